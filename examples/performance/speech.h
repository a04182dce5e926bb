// SPDX-License-Identifier: GPL-3.0-or-later
/// A sentence as mouth shapes over time, with co-articulation by dominance functions (Cohen and Massaro 1993): each
/// sound pulls the mouth towards its own shape, strongest at its middle; neighbours share what lies between.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace phiz::authoring {

/// Weights of expressions, by name.
using MouthShape = std::map<std::string, double>;

/// One sound of the sentence: its shape and when it is spoken. Seconds.
struct Sound {
  std::string symbol;  ///< of the table in speech.cpp
  double start = 0, duration = 0.1;
};

/// Sounds one after another from `start`, each `tempo` times as long as the table says; "_" is a pause.
std::vector<Sound> sentence(const std::vector<std::string>& symbols, double start, double tempo);

/// The mouth at one instant of a sentence that begins and ends at rest.
MouthShape mouth_at(const std::vector<Sound>& sounds, double time);

}  // namespace phiz::authoring
