// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/io/csv_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "phiz/core/error.h"

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

/// Splits into `fields`, whose storage is used again.
void split_fields(std::string_view line, char separator, std::vector<std::string>& fields, const std::string& where) {
  std::size_t count = 0;
  const auto begin_field = [&]() -> std::string& {
    if (count == most_columns) reject(where, fmt::format("more than {} columns", most_columns));
    if (count == fields.size()) fields.emplace_back();
    fields[count].clear();
    return fields[count++];
  };
  std::string* field = &begin_field();
  bool in_quotes = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (in_quotes && c == '"' && i + 1 < line.size() && line[i + 1] == '"') {
      *field += line[++i];
    } else if (c == '"') {
      in_quotes = !in_quotes;
    } else if (c == separator && !in_quotes) {
      field = &begin_field();
    } else {
      *field += c;
    }
  }
  if (in_quotes) reject(where, "a quoted field is not closed on its line");
  fields.resize(count);
  for (std::string& f : fields) {
    const std::string_view bare = trimmed(f);
    if (bare.size() != f.size()) f = std::string(bare);
  }
}

std::string_view without_mark(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  return text;
}

}  // namespace

CsvReader::CsvReader(std::string_view text, std::string where) : where_(std::move(where)), lines_(without_mark(text)) {
  if (text.find('\0') != std::string_view::npos)
    reject(where_, "the file is no plain text, or text in UTF-16", "save it as UTF-8");
  if (!next_filled_line()) reject(where_, "no header line found");
  const std::string_view first = trimmed(lines_.line());
  const bool names_separator = first.size() == 5 && lowered(first).starts_with("sep=");
  if (names_separator && !next_filled_line()) reject(where_, "no header line found");
  separator_ = names_separator ? first[4] : separator_of(lines_.line());
  header_place_ = here();
  split_fields(lines_.line(), separator_, header_, header_place_);
  while (header_.size() > 1 && header_.back().empty()) header_.pop_back();
}

std::string CsvReader::here() const {
  return fmt::format("{}:{}", where_, lines_.number());
}

bool CsvReader::next_filled_line() {
  while (lines_.next())
    if (!trimmed(lines_.line()).empty()) return true;
  return false;
}

bool CsvReader::next() {
  if (!next_filled_line()) return false;
  split_fields(lines_.line(), separator_, fields_, here());
  while (fields_.size() > header_.size() && fields_.back().empty()) fields_.pop_back();
  return true;
}

void CsvReader::require_full_row() const {
  const std::size_t found = fields_.size(), expected = header_.size();
  if (found == expected) return;
  reject(here(), fmt::format("{} fields, expected {} as in the header", found, expected),
         found < expected || separator_ != ','
             ? "the line is damaged or cut off; delete or complete it"
             : "the line is damaged; numbers with a decimal comma need a semicolon between fields");
}

}  // namespace phiz
