// SPDX-License-Identifier: GPL-3.0-or-later
/// Lines, words and numbers of a text file held in memory.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace phiz {

/// Goes through the lines of a text. Ends of lines: LF, CR LF or CR.
class LineScanner {
 public:
  explicit LineScanner(std::string_view text) : rest_(text) {}

  /// Moves to the next line; false at the end of the text.
  bool next();
  std::string_view line() const { return line_; }
  /// Number of the line, from 1.
  int number() const { return number_; }
  /// What follows the line.
  std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_;
  std::string_view line_;
  int number_ = 0;
};

/// Splits at blanks and tabs into `words`, which is cleared first (so that its storage is used again).
void split_words(std::string_view line, std::vector<std::string_view>& words);

/// The number that fills the whole word, in any exponent format, with an optional sign; nothing when the word is not a
/// number. Values beyond the range of double come out infinite, below it zero; "nan" and "inf" are numbers.
std::optional<double> parse_number(std::string_view word);

/// The integer that fills the whole word; nothing when it is none or beyond 64 bits.
std::optional<long long> parse_integer(std::string_view word);

/// A word for an error message: quoted, shortened, unprintable characters replaced.
std::string quoted_word(std::string_view word);

/// Without blanks, tabs and line ends on either side.
std::string_view trimmed(std::string_view text);

/// In lower case (ASCII).
std::string lowered(std::string_view text);

}  // namespace phiz
