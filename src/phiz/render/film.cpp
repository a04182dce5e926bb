// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/render/film.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <utility>
#include <vector>

#include "phiz/core/error.h"
#include "phiz/io/output_file.h"

namespace phiz {

struct FilmWriter::Encoder {
  std::string path, temporary;
  FilmOptions options;
  int width = 0, height = 0, frames = 0;
  pid_t process = -1;
  int channel = -1;               // our end of the socket that is ffmpeg's standard input
  std::FILE* messages = nullptr;  // ffmpeg's standard error

  void start(int frame_width, int frame_height);
  [[noreturn]] void complain(const std::string& what);
  int wait();
  void close_channel() {
    if (channel >= 0) ::close(std::exchange(channel, -1));
  }
  ~Encoder() {
    close_channel();
    if (process > 0) {
      ::kill(process, SIGTERM);
      wait();
    }
    if (messages != nullptr) std::fclose(messages);
    ::unlink(temporary.c_str());
  }
};

int FilmWriter::Encoder::wait() {
  int status = -1;
  while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  process = -1;
  return status;
}

void FilmWriter::Encoder::complain(const std::string& what) {
  std::string said;
  if (messages != nullptr) {
    std::rewind(messages);
    char buffer[512];
    const std::size_t n = std::fread(buffer, 1, sizeof buffer, messages);
    said.assign(buffer, n);
    while (!said.empty() && (said.back() == '\n' || said.back() == '\r')) said.pop_back();
  }
  fail(fmt::format("{}: {}{}", path, what, said.empty() ? "" : ": " + said),
       "check that ffmpeg is installed with x264 (Debian: apt-get install ffmpeg) and that the disk is not full");
}

void FilmWriter::Encoder::start(int frame_width, int frame_height) {
  width = frame_width;
  height = frame_height;
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
    complain(fmt::format("no channel to ffmpeg ({})", std::strerror(errno)));
  channel = ends[0];
  messages = std::tmpfile();
  const std::string size = fmt::format("{}x{}", width, height), rate = fmt::format("{:.8g}", options.frame_rate);
  const std::string quality = std::to_string(options.quality);
  std::vector<std::string> words = {"ffmpeg",
                                    "-nostdin",
                                    "-loglevel",
                                    "error",
                                    "-y",
                                    "-f",
                                    "rawvideo",
                                    "-pix_fmt",
                                    "rgb24",
                                    "-video_size",
                                    size,
                                    "-framerate",
                                    rate,
                                    "-i",
                                    "pipe:0",
                                    "-an",
                                    "-vf",
                                    "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv",
                                    "-c:v",
                                    "libx264",
                                    "-preset",
                                    "medium",
                                    "-crf",
                                    quality,
                                    "-pix_fmt",
                                    "yuv420p",
                                    "-colorspace",
                                    "bt709",
                                    "-color_primaries",
                                    "bt709",
                                    "-color_trc",
                                    "bt709",
                                    "-movflags",
                                    "+faststart",
                                    "-f",
                                    "mp4",
                                    temporary};
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& w : words) arguments.push_back(w.data());
  arguments.push_back(nullptr);

  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_init(&actions);
  posix_spawnattr_init(&attributes);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDIN_FILENO);
  if (messages != nullptr) posix_spawn_file_actions_adddup2(&actions, ::fileno(messages), STDERR_FILENO);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);  // out of reach of the terminal's Ctrl-C
  posix_spawnattr_setpgroup(&attributes, 0);
  const int error = ::posix_spawnp(&process, "ffmpeg", &actions, &attributes, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  ::close(ends[1]);
  if (error != 0) {
    process = -1;
    complain(fmt::format("the program ffmpeg could not be started ({})", std::strerror(error)));
  }
}

FilmWriter::FilmWriter(std::string path, const FilmOptions& options) : encoder_(std::make_unique<Encoder>()) {
  if (path.size() < 5 || path.substr(path.size() - 4) != ".mp4")
    reject(path, "films are written as MP4", "give a file name that ends in .mp4");
  if (!(options.frame_rate >= 0.1 && options.frame_rate <= 1000))
    reject(path, fmt::format("a frame rate of {} is not possible", options.frame_rate),
           "use 0.1 to 1000 frames per second");
  if (options.quality < 0 || options.quality > 51)
    reject(path, fmt::format("a quality of {} is not possible", options.quality), "use 0 (best) to 51");
  make_parent_folder(path);
  encoder_->temporary = temporary_name(path);
  encoder_->path = std::move(path);
  encoder_->options = options;
}

FilmWriter::~FilmWriter() = default;

int FilmWriter::frames() const {
  return encoder_->frames;
}

void FilmWriter::add(const Image& frame) {
  Encoder& e = *encoder_;
  if (frame.channels != 3 || frame.width < 1 || frame.height < 1 ||
      frame.pixels.size() != static_cast<std::size_t>(frame.width) * frame.height * 3)
    reject(e.path, "a frame is not an RGB image");
  if (e.frames == 0 && e.process < 0) e.start(frame.width, frame.height);
  if (frame.width != e.width || frame.height != e.height)
    reject(e.path, fmt::format("frame {} has {} x {} pixels, the first one {} x {}", e.frames, frame.width,
                               frame.height, e.width, e.height));
  for (std::size_t sent = 0; sent < frame.pixels.size();) {
    const ssize_t n = ::send(e.channel, frame.pixels.data() + sent, frame.pixels.size() - sent, MSG_NOSIGNAL);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) {
      e.close_channel();
      e.wait();
      e.complain("ffmpeg stopped");
    }
    sent += static_cast<std::size_t>(n);
  }
  ++e.frames;
}

void FilmWriter::finish() {
  Encoder& e = *encoder_;
  if (e.frames == 0 || e.process < 0) fail(e.path + ": the film has no frames");
  e.close_channel();
  const int status = e.wait();
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) e.complain("ffmpeg failed");
  rename_file(e.temporary, e.path);
}

}  // namespace phiz
