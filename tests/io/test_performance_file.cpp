// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "io/expect_error.h"
#include "io/sample_nouns.h"
#include "io/temporary_folder.h"
#include "io/version1.h"
#include "phiz/io/container.h"

namespace phiz {
namespace {

void expect_same(const Performance& a, const Performance& b) {
  EXPECT_EQ(a.expressions, b.expressions);
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.weights, b.weights);
  EXPECT_EQ(a.head, b.head);
  EXPECT_EQ(a.left_eye, b.left_eye);
  EXPECT_EQ(a.right_eye, b.right_eye);
  EXPECT_EQ(a.frame_rate, b.frame_rate);
}

TEST(PerformanceFile, reads_back_the_same) {
  const TemporaryFolder folder;
  const Performance performance = sample_performance();
  save(folder.file("a.phiz"), performance);
  EXPECT_EQ(kind_of(folder.file("a.phiz")), ContainerKind::performance);
  expect_same(performance, load_performance(folder.file("a.phiz")));
}

TEST(PerformanceFile, version_1_still_loads) {
  const TemporaryFolder folder;
  const Performance performance = sample_performance();
  version1::write_performance(folder.file("a.phiz"), performance);
  expect_same(performance, load_performance(folder.file("a.phiz")));
}

TEST(PerformanceFile, invalid_content_is_refused) {
  const TemporaryFolder folder;
  Performance performance = sample_performance();
  performance.time[3] = performance.time[2];
  save(folder.file("a.phiz"), performance);
  EXPECT_REJECTED(load_performance(folder.file("a.phiz")), "a.phiz");
}

}  // namespace
}  // namespace phiz
