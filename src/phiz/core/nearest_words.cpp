// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/core/nearest_words.h"

#include <algorithm>
#include <cctype>
#include <numeric>

namespace phiz {

namespace {

std::string lower_case(std::string_view word) {
  std::string lower(word);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

}  // namespace

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  std::iota(d[0].begin(), d[0].end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i)
    for (std::size_t j = 1; j <= b.size(); ++j) {
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

std::vector<std::string> nearest_words(std::string_view word, std::vector<std::string> candidates, std::size_t count) {
  const std::string sought = lower_case(word);
  const auto distance = [&](const std::string& candidate) {
    const std::string lower = lower_case(candidate);
    return lower.find(sought) != std::string::npos ? 0 : 1 + edit_distance(sought, lower);
  };
  std::stable_sort(candidates.begin(), candidates.end(),
                   [&](const std::string& a, const std::string& b) { return distance(a) < distance(b); });
  candidates.resize(std::min(count, candidates.size()));
  return candidates;
}

}  // namespace phiz
