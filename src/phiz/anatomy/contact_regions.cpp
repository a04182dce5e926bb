// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/contact_regions.h"

#include <algorithm>
#include <string>
#include <vector>

#include "phiz/core/error.h"
#include "phiz/geometry/spatial_query.h"
#include "phiz/geometry/topology.h"

namespace phiz {
namespace {

using Flags = std::vector<char>;

const VectorXi& region(const SkinRegions& regions, const std::string& name) {
  const auto found = regions.find(name);
  if (found == regions.end()) reject("head", "the skin has no region " + name);
  return found->second;
}

Flags flags(const SkinRegions& regions, std::initializer_list<std::string> names, Eigen::Index count) {
  Flags result(count, 0);
  for (const std::string& name : names)
    for (const int v : region(regions, name)) result[v] = 1;
  return result;
}

/// Where two regions meet they share vertices, by which contact knows their seam: `one` takes those of `other` in the
/// triangles between them.
void share_seam(Flags& one, const Flags& other, const MatrixX3i& triangles) {
  const Flags before = one;
  for (Eigen::Index f = 0; f < triangles.rows(); ++f) {
    bool all = true, own = false, foreign = false;
    for (int k = 0; k < 3; ++k) {
      const auto v = static_cast<std::size_t>(triangles(f, k));
      all = all && (before[v] || other[v]);
      own = own || (before[v] && !other[v]);
      foreign = foreign || (other[v] && !before[v]);
    }
    for (int k = 0; k < 3 && all && own && foreign; ++k) one[static_cast<std::size_t>(triangles(f, k))] = 1;
  }
}

/// The vertices of the triangles whose corners are all flagged, and those triangles.
ContactRegion contact_region(const std::string& name, const Flags& inside, const MatrixX3i& triangles) {
  ContactRegion result;
  result.name = name;
  result.triangles.resize(triangles.rows(), 3);
  Flags used(inside.size(), 0);
  Eigen::Index count = 0;
  for (Eigen::Index f = 0; f < triangles.rows(); ++f) {
    if (!inside[triangles(f, 0)] || !inside[triangles(f, 1)] || !inside[triangles(f, 2)]) continue;
    result.triangles.row(count++) = triangles.row(f);
    for (int k = 0; k < 3; ++k) used[triangles(f, k)] = 1;
  }
  result.triangles.conservativeResize(count, 3);
  result.vertices.resize(std::count(used.begin(), used.end(), 1));
  Eigen::Index row = 0;
  for (std::size_t v = 0; v < used.size(); ++v)
    if (used[v]) result.vertices(row++) = static_cast<int>(v);
  return result;
}

/// Takes the vertices that lie inside `part` at rest out of the contact regions: the folds behind the gums, whose
/// hidden rims reach through the roof and the floor of the oral cavity.
void release_vertices_inside(HeadTemplate& head, const std::string& part) {
  const Part* obstacle = find_part(head, part);
  if (obstacle == nullptr) reject(head.name, "there is no part " + part);
  const SurfaceQuery query(obstacle->mesh);
  for (ContactRegion& contact : head.contact_regions) {
    Eigen::Index kept = 0;
    for (const int v : contact.vertices)
      if (query.signed_distance(head.volume.V.row(v)) > 0) contact.vertices(kept++) = v;
    contact.vertices.conservativeResize(kept);
  }
}

}  // namespace

void assign_contacts(HeadTemplate& head, const SkinRegions& regions) {
  const Eigen::Index n = head.skin_vertices.size();
  const auto add = [&](const std::string& name, const Flags& inside) {
    head.contact_regions.push_back(contact_region(name, inside, head.skin_triangles));
  };
  Flags upper = flags(regions, {"upperLip", "upperLipInner"}, n);
  const Flags lower = flags(regions, {"lowerLip", "lowerLipInner"}, n);
  share_seam(upper, lower, head.skin_triangles);
  add("upperLip", upper);
  add("lowerLip", lower);
  // Cheeks: what is left of the bag's wall beside the teeth; behind the last ones gums end in thin flanges.
  const Part* teeth = find_part(head, "upperTeeth");
  if (teeth == nullptr) reject(head.name, "there is no part upperTeeth");
  constexpr double before_end = 0.001;  // metres
  const double last_molar = teeth->mesh.V.col(2).minCoeff() + before_end;
  const Flags lips = flags(regions, {"upperLip", "lowerLip"}, n);
  const Flags ends = flags(regions, {"oralRoof", "oralFloor"}, n);
  Flags left = flags(regions, {"mouthBag"}, n), right = left;
  for (Eigen::Index v = 0; v < n; ++v) {
    const double x = head.volume.V(v, 0);
    const bool wall = left[v] && !lips[v] && !ends[v] && std::abs(x) > 0.018 && head.volume.V(v, 2) > last_molar;
    left[v] = wall && x > 0;
    right[v] = wall && x < 0;
  }
  add("leftCheek", left);
  add("rightCheek", right);
  for (const std::string side : {"left", "right"}) {
    Flags above = flags(regions, {side + "UpperLid"}, n);
    const Flags below = flags(regions, {side + "LowerLid"}, n);
    share_seam(above, below, head.skin_triangles);
    add(side + "UpperLid", above);
    add(side + "LowerLid", below);
  }

  std::vector<std::string> hard{"upperTeeth", "lowerTeeth"};
  for (const char* gums : {"upperGums", "lowerGums"}) {
    const Part* part = find_part(head, gums);
    if (part == nullptr || !is_closed(part->mesh.F)) continue;
    release_vertices_inside(head, gums);
    hard.emplace_back(gums);
  }

  head.contact_pairs = {{"upperLip", "lowerLip"}, {"lowerLip", "upperLip"}};
  for (const char* soft : {"upperLip", "lowerLip", "leftCheek", "rightCheek"})
    for (const std::string& obstacle : hard) head.contact_pairs.push_back({soft, obstacle});
  for (const std::string side : {"left", "right"}) {
    head.contact_pairs.push_back({side + "UpperLid", side + "Eye"});
    head.contact_pairs.push_back({side + "LowerLid", side + "Eye"});
    head.contact_pairs.push_back({side + "UpperLid", side + "LowerLid"});
    head.contact_pairs.push_back({side + "LowerLid", side + "UpperLid"});
  }
  const auto is_empty = [](const ContactRegion& contact) { return contact.triangles.rows() == 0; };
  const auto is_missing = [&](const std::string& name) {
    return std::any_of(head.contact_regions.begin(), head.contact_regions.end(),
                       [&](const ContactRegion& contact) { return contact.name == name && is_empty(contact); });
  };
  std::erase_if(head.contact_pairs,
                [&](const ContactPair& pair) { return is_missing(pair.vertices) || is_missing(pair.obstacle); });
  std::erase_if(head.contact_regions, is_empty);
}

}  // namespace phiz
