// SPDX-License-Identifier: GPL-3.0-or-later
/// Random poses to try the real-time engine with: what it must survive, and what it must be honest about.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "phiz/core/random.h"
#include "phiz/face/muscle_simulation.h"

namespace phiz {

/// Within range: up to eight expressions of weights in [0, 1], or all muscles striving for 0.7 to 1.3 times their
/// length; the jaw anywhere within its limits, or where the expressions have it. Beyond: weights up to 2, lengths from
/// 0.5 to 1.5, jaw limits times 1.5.
struct TorturePose {
  std::string what;  ///< for people: what makes it
  std::vector<Matrix3d> stretches;
  JawPose jaw = JawPose::Zero();
};

class PoseMaker {
 public:
  PoseMaker(const FaceModel& model, const std::vector<ActivationShape>& shapes, const TissueOptions& options,
            std::uint64_t seed);
  /// Depends on the seed, the number and `beyond` only. The kind of pose goes round with the number.
  TorturePose pose(int number, bool beyond) const;

 private:
  VectorXd random_weights(Random& random, double most, std::string& what) const;
  JawPose random_jaw(Random& random, double scale) const;

  HeadTemplate head_;
  std::vector<ActivationShape> shapes_;
  HeadTissue tissue_;
  ActivationBlender blender_;
  std::uint64_t seed_;
};

struct TortureOptions {
  int first = 0;  ///< number of the first pose
  int poses = 1000;
  int beyond = 100;  ///< poses beyond range, after the others
  std::uint64_t seed = 1;
  MuscleOptions simulation;
};

struct TortureResult {
  int number = 0;
  bool beyond = false;
  bool from_neutral = false;  ///< poses with odd numbers start from the state of the one before
  std::string what;
  SolveStatistics statistics;
  std::string error;  ///< what the engine threw, if it did: it should not
  bool finite = true;
  double penetration = 0;  ///< by an independent search, metres
};

/// Solves for the poses one after the other; `on_result` is called after each, when set. Stops early when
/// interrupted(). The same pose gets the same result in every run that starts with an even number before it.
std::vector<TortureResult> torture(const FaceModel& model, const TortureOptions& options = {},
                                   const std::function<void(const TortureResult&)>& on_result = {});

}  // namespace phiz
