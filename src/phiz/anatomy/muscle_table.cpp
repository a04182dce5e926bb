// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/muscle_table.h"

#include <algorithm>
#include <array>

#include "phiz/anatomy/sides.h"

namespace phiz {
namespace {

using enum MuscleForm;
constexpr bool pair = true, single = false, face = true, jaw = false, bone = true, soft = false;

constexpr std::array table{
    MuscleFacts{"frontalis", "venter frontalis m. occipitofrontalis", pair, face, sheet, soft, "1 2 5",
                "browInnerUp browOuterUp eyeWide eyeLookUp", "FMA46760", "FMA46759"},
    MuscleFacts{"corrugator", "m. corrugator supercilii", pair, face, spindle, bone, "4",
                "browDown browInnerUp noseSneer", "FMA46797", "FMA46796"},
    MuscleFacts{"orbicularisOculi", "m. orbicularis oculi", pair, face, ring, bone, "6 7 43 45 46",
                "eyeBlink eyeSquint cheekSquint browDown mouthSmile eyeLookDown", "FMA46783 FMA46786",
                "FMA46782 FMA46785"},
    MuscleFacts{"nasalis", "m. nasalis", pair, face, sheet, bone, "38 39", "noseSneer", "FMA55607", "FMA55606"},
    MuscleFacts{"levatorLabiiSuperiorisAlaequeNasi", "m. levator labii superioris alaeque nasi", pair, face, spindle,
                bone, "9", "noseSneer mouthUpperUp mouthShrugUpper", "FMA46804", "FMA46803"},
    MuscleFacts{"levatorLabiiSuperioris", "m. levator labii superioris", pair, face, sheet, bone, "10",
                "mouthUpperUp noseSneer cheekSquint", "FMA46807", "FMA46806"},
    MuscleFacts{"zygomaticusMinor", "m. zygomaticus minor", pair, face, spindle, bone, "11",
                "mouthUpperUp mouthSmile cheekSquint", "FMA46815", "FMA46814"},
    MuscleFacts{"zygomaticusMajor", "m. zygomaticus major", pair, face, spindle, bone, "12",
                "mouthSmile cheekSquint mouthLeft mouthRight", "FMA46813", "FMA46812"},
    MuscleFacts{"levatorAnguliOris", "m. levator anguli oris", pair, face, spindle, bone, "13", "mouthSmile",
                "FMA46824", "FMA46823"},
    MuscleFacts{"risorius", "m. risorius", pair, face, sheet, soft, "20",
                "mouthStretch mouthDimple mouthLeft mouthRight", "FMA46840", "FMA46839"},
    MuscleFacts{"buccinator", "m. buccinator", pair, face, sheet, bone, "14",
                "mouthDimple mouthPress mouthLeft mouthRight", "FMA46836", "FMA46835"},
    MuscleFacts{"depressorAnguliOris", "m. depressor anguli oris", pair, face, sheet, bone, "15",
                "mouthFrown mouthStretch", "FMA46830", "FMA46829"},
    MuscleFacts{"depressorLabiiInferioris", "m. depressor labii inferioris", pair, face, sheet, bone, "16",
                "mouthLowerDown", "FMA46818", "FMA46817"},
    MuscleFacts{"mentalis", "m. mentalis", pair, face, spindle, bone, "17",
                "mouthShrugLower mouthRollLower mouthPress mouthFrown", "FMA46827", "FMA46826"},
    MuscleFacts{"platysma", "platysma", pair, face, sheet, soft, "20 21", "mouthStretch mouthFrown mouthLowerDown",
                "FMA45740", "FMA45739"},
    MuscleFacts{"procerus", "m. procerus", single, face, sheet, bone, "4 9", "browDown noseSneer", "FMA55611 FMA55610",
                ""},
    MuscleFacts{"orbicularisOris", "m. orbicularis oris", single, face, ring, soft, "8 18 22 23 24 28",
                "mouthFunnel mouthPucker mouthClose mouthRollLower mouthRollUpper mouthPress mouthShrugUpper",
                "FMA46841", ""},
    MuscleFacts{"depressorSepti", "m. depressor septi nasi", single, face, sheet, bone, "38 39", "mouthShrugUpper",
                "FMA55609 FMA55608", ""},
    MuscleFacts{"masseter", "m. masseter", pair, jaw, sheet, bone, "26 27 31", "jawOpen jawForward",
                "FMA49002 FMA49005", "FMA49001 FMA49004"},
    MuscleFacts{"temporalis", "m. temporalis", pair, jaw, sheet, bone, "26 27 31", "jawOpen", "", ""},
};

}  // namespace

std::span<const MuscleFacts> muscle_table() {
  return table;
}

const MuscleFacts* find_muscle_facts(std::string_view muscle) {
  const std::string_view stem = without_side(muscle);
  const auto found = std::find_if(table.begin(), table.end(), [&](const MuscleFacts& facts) {
    return facts.stem == (facts.paired ? stem : muscle);
  });
  return found == table.end() ? nullptr : &*found;
}

std::vector<std::string> expression_muscle_names() {
  std::vector<std::string> names;
  for (const MuscleFacts& facts : table) {
    if (!facts.expression) continue;
    const std::string stem(facts.stem);
    if (facts.paired) {
      names.push_back(stem + "Left");
      names.push_back(stem + "Right");
    } else {
      names.push_back(stem);
    }
  }
  return names;
}

}  // namespace phiz
