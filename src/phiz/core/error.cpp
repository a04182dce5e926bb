// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/core/error.h"

namespace phiz {

namespace {

std::string sentence(std::string_view what, std::string_view mend) {
  std::string message(what);
  if (!mend.empty()) message.append("; ").append(mend);
  return message;
}

}  // namespace

void fail(std::string_view what, std::string_view mend) {
  throw Error(ErrorKind::failure, sentence(what, mend));
}

void reject(std::string_view where, std::string_view what, std::string_view mend) {
  throw Error(ErrorKind::bad_input, std::string(where) + ": " + sentence(what, mend));
}

int exit_code(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::failure:
      return 1;
    case ErrorKind::usage:
      return 2;
    case ErrorKind::bad_input:
      return 3;
  }
  return 1;
}

}  // namespace phiz
