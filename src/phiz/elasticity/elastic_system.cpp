// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/elasticity/elastic_system.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include "phiz/core/error.h"
#include "phiz/core/parallel.h"
#include "phiz/geometry/operators.h"

namespace phiz {

namespace {

constexpr std::ptrdiff_t block_grain = 32;
constexpr std::ptrdiff_t row_grain = 512;

void check(const ElasticBody& body) {
  const Eigen::Index n = body.rest.rows();
  if (static_cast<Eigen::Index>(body.fixed.size()) != n || body.stiffness.size() != body.tets.rows())
    reject("elastic body", "needs one fixed flag per vertex and one stiffness per tet");
  if (!body.rest.allFinite()) reject("elastic body", "a rest position is not a number");
  if (body.tets.rows() == 0) reject("elastic body", "has no tets");
  if (body.tets.minCoeff() < 0 || body.tets.maxCoeff() >= n)
    reject("elastic body", "a tet names a vertex that does not exist");
  if (!(body.stiffness.minCoeff() > 0) || !body.stiffness.allFinite())
    reject("elastic body", "stiffness must be positive");
  if (body.target_share.size() > 0 &&
      (body.target_share.size() != body.tets.rows() || !(body.target_share.minCoeff() >= 0)))
    reject("elastic body", "needs one target share per tet, not negative");
  const double least = std::min({body.weights.target, body.weights.shape, body.weights.volume});
  if (!(least >= 0) || !(body.weights.target + body.weights.shape + body.weights.volume > 0))
    reject("elastic body", "term weights must not be negative, nor all zero");
  for (const Attachment& a : body.attachments)
    if (a.vertex < 0 || a.vertex >= n || !(a.weight >= 0) || !a.point.allFinite())
      reject("elastic body", "an attachment names no vertex, or its weight or point is not usable");
  if (body.time_step < 0 || (body.time_step > 0 && (body.mass.size() != n || !(body.mass.minCoeff() >= 0))))
    reject("elastic body", "dynamics needs a mass per vertex and a positive time step");
}

template <class T>
ElementForces<T> element_forces(const MatrixX3d& rest, const MatrixX4i& tets, const VectorXd& stiffness,
                                const VectorXd& share) {
  ElementForces<T> elements{ElementBlocks<T>(rest, tets, stiffness, share), nullptr};
  elements.corners =
      hwy::AllocateAligned<T>(static_cast<std::size_t>(16 * elements.blocks.blocks * ElementBlocks<T>::width));
  return elements;
}

/// Fails if a piece of connected vertices has nothing to hold it. `anchored`: per vertex.
void check_anchors(const ElasticBody& body, std::vector<char> anchored) {
  std::vector<int> parent(anchored.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&parent](int v) {
    while (parent[static_cast<std::size_t>(v)] != v)
      v = parent[static_cast<std::size_t>(v)] = parent[static_cast<std::size_t>(parent[static_cast<std::size_t>(v)])];
    return v;
  };
  for (Eigen::Index t = 0; t < body.tets.rows(); ++t)
    for (int c = 1; c < 4; ++c) {
      const int a = root(body.tets(t, 0)), b = root(body.tets(t, c));
      parent[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
    }
  for (std::size_t v = 0; v < anchored.size(); ++v)
    if (anchored[v]) anchored[static_cast<std::size_t>(root(static_cast<int>(v)))] = 1;
  for (Eigen::Index t = 0; t < body.tets.rows(); ++t)
    if (!anchored[static_cast<std::size_t>(root(body.tets(t, 0)))])
      fail("the piece of flesh with tet " + std::to_string(t) + " hangs on nothing",
           "every connected piece must touch a fixed vertex, carry an attachment or have mass");
}

}  // namespace

ElasticSystem::ElasticSystem(const ElasticBody& body, const VectorXi& contact_vertices)
    : vertices(body.rest.rows()), weights(body.weights), attachments(body.attachments) {
  check(body);
  // Quadratic part: 2 sum_w (weights) stiffness V G^T G + 2 attachments + M / h^2, over the free vertices.
  const VectorXd share = body.target_share.size() > 0 ? body.target_share : VectorXd::Ones(body.tets.rows());
  const VectorXd total = (weights.shape + weights.volume + weights.target * share.array()).matrix();
  const SparseMatrixd A = tet_laplacian(body.rest, body.tets, 2 * total.cwiseProduct(body.stiffness));
  std::vector<char> used(static_cast<std::size_t>(vertices), 0);
  for (Eigen::Index i = 0; i < body.tets.size(); ++i) used[static_cast<std::size_t>(body.tets.data()[i])] = 1;
  VectorXd diagonal = VectorXd::Zero(vertices);
  for (const Attachment& a : attachments) diagonal[a.vertex] += 2 * a.weight;
  VectorXd inertia_of;
  if (body.time_step > 0) {
    inertia_of = body.mass / (body.time_step * body.time_step);
    diagonal += inertia_of;
  }
  std::vector<char> anchored = body.fixed;
  for (std::size_t v = 0; v < anchored.size(); ++v)
    if (diagonal[static_cast<Eigen::Index>(v)] > 0) anchored[v] = 1;
  check_anchors(body, std::move(anchored));
  std::vector<int> free_vertices, others;
  for (int v = 0; v < vertices; ++v)
    (used[static_cast<std::size_t>(v)] && !body.fixed[static_cast<std::size_t>(v)] ? free_vertices : others)
        .push_back(v);
  if (free_vertices.empty()) reject("elastic body", "no vertex is free to move");
  free = static_cast<std::ptrdiff_t>(free_vertices.size());

  std::vector<int> local(static_cast<std::size_t>(vertices), -1);
  for (std::size_t i = 0; i < free_vertices.size(); ++i)
    local[static_cast<std::size_t>(free_vertices[i])] = static_cast<int>(i);
  const auto restrict_to = [&](const std::vector<int>& row) {
    std::vector<Eigen::Triplet<double>> entries;
    for (const int v : free_vertices) {
      const int i = row[static_cast<std::size_t>(v)];
      entries.emplace_back(i, i, diagonal[v]);
      for (SparseMatrixd::InnerIterator it(A, v); it; ++it)
        if (row[static_cast<std::size_t>(it.col())] >= 0)
          entries.emplace_back(i, row[static_cast<std::size_t>(it.col())], it.value());
    }
    SparseMatrixd out(free, free);
    out.setFromTriplets(entries.begin(), entries.end());
    return out;
  };
  const VectorXi order = elimination_order(restrict_to(local));
  row_of = VectorXi::Constant(vertices, -1);
  for (std::ptrdiff_t i = 0; i < free; ++i)
    row_of[free_vertices[static_cast<std::size_t>(order[i])]] = static_cast<int>(i);
  std::vector<int> permuted(static_cast<std::size_t>(vertices), -1);
  for (const int v : free_vertices) permuted[static_cast<std::size_t>(v)] = row_of[v];
  const SparseMatrixd system = restrict_to(permuted);
  smallest_force = 1e-6 * system.diagonal().norm();
  smallest_energy = 0.5e-18 * system.diagonal().sum();
  solver = std::make_unique<VertexSolver>(system);
  for (std::size_t i = 0; i < others.size(); ++i)
    row_of[others[i]] = static_cast<int>(free + static_cast<std::ptrdiff_t>(i));
  for (Attachment& a : attachments) a.vertex = row_of[a.vertex];
  if (inertia_of.size() > 0) {
    inertia.resize(vertices);
    for (int v = 0; v < vertices; ++v) inertia[row_of[v]] = inertia_of[v];
  }

  // Tets in the order of their lowest row, so that neighbours in memory are neighbours in space.
  std::vector<int> sequence(static_cast<std::size_t>(body.tets.rows()));
  std::iota(sequence.begin(), sequence.end(), 0);
  MatrixX4i rows(body.tets.rows(), 4);
  for (Eigen::Index t = 0; t < rows.rows(); ++t)
    for (int c = 0; c < 4; ++c) rows(t, c) = row_of[body.tets(t, c)];
  std::stable_sort(sequence.begin(), sequence.end(),
                   [&](int a, int b) { return rows.row(a).minCoeff() < rows.row(b).minCoeff(); });
  MatrixX4i sorted(rows.rows(), 4);
  VectorXd stiffness(rows.rows()), sorted_share(rows.rows());
  slot_of.resize(sequence.size());
  for (std::size_t s = 0; s < sequence.size(); ++s) {
    sorted.row(static_cast<Eigen::Index>(s)) = rows.row(sequence[s]);
    stiffness[static_cast<Eigen::Index>(s)] = body.stiffness[sequence[s]];
    sorted_share[static_cast<Eigen::Index>(s)] = share[sequence[s]];
    slot_of[static_cast<std::size_t>(sequence[s])] = static_cast<std::ptrdiff_t>(s);
  }
  MatrixX3d rest(vertices, 3);
  for (int v = 0; v < vertices; ++v) rest.row(row_of[v]) = body.rest.row(v);
  if (body.precision == Precision::single)
    elements = element_forces<float>(rest, sorted, stiffness, sorted_share);
  else
    elements = element_forces<double>(rest, sorted, stiffness, sorted_share);
  energy_rounding = body.precision == Precision::single ? 3e-8 : 1e-13;

  incidence_start.assign(static_cast<std::size_t>(vertices) + 1, 0);
  for (Eigen::Index i = 0; i < sorted.size(); ++i) ++incidence_start[static_cast<std::size_t>(sorted.data()[i]) + 1];
  std::partial_sum(incidence_start.begin(), incidence_start.end(), incidence_start.begin());
  incidence.resize(static_cast<std::size_t>(sorted.size()));
  std::vector<int> fill(incidence_start.begin(), incidence_start.end() - 1);
  std::visit(
      [&]<class T>(const ElementForces<T>&) {
        for (Eigen::Index s = 0; s < sorted.rows(); ++s)
          for (int c = 0; c < 4; ++c)
            incidence[static_cast<std::size_t>(fill[static_cast<std::size_t>(sorted(s, c))]++)] =
                static_cast<int>(ElementBlocks<T>::at(s, 4, c));
      },
      elements);
  prediction = hwy::AllocateAligned<double>(static_cast<std::size_t>(4 * vertices));
  force = hwy::AllocateAligned<double>(static_cast<std::size_t>(4 * vertices));
  std::fill_n(force.get(), 4 * vertices, 0.0);
  load(body.rest, prediction.get());
  rest_volume = volume(prediction.get());

  compliance_row = VectorXi::Constant(free, -1);
  std::vector<int> contact_rows;
  for (const int v : contact_vertices) {
    if (v < 0 || v >= vertices) reject("elastic body", "a contact vertex does not exist");
    if (row_of[v] < free) contact_rows.push_back(row_of[v]);
  }
  std::sort(contact_rows.begin(), contact_rows.end());
  contact_rows.erase(std::unique(contact_rows.begin(), contact_rows.end()), contact_rows.end());
  for (std::size_t k = 0; k < contact_rows.size(); ++k) compliance_row[contact_rows[k]] = static_cast<int>(k);
  compliance = solver->inverse_block(
      Eigen::Map<const VectorXi>(contact_rows.data(), static_cast<Eigen::Index>(contact_rows.size())));
}

void ElasticSystem::load(const MatrixX3d& positions, double* x) const {
  for (std::ptrdiff_t v = 0; v < vertices; ++v) {
    double* p = x + 4 * static_cast<std::ptrdiff_t>(row_of[v]);
    for (int k = 0; k < 3; ++k) p[k] = positions(v, k);
    p[3] = 0;
  }
}

void ElasticSystem::store(const double* x, MatrixX3d& positions) const {
  for (std::ptrdiff_t v = 0; v < vertices; ++v)
    for (int k = 0; k < 3; ++k) positions(v, k) = x[4 * static_cast<std::ptrdiff_t>(row_of[v]) + k];
}

void ElasticSystem::set_target(std::ptrdiff_t tet, const Matrix3d& F, const Matrix3d& stretch) {
  const std::ptrdiff_t slot = slot_of[static_cast<std::size_t>(tet)];
  constexpr int place[6] = {0, 4, 8, 3, 6, 7};
  std::visit(
      [&]<class T>(ElementForces<T>& e) {
        for (int k = 0; k < 9; ++k) e.blocks.target[ElementBlocks<T>::at(slot, 9, k)] = static_cast<T>(F.data()[k]);
        for (int k = 0; k < 6; ++k)
          e.blocks.stretch[ElementBlocks<T>::at(slot, 6, k)] = static_cast<T>(stretch.data()[place[k]]);
      },
      elements);
}

double ElasticSystem::volume(const double* x) const {
  return std::visit(
      [&](const auto& e) {
        return parallel_sum(e.blocks.tets, row_grain, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
          return deformed_volume(e.blocks, x, begin, end);
        });
      },
      elements);
}

template <class Out>
double ElasticSystem::evaluate(const double* x, Out* gradient, std::ptrdiff_t rows) {
  using Row = Eigen::Map<Eigen::Vector4<Out>>;
  double energy = std::visit(
      [&]<class T>(ElementForces<T>& e) {
        const double sum = parallel_sum(e.blocks.blocks, block_grain, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
          return evaluate_elements(e.blocks, weights, x, e.corners.get(), begin, end);
        });
        return sum + parallel_sum(rows, row_grain, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                 double part = 0;
                 for (std::ptrdiff_t r = begin; r < end; ++r) {
                   Eigen::Vector4<T> sum_of_tets = Eigen::Vector4<T>::Zero();
                   for (const int corner : corners_of(r))
                     sum_of_tets += Eigen::Map<const Eigen::Vector4<T>, Eigen::Aligned16>(
                         e.corners.get() + 4 * static_cast<std::ptrdiff_t>(corner));
                   Eigen::Vector4d g = sum_of_tets.template cast<double>();
                   part += add_inertia_and_forces(x, r, g);
                   Row(gradient + 4 * r) = g.template cast<Out>();
                 }
                 return part;
               });
      },
      elements);
  for (const Attachment& a : attachments) {
    if (a.vertex >= rows) continue;
    const Vector3d d = Eigen::Map<const Vector3d>(x + 4 * static_cast<std::ptrdiff_t>(a.vertex)) - a.point;
    const bool plane = !a.normal.isZero();
    const Vector3d pull = plane ? Vector3d(a.normal.dot(d) * a.normal) : d;
    energy += a.weight * pull.squaredNorm();
    Row(gradient + 4 * static_cast<std::ptrdiff_t>(a.vertex)).template head<3>() +=
        (2 * a.weight * pull).template cast<Out>();
  }
  return energy;
}

template double ElasticSystem::evaluate(const double*, float*, std::ptrdiff_t);
template double ElasticSystem::evaluate(const double*, double*, std::ptrdiff_t);

double ElasticSystem::add_inertia_and_forces(const double* x, std::ptrdiff_t row, Eigen::Vector4d& gradient) const {
  double energy = 0;
  const Eigen::Map<const Eigen::Vector4d> p(x + 4 * row);
  if (inertia.size() > 0) {
    const Eigen::Vector4d d = p - Eigen::Map<const Eigen::Vector4d>(prediction.get() + 4 * row);
    energy += 0.5 * inertia[row] * d.squaredNorm();
    gradient += inertia[row] * d;
  }
  if (has_force) {
    const Eigen::Map<const Eigen::Vector4d> f(force.get() + 4 * row);
    energy -= f.dot(p);
    gradient -= f;
  }
  return energy;
}

double ElasticSystem::force_scale() const {
  const double squares = std::visit(
      [&]<class T>(const ElementForces<T>& e) {
        return parallel_sum(free, row_grain, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
          double sum = 0;
          for (std::ptrdiff_t r = begin; r < end; ++r) {
            double magnitude = 0;
            for (const int corner : corners_of(r))
              magnitude += static_cast<double>(
                  Eigen::Map<const Eigen::Vector3<T>>(e.corners.get() + 4 * static_cast<std::ptrdiff_t>(corner))
                      .norm());
            sum += magnitude * magnitude;
          }
          return sum;
        });
      },
      elements);
  return std::max(smallest_force, std::sqrt(squares));
}

}  // namespace phiz
