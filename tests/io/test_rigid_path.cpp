// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "io/expect_error.h"
#include "phiz/io/rigid_path_file.h"

namespace phiz {
namespace {

TEST(RigidPathFile, columns_come_in_any_order_and_quaternions_are_normalised) {
  const RigidPath path = parse_rigid_path("x;TIME;z;y;qw;qx;qy;qz\n1;-0.5;3;2;1;0;0;0\n1;0.5;3;2;2;0;2;0\n", "a.csv");
  ASSERT_EQ(path.time, (std::vector<double>{-0.5, 0.5}));
  EXPECT_EQ(path.places[0].translation(), Vector3d(1, 2, 3));
  EXPECT_TRUE(path.places[0].linear().isIdentity());
  EXPECT_TRUE((path.places[1].linear() * Vector3d::UnitZ()).isApprox(Vector3d::UnitX(), 1e-12));
}

TEST(RigidPathFile, without_a_quaternion_does_not_turn) {
  const RigidPath path = parse_rigid_path("time,x,y,z\n0,0,0,1\n", "a.csv");
  EXPECT_EQ(path.at(7).translation(), Vector3d(0, 0, 1));
  EXPECT_TRUE(path.at(7).linear().isIdentity());
}

TEST(RigidPathFile, malformed_tables_are_refused_with_file_and_line) {
  EXPECT_REJECTED(parse_rigid_path("time,x,y\n0,0,0\n", "a.csv"), "column z is missing");
  EXPECT_REJECTED(parse_rigid_path("time,x,y,z,qw\n0,0,0,0,1\n", "a.csv"), "column qx is missing");
  EXPECT_REJECTED(parse_rigid_path("time,x,y,z,w\n0,0,0,0,1\n", "a.csv"), "unknown column");
  EXPECT_REJECTED(parse_rigid_path("time,x,y,z,x\n0,0,0,0,1\n", "a.csv"), "comes twice");
  EXPECT_REJECTED(parse_rigid_path("time,x,y,z\n", "a.csv"), "no rows");
  EXPECT_REJECTED(parse_rigid_path("time,x,y,z\n0,0,0,0\n0,1,0,0\n", "a.csv"), "a.csv:3");
  EXPECT_REJECTED(parse_rigid_path("time,x,y,z\n0,0,nan,0\n", "a.csv"), "y is 'nan'");
  EXPECT_REJECTED(parse_rigid_path("time,x,y,z\n0,0,0\n", "a.csv"), "a.csv:2");
  EXPECT_REJECTED(parse_rigid_path("time,x,y,z,qw,qx,qy,qz\n0,0,0,0,0,0,0,0\n", "a.csv"), "quaternion");
  EXPECT_REJECTED(parse_rigid_path("time,x,y,z\n0,0,0,1000\n", "a.csv"), "100 m");
}

}  // namespace
}  // namespace phiz
