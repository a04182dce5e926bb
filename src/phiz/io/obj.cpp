// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/io/obj.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <unordered_map>

#include "phiz/core/error.h"
#include "phiz/geometry/validate.h"
#include "phiz/io/file_bytes.h"
#include "phiz/io/output_file.h"
#include "phiz/io/polygons.h"
#include "phiz/io/text_scanner.h"

namespace phiz {

namespace {

/// One face corner as written: rows of V and UV from 0, or `none`.
struct Corner {
  int vertex;
  int uv;
};
constexpr int none = -1;

class ObjParser {
 public:
  ObjParser(std::string_view text, const std::string& where) : lines_(text), where_(where) {}

  PolygonMesh parse() {
    while (next_statement()) statement();
    if (vertices_.empty())
      reject(where_, "no vertices found, expected lines like 'v 1.0 2.0 3.0'", "is it an OBJ file?");
    check_ranges();
    return result();
  }

 private:
  std::string here() const { return fmt::format("{}:{}", where_, statement_line_); }

  /// Splits the next line, joined with its continuations, into words_.
  bool next_statement() {
    if (!lines_.next()) return false;
    statement_line_ = lines_.number();
    std::string_view line = lines_.line();
    if (!line.empty() && line.back() == '\\') {
      joined_.clear();
      while (!line.empty() && line.back() == '\\') {
        joined_.append(line.substr(0, line.size() - 1)).push_back(' ');
        line = lines_.next() ? lines_.line() : std::string_view{};
      }
      joined_.append(line);
      line = joined_;
    }
    if (statement_line_ == 1 && line.substr(0, 3) == "\xEF\xBB\xBF") line.remove_prefix(3);
    line = line.substr(0, line.find('#'));
    split_words(line, words_);
    return true;
  }

  void statement() {
    if (words_.empty()) return;
    const std::string_view keyword = words_[0];
    if (keyword == "v") {
      require_words(3);
      for (int i = 1; i <= 3; ++i) vertices_.push_back(number(words_[i]));
    } else if (keyword == "vt") {
      require_words(1);
      uvs_.push_back(number(words_[1]));
      uvs_.push_back(words_.size() > 2 ? number(words_[2]) : 0.0);
    } else if (keyword == "f") {
      face();
    } else if (keyword == "g" || keyword == "o") {
      group();
    }
    if (vertices_.size() / 3 > std::numeric_limits<int>::max() / 4) reject(here(), "too many vertices");
  }

  void require_words(std::size_t count) const {
    if (words_.size() > count) return;
    reject(here(), fmt::format("'{}' has {} numbers, expected {}", words_[0], words_.size() - 1, count));
  }

  double number(std::string_view word) const {
    const auto value = parse_number(word);
    if (!value) reject(here(), fmt::format("expected a number, found {}", quoted_word(word)));
    if (!std::isfinite(*value)) reject(here(), fmt::format("expected a finite number, found {}", quoted_word(word)));
    return *value;
  }

  /// Row from 0 of a one-based or relative index.
  int row(std::string_view word, std::size_t count, std::string_view kind) const {
    const auto index = parse_integer(word);
    if (!index) reject(here(), fmt::format("expected a {} index, found {}", kind, quoted_word(word)));
    if (*index == 0) reject(here(), fmt::format("{} index 0, indices start at 1", kind));
    const auto limit = static_cast<long long>(std::numeric_limits<int>::max());
    const long long value = *index > 0 ? *index - 1 : static_cast<long long>(count) + *index;
    if (value < 0 || value >= limit) {
      reject(here(), fmt::format("{} index {} is out of range, {} {} lines so far", kind, *index, count, kind));
    }
    return static_cast<int>(value);
  }

  Corner corner(std::string_view word) const {
    const std::size_t slash = word.find('/');
    Corner result{row(word.substr(0, slash), vertices_.size() / 3, "vertex"), none};
    if (slash == std::string_view::npos) return result;
    const std::string_view rest = word.substr(slash + 1);
    const std::string_view uv = rest.substr(0, rest.find('/'));
    if (!uv.empty()) result.uv = row(uv, uvs_.size() / 2, "texture coordinate");
    return result;
  }

  void face() {
    if (words_.size() < 4) {
      reject(here(), fmt::format("a face with {} corners, expected at least 3", words_.size() - 1));
    }
    std::vector<int> corners, uv;
    corners.reserve(words_.size() - 1);
    for (std::size_t i = 1; i < words_.size(); ++i) {
      const Corner c = corner(words_[i]);
      corners.push_back(c.vertex);
      if (c.uv != none) uv.push_back(c.uv);
    }
    if (!uv.empty() && uv.size() != corners.size()) {
      reject(here(),
             fmt::format("a face with {} corners of which {} have texture coordinates", corners.size(), uv.size()));
    }
    std::vector<int> sorted = corners;
    std::sort(sorted.begin(), sorted.end());
    const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
    if (twice != sorted.end()) {
      reject(here(), fmt::format("a face uses vertex {} twice", *twice + 1),
             "delete degenerate faces and export again");
    }
    faces_with_uv_ += uv.empty() ? 0 : 1;
    mesh_.faces.push_back(std::move(corners));
    mesh_.face_uvs.push_back(std::move(uv));
    mesh_.face_group.push_back(group_);
    face_lines_.push_back(statement_line_);
  }

  void group() {
    std::string name;
    for (std::size_t i = 1; i < words_.size(); ++i) name.append(i > 1 ? " " : "").append(words_[i]);
    if (name.empty()) name = "default";
    group_ = group_of(name);
  }

  int group_of(const std::string& name) {
    const auto [place, added] = group_rows_.try_emplace(name, static_cast<int>(mesh_.groups.size()));
    if (added) mesh_.groups.push_back(name);
    return place->second;
  }

  /// Faces may refer to vertices that come later, so ranges are checked at the end.
  void check_ranges() const {
    const auto check = [this](const std::vector<int>& rows, std::size_t count, std::size_t face_index,
                              const char* kind) {
      for (const int r : rows) {
        if (static_cast<std::size_t>(r) < count) continue;
        reject(fmt::format("{}:{}", where_, face_lines_[face_index]),
               fmt::format("{} index {} is out of range, the file has {}", kind, r + 1LL, count));
      }
    };
    for (std::size_t i = 0; i < mesh_.faces.size(); ++i) {
      check(mesh_.faces[i], vertices_.size() / 3, i, "vertex");
      check(mesh_.face_uvs[i], uvs_.size() / 2, i, "texture coordinate");
    }
  }

  PolygonMesh result() {
    using Row3 = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
    using Row2 = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;
    mesh_.V = Eigen::Map<const Row3>(vertices_.data(), static_cast<Eigen::Index>(vertices_.size() / 3), 3);
    if (faces_with_uv_ == 0) {
      mesh_.face_uvs.clear();
    } else {
      fill_missing_uvs();
      mesh_.UV = Eigen::Map<const Row2>(uvs_.data(), static_cast<Eigen::Index>(uvs_.size() / 2), 2);
    }
    if (mesh_.groups.empty()) {
      mesh_.face_group.clear();
    } else {
      for (int& g : mesh_.face_group) g = g == none ? group_of("default") : g;
    }
    return std::move(mesh_);
  }

  void fill_missing_uvs() {
    if (faces_with_uv_ == mesh_.faces.size()) return;
    const int origin = static_cast<int>(uvs_.size() / 2);
    uvs_.insert(uvs_.end(), {0.0, 0.0});
    for (std::size_t i = 0; i < mesh_.faces.size(); ++i) {
      if (mesh_.face_uvs[i].empty()) mesh_.face_uvs[i].assign(mesh_.faces[i].size(), origin);
    }
  }

  LineScanner lines_;
  std::string where_;
  int statement_line_ = 0;
  std::string joined_;
  std::vector<std::string_view> words_;
  std::vector<double> vertices_, uvs_;
  std::vector<int> face_lines_;
  std::size_t faces_with_uv_ = 0;
  int group_ = none;
  std::unordered_map<std::string, int> group_rows_;
  PolygonMesh mesh_;
};

/// A name as one OBJ line can hold it.
std::string one_line(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == '\n' || c == '\r' || c == '#' || c == '\\'; }, '_');
  return name.empty() ? "default" : name;
}

}  // namespace

PolygonMesh parse_obj(std::string_view text, const std::string& where) {
  PolygonMesh mesh = ObjParser(text, where).parse();
  validate(mesh, where);
  return mesh;
}

PolygonMesh read_obj(const std::string& path) {
  return parse_obj(read_bytes(path), path);
}

void write_obj(const std::string& path, const PolygonMesh& mesh, const MatrixX3d& normals) {
  OutputFile file(path);
  fmt::memory_buffer text;
  const auto flush = [&file, &text] {
    file.write({text.data(), text.size()});
    text.clear();
  };
  auto out = fmt::appender(text);
  for (Eigen::Index i = 0; i < mesh.V.rows(); ++i) {
    fmt::format_to(out, "v {:.9g} {:.9g} {:.9g}\n", mesh.V(i, 0), mesh.V(i, 1), mesh.V(i, 2));
  }
  const bool with_uv = !mesh.face_uvs.empty();
  const bool with_normals = normals.rows() > 0 && normals.rows() == mesh.V.rows();
  for (Eigen::Index i = 0; with_uv && i < mesh.UV.rows(); ++i) {
    fmt::format_to(out, "vt {:.9g} {:.9g}\n", mesh.UV(i, 0), mesh.UV(i, 1));
  }
  for (Eigen::Index i = 0; with_normals && i < normals.rows(); ++i) {
    fmt::format_to(out, "vn {:.6g} {:.6g} {:.6g}\n", normals(i, 0), normals(i, 1), normals(i, 2));
  }
  flush();
  int group = none;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (!mesh.face_group.empty() && mesh.face_group[f] != group) {
      group = mesh.face_group[f];
      fmt::format_to(out, "g {}\n", one_line(mesh.groups[static_cast<std::size_t>(group)]));
    }
    fmt::format_to(out, "f");
    for (std::size_t c = 0; c < mesh.faces[f].size(); ++c) {
      const int v = mesh.faces[f][c] + 1;
      fmt::format_to(out, " {}", v);
      if (with_uv) fmt::format_to(out, "/{}", mesh.face_uvs[f][c] + 1);
      if (with_normals) fmt::format_to(out, "{}{}", with_uv ? "/" : "//", v);
    }
    fmt::format_to(out, "\n");
    if (text.size() > (std::size_t{1} << 20)) flush();
  }
  flush();
  file.commit();
}

void write_obj(const std::string& path, const TriangleMesh& mesh, const MatrixX3d& normals) {
  write_obj(path, as_polygons(mesh), normals);
}

std::string sequence_name(const std::string& path, int frame) {
  const std::filesystem::path p(path);
  return (p.parent_path() / fmt::format("{}.{:04d}{}", p.stem().string(), frame, p.extension().string())).string();
}

}  // namespace phiz
