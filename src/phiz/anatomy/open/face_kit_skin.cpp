// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/open/face_kit_skin.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "phiz/anatomy/open/face_kit_layout.h"
#include "phiz/anatomy/open/lash_cards.h"
#include "phiz/core/error.h"
#include "phiz/geometry/coarsen.h"
#include "phiz/geometry/geodesic.h"
#include "phiz/geometry/surface.h"
#include "phiz/geometry/topology.h"
#include "phiz/geometry/untangle.h"
#include "phiz/geometry/validate.h"

namespace phiz {

namespace {

constexpr int cap_rings = 7;

/// The vertices that close a loop: rings that shrink to its centre, and that.
MatrixX3d cap_of(const MatrixX3d& loop) {
  const Eigen::Index n = loop.rows();
  const Eigen::RowVector3d centre = loop.colwise().mean();
  MatrixX3d cap((cap_rings - 1) * n + 1, 3);
  for (int ring = 1; ring < cap_rings; ++ring) {
    const double t = double(ring) / cap_rings;
    cap.middleRows((ring - 1) * n, n) = ((1 - t) * loop).rowwise() + t * centre;
  }
  cap.bottomRows(1) = centre;
  return cap;
}

/// Closes the base of the neck; returns its loop. Texture coordinates of the cap are one point.
std::vector<int> cap_neck(TriangleMesh& mesh) {
  const auto loops = boundary_loops(mesh.F);
  if (loops.size() != 1) reject("face kit", "its skin has " + std::to_string(loops.size()) + " holes, expected 1");
  const std::vector<int> loop = loops.front();
  const auto n = static_cast<int>(loop.size());
  const auto first = static_cast<int>(mesh.V.rows()), faces = static_cast<int>(mesh.F.rows());
  const MatrixX3d cap = cap_of(mesh.V(loop, Eigen::all));
  mesh.V.conservativeResize(first + cap.rows(), 3);
  mesh.V.bottomRows(cap.rows()) = cap;
  mesh.F.conservativeResize(faces + (2 * (cap_rings - 1) + 1) * n, 3);
  const auto row = [&](int ring, int i) { return ring == 0 ? loop[i % n] : first + (ring - 1) * n + i % n; };
  const int middle = static_cast<int>(mesh.V.rows()) - 1;
  int f = faces;
  for (int i = 0; i < n; ++i) {
    for (int ring = 0; ring + 1 < cap_rings; ++ring) {
      mesh.F.row(f++) << row(ring, i + 1), row(ring, i), row(ring + 1, i);
      mesh.F.row(f++) << row(ring, i + 1), row(ring + 1, i), row(ring + 1, i + 1);
    }
    mesh.F.row(f++) << row(cap_rings - 1, i + 1), row(cap_rings - 1, i), middle;
  }
  const auto corner = static_cast<int>(mesh.UV.rows());
  mesh.UV.conservativeResize(corner + 1, 2);
  mesh.UV.row(corner).setZero();
  mesh.FUV.conservativeResize(mesh.F.rows(), 3);
  mesh.FUV.bottomRows(mesh.F.rows() - faces).setConstant(corner);
  return loop;
}

std::vector<char> used_by(const PolygonMesh& mesh, const face_kit::Range& faces, Eigen::Index count) {
  std::vector<char> used(static_cast<std::size_t>(count), 0);
  for (int f = faces.first; f < faces.end; ++f)
    for (const int v : mesh.faces[static_cast<std::size_t>(f)]) used[static_cast<std::size_t>(v)] = 1;
  return used;
}

std::vector<int> both(const std::vector<char>& a, const std::vector<char>& b) {
  std::vector<int> rows;
  for (std::size_t v = 0; v < a.size(); ++v)
    if (a[v] && b[v]) rows.push_back(static_cast<int>(v));
  return rows;
}

/// Names parts of the skin by where they are.
class Regions {
 public:
  Regions(const FaceKit& kit, FaceKitSkin& skin) : kit_(kit), skin_(skin), n_(skin.mesh.V.rows()) {
    outer_ = used_by(kit.neutral, face_kit::outer_faces, n_);
    mouth_ = used_by(kit.neutral, face_kit::mouth_faces, n_);
    sockets_ = {used_by(kit.neutral, face_kit::left_socket_faces, n_),
                used_by(kit.neutral, face_kit::right_socket_faces, n_)};
    skin.lip_line = both(outer_, mouth_);
    for (int side = 0; side < 2; ++side) {
      skin.socket_lines[side] = both(outer_, sockets_[side]);
      skin.upper_lashes[side] = lash_roots(kit, side == 0, true);
      skin.lower_lashes[side] = lash_roots(kit, side == 0, false);
    }
  }

  void name() {
    name_mouth();
    for (int side = 0; side < 2; ++side) name_lids(side, side == 0 ? "left" : "right");
    const Vector3d eye = 0.5 * (landmark(36) + landmark(45));
    const double brow = landmark(24).y(), chin = landmark(8).y(), width = std::abs(landmark(16).x());
    set("scalp", [&](int v, const Vector3d& p) {
      return outer_[v] && p.y() > brow + 0.055 - 0.55 * std::max(0.0, landmark(27).z() - 0.012 - p.z()) &&
             p.y() > eye.y() - 0.06 && std::abs(p.x()) < 1.04 * width;
    });
    set("leftEar", [&](int v, const Vector3d& p) { return outer_[v] && ear(p, eye, width) && p.x() > 0; });
    set("rightEar", [&](int v, const Vector3d& p) { return outer_[v] && ear(p, eye, width) && p.x() < 0; });
    set("neck", [&](int v, const Vector3d& p) { return outer_[v] && p.y() < chin - 0.012; });
    set("neckCap", [&](int v, const Vector3d&) { return v >= face_kit::skin_vertices.end; });
    // The shoulders do not move with the face.
    set("shoulders",
        [&](int v, const Vector3d& p) { return v >= face_kit::skin_vertices.end || p.y() < chin - 0.055; });
  }

 private:
  Vector3d landmark(std::size_t i) const { return skin_.mesh.V.row(face_kit::landmarks[i]); }

  template <class Where>
  void set(const std::string& name, Where&& where) {
    std::vector<int> rows;
    for (int v = 0; v < n_; ++v)
      if (where(v, Vector3d(skin_.mesh.V.row(v)))) rows.push_back(v);
    skin_.regions[name] = Eigen::Map<VectorXi>(rows.data(), static_cast<Eigen::Index>(rows.size()));
  }

  static bool ear(const Vector3d& p, const Vector3d& eye, double width) {
    return std::abs(p.x()) > 1.03 * width && std::abs(p.y() - eye.y() + 0.018) < 0.05;
  }

  void name_mouth() {
    const VectorXd distance = edge_distances(skin_.mesh.V, skin_.mesh.F, skin_.lip_line);
    const MatrixX3d& opened = kit_.expressions.at("jawOpen");
    const double half = 0.45 * opened.row(face_kit::landmarks[66]).norm();
    // By what moves with the jaw beside the line of the lips, and farther inside, where the lining moves less, by
    // height.
    constexpr double beside = 0.004;
    const MatrixX3d line = skin_.mesh.V(skin_.lip_line, Eigen::all);
    const auto is_lower = [&](int v) {
      if (v >= opened.rows()) return false;
      if (!mouth_[v] || distance[v] < beside) return opened.row(v).norm() > half;
      Eigen::Index nearest = 0;
      (line.rowwise() - skin_.mesh.V.row(v)).rowwise().squaredNorm().minCoeff(&nearest);
      return skin_.mesh.V(v, 1) < line(nearest, 1);
    };
    // The border of the vermilion passes through the outer landmarks of the mouth.
    const auto vermilion = [&](int v, const Vector3d& p) {
      if (!outer_[v] || distance[v] > 0.02) return false;
      std::size_t best = 48;
      for (std::size_t i = 48; i < 60; ++i)
        if ((landmark(i) - p).norm() < (landmark(best) - p).norm()) best = i;
      return distance[v] <= 1.02 * distance[face_kit::landmarks[best]] + 1e-4;
    };
    constexpr double inner = 0.013;
    set("upperLip", [&](int v, const Vector3d& p) { return vermilion(v, p) && !is_lower(v); });
    set("lowerLip", [&](int v, const Vector3d& p) { return vermilion(v, p) && is_lower(v); });
    set("upperLipInner", [&](int v, const Vector3d&) { return mouth_[v] && distance[v] < inner && !is_lower(v); });
    set("lowerLipInner", [&](int v, const Vector3d&) { return mouth_[v] && distance[v] < inner && is_lower(v); });
    set("mouthBag", [&](int v, const Vector3d&) { return mouth_[v] != 0; });
    // Beyond the ends of the roots; the lining of lips and cheeks is what lies between.
    double top = -1e9, bottom = 1e9;
    for (int v = face_kit::teeth_vertices.first; v < face_kit::teeth_vertices.end; ++v) {
      top = std::max(top, kit_.neutral.V(v, 1));
      bottom = std::min(bottom, kit_.neutral.V(v, 1));
    }
    constexpr double root_end = 0.006;
    set("oralRoof", [&](int v, const Vector3d& p) { return mouth_[v] && p.y() > top - root_end; });
    set("oralFloor", [&](int v, const Vector3d& p) { return mouth_[v] && p.y() < bottom + root_end; });
  }

  void name_lids(int side, const std::string& name) {
    const auto from = [&](const std::vector<int>& line) { return edge_distances(skin_.mesh.V, skin_.mesh.F, line); };
    const VectorXd upper = from(skin_.upper_lashes[side]), lower = from(skin_.lower_lashes[side]);
    constexpr double outside = 0.006, inside = 0.010, margin = 0.0018;  // metres from the roots of the lashes
    const auto& socket = sockets_[side];
    const auto is_near = [&](int v, const VectorXd& d) {
      return (outer_[v] && d[v] < outside) || (socket[v] && d[v] < inside);
    };
    set(name + "UpperLid", [&](int v, const Vector3d&) { return upper[v] < lower[v] && is_near(v, upper); });
    set(name + "LowerLid", [&](int v, const Vector3d&) { return lower[v] <= upper[v] && is_near(v, lower); });
    set(name + "UpperLidMargin", [&](int v, const Vector3d&) { return upper[v] < lower[v] && upper[v] < margin; });
    set(name + "LowerLidMargin", [&](int v, const Vector3d&) { return lower[v] <= upper[v] && lower[v] < margin; });
    set(name + "Socket", [&](int v, const Vector3d&) { return socket[v] != 0; });
  }

  const FaceKit& kit_;
  FaceKitSkin& skin_;
  Eigen::Index n_;
  std::vector<char> outer_, mouth_;
  std::array<std::vector<char>, 2> sockets_;
};

}  // namespace

FaceKitSkin make_face_kit_skin(const FaceKit& kit) {
  PolygonMesh skin;
  skin.V = kit.neutral.V.topRows(face_kit::skin_vertices.end);
  const auto first = static_cast<std::ptrdiff_t>(face_kit::skin_faces.end);
  skin.faces.assign(kit.neutral.faces.begin(), kit.neutral.faces.begin() + first);
  skin.UV = kit.neutral.UV;
  if (!kit.neutral.face_uvs.empty())
    skin.face_uvs.assign(kit.neutral.face_uvs.begin(), kit.neutral.face_uvs.begin() + first);
  for (const auto& face : skin.faces)
    for (const int v : face)
      if (v >= skin.V.rows()) reject("face kit", "a face of the skin has the corner " + std::to_string(v));
  FaceKitSkin result;
  result.mesh = triangulate(skin);
  result.neck_loop = cap_neck(result.mesh);
  if (!untangle(result.mesh, 40)) fail("the skin of the face kit intersects itself and could not be mended");
  require_closed_manifold(result.mesh, "face kit's skin");
  Regions(kit, result).name();
  return result;
}

MatrixX3d with_cap(const FaceKitSkin& skin, const MatrixX3d& of_kit) {
  MatrixX3d all(skin.mesh.V.rows(), 3);
  const MatrixX3d cap = cap_of(of_kit(skin.neck_loop, Eigen::all));
  all << of_kit.topRows(face_kit::skin_vertices.end), cap;
  return all;
}

TriangleMesh simulation_skin(const FaceKitSkin& skin, int vertices) {
  const MatrixX3d& V = skin.mesh.V;
  const auto points = [&V](const std::vector<int>& rows) { return MatrixX3d(V(rows, Eigen::all)); };
  const MatrixX3d lips = points(skin.lip_line);
  std::vector<int> lashes;
  for (const auto* lines : {&skin.upper_lashes, &skin.lower_lashes})
    for (const std::vector<int>& line : *lines) lashes.insert(lashes.end(), line.begin(), line.end());
  const MatrixX3d lids = points(lashes);
  MatrixX3d nose(3, 3);
  nose << V.row(face_kit::landmarks[30]), V.row(face_kit::landmarks[31]), V.row(face_kit::landmarks[35]);
  const auto near = [](const MatrixX3d& features, const Vector3d& p) {
    return std::sqrt((features.rowwise() - p.transpose()).rowwise().squaredNorm().minCoeff());
  };
  // Edge lengths relative to the base: they grow with the distance from what moves in detail.
  const auto relative = [&](const Vector3d& p) {
    const double d = std::min({near(lids, p) / 0.016 + 0.35, near(lips, p) / 0.022 + 0.45, near(nose, p) / 0.03 + 0.6});
    return std::clamp(d, 0.35, 3.4);
  };
  TriangleMesh best;
  double base = 0.0042 * std::sqrt(6000.0 / vertices);
  for (int attempt = 0; attempt < 5; ++attempt) {
    CoarsenOptions options;
    options.edge_length = [&](const Vector3d& p) { return base * relative(p); };
    best = coarsen(skin.mesh, options);
    const double ratio = static_cast<double>(best.V.rows()) / vertices;
    if (std::abs(ratio - 1) < 0.04 || best.V.rows() > 0.97 * V.rows()) break;
    base *= std::sqrt(ratio);
  }
  if (!untangle(best, 40)) fail("the simulation skin intersects itself and could not be mended");
  return best;
}

}  // namespace phiz
