// SPDX-License-Identifier: GPL-3.0-or-later
/// Scenes of a head: from its template, or from a frame of a take.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "phiz/anatomy/head_template.h"
#include "phiz/face/take.h"
#include "phiz/render/camera.h"
#include "phiz/render/cut.h"
#include "phiz/render/heat_map.h"
#include "phiz/render/legend.h"
#include "phiz/render/scene.h"

namespace phiz {

enum class HeadStyle {
  clay,         ///< grey skin, for judging form
  skin,         ///< skin colours; lips, brows and the like where the template's regions are known
  wireframe,    ///< clay with the edges of the mesh; diagonals of quads are left out
  anatomy,      ///< bones, teeth, eyes and muscles under translucent skin
  bones,        ///< without the skin
  cutaway,      ///< cut by a plane, the cut coloured by tissue
  muscles,      ///< muscles over bones, teeth and eyes
  fibres,       ///< fibres from their origin (white) to their insertion (red) under a veil of skin
  attachments,  ///< bones as the tets have them, painted by how flesh sits on them
  contacts,     ///< contact regions of the skin and the parts that they must not enter
  heat,         ///< HeadViewOptions::values as colours
};

/// "clay", "skin", ... Throws phiz::Error(usage) naming the known ones.
HeadStyle head_style(std::string_view name);

struct HeadViewOptions {
  HeadStyle style = HeadStyle::clay;
  /// Cutaway: the plane in the head frame; what lies on the side of its normal is taken away.
  CutPlane plane{Vector3d(0.004, 0, 0), Vector3d::UnitX()};
  bool cut_tets = false;  ///< cutaway: show the tets in the cut, flesh coloured by the share that muscles fill
  /// Muscles, fibres, attachments, contacts: with skin, but only on the side that a cut by this plane keeps.
  std::optional<CutPlane> peel;
  std::vector<std::string> muscles;           ///< show only these: names, with or without their side; empty: all
  bool muscle_colours = false;                ///< a hue per muscle instead of reds that lie close together
  VectorXd values;                            ///< heat: one number per vertex of the drawn skin
  HeatScale scale;                            ///< heat: what its colours mean
  std::map<std::string, double> expressions;  ///< weights of the expressions that a head at rest shows
  bool still_head = false;                    ///< leave out the head's motion: for close-ups of a take
};

/// The head at rest, or with expressions added as they are stored (displacements of the skin, jaw, eyes for eyeLook*).
/// Throws phiz::Error(usage) for an expression or a muscle that the head does not have.
Scene head_scene(const HeadTemplate& head, const HeadViewOptions& options);

/// A frame of a take. With the head that it was made with, the skin gets its colours and cut-aways show tissue
/// (deformed where the frame holds TakeFrame::volume). Throws phiz::Error(bad_input) when head and take disagree.
Scene head_scene(const Take& take, const TakeFrame& frame, const HeadViewOptions& options,
                 const HeadTemplate* head = nullptr);

/// What the colours of these styles mean: muscles (with muscle_colours), fibres, cutaway, attachments, contacts. Empty
/// for the others.
std::vector<LegendEntry> head_legend(const HeadTemplate& head, const HeadViewOptions& options);

/// Face points for framing, from landmarks and eyes.
FacePoints face_points(const HeadTemplate& head);
FacePoints face_points(const Take& take);

/// True where nothing of the skin is drawn.
bool without_skin(const HeadViewOptions& options);

/// The camera for a view of what the options show of the head at rest: without skin, the parts and the muscles.
Camera head_camera(const HeadTemplate& head, const HeadViewOptions& options, View view, int width, int height);

/// The camera for a view of the head at rest, or of the frames of a take: whole-head views leave room for their motion.
Camera head_camera(const HeadTemplate& head, View view, int width, int height);
Camera take_camera(const Take& take, View view, int width, int height);

/// True for views of a detail; they are rendered with HeadViewOptions::still_head so that the detail stays in place.
bool is_close_up(View view);

}  // namespace phiz
