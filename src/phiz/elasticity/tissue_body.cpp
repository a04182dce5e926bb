// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/elasticity/tissue_body.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <string>

#include "phiz/core/error.h"
#include "phiz/core/parallel.h"

namespace phiz {

namespace {

using Matrix12d = Eigen::Matrix<double, 12, 12>;

constexpr std::ptrdiff_t grain = 64;

/// F as a 9-vector from the twelve coordinates of the corners.
Eigen::Matrix<double, 9, 12> gradient_operator(const Eigen::Matrix<double, 3, 4>& hats) {
  Eigen::Matrix<double, 9, 12> G = Eigen::Matrix<double, 9, 12>::Zero();
  for (int corner = 0; corner < 4; ++corner)
    for (int column = 0; column < 3; ++column)
      G.block<3, 3>(3 * column, 3 * corner) = hats(column, corner) * Matrix3d::Identity();
  return G;
}

void require_per_tet(const VectorXd& values, const TissueBody& body, const std::string& what, double least,
                     double most) {
  if (values.size() == 0) return;
  if (values.size() != body.tets.rows())
    reject("tissue body", "has " + std::to_string(values.size()) + " values of " + what + " for " +
                              std::to_string(body.tets.rows()) + " tets");
  for (Eigen::Index t = 0; t < values.size(); ++t)
    if (!(values[t] >= least && values[t] <= most))
      reject("tissue body", what + " of tet " + std::to_string(t) + " is " + std::to_string(values[t]));
}

void require_slides(const std::vector<Slide>& slides, Eigen::Index n) {
  for (const Slide& slide : slides)
    if (slide.vertex < 0 || slide.vertex >= n || !slide.point.allFinite() || !slide.bend.allFinite() ||
        !(std::abs(slide.normal.norm() - 1) < 1e-6))
      reject("tissue body", "the slide of vertex " + std::to_string(slide.vertex) + " is malformed");
}

}  // namespace

void validate(const TissueBody& body) {
  const Eigen::Index n = body.rest.rows();
  if (!body.rest.allFinite() || !body.gravity.allFinite()) reject("tissue body", "has positions that are no numbers");
  if (body.tets.rows() == 0) reject("tissue body", "has no tets");
  if (body.tets.minCoeff() < 0 || body.tets.maxCoeff() >= n) reject("tissue body", "a tet names a missing vertex");
  if (body.moduli.size() != static_cast<std::size_t>(body.tets.rows()))
    reject("tissue body", "needs moduli for every tet");
  for (std::size_t t = 0; t < body.moduli.size(); ++t)
    if (!(body.moduli[t].mu > 0 && body.moduli[t].lambda >= 0 && std::isfinite(body.moduli[t].mu) &&
          std::isfinite(body.moduli[t].lambda)))
      reject("tissue body", "the moduli of tet " + std::to_string(t) + " are not positive");
  require_per_tet(body.active, body, "the active share", 0, 1);
  require_per_tet(body.growth, body, "growth", 1e-3, 1e3);
  require_per_tet(body.density, body, "density", 0, 1e6);
  if (body.added_mass.size() != 0 &&
      (body.added_mass.size() != n || !(body.added_mass.minCoeff() >= 0) || !body.added_mass.allFinite()))
    reject("tissue body", "needs an added mass of 0 or more for every vertex");
  if (body.pinned.size() != static_cast<std::size_t>(n)) reject("tissue body", "needs a pin flag for every vertex");
  require_slides(body.slides, n);
}

void put_on_slides(const TissueBody& body, MatrixX3d& x) {
  // To each surface of a vertex in turn; one or orthogonal planes need one round, curved surfaces a few.
  constexpr int rounds = 50;
  constexpr double close = 1e-15;  // metres
  for (int round = 0; round < rounds; ++round) {
    double farthest = 0;
    for (const Slide& slide : body.slides) {
      if (body.pinned[static_cast<std::size_t>(slide.vertex)] != 0) continue;
      const Vector3d p = x.row(slide.vertex), n = slide.gradient(p);
      const double height = slide.height(p);
      x.row(slide.vertex) -= height / n.squaredNorm() * n.transpose();
      farthest = std::max(farthest, std::abs(height));
    }
    if (farthest <= close) break;
  }
}

FreeMotion::FreeMotion(const TissueBody& body, const MatrixX3d& x)
    : first_(VectorXi::Constant(body.rest.rows(), -1)), directions_(static_cast<std::size_t>(body.rest.rows())) {
  std::vector<MatrixX3d> normals(directions_.size());
  for (const Slide& slide : body.slides) {
    MatrixX3d& all = normals[static_cast<std::size_t>(slide.vertex)];
    all.conservativeResize(all.rows() + 1, 3);
    all.row(all.rows() - 1) = slide.gradient(x.row(slide.vertex)).normalized().transpose();
  }
  std::vector<char> used(directions_.size(), 0);
  for (const int v : body.tets.reshaped()) used[static_cast<std::size_t>(v)] = 1;
  for (std::size_t v = 0; v < directions_.size(); ++v) {
    auto& directions = directions_[v];
    directions.resize(3, 0);
    if (used[v] == 0 || body.pinned[v] != 0) continue;
    if (normals[v].rows() == 0) {
      directions = Matrix3d::Identity();
    } else {
      constexpr double same = 1e-6;
      const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(normals[v].transpose() * normals[v]);  // ascending
      directions = eigen.eigenvectors().leftCols((eigen.eigenvalues().array() < same * same).count());
    }
    first_[static_cast<Eigen::Index>(v)] = static_cast<int>(size_);
    size_ += directions.cols();
  }
}

VectorXd FreeMotion::reduced(const MatrixX3d& force) const {
  VectorXd out(size_);
  for (std::size_t v = 0; v < directions_.size(); ++v)
    if (directions_[v].cols() > 0)
      out.segment(first_[static_cast<Eigen::Index>(v)], directions_[v].cols()) =
          directions_[v].transpose() * force.row(static_cast<Eigen::Index>(v)).transpose();
  return out;
}

MatrixX3d FreeMotion::expanded(const VectorXd& unknowns) const {
  MatrixX3d out = MatrixX3d::Zero(static_cast<Eigen::Index>(directions_.size()), 3);
  for (std::size_t v = 0; v < directions_.size(); ++v)
    if (directions_[v].cols() > 0)
      out.row(static_cast<Eigen::Index>(v)) =
          (directions_[v] * unknowns.segment(first_[static_cast<Eigen::Index>(v)], directions_[v].cols())).transpose();
  return out;
}

TissueEnergy::TissueEnergy(const TissueBody& body)
    : body_((validate(body), body)),
      rest_(tet_rest(body.rest, body.tets)),
      stretches_(static_cast<std::size_t>(body.tets.rows()), Matrix3d::Identity()),
      mass_(body.added_mass.size() > 0 ? body.added_mass : VectorXd::Zero(body.rest.rows())) {
  for (Eigen::Index t = 0; t < body_.tets.rows(); ++t) {
    if (body_.density.size() > 0)
      for (int k = 0; k < 4; ++k) mass_[body_.tets(t, k)] += body_.density[t] * rest_.volume[t] / 4;
    // F_elastic = F / s (phace.md section 7.2).
    if (body_.growth.size() > 0) rest_.inverse_edges[static_cast<std::size_t>(t)] /= body_.growth[t];
  }
}

void TissueEnergy::set_activation(const std::vector<Matrix3d>& stretches) {
  if (stretches.size() != stretches_.size())
    reject("activation",
           "has " + std::to_string(stretches.size()) + " stretches for " + std::to_string(stretches_.size()) + " tets");
  for (std::size_t t = 0; t < stretches.size(); ++t)
    if (!stretches[t].allFinite() || (stretches[t] - stretches[t].transpose()).norm() > 1e-9)
      reject("activation", "the stretch of tet " + std::to_string(t) + " is not symmetric");
  stretches_ = stretches;
}

void TissueEnergy::set_slides(const std::vector<Slide>& slides) {
  require_slides(slides, body_.rest.rows());
  body_.slides = slides;
}

void TissueEnergy::set_forces(const MatrixX3d& forces) {
  if (forces.rows() != 0 && (forces.rows() != body_.rest.rows() || !forces.allFinite()))
    reject("forces", "need one finite force for every vertex");
  forces_ = forces;
}

void TissueEnergy::set_inertia(double time_step, const MatrixX3d& prediction) {
  if (prediction.rows() != 0 && (prediction.rows() != body_.rest.rows() || !prediction.allFinite() || !(time_step > 0)))
    reject("inertia", "needs a positive time step and one finite prediction for every vertex");
  time_step_ = time_step;
  prediction_ = prediction;
}

double TissueEnergy::tet_energy(Eigen::Index tet, const Matrix3d& F) const {
  const auto t = static_cast<std::size_t>(tet);
  const Moduli& m = body_.moduli[t];
  const double muscle = active(tet);
  const double passive =
      body_.passive == PassiveLaw::corotated ? corotated_energy(F, Matrix3d::Identity(), m) : neo_hookean_energy(F, m);
  return (1 - muscle) * passive + (muscle > 0 ? muscle * corotated_energy(F, stretches_[t], m) : 0);
}

Matrix3d TissueEnergy::tet_stress(Eigen::Index tet, const Matrix3d& F) const {
  const auto t = static_cast<std::size_t>(tet);
  const Moduli& m = body_.moduli[t];
  const double muscle = active(tet);
  Matrix3d P = (1 - muscle) * (body_.passive == PassiveLaw::corotated ? corotated_stress(F, Matrix3d::Identity(), m)
                                                                      : neo_hookean_stress(F, m));
  if (muscle > 0) P += muscle * corotated_stress(F, stretches_[t], m);
  return P;
}

Matrix9d TissueEnergy::tet_stiffness(Eigen::Index tet, const Matrix3d& F, Stiffness kind) const {
  const auto t = static_cast<std::size_t>(tet);
  const Moduli& m = body_.moduli[t];
  const double muscle = active(tet);
  Matrix9d H =
      (1 - muscle) * (body_.passive == PassiveLaw::corotated ? corotated_stiffness(F, Matrix3d::Identity(), m, kind)
                                                             : neo_hookean_stiffness(F, m, kind));
  if (muscle > 0) H += muscle * corotated_stiffness(F, stretches_[t], m, kind);
  return H;
}

double TissueEnergy::value(const MatrixX3d& x) const {
  const double elastic = parallel_sum(body_.tets.rows(), grain, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    double sum = 0;
    for (std::ptrdiff_t t = begin; t < end; ++t) sum += rest_.volume[t] * tet_energy(t, elastic_gradient(x, t));
    return sum;
  });
  double value = elastic - mass_.dot(x * body_.gravity);
  if (forces_.rows() > 0) value -= forces_.cwiseProduct(x).sum();
  if (prediction_.rows() > 0)
    value += mass_.dot((x - prediction_).rowwise().squaredNorm()) / (2 * time_step_ * time_step_);
  return value;
}

MatrixX3d TissueEnergy::gradient(const MatrixX3d& x, VectorXd* magnitude) const {
  std::vector<Eigen::Matrix<double, 3, 4>> forces(static_cast<std::size_t>(body_.tets.rows()));
  parallel_for(
      body_.tets.rows(),
      [&](std::ptrdiff_t t) {
        const auto s = static_cast<std::size_t>(t);
        forces[s] = rest_.volume[t] * tet_stress(t, elastic_gradient(x, t)) * hat_gradients(rest_.inverse_edges[s]);
      },
      grain);
  MatrixX3d out = -mass_ * body_.gravity.transpose();
  if (forces_.rows() > 0) out -= forces_;
  if (prediction_.rows() > 0) out += (mass_ / (time_step_ * time_step_)).asDiagonal() * (x - prediction_);
  if (magnitude != nullptr) *magnitude = out.rowwise().norm();
  for (Eigen::Index t = 0; t < body_.tets.rows(); ++t)
    for (int k = 0; k < 4; ++k) {
      const auto& force = forces[static_cast<std::size_t>(t)];
      out.row(body_.tets(t, k)) += force.col(k).transpose();
      if (magnitude != nullptr) (*magnitude)[body_.tets(t, k)] += force.col(k).norm();
    }
  return out;
}

SparseMatrixd TissueEnergy::hessian(const MatrixX3d& x, const FreeMotion& motion, Stiffness kind) const {
  std::vector<Matrix12d> blocks(static_cast<std::size_t>(body_.tets.rows()));
  parallel_for(
      body_.tets.rows(),
      [&](std::ptrdiff_t t) {
        const auto s = static_cast<std::size_t>(t);
        const Eigen::Matrix<double, 9, 12> G = gradient_operator(hat_gradients(rest_.inverse_edges[s]));
        blocks[s] = rest_.volume[t] * G.transpose() * tet_stiffness(t, elastic_gradient(x, t), kind) * G;
      },
      grain);
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(blocks.size() * 144);
  const auto add_block = [&](int a, int b, const Matrix3d& block) {
    const int row = motion.first(a), column = motion.first(b);
    if (row < 0 || column < 0) return;
    const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3> reduced =
        motion.directions(a).transpose() * block * motion.directions(b);
    for (Eigen::Index i = 0; i < reduced.rows(); ++i)
      for (Eigen::Index k = 0; k < reduced.cols(); ++k)
        entries.emplace_back(row + static_cast<int>(i), column + static_cast<int>(k), reduced(i, k));
  };
  for (Eigen::Index t = 0; t < body_.tets.rows(); ++t)
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < 4; ++b)
        add_block(body_.tets(t, a), body_.tets(t, b), blocks[static_cast<std::size_t>(t)].block<3, 3>(3 * a, 3 * b));
  if (prediction_.rows() > 0)
    for (int v = 0; v < mass_.size(); ++v) add_block(v, v, mass_[v] / (time_step_ * time_step_) * Matrix3d::Identity());
  if (kind == Stiffness::exact && !body_.slides.empty()) {
    const MatrixX3d g = gradient(x);
    for (const Slide& slide : body_.slides) {
      const Vector3d n = slide.gradient(x.row(slide.vertex));
      add_block(slide.vertex, slide.vertex, g.row(slide.vertex).dot(n) / n.squaredNorm() * slide.bend);
    }
  }
  SparseMatrixd H(motion.size(), motion.size());
  H.setFromTriplets(entries.begin(), entries.end());
  return H;
}

MatrixX3d TissueEnergy::gradient_change(const MatrixX3d& x, const MatrixX3d& d) const {
  std::vector<Eigen::Matrix<double, 3, 4>> changes(static_cast<std::size_t>(body_.tets.rows()));
  parallel_for(
      body_.tets.rows(),
      [&](std::ptrdiff_t t) {
        const auto s = static_cast<std::size_t>(t);
        const Eigen::Matrix<double, 3, 4> hats = hat_gradients(rest_.inverse_edges[s]);
        const Matrix3d dF = d(body_.tets.row(t), Eigen::all).transpose() * hats.transpose();
        const Eigen::Matrix<double, 9, 1> dP =
            tet_stiffness(t, elastic_gradient(x, t), Stiffness::exact) * dF.reshaped();
        changes[s] = rest_.volume[t] * Eigen::Map<const Matrix3d>(dP.data()) * hats;
      },
      grain);
  MatrixX3d out = MatrixX3d::Zero(x.rows(), 3);
  if (prediction_.rows() > 0) out = (mass_ / (time_step_ * time_step_)).asDiagonal() * d;
  for (Eigen::Index t = 0; t < body_.tets.rows(); ++t)
    for (int k = 0; k < 4; ++k) out.row(body_.tets(t, k)) += changes[static_cast<std::size_t>(t)].col(k).transpose();
  return out;
}

SparseMatrixd TissueEnergy::gradient_by_activation(const MatrixX3d& x, const FreeMotion& motion,
                                                   const VectorXi& tets) const {
  std::vector<Eigen::Matrix<double, 12, 6>> blocks(static_cast<std::size_t>(tets.size()));
  parallel_for(
      tets.size(),
      [&](std::ptrdiff_t k) {
        const int t = tets[k];
        const auto s = static_cast<std::size_t>(t);
        blocks[static_cast<std::size_t>(k)] =
            rest_.volume[t] * active(t) * gradient_operator(hat_gradients(rest_.inverse_edges[s])).transpose() *
            corotated_stress_by_activation(elastic_gradient(x, t), stretches_[s], body_.moduli[s]);
      },
      grain);
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(blocks.size() * 72);
  for (Eigen::Index k = 0; k < tets.size(); ++k)
    for (int a = 0; a < 4; ++a) {
      const int vertex = body_.tets(tets[k], a), row = motion.first(vertex);
      if (row < 0) continue;
      const MatrixXd reduced =
          motion.directions(vertex).transpose() * blocks[static_cast<std::size_t>(k)].middleRows<3>(3 * a);
      for (Eigen::Index i = 0; i < reduced.rows(); ++i)
        for (int c = 0; c < 6; ++c)
          entries.emplace_back(row + static_cast<int>(i), static_cast<int>(6 * k) + c, reduced(i, c));
    }
  SparseMatrixd out(motion.size(), 6 * tets.size());
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

}  // namespace phiz
