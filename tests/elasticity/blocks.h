// SPDX-License-Identifier: GPL-3.0-or-later
/// Small bodies for the tests.
#pragma once

#include <vector>

#include "phiz/core/random.h"
#include "phiz/elasticity/projective_dynamics.h"
#include "phiz/geometry/mesh.h"

namespace phiz::testing {

/// A box of nx x ny x nz cells of six tets each, from `low` to `high`.
inline TetMesh box(const Vector3d& low, const Vector3d& high, int nx, int ny, int nz) {
  TetMesh mesh;
  const auto id = [=](int i, int j, int k) { return (k * (ny + 1) + j) * (nx + 1) + i; };
  mesh.V.resize((nx + 1) * (ny + 1) * (nz + 1), 3);
  for (int k = 0; k <= nz; ++k)
    for (int j = 0; j <= ny; ++j)
      for (int i = 0; i <= nx; ++i)
        mesh.V.row(id(i, j, k)) =
            low + (high - low).cwiseProduct(Vector3d(double(i) / nx, double(j) / ny, double(k) / nz));
  mesh.T.resize(6 * nx * ny * nz, 4);
  constexpr int orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {1, 0, 2}, {2, 1, 0}};
  Eigen::Index t = 0;
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i)
        for (int o = 0; o < 6; ++o) {
          int at[3] = {i, j, k};
          int corner[4];
          corner[0] = id(at[0], at[1], at[2]);
          for (int s = 0; s < 3; ++s) {
            ++at[orders[o][s]];
            corner[s + 1] = id(at[0], at[1], at[2]);
          }
          if (o > 2) std::swap(corner[2], corner[3]);
          mesh.T.row(t++) << corner[0], corner[1], corner[2], corner[3];
        }
  mesh.region = VectorXi::Ones(mesh.T.rows());
  return mesh;
}

/// A body of that mesh with the given weights; fixed where `is_fixed(position)`.
template <class Predicate>
ElasticBody body_of(const TetMesh& mesh, const TermWeights& weights, Predicate&& is_fixed) {
  ElasticBody body;
  body.rest = mesh.V;
  body.tets = mesh.T;
  body.weights = weights;
  body.stiffness = VectorXd::Constant(mesh.T.rows(), 3000.0);
  body.fixed.resize(static_cast<std::size_t>(mesh.V.rows()));
  for (Eigen::Index v = 0; v < mesh.V.rows(); ++v)
    body.fixed[static_cast<std::size_t>(v)] = is_fixed(Vector3d(mesh.V.row(v)));
  return body;
}

inline MatrixX3d shaken(const MatrixX3d& V, double amount, std::uint64_t seed) {
  Random random(seed);
  MatrixX3d out = V;
  for (Eigen::Index i = 0; i < out.size(); ++i) out.data()[i] += amount * random.normal();
  return out;
}

}  // namespace phiz::testing
