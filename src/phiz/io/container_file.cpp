// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/io/container_file.h"

#include <fmt/format.h>
#include <hdf5.h>
#include <zlib.h>

#include <cstring>
#include <filesystem>
#include <fstream>

#include "phiz/core/error.h"
#include "phiz/io/byte_order.h"
#include "phiz/io/container.h"
#include "phiz/io/output_file.h"

namespace phiz {

namespace {

// The first block: magic (8 bytes), state (uint32: 0 unfinished, 1 finished), checksum (uint32: CRC-32 of all bytes
// after the block), length of what follows (uint64), a line for people; little-endian, padded with zeros.
constexpr std::size_t block_bytes = 512;
constexpr std::string_view magic("\x89PHIZ\r\n\x1a", 8);
constexpr std::string_view for_people = "Phiz container; an HDF5 file begins at byte 512.\n";
constexpr std::uint32_t unfinished = 0, finished = 1;

std::string first_block(std::uint32_t state, std::uint32_t checksum, std::uint64_t length) {
  std::string block(magic);
  append_number(block, state);
  append_number(block, checksum);
  append_number(block, length);
  block += for_people;
  block.resize(block_bytes, '\0');
  return block;
}

struct Rest {
  std::uint32_t checksum = 0;
  std::uint64_t length = 0;
};

/// Checksum and length of everything after the first block.
Rest read_rest(std::istream& file) {
  Rest rest;
  std::string piece(std::size_t{1} << 20, '\0');
  uLong crc = crc32(0, nullptr, 0);
  while (file.read(piece.data(), static_cast<std::streamsize>(piece.size())) || file.gcount() > 0) {
    crc = crc32(crc, reinterpret_cast<const Bytef*>(piece.data()), static_cast<uInt>(file.gcount()));
    rest.length += static_cast<std::uint64_t>(file.gcount());
  }
  rest.checksum = static_cast<std::uint32_t>(crc);
  return rest;
}

void check_first_block(const std::string& path) {
  std::error_code code;
  if (!std::filesystem::exists(path, code)) reject(path, "the file does not exist", "check the path");
  if (std::filesystem::is_directory(path, code)) reject(path, "this is a folder, expected a file");
  std::ifstream file(path, std::ios::binary);
  std::string block(block_bytes, '\0');
  if (!file) reject(path, "the file cannot be opened", "check its permissions");
  if (file.peek() == std::ifstream::traits_type::eof()) reject(path, "the file is empty");
  if (!file.read(block.data(), block_bytes) || !block.starts_with(magic)) reject(path, "not a .phiz file");
  const auto state = load_number<std::uint32_t>(block, 8);
  if (state == unfinished) return;
  const Rest rest = read_rest(file);
  if (state != finished || rest.length != load_number<std::uint64_t>(block, 16)) {
    reject(path, "the file is cut off or its first block is damaged", "copy it again from where it came from");
  }
  if (rest.checksum != load_number<std::uint32_t>(block, 12)) {
    reject(path, "the file is damaged: its checksum is wrong", "copy it again from where it came from");
  }
}

/// `shown`: the name for messages.
void write_first_block(const std::string& place, const std::string& block, const std::string& shown) {
  std::fstream file(place, std::ios::binary | std::ios::in | std::ios::out);
  file.write(block.data(), static_cast<std::streamsize>(block.size()));
  file.close();
  if (!file) fail("cannot write " + shown, "free some space or choose another place");
}

Hdf5Handle own_file(hid_t id) {
  return {id, H5Fclose};
}

/// Metadata goes to the disk when the file is flushed and at no other time, so that a killed program leaves the
/// state of its last flush behind.
Hdf5Handle access_properties() {
  Hdf5Handle properties(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5AC_cache_config_t config;
  config.version = H5AC__CURR_CACHE_CONFIG_VERSION;
  H5Pget_mdc_config(properties.get(), &config);
  config.evictions_enabled = false;
  config.incr_mode = H5C_incr__off;
  config.flash_incr_mode = H5C_flash_incr__off;
  config.decr_mode = H5C_decr__off;
  H5Pset_mdc_config(properties.get(), &config);
  H5Pset_fclose_degree(properties.get(), H5F_CLOSE_STRONG);
  return properties;
}

/// Before the first use: no messages of its own, and no clean-up at the end of the process, in which the library
/// follows dangling pointers of files that could not be written (full disk). Every file here is closed by its owner.
void prepare_hdf5() {
  static const bool first = H5dont_atexit() >= 0;
  static_cast<void>(first);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

}  // namespace

std::recursive_mutex& hdf5_lock() {
  static std::recursive_mutex mutex;
  return mutex;
}

ContainerFile::Unpublished::~Unpublished() {
  if (!name.empty()) std::remove(name.c_str());
}

ContainerFile::ContainerFile(std::string path, std::unique_ptr<Unpublished> unpublished, Hdf5Handle file)
    : path_(std::move(path)), unpublished_(std::move(unpublished)), file_(std::move(file)) {
  std::error_code code;
  const auto bytes = std::filesystem::file_size(place(), code);
  const auto origin = std::make_shared<Hdf5Origin>(Hdf5Origin{path_, code ? 0 : bytes});
  root_ = Hdf5Group(Hdf5Handle(H5Gopen2(file_.get(), "/", H5P_DEFAULT), H5Gclose), origin, "");
}

void ContainerFile::read_root() {
  if (root_.text("format") != "phiz") reject(path_, "not a .phiz file");
  kind_ = root_.text("kind");
  version_ = root_.integer("version");
  if (version_ < 1) reject(path_, fmt::format("version {} of the format does not exist", version_));
  if (version_ > container_version) {
    reject(
        path_,
        fmt::format("the file has version {} of the format, this program knows up to {}", version_, container_version),
        "use a newer Phiz");
  }
}

ContainerFile ContainerFile::open(const std::string& path) {
  prepare_hdf5();
  check_first_block(path);
  const Hdf5Handle access = access_properties();
  Hdf5Handle file = own_file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.get()));
  if (!file.valid()) reject(path, "the file cannot be opened as HDF5", "it is damaged");
  ContainerFile result(path, nullptr, std::move(file));
  result.read_root();
  return result;
}

ContainerFile ContainerFile::create(const std::string& path, const std::string& kind) {
  prepare_hdf5();
  require_writable(path);
  auto unpublished = std::make_unique<Unpublished>(Unpublished{temporary_name(path)});
  const std::string place = unpublished->name;
  const Hdf5Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  H5Pset_userblock(creation.get(), block_bytes);
  const Hdf5Handle access = access_properties();
  Hdf5Handle file = own_file(H5Fcreate(place.c_str(), H5F_ACC_TRUNC, creation.get(), access.get()));
  if (!file.valid()) fail("cannot write " + path, "is the disk full?");
  ContainerFile result(path, std::move(unpublished), std::move(file));
  result.root_.set("format", std::string("phiz"));
  result.root_.set("version", container_version);
  result.root_.set("kind", kind);
  result.root_.set("unit", std::string("metres, kilograms, seconds, radians"));
  result.kind_ = kind;
  result.version_ = container_version;
  result.flush();
  write_first_block(place, first_block(unfinished, 0, 0), path);
  return result;
}

void ContainerFile::require_kind(const std::string& kind) const {
  if (kind_ != kind) reject(path_, fmt::format("the file holds a {}, expected a {}", kind_, kind));
}

void ContainerFile::publish() {
  if (!unpublished_) return;
  rename_file(place(), path_);
  unpublished_->name.clear();
  unpublished_.reset();
}

void ContainerFile::flush() {
  if (H5Fflush(file_.get(), H5F_SCOPE_LOCAL) < 0) fail("cannot write " + path_, "is the disk full?");
}

void ContainerFile::finish() {
  flush();
  root_ = Hdf5Group();
  if (!file_.close()) fail("cannot write " + path_, "is the disk full?");
  std::ifstream file(place(), std::ios::binary);
  file.seekg(block_bytes);
  const Rest rest = read_rest(file);
  write_first_block(place(), first_block(finished, rest.checksum, rest.length), path_);
}

void write_container(const std::string& path, const std::string& kind,
                     const std::function<void(const Hdf5Group& root)>& fill) {
  const std::scoped_lock lock(hdf5_lock());
  const DelayInterrupts delay;
  ContainerFile file = ContainerFile::create(path, kind);
  fill(file.root());
  file.finish();
  file.publish();
}

ContainerKind kind_of(const std::string& path) {
  const std::scoped_lock lock(hdf5_lock());
  const std::string kind = ContainerFile::open(path).kind();
  for (const ContainerKind k :
       {ContainerKind::head_template, ContainerKind::face_model, ContainerKind::performance, ContainerKind::take}) {
    if (name_of(k) == kind) return k;
  }
  reject(path, fmt::format("unknown kind of content '{}'", kind), "use a newer Phiz");
}

std::string name_of(ContainerKind kind) {
  switch (kind) {
    case ContainerKind::head_template:
      return "head";
    case ContainerKind::face_model:
      return "model";
    case ContainerKind::performance:
      return "performance";
    case ContainerKind::take:
      return "take";
  }
  return {};
}

}  // namespace phiz
