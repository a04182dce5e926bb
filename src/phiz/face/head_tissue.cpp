// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/face/head_tissue.h"

#include <algorithm>
#include <cmath>

#include "phiz/anatomy/muscle_table.h"
#include "phiz/core/error.h"
#include "phiz/core/parallel.h"
#include "phiz/face/bone_slides.h"
#include "phiz/face/flesh.h"

namespace phiz {

namespace {

void require(const TissueOptions& options) {
  for (const double value : {options.shear_scale, options.mu, options.muscle_stiffness})
    if (!(value > 0 && std::isfinite(value)))
      reject("tissue options", "the shear scale, mu and the stiffness of muscle must be positive");
  if (!(options.slide_reach >= 0)) reject("tissue options", "the reach of slides must not be negative");
  for (const double value : {options.lambda, options.density})
    if (!(value >= 0 && std::isfinite(value))) reject("tissue options", "lambda and density must not be negative");
}

/// The sum of the muscles' fractions in each of the tets `soft`.
VectorXd muscle_share(const HeadTemplate& head, const VectorXi& soft) {
  VectorXd share = VectorXd::Zero(head.volume.T.rows());
  for (const Muscle& muscle : head.muscles)
    for (Eigen::Index i = 0; i < muscle.tets.size(); ++i) share[muscle.tets[i]] += muscle.fraction[i];
  return share(soft).cwiseMin(1.0);
}

/// Drops the slides that are farther than `reach` from every muscle of expression.
void drop_far_slides(const HeadTemplate& head, double reach, std::vector<Slide>& slides) {
  std::vector<char> near_muscle(static_cast<std::size_t>(head.volume.V.rows()), 0);
  for (const Muscle& muscle : head.muscles) {
    const MuscleFacts* facts = find_muscle_facts(muscle.name);
    if (facts != nullptr && !facts->expression) continue;
    for (const int t : muscle.tets)
      for (int k = 0; k < 4; ++k) near_muscle[static_cast<std::size_t>(head.volume.T(t, k))] = 1;
  }
  std::erase_if(slides, [&](const Slide& slide) {
    for (Eigen::Index v = 0; v < head.volume.V.rows(); ++v)
      if (near_muscle[static_cast<std::size_t>(v)] != 0 &&
          (head.volume.V.row(v).transpose() - slide.point).squaredNorm() <= reach * reach)
        return false;
    return true;
  });
}

constexpr double crowded = 1e-3;  ///< metres

/// Where bone is meshed far finer than flesh has to be, flesh and slides that are crowded by pinned bone are held by
/// it: between them are only tets of some tenths of a millimetre, which snap from fold to fold.
void hold_crowded(HeadTissue& tissue) {
  TissueBody& body = tissue.body;
  const MatrixX3d& V = body.rest;
  std::vector<Eigen::Index> bone;
  for (Eigen::Index v = 0; v < V.rows(); ++v)
    if (body.pinned[static_cast<std::size_t>(v)] != 0) bone.push_back(v);
  std::vector<Eigen::Index> nearest(static_cast<std::size_t>(V.rows()), -1);
  parallel_for(
      V.rows(),
      [&](std::ptrdiff_t v) {
        if (body.pinned[static_cast<std::size_t>(v)] != 0) return;
        double least2 = crowded * crowded;
        for (const Eigen::Index w : bone)
          if (const double d2 = (V.row(v) - V.row(w)).squaredNorm(); d2 < least2) {
            least2 = d2;
            nearest[static_cast<std::size_t>(v)] = w;
          }
      },
      64);
  for (std::size_t v = 0; v < nearest.size(); ++v) {
    if (nearest[v] < 0) continue;
    body.pinned[v] = 1;
    tissue.on_mandible[v] = tissue.on_mandible[static_cast<std::size_t>(nearest[v])];
  }
  std::erase_if(body.slides, [&](const Slide& s) { return body.pinned[static_cast<std::size_t>(s.vertex)] != 0; });
}

}  // namespace

HeadTissue head_tissue(const HeadTemplate& head, const TissueOptions& options) {
  require(options);
  HeadTissue tissue;
  tissue.soft = soft_tets(head);
  tissue.muscle = muscle_share(head, tissue.soft);
  TissueBody& body = tissue.body;
  body.rest = head.volume.V;
  body.tets = head.volume.T(tissue.soft, Eigen::all);
  const VectorXd softening = flat_softening(body.rest, body.tets);
  body.active.resize(tissue.soft.size());
  for (Eigen::Index t = 0; t < tissue.soft.size(); ++t) {
    const double contractile = options.muscle_stiffness * tissue.muscle[t], sum = 1 - tissue.muscle[t] + contractile;
    const double scale = options.shear_scale * softening[t] * sum;
    body.moduli.push_back({scale * options.mu, scale * options.lambda});
    body.active[t] = contractile / sum;
  }
  body.density = VectorXd::Constant(tissue.soft.size(), options.density);
  body.gravity = options.gravity;
  body.passive = options.passive;
  body.slides = bone_slides(head);
  if (std::isfinite(options.slide_reach)) drop_far_slides(head, options.slide_reach, body.slides);
  body.pinned.resize(static_cast<std::size_t>(body.rest.rows()));
  tissue.on_mandible.resize(body.pinned.size());
  for (Eigen::Index v = 0; v < body.rest.rows(); ++v) {
    body.pinned[static_cast<std::size_t>(v)] = head.carrier[v] != static_cast<int>(Carrier::flesh);
    tissue.on_mandible[static_cast<std::size_t>(v)] = head.carrier[v] == static_cast<int>(Carrier::mandible);
  }
  for (const Slide& slide : body.slides) body.pinned[static_cast<std::size_t>(slide.vertex)] = 0;
  hold_crowded(tissue);
  validate(body);
  return tissue;
}

void place_pins(const HeadTemplate& head, const HeadTissue& tissue, const JawPose& pose, MatrixX3d& x) {
  const Eigen::Isometry3d jaw = jaw_transform(head.jaw, pose);
  for (Eigen::Index v = 0; v < x.rows(); ++v) {
    if (tissue.body.pinned[static_cast<std::size_t>(v)] == 0) continue;
    const Vector3d rest = head.volume.V.row(v);
    x.row(v) = tissue.on_mandible[static_cast<std::size_t>(v)] != 0 ? Vector3d(jaw * rest) : rest;
  }
}

std::vector<Slide> place_slides(const HeadTemplate& head, const TissueBody& body, const JawPose& pose) {
  std::vector<Slide> slides;
  slides.reserve(body.slides.size());
  for (const Slide& slide : body.slides) slides.push_back(placed(head, slide, pose));
  return slides;
}

void place_jaw(const HeadTemplate& head, const HeadTissue& tissue, const JawPose& pose, TissueEnergy& energy,
               MatrixX3d& x) {
  place_pins(head, tissue, pose, x);
  energy.set_slides(place_slides(head, tissue.body, pose));
}

Eigen::Matrix<double, 3, 5> pin_rate(const HeadTemplate& head, const HeadTissue& tissue, int vertex,
                                     const JawPose& pose) {
  if (tissue.on_mandible[static_cast<std::size_t>(vertex)] == 0) return Eigen::Matrix<double, 3, 5>::Zero();
  return jaw_jacobian(head.jaw, pose, head.volume.V.row(vertex));
}

std::array<MatrixX3d, 5> gradient_by_jaw(const HeadTemplate& head, const HeadTissue& tissue, const JawPose& pose,
                                         const TissueEnergy& energy, const MatrixX3d& x) {
  std::array<MatrixX3d, 5> rates;
  rates.fill(MatrixX3d::Zero(x.rows(), 3));
  for (int v = 0; v < x.rows(); ++v) {
    if (tissue.body.pinned[static_cast<std::size_t>(v)] == 0) continue;
    const Eigen::Matrix<double, 3, 5> rate = pin_rate(head, tissue, v, pose);
    for (int k = 0; k < 5; ++k) rates[static_cast<std::size_t>(k)].row(v) = rate.col(k).transpose();
  }
  for (MatrixX3d& rate : rates) rate = energy.gradient_change(x, rate);
  return rates;
}

}  // namespace phiz
