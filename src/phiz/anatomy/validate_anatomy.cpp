// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <set>
#include <string>

#include "phiz/anatomy/head_check.h"
#include "phiz/geometry/surface.h"
#include "phiz/geometry/validate.h"

namespace phiz {
namespace {

void check_landmarks(const HeadTemplate& head, const HeadCheck& check) {
  std::set<std::string> names;
  for (const Landmark& mark : head.landmarks) {
    check.fresh(names, mark.name, "landmark");
    check.that(mark.skin_vertex >= 0 && mark.skin_vertex < head.skin.V.rows(),
               "the landmark " + mark.name + " refers to skin vertex " + std::to_string(mark.skin_vertex));
  }
  names.clear();
  for (const SkullLandmark& mark : head.skull_landmarks) {
    check.fresh(names, mark.name, "skull landmark");
    check.that(mark.bone_vertex >= 0 && mark.bone_vertex < head.volume.V.rows() &&
                   head.carrier(mark.bone_vertex) != static_cast<int>(Carrier::flesh),
               "the skull landmark " + mark.name + " does not refer to a vertex of a bone");
    check.that(mark.skin_vertex >= 0 && mark.skin_vertex < head.skin.V.rows(),
               "the skull landmark " + mark.name + " refers to skin vertex " + std::to_string(mark.skin_vertex));
    check.that(std::abs(mark.normal.norm() - 1) < 1e-6, "the normal of skull landmark " + mark.name + " is not unit");
    check.that(
        mark.thickness_mean > 0 && mark.thickness_mean < 0.1 && mark.thickness_deviation > 0,
        "the flesh at skull landmark " + mark.name + " is " + std::to_string(1e3 * mark.thickness_mean) + " mm thick",
        "thickness must be in metres and positive");
  }
}

void check_muscles(const HeadTemplate& head, const HeadCheck& check) {
  std::set<std::string> names;
  for (const Muscle& m : head.muscles) {
    check.fresh(names, m.name, "muscle");
    for (const MatrixX3d& fibre : m.fibres) {
      check.that(fibre.rows() >= 2, "a fibre of " + m.name + " has less than two points");
      check.finite(fibre, "a fibre of " + m.name);
    }
    check.that(m.fraction.size() == m.tets.size() && m.direction.rows() == m.tets.size(),
               "the muscle " + m.name + " has lists of different lengths");
    check.rows_below(m.tets, head.volume.T.rows(), "muscle " + m.name);
    for (Eigen::Index i = 0; i < m.tets.size(); ++i) {
      check.that(m.fraction(i) > 0 && m.fraction(i) <= 1 + 1e-9, "muscle " + m.name + " fills the share " +
                                                                     std::to_string(m.fraction(i)) + " of tet " +
                                                                     std::to_string(m.tets(i)));
      check.that(std::abs(m.direction.row(i).norm() - 1) < 1e-6,
                 "a fibre direction of muscle " + m.name + " is not a unit vector");
    }
    if (m.surface.V.rows() == 0 && m.surface.F.rows() == 0) continue;
    const std::string surface = "the surface of muscle " + m.name;
    require_closed_manifold(m.surface, check.where() + ": " + surface);
    check.nearby(m.surface.V, surface);
    check.that(signed_volume(m.surface.V, m.surface.F) > 0, surface + " is inside out");
  }
}

void check_contacts(const HeadTemplate& head, const HeadCheck& check) {
  std::set<std::string> names;
  for (const ContactRegion& region : head.contact_regions) {
    check.fresh(names, region.name, "contact region");
    check.rows_below(region.vertices, head.volume.V.rows(), "contact region " + region.name);
    check.rows_below(region.triangles, head.volume.V.rows(), "contact region " + region.name);
  }
  for (const ContactPair& pair : head.contact_pairs) {
    check.that(names.count(pair.vertices) > 0, "a contact pair names the unknown region '" + pair.vertices + "'");
    check.that(names.count(pair.obstacle) > 0 || find_part(head, pair.obstacle) != nullptr,
               "a contact pair names '" + pair.obstacle + "', which is neither a contact region nor a part");
  }
}

void check_attachments(const HeadTemplate& head, const HeadCheck& check) {
  const Attachments& a = head.attachments;
  check.that(a.hold.size() == a.vertices.size() && a.normals.rows() == a.vertices.size(),
             "the attachments have lists of different lengths");
  check.rows_below(a.vertices, head.volume.V.rows(), "attachments");
  for (Eigen::Index i = 0; i < a.vertices.size(); ++i) {
    const std::string which = "attachment " + std::to_string(i);
    check.that(i == 0 || a.vertices(i) > a.vertices(i - 1), which + " is out of order: vertices must ascend");
    check.that(head.carrier(a.vertices(i)) != static_cast<int>(Carrier::flesh),
               which + " refers to vertex " + std::to_string(a.vertices(i)) + ", which no bone carries");
    check.that(a.hold(i) == static_cast<int>(Hold::pin) || a.hold(i) == static_cast<int>(Hold::slide),
               which + " has the unknown hold " + std::to_string(a.hold(i)));
    check.that(std::abs(a.normals.row(i).norm() - 1) < 1e-6, "the normal of " + which + " is not unit");
  }
}

void check_modes(const Eigen::MatrixXf& modes, Eigen::Index vertices, Eigen::Index count, const std::string& name,
                 const HeadCheck& check) {
  check.that(modes.rows() == 3 * vertices && modes.cols() == count,
             name + " has " + std::to_string(modes.rows()) + " x " + std::to_string(modes.cols()) +
                 " modes, expected " + std::to_string(3 * vertices) + " x " + std::to_string(count));
  check.finite(modes, name);
  check.that(modes.cwiseAbs().maxCoeff() < farthest_from_head, name + " moves a vertex by more than the head's size",
             "displacements must be in metres");
}

void check_identity(const HeadTemplate& head, const HeadCheck& check) {
  const IdentityModel& model = head.identity;
  const Eigen::Index count = model.skin.cols();
  check.that(model.deviation.size() == count, "the identity model has " + std::to_string(model.deviation.size()) +
                                                  " deviations for " + std::to_string(count) + " modes");
  check.finite(model.deviation, "the identity model's deviations");
  check.that(count > 0 || model.skin.rows() == 0, "the identity model has no modes");
  if (count == 0) return;
  check.that(model.deviation.minCoeff() >= 0, "a deviation of the identity model is negative");
  check_modes(model.skin, head.skin.V.rows(), count, "the identity model", check);
}

}  // namespace

void check_anatomy(const HeadTemplate& head, const HeadCheck& check) {
  check_landmarks(head, check);
  check_muscles(head, check);
  check_attachments(head, check);
  check_identity(head, check);
  check_contacts(head, check);
}

}  // namespace phiz
