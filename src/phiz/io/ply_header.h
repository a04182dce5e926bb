// SPDX-License-Identifier: GPL-3.0-or-later
/// The header of a PLY file: private to the reader.
#pragma once

#include <bit>
#include <string>
#include <string_view>
#include <vector>

namespace phiz {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// Bytes of one value in a binary file.
std::size_t size_of(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;
  bool list = false;
  PlyType count_type = PlyType::uint8;  ///< of the length of a list
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  bool ascii = false;
  std::endian order = std::endian::little;
  std::vector<PlyElement> elements;
  std::string_view body;  ///< what follows the header
  int body_line = 1;      ///< number of the first line of the body
};

/// Throws phiz::Error(bad_input) with the line; refuses element counts that the body is too short for.
PlyHeader parse_ply_header(std::string_view bytes, const std::string& where);

}  // namespace phiz
