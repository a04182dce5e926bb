// SPDX-License-Identifier: GPL-3.0-or-later
/// Measures the real-time engine on a face moved by its muscles, and judges it by engines that are slow and right.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "phiz/face/muscle_simulation.h"
#include "phiz/face/performance.h"

namespace phiz {

/// An engine to compare with: minimises the energy from and to x (n x 3, metres; pinned vertices in place) under
/// contact. `trace`, if not null, gets an entry per iteration.
using StaticEngine =
    std::function<SolveStatistics(const TissueEnergy& energy, MatrixX3d& x, ContactScene* contacts, Trace* trace)>;

struct ForwardBenchOptions {
  int frames = 180;           ///< of the performance
  int reference_frames = 12;  ///< of these, solved by the reference engine, too; 0: none
  int own_start_frames = 3;   ///< of these, solved by it from its own state of the frame before, too
  int rival_frames = 3;       ///< of these, solved by the rival, too
  std::vector<double> dial = {1e-4, 1e-5, 1e-6};  ///< step tolerances to play the frames with, too, metres
  double dynamic_step_tolerance = 1e-5;           ///< metres; 0: no dynamics
  int scaling_frames = 60;                        ///< played with one and with two threads; 0: none
  MuscleOptions simulation;
  StaticEngine rival;               ///< empty: none
  std::function<FaceModel()> fine;  ///< makes a finer head, for how time grows with tets; empty: none
  std::function<void(const std::string& part)> on_part;  ///< called before each part of the work, when set
};

/// One engine's way to the state of one frame, from the state of the frame before.
struct EngineTrace {
  std::string engine;  ///< "real-time", "reference" or "rival"
  int frame = 0;
  Trace entries;
};

/// Times of frames, milliseconds, of which the first, which starts from rest, is left out.
struct FrameTimes {
  std::vector<double> ms;
  std::vector<double> iterations;  ///< of the same frames
  int not_converged = 0;           ///< of all frames

  double median() const;
  double p95() const;
  double most() const;
  double mean_iterations() const;
};

/// The frames played with another step tolerance.
struct DialSetting {
  double step_tolerance = 0;  ///< metres
  FrameTimes times;
  double residual_max = 0;
  std::optional<double> skin_error_mm_max;  ///< in the reference frames
};

/// What another engine says of one frame.
struct JudgedFrame {
  int frame = 0;
  SolveStatistics statistics;  ///< of that engine
  double skin_error_mm = 0;    ///< largest distance of drawn skin vertices between its state and another one
  std::optional<double> own_start_error_mm;
};

struct ForwardBench {
  Eigen::Index soft_tets = 0;
  int frames = 0, threads = 0;
  double setup_ms = 0;

  // Static frames with the engine's own tolerances.
  FrameTimes times;                              ///< from weights to drawn skin, contact and sliding included
  std::vector<double> residual, penetration_mm;  ///< relative force residual; by an independent search. All frames
  double volume_change_max = 0;                  ///< of the flesh, relative
  int contacts_max = 0;
  int factorisations = 0, projections = 0;
  double peak_rss_mib = 0;  ///< of the process, before other engines were run

  std::vector<JudgedFrame> reference;  ///< started from the real-time state, and judging that
  std::vector<JudgedFrame> rival;  ///< started from the real-time state of the frame before, judged by the reference
  std::vector<DialSetting> dial;
  FrameTimes dynamic;                    ///< steps of one frame's duration with the head's motion; empty: not measured
  std::optional<double> thread_scaling;  ///< median time with one thread by that with two
  Eigen::Index fine_soft_tets = 0;
  FrameTimes fine;
  std::vector<EngineTrace> traces;  ///< in the rival's frames

  bool reference_converged() const;
  bool rival_converged() const;
  std::optional<double> skin_error_mm_max() const;            ///< of the real-time states
  std::optional<double> skin_error_own_start_mm_max() const;  ///< of these, where the reference starts from its own
  std::optional<double> rival_ms_median() const;
  std::optional<double> rival_ratio() const;  ///< median time of the rival by that of the real-time engine
  /// Median time on the fine head by what it would be if time grew as the number of tets.
  std::optional<double> fine_ratio() const;
};

/// Runs the benchmark on the first frames of a performance, with estimated activations. Stops early when interrupted().
/// Throws phiz::Error(bad_input) for performances without frames.
ForwardBench bench_forward(const FaceModel& model, const Performance& performance,
                           const ForwardBenchOptions& options = {});

}  // namespace phiz
