// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/open/kit_parts.h"

#include <algorithm>
#include <string>
#include <utility>

#include "phiz/anatomy/builtin/ease.h"
#include "phiz/anatomy/open/face_guide.h"
#include "phiz/anatomy/open/face_kit_layout.h"
#include "phiz/geometry/geodesic.h"
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

/// Which vertices of the gums go with the jaw, and which of those are tongue.
struct GumSplit {
  std::vector<char> upper, lower, tongue;  // per vertex of the kit; lower without the tongue
};

GumSplit split_gums(const FaceKit& kit, const MatrixX3i& gums) {
  const MatrixX3d& V = kit.neutral.V;
  const auto n = static_cast<std::size_t>(V.rows());
  GumSplit split{std::vector<char>(n, 0), std::vector<char>(n, 0), std::vector<char>(n, 0)};
  constexpr double still = 1e-4;
  for (int v = face_kit::gum_vertices.first; v < face_kit::gum_vertices.end; ++v)
    (kit.expressions.at("jawOpen").row(v).norm() > still ? split.lower : split.upper)[static_cast<std::size_t>(v)] = 1;

  // The back of the tongue, and the gums beside the teeth.
  const MatrixX3i below = triangles_with(gums, split.lower);
  const MatrixX3d normals = vertex_normals(V, below);
  const SurfaceQuery teeth(
      V, face_kit_triangles(kit.neutral, face_kit::lower_teeth_faces.first, face_kit::lower_teeth_faces.end));
  constexpr double beside = 0.0015, half_width = 0.012, under_edge = 0.004;
  double edge = -1e9;
  for (int v = face_kit::lower_teeth_vertices.first; v < face_kit::lower_teeth_vertices.end; ++v)
    edge = std::max(edge, V(v, 1));
  std::vector<int> back, crest;
  for (int v = face_kit::gum_vertices.first; v < face_kit::gum_vertices.end; ++v) {
    if (!split.lower[static_cast<std::size_t>(v)]) continue;
    if (teeth.closest_point(V.row(v)).squared_distance < beside * beside)
      crest.push_back(v);
    else if (std::abs(V(v, 0)) < half_width && normals(v, 1) > 0.6 && V(v, 1) > edge - under_edge)
      back.push_back(v);
  }
  const VectorXd to_back = edge_distances(V, below, back), to_crest = edge_distances(V, below, crest);
  for (int v = face_kit::gum_vertices.first; v < face_kit::gum_vertices.end; ++v) {
    const auto i = static_cast<std::size_t>(v);
    if (split.lower[i] && to_back[v] < to_crest[v]) split.tongue[i] = 1;
  }
  // The sheet is cut through triangles that gums and tongue share: those go to the gums.
  return split;
}

std::vector<int> used_vertices(const PolygonMesh& mesh, const face_kit::Range& faces) {
  std::vector<int> rows;
  for (int f = faces.first; f < faces.end; ++f)
    rows.insert(rows.end(), mesh.faces[static_cast<std::size_t>(f)].begin(),
                mesh.faces[static_cast<std::size_t>(f)].end());
  return rows;
}

/// Slides the front of the tongue out over the lower lip; its root stays.
MatrixX3d tongue_out(const MatrixX3d& V) {
  const double root = V.col(2).minCoeff(), tip = V.col(2).maxCoeff();
  MatrixX3d D(V.rows(), 3);
  for (Eigen::Index v = 0; v < V.rows(); ++v) {
    const double t = (V(v, 2) - root) / (tip - root);
    const double s = smoothstep(0.15, 1.0, t);
    D.row(v) << -0.15 * s * V(v, 0), (0.003 - 0.012 * t * t) * s, 0.032 * s;
  }
  return D;
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

}  // namespace

KitParts kit_parts(const FaceKit& kit) {
  using namespace face_kit;
  const MatrixX3d& V = kit.neutral.V;
  KitParts result;
  const auto add = [&](const std::string& name, Carrier carrier, const MatrixX3i& F) {
    CompactMesh compact = remove_unused_vertices(V, F);
    result.parts.push_back({name, std::move(compact.mesh), carrier, {}});
    result.rows.push_back(std::move(compact.kept));
  };
  const auto faces = [&kit](const Range& range) { return face_kit_triangles(kit.neutral, range.first, range.end); };
  add("upperTeeth", Carrier::skull, faces(upper_teeth_faces));
  add("lowerTeeth", Carrier::mandible, faces(lower_teeth_faces));
  const MatrixX3i gums = faces(gum_faces);
  const GumSplit split = split_gums(kit, gums);
  add("upperGums", Carrier::skull, triangles_with(gums, split.upper));
  // Triangles with a corner off the tongue are gums.
  const MatrixX3i below = triangles_with(gums, split.lower);
  std::vector<int> gum_rows;
  for (int f = 0; f < below.rows(); ++f) {
    const auto on_tongue = [&](int k) { return split.tongue[static_cast<std::size_t>(below(f, k))] != 0; };
    if (!(on_tongue(0) && on_tongue(1) && on_tongue(2))) gum_rows.push_back(f);
  }
  add("lowerGums", Carrier::mandible, below(gum_rows, Eigen::all));
  add("tongue", Carrier::mandible, triangles_with(gums, split.tongue));
  result.parts.back().shapes["tongueOut"] = tongue_out(result.parts.back().mesh.V);
  // The kit's teeth are closed by force, 0.7 mm into each other.
  constexpr double clench = 0.0005;
  for (Part& part : result.parts)
    if (part.carrier == Carrier::mandible) part.mesh.V.col(1).array() -= clench;
  add("leftEye", Carrier::left_eye, faces({left_eye_faces.first, left_eye_faces.first + 800}));
  fit_eye(kit, left_sclera_vertices, left_socket_faces, "eyeBlink_L", result.parts.back().mesh);
  add("rightEye", Carrier::right_eye, faces({right_eye_faces.first, right_eye_faces.first + 800}));
  fit_eye(kit, right_sclera_vertices, right_socket_faces, "eyeBlink_R", result.parts.back().mesh);
  return result;
}

}  // namespace phiz
