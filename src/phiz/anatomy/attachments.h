// SPDX-License-Identifier: GPL-3.0-or-later
/// Where flesh is grown to bone and where it slides on it (phace.md 4.3), by anatomical rule instead of by hand.
///
/// Every vertex on the surface of a bone that touches soft tissue gets the first rule that fits:
///
/// | rule            | hold  | where                                               | why |
/// |-----------------|-------|-----------------------------------------------------|------------------------------------------|
/// | muscle origin   | pin   | within 4 mm of a fibre's first point, for muscles   | fibres arise from the periosteum |
/// |                 |       | of expression that arise from bone                  | | | nose            | pin   |
/// nasal bones: between the inner canthi, from the     | thin skin and procerus adhere to the     | |                 |
/// | nasion to the tip of the bridge                     | bone; soft cover slides little           | | inner canthus
/// | pin   | within 9 mm of the inner corners of the eyes        | medial palpebral ligament, lacrimal crest| |
/// alveolar        | pin   | within 7 mm of the teeth                            | gingiva and mucosa bound to
/// periosteum   | | chin            | pin   | mandible, medial of the corners of the mouth, below | mentalis, chin pad
/// fixed to the symphysis| |                 |       | the lower teeth                                     | | |
/// zygomatic       | pin   | within 7 mm of where zygomaticus major arises       | zygomatic retaining ligament
/// (McGregor)  | | mandibular      | pin   | within 7 mm of where depressor anguli oris arises   | mandibular retaining
/// ligament            | | scalp           | slide | skull, above the brows                              | loose
/// areolar layer under the galea      | | temple          | slide | skull, below that, beside and behind the outer |
/// temporoparietal fascia on the temporal   | |                 |       | canthi, above the mouth; back of the head |
/// fascia                                   | | cheekbone       | slide | skull, lateral of the pupils, between eyes
/// and mouth| prezygomatic space                       | | jaw             | slide | mandible, lateral of the corners
/// of the mouth and   | premasseter space: platysma glides over  | |                 |       | behind them: angle,
/// ramus, lower border             | masseter and the border                  | | elsewhere       | pin   | floor of
/// the orbit, behind the face, under the base | deep tissue is bound                     |
///
/// Ligaments: Mendelson and Wong, "Anatomy of the aging face" (in Neligan, Plastic Surgery, 2012).
#pragma once

#include <map>
#include <string>

#include "phiz/anatomy/head_template.h"

namespace phiz {

/// Attachments of `head`, from its volume, carriers, simulation skin, the 68 landmarks, muscles and parts (upperTeeth,
/// lowerTeeth, where it has them). `count_by_rule`, when given, receives how many vertices each rule of the table above
/// took. Throws phiz::Error(bad_input) naming the first landmark that is missing.
Attachments find_attachments(const HeadTemplate& head, std::map<std::string, int>* count_by_rule = nullptr);

}  // namespace phiz
