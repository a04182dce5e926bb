// SPDX-License-Identifier: GPL-3.0-or-later
/// One piece of work beside the parallel loops.
#pragma once

#include <functional>
#include <memory>

namespace phiz {

/// Work that a thread of the parallel loops does, which takes no part in them until it is done. Under a ThreadLimit of
/// 1 it has a thread of its own. Whoever asks for a result that nobody has begun makes it: nothing waits for a thread
/// that is not there, as where all of them are in get().
class Background {
 public:
  ~Background() { drop(); }
  /// What ran before is dropped.
  void start(std::function<bool()> work);
  bool is_started() const { return work_ != nullptr; }
  /// The result, once; throws what the work threw.
  bool get();
  /// Waits for the end of what has begun; what has not never will.
  void drop();

 private:
  struct Work;
  struct Queue;
  std::shared_ptr<Work> work_;
};

}  // namespace phiz
