// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/core/parallel.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <vector>

namespace phiz {

void parallel_chunks(std::ptrdiff_t count, std::ptrdiff_t grain,
                     const std::function<void(std::ptrdiff_t, std::ptrdiff_t)>& body) {
  if (count <= 0) return;
  grain = std::max<std::ptrdiff_t>(grain, 1);
  const std::ptrdiff_t chunks = (count + grain - 1) / grain;
  if (chunks == 1) {
    body(0, count);
    return;
  }
  tbb::parallel_for(std::ptrdiff_t{0}, chunks,
                    [&](std::ptrdiff_t c) { body(c * grain, std::min(count, (c + 1) * grain)); });
}

double parallel_sum(std::ptrdiff_t count, std::ptrdiff_t grain,
                    const std::function<double(std::ptrdiff_t, std::ptrdiff_t)>& chunk) {
  grain = std::max<std::ptrdiff_t>(grain, 1);
  std::vector<double> partial(static_cast<std::size_t>(std::max<std::ptrdiff_t>((count + grain - 1) / grain, 0)), 0.0);
  parallel_chunks(count, grain, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    partial[static_cast<std::size_t>(begin / grain)] = chunk(begin, end);
  });
  double sum = 0;
  for (const double p : partial) sum += p;
  return sum;
}

ThreadLimit::ThreadLimit(int count) : control_(nullptr) {
  if (count > 0)
    control_ = new tbb::global_control(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(count));
}

ThreadLimit::~ThreadLimit() {
  delete static_cast<tbb::global_control*>(control_);
}

int thread_count() {
  return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

}  // namespace phiz
