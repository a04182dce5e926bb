// SPDX-License-Identifier: GPL-3.0-or-later
/// Faces that tests of forward physics move: the face in miniature and a preview head with four expressions.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "face/small_face.h"
#include "phiz/anatomy/builtin/builtin_head.h"
#include "phiz/face/volumetric_blendshapes.h"

namespace phiz::testing {

/// The small face with a muscle that fills all of it.
inline const FaceModel& small_model() {
  static const FaceModel model = [] {
    HeadTemplate head = small_head();
    Muscle muscle;
    muscle.name = "lips";
    muscle.tets = VectorXi::LinSpaced(head.volume.T.rows(), 0, static_cast<int>(head.volume.T.rows()) - 1);
    muscle.fraction = VectorXd::Constant(head.volume.T.rows(), 0.5);
    muscle.direction = MatrixX3d::Zero(head.volume.T.rows(), 3);
    muscle.direction.col(0).setOnes();
    head.muscles.push_back(muscle);
    return build_volumetric_blendshapes(std::move(head));
  }();
  return model;
}

/// The built-in preview head with jawOpen, both sides of mouthSmile, and mouthPucker.
inline const FaceModel& preview_model() {
  static const FaceModel model = [] {
    BuiltinOptions options;
    options.size = HeadSize::preview;
    HeadTemplate head = build_builtin_head(options);
    std::erase_if(head.expressions, [](const Expression& e) {
      return e.name != "jawOpen" && !e.name.starts_with("mouthSmile") && e.name != "mouthPucker";
    });
    return build_volumetric_blendshapes(std::move(head));
  }();
  return model;
}

/// Weights of a model's shapes, zero for those that are not named.
inline VectorXd weights_of(const FaceModel& model, const std::map<std::string, double>& named) {
  VectorXd weights = VectorXd::Zero(static_cast<Eigen::Index>(model.shapes.size()));
  for (std::size_t m = 0; m < model.shapes.size(); ++m)
    if (const auto found = named.find(model.shapes[m].name); found != named.end())
      weights[static_cast<Eigen::Index>(m)] = found->second;
  return weights;
}

inline double largest_distance(const MatrixX3d& a, const MatrixX3d& b) {
  return (a - b).rowwise().norm().maxCoeff();
}

inline Eigen::Isometry3d place_at(const Vector3d& p) {
  Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
  place.translation() = p;
  return place;
}

}  // namespace phiz::testing
