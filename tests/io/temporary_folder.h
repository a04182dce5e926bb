// SPDX-License-Identifier: GPL-3.0-or-later
/// A folder that a test may fill; removed with everything in it at the end.
#pragma once

#include <filesystem>
#include <string>

#include "phiz/io/output_file.h"

namespace phiz {

class TemporaryFolder {
 public:
  TemporaryFolder() : path_(temporary_name((std::filesystem::temp_directory_path() / "phiz-test").string())) {
    std::filesystem::create_directories(path_);
  }
  ~TemporaryFolder() {
    std::error_code code;
    std::filesystem::remove_all(path_, code);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::string file(const std::string& name) const { return (path_ / name).string(); }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace phiz
