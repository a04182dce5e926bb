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

Vector3d three_numbers(const std::string& text, const char* option) {
  Vector3d out;
  std::size_t at = 0;
  for (int k = 0; k < 3; ++k) {
    const std::size_t end = k < 2 ? text.find(',', at) : text.size();
    const auto number =
        end == std::string::npos ? std::nullopt : parse_number(trimmed(std::string_view(text).substr(at, end - at)));
    if (!number || !std::isfinite(*number))
      misuse(fmt::format("{} '{}' is not of the form X,Y,Z, e.g. 0,-9.81,0", option, text));
    out[k] = *number;
    at = end + 1;
  }
  return out;
}

std::map<std::string, double> named_weights(const std::vector<std::string>& words, const char* option) {
  constexpr int largest = 10;  // far beyond any face, and safe to draw
  std::map<std::string, double> weights;
  for (const std::string& word : words) {
    const std::size_t at = word.find('=');
    const auto weight = at == std::string::npos ? 1.0 : parse_number(word.substr(at + 1));
    if (!weight || !(std::abs(*weight) <= largest))
      misuse(fmt::format("{} '{}' is not of the form NAME=WEIGHT with a weight from -{} to {}", option, word, largest,
                         largest));
    weights[word.substr(0, at)] = *weight;
  }
  return weights;
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
