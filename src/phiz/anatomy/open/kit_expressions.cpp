// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/open/kit_expressions.h"

#include <algorithm>
#include <string>

#include "phiz/anatomy/expression_names.h"
#include "phiz/anatomy/open/face_kit_layout.h"
#include "phiz/anatomy/open/jaw_of_mandible.h"

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
  if (name.starts_with("jaw") || name == "mouthLeft" || name == "mouthRight") return {{name}};
  if (name.ends_with("Left")) return {{name.substr(0, name.size() - 4) + "_L"}};
  if (name.ends_with("Right")) return {{name.substr(0, name.size() - 5) + "_R"}};
  return {{name}};
}

}  // namespace

std::vector<Expression> kit_expressions(const FaceKit& kit, Eigen::Index skin_vertices, const JawJoint& joint,
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
    e.displacement = MatrixX3d::Zero(skin_vertices, 3);
    e.displacement.topRows(face_kit::skin_vertices.end) = moved.topRows(face_kit::skin_vertices.end);
    const MatrixX3d of_teeth = moved.middleRows(lower.first, lower.end - lower.first);
    if (of_teeth.rowwise().norm().maxCoeff() > still) {
      double residual = 0;
      e.jaw = fit_jaw_pose(joint, teeth, teeth + of_teeth, &residual);
      if (jaw_residual != nullptr) *jaw_residual = std::max(*jaw_residual, residual);
    }
    all.push_back(std::move(e));
  }
  return all;
}

}  // namespace phiz
