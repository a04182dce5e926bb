// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/open/sources.h"

#include <cstdio>

namespace phiz {

const std::vector<BodyPartName>& needed_body_parts() {
  using enum BodyPartKind;
  static const std::vector<BodyPartName> parts = {
      {52734, skull, "frontal bone"},
      {52735, skull, "occipital bone"},
      {52736, skull, "sphenoid bone"},
      {52738, skull, "right temporal bone"},
      {52739, skull, "left temporal bone"},
      {52740, skull, "ethmoid"},
      {52788, skull, "right parietal bone"},
      {52789, skull, "left parietal bone"},
      {52892, skull, "right zygomatic bone"},
      {52893, skull, "left zygomatic bone"},
      {53645, skull, "right lacrimal bone"},
      {53646, skull, "left lacrimal bone"},
      {53647, skull, "right nasal bone"},
      {53648, skull, "left nasal bone"},
      {53649, skull, "right maxilla"},
      {53650, skull, "left maxilla"},
      {53655, skull, "right palatine bone"},
      {53656, skull, "left palatine bone"},
      {54737, skull, "right inferior nasal concha"},
      {54738, skull, "left inferior nasal concha"},
      {9710, skull, "vomer"},
      {52748, mandible, "mandible"},
      {55680, upper_tooth, "right upper lateral secondary incisor tooth"},
      {55681, upper_tooth, "right upper central secondary incisor tooth"},
      {55682, upper_tooth, "left upper central secondary incisor tooth"},
      {55683, upper_tooth, "left upper lateral secondary incisor tooth"},
      {55686, lower_tooth, "right lower secondary canine tooth"},
      {55687, lower_tooth, "left lower secondary canine tooth"},
      {55688, upper_tooth, "right upper second secondary premolar tooth"},
      {55689, upper_tooth, "right upper first secondary premolar tooth"},
      {55690, upper_tooth, "left upper first secondary premolar tooth"},
      {55691, upper_tooth, "left upper second secondary premolar tooth"},
      {55692, lower_tooth, "left lower second secondary premolar tooth"},
      {55693, lower_tooth, "left lower first secondary premolar tooth"},
      {55694, lower_tooth, "right lower first secondary premolar tooth"},
      {55695, lower_tooth, "right lower second secondary premolar tooth"},
      {55697, upper_tooth, "right upper second secondary molar tooth"},
      {55698, upper_tooth, "right upper first secondary molar tooth"},
      {55699, upper_tooth, "left upper first secondary molar tooth"},
      {55700, upper_tooth, "left upper second secondary molar tooth"},
      {55703, lower_tooth, "left lower second secondary molar tooth"},
      {55704, lower_tooth, "left lower first secondary molar tooth"},
      {55705, lower_tooth, "right lower first secondary molar tooth"},
      {55706, lower_tooth, "right lower second secondary molar tooth"},
      {55798, upper_tooth, "right upper secondary canine tooth"},
      {55799, upper_tooth, "left upper secondary canine tooth"},
      {57140, lower_tooth, "right lower lateral secondary incisor tooth"},
      {57141, lower_tooth, "left lower lateral secondary incisor tooth"},
      {57142, lower_tooth, "right lower central secondary incisor tooth"},
      {57143, lower_tooth, "left lower central secondary incisor tooth"},
      {12513, soft, "eyeballs"},
      {59815, soft, "labial part of mouth"},
      {52780, soft, "ear"},
      {45739, muscle, "right platysma"},
      {45740, muscle, "left platysma"},
      {46759, muscle, "right frontalis"},
      {46760, muscle, "left frontalis"},
      {46782, muscle, "orbital part of right orbicularis oculi"},
      {46783, muscle, "orbital part of left orbicularis oculi"},
      {46785, muscle, "palpebral part of right orbicularis oculi"},
      {46786, muscle, "palpebral part of left orbicularis oculi"},
      {46796, muscle, "right corrugator supercilii"},
      {46797, muscle, "left corrugator supercilii"},
      {46803, muscle, "right levator labii superioris alaeque nasi"},
      {46804, muscle, "left levator labii superioris alaeque nasi"},
      {46806, muscle, "right levator labii superioris"},
      {46807, muscle, "left levator labii superioris"},
      {46812, muscle, "right zygomaticus major"},
      {46813, muscle, "left zygomaticus major"},
      {46814, muscle, "right zygomaticus minor"},
      {46815, muscle, "left zygomaticus minor"},
      {46817, muscle, "right depressor labii inferioris"},
      {46818, muscle, "left depressor labii inferioris"},
      {46823, muscle, "right levator anguli oris"},
      {46824, muscle, "left levator anguli oris"},
      {46826, muscle, "right mentalis"},
      {46827, muscle, "left mentalis"},
      {46829, muscle, "right depressor anguli oris"},
      {46830, muscle, "left depressor anguli oris"},
      {46835, muscle, "right buccinator"},
      {46836, muscle, "left buccinator"},
      {46839, muscle, "right risorius"},
      {46840, muscle, "left risorius"},
      {46841, muscle, "orbicularis oris"},
      {55606, muscle, "right nasalis"},
      {55607, muscle, "left nasalis"},
      {55608, muscle, "right depressor septi nasi"},
      {55609, muscle, "left depressor septi nasi"},
      {55610, muscle, "right procerus"},
      {55611, muscle, "left procerus"},
      {49001, muscle, "superficial part of right masseter"},
      {49002, muscle, "superficial part of left masseter"},
      {49004, muscle, "deep part of right masseter"},
      {49005, muscle, "deep part of left masseter"},
  };
  return parts;
}

const std::vector<BodyPartName>& optional_body_parts() {
  using enum BodyPartKind;
  static const std::vector<BodyPartName> parts = {
      {12519, vertebra, "atlas"},
      {12520, vertebra, "axis"},
      {12521, vertebra, "third cervical vertebra"},
      {12522, vertebra, "fourth cervical vertebra"},
      {12523, vertebra, "fifth cervical vertebra"},
      {12524, vertebra, "sixth cervical vertebra"},
      {12525, vertebra, "seventh cervical vertebra"},
      {13896, vertebra, "intervertebral disk of third cervical vertebra"},
      {13897, vertebra, "intervertebral disk of fourth cervical vertebra"},
      {13898, vertebra, "intervertebral disk of fifth cervical vertebra"},
      {13899, vertebra, "intervertebral disk of sixth cervical vertebra"},
      {13900, vertebra, "intervertebral disk of seventh cervical vertebra"},
      {25058, vertebra, "intervertebral disk of axis"},
  };
  return parts;
}

const std::vector<std::string>& face_kit_expressions() {
  static const std::vector<std::string> names = {
      "browDown_L",       "browDown_R",      "browInnerUp_L",   "browInnerUp_R", "browOuterUp_L", "browOuterUp_R",
      "cheekPuff_L",      "cheekPuff_R",     "cheekSquint_L",   "cheekSquint_R", "eyeBlink_L",    "eyeBlink_R",
      "eyeLookDown_L",    "eyeLookDown_R",   "eyeLookIn_L",     "eyeLookIn_R",   "eyeLookOut_L",  "eyeLookOut_R",
      "eyeLookUp_L",      "eyeLookUp_R",     "eyeSquint_L",     "eyeSquint_R",   "eyeWide_L",     "eyeWide_R",
      "jawForward",       "jawLeft",         "jawOpen",         "jawRight",      "mouthClose",    "mouthDimple_L",
      "mouthDimple_R",    "mouthFrown_L",    "mouthFrown_R",    "mouthFunnel",   "mouthLeft",     "mouthLowerDown_L",
      "mouthLowerDown_R", "mouthPress_L",    "mouthPress_R",    "mouthPucker",   "mouthRight",    "mouthRollLower",
      "mouthRollUpper",   "mouthShrugLower", "mouthShrugUpper", "mouthSmile_L",  "mouthSmile_R",  "mouthStretch_L",
      "mouthStretch_R",   "mouthUpperUp_L",  "mouthUpperUp_R",  "noseSneer_L",   "noseSneer_R"};
  return names;
}

std::vector<std::string> face_kit_identities() {
  constexpr int count = 100;
  std::vector<std::string> names;
  for (int i = 0; i < count; ++i) {
    char name[16];
    std::snprintf(name, sizeof name, "identity%03d", i);
    names.emplace_back(name);
  }
  return names;
}

}  // namespace phiz
