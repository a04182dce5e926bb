// SPDX-License-Identifier: GPL-3.0-or-later
/// Files that appear whole or not at all: written under a temporary name beside the target and renamed at the end.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

#include "phiz/core/progress.h"

namespace phiz {

/// A file being written. Missing folders on the way to it are created. Every member function throws
/// phiz::Error(failure) with the system's reason (disk full, no permission) when it does not succeed; a file that is
/// not committed leaves nothing behind.
class OutputFile {
 public:
  explicit OutputFile(std::string path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void write(std::string_view bytes);
  /// Flushes to the disk, closes and renames to the path.
  void commit();

 private:
  DelayInterrupts delay_;
  std::string path_;
  std::string temporary_;
  std::FILE* file_ = nullptr;
};

/// Writes a whole file.
void write_bytes(const std::string& path, std::string_view bytes);

/// Throws phiz::Error(failure) unless a file can be made at `path`: for asking before long work.
void require_writable(const std::string& path);

/// Creates the folder that `path` lies in, where it is missing. Throws phiz::Error(failure).
void make_parent_folder(const std::string& path);

/// A name in the same folder as `path` that no other process uses: "X" becomes "X.<process>-<count>.tmp".
std::string temporary_name(const std::string& path);

/// Renames, replacing an existing file. Throws phiz::Error(failure).
void rename_file(const std::string& from, const std::string& to);

}  // namespace phiz
