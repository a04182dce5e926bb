// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "phiz/face/activation.h"
#include "phiz/geometry/operators.h"
#include "phiz/geometry/topology.h"
#include "phiz/numerics/cholesky.h"

namespace phiz {

namespace {

constexpr double smoothing_length = 4e-3;  ///< metres

/// Averages what tets of muscle strive for with what those around do: screened diffusion through the faces between
/// them, as far as muscle conducts it.
class MuscleFilter {
 public:
  MuscleFilter(const HeadTemplate& head, const HeadTissue& tissue, double length)
      : place_(VectorXi::Constant(head.volume.T.rows(), -1)) {
    VectorXd share = VectorXd::Zero(head.volume.T.rows());
    for (Eigen::Index t = 0; t < tissue.soft.size(); ++t) {
      if (!(tissue.muscle[t] > 0)) continue;
      share[tissue.soft[t]] = tissue.muscle[t];
      place_[tissue.soft[t]] = static_cast<int>(tets_.size());
      tets_.push_back(tissue.soft[t]);
    }
    const auto n = static_cast<Eigen::Index>(tets_.size());
    const MatrixX4i neighbours = tet_neighbours(head.volume.T);
    const VectorXd volumes = tet_volumes(head.volume.V, head.volume.T);
    std::vector<Eigen::Triplet<double>> entries;
    mass_.resize(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const int t = tets_[static_cast<std::size_t>(i)];
      mass_[i] = share[t] * std::abs(volumes[t]);
      entries.emplace_back(i, i, mass_[i]);
      for (int k = 0; k < 4; ++k) {
        const int other = neighbours(t, k);
        if (other < 0 || place_[other] < i) continue;
        const double conducts = length * length * std::min(share[t], share[other]) * face_area(head.volume, t, k) /
                                (centre(head.volume, t) - centre(head.volume, other)).norm();
        const int j = place_[other];
        entries.emplace_back(i, i, conducts);
        entries.emplace_back(j, j, conducts);
        entries.emplace_back(i, j, -conducts);
        entries.emplace_back(j, i, -conducts);
      }
    }
    SparseMatrixd A(n, n);
    A.setFromTriplets(entries.begin(), entries.end());
    if (n > 0) factor_.emplace(A);
  }

  /// `tets`: rows of the volume, ascending, both ways; what has become next to nothing is dropped.
  void apply(VectorXi& tets, Stretches& changes) const {
    MatrixXd sums = MatrixXd::Zero(mass_.size(), 6);
    for (Eigen::Index i = 0; i < tets.size(); ++i)
      if (const int at = place_[tets[i]]; at >= 0) sums.row(at) = mass_[at] * changes.row(i).cast<double>();
    if (factor_) factor_->solve_in_place(sums);
    constexpr double least_change = 1e-4;
    std::vector<Eigen::Index> kept;
    for (Eigen::Index i = 0; i < sums.rows(); ++i)
      if (sums.row(i).cwiseAbs().maxCoeff() > least_change) kept.push_back(i);
    tets = Eigen::Map<const VectorXi>(tets_.data(), mass_.size())(kept);
    changes = sums(kept, Eigen::all).cast<float>();
  }

 private:
  static Vector3d corner(const TetMesh& mesh, int t, int k) { return mesh.V.row(mesh.T(t, k % 4)).transpose(); }
  static Vector3d centre(const TetMesh& mesh, int t) {
    return (corner(mesh, t, 0) + corner(mesh, t, 1) + corner(mesh, t, 2) + corner(mesh, t, 3)) / 4;
  }
  static double face_area(const TetMesh& mesh, int t, int opposite) {
    const Vector3d a = corner(mesh, t, opposite + 1);
    return 0.5 * (corner(mesh, t, opposite + 2) - a).cross(corner(mesh, t, opposite + 3) - a).norm();
  }

  VectorXi place_;         ///< per tet of the volume: its number among those with muscle, or -1
  std::vector<int> tets_;  ///< the other way
  VectorXd mass_;          ///< volume of muscle, m^3
  std::optional<SparseCholesky> factor_;
};

}  // namespace

std::vector<ActivationShape> estimate_activations(const FaceModel& model, const HeadTissue& tissue) {
  const MuscleFilter filter(model.head, tissue, smoothing_length);
  std::vector<ActivationShape> shapes;
  for (const VolumetricShape& shape : model.shapes) {
    ActivationShape out{shape.name, shape.jaw, shape.tets, shape.stretch};
    filter.apply(out.tets, out.change);
    shapes.push_back(std::move(out));
  }
  return shapes;
}

}  // namespace phiz
