// SPDX-License-Identifier: GPL-3.0-or-later
/// Blocks of tissue for the tests of forward physics, and rigid things to press them with.
#pragma once

#include <algorithm>
#include <vector>

#include "elasticity/blocks.h"
#include "phiz/elasticity/contact.h"
#include "phiz/elasticity/tissue_body.h"
#include "phiz/geometry/topology.h"

namespace phiz::testing {

inline constexpr double length = 0.04, breadth = 0.03, depth = 0.02;  // metres, along x, y, z
inline constexpr Moduli flesh{1000, 3000};

inline TissueBody tissue_of(const TetMesh& mesh, const Moduli& moduli = flesh) {
  TissueBody body;
  body.rest = mesh.V;
  body.tets = mesh.T;
  body.moduli.assign(static_cast<std::size_t>(mesh.T.rows()), moduli);
  body.pinned.assign(static_cast<std::size_t>(mesh.V.rows()), 0);
  return body;
}

inline TissueBody block(const Moduli& moduli = flesh) {
  return tissue_of(box(Vector3d::Zero(), Vector3d(length, breadth, depth), 4, 3, 2), moduli);
}

template <class Predicate>
void pin(TissueBody& body, Predicate&& where) {
  for (Eigen::Index v = 0; v < body.rest.rows(); ++v)
    if (where(Vector3d(body.rest.row(v)))) body.pinned[static_cast<std::size_t>(v)] = 1;
}

template <class Predicate>
void slide(TissueBody& body, int axis, double offset, Predicate&& where) {
  for (Eigen::Index v = 0; v < body.rest.rows(); ++v) {
    const Vector3d p = body.rest.row(v);
    if (where(p)) body.slides.push_back({static_cast<int>(v), p + offset * Vector3d::Unit(axis), Vector3d::Unit(axis)});
  }
}

template <class Predicate>
VectorXi vertices_where(const TissueBody& body, Predicate&& where) {
  std::vector<int> found;
  for (Eigen::Index v = 0; v < body.rest.rows(); ++v)
    if (where(Vector3d(body.rest.row(v)))) found.push_back(static_cast<int>(v));
  return Eigen::Map<VectorXi>(found.data(), static_cast<Eigen::Index>(found.size()));
}

inline void weigh(TissueBody& body, const Vector3d& gravity) {
  body.density = VectorXd::Constant(body.tets.rows(), 1000);
  body.gravity = gravity;
}

inline std::vector<Matrix3d> everywhere(const TissueBody& body, const Matrix3d& S) {
  return std::vector<Matrix3d>(static_cast<std::size_t>(body.tets.rows()), S);
}

inline double total_volume(const TissueBody& body, const MatrixX3d& x) {
  return tet_volumes(x, body.tets).sum();
}

/// A rigid box.
inline TriangleMesh rigid_box(const Vector3d& low, const Vector3d& high, int cells = 1) {
  const TetMesh mesh = box(low, high, cells, cells, cells);
  return {mesh.V, boundary_triangles(mesh.T), {}, {}};
}

}  // namespace phiz::testing
