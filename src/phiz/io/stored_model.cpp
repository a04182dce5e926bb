// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <mutex>

#include "phiz/core/error.h"
#include "phiz/io/container.h"
#include "phiz/io/container_file.h"
#include "phiz/io/stored_anatomy.h"

namespace phiz {

namespace {

constexpr double largest_angle = 6.3;     // radians, a full turn
constexpr double largest_shift = 0.2;     // metres
constexpr double largest_stretch = 1000;  // far beyond what any flesh can do

void check_shape(const VolumetricShape& shape, const HeadTemplate& head, const std::string& where) {
  const auto tets = shape.tets.size();
  if (shape.log_rotation.rows() != tets || shape.stretch.rows() != tets) {
    reject(where, "the arrays of the shape differ in length");
  }
  if (tets > 0 && (shape.tets.minCoeff() < 0 || shape.tets.maxCoeff() >= head.volume.T.rows())) {
    reject(where, fmt::format("a tet of the shape is not one of the {} tets", head.volume.T.rows()));
  }
  if (shape.displacement.rows() != 0 && shape.displacement.rows() != head.volume.V.rows()) {
    reject(where, "the displacement does not fit the vertices of the volume");
  }
  if (!shape.jaw.allFinite() || !shape.log_rotation.allFinite() || !shape.stretch.allFinite() ||
      !shape.displacement.allFinite()) {
    reject(where, "a value of the shape is not finite");
  }
  if (shape.jaw.cwiseAbs().maxCoeff() > largest_angle ||
      (tets > 0 && shape.log_rotation.rowwise().norm().maxCoeff() > largest_angle)) {
    reject(where, "an angle of the shape is more than a full turn", "angles must be in radians");
  }
  if (shape.displacement.size() > 0 && shape.displacement.cwiseAbs().maxCoeff() > largest_shift) {
    reject(where, fmt::format("the shape moves the flesh by more than {} m", largest_shift),
           "displacements must be in metres");
  }
  if (tets > 0 && shape.stretch.cwiseAbs().maxCoeff() > largest_stretch) {
    reject(where, fmt::format("the shape stretches a tet more than {} times", largest_stretch));
  }
}

}  // namespace

void save(const std::string& path, const FaceModel& model) {
  write_container(path, name_of(ContainerKind::face_model), [&](const Hdf5Group& root) {
    store_head(root.create_group("head"), model.head);
    const Hdf5Group shapes = root.create_group("shapes");
    store_count(shapes, model.shapes.size());
    for (std::size_t i = 0; i < model.shapes.size(); ++i) {
      const VolumetricShape& shape = model.shapes[i];
      const Hdf5Group g = shapes.create_group(std::to_string(i));
      g.set("name", shape.name);
      g.write("jaw", shape.jaw);
      g.write("tets", shape.tets);
      g.write("log_rotation", shape.log_rotation);
      g.write("stretch", shape.stretch);
      g.write("displacement", shape.displacement);
    }
  });
}

FaceModel load_face_model(const std::string& path) {
  const std::scoped_lock lock(hdf5_lock());
  const ContainerFile file = ContainerFile::open(path);
  file.require_kind(name_of(ContainerKind::face_model));
  FaceModel model;
  model.head = stored_head(file.root().group("head"));
  const Hdf5Group shapes = file.root().group("shapes");
  const int count = stored_count(shapes);
  for (int i = 0; i < count; ++i) {
    const Hdf5Group g = shapes.group(std::to_string(i));
    VolumetricShape shape;
    shape.name = g.text("name");
    shape.jaw = g.read<JawPose>("jaw");
    shape.tets = g.read<VectorXi>("tets");
    shape.log_rotation = g.read<decltype(shape.log_rotation)>("log_rotation");
    shape.stretch = g.read<decltype(shape.stretch)>("stretch");
    shape.displacement = g.read<decltype(shape.displacement)>("displacement");
    check_shape(shape, model.head, g.where(shape.name));
    model.shapes.push_back(std::move(shape));
  }
  return model;
}

}  // namespace phiz
