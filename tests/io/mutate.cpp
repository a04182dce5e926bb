// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/mutate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>

#include "phiz/core/error.h"

namespace phiz {

namespace {

std::size_t place(const std::string& text, Random& random) {
  return text.empty() ? 0 : random.below(static_cast<std::uint32_t>(text.size()));
}

void flip_bits(std::string& text, Random& random) {
  if (text.empty()) return;
  for (std::uint32_t i = random.below(8) + 1; i > 0; --i) {
    char& c = text[place(text, random)];
    c = static_cast<char>(c ^ (1 << random.below(8)));
  }
}

void replace_word(std::string& text, Random& random) {
  constexpr std::array<std::uint32_t, 9> words = {0,          1,          0xFFFFFFFF, 0x7FFFFFFF, 0x80000000,
                                                  0x7F800000, 0x7FC00000, 0x000F4240, 0x00010000};
  if (text.size() < 4) return;
  std::uint32_t word = words[random.below(words.size())];
  if (random.below(2) == 0) word = __builtin_bswap32(word);
  // Headers deserve more damage than data.
  const std::size_t range = random.below(2) == 0 ? std::min<std::size_t>(text.size(), 200) : text.size();
  const std::size_t at = random.below(static_cast<std::uint32_t>(range - 3));
  for (std::size_t i = 0; i < 4; ++i) text[at + i] = static_cast<char>(word >> (8 * i));
}

void cut_end(std::string& text, Random& random) {
  text.resize(place(text, random));
}

void cut_block(std::string& text, Random& random) {
  text.erase(place(text, random), random.below(64) + 1);
}

void copy_block(std::string& text, Random& random) {
  const std::string block = text.substr(place(text, random), random.below(64) + 1);
  const std::size_t at = place(text, random);
  if (random.below(2) == 0) {
    text.insert(at, block);
  } else {
    text.replace(at, block.size(), block);
  }
}

void replace_number(std::string& text, Random& random) {
  constexpr std::array<std::string_view, 18> numbers = {"nan",
                                                        "inf",
                                                        "-inf",
                                                        "-1",
                                                        "0",
                                                        "1e999",
                                                        "-1e308",
                                                        "1e-320",
                                                        "99999999999999999999",
                                                        "-2147483648",
                                                        "4294967295",
                                                        "2147483647",
                                                        "1000000000000",
                                                        "",
                                                        "0x10",
                                                        "1.5",
                                                        "-0",
                                                        "+7"};
  const std::size_t start = place(text, random);
  const auto digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
  const auto first = std::find_if(text.begin() + static_cast<std::ptrdiff_t>(start), text.end(), digit);
  const auto last = std::find_if_not(first, text.end(), [&](char c) { return digit(c) || c == '.'; });
  text.replace(first, last, numbers[random.below(numbers.size())]);
}

void change_lines(std::string& text, Random& random) {
  const auto line_at = [&text](std::size_t at) {
    const std::size_t begin = text.rfind('\n', at);
    const std::size_t end = text.find('\n', at);
    const std::size_t first = begin == std::string::npos ? 0 : begin + 1;
    return std::pair(first, (end == std::string::npos ? text.size() : end + 1) - std::min(first, text.size()));
  };
  const auto [begin, length] = line_at(place(text, random));
  const std::string line = text.substr(std::min(begin, text.size()), length);
  const std::uint32_t action = random.below(3);
  if (action != 0) text.erase(std::min(begin, text.size()), length);
  if (action != 1) {
    const auto [other, ignored] = line_at(place(text, random));
    text.insert(std::min(other, text.size()), line);
  }
}

void insert_bytes(std::string& text, Random& random) {
  std::string bytes;
  for (std::uint32_t i = random.below(12) + 1; i > 0; --i) bytes += static_cast<char>(random.below(256));
  text.insert(place(text, random), bytes);
}

}  // namespace

std::string mutate(const std::string& seed, Random& random) {
  using Damage = void (*)(std::string&, Random&);
  constexpr std::array<Damage, 8> damages = {flip_bits,  replace_word,   cut_end,      cut_block,
                                             copy_block, replace_number, change_lines, insert_bytes};
  std::string text = seed;
  for (std::uint32_t i = random.below(4) + 1; i > 0; --i) damages[random.below(damages.size())](text, random);
  return text;
}

void expect_survives(const std::vector<std::string>& seeds, int count,
                     const std::function<void(const std::string&)>& read) {
  for (std::size_t s = 0; s < seeds.size(); ++s) {
    ASSERT_NO_THROW(read(seeds[s])) << "seed " << s << " is not valid";
    int refused = 0;
    for (int i = 0; i < count; ++i) {
      Random random(static_cast<std::uint64_t>(i), s);
      try {
        read(mutate(seeds[s], random));
      } catch (const Error& error) {
        EXPECT_FALSE(std::string(error.what()).empty());
        ++refused;
      } catch (const std::exception& error) {
        ADD_FAILURE() << "seed " << s << ", mutation " << i << ": " << error.what();
      }
    }
    EXPECT_GT(refused, 0) << "seed " << s << ": no damage was noticed";
  }
}

}  // namespace phiz
