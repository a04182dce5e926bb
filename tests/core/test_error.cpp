// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "phiz/core/error.h"

namespace phiz {
namespace {

TEST(Error, NamesPlaceEventAndMend) {
  try {
    reject("head.obj:12", "vertex index 99 is out of range (8 vertices)", "export the file again");
    FAIL() << "reject returned";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "head.obj:12: vertex index 99 is out of range (8 vertices); export the file again");
    EXPECT_EQ(error.kind(), ErrorKind::bad_input);
  }
}

TEST(Error, LeavesOutTheMendWhenThereIsNone) {
  try {
    fail("the disk is full");
    FAIL() << "fail returned";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "the disk is full");
    EXPECT_EQ(error.kind(), ErrorKind::failure);
  }
}

TEST(Error, ExitCodesAreTheDocumentedOnes) {
  EXPECT_EQ(exit_code(ErrorKind::failure), 1);
  EXPECT_EQ(exit_code(ErrorKind::usage), 2);
  EXPECT_EQ(exit_code(ErrorKind::bad_input), 3);
}

}  // namespace
}  // namespace phiz
