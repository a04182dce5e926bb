// SPDX-License-Identifier: GPL-3.0-or-later
/// HeadTemplate: everything that a simulation-ready head is made of. A plain value; see docs/vocabulary.md.
/// Head frame: +x to the person's left, +y up, +z forward, origin midway between the mandibular condyles; metres.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "phiz/anatomy/jaw.h"
#include "phiz/geometry/mesh.h"

namespace phiz {

/// Region tags of the tets of HeadTemplate::volume.
enum Tissue : int { flesh = 1, skull = 2, mandible = 3 };

/// What a vertex or a part moves with.
enum class Carrier : int { flesh = 0, skull = 1, mandible = 2, left_eye = 3, right_eye = 4 };

/// A rigid mesh that is drawn and collided with: skull, mandible, upperTeeth, lowerTeeth, leftEye, rightEye, tongue...
/// `shapes` holds vertex displacements per expression for the few parts that also deform (the tongue). Connected pieces
/// of a part that Carrier::flesh carries (leftLashes, rightLashes) ride the skin where they grow (skin_ride.h).
struct Part {
  std::string name;
  TriangleMesh mesh;
  Carrier carrier = Carrier::skull;
  std::map<std::string, MatrixX3d> shapes;
};

/// One expression: displacement of every vertex of HeadTemplate::skin (metres, n_skin x 3) and the pose of the jaw.
struct Expression {
  std::string name;
  MatrixX3d displacement;
  JawPose jaw = JawPose::Zero();
};

/// A named point on the skin, as a vertex of HeadTemplate::skin. The 68 of the usual markup are named "0" to "67".
struct Landmark {
  std::string name;
  int skin_vertex = -1;
};

/// A craniometric landmark: a point on the skull or mandible (vertex of `volume`), its outward normal, the skin vertex
/// above it and the statistics of flesh thickness there (metres).
struct SkullLandmark {
  std::string name;
  int bone_vertex = -1;
  Vector3d normal = Vector3d::UnitZ();
  int skin_vertex = -1;
  double thickness_mean = 0;
  double thickness_deviation = 0;
};

/// A facial muscle: fibres as polylines from origin to insertion (metres), and the share of each tet that it fills.
struct Muscle {
  std::string name;
  std::vector<MatrixX3d> fibres;
  VectorXi tets;         ///< rows of volume.T that contain some of it
  VectorXd fraction;     ///< share of the tet's volume, in (0, 1]
  MatrixX3d direction;   ///< unit fibre direction per entry of `tets`
  TriangleMesh surface;  ///< closed and outward: what it looks like and fills; empty in files before version 3
  bool ring = false;     ///< its fibres go round an opening: orbicularis oculi and oris
};

/// How flesh sits on bone at a vertex.
enum class Hold : int {
  pin = 1,    ///< grown to the bone: it moves with it
  slide = 2,  ///< it stays on the bone's tangent plane and may slip along
};

/// Where flesh sits on bone (phace.md 4.3), one row each. The carrier of a vertex says which bone.
struct Attachments {
  VectorXi vertices;  ///< rows of volume.V on the surface of a bone, ascending
  VectorXi hold;      ///< Hold
  MatrixX3d normals;  ///< unit, out of the bone
};

/// A statistical model of people: skin = HeadTemplate::skin.V + sum over k of c_k mode_k, the c_k independent and
/// standard normal. Empty where nothing is known.
struct IdentityModel {
  Eigen::MatrixXf skin;  ///< 3 n_skin x k: x, y, z of vertex 0, of vertex 1, ...; metres
  VectorXd deviation;    ///< k: root mean square displacement of the skin by one unit of the mode, metres
};

/// A patch of the simulation skin that takes part in contact.
struct ContactRegion {
  std::string name;
  VectorXi vertices;    ///< rows of volume.V whose penetration is checked
  MatrixX3i triangles;  ///< triangles over rows of volume.V, outward, on which others are projected
};

/// Vertices of region `vertices` must stay outside of `obstacle`: the triangles of another region, or a rigid part.
struct ContactPair {
  std::string vertices;
  std::string obstacle;
};

struct HeadTemplate {
  std::string name;        ///< e.g. "builtin-standard"
  std::string provenance;  ///< where it comes from, with licences of the sources

  TetMesh volume;            ///< flesh, skull and mandible tets (tags: Tissue); flesh conforms to skin and bones
  VectorXi carrier;          ///< Carrier per vertex of `volume`: flesh = free, skull or mandible = fixed to that bone
  VectorXi skin_vertices;    ///< rows of volume.V on the skin surface (face, lips, oral cavity, sockets), s entries
  MatrixX3i skin_triangles;  ///< simulation skin: outward triangles over rows of volume.V

  TriangleMesh skin;            ///< the skin as drawn, with UVs: at least as fine as the simulation skin
  SparseMatrixd skin_sampling;  ///< s x n_skin: simulation skin from drawn skin (rows sum to 1)
  SparseMatrixd
      skin_interpolation;  ///< n_skin x s: drawn skin from simulation skin, applied to displacements (rows sum to 1)
  std::map<std::string, VectorXi>
      skin_regions;  ///< named vertex sets of `skin`: upperLip, lowerLip, leftUpperLid, scalp, ...

  std::vector<Part> parts;
  JawJoint jaw;
  std::vector<Expression> expressions;
  std::vector<Landmark> landmarks;
  std::vector<SkullLandmark> skull_landmarks;
  std::vector<Muscle> muscles;
  Attachments attachments;
  IdentityModel identity;
  std::vector<ContactRegion> contact_regions;
  std::vector<ContactPair> contact_pairs;
  Vector3d left_eye_centre = Vector3d::Zero();
  Vector3d right_eye_centre = Vector3d::Zero();
};

/// Throws phiz::Error(bad_input) naming the first thing that is wrong: counts, index ranges, NaN, inverted or
/// degenerate tets, non-manifold skin, weights that do not sum to one, unknown names, a head that is not the size of a
/// head (wrong unit). `where` is put in front of the message, e.g. the file name.
void validate(const HeadTemplate& head, const std::string& where);

/// The soft tets: flesh tets with at least one vertex that is free to move. Rows of volume.T, ascending.
VectorXi soft_tets(const HeadTemplate& head);
/// The share of the volume of all flesh tets that muscles fill (the template of phace.md section 3: 0.27).
double active_share(const HeadTemplate& head);

/// The part of that name, or nullptr.
const Part* find_part(const HeadTemplate& head, const std::string& name);
/// The expression of that name, or nullptr.
const Expression* find_expression(const HeadTemplate& head, const std::string& name);

/// Moves everything that has a place by `by`, metres.
void translate(HeadTemplate& head, const Vector3d& by);

}  // namespace phiz
