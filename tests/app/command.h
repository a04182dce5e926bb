// SPDX-License-Identifier: GPL-3.0-or-later
/// Runs programs from tests and catches what they say.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace phiz::testing {

struct Outcome {
  int code = -1;  ///< exit code; 128 + signal when a signal ended the program
  std::string out;
  std::string err;
};

/// Runs a program (searched on the path) to its end. While it runs, `watch` is called every few milliseconds with its
/// process id; it may send signals.
Outcome run_program(const std::vector<std::string>& command, const std::function<void(pid_t)>& watch = {});

/// Runs the command `phiz` with these arguments.
Outcome phiz_command(std::vector<std::string> arguments, const std::function<void(pid_t)>& watch = {});

/// True when a program of that name is on the path.
bool program_exists(const std::string& name);

/// A folder for the files of one test, removed with its contents at the end.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  std::string operator/(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

std::string read_text(const std::string& path);
void write_text(const std::string& path, const std::string& text);

}  // namespace phiz::testing
