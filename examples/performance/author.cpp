// SPDX-License-Identifier: GPL-3.0-or-later
// Writes examples/performance/first-light.csv: author_performance OUTPUT.csv
#include <cstdio>
#include <exception>

#include "phiz/io/live_link.h"
#include "score.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: author_performance OUTPUT.csv\n");
    return 2;
  }
  try {
    phiz::write_live_link(argv[1], phiz::authoring::first_light(30));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "author_performance: %s\n", error.what());
    return 1;
  }
  return 0;
}
