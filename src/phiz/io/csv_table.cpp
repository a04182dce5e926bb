// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/io/csv_table.h"

#include <fmt/format.h>

#include <algorithm>

#include "phiz/core/error.h"
#include "phiz/io/text_scanner.h"

namespace phiz {

namespace {

constexpr std::size_t most_columns = 4096;

char separator_of(std::string_view header) {
  char best = ',';
  auto most = std::count(header.begin(), header.end(), ',');
  for (const char candidate : {';', '\t'}) {
    const auto count = std::count(header.begin(), header.end(), candidate);
    if (count > most) most = count, best = candidate;
  }
  return best;
}

std::vector<std::string> split_fields(std::string_view line, char separator, const std::string& where) {
  std::vector<std::string> fields(1);
  bool in_quotes = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (in_quotes && c == '"' && i + 1 < line.size() && line[i + 1] == '"') {
      fields.back() += line[++i];
    } else if (c == '"') {
      in_quotes = !in_quotes;
    } else if (c == separator && !in_quotes) {
      if (fields.size() == most_columns) reject(where, fmt::format("more than {} columns", most_columns));
      fields.emplace_back();
    } else {
      fields.back() += c;
    }
  }
  if (in_quotes) reject(where, "a quoted field is not closed on its line");
  for (std::string& field : fields) field = std::string(trimmed(field));
  return fields;
}

}  // namespace

CsvTable parse_csv(std::string_view text, const std::string& where) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  if (text.find('\0') != std::string_view::npos) {
    reject(where, "the file is no plain text, or text in UTF-16", "save it as UTF-8");
  }
  CsvTable table;
  LineScanner lines(text);
  while (lines.next()) {
    if (trimmed(lines.line()).empty()) continue;
    const std::string here = fmt::format("{}:{}", where, lines.number());
    if (table.header.empty()) table.separator = separator_of(lines.line());
    std::vector<std::string> fields = split_fields(lines.line(), table.separator, here);
    if (table.header.empty()) {
      table.header = std::move(fields);
      continue;
    }
    // A separator at the end of the line makes no further field.
    if (fields.size() == table.header.size() + 1 && fields.back().empty()) fields.pop_back();
    if (fields.size() != table.header.size()) {
      reject(here, fmt::format("{} fields, expected {} as in the header", fields.size(), table.header.size()),
             "the line is damaged or cut off; delete or complete it");
    }
    table.rows.push_back(std::move(fields));
    table.lines.push_back(lines.number());
  }
  if (table.header.empty()) reject(where, "no header line found");
  return table;
}

}  // namespace phiz
