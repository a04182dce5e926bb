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

const HeadTemplate& head() {
  return test::preview_head();
}

Vector3d place(Eigen::Index i) {
  return head().volume.V.row(head().attachments.vertices[i]);
}

bool pinned(Eigen::Index i) {
  return head().attachments.hold[i] == static_cast<int>(Hold::pin);
}

TEST(AttachmentsOfAHead, LieOnBonesThatTouchFleshAndNotOnTheSkin) {
  const Attachments& a = head().attachments;
  ASSERT_GT(a.vertices.size(), 300);
  const std::set<int> skin(head().skin_vertices.begin(), head().skin_vertices.end());
  for (const int v : a.vertices) {
    EXPECT_NE(head().carrier[v], static_cast<int>(Carrier::flesh));
    EXPECT_FALSE(skin.contains(v));
  }
}

TEST(AttachmentsOfAHead, PointOutOfTheBone) {
  // On the vault and the forehead out of the bone is away from the middle of the head.
  const Vector3d middle(0, 0.06, -0.02);
  for (Eigen::Index i = 0; i < head().attachments.vertices.size(); ++i)
    if (place(i).y() > 0.06) {
      EXPECT_GT(Vector3d(head().attachments.normals.row(i)).dot(place(i) - middle), 0);
    }
}

TEST(AttachmentsOfAHead, SlideOnTheForeheadAndHoldTheChinAndTheTeeth) {
  const FaceFrame frame = face_frame(head());
  int forehead = 0, chin = 0;
  for (Eigen::Index i = 0; i < head().attachments.vertices.size(); ++i) {
    const Vector3d p = place(i);
    const bool mandible = head().carrier[head().attachments.vertices[i]] == static_cast<int>(Carrier::mandible);
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
  for (const Muscle& m : head().muscles) {
    const MuscleFacts* facts = find_muscle_facts(m.name);
    if (m.ring || !facts->origin_on_bone || !facts->expression) continue;
    for (const MatrixX3d& fibre : m.fibres)
      for (Eigen::Index i = 0; i < head().attachments.vertices.size(); ++i)
        if ((place(i) - fibre.row(0).transpose()).norm() < 0.003) {
          ++near;
          EXPECT_TRUE(pinned(i)) << m.name;
        }
  }
  EXPECT_GT(near, 10);
}

TEST(AttachmentsOfAHead, TheRulesOfTheTableFindTheirPlaces) {
  std::map<std::string, int> count;
  find_attachments(head(), &count);
  for (const char* rule :
       {"muscle origin", "nose", "alveolar", "chin", "deep", "scalp", "temple", "cheekbone", "jaw", "elsewhere"})
    EXPECT_GT(count[rule], 0) << rule;
  int all = 0;
  for (const auto& [rule, n] : count) all += n;
  EXPECT_EQ(all, head().attachments.vertices.size());
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
