// SPDX-License-Identifier: GPL-3.0-or-later
/// Measures the animation solve of a face model, and the distance of its results from an independent solver's.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "phiz/face/performance.h"
#include "phiz/face/simulation.h"

namespace phiz {

struct VolumetricBenchOptions {
  int frames = 120;            ///< of the performance
  int reference_frames = 3;    ///< of these, solved by newton_reference too; 0: none
  bool thread_scaling = true;  ///< play a part with one thread, too
  SimulationOptions simulation;
  std::function<void()> on_frame;  ///< called after each frame, when set
};

/// Times exclude the first frame, which starts from rest.
struct VolumetricBench {
  Eigen::Index soft_tets = 0;
  int frames = 0;
  int threads = 0;
  double ms_median = 0, ms_p95 = 0, ms_max = 0;
  double iterations_median = 0, contacts_max = 0;
  int frames_not_converged = 0;
  double residual_max = 0;  ///< relative force residual
  double penetration_mm_max = 0;
  double volume_change_max = 0;             ///< of the flesh, relative
  std::optional<double> skin_error_mm_max;  ///< distance of drawn skin vertices from the reference's state
  std::optional<double> reference_ms_median;
  bool reference_converged = true;
  std::optional<double> thread_scaling;  ///< median time with one thread by that with all
  double setup_ms = 0;
  double peak_rss_mib = 0;                                      ///< of the process
  std::vector<double> ms, iterations, contacts, skin_error_mm;  ///< per frame; the last one per reference frame
};

/// Runs the benchmark on the first frames of a performance.
VolumetricBench bench_volumetric(const FaceModel& model, const Performance& performance,
                                 const VolumetricBenchOptions& options = {});

/// A performance to measure with when none is given: speech-like jaw and lips, blinks, smiles, brows and pressed lips,
/// 30 frames per second, smooth and without an end.
Performance bench_performance(int frames);

}  // namespace phiz
