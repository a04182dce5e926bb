// SPDX-License-Identifier: GPL-3.0-or-later
/// Discrete differential operators with linear elements.
#pragma once

#include <vector>

#include "phiz/geometry/mesh.h"

namespace phiz {

/// Per-tet rest shape: everything that turns positions into deformation gradients.
struct TetRest {
  std::vector<Matrix3d> inverse_edges;  ///< Dm^-1 with Dm = [x1-x0, x2-x0, x3-x0], 1/metre
  VectorXd volume;                      ///< rest volumes, cubic metres, all positive
};

/// Throws phiz::Error(bad_input) naming the first tet that is not positive.
TetRest tet_rest(const MatrixX3d& V, const MatrixX4i& T);

/// Signed volumes det[x1-x0, x2-x0, x3-x0] / 6, cubic metres.
VectorXd tet_volumes(const MatrixX3d& V, const MatrixX4i& T);

/// Gradients of the four hat functions of a tet: column k is the gradient of the barycentric coordinate of corner k.
Eigen::Matrix<double, 3, 4> hat_gradients(const Matrix3d& inverse_edges);

/// F = Ds Dm^-1 per tet.
std::vector<Matrix3d> deformation_gradients(const MatrixX3d& V, const MatrixX4i& T, const TetRest& rest);
Matrix3d deformation_gradient(const MatrixX3d& V, const MatrixX4i& T, const TetRest& rest, Eigen::Index tet);

/// Sparse gradient operator, 3m x n: rows 3t..3t+2 of (G u) are the gradient of the piecewise linear u in tet t.
SparseMatrixd tet_gradient_operator(const MatrixX3d& V, const MatrixX4i& T);

/// Stiffness of the Laplacian on a triangle surface (Pinkall and Polthier 1993), n x n, symmetric positive
/// semidefinite: u^T L u = integral of weight |grad u|^2. Degenerate triangles contribute nothing; `weight` is one
/// number per triangle, 1 when empty.
SparseMatrixd cotangent_laplacian(const MatrixX3d& V, const MatrixX3i& F, const VectorXd& weight = {});

/// The same for tets (linear finite elements), units of metres; `weight` scales each tet when not empty.
SparseMatrixd tet_laplacian(const MatrixX3d& V, const MatrixX4i& T, const VectorXd& weight = {});

/// A third of the area of its triangles per vertex, square metres.
VectorXd lumped_triangle_mass(const MatrixX3d& V, const MatrixX3i& F);
/// A quarter of the volume of its tets per vertex times `density`, kilograms (cubic metres with the default).
VectorXd lumped_tet_mass(const MatrixX3d& V, const MatrixX4i& T, double density = 1.0);

/// Barycentric coordinates of the projection of p to the plane of a triangle; of the closest point of the longest edge
/// when the triangle is degenerate. Sums to 1, not clamped.
Vector3d barycentric(const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c);
/// Barycentric coordinates in a tet; sums to 1, not clamped. A flat tet gives a quarter each.
Eigen::Vector4d barycentric(const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c,
                            const Vector3d& d);

}  // namespace phiz
