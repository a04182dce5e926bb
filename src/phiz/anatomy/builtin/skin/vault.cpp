// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "phiz/anatomy/builtin/skin/cranium.h"
#include "phiz/anatomy/builtin/skin/form.h"

namespace phiz {
namespace {

constexpr int first_behind = 14;  // the column behind the ear

/// Where a row runs behind the ear: its angle and height there, and its height at the back midline.
struct Behind {
  int j;
  double angle, y, y_back;
};
constexpr Behind rows_behind[] = {{3, 122, -90, -97}, {4, 116, -70, -76},   {5, 108, -53, -57},  {6, 103, -44, -39},
                                  {7, 100, -37, -24}, {8, 98, -31, -11},    {9, 96, -26, 1},     {10, 95, -20.5, 11},
                                  {11, 97, -14, 20},  {12, 105, -4.5, 30},  {13, 110, 6, 41},    {20, 112, 20, 53},
                                  {21, 110, 33, 64},  {22, 113, 47, 76},    {23, 115, 65, 88.5}, {24, 117, 84, 100.5},
                                  {25, 120, 104, 112.5}, {26, 124, 121, 123.5}};

}  // namespace

Vector3d coons(const SkinForm& form, const std::function<int(int, int)>& vertex, int u, int p, int v, int q) {
  const auto at = [&](int a, int b) { return form.at(vertex(a, b)); };
  const double s = static_cast<double>(u) / p, t = static_cast<double>(v) / q;
  const Vector3d midline = (1 - t) * at(0, 0) + t * at(0, q);
  const Vector3d corners =
      (1 - s) * (1 - t) * at(0, 0) + s * (1 - t) * at(p, 0) + (1 - s) * t * at(0, q) + s * t * at(p, q);
  return (1 - s) * midline + s * at(p, v) + (1 - t) * at(u, 0) + t * at(u, q) - corners;
}

void place_back(SkinForm& form) {
  const SkinTopology& topology = skin_topology();
  for (const Behind& row : rows_behind)
    for (int i = first_behind; i <= SkinTopology::columns; ++i) {
      const double t = static_cast<double>(i - first_behind) / (SkinTopology::columns - first_behind);
      const double y = row.y + (row.y_back - row.y) * t * t * (3 - 2 * t);
      form.place(topology.sheet(i, row.j), cranium_point(row.angle + (180 - row.angle) * t, y), 0.3);
    }
}

void place_vault(SkinForm& form) {
  const SkinTopology& topology = skin_topology();
  for (int j = 21; j <= SkinTopology::rows; ++j)
    for (int i = j < 24 ? 12 : 0; i < first_behind; ++i) {
      const int v = topology.sheet(i, j);
      const double share = j == 24 && i < 12 ? 0.5 : 1.0;  // the forehead keeps some of its own form
      form.place(v, form.at(v) + share * (cranium_under(form.at(v)) - form.at(v)), 0.3);
    }
  const auto crown = [&](int u, int v) { return topology.crown(u, v); };
  for (int u = 0; u < SkinTopology::crown_columns; ++u)
    for (int v = 1; v < SkinTopology::crown_rows; ++v) {
      const Vector3d p = coons(form, crown, u, SkinTopology::crown_columns, v, SkinTopology::crown_rows);
      form.place(crown(u, v), {p.x(), vault_height(p.x(), p.z()), p.z()}, 0.3);
    }
}

}  // namespace phiz
