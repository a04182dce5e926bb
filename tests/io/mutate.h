// SPDX-License-Identifier: GPL-3.0-or-later
/// Deterministic damage to files, and the expectation that readers survive it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "phiz/core/random.h"

namespace phiz {

/// The seed with one to four damages: bits flipped, bytes or 32-bit numbers replaced by extreme ones, blocks cut out,
/// doubled, moved or overwritten, the end cut off, numbers in text replaced by nan, inf, huge and negative ones, lines
/// doubled, removed or swapped.
std::string mutate(const std::string& seed, Random& random);

/// Calls `read` on `count` mutations of the seeds. Every call must return or throw phiz::Error; anything else is a
/// test failure that names the mutation.
void expect_survives(const std::vector<std::string>& seeds, int count,
                     const std::function<void(const std::string&)>& read);

}  // namespace phiz
