// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "phiz/anatomy/skin_form.h"

namespace phiz {
namespace {

struct Place {
  int i, j;
  double x, y, z;  // millimetres
};

// Rows from the neck upwards, in each from the midline outwards. Midline points are those of Proportions.
constexpr Place places[] = {
    // Under the chin.
    {0, 3, 0, -97, 27},
    {3, 3, 17, -97, 23},
    {6, 3, 33, -95, 9},
    {8, 3, 40, -92, -3},
    {10, 3, 44.5, -88, -16},
    {12, 3, 47, -84, -34},
    {14, 3, 42, -90, -66},
    {16, 3, 0, -96, -86},
    {0, 4, 0, -87.5, 50},
    {3, 4, 16, -87, 47},
    {6, 4, 30, -84, 35},
    {8, 4, 38.5, -79.5, 21},
    {10, 4, 44.5, -72.5, 4},
    {12, 4, 48.5, -62, -22},
    {14, 4, 45, -70, -58},
    {16, 4, 0, -73, -85.5},
    // Edge of the jaw.
    {0, 5, 0, -82, 67},
    {2, 5, 8, -82, 66.5},
    {4, 5, 17, -80.5, 63},
    {6, 5, 26, -77.5, 57},
    {7, 5, 32.5, -74.5, 50},
    {8, 5, 38.5, -71, 41},
    {9, 5, 44, -67, 31},
    {10, 5, 49, -61.5, 20},
    {11, 5, 53.5, -52.5, 5},
    {12, 5, 57, -44, -13},
    {14, 5, 52.5, -52, -48},
    {15, 5, 38, -50, -71},
    {16, 5, 0, -51, -87},
    // Chin.
    {0, 6, 0, -69, 80},
    {2, 6, 8, -69.3, 79},
    {4, 6, 17, -69, 74.6},
    {6, 6, 27, -67, 67.5},
    {7, 6, 34.5, -64.7, 60.5},
    {8, 6, 41.5, -61.7, 50},
    {9, 6, 47.5, -58, 38.5},
    {10, 6, 52, -53.5, 25.5},
    {11, 6, 56, -46, 10},
    {12, 6, 59, -39, -9},
    {14, 6, 56.5, -44, -44},
    {16, 6, 0, -34, -89.5},
    // Beside the mouth.
    {0, 7, 0, -56, 78.6},
    {1, 7, 3.1, -56.3, 78.6},
    {2, 7, 6.3, -56.7, 78.4},
    {3, 7, 9.8, -57.2, 77.9},
    {4, 7, 13.6, -57.8, 76.9},
    {5, 7, 17.8, -58.4, 75.3},
    {6, 7, 23, -58.5, 72.8},
    {7, 7, 33, -56.5, 66.5},
    {8, 7, 41.3, -54.2, 56.5},
    {9, 7, 47.8, -51.3, 44.5},
    {10, 7, 53, -47, 30},
    {11, 7, 57.2, -40.5, 12},
    {14, 7, 59, -39, -42},
    {16, 7, 0, -21, -92.5},
    {6, 8, 32, -50, 70.4},
    {7, 8, 39, -48, 65.4},
    {8, 8, 45.3, -46.3, 57},
    {9, 8, 50.7, -44, 46},
    {10, 8, 55.2, -40, 31.5},
    {11, 8, 58.7, -34, 13.5},
    {12, 8, 62.5, -31, -9},
    {14, 8, 61, -33, -39},
    {16, 8, 0, -10, -96},
    {6, 9, 36.2, -37.5, 70.3},
    {7, 9, 42, -37, 65.2},
    {8, 9, 47.8, -36.3, 58},
    {9, 9, 52.7, -35, 48},
    {10, 9, 56.8, -32, 34},
    {11, 9, 59.8, -27, 15.5},
    {14, 9, 63, -27, -36},
    {16, 9, 0, -1, -98.5},
    {6, 10, 30.2, -25, 73.3},
    {7, 10, 37, -25.5, 68.8},
    {8, 10, 43.8, -26, 62.8},
    {9, 10, 50, -26, 53.5},
    {10, 10, 55.7, -24.3, 38.5},
    {11, 10, 60.5, -20.5, 18},
    {14, 10, 64, -20, -33},
    {16, 10, 0, 8, -101.5},
    // Under the nose, out over the cheek.
    {0, 11, 0, -13, 84},
    {1, 11, 4.2, -13.7, 83.3},
    {2, 11, 8.5, -14.4, 80.8},
    {3, 11, 11.5, -14.3, 79},
    {4, 11, 14.6, -14.6, 77},
    {5, 11, 17.6, -15, 75},
    {6, 11, 20.8, -15.8, 72.6},
    {7, 11, 29, -15.8, 71.2},
    {8, 11, 38, -17.5, 66.4},
    {9, 11, 47, -18.3, 57.8},
    {10, 11, 55, -17, 43},
    {11, 11, 61.5, -15, 20.5},
    {15, 11, 49, 3, -82},
    {16, 11, 0, 17, -104.3},
    {0, 12, 0, -12.3, 88.3},
    {1, 12, 4, -12.8, 85},
    {2, 12, 7.8, -13.1, 81.8},
    {3, 12, 11.8, -12.4, 80.3},
    {4, 12, 14.8, -11.6, 79},
    {5, 12, 17.4, -11.2, 75.8},
    {6, 12, 19.3, -11.5, 70.2},
    {7, 12, 25, -12, 71.2},
    {8, 12, 37, -13.8, 67},
    {9, 12, 46.4, -14.3, 59},
    {10, 12, 55, -12.3, 45},
    {11, 12, 62.5, -10.5, 22.5},
    {16, 12, 0, 28, -107},
    {0, 13, 0, -10.8, 92.8},
    {1, 13, 2.9, -11.4, 89.3},
    {3, 13, 12.9, -10, 85},
    {4, 13, 16.8, -8.8, 82.4},
    {5, 13, 18.9, -7.2, 77.4},
    {6, 13, 19.4, -7.5, 69},
    {7, 13, 24.5, -8.5, 70.6},
    {8, 13, 36.4, -10.2, 67.5},
    {9, 13, 45.8, -10.4, 60.2},
    {10, 13, 55, -8, 47},
    {11, 13, 63.4, -6.5, 24},
    {15, 13, 55.5, 25, -82},
    {16, 13, 0, 40, -109.3},
    {0, 14, 0, -8, 97},
    {1, 14, 3.4, -9.4, 94},
    {2, 14, 6.6, -8.4, 92.4},
    {3, 14, 11, -7.6, 89.8},
    {4, 14, 15.7, -4.8, 85.7},
    {5, 14, 18.8, -3.4, 78.9},
    {6, 14, 19.4, -3.2, 68.8},
    {7, 14, 24.3, -5, 70.6},
    {8, 14, 35.8, -6.5, 68},
    {9, 14, 45.2, -6.3, 61.5},
    {10, 14, 54.8, -3.5, 49},
    {11, 14, 64, -2.5, 25},
    {0, 15, 0, 0, 99},
    {1, 15, 4.2, -0.3, 98},
    {2, 15, 8, -0.3, 95},
    {3, 15, 11, 0, 89.5},
    {4, 15, 13.6, 1.4, 83.6},
    {5, 15, 16.2, 2, 77.2},
    {6, 15, 19, 1.2, 69},
    {7, 15, 24, -0.5, 70.2},
    {8, 15, 35, -2.5, 68.5},
    {9, 15, 44.3, -2, 62.9},
    {10, 15, 54.2, 1.5, 51},
    {11, 15, 64.6, 1.5, 24},
    {0, 16, 0, 6.5, 94},
    {1, 16, 4, 6.2, 92.8},
    {2, 16, 7.6, 6, 88.8},
    {3, 16, 10.6, 6, 84.2},
    {4, 16, 12.8, 6, 79},
    {5, 16, 15.6, 6, 74.3},
    {6, 16, 18.8, 5.6, 69.6},
    {7, 16, 26, 3, 69.5},
    {8, 16, 33.8, 1.5, 68.4},
    {9, 16, 43, 2.5, 63.5},
    {10, 16, 54.3, 5.5, 50.5},
    {11, 16, 65.3, 6, 22},
    {0, 17, 0, 13.5, 88.3},
    {1, 17, 3.8, 13.3, 87},
    {2, 17, 7, 13, 83.2},
    {3, 17, 9.8, 12.8, 78.6},
    {4, 17, 12.6, 12.4, 74},
    {5, 17, 15.6, 12, 70},
    {6, 17, 19, 11, 67.6},
    {7, 17, 25, 8, 68.2},
    {8, 17, 32.5, 6, 67.4},
    {9, 17, 41.5, 7.5, 63},
    {10, 17, 53.5, 9.5, 50},
    {11, 17, 65.5, 11, 20},
    // Bridge of the nose and round the eye.
    {0, 18, 0, 20, 83},
    {1, 18, 3.7, 19.8, 81.7},
    {2, 18, 6.5, 19.5, 78},
    {3, 18, 9, 19.2, 73.8},
    {4, 18, 11.6, 18.8, 70},
    {5, 18, 14.5, 17.8, 67.4},
    {6, 18, 18.5, 15.5, 65.6},
    {7, 18, 24.8, 12, 66},
    {8, 18, 32, 10, 65.2},
    {9, 18, 40.5, 11.5, 60.8},
    {10, 18, 52, 14, 49},
    {11, 18, 65.7, 17, 18},
    {0, 19, 0, 25.3, 78.6},
    {1, 19, 3.6, 25, 77.3},
    {2, 19, 6.2, 24.8, 74.2},
    {3, 19, 8.4, 24.4, 70.6},
    {4, 19, 10.4, 23.8, 67.6},
    {5, 19, 12.4, 22.8, 65.6},
    {6, 19, 15, 20.5, 63.8},
    {10, 19, 56, 20.5, 43.5},
    {11, 19, 66, 23.5, 15},
    {0, 20, 0, 30.5, 74.4},
    {1, 20, 3.6, 30.3, 73.3},
    {2, 20, 6, 30, 71},
    {3, 20, 8, 29.5, 68.4},
    {4, 20, 9.7, 28.8, 66.4},
    {5, 20, 11.2, 28, 64.9},
    {6, 20, 12.8, 26.6, 63.4},
    {10, 20, 57.5, 27.5, 40.5},
    {11, 20, 67.3, 31, 11},
    {15, 20, 56.5, 37, -82},
    {16, 20, 0, 52, -111.8},
    {0, 21, 0, 36, 71.2},
    {1, 21, 3.8, 36, 70.8},
    {2, 21, 6.4, 36, 69.6},
    {3, 21, 8.6, 35.8, 68.2},
    {4, 21, 10.4, 35.4, 67},
    {5, 21, 12, 34.8, 66.2},
    {6, 21, 13.8, 33.8, 65.4},
    {10, 21, 57, 34.8, 43},
    {11, 21, 69.5, 39, 8},
    {12, 21, 74, 36, -33},
    {14, 21, 70.5, 25, -46},
    {16, 21, 0, 63, -111.2},
    // Brow.
    {0, 22, 0, 42.5, 72.4},
    {1, 22, 4, 42.6, 72.3},
    {2, 22, 7.4, 42.6, 71.9},
    {3, 22, 10.4, 42.6, 71.2},
    {4, 22, 13, 42.4, 70.4},
    {5, 22, 15.4, 42, 69.7},
    {6, 22, 18, 41.4, 68.8},
    {7, 22, 24.5, 44.2, 68.8},
    {8, 22, 32.3, 45.6, 67.2},
    {9, 22, 41.5, 44.6, 62.6},
    {10, 22, 54.5, 42, 49},
    {11, 22, 71.3, 47.5, 6},
    {12, 22, 75, 50, -31},
    {16, 22, 0, 75, -110},
    {13, 21, 73.8, 33, -41.5},
    {13, 22, 75, 48, -44},
    {14, 22, 69, 40, -56},
    {15, 12, 53, 14, -82},
    {15, 21, 58.5, 50, -82},
    {15, 22, 59, 63, -82},
    {15, 10, 47, -6, -82},
    {15, 8, 46, -20, -80},
    {15, 6, 42, -38, -74},
    // Forehead and vault.
    {0, 23, 0, 51, 74},
    {2, 23, 7.5, 52, 74},
    {4, 23, 16, 54, 73.4},
    {6, 23, 25.5, 56, 71.2},
    {8, 23, 41.5, 56.5, 63.5},
    {9, 23, 50.5, 55, 56},
    {10, 23, 59.5, 53.5, 44},
    {11, 23, 73, 58, 4},
    {12, 23, 76, 65, -26.5},
    {13, 23, 75, 69, -38},
    {14, 23, 71.5, 64, -58},
    {15, 23, 46, 81, -89},
    {16, 23, 0, 87, -104.5},
    {0, 24, 0, 70, 73},
    {2, 24, 10, 70.5, 72.5},
    {4, 24, 20.5, 71, 70},
    {6, 24, 31, 71.5, 66},
    {8, 24, 46, 71.5, 56.5},
    {9, 24, 54, 71, 47.5},
    {10, 24, 61.5, 71, 37},
    {11, 24, 71, 76, 9},
    {12, 24, 75, 82, -25},
    {13, 24, 73, 86, -41},
    {14, 24, 67, 91, -58},
    {15, 24, 42, 96, -84},
    {16, 24, 0, 99, -96},
    {0, 25, 0, 96, 66},
    {2, 25, 10, 96, 65},
    {4, 25, 20.5, 96, 62},
    {6, 25, 31, 96, 57},
    {8, 25, 45, 95.5, 46},
    {9, 25, 52.5, 95.5, 36},
    {10, 25, 59, 95.5, 25},
    {11, 25, 68, 98, 1},
    {12, 25, 71, 101, -25},
    {13, 25, 67, 104.5, -41},
    {14, 25, 59, 107.5, -56},
    {15, 25, 35, 110, -76},
    {16, 25, 0, 111, -85},
    {0, 26, 0, 118.5, 50},
    {2, 26, 9, 118.5, 49},
    {4, 26, 18.5, 118, 45.5},
    {6, 26, 28, 117.5, 40},
    {8, 26, 41, 116.5, 29},
    {9, 26, 47.5, 116.5, 20},
    {10, 26, 53, 116.5, 8},
    {11, 26, 59, 117, -8},
    {12, 26, 60, 118.5, -25},
    {13, 26, 55, 120.5, -41},
    {14, 26, 46, 121.5, -54},
    {15, 26, 26, 122.5, -66},
    {16, 26, 0, 123, -71},
};

/// The neck is an upright oval column: its sections at the lowest rows, millimetres.
struct NeckSection {
  int j;
  double y, half_width, half_depth, centre_z;
  double muscle_angle;  // of the ridge of the sternocleidomastoid, degrees from the front
  double larynx;        // how far the larynx stands out
};
constexpr NeckSection neck_sections[] = {
    {0, -170, 52, 47, -45, 26, 0.5}, {1, -146, 49, 46.5, -41, 42, 1.5}, {2, -121, 47.5, 47.5, -37.5, 62, 3.2}};
constexpr double neck_angles[SkinTopology::columns + 1] = {0,  9,  18,  27,  36,  46,  56,  66, 76,
                                                           86, 96, 106, 117, 129, 142, 161, 180};

/// The vault of the skull: a superellipsoid, deeper behind than in front.
struct Vault {
  Vector3d centre{0, 66, -22};
  double half_width = 76, height = 74, depth = 105, front = 95.5, back = 88.5, exponent = 2.25;

  double level(const Vector3d& d) const {
    return std::pow(std::abs(d.x()) / half_width, exponent) +
           std::pow(std::abs(d.y()) / (d.y() > 0 ? height : depth), exponent) +
           std::pow(std::abs(d.z()) / (d.z() > 0 ? front : back), exponent);
  }
  /// The point of the vault in the direction of p from the centre.
  Vector3d under(const Vector3d& p) const {
    const Vector3d d = p - centre;
    return centre + d * std::pow(level(d), -1 / exponent);
  }
  /// Height of the vault over (x, z).
  double top(double x, double z) const {
    const double rest = 1 - level({x, 0, z - centre.z()});
    return centre.y() + height * std::pow(std::max(rest, 0.0), 1 / exponent);
  }
};

/// Point (u, v) of the Coons patch that fills a grid 0..p x 0..q between its border and the midline u = 0.
Vector3d coons(const SkinForm& form, const std::function<int(int, int)>& vertex, int u, int p, int v, int q) {
  const auto at = [&](int a, int b) { return form.at(vertex(a, b)); };
  const double s = static_cast<double>(u) / p, t = static_cast<double>(v) / q;
  const Vector3d midline = (1 - t) * at(0, 0) + t * at(0, q);
  const Vector3d corners =
      (1 - s) * (1 - t) * at(0, 0) + s * (1 - t) * at(p, 0) + (1 - s) * t * at(0, q) + s * t * at(p, q);
  return (1 - s) * midline + s * at(p, v) + (1 - t) * at(u, 0) + t * at(u, q) - corners;
}

/// Lays the scalp on the vault, and the grid that closes the crown.
void place_vault(SkinForm& form) {
  const SkinTopology& topology = skin_topology();
  const Vault vault;
  for (int j = 11; j <= SkinTopology::rows; ++j)
    for (int i = j < 20 ? 15 : j < 23 ? 14 : j == 23 ? 12 : 0; i <= SkinTopology::columns; ++i) {
      const int v = topology.sheet(i, j);
      if (v < 0 || !form.placed(v) || (i == 14 && j == 20)) continue;
      const double share = j == 24 && i < 12 ? 0.5 : 1.0;  // the forehead keeps some of its own form
      form.place(v, form.at(v) + share * (vault.under(form.at(v)) - form.at(v)),
                 j < 23 && i < 16          ? 0.15
                 : j == SkinTopology::rows ? 0.08
                                           : 0.5);
    }
  for (int u = 0; u < 4; ++u)
    for (int v = 1; v < 8; ++v) {
      const Vector3d p = coons(
          form, [&](int a, int b) { return topology.crown(a, b); }, u, 4, v, 8);
      form.place(topology.crown(u, v), {p.x(), vault.top(p.x(), p.z()), p.z()}, 0.08);
    }
}

/// How firmly the surface keeps to the places: firm in the face, loose on the sides where they are few.
double firmness(int i, int j) {
  if (i == SkinTopology::columns || j > 21) return 0.3;
  if (i == 11 && j > 4 && j < 9) return 0.15;  // angle of the jaw
  if (i > 10) return 0.02;
  if (i == 10 && j > 17) return 0.1;
  return i > 6 ? 0.15 : 1.0;
}

/// Fills the gaps between the places of each row by a cubic curve (Catmull-Rom over the column number).
void fill_rows(SkinForm& form) {
  const SkinTopology& topology = skin_topology();
  for (int j = 3; j <= SkinTopology::rows; ++j) {
    std::vector<int> known;
    for (int i = 0; i <= SkinTopology::columns; ++i)
      if (topology.sheet(i, j) >= 0 && form.placed(topology.sheet(i, j))) known.push_back(i);
    const auto at = [&](int i) { return form.at(topology.sheet(i, j)); };
    const int last = static_cast<int>(known.size()) - 1;
    const auto slope = [&](int k) -> Vector3d {
      const int a = known[std::max(k - 1, 0)], b = known[std::min(k + 1, last)];
      if (known[k] == 0 || known[k] == SkinTopology::columns) {  // crosses the midline at a right angle
        const Vector3d d = (at(b) - at(a)) / (b - a);
        return {d.x(), 0, 0};
      }
      return (at(b) - at(a)) / (b - a);
    };
    for (int k = 0; k < last; ++k) {
      const int a = known[k], b = known[k + 1];
      const Vector3d pa = at(a), pb = at(b), sa = slope(k), sb = slope(k + 1);
      for (int i = a + 1; i < b; ++i) {
        const int v = topology.sheet(i, j);
        if (v < 0) break;
        const double t = static_cast<double>(i - a) / (b - a), h = b - a;
        const double t2 = t * t, t3 = t2 * t;
        form.place(
            v, (2 * t3 - 3 * t2 + 1) * pa + (t3 - 2 * t2 + t) * h * sa + (3 * t2 - 2 * t3) * pb + (t3 - t2) * h * sb,
            0.3 * firmness(i, j));
      }
    }
  }
}

}  // namespace

void place_sheet(SkinForm& form) {
  const SkinTopology& topology = skin_topology();
  for (const NeckSection& section : neck_sections)
    for (int i = 0; i <= SkinTopology::columns; ++i) {
      const double angle = neck_angles[i] * std::numbers::pi / 180;
      const auto ridge = [&](double at, double width) { return std::exp(-std::pow((neck_angles[i] - at) / width, 2)); };
      const double muscle = 2.2 * ridge(section.muscle_angle, 11) - 1.6 * ridge(section.muscle_angle - 24, 12);
      const double larynx = section.larynx * ridge(0, 12);
      const double swell = 1 + (muscle + larynx) / section.half_depth;
      form.place(topology.sheet(i, section.j), {swell * section.half_width * std::sin(angle), section.y,
                                                section.centre_z + swell * section.half_depth * std::cos(angle)});
    }
  for (const Place& p : places) form.place(topology.sheet(p.i, p.j), {p.x, p.y, p.z}, firmness(p.i, p.j));
  fill_rows(form);
  place_vault(form);
  for (int u = 0; u <= 6; ++u)
    for (int v = 0; v <= 4; ++v) {
      form.keep_control(topology.foot(u, v));
    }
  for (int u = 0; u < 6; ++u)
    for (int v = 1; v < 4; ++v) {
      Vector3d p = coons(
          form, [&](int a, int b) { return topology.foot(a, b); }, u, 6, v, 4);
      p.y() = neck_sections[0].y;
      form.place(topology.foot(u, v), p);
    }
  place_vault(form);
  for (int u = 0; u <= 6; ++u)
    for (int v = 0; v <= 4; ++v) {
      form.keep_control(topology.foot(u, v));
    }
  for (int u = 0; u < 6; ++u)
    for (int v = 1; v < 4; ++v) {
      const double angle = std::numbers::pi * v / 4, across = u / 6.0;
      const NeckSection& section = neck_sections[0];
      form.place(topology.foot(u, v), {section.half_width * across * (0.6 + 0.4 * std::sin(angle)), section.y,
                                       section.centre_z + section.half_depth * (1 - 0.3 * across) * std::cos(angle)});
    }
}

}  // namespace phiz
