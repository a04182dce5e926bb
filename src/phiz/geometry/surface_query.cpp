// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "phiz/core/error.h"
#include "phiz/core/parallel.h"
#include "phiz/geometry/box_tree.h"
#include "phiz/geometry/spatial_query.h"
#include "phiz/geometry/validate.h"

namespace phiz {

namespace {

struct TriangleCorners {
  Vector3d a, b, c;
};

/// Everything below a node seen from afar: area-weighted normal at the area-weighted centre (Barill et al. 2018, order
/// 1).
struct Dipole {
  Vector3d centre = Vector3d::Zero();
  Vector3d area_normal = Vector3d::Zero();
  double radius = 0;
};

constexpr double far_ratio = 3.0;  // use the dipole beyond this many radii; keeps the error of the sum below 0.03

double solid_angle(const Vector3d& p, const TriangleCorners& t) {
  const Vector3d a = t.a - p, b = t.b - p, c = t.c - p;
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  const double numerator = a.dot(b.cross(c));
  const double denominator = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
  return numerator == 0 && denominator == 0 ? 0.0 : 2 * std::atan2(numerator, denominator);
}

/// Moeller and Trumbore (1997), both sides.
std::optional<RayHit> hit_triangle(const Vector3d& origin, const Vector3d& direction, const TriangleCorners& t) {
  const Vector3d e1 = t.b - t.a, e2 = t.c - t.a, q = direction.cross(e2);
  const double det = e1.dot(q);
  if (det == 0) return std::nullopt;
  const Vector3d s = origin - t.a, r = s.cross(e1);
  const double v = s.dot(q) / det, w = direction.dot(r) / det;
  if (!(v >= 0 && w >= 0 && v + w <= 1)) return std::nullopt;
  return RayHit{-1, {1 - v - w, v, w}, e2.dot(r) / det};
}

/// Slab test that also copes with directions along an axis.
bool ray_meets_box(const Vector3d& origin, const Vector3d& direction, const AlignedBox& box, double min_t,
                   double max_t) {
  for (int k = 0; k < 3; ++k) {
    if (direction[k] == 0) {
      if (origin[k] < box.min()[k] || origin[k] > box.max()[k]) return false;
      continue;
    }
    double low = (box.min()[k] - origin[k]) / direction[k], high = (box.max()[k] - origin[k]) / direction[k];
    if (low > high) std::swap(low, high);
    const double slack = 1e-12 * (std::abs(low) + std::abs(high));
    min_t = std::max(min_t, low - slack);
    max_t = std::min(max_t, high + slack);
    if (min_t > max_t) return false;
  }
  return true;
}

std::vector<AlignedBox> triangle_boxes(const MatrixX3d& V, const MatrixX3i& F) {
  std::vector<AlignedBox> boxes(static_cast<std::size_t>(F.rows()));
  for (Eigen::Index f = 0; f < F.rows(); ++f)
    for (int k = 0; k < 3; ++k) boxes[static_cast<std::size_t>(f)].extend(Vector3d(V.row(F(f, k))));
  return boxes;
}

}  // namespace

struct SurfaceQuery::Tree {
  MatrixX3i F;
  BoxTree tree;
  std::vector<TriangleCorners> corners;  // in the order of the tree
  std::vector<int> place;                // place in that order per triangle
  std::vector<Dipole> dipoles;           // per node

  Tree(const MatrixX3d& V, const MatrixX3i& triangles)
      : F(triangles), tree(triangle_boxes(V, F)), place(static_cast<std::size_t>(F.rows())) {
    for (std::size_t i = 0; i < tree.order().size(); ++i)
      place[static_cast<std::size_t>(tree.order()[i])] = static_cast<int>(i);
    update(V);
  }

  const TriangleCorners& at(int triangle) const {
    return corners[static_cast<std::size_t>(place[static_cast<std::size_t>(triangle)])];
  }

  void update(const MatrixX3d& V) {
    corners.resize(place.size());
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const int f = tree.order()[i];
      corners[i] = {V.row(F(f, 0)), V.row(F(f, 1)), V.row(F(f, 2))};
    }
    const auto& nodes = tree.nodes();
    dipoles.assign(nodes.size(), {});
    std::vector<double> areas(nodes.size(), 0);
    for (std::size_t n = nodes.size(); n-- > 0;) {
      Dipole& dipole = dipoles[n];
      const auto add = [&](const Vector3d& centre, const Vector3d& area_normal, double area) {
        dipole.centre += area * centre;
        dipole.area_normal += area_normal;
        areas[n] += area;
      };
      if (nodes[n].is_leaf()) {
        for (int i = nodes[n].begin; i < nodes[n].end; ++i) {
          const TriangleCorners& t = corners[static_cast<std::size_t>(i)];
          const Vector3d area_normal = 0.5 * (t.b - t.a).cross(t.c - t.a);
          add((t.a + t.b + t.c) / 3, area_normal, area_normal.norm());
        }
      } else {
        for (const std::size_t child : {n + 1, static_cast<std::size_t>(nodes[n].right)})
          add(dipoles[child].centre, dipoles[child].area_normal, areas[child]);
      }
      dipole.centre = areas[n] > 0 ? Vector3d(dipole.centre / areas[n]) : Vector3d(nodes[n].box.center());
      const Vector3d reach = (nodes[n].box.max() - dipole.centre).cwiseMax(dipole.centre - nodes[n].box.min());
      dipole.radius = reach.norm();
    }
  }

  std::optional<SurfacePoint> nearest(const Vector3d& p, double squared_bound) const {
    SurfacePoint best;
    best.squared_distance = squared_bound;
    tree.nearest_first(
        p, [&best] { return best.squared_distance; },
        [&](int triangle) {
          const TriangleCorners& t = at(triangle);
          const Vector3d weights = closest_barycentric(p, t.a, t.b, t.c);
          const Vector3d position = weights[0] * t.a + weights[1] * t.b + weights[2] * t.c;
          const double squared = (p - position).squaredNorm();
          if (squared < best.squared_distance ||
              (squared == best.squared_distance && (best.triangle < 0 || triangle < best.triangle)))
            best = {triangle, weights, position, squared};
        });
    if (best.triangle < 0) return std::nullopt;
    return best;
  }

  double winding(const Vector3d& p) const {
    double sum = 0;
    int stack[64];
    int top = 0;
    stack[top++] = 0;
    const auto& nodes = tree.nodes();
    while (top > 0) {
      const int n = stack[--top];
      const auto& node = nodes[static_cast<std::size_t>(n)];
      const Dipole& dipole = dipoles[static_cast<std::size_t>(n)];
      const Vector3d r = dipole.centre - p;
      const double squared = r.squaredNorm();
      if (squared > far_ratio * far_ratio * dipole.radius * dipole.radius) {
        sum += dipole.area_normal.dot(r) / (squared * std::sqrt(squared));
      } else if (node.is_leaf()) {
        for (int i = node.begin; i < node.end; ++i) sum += solid_angle(p, corners[static_cast<std::size_t>(i)]);
      } else {
        stack[top++] = node.right;
        stack[top++] = n + 1;
      }
    }
    return sum / (4 * std::numbers::pi);
  }
};

SurfaceQuery::SurfaceQuery(const TriangleMesh& mesh) : SurfaceQuery(mesh.V, mesh.F) {}

SurfaceQuery::SurfaceQuery(const MatrixX3d& V, const MatrixX3i& F) {
  if (F.rows() == 0) reject("surface query", "the surface has no triangles");
  if (F.minCoeff() < 0 || F.maxCoeff() >= V.rows() || !V.allFinite())
    validate(TriangleMesh{V, F, {}, {}}, "surface query");
  tree_ = std::make_unique<Tree>(V, F);
}

SurfaceQuery::~SurfaceQuery() = default;
SurfaceQuery::SurfaceQuery(SurfaceQuery&&) noexcept = default;
SurfaceQuery& SurfaceQuery::operator=(SurfaceQuery&&) noexcept = default;

void SurfaceQuery::refit(const MatrixX3d& V) {
  if (tree_->F.maxCoeff() >= V.rows() || !V.allFinite()) validate(TriangleMesh{V, tree_->F, {}, {}}, "surface query");
  tree_->tree.refit(triangle_boxes(V, tree_->F));
  tree_->update(V);
}

SurfacePoint SurfaceQuery::closest_point(const Vector3d& p) const {
  const auto found = tree_->nearest(p, std::numeric_limits<double>::infinity());
  if (!found) reject("surface query", "the query point is not finite");
  return *found;
}

std::optional<SurfacePoint> SurfaceQuery::closest_point_within(const Vector3d& p, double max_distance) const {
  return tree_->nearest(p, max_distance * max_distance);
}

std::optional<RayHit> SurfaceQuery::first_hit(const Vector3d& origin, const Vector3d& direction, double min_t,
                                              double max_t) const {
  std::optional<RayHit> best;
  tree_->tree.each_overlapping(
      [&](const AlignedBox& box) { return ray_meets_box(origin, direction, box, min_t, best ? best->t : max_t); },
      [&](int triangle) {
        auto hit = hit_triangle(origin, direction, tree_->at(triangle));
        if (!hit || !(hit->t >= min_t && hit->t <= max_t)) return;
        if (best && (hit->t > best->t || (hit->t == best->t && triangle > best->triangle))) return;
        hit->triangle = triangle;
        best = hit;
      });
  return best;
}

std::vector<RayHit> SurfaceQuery::all_hits(const Vector3d& origin, const Vector3d& direction, double min_t,
                                           double max_t) const {
  std::vector<RayHit> hits;
  tree_->tree.each_overlapping(
      [&](const AlignedBox& box) { return ray_meets_box(origin, direction, box, min_t, max_t); },
      [&](int triangle) {
        auto hit = hit_triangle(origin, direction, tree_->at(triangle));
        if (!hit || !(hit->t >= min_t && hit->t <= max_t)) return;
        hit->triangle = triangle;
        hits.push_back(*hit);
      });
  std::sort(hits.begin(), hits.end(),
            [](const RayHit& l, const RayHit& r) { return l.t < r.t || (l.t == r.t && l.triangle < r.triangle); });
  return hits;
}

std::vector<int> SurfaceQuery::triangles_in_box(const Vector3d& low, const Vector3d& high) const {
  const AlignedBox wanted(low, high);
  std::vector<int> found;
  tree_->tree.each_overlapping([&](const AlignedBox& box) { return box.intersects(wanted); },
                               [&](int triangle) {
                                 const TriangleCorners& t = tree_->at(triangle);
                                 AlignedBox box(t.a);
                                 if (box.extend(t.b).extend(t.c).intersects(wanted)) found.push_back(triangle);
                               });
  std::sort(found.begin(), found.end());
  return found;
}

double SurfaceQuery::winding_number(const Vector3d& p) const {
  return tree_->winding(p);
}

double SurfaceQuery::signed_distance(const Vector3d& p) const {
  const double distance = std::sqrt(closest_point(p).squared_distance);
  return is_inside(p) ? -distance : distance;
}

std::vector<SurfacePoint> SurfaceQuery::closest_points(const MatrixX3d& P) const {
  std::vector<SurfacePoint> result(static_cast<std::size_t>(P.rows()));
  parallel_for(P.rows(), [&](Eigen::Index i) { result[static_cast<std::size_t>(i)] = closest_point(P.row(i)); });
  return result;
}

VectorXd SurfaceQuery::signed_distances(const MatrixX3d& P) const {
  VectorXd result(P.rows());
  parallel_for(P.rows(), [&](Eigen::Index i) { result[i] = signed_distance(P.row(i)); });
  return result;
}

VectorXd SurfaceQuery::winding_numbers(const MatrixX3d& P) const {
  VectorXd result(P.rows());
  parallel_for(P.rows(), [&](Eigen::Index i) { result[i] = winding_number(P.row(i)); });
  return result;
}

std::vector<SurfacePoint> closest_points(const TriangleMesh& mesh, const MatrixX3d& P) {
  return SurfaceQuery(mesh).closest_points(P);
}

VectorXd signed_distances(const TriangleMesh& mesh, const MatrixX3d& P) {
  return SurfaceQuery(mesh).signed_distances(P);
}

SparseMatrixd interpolation_matrix(const std::vector<SurfacePoint>& points, const MatrixX3i& F,
                                   Eigen::Index vertex_count) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (int k = 0; points[i].triangle >= 0 && k < 3; ++k)
      entries.emplace_back(static_cast<int>(i), F(points[i].triangle, k), points[i].barycentric[k]);
  SparseMatrixd W(static_cast<Eigen::Index>(points.size()), vertex_count);
  W.setFromTriplets(entries.begin(), entries.end());
  return W;
}

}  // namespace phiz
