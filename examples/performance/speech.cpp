// SPDX-License-Identifier: GPL-3.0-or-later
#include "speech.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace phiz::authoring {

namespace {

/// How a sound is made: its length, how firmly jaw and lips insist on its shape, and the shape. Names without a side
/// stand for both.
struct Articulation {
  double duration, jaw_dominance, lip_dominance;
  MouthShape shape;
};

const std::map<std::string, Articulation>& articulations() {
  static const std::map<std::string, Articulation> table = {
      {"_", {0.14, 0.6, 0.6, {}}},
      // Vowels: the jaw sets the opening.
      {"a", {0.13, 1.2, 0.8, {{"jawOpen", 0.50}, {"mouthLowerDown", 0.26}, {"mouthUpperUp", 0.16}}}},
      {"ae",
       {0.11, 1.2, 0.8, {{"jawOpen", 0.40}, {"mouthLowerDown", 0.30}, {"mouthUpperUp", 0.20}, {"mouthStretch", 0.22}}}},
      {"e",
       {0.10, 1.0, 0.8, {{"jawOpen", 0.30}, {"mouthLowerDown", 0.26}, {"mouthUpperUp", 0.16}, {"mouthStretch", 0.15}}}},
      {"i",
       {0.09,
        1.0,
        0.9,
        {{"jawOpen", 0.13},
         {"mouthLowerDown", 0.24},
         {"mouthUpperUp", 0.16},
         {"mouthStretch", 0.28},
         {"mouthSmile", 0.15}}}},
      {"uh", {0.07, 0.8, 0.5, {{"jawOpen", 0.24}, {"mouthLowerDown", 0.12}}}},
      {"o", {0.12, 1.1, 1.6, {{"jawOpen", 0.34}, {"mouthFunnel", 0.50}, {"mouthPucker", 0.25}}}},
      {"u", {0.11, 1.0, 1.8, {{"jawOpen", 0.13}, {"mouthFunnel", 0.30}, {"mouthPucker", 0.65}}}},
      // Consonants: closures and narrow gaps are not negotiable, the rest borrow their neighbours' shape.
      {"h", {0.06, 0.4, 0.3, {{"jawOpen", 0.22}, {"mouthLowerDown", 0.12}}}},
      {"l", {0.07, 0.7, 0.4, {{"jawOpen", 0.20}, {"mouthLowerDown", 0.20}, {"mouthUpperUp", 0.10}}}},
      {"d", {0.06, 1.2, 0.5, {{"jawOpen", 0.11}, {"mouthLowerDown", 0.22}, {"mouthUpperUp", 0.12}}}},
      {"n", {0.08, 1.0, 0.4, {{"jawOpen", 0.12}, {"mouthLowerDown", 0.18}, {"mouthUpperUp", 0.08}}}},
      {"m",
       {0.09,
        2.0,
        9.0,
        {{"jawOpen", 0.06},
         {"mouthClose", 0.08},
         {"mouthPress", 0.35},
         {"mouthRollLower", 0.14},
         {"mouthRollUpper", 0.10}}}},
      {"b",
       {0.08,
        2.0,
        9.0,
        {{"jawOpen", 0.07},
         {"mouthClose", 0.09},
         {"mouthPress", 0.45},
         {"mouthRollLower", 0.18},
         {"mouthRollUpper", 0.12}}}},
      {"f",
       {0.10,
        2.0,
        6.0,
        {{"jawOpen", 0.07}, {"mouthRollLower", 0.48}, {"mouthShrugLower", 0.20}, {"mouthUpperUp", 0.26}}}},
      {"v",
       {0.08,
        2.0,
        6.0,
        {{"jawOpen", 0.08}, {"mouthRollLower", 0.42}, {"mouthShrugLower", 0.18}, {"mouthUpperUp", 0.22}}}},
      {"sh",
       {0.12,
        2.0,
        4.0,
        {{"jawOpen", 0.07},
         {"mouthFunnel", 0.58},
         {"mouthPucker", 0.22},
         {"mouthUpperUp", 0.18},
         {"mouthLowerDown", 0.22}}}},
  };
  return table;
}

/// Pull of a sound at `time`: 1 during its middle, a Gaussian flank on either side that is wider for long sounds.
double presence(const Sound& sound, double time) {
  const double distance = std::abs(time - sound.start - 0.5 * sound.duration) - 0.2 * sound.duration;
  const double flank = 0.030 + 0.28 * sound.duration;
  const double u = std::max(distance, 0.0) / flank;
  return std::exp(-u * u);
}

void add_both_sides(MouthShape& mouth, const std::string& name, double weight) {
  static const std::set<std::string> paired = {"mouthSmile", "mouthStretch", "mouthPress", "mouthLowerDown",
                                               "mouthUpperUp"};
  if (paired.count(name) == 0) {
    mouth[name] += weight;
    return;
  }
  mouth[name + "Left"] += weight;
  mouth[name + "Right"] += 0.94 * weight;  // nobody speaks symmetrically
}

}  // namespace

std::vector<Sound> sentence(const std::vector<std::string>& symbols, double start, double tempo) {
  std::vector<Sound> sounds;
  for (const std::string& symbol : symbols) {
    const double duration = tempo * articulations().at(symbol).duration;
    sounds.push_back({symbol, start, duration});
    start += duration;
  }
  return sounds;
}

MouthShape mouth_at(const std::vector<Sound>& sounds, double time) {
  // Rest has a faint pull everywhere, so that the mouth settles when no sound is near.
  constexpr double rest = 0.02;
  double jaw_sum = rest;
  double lip_sum = rest;
  MouthShape unnormalised;
  for (const Sound& sound : sounds) {
    const Articulation& articulation = articulations().at(sound.symbol);
    const double jaw = articulation.jaw_dominance * presence(sound, time);
    const double lip = articulation.lip_dominance * presence(sound, time);
    jaw_sum += jaw;
    lip_sum += lip;
    for (const auto& [name, weight] : articulation.shape)
      unnormalised[name] += weight * (name == "jawOpen" ? jaw : lip);
  }
  MouthShape mouth;
  for (const auto& [name, weight] : unnormalised)
    add_both_sides(mouth, name, weight / (name == "jawOpen" ? jaw_sum : lip_sum));
  return mouth;
}

}  // namespace phiz::authoring
