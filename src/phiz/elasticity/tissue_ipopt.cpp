// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/elasticity/tissue_ipopt.h"

#include <IpIpoptApplication.hpp>
#include <IpTNLP.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>

#include "phiz/core/error.h"
#include "phiz/elasticity/contact_planes.h"
#include "phiz/elasticity/static_residual.h"

namespace phiz {

namespace {

using Clock = std::chrono::steady_clock;
using Ipopt::Index;
using Ipopt::Number;

/// Whether each vertex has a slide that is curved.
std::vector<char> on_curves(const TissueBody& body) {
  std::vector<char> out(static_cast<std::size_t>(body.rest.rows()), 0);
  for (const Slide& slide : body.slides)
    if (slide.bend != Matrix3d::Zero() && body.pinned[static_cast<std::size_t>(slide.vertex)] == 0)
      out[static_cast<std::size_t>(slide.vertex)] = 1;
  return out;
}

/// The energy with the slides that are eliminated from the unknowns.
TissueEnergy with_flat_slides(const TissueEnergy& energy, const std::vector<char>& curved) {
  std::vector<Slide> flat;
  for (const Slide& slide : energy.body().slides)
    if (curved[static_cast<std::size_t>(slide.vertex)] == 0) flat.push_back(slide);
  TissueEnergy out = energy;
  out.set_slides(flat);
  return out;
}

std::vector<Slide> curved_slides(const TissueBody& body, const std::vector<char>& curved) {
  std::vector<Slide> out;
  for (const Slide& slide : body.slides)
    if (curved[static_cast<std::size_t>(slide.vertex)] != 0) out.push_back(slide);
  return out;
}

/// The problem in units in which its numbers are near 1: unknowns in `unit_length` from where they start, energy in
/// `unit_force` * `unit_length`. Constraints: gaps of the planes, then heights over the curved slides.
class StaticProgram : public Ipopt::TNLP {
 public:
  StaticProgram(const TissueEnergy& energy, const std::vector<Slide>& curves, const FreeMotion& motion,
                const MatrixX3d& x)
      : energy_(energy), curves_(curves), motion_(motion), pattern_(energy.hessian(x, motion, Stiffness::exact)) {
    for (Eigen::Index row = 0; row < pattern_.rows(); ++row)
      for (SparseMatrixd::InnerIterator it(pattern_, row); it; ++it)
        if (it.col() <= row) ++lower_;
  }

  /// Before each round.
  void start(const MatrixX3d& x, const ContactPlanes& planes, const VectorXd& pressures, double unit_force) {
    origin_ = x;
    x_ = x;
    planes_ = &planes;
    unit_force_ = unit_force;
    multipliers_ = VectorXd::Zero(rows());
    multipliers_.head(planes.size()) = -pressures / unit_force;
    if (curve_multipliers_.size() == rows() - planes.size())
      multipliers_.tail(rows() - planes.size()) = curve_multipliers_ / unit_force;
    gap_rows_ = planes.derivative(motion_);
  }
  void report_to(Trace* trace, int round, Clock::time_point since) {
    trace_ = trace;
    round_ = round;
    since_ = since;
  }

  const MatrixX3d& solution() const { return x_; }
  VectorXd pressures() const { return (-unit_force_ * multipliers_.head(planes_->size())).cwiseMax(0.0); }
  int iterations() const { return iterations_; }
  void limit_iterations(int most) { most_iterations_ = most; }

  bool get_nlp_info(Index& n, Index& m, Index& nnz_jac_g, Index& nnz_h_lag, IndexStyleEnum& index_style) override {
    n = static_cast<Index>(motion_.size());
    m = static_cast<Index>(rows());
    nnz_jac_g = 0;
    for (Eigen::Index i = 0; i < planes_->size(); ++i) nnz_jac_g += gap_entries(i);
    nnz_jac_g += static_cast<Index>(3 * curves_.size());
    nnz_h_lag = static_cast<Index>(lower_ + 6 * curves_.size());
    index_style = C_STYLE;
    return true;
  }

  bool get_bounds_info(Index n, Number* x_l, Number* x_u, Index m, Number* g_l, Number* g_u) override {
    constexpr Number infinity = 2e19;
    std::fill_n(x_l, n, -infinity);
    std::fill_n(x_u, n, infinity);
    std::fill_n(g_l, m, 0);
    std::fill_n(g_u, m, 0);
    std::fill_n(g_u, planes_->size(), infinity);
    return true;
  }

  bool get_starting_point(Index n, bool, Number* x, bool init_z, Number* z_L, Number* z_U, Index m, bool init_lambda,
                          Number* lambda) override {
    std::fill_n(x, n, 0);
    if (init_z) {
      std::fill_n(z_L, n, 0);
      std::fill_n(z_U, n, 0);
    }
    if (init_lambda) std::copy_n(multipliers_.data(), m, lambda);
    return true;
  }

  bool eval_f(Index, const Number* q, bool new_x, Number& value) override {
    move_to(q, new_x);
    value = energy_.value(x_) / (unit_force_ * unit_length);
    return std::isfinite(value);
  }

  bool eval_grad_f(Index n, const Number* q, bool new_x, Number* gradient) override {
    move_to(q, new_x);
    Eigen::Map<VectorXd>(gradient, n) = motion_.reduced(energy_.gradient(x_)) / unit_force_;
    return true;
  }

  bool eval_g(Index, const Number* q, bool new_x, Index m, Number* g) override {
    move_to(q, new_x);
    const Eigen::Matrix3Xd separation = planes_->separation(x_);
    Eigen::Map<VectorXd> out(g, m);
    out.head(planes_->size()) = separation.row(0).transpose() / unit_length;
    for (std::size_t s = 0; s < curves_.size(); ++s)
      g[planes_->size() + static_cast<Eigen::Index>(s)] = curves_[s].height(x_.row(curves_[s].vertex)) / unit_length;
    return true;
  }

  bool eval_jac_g(Index, const Number* q, bool new_x, Index, Index, Index* rows, Index* columns,
                  Number* values) override {
    if (values != nullptr) move_to(q, new_x);
    Index k = 0;
    for (Eigen::Index i = 0; i < planes_->size(); ++i)
      for (Eigen::SparseMatrix<double>::InnerIterator it(gap_rows_, 3 * i); it; ++it, ++k) {
        if (values != nullptr) {
          values[k] = it.value();
        } else {
          rows[k] = static_cast<Index>(i);
          columns[k] = static_cast<Index>(it.row());
        }
      }
    for (std::size_t s = 0; s < curves_.size(); ++s) {
      const int vertex = curves_[s].vertex;
      const Vector3d part =
          values == nullptr ? Vector3d::Zero()
                            : Vector3d(motion_.directions(vertex).transpose() * curves_[s].gradient(x_.row(vertex)));
      for (int c = 0; c < 3; ++c, ++k) {
        if (values != nullptr) {
          values[k] = part[c];
        } else {
          rows[k] = static_cast<Index>(planes_->size()) + static_cast<Index>(s);
          columns[k] = motion_.first(vertex) + c;
        }
      }
    }
    return true;
  }

  bool eval_h(Index, const Number* q, bool new_x, Number factor, Index, const Number* lambda, bool, Index, Index* rows,
              Index* columns, Number* values) override {
    Index k = 0;
    if (values != nullptr) move_to(q, new_x);
    const SparseMatrixd now = values != nullptr ? energy_.hessian(x_, motion_, Stiffness::exact) : SparseMatrixd();
    const SparseMatrixd& H = values != nullptr ? now : pattern_;
    const double unit = factor * unit_length / unit_force_;
    for (Eigen::Index row = 0; row < H.rows(); ++row)
      for (SparseMatrixd::InnerIterator it(H, row); it && it.col() <= row; ++it, ++k) {
        if (values != nullptr) {
          values[k] = unit * it.value();
        } else {
          rows[k] = static_cast<Index>(row);
          columns[k] = static_cast<Index>(it.col());
        }
      }
    for (std::size_t s = 0; s < curves_.size(); ++s) {
      const auto& directions = motion_.directions(curves_[s].vertex);
      const Matrix3d bend = -unit_length * directions.transpose() * curves_[s].bend * directions;
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b <= a; ++b, ++k) {
          if (values != nullptr) {
            values[k] = lambda[planes_->size() + static_cast<Eigen::Index>(s)] * bend(a, b);
          } else {
            rows[k] = motion_.first(curves_[s].vertex) + a;
            columns[k] = motion_.first(curves_[s].vertex) + b;
          }
        }
    }
    return true;
  }

  bool intermediate_callback(Ipopt::AlgorithmMode, Index iteration, Number value, Number violation, Number dual, Number,
                             Number step, Number, Number alpha, Number, Index, const Ipopt::IpoptData*,
                             Ipopt::IpoptCalculatedQuantities*) override {
    if (iteration == 0) return true;
    ++iterations_;
    if (trace_ != nullptr) {
      TraceEntry entry;
      entry.iteration = iterations_;
      entry.round = round_;
      entry.energy = value * unit_force_ * unit_length;
      entry.residual = dual;
      entry.violation = violation * unit_length;
      entry.step_length = alpha;
      entry.last_step = step * alpha * unit_length;
      entry.milliseconds = milliseconds_since(since_);
      trace_->push_back(entry);
    }
    return iterations_ < most_iterations_;
  }

  void finalize_solution(Ipopt::SolverReturn, Index, const Number* q, const Number*, const Number*, Index m,
                         const Number*, const Number* lambda, Number, const Ipopt::IpoptData*,
                         Ipopt::IpoptCalculatedQuantities*) override {
    move_to(q, true);
    multipliers_ = Eigen::Map<const VectorXd>(lambda, m);
    curve_multipliers_ = unit_force_ * multipliers_.tail(static_cast<Eigen::Index>(curves_.size()));
  }

 private:
  static constexpr double unit_length = 1e-3;  // metres

  Eigen::Index rows() const { return planes_->size() + static_cast<Eigen::Index>(curves_.size()); }
  Index gap_entries(Eigen::Index contact) const {
    return static_cast<Index>(gap_rows_.outerIndexPtr()[3 * contact + 1] - gap_rows_.outerIndexPtr()[3 * contact]);
  }
  void move_to(const Number* q, bool is_new) {
    if (!is_new) return;
    x_ = origin_ + unit_length * motion_.expanded(Eigen::Map<const VectorXd>(q, motion_.size()));
  }

  const TissueEnergy& energy_;
  const std::vector<Slide>& curves_;
  const FreeMotion& motion_;
  SparseMatrixd pattern_;
  std::size_t lower_ = 0;
  MatrixX3d origin_, x_;
  const ContactPlanes* planes_ = nullptr;
  Eigen::SparseMatrix<double> gap_rows_;
  VectorXd multipliers_, curve_multipliers_;
  double unit_force_ = 1;
  Trace* trace_ = nullptr;
  int round_ = 0;
  Clock::time_point since_;
  int iterations_ = 0, most_iterations_ = 0;
};

void set_options(Ipopt::OptionsList& list, const IpoptStaticOptions& options) {
  list.SetIntegerValue("print_level", 0);
  list.SetStringValue("sb", "yes");
  list.SetStringValue("linear_solver", options.linear_solver);
  if (options.linear_solver == "mumps") list.SetIntegerValue("mumps_pivot_order", options.mumps_pivot_order);
  list.SetStringValue("hessian_approximation", "exact");
  list.SetStringValue("nlp_scaling_method", "none");  // done by the units
  list.SetStringValue("jac_d_constant", "yes");
  list.SetNumericValue("bound_relax_factor", 0);
  list.SetIntegerValue("acceptable_iter", 0);
  list.SetNumericValue("warm_start_mult_bound_push", 1e-9);
}

/// Pressures of the contacts that were there before.
VectorXd carried_over(const std::vector<ContactForce>& before, const ContactPlanes& planes) {
  std::map<std::pair<int, int>, double> known;
  for (const ContactForce& force : before) known[{force.row.pair, force.row.vertices[0]}] += force.pressure;
  VectorXd out = VectorXd::Zero(planes.size());
  for (Eigen::Index i = 0; i < planes.size(); ++i) {
    const ContactRow& row = planes.rows()[static_cast<std::size_t>(i)];
    const auto found = known.find({row.pair, row.vertices[0]});
    if (found == known.end()) continue;
    out[i] = found->second;
    known.erase(found);
  }
  return out;
}

std::vector<ContactForce> forces_of(const ContactPlanes& planes, const VectorXd& pressures, const MatrixX3d& x) {
  const Eigen::Matrix3Xd separation = planes.separation(x);
  std::vector<ContactForce> out;
  for (Eigen::Index i = 0; i < planes.size(); ++i) {
    if (pressures[i] <= 0) continue;
    out.push_back({planes.rows()[static_cast<std::size_t>(i)], pressures[i], Vector3d::Zero()});
    out.back().row.gap = separation(0, i);
  }
  return out;
}

}  // namespace

SolveStatistics solve_static_with_ipopt(const TissueEnergy& energy, MatrixX3d& x, const IpoptStaticOptions& options,
                                        ContactScene* contacts, std::vector<ContactForce>* forces) {
  const Clock::time_point start = Clock::now();
  const TissueBody& body = energy.body();
  if (x.rows() != body.rest.rows() || !x.allFinite())
    reject("static solve", "needs " + std::to_string(body.rest.rows()) + " finite positions");
  put_on_slides(body, x);
  const std::vector<char> curved = on_curves(body);
  const std::vector<Slide> curves = curved_slides(body, curved);
  const TissueEnergy flat = with_flat_slides(energy, curved);
  const FreeMotion motion(flat.body(), x);
  SolveStatistics statistics;
  statistics.energy = energy.value(x);
  if (motion.size() == 0) {
    statistics.converged = true;
    return statistics;
  }
  const ForceScale force_scale(body);
  const Ipopt::SmartPtr<StaticProgram> program = new StaticProgram(flat, curves, motion, x);
  program->limit_iterations(options.max_iterations);
  const Ipopt::SmartPtr<Ipopt::IpoptApplication> application = new Ipopt::IpoptApplication(false);
  set_options(*application->Options(), options);
  if (application->Initialize("") != Ipopt::Solve_Succeeded) fail("IPOPT refused its options");

  VectorXd magnitude;
  energy.gradient(x, &magnitude);
  double scale = force_scale(motion, magnitude), digits = 1;
  constexpr double least_barrier = 1e-10;
  double barrier = options.warm_barrier;
  std::vector<ContactForce> pushing;
  for (int round = 0; round < options.max_rounds; ++round) {
    const ContactPlanes planes(contacts != nullptr ? detect_afresh(*contacts, x) : std::vector<ContactRow>(), motion, x,
                               x);
    const bool warm = !pushing.empty();
    const double loose = contacts == nullptr || round > 1 ? 0 : round == 0 ? 1e-3 : 1e-5;
    application->Options()->SetNumericValue("tol", std::max(loose, digits * options.residual_tolerance));
    application->Options()->SetStringValue("warm_start_init_point", warm ? "yes" : "no");
    application->Options()->SetNumericValue("mu_init", warm ? barrier : 0.1);
    // A slack s is pushed with barrier / s: not more than contact forces, which are near 1 in our units.
    for (const char* name : {"warm_start_slack_bound_push", "warm_start_slack_bound_frac"})
      application->Options()->SetNumericValue(name, 10 * barrier);
    if (warm) barrier = std::max(least_barrier, 0.01 * barrier);
    program->start(x, planes, carried_over(pushing, planes), scale / std::sqrt(static_cast<double>(motion.size())));
    program->report_to(options.trace, round, start);
    application->OptimizeTNLP(program);
    const MatrixX3d before = x;
    if (program->solution().allFinite()) x = program->solution();
    pushing = forces_of(planes, program->pressures(), x);

    // Judged without IPOPT.
    const FreeMotion exact_motion(body, x);
    const MatrixX3d left = energy.gradient(x, &magnitude) - sum_of_contact_forces(pushing, x.rows());
    scale = force_scale(exact_motion, magnitude);
    statistics.iterations = program->iterations();
    statistics.residual = exact_motion.reduced(left).norm() / scale;
    statistics.last_step = (x - before).rowwise().norm().maxCoeff();
    statistics.penetration = contacts != nullptr ? contacts->penetration(x) : 0;
    const bool settled = contacts == nullptr || (statistics.last_step <= options.state_tolerance &&
                                                 statistics.penetration <= options.penetration_tolerance);
    statistics.converged = statistics.residual <= options.residual_tolerance && settled;
    if (statistics.converged || statistics.iterations >= options.max_iterations) break;
    if (statistics.residual > options.residual_tolerance && loose == 0) {
      digits *= 0.1;
      if (digits < 1e-3) break;
    }
  }
  // The barrier leaves a little pressure on every plane.
  double most = 0;
  for (const ContactForce& force : pushing) most = std::max(most, force.pressure);
  statistics.contacts = static_cast<int>(std::count_if(
      pushing.begin(), pushing.end(), [most](const ContactForce& force) { return force.pressure > 1e-6 * most; }));
  statistics.energy = energy.value(x);
  statistics.volume_change = tet_volumes(x, body.tets).sum() / tet_volumes(body.rest, body.tets).sum() - 1;
  statistics.milliseconds = milliseconds_since(start);
  if (forces != nullptr) *forces = pushing;
  return statistics;
}

}  // namespace phiz
