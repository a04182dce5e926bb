// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/io/ply.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "phiz/core/error.h"
#include "phiz/geometry/validate.h"
#include "phiz/io/byte_order.h"
#include "phiz/io/file_bytes.h"
#include "phiz/io/output_file.h"
#include "phiz/io/ply_header.h"
#include "phiz/io/polygons.h"
#include "phiz/io/text_scanner.h"

namespace phiz {

namespace {

/// Takes the values of the body one after the other.
class BodyReader {
 public:
  BodyReader(const PlyHeader& header, const std::string& where)
      : header_(header), where_(where), lines_(header.body), line_(header.body_line - 1) {}

  void begin(const PlyElement& element, std::size_t index) {
    element_ = &element;
    index_ = index;
    if (!header_.ascii || element.properties.empty()) return;
    word_ = 0;
    do {
      if (!lines_.next()) reject(here(), "the file ends before this element", "it is cut off");
      ++line_;
      split_words(lines_.line(), words_);
    } while (words_.empty());
  }

  double value(PlyType type) {
    if (header_.ascii) return ascii_value();
    if (size_of(type) > header_.body.size() - offset_)
      reject(here(), "the file ends inside this element", "it is cut off");
    const std::size_t at = offset_;
    offset_ += size_of(type);
    switch (type) {
      case PlyType::int8:
        return load_number<std::int8_t>(header_.body, at, header_.order);
      case PlyType::uint8:
        return load_number<std::uint8_t>(header_.body, at, header_.order);
      case PlyType::int16:
        return load_number<std::int16_t>(header_.body, at, header_.order);
      case PlyType::uint16:
        return load_number<std::uint16_t>(header_.body, at, header_.order);
      case PlyType::int32:
        return load_number<std::int32_t>(header_.body, at, header_.order);
      case PlyType::uint32:
        return load_number<std::uint32_t>(header_.body, at, header_.order);
      case PlyType::float32:
        return load_number<float>(header_.body, at, header_.order);
      case PlyType::float64:
        return load_number<double>(header_.body, at, header_.order);
    }
    return 0;
  }

  /// Values of a list. A length that the rest of the file cannot hold is refused.
  void list(const PlyProperty& property, std::vector<double>& values) {
    const double length = value(property.count_type);
    const std::size_t room =
        header_.ascii ? words_.size() - word_ : (header_.body.size() - offset_) / size_of(property.type);
    if (!(length >= 0) || length > static_cast<double>(room)) {
      reject(here(), fmt::format("list '{}' claims {} values, room for {}", property.name, length, room));
    }
    values.resize(static_cast<std::size_t>(length));
    for (double& v : values) v = value(property.type);
  }

  std::string here() const {
    const std::string item = element_ == nullptr ? "" : fmt::format("{} {}", element_->name, index_);
    return header_.ascii ? fmt::format("{}:{}: {}", where_, line_, item) : fmt::format("{}: {}", where_, item);
  }

 private:
  double ascii_value() {
    if (word_ == words_.size()) reject(here(), fmt::format("{} numbers on the line, expected more", words_.size()));
    const auto number = parse_number(words_[word_]);
    if (!number) reject(here(), "expected a number, found " + quoted_word(words_[word_]));
    ++word_;
    return *number;
  }

  const PlyHeader& header_;
  const std::string& where_;
  LineScanner lines_;
  int line_;
  const PlyElement* element_ = nullptr;
  std::size_t index_ = 0;
  std::size_t offset_ = 0;
  std::vector<std::string_view> words_;
  std::size_t word_ = 0;
};

/// Where a vertex property goes: a column of one of four matrices.
enum Target { position, normal, colour, uv, skipped };
struct Slot {
  Target target = skipped;
  int column = 0;
  double scale = 1;
};

Slot slot_of(const PlyProperty& property) {
  struct Known {
    std::string_view name;
    Slot slot;
  };
  static const std::array<Known, 18> known = {{{"x", {position, 0}},
                                               {"y", {position, 1}},
                                               {"z", {position, 2}},
                                               {"nx", {normal, 0}},
                                               {"ny", {normal, 1}},
                                               {"nz", {normal, 2}},
                                               {"red", {colour, 0}},
                                               {"green", {colour, 1}},
                                               {"blue", {colour, 2}},
                                               {"r", {colour, 0}},
                                               {"g", {colour, 1}},
                                               {"b", {colour, 2}},
                                               {"u", {uv, 0}},
                                               {"v", {uv, 1}},
                                               {"s", {uv, 0}},
                                               {"t", {uv, 1}},
                                               {"texture_u", {uv, 0}},
                                               {"texture_v", {uv, 1}}}};
  if (property.list) return {};
  for (const Known& k : known) {
    if (k.name != property.name) continue;
    Slot slot = k.slot;
    if (slot.target == colour && property.type == PlyType::uint8) slot.scale = 1.0 / 255;
    if (slot.target == colour && property.type == PlyType::uint16) slot.scale = 1.0 / 65535;
    return slot;
  }
  return {};
}

void read_vertices(const PlyElement& element, BodyReader& body, PolygonMesh& mesh, PlyAttributes& attributes) {
  std::vector<Slot> slots;
  std::array<int, 4> found{};
  for (const PlyProperty& p : element.properties) {
    slots.push_back(slot_of(p));
    if (slots.back().target != skipped) found[slots.back().target] |= 1 << slots.back().column;
  }
  if (found[position] != 7) reject(body.here(), "vertices without the properties x, y and z");
  const auto n = static_cast<Eigen::Index>(element.count);
  mesh.V.resize(n, 3);
  if (found[normal] == 7) attributes.normals.resize(n, 3);
  if (found[colour] == 7) attributes.colours.resize(n, 3);
  if (found[uv] == 3) mesh.UV.resize(n, 2);
  std::vector<double> list;
  for (Eigen::Index i = 0; i < n; ++i) {
    body.begin(element, static_cast<std::size_t>(i));
    for (std::size_t k = 0; k < slots.size(); ++k) {
      const PlyProperty& property = element.properties[k];
      if (property.list) {
        body.list(property, list);
        continue;
      }
      const double value = body.value(property.type) * slots[k].scale;
      const int column = slots[k].column;
      if (slots[k].target != skipped && !std::isfinite(value)) {
        reject(body.here(), fmt::format("'{}' is not a finite number", property.name));
      }
      if (slots[k].target == position) mesh.V(i, column) = value;
      if (slots[k].target == normal && attributes.normals.rows() > 0) attributes.normals(i, column) = value;
      if (slots[k].target == colour && attributes.colours.rows() > 0) attributes.colours(i, column) = value;
      if (slots[k].target == uv && mesh.UV.rows() > 0) mesh.UV(i, column) = value;
    }
  }
}

void read_faces(const PlyElement& element, BodyReader& body, PolygonMesh& mesh) {
  std::vector<double> list;
  for (std::size_t f = 0; f < element.count; ++f) {
    body.begin(element, f);
    for (const PlyProperty& property : element.properties) {
      if (!property.list) {
        body.value(property.type);
        continue;
      }
      body.list(property, list);
      if (property.name != "vertex_indices" && property.name != "vertex_index") continue;
      std::vector<int> corners;
      for (const double row : list) {
        if (!(row >= 0) || row > std::numeric_limits<int>::max() || row != std::floor(row)) {
          reject(body.here(), fmt::format("vertex index {} is not a row of the vertices", row));
        }
        corners.push_back(static_cast<int>(row));
      }
      mesh.faces.push_back(std::move(corners));
    }
  }
}

void skip_element(const PlyElement& element, BodyReader& body) {
  if (element.properties.empty()) return;
  std::vector<double> list;
  for (std::size_t i = 0; i < element.count; ++i) {
    body.begin(element, i);
    for (const PlyProperty& property : element.properties) {
      if (property.list) {
        body.list(property, list);
      } else {
        body.value(property.type);
      }
    }
  }
}

}  // namespace

PolygonMesh parse_ply(std::string_view bytes, const std::string& where, PlyAttributes* attributes) {
  const PlyHeader header = parse_ply_header(bytes, where);
  BodyReader body(header, where);
  PolygonMesh mesh;
  PlyAttributes found;
  for (const PlyElement& element : header.elements) {
    if (element.name == "vertex") {
      read_vertices(element, body, mesh, found);
    } else if (element.name == "face") {
      read_faces(element, body, mesh);
    } else {
      skip_element(element, body);
    }
  }
  if (mesh.V.rows() == 0) reject(where, "the file has no vertices");
  if (mesh.UV.rows() > 0) mesh.face_uvs = mesh.faces;
  if (mesh.faces.empty()) mesh.UV.resize(0, 2);
  validate(mesh, where);
  if (attributes != nullptr) *attributes = std::move(found);
  return mesh;
}

PolygonMesh read_ply(const std::string& path, PlyAttributes* attributes) {
  return parse_ply(read_bytes(path), path, attributes);
}

void write_ply(const std::string& path, const PolygonMesh& mesh, const PlyAttributes& attributes,
               PlyEncoding encoding) {
  const bool ascii = encoding == PlyEncoding::ascii;
  const std::endian order = encoding == PlyEncoding::binary_big_endian ? std::endian::big : std::endian::little;
  const bool with_normals = attributes.normals.rows() == mesh.V.rows();
  const bool with_colours = attributes.colours.rows() == mesh.V.rows();
  const bool with_uv = mesh.UV.rows() == mesh.V.rows() && mesh.face_uvs == mesh.faces;
  std::string bytes = "ply\nformat ";
  bytes += ascii ? "ascii" : order == std::endian::big ? "binary_big_endian" : "binary_little_endian";
  bytes += fmt::format(" 1.0\ncomment metres\nelement vertex {}\n", mesh.V.rows());
  for (const char* name : {"x", "y", "z"}) bytes += fmt::format("property double {}\n", name);
  if (with_normals) bytes += "property float nx\nproperty float ny\nproperty float nz\n";
  if (with_uv) bytes += "property float u\nproperty float v\n";
  if (with_colours) bytes += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  bytes += fmt::format("element face {}\nproperty list uint int vertex_indices\nend_header\n", mesh.faces.size());

  OutputFile file(path);
  const auto flush_when_long = [&] {
    if (bytes.size() < (std::size_t{1} << 20)) return;
    file.write(bytes);
    bytes.clear();
  };
  const auto put = [&]<class Number>(Number value) {
    if (ascii) {
      bytes += fmt::format("{} ", value);
    } else {
      append_number(bytes, value, order);
    }
  };
  for (Eigen::Index i = 0; i < mesh.V.rows(); ++i) {
    for (int k = 0; k < 3; ++k) put(mesh.V(i, k));
    for (int k = 0; with_normals && k < 3; ++k) put(static_cast<float>(attributes.normals(i, k)));
    for (int k = 0; with_uv && k < 2; ++k) put(static_cast<float>(mesh.UV(i, k)));
    for (int k = 0; with_colours && k < 3; ++k) {
      put(static_cast<std::uint8_t>(std::lround(std::clamp(attributes.colours(i, k), 0.0, 1.0) * 255)));
    }
    if (ascii) bytes += '\n';
    flush_when_long();
  }
  for (const auto& face : mesh.faces) {
    put(static_cast<std::uint32_t>(face.size()));
    for (const int v : face) put(static_cast<std::int32_t>(v));
    if (ascii) bytes += '\n';
    flush_when_long();
  }
  file.write(bytes);
  file.commit();
}

void write_ply(const std::string& path, const TriangleMesh& mesh) {
  write_ply(path, as_polygons(mesh));
}

}  // namespace phiz
