// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "phiz/anatomy/builtin/builtin_head.h"
#include "phiz/anatomy/builtin/expressions/recipes.h"
#include "phiz/anatomy/expression_names.h"
#include "phiz/geometry/surface.h"

namespace phiz {
namespace {

const HeadTemplate& head() {
  static const HeadTemplate built = build_builtin_head(BuiltinOptions{});
  return built;
}

const Expression& expression(const std::string& name) {
  const Expression* found = find_expression(head(), name);
  EXPECT_NE(found, nullptr) << name;
  return *found;
}

int vertex(int mark) {
  for (const Landmark& landmark : head().landmarks)
    if (landmark.name == std::to_string(mark)) return landmark.skin_vertex;
  ADD_FAILURE() << "no landmark " << mark;
  return 0;
}

/// Displacement of one of the 68 marks, millimetres.
Vector3d shift(const std::string& name, int mark) {
  return 1e3 * expression(name).displacement.row(vertex(mark)).transpose();
}

/// Position of a mark in an expression, millimetres.
Vector3d place(const std::string& name, int mark) {
  return 1e3 * head().skin.V.row(vertex(mark)).transpose() + shift(name, mark);
}

double largest(const std::string& name, const std::string& region) {
  double most = 0;
  for (const int v : head().skin_regions.at(region))
    most = std::max(most, 1e3 * expression(name).displacement.row(v).norm());
  return most;
}

/// Triangles that the expression folds over: their normal opposes that of their neighbourhood. The lining behind the
/// lids is left out: between lids that press it together normals mean nothing; that it does not cross itself is
/// another test.
int folded_triangles(const MatrixX3d& V) {
  const MatrixX3i& F = head().skin.F;
  const MatrixX3d faces = triangle_area_normals(V, F), normals = vertex_normals(V, F);
  std::vector<char> lining(static_cast<std::size_t>(V.rows()), 0);
  for (const char* name : {"leftSocket", "rightSocket"})
    for (const int v : head().skin_regions.at(name)) lining[static_cast<std::size_t>(v)] = 1;
  int count = 0;
  for (Eigen::Index f = 0; f < F.rows(); ++f) {
    const auto is_lining = [&](int k) { return lining[static_cast<std::size_t>(F(f, k))] != 0; };
    if (is_lining(0) && is_lining(1) && is_lining(2)) continue;
    const Vector3d around = (normals.row(F(f, 0)) + normals.row(F(f, 1)) + normals.row(F(f, 2))).transpose();
    count += faces.row(f).dot(around.transpose()) < 0;
  }
  return count;
}

/// The skin with several expressions at the same weight.
MatrixX3d skin_with(const std::vector<std::string>& names, double weight) {
  MatrixX3d V = head().skin.V;
  for (const std::string& name : names) V += weight * expression(name).displacement;
  return V;
}

/// Pairs of triangles on and round some regions that pass through one another.
std::size_t crossings(const std::vector<const char*>& regions, const MatrixX3d& V) {
  std::vector<char> near(static_cast<std::size_t>(head().skin.V.rows()), 0);
  for (const char* name : regions)
    for (const int v : head().skin_regions.at(name)) near[static_cast<std::size_t>(v)] = 1;
  std::vector<int> faces;
  for (int f = 0; f < head().skin.F.rows(); ++f)
    for (int k = 0; k < 3; ++k)
      if (near[static_cast<std::size_t>(head().skin.F(f, k))]) {
        faces.push_back(f);
        break;
      }
  TriangleMesh part;
  part.V = V;
  part.F = head().skin.F(faces, Eigen::all);
  return self_intersections(part).size();
}
std::size_t crossings_at_the_lips(const MatrixX3d& V) {
  return crossings({"upperLip", "lowerLip", "upperLipInner", "lowerLipInner"}, V);
}

/// By how much the lips are farther apart than at rest, at the most and upright, millimetres.
double parting(const MatrixX3d& V) {
  const VectorXi &upper = head().skin_regions.at("loop:upperLipLine"),
                 &lower = head().skin_regions.at("loop:lowerLipLine");
  const MatrixX3d& rest = head().skin.V;
  double most = 0;
  for (const int u : upper) {
    int nearest = lower[0];
    for (const int l : lower)
      if ((rest.row(l) - rest.row(u)).norm() < (rest.row(nearest) - rest.row(u)).norm()) nearest = l;
    most = std::max(most, 1e3 * ((V(u, 1) - V(nearest, 1)) - (rest(u, 1) - rest(nearest, 1))));
  }
  return most;
}

// Marks: 17-21 right brow, 22-26 left brow (22 inner), 31-35 nostrils, 42 inner and 45 outer corner of the left eye,
// 48 right and 54 left corner of the mouth, 51 top and 57 bottom of the lips, 62 and 66 their parting, 8 chin.
constexpr int chin = 8, left_inner_brow = 22, left_outer_brow = 25, left_ala = 35, right_corner = 48, left_corner = 54,
              lip_top = 51, lip_bottom = 57, parting_above = 62, parting_below = 66, left_upper_lip = 53,
              left_lower_lip = 55, left_upper_lid = 43, left_lower_lid = 47;

TEST(Expressions, AllFiftyTwoArePresentInTheirOrderAndFinite) {
  ASSERT_EQ(head().expressions.size(), expression_names.size());
  for (std::size_t i = 0; i < expression_names.size(); ++i) {
    const Expression& e = head().expressions[i];
    EXPECT_EQ(e.name, expression_names[i]);
    ASSERT_EQ(e.displacement.rows(), head().skin.V.rows());
    EXPECT_TRUE(e.displacement.allFinite()) << e.name;
    const double most = 1e3 * e.displacement.rowwise().norm().maxCoeff();
    EXPECT_GT(most, 0.5) << e.name;
    EXPECT_LT(most, 60) << e.name;
  }
}

TEST(Expressions, RightOnesAreMirrorImagesOfLeftOnes) {
  const MatrixX3d& V = head().skin.V;
  std::map<std::array<long, 3>, int> at;  // by position rounded to a micrometre, x reflected
  const auto key = [&](int v, double sign) {
    return std::array<long, 3>{std::lround(sign * V(v, 0) * 1e6), std::lround(V(v, 1) * 1e6),
                               std::lround(V(v, 2) * 1e6)};
  };
  for (int v = 0; v < V.rows(); ++v) at[key(v, -1)] = v;
  int compared = 0;
  for (const std::string_view name : expression_names) {
    const std::string other = other_side(name);
    const Expression &e = expression(std::string(name)), &m = expression(other);
    EXPECT_NEAR(e.jaw[0], m.jaw[0], 1e-12);
    EXPECT_NEAR(e.jaw[1], -m.jaw[1], 1e-12);
    for (int v = 0; v < V.rows(); ++v) {
      const auto found = at.find(key(v, 1));
      if (found == at.end()) continue;
      ++compared;
      const Vector3d wanted(-e.displacement(v, 0), e.displacement(v, 1), e.displacement(v, 2));
      ASSERT_LT((m.displacement.row(found->second).transpose() - wanted).norm(), 1e-9) << name << " vertex " << v;
    }
  }
  EXPECT_GT(compared, 52 * V.rows() * 9 / 10);
}

TEST(Expressions, MoveWhatTheirNamesSay) {
  struct Claim {
    const char* name;
    int mark;
    Vector3d direction;
    double at_least;  // millimetres
  };
  const Vector3d up(0, 1, 0), left(1, 0, 0), forward(0, 0, 1);
  const std::vector<Claim> claims = {
      {"jawForward", chin, forward, 3},
      {"jawLeft", chin, left, 4},
      {"jawRight", chin, -left, 4},
      {"jawOpen", chin, -up, 20},
      {"mouthFunnel", lip_top, forward, 4},
      {"mouthFunnel", parting_above, forward, 5},
      {"mouthFunnel", parting_above, up, 1.5},
      {"mouthFunnel", parting_below, -up, 1.5},
      {"mouthPucker", lip_top, forward, 4},
      {"mouthPucker", lip_bottom, forward, 3},
      {"mouthPucker", parting_above, forward, 5},
      {"mouthPucker", parting_below, forward, 5},
      {"mouthLeft", lip_top, left, 3},
      {"mouthRight", lip_top, -left, 3},
      {"mouthSmileLeft", left_corner, up, 4},
      {"mouthSmileLeft", left_corner, left, 3},
      {"mouthFrownLeft", left_corner, -up, 4},
      {"mouthDimpleLeft", left_corner, left, 2},
      {"mouthStretchLeft", left_corner, left, 4},
      {"mouthRollLower", lip_bottom, -forward, 0.5},
      {"mouthRollUpper", lip_top, -forward, 0.5},
      {"mouthShrugLower", lip_bottom, up, 2},
      {"mouthShrugLower", lip_bottom, forward, 1},
      {"mouthShrugUpper", lip_top, up, 1.5},
      {"mouthLowerDownLeft", left_lower_lip, -up, 3},
      {"mouthUpperUpLeft", left_upper_lip, up, 3},
      {"browDownLeft", left_inner_brow, -up, 2},
      {"browInnerUp", left_inner_brow, up, 3},
      {"browOuterUpLeft", left_outer_brow, up, 3},
      {"noseSneerLeft", left_ala, up, 2},
  };
  for (const Claim& claim : claims)
    EXPECT_GT(shift(claim.name, claim.mark).dot(claim.direction), claim.at_least)
        << claim.name << " moves mark " << claim.mark << " by " << shift(claim.name, claim.mark).transpose() << " mm";
}

TEST(Expressions, LeaveFarRegionsStill) {
  for (const std::string_view name : expression_names) {
    double crown = 0;  // the vault above the forehead; the skin behind the jaw goes with the jaw
    for (const int v : head().skin_regions.at("scalp"))
      if (head().skin.V(v, 1) > 0.115)
        crown = std::max(crown, expression(std::string(name)).displacement.row(v).norm());
    EXPECT_LT(1e3 * crown, 1.5) << name;
  }
  for (const char* name : {"eyeBlinkLeft", "eyeSquintLeft", "browDownLeft", "noseSneerLeft", "browOuterUpLeft"}) {
    EXPECT_LT(shift(name, lip_bottom).norm(), 0.3) << name;
    EXPECT_LT(largest(name, "rightCheek"), 0.6) << name;
  }
  for (const char* name : {"jawOpen", "mouthPucker", "mouthSmileLeft", "mouthFunnel"})
    EXPECT_LT(largest(name, "leftBrow"), 1.0) << name;
}

TEST(Expressions, BlinkClosesTheLidsWithoutCuttingTheEyeball) {
  const auto curve = [](const char* loop) {
    MatrixX3d points(head().skin_regions.at(loop).size(), 3);
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      const int v = head().skin_regions.at(loop)[i];
      points.row(i) = head().skin.V.row(v) + expression("eyeBlinkLeft").displacement.row(v);
    }
    return points;
  };
  const MatrixX3d upper = curve("loop:leftUpperLidMargin"), lower = curve("loop:leftLowerLidMargin");
  for (Eigen::Index i = 0; i < upper.rows(); ++i) {
    double nearest = 1;
    for (Eigen::Index j = 0; j + 1 < lower.rows(); ++j) {
      const Vector3d a = lower.row(j), e = lower.row(j + 1).transpose() - a, p = upper.row(i);
      const double t = std::clamp((p - a).dot(e) / e.squaredNorm(), 0.0, 1.0);
      nearest = std::min(nearest, (a + t * e - p).norm());
    }
    EXPECT_LT(1e3 * nearest, 0.5) << "upper margin vertex " << i;
  }
  const double radius = Proportions{}.eye_radius;
  for (const char* region : {"leftUpperLid", "leftLowerLid", "leftSocket"})
    for (const int v : head().skin_regions.at(region)) {
      const Vector3d p = (head().skin.V.row(v) + expression("eyeBlinkLeft").displacement.row(v)).transpose();
      EXPECT_GT((p - head().left_eye_centre).norm(), radius - 0.0002) << region << " vertex " << v;
    }
}

TEST(Expressions, LidsAndTheirLiningDoNotPassThroughThemselves) {
  const std::vector<const char*> eye{"leftUpperLid", "leftLowerLid", "leftSocket"};
  const std::size_t neutral = crossings(eye, head().skin.V);
  for (const char* name : {"eyeBlinkLeft", "eyeSquintLeft", "eyeWideLeft", "eyeLookUpLeft", "eyeLookDownLeft",
                           "eyeLookInLeft", "eyeLookOutLeft", "cheekSquintLeft", "mouthSmileLeft", "noseSneerLeft"})
    for (const double weight : {0.5, 1.0})
      EXPECT_LE(crossings(eye, skin_with({name}, weight)), neutral) << name << " at " << weight;
}

TEST(Expressions, ClosingLidsLeaveTheBrow) {
  for (const char* name : {"eyeBlinkLeft", "eyeLookDownLeft"}) EXPECT_LT(largest(name, "leftBrow"), 0.5) << name;
}

TEST(Expressions, LidsThatCloseTogetherOverlapByLessThanHalfOfTheOpening) {
  const auto height = [](const MatrixX3d& V, int mark) { return 1e3 * V(vertex(mark), 1); };
  const MatrixX3d all = skin_with({"eyeBlinkLeft", "eyeSquintLeft", "cheekSquintLeft"}, 1);
  const double open = height(head().skin.V, left_upper_lid) - height(head().skin.V, left_lower_lid);
  EXPECT_LT(height(all, left_lower_lid) - height(all, left_upper_lid), 0.5 * open);
}

TEST(Expressions, JawOpenPartsTheLipsAndMouthCloseClosesThemAgain) {
  const auto gap = [](const Vector3d& above, const Vector3d& below) { return above.y() - below.y(); };
  EXPECT_GT(gap(place("jawOpen", parting_above), place("jawOpen", parting_below)), 25);
  const double closed = gap(place("jawOpen", parting_above) + shift("mouthClose", parting_above),
                            place("jawOpen", parting_below) + shift("mouthClose", parting_below));
  EXPECT_LT(closed, 2);
  EXPECT_GT(closed, -0.5);
  EXPECT_TRUE(expression("mouthClose").jaw.isZero());
  EXPECT_GT(expression("jawOpen").jaw[0], 0.3);
}

TEST(Expressions, PuckerNarrowsTheMouthSmilesWidenIt) {
  const double width =
      (1e3 * (head().skin.V.row(vertex(left_corner)) - head().skin.V.row(vertex(right_corner)))).norm();
  EXPECT_LT((place("mouthPucker", left_corner) - place("mouthPucker", right_corner)).norm(), 0.75 * width);
  const Vector3d left = place("mouthSmileLeft", left_corner), right = place("mouthSmileRight", right_corner);
  EXPECT_GT((left - right).norm(), 1.1 * width);
}

TEST(Expressions, LipsDoNotPassThroughOneAnother) {
  const std::size_t neutral = crossings_at_the_lips(head().skin.V);
  std::vector<std::vector<std::string>> played = {{"jawOpen", "mouthClose"}};
  for (const std::string_view name : expression_names) {
    const std::string one(name), other = other_side(name);
    if (one == "mouthClose" || one.ends_with("Right")) continue;  // made for jawOpen; mirrored
    played.push_back({one});
    const bool press = one == "mouthPressLeft";  // both together press harder than shut: left to the contact of a take
    if (other != one && one != "mouthLeft" && one != "jawLeft" && !press) played.push_back({one, other});
  }
  for (const auto& names : played)
    for (const double weight : {0.5, 1.0})
      EXPECT_LE(crossings_at_the_lips(skin_with(names, weight)), neutral) << names.back() << " at " << weight;
}

TEST(Expressions, ClosedLipsStayClosed) {
  for (const double weight : {0.1, 0.4, 0.7, 1.0})
    EXPECT_LT(parting(skin_with({"jawOpen", "mouthClose"}, weight)), 0.5) << "over a jaw open by " << weight;
  const std::vector<std::vector<std::string>> closed = {{"mouthPucker"},
                                                        {"cheekPuff"},
                                                        {"mouthLeft"},
                                                        {"mouthSmileLeft", "mouthSmileRight"},
                                                        {"mouthFrownLeft", "mouthFrownRight"},
                                                        {"mouthDimpleLeft", "mouthDimpleRight"},
                                                        {"mouthStretchLeft", "mouthStretchRight"},
                                                        {"mouthPressLeft", "mouthPressRight"}};
  for (const auto& names : closed) EXPECT_LT(parting(skin_with(names, 1)), 1.0) << names.front();
}

TEST(Expressions, RollingHidesTheRedOfTheLip) {
  const auto height = [](const std::string& name, int border, int line) {
    return std::abs(place(name, border).y() - place(name, line).y());
  };
  EXPECT_LT(height("mouthRollUpper", lip_top, parting_above), 0.65 * height("jawForward", lip_top, parting_above));
  EXPECT_LT(height("mouthRollLower", lip_bottom, parting_below),
            0.65 * height("jawForward", lip_bottom, parting_below));
}

TEST(Expressions, AnOpenMouthIsTallerThanWideAndKeepsTheVolumeOfTheFlesh) {
  EXPECT_GT((place("jawOpen", lip_top) - place("jawOpen", lip_bottom)).norm(),
            (place("jawOpen", left_corner) - place("jawOpen", right_corner)).norm());
  double flesh = 0;
  const MatrixX3d& V = head().volume.V;
  for (Eigen::Index t = 0; t < head().volume.T.rows(); ++t) {
    if (head().volume.region[t] != Tissue::flesh) continue;
    const auto T = head().volume.T.row(t);
    const Vector3d a = V.row(T[0]), b = V.row(T[1]), c = V.row(T[2]), d = V.row(T[3]);
    flesh += (b - a).cross(c - a).dot(d - a) / 6;
  }
  const double rest = signed_volume(head().skin.V, head().skin.F);
  for (const std::string_view name : expression_names)
    EXPECT_LT(std::abs(signed_volume(skin_with({std::string(name)}, 1), head().skin.F) - rest), 0.02 * std::abs(flesh))
        << name;
}

TEST(Expressions, CheekPuffBulgesBothCheeks) {
  EXPECT_GT(largest("cheekPuff", "leftCheek"), 6);
  EXPECT_GT(largest("cheekPuff", "rightCheek"), 6);
}

TEST(Expressions, LidsStayInFrontOfTheEyeballOnTheirWay) {
  const double radius = Proportions{}.eye_radius;
  const auto height = [](const std::string& name, double weight, int v) {
    return (head().skin.V.row(v) + weight * expression(name).displacement.row(v) - head().left_eye_centre.transpose())
        .norm();
  };
  for (const char* name : {"eyeBlinkLeft", "eyeSquintLeft", "eyeWideLeft", "eyeLookUpLeft", "eyeLookDownLeft"}) {
    for (const char* region : {"leftUpperLid", "leftLowerLid"})
      for (const int v : head().skin_regions.at(region))
        EXPECT_GT(height(name, 1, v), radius - 0.0002) << name << ", " << region << " vertex " << v;
    // Halfway the edge that is seen goes straight where the lid slides round the eyeball.
    for (const char* edge : {"loop:leftUpperLidMargin", "loop:leftLowerLidMargin"})
      for (const int v : head().skin_regions.at(edge)) EXPECT_GT(height(name, 0.5, v), radius) << name << ", " << edge;
  }
}

TEST(Expressions, FoldNoTriangleOver) {
  const int neutral = folded_triangles(head().skin.V);
  for (const std::string_view name : expression_names) {
    if (name == "mouthClose") continue;  // made for use with jawOpen only
    EXPECT_LE(folded_triangles(head().skin.V + expression(std::string(name)).displacement), neutral) << name;
  }
  const MatrixX3d closed = head().skin.V + expression("jawOpen").displacement + expression("mouthClose").displacement;
  EXPECT_LE(folded_triangles(closed), neutral);
}

}  // namespace
}  // namespace phiz
