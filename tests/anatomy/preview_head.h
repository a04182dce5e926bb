// SPDX-License-Identifier: GPL-3.0-or-later
/// A head without expressions that many tests look at, made once per process.
#pragma once

#include "phiz/anatomy/builtin/builtin_head.h"

namespace phiz::test {

inline const HeadTemplate& preview_head() {
  static const HeadTemplate head = [] {
    BuiltinOptions options;
    options.size = HeadSize::preview;
    options.expressions = false;
    return build_builtin_head(options);
  }();
  return head;
}

}  // namespace phiz::test
