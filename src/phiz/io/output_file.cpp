// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/io/output_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "phiz/core/error.h"

namespace phiz {

namespace {

[[noreturn]] void fail_to_write(const std::string& path, const std::string& reason) {
  fail(fmt::format("cannot write {}: {}", path, reason), "free some space or choose another place");
}

}  // namespace

void make_parent_folder(const std::string& path) {
  const auto folder = std::filesystem::path(path).parent_path();
  if (folder.empty()) return;
  std::error_code code;
  std::filesystem::create_directories(folder, code);
  if (code) fail_to_write(path, fmt::format("folder {}: {}", folder.string(), code.message()));
}

std::string temporary_name(const std::string& path) {
  static std::atomic<int> count{0};
  return fmt::format("{}.{}-{}.tmp", path, getpid(), count++);
}

void rename_file(const std::string& from, const std::string& to) {
  std::error_code code;
  std::filesystem::rename(from, to, code);
  if (code) fail_to_write(to, code.message());
}

OutputFile::OutputFile(std::string path) : path_(std::move(path)), temporary_(temporary_name(path_)) {
  if (std::filesystem::is_directory(path_)) fail_to_write(path_, "it is a folder");
  make_parent_folder(path_);
  file_ = std::fopen(temporary_.c_str(), "wb");
  if (file_ == nullptr) fail_to_write(path_, std::strerror(errno));
}

OutputFile::~OutputFile() {
  if (file_ == nullptr) return;
  std::fclose(file_);
  std::remove(temporary_.c_str());
}

void OutputFile::write(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) fail_to_write(path_, std::strerror(errno));
}

void OutputFile::commit() {
  // fsync refuses what is not a plain file (EINVAL); that is no loss of data.
  if (std::fflush(file_) != 0 || (fsync(fileno(file_)) != 0 && errno != EINVAL)) {
    fail_to_write(path_, std::strerror(errno));
  }
  std::FILE* file = file_;
  file_ = nullptr;
  if (std::fclose(file) != 0) {
    const std::string reason = std::strerror(errno);
    std::remove(temporary_.c_str());
    fail_to_write(path_, reason);
  }
  rename_file(temporary_, path_);
}

void require_writable(const std::string& path) {
  const OutputFile probe(path);
}

void write_bytes(const std::string& path, std::string_view bytes) {
  OutputFile file(path);
  file.write(bytes);
  file.commit();
}

}  // namespace phiz
