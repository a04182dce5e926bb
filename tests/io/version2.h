// SPDX-License-Identifier: GPL-3.0-or-later
/// Makes heads of version 2 of the format, independently of the library: what it makes must load for ever.
#pragma once

#include <string>

namespace phiz::version2 {

/// Takes everything that later versions added out of the head at `path`.
void strip_head(const std::string& path);

}  // namespace phiz::version2
