// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/core/background.h"

#include <tbb/task_arena.h>

#include <atomic>
#include <deque>
#include <future>
#include <mutex>
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

/// What was started, in order, until a thread comes for it. Held here and not by the tasks of the arena, which are lost
/// where the program ends before their turn; never destroyed, as a thread may come when statics already are.
struct Background::Queue {
  std::mutex mutex;
  std::deque<std::shared_ptr<Work>> works;

  static Queue& instance() {
    static Queue& queue = *new Queue;
    return queue;
  }
  void push(std::shared_ptr<Work> work) {
    const std::lock_guard lock(mutex);
    works.push_back(std::move(work));
  }
  std::shared_ptr<Work> pop() {
    const std::lock_guard lock(mutex);
    std::shared_ptr<Work> work = std::move(works.front());
    works.pop_front();
    return work;
  }
};

void Background::start(std::function<bool()> work) {
  static tbb::task_arena arena(1, 0, tbb::task_arena::priority::low);
  drop();
  work_ = std::make_shared<Work>();
  work_->task = std::packaged_task<bool()>(std::move(work));
  work_->result = work_->task.get_future();
  Queue::instance().push(work_);
  arena.enqueue([] { Queue::instance().pop()->run_if_not_taken(); });
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
