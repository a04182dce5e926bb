// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/face/calibration.h"

#include <algorithm>
#include <cmath>

#include "phiz/core/error.h"
#include "phiz/core/progress.h"
#include "phiz/elasticity/tissue_newton.h"

namespace phiz {

namespace {

/// The sum of a . b over the skin by area.
double product(const VectorXd& area, const MatrixX3d& a, const MatrixX3d& b) {
  return area.dot(a.cwiseProduct(b).rowwise().sum());
}

MatrixX3d displacement_of(const VolumetricShape& shape, const HeadTemplate& head) {
  if (shape.displacement.rows() != head.volume.V.rows())
    reject("calibration", "the volumetric shape " + shape.name + " has no displacement");
  return shape.displacement.cast<double>();
}

}  // namespace

std::vector<Calibration> calibrate_activations(const FaceModel& model, const HeadTissue& tissue,
                                               std::vector<ActivationShape>& shapes,
                                               const CalibrationOptions& options) {
  const HeadTemplate& head = model.head;
  if (shapes.size() != model.shapes.size()) reject("calibration", "needs one activation per volumetric shape");
  const VectorXd area = lumped_triangle_mass(head.volume.V, head.skin_triangles);
  std::size_t open = 0;
  while (open < shapes.size() && shapes[open].name != "jawOpen") ++open;
  TissueEnergy energy(tissue.body);
  std::vector<Calibration> all;
  for (std::size_t j = 0; j < shapes.size(); ++j) {
    if (interrupted()) fail("stopped while calibrating muscles");
    std::vector<ActivationShape> tried{shapes[j]};
    MatrixX3d goal = displacement_of(model.shapes[j], head);
    if (shapes[j].name == "mouthClose" && open < shapes.size()) {
      tried.push_back(shapes[open]);
      goal += displacement_of(model.shapes[open], head);
    }
    const ActivationBlender blender(tried, tissue);
    VectorXd weights = VectorXd::Ones(static_cast<Eigen::Index>(tried.size()));
    MatrixX3d x = head.volume.V + goal;
    place_jaw(head, tissue, blend_jaw(head.jaw, tried, weights), energy, x);
    const auto solve_at = [&](double gain) {
      weights[0] = gain;
      energy.set_activation(blender.blend(weights));
      return solve_static(energy, x);
    };
    Calibration result;
    result.name = shapes[j].name;
    result.statistics = solve_at(1);
    const MatrixX3d first = x - head.volume.V, miss = goal - first;
    const double size = product(area, goal, goal);
    if (size > 0) {
      result.reached = product(area, first, goal) / size;
      result.error = std::sqrt(product(area, miss, miss) / size);
    }
    if (size > 0 && shapes[j].jaw.isZero() && result.statistics.converged && solve_at(options.probe).converged) {
      const MatrixX3d rate = (x - head.volume.V - first) / (options.probe - 1);
      const double step = product(area, rate, miss) / (product(area, rate, rate) + options.towards_one * size);
      result.gain = std::clamp(1 + step, options.least, options.most);
    }
    shapes[j].change *= static_cast<float>(result.gain);
    if (options.report) options.report(result);
    all.push_back(result);
  }
  return all;
}

}  // namespace phiz
