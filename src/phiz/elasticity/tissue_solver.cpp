// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/elasticity/tissue_solver.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "phiz/core/error.h"
#include "phiz/core/parallel.h"
#include "phiz/elasticity/tissue_engine.h"

namespace phiz {

TissueSolver::TissueSolver(const TissueBody& body, const TissueSolverOptions& options)
    : engine_(std::make_unique<TissueEngine>(body, options)) {}
TissueSolver::~TissueSolver() = default;
TissueSolver::TissueSolver(TissueSolver&&) noexcept = default;
TissueSolver& TissueSolver::operator=(TissueSolver&&) noexcept = default;

const TissueBody& TissueSolver::body() const {
  return engine_->system.body;
}
TissueSolverOptions& TissueSolver::options() {
  return engine_->options;
}

void TissueSolver::set_activation(const std::vector<Matrix3d>& stretches) {
  if (static_cast<Eigen::Index>(stretches.size()) != engine_->system.body.tets.rows())
    reject("activation", "needs one stretch for every tet");
  for (std::size_t t = 0; t < stretches.size(); ++t) {
    if (!stretches[t].allFinite() || (stretches[t] - stretches[t].transpose()).norm() > 1e-9)
      reject("activation", "the stretch of tet " + std::to_string(t) + " is not symmetric");
    engine_->system.blocks.set_stretch(static_cast<std::ptrdiff_t>(t), stretches[t]);
  }
}

void TissueSolver::set_activation(const VectorXi& tets,
                                  const Eigen::Matrix<float, Eigen::Dynamic, 6, Eigen::RowMajor>& stretches) {
  TissueBlocks& blocks = engine_->system.blocks;
  if (tets.size() != stretches.rows() || (tets.size() > 0 && (tets.minCoeff() < 0 || tets.maxCoeff() >= blocks.tets)) ||
      !stretches.allFinite())
    reject("activation", "needs six finite numbers for every tet that it names");
  parallel_for(
      tets.size(),
      [&](std::ptrdiff_t i) {
        const std::ptrdiff_t slot = blocks.slot_of[tets[i]];
        for (int k = 0; k < 6; ++k) blocks.stretch[TissueBlocks::at(slot, 6, k)] = stretches(i, k);
      },
      2048);
}

void TissueSolver::set_slides(const std::vector<Slide>& slides) {
  std::vector<Slide>& mine = engine_->system.body.slides;
  if (slides.size() != mine.size()) reject("slides", "must be those of the body, in its order");
  for (std::size_t s = 0; s < slides.size(); ++s)
    if (slides[s].vertex != mine[s].vertex || !slides[s].point.allFinite() || !slides[s].normal.allFinite() ||
        !slides[s].bend.allFinite())
      reject("slides", "number " + std::to_string(s) + " is not finite or of another vertex");
  mine = slides;
}

void TissueSolver::set_forces(const MatrixX3d& forces) {
  if (forces.rows() != 0 && (forces.rows() != engine_->system.rows || !forces.allFinite()))
    reject("forces", "need one finite force for every vertex");
  engine_->system.set_forces(forces);
}

void TissueSolver::set_inertia(double time_step, const MatrixX3d& prediction) {
  TissueSystem& system = engine_->system;
  if (prediction.rows() == 0) {
    system.inverse_time_step2 = 0;
    return;
  }
  if (prediction.rows() != system.rows || !prediction.allFinite() || !(time_step > 0))
    reject("inertia", "needs a positive time step and one finite prediction for every vertex");
  system.inverse_time_step2 = 1 / (time_step * time_step);
  system.load(prediction, system.prediction.get());
}

void TissueSolver::watch(const VectorXi& vertices, double slack) {
  TissueEngine& p = *engine_;
  if (!(slack >= 1) || (vertices.size() > 0 && (vertices.minCoeff() < 0 || vertices.maxCoeff() >= p.system.rows)))
    reject("watched vertices", "must be vertices of the body, the slack at least 1");
  std::fill(p.weight2.begin(), p.weight2.end(), static_cast<float>(1 / (slack * slack)));
  for (const int v : vertices)
    if (p.system.row_of[v] < p.system.free) p.weight2[static_cast<std::size_t>(p.system.row_of[v])] = 1;
}

void TissueSolver::restart(const MatrixX3d& positions) {
  TissueEngine& p = *engine_;
  if (positions.rows() != p.system.rows || !positions.allFinite())
    reject("tissue solver", "needs a finite position for every vertex to start from");
  p.drop_job();
  p.has_factor = false;
  p.forget_curvature();
  p.pushes.clear();
  p.start_from(positions);
}

const MatrixX3d& TissueSolver::positions() const {
  return engine_->positions;
}

SolveStatistics TissueSolver::solve(const MatrixX3d& pins, ContactScene* contacts) {
  return engine_->solve(pins, contacts);
}

MatrixX3d TissueSolver::contact_forces() const {
  const TissueEngine& p = *engine_;
  MatrixX3d out = MatrixX3d::Zero(p.system.rows, 3);
  for (std::size_t i = 0; i < p.contact.rows.size(); ++i) {
    const ContactRow& row = p.contact.rows[i];
    for (int k = 0; k < row.count; ++k)
      out.row(p.system.vertex_of[row.vertices[k]]) +=
          p.contact.multipliers[static_cast<Eigen::Index>(i)] * row.coefficients[k] * row.normal.transpose();
  }
  return out;
}

TissueSolverCounts TissueSolver::counts() const {
  return engine_->counts;
}

}  // namespace phiz
