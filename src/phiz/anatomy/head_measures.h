// SPDX-License-Identifier: GPL-3.0-or-later
/// Figures of a head that say how good it is. Everything is metres unless stated.
#pragma once

#include <string>
#include <vector>

#include "phiz/anatomy/head_template.h"

namespace phiz {

/// The least depth of the vertices of the simulated bones below the simulation skin (all of it: lips, oral cavity and
/// sockets too), and of the skin's vertices above the bones; negative where a bone sticks out.
double simulated_bone_depth(const HeadTemplate& head);

/// The triangles of the drawn skin as seen from outside: from which at least three of 32 directions lead away freely,
/// without the lining of mouth and eye sockets, which parted lips show.
MatrixX3i outer_triangles(const HeadTemplate& head);

/// The least depth of the vertices of the drawn skull and mandible below those triangles. Infinite when there are no
/// such parts.
double drawn_bone_depth(const HeadTemplate& head);

/// The flesh over a craniometric landmark of the thickness table: along the bone's normal up to the simulation skin.
struct MeasuredThickness {
  std::string name;
  double measured = 0;   ///< NaN where the normal does not meet the skin within 60 mm
  double usual = 0;      ///< of the table
  double deviation = 0;  ///< of the table
};
/// The published landmarks of thickness_table that the head has.
std::vector<MeasuredThickness> measured_thickness(const HeadTemplate& head);

struct MuscleFigures {
  std::string name;
  double volume = 0;          ///< that fills tets, cubic metres
  double share_in_flesh = 0;  ///< of the volume inside its surface
  /// Median over its tets, weighted by volume, of the angle between the fibre direction and the muscle's own axis
  /// there, degrees. The long axis of a spindle (muscle_table; for other names: first principal variance at least three
  /// times the second) is the first principal axis of its volume; that of a sheet, which may be broader than long,
  /// leads from where its fibres begin on average to where they end. As muscles bend round the cheek and the jaw, the
  /// own axis at a place joins the centres of the thirds of the volume, cut across the long axis, on either side of it.
  /// In a ring it joins the centres of the sectors on either side, of twelve round the normal of what its fibres span.
  double angle = 0;
};
MuscleFigures muscle_figures(const HeadTemplate& head, const Muscle& muscle);

/// How the teeth meet, from the parts upperTeeth and lowerTeeth.
struct Occlusion {
  bool known = false;           ///< both parts are there
  double overbite = 0;          ///< how far the upper incisors overlap the lower ones, along y
  double overjet = 0;           ///< how far their edges stand before the lower ones, along z
  double gap = 0;               ///< least distance between upper and lower teeth
  double interpenetration = 0;  ///< greatest depth of a vertex of one inside the other
};
Occlusion occlusion(const HeadTemplate& head);

/// Pairs of triangles of the simulation skin that intersect when an expression has weight 1. mouthClose is measured on
/// top of jawOpen, which it is made for.
struct ExpressionFigures {
  std::string name;
  std::size_t self_intersections = 0;
};
std::vector<ExpressionFigures> expression_figures(const HeadTemplate& head);

/// The simulation skin with every vertex displaced; `displacement`: of the drawn skin, empty for none.
TriangleMesh simulation_skin(const HeadTemplate& head, const MatrixX3d& displacement = {});

/// Share of muscle in the flesh of the face: in front of the condyles, from the chin (landmark 8) to the brows.
double active_share_of_face(const HeadTemplate& head);

}  // namespace phiz
