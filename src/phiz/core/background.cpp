// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/core/background.h"

#include <tbb/task_arena.h>

#include <atomic>
#include <future>
#include <utility>

namespace phiz {

struct Background::Work {
  std::packaged_task<bool()> task;
  std::future<bool> result;
  std::atomic<bool> is_taken{false};

  void run_if_not_taken() {
    if (!is_taken.exchange(true)) task();
  }
};

void Background::start(std::function<bool()> work) {
  static tbb::task_arena arena(1, 0, tbb::task_arena::priority::low);
  drop();
  work_ = std::make_shared<Work>();
  work_->task = std::packaged_task<bool()>(std::move(work));
  work_->result = work_->task.get_future();
  arena.enqueue([shared = work_] { shared->run_if_not_taken(); });
}

bool Background::get() {
  const std::shared_ptr<Work> work = std::exchange(work_, nullptr);
  work->run_if_not_taken();
  return work->result.get();
}

void Background::drop() {
  if (!work_) return;
  const std::shared_ptr<Work> work = std::exchange(work_, nullptr);
  if (work->is_taken.exchange(true)) work->result.wait();
}

}  // namespace phiz
