// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "anatomy/preview_head.h"
#include "phiz/anatomy/attachments.h"
#include "phiz/anatomy/face_frame.h"
#include "phiz/anatomy/muscle_table.h"
#include "phiz/core/error.h"

namespace phiz {
namespace {

using test::preview_head;

Vector3d place(Eigen::Index i) {
  return preview_head().volume.V.row(preview_head().attachments.vertices[i]);
}

bool pinned(Eigen::Index i) {
  return preview_head().attachments.hold[i] == static_cast<int>(Hold::pin);
}

TEST(AttachmentsOfAHead, LieOnBonesThatTouchFleshAndNotOnTheSkin) {
  const Attachments& a = preview_head().attachments;
  ASSERT_GT(a.vertices.size(), 300);
  const std::set<int> skin(preview_head().skin_vertices.begin(), preview_head().skin_vertices.end());
  for (const int v : a.vertices) {
    EXPECT_NE(preview_head().carrier[v], static_cast<int>(Carrier::flesh));
    EXPECT_FALSE(skin.contains(v));
  }
}

TEST(AttachmentsOfAHead, PointOutOfTheBone) {
  // On the vault and the forehead out of the bone is away from the middle of the head.
  const Vector3d middle(0, 0.06, -0.02);
  for (Eigen::Index i = 0; i < preview_head().attachments.vertices.size(); ++i)
    if (place(i).y() > 0.06) {
      EXPECT_GT(Vector3d(preview_head().attachments.normals.row(i)).dot(place(i) - middle), 0);
    }
}

TEST(AttachmentsOfAHead, SlideOnTheForeheadAndHoldTheChinAndTheTeeth) {
  const FaceFrame frame = face_frame(preview_head());
  int forehead = 0, chin = 0;
  for (Eigen::Index i = 0; i < preview_head().attachments.vertices.size(); ++i) {
    const Vector3d p = place(i);
    const bool mandible =
        preview_head().carrier[preview_head().attachments.vertices[i]] == static_cast<int>(Carrier::mandible);
    if (p.y() > frame.brow + 0.01) {
      ++forehead;
      EXPECT_FALSE(pinned(i)) << p.transpose();
    }
    if (mandible && std::abs(p.x()) < 0.01 && p.z() > frame.mouth_corner.z() - 0.01) {
      ++chin;
      EXPECT_TRUE(pinned(i)) << p.transpose();
    }
  }
  EXPECT_GT(forehead, 20);
  EXPECT_GT(chin, 3);
}

TEST(AttachmentsOfAHead, HoldWhereMusclesArise) {
  int near = 0;
  for (const Muscle& m : preview_head().muscles) {
    const MuscleFacts* facts = find_muscle_facts(m.name);
    if (m.ring || !facts->origin_on_bone || !facts->expression) continue;
    for (const MatrixX3d& fibre : m.fibres)
      for (Eigen::Index i = 0; i < preview_head().attachments.vertices.size(); ++i)
        if ((place(i) - fibre.row(0).transpose()).norm() < 0.003) {
          ++near;
          EXPECT_TRUE(pinned(i)) << m.name;
        }
  }
  EXPECT_GT(near, 10);
}

TEST(AttachmentsOfAHead, TheRulesOfTheTableFindTheirPlaces) {
  std::map<std::string, int> count;
  find_attachments(preview_head(), &count);
  for (const char* rule :
       {"muscle origin", "nose", "alveolar", "chin", "deep", "scalp", "temple", "cheekbone", "jaw", "elsewhere"})
    EXPECT_GT(count[rule], 0) << rule;
  int all = 0;
  for (const auto& [rule, n] : count) all += n;
  EXPECT_EQ(all, preview_head().attachments.vertices.size());
}

TEST(AttachmentsOfAHead, NeedLandmarks) {
  HeadTemplate head = test::preview_head();
  std::erase_if(head.landmarks, [](const Landmark& mark) { return mark.name == "42"; });
  try {
    find_attachments(head);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("landmark 42"), std::string::npos);
  }
}

}  // namespace
}  // namespace phiz
