// SPDX-License-Identifier: GPL-3.0-or-later
/// Where flesh is grown to bone and where it slides on it (phace.md 4.3), by anatomical rule instead of by hand.
///
/// Every vertex on the surface of a bone that touches soft tissue gets the first rule that fits:
///
/// * pin, muscle origin: within 4 mm of a fibre's first point, for muscles of expression that arise from bone. Fibres
///   arise from the periosteum.
/// * pin, nose: the nasal bones, between the inner canthi from the nasion to the tip of the bridge. Skin is thin there
///   and adheres with procerus.
/// * pin, inner canthus: within 10 mm of the inner corners of the eyes. Medial palpebral ligament.
/// * pin, alveolar: within 7 mm of the teeth. Gingiva and mucosa are bound to the periosteum.
/// * pin, chin: the mandible medial of the corners of the mouth. Mentalis and the chin pad are fixed to the symphysis.
/// * pin, zygomatic: within 7 mm of where zygomaticus major arises. Zygomatic retaining ligament (McGregor's patch).
/// * pin, mandibular: within 7 mm of where depressor anguli oris arises. Mandibular retaining ligament.
/// * pin, deep: bone faces bone: within 30 mm its outward normal meets bone before skin. In the narrow gaps under the
///   zygomatic arch and behind the ramus flesh has nowhere to slide.
/// * slide, jaw: the rest of the mandible: lower border, angle, ramus. Premasseter space: platysma glides over masseter
///   and over the border.
/// * slide, scalp: the skull above the brows, forehead included. Loose areolar layer under the galea.
/// * slide, temple: below that, beside and behind the outer canthi and above the mouth; back of the head.
///   Temporoparietal fascia glides on the temporal fascia.
/// * slide, cheekbone: lateral of the pupils, between eyes and mouth. Prezygomatic space.
/// * pin, elsewhere: floor of the orbit, behind the face, under the base of the skull. Deep tissue is bound.
///
/// Ligaments and spaces: Mendelson and Wong (2012).
#pragma once

#include <map>
#include <string>

#include "phiz/anatomy/head_template.h"

namespace phiz {

/// Attachments of `head`, from its volume, carriers, simulation skin, the 68 landmarks, muscles and parts (upperTeeth,
/// lowerTeeth, where it has them). `count_by_rule`, when given, receives how many vertices each of the rules above
/// took. Throws phiz::Error(bad_input) naming the first landmark that is missing.
Attachments find_attachments(const HeadTemplate& head, std::map<std::string, int>* count_by_rule = nullptr);

}  // namespace phiz
