// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/open/kit_expressions.h"

#include <algorithm>
#include <string>

#include "phiz/anatomy/expression_names.h"
#include "phiz/anatomy/open/face_kit_layout.h"
#include "phiz/anatomy/open/jaw_of_mandible.h"
#include "phiz/geometry/geodesic.h"
#include "phiz/numerics/rbf.h"

namespace phiz {

namespace {

/// The shapes of the kit that make up an expression, and how much of each.
struct Share {
  std::string shape;
  double weight = 1;
};

std::vector<Share> shares(const std::string& name) {
  if (name == "browInnerUp" || name == "cheekPuff") return {{name + "_L"}, {name + "_R"}};
  if (name == "tongueOut") return {{"jawOpen", 0.35}, {"mouthFunnel", 0.25}};
  // The kit's lids stop short of each other, and flesh lags behind what is asked of it.
  constexpr double closed = 1.15;
  if (name == "eyeBlinkLeft") return {{"eyeBlink_L", closed}};
  if (name == "eyeBlinkRight") return {{"eyeBlink_R", closed}};
  if (name.starts_with("jaw") || name == "mouthLeft" || name == "mouthRight") return {{name}};
  if (name.ends_with("Left")) return {{name.substr(0, name.size() - 4) + "_L"}};
  if (name.ends_with("Right")) return {{name.substr(0, name.size() - 5) + "_R"}};
  return {{name}};
}

/// Moves the lining of an eye socket, from the roots of the lashes inwards, as the lids in front of it move, and holds
/// its depth.
void follow_lids(const FaceKitSkin& skin, std::size_t side, std::vector<Expression>& expressions) {
  constexpr double near = 0.012, deep = 0.010, inside = 0.75;  // metres; share of the way from the lashes inwards
  const auto from = [&](const std::vector<int>& line) { return edge_distances(skin.mesh.V, skin.mesh.F, line); };
  const VectorXd upper = from(skin.upper_lashes[side]), lower = from(skin.lower_lashes[side]);
  const VectorXd behind = from(skin.socket_lines[side]);
  std::vector<char> socket(static_cast<std::size_t>(skin.mesh.V.rows()), 0);
  for (const int v : skin.regions.at(side == 0 ? "leftSocket" : "rightSocket")) socket[static_cast<std::size_t>(v)] = 1;
  std::vector<int> lining, fronts, depth;
  for (int v = 0; v < skin.mesh.V.rows(); ++v) {
    const bool is_upper = upper[v] < lower[v];
    const double way = behind(is_upper ? skin.upper_lashes[side] : skin.lower_lashes[side]).mean();
    if (socket[static_cast<std::size_t>(v)] != 0 && behind[v] > deep)
      depth.push_back(v);
    else if (socket[static_cast<std::size_t>(v)] != 0 || behind[v] < inside * way)
      lining.push_back(v);
    else if (std::min(upper[v], lower[v]) < near)
      fronts.push_back(v);
  }
  std::vector<int> centres = fronts;
  centres.insert(centres.end(), depth.begin(), depth.end());
  const auto columns = 3 * static_cast<Eigen::Index>(expressions.size());
  MatrixXd values = MatrixXd::Zero(static_cast<Eigen::Index>(centres.size()), columns);
  for (std::size_t e = 0; e < expressions.size(); ++e)
    values.block(0, 3 * static_cast<Eigen::Index>(e), static_cast<Eigen::Index>(fronts.size()), 3) =
        expressions[e].displacement(fronts, Eigen::all);
  const MatrixXd of_lining = Rbf(skin.mesh.V(centres, Eigen::all), values).evaluate(skin.mesh.V(lining, Eigen::all));
  for (std::size_t e = 0; e < expressions.size(); ++e) {
    MatrixX3d& displacement = expressions[e].displacement;
    displacement(lining, Eigen::all) = of_lining.middleCols<3>(3 * static_cast<Eigen::Index>(e));
    displacement(depth, Eigen::all).setZero();
  }
}

}  // namespace

std::vector<Expression> kit_expressions(const FaceKit& kit, const FaceKitSkin& skin, const JawJoint& joint,
                                        double* jaw_residual) {
  constexpr face_kit::Range lower = face_kit::lower_teeth_vertices;
  constexpr double still = 1e-4;  // metres; below this the lower teeth do not move
  const MatrixX3d teeth = kit.neutral.V.middleRows(lower.first, lower.end - lower.first);
  std::vector<Expression> all;
  if (jaw_residual != nullptr) *jaw_residual = 0;
  for (const std::string_view name : expression_names) {
    MatrixX3d moved = MatrixX3d::Zero(kit.neutral.V.rows(), 3);
    for (const auto& [shape, weight] : shares(std::string(name))) moved += weight * kit.expressions.at(shape);
    Expression e;
    e.name = name;
    e.displacement = MatrixX3d::Zero(skin.mesh.V.rows(), 3);
    e.displacement.topRows(face_kit::skin_vertices.end) = moved.topRows(face_kit::skin_vertices.end);
    const MatrixX3d of_teeth = moved.middleRows(lower.first, lower.end - lower.first);
    if (of_teeth.rowwise().norm().maxCoeff() > still) {
      double residual = 0;
      e.jaw = fit_jaw_pose(joint, teeth, teeth + of_teeth, &residual);
      if (jaw_residual != nullptr) *jaw_residual = std::max(*jaw_residual, residual);
    }
    all.push_back(std::move(e));
  }
  for (const std::size_t side : {0, 1}) follow_lids(skin, side, all);
  return all;
}

}  // namespace phiz
