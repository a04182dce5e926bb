// SPDX-License-Identifier: GPL-3.0-or-later
#include <mutex>

#include "phiz/core/error.h"
#include "phiz/io/container.h"
#include "phiz/io/container_file.h"
#include "phiz/io/stored_anatomy.h"

namespace phiz {

namespace {

void store_expressions(const Hdf5Group& group, const std::vector<Expression>& expressions) {
  std::vector<std::string> names;
  for (const Expression& e : expressions) {
    const Hdf5Group g = group.create_group(std::to_string(names.size()));
    g.write("displacement", e.displacement);
    g.write("jaw", e.jaw);
    names.push_back(e.name);
  }
  group.write_strings("names", names);
}

std::vector<Expression> stored_expressions(const Hdf5Group& group) {
  std::vector<Expression> expressions;
  for (const std::string& name : group.read_strings("names")) {
    const Hdf5Group g = group.group(std::to_string(expressions.size()));
    expressions.push_back({name, g.read<MatrixX3d>("displacement"), g.read<JawPose>("jaw")});
  }
  return expressions;
}

void store_landmarks(const Hdf5Group& group, const HeadTemplate& head) {
  std::vector<std::string> names;
  VectorXi vertices(static_cast<Eigen::Index>(head.landmarks.size()));
  for (const Landmark& mark : head.landmarks) {
    vertices[static_cast<Eigen::Index>(names.size())] = mark.skin_vertex;
    names.push_back(mark.name);
  }
  group.write_strings("skin_names", names);
  group.write("skin_vertex", vertices);

  names.clear();
  const auto count = static_cast<Eigen::Index>(head.skull_landmarks.size());
  MatrixX2i ends(count, 2);
  Eigen::Matrix<double, Eigen::Dynamic, 5> values(count, 5);
  for (const SkullLandmark& mark : head.skull_landmarks) {
    const auto i = static_cast<Eigen::Index>(names.size());
    ends.row(i) << mark.bone_vertex, mark.skin_vertex;
    values.row(i) << mark.normal.transpose(), mark.thickness_mean, mark.thickness_deviation;
    names.push_back(mark.name);
  }
  group.write_strings("skull_names", names);
  group.write("skull_bone_and_skin_vertex", ends);
  group.write("skull_normal_mean_deviation", values);
}

void read_landmarks(const Hdf5Group& group, HeadTemplate& head) {
  const auto skin_names = group.read_strings("skin_names");
  const auto vertices = group.read<VectorXi>("skin_vertex");
  const auto skull_names = group.read_strings("skull_names");
  const auto ends = group.read<MatrixX2i>("skull_bone_and_skin_vertex");
  const auto values = group.read<Eigen::Matrix<double, Eigen::Dynamic, 5>>("skull_normal_mean_deviation");
  const auto skulls = static_cast<Eigen::Index>(skull_names.size());
  if (vertices.size() != static_cast<Eigen::Index>(skin_names.size()) || ends.rows() != skulls ||
      values.rows() != skulls) {
    reject(group.where(), "the lists of landmarks differ in length");
  }
  for (Eigen::Index i = 0; i < vertices.size(); ++i) {
    head.landmarks.push_back({skin_names[static_cast<std::size_t>(i)], vertices[i]});
  }
  for (Eigen::Index i = 0; i < skulls; ++i) {
    head.skull_landmarks.push_back({skull_names[static_cast<std::size_t>(i)], ends(i, 0),
                                    values.row(i).head<3>().transpose(), ends(i, 1), values(i, 3), values(i, 4)});
  }
}

void store_muscles(const Hdf5Group& group, const std::vector<Muscle>& muscles) {
  store_count(group, muscles.size());
  for (std::size_t i = 0; i < muscles.size(); ++i) {
    const Muscle& muscle = muscles[i];
    const Hdf5Group g = group.create_group(std::to_string(i));
    g.set("name", muscle.name);
    g.write("tets", muscle.tets);
    g.write("fraction", muscle.fraction);
    g.write("direction", muscle.direction);
    // All fibres in one list of points; fibre k is the rows start[k] to start[k + 1].
    VectorXi start = VectorXi::Zero(static_cast<Eigen::Index>(muscle.fibres.size()) + 1);
    for (std::size_t k = 0; k < muscle.fibres.size(); ++k) {
      const auto row = static_cast<Eigen::Index>(k);
      start[row + 1] = start[row] + static_cast<int>(muscle.fibres[k].rows());
    }
    MatrixX3d points(start[start.size() - 1], 3);
    for (std::size_t k = 0; k < muscle.fibres.size(); ++k) {
      points.middleRows(start[static_cast<Eigen::Index>(k)], muscle.fibres[k].rows()) = muscle.fibres[k];
    }
    g.write("fibre_start", start);
    g.write("fibre_points", points);
    g.set("ring", muscle.ring ? 1 : 0);
    store_mesh(g.create_group("surface"), muscle.surface);
  }
}

std::vector<Muscle> stored_muscles(const Hdf5Group& group) {
  std::vector<Muscle> muscles;
  const int count = stored_count(group);
  for (int i = 0; i < count; ++i) {
    const Hdf5Group g = group.group(std::to_string(i));
    Muscle muscle;
    muscle.name = g.text("name");
    muscle.tets = g.read<VectorXi>("tets");
    muscle.fraction = g.read<VectorXd>("fraction");
    muscle.direction = g.read<MatrixX3d>("direction");
    const auto start = g.read<VectorXi>("fibre_start");
    const auto points = g.read<MatrixX3d>("fibre_points");
    for (Eigen::Index k = 0; k + 1 < start.size(); ++k) {
      if (start[k] < 0 || start[k + 1] < start[k] || start[k + 1] > points.rows()) {
        reject(g.where("fibre_start"), "a fibre lies outside of the list of points");
      }
      muscle.fibres.emplace_back(points.middleRows(start[k], start[k + 1] - start[k]));
    }
    if (g.has_group("surface")) {  // since version 3
      muscle.surface = stored_mesh(g.group("surface"));
      muscle.ring = g.integer("ring") != 0;
    }
    muscles.push_back(std::move(muscle));
  }
  return muscles;
}

void store_attachments(const Hdf5Group& group, const Attachments& attachments) {
  group.write("vertices", attachments.vertices);
  group.write("hold", attachments.hold);
  group.write("normals", attachments.normals);
}

Attachments stored_attachments(const Hdf5Group& group) {
  return {group.read<VectorXi>("vertices"), group.read<VectorXi>("hold"), group.read<MatrixX3d>("normals")};
}

void store_identity(const Hdf5Group& group, const IdentityModel& identity) {
  group.write("skin", identity.skin);
  group.write("deviation", identity.deviation);
}

IdentityModel stored_identity(const Hdf5Group& group) {
  IdentityModel identity;
  identity.skin = group.read<Eigen::MatrixXf>("skin");
  identity.deviation = group.read<VectorXd>("deviation");
  return identity;
}

void store_contact(const Hdf5Group& group, const HeadTemplate& head) {
  std::vector<std::string> names, vertices, obstacles;
  for (const ContactRegion& region : head.contact_regions) {
    const Hdf5Group g = group.create_group(std::to_string(names.size()));
    g.write("vertices", region.vertices);
    g.write("triangles", region.triangles);
    names.push_back(region.name);
  }
  for (const ContactPair& pair : head.contact_pairs) {
    vertices.push_back(pair.vertices);
    obstacles.push_back(pair.obstacle);
  }
  group.write_strings("names", names);
  group.write_strings("pair_vertices", vertices);
  group.write_strings("pair_obstacle", obstacles);
}

void read_contact(const Hdf5Group& group, HeadTemplate& head) {
  const auto names = group.read_strings("names");
  const auto count = static_cast<Eigen::Index>(names.size());
  for (Eigen::Index i = 0; i < count; ++i) {
    const Hdf5Group g = group.group(std::to_string(i));
    head.contact_regions.push_back(
        {names[static_cast<std::size_t>(i)], g.read<VectorXi>("vertices"), g.read<MatrixX3i>("triangles")});
  }
  const auto vertices = group.read_strings("pair_vertices");
  const auto obstacles = group.read_strings("pair_obstacle");
  if (vertices.size() != obstacles.size()) reject(group.where(), "the lists of contact pairs differ in length");
  for (std::size_t i = 0; i < vertices.size(); ++i) head.contact_pairs.push_back({vertices[i], obstacles[i]});
}

void store_regions(const Hdf5Group& group, const std::map<std::string, VectorXi>& regions) {
  std::vector<std::string> names;
  for (const auto& [name, vertices] : regions) {
    group.write(std::to_string(names.size()), vertices);
    names.push_back(name);
  }
  group.write_strings("names", names);
}

std::map<std::string, VectorXi> stored_regions(const Hdf5Group& group) {
  std::map<std::string, VectorXi> regions;
  const auto names = group.read_strings("names");
  for (std::size_t i = 0; i < names.size(); ++i) regions[names[i]] = group.read<VectorXi>(std::to_string(i));
  return regions;
}

}  // namespace

void store_head(const Hdf5Group& group, const HeadTemplate& head) {
  group.set("name", head.name);
  group.set("provenance", head.provenance);
  const Hdf5Group volume = group.create_group("volume");
  volume.write("V", head.volume.V);
  volume.write("T", head.volume.T);
  volume.write("region", head.volume.region);
  volume.write("carrier", head.carrier);
  volume.write("skin_vertices", head.skin_vertices);
  volume.write("skin_triangles", head.skin_triangles);
  store_mesh(group.create_group("skin"), head.skin);
  store_sparse(group.create_group("skin_sampling"), head.skin_sampling);
  store_sparse(group.create_group("skin_interpolation"), head.skin_interpolation);
  store_regions(group.create_group("skin_regions"), head.skin_regions);
  store_parts(group.create_group("parts"), head.parts);
  store_joint(group.create_group("jaw"), head.jaw);
  store_expressions(group.create_group("expressions"), head.expressions);
  store_landmarks(group.create_group("landmarks"), head);
  store_muscles(group.create_group("muscles"), head.muscles);
  store_attachments(group.create_group("attachments"), head.attachments);
  store_identity(group.create_group("identity"), head.identity);
  store_contact(group.create_group("contact"), head);
  group.write("left_eye_centre", head.left_eye_centre);
  group.write("right_eye_centre", head.right_eye_centre);
}

HeadTemplate stored_head(const Hdf5Group& group) {
  HeadTemplate head;
  head.name = group.text("name");
  head.provenance = group.text("provenance");
  const Hdf5Group volume = group.group("volume");
  head.volume.V = volume.read<MatrixX3d>("V");
  head.volume.T = volume.read<MatrixX4i>("T");
  head.volume.region = volume.read<VectorXi>("region");
  head.carrier = volume.read<VectorXi>("carrier");
  head.skin_vertices = volume.read<VectorXi>("skin_vertices");
  head.skin_triangles = volume.read<MatrixX3i>("skin_triangles");
  head.skin = stored_mesh(group.group("skin"));
  const auto simulated = head.skin_vertices.size(), drawn = head.skin.V.rows();
  head.skin_sampling = stored_sparse(group.group("skin_sampling"), simulated, drawn);
  head.skin_interpolation = stored_sparse(group.group("skin_interpolation"), drawn, simulated);
  head.skin_regions = stored_regions(group.group("skin_regions"));
  head.parts = stored_parts(group.group("parts"));
  head.jaw = stored_joint(group.group("jaw"));
  head.expressions = stored_expressions(group.group("expressions"));
  read_landmarks(group.group("landmarks"), head);
  head.muscles = stored_muscles(group.group("muscles"));
  // Since version 3.
  if (group.has_group("attachments")) head.attachments = stored_attachments(group.group("attachments"));
  if (group.has_group("identity")) head.identity = stored_identity(group.group("identity"));
  read_contact(group.group("contact"), head);
  head.left_eye_centre = group.read<Vector3d>("left_eye_centre");
  head.right_eye_centre = group.read<Vector3d>("right_eye_centre");
  validate(head, group.where());
  return head;
}

void save(const std::string& path, const HeadTemplate& head) {
  write_container(path, name_of(ContainerKind::head_template),
                  [&](const Hdf5Group& root) { store_head(root.create_group("head"), head); });
}

HeadTemplate load_head_template(const std::string& path) {
  const std::scoped_lock lock(hdf5_lock());
  const ContainerFile file = ContainerFile::open(path);
  // A face model is a head with more.
  if (file.kind() != name_of(ContainerKind::face_model)) file.require_kind(name_of(ContainerKind::head_template));
  return stored_head(file.root().group("head"));
}

}  // namespace phiz
