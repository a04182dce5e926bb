// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/elasticity/tissue_solver.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <future>
#include <map>
#include <optional>

#include "phiz/core/error.h"
#include "phiz/core/parallel.h"
#include "phiz/elasticity/complementarity.h"
#include "phiz/elasticity/contact_compliance.h"
#include "phiz/elasticity/low_rank_inverse.h"
#include "phiz/elasticity/tissue_system.h"

namespace phiz {

namespace {

/// Rows whose gap would stay above this after the unconstrained step are left out of the multiplier problem, metres.
constexpr double idle_gap = 2e-4;
/// Iterations before steps that turn back are relaxed.
constexpr int settle = 5;
/// Where more iterations than this are to be expected on an old factor, a new one is cheaper.
constexpr double cheap_iterations = 3;
/// A factor that had so many iterations without convergence is renewed in any case.
constexpr int patience = 8;
/// Of the first corrections after predictors, as shares of the predictors' steps, the largest of so many decides
/// whether the next one is worth making.
constexpr std::size_t remembered_shares = 6;
constexpr int most_uncorrected = 4;  ///< solves in a row
/// Relative error of the energy.
constexpr double energy_rounding = 1e-7;
/// Solves between the state that a factor is made at in the background and its first use.
constexpr int factor_delay = 2;
/// How far bones move, metres, in the difference that tells what their motion does to the forces.
constexpr double probe = 1e-4;

struct Contacts {
  std::vector<ContactRow> rows;    ///< vertices replaced by solver rows, those that do not move dropped
  std::vector<FactorRow> entries;  ///< of the same rows
  VectorXd multipliers;            ///< of the rows, newtons
};

Eigen::Map<const Eigen::Vector3f> vector_at(const float* v, int row) {
  return Eigen::Map<const Eigen::Vector3f>(v + 3 * static_cast<std::ptrdiff_t>(row));
}

/// Step of one iteration.
struct Step {
  FloatVector hat;          ///< L^T p
  FloatVector p;            ///< three per free row
  double contact_work = 0;  ///< of the contact forces along p
};

const TissueSolverOptions& checked(const TissueSolverOptions& o) {
  if (!(o.step_tolerance > 0) || !(o.residual_tolerance > 0) || !(o.penetration_tolerance > 0) ||
      o.max_iterations < 1 || o.history < 0 || o.refresh_iterations < 1 || o.refresh_solves < 1 ||
      !(o.longest_step > 0) || !(o.longest_lead > 0))
    reject("tissue solver options", "tolerances, steps and counts must be positive");
  return o;
}

}  // namespace

struct TissueSolver::Parts {
  TissueSolverOptions options;
  TissueSystem system;
  BlockCholesky factor, spare;
  BlockMatrix A, spare_A;
  std::vector<float> room, spare_room;
  LowRankInverse memory;
  ContactCompliance compliance;
  std::map<std::int64_t, double> pushes;  ///< multipliers of the last solve, by key
  Contacts contact;
  AlignedDoubles x, trial, moved, g, next_g;
  FloatVector hat;       ///< L^-1 of the gradient and of the contact forces, one after the other
  FloatVector last_hat;  ///< of the last gradient
  MatrixX3d positions;
  std::vector<float> solved_stretch;
  std::vector<Slide> solved_slides;
  std::vector<Slide> rest_slides;
  bool settled = true;  ///< the state is near an equilibrium, from which a predictor makes sense
  bool has_factor = false, fresh = false;
  double factor_inverse_time_step2 = 0;
  int served = 0;
  std::vector<double> correction_shares;  ///< of the last solves that made a correction
  int uncorrected = 0;                    ///< solves since the last one that did
  std::vector<double> restricted;         ///< room for a gradient
  std::vector<float> weight2;             ///< per free row: square of 1 for watched vertices, less for others
  TissueSolverCounts counts;
  std::future<bool> job;
  std::optional<bool> job_result;
  int job_due = -1;

  Parts(const TissueBody& body, const TissueSolverOptions& given)
      : options(checked(given)),
        system(body),
        factor(system.pattern),
        spare(factor.twin()),
        A(system.pattern),
        spare_A(system.pattern),
        memory(size(), std::clamp(given.history, 1, LowRankInverse::most_history)),
        x(zero_doubles(4 * system.rows)),
        trial(zero_doubles(4 * system.rows)),
        moved(zero_doubles(4 * system.rows)),
        g(zero_doubles(4 * system.free)),
        next_g(zero_doubles(4 * system.free)),
        hat(float_vector(2 * factor.side_stride())),
        last_hat(float_vector(size())),
        positions(body.rest),
        weight2(static_cast<std::size_t>(system.free), 1.0F) {
    rest_slides = body.slides;
    start_from(body.rest);
  }
  ~Parts() {
    if (job.valid()) job.wait();
  }
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;

  std::ptrdiff_t size() const { return 3 * system.free; }
  float* pushed_hat() { return hat.get() + factor.side_stride(); }

  void remember_targets() {
    solved_stretch.assign(system.blocks.stretch.get(),
                          system.blocks.stretch.get() + 6 * TissueBlocks::width * system.blocks.muscle_blocks);
    solved_slides = system.body.slides;
  }

  /// At rest, relaxed flesh is in balance but for its weight.
  void start_from(const MatrixX3d& at) {
    positions = at;
    system.load(at, x.get());
    system.put_on_slides(x.get());
    settled = at == system.body.rest;
    remember_targets();
    if (!settled) return;
    solved_slides = rest_slides;
    for (std::size_t i = 0; i < solved_stretch.size(); ++i) {
      const std::size_t entry = i / static_cast<std::size_t>(TissueBlocks::width) % 6;
      solved_stretch[i] = entry < 3 ? 1 : 0;
    }
  }

  // === Factors

  void forget_curvature() {
    memory.clear();
    compliance.clear();
  }

  /// A factor of the Hessian at a state: exact if that is positive definite, else bounded where tets twist or are under
  /// pressure, until few negative eigenvalues are left, which count as positive.
  void factorise_now(const double* at, const double* gradient) {
    const StiffnessState state = system.stiffness_state(at, gradient);
    ++counts.factorisations;
    for (const double least_curvature : {any_curvature, -0.3, 0.0}) {
      system.assemble(state, least_curvature, true, room, A);
      const int negative = factor.factorise(A);
      if (negative == 0) break;
      if (negative < 0 && least_curvature == 0)
        fail("the stiffness of the tissue is not finite", "check moduli, activations and positions");
      ++counts.projections;
    }
    has_factor = fresh = true;
    served = 0;
    factor_inverse_time_step2 = state.inverse_time_step2;
    forget_curvature();
  }

  void start_job() {
    auto work = [this, state = system.stiffness_state(x.get(), g.get())] {
      system.assemble(state, any_curvature, false, spare_room, spare_A);
      return spare.factorise(spare_A, false) == 0;
    };
    job_due = counts.solves + factor_delay;
    ++counts.factorisations;
    factor_inverse_time_step2 = system.inverse_time_step2;
    if (options.background)
      job = std::async(std::launch::async, std::move(work));
    else
      job_result = work();
  }

  void take_job() {
    if (job_due < 0 || counts.solves < job_due) return;
    const bool good = job.valid() ? job.get() : *job_result;
    job_result.reset();
    job_due = -1;
    if (!good) {
      has_factor = false;  // to be made now, projected if need be
      return;
    }
    std::swap(factor, spare);
    served = 0;
    fresh = false;
    forget_curvature();
  }

  void drop_job() {
    if (job.valid()) job.get();
    job_result.reset();
    job_due = -1;
  }

  // === Vectors

  void to_floats(const double* v, float* out) const {
    for (std::ptrdiff_t r = 0; r < system.free; ++r)
      for (int k = 0; k < 3; ++k) out[3 * r + k] = static_cast<float>(v[4 * r + k]);
  }

  double longest(const float* p) const {
    float longest2 = 0;
    for (int r = 0; r < system.free; ++r) longest2 = std::max(longest2, vector_at(p, r).squaredNorm());
    return std::sqrt(static_cast<double>(longest2));
  }

  /// The longest step of watched vertices, or a share of that of the others.
  double longest_watched(const float* p) const {
    float longest2 = 0;
    for (int r = 0; r < system.free; ++r)
      longest2 = std::max(longest2, weight2[static_cast<std::size_t>(r)] * vector_at(p, r).squaredNorm());
    return std::sqrt(static_cast<double>(longest2));
  }

  /// g . p
  double slope(const double* gradient, const float* p) const {
    return parallel_sum(system.free, 2048, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      double sum = 0;
      for (std::ptrdiff_t r = begin; r < end; ++r)
        for (int k = 0; k < 3; ++k) sum += gradient[4 * r + k] * static_cast<double>(p[3 * r + k]);
      return sum;
    });
  }

  double evaluate(const double* at, double* gradient, double* scale2 = nullptr) {
    return system.evaluate(at, gradient, scale2);
  }

  // === Contact

  Contacts detect(ContactScene* scene, const double* at, double patience) {
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

  static double deepest(const Contacts& contacts) {
    double depth = 0;
    for (std::size_t i = 0; i < contacts.rows.size(); ++i)
      if (contacts.entries[i].key % 8 == 0) depth = std::max(depth, -contacts.rows[i].gap);
    return depth;
  }

  /// force <- C^T lambda, three per free row.
  void contact_force(const Contacts& contacts, float* force) const {
    std::fill_n(force, size(), 0.0F);
    for (std::size_t i = 0; i < contacts.rows.size(); ++i) {
      const auto lambda = static_cast<float>(contacts.multipliers[static_cast<Eigen::Index>(i)]);
      if (lambda == 0) continue;
      const SparseRow& row = contacts.entries[i].entries;
      for (int k = 0; k < row.count; ++k)
        Eigen::Map<Eigen::Vector3f>(force + 3 * static_cast<std::ptrdiff_t>(row.column[k])) += lambda * row.value[k];
    }
  }

  /// |P (g - C^T lambda)| / sqrt(scale2).
  double residual(const Contacts& contacts, const double* gradient, double scale2) {
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

  // === The iteration

  /// hat <- L^-1 of the restricted gradient, and of the contact forces if there are any.
  void transform(const double* gradient, const Contacts& contacts) {
    restricted.assign(gradient, gradient + 4 * system.free);
    system.restrict_to_slides(restricted.data());
    to_floats(restricted.data(), hat.get());
    contact_force(contacts, pushed_hat());
    const bool pushed = contacts.multipliers.size() > 0 && contacts.multipliers.maxCoeff() > 0;
    if (!pushed) std::fill_n(pushed_hat(), size(), 0.0F);
    factor.forward(hat.get(), pushed ? 2 : 1);
  }

  /// The step from what transform() left in `hat`; finds the multipliers.
  void find_step(Contacts& contacts, Step& step) {
    const int pairs = memory.pairs();
    const auto gamma = static_cast<float>(memory.gamma());
    FloatVector excess = float_vector(size());  // L^-1 (g - C^T lambda)
    combine({hat.get(), pushed_hat()}, Eigen::Vector2f(1, -1), excess.get(), size());
    const Eigen::VectorXd u = memory.products(excess.get());
    memory.apply(excess.get(), memory.middle(u), -1, step.hat.get());
    step.contact_work = 0;
    if (!contacts.rows.empty()) find_multipliers(contacts, step, pairs, gamma);
    std::copy_n(step.hat.get(), size(), step.p.get());
    factor.backward(step.p.get());
    for (const SlidingRow& s : system.sliding) {
      Eigen::Map<Eigen::Vector3f> p(step.p.get() + 3 * static_cast<std::ptrdiff_t>(s.row));
      p = (s.keep.cast<float>() * p).eval();
    }
  }

  void find_multipliers(Contacts& contacts, Step& step, int pairs, float gamma) {
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

  /// lambda_before . C p with the exact rows, which the forces of transform() belong to.
  static double work_of(const Contacts& contacts, const VectorXd& multipliers, const float* p) {
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

  void keep_pushes(const Contacts& contacts) {
    pushes.clear();
    for (std::size_t i = 0; i < contacts.rows.size(); ++i) {
      const double lambda = contacts.multipliers[static_cast<Eigen::Index>(i)];
      if (lambda > 0) pushes[contacts.entries[i].key] = lambda;
    }
  }

  void advance(const double* from, const float* p, double alpha, double* to) {
    parallel_chunks(system.free, 2048, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (std::ptrdiff_t r = begin; r < end; ++r)
        for (int k = 0; k < 3; ++k) to[4 * r + k] = from[4 * r + k] + alpha * static_cast<double>(p[3 * r + k]);
    });
    std::copy(from + 4 * system.free, from + 4 * system.rows, to + 4 * system.free);
    system.put_on_slides(to);
  }

  /// Moves bones to `pins` and answers with the linearised equilibrium. Returns how far flesh goes; the state is only
  /// changed if that is at most `longest_lead`.
  double predict(const MatrixX3d& pins, ContactScene* scene, double longest_lead) {
    std::copy_n(x.get(), 4 * system.rows, moved.get());
    for (std::ptrdiff_t r = system.free; r < system.rows; ++r)
      Eigen::Map<Vector3d>(moved.get() + 4 * r) = pins.row(system.vertex_of[r]).transpose();
    const std::vector<SlidingRow> sliding_before = system.sliding;
    system.put_on_slides(moved.get());
    double farthest2 = 0;
    for (std::ptrdiff_t r = 0; r < system.rows; ++r)
      farthest2 = std::max(
          farthest2, (Eigen::Map<const Vector3d>(moved.get() + 4 * r) - Eigen::Map<const Vector3d>(x.get() + 4 * r))
                         .squaredNorm());
    const double farthest = std::sqrt(farthest2);
    evaluate(x.get(), g.get());
    if (farthest > 0) {
      const double share = std::min(1.0, probe / farthest);
      for (std::ptrdiff_t i = 0; i < 4 * system.rows; ++i)
        trial[static_cast<std::size_t>(i)] =
            x[static_cast<std::size_t>(i)] +
            share * (moved[static_cast<std::size_t>(i)] - x[static_cast<std::size_t>(i)]);
      evaluate(trial.get(), next_g.get());
      for (std::ptrdiff_t i = 0; i < 4 * system.free; ++i)
        g[static_cast<std::size_t>(i)] +=
            (next_g[static_cast<std::size_t>(i)] - g[static_cast<std::size_t>(i)]) / share;
    }
    if (!has_factor || factor_inverse_time_step2 != system.inverse_time_step2) {
      drop_job();
      factorise_now(x.get(), g.get());
    }
    Contacts contacts = detect(scene, moved.get(), 1);
    transform(g.get(), contacts);
    Step step{float_vector(size()), float_vector(size())};
    find_step(contacts, step);
    const double reach = std::max(farthest, longest(step.p.get()));
    if (!(reach <= longest_lead) || !std::isfinite(reach)) {
      system.sliding = sliding_before;
      return std::isfinite(reach) ? reach : 2 * longest_lead;
    }
    keep_pushes(contacts);
    advance(moved.get(), step.p.get(), std::min(1.0, 2 * options.longest_lead / reach), x.get());
    fresh = false;
    return reach;
  }

  /// `lead`: how far the predictor went, if it may be good enough by itself; 0 if not.
  SolveStatistics descend(ContactScene* scene, double lead, double step_tolerance, int max_iterations);
  SolveStatistics solve(const MatrixX3d& pins, ContactScene* scene);
};

SolveStatistics TissueSolver::Parts::descend(ContactScene* scene, double lead, double step_tolerance,
                                             int max_iterations) {
  SolveStatistics statistics;
  Step step{float_vector(size()), float_vector(size())};
  FloatVector last_p = float_vector(size());
  AlignedDoubles apart = zero_doubles(4 * system.rows);
  bool has_apart = false;  // the last state without penetration
  double last_length2 = 0, relaxation = 1;
  double scale2 = 0;
  double energy = evaluate(x.get(), g.get(), &scale2);
  bool is_judged = false;
  const auto judge = [&](double reach) {
    is_judged = true;
    statistics.residual = residual(contact, g.get(), scale2);
    statistics.penetration = deepest(contact);
    statistics.contacts = static_cast<int>((contact.multipliers.array() > 0).count());
    statistics.converged = reach <= step_tolerance && statistics.residual <= options.residual_tolerance &&
                           statistics.penetration <= options.penetration_tolerance;
  };
  const double share = correction_shares.empty()
                           ? std::numeric_limits<double>::infinity()
                           : *std::max_element(correction_shares.begin(), correction_shares.end());
  const bool may_suffice = lead > 0 && uncorrected < most_uncorrected && share * lead <= 0.5 * step_tolerance;
  contact = detect(scene, x.get(), may_suffice ? 0 : 1);
  if (may_suffice) {
    judge(share * lead);
    statistics.last_step = share * lead;
    if (statistics.converged) {
      ++uncorrected;
      statistics.energy = energy;
      return statistics;
    }
  }
  transform(g.get(), contact);
  std::copy_n(hat.get(), size(), last_hat.get());
  memory.start(hat.get());
  int on_factor = 0, renewed = 0;
  const auto start = std::chrono::steady_clock::now();
  const auto note = [&](double length, double reach) {
    if (options.trace == nullptr) return;
    TraceEntry entry;
    entry.iteration = statistics.iterations;
    entry.round = renewed;
    entry.energy = energy;
    entry.residual = residual(contact, g.get(), scale2);
    entry.contacts = static_cast<int>((contact.multipliers.array() > 0).count());
    entry.violation = deepest(contact);
    entry.step_length = length;
    entry.last_step = length * reach;
    entry.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    options.trace->push_back(entry);
  };
  const auto renew_factor = [&] {
    drop_job();
    factorise_now(x.get(), g.get());
    on_factor = 0;
    relaxation = 1;
    ++renewed;
    transform(g.get(), contact);
    std::copy_n(hat.get(), size(), last_hat.get());
    memory.start(hat.get());
  };
  double last_seen = lead;
  while (statistics.iterations < max_iterations) {
    ++statistics.iterations;
    if (on_factor++ == patience) renew_factor();
    const VectorXd before = contact.multipliers;
    find_step(contact, step);
    const double reach = longest(step.p.get());
    // How many steps are left, by how much this one is shorter than the last.
    const double seen = longest_watched(step.p.get());
    const double rate = std::clamp(seen / std::max(last_seen, 1e-12), 0.05, 0.9);
    const double expected = std::log(std::max(seen / step_tolerance, 1.0)) / -std::log(rate);
    last_seen = seen;
    if (!std::isfinite(reach) || (!fresh && expected > cheap_iterations && on_factor > 1)) {
      if (fresh) break;
      contact.multipliers = before;
      renew_factor();
      continue;
    }
    if (statistics.iterations == 1 && lead > 0) {
      uncorrected = 0;
      if (correction_shares.size() == remembered_shares) correction_shares.erase(correction_shares.begin());
      correction_shares.push_back(longest_watched(step.p.get()) / lead);
    }
    const double contact_work = step.contact_work + work_of(contact, before, step.p.get());
    const double decrease = contact_work - slope(g.get(), step.p.get());
    const Eigen::VectorXd products = dots({last_p.get(), step.p.get()}, step.p.get(), size());
    if (!contact.rows.empty() && statistics.iterations > settle &&
        products[0] < -0.3 * std::sqrt(products[1] * last_length2))
      relaxation *= 0.6;
    else
      relaxation = std::min(1.0, 1.1 * relaxation);
    std::copy_n(step.p.get(), size(), last_p.get());
    last_length2 = products[1];
    double alpha = relaxation;
    if (alpha * reach > options.longest_step) alpha = options.longest_step / reach;
    const double rounding = energy_rounding * std::abs(energy) + 1e-16;
    double next_energy = energy;
    bool accepted = false;
    for (int halving = 0; halving < (fresh ? 16 : 2) && std::isfinite(reach); ++halving, alpha *= 0.5) {
      advance(x.get(), step.p.get(), alpha, trial.get());
      next_energy = evaluate(trial.get(), next_g.get(), &scale2);
      if (next_energy - alpha * contact_work <= energy - 1e-4 * alpha * decrease + rounding) {
        accepted = true;
        break;
      }
    }
    if (!accepted) {
      note(0, reach);
      if (memory.pairs() > 0 || !fresh) {
        contact.multipliers = before;
        renew_factor();
        continue;
      }
      system.put_on_slides(x.get());  // the energy is as low as rounding lets it be seen
      evaluate(x.get(), g.get(), &scale2);
      judge(seen);
      statistics.last_step = seen;
      break;
    }
    note(alpha, reach);
    is_judged = false;
    std::copy_n(trial.get(), 4 * system.rows, x.get());
    std::swap(g, next_g);
    energy = next_energy;
    fresh = false;
    keep_pushes(contact);
    statistics.last_step = seen * std::min(1.0, alpha / relaxation);
    const bool last = statistics.iterations == max_iterations;
    const bool stalled = relaxation < 0.2 && alpha * seen <= step_tolerance;
    const bool judged = statistics.last_step <= step_tolerance || last || stalled;
    contact = detect(scene, x.get(), judged ? 0 : 1 / relaxation);
    if (judged) judge(statistics.last_step);
    if (scene != nullptr && statistics.iterations > settle && deepest(contact) <= options.penetration_tolerance) {
      std::copy_n(x.get(), 4 * system.rows, apart.get());
      has_apart = true;
    }
    if (last || stalled || statistics.converged) break;
    transform(g.get(), contact);
    if (options.history > 0) {
      // The pair in the coordinates of the factor: step and change of the gradient.
      FloatVector s = float_vector(size()), y = float_vector(size());
      combine({step.hat.get()}, Eigen::VectorXf::Constant(1, static_cast<float>(alpha)), s.get(), size());
      combine({hat.get(), last_hat.get()}, Eigen::Vector2f(1, -1), y.get(), size());
      memory.add(s.get(), y.get(), y.get(), hat.get());
    }
    std::copy_n(hat.get(), size(), last_hat.get());
  }
  if (!is_judged) {
    contact = detect(scene, x.get(), 0);
    judge(statistics.last_step);
  }
  if (has_apart && statistics.penetration > options.penetration_tolerance) {
    // Two states took turns; of the two, the one without penetration.
    std::copy_n(apart.get(), 4 * system.rows, x.get());
    system.put_on_slides(x.get());
    contact = detect(scene, x.get(), 0);
    energy = evaluate(x.get(), g.get(), &scale2);
    judge(statistics.last_step);
  }
  statistics.energy = energy;
  return statistics;
}

SolveStatistics TissueSolver::Parts::solve(const MatrixX3d& pins, ContactScene* scene) {
  const auto start = std::chrono::steady_clock::now();
  if (pins.rows() != system.body.rest.rows() || !pins.allFinite())
    reject("tissue solve", "needs a finite position for every vertex");
  ++counts.solves;
  take_job();
  const std::vector<double> backup(x.get(), x.get() + 4 * system.rows);
  int iterations = 0;
  const double lead = settled ? predict(pins, scene, options.longest_lead) : 0;
  if (!settled) {
    for (std::ptrdiff_t r = system.free; r < system.rows; ++r)
      Eigen::Map<Vector3d>(x.get() + 4 * r) = pins.row(system.vertex_of[r]).transpose();
    system.put_on_slides(x.get());
    evaluate(x.get(), g.get());
    drop_job();
    factorise_now(x.get(), g.get());
  } else if (lead > options.longest_lead) {
    // A jump: go there in parts, so that lips meet where they would meet in motion.
    const std::vector<float> stretch(system.blocks.stretch.get(), system.blocks.stretch.get() + solved_stretch.size());
    const std::vector<Slide> slides = system.body.slides;
    MatrixX3d from = pins;
    system.store(x.get(), from);
    constexpr double most_parts = 50;
    const int parts = static_cast<int>(std::clamp(std::ceil(lead / options.longest_lead), 2.0, most_parts));
    for (int part = 1; part <= parts; ++part) {
      const double share = static_cast<double>(part) / parts;
      for (std::size_t i = 0; i < stretch.size(); ++i)
        system.blocks.stretch[i] =
            static_cast<float>(1 - share) * solved_stretch[i] + static_cast<float>(share) * stretch[i];
      for (std::size_t s = 0; s < slides.size(); ++s) {
        Slide& slide = system.body.slides[s];
        slide.point = (1 - share) * solved_slides[s].point + share * slides[s].point;
        slide.normal = ((1 - share) * solved_slides[s].normal + share * slides[s].normal).normalized();
        slide.bend = (1 - share) * solved_slides[s].bend + share * slides[s].bend;
      }
      predict((1 - share) * from + share * pins, scene, std::numeric_limits<double>::infinity());
      if (part < parts) iterations += descend(scene, 0, std::max(options.step_tolerance, 3e-4), 6).iterations;
    }
  }
  const bool in_one = settled && lead <= options.longest_lead;
  SolveStatistics statistics = descend(scene, in_one ? lead : 0, options.step_tolerance, options.max_iterations);
  statistics.iterations += iterations;
  counts.iterations += statistics.iterations;
  if (!std::all_of(x.get(), x.get() + 4 * system.rows, [](double value) { return std::isfinite(value); })) {
    std::copy(backup.begin(), backup.end(), x.get());
    statistics.converged = false;
    has_factor = false;
  }
  settled = statistics.converged;
  remember_targets();
  ++served;
  if (job_due < 0 && has_factor &&
      (statistics.iterations > options.refresh_iterations || served >= options.refresh_solves))
    start_job();
  system.store(x.get(), positions);
  statistics.volume_change = system.volume(x.get()) / system.rest_volume - 1;
  statistics.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return statistics;
}

TissueSolver::TissueSolver(const TissueBody& body, const TissueSolverOptions& options)
    : parts_(std::make_unique<Parts>(body, options)) {}
TissueSolver::~TissueSolver() = default;
TissueSolver::TissueSolver(TissueSolver&&) noexcept = default;
TissueSolver& TissueSolver::operator=(TissueSolver&&) noexcept = default;

const TissueBody& TissueSolver::body() const {
  return parts_->system.body;
}
TissueSolverOptions& TissueSolver::options() {
  return parts_->options;
}

void TissueSolver::set_activation(const std::vector<Matrix3d>& stretches) {
  if (static_cast<Eigen::Index>(stretches.size()) != parts_->system.body.tets.rows())
    reject("activation", "needs one stretch for every tet");
  for (std::size_t t = 0; t < stretches.size(); ++t) {
    if (!stretches[t].allFinite() || (stretches[t] - stretches[t].transpose()).norm() > 1e-9)
      reject("activation", "the stretch of tet " + std::to_string(t) + " is not symmetric");
    parts_->system.blocks.set_stretch(static_cast<std::ptrdiff_t>(t), stretches[t]);
  }
}

void TissueSolver::set_activation(const VectorXi& tets,
                                  const Eigen::Matrix<float, Eigen::Dynamic, 6, Eigen::RowMajor>& stretches) {
  TissueBlocks& blocks = parts_->system.blocks;
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
  std::vector<Slide>& mine = parts_->system.body.slides;
  if (slides.size() != mine.size()) reject("slides", "must be those of the body, in its order");
  for (std::size_t s = 0; s < slides.size(); ++s)
    if (slides[s].vertex != mine[s].vertex || !slides[s].point.allFinite() || !slides[s].normal.allFinite() ||
        !slides[s].bend.allFinite())
      reject("slides", "number " + std::to_string(s) + " is not finite or of another vertex");
  mine = slides;
}

void TissueSolver::set_forces(const MatrixX3d& forces) {
  if (forces.rows() != 0 && (forces.rows() != parts_->system.rows || !forces.allFinite()))
    reject("forces", "need one finite force for every vertex");
  parts_->system.set_forces(forces);
}

void TissueSolver::set_inertia(double time_step, const MatrixX3d& prediction) {
  TissueSystem& system = parts_->system;
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
  Parts& p = *parts_;
  if (!(slack >= 1) || (vertices.size() > 0 && (vertices.minCoeff() < 0 || vertices.maxCoeff() >= p.system.rows)))
    reject("watched vertices", "must be vertices of the body, the slack at least 1");
  std::fill(p.weight2.begin(), p.weight2.end(), static_cast<float>(1 / (slack * slack)));
  for (const int v : vertices)
    if (p.system.row_of[v] < p.system.free) p.weight2[static_cast<std::size_t>(p.system.row_of[v])] = 1;
}

void TissueSolver::restart(const MatrixX3d& positions) {
  Parts& p = *parts_;
  if (positions.rows() != p.system.rows || !positions.allFinite())
    reject("tissue solver", "needs a finite position for every vertex to start from");
  p.drop_job();
  p.has_factor = false;
  p.forget_curvature();
  p.pushes.clear();
  p.start_from(positions);
}

const MatrixX3d& TissueSolver::positions() const {
  return parts_->positions;
}

SolveStatistics TissueSolver::solve(const MatrixX3d& pins, ContactScene* contacts) {
  return parts_->solve(pins, contacts);
}

MatrixX3d TissueSolver::contact_forces() const {
  const Parts& p = *parts_;
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
  return parts_->counts;
}

}  // namespace phiz
