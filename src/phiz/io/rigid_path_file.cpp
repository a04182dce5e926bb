// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/io/rigid_path_file.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "phiz/core/error.h"
#include "phiz/io/csv_reader.h"
#include "phiz/io/file_bytes.h"
#include "phiz/io/text_scanner.h"

namespace phiz {

namespace {

constexpr std::array<std::string_view, 8> names = {"time", "x", "y", "z", "qw", "qx", "qy", "qz"};
constexpr std::size_t without_rotation = 4;

}  // namespace

RigidPath parse_rigid_path(std::string_view text, const std::string& where) {
  CsvReader table(text, where);
  const char* const mend = "the first line must be time,x,y,z or time,x,y,z,qw,qx,qy,qz";
  std::array<int, names.size()> column;
  column.fill(-1);
  for (std::size_t c = 0; c < table.header().size(); ++c) {
    const std::string name = lowered(trimmed(table.header()[c]));
    const auto known = std::find(names.begin(), names.end(), name);
    if (known == names.end()) reject(table.header_place(), "unknown column " + quoted_word(name), mend);
    int& place = column[static_cast<std::size_t>(known - names.begin())];
    if (place >= 0) reject(table.header_place(), "column " + quoted_word(name) + " comes twice", mend);
    place = static_cast<int>(c);
  }
  const bool turns = std::any_of(column.begin() + without_rotation, column.end(), [](int c) { return c >= 0; });
  const std::size_t needed = turns ? names.size() : without_rotation;
  for (std::size_t k = 0; k < needed; ++k)
    if (column[k] < 0) reject(table.header_place(), "column " + std::string(names[k]) + " is missing", mend);

  RigidPath path;
  while (table.next()) {
    table.require_full_row();
    const std::string here = where + ":" + std::to_string(table.line());
    std::array<double, names.size()> value{0, 0, 0, 0, 1, 0, 0, 0};
    for (std::size_t k = 0; k < needed; ++k) {
      const std::string& word = table.fields()[static_cast<std::size_t>(column[k])];
      const auto number = parse_number(trimmed(word));
      if (!number || !std::isfinite(*number))
        reject(here, std::string(names[k]) + " is " + quoted_word(word) + ", not a finite number");
      value[k] = *number;
    }
    if (!path.time.empty() && !(value[0] > path.time.back()))
      reject(here, "its time is not later than that of the row before");
    const Eigen::Quaterniond turn(value[4], value[5], value[6], value[7]);
    if (!(turn.norm() > 1e-3) || !(turn.norm() < 1e3))
      reject(here, "its quaternion is of length " + std::to_string(turn.norm()) + "; expected 1");
    Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
    place.linear() = turn.normalized().toRotationMatrix();
    place.translation() = Vector3d(value[1], value[2], value[3]);
    path.time.push_back(value[0]);
    path.places.push_back(place);
  }
  if (path.time.empty()) reject(where, "it has no rows", mend);
  validate(path, where);
  return path;
}

RigidPath read_rigid_path(const std::string& path) {
  return parse_rigid_path(read_bytes(path), path);
}

}  // namespace phiz
