// SPDX-License-Identifier: GPL-3.0-or-later
/// Whole files as bytes.
#pragma once

#include <cstdint>
#include <string>

namespace phiz {

/// The content of a file. Throws phiz::Error(bad_input) when it does not exist, is a folder, cannot be read, is empty
/// or is longer than `limit` bytes.
std::string read_bytes(const std::string& path, std::uint64_t limit = std::uint64_t{8} << 30);

/// The extension of a path in lower case with its dot, e.g. ".obj"; empty when there is none.
std::string lower_extension(const std::string& path);

}  // namespace phiz
