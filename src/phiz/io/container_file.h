// SPDX-License-Identifier: GPL-3.0-or-later
/// A .phiz file: an HDF5 file behind a block of 512 bytes that says what it is and carries a checksum, so that damage
/// is noticed before HDF5 sees it. Private to the container's readers and writers. Layout: docs/format.md.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "phiz/io/hdf5_group.h"

namespace phiz {

/// HDF5 is not safe for threads: every public function of the container holds this lock.
std::recursive_mutex& hdf5_lock();

/// A .phiz file open for reading or writing.
class ContainerFile {
 public:
  /// Opens for reading: checks the first block, the checksum and the version. Throws phiz::Error(bad_input).
  static ContainerFile open(const std::string& path);
  /// Makes a new file of that kind ("head", ...), marked as unfinished. It lies beside `path` under a temporary name
  /// until it is published; if it never is, it leaves nothing behind.
  static ContainerFile create(const std::string& path, const std::string& kind);

  ContainerFile(ContainerFile&&) = default;
  ContainerFile& operator=(ContainerFile&&) = default;
  ~ContainerFile() = default;

  const Hdf5Group& root() const { return root_; }
  std::string kind() const { return kind_; }
  int version() const { return version_; }
  /// Refuses a file of another kind.
  void require_kind(const std::string& kind) const;

  /// Gives a new file its name, in the place of what was there.
  void publish();
  /// Brings everything written so far to the disk in a state that can be opened.
  void flush();
  /// Closes the file, writes its checksum and marks it as finished. Throws phiz::Error(failure).
  void finish();

 private:
  struct Unpublished {
    std::string name;
    ~Unpublished();
  };
  ContainerFile(std::string path, std::unique_ptr<Unpublished> unpublished, Hdf5Handle file);
  void read_root();
  /// Where the file lies now.
  const std::string& place() const { return unpublished_ ? unpublished_->name : path_; }

  std::string path_;
  std::unique_ptr<Unpublished> unpublished_;
  Hdf5Handle file_;
  Hdf5Group root_;
  std::string kind_;
  int version_ = 0;
};

/// Writes a whole container: `fill(root)` puts the content in; the file appears under its name only when all went well.
void write_container(const std::string& path, const std::string& kind,
                     const std::function<void(const Hdf5Group& root)>& fill);

}  // namespace phiz
