// SPDX-License-Identifier: GPL-3.0-or-later
#include <set>
#include <string>
#include <vector>

#include "phiz/anatomy/head_check.h"
#include "phiz/geometry/topology.h"
#include "phiz/geometry/validate.h"

namespace phiz {
namespace {

constexpr double largest_skin_gap = 0.01;  // metres between the drawn and the simulation skin

void check_volume(const HeadTemplate& head, const HeadCheck& check) {
  const Eigen::Index n = head.volume.V.rows();
  check.that(n > 0 && head.volume.T.rows() > 0, "the head has no tets");
  validate(head.volume, check.where() + ": volume");
  const Vector3d size = (head.volume.V.colwise().maxCoeff() - head.volume.V.colwise().minCoeff()).transpose();
  check.that(size.maxCoeff() > 0.05 && size.maxCoeff() < 1.0,
             "the head is " + std::to_string(size.maxCoeff()) + " m large, which no head is",
             "positions must be in metres");
  check.that(head.carrier.size() == n,
             "there are " + std::to_string(head.carrier.size()) + " carriers for " + std::to_string(n) + " vertices");
  for (Eigen::Index v = 0; v < n; ++v)
    check.that(head.carrier(v) >= 0 && head.carrier(v) <= static_cast<int>(Carrier::mandible),
               "vertex " + std::to_string(v) + " has the carrier " + std::to_string(head.carrier(v)));
  bool soft = false;
  for (Eigen::Index t = 0; t < head.volume.T.rows(); ++t) {
    const int region = head.volume.region(t);
    check.that(region == Tissue::flesh || region == Tissue::skull || region == Tissue::mandible,
               "tet " + std::to_string(t) + " has the unknown region " + std::to_string(region));
    const int bone =
        region == Tissue::mandible ? static_cast<int>(Carrier::mandible) : static_cast<int>(Carrier::skull);
    for (int k = 0; k < 4; ++k) {
      const int carrier = head.carrier(head.volume.T(t, k));
      soft |= carrier == static_cast<int>(Carrier::flesh);
      check.that(region == Tissue::flesh || carrier == bone, "tet " + std::to_string(t) + " is bone, but its vertex " +
                                                                 std::to_string(head.volume.T(t, k)) +
                                                                 " does not move with that bone");
    }
  }
  check.that(soft, "no vertex is free to move");
}

void check_skin(const HeadTemplate& head, const HeadCheck& check) {
  const Eigen::Index n = head.volume.V.rows(), s = head.skin_vertices.size();
  check.that(s > 0 && head.skin_triangles.rows() > 0, "the simulation skin is empty");
  check.rows_below(head.skin_vertices, n, "skin_vertices");
  check.rows_below(head.skin_triangles, n, "skin_triangles");
  std::vector<char> on_skin(n, 0);
  for (Eigen::Index i = 0; i < s; ++i) {
    check.that(!on_skin[head.skin_vertices(i)],
               "skin_vertices lists vertex " + std::to_string(head.skin_vertices(i)) + " twice");
    on_skin[head.skin_vertices(i)] = 1;
  }
  for (Eigen::Index f = 0; f < head.skin_triangles.rows(); ++f)
    for (int k = 0; k < 3; ++k)
      check.that(on_skin[head.skin_triangles(f, k)],
                 "skin triangle " + std::to_string(f) + " has a corner that is not in skin_vertices");
  check.that(is_edge_manifold(head.skin_triangles) && is_oriented(head.skin_triangles),
             "the simulation skin is not manifold or not consistently oriented");
  validate(head.skin, check.where() + ": skin");
  check.that(head.skin.F.rows() > 0, "the drawn skin is empty");
  check.that(is_edge_manifold(head.skin.F) && is_oriented(head.skin.F),
             "the drawn skin is not manifold or not consistently oriented");
  check.weights(head.skin_sampling, s, head.skin.V.rows(), "skin_sampling");
  const MatrixX3d apart = head.skin_sampling * head.skin.V - head.volume.V(head.skin_vertices, Eigen::all);
  check.that(apart.rowwise().norm().maxCoeff() < largest_skin_gap,
             "the drawn skin and the simulation skin are up to " +
                 std::to_string(1e3 * apart.rowwise().norm().maxCoeff()) + " mm apart",
             "both must be in metres, and skin_sampling must fit them");
  check.weights(head.skin_interpolation, head.skin.V.rows(), s, "skin_interpolation");
  for (const auto& [name, vertices] : head.skin_regions)
    check.rows_below(vertices, head.skin.V.rows(), "skin region " + name);
}

void check_parts(const HeadTemplate& head, const HeadCheck& check) {
  std::set<std::string> names;
  for (const Part& part : head.parts) {
    check.fresh(names, part.name, "part");
    validate(part.mesh, check.where() + ": part " + part.name);
    check.nearby(part.mesh.V, "the part " + part.name);
    check.that(part.carrier >= Carrier::flesh && part.carrier <= Carrier::right_eye,
               "the part " + part.name + " has an unknown carrier");
    for (const auto& [shape, displacement] : part.shapes) {
      check.that(displacement.rows() == part.mesh.V.rows(),
                 "the shape " + shape + " of part " + part.name + " has another number of vertices than the part");
      check.finite(displacement, "shape " + shape + " of part " + part.name);
    }
  }
}

void check_jaw(const JawJoint& jaw, const HeadCheck& check) {
  check.nearby(jaw.centre.transpose(), "the jaw's centre");
  check.finite(jaw.lower, "the jaw's lower limits");
  check.finite(jaw.upper, "the jaw's upper limits");
  check.that(std::abs(jaw.axis.norm() - 1) < 1e-6 && std::abs(jaw.up.norm() - 1) < 1e-6 &&
                 std::abs(jaw.axis.dot(jaw.up)) < 1e-6,
             "the axes of the jaw are not unit vectors at a right angle");
  check.that((jaw.lower.array() <= jaw.upper.array()).all(), "a lower limit of the jaw is above its upper limit");
  check.that(jaw.lower.head<2>().cwiseAbs().maxCoeff() < 1.6 && jaw.upper.head<2>().cwiseAbs().maxCoeff() < 1.6,
             "the jaw opens by more than a right angle", "angles must be in radians");
}

void check_expressions(const HeadTemplate& head, const HeadCheck& check) {
  std::set<std::string> names;
  for (const Expression& e : head.expressions) {
    check.fresh(names, e.name, "expression");
    check.that(e.displacement.rows() == head.skin.V.rows(),
               "the expression " + e.name + " has " + std::to_string(e.displacement.rows()) +
                   " displacements for a skin of " + std::to_string(head.skin.V.rows()) + " vertices");
    check.finite(e.displacement, "expression " + e.name);
    check.finite(e.jaw, "jaw pose of expression " + e.name);
    check.that(e.jaw.cwiseAbs().maxCoeff() < 1.6,
               "the expression " + e.name + " turns the jaw by more than a right angle",
               "angles must be in radians, shifts in metres");
    check.that(e.displacement.cwiseAbs().maxCoeff() < 0.2,
               "the expression " + e.name + " moves the skin by more than 0.2 m", "displacements must be in metres");
  }
}

}  // namespace

void validate(const HeadTemplate& head, const std::string& where) {
  const HeadCheck check(where);
  check_volume(head, check);
  check_skin(head, check);
  check_parts(head, check);
  check_jaw(head.jaw, check);
  check_expressions(head, check);
  check_anatomy(head, check);
  check.nearby(head.left_eye_centre.transpose(), "the centre of the left eye");
  check.nearby(head.right_eye_centre.transpose(), "the centre of the right eye");
}

}  // namespace phiz
