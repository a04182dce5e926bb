// SPDX-License-Identifier: GPL-3.0-or-later
/// Takes in .phiz files: frames are appended one by one, so that an interrupted run keeps the finished ones.
///
/// While a take is being made it is called "X.phiz.part"; every appended frame is on the disk when append() returns.
/// finish(), or the end of the writer's life, gives it its checksum and renames it to "X.phiz", however many frames it
/// has. Only a killed program leaves a .part file behind; resume goes on with that too.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "phiz/face/take.h"

namespace phiz {

class TakeWriter {
 public:
  /// Starts a take without frames. `head` says everything but the frames (its own frames are not written).
  /// frames_planned must be set. Throws phiz::Error(failure) when the file cannot be made.
  TakeWriter(const std::string& path, const Take& head);

  /// Goes on with the take at `path` (or its .part file) that was interrupted; starts a new one when there is none. The
  /// finished frames are copied, and shown to `finished` on the way, which may throw to refuse them; until all are
  /// copied, the old file stays. Throws phiz::Error(bad_input) when the file there was made from another head,
  /// performance length or frame rate.
  static TakeWriter resume(const std::string& path, const Take& head,
                           const std::function<void(const TakeFrame& frame)>& finished = {});

  TakeWriter(TakeWriter&&) noexcept;
  TakeWriter& operator=(TakeWriter&&) noexcept;
  ~TakeWriter();  ///< finishes; a failure to do so leaves the .part file

  /// Frames that the file has.
  int frames() const;
  /// Appends a frame and brings it to the disk. All frames must have or lack `volume` and `velocity` alike. Throws
  /// phiz::Error(failure) when sizes disagree with the head or a position is not finite.
  void append(const TakeFrame& frame);
  /// Closes and renames. No frame can be appended afterwards.
  void finish();

 private:
  struct State;
  explicit TakeWriter(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Reads the frames of a take one by one, without holding them all.
class TakeReader {
 public:
  /// Throws phiz::Error(bad_input) naming the item that is wrong.
  explicit TakeReader(const std::string& path);
  TakeReader(TakeReader&&) noexcept;
  TakeReader& operator=(TakeReader&&) noexcept;
  ~TakeReader();

  /// Everything but the frames.
  const Take& head() const;
  int frames() const;
  /// Frame 0 to frames() - 1; throws phiz::Error(usage) beyond.
  TakeFrame frame(int index) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Whole takes in one go.
void save(const std::string& path, const Take& take);
Take load_take(const std::string& path);

}  // namespace phiz
