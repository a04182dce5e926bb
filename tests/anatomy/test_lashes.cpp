// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <string>

#include "anatomy/preview_head.h"
#include "phiz/anatomy/skin_ride.h"
#include "phiz/geometry/spatial_query.h"
#include "phiz/geometry/surface.h"
#include "phiz/geometry/topology.h"

namespace phiz {
namespace {

const Part& lashes(const std::string& side) {
  return *find_part(test::preview_head(), side + "Lashes");
}

TEST(Lashes, AreClosedHairsThatSpringFromTheLids) {
  const HeadTemplate& head = test::preview_head();
  const SurfaceQuery skin(head.skin);
  for (const std::string side : {"left", "right"}) {
    const Part& part = lashes(side);
    EXPECT_EQ(part.carrier, Carrier::flesh);
    EXPECT_TRUE(is_closed(part.mesh.F));
    EXPECT_GT(signed_volume(part.mesh.V, part.mesh.F), 0);
    const VectorXi hair = triangle_components(part.mesh.F);
    const int count = hair.maxCoeff() + 1;
    EXPECT_GE(count, 150);
    VectorXd root = VectorXd::Constant(count, 1), tip = VectorXd::Zero(count);
    for (Eigen::Index f = 0; f < part.mesh.F.rows(); ++f)
      for (int k = 0; k < 3; ++k) {
        const double d = std::sqrt(skin.closest_point(part.mesh.V.row(part.mesh.F(f, k))).squared_distance);
        root[hair[f]] = std::min(root[hair[f]], d);
        tip[hair[f]] = std::max(tip[hair[f]], d);
      }
    EXPECT_LT(root.maxCoeff(), 2e-4);
    EXPECT_GT(tip.mean(), 1.5e-3);
  }
}

TEST(SkinRide, FollowsARigidMotionExactlyAndKeepsHairsRigid) {
  const HeadTemplate& head = test::preview_head();
  const Part& part = lashes("left");
  const SkinRide ride(head.skin, part.mesh);
  EXPECT_LT((ride(head.skin.V) - part.mesh.V).cwiseAbs().maxCoeff(), 1e-12);
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.rotate(Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()));
  motion.pretranslate(Vector3d(0.1, -0.2, 0.3));
  const auto moved = [&](const MatrixX3d& V) {
    return MatrixX3d((V * motion.linear().transpose()).rowwise() + motion.translation().transpose());
  };
  EXPECT_LT((ride(moved(head.skin.V)) - moved(part.mesh.V)).cwiseAbs().maxCoeff(), 1e-12);
  // Under any other motion of the skin edges keep their lengths.
  MatrixX3d bent = head.skin.V;
  for (Eigen::Index v = 0; v < bent.rows(); ++v) bent(v, 1) -= 0.2 * bent(v, 2) * bent(v, 2) / 0.07;
  const MatrixX3d now = ride(bent);
  for (Eigen::Index f = 0; f < part.mesh.F.rows(); ++f)
    EXPECT_NEAR((now.row(part.mesh.F(f, 0)) - now.row(part.mesh.F(f, 1))).norm(),
                (part.mesh.V.row(part.mesh.F(f, 0)) - part.mesh.V.row(part.mesh.F(f, 1))).norm(), 1e-12);
}

}  // namespace
}  // namespace phiz
