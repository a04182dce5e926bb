// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/open/part_muscles.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <sstream>
#include <string>
#include <tuple>
#include <utility>

#include "phiz/anatomy/muscle_table.h"
#include "phiz/anatomy/open/flesh_layer.h"
#include "phiz/core/parallel.h"
#include "phiz/geometry/remesh.h"
#include "phiz/geometry/solidify.h"
#include "phiz/geometry/surface.h"
#include "phiz/geometry/topology.h"

namespace phiz {

namespace {

/// Where a pair of muscles inserts: towards a landmark, or along a direction.
struct Plan {
  const char* stem;
  int landmark = -1;                      ///< of the left side
  Vector3d direction = Vector3d::Zero();  ///< of pull from origin to insertion; spindles: about
};

const std::vector<Plan>& muscle_plans() {
  const Vector3d up(0, 1, 0), down(0, -1, 0);
  static const std::vector<Plan> all = {
      {"frontalis", -1, down},
      {"corrugator", 25, {}},
      {"nasalis", 28, {}},
      {"levatorLabiiSuperiorisAlaequeNasi", 52, {}},
      {"levatorLabiiSuperioris", 52, {}},
      {"zygomaticusMinor", 52, {}},
      {"zygomaticusMajor", 54, {}},
      {"risorius", 54, {}},
      {"buccinator", 54, {}},
      {"depressorAnguliOris", 54, {}},
      {"depressorLabiiInferioris", 56, {}},
      {"mentalis", -1, Vector3d(0, -1, 0.3)},
      {"platysma", -1, up},
      {"masseter", -1, down},
  };
  return all;
}

/// The parts that make up a muscle, by their numbers.
std::vector<int> parts_of(const std::string& muscle) {
  const MuscleFacts* facts = find_muscle_facts(muscle);
  std::istringstream list{std::string(muscle.ends_with("Right") ? facts->parts_right : facts->parts_left)};
  std::vector<int> numbers;
  constexpr std::size_t prefix = 3;  // FMA
  for (std::string id; list >> id;) numbers.push_back(std::stoi(id.substr(prefix)));
  return numbers;
}

/// The landmark on the other side.
int mirrored_landmark(int i) {
  static const std::map<int, int> pairs = {{25, 18}, {28, 28}, {52, 50}, {54, 48}, {56, 58}};
  return pairs.at(i);
}

/// The height in the frame of the parts that the map brings to about `level`, where the part reaches below it.
double cut_height(const TriangleMesh& part, const SpaceMap& map, double level) {
  constexpr double near = 0.003;
  const MatrixX3d moved = map(part.V);
  double sum = 0;
  int count = 0;
  for (Eigen::Index v = 0; v < moved.rows(); ++v)
    if (std::abs(moved(v, 1) - level) < near) sum += part.V(v, 1), ++count;
  return count > 0 ? sum / count : -1e9;
}

/// One body out of the strands of a muscle, which lie up to 4 mm apart: gaps sealed, thin muscles made thicker by half
/// a millimetre and more on either side (a dissected strand is thinner than a living one), few triangles.
TriangleMesh belly(const BodyParts& parts, const std::vector<int>& fma, double lowest) {
  constexpr double spacing = 0.0005, gap = 0.0020, edge = 0.0011, grown = 0.0008, thin = 1.2e-6;
  constexpr int most_triangles = 4000, most_of_sheets = 12000;
  Vector3d low = Vector3d::Constant(1e9), high = -low;
  for (const int id : fma) {
    low = low.cwiseMin(parts.at(id).V.colwise().minCoeff().transpose());
    high = high.cwiseMax(parts.at(id).V.colwise().maxCoeff().transpose());
  }
  const VoxelGrid grid = grid_round({low, high}, spacing, gap + grown + 4 * spacing);
  VoxelFlags cells(static_cast<std::size_t>(grid.count()), 0);
  for (const int id : fma) fill_inside(grid, parts.at(id), cells);
  seal_gaps(grid, gap, cells);
  for (std::ptrdiff_t c = 0; c < grid.count(); ++c)
    if (cells[static_cast<std::size_t>(c)] && grid.centre(c).y() < lowest) cells[static_cast<std::size_t>(c)] = 0;
  PolygoniseOptions options;
  options.edge_length = edge;
  options.projection_steps = 1;
  options.improve = false;
  const double volume = static_cast<double>(std::count(cells.begin(), cells.end(), 1)) * std::pow(spacing, 3);
  const double grow = volume < thin ? grown : 0.25 * grown;
  const VoxelField distance = signed_distance_field(grid, cells);
  return decimate(polygonise([&](const Vector3d& p) { return distance(p) - grow; },
                             {grid.centre(0), grid.centre(grid.count() - 1)}, options),
                  volume < 5e-6 ? most_triangles : most_of_sheets);
}

/// The principal axis of points that leads most in a direction of pull.
Vector3d long_axis(const MatrixX3d& points, const Vector3d& pull) {
  const MatrixX3d arms = points.rowwise() - points.colwise().mean();
  const Vector3d axis = Eigen::SelfAdjointEigenSolver<Matrix3d>(arms.transpose() * arms).eigenvectors().col(2);
  return axis.dot(pull) < 0 ? Vector3d(-axis) : axis;
}

/// The rows with the lowest and the highest values: a tenth of them each.
struct Ends {
  std::vector<int> low, high;
};
Ends ends_of(std::vector<int> rows, const VectorXd& along) {
  constexpr double share = 0.10;
  std::stable_sort(rows.begin(), rows.end(), [&](int a, int b) { return along[a] < along[b]; });
  const auto count = std::max<std::ptrdiff_t>(4, static_cast<std::ptrdiff_t>(share * static_cast<double>(rows.size())));
  return {{rows.begin(), rows.begin() + count}, {rows.end() - count, rows.end()}};
}

void set_ends(MuscleShape& shape, const VectorXd& along) {
  std::vector<int> rows(static_cast<std::size_t>(along.size()));
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = static_cast<int>(i);
  const Ends ends = ends_of(rows, along);
  shape.origin = shape.surface.V(ends.low, Eigen::all);
  shape.insertion = shape.surface.V(ends.high, Eigen::all);
}

/// The same for the two halves of a muscle in the midline.
void set_ends_of_halves(MuscleShape& shape, const VectorXd& along) {
  std::vector<int> left, right;
  for (int v = 0; v < along.size(); ++v) (shape.surface.V(v, 0) > 0 ? left : right).push_back(v);
  Ends a = ends_of(left, along);
  const Ends b = ends_of(right, along);
  a.low.insert(a.low.end(), b.low.begin(), b.low.end());
  a.high.insert(a.high.end(), b.high.begin(), b.high.end());
  shape.origin = shape.surface.V(a.low, Eigen::all);
  shape.insertion = shape.surface.V(a.high, Eigen::all);
}

/// Brings the ring of the lips into the lips of the face: the edges of its opening under the line where they meet, its
/// corners under the corners of the mouth. Far away nothing moves.
Rbf into_lips(const BodyParts& parts, const SpaceMap& map, const FaceGuide& guide,
              std::span<const TriangleMesh> bones) {
  constexpr int lips = 59815;
  const int ring = parts_of("orbicularisOris").front();
  constexpr double middle = 0.002, under = 0.003, still = 0.028, spacing = 0.012;
  const MatrixX3d V = map(parts.at(ring).V), L = map(parts.at(lips).V);
  const double parting = 0.5 * (L.col(1).minCoeff() + L.col(1).maxCoeff());
  std::vector<Vector3d> from, to;
  const auto add = [&](const Vector3d& a, const Vector3d& b) {
    from.push_back(a);
    to.push_back(b);
  };
  // The edges of the ring's opening to the line where the lips meet, at five places across.
  const auto on_line = [&guide](const std::array<std::size_t, 5>& marks, double x) {
    for (std::size_t i = 0; i + 1 < marks.size(); ++i) {
      const Vector3d &a = guide.landmarks[marks[i]], &b = guide.landmarks[marks[i + 1]];
      if (x <= b.x() || i + 2 == marks.size()) return Vector3d(a + (b - a) * (x - a.x()) / (b.x() - a.x()));
    }
    return Vector3d(guide.landmarks[marks[0]]);
  };
  for (const double x : {-0.014, -0.007, 0.0, 0.007, 0.014}) {
    Eigen::Index above = -1, below = -1;
    for (Eigen::Index v = 0; v < V.rows(); ++v) {
      if (std::abs(V(v, 0) - x) > middle) continue;
      if (V(v, 1) > parting && (above < 0 || V(v, 1) < V(above, 1))) above = v;
      if (V(v, 1) < parting && (below < 0 || V(v, 1) > V(below, 1))) below = v;
    }
    if (above >= 0) add(V.row(above), on_line({60, 61, 62, 63, 64}, x) + Vector3d(0, 0.0020, -under));
    if (below >= 0) add(V.row(below), on_line({60, 67, 66, 65, 64}, x) + Vector3d(0, -0.0020, -under));
  }
  Eigen::Index left = 0, right = 0;
  L.col(0).maxCoeff(&left);
  L.col(0).minCoeff(&right);
  add(L.row(left), guide.landmarks[64] + Vector3d(0, 0, -0.001));
  add(L.row(right), guide.landmarks[60] + Vector3d(0, 0, -0.001));
  const Vector3d mouth = guide.landmarks[66];
  std::map<std::tuple<int, int, int>, Vector3d> anchors;
  for (const TriangleMesh& bone : bones)
    for (Eigen::Index v = 0; v < bone.V.rows(); ++v) {
      const Vector3d p = bone.V.row(v);
      if ((p - mouth).norm() < still) continue;
      const Eigen::Array3i cell = (p.array() / spacing).floor().cast<int>();
      anchors.emplace(std::tuple(cell[0], cell[1], cell[2]), p);
    }
  for (const auto& [cell, p] : anchors) add(p, p);
  const MatrixX3d centres = rows_of(from);
  return {centres, rows_of(to) - centres, RbfKernel::biharmonic, 0.002};
}

/// Moves muscles as wholes towards the flesh, smoothly in space, then what is still outside on its own.
void settle(std::vector<MuscleShape>& shapes, const FleshLayer& layer) {
  constexpr double spacing = 0.009, smoothing = 0.01;
  for (int round = 0; round < 3; ++round) {
    std::map<std::tuple<int, int, int>, std::vector<Vector3d>> cells;  // what lies over each other moves together
    for (const MuscleShape& shape : shapes)
      for (Eigen::Index v = 0; v < shape.surface.V.rows(); ++v) {
        const Vector3d p = shape.surface.V.row(v);
        const Eigen::Array3i cell = (p.array() / spacing).floor().cast<int>();
        cells[std::tuple(cell[0], cell[1], cell[2])].push_back(p);
      }
    std::vector<MatrixX3d> clusters;
    for (const auto& [cell, points] : cells) clusters.push_back(rows_of(points));
    MatrixX3d centres(static_cast<Eigen::Index>(clusters.size()), 3), moves(centres.rows(), 3);
    parallel_for(
        centres.rows(),
        [&](std::ptrdiff_t i) {
          const MatrixX3d& points = clusters[static_cast<std::size_t>(i)];
          centres.row(i) = points.colwise().mean();
          moves.row(i) = layer.all_into_flesh(points);
        },
        16);
    const Rbf displacement(centres, moves, RbfKernel::biharmonic, smoothing);
    for (MuscleShape& shape : shapes) shape.surface.V += displacement.evaluate(shape.surface.V);
  }
  for (MuscleShape& shape : shapes) {
    MatrixX3d& V = shape.surface.V;
    const auto neighbours = vertex_neighbours(shape.surface.F, static_cast<int>(V.rows()));
    MatrixX3d D(V.rows(), 3);
    parallel_for(
        V.rows(), [&](std::ptrdiff_t v) { D.row(v) = layer.into_flesh(V.row(v)); }, 64);
    for (int pass = 0; pass < 6; ++pass) {
      const MatrixX3d before = D;
      for (Eigen::Index v = 0; v < D.rows(); ++v) {
        const auto& round = neighbours[static_cast<std::size_t>(v)];
        for (const int w : round) D.row(v) += before.row(w);
        D.row(v) /= static_cast<double>(round.size() + 1);
      }
    }
    V += D;
    parallel_for(
        V.rows(), [&](std::ptrdiff_t v) { V.row(v) += layer.into_flesh(V.row(v)); }, 64);
  }
}

}  // namespace

std::vector<MuscleShape> part_muscles(const BodyParts& parts, const SpaceMap& map, const FaceGuide& guide,
                                      const FaceKitSkin& skin, std::span<const TriangleMesh> bones) {
  std::vector<MuscleShape> shapes;
  const auto add = [&shapes](const std::string& name) -> MuscleShape& {
    shapes.push_back({name, {}, {}, {}});
    return shapes.back();
  };
  for (const Plan& plan : muscle_plans()) {
    add(plan.stem + std::string("Left"));
    add(plan.stem + std::string("Right"));
  }
  const auto ring = [&](const std::string& name, int first, int last, const Vector3d& axis) {
    MuscleShape& shape = add(name);
    shape.ring = true;
    shape.ring_axis = axis.normalized();
    for (int i = first; i <= last; ++i)
      shape.ring_centre += guide.landmarks[static_cast<std::size_t>(i)] / (last - first + 1);
  };
  ring("orbicularisOculiLeft", 42, 47, {0.3, 0, 1});
  ring("orbicularisOculiRight", 36, 41, {-0.3, 0, 1});
  ring("orbicularisOris", 60, 67, {0, 0, 1});
  add("procerus");

  constexpr double below_chin = 0.050;
  parallel_for(
      static_cast<std::ptrdiff_t>(shapes.size()),
      [&](std::ptrdiff_t i) {
        MuscleShape& shape = shapes[static_cast<std::size_t>(i)];
        TriangleMesh& surface = shape.surface;
        const std::vector<int> fma = parts_of(shape.name);
        // Muscles of the neck reach down to the collar bones; the bust ends above.
        surface = belly(parts, fma, cut_height(parts.at(fma.front()), map, guide.landmarks[8].y() - below_chin));
        surface.V = map(surface.V);
      },
      1);
  const Rbf lips = into_lips(parts, map, guide, bones);
  for (MuscleShape& shape : shapes) shape.surface.V += lips.evaluate(shape.surface.V);
  settle(shapes, FleshLayer(skin, bones));

  for (std::size_t i = 0; i < muscle_plans().size(); ++i) {
    const Plan& plan = muscle_plans()[i];
    for (const bool left : {true, false}) {
      MuscleShape& shape = shapes[2 * i + (left ? 0 : 1)];
      if (plan.landmark < 0) {
        const bool spindle = find_muscle_facts(shape.name)->form == MuscleForm::spindle;
        set_ends(shape, shape.surface.V * (spindle ? long_axis(shape.surface.V, plan.direction) : plan.direction));
      } else {
        const int mark = left ? plan.landmark : mirrored_landmark(plan.landmark);
        const Vector3d goal = guide.landmarks[static_cast<std::size_t>(mark)];
        set_ends(shape, -(shape.surface.V.rowwise() - goal.transpose()).rowwise().norm());
      }
    }
  }
  set_ends_of_halves(shapes.back(), shapes.back().surface.V.col(1));  // procerus
  return shapes;
}

}  // namespace phiz
