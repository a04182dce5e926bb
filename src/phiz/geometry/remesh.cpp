// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/geometry/remesh.h"

#include <CGAL/Polygon_mesh_processing/detect_features.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_filter.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_plane_policies.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include <stdexcept>
#include <string>

#include "phiz/core/error.h"
#include "phiz/geometry/cgal_mesh.h"
#include "phiz/geometry/validate.h"

namespace phiz {

namespace processing = CGAL::Polygon_mesh_processing;
namespace simplification = CGAL::Surface_mesh_simplification;

TriangleMesh remesh_isotropic(const TriangleMesh& mesh, const RemeshOptions& options) {
  if (!(options.edge_length > 0) || options.iterations < 1)
    throw Error(ErrorKind::usage, "remeshing needs a positive edge length and at least one iteration");
  validate(mesh, "remesh");
  CgalMesh work = to_cgal(mesh, "remesh");
  auto kept = work.add_property_map<CgalMesh::Edge_index, bool>("e:kept", false).first;
  if (options.sharp_angle < 180) processing::detect_sharp_edges(work, options.sharp_angle, kept);
  for (const auto e : work.edges())
    if (work.is_border(e)) kept[e] = true;
  try {
    processing::isotropic_remeshing(work.faces(), options.edge_length, work,
                                    processing::parameters::number_of_iterations(options.iterations)
                                        .edge_is_constrained_map(kept)
                                        .relax_constraints(false));
  } catch (const std::logic_error& error) {
    fail(std::string("remeshing failed: ") + error.what(), "check the surface for degenerate or folded triangles");
  }
  return from_cgal(work);
}

TriangleMesh decimate(const TriangleMesh& mesh, int target_triangles) {
  if (target_triangles < 4) throw Error(ErrorKind::usage, "decimation needs a target of at least 4 triangles");
  validate(mesh, "decimate");
  CgalMesh work = to_cgal(mesh, "decimate");
  if (static_cast<Eigen::Index>(target_triangles) >= mesh.F.rows()) return from_cgal(work);
  // A closed surface has three edges for every two triangles.
  simplification::Count_stop_predicate<CgalMesh> stop(static_cast<std::size_t>(target_triangles) * 3 / 2 + 1);
  using Policies = simplification::GarlandHeckbert_plane_policies<CgalMesh, CgalKernel>;
  const Policies policies(work);
  try {
    simplification::edge_collapse(work, stop,
                                  CGAL::parameters::get_cost(policies.get_cost())
                                      .get_placement(policies.get_placement())
                                      .filter(simplification::Bounded_normal_change_filter<>()));
  } catch (const std::logic_error& error) {
    fail(std::string("decimation failed: ") + error.what(), "check the surface for degenerate or folded triangles");
  }
  return from_cgal(work);
}

}  // namespace phiz
