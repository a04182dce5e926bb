// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/io/stl.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>

#include "phiz/core/error.h"
#include "phiz/geometry/surface.h"
#include "phiz/geometry/validate.h"
#include "phiz/io/byte_order.h"
#include "phiz/io/file_bytes.h"
#include "phiz/io/output_file.h"
#include "phiz/io/text_scanner.h"

namespace phiz {

namespace {

constexpr std::size_t header_bytes = 84;    // 80 bytes of text and the number of triangles
constexpr std::size_t triangle_bytes = 50;  // normal, three corners, two bytes of attributes

using Position = std::array<double, 3>;

struct PositionHash {
  std::size_t operator()(const Position& p) const {
    std::uint64_t h = 0x9E3779B97F4A7C15u;
    for (const double x : p) h = (h ^ std::bit_cast<std::uint64_t>(x)) * 0xFF51AFD7ED558CCDu, h ^= h >> 32;
    return static_cast<std::size_t>(h);
  }
};

/// Collects corners and gives equal positions one vertex.
class Welder {
 public:
  void corner(Position p) {
    for (double& x : p) x += 0.0;  // -0 and 0 are the same place
    const auto [place, added] = rows_.try_emplace(p, static_cast<int>(positions_.size()));
    if (added) positions_.push_back(p);
    triangle_[count_++] = place->second;
    if (count_ < 3) return;
    count_ = 0;
    const auto& [a, b, c] = triangle_;
    if (a != b && b != c && c != a) triangles_.push_back(triangle_);
  }
  bool between_triangles() const { return count_ == 0; }
  TriangleMesh mesh(const std::string& where) const {
    if (triangles_.empty()) reject(where, "no triangles with area found");
    TriangleMesh result;
    result.V.resize(static_cast<Eigen::Index>(positions_.size()), 3);
    result.F.resize(static_cast<Eigen::Index>(triangles_.size()), 3);
    for (std::size_t i = 0; i < positions_.size(); ++i) {
      result.V.row(static_cast<Eigen::Index>(i)) << positions_[i][0], positions_[i][1], positions_[i][2];
    }
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      result.F.row(static_cast<Eigen::Index>(i)) << triangles_[i][0], triangles_[i][1], triangles_[i][2];
    }
    return result;
  }

 private:
  std::unordered_map<Position, int, PositionHash> rows_;
  std::vector<Position> positions_;
  std::vector<std::array<int, 3>> triangles_;
  std::array<int, 3> triangle_{};
  int count_ = 0;
};

TriangleMesh parse_binary(std::string_view bytes, std::size_t count, const std::string& where) {
  Welder welder;
  for (std::size_t t = 0; t < count; ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      Position p;
      for (std::size_t k = 0; k < 3; ++k) {
        p[k] = load_number<float>(bytes, header_bytes + t * triangle_bytes + 12 + 12 * c + 4 * k);
        if (!std::isfinite(p[k])) reject(where, fmt::format("triangle {} has a coordinate that is not finite", t));
      }
      welder.corner(p);
    }
  }
  return welder.mesh(where);
}

TriangleMesh parse_ascii(std::string_view text, const std::string& where) {
  Welder welder;
  LineScanner lines(text);
  std::vector<std::string_view> words;
  bool in_facet = false, ended = false;
  while (lines.next()) {
    split_words(lines.line(), words);
    if (words.empty()) continue;
    const auto here = [&] { return fmt::format("{}:{}", where, lines.number()); };
    if (words[0] == "vertex") {
      if (words.size() != 4) reject(here(), fmt::format("'vertex' has {} numbers, expected 3", words.size() - 1));
      Position p;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto value = parse_number(words[k + 1]);
        if (!value || !std::isfinite(*value)) {
          reject(here(), fmt::format("expected a finite number, found {}", quoted_word(words[k + 1])));
        }
        p[k] = *value;
      }
      welder.corner(p);
    } else if (words[0] == "endloop") {
      if (!welder.between_triangles()) reject(here(), "a loop whose number of vertices is not three");
    } else if (words[0] == "facet" || words[0] == "endfacet") {
      in_facet = words[0] == "facet";
    } else if (words[0] == "solid" || words[0] == "endsolid") {
      ended = words[0] == "endsolid";
    } else if (words[0] != "outer") {
      reject(here(), fmt::format("expected an STL keyword, found {}", quoted_word(words[0])));
    }
  }
  if (!welder.between_triangles() || in_facet) reject(where, "the file ends inside a triangle", "it may be cut off");
  if (!ended) reject(where, "the file ends without 'endsolid'", "it may be cut off");
  return welder.mesh(where);
}

TriangleMesh parse_either(std::string_view bytes, const std::string& where) {
  // Binary files may begin with "solid" too; the size decides.
  if (bytes.size() >= header_bytes) {
    const std::size_t count = load_number<std::uint32_t>(bytes, 80);
    if (bytes.size() == header_bytes + count * triangle_bytes) return parse_binary(bytes, count, where);
    if (!bytes.starts_with("solid")) {
      reject(where,
             fmt::format("the header says {} triangles, which takes {} bytes, but the file has {}", count,
                         header_bytes + count * triangle_bytes, bytes.size()),
             "the file is cut off or not STL");
    }
  }
  if (!trimmed(bytes).starts_with("solid")) reject(where, "not an STL file: neither binary nor beginning with 'solid'");
  return parse_ascii(bytes, where);
}

}  // namespace

TriangleMesh parse_stl(std::string_view bytes, const std::string& where) {
  TriangleMesh mesh = parse_either(bytes, where);
  validate(mesh, where);
  return mesh;
}

TriangleMesh read_stl(const std::string& path) {
  return parse_stl(read_bytes(path), path);
}

void write_stl(const std::string& path, const TriangleMesh& mesh, StlEncoding encoding) {
  if (mesh.F.rows() > static_cast<Eigen::Index>(std::numeric_limits<std::uint32_t>::max())) {
    fail("cannot write " + path + ": STL holds at most 4294967295 triangles");
  }
  const MatrixX3d normals = triangle_normals(mesh.V, mesh.F);
  OutputFile file(path);
  std::string bytes;
  if (encoding == StlEncoding::binary) {
    bytes = "binary STL, metres";
    bytes.resize(80, ' ');
    append_number(bytes, static_cast<std::uint32_t>(mesh.F.rows()));
  } else {
    bytes = "solid phiz\n";
  }
  for (Eigen::Index f = 0; f < mesh.F.rows(); ++f) {
    const Vector3d n = normals.row(f);
    if (encoding == StlEncoding::binary) {
      for (int k = 0; k < 3; ++k) append_number(bytes, static_cast<float>(n[k]));
      for (int c = 0; c < 3; ++c) {
        for (int k = 0; k < 3; ++k) append_number(bytes, static_cast<float>(mesh.V(mesh.F(f, c), k)));
      }
      append_number(bytes, std::uint16_t{0});
    } else {
      bytes += fmt::format("facet normal {:.6g} {:.6g} {:.6g}\nouter loop\n", n[0], n[1], n[2]);
      for (int c = 0; c < 3; ++c) {
        const Vector3d p = mesh.V.row(mesh.F(f, c));
        bytes += fmt::format("vertex {:.9g} {:.9g} {:.9g}\n", p[0], p[1], p[2]);
      }
      bytes += "endloop\nendfacet\n";
    }
    if (bytes.size() > (std::size_t{1} << 20)) {
      file.write(bytes);
      bytes.clear();
    }
  }
  if (encoding == StlEncoding::ascii) bytes += "endsolid phiz\n";
  file.write(bytes);
  file.commit();
}

}  // namespace phiz
