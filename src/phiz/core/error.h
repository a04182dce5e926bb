// SPDX-License-Identifier: GPL-3.0-or-later
/// Errors. Every failure that a user can cause is a phiz::Error with a kind (which decides the exit code of the
/// command) and a message that says what happened, where, what was expected and what to do.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace phiz {

enum class ErrorKind {
  failure,    ///< the computation could not be completed (exit code 1)
  usage,      ///< the command line or an option is wrong (exit code 2)
  bad_input,  ///< a file or a value given by the user is malformed (exit code 3)
};

class Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
  ErrorKind kind() const { return kind_; }

 private:
  ErrorKind kind_;
};

/// A computation that cannot be completed. `what`: the event; `mend`: what the user can do about it.
[[noreturn]] void fail(std::string_view what, std::string_view mend = {});

/// A malformed file or value. `where`: the file (and line or element), e.g. "head.obj:12"; `what`: what is wrong and
/// what was expected; `mend`: what to do about it.
[[noreturn]] void reject(std::string_view where, std::string_view what, std::string_view mend = {});

/// The process exit code of an error kind: 1, 2 or 3.
int exit_code(ErrorKind kind);

}  // namespace phiz
