// SPDX-License-Identifier: GPL-3.0-or-later
/// SMPTE-like time codes with fractions of a frame, as face recorders write them.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace phiz {

/// HH:MM:SS:FF.sub, e.g. "24:53:15:35.121": frame 35.121 of that second. Hours may go beyond 23.
struct Timecode {
  long long seconds = 0;  ///< since 00:00:00:00
  double frames = 0;      ///< frames within the second
};

/// Nothing when the text is no time code. A semicolon before the frames (drop-frame notation) is accepted.
std::optional<Timecode> parse_timecode(std::string_view text);

/// HH:MM:SS or HH:MM:SS.sss, a time of day; `frames` is the fraction of the second, so the rate is 1.
std::optional<Timecode> parse_clock(std::string_view text);

/// The rate in which FF counts: of 24, 25, 30, 48, 50, 60, 120 above the largest FF the one that makes steps across a
/// full second most like the others; where no second changes, 60 when it fits.
double timecode_rate(const std::vector<Timecode>& codes);

/// Seconds of each code since the first. A step back by more than half a day is midnight; others stay negative.
std::vector<double> timecode_seconds(const std::vector<Timecode>& codes, double rate);

/// The code of `seconds` since 00:00:00:00 with thousandths of a frame. rate: an integer number of frames per second.
std::string format_timecode(double seconds, int rate);

}  // namespace phiz
