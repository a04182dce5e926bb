// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/open/lash_cards.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "phiz/anatomy/open/face_kit_layout.h"
#include "phiz/core/error.h"

namespace phiz {

namespace {

using Edge = std::pair<int, int>;

/// Row of the nearest vertex of the skin.
int nearest_on_skin(const FaceKit& kit, int vertex, double* distance = nullptr) {
  Eigen::Index row = 0;
  const double square = (kit.neutral.V.topRows(face_kit::skin_vertices.end).rowwise() - kit.neutral.V.row(vertex))
                            .rowwise()
                            .squaredNorm()
                            .minCoeff(&row);
  if (distance != nullptr) *distance = std::sqrt(square);
  return static_cast<int>(row);
}

/// The sides of a patch of quads, between its corners: the vertices that only one quad has.
std::vector<std::vector<int>> sides_of(const std::map<Edge, Edge>& across) {
  std::map<int, int> next, quads;
  for (const auto& [edge, opposite] : across) {
    ++quads[edge.first];
    if (!across.contains({edge.second, edge.first})) next[edge.first] = edge.second;
  }
  std::vector<std::vector<int>> sides;
  for (const auto& [corner, after] : next) {
    if (quads[corner] != 1) continue;
    std::vector<int> side{corner};
    while (side.size() <= next.size() && next.contains(side.back())) {
      side.push_back(next.at(side.back()));
      if (quads[side.back()] == 1) break;
    }
    sides.push_back(std::move(side));
  }
  return sides;
}

LashCard card_of(const FaceKit& kit, int first_face) {
  const MatrixX3d& V = kit.neutral.V;
  std::map<Edge, Edge> across;  // per edge of a quad, as it runs there: the opposite one, the same way
  for (int f = first_face; f < first_face + face_kit::faces_per_lash_card; ++f) {
    const std::vector<int>& quad = kit.neutral.faces[static_cast<std::size_t>(f)];
    if (quad.size() != 4) reject("face kit", "face " + std::to_string(f) + " of the lashes is no quad");
    for (std::size_t k = 0; k < 4; ++k) across[{quad[k], quad[(k + 1) % 4]}] = {quad[(k + 3) % 4], quad[(k + 2) % 4]};
  }
  std::vector<int> line;
  double nearest = 1;
  for (const std::vector<int>& side : sides_of(across)) {
    double farthest = 0;
    for (const int v : side) {
      double distance = 0;
      nearest_on_skin(kit, v, &distance);
      farthest = std::max(farthest, distance);
    }
    if (farthest < nearest) {
      nearest = farthest;
      line = side;
    }
  }
  LashCard card;
  while (line.size() > 1) {
    card.lines.push_back(line);
    std::vector<int> after;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      const auto opposite = across.find({line[i], line[i + 1]});
      if (opposite == across.end()) break;
      if (i == 0) after.push_back(opposite->second.first);
      after.push_back(opposite->second.second);
    }
    if (after.size() != line.size()) break;
    line = std::move(after);
  }
  constexpr double off = 0.002;  // metres
  if (card.lines.size() < 2 || nearest > off) reject("face kit", "its eyelashes do not spring from the lids");
  const std::vector<int>& roots = card.lines.front();
  if (std::abs(V(roots.front(), 0)) > std::abs(V(roots.back(), 0)))
    for (std::vector<int>& reversed : card.lines) std::reverse(reversed.begin(), reversed.end());
  return card;
}

}  // namespace

std::vector<LashCard> lash_cards(const FaceKit& kit, bool left) {
  const face_kit::Range& faces = left ? face_kit::left_lash_faces : face_kit::right_lash_faces;
  std::vector<LashCard> cards;
  for (int i = 0; i < face_kit::lash_cards; ++i) {
    cards.push_back(card_of(kit, faces.first + i * face_kit::faces_per_lash_card));
    cards.back().upper = i < face_kit::lash_cards / 2;
  }
  return cards;
}

std::vector<int> lash_roots(const FaceKit& kit, bool left, bool upper) {
  std::vector<int> rows;
  for (const LashCard& card : lash_cards(kit, left))
    if (card.upper == upper)
      for (const int v : card.lines.front()) rows.push_back(nearest_on_skin(kit, v));
  std::sort(rows.begin(), rows.end());
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  return rows;
}

}  // namespace phiz
