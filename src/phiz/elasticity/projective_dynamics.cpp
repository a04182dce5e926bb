// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/elasticity/projective_dynamics.h"

#include <algorithm>
#include <chrono>

#include "phiz/core/error.h"
#include "phiz/core/parallel.h"
#include "phiz/elasticity/descent.h"
#include "phiz/elasticity/elastic_system.h"

namespace phiz {

ProjectiveDynamics::ProjectiveDynamics(const ElasticBody& body, const VectorXi& contact_vertices)
    : system_(std::make_unique<ElasticSystem>(body, contact_vertices)) {}

ProjectiveDynamics::~ProjectiveDynamics() = default;
ProjectiveDynamics::ProjectiveDynamics(ProjectiveDynamics&&) noexcept = default;
ProjectiveDynamics& ProjectiveDynamics::operator=(ProjectiveDynamics&&) noexcept = default;

ElementBlocks<float>& ProjectiveDynamics::elements() {
  return std::get<ElementForces<float>>(system_->elements).blocks;
}
std::ptrdiff_t ProjectiveDynamics::slot(std::ptrdiff_t tet) const {
  return system_->slot_of[static_cast<std::size_t>(tet)];
}

void ProjectiveDynamics::set_target(std::ptrdiff_t tet, const Matrix3d& F, const Matrix3d& stretch) {
  system_->set_target(tet, F, stretch);
}

void ProjectiveDynamics::set_attachment(std::size_t index, const Vector3d& point, const Vector3d& normal) {
  system_->attachments.at(index).point = point;
  system_->attachments.at(index).normal = normal;
}

void ProjectiveDynamics::set_prediction(const MatrixX3d& y) {
  system_->load(y, system_->prediction.get());
}

void ProjectiveDynamics::set_forces(const MatrixX3d& forces) {
  system_->has_force = forces.rows() == system_->vertices;
  if (system_->has_force) system_->load(forces, system_->force.get());
}

SolveStatistics ProjectiveDynamics::solve(MatrixX3d& x, const SolveOptions& options, ContactScene* contacts) {
  if (x.rows() != system_->vertices || !x.allFinite()) reject("elastic solve", "needs one finite position per vertex");
  const auto start = std::chrono::steady_clock::now();
  const AlignedVector state = hwy::AllocateAligned<double>(static_cast<std::size_t>(4 * system_->vertices));
  system_->load(x, state.get());
  SolveStatistics statistics = Descent(*system_, options, contacts).run(state.get());
  system_->store(state.get(), x);
  statistics.volume_change = volume(x) / system_->rest_volume - 1;
  statistics.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return statistics;
}

void ProjectiveDynamics::forget() {
  system_->memory.reset();
}

double ProjectiveDynamics::energy(const MatrixX3d& x, MatrixX3d* gradient) {
  const auto rows = static_cast<std::size_t>(4 * system_->vertices);
  const AlignedVector state = hwy::AllocateAligned<double>(rows), g = hwy::AllocateAligned<double>(rows);
  system_->load(x, state.get());
  const double energy = system_->evaluate(state.get(), g.get(), system_->vertices);
  if (gradient != nullptr) {
    gradient->resize(x.rows(), 3);
    system_->store(g.get(), *gradient);
  }
  return energy;
}

double ProjectiveDynamics::volume(const MatrixX3d& x) const {
  const AlignedVector state = hwy::AllocateAligned<double>(static_cast<std::size_t>(4 * system_->vertices));
  system_->load(x, state.get());
  return system_->volume(state.get());
}

double ProjectiveDynamics::rest_volume() const {
  return system_->rest_volume;
}
std::ptrdiff_t ProjectiveDynamics::free_vertices() const {
  return system_->free;
}
std::ptrdiff_t ProjectiveDynamics::factor_entries() const {
  return system_->solver->factor_entries();
}

}  // namespace phiz
