// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/elasticity/tissue_system.h"

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "phiz/core/parallel.h"
#include "phiz/elasticity/static_residual.h"

namespace phiz {

namespace {

constexpr std::ptrdiff_t block_grain = 16, row_grain = 512, column_grain = 128;

Eigen::Map<const Vector3d> point(const double* x, std::ptrdiff_t row) {
  return Eigen::Map<const Vector3d>(x + 4 * row);
}

void for_chunks(bool parallel, std::ptrdiff_t count, std::ptrdiff_t grain,
                const std::function<void(std::ptrdiff_t, std::ptrdiff_t)>& body) {
  if (parallel)
    parallel_chunks(count, grain, body);
  else
    body(0, count);
}

/// The projector on what planes with these normals have in common.
Matrix3d common_directions(const MatrixX3d& normals) {
  if (normals.rows() == 1) return Matrix3d::Identity() - normals.row(0).transpose() * normals.row(0);
  Eigen::ColPivHouseholderQR<MatrixXd> qr(normals.transpose());
  qr.setThreshold(1e-6);
  const MatrixXd Q = MatrixXd(qr.householderQ()).leftCols(qr.rank());
  return Matrix3d::Identity() - Q * Q.transpose();
}

}  // namespace

AlignedDoubles zero_doubles(std::ptrdiff_t size) {
  AlignedDoubles out = hwy::AllocateAligned<double>(static_cast<std::size_t>(std::max<std::ptrdiff_t>(size, 1)));
  std::fill_n(out.get(), size, 0.0);
  return out;
}

TissueSystem::TissueSystem(const TissueBody& given) : body((validate(given), given)) {
  const Eigen::Index n = body.rest.rows();
  std::vector<char> used(static_cast<std::size_t>(n), 0);
  for (const int v : body.tets.reshaped()) used[static_cast<std::size_t>(v)] = 1;
  VectorXi moving = VectorXi::Constant(n, -1);
  int count = 0;
  for (Eigen::Index v = 0; v < n; ++v)
    if (used[static_cast<std::size_t>(v)] != 0 && body.pinned[static_cast<std::size_t>(v)] == 0) moving[v] = count++;
  free = count;
  const VectorXi order = elimination_order(block_pattern(body.tets, moving, count));
  VectorXi place(count);
  for (int i = 0; i < count; ++i) place[order[i]] = i;
  row_of = VectorXi::Constant(n, -1);
  rows = free;
  for (Eigen::Index v = 0; v < n; ++v) {
    if (moving[v] >= 0)
      row_of[v] = place[moving[v]];
    else
      row_of[v] = static_cast<int>(rows++);
  }
  vertex_of.resize(rows);
  for (Eigen::Index v = 0; v < n; ++v) vertex_of[row_of[v]] = static_cast<int>(v);
  blocks = TissueBlocks(body, row_of);

  VectorXi free_row(n);
  for (Eigen::Index v = 0; v < n; ++v) free_row[v] = row_of[v] < free ? row_of[v] : -1;
  pattern = block_pattern(body.tets, free_row, static_cast<int>(free));
  std::vector<std::vector<int>> sources(pattern.row.size());
  incidence_start_.assign(static_cast<std::size_t>(rows) + 1, 0);
  for (const int row : blocks.chunk_rows) ++incidence_start_[static_cast<std::size_t>(row) + 1];
  for (Eigen::Index t = 0; t < body.tets.rows(); ++t) {
    for (int pair = 0; pair < 10; ++pair) {
      const int a = free_row[body.tets(t, corner_pairs[pair][0])], b = free_row[body.tets(t, corner_pairs[pair][1])];
      if (a < 0 || b < 0) continue;
      const auto column = static_cast<std::size_t>(std::min(a, b));
      const auto found = std::lower_bound(pattern.row.begin() + pattern.start[column],
                                          pattern.row.begin() + pattern.start[column + 1], std::max(a, b));
      sources[static_cast<std::size_t>(found - pattern.row.begin())].push_back(2 * (10 * blocks.slot_of[t] + pair) +
                                                                               (a < b ? 1 : 0));
    }
  }
  source_start_.push_back(0);
  for (const std::vector<int>& list : sources) {
    source_.insert(source_.end(), list.begin(), list.end());
    source_start_.push_back(static_cast<int>(source_.size()));
  }
  std::partial_sum(incidence_start_.begin(), incidence_start_.end(), incidence_start_.begin());
  incidence_.resize(blocks.chunk_rows.size());
  std::vector<int> next(incidence_start_.begin(), incidence_start_.end() - 1);
  for (std::size_t i = 0; i < blocks.chunk_rows.size(); ++i)
    incidence_[static_cast<std::size_t>(next[static_cast<std::size_t>(blocks.chunk_rows[i])]++)] =
        static_cast<int>(4 * i);
  sums_ = hwy::AllocateAligned<float>(4 * blocks.chunk_rows.size());
  energies_.assign(static_cast<std::size_t>(blocks.chunks()), 0.0);

  sliding_of.assign(static_cast<std::size_t>(free), -1);
  for (std::size_t s = 0; s < body.slides.size(); ++s) {
    const int row = free_row[body.slides[s].vertex];
    if (row < 0) continue;
    int& id = sliding_of[static_cast<std::size_t>(row)];
    if (id < 0) {
      id = static_cast<int>(sliding.size());
      sliding.push_back({row, {}, Matrix3d::Identity()});
    }
    sliding[static_cast<std::size_t>(id)].slides.push_back(static_cast<int>(s));
  }
  mass = VectorXd::Zero(rows);
  const TetRest rest = tet_rest(body.rest, body.tets);
  rest_volume = rest.volume.sum();
  if (body.density.size() > 0)
    for (Eigen::Index t = 0; t < body.tets.rows(); ++t)
      for (int c = 0; c < 4; ++c) mass[row_of[body.tets(t, c)]] += body.density[t] * rest.volume[t] / 4;
  if (body.added_mass.size() > 0)
    for (std::ptrdiff_t r = 0; r < rows; ++r) mass[r] += body.added_mass[vertex_of[r]];
  const VectorXd least2 = micrometre_forces2(body);
  for (std::ptrdiff_t r = 0; r < free; ++r) least_scale2 += least2[vertex_of[r]];
  force = zero_doubles(4 * rows);
  prediction = zero_doubles(4 * rows);
  set_forces({});
}

void TissueSystem::load(const MatrixX3d& positions, double* x) const {
  for (std::ptrdiff_t r = 0; r < rows; ++r) {
    Eigen::Map<Vector3d>(x + 4 * r) = positions.row(vertex_of[r]).transpose();
    x[4 * r + 3] = 0;
  }
}

void TissueSystem::store(const double* x, MatrixX3d& positions) const {
  for (std::ptrdiff_t r = 0; r < rows; ++r) positions.row(vertex_of[r]) = point(x, r).transpose();
}

void TissueSystem::set_forces(const MatrixX3d& forces) {
  for (std::ptrdiff_t r = 0; r < rows; ++r) {
    Eigen::Map<Vector3d> f(force.get() + 4 * r);
    f = mass[r] * body.gravity;
    if (forces.rows() > 0) f += forces.row(vertex_of[r]).transpose();
  }
}

double TissueSystem::evaluate(const double* x, double* gradient, double* scale2) {
  parallel_for(
      blocks.chunks(), [&](std::ptrdiff_t chunk) { evaluate_chunk(chunk, x); }, 1);
  return add_up(x, gradient, scale2);
}

double TissueSystem::evaluate_again(const std::vector<int>& chunks, const double* x, double* gradient) {
  parallel_for(
      static_cast<std::ptrdiff_t>(chunks.size()),
      [&](std::ptrdiff_t i) { evaluate_chunk(chunks[static_cast<std::size_t>(i)], x); }, 1);
  return add_up(x, gradient, nullptr);
}

void TissueSystem::evaluate_chunk(std::ptrdiff_t chunk, const double* x) {
  const auto c = static_cast<std::size_t>(chunk);
  energies_[c] = evaluate_tissue(blocks, x, chunk, sums_.get() + 4 * blocks.chunk_start[c]);
}

std::vector<int> TissueSystem::muscle_chunks() const {
  std::vector<int> chunks;
  for (int c = 0; c * TissueBlocks::chunk < blocks.muscle_blocks; ++c) chunks.push_back(c);
  return chunks;
}

std::vector<int> TissueSystem::chunks_with(const std::function<bool(int row)>& is) const {
  std::vector<int> chunks;
  for (int c = 0; c < blocks.chunks(); ++c)
    if (std::any_of(blocks.chunk_rows.begin() + blocks.chunk_start[static_cast<std::size_t>(c)],
                    blocks.chunk_rows.begin() + blocks.chunk_start[static_cast<std::size_t>(c) + 1], is))
      chunks.push_back(c);
  return chunks;
}

double TissueSystem::add_up(const double* x, double* gradient, double* scale2) {
  const double elastic = std::accumulate(energies_.begin(), energies_.end(), 0.0);
  std::vector<double> scales(static_cast<std::size_t>((free + row_grain - 1) / row_grain), 0.0);
  const double loads = parallel_sum(rows, row_grain, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    double work = 0;
    for (std::ptrdiff_t r = begin; r < end; ++r) {
      const auto p = point(x, r);
      const auto f = point(force.get(), r);
      work -= f.dot(p);
      Eigen::Vector3d g = -f;
      if (inverse_time_step2 > 0) {
        const Vector3d ahead = p - point(prediction.get(), r);
        const double stiff = mass[r] * inverse_time_step2;
        work += 0.5 * stiff * ahead.squaredNorm();
        g += stiff * ahead;
      }
      if (r >= free) continue;
      double sum = scale2 != nullptr ? g.norm() : 0;
      for (int i = incidence_start_[static_cast<std::size_t>(r)]; i < incidence_start_[static_cast<std::size_t>(r) + 1];
           ++i) {
        const float* part = sums_.get() + incidence_[static_cast<std::size_t>(i)];
        g += Eigen::Map<const Eigen::Vector3f>(part).cast<double>();
        sum += static_cast<double>(part[3]);
      }
      Eigen::Map<Vector3d>(gradient + 4 * r) = g;
      gradient[4 * r + 3] = 0;
      if (scale2 != nullptr) scales[static_cast<std::size_t>(begin / row_grain)] += sum * sum;
    }
    return work;
  });
  if (scale2 != nullptr) *scale2 = std::max(least_scale2, std::accumulate(scales.begin(), scales.end(), 0.0));
  return elastic + loads;
}

void TissueSystem::put_on_slides(double* x) {
  constexpr int rounds = 20;
  constexpr double close = 1e-12;  // metres
  for (SlidingRow& s : sliding) {
    Eigen::Map<Vector3d> p(x + 4 * static_cast<std::ptrdiff_t>(s.row));
    for (int round = 0; round < rounds; ++round) {
      double farthest = 0;
      for (const int k : s.slides) {
        const Slide& slide = body.slides[static_cast<std::size_t>(k)];
        const Vector3d n = slide.gradient(p);
        const double height = slide.height(p);
        p -= height / n.squaredNorm() * n;
        farthest = std::max(farthest, std::abs(height));
      }
      if (farthest < close) break;
    }
    MatrixX3d normals(static_cast<Eigen::Index>(s.slides.size()), 3);
    for (std::size_t k = 0; k < s.slides.size(); ++k)
      normals.row(static_cast<Eigen::Index>(k)) =
          body.slides[static_cast<std::size_t>(s.slides[k])].gradient(p).normalized().transpose();
    s.keep = common_directions(normals);
  }
}

void TissueSystem::restrict_to_slides(double* gradient) const {
  for (const SlidingRow& s : sliding) {
    Eigen::Map<Vector3d> g(gradient + 4 * static_cast<std::ptrdiff_t>(s.row));
    g = (s.keep * g).eval();
  }
}

double TissueSystem::volume(const double* x) const {
  return parallel_sum(body.tets.rows(), 2048, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    double sum = 0;
    for (std::ptrdiff_t t = begin; t < end; ++t) {
      const Vector3d a = point(x, row_of[body.tets(t, 0)]);
      const Vector3d b = point(x, row_of[body.tets(t, 1)]) - a, c = point(x, row_of[body.tets(t, 2)]) - a,
                     d = point(x, row_of[body.tets(t, 3)]) - a;
      sum += b.cross(c).dot(d) / 6;
    }
    return sum;
  });
}

StiffnessState TissueSystem::stiffness_state(const double* x, const double* gradient) const {
  StiffnessState state;
  state.x.assign(x, x + 4 * rows);
  state.stretch.assign(blocks.stretch.get(), blocks.stretch.get() + 6 * TissueBlocks::width * blocks.muscle_blocks);
  state.sliding = sliding;
  state.inverse_time_step2 = inverse_time_step2;
  for (const SlidingRow& s : sliding) {
    Matrix3d bend = Matrix3d::Zero();
    const Vector3d p = point(x, s.row), g = point(gradient, s.row);
    if (s.slides.size() == 1) {
      const Slide& slide = body.slides[static_cast<std::size_t>(s.slides.front())];
      const Vector3d n = slide.gradient(p);
      bend = g.dot(n) / n.squaredNorm() * slide.bend;
    }
    state.slide_bend.push_back(bend);
  }
  return state;
}

void TissueSystem::assemble(const StiffnessState& state, double least_curvature, bool parallel,
                            std::vector<float>& room, BlockMatrix& A) const {
  room.resize(static_cast<std::size_t>(90 * TissueBlocks::width * blocks.blocks));
  for_chunks(parallel, blocks.blocks, block_grain, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    tissue_stiffness(blocks, state.stretch.data(), state.x.data(), least_curvature, room.data(), begin, end);
  });
  for_chunks(parallel, free, column_grain, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t j = begin; j < end; ++j)
      for (int k = pattern.start[static_cast<std::size_t>(j)]; k < pattern.start[static_cast<std::size_t>(j) + 1];
           ++k) {
        const auto entry = static_cast<std::size_t>(k);
        const int i = pattern.row[entry];
        Eigen::Matrix3f straight = Eigen::Matrix3f::Zero(), transposed = Eigen::Matrix3f::Zero();
        for (int s = source_start_[entry]; s < source_start_[entry + 1]; ++s) {
          const int code = source_[static_cast<std::size_t>(s)];
          (code % 2 == 0 ? straight : transposed) +=
              Eigen::Map<const Eigen::Matrix3f>(room.data() + 9 * static_cast<std::ptrdiff_t>(code / 2));
        }
        Eigen::Matrix3f block = straight + transposed.transpose();
        if (i == j) block.diagonal().array() += static_cast<float>(mass[j] * state.inverse_time_step2);
        const int row = sliding_of[static_cast<std::size_t>(i)], column = sliding_of[static_cast<std::size_t>(j)];
        if (row >= 0 && i == j) {
          const auto r = static_cast<std::size_t>(row);
          const float scale = block.trace() / 3;
          if (least_curvature <= any_curvature) block += state.slide_bend[r].cast<float>();
          const Eigen::Matrix3f keep = state.sliding[r].keep.cast<float>();
          block = keep * block * keep + scale * (Eigen::Matrix3f::Identity() - keep);
        } else {
          if (row >= 0) block = (state.sliding[static_cast<std::size_t>(row)].keep.cast<float>() * block).eval();
          if (column >= 0) block = (block * state.sliding[static_cast<std::size_t>(column)].keep.cast<float>()).eval();
        }
        Eigen::Map<Eigen::Matrix3f>(A.value.data() + 9 * static_cast<std::ptrdiff_t>(k)) = block;
      }
  });
}

}  // namespace phiz
