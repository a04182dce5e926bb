// SPDX-License-Identifier: GPL-3.0-or-later
/// The flesh of a head as muscle and passive tissue (Ichim et al. 2017, sections 3 and 4; phace.md sections 3, 4, 11).
#pragma once

#include <array>
#include <vector>

#include "phiz/anatomy/head_template.h"
#include "phiz/elasticity/tissue_body.h"

namespace phiz {

struct TissueOptions {
  double shear_scale = 3000;  ///< E0, pascals: what mu = 1 stands for
  double mu = 1, lambda = 3;  ///< multiples of E0 (phace.md section 11)
  /// How many times stiffer muscle is than passive tissue. A muscle that contracts reaches tens of kilopascals where
  /// fat has a few; at 1 passive tissue takes more than half of most expressions away.
  double muscle_stiffness = 10;
  double density = 1000;                ///< kg/m^3
  Vector3d gravity = Vector3d::Zero();  ///< m/s^2, head frame
  PassiveLaw passive = PassiveLaw::corotated;
  /// Flesh slides on bone only within this distance from a muscle of expression, metres; beyond, it is pinned. The
  /// scalp is held by its aponeurosis, which the model lacks: free, it slips over the skull by centimetres when a head
  /// shakes.
  double slide_reach = 0.02;
};

struct HeadTissue {
  VectorXi soft;  ///< rows of volume.T that body.tets are: soft_tets(head), ascending
  VectorXd
      muscle;  ///< per soft tet: share of its volume that muscles of expression and closers of the jaw fill, 0 to 1
  TissueBody body;                ///< over all vertices of the volume, slides in the rest pose
  std::vector<char> on_mandible;  ///< per vertex, where it is pinned: 1 if it goes with the mandible, 0: with the skull
};

/// Bone vertices are pinned, but those of head.attachments that slide; so is flesh within 1 mm of pinned ones. Flat
/// tets are as soft as flesh_body() has them. A tet with a share f of muscle that is k times stiffer has the energy (1
/// - f) E_pass + f k E_act; the body says so as moduli times 1 - f + f k, of which the share f k / (1 - f + f k) is
/// active. Throws phiz::Error(bad_input) for options or heads that make no body.
HeadTissue head_tissue(const HeadTemplate& head, const TissueOptions& options = {});

/// Moves the pinned rows of x (n x 3) to their places for a pose of the jaw.
void place_pins(const HeadTemplate& head, const HeadTissue& tissue, const JawPose& pose, MatrixX3d& x);
/// The slides of the body (rest pose) in a pose of the jaw, in the same order.
std::vector<Slide> place_slides(const HeadTemplate& head, const TissueBody& body, const JawPose& pose);
/// Both, for a solve in that pose: pins in x, slides in the energy of tissue.body.
void place_jaw(const HeadTemplate& head, const HeadTissue& tissue, const JawPose& pose, TissueEnergy& energy,
               MatrixX3d& x);
/// Derivative of the place of a pinned vertex by the pose.
Eigen::Matrix<double, 3, 5> pin_rate(const HeadTemplate& head, const HeadTissue& tissue, int vertex,
                                     const JawPose& pose);
/// Derivative of energy.gradient(x) by each coordinate of the pose, as pins move with the mandible; n x 3 each.
std::array<MatrixX3d, 5> gradient_by_jaw(const HeadTemplate& head, const HeadTissue& tissue, const JawPose& pose,
                                         const TissueEnergy& energy, const MatrixX3d& x);

}  // namespace phiz
