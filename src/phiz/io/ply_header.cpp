// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/io/ply_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "phiz/core/error.h"
#include "phiz/io/text_scanner.h"

namespace phiz {

namespace {

struct TypeName {
  std::string_view name;
  PlyType type;
};
constexpr std::array<TypeName, 16> type_names = {{{"char", PlyType::int8},
                                                  {"uchar", PlyType::uint8},
                                                  {"short", PlyType::int16},
                                                  {"ushort", PlyType::uint16},
                                                  {"int", PlyType::int32},
                                                  {"uint", PlyType::uint32},
                                                  {"float", PlyType::float32},
                                                  {"double", PlyType::float64},
                                                  {"int8", PlyType::int8},
                                                  {"uint8", PlyType::uint8},
                                                  {"int16", PlyType::int16},
                                                  {"uint16", PlyType::uint16},
                                                  {"int32", PlyType::int32},
                                                  {"uint32", PlyType::uint32},
                                                  {"float32", PlyType::float32},
                                                  {"float64", PlyType::float64}}};

constexpr std::size_t most_properties = 256;
constexpr std::size_t most_elements = 64;

PlyType type_of(std::string_view name, const std::string& where) {
  for (const TypeName& t : type_names) {
    if (t.name == name) return t.type;
  }
  reject(where, "unknown property type " + quoted_word(name));
}

PlyProperty parse_property(const std::vector<std::string_view>& words, const std::string& where) {
  PlyProperty property;
  property.list = words.size() > 1 && words[1] == "list";
  if (words.size() != (property.list ? 5u : 3u)) {
    reject(where, "expected 'property TYPE NAME' or 'property list TYPE TYPE NAME'");
  }
  if (property.list) {
    property.count_type = type_of(words[2], where);
    if (property.count_type >= PlyType::float32) reject(where, "the length of a list must be an integer type");
  }
  property.type = type_of(words[property.list ? 3 : 1], where);
  property.name = words.back();
  return property;
}

/// The least number of bytes that one element takes.
std::size_t least_bytes(const PlyElement& element, bool ascii) {
  std::size_t bytes = 0;
  for (const PlyProperty& p : element.properties) bytes += ascii ? 2 : size_of(p.list ? p.count_type : p.type);
  return bytes;
}

void require_room(const PlyHeader& header, const std::string& where) {
  std::size_t needed = 0;
  for (const PlyElement& element : header.elements) {
    const std::size_t each = least_bytes(element, header.ascii);
    // The last number of an ascii file needs no separator after it.
    const std::size_t room = header.body.size() + 1;
    if (each > 0 && element.count > (room - std::min(needed, room)) / each) {
      reject(where,
             fmt::format("the header claims {} '{}' elements, but only {} bytes follow", element.count, element.name,
                         header.body.size()),
             "the file is cut off or its header is wrong");
    }
    needed += each * (each > 0 ? element.count : 0);
  }
}

}  // namespace

std::size_t size_of(PlyType type) {
  switch (type) {
    case PlyType::int8:
    case PlyType::uint8:
      return 1;
    case PlyType::int16:
    case PlyType::uint16:
      return 2;
    case PlyType::int32:
    case PlyType::uint32:
    case PlyType::float32:
      return 4;
    case PlyType::float64:
      return 8;
  }
  return 8;
}

PlyHeader parse_ply_header(std::string_view bytes, const std::string& where) {
  PlyHeader header;
  bool format_known = false;
  LineScanner lines(bytes);
  std::vector<std::string_view> words;
  if (!lines.next() || trimmed(lines.line()) != "ply") reject(where + ":1", "not a PLY file: it must begin with 'ply'");
  while (lines.next()) {
    const std::string here = fmt::format("{}:{}", where, lines.number());
    split_words(lines.line(), words);
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "end_header") {
      if (!format_known) reject(here, "the header has no 'format' line");
      header.body = lines.rest();
      header.body_line = lines.number() + 1;
      require_room(header, where);
      return header;
    }
    if (words[0] == "format") {
      const std::string_view name = words.size() > 1 ? words[1] : std::string_view{};
      header.ascii = name == "ascii";
      header.order = name == "binary_big_endian" ? std::endian::big : std::endian::little;
      format_known = header.ascii || name == "binary_big_endian" || name == "binary_little_endian";
      if (!format_known) {
        reject(here,
               "unknown format " + quoted_word(name) + ", expected ascii, binary_little_endian or binary_big_endian");
      }
    } else if (words[0] == "element") {
      const auto count = words.size() == 3 ? parse_integer(words[2]) : std::optional<long long>{};
      if (!count || *count < 0) reject(here, "expected 'element NAME COUNT' with a count of 0 or more");
      if (header.elements.size() == most_elements) reject(here, "too many kinds of elements");
      for (const PlyElement& e : header.elements) {
        if (e.name == words[1]) reject(here, "element " + quoted_word(words[1]) + " is defined twice");
      }
      header.elements.push_back({std::string(words[1]), static_cast<std::size_t>(*count), {}});
    } else if (words[0] == "property") {
      if (header.elements.empty()) reject(here, "a property before the first element");
      auto& properties = header.elements.back().properties;
      if (properties.size() == most_properties) reject(here, "too many properties");
      properties.push_back(parse_property(words, here));
    } else {
      reject(here, "unknown header line " + quoted_word(words[0]));
    }
  }
  reject(where, "the header has no 'end_header' line", "the file is cut off");
}

}  // namespace phiz
