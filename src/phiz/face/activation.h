// SPDX-License-Identifier: GPL-3.0-or-later
/// Muscles by expression (Ichim et al. 2017, section 6; phace.md section 7): what the muscles of every tet strive for,
/// blended by weights.
#pragma once

#include <string>
#include <vector>

#include "phiz/face/face_model.h"
#include "phiz/face/head_tissue.h"

namespace phiz {

/// Symmetric stretches, one per row: xx, yy, zz, xy, xz, yz.
using Stretches = Eigen::Matrix<float, Eigen::Dynamic, 6, Eigen::RowMajor>;

/// One expression as its muscles do it: a_j - a_neut of the tets that it moves, and the pose b_j of the jaw.
struct ActivationShape {
  std::string name;
  JawPose jaw = JawPose::Zero();
  VectorXi tets;     ///< rows of HeadTemplate::volume.T, ascending
  Stretches change;  ///< S(a_j) - I
};

/// Stretches that muscles may strive for; a blend beyond is brought back.
constexpr double least_activation = 0.5, most_activation = 2;

/// A kinematic estimate of the activations of a model's expressions: the muscles of a tet strive for the stretch that
/// the tet has in the volumetric shape, S_j = I + V_j, averaged over some 4 mm of muscle around (screened diffusion of
/// V_j): muscles do not fold where the sculpt of a tet does. It knows nothing of forces: passive tissue resists, so
/// that the expressions come out weaker, and what is no muscle's work (air in the cheeks, the tongue) is missing.
std::vector<ActivationShape> estimate_activations(const FaceModel& model, const HeadTissue& tissue);

/// Pose of the jaw, b(w) = sum w_j b_j within the limits of the joint. `weights`: one per shape, else it throws as
/// blend() does.
JawPose blend_jaw(const JawJoint& joint, const std::vector<ActivationShape>& shapes, const VectorXd& weights);

/// a(w) = a_neut + sum w_j (a_j - a_neut) of all tets at once.
class ActivationBlender {
 public:
  /// Takes what the shapes say of the tets of `tissue` that have muscle. Throws phiz::Error(bad_input) for shapes that
  /// are malformed.
  ActivationBlender(const std::vector<ActivationShape>& shapes, const HeadTissue& tissue);

  /// The stretch of every tet of the tissue's body, as TissueEnergy::set_activation takes it; I where there is no
  /// muscle. Symmetric and positive: eigenvalues outside of the bounds above are brought back to them. Throws
  /// phiz::Error(bad_input) unless there is one weight per shape, none beyond a million.
  std::vector<Matrix3d> blend(const VectorXd& weights) const;
  /// The same for the tets that have muscle, tets().
  void blend(const VectorXd& weights, Stretches& stretches) const;
  const VectorXi& tets() const { return active_; }  ///< rows of body.tets, ascending

 private:
  struct Piece {
    std::vector<int> tets;  ///< places in active_
    std::vector<float> change;
    std::vector<std::size_t> start;  ///< of every chunk of active tets
  };
  VectorXi active_;
  std::vector<Piece> pieces_;  ///< per shape
  std::size_t tets_ = 0;
};

/// How well each tet (of tissue.body) is innervated, for a gain per muscle of the head (1: healthy, 0: paralysed): the
/// mean over the muscles in it. 1 where there is none.
VectorXd innervation(const HeadTemplate& head, const HeadTissue& tissue, const VectorXd& gain_per_muscle);
/// The same for paralysed muscles. A word is a muscle of the head, without Left or Right both of a pair; or "left" or
/// "right", the half of the head on that side of the person, with its half of the muscles that lie across the middle.
/// Throws phiz::Error(usage) for other words.
VectorXd paralysis(const HeadTemplate& head, const HeadTissue& tissue, const std::vector<std::string>& paralysed);
/// I + gain (S - I) in place, gains in [0, 1], one per row.
void scale_activation(const VectorXd& gain, Stretches& stretches);

}  // namespace phiz
