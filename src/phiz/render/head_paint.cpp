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
      {"leftCheek", {1.04, 0.90, 0.87}, 0.016},     {"rightCheek", {1.04, 0.90, 0.87}, 0.016},
      {"chin", {1.0, 0.95, 0.94}, 0.010},           {"leftEar", {1.04, 0.86, 0.84}, 0.008},
      {"rightEar", {1.04, 0.86, 0.84}, 0.008},      {"leftUpperLid", {0.97, 0.88, 0.88}, 0.004},
      {"rightUpperLid", {0.97, 0.88, 0.88}, 0.004}, {"leftLowerLid", {0.97, 0.86, 0.88}, 0.004},
      {"rightLowerLid", {0.97, 0.86, 0.88}, 0.004}, {"upperLip", {0.86, 0.56, 0.60}, 0.0011},
      {"lowerLip", {0.88, 0.58, 0.61}, 0.0011},     {"upperLipInner", {0.80, 0.46, 0.52}, 0.001},
      {"lowerLipInner", {0.80, 0.46, 0.52}, 0.001}, {"mouthBag", {0.62, 0.30, 0.33}, 0.001},
      {"oralRoof", {0.55, 0.28, 0.30}, 0.001},      {"oralFloor", {0.55, 0.28, 0.30}, 0.001},
      {"leftSocket", {0.92, 0.60, 0.58}, 0.0006},   {"rightSocket", {0.92, 0.60, 0.58}, 0.0006},
      {"leftNostril", {0.75, 0.55, 0.52}, 0.002},   {"rightNostril", {0.75, 0.55, 0.52}, 0.002},
      {"neckCap", {0.9, 0.6, 0.55}, 0.001},         {"forehead", {1.0, 0.98, 0.97}, 0.012},
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

std::function<Vector3d(const Vector3d&)> brow_pattern(const HeadTemplate& head) {
  struct Brow {
    std::vector<Vector3d> line;  // from the nose outwards
    double length = 0;
  };
  std::vector<Brow> brows(2);
  for (int side = 0; side < 2; ++side) {
    Brow& brow = brows[side];
    for (int k = 0; k < 5; ++k) {
      const std::string name = std::to_string(side == 0 ? 21 - k : 22 + k);
      for (const Landmark& l : head.landmarks)
        if (l.name == name && l.skin_vertex >= 0 && l.skin_vertex < head.skin.V.rows())
          brow.line.emplace_back(head.skin.V.row(l.skin_vertex));
    }
    if (brow.line.size() != 5) return {};
    for (int k = 0; k < 4; ++k) brow.length += (brow.line[k + 1] - brow.line[k]).norm();
    if (!(brow.length > 0)) return {};
  }
  return [brows](const Vector3d& p) -> Vector3d {
    double density = 0;
    for (const Brow& brow : brows) {
      const double reach = 0.35 * brow.length;
      if ((p - brow.line[2]).squaredNorm() > (reach + 0.5 * brow.length) * (reach + 0.5 * brow.length)) continue;
      double nearest = 1e9, along = 0, across = 0, before = 0;
      for (int k = 0; k < 4; ++k) {
        const Vector3d ab = brow.line[k + 1] - brow.line[k];
        const double l = ab.norm(), t = std::clamp((p - brow.line[k]).dot(ab) / (l * l), 0.0, 1.0);
        const Vector3d off = p - brow.line[k] - t * ab;
        if (off.norm() < nearest) {
          nearest = off.norm();
          along = (before + t * l) / brow.length;
          across = off.y() >= 0 ? nearest : -nearest;
        }
        before += l;
      }
      // Widest near the nose, a thin tail; hairs lean outwards, those at the inner end stand up.
      const double half = brow.length * (0.115 - 0.075 * along) * smooth_step(-0.05, 0.12, along + 0.05);
      const double edge = std::clamp(nearest / std::max(half, 1e-6), 0.0, 2.0);
      const double lean = 0.25 + 1.9 * smooth_step(0.0, 0.45, along);
      const double stroke = along * brow.length + across * -lean;
      const int row = static_cast<int>(std::floor(across / brow.length * 24 + 100));
      const double hair = 0.65 * line_noise(stroke * 2600, row) + 0.35 * line_noise(stroke * 1100, 3);
      density = std::max(density, (1 - smooth_step(0.45, 1.25, edge + 0.55 * (hair - 0.5))) * (0.45 + 0.75 * hair));
    }
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
        0.55 * ring_noise(around + 0.05 * std::sin(20 * across), 90, 1) + 0.45 * ring_noise(around, 37, 2);
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
