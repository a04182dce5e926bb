// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/io/file_set.h"

#include <archive.h>
#include <archive_entry.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>

#include "phiz/core/error.h"
#include "phiz/io/text_scanner.h"

namespace phiz {

namespace {

constexpr std::int64_t largest_entry = std::int64_t{1} << 30;  // bytes; no mesh of a data set is larger

struct Close {
  void operator()(archive* a) const { archive_read_free(a); }
};

}  // namespace

std::vector<std::string> files_under(const std::string& folder) {
  namespace fs = std::filesystem;
  std::error_code error;
  if (!fs::is_directory(folder, error)) reject(folder, "there is no such folder");
  std::vector<std::string> files;
  fs::recursive_directory_iterator it(folder, fs::directory_options::skip_permission_denied, error), end;
  for (; !error && it != end; it.increment(error))
    if (it->is_regular_file(error)) files.push_back(it->path().string());
  if (error) reject(folder, "cannot be read: " + error.message());
  std::sort(files.begin(), files.end());
  return files;
}

bool is_archive(const std::string& path) {
  const std::string name = lowered(path);
  for (const char* end : {".tar.xz", ".tar.gz", ".tgz", ".tar", ".zip"})
    if (name.ends_with(end)) return true;
  return false;
}

void read_archive(const std::string& path, const std::function<bool(const std::string& name)>& wanted,
                  const std::function<void(const std::string& name, std::string bytes)>& visit) {
  const std::unique_ptr<archive, Close> reader(archive_read_new());
  archive_read_support_filter_all(reader.get());
  archive_read_support_format_tar(reader.get());
  archive_read_support_format_zip(reader.get());
  const auto damaged = [&] {
    const char* why = archive_error_string(reader.get());
    reject(path, std::string("the archive is damaged: ") + (why != nullptr ? why : "no reason given"),
           "fetch it again");
  };
  if (archive_read_open_filename(reader.get(), path.c_str(), 1 << 20) != ARCHIVE_OK) damaged();
  for (archive_entry* entry = nullptr;;) {
    const int status = archive_read_next_header(reader.get(), &entry);
    if (status == ARCHIVE_EOF) return;
    if (status != ARCHIVE_OK && status != ARCHIVE_WARN) damaged();
    const char* stored = archive_entry_pathname_utf8(entry);
    if (stored == nullptr || archive_entry_filetype(entry) != AE_IFREG || !wanted(stored)) continue;
    const std::string name = stored;
    std::string bytes;
    for (char block[1 << 16];;) {
      const la_ssize_t count = archive_read_data(reader.get(), block, sizeof block);
      if (count < 0) damaged();
      if (count == 0) break;
      bytes.append(block, static_cast<std::size_t>(count));
      if (static_cast<std::int64_t>(bytes.size()) > largest_entry) reject(path, name + " is larger than 1 GiB");
    }
    visit(name, std::move(bytes));
  }
}

}  // namespace phiz
