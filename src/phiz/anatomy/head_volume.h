// SPDX-License-Identifier: GPL-3.0-or-later
/// The tets of a head between its skin and its bones, in the three sizes that every head comes in.
#pragma once

#include <string>

#include "phiz/anatomy/bones/settle_bones.h"
#include "phiz/anatomy/head_template.h"

namespace phiz {

/// Fineness: about 8k, 35k to 40k, at least 150k soft tets (flesh tets with a vertex that is free to move).
enum class HeadSize { preview, standard, fine };

/// "preview", "standard" or "fine", else phiz::Error(usage).
HeadSize head_size(const std::string& name);
std::string head_size_name(HeadSize size);

/// Fills volume, carrier, skin_vertices and skin_triangles: tets between and inside the surfaces, as many soft ones as
/// the size has. The vertices of the skin come first, then those of the skull's and of the mandible's surface, then
/// inner ones. `held`: rows of the skin that do not move with the face (the cap of the neck) and are carried by the
/// skull. Throws as `tetrahedralise` does.
void build_volume(HeadTemplate& head, const TriangleMesh& skin, const VectorXi& held, const BoneSurfaces& bones,
                  HeadSize size);

}  // namespace phiz
