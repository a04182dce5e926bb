// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/io/take_export.h"

#include <filesystem>

#include "phiz/core/error.h"
#include "phiz/geometry/surface.h"
#include "phiz/io/file_bytes.h"
#include "phiz/io/obj.h"
#include "phiz/io/point_cache.h"

namespace phiz {

namespace {

/// Skin positions of a frame in the world.
MatrixX3d world_skin(const TakeFrame& frame) {
  return (frame.skin.cast<double>() * frame.head.linear().transpose()).rowwise() + frame.head.translation().transpose();
}

}  // namespace

int export_take_obj_sequence(const Take& take, const std::string& path) {
  if (lower_extension(path) != ".obj") throw Error(ErrorKind::usage, path + ": expected a name that ends in .obj");
  TriangleMesh mesh = take.skin;
  int count = 0;
  for (const TakeFrame& frame : take.frames) {
    mesh.V = world_skin(frame);
    write_obj(sequence_name(path, count++), mesh, vertex_normals(mesh.V, mesh.F));
  }
  return count;
}

void export_take_point_cache(const Take& take, const std::string& path) {
  const std::string extension = lower_extension(path);
  if (extension != ".pc2" && extension != ".mdd") {
    throw Error(ErrorKind::usage, path + ": expected a name that ends in .pc2 or .mdd");
  }
  PointCache cache;
  cache.frame_rate = take.frame_rate;
  for (const TakeFrame& frame : take.frames) cache.frames.emplace_back(world_skin(frame).cast<float>());
  if (extension == ".pc2") {
    write_pc2(path, cache);
  } else {
    write_mdd(path, cache);
  }
  write_obj(std::filesystem::path(path).replace_extension(".obj").string(), take.skin);
}

}  // namespace phiz
