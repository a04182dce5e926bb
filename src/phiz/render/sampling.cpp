// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/render/sampling.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace phiz::detail {

namespace {

float fraction(double x) {
  return std::min(static_cast<float>(x - std::floor(x)), 0.99999994F);
}

constexpr double plastic1 = 0.7548776662466927, plastic2 = 0.5698402909980532, golden = 0.6180339887498949;

float hashed(int x, int y, int z) {
  std::uint32_t h = static_cast<std::uint32_t>(x) * 0x8da6b343U ^ static_cast<std::uint32_t>(y) * 0xd8163841U ^
                    static_cast<std::uint32_t>(z) * 0xcb1ab31fU;
  h ^= h >> 15;
  h *= 0x2c1b3c6dU;
  h ^= h >> 12;
  h *= 0x297a2d39U;
  h ^= h >> 15;
  return static_cast<float>(h & 0xffffffU) / 16777216.F - 0.5F;
}

/// Smooth value noise on the unit lattice, -0.5 to 0.5, and its gradient.
struct Noise {
  float value = 0;
  Eigen::Vector3f gradient = Eigen::Vector3f::Zero();
};

Noise noise_at(const Eigen::Vector3f& p) {
  const int x = static_cast<int>(std::floor(p.x())), y = static_cast<int>(std::floor(p.y())),
            z = static_cast<int>(std::floor(p.z()));
  const Eigen::Vector3f f(p.x() - static_cast<float>(x), p.y() - static_cast<float>(y), p.z() - static_cast<float>(z));
  const Eigen::Vector3f s = (f.array() * f.array() * (3 - 2 * f.array())).matrix();
  const Eigen::Vector3f ds = (6 * f.array() * (1 - f.array())).matrix();
  Noise noise;
  Eigen::Vector3f& g = noise.gradient;
  for (int corner = 0; corner < 8; ++corner) {
    const int dx = corner & 1, dy = (corner >> 1) & 1, dz = corner >> 2;
    const float value = hashed(x + dx, y + dy, z + dz);
    const float wx = dx != 0 ? s.x() : 1 - s.x(), wy = dy != 0 ? s.y() : 1 - s.y(), wz = dz != 0 ? s.z() : 1 - s.z();
    noise.value += value * wx * wy * wz;
    g.x() += value * (dx != 0 ? ds.x() : -ds.x()) * wy * wz;
    g.y() += value * (dy != 0 ? ds.y() : -ds.y()) * wx * wz;
    g.z() += value * (dz != 0 ? ds.z() : -ds.z()) * wx * wy;
  }
  return noise;
}

/// How much of a pattern of this cell size shows at a pixel's footprint.
float visible_share(float cell, float footprint) {
  return std::clamp(cell / std::max(footprint, 1e-12F) / 2 - 0.75F, 0.F, 1.F);
}

}  // namespace

Sample2 plane_sample(int j, int count, int pattern) {
  // 16 neighbours deal the first 16 * count points out among them; each block of 16 shifts the set within its spacing.
  const double i = 16.0 * j + (pattern & 15) + 0.5;
  const int block = pattern >> 4;
  const double spacing = 0.25 / std::sqrt(static_cast<double>(count));
  return {fraction(i * plastic1 + spacing * ((block & 3) - 1.5) / 4),
          fraction(i * plastic2 + spacing * ((block >> 2) - 1.5) / 4)};
}

float line_sample(int j, int count, int pattern) {
  return fraction((16.0 * j + (pattern & 15) + 0.5) * golden + (pattern >> 4) / (256.0 * count));
}

int pixel_pattern(int x, int y) {
  // A magic arrangement: rows, columns and 2 x 2 blocks hold well-spread values.
  static constexpr int order[16] = {0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5};
  return order[(y & 3) * 4 + (x & 3)] + 16 * order[(y >> 2 & 3) * 4 + (x >> 2 & 3)];
}

std::vector<Sample2> lens_offsets(int count) {
  const auto tent = [](double u) {
    return static_cast<float>(u < 0.5 ? std::sqrt(2 * u) - 1 : 1 - std::sqrt(2 * (1 - u)));
  };
  std::vector<Sample2> offsets(static_cast<std::size_t>(count));
  Sample2 mean;
  for (int j = 0; j < count; ++j) {
    offsets[j] = {tent((j + 0.5) / count), tent(fraction((j + 0.5) * golden))};
    mean.x += offsets[j].x / static_cast<float>(count);
    mean.y += offsets[j].y / static_cast<float>(count);
  }
  for (Sample2& o : offsets) o = {o.x - mean.x, o.y - mean.y};
  return offsets;
}

Eigen::Vector3f grain_slope(const Eigen::Vector3f& rest, float strength, float size, float footprint) {
  Eigen::Vector3f bump = Eigen::Vector3f::Zero();
  float cell = 0.0022F * size;
  float weight = 0.055F * strength;
  for (int octave = 0; octave < 2; ++octave) {
    const float fade = visible_share(cell, footprint);
    if (fade > 0) bump += weight * fade * noise_at(rest / cell).gradient;
    cell *= 0.46F;
    weight *= 0.9F;
  }
  return bump;
}

Streak fibre_streak(const Eigen::Vector3f& rest, const Eigen::Vector3f& fibre, float size, float footprint) {
  // Noise averaged along the fibre (line integral convolution, Cabral and Leedom 1993), in two widths: fascicles and
  // the bundles within.
  Streak streak;
  constexpr int taps = 14;
  const float cells[2] = {0.0030F * size, 0.0012F * size}, steps[2] = {0.55F, 0.85F}, weights[2] = {2.4F, 2.0F};
  for (int octave = 0; octave < 2; ++octave) {
    const float cell = cells[octave], fade = visible_share(1.6F * cell, footprint) * weights[octave];
    if (fade <= 0) continue;
    Noise sum;
    for (int k = 0; k < taps; ++k) {
      const float along = steps[octave] * (static_cast<float>(k) - 0.5F * (taps - 1));
      const Noise noise = noise_at(rest / cell + along * fibre);
      sum.value += noise.value / taps;
      sum.gradient += noise.gradient / taps;
    }
    streak.light += fade * sum.value;
    streak.slope += fade * (sum.gradient - fibre * fibre.dot(sum.gradient));
  }
  return streak;
}

}  // namespace phiz::detail
