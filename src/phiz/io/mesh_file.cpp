// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/io/mesh_file.h"

#include <fmt/format.h>

#include "phiz/core/error.h"
#include "phiz/io/file_bytes.h"
#include "phiz/io/obj.h"
#include "phiz/io/ply.h"
#include "phiz/io/polygons.h"
#include "phiz/io/stl.h"

namespace phiz {

PolygonMesh read_mesh(const std::string& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".obj") return read_obj(path);
  if (extension == ".ply") return read_ply(path);
  if (extension == ".stl") return as_polygons(read_stl(path));
  reject(path, fmt::format("unknown kind of mesh file '{}'", extension), "use .obj, .ply or .stl");
}

void write_mesh(const std::string& path, const TriangleMesh& mesh) {
  const std::string extension = lower_extension(path);
  if (extension == ".obj") return write_obj(path, mesh);
  if (extension == ".ply") return write_ply(path, mesh);
  if (extension == ".stl") return write_stl(path, mesh);
  throw Error(ErrorKind::usage,
              fmt::format("{}: unknown kind of mesh file '{}'; use .obj, .ply or .stl", path, extension));
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

void require_metres(const MatrixX3d& V, const std::string& where) {
  const SuspectedUnit unit = suspect_unit(V);
  if (unit.name == "metres") return;
  if (unit.name == "unknown") {
    reject(where, fmt::format("the mesh measures {:.4g} units, expected a head of about 0.25 metres", unit.extent),
           "scale it to metres");
  }
  reject(where,
         fmt::format("the mesh measures {:.4g} units and seems to be in {}, expected metres", unit.extent, unit.name),
         fmt::format("scale it by {:g}", unit.metres));
}

}  // namespace phiz
