// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/core/progress.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <exception>
#include <utility>

namespace phiz {

namespace {

std::atomic<bool> quiet_flag{false};
volatile std::sig_atomic_t interrupt_flag = 0;

volatile std::sig_atomic_t caught_for_good = 0;
volatile std::sig_atomic_t delayed_signal = 0;
std::atomic<int> delays{0};  // lives of DelayInterrupts

void on_signal(int signal_number) {
  interrupt_flag = 1;
  std::signal(signal_number, SIG_DFL);
}

using Handler = void (*)(int);
Handler before_interrupt = SIG_DFL, before_termination = SIG_DFL;

void on_delayed_signal(int signal_number) {
  delayed_signal = signal_number;
}

bool is_terminal() {
  return ::isatty(STDERR_FILENO) != 0;
}

}  // namespace

Progress::Progress(std::string task, std::ptrdiff_t total)
    : task_(std::move(task)), total_(total), start_(std::chrono::steady_clock::now()), drawn_(start_) {}

Progress::~Progress() {
  if (!step_.empty() && std::uncaught_exceptions() == 0) ++done_;
  draw(true);
}

void Progress::set_quiet(bool quiet) {
  quiet_flag = quiet;
}

void Progress::advance(std::ptrdiff_t steps) {
  done_ += steps;
  const auto now = std::chrono::steady_clock::now();
  const auto pause = is_terminal() ? std::chrono::milliseconds(100) : std::chrono::milliseconds(5000);
  if (now - drawn_ >= pause) {
    drawn_ = now;
    draw(false);
  }
}

void Progress::begin(const std::string& step) {
  if (!step_.empty()) ++done_;
  step_ = step;
  draw(false);
}

void Progress::draw(bool last) {
  if (quiet_flag) return;
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  const double share = total_ > 0 ? std::min(1.0, static_cast<double>(done_) / static_cast<double>(total_)) : 1.0;
  const std::string what = step_.empty() ? task_ : last && done_ == total_ ? task_ + ": done" : task_ + ": " + step_;
  if (is_terminal()) {
    constexpr int width = 30;
    const int filled = static_cast<int>(share * width);
    std::fprintf(stderr, "\r%-34s [%.*s%*s] %3d%% %td/%td %.1f s\033[K", what.c_str(), filled,
                 "##############################", width - filled, "", static_cast<int>(share * 100), done_, total_,
                 seconds);
    if (last) std::fputc('\n', stderr);
  } else {
    std::fprintf(stderr, "%s: %td/%td, %.1f s\n", what.c_str(), done_, total_, seconds);
  }
  std::fflush(stderr);
}

void announce(const std::string& what) {
  if (!quiet_flag) std::fprintf(stderr, "%s\n", what.c_str());
}

void catch_interrupts() {
  caught_for_good = 1;
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  if (std::signal(SIGHUP, on_signal) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);  // nohup
}

bool interrupted() {
  return interrupt_flag != 0;
}

DelayInterrupts::DelayInterrupts() {
  if (caught_for_good != 0 || ++delays > 1) return;
  before_interrupt = std::signal(SIGINT, on_delayed_signal);
  before_termination = std::signal(SIGTERM, on_delayed_signal);
}

DelayInterrupts::~DelayInterrupts() {
  if (caught_for_good != 0 || --delays > 0) return;
  std::signal(SIGINT, before_interrupt);
  std::signal(SIGTERM, before_termination);
  if (delayed_signal != 0) std::raise(delayed_signal);
}

}  // namespace phiz
