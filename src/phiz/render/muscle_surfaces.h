// SPDX-License-Identifier: GPL-3.0-or-later
/// Internal: muscles as surfaces to be drawn. Included by sources only.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "phiz/geometry/spatial_query.h"
#include "phiz/render/head_surfaces.h"

namespace phiz::detail {

/// A muscle that is shown: its row in HeadTemplate::muscles and its place among the names without their side, by which
/// left and right share a colour.
struct ShownMuscle {
  int row = 0;
  int kind = 0;
};

/// Moves points of the head at rest with its tets.
class TissueMotion {
 public:
  explicit TissueMotion(const PosedHead& posed);
  MatrixX3d operator()(const MatrixX3d& points) const;

 private:
  std::optional<TetQuery> tets_;  // none: nothing moves
  const MatrixX4i* T_ = nullptr;
  MatrixX3d moved_;
};

/// The name without its side: "masseter" for "masseterLeft".
std::string muscle_stem(const std::string& name);

/// The muscles that options.muscles asks for, in the order of the head. Throws phiz::Error(usage) with the nearest
/// names for one that the head does not have.
std::vector<ShownMuscle> shown_muscles(const HeadTemplate& head, const HeadViewOptions& options);

/// The colour of a muscle among the others.
Vector3d colour_of(const ShownMuscle& muscle, const HeadViewOptions& options);

/// The muscle's own surface with streaks along its fibres, paler where it begins and ends; empty where it has none.
Surface muscle_belly(const PosedHead& posed, const TissueMotion& motion, const ShownMuscle& muscle,
                     const HeadViewOptions& options);

/// Its fibres as tubes: of its own colour, or (`graded`) from white at the origin to red at the insertion.
Surface fibre_tubes(const PosedHead& posed, const TissueMotion& motion, const ShownMuscle& muscle,
                    const HeadViewOptions& options, double radius, bool graded);

/// Ends of the grading of fibre_tubes.
Vector3d origin_colour();
Vector3d insertion_colour();

/// Bellies, and thick tubes for muscles without a surface.
void add_muscles(Scene& scene, const PosedHead& posed, const HeadViewOptions& options);
/// Thin tubes for all muscles.
void add_fibres(Scene& scene, const PosedHead& posed, const HeadViewOptions& options);

}  // namespace phiz::detail
