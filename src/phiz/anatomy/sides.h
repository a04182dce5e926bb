// SPDX-License-Identifier: GPL-3.0-or-later
/// Names of things that a head has twice end in Left or Right.
#pragma once

#include <string_view>

namespace phiz {

/// "zygionLeft" -> "zygion"; a name without a side stays.
constexpr std::string_view without_side(std::string_view name) {
  for (const std::string_view side : {std::string_view("Left"), std::string_view("Right")})
    if (name.ends_with(side)) return name.substr(0, name.size() - side.size());
  return name;
}

}  // namespace phiz
