// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/open/part_muscles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <tuple>
#include <utility>

#include "phiz/anatomy/open/flesh_layer.h"
#include "phiz/core/parallel.h"
#include "phiz/geometry/remesh.h"
#include "phiz/geometry/surface.h"
#include "phiz/geometry/topology.h"

namespace phiz {

namespace {

/// A muscle of one side: its parts (left, right), and where it inserts: towards a landmark, or along a direction.
struct Plan {
  const char* stem;
  std::vector<int> left, right;
  int landmark = -1;                      ///< of the left side
  Vector3d direction = Vector3d::Zero();  ///< of pull from origin to insertion, for sheets
};

const std::vector<Plan>& plans() {
  const Vector3d up(0, 1, 0), down(0, -1, 0);
  static const std::vector<Plan> all = {
      {"frontalis", {46760}, {46759}, -1, down},
      {"corrugator", {46797}, {46796}, 25, {}},
      {"nasalis", {55607}, {55606}, 28, {}},
      {"levatorLabiiSuperiorisAlaequeNasi", {46804}, {46803}, 52, {}},
      {"levatorLabiiSuperioris", {46807}, {46806}, 52, {}},
      {"zygomaticusMinor", {46815}, {46814}, 52, {}},
      {"zygomaticusMajor", {46813}, {46812}, 54, {}},
      {"levatorAnguliOris", {46824}, {46823}, 54, {}},
      {"risorius", {46840}, {46839}, 54, {}},
      {"buccinator", {46836}, {46835}, 54, {}},
      {"depressorAnguliOris", {46830}, {46829}, 54, {}},
      {"depressorLabiiInferioris", {46818}, {46817}, 56, {}},
      {"mentalis", {46827}, {46826}, -1, Vector3d(0, -1, 0.3)},
      {"platysma", {45740}, {45739}, -1, up},
      {"masseter", {49002, 49005}, {49001, 49004}, -1, down},
  };
  return all;
}

/// The landmark on the other side.
int mirrored_landmark(int i) {
  static const std::map<int, int> pairs = {{25, 18}, {28, 28}, {52, 50}, {54, 48}, {56, 58}};
  return pairs.at(i);
}

/// Without what lies below `lowest`: muscles of the neck reach down to the collar bones, the bust ends above.
TriangleMesh above(const TriangleMesh& mesh, double lowest) {
  std::vector<int> kept;
  for (int f = 0; f < mesh.F.rows(); ++f)
    if (mesh.V(mesh.F(f, 0), 1) > lowest && mesh.V(mesh.F(f, 1), 1) > lowest && mesh.V(mesh.F(f, 2), 1) > lowest)
      kept.push_back(f);
  return remove_unused_vertices(mesh.V, mesh.F(kept, Eigen::all)).mesh;
}

TriangleMesh gathered(const BodyParts& parts, const std::vector<int>& fma, const SpaceMap& map) {
  constexpr int most_triangles = 4000;
  std::vector<TriangleMesh> pieces;
  for (const int id : fma) {
    TriangleMesh piece = parts.at(id);
    if (is_edge_manifold(piece.F) && is_vertex_manifold(piece.F) && is_oriented(piece.F))
      piece = decimate(piece, most_triangles);
    piece.V = map(piece.V);
    pieces.push_back(std::move(piece));
  }
  return joined(pieces);
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
Rbf into_lips(const BodyParts& parts, const SpaceMap& map, const FaceGuide& guide, const BoneSolids& bones) {
  constexpr int ring = 46841, lips = 59815;
  constexpr double middle = 0.003, under = 0.003, still = 0.028, spacing = 0.012;
  const MatrixX3d V = map(parts.at(ring).V), L = map(parts.at(lips).V);
  const double parting = 0.5 * (L.col(1).minCoeff() + L.col(1).maxCoeff());
  std::vector<Vector3d> from, to;
  const auto add = [&](const Vector3d& a, const Vector3d& b) {
    from.push_back(a);
    to.push_back(b);
  };
  Eigen::Index above = -1, below = -1, left = 0, right = 0;
  for (Eigen::Index v = 0; v < V.rows(); ++v) {
    if (std::abs(V(v, 0)) > middle) continue;
    if (V(v, 1) > parting && (above < 0 || V(v, 1) < V(above, 1))) above = v;
    if (V(v, 1) < parting && (below < 0 || V(v, 1) > V(below, 1))) below = v;
  }
  L.col(0).maxCoeff(&left);
  L.col(0).minCoeff(&right);
  if (above >= 0) add(V.row(above), guide.landmarks[62] + Vector3d(0, 0.0005, -under));
  if (below >= 0) add(V.row(below), guide.landmarks[66] + Vector3d(0, -0.0005, -under));
  add(L.row(left), guide.landmarks[64] + Vector3d(0, 0, -0.001));
  add(L.row(right), guide.landmarks[60] + Vector3d(0, 0, -0.001));
  const Vector3d mouth = guide.landmarks[66];
  std::map<std::tuple<int, int, int>, Vector3d> anchors;
  for (const TriangleMesh* bone : {&bones.skull, &bones.mandible})
    for (Eigen::Index v = 0; v < bone->V.rows(); ++v) {
      const Vector3d p = bone->V.row(v);
      if ((p - mouth).norm() < still) continue;
      const Eigen::Array3i cell = (p.array() / spacing).floor().cast<int>();
      anchors.emplace(std::tuple(cell[0], cell[1], cell[2]), p);
    }
  for (const auto& [cell, p] : anchors) add(p, p);
  MatrixX3d centres(static_cast<Eigen::Index>(from.size()), 3), moves(centres.rows(), 3);
  for (std::size_t i = 0; i < from.size(); ++i) {
    centres.row(static_cast<Eigen::Index>(i)) = from[i];
    moves.row(static_cast<Eigen::Index>(i)) = to[i] - from[i];
  }
  return {centres, moves, RbfKernel::biharmonic, 0.002};
}

/// Moves muscles as wholes towards the flesh, smoothly in space, then what is still outside on its own.
void settle(std::vector<MuscleShape>& shapes, const FleshLayer& layer) {
  constexpr double spacing = 0.009, smoothing = 0.01;
  for (int round = 0; round < 3; ++round) {
    std::map<std::tuple<int, int, int>, Vector3d> samples;
    for (const MuscleShape& shape : shapes)
      for (Eigen::Index v = 0; v < shape.surface.V.rows(); ++v) {
        const Vector3d p = shape.surface.V.row(v);
        const Eigen::Array3i cell = (p.array() / spacing).floor().cast<int>();
        samples.emplace(std::tuple(cell[0], cell[1], cell[2]), p);
      }
    MatrixX3d centres(static_cast<Eigen::Index>(samples.size()), 3), moves(centres.rows(), 3);
    Eigen::Index row = 0;
    for (const auto& [cell, p] : samples) centres.row(row++) = p;
    parallel_for(
        centres.rows(), [&](std::ptrdiff_t i) { moves.row(i) = layer.into_flesh(centres.row(i)); }, 16);
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
                                      const FaceKitSkin& skin, const BoneSolids& bones) {
  std::vector<MuscleShape> shapes;
  const auto add = [&](const std::string& name, const std::vector<int>& fma) -> MuscleShape& {
    shapes.push_back({name, gathered(parts, fma, map), {}, {}});
    return shapes.back();
  };
  for (const Plan& plan : plans()) {
    add(plan.stem + std::string("Left"), plan.left);
    add(plan.stem + std::string("Right"), plan.right);
  }
  const auto ring = [&](const std::string& name, const std::vector<int>& fma, int first, int last,
                        const Vector3d& axis) {
    MuscleShape& shape = add(name, fma);
    shape.ring = true;
    shape.ring_axis = axis.normalized();
    for (int i = first; i <= last; ++i)
      shape.ring_centre += guide.landmarks[static_cast<std::size_t>(i)] / (last - first + 1);
  };
  ring("orbicularisOculiLeft", {46783, 46786}, 42, 47, {0.3, 0, 1});
  ring("orbicularisOculiRight", {46782, 46785}, 36, 41, {-0.3, 0, 1});
  ring("orbicularisOris", {46841}, 60, 67, {0, 0, 1});
  add("procerus", {55611, 55610});
  add("depressorSepti", {55609, 55608});

  constexpr double below_chin = 0.050;
  const Rbf lips = into_lips(parts, map, guide, bones);
  for (MuscleShape& shape : shapes) {
    shape.surface.V += lips.evaluate(shape.surface.V);
    shape.surface = above(shape.surface, guide.landmarks[8].y() - below_chin);
  }
  settle(shapes, FleshLayer(skin, bones));

  for (std::size_t i = 0; i < plans().size(); ++i) {
    const Plan& plan = plans()[i];
    for (const bool left : {true, false}) {
      MuscleShape& shape = shapes[2 * i + (left ? 0 : 1)];
      if (plan.landmark < 0) {
        set_ends(shape, shape.surface.V * plan.direction.normalized());
      } else {
        const int mark = left ? plan.landmark : mirrored_landmark(plan.landmark);
        const Vector3d goal = guide.landmarks[static_cast<std::size_t>(mark)];
        set_ends(shape, -(shape.surface.V.rowwise() - goal.transpose()).rowwise().norm());
      }
    }
  }
  for (MuscleShape& shape : shapes) {
    if (shape.name == "procerus") set_ends_of_halves(shape, shape.surface.V.col(1));
    if (shape.name == "depressorSepti")
      set_ends_of_halves(shape, -(shape.surface.V.rowwise() - guide.landmarks[33].transpose()).rowwise().norm());
  }
  return shapes;
}

}  // namespace phiz
