// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/open/kit_parts.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "phiz/anatomy/builtin/mouth/tongue.h"
#include "phiz/anatomy/lashes.h"
#include "phiz/anatomy/open/face_guide.h"
#include "phiz/anatomy/open/face_kit_layout.h"
#include "phiz/anatomy/open/lash_cards.h"
#include "phiz/geometry/spatial_query.h"
#include "phiz/geometry/surface.h"
#include "phiz/geometry/topology.h"

namespace phiz {

namespace {

MatrixX3i triangles_with(const MatrixX3i& F, const std::vector<char>& member) {
  MatrixX3i kept(F.rows(), 3);
  Eigen::Index count = 0;
  for (Eigen::Index f = 0; f < F.rows(); ++f) {
    const auto in = [&](int k) { return member[static_cast<std::size_t>(F(f, k))] != 0; };
    if (in(0) && in(1) && in(2)) kept.row(count++) = F.row(f);
  }
  kept.conservativeResize(count, 3);
  return kept;
}

/// The sheet of the gums without the tongue that is a part of it: from the back of the tongue down its sides, up to the
/// gums that face it.
MatrixX3i without_tongue(const MatrixX3d& V, const MatrixX3i& sheet) {
  const MatrixX3d normals = vertex_normals(V, sheet);
  constexpr face_kit::Range lower = face_kit::lower_teeth_vertices;
  const auto teeth = V.middleRows(lower.first, lower.end - lower.first);
  constexpr double half_width = 0.010, under_edge = 0.004, behind_teeth_width = 0.021;  // metres
  const double edge = teeth.col(1).maxCoeff(), last_molar = teeth.col(2).minCoeff(), middle = teeth.col(2).mean();
  const auto is_gum = [&](int v) {
    if (V(v, 2) < last_molar) return std::abs(V(v, 0)) > behind_teeth_width;
    if (V(v, 2) < middle && std::abs(V(v, 0)) < half_width) return false;
    const Vector2d outward = Vector2d(V(v, 0), V(v, 2) - middle).normalized();
    return Vector2d(normals(v, 0), normals(v, 2)).dot(outward) < -0.1;
  };
  std::vector<char> tongue(static_cast<std::size_t>(V.rows()), 0);
  std::vector<int> found;
  const auto find = [&](int v) {
    if (tongue[static_cast<std::size_t>(v)]) return;
    tongue[static_cast<std::size_t>(v)] = 1;
    found.push_back(v);
  };
  for (int v = face_kit::gum_vertices.first; v < face_kit::gum_vertices.end; ++v)
    if (std::abs(V(v, 0)) < half_width && normals(v, 1) > 0.6 && V(v, 1) > edge - under_edge && V(v, 2) < middle)
      find(v);
  const auto neighbours = vertex_neighbours(sheet, static_cast<int>(V.rows()));
  for (std::size_t k = 0; k < found.size(); ++k)
    for (const int v : neighbours[static_cast<std::size_t>(found[k])])
      if (!is_gum(v)) find(v);
  std::vector<int> rows;
  for (int f = 0; f < sheet.rows(); ++f) {
    const auto on_tongue = [&](int k) { return tongue[static_cast<std::size_t>(sheet(f, k))] != 0; };
    if (!(on_tongue(0) && on_tongue(1) && on_tongue(2))) rows.push_back(f);
  }
  return sheet(rows, Eigen::all);
}

std::vector<int> used_vertices(const PolygonMesh& mesh, const face_kit::Range& faces) {
  std::vector<int> rows;
  for (int f = faces.first; f < faces.end; ++f)
    rows.insert(rows.end(), mesh.faces[static_cast<std::size_t>(f)].begin(),
                mesh.faces[static_cast<std::size_t>(f)].end());
  return rows;
}

/// A tongue between the lower teeth, with its shape tongueOut: the kit's is a part of the sheet of the gums, without an
/// underside.
Part tongue_of(const FaceKit& kit) {
  constexpr double behind = 0.012;  // metres: how far the mouth goes on behind the last molars
  const auto teeth = [&](const face_kit::Range& range) {
    return kit.neutral.V.middleRows(range.first, range.end - range.first);
  };
  const auto upper = teeth(face_kit::upper_teeth_vertices), lower = teeth(face_kit::lower_teeth_vertices);
  Proportions::DentalArch arch;
  arch.half_width = upper.col(0).cwiseAbs().maxCoeff();
  arch.z0 = lower.col(2).minCoeff() - behind;
  arch.depth = upper.col(2).maxCoeff() - arch.z0;
  arch.lower_edge = -1;
  for (Eigen::Index v = 0; v < lower.rows(); ++v) {
    constexpr double incisors = 0.008;  // metres behind the foremost point
    if (lower(v, 2) > lower.col(2).maxCoeff() - incisors) arch.lower_edge = std::max(arch.lower_edge, lower(v, 1));
  }
  Proportions proportions;
  proportions.arch = arch;
  return make_tongue(proportions);
}

/// The kit's eyeballs are larger than its sockets. A round eye that fits behind its lids, open and closed.
void fit_eye(const FaceKit& kit, const face_kit::Range& sclera, const face_kit::Range& socket, const char* blink,
             TriangleMesh& eye) {
  constexpr double front = 0.005, film = 0.0002;  // metres: where lids are, and between them and the eye
  const MatrixX3d& V = kit.neutral.V;
  const Vector3d centre = fit_sphere(V.middleRows(sclera.first, sclera.end - sclera.first)).centre;
  double radius = 1;
  for (const int v : used_vertices(kit.neutral, socket))
    for (const double closed : {0.0, 1.0}) {
      const Vector3d p = (V.row(v) + closed * kit.expressions.at(blink).row(v)).transpose() - centre;
      if (p.z() > front) radius = std::min(radius, p.norm() - film);
    }
  for (Eigen::Index v = 0; v < eye.V.rows(); ++v) {
    const Vector3d away = eye.V.row(v).transpose() - centre;
    eye.V.row(v) = centre + radius * away.normalized();
  }
}

TriangleMesh kit_lashes(const FaceKit& kit, bool left) {
  std::vector<LashSheet> upper, lower;
  for (const LashCard& card : lash_cards(kit, left)) {
    LashSheet& sheet = (card.upper ? upper : lower).emplace_back();
    for (const std::vector<int>& line : card.lines) sheet.push_back(kit.neutral.V(line, Eigen::all));
  }
  return grow_lashes(upper, lower, 1);
}

}  // namespace

std::vector<Part> kit_parts(const FaceKit& kit) {
  using namespace face_kit;
  const MatrixX3d& V = kit.neutral.V;
  std::vector<Part> parts;
  const auto add = [&](const std::string& name, Carrier carrier, const MatrixX3i& F) {
    parts.push_back({name, remove_unused_vertices(V, F).mesh, carrier, {}});
  };
  const auto faces = [&kit](const Range& range) { return face_kit_triangles(kit.neutral, range.first, range.end); };
  add("upperTeeth", Carrier::skull, faces(upper_teeth_faces));
  add("lowerTeeth", Carrier::mandible, faces(lower_teeth_faces));
  // What moves with the jaw in jawOpen are the lower gums, with the tongue.
  constexpr double still = 1e-4, gum_thickness = 0.003;  // metres
  const VectorXd moved = kit.expressions.at("jawOpen").rowwise().norm();
  const MatrixX3i gums = faces(gum_faces);
  const auto sheet = [&](bool lower) {
    std::vector<char> member(static_cast<std::size_t>(V.rows()));
    for (std::size_t v = 0; v < member.size(); ++v) member[v] = (moved[static_cast<Eigen::Index>(v)] > still) == lower;
    return triangles_with(gums, member);
  };
  add("upperGums", Carrier::skull, sheet(false));
  add("lowerGums", Carrier::mandible, without_tongue(V, sheet(true)));
  for (Part& part : parts)
    if (!is_closed(part.mesh.F)) part.mesh = thickened(part.mesh, gum_thickness);
  parts.push_back(tongue_of(kit));
  // The kit's teeth are closed by force, 0.7 mm into each other.
  constexpr double clench = 0.0005;
  for (Part& part : parts)
    if (part.carrier == Carrier::mandible) part.mesh.V.col(1).array() -= clench;
  add("leftEye", Carrier::left_eye, faces({left_eye_faces.first, left_eye_faces.first + 800}));
  fit_eye(kit, left_sclera_vertices, left_socket_faces, "eyeBlink_L", parts.back().mesh);
  add("rightEye", Carrier::right_eye, faces({right_eye_faces.first, right_eye_faces.first + 800}));
  fit_eye(kit, right_sclera_vertices, right_socket_faces, "eyeBlink_R", parts.back().mesh);
  parts.push_back({"leftLashes", kit_lashes(kit, true), Carrier::flesh, {}});
  parts.push_back({"rightLashes", kit_lashes(kit, false), Carrier::flesh, {}});
  return parts;
}

}  // namespace phiz
