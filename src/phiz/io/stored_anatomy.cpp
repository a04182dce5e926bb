// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/io/stored_anatomy.h"

#include <fmt/format.h>

#include "phiz/core/error.h"
#include "phiz/geometry/validate.h"

namespace phiz {

namespace {

constexpr int most_children = 1 << 20;

}  // namespace

void store_count(const Hdf5Group& group, std::size_t count) {
  group.set("count", static_cast<int>(count));
}

int stored_count(const Hdf5Group& group) {
  const int count = group.integer("count");
  if (count < 0 || count > most_children) reject(group.where("count"), fmt::format("{} entries", count));
  return count;
}

void store_mesh(const Hdf5Group& group, const TriangleMesh& mesh) {
  group.write("V", mesh.V);
  group.write("F", mesh.F);
  group.write("UV", mesh.UV);
  group.write("FUV", mesh.FUV);
}

TriangleMesh stored_mesh(const Hdf5Group& group) {
  TriangleMesh mesh;
  mesh.V = group.read<MatrixX3d>("V");
  mesh.F = group.read<MatrixX3i>("F");
  mesh.UV = group.read<MatrixX2d>("UV");
  mesh.FUV = group.read<MatrixX3i>("FUV");
  validate(mesh, group.where());
  return mesh;
}

void store_sparse(const Hdf5Group& group, const SparseMatrixd& matrix) {
  SparseMatrixd m = matrix;
  m.makeCompressed();
  group.set("rows", static_cast<int>(m.rows()));
  group.set("cols", static_cast<int>(m.cols()));
  // An empty matrix has no row starts to point at.
  VectorXi start = VectorXi::Zero(m.rows() + 1);
  if (m.rows() > 0) start = Eigen::Map<const VectorXi>(m.outerIndexPtr(), m.rows() + 1);
  group.write("row_start", start);
  group.write("column", Eigen::Map<const VectorXi>(m.innerIndexPtr(), m.nonZeros()));
  group.write("value", Eigen::Map<const VectorXd>(m.valuePtr(), m.nonZeros()));
}

SparseMatrixd stored_sparse(const Hdf5Group& group, Eigen::Index expected_rows, Eigen::Index expected_cols) {
  const int rows = group.integer("rows"), cols = group.integer("cols");
  if (rows != expected_rows || cols != expected_cols) {
    reject(group.where(),
           fmt::format("the matrix is {} x {}, expected {} x {}", rows, cols, expected_rows, expected_cols));
  }
  const auto start = group.read<VectorXi>("row_start");
  const auto column = group.read<VectorXi>("column");
  const auto value = group.read<VectorXd>("value");
  if (start.size() != rows + 1LL || value.size() != column.size()) {
    reject(group.where(), "the arrays of the sparse matrix do not fit together");
  }
  if (start[0] != 0 || start[rows] != column.size()) reject(group.where("row_start"), "does not cover all values");
  for (int r = 0; r < rows; ++r) {
    if (start[r] > start[r + 1] || start[r + 1] > column.size())
      reject(group.where("row_start"), fmt::format("row {} is out of order", r));
    for (int k = start[r]; k < start[r + 1]; ++k) {
      const int least = k > start[r] ? column[k - 1] + 1 : 0;
      if (column[k] < least || column[k] >= cols) {
        reject(group.where("column"), fmt::format("entry {} is column {} of {}", k, column[k], cols));
      }
    }
  }
  return Eigen::Map<const SparseMatrixd>(rows, cols, value.size(), start.data(), column.data(), value.data());
}

void store_parts(const Hdf5Group& group, const std::vector<Part>& parts) {
  store_count(group, parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Hdf5Group g = group.create_group(std::to_string(i));
    g.set("name", parts[i].name);
    g.set("carrier", static_cast<int>(parts[i].carrier));
    store_mesh(g.create_group("mesh"), parts[i].mesh);
    const Hdf5Group shapes = g.create_group("shapes");
    std::vector<std::string> names;
    for (const auto& [name, displacement] : parts[i].shapes) {
      shapes.write(std::to_string(names.size()), displacement);
      names.push_back(name);
    }
    shapes.write_strings("names", names);
  }
}

std::vector<Part> stored_parts(const Hdf5Group& group) {
  std::vector<Part> parts;
  const int count = stored_count(group);
  for (int i = 0; i < count; ++i) {
    const Hdf5Group g = group.group(std::to_string(i));
    Part part;
    part.name = g.text("name");
    const int carrier = g.integer("carrier");
    if (carrier < 0 || carrier > static_cast<int>(Carrier::right_eye)) {
      reject(g.where("carrier"), fmt::format("{} is no carrier", carrier));
    }
    part.carrier = static_cast<Carrier>(carrier);
    part.mesh = stored_mesh(g.group("mesh"));
    const Hdf5Group shapes = g.group("shapes");
    const std::vector<std::string> names = shapes.read_strings("names");
    for (std::size_t k = 0; k < names.size(); ++k) {
      auto displacement = shapes.read<MatrixX3d>(std::to_string(k));
      if (displacement.rows() != part.mesh.V.rows() || !displacement.allFinite()) {
        reject(shapes.where(names[k]), "the shape does not fit the part or is not finite");
      }
      part.shapes[names[k]] = std::move(displacement);
    }
    parts.push_back(std::move(part));
  }
  return parts;
}

void store_joint(const Hdf5Group& group, const JawJoint& joint) {
  group.write("centre", joint.centre);
  group.write("axis", joint.axis);
  group.write("up", joint.up);
  group.write("lower", joint.lower);
  group.write("upper", joint.upper);
}

JawJoint stored_joint(const Hdf5Group& group) {
  JawJoint joint;
  joint.centre = group.read<Vector3d>("centre");
  joint.axis = group.read<Vector3d>("axis");
  joint.up = group.read<Vector3d>("up");
  joint.lower = group.read<JawPose>("lower");
  joint.upper = group.read<JawPose>("upper");
  const bool finite = joint.centre.allFinite() && joint.lower.allFinite() && joint.upper.allFinite();
  const bool unit = std::abs(joint.axis.norm() - 1) < 1e-6 && std::abs(joint.up.norm() - 1) < 1e-6;
  if (!finite || !unit) reject(group.where(), "the joint is not finite or its axes are not unit vectors");
  return joint;
}

}  // namespace phiz
