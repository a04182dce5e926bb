// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/io/mesh_file.h"

#include <fmt/format.h>

#include "phiz/core/error.h"
#include "phiz/geometry/validate.h"
#include "phiz/io/file_bytes.h"
#include "phiz/io/gltf.h"
#include "phiz/io/gltf_surface.h"
#include "phiz/io/obj.h"
#include "phiz/io/ply.h"
#include "phiz/io/polygons.h"
#include "phiz/io/stl.h"

namespace phiz {

namespace {

GltfScene as_scene(const TriangleMesh& mesh) {
  GltfScene scene;
  scene.materials.push_back({.name = "surface"});
  scene.meshes.push_back({.name = "mesh", .primitives = {GltfSurface(mesh).primitive(mesh.V, 0)}});
  scene.nodes.push_back({.name = "mesh", .mesh = 0});
  scene.roots = {0};
  return scene;
}

}  // namespace

PolygonMesh read_mesh(const std::string& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".obj") return read_obj(path);
  if (extension == ".ply") return read_ply(path);
  if (extension == ".stl") return as_polygons(read_stl(path));
  if (extension == ".gltf" || extension == ".glb") {
    PolygonMesh mesh = flattened(read_gltf(path));
    if (mesh.V.rows() == 0) reject(path, "the file has no triangles");
    validate(mesh, path);
    return mesh;
  }
  reject(path, fmt::format("unknown kind of mesh file '{}'", extension), "use .obj, .ply, .stl, .gltf or .glb");
}

void write_mesh(const std::string& path, const TriangleMesh& mesh) {
  const std::string extension = lower_extension(path);
  if (extension == ".obj") return write_obj(path, mesh);
  if (extension == ".ply") return write_ply(path, mesh);
  if (extension == ".stl") return write_stl(path, mesh);
  if (extension == ".gltf" || extension == ".glb") return write_gltf(path, as_scene(mesh));
  throw Error(ErrorKind::usage,
              fmt::format("{}: unknown kind of mesh file '{}'; use .obj, .ply, .stl, .gltf or .glb", path, extension));
}

SuspectedUnit suspect_unit(const MatrixX3d& V) {
  SuspectedUnit unit;
  if (V.rows() > 0) unit.extent = (V.colwise().maxCoeff() - V.colwise().minCoeff()).maxCoeff();
  if (unit.extent >= 0.08 && unit.extent < 3) return {"metres", 1, unit.extent};
  if (unit.extent >= 8 && unit.extent < 80) return {"centimetres", 0.01, unit.extent};
  if (unit.extent >= 80 && unit.extent < 3000) return {"millimetres", 0.001, unit.extent};
  unit.name = "unknown";
  return unit;
}

std::string unit_defect(const MatrixX3d& V) {
  const SuspectedUnit unit = suspect_unit(V);
  if (unit.name == "metres" || unit.name == "unknown") return {};
  return fmt::format("the mesh measures {:.4g} units and seems to be in {}, expected metres; scale it by {:g}",
                     unit.extent, unit.name, unit.metres);
}

}  // namespace phiz
