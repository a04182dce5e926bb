// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/io/head_materials.h"

#include <algorithm>
#include <cmath>

#include "phiz/core/random.h"
#include "phiz/io/png.h"
#include "phiz/io/text_scanner.h"

namespace phiz {

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double iris_angle = 29.0 * pi / 180;  // of the limbus from the optical axis: 11.7 mm on a 24 mm eye
constexpr double pupil_angle = 8.5 * pi / 180;  // 3.5 mm
constexpr int texture_size = 512;

bool contains(const std::string& text, std::string_view part) {
  return text.find(part) != std::string::npos;
}

double smooth_step(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// Sclera, limbus, iris with radial fibres, pupil; sRGB.
Image eye_texture() {
  Random random(7);
  constexpr int fibres = 180;
  std::vector<double> fibre(fibres);
  for (double& f : fibre) f = random.uniform(-1, 1);
  Image image{texture_size, texture_size, 3, std::vector<std::uint8_t>(std::size_t{3} * texture_size * texture_size)};
  const Vector3d sclera(236, 228, 222), rim(214, 178, 168), iris_outer(66, 84, 92), iris_inner(126, 108, 74),
      dark(22, 26, 30), black(8, 7, 7);
  for (int y = 0; y < texture_size; ++y) {
    for (int x = 0; x < texture_size; ++x) {
      const double u = (x + 0.5) / texture_size * 2 - 1, v = (y + 0.5) / texture_size * 2 - 1;
      const double angle = std::hypot(u, v) * pi / 2;
      const double turn = (std::atan2(v, u) / (2 * pi) + 0.5) * fibres;
      const auto first = static_cast<std::size_t>(turn) % fibres;
      const double share = turn - std::floor(turn);
      const double strand = fibre[first] * (1 - share) + fibre[(first + 1) % fibres] * share;
      const double radius = (angle - pupil_angle) / (iris_angle - pupil_angle);
      Vector3d iris = iris_inner + (iris_outer - iris_inner) * smooth_step(0.15, 0.6, radius + 0.12 * strand);
      iris *= 1 + 0.22 * strand;
      iris += (dark - iris) * 0.8 * smooth_step(0.72, 1.0, radius);  // limbal ring
      Vector3d colour = sclera + (rim - sclera) * smooth_step(0.9, pi / 2, angle);
      colour = iris + (colour - iris) * smooth_step(iris_angle - 0.02, iris_angle + 0.035, angle);
      colour = black + (colour - black) * smooth_step(pupil_angle - 0.012, pupil_angle + 0.012, angle);
      for (int k = 0; k < 3; ++k) image.at(x, y)[k] = static_cast<std::uint8_t>(std::clamp(colour[k], 0.0, 255.0));
    }
  }
  return image;
}

GltfMaterial material(const std::string& name, double red, double green, double blue, double roughness) {
  return {.name = name, .base_colour = {red, green, blue, 1}, .metallic = 0, .roughness = roughness};
}

}  // namespace

GltfMaterial head_material(const std::string& part_name) {
  const std::string name = lowered(part_name);
  if (contains(name, "skin")) {
    GltfMaterial skin = material("skin", 0.60, 0.375, 0.285, 0.5);
    skin.double_sided = true;  // the inside of the mouth is seen from within
    return skin;
  }
  if (contains(name, "lash")) return material("hair", 0.035, 0.024, 0.018, 0.4);
  if (contains(name, "eye")) {
    GltfMaterial eye = material("eye", 1, 1, 1, 0.08);
    eye.base_colour_png = png_bytes(eye_texture());
    return eye;
  }
  if (contains(name, "gum")) return material("gum", 0.50, 0.185, 0.17, 0.3);
  if (contains(name, "tongue")) return material("tongue", 0.47, 0.17, 0.16, 0.38);
  if (contains(name, "teeth") || contains(name, "tooth")) return material("enamel", 0.80, 0.75, 0.63, 0.2);
  if (contains(name, "skull") || contains(name, "mandible") || contains(name, "vertebra") || contains(name, "bone")) {
    return material("bone", 0.66, 0.59, 0.46, 0.6);
  }
  return material("plain", 0.6, 0.6, 0.6, 0.5);
}

TriangleMesh with_eye_texture_coordinates(const TriangleMesh& eye, const Vector3d& centre) {
  TriangleMesh result = eye;
  result.UV.resize(eye.V.rows(), 2);
  for (Eigen::Index i = 0; i < eye.V.rows(); ++i) {
    const Vector3d d = (eye.V.row(i).transpose() - centre).normalized();
    const double angle = std::acos(std::clamp(d.z(), -1.0, 1.0));
    const double radius = std::min(angle / (pi / 2), 1.0) / 2;
    const double across = std::hypot(d.x(), d.y());
    result.UV.row(i) << 0.5, 0.5;
    if (across > 0) result.UV.row(i) += radius / across * Eigen::RowVector2d(d.x(), d.y());
  }
  result.FUV = eye.F;
  return result;
}

}  // namespace phiz
