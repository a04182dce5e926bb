// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/io/hdf5_group.h"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "phiz/core/error.h"

namespace phiz {

namespace {

constexpr std::uint64_t best_deflate_ratio = 1032;  // no deflate stream expands more than this
constexpr std::uint64_t largest_chunk = 1u << 16;   // rows of a chunk
constexpr std::size_t longest_string = 1u << 20;
constexpr unsigned compression_level = 3;

hid_t memory_type(Scalar scalar) {
  switch (scalar) {
    case Scalar::float32:
      return H5T_NATIVE_FLOAT;
    case Scalar::float64:
      return H5T_NATIVE_DOUBLE;
    case Scalar::int32:
      return H5T_NATIVE_INT32;
  }
  return -1;
}

hid_t file_type(Scalar scalar) {
  switch (scalar) {
    case Scalar::float32:
      return H5T_IEEE_F32LE;
    case Scalar::float64:
      return H5T_IEEE_F64LE;
    case Scalar::int32:
      return H5T_STD_I32LE;
  }
  return -1;
}

/// HDF5 identifiers are 64 bits wide and its closers return int, as Hdf5Handle expects.
Hdf5Handle own_type(hid_t id) {
  return {id, H5Tclose};
}
Hdf5Handle own_space(hid_t id) {
  return {id, H5Sclose};
}
Hdf5Handle own_array(hid_t id) {
  return {id, H5Dclose};
}
Hdf5Handle own_attribute(hid_t id) {
  return {id, H5Aclose};
}
Hdf5Handle own_properties(hid_t id) {
  return {id, H5Pclose};
}

Hdf5Handle string_type(std::size_t length) {
  Hdf5Handle type = own_type(H5Tcopy(H5T_C_S1));
  H5Tset_size(type.get(), std::max<std::size_t>(length, 1));
  H5Tset_strpad(type.get(), H5T_STR_NULLPAD);
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  return type;
}

/// Fixed-length text without the padding.
std::string unpadded(const char* text, std::size_t length) {
  return {text, strnlen(text, length)};
}

}  // namespace

Hdf5Handle& Hdf5Handle::operator=(Hdf5Handle&& other) noexcept {
  if (this == &other) return *this;
  close();
  id_ = other.id_;
  closer_ = other.closer_;
  other.id_ = -1;
  return *this;
}

bool Hdf5Handle::close() {
  const bool good = id_ < 0 || closer_(id_) >= 0;
  id_ = -1;
  return good;
}

Hdf5Group::Hdf5Group(Hdf5Handle handle, std::shared_ptr<const Hdf5Origin> origin, std::string name)
    : handle_(std::move(handle)), origin_(std::move(origin)), name_(std::move(name)) {}

std::string Hdf5Group::where(const std::string& item) const {
  std::string place = name_;
  if (!place.empty() && !item.empty()) place += "/";
  place += item;
  return place.empty() ? origin_->path : fmt::format("{}: {}", origin_->path, place);
}

bool Hdf5Group::has_group(const std::string& name) const {
  if (H5Lexists(handle_.get(), name.c_str(), H5P_DEFAULT) <= 0) return false;
  H5O_info_t info;
  return H5Oget_info_by_name(handle_.get(), name.c_str(), &info, H5P_DEFAULT) >= 0 && info.type == H5O_TYPE_GROUP;
}

bool Hdf5Group::has_array(const std::string& name) const {
  if (H5Lexists(handle_.get(), name.c_str(), H5P_DEFAULT) <= 0) return false;
  H5O_info_t info;
  return H5Oget_info_by_name(handle_.get(), name.c_str(), &info, H5P_DEFAULT) >= 0 && info.type == H5O_TYPE_DATASET;
}

Hdf5Group Hdf5Group::group(const std::string& name) const {
  if (!has_group(name)) reject(where(name), "this group is missing");
  Hdf5Handle handle(H5Gopen2(handle_.get(), name.c_str(), H5P_DEFAULT), H5Gclose);
  if (!handle.valid()) reject(where(name), "this group cannot be opened");
  return {std::move(handle), origin_, name_.empty() ? name : name_ + "/" + name};
}

Hdf5Group Hdf5Group::create_group(const std::string& name) const {
  Hdf5Handle handle(H5Gcreate2(handle_.get(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
  if (!handle.valid()) fail("cannot write " + where(name));
  return {std::move(handle), origin_, name_.empty() ? name : name_ + "/" + name};
}

namespace {

void set_attribute(hid_t group, const std::string& name, hid_t type, const void* value, const std::string& where) {
  if (H5Aexists(group, name.c_str()) > 0) {
    const Hdf5Handle old = own_attribute(H5Aopen(group, name.c_str(), H5P_DEFAULT));
    if (!old.valid() || H5Awrite(old.get(), type, value) < 0) fail("cannot write " + where);
    return;
  }
  const Hdf5Handle space = own_space(H5Screate(H5S_SCALAR));
  const Hdf5Handle attribute =
      own_attribute(H5Acreate2(group, name.c_str(), type, space.get(), H5P_DEFAULT, H5P_DEFAULT));
  if (!attribute.valid() || H5Awrite(attribute.get(), type, value) < 0) fail("cannot write " + where);
}

struct OpenAttribute {
  Hdf5Handle attribute, type;
};

OpenAttribute open_attribute(hid_t group, const std::string& name, H5T_class_t kind, const std::string& where) {
  if (H5Aexists(group, name.c_str()) <= 0) reject(where, "this attribute is missing");
  OpenAttribute open{own_attribute(H5Aopen(group, name.c_str(), H5P_DEFAULT)), {}};
  if (!open.attribute.valid()) reject(where, "this attribute cannot be opened");
  open.type = own_type(H5Aget_type(open.attribute.get()));
  const Hdf5Handle space = own_space(H5Aget_space(open.attribute.get()));
  if (H5Tget_class(open.type.get()) != kind || H5Sget_simple_extent_npoints(space.get()) != 1) {
    reject(where, "this attribute has another type than expected");
  }
  return open;
}

}  // namespace

void Hdf5Group::set(const std::string& name, double value) const {
  set_attribute(handle_.get(), name, H5T_NATIVE_DOUBLE, &value, where(name));
}

void Hdf5Group::set(const std::string& name, int value) const {
  set_attribute(handle_.get(), name, H5T_NATIVE_INT32, &value, where(name));
}

void Hdf5Group::set(const std::string& name, const std::string& value) const {
  const Hdf5Handle type = string_type(value.size());
  const std::string at_least_one = value.empty() ? std::string(1, '\0') : value;
  set_attribute(handle_.get(), name, type.get(), at_least_one.data(), where(name));
}

double Hdf5Group::number(const std::string& name) const {
  const OpenAttribute open = open_attribute(handle_.get(), name, H5T_FLOAT, where(name));
  double value = 0;
  if (H5Aread(open.attribute.get(), H5T_NATIVE_DOUBLE, &value) < 0) reject(where(name), "cannot be read");
  if (!std::isfinite(value)) reject(where(name), "this number is not finite");
  return value;
}

int Hdf5Group::integer(const std::string& name) const {
  const OpenAttribute open = open_attribute(handle_.get(), name, H5T_INTEGER, where(name));
  int value = 0;
  if (H5Aread(open.attribute.get(), H5T_NATIVE_INT32, &value) < 0) reject(where(name), "cannot be read");
  return value;
}

std::string Hdf5Group::text(const std::string& name) const {
  const OpenAttribute open = open_attribute(handle_.get(), name, H5T_STRING, where(name));
  const std::size_t length = H5Tget_size(open.type.get());
  if (H5Tis_variable_str(open.type.get()) != 0 || length > longest_string) {
    reject(where(name), "expected a text of fixed length");
  }
  std::string value(length, '\0');
  if (H5Aread(open.attribute.get(), open.type.get(), value.data()) < 0) reject(where(name), "cannot be read");
  return unpadded(value.data(), length);
}

Hdf5Handle Hdf5Group::open_array(const std::string& name) const {
  if (!has_array(name)) reject(where(name), "this array is missing");
  Hdf5Handle array = own_array(H5Dopen2(handle_.get(), name.c_str(), H5P_DEFAULT));
  if (!array.valid()) reject(where(name), "this array cannot be opened");
  return array;
}

namespace {

/// Sizes of an array; refuses more bytes than the file can hold, compressed as well as can be.
Dimensions sizes_of(hid_t array, std::size_t rank, const Hdf5Origin& origin, const std::string& where) {
  const Hdf5Handle space = own_space(H5Dget_space(array));
  const int found = space.valid() ? H5Sget_simple_extent_ndims(space.get()) : -1;
  if (found != static_cast<int>(rank)) reject(where, fmt::format("{} dimensions, expected {}", found, rank));
  std::vector<hsize_t> sizes(rank);
  H5Sget_simple_extent_dims(space.get(), sizes.data(), nullptr);
  if (std::find(sizes.begin(), sizes.end(), hsize_t{0}) != sizes.end()) return {sizes.begin(), sizes.end()};
  const Hdf5Handle type = own_type(H5Dget_type(array));
  std::uint64_t room = origin.bytes * best_deflate_ratio / std::max<std::uint64_t>(H5Tget_size(type.get()), 1);
  for (const hsize_t size : sizes) {
    if (size > room) reject(where, "the array claims more values than the file can hold", "the file is damaged");
    room /= size;
  }
  return {sizes.begin(), sizes.end()};
}

void require_class(hid_t array, Scalar scalar, const std::string& where) {
  const Hdf5Handle type = own_type(H5Dget_type(array));
  const bool integer = scalar == Scalar::int32;
  if (H5Tget_class(type.get()) != (integer ? H5T_INTEGER : H5T_FLOAT)) {
    reject(where, integer ? "expected whole numbers" : "expected floating-point numbers");
  }
}

}  // namespace

Dimensions Hdf5Group::dimensions(const std::string& name, std::size_t rank) const {
  return sizes_of(open_array(name).get(), rank, *origin_, where(name));
}

void Hdf5Group::require_size(const std::string& name, std::uint64_t found, std::uint64_t expected) const {
  if (found != expected) reject(where(name), fmt::format("{} values, expected {}", found, expected));
}

void Hdf5Group::write_array(const std::string& name, Scalar scalar, const Dimensions& sizes, const void* values) const {
  const std::vector<hsize_t> dims(sizes.begin(), sizes.end());
  const Hdf5Handle space = own_space(H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr));
  const Hdf5Handle properties = own_properties(H5Pcreate(H5P_DATASET_CREATE));
  H5Pset_obj_track_times(properties.get(), false);
  std::uint64_t count = 1;
  for (const hsize_t d : dims) count *= d;
  if (count > 256) {
    std::vector<hsize_t> chunk = dims;
    chunk[0] = std::min<hsize_t>(chunk[0], largest_chunk);
    H5Pset_chunk(properties.get(), static_cast<int>(chunk.size()), chunk.data());
    H5Pset_shuffle(properties.get());
    H5Pset_deflate(properties.get(), compression_level);
  }
  const Hdf5Handle array = own_array(H5Dcreate2(handle_.get(), name.c_str(), file_type(scalar), space.get(),
                                                H5P_DEFAULT, properties.get(), H5P_DEFAULT));
  if (!array.valid() ||
      (count > 0 && H5Dwrite(array.get(), memory_type(scalar), H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0)) {
    fail("cannot write " + where(name), "is the disk full?");
  }
}

void Hdf5Group::read_array(const std::string& name, Scalar scalar, void* values) const {
  const Hdf5Handle array = open_array(name);
  require_class(array.get(), scalar, where(name));
  const Hdf5Handle space = own_space(H5Dget_space(array.get()));
  if (H5Sget_simple_extent_npoints(space.get()) == 0) return;
  if (H5Dread(array.get(), memory_type(scalar), H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0) {
    reject(where(name), "this array cannot be read", "the file is damaged");
  }
}

void Hdf5Group::write_strings(const std::string& name, const std::vector<std::string>& values) const {
  std::size_t length = 1;
  for (const std::string& v : values) length = std::max(length, v.size());
  std::string padded;
  for (const std::string& v : values) padded.append(v).append(length - v.size(), '\0');
  const Hdf5Handle type = string_type(length);
  const hsize_t count = values.size();
  const Hdf5Handle space = own_space(H5Screate_simple(1, &count, nullptr));
  const Hdf5Handle timeless = own_properties(H5Pcreate(H5P_DATASET_CREATE));
  H5Pset_obj_track_times(timeless.get(), false);
  const Hdf5Handle array = own_array(
      H5Dcreate2(handle_.get(), name.c_str(), type.get(), space.get(), H5P_DEFAULT, timeless.get(), H5P_DEFAULT));
  if (!array.valid() ||
      (count > 0 && H5Dwrite(array.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, padded.data()) < 0)) {
    fail("cannot write " + where(name), "is the disk full?");
  }
}

std::vector<std::string> Hdf5Group::read_strings(const std::string& name) const {
  const Hdf5Handle array = open_array(name);
  const Dimensions sizes = sizes_of(array.get(), 1, *origin_, where(name));
  const Hdf5Handle type = own_type(H5Dget_type(array.get()));
  const std::size_t length = H5Tget_size(type.get());
  if (H5Tget_class(type.get()) != H5T_STRING || H5Tis_variable_str(type.get()) != 0 || length > longest_string) {
    reject(where(name), "expected texts of fixed length");
  }
  std::string padded(length * sizes[0], '\0');
  if (sizes[0] > 0 && H5Dread(array.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, padded.data()) < 0) {
    reject(where(name), "this list cannot be read", "the file is damaged");
  }
  std::vector<std::string> values;
  for (std::uint64_t i = 0; i < sizes[0]; ++i) values.push_back(unpadded(padded.data() + i * length, length));
  return values;
}

void Hdf5Group::create_frames(const std::string& name, Scalar scalar, const Dimensions& shape) const {
  std::vector<hsize_t> dims = {0}, most = {H5S_UNLIMITED}, chunk = {1};
  std::uint64_t count = 1;
  for (const std::uint64_t size : shape) {
    dims.push_back(size);
    most.push_back(size);
    chunk.push_back(std::clamp<hsize_t>(size, 1, largest_chunk));
    count *= size;
  }
  // A chunk holds one frame of positions, compressed; or many frames of a few numbers, which stay as long as they are,
  // so that a frame is added in place and a full disk cannot harm those before it.
  const bool small = count < 512;
  if (small) chunk[0] = 64;
  const Hdf5Handle space = own_space(H5Screate_simple(static_cast<int>(dims.size()), dims.data(), most.data()));
  const Hdf5Handle properties = own_properties(H5Pcreate(H5P_DATASET_CREATE));
  H5Pset_obj_track_times(properties.get(), false);
  H5Pset_chunk(properties.get(), static_cast<int>(chunk.size()), chunk.data());
  if (!small) {
    H5Pset_shuffle(properties.get());
    H5Pset_deflate(properties.get(), compression_level);
  }
  const Hdf5Handle array = own_array(H5Dcreate2(handle_.get(), name.c_str(), file_type(scalar), space.get(),
                                                H5P_DEFAULT, properties.get(), H5P_DEFAULT));
  if (!array.valid()) fail("cannot write " + where(name));
}

namespace {

/// The part of a growing array that holds one frame, selected in `space`; and its counterpart in memory.
Hdf5Handle select_frame(hid_t space, std::uint64_t frame) {
  std::vector<hsize_t> size(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space)));
  H5Sget_simple_extent_dims(space, size.data(), nullptr);
  std::vector<hsize_t> start(size.size(), 0);
  start[0] = frame;
  size[0] = 1;
  H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, size.data(), nullptr);
  return own_space(H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr));
}

}  // namespace

void Hdf5Group::append_frame(const std::string& name, Scalar scalar, std::uint64_t frame, const void* values) const {
  const Hdf5Handle array = open_array(name);
  const Hdf5Handle before = own_space(H5Dget_space(array.get()));
  std::vector<hsize_t> sizes(static_cast<std::size_t>(H5Sget_simple_extent_ndims(before.get())));
  H5Sget_simple_extent_dims(before.get(), sizes.data(), nullptr);
  sizes[0] = frame + 1;
  bool good = H5Dset_extent(array.get(), sizes.data()) >= 0;
  const Hdf5Handle space = own_space(H5Dget_space(array.get()));
  const Hdf5Handle memory = select_frame(space.get(), frame);
  if (H5Sget_simple_extent_npoints(memory.get()) > 0) {
    good = good && H5Dwrite(array.get(), memory_type(scalar), memory.get(), space.get(), H5P_DEFAULT, values) >= 0;
  }
  if (!good) fail("cannot write " + where(name), "is the disk full?");
}

Dimensions Hdf5Group::frame_shape(const std::string& name, std::uint64_t frames, std::size_t rank) const {
  const Dimensions sizes = dimensions(name, rank + 1);
  if (sizes[0] < frames) reject(where(name), fmt::format("{} frames, expected {}", sizes[0], frames));
  return {sizes.begin() + 1, sizes.end()};
}

void Hdf5Group::read_frame(const std::string& name, Scalar scalar, std::uint64_t frame, void* values) const {
  const Hdf5Handle array = open_array(name);
  require_class(array.get(), scalar, where(name));
  const Hdf5Handle space = own_space(H5Dget_space(array.get()));
  const Hdf5Handle memory = select_frame(space.get(), frame);
  if (H5Sget_simple_extent_npoints(memory.get()) == 0) return;
  if (H5Dread(array.get(), memory_type(scalar), memory.get(), space.get(), H5P_DEFAULT, values) < 0) {
    reject(where(fmt::format("{} frame {}", name, frame)), "this frame cannot be read", "the file is damaged");
  }
}

}  // namespace phiz
