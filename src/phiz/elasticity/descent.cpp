// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/elasticity/descent.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "phiz/core/parallel.h"
#include "phiz/elasticity/complementarity.h"

namespace phiz {

namespace {

/// Iterations before steps are relaxed.
constexpr int settle = 5;

/// See run().
constexpr double plain_shortfall = 10;

/// The factor bounds the curvature from above: where the first step need not be the plain one, it is longer by this.
constexpr double first_stretch = 1.6;

/// The system's memory, or a new one if there is none of that length.
LowRankInverse& memory_of(ElasticSystem& system, int history) {
  const int pairs = std::clamp(history, 1, LowRankInverse::most_history);
  if (!system.memory || system.memory->history() != pairs)
    system.memory.emplace(system.size(), pairs, history > 0 ? first_stretch : 1);
  return *system.memory;
}

double longest_move(const float* p, std::ptrdiff_t rows) {
  float longest2 = 0;
  for (std::ptrdiff_t r = 0; r < rows; ++r)
    longest2 = std::max(longest2, Eigen::Map<const Eigen::Vector4f>(p + 4 * r).squaredNorm());
  return std::sqrt(static_cast<double>(longest2));
}

Vector3d vector_at(const float* v, int row) {
  return Eigen::Map<const Eigen::Vector3f>(v + 4 * static_cast<std::ptrdiff_t>(row)).cast<double>();
}

/// sum_k coefficient_k v(vertex_k) . normal.
template <class Vectors>
double row_product(const ContactRow& row, const Vectors& v) {
  Vector3d sum = Vector3d::Zero();
  for (int k = 0; k < row.count; ++k) sum += row.coefficients[k] * v(row.vertices[k]);
  return sum.dot(row.normal);
}

bool is_converged(double way_to_go, const SolveStatistics& statistics, const SolveOptions& options) {
  return way_to_go <= options.step_tolerance && statistics.residual <= options.residual_tolerance &&
         statistics.penetration <= options.penetration_tolerance;
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
      inverse_(memory_of(system, options.history)),
      force_(float_vector(system.size())) {}

ContactRows Descent::detect(const double* x, double patience) {
  ContactRows out;
  if (contacts_ == nullptr) return out;
  for (ContactRow row : contacts_->detect({x, 4, system_.row_of.data()}, patience)) {
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

bool Descent::was_active(std::int64_t key) const {
  return std::binary_search(active_keys_.begin(), active_keys_.end(), key);
}

void Descent::find_step(const ContactRows& contact, const float* gradient, const float* inverse_gradient, float* p) {
  const auto row_count = static_cast<Eigen::Index>(contact.rows.size());
  const Eigen::VectorXd u = inverse_.projection(), free_middle = inverse_.middle(u);
  // Where the vertices in contact would go without it.
  const auto free_motion = [&](int row) -> Vector3d {
    return -inverse_.gamma() * vector_at(inverse_gradient, row) -
           inverse_.rows(4 * static_cast<std::ptrdiff_t>(row)) * free_middle;
  };
  lambda_ = Eigen::VectorXd::Zero(row_count);
  row_motion_.resize(row_count);
  parallel_for(
      row_count,
      [&](std::ptrdiff_t i) { row_motion_[i] = row_product(contact.rows[static_cast<std::size_t>(i)], free_motion); },
      64);
  std::vector<Eigen::Index> working;
  for (Eigen::Index i = 0; i < row_count; ++i) {
    const auto s = static_cast<std::size_t>(i);
    if (contact.rows[s].gap + row_motion_[i] < idle_gap || was_active(contact.key[s])) working.push_back(i);
  }
  Eigen::MatrixXd U = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(working.size()), 2 * inverse_.pairs());
  for (Eigen::Index i = 0; i < U.rows(); ++i) {
    const ContactRow& row = contact.rows[static_cast<std::size_t>(working[static_cast<std::size_t>(i)])];
    for (int k = 0; k < row.count; ++k)
      U.row(i) += row.coefficients[k] * row.normal.transpose() *
                  inverse_.rows(4 * static_cast<std::ptrdiff_t>(row.vertices[k]));
  }
  find_multipliers(contact, working, U);
  active_keys_.clear();
  for (Eigen::Index i = 0; i < row_count; ++i)
    if (lambda_[i] > 0) active_keys_.push_back(contact.key[static_cast<std::size_t>(i)]);
  if (active_keys_.empty()) {
    inverse_.apply(inverse_gradient, free_middle, -1, p);
    return;
  }
  std::sort(active_keys_.begin(), active_keys_.end());
  // Near a solution the contact forces all but cancel the gradient: one solve for both keeps what is left.
  subtract_contact_forces(contact, gradient);
  system_.solver->solve(force_.get());
  inverse_.apply(force_.get(), inverse_.middle(u - U.transpose() * lambda_(working)), -1, p);
  for (Eigen::Index i = 0; i < row_count; ++i)
    row_motion_[i] = row_product(contact.rows[static_cast<std::size_t>(i)], [p](int row) { return vector_at(p, row); });
}

void Descent::find_multipliers(const ContactRows& contact, const std::vector<Eigen::Index>& working,
                               const Eigen::MatrixXd& U) {
  // (C H C^T) lambda + (gap - C H g) >= 0 (eq. 5.10, with unilateral multipliers).
  const auto m = static_cast<Eigen::Index>(working.size());
  if (m == 0) return;
  const auto row_of = [&](Eigen::Index i) -> const ContactRow& {
    return contact.rows[static_cast<std::size_t>(working[static_cast<std::size_t>(i)])];
  };
  Eigen::VectorXd q(m);
  std::vector<char> active(working.size(), 0);
  for (Eigen::Index i = 0; i < m; ++i) {
    const auto s = static_cast<std::size_t>(i);
    q[i] = row_of(i).gap + row_motion_[working[s]];
    active[s] = was_active(contact.key[static_cast<std::size_t>(working[s])]) || q[i] < 0;
  }
  Eigen::MatrixXd M = U * (inverse_.middle() * U.transpose());
  M = 0.5 * (M + M.transpose()).eval();
  parallel_for(
      m,
      [&](std::ptrdiff_t i) {
        const ContactRow& a = row_of(i);
        for (Eigen::Index j = 0; j <= i; ++j) {
          const ContactRow& b = row_of(j);
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
  if (multipliers.size() == m) lambda_(working) = multipliers;
}

void Descent::subtract_contact_forces(const ContactRows& contact, const float* gradient) {
  std::copy_n(gradient, system_.size(), force_.get());
  for (std::size_t i = 0; i < contact.rows.size(); ++i) {
    const double lambda = lambda_[static_cast<Eigen::Index>(i)];
    if (lambda == 0) continue;
    const ContactRow& row = contact.rows[i];
    for (int k = 0; k < row.count; ++k)
      Eigen::Map<Eigen::Vector3f>(force_.get() + 4 * static_cast<std::ptrdiff_t>(row.vertices[k])) -=
          (lambda * row.coefficients[k] * row.normal).cast<float>();
  }
}

double Descent::residual(const ContactRows& contact, const float* gradient) {
  subtract_contact_forces(contact, gradient);
  return std::sqrt(dot(force_.get(), force_.get(), system_.size())) / system_.force_scale();
}

SolveStatistics Descent::run(double* x) {
  const std::ptrdiff_t size = system_.size();
  FloatVector g = float_vector(size), next_g = float_vector(size), v = float_vector(size), next_v = float_vector(size);
  FloatVector p = float_vector(size), last_p = float_vector(size);
  AlignedVector trial = hwy::AllocateAligned<double>(static_cast<std::size_t>(4 * system_.vertices));
  AlignedVector apart = hwy::AllocateAligned<double>(static_cast<std::size_t>(4 * system_.vertices));
  std::copy_n(x, 4 * system_.vertices, trial.get());
  bool has_apart = false;  // the last state without penetration
  double last_length2 = 0, relaxation = 1;
  SolveStatistics statistics;
  double energy = system_.evaluate(x, g.get(), system_.free);
  std::copy_n(g.get(), size, v.get());
  system_.solver->solve(v.get());
  inverse_.start(g.get());
  ContactRows contact = detect(x);

  while (statistics.iterations < options_.max_iterations) {
    ++statistics.iterations;
    find_step(contact, g.get(), v.get(), p.get());
    const bool plain = options_.history > 0 && inverse_.pairs() == 0;
    const double contact_work = lambda_.dot(row_motion_);
    const Eigen::VectorXd products = dots({g.get(), last_p.get(), p.get()}, p.get(), size);
    const double decrease = contact_work - products[0];
    const double reach = longest_move(p.get(), system_.free);
    // Where contacts switch from face to face two states can call each other for ever: steps that turn back are
    // shortened, and contacts keep their planes the longer for it.
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
        trial[static_cast<std::size_t>(i)] = x[i] + alpha * static_cast<double>(p[static_cast<std::size_t>(i)]);
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
        // Not even the plain step helps: the energy is as low as rounding lets it be seen.
        statistics.last_step = reach;
        statistics.contacts = static_cast<int>((lambda_.array() > 0).count());
        statistics.residual = residual(contact, g.get());
        statistics.penetration = deepest(contact);
        statistics.converged = is_converged(plain_shortfall * reach, statistics, options_);
        break;
      }
      inverse_.clear();  // fall back to a plain step from the same place
      continue;
    }
    std::copy_n(trial.get(), size, x);
    energy = next_energy;
    statistics.last_step = reach * std::min(1.0, alpha / relaxation);
    statistics.contacts = static_cast<int>((lambda_.array() > 0).count());
    // A plain step is short of the way to go by up to the ratio of the softest to the stiffest response.
    const double way_to_go = (plain ? plain_shortfall : 1.0) * statistics.last_step;
    const bool last = statistics.iterations == options_.max_iterations;
    const bool stalled = relaxation < 0.2 && alpha * reach <= options_.step_tolerance;
    const bool judged = way_to_go <= options_.step_tolerance || last || stalled;
    if (judged) statistics.residual = residual(contact, next_g.get());
    // Old planes may guide, but not judge.
    contact = detect(x, judged ? 0 : 1 / relaxation);
    statistics.penetration = deepest(contact);
    statistics.converged = is_converged(way_to_go, statistics, options_);
    if (statistics.iterations > settle && statistics.penetration <= options_.penetration_tolerance) {
      std::copy_n(x, 4 * system_.vertices, apart.get());
      has_apart = true;
    }
    if (last || stalled || (statistics.converged && statistics.iterations >= options_.min_iterations)) break;

    std::copy_n(next_g.get(), size, next_v.get());
    system_.solver->solve(next_v.get());
    if (options_.history > 0) {
      for (std::ptrdiff_t i = 0; i < size; ++i) {
        const auto s = static_cast<std::size_t>(i);
        p[s] *= static_cast<float>(alpha);
        g[s] = next_g[s] - g[s];
        v[s] = next_v[s] - v[s];
      }
      inverse_.add(p.get(), g.get(), v.get(), next_g.get());
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
