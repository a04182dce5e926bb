// SPDX-License-Identifier: GPL-3.0-or-later
/// Writes .phiz files of version 1 of the format, independently of the library: what it writes must load for ever.
/// Do not change this file when the format moves on; add version2.h beside it.
#pragma once

#include <string>

#include "phiz/face/performance.h"
#include "phiz/face/take.h"

namespace phiz::version1 {

void write_performance(const std::string& path, const Performance& performance);
/// A take without parts.
void write_take(const std::string& path, const Take& take);

/// Gives a file whose HDF5 part was changed a first block with the right checksum.
void seal(const std::string& path);

}  // namespace phiz::version1
