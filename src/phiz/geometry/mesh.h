// SPDX-License-Identifier: GPL-3.0-or-later
/// The mesh values that every other folder passes around. One row per vertex or element, as in libigl; metres.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <string>
#include <vector>

namespace phiz {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Eigen::VectorXi;
using MatrixX2d = Eigen::Matrix<double, Eigen::Dynamic, 2>;
using MatrixX3d = Eigen::Matrix<double, Eigen::Dynamic, 3>;
using MatrixX2i = Eigen::Matrix<int, Eigen::Dynamic, 2>;
using MatrixX3i = Eigen::Matrix<int, Eigen::Dynamic, 3>;
using MatrixX4i = Eigen::Matrix<int, Eigen::Dynamic, 4>;
using SparseMatrixd = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// A triangle surface, optionally with texture coordinates on its own index set.
struct TriangleMesh {
  MatrixX3d V;    ///< vertex positions, n x 3
  MatrixX3i F;    ///< triangles, counter-clockwise seen from outside, m x 3
  MatrixX2d UV;   ///< texture coordinates, k x 2, empty when there are none; v points up
  MatrixX3i FUV;  ///< rows of UV per triangle corner, m x 3, empty when there are none
};

/// A polygon surface as modellers exchange it: quads and larger faces, groups, texture coordinates.
struct PolygonMesh {
  MatrixX3d V;                             ///< vertex positions, n x 3
  std::vector<std::vector<int>> faces;     ///< vertex rows per face, counter-clockwise seen from outside
  MatrixX2d UV;                            ///< texture coordinates, k x 2, or empty
  std::vector<std::vector<int>> face_uvs;  ///< rows of UV per face corner, or empty
  std::vector<int> face_group;             ///< row of `groups` per face, or empty
  std::vector<std::string> groups;         ///< group names
};

/// A tetrahedral mesh. Tets are positively oriented: det[x1-x0, x2-x0, x3-x0] > 0.
struct TetMesh {
  MatrixX3d V;      ///< vertex positions, n x 3
  MatrixX4i T;      ///< tets, m x 4
  VectorXi region;  ///< region tag per tet, m
};

}  // namespace phiz
