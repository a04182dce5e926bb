// SPDX-License-Identifier: GPL-3.0-or-later
/// The open data that the open-anatomy head is built from, as values. io/open_data.h reads them from folders.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "phiz/geometry/mesh.h"

namespace phiz {

/// ICT Face Model Light (Li et al. 2020; MIT licence): one mesh of skin, mouth, teeth, tongue and eyes, with shapes.
/// Metres; +x to the person's left, +y up, +z forward; the origin is the model's own.
struct FaceKit {
  PolygonMesh neutral;
  std::map<std::string, MatrixX3d> expressions;  ///< displacement of every vertex, by the model's names ("jawOpen")
  std::vector<MatrixX3d> identities;             ///< displacement of every vertex by one standard deviation of a mode
};

/// BodyParts3D (Mitsuhashi et al. 2009; CC BY 4.0): organs of one man in one frame, by their number in the Foundational
/// Model of Anatomy, e.g. 52748 for the mandible. Metres; axes as for FaceKit; the origin is between the feet.
struct BodyParts {
  std::map<int, TriangleMesh> meshes;

  const TriangleMesh& at(int fma) const { return meshes.at(fma); }
};

enum class BodyPartKind { skull, mandible, upper_tooth, lower_tooth, vertebra, muscle, soft };

/// A part that the open-anatomy head needs.
struct BodyPartName {
  int fma;
  BodyPartKind kind;
  const char* name;
};
/// What must be there: 21 bones of the skull, the mandible, 28 teeth, eyeballs, lips, ears, and the muscles of
/// expression and of the jaw.
const std::vector<BodyPartName>& needed_body_parts();
/// What is used when it is there: the vertebrae of the neck.
const std::vector<BodyPartName>& optional_body_parts();

/// Names of the files of FaceKit, without ".obj": the expressions, and the identities in their order.
const std::vector<std::string>& face_kit_expressions();
std::vector<std::string> face_kit_identities();

}  // namespace phiz
