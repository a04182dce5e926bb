// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "phiz/anatomy/builtin/muscles.h"
#include "phiz/core/parallel.h"
#include "phiz/geometry/box_tree.h"
#include "phiz/geometry/remesh.h"
#include "phiz/geometry/spatial_query.h"
#include "phiz/geometry/topology.h"

namespace phiz {
namespace {

constexpr double thinnest = 0.0006;     ///< metres, radius
constexpr double fibre_distance = 0.9;  ///< between neighbours of a sheet, in radii
constexpr double fibre_step = 0.003;    ///< metres between points: fibres follow the corner below the chin
constexpr int room_steps = 8;

bool is_closed_fibre(const MatrixX3d& fibre) {
  return (fibre.row(0) - fibre.row(fibre.rows() - 1)).norm() < 1e-9;
}

/// The space of the flesh: between the skin and the bones.
class Room {
 public:
  explicit Room(const HeadTemplate& head)
      : skin_(head.volume.V, head.skin_triangles), bones_(head.volume.V, bone_triangles(head.volume)) {}

  /// Moves p until a ball of `radius` round it lies in the flesh, as far as that is possible in a few steps; returns
  /// the radius that has room.
  double settle(Vector3d& p, double radius) const {
    double room = 0;
    for (int step = 0; step <= room_steps; ++step) {
      const SurfacePoint skin = skin_.closest_point(p), bone = bones_.closest_point(p);
      const double under = std::copysign(std::sqrt(skin.squared_distance), skin_.is_inside(p) ? 1 : -1);
      const double over = std::copysign(std::sqrt(bone.squared_distance), bones_.is_inside(p) ? -1 : 1);
      room = std::min(under, over);
      if (room >= radius || step == room_steps) break;
      const double share = under < radius && over < radius ? 0.5 : 1;
      if (under < radius)
        p += share * (radius - under) * std::copysign(1.0, under) * (p - skin.position).stableNormalized();
      if (over < radius)
        p += share * (radius - over) * std::copysign(1.0, over) * (p - bone.position).stableNormalized();
    }
    return std::clamp(room, thinnest, radius);
  }

 private:
  static MatrixX3i bone_triangles(const TetMesh& volume) {
    const MatrixX3i skull = region_boundary(volume, Tissue::skull),
                    mandible = region_boundary(volume, Tissue::mandible);
    MatrixX3i both(skull.rows() + mandible.rows(), 3);
    both << skull, mandible;
    return both;
  }

  SurfaceQuery skin_, bones_;
};

/// A fibre with a radius at every point.
struct Tube {
  MatrixX3d points;
  VectorXd radius;
};

/// The distance to the nearest of many tubes.
class TubeDistance {
 public:
  explicit TubeDistance(const std::vector<Tube>& tubes) : pieces_(pieces(tubes)), tree_(boxes(pieces_)) {}

  /// Negative inside; what lies farther than 1 m counts as 1 m.
  double operator()(const Vector3d& p) const {
    double best = 1;
    const auto bound = [&best] { return std::max(best, 0.0) * std::max(best, 0.0); };
    tree_.nearest_first(p, bound, [&](int i) {
      const Piece& piece = pieces_[static_cast<std::size_t>(i)];
      const Vector3d e = piece.b - piece.a;
      const double t = std::clamp((p - piece.a).dot(e) / std::max(e.squaredNorm(), 1e-18), 0.0, 1.0);
      best = std::min(best, (piece.a + t * e - p).norm() - (1 - t) * piece.radius_a - t * piece.radius_b);
    });
    return best;
  }

  AlignedBox box() const { return tree_.nodes().front().box; }

 private:
  struct Piece {
    Vector3d a, b;
    double radius_a, radius_b;
  };
  static std::vector<Piece> pieces(const std::vector<Tube>& tubes) {
    std::vector<Piece> all;
    for (const Tube& tube : tubes)
      for (Eigen::Index i = 0; i + 1 < tube.points.rows(); ++i)
        all.push_back({tube.points.row(i), tube.points.row(i + 1), tube.radius[i], tube.radius[i + 1]});
    return all;
  }
  static std::vector<AlignedBox> boxes(const std::vector<Piece>& pieces) {
    std::vector<AlignedBox> all;
    for (const Piece& piece : pieces) {
      const double thick = std::max(piece.radius_a, piece.radius_b);
      all.emplace_back(piece.a.cwiseMin(piece.b).array() - thick, piece.a.cwiseMax(piece.b).array() + thick);
    }
    return all;
  }

  std::vector<Piece> pieces_;
  BoxTree tree_;
};

/// Fibres between the neighbours of a bundle, so that their tubes merge.
std::vector<MatrixX3d> dense(const MuscleBundle& bundle) {
  std::vector<MatrixX3d> fibres;
  for (std::size_t f = 0; f < bundle.fibres.size(); ++f) {
    fibres.push_back(bundle.fibres[f]);
    if (f + 1 == bundle.fibres.size()) break;
    const MatrixX3d across = bundle.fibres[f + 1] - bundle.fibres[f];
    const int between =
        static_cast<int>(std::ceil(across.rowwise().norm().maxCoeff() / (fibre_distance * bundle.radius)));
    for (int i = 1; i < between; ++i) fibres.emplace_back(bundle.fibres[f] + (i / double(between)) * across);
  }
  return fibres;
}

/// The fibre with its points at most `step` apart.
MatrixX3d subdivided(const MatrixX3d& fibre, double step) {
  std::vector<Eigen::RowVector3d> points;
  for (Eigen::Index i = 0; i + 1 < fibre.rows(); ++i) {
    const Eigen::RowVector3d along = fibre.row(i + 1) - fibre.row(i);
    const int count = std::max(1, static_cast<int>(std::ceil(along.norm() / step)));
    for (int k = 0; k < count; ++k) points.emplace_back(fibre.row(i) + (k / double(count)) * along);
  }
  points.emplace_back(fibre.row(fibre.rows() - 1));
  MatrixX3d result(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i) result.row(static_cast<Eigen::Index>(i)) = points[i];
  return result;
}

void smooth(MatrixX3d& fibre) {
  const bool closed = is_closed_fibre(fibre);
  const Eigen::Index last = fibre.rows() - 1;
  const MatrixX3d before = fibre;
  for (Eigen::Index i = 0; i <= last; ++i) {
    if (!closed && (i == 0 || i == last)) continue;
    const Eigen::Index back = i == 0 ? last - 1 : i - 1, ahead = i == last ? 1 : i + 1;
    fibre.row(i) = 0.5 * before.row(i) + 0.25 * (before.row(back) + before.row(ahead));
  }
}

Tube tube(const MatrixX3d& fibre, double radius, const Room& room) {
  Tube result{fibre, {}};
  const auto settle = [&] {
    result.radius.resize(result.points.rows());
    for (Eigen::Index i = 0; i < result.points.rows(); ++i) {
      Vector3d p = result.points.row(i);
      result.radius[i] = room.settle(p, radius);
      result.points.row(i) = p.transpose();
    }
  };
  settle();
  result.points = subdivided(result.points, fibre_step);
  for (int pass = 0; pass < 3; ++pass) {
    settle();
    smooth(result.points);
  }
  settle();
  return result;
}

TriangleMesh surface_of(const std::vector<Tube>& tubes, double radius) {
  const TubeDistance distance(tubes);
  PolygoniseOptions options;
  options.edge_length = std::clamp(0.6 * radius, 0.0010, 0.0018);
  options.projection_steps = 3;
  options.lipschitz = 1.3;
  const double rim = 4 * options.edge_length;
  return polygonise([&distance](const Vector3d& p) { return distance(p); },
                    {distance.box().min().array() - rim, distance.box().max().array() + rim}, options);
}

/// The axis that the fibres of a ring go round right-handed, from the area they enclose.
Vector3d axis_of(const std::vector<MatrixX3d>& fibres, const Vector3d& centre) {
  Vector3d area = Vector3d::Zero();
  for (const MatrixX3d& fibre : fibres)
    for (Eigen::Index i = 0; i + 1 < fibre.rows(); ++i)
      area += (fibre.row(i).transpose() - centre).cross(fibre.row(i + 1).transpose() - centre);
  return area.normalized();
}

MuscleShape shape_of(const MuscleBundle& bundle, const Room& room) {
  MuscleShape shape;
  shape.name = bundle.name;
  std::vector<Tube> tubes;
  for (const MatrixX3d& fibre : dense(bundle)) tubes.push_back(tube(fibre, bundle.radius, room));
  shape.surface = surface_of(tubes, bundle.radius);
  shape.ring = is_closed_fibre(bundle.fibres.front());
  const auto count = static_cast<Eigen::Index>(tubes.size());
  if (shape.ring) {
    for (const Tube& t : tubes) shape.ring_centre += t.points.colwise().mean().transpose() / double(count);
    shape.ring_axis = axis_of(bundle.fibres, shape.ring_centre);
    return shape;
  }
  shape.origin.resize(count, 3);
  shape.insertion.resize(count, 3);
  for (Eigen::Index i = 0; i < count; ++i) {
    const MatrixX3d& points = tubes[static_cast<std::size_t>(i)].points;
    shape.origin.row(i) = points.row(0);
    shape.insertion.row(i) = points.row(points.rows() - 1);
  }
  return shape;
}

MuscleShape mirrored(const MuscleShape& left, const std::string& name) {
  MuscleShape right = left;
  right.name = name;
  for (MatrixX3d* points : {&right.surface.V, &right.origin, &right.insertion}) points->col(0) *= -1;
  right.surface.F.col(1).swap(right.surface.F.col(2));
  right.ring_centre.x() *= -1;
  right.ring_axis =
      -right.ring_axis.cwiseProduct(Vector3d(-1, 1, 1));  // fibres go round as those of the left, reflected
  return right;
}

}  // namespace

std::vector<MuscleShape> muscle_shapes(const std::vector<MuscleBundle>& bundles, const HeadTemplate& head) {
  const Room room(head);
  std::vector<MuscleShape> shapes(bundles.size());
  parallel_for(
      static_cast<std::ptrdiff_t>(bundles.size()),
      [&](std::ptrdiff_t i) {
        const auto m = static_cast<std::size_t>(i);
        if (!bundles[m].name.ends_with("Right")) shapes[m] = shape_of(bundles[m], room);
      },
      1);
  for (std::size_t m = 1; m < shapes.size(); ++m)  // a right muscle follows its left one
    if (bundles[m].name.ends_with("Right")) shapes[m] = mirrored(shapes[m - 1], bundles[m].name);
  return shapes;
}

}  // namespace phiz
