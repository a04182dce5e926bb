// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/fibres.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "phiz/core/parallel.h"
#include "phiz/geometry/spatial_query.h"
#include "phiz/geometry/surface.h"
#include "phiz/geometry/topology.h"
#include "phiz/geometry/voxels.h"

namespace phiz {

namespace {

constexpr double sample_spacing = 0.0008;  // metres
constexpr int fewest_divisions = 5, most_divisions = 12;

/// n (n + 1) (n + 2) / 6 barycentric points in n layers, evenly spread: their mean of every quadratic function is
/// exact.
std::vector<Eigen::Vector4d> sample_points(int n) {
  const double m = n - 1, rim = (std::sqrt(0.09 * m * m + 0.36 * m) - 0.3 * m) / 1.2;  // exactness for squares
  std::vector<Eigen::Vector4d> points;
  for (int i = 0; i < n; ++i)
    for (int j = 0; i + j < n; ++j)
      for (int k = 0; i + j + k < n; ++k)
        points.push_back((Eigen::Vector4d(i, j, k, n - 1 - i - j - k).array() + rim).matrix() / (m + 4 * rim));
  return points;
}

std::vector<std::vector<Eigen::Vector4d>> all_sample_points() {
  std::vector<std::vector<Eigen::Vector4d>> points;
  for (int n = 0; n <= most_divisions; ++n) points.push_back(sample_points(n));
  return points;
}

double longest_edge(const Eigen::Matrix<double, 3, 4>& corners) {
  double squared = 0;
  for (int a = 0; a < 4; ++a)
    for (int b = a + 1; b < 4; ++b) squared = std::max(squared, (corners.col(a) - corners.col(b)).squaredNorm());
  return std::sqrt(squared);
}

/// Direction along which most of the unit vectors point, on the side of their sum; `spread`: sum of d d^T.
Vector3d dominant(const Matrix3d& spread, const Vector3d& sum) {
  Eigen::SelfAdjointEigenSolver<Matrix3d> axes;
  axes.computeDirect(spread);
  const Vector3d axis = axes.eigenvectors().col(2).normalized();
  return axis.dot(sum) < 0 ? Vector3d(-axis) : axis;
}

bool is_clean(const TriangleMesh& mesh) {
  return is_closed(mesh.F) && is_edge_manifold(mesh.F) && is_vertex_manifold(mesh.F) && is_oriented(mesh.F) &&
         signed_volume(mesh.V, mesh.F) > 0;
}

/// Scales fractions so that they sum to at most 1 in every tet.
void share_tets(std::vector<Muscle>& muscles, Eigen::Index tets) {
  VectorXd total = VectorXd::Zero(tets);
  for (const Muscle& muscle : muscles)
    for (Eigen::Index i = 0; i < muscle.tets.size(); ++i) total[muscle.tets[i]] += muscle.fraction[i];
  for (Muscle& muscle : muscles)
    for (Eigen::Index i = 0; i < muscle.tets.size(); ++i) muscle.fraction[i] /= std::max(1.0, total[muscle.tets[i]]);
}

}  // namespace

void fill_muscle(Muscle& muscle, const TetMesh& volume, const FibreField& field) {
  static const std::vector<std::vector<Eigen::Vector4d>> samples_by_division = all_sample_points();
  const Eigen::AlignedBox3d reach = field.box();
  std::vector<int> near;
  for (int t = 0; t < volume.T.rows(); ++t) {
    if (volume.region[t] != Tissue::flesh) continue;
    Eigen::AlignedBox3d box;
    for (int k = 0; k < 4; ++k) box.extend(Vector3d(volume.V.row(volume.T(t, k))));
    if (reach.intersects(box)) near.push_back(t);
  }
  VectorXd share = VectorXd::Zero(static_cast<Eigen::Index>(near.size()));
  MatrixX3d direction = MatrixX3d::Zero(share.size(), 3);
  parallel_for(share.size(), [&](std::ptrdiff_t i) {
    Eigen::Matrix<double, 3, 4> corners;
    for (int k = 0; k < 4; ++k)
      corners.col(k) = volume.V.row(volume.T(near[static_cast<std::size_t>(i)], k)).transpose();
    const int divisions = std::clamp(static_cast<int>(std::ceil(longest_edge(corners) / sample_spacing)),
                                     fewest_divisions, most_divisions);
    const std::vector<Eigen::Vector4d>& samples = samples_by_division[static_cast<std::size_t>(divisions)];
    int inside = 0;
    Matrix3d spread = Matrix3d::Zero();
    Vector3d sum = Vector3d::Zero();
    for (const Eigen::Vector4d& s : samples) {
      const Vector3d p = corners * s;
      if (!field.contains(p)) continue;
      const Vector3d d = field.direction(p);
      ++inside;
      spread += d * d.transpose();
      sum += d;
    }
    if (inside == 0) return;
    share[i] = inside / static_cast<double>(samples.size());
    direction.row(i) = dominant(spread, sum).transpose();
  });
  const Eigen::Index count = (share.array() > 0).count();
  muscle.tets.resize(count);
  muscle.fraction.resize(count);
  muscle.direction.resize(count, 3);
  Eigen::Index row = 0;
  for (Eigen::Index i = 0; i < share.size(); ++i) {
    if (!(share[i] > 0)) continue;
    muscle.tets[row] = near[static_cast<std::size_t>(i)];
    muscle.fraction[row] = share[i];
    muscle.direction.row(row++) = direction.row(i);
  }
}

std::vector<Muscle> make_muscles(const TetMesh& volume, std::span<const MuscleShape> shapes,
                                 const FibreOptions& options) {
  std::vector<Muscle> muscles(shapes.size());
  parallel_for(
      static_cast<std::ptrdiff_t>(shapes.size()),
      [&](std::ptrdiff_t m) {
        const MuscleShape& shape = shapes[static_cast<std::size_t>(m)];
        Muscle& muscle = muscles[static_cast<std::size_t>(m)];
        const FibreField field(shape, options);
        muscle.name = shape.name;
        muscle.ring = shape.ring;
        muscle.surface =
            is_clean(shape.surface) ? TriangleMesh{shape.surface.V, shape.surface.F, {}, {}} : field.voxel_surface();
        fill_muscle(muscle, volume, field);
        muscle.fibres = field.trace();
      },
      1);
  share_tets(muscles, volume.T.rows());
  return muscles;
}

double share_in_flesh(const TetMesh& volume, const TriangleMesh& surface) {
  constexpr double spacing = 0.0007;
  const SurfaceVoxels voxels(surface, spacing, 0);
  std::vector<int> flesh;
  for (int t = 0; t < volume.T.rows(); ++t)
    if (volume.region[t] == Tissue::flesh) flesh.push_back(t);
  const TetQuery query(volume.V, volume.T(flesh, Eigen::all));
  std::vector<std::ptrdiff_t> inside;
  for (std::ptrdiff_t voxel = 0; voxel < voxels.grid().count(); ++voxel)
    if (voxels.inside()[static_cast<std::size_t>(voxel)]) inside.push_back(voxel);
  if (inside.empty()) return 0;
  const auto count = static_cast<std::ptrdiff_t>(inside.size());
  const double found = parallel_sum(count, 1024, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    double sum = 0;
    for (std::ptrdiff_t i = begin; i < end; ++i)
      sum += query.locate(voxels.grid().centre(inside[static_cast<std::size_t>(i)])) ? 1 : 0;
    return sum;
  });
  return found / static_cast<double>(count);
}

}  // namespace phiz
