// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "phiz/core/nearest_words.h"

namespace phiz {
namespace {

TEST(NearestWords, CountsInsertedDeletedReplacedAndSwappedLetters) {
  EXPECT_EQ(edit_distance("jaw", "jaw"), 0U);
  EXPECT_EQ(edit_distance("jaw", "jaws"), 1U);
  EXPECT_EQ(edit_distance("jaw", "jw"), 1U);
  EXPECT_EQ(edit_distance("jaw", "paw"), 1U);
  EXPECT_EQ(edit_distance("jaw", "jwa"), 1U);
  EXPECT_EQ(edit_distance("", "jaw"), 3U);
}

TEST(NearestWords, PutsTheNearestFirstWhateverTheCase) {
  EXPECT_EQ(nearest_words("Maseter", {"buccinator", "masseter", "mentalis"}, 1),
            (std::vector<std::string>{"masseter"}));
  EXPECT_EQ(nearest_words("x", {"b", "a"}, 5), (std::vector<std::string>{"b", "a"}));
}

TEST(NearestWords, PutsWordsThatHoldTheWholeOneBeforeOthers) {
  EXPECT_EQ(nearest_words("oris", {"horse", "orbicularisOris"}, 1), (std::vector<std::string>{"orbicularisOris"}));
}

}  // namespace
}  // namespace phiz
