// SPDX-License-Identifier: GPL-3.0-or-later
/// Deterministic parallel loops: the partition depends on the range and the grain only, never on the number of
/// threads, so sums come out the same on any machine.
#pragma once

#include <cstddef>
#include <functional>

namespace phiz {

/// Calls body(begin, end) on consecutive chunks of [0, count) of at most `grain` items, in parallel.
/// The chunks are the same for any number of threads. The body must write to its own items only.
void parallel_chunks(std::ptrdiff_t count, std::ptrdiff_t grain,
                     const std::function<void(std::ptrdiff_t begin, std::ptrdiff_t end)>& body);

/// Calls body(i) for i in [0, count), in parallel.
template <class Body>
void parallel_for(std::ptrdiff_t count, Body&& body, std::ptrdiff_t grain = 256) {
  parallel_chunks(count, grain, [&body](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i) body(i);
  });
}

/// Sum of chunk(begin, end) over the chunks of parallel_chunks, added in chunk order: the same bits for any thread
/// count.
double parallel_sum(std::ptrdiff_t count, std::ptrdiff_t grain,
                    const std::function<double(std::ptrdiff_t begin, std::ptrdiff_t end)>& chunk);

/// Limits parallel loops to `count` threads while the object lives; 0 means all cores.
class ThreadLimit {
 public:
  explicit ThreadLimit(int count);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  void* control_;
};

/// Number of threads that parallel loops use now.
int thread_count();

}  // namespace phiz
