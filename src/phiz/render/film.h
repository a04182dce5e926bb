// SPDX-License-Identifier: GPL-3.0-or-later
/// Films: frames piped to ffmpeg, H.264 in MP4.
#pragma once

#include <memory>
#include <string>

#include "phiz/geometry/image.h"

namespace phiz {

struct FilmOptions {
  double frame_rate = 30;
  int quality = 17;  ///< constant rate factor of x264: 0 lossless, 17 visually lossless, 28 small
};

/// A film being written. Frames go to a temporary file that finish() renames, so that a film that could not be
/// completed leaves nothing behind; a caller that is interrupted calls finish() to keep the frames so far. The encoder
/// does not receive the terminal's Ctrl-C.
class FilmWriter {
 public:
  /// Throws phiz::Error(failure) when ffmpeg cannot be started, phiz::Error(bad_input) for a name that does not end in
  /// .mp4 or an impossible frame rate.
  explicit FilmWriter(std::string path, const FilmOptions& options = {});
  ~FilmWriter();
  FilmWriter(const FilmWriter&) = delete;
  FilmWriter& operator=(const FilmWriter&) = delete;

  /// RGB frames of one size; odd sizes are padded by one pixel. Throws phiz::Error(failure) with ffmpeg's own message
  /// when the encoder fails.
  void add(const Image& frame);
  /// Completes the film and renames it. At least one frame must have been added.
  void finish();
  int frames() const;

 private:
  struct Encoder;
  std::unique_ptr<Encoder> encoder_;
};

}  // namespace phiz
