// SPDX-License-Identifier: GPL-3.0-or-later
/// Many files at once, from a folder with its subfolders and the archives in it.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace phiz {

/// Every regular file under `folder`, sorted. Throws phiz::Error(bad_input) when it is no readable folder.
std::vector<std::string> files_under(const std::string& folder);

/// True for .tar.xz, .tar.gz, .tgz, .tar and .zip.
bool is_archive(const std::string& path);

/// Calls visit(name, bytes) for every wanted file in the archive, in its order; `name` as stored. Throws
/// phiz::Error(bad_input) for a damaged archive.
void read_archive(const std::string& path, const std::function<bool(const std::string& name)>& wanted,
                  const std::function<void(const std::string& name, std::string bytes)>& visit);

}  // namespace phiz
