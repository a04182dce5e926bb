// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/render/font.h"

// PHIZ_FONT_FILE is set by CMake.
__asm__(
    ".section .rodata\n"
    ".balign 16\n"
    "phiz_font_bytes:\n"
    ".incbin \"" PHIZ_FONT_FILE
    "\"\n"
    ".byte 0\n"
    ".previous\n");

extern "C" const unsigned char phiz_font_bytes[];

namespace phiz::detail {

const unsigned char* font_file() {
  return phiz_font_bytes;
}

}  // namespace phiz::detail
