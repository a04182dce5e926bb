// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/face/torture.h"

#include <algorithm>
#include <cstdio>

#include "phiz/core/error.h"
#include "phiz/core/progress.h"
#include "phiz/face/flesh.h"
#include "phiz/face/muscle_contraction.h"

namespace phiz {

namespace {

std::string two_digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", value);
  return text;
}

}  // namespace

PoseMaker::PoseMaker(const FaceModel& model, const std::vector<ActivationShape>& shapes, const TissueOptions& options,
                     std::uint64_t seed)
    : head_(model.head),
      shapes_(shapes),
      tissue_(head_tissue(head_, options)),
      blender_(shapes, tissue_),
      seed_(seed) {}

VectorXd PoseMaker::random_weights(Random& random, double most, std::string& what) const {
  constexpr std::uint32_t most_expressions = 8;
  VectorXd weights = VectorXd::Zero(static_cast<Eigen::Index>(shapes_.size()));
  if (shapes_.empty()) return weights;
  const std::uint32_t count = 1 + random.below(most_expressions);
  for (std::uint32_t k = 0; k < count; ++k) {
    const auto shape = random.below(static_cast<std::uint32_t>(shapes_.size()));
    weights[shape] = random.uniform(0, most);
  }
  for (std::size_t j = 0; j < shapes_.size(); ++j)
    if (const double w = weights[static_cast<Eigen::Index>(j)]; w > 0)
      what += shapes_[j].name + " " + two_digits(w) + ", ";
  return weights;
}

JawPose PoseMaker::random_jaw(Random& random, double scale) const {
  JawPose jaw;
  for (int k = 0; k < 5; ++k) jaw[k] = scale * random.uniform(head_.jaw.lower[k], head_.jaw.upper[k]);
  return jaw;
}

TorturePose PoseMaker::pose(int number, bool beyond) const {
  Random random(seed_, 2 * static_cast<std::uint64_t>(number) + (beyond ? 1 : 0));
  TorturePose pose;
  enum { expressions, expressions_and_jaw, muscles };
  const int kind = number % 3;
  const double jaw_scale = beyond ? 1.5 : 1;
  if (kind == muscles) {
    pose.what = "muscles, ";
    VectorXd gamma(static_cast<Eigen::Index>(head_.muscles.size()));
    for (double& g : gamma) g = beyond ? random.uniform(0.5, 1.5) : random.uniform(0.7, 1.3);
    pose.stretches = contract_muscles(head_, tissue_, gamma);
  } else {
    const VectorXd weights = random_weights(random, beyond ? 2 : 1, pose.what);
    pose.stretches = blender_.blend(weights);
    pose.jaw = blend_jaw(head_.jaw, shapes_, weights);
  }
  if (kind != expressions || beyond) pose.jaw = random_jaw(random, jaw_scale);
  pose.what += "jaw " + two_digits(pose.jaw[0]) + " " + two_digits(pose.jaw[1]) + " rad";
  for (int k = 2; k < 5; ++k) pose.what += " " + two_digits(1e3 * pose.jaw[k]);
  pose.what += " mm";
  return pose;
}

std::vector<TortureResult> torture(const FaceModel& model, const TortureOptions& options,
                                   const std::function<void(const TortureResult&)>& on_result) {
  const std::vector<ActivationShape> shapes =
      estimate_activations(model, head_tissue(model.head, options.simulation.tissue));
  const PoseMaker maker(model, shapes, options.simulation.tissue, options.seed);
  MuscleSimulation simulation(model, shapes, options.simulation);
  std::vector<TortureResult> results;
  for (int k = 0; k < options.poses + options.beyond && !interrupted(); ++k) {
    TortureResult result;
    result.beyond = k >= options.poses;
    result.number = options.first + (result.beyond ? k - options.poses : k);
    result.from_neutral = k == 0 || result.number % 2 == 0;
    const TorturePose pose = maker.pose(result.number, result.beyond);
    result.what = pose.what;
    if (result.from_neutral) simulation.forget();
    try {
      result.statistics = simulation.solve_static(pose.stretches, pose.jaw);
    } catch (const Error& error) {
      result.error = error.what();
    }
    result.finite = simulation.positions().allFinite();
    result.penetration = result.finite ? simulation.penetration() : 0;
    if (on_result) on_result(result);
    results.push_back(std::move(result));
  }
  return results;
}

}  // namespace phiz
