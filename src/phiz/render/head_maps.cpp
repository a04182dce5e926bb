// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/render/head_maps.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>
#include <vector>

#include "phiz/geometry/topology.h"
#include "phiz/render/head_surfaces.h"
#include "phiz/render/materials.h"
#include "phiz/render/palette.h"

namespace phiz::detail {

namespace {

/// Every triangle in six, two for each corner, so that areas round vertices have sharp borders.
/// `owner`: the vertex of `mesh` that a new triangle belongs to.
TriangleMesh areas_of_vertices(const TriangleMesh& mesh, std::vector<int>& owner) {
  TriangleMesh fine;
  const Eigen::Index n = mesh.F.rows();
  fine.V.resize(7 * n, 3);
  fine.F.resize(6 * n, 3);
  for (Eigen::Index f = 0; f < n; ++f) {
    const int first = static_cast<int>(7 * f);  // corners, then middles of the edges that start there, then the centre
    for (int k = 0; k < 3; ++k) {
      const int a = mesh.F(f, k), b = mesh.F(f, (k + 1) % 3);
      fine.V.row(first + k) = mesh.V.row(a);
      fine.V.row(first + 3 + k) = (mesh.V.row(a) + mesh.V.row(b)) / 2;
    }
    fine.V.row(first + 6) = fine.V.middleRows(first, 3).colwise().mean();
    for (int k = 0; k < 3; ++k) {
      fine.F.row(6 * f + 2 * k) << first + k, first + 3 + k, first + 6;
      fine.F.row(6 * f + 2 * k + 1) << first + k, first + 6, first + 3 + (k + 2) % 3;
      owner.insert(owner.end(), 2, mesh.F(f, k));
    }
  }
  return fine;
}

Material painted_material() {
  Material m;
  m.albedo = Vector3d::Ones();
  m.roughness = 0.6;
  m.specular = 0.02;
  m.unlit = 0.25;
  return m;
}

/// The contact region of every vertex of the drawn skin; -1 none.
VectorXi region_of_skin(const HeadTemplate& head) {
  const Eigen::Index n = head.skin.V.rows();
  VectorXi row = VectorXi::Constant(head.volume.V.rows(), -1);
  for (Eigen::Index i = 0; i < head.skin_vertices.size(); ++i) row[head.skin_vertices[i]] = static_cast<int>(i);
  // Small regions lie on top of large ones: the margin of a lid on the lid.
  std::vector<int> order(head.contact_regions.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return head.contact_regions[a].vertices.size() > head.contact_regions[b].vertices.size();
  });
  VectorXi region = VectorXi::Constant(n, -1);
  for (const int r : order) {
    VectorXd member = VectorXd::Zero(head.skin_vertices.size());
    for (const int v : head.contact_regions[r].vertices)
      if (v >= 0 && v < row.size() && row[v] >= 0) member[row[v]] = 1;
    const VectorXd share = head.skin_interpolation * member;
    for (Eigen::Index v = 0; v < n; ++v)
      if (share[v] > 0.5) region[v] = r;
  }
  return region;
}

}  // namespace

Vector3d pinned_colour() {
  return {0.70, 0.07, 0.06};
}
Vector3d sliding_colour() {
  return {0.06, 0.24, 0.62};
}
Vector3d bare_bone_colour() {
  return {0.74, 0.67, 0.53};
}

std::string readable(const std::string& name) {
  std::string words;
  for (const char c : name) {
    const bool upper = c >= 'A' && c <= 'Z';
    if (upper && !words.empty()) words += ' ';
    words += upper ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return words;
}

void add_attachments(Scene& scene, const PosedHead& posed) {
  const HeadTemplate& head = *posed.head;
  std::vector<int> hold(static_cast<std::size_t>(head.volume.V.rows()), 0);
  for (Eigen::Index i = 0; i < head.attachments.vertices.size(); ++i)
    hold[head.attachments.vertices[i]] = head.attachments.hold[i];
  for (const int tissue : {Tissue::skull, Tissue::mandible}) {
    TriangleMesh bone;
    bone.V = posed.volume_now.rows() > 0 ? posed.volume_now : head.volume.V;
    bone.F = region_boundary(head.volume, tissue);
    if (bone.F.rows() == 0) continue;
    std::vector<int> owner;
    Surface s;
    s.name = tissue == Tissue::skull ? "skull attachments" : "mandible attachments";
    s.mesh = areas_of_vertices(bone, owner);
    s.flat = true;
    s.material = painted_material();
    // A colour per triangle needs corners of its own.
    const MatrixX3i shared = s.mesh.F;
    const MatrixX3d V = s.mesh.V;
    s.mesh.V.resize(3 * shared.rows(), 3);
    s.colour.resize(3 * shared.rows(), 3);
    for (Eigen::Index f = 0; f < shared.rows(); ++f) {
      const int held = hold[owner[f]];
      for (int k = 0; k < 3; ++k) {
        const Eigen::Index corner = 3 * f + k;
        s.mesh.V.row(corner) = V.row(shared(f, k));
        s.mesh.F(f, k) = static_cast<int>(corner);
        s.colour.row(corner) = (held == static_cast<int>(Hold::pin)     ? pinned_colour()
                                : held == static_cast<int>(Hold::slide) ? sliding_colour()
                                                                        : bare_bone_colour())
                                   .transpose();
      }
    }
    scene.surfaces.push_back(std::move(s));
  }
}

void add_contacts(Scene& scene, const PosedHead& posed, const HeadViewOptions& options) {
  const HeadTemplate& head = *posed.head;
  const VectorXi region = region_of_skin(head);
  const int regions = static_cast<int>(head.contact_regions.size());
  std::vector<std::vector<Eigen::Index>> faces(regions + 1);  // the last: no region
  for (Eigen::Index f = 0; f < posed.skin->F.rows(); ++f) {
    // The region of two corners at least.
    const std::array<int, 3> r = {region[posed.skin->F(f, 0)], region[posed.skin->F(f, 1)],
                                  region[posed.skin->F(f, 2)]};
    const int most = r[0] == r[1] || r[0] == r[2] ? r[0] : r[1] == r[2] ? r[1] : -1;
    faces[most < 0 ? regions : most].push_back(f);
  }
  const Surface skin = skin_surface(posed, options);
  for (int r = 0; r <= regions; ++r) {
    Surface s = skin;
    s.mesh.F.resize(static_cast<Eigen::Index>(faces[r].size()), 3);
    for (std::size_t i = 0; i < faces[r].size(); ++i)
      s.mesh.F.row(static_cast<Eigen::Index>(i)) = skin.mesh.F.row(faces[r][i]);
    if (r < regions) {
      s.name = head.contact_regions[r].name;
      s.material = painted_material();
      s.material.albedo = category_colour(r);
      s.outline = 0.3;
    } else {
      s.material.opacity = 0.3;
    }
    if (options.peel) s = cut_surface(s, *options.peel);
    if (s.mesh.F.rows() > 0) scene.surfaces.push_back(std::move(s));
  }
}

}  // namespace phiz::detail
