// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/elasticity/contact.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "phiz/core/error.h"
#include "phiz/core/parallel.h"
#include "phiz/elasticity/obstacle.h"

namespace phiz {

namespace {

/// A vertex that is checked against one obstacle, and what its last search allows us to skip.
struct Watch {
  int vertex = -1;
  int obstacle = -1;
  int own_patch = -1;
  int pair = -1;
  int hint = -1;  ///< the triangle that was closest in the last search ...
  bool known = false, searched = false;
  double clear = 0;                     ///< ... no contact was nearer than this, if known ...
  std::vector<SignedContact> contacts;  ///< ... and these were found ...
  Vector3d at;                          ///< ... when the vertex was here
  double travel = 0;                    ///< ... and the obstacle had travelled so far
};

constexpr double search_reach = 2.5e-3;  ///< beyond the margin; a longer search is seldom of use for the next call
constexpr double hollow_reach = 3e-4;    ///< how near a second face must be to hold a vertex in a hollow, metres
/// A penetrating vertex that faces as its obstacle does (cosine above `same_side`) has come through from behind or
/// belongs to the same skin past the seam, unless it is no deeper than `shallow` and its way over the seam is long.
constexpr double same_side = 0.5;
constexpr double shallow = 3e-4, long_way = 5e-3;  // metres
/// A vertex at an angle t behind a face has a way of cot(t/2) times its depth over the seam: with less than this it has
/// not passed through the closed seam, but the seam has opened by more than three quarters of a turn.
constexpr double least_detour = 2;

}  // namespace

struct ContactScene::State {
  Eigen::Index vertex_count = 0;
  ContactOptions options;
  std::vector<Obstacle> obstacles;
  std::vector<Watch> watches;
  std::vector<std::vector<int>> seams;  ///< per pair: edges of the obstacle that the vertices' own patch shares
  int pairs = 0;
  int left_out = 0;

  /// Whether the closest point to a watched vertex at p is a contact: not on the rim of a patch, not pushed through
  /// from behind, not beyond a seam that has opened past the plane of the face.
  bool is_contact(const Watch& watch, const Vector3d& p, const std::optional<SignedContact>& closest) const {
    if (!closest || closest->on_rim || closest->gap < -options.depth_limit) return false;
    if (closest->gap >= 0 || watch.own_patch < 0) return true;
    const double depth = -closest->gap;
    const double way = obstacle_of(watch).way_over(seams[static_cast<std::size_t>(watch.pair)], p, *closest);
    if (way < least_detour * depth) return false;
    const Vector3d facing = obstacles[static_cast<std::size_t>(watch.own_patch)].normal_at(watch.vertex);
    return facing.dot(closest->normal) <= same_side || (depth < shallow && way > long_way);
  }

  const Obstacle& obstacle_of(const Watch& watch) const { return obstacles[static_cast<std::size_t>(watch.obstacle)]; }

  /// How far vertex and obstacle may have come since the last search.
  double way_since_search(const Watch& watch, const Vector3d& p) const {
    return (p - watch.at).norm() + obstacle_of(watch).travel() - watch.travel;
  }

  /// Lower bound of the distance to the obstacle by what its last search found.
  double clearance(const Watch& watch, const Vector3d& p) const {
    return watch.known ? watch.clear - way_since_search(watch, p) : 0;
  }

  void search(Watch& watch, const Vector3d& p) const;
};

ContactScene::ContactScene(Eigen::Index vertex_count, const ContactOptions& options)
    : state_(std::make_unique<State>()) {
  if (!(options.margin > 0) || !(options.depth_limit > 0))
    reject("contact options", "margin and depth limit must be positive");
  state_->vertex_count = vertex_count;
  state_->options = options;
}

ContactScene::~ContactScene() = default;
ContactScene::ContactScene(ContactScene&&) noexcept = default;
ContactScene& ContactScene::operator=(ContactScene&&) noexcept = default;

int ContactScene::add_patch(const MatrixX3d& rest, const MatrixX3i& triangles) {
  state_->obstacles.push_back(Obstacle::patch(rest, triangles));
  return static_cast<int>(state_->obstacles.size()) - 1;
}

int ContactScene::add_rigid(const TriangleMesh& mesh) {
  state_->obstacles.push_back(Obstacle::rigid(mesh));
  return static_cast<int>(state_->obstacles.size()) - 1;
}

void ContactScene::add_pair(const VectorXi& vertices, int obstacle, int own_patch, const MatrixX3d& rest) {
  const auto count = static_cast<int>(state_->obstacles.size());
  if (obstacle < 0 || obstacle >= count || own_patch >= count)
    reject("contact pair", "names an obstacle that does not exist");
  state_->seams.emplace_back();
  if (own_patch >= 0)
    state_->seams.back() = state_->obstacles[static_cast<std::size_t>(obstacle)].shared_edges(
        state_->obstacles[static_cast<std::size_t>(own_patch)]);
  for (const int v : vertices) {
    if (v < 0 || v >= state_->vertex_count) reject("contact pair", "names a vertex that does not exist");
    if (state_->obstacles[static_cast<std::size_t>(obstacle)].has_vertex(v)) continue;  // where two patches meet
    Watch watch;
    watch.vertex = v;
    watch.obstacle = obstacle;
    watch.own_patch = own_patch;
    watch.pair = state_->pairs;
    const auto now =
        state_->obstacles[static_cast<std::size_t>(obstacle)].closest(rest.row(v), state_->options.depth_limit);
    if (state_->is_contact(watch, rest.row(v), now) && now->gap < 0) {
      ++state_->left_out;
      continue;
    }
    state_->watches.push_back(watch);
  }
  ++state_->pairs;
}

void ContactScene::place(int obstacle, const Eigen::Isometry3d& transform) {
  state_->obstacles[static_cast<std::size_t>(obstacle)].place(transform);
}

VectorXi ContactScene::candidates() const {
  std::vector<int> all;
  for (const Watch& watch : state_->watches) {
    all.push_back(watch.vertex);
    const auto& patch = state_->obstacles[static_cast<std::size_t>(watch.obstacle)].vertices();
    if (&watch == state_->watches.data() || (&watch)[-1].obstacle != watch.obstacle)
      all.insert(all.end(), patch.begin(), patch.end());
  }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return Eigen::Map<const VectorXi>(all.data(), static_cast<Eigen::Index>(all.size()));
}

/// Finds the contacts of a watched vertex that is at p.
void ContactScene::State::search(Watch& watch, const Vector3d& p) const {
  const double reach = options.margin + search_reach;
  const Obstacle& obstacle = obstacle_of(watch);
  const std::optional<SignedContact> nearest = obstacle.closest(p, reach, watch.hint);
  watch.hint = nearest ? nearest->triangle : -1;
  watch.contacts.clear();
  if (is_contact(watch, p, nearest) && nearest->gap <= options.margin) {
    watch.contacts.push_back(*nearest);
    if (nearest->gap < hollow_reach)
      for (const SignedContact& second : obstacle.beside(p, *nearest, hollow_reach + std::abs(nearest->gap)))
        watch.contacts.push_back(second);
  }
  // The far side of an obstacle and the rim of a patch are no contact, yet near: look again.
  watch.clear = nearest ? std::abs(nearest->gap) : reach;
  watch.known = watch.clear > options.margin && (!nearest || nearest->gap > 0);
  watch.searched = true;
  watch.at = p;
  watch.travel = obstacle.travel();
}

std::vector<ContactRow> ContactScene::detect(const PositionView& positions, double patience) {
  State& s = *state_;
  for (Obstacle& obstacle : s.obstacles) obstacle.follow(positions);
  enum : char { clear, kept, stale };
  std::vector<char> status(s.watches.size());
  parallel_for(
      static_cast<std::ptrdiff_t>(s.watches.size()),
      [&](std::ptrdiff_t i) {
        const Watch& watch = s.watches[static_cast<std::size_t>(i)];
        const Vector3d p = positions[watch.vertex];
        const bool is_kept = watch.searched && s.way_since_search(watch, p) <= patience * s.options.lag;
        status[static_cast<std::size_t>(i)] = s.clearance(watch, p) > s.options.margin ? clear : is_kept ? kept : stale;
      },
      512);
  std::vector<std::size_t> searches;
  for (std::size_t i = 0; i < status.size(); ++i)
    if (status[i] == stale) {
      searches.push_back(i);
      s.obstacles[static_cast<std::size_t>(s.watches[i].obstacle)].refit();
    }
  parallel_for(
      static_cast<std::ptrdiff_t>(searches.size()),
      [&](std::ptrdiff_t i) {
        Watch& watch = s.watches[searches[static_cast<std::size_t>(i)]];
        s.search(watch, positions[watch.vertex]);
      },
      16);

  std::vector<ContactRow> rows;
  for (std::size_t i = 0; i < s.watches.size(); ++i) {
    if (status[i] == clear) continue;
    const Watch& watch = s.watches[i];
    const Obstacle& obstacle = s.obstacle_of(watch);
    for (const SignedContact& contact : watch.contacts) {
      ContactRow row;
      row.vertices[0] = watch.vertex;
      row.normal = contact.normal;
      row.gap = contact.normal.dot(positions[watch.vertex] - obstacle.point(contact));
      row.pair = watch.pair;
      row.face = contact.triangle;
      if (!obstacle.is_rigid())
        for (int k = 0; k < 3; ++k) {
          const double b = contact.barycentric[k];
          if (b == 0) continue;
          row.vertices[row.count] =
              obstacle.vertices()[static_cast<std::size_t>(obstacle.triangles()(contact.triangle, k))];
          row.coefficients[row.count] = -b;
          ++row.count;
        }
      rows.push_back(row);
    }
  }
  return rows;
}

void ContactScene::forget() {
  for (Watch& watch : state_->watches) watch.searched = watch.known = false;
}

double ContactScene::penetration(const PositionView& positions) const {
  State& s = *state_;
  for (Obstacle& obstacle : s.obstacles) {
    obstacle.follow(positions);
    obstacle.refit();
  }
  std::vector<double> depth(s.watches.size(), 0.0);
  parallel_for(
      static_cast<std::ptrdiff_t>(s.watches.size()),
      [&](std::ptrdiff_t i) {
        const Watch& watch = s.watches[static_cast<std::size_t>(i)];
        const Vector3d p = positions[watch.vertex];
        if (s.clearance(watch, p) > 0) return;
        const auto contact = s.obstacle_of(watch).closest(p, s.options.depth_limit, watch.hint);
        if (s.is_contact(watch, p, contact)) depth[static_cast<std::size_t>(i)] = std::max(0.0, -contact->gap);
      },
      64);
  return depth.empty() ? 0.0 : *std::max_element(depth.begin(), depth.end());
}

double ContactScene::penetration(const MatrixX3d& x) const {
  const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> rows = x;
  return penetration(PositionView{rows.data(), 3, nullptr});
}

const ContactOptions& ContactScene::options() const {
  return state_->options;
}

int ContactScene::left_out() const {
  return state_->left_out;
}

}  // namespace phiz
