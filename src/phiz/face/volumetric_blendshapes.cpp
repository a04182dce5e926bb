// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/face/volumetric_blendshapes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <string>
#include <utility>

#include "phiz/core/error.h"
#include "phiz/core/progress.h"
#include "phiz/face/flesh.h"
#include "phiz/face/surface_gradients.h"
#include "phiz/geometry/operators.h"
#include "phiz/geometry/topology.h"
#include "phiz/numerics/svd3.h"

namespace phiz {

namespace {

constexpr double stiffness = 3000;  ///< pascals; only ratios count here

/// Stretches that a target may ask for.
struct StretchBounds {
  double least, most;
};
constexpr StretchBounds usual{0.4, 4};
constexpr StretchBounds drawn_out{0.15, 8};  ///< lids that unfold; lips closed over an open jaw

/// The soft tet (index into `soft`) below each triangle of the simulation skin, or -1.
VectorXi tets_below(const HeadTemplate& head, const VectorXi& soft) {
  std::map<std::array<int, 3>, int> below;
  constexpr int faces[4][3] = {{1, 2, 3}, {0, 2, 3}, {0, 1, 3}, {0, 1, 2}};
  for (Eigen::Index t = 0; t < soft.size(); ++t)
    for (const auto& face : faces) {
      std::array<int, 3> key;
      for (int k = 0; k < 3; ++k) key[static_cast<std::size_t>(k)] = head.volume.T(soft[t], face[k]);
      std::sort(key.begin(), key.end());
      below[key] = static_cast<int>(t);
    }
  VectorXi out(head.skin_triangles.rows());
  for (Eigen::Index f = 0; f < out.size(); ++f) {
    std::array<int, 3> key{head.skin_triangles(f, 0), head.skin_triangles(f, 1), head.skin_triangles(f, 2)};
    std::sort(key.begin(), key.end());
    const auto found = below.find(key);
    out[f] = found == below.end() ? -1 : found->second;
  }
  return out;
}

/// A sculpted skin may fold over itself and invert tets below, mostly tiny ones at the corners of lids and lips. A
/// target must not ask for that: gradients outside of the bounds are replaced by the mean of their sound neighbours,
/// layer by layer, and what is left is brought within the bounds.
void repair_gradients(std::vector<Matrix3d>& F, const VectorXd& volume, const MatrixX4i& neighbours,
                      const StretchBounds& bounds) {
  constexpr int layers = 4;
  std::vector<char> sound(F.size());
  for (std::size_t t = 0; t < F.size(); ++t) {
    const Vector3d s = svd3(F[t]).s;
    sound[t] = s[2] >= bounds.least && s[0] <= bounds.most;
  }
  for (int layer = 0; layer < layers; ++layer) {
    std::vector<std::pair<std::size_t, Matrix3d>> mended;
    for (std::size_t t = 0; t < F.size(); ++t) {
      if (sound[t]) continue;
      Matrix3d sum = Matrix3d::Zero();
      double total = 0;
      for (int k = 0; k < 4; ++k) {
        const int n = neighbours(static_cast<Eigen::Index>(t), k);
        if (n < 0 || !sound[static_cast<std::size_t>(n)]) continue;
        sum += volume[n] * F[static_cast<std::size_t>(n)];
        total += volume[n];
      }
      if (total > 0) mended.emplace_back(t, sum / total);
    }
    for (const auto& [t, mean] : mended) {
      F[t] = mean;
      sound[t] = 1;
    }
  }
  for (Matrix3d& gradient : F) {
    const Svd3 svd = svd3(gradient);
    if (svd.s[2] < bounds.least || svd.s[0] > bounds.most)
      gradient = svd.U * svd.s.cwiseMax(bounds.least).cwiseMin(bounds.most).asDiagonal() * svd.V.transpose();
  }
}

/// Everything that the solves of all shapes share.
class ShapeSolver {
 public:
  ShapeSolver(const HeadTemplate& head, const BlendshapeOptions& options)
      : head_(head),
        options_(options),
        soft_(soft_tets(head)),
        below_(tets_below(head, soft_)),
        neighbours_(tet_neighbours(head.volume.T(soft_, Eigen::all))),
        rest_(tet_rest(head.volume.V, head.volume.T(soft_, Eigen::all))),
        transfer_(transfer_body()),
        hold_(hold_body()) {}

  VolumetricShape solve(const Expression& expression, const StretchBounds& bounds, SolveStatistics& statistics) {
    const MatrixX3d moved = head_.skin_sampling * expression.displacement;
    MatrixX3d sculpted = head_.volume.V;
    for (Eigen::Index i = 0; i < head_.skin_vertices.size(); ++i) sculpted.row(head_.skin_vertices[i]) += moved.row(i);
    const JawPose jaw = clamp_to_limits(head_.jaw, expression.jaw);
    place_bones(head_, jaw, sculpted);

    const std::vector<Matrix3d> skin = surface_gradients(head_.volume.V, sculpted, head_.skin_triangles);
    std::vector<Matrix3d> target(static_cast<std::size_t>(soft_.size()), Matrix3d::Zero());
    VectorXi count = VectorXi::Zero(soft_.size());
    for (Eigen::Index f = 0; f < below_.size(); ++f) {
      if (below_[f] < 0) continue;
      target[static_cast<std::size_t>(below_[f])] += skin[static_cast<std::size_t>(f)];
      ++count[below_[f]];
    }
    for (Eigen::Index t = 0; t < soft_.size(); ++t)
      transfer_.set_target(
          t, count[t] > 0 ? Matrix3d(target[static_cast<std::size_t>(t)] / count[t]) : Matrix3d(Matrix3d::Identity()),
          Matrix3d::Identity());
    MatrixX3d x = head_.volume.V;
    place_bones(head_, jaw, x);
    SolveOptions solve;
    solve.longest_step = 0.02;
    solve.residual_tolerance = 1;
    solve.max_iterations = options_.max_iterations;
    solve.step_tolerance = 20 * options_.step_tolerance;
    transfer_.solve(x, solve);

    for (std::size_t k = 0; k < held_.size(); ++k) hold_.set_attachment(k, sculpted.row(held_[k]));
    solve.step_tolerance = options_.step_tolerance;
    statistics = hold_.solve(x, solve);
    std::vector<Matrix3d> F = deformation_gradients(x, head_.volume.T(soft_, Eigen::all), rest_);
    repair_gradients(F, rest_.volume, neighbours_, bounds);
    VolumetricShape shape = shape_of_gradients(expression.name, jaw, soft_, F, options_.least_strain);
    shape.displacement = (x - head_.volume.V).cast<float>();
    return shape;
  }

 private:
  ElasticBody transfer_body() const {
    ElasticBody body = flesh_body(head_, soft_, {options_.transfer, options_.shape, options_.volume}, stiffness);
    body.target_share = VectorXd::Zero(soft_.size());
    for (const int t : below_)
      if (t >= 0) body.target_share[t] = 1;
    return body;
  }

  ElasticBody hold_body() {
    ElasticBody body = flesh_body(head_, soft_, {0, options_.shape, options_.volume}, stiffness);
    // A skin that misses its place by d is pulled with hold * stiffness * d / 1 mm of pressure: with the default a
    // strain energy of the order of the stiffness leaves some hundredths of a millimetre.
    const VectorXd area = lumped_triangle_mass(head_.volume.V, head_.skin_triangles);
    std::vector<char> inner(static_cast<std::size_t>(head_.skin.V.rows()), 0);
    for (const char* name : {"mouthBag", "oralRoof", "oralFloor"}) {
      const auto region = head_.skin_regions.find(name);
      if (region == head_.skin_regions.end()) continue;
      for (const int v : region->second) inner[static_cast<std::size_t>(v)] = 1;
    }
    for (Eigen::Index i = 0; i < head_.skin_vertices.size(); ++i) {
      const int v = head_.skin_vertices[i];
      if (body.fixed[static_cast<std::size_t>(v)]) continue;
      double hidden = 0;
      for (SparseMatrixd::InnerIterator it(head_.skin_sampling, i); it; ++it)
        if (inner[static_cast<std::size_t>(it.col())]) hidden += it.value();
      const double share = hidden > 0.5 ? options_.inner_hold : is_beside_eye(v) ? options_.lid_hold : 1.0;
      body.attachments.push_back(
          {v, 0.5 * share * options_.hold * stiffness * area[v] / 1e-3, head_.volume.V.row(v), Vector3d::Zero()});
      held_.push_back(v);
    }
    return body;
  }

  bool is_beside_eye(int v) const {
    constexpr double reach = 0.024;  // metres from the centre of an eye: twice its radius
    const Vector3d p = head_.volume.V.row(v);
    return std::min((p - head_.left_eye_centre).norm(), (p - head_.right_eye_centre).norm()) < reach;
  }

  const HeadTemplate& head_;
  const BlendshapeOptions& options_;
  VectorXi soft_;
  VectorXi below_;
  MatrixX4i neighbours_;
  TetRest rest_;
  std::vector<int> held_;
  ProjectiveDynamics transfer_;
  ProjectiveDynamics hold_;
};

/// What has to be added to `base` for a blend of both to give `sum`.
VolumetricShape difference(const VolumetricShape& sum, const VolumetricShape& base) {
  std::vector<int> tets;
  std::set_union(sum.tets.begin(), sum.tets.end(), base.tets.begin(), base.tets.end(), std::back_inserter(tets));
  VolumetricShape out = sum;
  out.jaw -= base.jaw;
  out.displacement -= base.displacement;
  out.tets = Eigen::Map<const VectorXi>(tets.data(), static_cast<Eigen::Index>(tets.size()));
  out.log_rotation.setZero(out.tets.size(), 3);
  out.stretch.setZero(out.tets.size(), 6);
  for (const auto& [shape, sign] : {std::pair{&sum, 1.0F}, {&base, -1.0F}})
    for (Eigen::Index i = 0, at = 0; i < shape->tets.size(); ++i) {
      while (out.tets[at] != shape->tets[i]) ++at;
      out.log_rotation.row(at) += sign * shape->log_rotation.row(i);
      out.stretch.row(at) += sign * shape->stretch.row(i);
    }
  return out;
}

}  // namespace

Vector3d rotation_logarithm(const Matrix3d& R) {
  const Eigen::AngleAxisd turn(R);
  return turn.angle() * turn.axis();
}

VolumetricShape shape_of_gradients(const std::string& name, const JawPose& jaw, const VectorXi& tets,
                                   const std::vector<Matrix3d>& gradients, double least_strain) {
  std::vector<Eigen::Index> kept;
  MatrixX3d logs(tets.size(), 3);
  Eigen::Matrix<double, Eigen::Dynamic, 6> stretches(tets.size(), 6);
  for (Eigen::Index t = 0; t < tets.size(); ++t) {
    const Svd3 svd = svd3(gradients[static_cast<std::size_t>(t)]);
    const Matrix3d S = svd.V * (svd.s - Vector3d::Ones()).asDiagonal() * svd.V.transpose();
    logs.row(t) = rotation_logarithm(svd.U * svd.V.transpose());
    stretches.row(t) << S(0, 0), S(1, 1), S(2, 2), S(0, 1), S(0, 2), S(1, 2);
    if (logs.row(t).norm() > least_strain || svd.s.cwiseAbs().maxCoeff() > 1 + least_strain ||
        svd.s[2] < 1 - least_strain)
      kept.push_back(t);
  }
  VolumetricShape shape;
  shape.name = name;
  shape.jaw = jaw;
  shape.tets = tets(kept);
  shape.log_rotation = logs(kept, Eigen::all).cast<float>();
  shape.stretch = stretches(kept, Eigen::all).cast<float>();
  return shape;
}

FaceModel build_volumetric_blendshapes(HeadTemplate head, const BlendshapeOptions& options) {
  FaceModel model;
  {
    ShapeSolver solver(head, options);
    const Expression* open = find_expression(head, "jawOpen");
    for (const Expression& expression : head.expressions) {
      if (interrupted()) fail("stopped while building volumetric blendshapes");
      SolveStatistics statistics;
      if (expression.name == "mouthClose" && open != nullptr) {
        // Lips that meet over an open jaw: with the jaw closed the shape would turn them inside out.
        Expression both{expression.name, open->displacement + expression.displacement, open->jaw + expression.jaw};
        SolveStatistics again;
        model.shapes.push_back(
            difference(solver.solve(both, drawn_out, statistics), solver.solve(*open, usual, again)));
      } else {
        const bool unfolds = expression.name.starts_with("eyeBlink");
        model.shapes.push_back(solver.solve(expression, unfolds ? drawn_out : usual, statistics));
      }
      if (options.report) options.report(expression.name, statistics);
    }
  }
  model.head = std::move(head);
  return model;
}

}  // namespace phiz
