// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>

#include "anatomy/preview_head.h"
#include "phiz/anatomy/builtin/expressions/recipes.h"
#include "phiz/anatomy/builtin/muscles.h"
#include "phiz/anatomy/fibres.h"
#include "phiz/anatomy/muscle_table.h"
#include "phiz/anatomy/sides.h"
#include "phiz/geometry/operators.h"
#include "phiz/geometry/validate.h"

namespace phiz {
namespace {

using test::preview_head;

TEST(Muscles, AreThirtyThreeOfExpressionAndTheTwoClosers) {
  const std::vector<MuscleBundle> muscles = make_muscle_bundles(Proportions{});
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
  const std::vector<MuscleBundle> muscles = make_muscle_bundles(Proportions{});
  for (std::size_t i = 0; i + 1 < muscles.size(); ++i) {
    if (!muscles[i].name.ends_with("Left")) continue;
    const MuscleBundle &left = muscles[i], &right = muscles[i + 1];
    ASSERT_EQ(right.name, left.name.substr(0, left.name.size() - 4) + "Right");
    for (std::size_t f = 0; f < left.fibres.size(); ++f)
      EXPECT_EQ(MatrixX3d(left.fibres[f] * Vector3d(-1, 1, 1).asDiagonal()), right.fibres[f]);
  }
}

TEST(MusclesInAHead, ReachTheMarginsOfTheLids) {
  VectorXd filled = VectorXd::Zero(preview_head().volume.T.rows());
  for (const Muscle& m : preview_head().muscles) {
    EXPECT_TRUE(std::is_sorted(m.tets.begin(), m.tets.end())) << m.name;
    EXPECT_EQ(std::adjacent_find(m.tets.begin(), m.tets.end()), m.tets.end()) << m.name;
    for (Eigen::Index i = 0; i < m.tets.size(); ++i) filled[m.tets[i]] += m.fraction[i];
  }
  EXPECT_LE(filled.maxCoeff(), 1 + 1e-9);
  for (const char* name : {"leftUpperLid", "leftLowerLid", "rightUpperLid", "rightLowerLid"}) {
    const auto lid = std::find_if(preview_head().contact_regions.begin(), preview_head().contact_regions.end(),
                                  [&](const ContactRegion& region) { return region.name == name; });
    ASSERT_NE(lid, preview_head().contact_regions.end());
    const std::set<int> vertices(lid->vertices.begin(), lid->vertices.end());
    int tets = 0;
    for (Eigen::Index t = 0; t < filled.size(); ++t) {
      const auto corners = preview_head().volume.T.row(t);
      if (preview_head().volume.region[t] != Tissue::flesh ||
          std::none_of(corners.begin(), corners.end(), [&](int v) { return vertices.contains(v); }))
        continue;
      EXPECT_GE(filled[t], 0.6 - 1e-9) << name;
      ++tets;
    }
    EXPECT_GT(tets, 20) << name;
  }
}

TEST(MusclesInAHead, FillAShareOfTheFleshWithUnitFibres) {
  const VectorXd volume = tet_volumes(preview_head().volume.V, preview_head().volume.T);
  VectorXd filled = VectorXd::Zero(volume.size());
  for (const Muscle& m : preview_head().muscles) {
    EXPECT_GT(m.tets.size(), 0) << m.name;
    for (Eigen::Index i = 0; i < m.tets.size(); ++i) {
      EXPECT_EQ(preview_head().volume.region[m.tets[i]], Tissue::flesh);
      EXPECT_GT(m.fraction[i], 0);
      EXPECT_NEAR(m.direction.row(i).norm(), 1, 1e-9);
      filled[m.tets[i]] += m.fraction[i];
    }
  }
  EXPECT_LE(filled.maxCoeff(), 1 + 1e-9);
  EXPECT_GT(filled.dot(volume), 20e-6);  // cubic metres: the muscles of a face weigh tens of grams
  EXPECT_NEAR(active_share(preview_head()), 0.07, 0.02);
}

TEST(MusclesInAHead, AreClosedSurfacesInsideTheFlesh) {
  for (const Muscle& m : preview_head().muscles) {
    require_closed_manifold(m.surface, m.name);
    EXPECT_GE(share_in_flesh(preview_head().volume, m.surface), 0.95) << m.name;
    const MuscleFacts* facts = find_muscle_facts(m.name);
    ASSERT_NE(facts, nullptr) << m.name;
    EXPECT_EQ(m.ring, facts->form == MuscleForm::ring) << m.name;
    EXPECT_GE(m.fibres.size(), 8U) << m.name;
  }
}

TEST(MusclesInAHead, AreThoseOfTheTable) {
  std::set<std::string> names;
  for (const Muscle& m : preview_head().muscles) names.insert(m.name);
  const std::vector<std::string> wanted = expression_muscle_names();
  EXPECT_EQ(wanted.size(), 33U);
  for (const std::string& name : wanted) EXPECT_TRUE(names.contains(name)) << name;
}

TEST(MuscleTable, KnowsEveryMuscleThatAnExpressionShortens) {
  for (const ExpressionRecipe& recipe : expression_recipes())
    for (const MusclePull& pull : recipe.pulls) {
      const MuscleFacts* facts = find_muscle_facts(pull.muscle);
      const std::string full = std::string(pull.muscle) + "Left";
      if (facts == nullptr) facts = find_muscle_facts(full);
      ASSERT_NE(facts, nullptr) << pull.muscle;
      std::istringstream shapes{std::string(facts->shapes)};
      const bool listed = std::any_of(std::istream_iterator<std::string>(shapes), {}, [&](const std::string& shape) {
        return shape == recipe.name || (recipe.paired && shape == without_side(recipe.name));
      });
      EXPECT_TRUE(listed) << facts->stem << " should list " << recipe.name;
    }
}

TEST(MuscleTable, IsPrintedInTheDocumentation) {
  std::ifstream file("docs/anatomy.md");
  const std::string page{std::istreambuf_iterator<char>(file), {}};
  ASSERT_FALSE(page.empty()) << "run in the source folder";
  for (const MuscleFacts& m : muscle_table()) {
    const std::string form = m.form == MuscleForm::ring ? "ring" : m.form == MuscleForm::sheet ? "sheet" : "spindle";
    std::string row = "| " + std::string(m.stem) + " | " + std::string(m.latin) + " | " + (m.paired ? "2" : "1") +
                      " | " + form + " | " + (m.origin_on_bone ? "bone" : "soft tissue");
    for (const std::string_view column : {m.units, m.shapes, m.parts_left, m.parts_right})
      row += " | " + std::string(column);
    EXPECT_NE(page.find(row + " |"), std::string::npos) << "docs/anatomy.md lacks the line\n" << row << " |";
  }
}

}  // namespace
}  // namespace phiz
