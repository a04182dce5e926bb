// SPDX-License-Identifier: GPL-3.0-or-later
/// Internal: the built-in typeface. Included by sources only.
#pragma once

namespace phiz::detail {

/// The TrueType file of DejaVu Sans, taken in when the library was built.
const unsigned char* font_file();

}  // namespace phiz::detail
