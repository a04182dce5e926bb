// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/io/timecode.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "phiz/io/text_scanner.h"

namespace phiz {

namespace {

constexpr std::array<double, 7> known_rates = {24, 25, 30, 48, 50, 60, 120};
constexpr double day = 86400;

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

std::optional<Timecode> parse_timecode(std::string_view text) {
  const std::size_t last = text.find_last_of(":;");
  if (last == std::string_view::npos) return std::nullopt;
  const auto clock = parse_clock(text.substr(0, last));
  const auto frames = parse_number(text.substr(last + 1));
  if (!clock || clock->frames != 0 || !frames) return std::nullopt;
  if (!(*frames >= 0 && *frames < known_rates.back())) return std::nullopt;
  return Timecode{clock->seconds, *frames};
}

std::optional<Timecode> parse_clock(std::string_view text) {
  std::array<std::string_view, 3> parts;
  for (std::size_t i = 0; i < 2; ++i) {
    const std::size_t colon = text.find(':');
    if (colon == std::string_view::npos) return std::nullopt;
    parts[i] = text.substr(0, colon);
    text.remove_prefix(colon + 1);
  }
  parts[2] = text;
  const auto hours = parse_integer(parts[0]);
  const auto minutes = parse_integer(parts[1]);
  const auto seconds = parse_number(parts[2]);
  if (!hours || !minutes || !seconds) return std::nullopt;
  if (*hours < 0 || *hours > 9999 || *minutes < 0 || *minutes > 59 || !(*seconds >= 0 && *seconds < 60))
    return std::nullopt;
  const double whole = std::floor(*seconds);
  return Timecode{(*hours * 60 + *minutes) * 60 + static_cast<long long>(whole), *seconds - whole};
}

double timecode_rate(const std::vector<Timecode>& codes) {
  double largest = 0;
  for (const Timecode& code : codes) largest = std::max(largest, std::floor(code.frames));
  std::vector<double> within;  // steps inside a second
  std::vector<std::size_t> changes;
  for (std::size_t i = 1; i < codes.size(); ++i) {
    if (codes[i].seconds == codes[i - 1].seconds) {
      within.push_back(codes[i].frames - codes[i - 1].frames);
    } else {
      changes.push_back(i);
    }
  }
  if (changes.empty() || within.empty()) {
    if (largest < 60) return 60;
    return 120;
  }
  const double step = median(within);
  double best_rate = known_rates.back();
  double least = std::numeric_limits<double>::infinity();
  for (const double rate : known_rates) {
    if (rate <= largest) continue;
    std::vector<double> misfit;
    for (const std::size_t i : changes) {
      const auto seconds = static_cast<double>(codes[i].seconds - codes[i - 1].seconds);
      misfit.push_back(std::abs(seconds * rate + codes[i].frames - codes[i - 1].frames - step));
    }
    const double typical = median(misfit);
    if (typical < least - 1e-9) least = typical, best_rate = rate;
  }
  return best_rate;
}

std::vector<double> timecode_seconds(const std::vector<Timecode>& codes, double rate) {
  std::vector<double> result;
  result.reserve(codes.size());
  double offset = 0;
  for (std::size_t i = 0; i < codes.size(); ++i) {
    if (i > 0 && static_cast<double>(codes[i].seconds - codes[i - 1].seconds) < -day / 2) {
      offset += std::ceil(static_cast<double>(codes[i - 1].seconds - codes[i].seconds) / day - 0.5) * day;
    }
    const auto seconds = static_cast<double>(codes[i].seconds - codes[0].seconds);
    result.push_back(offset + seconds + (codes[i].frames - codes[0].frames) / rate);
  }
  return result;
}

std::string format_timecode(double seconds, int rate) {
  const long long per_second = 1000LL * rate;
  const auto total = static_cast<long long>(std::llround(seconds * static_cast<double>(per_second)));
  const long long whole = total / per_second;
  const long long part = total % per_second;
  return fmt::format("{:02}:{:02}:{:02}:{:02}.{:03}", whole / 3600, whole / 60 % 60, whole % 60, part / 1000,
                     part % 1000);
}

}  // namespace phiz
