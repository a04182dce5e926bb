// SPDX-License-Identifier: GPL-3.0-or-later
#include "object_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "options.h"
#include "phiz/core/error.h"
#include "phiz/core/progress.h"
#include "phiz/geometry/surface.h"
#include "phiz/geometry/validate.h"
#include "phiz/io/mesh_file.h"
#include "phiz/io/rigid_path_file.h"

namespace phiz {

void add_object_options(CLI::App& verb, ObjectArguments& arguments) {
  verb.add_option("--object", arguments.file, "A rigid object: a closed surface (.obj, .ply, .stl) in metres")
      ->type_name("MESH");
  verb.add_option(
          "--object-path", arguments.path,
          "Where it is over time: a table (CSV) with the columns time,x,y,z and perhaps qw,qx,qy,qz; seconds of "
          "the performance, metres. Rows before the first frame are an approach")
      ->type_name("CSV");
  verb.add_option("--object-at", arguments.at, "Where it stays; without, where its own coordinates say")
      ->type_name("X,Y,Z")
      ->excludes("--object-path");
  verb.add_option("--object-frame", arguments.frame,
                  "What path and place refer to; the head carries what is in its frame")
      ->check(CLI::IsMember({"world", "head"}))
      ->capture_default_str();
}

std::optional<SimulateObject> load_object(const ObjectArguments& arguments) {
  constexpr double largest = 5;  // metres
  if (arguments.file.empty()) {
    if (!arguments.path.empty() || !arguments.at.empty()) misuse("--object-path and --object-at need --object");
    return {};
  }
  SimulateObject object;
  object.on_head = arguments.frame == "head";
  Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
  if (!arguments.at.empty()) place.translation() = three_numbers(arguments.at, "--object-at");
  object.mesh = triangulate(read_mesh(arguments.file));
  if (object.mesh.F.rows() == 0) reject(arguments.file, "it has no faces");
  require_closed_manifold(object.mesh, arguments.file);
  const double extent = (object.mesh.V.colwise().maxCoeff() - object.mesh.V.colwise().minCoeff()).maxCoeff();
  if (extent > largest)
    reject(arguments.file, fmt::format("it is {:.3g} m long", extent), "lengths are in metres; scale it");
  if (signed_volume(object.mesh.V, object.mesh.F) < 0) {
    announce(arguments.file + ": its triangles face inward and are turned");
    object.mesh.F.col(0).swap(object.mesh.F.col(1));
  }
  object.path = arguments.path.empty() ? resting_at(place) : read_rigid_path(arguments.path);
  return object;
}

}  // namespace phiz
