// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/face/activation_fit.h"

#include <cmath>
#include <optional>

#include "phiz/core/error.h"
#include "phiz/face/head_contacts.h"
#include "phiz/geometry/surface.h"

namespace phiz {

namespace {

/// The skin that an expression should have, where it is not held by bone.
std::vector<ShapeTarget> skin_targets(const HeadTemplate& head, const TissueBody& body, const MatrixX3d& goal) {
  const MatrixX3d normals = vertex_normals(goal, head.skin_triangles);
  std::vector<ShapeTarget> out;
  for (const int v : head.skin_vertices)
    if (body.pinned[static_cast<std::size_t>(v)] == 0) out.push_back({v, goal.row(v), normals.row(v), 1});
  return out;
}

ActivationShape changed_tets(const HeadTissue& tissue, const std::vector<Matrix3d>& stretches) {
  constexpr double least_change = 1e-4;
  ActivationShape out;
  std::vector<int> changed;
  for (std::size_t t = 0; t < stretches.size(); ++t)
    if ((stretches[t] - Matrix3d::Identity()).cwiseAbs().maxCoeff() > least_change)
      changed.push_back(static_cast<int>(t));
  const auto n = static_cast<Eigen::Index>(changed.size());
  out.tets.resize(n);
  out.change.resize(n, 6);
  for (Eigen::Index k = 0; k < n; ++k) {
    const int t = changed[static_cast<std::size_t>(k)];
    const Matrix3d change = stretches[static_cast<std::size_t>(t)] - Matrix3d::Identity();
    out.tets[k] = tissue.soft[t];
    out.change.row(k) = activation_of(change).cast<float>();
  }
  return out;
}

}  // namespace

std::vector<MuscleFibres> muscle_fibres(const HeadTemplate& head, const HeadTissue& tissue) {
  VectorXi soft_of = VectorXi::Constant(head.volume.T.rows(), -1);
  for (int t = 0; t < tissue.soft.size(); ++t) soft_of[tissue.soft[t]] = t;
  std::vector<MuscleFibres> out;
  for (const Muscle& muscle : head.muscles) {
    std::vector<Eigen::Index> kept;
    for (Eigen::Index i = 0; i < muscle.tets.size(); ++i)
      if (soft_of[muscle.tets[i]] >= 0) kept.push_back(i);
    out.push_back({soft_of(muscle.tets(kept)), muscle.fraction(kept), MatrixX3d(muscle.direction(kept, Eigen::all))});
  }
  return out;
}

ActivationFit fit_activation(const FaceModel& model, const HeadTissue& tissue, const VolumetricShape& shape,
                             const ActivationShape& estimate, const ActivationFitOptions& options) {
  const HeadTemplate& head = model.head;
  if (shape.displacement.rows() != head.volume.V.rows())
    reject("expression " + shape.name, "has no displacement of the volume", "build the model anew");
  TissueBody body = tissue.body;
  body.slides = place_slides(head, body, shape.jaw);
  const MatrixX3d goal = head.volume.V + shape.displacement.cast<double>();
  MatrixX3d x = goal;
  place_pins(head, tissue, shape.jaw, x);
  put_on_slides(body, x);
  std::optional<HeadContacts> contacts;
  if (options.contact) {
    contacts.emplace(head, options.contact_options);
    contacts->place_jaw(jaw_transform(head.jaw, shape.jaw));
  }
  const std::vector<Matrix3d> start = ActivationBlender({estimate}, tissue).blend(VectorXd::Ones(1));
  const InverseResult found = find_activations(body, skin_targets(head, body, goal), muscle_fibres(head, tissue), x,
                                               start, options.inverse, contacts ? &contacts->scene : nullptr);
  ActivationFit out{changed_tets(tissue, found.stretches),
                    found.contractions,
                    found.start,
                    found.distance,
                    found.converged,
                    found.iterations};
  out.shape.name = shape.name;
  out.shape.jaw = shape.jaw;
  return out;
}

}  // namespace phiz
