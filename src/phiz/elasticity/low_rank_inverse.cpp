// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/elasticity/low_rank_inverse.h"

#include <algorithm>

#include "phiz/core/parallel.h"

namespace phiz {

namespace {

using Segment = Eigen::Map<const Eigen::VectorXd>;
constexpr std::ptrdiff_t grain = 8192;

}  // namespace

double dot(const double* a, const double* b, std::ptrdiff_t size) {
  return parallel_sum(size, grain, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    return Segment(a + begin, end - begin).dot(Segment(b + begin, end - begin));
  });
}

LowRankInverse::LowRankInverse(std::ptrdiff_t size, int history)
    : size_(size), history_(std::max(history, 1)), sy_(history_, history_), yz_(history_, history_) {
  for (int k = 0; k < history_; ++k)
    for (auto* set : {&s_, &y_, &z_}) set->push_back(hwy::AllocateAligned<double>(static_cast<std::size_t>(size)));
}

void LowRankInverse::clear() {
  first_ = count_ = 0;
  gamma_ = 1;
}

bool LowRankInverse::add(const double* step, const double* change, const double* inverse_change) {
  const double curvature = dot(step, change, size_);
  const double length = dot(change, inverse_change, size_);
  if (!(length > 0) || !(curvature > 1e-8 * length)) return false;
  if (count_ == history_) {
    const int kept = history_ - 1;
    sy_.topLeftCorner(kept, kept) = sy_.bottomRightCorner(kept, kept).eval();
    yz_.topLeftCorner(kept, kept) = yz_.bottomRightCorner(kept, kept).eval();
    first_ = slot(1);
    --count_;
  }
  const auto place = static_cast<std::size_t>(slot(count_));
  std::copy_n(step, size_, s_[place].get());
  std::copy_n(change, size_, y_[place].get());
  std::copy_n(inverse_change, size_, z_[place].get());
  sy_(count_, count_) = curvature;
  yz_(count_, count_) = length;
  for (int k = 0; k < count_; ++k) {
    sy_(k, count_) = dot(s(k), change, size_);
    yz_(k, count_) = yz_(count_, k) = dot(z(k), change, size_);
  }
  ++count_;
  gamma_ = curvature / length;
  return true;
}

Eigen::VectorXd LowRankInverse::project(const double* v) const {
  Eigen::VectorXd u(2 * count_);
  for (int k = 0; k < count_; ++k) {
    u[k] = dot(s(k), v, size_);
    u[count_ + k] = gamma_ * dot(z(k), v, size_);
  }
  return u;
}

Eigen::MatrixXd LowRankInverse::rows(std::ptrdiff_t first, std::ptrdiff_t count) const {
  Eigen::MatrixXd out(count, 2 * count_);
  for (int k = 0; k < count_; ++k) {
    out.col(k) = Segment(s(k) + first, count);
    out.col(count_ + k) = gamma_ * Segment(z(k) + first, count);
  }
  return out;
}

Eigen::VectorXd LowRankInverse::middle(const Eigen::VectorXd& u) const {
  if (count_ == 0) return u;
  const Eigen::MatrixXd R = sy_.topLeftCorner(count_, count_).triangularView<Eigen::Upper>();
  const Eigen::VectorXd r = R.triangularView<Eigen::Upper>().solve(u.head(count_));
  Eigen::VectorXd out(2 * count_);
  const Eigen::VectorXd t =
      R.diagonal().cwiseProduct(r) + gamma_ * (yz_.topLeftCorner(count_, count_) * r) - u.tail(count_);
  out.head(count_) = R.transpose().triangularView<Eigen::Lower>().solve(t);
  out.tail(count_) = -r;
  return out;
}

Eigen::MatrixXd LowRankInverse::middle() const {
  Eigen::MatrixXd M(2 * count_, 2 * count_);
  for (int k = 0; k < 2 * count_; ++k) M.col(k) = middle(Eigen::VectorXd::Unit(2 * count_, k));
  return M;
}

void LowRankInverse::combine(const double* inverse_v, const Eigen::VectorXd& u, double sign, double* out) const {
  parallel_chunks(size_, grain, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    Eigen::Map<Eigen::VectorXd> part(out + begin, end - begin);
    part = (sign * gamma_) * Segment(inverse_v + begin, end - begin);
    for (int k = 0; k < count_; ++k)
      part += (sign * u[k]) * Segment(s(k) + begin, end - begin) +
              (sign * gamma_ * u[count_ + k]) * Segment(z(k) + begin, end - begin);
  });
}

}  // namespace phiz
