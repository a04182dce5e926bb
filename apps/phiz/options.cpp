// SPDX-License-Identifier: GPL-3.0-or-later
#include "options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <limits>

#include "phiz/core/error.h"
#include "phiz/io/file_bytes.h"
#include "phiz/io/text_scanner.h"

namespace phiz {

void misuse(const std::string& message) {
  throw Error(ErrorKind::usage, message);
}

std::pair<double, double> two_numbers(const std::string& text, char separator, const char* option, const char* form) {
  const std::size_t at = text.find(separator);
  if (at != std::string::npos) {
    const auto a = parse_number(trimmed(text.substr(0, at))), b = parse_number(trimmed(text.substr(at + 1)));
    if (a && b && std::isfinite(*a) && std::isfinite(*b)) return {*a, *b};
  }
  misuse(fmt::format("{} '{}' is not of the form {}", option, text, form));
}

FrameRange frame_range(const std::string& text) {
  const auto [first, end] = two_numbers(text, ':', "--frames", "FIRST:END, e.g. 100:200");
  const bool whole = first == std::floor(first) && end == std::floor(end);
  if (!whole || first < 0 || end <= first || end > std::numeric_limits<int>::max())
    misuse("--frames " + text + ": FIRST and END must be whole numbers, FIRST not below 0 and END above FIRST");
  return {static_cast<int>(first), static_cast<int>(end)};
}

CLI::Validator between(double low, double high) {
  const std::string form = fmt::format("from {:g} to {:g}", low, high);
  return {[=](std::string& text) {
            const auto value = parse_number(text);
            return value && *value >= low && *value <= high ? std::string()
                                                            : fmt::format("'{}' is not a number {}", text, form);
          },
          form};
}

CLI::Validator phiz_name() {
  return {[](std::string& text) {
            return lower_extension(text) == ".phiz" ? std::string() : "'" + text + "' does not end in .phiz";
          },
          ".phiz"};
}

void protect_inputs(const std::string& output, std::initializer_list<std::string> inputs) {
  for (const std::string& input : inputs) {
    std::error_code none;
    if (!input.empty() && std::filesystem::equivalent(output, input, none))
      misuse("the output " + output + " is one of the files that are read; choose another name");
  }
}

}  // namespace phiz
