// SPDX-License-Identifier: GPL-3.0-or-later
/// What is known about the muscles of a head beside their shape: the 33 of expression (phace.md section 3) and the two
/// great closers of the jaw. Printed in docs/anatomy.md.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace phiz {

enum class MuscleForm { sheet, spindle, ring };

struct MuscleFacts {
  std::string_view stem;   ///< name in a head; paired ones have Left or Right behind
  std::string_view latin;  ///< for people, e.g. "musculus zygomaticus major"
  bool paired = true;
  bool expression = true;  ///< one of the 33; false: a closer of the jaw
  MuscleForm form = MuscleForm::sheet;
  bool origin_on_bone = true;    ///< false: it arises from fascia, aponeurosis or another muscle
  std::string_view units;        ///< FACS action units (Ekman, Friesen and Hager 2002) it takes part in
  std::string_view shapes;       ///< expressions it takes part in, without their side, separated by spaces
  std::string_view parts_left;   ///< concept ids of its parts in BodyParts3D, separated by spaces; empty: not there
  std::string_view parts_right;  ///< those of the right one; empty for unpaired muscles, which list all on the left
};

/// In the order of a head's muscles: pairs, then midline ones, then closers.
std::span<const MuscleFacts> muscle_table();

/// The facts of a head's muscle, e.g. "zygomaticusMajorLeft", or nullptr.
const MuscleFacts* find_muscle_facts(std::string_view muscle);

/// The names of the 33 muscles of expression, as heads use them.
std::vector<std::string> expression_muscle_names();

}  // namespace phiz
