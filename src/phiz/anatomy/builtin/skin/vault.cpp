// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "phiz/anatomy/builtin/skin/cranium.h"
#include "phiz/anatomy/builtin/skin/form.h"

namespace phiz {
namespace {

constexpr int first_behind = 14;         // the column behind the ear
constexpr double vault_firmness = 0.03;  // large and round: fairness counts more than the places

/// Where a row runs behind the ear: its angle and height there, and its height at the back midline.
struct Behind {
  int j;
  double angle, y, y_back;
};
constexpr Behind rows_behind[] = {
    {3, 112, -90, -97},   {4, 106, -70, -76},    {5, 98, -53, -57},    {6, 92, -44, -39},   {7, 88, -37, -24},
    {8, 86, -31, -11},    {9, 84, -26, 1},       {10, 83, -20.5, 11},  {11, 84, -11.6, 20}, {12, 88, -4.8, 30},
    {13, 92, 2.8, 41},    {20, 97, 11.5, 53},    {21, 103, 28, 64},    {22, 105, 46, 76},   {23, 110, 65, 88.5},
    {24, 114, 84, 100.5}, {25, 119, 104, 112.5}, {26, 124, 121, 123.5}};

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
      form.place(topology.sheet(i, row.j), cranium_point(row.angle + (180 - row.angle) * t, y), vault_firmness);
    }
}

void place_vault(SkinForm& form) {
  const SkinTopology& topology = skin_topology();
  for (int j = 21; j <= SkinTopology::rows; ++j)
    for (int i = j < 24 ? 12 : 0; i < first_behind; ++i) {
      const int v = topology.sheet(i, j);
      const double share = j == 24 && i < 10 ? 0.5 : 1.0;  // the forehead keeps some of its own form
      form.place(v, form.at(v) + share * (cranium_under(form.at(v)) - form.at(v)), vault_firmness);
    }
  const auto crown = [&](int u, int v) { return topology.crown(u, v); };
  for (int u = 0; u < SkinTopology::crown_columns; ++u)
    for (int v = 1; v < SkinTopology::crown_rows; ++v) {
      const Vector3d p = coons(form, crown, u, SkinTopology::crown_columns, v, SkinTopology::crown_rows);
      form.place(crown(u, v), {p.x(), vault_height(p.x(), p.z()), p.z()}, vault_firmness);
    }
}

}  // namespace phiz
