// SPDX-License-Identifier: GPL-3.0-or-later
/// Progress of long work: a bar on a terminal, plain lines otherwise; and cancellation by Ctrl-C.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace phiz {

/// Reports progress of `total` steps on standard error. Quiet when `set_quiet(true)` was called (e.g. with --json -).
class Progress {
 public:
  Progress(std::string task, std::ptrdiff_t total);
  ~Progress();  ///< ends the bar's line
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void advance(std::ptrdiff_t steps = 1);
  /// For steps with names: the one before, if there was one, is done, and `step` begins. Shown at once.
  void begin(const std::string& step);

  static void set_quiet(bool quiet);

 private:
  void draw(bool last);

  std::string task_, step_;
  std::ptrdiff_t total_;
  std::ptrdiff_t done_ = 0;
  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point drawn_;
};

/// One line about what is being done, on standard error; nothing when quiet.
void announce(const std::string& what);

/// From now on Ctrl-C (SIGINT), SIGTERM and the end of the terminal (SIGHUP, unless it is ignored) set a flag instead
/// of ending the process; a second Ctrl-C ends it. For work that asks interrupted() and keeps what is finished.
void catch_interrupts();
/// True once the user has asked to stop. Long loops ask after each finished step.
bool interrupted();

/// While a file is being written: Ctrl-C and SIGTERM, where they would end the process, do so at the end of this life.
class DelayInterrupts {
 public:
  DelayInterrupts();
  ~DelayInterrupts();
  DelayInterrupts(const DelayInterrupts&) = delete;
  DelayInterrupts& operator=(const DelayInterrupts&) = delete;
};

}  // namespace phiz
