// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/version1.h"

#include <hdf5.h>
#include <zlib.h>

#include <cstring>
#include <filesystem>
#include <fstream>

#include "phiz/io/file_bytes.h"

namespace phiz::version1 {

namespace {

hid_t create(const std::string& path, const char* kind) {
  const hid_t creation = H5Pcreate(H5P_FILE_CREATE);
  H5Pset_userblock(creation, 512);
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation, H5P_DEFAULT);
  H5Pclose(creation);
  const hid_t space = H5Screate(H5S_SCALAR);
  for (const auto& [name, text] : {std::pair{"format", "phiz"}, std::pair{"kind", kind}}) {
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, std::strlen(text));
    const hid_t attribute = H5Acreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(attribute, type, text);
    H5Aclose(attribute);
    H5Tclose(type);
  }
  H5Sclose(space);
  return file;
}

template <class Number>
void set(hid_t place, const char* name, hid_t type, Number value) {
  const hid_t space = H5Screate(H5S_SCALAR);
  const hid_t attribute = H5Acreate2(place, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
  H5Awrite(attribute, type, &value);
  H5Aclose(attribute);
  H5Sclose(space);
}

void write(hid_t place, const char* name, hid_t type, std::initializer_list<hsize_t> sizes, const void* values) {
  const hid_t space = H5Screate_simple(static_cast<int>(sizes.size()), sizes.begin(), nullptr);
  const hid_t array = H5Dcreate2(place, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  hsize_t count = 1;
  for (const hsize_t size : sizes) count *= size;
  if (count > 0) H5Dwrite(array, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
  H5Dclose(array);
  H5Sclose(space);
}

template <class Matrix>
void write_rows(hid_t place, const char* name, hid_t type, const Matrix& m) {
  const Eigen::Matrix<typename Matrix::Scalar, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows = m;
  write(place, name, type, {static_cast<hsize_t>(m.rows()), static_cast<hsize_t>(m.cols())}, rows.data());
}

void write_names(hid_t place, const char* name, const std::vector<std::string>& names) {
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, 32);
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  std::string padded;
  for (const std::string& n : names) padded.append(n).append(32 - n.size(), '\0');
  write(place, name, type, {names.size()}, padded.data());
  H5Tclose(type);
}

}  // namespace

void seal(const std::string& path) {
  std::string bytes = read_bytes(path);
  const std::uint32_t state = 1;
  const auto checksum = static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(bytes.data()) + 512, static_cast<uInt>(bytes.size() - 512)));
  const std::uint64_t length = bytes.size() - 512;
  std::memcpy(bytes.data(), "\x89PHIZ\r\n\x1a", 8);
  std::memcpy(bytes.data() + 8, &state, 4);
  std::memcpy(bytes.data() + 12, &checksum, 4);
  std::memcpy(bytes.data() + 16, &length, 8);
  std::ofstream(path, std::ios::binary) << bytes;
}

void write_performance(const std::string& path, const Performance& p) {
  const hid_t file = create(path, "performance");
  set(file, "version", H5T_STD_I32LE, 1);
  set(file, "frame_rate", H5T_IEEE_F64LE, p.frame_rate);
  write_names(file, "expressions", p.expressions);
  write(file, "time", H5T_IEEE_F64LE, {static_cast<hsize_t>(p.time.size())}, p.time.data());
  write_rows(file, "weights", H5T_IEEE_F64LE, p.weights);
  write_rows(file, "head", H5T_IEEE_F64LE, p.head);
  write_rows(file, "left_eye", H5T_IEEE_F64LE, p.left_eye);
  write_rows(file, "right_eye", H5T_IEEE_F64LE, p.right_eye);
  H5Fclose(file);
  seal(path);
}

void write_take(const std::string& path, const Take& take) {
  const hid_t file = create(path, "take");
  set(file, "version", H5T_STD_I32LE, 1);
  set(file, "frame_rate", H5T_IEEE_F64LE, take.frame_rate);
  set(file, "frames", H5T_STD_I32LE, static_cast<int>(take.frames.size()));
  set(file, "frames_planned", H5T_STD_I32LE, take.frames_planned);
  const hid_t model_type = H5Tcopy(H5T_C_S1);
  H5Tset_size(model_type, 16);
  H5Tset_strpad(model_type, H5T_STR_NULLPAD);
  std::array<char, 16> model{};
  take.model.copy(model.data(), 15);
  set(file, "model", model_type, model);
  H5Tclose(model_type);
  write_names(file, "expressions", take.expressions);
  const hid_t skin = H5Gcreate2(file, "skin", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  write_rows(skin, "V", H5T_IEEE_F64LE, take.skin.V);
  write_rows(skin, "F", H5T_STD_I32LE, take.skin.F);
  write_rows(skin, "UV", H5T_IEEE_F64LE, take.skin.UV);
  write_rows(skin, "FUV", H5T_STD_I32LE, take.skin.FUV);
  H5Gclose(skin);
  const hid_t parts = H5Gcreate2(file, "parts", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  set(parts, "count", H5T_STD_I32LE, 0);
  H5Gclose(parts);
  const hid_t jaw = H5Gcreate2(file, "jaw", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  write(jaw, "centre", H5T_IEEE_F64LE, {3}, take.joint.centre.data());
  write(jaw, "axis", H5T_IEEE_F64LE, {3}, take.joint.axis.data());
  write(jaw, "up", H5T_IEEE_F64LE, {3}, take.joint.up.data());
  write(jaw, "lower", H5T_IEEE_F64LE, {5}, take.joint.lower.data());
  write(jaw, "upper", H5T_IEEE_F64LE, {5}, take.joint.upper.data());
  H5Gclose(jaw);
  write(file, "left_eye_centre", H5T_IEEE_F64LE, {3}, take.left_eye_centre.data());
  write(file, "right_eye_centre", H5T_IEEE_F64LE, {3}, take.right_eye_centre.data());
  const hid_t data = H5Gcreate2(file, "frame_data", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  std::vector<double> numbers, weights;
  std::vector<float> positions;
  for (const TakeFrame& f : take.frames) {
    numbers.push_back(f.time);
    numbers.insert(numbers.end(), f.jaw.data(), f.jaw.data() + 5);
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 4; ++c) numbers.push_back(f.head.matrix()(r, c));
    }
    for (const Matrix3d* eye : {&f.left_eye, &f.right_eye}) {
      for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) numbers.push_back((*eye)(r, c));
      }
    }
    const SolveStatistics& s = f.statistics;
    numbers.insert(numbers.end(),
                   {s.converged ? 1.0 : 0.0, static_cast<double>(s.iterations), s.residual, s.energy,
                    static_cast<double>(s.contacts), s.penetration, s.milliseconds, s.volume_change, s.last_step});
    weights.insert(weights.end(), f.part_weights.data(), f.part_weights.data() + f.part_weights.size());
    positions.insert(positions.end(), f.skin.data(), f.skin.data() + f.skin.size());
  }
  const hsize_t frames = take.frames.size();
  write(data, "numbers", H5T_IEEE_F64LE, {frames, 45}, numbers.data());
  write(data, "weights", H5T_IEEE_F64LE, {frames, take.expressions.size()}, weights.data());
  write(data, "skin", H5T_IEEE_F32LE, {frames, static_cast<hsize_t>(take.skin.V.rows()), 3}, positions.data());
  H5Gclose(data);
  H5Fclose(file);
  seal(path);
}

}  // namespace phiz::version1
