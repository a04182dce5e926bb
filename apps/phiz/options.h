// SPDX-License-Identifier: GPL-3.0-or-later
/// What several verbs ask of their options. Mistakes throw phiz::Error(usage).
#pragma once

#include <initializer_list>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "phiz/geometry/mesh.h"

namespace CLI {
class Validator;
}

namespace phiz {

[[noreturn]] void misuse(const std::string& message);

/// Two finite numbers with a separator between them, e.g. 640x480. `form` shows the user how to write them.
std::pair<double, double> two_numbers(const std::string& text, char separator, const char* option, const char* form);

/// Three finite numbers with commas between them, e.g. 0,-9.81,0.
Vector3d three_numbers(const std::string& text, const char* option);

/// Words NAME=WEIGHT (NAME alone: 1), weights from -10 to 10.
std::map<std::string, double> named_weights(const std::vector<std::string>& words, const char* option);

/// "FIRST:END" of the option --frames: whole numbers with 0 <= FIRST < END.
struct FrameRange {
  int first, end;
};
FrameRange frame_range(const std::string& text);

/// A number from `low` to `high`; no other text, and no NaN.
CLI::Validator between(double low, double high);

/// A file name that ends in .phiz.
CLI::Validator phiz_name();

/// Refuses an output that is one of the files that the verb reads; empty names count for nothing.
void protect_inputs(const std::string& output, std::initializer_list<std::string> inputs);

}  // namespace phiz
