// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "phiz/core/parallel.h"
#include "phiz/elasticity/complementarity.h"
#include "phiz/elasticity/tissue_engine.h"

namespace phiz {

Contacts TissueEngine::detect(ContactScene* scene, const double* at, double patience) {
  Contacts out;
  if (scene == nullptr) return out;
  std::int64_t last_vertex = -1;
  int face = 0;
  for (ContactRow row : scene->detect({at, 4, system.row_of.data()}, patience)) {
    const std::int64_t vertex = (static_cast<std::int64_t>(row.pair) << 32) + row.vertices[0];
    face = vertex == last_vertex ? face + 1 : 0;
    last_vertex = vertex;
    FactorRow entry;
    entry.key = 8 * vertex + std::min(face, 7);
    entry.normal = row.normal.cast<float>();
    int kept = 0;
    for (int k = 0; k < row.count; ++k) {
      if (k > 0)
        entry.anchor -=
            static_cast<float>(row.coefficients[k]) * system.body.rest.row(row.vertices[k]).transpose().cast<float>();
      const int r = system.row_of[row.vertices[k]];
      if (r >= system.free) continue;
      Vector3d value = row.coefficients[k] * row.normal;
      const int sliding = system.sliding_of[static_cast<std::size_t>(r)];
      if (sliding >= 0) value = system.sliding[static_cast<std::size_t>(sliding)].keep * value;
      entry.entries.column[kept] = r;
      entry.entries.value[kept] = value.cast<float>();
      row.vertices[kept] = r;
      row.coefficients[kept++] = row.coefficients[k];
    }
    row.count = entry.entries.count = kept;
    if (kept == 0) continue;
    out.rows.push_back(row);
    out.entries.push_back(entry);
  }
  out.multipliers = VectorXd::Zero(static_cast<Eigen::Index>(out.rows.size()));
  for (std::size_t i = 0; i < out.rows.size(); ++i) {
    const auto found = pushes.find(out.entries[i].key);
    if (found != pushes.end()) out.multipliers[static_cast<Eigen::Index>(i)] = found->second;
  }
  return out;
}

double TissueEngine::deepest(const Contacts& contacts) {
  double depth = 0;
  for (std::size_t i = 0; i < contacts.rows.size(); ++i)
    if (contacts.entries[i].key % 8 == 0) depth = std::max(depth, -contacts.rows[i].gap);
  return depth;
}

void TissueEngine::contact_force(const Contacts& contacts, float* force) const {
  std::fill_n(force, size(), 0.0F);
  for (std::size_t i = 0; i < contacts.rows.size(); ++i) {
    const auto lambda = static_cast<float>(contacts.multipliers[static_cast<Eigen::Index>(i)]);
    if (lambda == 0) continue;
    const SparseRow& row = contacts.entries[i].entries;
    for (int k = 0; k < row.count; ++k)
      Eigen::Map<Eigen::Vector3f>(force + 3 * static_cast<std::ptrdiff_t>(row.column[k])) += lambda * row.value[k];
  }
}

double TissueEngine::residual(const Contacts& contacts, const double* gradient, double scale2) {
  std::vector<double>& rest = restricted;
  rest.assign(gradient, gradient + 4 * system.free);
  system.restrict_to_slides(rest.data());
  for (std::size_t i = 0; i < contacts.rows.size(); ++i) {
    const double lambda = contacts.multipliers[static_cast<Eigen::Index>(i)];
    if (lambda == 0) continue;
    const SparseRow& row = contacts.entries[i].entries;
    for (int k = 0; k < row.count; ++k)
      Eigen::Map<Vector3d>(rest.data() + 4 * static_cast<std::ptrdiff_t>(row.column[k])) -=
          lambda * row.value[k].cast<double>();
  }
  const double norm = Eigen::Map<const VectorXd>(rest.data(), static_cast<Eigen::Index>(rest.size())).norm();
  return scale2 > 0 ? norm / std::sqrt(scale2) : 0;
}

void TissueEngine::find_multipliers(Contacts& contacts, Step& step, int pairs, float gamma) {
  const std::vector<int> slots = compliance.find_slots(factor, contacts.entries);
  const Eigen::VectorXf motion = compliance.products(step.hat.get());  // of the rows, with the forces that were
  std::vector<std::size_t> working;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    if (contacts.multipliers[row] > 0 || contacts.rows[i].gap + static_cast<double>(motion[slots[i]]) < idle_gap)
      working.push_back(i);
  }
  if (working.empty()) return;
  const auto m = static_cast<Eigen::Index>(working.size());
  Eigen::MatrixXd U(m, 2 * pairs);
  if (pairs > 0) {
    const std::vector<const float*> columns = memory.columns();
    parallel_for(
        static_cast<std::ptrdiff_t>(columns.size()),
        [&](std::ptrdiff_t k) {
          const Eigen::VectorXf products = compliance.products(columns[static_cast<std::size_t>(k)]);
          const double scale = k < pairs ? 1 : memory.gamma();
          for (Eigen::Index i = 0; i < m; ++i)
            U(i, k) = scale * static_cast<double>(products[slots[working[static_cast<std::size_t>(i)]]]);
        },
        1);
  }
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(m, m);
  if (pairs > 0) M = U * (memory.middle() * U.transpose());
  VectorXd before(m), q(m);
  std::vector<char> active(working.size(), 0);
  for (Eigen::Index i = 0; i < m; ++i) {
    const std::size_t row = working[static_cast<std::size_t>(i)];
    for (Eigen::Index k = 0; k < m; ++k)
      M(i, k) +=
          static_cast<double>(gamma * compliance.compliance(slots[row], slots[working[static_cast<std::size_t>(k)]]));
    before[i] = contacts.multipliers[static_cast<Eigen::Index>(row)];
    q[i] = contacts.rows[row].gap + static_cast<double>(motion[slots[row]]);
    active[static_cast<std::size_t>(i)] = before[i] > 0 || q[i] < 0;
  }
  M = (0.5 * (M + M.transpose())).eval();
  M.diagonal().array() += 1e-6 * M.trace() / static_cast<double>(m);
  q -= M * before;
  const VectorXd found = solve_complementarity(M, q, active);
  if (found.size() != m) return;
  const VectorXd change = found - before;
  for (Eigen::Index i = 0; i < m; ++i)
    contacts.multipliers[static_cast<Eigen::Index>(working[static_cast<std::size_t>(i)])] = found[i];
  // H (C^T change) = gamma C^T change + [S, gamma Z] M U^T change, in the coordinates of the factor.
  FloatVector push = float_vector(size());
  Eigen::VectorXf weights = Eigen::VectorXf::Zero(compliance.slots());
  for (Eigen::Index i = 0; i < m; ++i)
    weights[slots[working[static_cast<std::size_t>(i)]]] += static_cast<float>(change[i]);
  compliance.add(weights, push.get());
  const Eigen::VectorXd bent = pairs > 0 ? memory.middle(U.transpose() * change) : Eigen::VectorXd();
  FloatVector response = float_vector(size());
  memory.apply(push.get(), bent, 1, response.get());
  combine({step.hat.get(), response.get()}, Eigen::Vector2f(1, 1), step.hat.get(), size());
  const Eigen::VectorXf moved_rows = compliance.products(step.hat.get());
  for (Eigen::Index i = 0; i < m; ++i)
    step.contact_work += change[i] * static_cast<double>(moved_rows[slots[working[static_cast<std::size_t>(i)]]]);
}

double TissueEngine::work_of(const Contacts& contacts, const VectorXd& multipliers, const float* p) {
  double work = 0;
  for (std::size_t i = 0; i < contacts.rows.size(); ++i) {
    const double lambda = multipliers[static_cast<Eigen::Index>(i)];
    if (lambda == 0) continue;
    const SparseRow& row = contacts.entries[i].entries;
    float motion = 0;
    for (int k = 0; k < row.count; ++k) motion += row.value[k].dot(vector_at(p, row.column[k]));
    work += lambda * static_cast<double>(motion);
  }
  return work;
}

void TissueEngine::keep_pushes(const Contacts& contacts) {
  pushes.clear();
  for (std::size_t i = 0; i < contacts.rows.size(); ++i) {
    const double lambda = contacts.multipliers[static_cast<Eigen::Index>(i)];
    if (lambda > 0) pushes[contacts.entries[i].key] = lambda;
  }
}

}  // namespace phiz
