// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/face/activation.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "phiz/anatomy/sides.h"
#include "phiz/core/error.h"
#include "phiz/core/nearest_words.h"
#include "phiz/core/parallel.h"
#include "phiz/face/blend.h"
#include "phiz/face/flesh.h"

namespace phiz {

namespace {

constexpr std::size_t chunk = 512;  ///< active tets that are blended together

void require_weights(const VectorXd& weights, std::size_t shapes) {
  constexpr double most = 1e6;
  if (weights.size() != static_cast<Eigen::Index>(shapes) || !(weights.array().abs() <= most).all())
    reject("activation", "needs one weight per shape, none larger than a million");
}

/// Brings the eigenvalues of I + change back to their bounds; out: the six numbers of the stretch.
void bound_stretch(const float* change, float* out) {
  static constexpr float unit[6] = {1, 1, 1, 0, 0, 0};
  float square = 0;
  for (int k = 0; k < 6; ++k) {
    out[k] = unit[k] + change[k];
    square += (k < 3 ? 1.0F : 2.0F) * change[k] * change[k];
  }
  constexpr float safe = 1 - least_activation;  // no eigenvalue is farther from 1 than the norm
  static_assert(safe < most_activation - 1);
  if (square <= safe * safe) return;
  Matrix3d S;
  S << out[0], out[3], out[4], out[3], out[1], out[5], out[4], out[5], out[2];
  Eigen::SelfAdjointEigenSolver<Matrix3d> eigen;
  eigen.computeDirect(S);
  const Vector3d& s = eigen.eigenvalues();
  if (s[0] >= least_activation && s[2] <= most_activation) return;
  const Vector3d bounded = s.cwiseMax(least_activation).cwiseMin(most_activation);
  const Vector6d a = activation_of(eigen.eigenvectors() * bounded.asDiagonal() * eigen.eigenvectors().transpose());
  for (int k = 0; k < 6; ++k) out[k] = static_cast<float>(a[k]);
}

}  // namespace

JawPose blend_jaw(const JawJoint& joint, const std::vector<ActivationShape>& shapes, const VectorXd& weights) {
  require_weights(weights, shapes.size());
  JawPose pose = JawPose::Zero();
  for (std::size_t j = 0; j < shapes.size(); ++j) pose += weights[static_cast<Eigen::Index>(j)] * shapes[j].jaw;
  return clamp_to_limits(joint, pose);
}

ActivationBlender::ActivationBlender(const std::vector<ActivationShape>& shapes, const HeadTissue& tissue)
    : tets_(static_cast<std::size_t>(tissue.soft.size())) {
  std::vector<int> active;
  for (std::size_t t = 0; t < tets_; ++t)
    if (tissue.muscle[static_cast<Eigen::Index>(t)] > 0) active.push_back(static_cast<int>(t));
  active_ = Eigen::Map<const VectorXi>(active.data(), static_cast<Eigen::Index>(active.size()));
  const std::size_t chunks = (active.size() + chunk - 1) / chunk;
  for (const ActivationShape& shape : shapes) {
    if (shape.change.rows() != shape.tets.size() || !shape.change.allFinite() ||
        !std::is_sorted(shape.tets.begin(), shape.tets.end()))
      reject("activation of " + shape.name, "needs one finite change per tet, in order of tets");
    Piece piece;
    std::size_t at = 0;
    for (Eigen::Index i = 0; i < shape.tets.size(); ++i) {
      while (at < active.size() && tissue.soft[active[at]] < shape.tets[i]) ++at;
      if (at == active.size()) break;
      if (tissue.soft[active[at]] != shape.tets[i]) continue;
      piece.tets.push_back(static_cast<int>(at));
      piece.change.insert(piece.change.end(), shape.change.row(i).begin(), shape.change.row(i).end());
    }
    for (std::size_t c = 0; c <= chunks; ++c)
      piece.start.push_back(static_cast<std::size_t>(
          std::lower_bound(piece.tets.begin(), piece.tets.end(), static_cast<int>(c * chunk)) - piece.tets.begin()));
    pieces_.push_back(std::move(piece));
  }
}

std::vector<Matrix3d> ActivationBlender::blend(const VectorXd& weights) const {
  Stretches rows;
  blend(weights, rows);
  std::vector<Matrix3d> stretches(tets_, Matrix3d::Identity());
  for (Eigen::Index i = 0; i < rows.rows(); ++i)
    stretches[static_cast<std::size_t>(active_[i])] = activation_stretch(rows.row(i).transpose().cast<double>());
  return stretches;
}

void ActivationBlender::blend(const VectorXd& weights, Stretches& stretches) const {
  require_weights(weights, pieces_.size());
  stretches.resize(active_.size(), 6);
  const auto count = static_cast<std::size_t>(active_.size());
  const auto chunks = static_cast<std::ptrdiff_t>((count + chunk - 1) / chunk);
  parallel_for(
      chunks,
      [&](std::ptrdiff_t c) {
        const std::size_t first = static_cast<std::size_t>(c) * chunk, end = std::min(first + chunk, count);
        std::array<float, 6 * chunk> sum{};
        for (std::size_t j = 0; j < pieces_.size(); ++j) {
          const auto w = static_cast<float>(weights[static_cast<Eigen::Index>(j)]);
          if (std::abs(w) < least_blend_weight) continue;
          const Piece& piece = pieces_[j];
          for (std::size_t i = piece.start[static_cast<std::size_t>(c)];
               i < piece.start[static_cast<std::size_t>(c) + 1]; ++i) {
            float* to = sum.data() + 6 * (static_cast<std::size_t>(piece.tets[i]) - first);
            for (std::size_t k = 0; k < 6; ++k) to[k] += w * piece.change[6 * i + k];
          }
        }
        for (std::size_t a = first; a < end; ++a) bound_stretch(sum.data() + 6 * (a - first), stretches.data() + 6 * a);
      },
      1);
}

VectorXd innervation(const HeadTemplate& head, const HeadTissue& tissue, const VectorXd& gain_per_muscle) {
  if (gain_per_muscle.size() != static_cast<Eigen::Index>(head.muscles.size()) || !gain_per_muscle.allFinite())
    reject("innervation", "needs one finite gain per muscle");
  VectorXd gain = VectorXd::Zero(head.volume.T.rows()), share = gain;
  for (std::size_t m = 0; m < head.muscles.size(); ++m) {
    const Muscle& muscle = head.muscles[m];
    for (Eigen::Index i = 0; i < muscle.tets.size(); ++i) {
      gain[muscle.tets[i]] += muscle.fraction[i] * gain_per_muscle[static_cast<Eigen::Index>(m)];
      share[muscle.tets[i]] += muscle.fraction[i];
    }
  }
  VectorXd out(tissue.soft.size());
  for (Eigen::Index t = 0; t < out.size(); ++t)
    out[t] = share[tissue.soft[t]] > 0 ? gain[tissue.soft[t]] / share[tissue.soft[t]] : 1;
  return out;
}

VectorXd paralysis(const HeadTemplate& head, const HeadTissue& tissue, const std::vector<std::string>& paralysed) {
  VectorXd of_muscles = VectorXd::Ones(static_cast<Eigen::Index>(head.muscles.size()));
  VectorXd of_sides = VectorXd::Ones(tissue.soft.size());
  for (const std::string& word : paralysed) {
    if (word == "left" || word == "right") {
      const double side = word == "left" ? 1 : -1;
      for (Eigen::Index t = 0; t < of_sides.size(); ++t)
        for (int k = 0; k < 4; ++k) {
          const double x = side * head.volume.V(head.volume.T(tissue.soft[t], k), 0);
          of_sides[t] -= x > 1e-9 ? 0.25 : x < -1e-9 ? 0 : 0.125;
        }
      continue;
    }
    bool found = false;
    std::vector<std::string> names;
    for (std::size_t m = 0; m < head.muscles.size(); ++m) {
      const std::string& name = head.muscles[m].name;
      names.push_back(name);
      if (word != name && word != without_side(name)) continue;
      of_muscles[static_cast<Eigen::Index>(m)] = 0;
      found = true;
    }
    if (found) continue;
    const std::vector<std::string> near = nearest_words(word, names, 1);
    throw Error(ErrorKind::usage, "the head has no muscle '" + word + "'" +
                                      (near.empty() ? std::string() : "; did you mean " + near.front() + "?") +
                                      " Or say left or right for a whole side.");
  }
  return innervation(head, tissue, of_muscles).cwiseProduct(of_sides).cwiseMax(0).cwiseMin(1);
}

void scale_activation(const VectorXd& gain, Stretches& stretches) {
  if (gain.size() != stretches.rows()) reject("innervation", "needs one gain per stretch");
  if (!(gain.array() >= 0 && gain.array() <= 1).all()) reject("innervation", "gains must be in [0, 1]");
  for (Eigen::Index i = 0; i < stretches.rows(); ++i) {
    const auto g = static_cast<float>(gain[i]);
    for (int k = 0; k < 6; ++k) stretches(i, k) = (k < 3 ? 1 - g : 0) + g * stretches(i, k);
  }
}

}  // namespace phiz
