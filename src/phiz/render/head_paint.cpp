// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/render/head_paint.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "phiz/geometry/surface.h"

namespace phiz {

namespace {

struct Tint {
  std::string_view region;
  Vector3d colour;
  double blur;  // metres
};

const std::vector<Tint>& tints() {
  static const std::vector<Tint> list = {
      {"scalp", {0.86, 0.88, 0.91}, 0.022},         {"nose", {1.03, 0.90, 0.88}, 0.006},
      {"leftCheek", {1.02, 0.93, 0.91}, 0.016},     {"rightCheek", {1.02, 0.93, 0.91}, 0.016},
      {"chin", {1.0, 0.95, 0.94}, 0.010},           {"leftEar", {1.04, 0.86, 0.84}, 0.008},
      {"rightEar", {1.04, 0.86, 0.84}, 0.008},      {"leftUpperLid", {0.97, 0.88, 0.88}, 0.004},
      {"rightUpperLid", {0.97, 0.88, 0.88}, 0.004}, {"leftLowerLid", {0.97, 0.86, 0.88}, 0.004},
      {"rightLowerLid", {0.97, 0.86, 0.88}, 0.004}, {"upperLip", {0.90, 0.63, 0.65}, 0.0015},
      {"lowerLip", {0.92, 0.65, 0.66}, 0.0015},     {"upperLipInner", {0.80, 0.46, 0.52}, 0.001},
      {"lowerLipInner", {0.80, 0.46, 0.52}, 0.001}, {"mouthBag", {0.62, 0.30, 0.33}, 0.001},
      {"oralRoof", {0.55, 0.28, 0.30}, 0.001},      {"oralFloor", {0.55, 0.28, 0.30}, 0.001},
      {"leftSocket", {0.93, 0.69, 0.67}, 0.0006},   {"rightSocket", {0.93, 0.69, 0.67}, 0.0006},
      {"leftNostril", {0.75, 0.55, 0.52}, 0.002},   {"rightNostril", {0.75, 0.55, 0.52}, 0.002},
      {"neckCap", {0.80, 0.76, 0.74}, 0.001},       {"forehead", {1.0, 0.98, 0.97}, 0.012},
      {"neck", {0.98, 0.96, 0.95}, 0.012},
  };
  return list;
}

double hashed(int i, int j) {
  unsigned h = static_cast<unsigned>(i) * 0x9e3779b1U ^ static_cast<unsigned>(j) * 0x85ebca6bU;
  h ^= h >> 15;
  h *= 0x2c1b3c6dU;
  h ^= h >> 13;
  return (h & 0xffffU) / 65535.0;
}

/// Smooth noise on a ring: `cells` random values round the circle, another set per `row`.
double ring_noise(double angle, int cells, int row) {
  const double t = (angle / (2 * M_PI) + 0.5) * cells;
  const int i = static_cast<int>(std::floor(t));
  const double f = t - i, s = f * f * (3 - 2 * f);
  return (1 - s) * hashed(i % cells, row) + s * hashed((i + 1) % cells, row);
}

/// Smooth noise on a line: a random value at every integer, another set per `row`.
double line_noise(double t, int row) {
  const double floor = std::floor(t), f = t - floor, s = f * f * (3 - 2 * f);
  const int i = static_cast<int>(floor);
  return (1 - s) * hashed(i, row) + s * hashed(i + 1, row);
}

double smooth_step(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

}  // namespace

MatrixX3d paint_skin(const TriangleMesh& skin, const std::map<std::string, VectorXi>& regions) {
  const Eigen::Index n = skin.V.rows();
  MatrixX3d colour = MatrixX3d::Ones(n, 3);
  if (skin.F.rows() == 0) return colour;
  // Local edge length decides how many rounds of averaging reach as far as the blur.
  VectorXd valence = VectorXd::Zero(n), length = VectorXd::Zero(n);
  for (Eigen::Index f = 0; f < skin.F.rows(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const int a = skin.F(f, k), b = skin.F(f, (k + 1) % 3);
      const double l = (skin.V.row(a) - skin.V.row(b)).norm();
      for (const int v : {a, b}) {
        valence[v] += 1;
        length[v] += l;
      }
    }
  }
  for (const Tint& tint : tints()) {
    const auto found = regions.find(std::string(tint.region));
    if (found == regions.end()) continue;
    VectorXd weight = VectorXd::Zero(n);
    double edge = 0;
    int members = 0;
    for (const int v : found->second) {
      if (v < 0 || v >= n || valence[v] == 0) continue;
      weight[v] = 1;
      edge += length[v] / valence[v];
      ++members;
    }
    if (members == 0) continue;
    const double reach = tint.blur / (edge / members);
    const int rounds = std::clamp(static_cast<int>(std::lround(2 * reach * reach)), 0, 200);
    for (int round = 0; round < rounds; ++round) {
      VectorXd sum = VectorXd::Zero(n);
      for (Eigen::Index f = 0; f < skin.F.rows(); ++f) {
        for (int k = 0; k < 3; ++k) {
          const int a = skin.F(f, k), b = skin.F(f, (k + 1) % 3);
          sum[a] += weight[b];
          sum[b] += weight[a];
        }
      }
      for (Eigen::Index v = 0; v < n; ++v)
        if (valence[v] > 0) weight[v] = 0.5 * weight[v] + 0.5 * sum[v] / valence[v];
    }
    for (Eigen::Index v = 0; v < n; ++v) {
      const Eigen::RowVector3d factor =
          Eigen::RowVector3d::Ones() + weight[v] * (tint.colour.transpose().array() - 1).matrix();
      colour.row(v) = colour.row(v).cwiseProduct(factor);
    }
  }
  return colour;
}

namespace {

/// Where a point lies beside a line: how far off, and where along it (0 to 1).
struct Beside {
  double distance = 1e9, along = 0;
  Vector3d offset = Vector3d::Zero();
};

/// A line on the face, in order.
struct FaceLine {
  std::vector<Vector3d> points;
  double length = 0;
  Vector3d middle = Vector3d::Zero();

  explicit FaceLine(std::vector<Vector3d> line) : points(std::move(line)) {
    for (std::size_t k = 0; k + 1 < points.size(); ++k) length += (points[k + 1] - points[k]).norm();
    for (const Vector3d& p : points) middle += p / static_cast<double>(points.size());
  }
  bool far_from(const Vector3d& p) const { return (p - middle).squaredNorm() > length * length; }
  Beside beside(const Vector3d& p) const {
    Beside nearest;
    double before = 0;
    for (std::size_t k = 0; k + 1 < points.size(); ++k) {
      const Vector3d ab = points[k + 1] - points[k];
      const double l = ab.norm(), t = std::clamp((p - points[k]).dot(ab) / std::max(l * l, 1e-18), 0.0, 1.0);
      const Vector3d off = p - points[k] - t * ab;
      if (off.norm() < nearest.distance) nearest = {off.norm(), (before + t * l) / length, off};
      before += l;
    }
    return nearest;
  }
};

/// How dense the hairs of a brow are at p: widest and loose near the nose, a thin tail; the hairs lean outwards, those
/// at the inner end stand up.
double brow_density(const FaceLine& brow, const Vector3d& p) {
  const Beside at = brow.beside(p);
  const double half = brow.length * (0.105 - 0.080 * at.along) * smooth_step(-0.25, 0.25, at.along);
  const double across = at.offset.y() >= 0 ? at.distance : -at.distance;
  const double lean = 0.3 + 2.2 * smooth_step(0.0, 0.4, at.along);
  const double stroke = at.along * brow.length, over = across / brow.length;
  // Hairs: thin across their direction, long along it, in two layers that lean a little differently.
  const auto hairs = [&](double slope, int layer) {
    const double side = (stroke - slope * across) * 2300, length = over * 9 + 0.3 * line_noise(side, layer);
    const double f = length - std::floor(length), s = f * f * (3 - 2 * f);
    const int row = layer + static_cast<int>(std::floor(length)) + 100;
    return (1 - s) * line_noise(side, row) + s * line_noise(side, row + 1);
  };
  const double hair = 0.55 * hairs(lean, 0) + 0.45 * hairs(0.75 * lean, 500);
  const double edge = at.distance / std::max(half, 1e-6);
  const double body = 1 - smooth_step(0.35, 1.35, edge + 0.9 * (hair - 0.5));
  const double ends = smooth_step(-0.05, 0.14, at.along) * (1 - 0.85 * smooth_step(0.72, 1.0, at.along));
  return body * (0.45 + 0.75 * ends) * (at.along < 1 ? 1 : 0.4) * (0.35 + 0.85 * hair);
}

/// The roots of the lashes darken the edge of a lid; most in the outer half.
double lash_density(const FaceLine& margin, const Vector3d& p, bool upper) {
  const Beside at = margin.beside(p);
  const double lash = line_noise(at.along * margin.length * 2600, 7);
  const double reach = (upper ? 0.00075 : 0.00055) * (0.4 + 0.6 * lash);
  const double ends = smooth_step(0.02, 0.25, at.along) * (1 - smooth_step(0.96, 1.0, at.along));
  return (upper ? 0.85 : 0.5 * lash * lash) * ends * (1 - smooth_step(0.2 * reach, reach, at.distance));
}

}  // namespace

std::function<Vector3d(const Vector3d&)> hair_pattern(const HeadTemplate& head) {
  std::vector<FaceLine> brows, upper_margins, lower_margins;
  for (int side = 0; side < 2; ++side) {
    std::vector<Vector3d> line;
    for (int k = 0; k < 5; ++k) {
      const std::string name = std::to_string(side == 0 ? 21 - k : 22 + k);
      for (const Landmark& l : head.landmarks)
        if (l.name == name && l.skin_vertex >= 0 && l.skin_vertex < head.skin.V.rows())
          line.emplace_back(head.skin.V.row(l.skin_vertex));
    }
    if (line.size() == 5) brows.emplace_back(line);
    for (const bool upper : {true, false}) {
      const std::string name =
          std::string("loop:") + (side == 0 ? "right" : "left") + (upper ? "Upper" : "Lower") + "LidMargin";
      const auto loop = head.skin_regions.find(name);
      if (loop == head.skin_regions.end()) continue;
      std::vector<Vector3d> edge;
      for (const int v : loop->second)
        if (v >= 0 && v < head.skin.V.rows()) edge.emplace_back(head.skin.V.row(v));
      if (edge.size() > 1) (upper ? upper_margins : lower_margins).emplace_back(edge);
    }
  }
  const auto too_short = [](const FaceLine& line) { return !(line.length > 0); };
  for (std::vector<FaceLine>* lines : {&brows, &upper_margins, &lower_margins})
    lines->erase(std::remove_if(lines->begin(), lines->end(), too_short), lines->end());
  if (brows.empty() && upper_margins.empty()) return {};
  return [brows, upper_margins, lower_margins](const Vector3d& p) -> Vector3d {
    double density = 0;
    for (const FaceLine& brow : brows)
      if (!brow.far_from(p)) density = std::max(density, brow_density(brow, p));
    for (const FaceLine& margin : upper_margins)
      if (!margin.far_from(p)) density = std::max(density, lash_density(margin, p, true));
    for (const FaceLine& margin : lower_margins)
      if (!margin.far_from(p)) density = std::max(density, lash_density(margin, p, false));
    density = std::clamp(density, 0.0, 0.9);
    return Vector3d::Ones() + density * (Vector3d(0.14, 0.11, 0.10) - Vector3d::Ones());
  };
}

std::function<Vector3d(const Vector3d&)> eye_pattern(const Vector3d& centre, double radius) {
  return [centre, radius](const Vector3d& rest) -> Vector3d {
    const Vector3d p = (rest - centre) / radius;
    const double rho = std::hypot(p.x(), p.y()), around = std::atan2(p.y(), p.x());
    const Vector3d white(1.0, 0.97, 0.93);
    // Veins and a warm tone away from the iris.
    const double vein = std::pow(ring_noise(around + 0.4 * std::sin(9 * rho), 23, 7), 6) * smooth_step(0.6, 0.95, rho);
    Vector3d sclera =
        white.cwiseProduct(Vector3d(1, 1 - 0.30 * vein, 1 - 0.32 * vein))
            .cwiseProduct(Vector3d(1, 1 - 0.10 * smooth_step(0.6, 1, rho), 1 - 0.14 * smooth_step(0.6, 1, rho)));
    if (p.z() < 0) return sclera;
    constexpr double limbus = 0.49, pupil = 0.155;  // of the radius
    const double across = std::clamp((rho - pupil) / (limbus - pupil), 0.0, 1.0);
    const double fibres =
        0.55 * ring_noise(around + 0.015 * std::sin(20 * across), 90, 1) + 0.45 * ring_noise(around, 37, 2);
    const Vector3d outer(0.105, 0.145, 0.160), inner(0.300, 0.215, 0.115);
    Vector3d iris = outer + (inner - outer) * (1 - smooth_step(0.15, 0.65, across + 0.25 * (fibres - 0.5)));
    iris *= 0.55 + 0.95 * fibres;
    iris *= 1 - 0.75 * smooth_step(0.74, 1.0, across);  // limbal ring
    iris *= smooth_step(-0.03, 0.06, rho - pupil);      // pupil
    const double rim = smooth_step(limbus - 0.025, limbus + 0.035, rho);
    return iris + rim * (sclera - iris);
  };
}

}  // namespace phiz
