// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/io/file_bytes.h"

#include <fmt/format.h>

#include <cctype>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "phiz/core/error.h"

namespace phiz {

std::string read_bytes(const std::string& path, std::uint64_t limit) {
  std::error_code code;
  const auto status = std::filesystem::status(path, code);
  if (!std::filesystem::exists(status)) reject(path, "the file does not exist", "check the path");
  if (std::filesystem::is_directory(status)) reject(path, "this is a folder, expected a file");
  std::ifstream file(path, std::ios::binary);
  if (!file) reject(path, fmt::format("the file cannot be opened: {}", std::strerror(errno)), "check its permissions");
  std::string bytes;
  // Pipes and devices have no size: read in pieces, never more than the limit.
  std::string piece(std::size_t{1} << 20, '\0');
  while (file.read(piece.data(), static_cast<std::streamsize>(piece.size())) || file.gcount() > 0) {
    bytes.append(piece.data(), static_cast<std::size_t>(file.gcount()));
    if (bytes.size() > limit) reject(path, fmt::format("the file is longer than {} bytes", limit));
  }
  if (file.bad()) reject(path, "the file cannot be read to its end");
  if (bytes.empty()) reject(path, "the file is empty");
  return bytes;
}

std::string lower_extension(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

}  // namespace phiz
