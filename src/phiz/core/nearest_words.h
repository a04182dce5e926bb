// SPDX-License-Identifier: GPL-3.0-or-later
/// Which known words a misspelt one may have meant.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace phiz {

/// Letters to insert, delete, replace or swap with a neighbour that lead from a to b.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// At most `count` of the candidates, nearest to the word first; among equals the earlier one. Case does not count, and
/// candidates that hold the whole word come before all others.
std::vector<std::string> nearest_words(std::string_view word, std::vector<std::string> candidates, std::size_t count);

}  // namespace phiz
