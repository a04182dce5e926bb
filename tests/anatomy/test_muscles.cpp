// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <set>

#include "phiz/anatomy/builtin/builtin_head.h"
#include "phiz/anatomy/builtin/muscles.h"
#include "phiz/geometry/operators.h"

namespace phiz {
namespace {

TEST(Muscles, AreThirtyThreeOfExpressionAndTheTwoClosers) {
  const std::vector<MuscleBundle> muscles = make_muscles(Proportions{});
  std::set<std::string> names;
  for (const MuscleBundle& m : muscles) {
    names.insert(m.name);
    EXPECT_FALSE(m.fibres.empty()) << m.name;
    for (const MatrixX3d& fibre : m.fibres) {
      EXPECT_GE(fibre.rows(), 2) << m.name;
      EXPECT_TRUE(fibre.allFinite()) << m.name;
    }
  }
  EXPECT_EQ(names.size(), muscles.size());
  EXPECT_EQ(muscles.size(), 33U + 4U);
  for (const char* name : {"procerus", "orbicularisOris", "depressorSepti", "zygomaticusMajorLeft", "platysmaRight"})
    EXPECT_TRUE(names.contains(name)) << name;
}

TEST(Muscles, AreMirrorImages) {
  const std::vector<MuscleBundle> muscles = make_muscles(Proportions{});
  for (std::size_t i = 0; i + 1 < muscles.size(); ++i) {
    if (!muscles[i].name.ends_with("Left")) continue;
    const MuscleBundle &left = muscles[i], &right = muscles[i + 1];
    ASSERT_EQ(right.name, left.name.substr(0, left.name.size() - 4) + "Right");
    for (std::size_t f = 0; f < left.fibres.size(); ++f)
      EXPECT_EQ(MatrixX3d(left.fibres[f] * Vector3d(-1, 1, 1).asDiagonal()), right.fibres[f]);
  }
}

TEST(Muscles, FillAShareOfTheFleshWithUnitFibres) {
  BuiltinOptions options;
  options.size = HeadSize::preview;
  options.expressions = false;
  const HeadTemplate head = build_builtin_head(options);
  const VectorXd volume = tet_volumes(head.volume.V, head.volume.T);
  VectorXd filled = VectorXd::Zero(volume.size());
  for (const Muscle& m : head.muscles) {
    EXPECT_GT(m.tets.size(), 0) << m.name;
    for (Eigen::Index i = 0; i < m.tets.size(); ++i) {
      EXPECT_EQ(head.volume.region[m.tets[i]], Tissue::flesh);
      EXPECT_GT(m.fraction[i], 0);
      EXPECT_NEAR(m.direction.row(i).norm(), 1, 1e-9);
      filled[m.tets[i]] += m.fraction[i];
    }
  }
  EXPECT_LE(filled.maxCoeff(), 1 + 1e-9);
  EXPECT_GT(filled.dot(volume), 20e-6);  // cubic metres: the muscles of a face weigh tens of grams
}

}  // namespace
}  // namespace phiz
