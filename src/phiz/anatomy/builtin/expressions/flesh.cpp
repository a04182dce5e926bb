// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/builtin/expressions/flesh.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "phiz/anatomy/head_template.h"
#include "phiz/core/error.h"
#include "phiz/core/parallel.h"
#include "phiz/geometry/operators.h"
#include "phiz/numerics/cholesky.h"

namespace phiz {
namespace {

constexpr double rigidity = 1.0;            ///< weight of |F - R|^2
constexpr double incompressibility = 20.0;  ///< weight of |F - P|^2, P the nearest matrix of determinant 1
constexpr double dermis = 8;                ///< stiffness of tets with a face on the skin, relative to the flesh below

constexpr double sideways_hold = 0.15;  ///< share of a pull's weight across its direction

/// Rotation of the polar decomposition of F, from the estimate `q` (Mueller et al. 2016).
void follow_rotation(const Matrix3d& F, Eigen::Quaterniond& q) {
  for (int i = 0; i < 4; ++i) {
    const Matrix3d R = q.toRotationMatrix();
    const Vector3d torque = R.col(0).cross(F.col(0)) + R.col(1).cross(F.col(1)) + R.col(2).cross(F.col(2));
    const double hold = std::abs(R.col(0).dot(F.col(0)) + R.col(1).dot(F.col(1)) + R.col(2).dot(F.col(2))) + 1e-9;
    const Vector3d omega = torque / hold;
    const double angle = omega.norm();
    if (angle < 1e-5) break;
    q = Eigen::Quaterniond(Eigen::AngleAxisd(angle, omega / angle)) * q;
    q.normalize();
  }
}

Matrix3d cofactor(const Matrix3d& F) {
  Matrix3d C;
  C.col(0) = F.col(1).cross(F.col(2));
  C.col(1) = F.col(2).cross(F.col(0));
  C.col(2) = F.col(0).cross(F.col(1));
  return C;
}

/// Projection of F to determinant 1 along the gradient of the determinant. A collapsed tet gets its rotation.
Matrix3d preserve_volume(const Matrix3d& F, const Matrix3d& rotation) {
  Matrix3d P = F.determinant() > 0.2 ? F : Matrix3d(0.5 * (F + rotation));
  for (int i = 0; i < 3; ++i) {
    const Matrix3d C = cofactor(P);
    const double excess = C.col(0).dot(P.col(0)) - 1, slope = C.squaredNorm();
    if (!(slope > 0.05)) return rotation;
    P -= C * (std::clamp(excess, -0.7, 0.7) / slope);
  }
  return P;
}

}  // namespace

struct FleshPoser::State {
  MatrixX3d rest;
  MatrixX4i tets;                                 ///< flesh tets with a free vertex
  std::vector<Eigen::Matrix<double, 3, 4>> hats;  ///< gradients of their hat functions
  VectorXd stiffness;                             ///< (rigidity + incompressibility) * rest volume per tet
  VectorXi carrier, unknown;                      ///< unknown: number among the free vertices or -1
  std::vector<int> free;
  std::vector<std::vector<std::pair<int, int>>> around;  ///< (tet, corner) per free vertex
  SparseMatrixd matrix;                                  ///< Laplacian of the free vertices
  SparseMatrixd coupling;                                ///< free x all, the columns of carried vertices
  VectorXd diagonal, jaw_share;

  MatrixX3d carried(const Eigen::Isometry3d& jaw) const {
    MatrixX3d X = rest;
    for (Eigen::Index v = 0; v < X.rows(); ++v)
      if (carrier[v] == static_cast<int>(Carrier::mandible)) X.row(v) = (jaw * Vector3d(rest.row(v))).transpose();
    return X;
  }
};

FleshPoser::FleshPoser(const TetMesh& volume, const VectorXi& carrier, const VectorXi& skin_vertices)
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.rest = volume.V;
  s.carrier = carrier;
  const auto is_free = [&](int v) { return carrier[v] == static_cast<int>(Carrier::flesh); };
  std::vector<int> kept;
  for (int t = 0; t < volume.T.rows(); ++t) {
    const auto T = volume.T.row(t);
    if (volume.region[t] == Tissue::flesh && (is_free(T[0]) || is_free(T[1]) || is_free(T[2]) || is_free(T[3])))
      kept.push_back(t);
  }
  s.tets.resize(static_cast<Eigen::Index>(kept.size()), 4);
  for (std::size_t i = 0; i < kept.size(); ++i) s.tets.row(static_cast<Eigen::Index>(i)) = volume.T.row(kept[i]);
  const TetRest rest = tet_rest(s.rest, s.tets);
  s.stiffness = (rigidity + incompressibility) * rest.volume;
  std::vector<char> skin(static_cast<std::size_t>(s.rest.rows()), 0);
  for (const int v : skin_vertices) skin[static_cast<std::size_t>(v)] = 1;
  for (Eigen::Index t = 0; t < s.tets.rows(); ++t) {
    int corners = 0;
    for (int k = 0; k < 4; ++k) corners += skin[static_cast<std::size_t>(s.tets(t, k))];
    if (corners >= 3) s.stiffness[t] *= dermis;
  }
  for (const Matrix3d& inverse : rest.inverse_edges) s.hats.push_back(hat_gradients(inverse));

  std::vector<char> used(static_cast<std::size_t>(s.rest.rows()), 0);
  for (Eigen::Index t = 0; t < s.tets.rows(); ++t)
    for (int k = 0; k < 4; ++k) used[static_cast<std::size_t>(s.tets(t, k))] = 1;
  s.unknown.setConstant(s.rest.rows(), -1);
  for (int v = 0; v < s.rest.rows(); ++v)
    if (used[static_cast<std::size_t>(v)] && is_free(v)) {
      s.unknown[v] = static_cast<int>(s.free.size());
      s.free.push_back(v);
    }
  const auto n = static_cast<Eigen::Index>(s.free.size());
  if (n == 0 || n == s.rest.rows())
    fail("the head has no free flesh, or no bone that holds it", "build the head with carried bone vertices");
  s.around.resize(s.free.size());
  std::vector<Eigen::Triplet<double>> own, others;
  for (int t = 0; t < s.tets.rows(); ++t) {
    const auto& G = s.hats[static_cast<std::size_t>(t)];
    const Eigen::Matrix4d K = s.stiffness[t] * (G.transpose() * G);
    for (int a = 0; a < 4; ++a) {
      const int row = s.unknown[s.tets(t, a)];
      if (row < 0) continue;
      s.around[static_cast<std::size_t>(row)].emplace_back(t, a);
      for (int b = 0; b < 4; ++b) {
        const int column = s.unknown[s.tets(t, b)];
        if (column >= 0)
          own.emplace_back(row, column, K(a, b));
        else
          others.emplace_back(row, s.tets(t, b), K(a, b));
      }
    }
  }
  s.matrix.resize(n, n);
  s.matrix.setFromTriplets(own.begin(), own.end());
  s.coupling.resize(n, s.rest.rows());
  s.coupling.setFromTriplets(others.begin(), others.end());
  s.diagonal = s.matrix.diagonal();

  VectorXd share = VectorXd::Zero(s.rest.rows());
  for (Eigen::Index v = 0; v < share.size(); ++v) share[v] = carrier[v] == static_cast<int>(Carrier::mandible) ? 1 : 0;
  const SparseCholesky factor(s.matrix);
  const VectorXd solved = factor.solve(VectorXd(-(s.coupling * share)));
  for (Eigen::Index i = 0; i < n; ++i) share[s.free[static_cast<std::size_t>(i)]] = std::clamp(solved[i], 0.0, 1.0);
  s.jaw_share = share;
}

FleshPoser::~FleshPoser() = default;
FleshPoser::FleshPoser(FleshPoser&&) noexcept = default;
FleshPoser& FleshPoser::operator=(FleshPoser&&) noexcept = default;

const VectorXd& FleshPoser::jaw_share() const {
  return state_->jaw_share;
}

MatrixX3d FleshPoser::pose(const std::vector<Handle>& handles, const std::vector<Pull>& pulls,
                           const std::vector<Obstacle>& obstacles, const Eigen::Isometry3d& jaw, int iterations,
                           const MatrixX3d& guess) const {
  const State& s = *state_;
  const auto n = static_cast<Eigen::Index>(s.free.size());
  VectorXd springs = VectorXd::Zero(n);
  MatrixX3d pull = MatrixX3d::Zero(n, 3);  // springs times targets
  for (const Handle& h : handles) {
    const int row = s.unknown[h.vertex];
    if (row < 0) continue;
    const double k = h.weight * s.diagonal[row];
    springs[row] += k;
    pull.row(row) += k * h.target.transpose();
  }
  for (const Pull& p : pulls)
    if (s.unknown[p.vertex] >= 0) springs[s.unknown[p.vertex]] += p.weight * s.diagonal[s.unknown[p.vertex]];
  for (const Obstacle& o : obstacles)
    for (const int v : o.vertices)
      if (s.unknown[v] >= 0) springs[s.unknown[v]] += o.weight * s.diagonal[s.unknown[v]];
  SparseMatrixd A = s.matrix;
  A.diagonal() += springs;
  const SparseCholesky factor(A);

  MatrixX3d X = s.carried(jaw);
  const MatrixX3d fixed_part = s.coupling * X;
  for (const int v : s.free) {  // the first guess turns every vertex by its share of the jaw's motion
    const Vector3d full = jaw * Vector3d(s.rest.row(v));
    const double w = s.jaw_share[v];
    X.row(v) = guess.rows() > 0 ? guess.row(v) : ((1 - w) * Vector3d(s.rest.row(v)) + w * full).transpose().eval();
  }
  const auto tets = static_cast<std::ptrdiff_t>(s.hats.size());
  std::vector<Eigen::Quaterniond> rotation(s.hats.size(), Eigen::Quaterniond::Identity());
  std::vector<Eigen::Matrix<double, 3, 4>> corner_force(s.hats.size());
  MatrixX3d right(n, 3);
  for (int iteration = 0; iteration < iterations; ++iteration) {
    parallel_chunks(tets, 2048, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (std::ptrdiff_t t = begin; t < end; ++t) {
        const auto i = static_cast<std::size_t>(t);
        Eigen::Matrix<double, 3, 4> corners;
        for (int k = 0; k < 4; ++k) corners.col(k) = X.row(s.tets(t, k)).transpose();
        const Matrix3d F = corners * s.hats[i].transpose();
        follow_rotation(F, rotation[i]);
        const Matrix3d R = rotation[i].toRotationMatrix();
        const Matrix3d goal =
            (rigidity * R + incompressibility * preserve_volume(F, R)) / (rigidity + incompressibility);
        corner_force[i] = s.stiffness[t] * (goal * s.hats[i]);
      }
    });
    MatrixX3d loads = pull;
    for (const Pull& p : pulls) {
      const int row = s.unknown[p.vertex];
      if (row < 0) continue;
      const Vector3d x = X.row(p.vertex), way = p.target - x;
      const Vector3d there = x + sideways_hold * way + (1 - sideways_hold) * p.direction.dot(way) * p.direction;
      loads.row(row) += (p.weight * s.diagonal[row]) * there.transpose();
    }
    for (const Obstacle& o : obstacles)
      for (std::size_t k = 0; k < o.vertices.size(); ++k) {
        const int row = s.unknown[o.vertices[k]];
        if (row < 0) continue;
        loads.row(row) += (o.weight * s.diagonal[row]) * o.allowed(k, Vector3d(X.row(o.vertices[k]))).transpose();
      }
    parallel_for(
        n,
        [&](std::ptrdiff_t v) {
          Vector3d sum = (loads.row(v) - fixed_part.row(v)).transpose();
          for (const auto& [t, corner] : s.around[static_cast<std::size_t>(v)])
            sum += corner_force[static_cast<std::size_t>(t)].col(corner);
          right.row(v) = sum.transpose();
        },
        512);
    const MatrixX3d solved = factor.solve(right);
    for (Eigen::Index v = 0; v < n; ++v) X.row(s.free[static_cast<std::size_t>(v)]) = solved.row(v);
  }
  return X;
}

}  // namespace phiz
