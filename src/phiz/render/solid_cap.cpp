// SPDX-License-Identifier: GPL-3.0-or-later
#include <vector>

#include "phiz/geometry/surface.h"
#include "phiz/geometry/topology.h"
#include "phiz/render/cut.h"

namespace phiz {

namespace {

/// A connected part of a surface.
struct Shell {
  std::vector<int> faces;
  Eigen::AlignedBox3d box;
  bool outward = true;
};

std::vector<Shell> shells_of(const TriangleMesh& mesh) {
  const VectorXi component = triangle_components(mesh.F);
  std::vector<Shell> shells(component.size() > 0 ? component.maxCoeff() + 1 : 0);
  for (int f = 0; f < component.size(); ++f) {
    Shell& shell = shells[component[f]];
    shell.faces.push_back(f);
    for (int k = 0; k < 3; ++k) shell.box.extend(Vector3d(mesh.V.row(mesh.F(f, k))));
  }
  for (Shell& shell : shells) shell.outward = signed_volume(mesh.V, mesh.F(shell.faces, Eigen::all)) > 0;
  return shells;
}

void append(TriangleMesh& mesh, const TriangleMesh& more) {
  const Eigen::Index points = mesh.V.rows(), faces = mesh.F.rows();
  mesh.V.conservativeResize(points + more.V.rows(), 3);
  mesh.V.bottomRows(more.V.rows()) = more.V;
  mesh.F.conservativeResize(faces + more.F.rows(), 3);
  mesh.F.bottomRows(more.F.rows()) = (more.F.array() + static_cast<int>(points)).matrix();
}

}  // namespace

Surface solid_cap(const Surface& surface, const CutPlane& plane) {
  const std::vector<Shell> shells = shells_of(surface.mesh);
  Surface result;
  for (const Shell& solid : shells) {
    if (!solid.outward) continue;
    std::vector<int> faces = solid.faces;
    for (const Shell& hollow : shells)
      if (!hollow.outward && solid.box.contains(hollow.box))
        faces.insert(faces.end(), hollow.faces.begin(), hollow.faces.end());
    Surface part;
    part.name = surface.name;
    part.transform = surface.transform;
    part.material = surface.material;
    part.mesh = remove_unused_vertices(surface.mesh.V, surface.mesh.F(faces, Eigen::all)).mesh;
    part = cap(part, plane);
    if (result.mesh.F.rows() == 0)
      result = std::move(part);
    else
      append(result.mesh, part.mesh);
  }
  return result.mesh.F.rows() > 0 ? result : cap(surface, plane);  // inside out: what an odd number of shells holds
}

}  // namespace phiz
