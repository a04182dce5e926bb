// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/builtin/skin/regions.h"

#include <algorithm>
#include <array>
#include <functional>
#include <set>

#include "phiz/anatomy/builtin/skin/topology.h"

namespace phiz {
namespace {

VectorXi to_vector(const std::vector<int>& values) {
  return Eigen::Map<const VectorXi>(values.data(), static_cast<Eigen::Index>(values.size()));
}

/// Collects left-half vertices; adds their mirror images where the region spans both halves.
class RegionSet {
 public:
  explicit RegionSet(const SkinTopology& topology) : topology_(topology) {}
  void add(int v) {
    if (v >= 0) left_.insert(v);
  }
  void sheet(int i0, int i1, int j0, int j1) {
    for (int i = i0; i <= i1; ++i)
      for (int j = j0; j <= j1; ++j) add(topology_.sheet(i, j));
  }
  void mouth(int r0, int r1, int c0, int c1) {
    for (int r = r0; r <= r1; ++r)
      for (int c = c0; c <= c1; ++c) add(topology_.mouth(r, c));
  }
  void eye(int r0, int r1, int c0, int c1) {
    for (int r = r0; r <= r1; ++r)
      for (int c = c0; c <= c1; ++c) add(topology_.eye(r, c));
  }
  VectorXi left() const { return to_vector({left_.begin(), left_.end()}); }
  VectorXi right() const {
    std::vector<int> side;
    for (int v : left_) side.push_back(topology_.mirror(v));
    std::sort(side.begin(), side.end());
    return to_vector(side);
  }
  VectorXi both() const {
    std::set<int> all(left_);
    for (int v : left_) all.insert(topology_.mirror(v));
    return to_vector({all.begin(), all.end()});
  }

 private:
  const SkinTopology& topology_;
  std::set<int> left_;
};

}  // namespace

SkinRegions skin_regions() {
  const SkinTopology& t = skin_topology();
  SkinRegions regions;
  const auto both = [&](const char* name, const std::function<void(RegionSet&)>& fill) {
    RegionSet set(t);
    fill(set);
    regions[name] = set.both();
  };
  const auto pair = [&](const char* name, const std::function<void(RegionSet&)>& fill) {
    RegionSet set(t);
    fill(set);
    regions[std::string("left") + name] = set.left();
    regions[std::string("right") + name] = set.right();
  };
  both("upperLip", [](RegionSet& s) { s.mouth(3, 8, 0, 8); });
  both("lowerLip", [](RegionSet& s) { s.mouth(3, 8, 8, 16); });
  both("upperLipInner", [](RegionSet& s) { s.mouth(7, 9, 0, 7); });
  both("lowerLipInner", [](RegionSet& s) { s.mouth(7, 9, 9, 16); });
  both("mouthBag", [&](RegionSet& s) {
    s.mouth(8, SkinTopology::mouth_rings, 0, 16);
    for (int u = 0; u <= 7; ++u) s.add(t.throat(u, 1));
  });
  both("oralRoof", [](RegionSet& s) { s.mouth(9, SkinTopology::mouth_rings, 0, 5); });
  both("oralFloor", [](RegionSet& s) { s.mouth(9, SkinTopology::mouth_rings, 11, 16); });
  both("nose", [&](RegionSet& s) {
    s.sheet(0, 5, 12, 18);
    s.sheet(0, 4, 19, 20);
  });
  both("scalp", [&](RegionSet& s) {
    s.sheet(0, 18, 25, 26);
    s.sheet(11, 18, 22, 24);
    s.sheet(13, 18, 11, 21);
    s.sheet(14, 18, 8, 10);
    for (int u = 0; u <= 4; ++u)
      for (int v = 0; v <= SkinTopology::crown_rows; ++v) s.add(t.crown(u, v));
  });
  both("forehead", [](RegionSet& s) { s.sheet(0, 10, 23, 25); });
  both("chin", [](RegionSet& s) { s.sheet(0, 5, 5, 7); });
  both("neck", [](RegionSet& s) {
    s.sheet(0, 18, 0, 4);
    s.sheet(13, 18, 5, 7);
  });
  both("neckCap", [&](RegionSet& s) {
    s.sheet(0, 18, 0, 0);
    for (int u = 0; u <= SkinTopology::foot_columns; ++u)
      for (int v = 0; v <= SkinTopology::foot_rows; ++v) s.add(t.foot(u, v));
  });
  both("jawLine", [](RegionSet& s) { s.sheet(0, 12, 5, 5); });
  pair("UpperLid", [](RegionSet& s) { s.eye(3, 6, 0, 8); });
  pair("LowerLid", [&](RegionSet& s) {
    s.eye(3, 6, 8, 15);
    s.eye(3, 6, 0, 0);
  });
  pair("UpperLidMargin", [](RegionSet& s) { s.eye(5, 6, 1, 7); });
  pair("LowerLidMargin", [](RegionSet& s) { s.eye(5, 6, 9, 15); });
  pair("Socket", [&](RegionSet& s) {
    s.eye(6, 9, 0, 15);
    for (int u = 1; u < 4; ++u)
      for (int v = 1; v < 4; ++v) s.add(t.socket(u, v));
  });
  pair("Nostril", [&](RegionSet& s) {
    for (int r = 0; r <= SkinTopology::nostril_rings; ++r)
      for (int c = 0; c < SkinTopology::nostril_columns; ++c) s.add(t.nostril(r, c));
    s.add(t.nostril_end());
  });
  pair("Ear", [&](RegionSet& s) {
    for (int r = 0; r <= SkinTopology::ear_rings; ++r)
      for (int c = 0; c < SkinTopology::ear_columns; ++c) s.add(t.ear(r, c));
    for (int u = 1; u < 4; ++u)
      for (int v = 1; v < 4; ++v) s.add(t.concha(u, v));
  });
  pair("Brow", [&](RegionSet& s) {
    s.sheet(3, 10, 22, 22);
    s.sheet(3, 10, 23, 23);
    s.eye(1, 1, 2, 6);
  });
  pair("Cheek", [](RegionSet& s) { s.sheet(7, 11, 8, 17); });

  const auto loop = [&](const char* name, const std::vector<int>& path) { regions[name] = to_vector(path); };
  std::vector<int> upper, lower;
  for (int c = 8; c > 0; --c) {
    upper.push_back(t.mirror(t.mouth(6, c)));
    lower.push_back(t.mirror(t.mouth(6, 16 - c)));
  }
  for (int c = 0; c <= 8; ++c) {
    upper.push_back(t.mouth(6, c));
    lower.push_back(t.mouth(6, 16 - c));
  }
  loop("loop:upperLipLine", upper);
  loop("loop:lowerLipLine", lower);
  std::vector<int> lids[4];
  for (int c = 0; c <= 8; ++c) {
    lids[0].push_back(t.eye(5, c));
    lids[1].push_back(t.eye(5, 16 - c));
    lids[2].push_back(t.mirror(t.eye(5, c)));
    lids[3].push_back(t.mirror(t.eye(5, 16 - c)));
  }
  loop("loop:leftUpperLidMargin", lids[0]);
  loop("loop:leftLowerLidMargin", lids[1]);
  loop("loop:rightUpperLidMargin", lids[2]);
  loop("loop:rightLowerLidMargin", lids[3]);
  return regions;
}

std::vector<Landmark> skin_landmarks() {
  const SkinTopology& t = skin_topology();
  std::vector<Landmark> landmarks;
  const auto add = [&](const std::string& name, int v) { landmarks.push_back({name, v}); };
  const auto left = [&](int number, int v) { add(std::to_string(number), v); };
  const auto pair = [&](int left_number, int right_number, int v) {
    left(left_number, v);
    left(right_number, t.mirror(v));
  };
  // 0..16 jaw from the right ear to the left one.
  constexpr std::array<std::array<int, 2>, 8> jaw{
      {{3, 5}, {6, 5}, {8, 5}, {10, 5}, {11, 6}, {12, 8}, {12, 10}, {12, 13}}};
  left(8, t.sheet(0, 5));
  for (int k = 0; k < 8; ++k) pair(9 + k, 7 - k, t.sheet(jaw[k][0], jaw[k][1]));
  // 17..26 brows.
  for (int k = 0; k < 5; ++k) pair(22 + k, 21 - k, t.sheet(6 + k, 22));
  // 27..35 nose.
  left(27, t.sheet(0, 20));
  left(28, t.sheet(0, 18));
  left(29, t.sheet(0, 17));
  left(30, t.sheet(0, 15));
  left(33, t.sheet(0, 11));
  pair(34, 32, t.sheet(2, 11));
  pair(35, 31, t.sheet(4, 12));
  // 36..47 eyes.
  pair(42, 39, t.eye(5, 0));
  pair(43, 38, t.eye(5, 3));
  pair(44, 37, t.eye(5, 6));
  pair(45, 36, t.eye(5, 8));
  pair(46, 41, t.eye(5, 11));
  pair(47, 40, t.eye(5, 13));
  // 48..59 outer and 60..67 inner lips.
  pair(54, 48, t.mouth(5, 8));
  pair(53, 49, t.mouth(3, 5));
  pair(52, 50, t.mouth(3, 2));
  left(51, t.mouth(3, 0));
  pair(55, 59, t.mouth(3, 11));
  pair(56, 58, t.mouth(3, 14));
  left(57, t.mouth(3, 16));
  pair(64, 60, t.mouth(6, 8));
  pair(63, 61, t.mouth(6, 3));
  left(62, t.mouth(6, 0));
  pair(65, 67, t.mouth(6, 13));
  left(66, t.mouth(6, 16));
  std::sort(landmarks.begin(), landmarks.end(),
            [](const Landmark& a, const Landmark& b) { return std::stoi(a.name) < std::stoi(b.name); });

  add("vertex", t.crown(0, SkinTopology::crown_rows / 2));
  add("opisthocranion", t.sheet(SkinTopology::columns, 13));
  add("trichion", t.sheet(0, 25));
  add("glabella", t.sheet(0, 23));
  add("nasion", t.sheet(0, 21));
  add("pronasale", t.sheet(0, 15));
  add("subnasale", t.sheet(0, 11));
  add("labraleSuperius", t.mouth(3, 0));
  add("labraleInferius", t.mouth(3, 16));
  add("sublabiale", t.sheet(0, 7));
  add("pogonion", t.sheet(0, 6));
  add("menton", t.sheet(0, 5));
  const auto sides = [&](const std::string& name, int v) {
    add("left" + name, v);
    add("right" + name, t.mirror(v));
  };
  sides("Endocanthion", t.eye(5, 0));
  sides("Exocanthion", t.eye(5, 8));
  sides("Alare", t.sheet(5, 14));
  sides("Cheilion", t.mouth(5, 8));
  sides("Zygion", t.sheet(11, 16));
  sides("Gonion", t.sheet(11, 5));
  sides("Tragion", t.ear(2, 4));
  sides("Euryon", t.sheet(12, 23));
  return landmarks;
}

}  // namespace phiz
