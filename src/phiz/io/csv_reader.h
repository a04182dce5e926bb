// SPDX-License-Identifier: GPL-3.0-or-later
/// Tables of text fields: comma, semicolon or tab separated.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "phiz/io/text_scanner.h"

namespace phiz {

/// Goes through the rows of a table held in memory. The first line is the header. The separator is the one of `,` `;`
/// tab that the header has most of, or that a line `sep=X` before it names. Fields may be quoted (a doubled quote
/// inside stands for one); blank lines and a byte order mark are skipped.
class CsvReader {
 public:
  /// Reads the header. `where` names the file. Throws phiz::Error(bad_input) when there is none, or no plain text.
  CsvReader(std::string_view text, std::string where);

  const std::vector<std::string>& header() const { return header_; }
  /// File and line of the header.
  const std::string& header_place() const { return header_place_; }

  /// Moves to the next row; false at the end. Throws for open quotes.
  bool next();
  /// Fields of the row; a separator at the end of the line makes no further field.
  const std::vector<std::string>& fields() const { return fields_; }
  /// Number of the row's line, from 1.
  int line() const { return lines_.number(); }
  /// Throws phiz::Error(bad_input) unless the row is as long as the header.
  void require_full_row() const;

 private:
  std::string here() const;
  bool next_filled_line();

  std::string where_;
  LineScanner lines_;
  char separator_ = ',';
  std::vector<std::string> header_;
  std::string header_place_;
  std::vector<std::string> fields_;
};

}  // namespace phiz
