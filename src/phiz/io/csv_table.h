// SPDX-License-Identifier: GPL-3.0-or-later
/// Tables of text fields: comma, semicolon or tab separated.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace phiz {

struct CsvTable {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;  ///< each as long as the header
  std::vector<int> lines;                      ///< line number of each row
  char separator = ',';
};

/// Reads a table with one header line. The separator is the one of `,` `;` tab that the header has most of. Fields may
/// be quoted (a doubled quote inside stands for one); blank lines are skipped; a byte order mark is skipped. Throws
/// phiz::Error(bad_input) with the line for rows of another length than the header and for open quotes.
CsvTable parse_csv(std::string_view text, const std::string& where);

}  // namespace phiz
