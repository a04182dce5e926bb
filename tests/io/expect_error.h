// SPDX-License-Identifier: GPL-3.0-or-later
/// Expectations about phiz::Error.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "phiz/core/error.h"

namespace phiz {

/// The message of the phiz::Error(bad_input) that the action throws; a test failure when it throws none.
template <class Action>
std::string message_of(Action&& action, ErrorKind kind = ErrorKind::bad_input) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "no error was thrown";
  return {};
}

}  // namespace phiz

/// The action throws a phiz::Error(bad_input) whose message contains the text.
#define EXPECT_REJECTED(action, text)                                                  \
  do {                                                                                 \
    const std::string message_ = phiz::message_of([&] { static_cast<void>(action); }); \
    EXPECT_NE(message_.find(text), std::string::npos) << "message: " << message_;      \
  } while (false)
