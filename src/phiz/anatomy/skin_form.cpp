// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/skin_form.h"

#include <Eigen/SparseCholesky>
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

void fair(SkinForm& form) {
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
  Eigen::SparseMatrix<double> A = L.transpose() * L;
  MatrixX3d b = MatrixX3d::Zero(n, 3);
  for (int v = 0; v < n; ++v) {
    A.coeffRef(v, v) += form.weight[v];
    b.row(v) = form.weight[v] * form.X.row(v);
  }
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(A);
  if (solver.info() != Eigen::Success) fail("the skin's smoothing equations could not be solved");
  form.X = solver.solve(b);
  for (int v = 0; v < topology.left_count(); ++v) {
    const int w = topology.mirror(v);
    if (w == v) {
      form.X(v, 0) = 0;
      continue;
    }
    const Vector3d p(0.5 * (form.X(v, 0) - form.X(w, 0)), 0.5 * (form.X(v, 1) + form.X(w, 1)),
                     0.5 * (form.X(v, 2) + form.X(w, 2)));
    form.X.row(v) = p.transpose();
    form.X.row(w) = Eigen::RowVector3d(-p.x(), p.y(), p.z());
  }
}

}  // namespace phiz
