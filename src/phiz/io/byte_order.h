// SPDX-License-Identifier: GPL-3.0-or-later
/// Numbers inside byte strings, in either byte order, at any alignment.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string>
#include <string_view>

namespace phiz {

/// The number whose bytes start at `offset`; the caller has checked that they are there.
template <class Number>
Number load_number(std::string_view bytes, std::size_t offset, std::endian order = std::endian::little) {
  std::array<char, sizeof(Number)> raw;
  std::memcpy(raw.data(), bytes.data() + offset, raw.size());
  if (order != std::endian::native) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<Number>(raw);
}

/// Appends the bytes of a number.
template <class Number>
void append_number(std::string& bytes, Number value, std::endian order = std::endian::little) {
  auto raw = std::bit_cast<std::array<char, sizeof(Number)>>(value);
  if (order != std::endian::native) std::reverse(raw.begin(), raw.end());
  bytes.append(raw.data(), raw.size());
}

}  // namespace phiz
