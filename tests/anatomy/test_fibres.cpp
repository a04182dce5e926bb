// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "anatomy/muscle_shapes.h"
#include "phiz/anatomy/fibres.h"
#include "phiz/core/error.h"
#include "phiz/core/random.h"
#include "phiz/geometry/operators.h"
#include "phiz/geometry/surface.h"
#include "phiz/geometry/validate.h"

namespace phiz {
namespace {

using test::flesh_block;
using test::rod;
using test::rod_muscle;

double degrees_between(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / std::numbers::pi;
}

/// The angles between the field and `expected(p)` at random points inside for which `where(p)` holds, ascending.
template <class Expected, class Where>
std::vector<double> angles(const FibreField& field, const Expected& expected, const Where& where) {
  std::vector<double> found;
  Random random(3);
  const Eigen::AlignedBox3d box = field.box();
  for (int i = 0; i < 40000; ++i) {
    const Vector3d p =
        box.min() + Vector3d(random.uniform(), random.uniform(), random.uniform()).cwiseProduct(box.sizes());
    if (field.contains(p) && where(p)) found.push_back(degrees_between(field.direction(p), expected(p)));
  }
  EXPECT_GT(found.size(), 300U);
  std::sort(found.begin(), found.end());
  return found;
}

double median(const std::vector<double>& sorted) {
  return sorted[sorted.size() / 2];
}

bool anywhere(const Vector3d&) {
  return true;
}

TEST(Fibres, of_a_slanted_rod_run_along_it) {
  const Vector3d a(0, 0, 0), b(0.02, 0.011, 0.007), along = (b - a).normalized();
  const FibreField field(rod_muscle(a, b, 0.003));
  const auto middle = [&](const Vector3d& p) { return std::abs((p - 0.5 * (a + b)).dot(along)) < 0.006; };
  const auto axis = [&](const Vector3d&) { return along; };
  EXPECT_LT(angles(field, axis, middle).back(), 9);
  EXPECT_LT(angles(field, axis, anywhere).back(), 45);  // they gather at the ends
}

TEST(Fibres, of_a_thin_slanted_sheet_run_along_it) {
  // 1.2 mm: two voxels.
  std::vector<TriangleMesh> rows;
  MuscleShape shape{"sheet", {}, MatrixX3d(6, 3), MatrixX3d(6, 3)};
  const Vector3d side = Vector3d(0.3, -0.5, 0.8).normalized(), along = Vector3d(1, 0.6, 0).cross(side).normalized();
  for (int i = 0; i < 6; ++i) {
    shape.origin.row(i) = (0.0009 * i * side).transpose();
    shape.insertion.row(i) = (0.0009 * i * side + 0.03 * along).transpose();
    rows.push_back(rod(shape.origin.row(i), shape.insertion.row(i), 0.0006));
  }
  shape.surface = joined(rows);
  const FibreField field(shape);
  const auto middle = [&](const Vector3d& p) { return std::abs(p.dot(along) - 0.015) < 0.01; };
  EXPECT_LT(angles(
                field, [&](const Vector3d&) { return along; }, middle)
                .back(),
            20);
}

TEST(Fibres, of_a_ring_go_round_it_right_handed) {
  MuscleShape shape;
  shape.name = "ring";
  shape.surface = test::torus(0.018, 0.003, 96, 24);
  shape.ring = true;
  shape.ring_axis = Vector3d::UnitY();
  const FibreField field(shape);
  const auto round = [](const Vector3d& p) { return Vector3d(Vector3d::UnitY().cross(p)); };
  EXPECT_LT(angles(field, round, anywhere).back(), 14);
  for (const MatrixX3d& fibre : field.trace()) {
    EXPECT_LT((fibre.row(0) - fibre.row(fibre.rows() - 1)).norm(), 1e-9);
    double length = 0;
    for (Eigen::Index i = 1; i < fibre.rows(); ++i) length += (fibre.row(i) - fibre.row(i - 1)).norm();
    EXPECT_NEAR(length, 2 * std::numbers::pi * 0.018, 0.02);
  }
}

TEST(Fibres, of_a_ring_in_arcs_go_round_it_too) {
  // Three arcs with gaps of 2 mm between them, as a bundle of strands is modelled.
  MuscleShape shape;
  shape.name = "broken ring";
  shape.ring = true;
  std::vector<TriangleMesh> arcs;
  for (int k = 0; k < 3; ++k) {
    const auto at = [k](double share) {
      const double angle = 2 * std::numbers::pi * (k + share) / 3;
      return Vector3d(0.015 * std::cos(angle), 0.015 * std::sin(angle), 0);
    };
    for (int i = 0; i < 8; ++i) arcs.push_back(rod(at(0.06 + 0.11 * i), at(0.06 + 0.11 * (i + 1)), 0.0016));
  }
  shape.surface = joined(arcs);
  const FibreField field(shape);
  const auto round = [](const Vector3d& p) { return Vector3d(Vector3d::UnitZ().cross(p)); };
  EXPECT_LT(angles(field, round, anywhere).back(), 30);
}

TEST(Fibres, strands_with_gaps_make_one_muscle) {
  // Five strands 1.4 mm apart; two of them are cut and so touch one end only.
  std::vector<TriangleMesh> strands;
  for (int i = 0; i < 5; ++i) {
    const Vector3d start(0, 0.0028 * i, 0), end(0.03, 0.0028 * i, 0);
    strands.push_back(
        rod(i == 1 ? Vector3d(0.012, start.y(), 0) : start, i == 3 ? Vector3d(0.018, end.y(), 0) : end, 0.0007));
  }
  MuscleShape shape{"bundle", joined(strands), {}, {}};
  shape.origin = MatrixX3d::Zero(5, 3);
  for (int i = 0; i < 5; ++i) shape.origin(i, 1) = 0.0028 * i;
  shape.insertion = shape.origin.rowwise() + Eigen::RowVector3d(0.03, 0, 0);
  const FibreField field(shape);
  EXPECT_LT(median(angles(
                field, [](const Vector3d&) { return Vector3d(1, 0, 0); }, anywhere)),
            10);
}

TEST(Fibres, are_traced_from_origin_to_insertion) {
  const Vector3d a(0, 0, 0), b(0.02, 0.011, 0.007);
  const std::vector<MatrixX3d> fibres = FibreField(rod_muscle(a, b, 0.003)).trace();
  EXPECT_GE(fibres.size(), 4U);
  EXPECT_LE(fibres.size(), 40U);
  for (const MatrixX3d& fibre : fibres) {
    EXPECT_EQ(fibre.rows(), 21);
    EXPECT_LT((fibre.row(0).transpose() - a).norm(), 0.004);
    EXPECT_LT((fibre.row(20).transpose() - b).norm(), 0.004);
  }
}

/// The share of a tet where a linear function with corner values v is below c (divided differences of (c - v)^3).
double share_below(const Eigen::Vector4d& v, double c) {
  double share = 0;
  for (int i = 0; i < 4; ++i) {
    if (v[i] >= c) continue;
    double product = 1;
    for (int k = 0; k < 4; ++k)
      if (k != i) product *= v[k] - v[i];
    share += std::pow(c - v[i], 3) / product;
  }
  return share;
}

TEST(Fractions, of_tets_cut_by_a_plane_are_those_of_geometry) {
  MuscleShape shape{"block", test::box({-0.03, -0.03, -0.03}, {0.0017, 0.03, 0.03}), {}, {}};
  shape.origin = Vector3d(-0.03, 0, 0).transpose();
  shape.insertion = Vector3d(0.0017, 0, 0).transpose();
  const FibreField field(shape);
  Random random(5);
  double worst = 0, sum = 0;
  const int count = 300;
  for (int i = 0; i < count; ++i) {
    TetMesh one;
    one.V.resize(4, 3);
    one.T.resize(1, 4);
    one.T << 0, 1, 2, 3;
    one.region = VectorXi::Constant(1, Tissue::flesh);
    const double size = random.uniform() < 0.5 ? 0.003 : 0.009;
    do {
      for (int k = 0; k < 12; ++k) one.V(k / 3, k % 3) = size * (random.uniform() - 0.5);
    } while (tet_volumes(one.V, one.T)[0] < 0.02 * size * size * size);
    Muscle muscle;
    fill_muscle(muscle, one, field);
    const double found = muscle.fraction.size() > 0 ? muscle.fraction[0] : 0;
    const double error = std::abs(found - share_below(one.V.col(0), 0.0017));
    worst = std::max(worst, error);
    sum += error;
  }
  EXPECT_LT(worst, 0.06);
  EXPECT_LT(sum / count, 0.015);
}

TEST(Fractions, add_up_to_the_volume_of_a_ball_whatever_the_size_of_the_tets) {
  const double radius = 0.006;
  MuscleShape shape{"ball", test::sphere({0.001, 0.002, 0.0005}, radius, 4), {}, {}};
  shape.origin = Vector3d(0.001, 0.002, -0.0055).transpose();
  shape.insertion = Vector3d(0.001, 0.002, 0.0065).transpose();
  const FibreField field(shape);
  for (const auto& [edge, cells] : {std::pair{0.0016, 15}, std::pair{0.004, 6}, std::pair{0.012, 2}}) {
    const TetMesh block = flesh_block(Vector3d::Constant(-0.5 * edge * cells), edge, cells);
    Muscle muscle;
    fill_muscle(muscle, block, field);
    const double filled = muscle.fraction.dot(tet_volumes(block.V, block.T)(muscle.tets));
    EXPECT_NEAR(filled / (4.0 / 3 * std::numbers::pi * std::pow(radius, 3)), 1, 0.01) << edge;
    EXPECT_LE(muscle.fraction.maxCoeff(), 1);
    EXPECT_GT(muscle.fraction.minCoeff(), 0);
    for (Eigen::Index i = 0; i < muscle.tets.size(); ++i) EXPECT_NEAR(muscle.direction.row(i).norm(), 1, 1e-9);
  }
}

TEST(Fractions, of_overlapping_muscles_share_the_tet) {
  const TetMesh block = flesh_block(Vector3d::Constant(-0.012), 0.003, 8);
  const std::vector<MuscleShape> shapes{rod_muscle({-0.008, 0, 0}, {0.008, 0, 0}, 0.003),
                                        rod_muscle({0, -0.008, 0}, {0, 0.008, 0}, 0.003)};
  const std::vector<Muscle> muscles = make_muscles(block, shapes);
  VectorXd total = VectorXd::Zero(block.T.rows());
  for (const Muscle& m : muscles)
    for (Eigen::Index i = 0; i < m.tets.size(); ++i) total[m.tets[i]] += m.fraction[i];
  EXPECT_LE(total.maxCoeff(), 1 + 1e-12);
  EXPECT_GT(total.maxCoeff(), 0.99);
  EXPECT_EQ(muscles[0].surface.F, shapes[0].surface.F);
}

TEST(Fractions, lie_in_flesh_only) {
  TetMesh block = flesh_block(Vector3d::Constant(-0.012), 0.003, 8);
  block.region.head(block.region.size() / 2).setConstant(Tissue::skull);
  const std::vector<MuscleShape> shapes{rod_muscle({0, 0, -0.008}, {0, 0, 0.008}, 0.003)};
  const Muscle muscle = make_muscles(block, shapes)[0];
  for (const int t : muscle.tets) EXPECT_EQ(block.region[t], Tissue::flesh);
}

TEST(Fibres, a_surface_that_is_no_manifold_is_replaced_by_that_of_its_voxels) {
  // Two boxes that share an edge.
  TriangleMesh boxes = joined(
      std::vector{test::box({0, 0, 0}, {0.01, 0.004, 0.004}), test::box({0, 0.004, 0.004}, {0.01, 0.008, 0.008})});
  boxes.F = (boxes.F.array() == 8).select(6, (boxes.F.array() == 9).select(7, boxes.F));
  MuscleShape shape{"boxes", boxes, {}, {}};
  shape.origin = Vector3d(0, 0.004, 0.004).transpose();
  shape.insertion = Vector3d(0.01, 0.004, 0.004).transpose();
  const TetMesh block = flesh_block(Vector3d::Constant(-0.006), 0.003, 8);
  const Muscle muscle = make_muscles(block, std::vector<MuscleShape>{shape})[0];
  require_closed_manifold(muscle.surface, "boxes");
  EXPECT_NEAR(signed_volume(muscle.surface.V, muscle.surface.F), 320e-9, 50e-9);
}

TEST(Fibres, of_a_muscle_without_ends_or_inside_are_refused_by_name) {
  const auto message = [](const MuscleShape& shape) {
    try {
      const FibreField field(shape);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  MuscleShape shape = rod_muscle({0, 0, 0}, {0.02, 0, 0}, 0.003);
  shape.insertion.resize(0, 3);
  EXPECT_NE(message(shape).find("muscle rod: it has no insertion"), std::string::npos);
  shape = rod_muscle({0, 0, 0}, {0.02, 0, 0}, 0.003);
  shape.origin(0, 1) = NAN;
  EXPECT_NE(message(shape).find("origin is not finite"), std::string::npos);
  shape = rod_muscle({0, 0, 0}, {0.02, 0, 0}, 0.003);
  shape.surface.F.col(0).swap(shape.surface.F.col(1));
  EXPECT_NE(message(shape).find("encloses nothing"), std::string::npos);
  shape.surface.F.resize(0, 3);
  EXPECT_NE(message(shape).find("no surface"), std::string::npos);
}

}  // namespace
}  // namespace phiz
