// SPDX-License-Identifier: GPL-3.0-or-later
/// Performances as the Live Link Face app and its kin record them: CSV with one row per frame.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "phiz/face/performance.h"

namespace phiz {

/// A performance and what the reader noticed: columns that are missing or unknown, dropped frames.
struct LiveLinkRecording {
  Performance performance;
  std::vector<std::string> notes;
};

/// Reads a recording. Columns are matched by name, whatever their order and case (`JawOpen`, `jawOpen`, `mouthSmile_L`,
/// `mouthSmileL`, `HeadYaw`); 51-, 52- and 61-column exporters, a byte order mark, CR LF, quoted fields, fields
/// separated by semicolons or tabs and decimal commas are all accepted. All 52 expressions come out, in the order of
/// expression_names; missing ones are zero. Rows without values, which recorders write while they see no face, are left
/// out.
///
/// Time is the column `Timecode`, HH:MM:SS:FF.sub with hours beyond 23 allowed, FF in frames of the take's rate (found
/// from the largest FF and the steps, one of 24, 25, 30, 48, 50, 60, 120) and wrapping at midnight; or a column `time`,
/// `seconds` or `timestamp` in seconds or HH:MM:SS.sss; or `timestamp_ms`, `time_ms` or `milliseconds`; or none, then
/// rows are 1/60 s apart. Dropped frames leave gaps in `time`.
///
/// Angles are stored by the recorder in radians, positive yaw to the person's right, positive roll to the person's
/// left; they come out in the signs of Performance. Throws phiz::Error(bad_input) with file:line for text where a
/// number is expected, NaN, time that runs backward, weights in percent, angles in degrees.
LiveLinkRecording read_live_link(const std::string& path);
LiveLinkRecording parse_live_link(std::string_view text, const std::string& where);

/// Writes the 61 columns of the app (expressions that the performance does not have are zero), with time codes.
void write_live_link(const std::string& path, const Performance& performance);

}  // namespace phiz
