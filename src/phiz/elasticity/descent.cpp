// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/elasticity/descent.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "phiz/core/parallel.h"
#include "phiz/elasticity/complementarity.h"

namespace phiz {

namespace {

/// Rows whose gap would stay above this after the unconstrained step are left out of the multiplier problem, metres.
constexpr double idle_gap = 2e-4;

/// Iterations before steps are relaxed.
constexpr int settle = 5;

/// See run().
constexpr double plain_shortfall = 10;

/// The factor bounds the curvature from above: where the first step need not be the plain one, it is longer by this.
constexpr double first_stretch = 1.6;

double longest_move(const double* p, std::ptrdiff_t rows) {
  double longest2 = 0;
  for (std::ptrdiff_t r = 0; r < rows; ++r)
    longest2 = std::max(longest2, Eigen::Map<const Eigen::Vector3d>(p + 4 * r).squaredNorm());
  return std::sqrt(longest2);
}

/// sum_k coefficient_k v_k . normal.
double row_product(const ContactRow& row, const double* v) {
  Vector3d sum = Vector3d::Zero();
  for (int k = 0; k < row.count; ++k)
    sum += row.coefficients[k] * Eigen::Map<const Vector3d>(v + 4 * static_cast<std::ptrdiff_t>(row.vertices[k]));
  return sum.dot(row.normal);
}

double deepest(const ContactRows& contact) {
  double depth = 0;
  for (std::size_t i = 0; i < contact.rows.size(); ++i)
    if (i == 0 || contact.vertex[i] != contact.vertex[i - 1]) depth = std::max(depth, -contact.rows[i].gap);
  return depth;
}

}  // namespace

Descent::Descent(ElasticSystem& system, const SolveOptions& options, ContactScene* contacts)
    : system_(system),
      options_(options),
      contacts_(contacts),
      inverse_(system.size(), std::max(1, options.history), options.history > 0 ? first_stretch : 1),
      contact_force_(hwy::AllocateAligned<double>(static_cast<std::size_t>(system.size()))),
      inverse_force_(hwy::AllocateAligned<double>(static_cast<std::size_t>(system.size()))) {}

ContactRows Descent::detect(const double* x) {
  ContactRows out;
  if (contacts_ == nullptr) return out;
  for (ContactRow row : contacts_->detect({x, 4, system_.row_of.data()})) {
    const std::int64_t vertex = (static_cast<std::int64_t>(row.pair) << 32) + row.vertices[0];
    int kept = 0;
    for (int k = 0; k < row.count; ++k) {
      const int r = system_.row_of[row.vertices[k]];
      if (r >= system_.free || system_.compliance_row[r] < 0) continue;
      row.vertices[kept] = r;
      row.coefficients[kept++] = row.coefficients[k];
    }
    row.count = kept;
    if (kept == 0) continue;
    out.rows.push_back(row);
    const bool first = out.vertex.empty() || out.vertex.back() != vertex;
    out.vertex.push_back(vertex);
    out.key.push_back(2 * vertex + (first ? 0 : 1));
  }
  return out;
}

void Descent::find_step(const ContactRows& contact, const double* gradient, const double* inverse_gradient, double* p) {
  const std::ptrdiff_t size = system_.size();
  const Eigen::VectorXd u = inverse_.project(gradient);
  inverse_.combine(inverse_gradient, inverse_.middle(u), -1, p);
  const auto row_count = static_cast<Eigen::Index>(contact.rows.size());
  lambda_ = Eigen::VectorXd::Zero(row_count);
  row_motion_.resize(row_count);
  std::vector<Eigen::Index> working;
  for (Eigen::Index i = 0; i < row_count; ++i) {
    const auto s = static_cast<std::size_t>(i);
    row_motion_[i] = row_product(contact.rows[s], p);
    if (contact.rows[s].gap + row_motion_[i] < idle_gap ||
        std::binary_search(active_keys_.begin(), active_keys_.end(), contact.key[s]))
      working.push_back(i);
  }
  if (working.empty()) {
    active_keys_.clear();
    return;
  }

  // (C H C^T) lambda + (gap - C H g) >= 0 (eq. 5.10, with unilateral multipliers).
  const auto m = static_cast<Eigen::Index>(working.size());
  Eigen::MatrixXd U(m, 2 * inverse_.pairs());
  Eigen::VectorXd q(m);
  std::vector<char> active(working.size(), 0);
  for (Eigen::Index i = 0; i < m; ++i) {
    const auto s = static_cast<std::size_t>(working[static_cast<std::size_t>(i)]);
    const ContactRow& row = contact.rows[s];
    q[i] = row.gap + row_motion_[static_cast<Eigen::Index>(s)];
    active[static_cast<std::size_t>(i)] =
        std::binary_search(active_keys_.begin(), active_keys_.end(), contact.key[s]) || q[i] < 0;
    U.row(i).setZero();
    for (int k = 0; k < row.count; ++k)
      U.row(i) += row.coefficients[k] * row.normal.transpose() *
                  inverse_.rows(4 * static_cast<std::ptrdiff_t>(row.vertices[k]), 3);
  }
  Eigen::MatrixXd M = U * (inverse_.middle() * U.transpose());
  M = 0.5 * (M + M.transpose()).eval();
  parallel_for(
      m,
      [&](std::ptrdiff_t i) {
        const ContactRow& a = contact.rows[static_cast<std::size_t>(working[static_cast<std::size_t>(i)])];
        for (Eigen::Index j = 0; j <= i; ++j) {
          const ContactRow& b = contact.rows[static_cast<std::size_t>(working[static_cast<std::size_t>(j)])];
          double sum = 0;
          for (int k = 0; k < b.count; ++k) {
            const auto column = system_.compliance.col(system_.compliance_row[b.vertices[k]]);
            double part = 0;
            for (int l = 0; l < a.count; ++l) part += a.coefficients[l] * column[system_.compliance_row[a.vertices[l]]];
            sum += b.coefficients[k] * part;
          }
          M(i, j) += inverse_.gamma() * a.normal.dot(b.normal) * sum;
        }
      },
      16);
  M.triangularView<Eigen::StrictlyUpper>() = M.transpose();
  M.diagonal().array() += 1e-10 * M.trace() / static_cast<double>(m);
  const Eigen::VectorXd multipliers = solve_complementarity(M, q, active);
  active_keys_.clear();
  if (multipliers.size() == 0 || multipliers.isZero(0)) return;

  std::fill_n(contact_force_.get(), size, 0.0);
  for (Eigen::Index i = 0; i < m; ++i) {
    if (multipliers[i] <= 0) continue;
    const auto s = static_cast<std::size_t>(working[static_cast<std::size_t>(i)]);
    const ContactRow& row = contact.rows[s];
    lambda_[static_cast<Eigen::Index>(s)] = multipliers[i];
    active_keys_.push_back(contact.key[s]);
    for (int k = 0; k < row.count; ++k)
      Eigen::Map<Vector3d>(contact_force_.get() + 4 * static_cast<std::ptrdiff_t>(row.vertices[k])) +=
          multipliers[i] * row.coefficients[k] * row.normal;
  }
  std::sort(active_keys_.begin(), active_keys_.end());
  std::copy_n(contact_force_.get(), size, inverse_force_.get());
  system_.solver->solve(inverse_force_.get());
  for (std::ptrdiff_t i = 0; i < size; ++i)
    inverse_force_[static_cast<std::size_t>(i)] = inverse_gradient[i] - inverse_force_[static_cast<std::size_t>(i)];
  inverse_.combine(inverse_force_.get(), inverse_.middle(u - U.transpose() * multipliers), -1, p);
  for (Eigen::Index i = 0; i < row_count; ++i)
    row_motion_[i] = row_product(contact.rows[static_cast<std::size_t>(i)], p);
}

double Descent::contact_residual(const ContactRows& contact, const double* gradient) {
  std::copy_n(gradient, system_.size(), inverse_force_.get());
  for (std::size_t i = 0; i < contact.rows.size(); ++i) {
    const double lambda = lambda_[static_cast<Eigen::Index>(i)];
    if (lambda == 0) continue;
    const ContactRow& row = contact.rows[i];
    for (int k = 0; k < row.count; ++k)
      Eigen::Map<Vector3d>(inverse_force_.get() + 4 * static_cast<std::ptrdiff_t>(row.vertices[k])) -=
          lambda * row.coefficients[k] * row.normal;
  }
  return std::sqrt(dot(inverse_force_.get(), inverse_force_.get(), system_.size()));
}

SolveStatistics Descent::run(double* x) {
  const std::ptrdiff_t size = system_.size();
  const auto allocate = [size] { return hwy::AllocateAligned<double>(static_cast<std::size_t>(size)); };
  AlignedVector g = allocate(), next_g = allocate(), v = allocate(), next_v = allocate(), p = allocate();
  AlignedVector trial = hwy::AllocateAligned<double>(static_cast<std::size_t>(4 * system_.vertices));
  std::copy_n(x, 4 * system_.vertices, trial.get());
  AlignedVector last_p = allocate();
  std::fill_n(last_p.get(), size, 0.0);
  AlignedVector apart = hwy::AllocateAligned<double>(static_cast<std::size_t>(4 * system_.vertices));
  bool has_apart = false;  // the last state without penetration
  double last_length2 = 0, relaxation = 1;
  SolveStatistics statistics;
  double energy = system_.evaluate(x, g.get(), system_.free);
  std::copy_n(g.get(), size, v.get());
  system_.solver->solve(v.get());
  ContactRows contact = detect(x);

  while (statistics.iterations < options_.max_iterations) {
    ++statistics.iterations;
    find_step(contact, g.get(), v.get(), p.get());
    const bool plain = options_.history > 0 && inverse_.pairs() == 0;
    const double contact_work = lambda_.dot(row_motion_);
    const Eigen::VectorXd products = dots({g.get(), last_p.get(), p.get()}, p.get(), size);
    const double decrease = contact_work - products[0];
    const double reach = longest_move(p.get(), system_.free);
    // Where contacts switch from face to face two states can call each other for ever; steps that turn back are
    // shortened.
    const double back = products[1], length2 = products[2];
    if (!contact.rows.empty() && statistics.iterations > settle && back < -0.3 * std::sqrt(length2 * last_length2))
      relaxation *= 0.6;
    else
      relaxation = std::min(1.0, 1.1 * relaxation);
    std::copy_n(p.get(), size, last_p.get());
    last_length2 = length2;
    double alpha = relaxation;
    if (alpha * reach > options_.longest_step) alpha = options_.longest_step / reach;

    // Armijo's rule on the energy minus the work of the contact forces, which falls along p also out of penetrations. A
    // plain local/global step (no pairs) fulfils it by construction: the factor bounds the energy from above.
    const double rounding = system_.energy_rounding * std::abs(energy) + system_.smallest_energy;
    double next_energy = energy;
    bool accepted = false;
    for (int halving = 0; halving < 12 && std::isfinite(reach); ++halving) {
      for (std::ptrdiff_t i = 0; i < size; ++i)
        trial[static_cast<std::size_t>(i)] = x[i] + alpha * p[static_cast<std::size_t>(i)];
      next_energy = system_.evaluate(trial.get(), next_g.get(), system_.free);
      if (next_energy - alpha * contact_work <= energy - 1e-4 * alpha * decrease + rounding) {
        accepted = true;
        break;
      }
      if (inverse_.pairs() > 0) break;
      alpha *= 0.5;
    }
    if (!accepted) {
      if (inverse_.pairs() == 0) {
        statistics.residual = contact_residual(contact, g.get()) / system_.force_scale();
        break;
      }
      inverse_.clear();  // fall back to a plain step from the same place
      continue;
    }
    std::copy_n(trial.get(), size, x);
    energy = next_energy;
    statistics.last_step = reach * std::min(1.0, alpha / relaxation);
    statistics.contacts = static_cast<int>((lambda_.array() > 0).count());
    const double force = contact_residual(contact, next_g.get());
    contact = detect(x);
    statistics.penetration = deepest(contact);
    // A plain step is short of the way to go by up to the ratio of the softest to the stiffest response.
    const bool small_step = (plain ? plain_shortfall : 1.0) * statistics.last_step <= options_.step_tolerance;
    const bool last = statistics.iterations == options_.max_iterations;
    if (small_step || last) statistics.residual = force / system_.force_scale();
    statistics.converged = small_step && statistics.residual <= options_.residual_tolerance &&
                           statistics.penetration <= options_.penetration_tolerance;
    if (statistics.iterations > settle && statistics.penetration <= options_.penetration_tolerance) {
      std::copy_n(x, 4 * system_.vertices, apart.get());
      has_apart = true;
    }
    const bool stalled = relaxation < 0.5 && alpha * reach <= options_.step_tolerance;
    if (stalled) statistics.residual = force / system_.force_scale();
    if (last || stalled || (statistics.converged && statistics.iterations >= options_.min_iterations)) break;

    std::copy_n(next_g.get(), size, next_v.get());
    system_.solver->solve(next_v.get());
    if (options_.history > 0) {
      for (std::ptrdiff_t i = 0; i < size; ++i) {
        const auto s = static_cast<std::size_t>(i);
        p[s] *= alpha;
        g[s] = next_g[s] - g[s];
        v[s] = next_v[s] - v[s];
      }
      inverse_.add(p.get(), g.get(), v.get());
    }
    std::swap(g, next_g);
    std::swap(v, next_v);
  }
  if (has_apart && statistics.penetration > options_.penetration_tolerance) {
    // Two states took turns; of the two, the one without penetration.
    std::copy_n(apart.get(), 4 * system_.vertices, x);
    statistics.penetration = deepest(detect(x));
  }
  statistics.energy = energy;
  return statistics;
}

}  // namespace phiz
