// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/builtin/skin/form.h"

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <set>

#include "phiz/core/error.h"

namespace phiz {

SkinForm::SkinForm() {
  const int count = skin_topology().vertex_count();
  X.setZero(count, 3);
  weight.assign(count, 0.0);
  on_limit.assign(count, 1);
}

void SkinForm::place(int v, const Vector3d& p, double firmness) {
  const SkinTopology& topology = skin_topology();
  const int mirrored = topology.mirror(v);
  X.row(v) = p.transpose();
  if (mirrored == v)
    X(v, 0) = 0;
  else
    X.row(mirrored) = Eigen::RowVector3d(-p.x(), p.y(), p.z());
  weight[v] = weight[mirrored] = firmness;
}

void SkinForm::keep_control(int v) {
  on_limit[v] = on_limit[skin_topology().mirror(v)] = 0;
}

namespace {

/// Thin-plate energy of the cage over the metric of the positions X (n x 3): the squared Laplacian integrated over the
/// surface. The weights of an edge are the width of the faces beside it over its length. `areas` receives the area per
/// vertex.
Eigen::SparseMatrix<double> bending(const MatrixX3d& X, VectorXd& areas) {
  const Eigen::Index n = X.rows();
  std::vector<Eigen::Triplet<double>> entries;
  areas = VectorXd::Constant(n, 1e-6);
  for (const auto& face : skin_topology().faces()) {
    const auto p = [&](int k) -> Vector3d { return X.row(face[k % 4]); };
    const double area = 0.5 * (p(2) - p(0)).cross(p(3) - p(1)).norm();
    for (int k = 0; k < 4; ++k) {
      const int v = face[k], w = face[(k + 1) % 4];
      const double length2 = 0.5 * ((p(k + 1) - p(k)).squaredNorm() + (p(k + 3) - p(k + 2)).squaredNorm());
      const double conductance = std::clamp(0.5 * area / length2, 0.02, 20.0);
      entries.emplace_back(v, v, conductance);
      entries.emplace_back(w, w, conductance);
      entries.emplace_back(v, w, -conductance);
      entries.emplace_back(w, v, -conductance);
      areas[v] += area / 4;
    }
  }
  Eigen::SparseMatrix<double> K(n, n);
  K.setFromTriplets(entries.begin(), entries.end());
  const VectorXd inverse_areas = areas.cwiseMax(0.05).cwiseInverse();
  return K.transpose() * inverse_areas.asDiagonal() * K;
}

/// The least of x' A x + sum_r pull_r |(S x - place)_r|^2, for the three coordinates.
MatrixX3d least_bending(const Eigen::SparseMatrix<double>& A, const Eigen::SparseMatrix<double>& S,
                        const VectorXd& pull, const MatrixX3d& places) {
  const Eigen::SparseMatrix<double> pulled = S.transpose() * pull.asDiagonal();
  const Eigen::SparseMatrix<double> system = A + pulled * S;
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(system);
  if (solver.info() != Eigen::Success) fail("the skin's smoothing equations could not be solved");
  return solver.solve(pulled * places);
}

/// The graph Laplacian's energy, for a first guess without positions.
Eigen::SparseMatrix<double> graph_bending() {
  const SkinTopology& topology = skin_topology();
  const int n = topology.vertex_count();
  std::vector<std::set<int>> neighbours(n);
  for (const auto& face : topology.faces())
    for (int k = 0; k < 4; ++k) {
      neighbours[face[k]].insert(face[(k + 1) % 4]);
      neighbours[face[(k + 1) % 4]].insert(face[k]);
    }
  std::vector<Eigen::Triplet<double>> entries;
  for (int v = 0; v < n; ++v) {
    entries.emplace_back(v, v, 1.0);
    for (int w : neighbours[v]) entries.emplace_back(v, w, -1.0 / static_cast<double>(neighbours[v].size()));
  }
  Eigen::SparseMatrix<double> L(n, n);
  L.setFromTriplets(entries.begin(), entries.end());
  return L.transpose() * L;
}

void make_symmetric(MatrixX3d& X) {
  const SkinTopology& topology = skin_topology();
  for (int v = 0; v < topology.left_count(); ++v) {
    const int w = topology.mirror(v);
    if (w == v) {
      X(v, 0) = 0;
      continue;
    }
    const Vector3d p(0.5 * (X(v, 0) - X(w, 0)), 0.5 * (X(v, 1) + X(w, 1)), 0.5 * (X(v, 2) + X(w, 2)));
    X.row(v) = p.transpose();
    X.row(w) = Eigen::RowVector3d(-p.x(), p.y(), p.z());
  }
}

}  // namespace

void fair(SkinForm& form, const SparseMatrixd& limit_mask) {
  constexpr double smoothing_length = 3.0;  // millimetres: shorter waves of the places are ironed out
  const Eigen::Index n = form.X.rows();
  const MatrixX3d places = form.X;
  const VectorXd firmness = Eigen::Map<const VectorXd>(form.weight.data(), n);
  Eigen::SparseMatrix<double> identity(n, n);
  identity.setIdentity();
  form.X = least_bending(graph_bending(), identity, 10 * firmness, places);
  // Rows of the limit mask where the limit surface should pass through the place, else of the identity.
  std::vector<Eigen::Triplet<double>> entries;
  for (int v = 0; v < n; ++v) {
    if (!form.on_limit[v])
      entries.emplace_back(v, v, 1.0);
    else
      for (SparseMatrixd::InnerIterator it(limit_mask, v); it; ++it)
        entries.emplace_back(v, static_cast<int>(it.col()), it.value());
  }
  Eigen::SparseMatrix<double> sample(n, n);
  sample.setFromTriplets(entries.begin(), entries.end());
  for (int pass = 0; pass < 2; ++pass) {  // the metric comes from the form before
    VectorXd areas;
    const Eigen::SparseMatrix<double> A = bending(form.X, areas);
    form.X = least_bending(A, sample, firmness.cwiseProduct(areas) / std::pow(smoothing_length, 4), places);
  }
  make_symmetric(form.X);
}

}  // namespace phiz
