// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/elasticity/low_rank_inverse.h"

#include <algorithm>

namespace phiz {

namespace {

/// Drops the first of `count` entries and appends a value.
void shift(Eigen::VectorXd& v, int count, bool drop, double value) {
  if (drop) v.head(count - 1) = v.segment(1, count - 1).eval();
  v[drop ? count - 1 : count] = value;
}

}  // namespace

LowRankInverse::LowRankInverse(std::ptrdiff_t size, int history, double gamma)
    : size_(size),
      history_(std::clamp(history, 1, most_history)),
      gamma_(gamma),
      sy_(history_, history_),
      yz_(history_, history_),
      sg_(history_),
      zg_(history_) {
  for (int k = 0; k < history_; ++k)
    for (auto* set : {&s_, &z_}) set->push_back(float_vector(size));
}

void LowRankInverse::clear() {
  first_ = count_ = 0;
  gamma_ = 1;
}

std::vector<const float*> LowRankInverse::columns() const {
  std::vector<const float*> all;
  all.reserve(static_cast<std::size_t>(2 * count_) + 2);
  for (int k = 0; k < count_; ++k) all.push_back(s(k));
  for (int k = 0; k < count_; ++k) all.push_back(z(k));
  return all;
}

void LowRankInverse::start(const float* g) {
  const Eigen::VectorXd products = dots(columns(), g, size_);
  sg_.head(count_) = products.head(count_);
  zg_.head(count_) = products.tail(count_);
}

void LowRankInverse::add(const float* step, const float* change, const float* inverse_change, const float* g) {
  std::vector<const float*> left = columns();
  left.insert(left.end(), {step, inverse_change});
  const Eigen::VectorXd products = dots(left, change, size_);
  sg_.head(count_) += products.head(count_);
  zg_.head(count_) += products.segment(count_, count_);
  const double curvature = products[2 * count_], length = products[2 * count_ + 1];
  if (!(length > 0) || !(curvature > 1e-8 * length)) return;
  const bool full = count_ == history_;
  if (full) {
    const int kept = history_ - 1;
    sy_.topLeftCorner(kept, kept) = sy_.bottomRightCorner(kept, kept).eval();
    yz_.topLeftCorner(kept, kept) = yz_.bottomRightCorner(kept, kept).eval();
    first_ = slot(1);
  }
  const Eigen::VectorXd onto_new = dots({step, inverse_change}, g, size_);
  shift(sg_, count_, full, onto_new[0]);
  shift(zg_, count_, full, onto_new[1]);
  const int dropped = full ? 1 : 0, before = count_, last = count_ - dropped;
  for (int k = 0; k < last; ++k) {
    sy_(k, last) = products[k + dropped];
    yz_(k, last) = yz_(last, k) = products[before + k + dropped];
  }
  sy_(last, last) = curvature;
  yz_(last, last) = length;
  const auto place = static_cast<std::size_t>(slot(last));
  std::copy_n(step, size_, s_[place].get());
  std::copy_n(inverse_change, size_, z_[place].get());
  count_ = last + 1;
  gamma_ = curvature / length;
}

Eigen::VectorXd LowRankInverse::products(const float* v) const {
  Eigen::VectorXd out = dots(columns(), v, size_);
  out.tail(count_) *= gamma_;
  return out;
}

Eigen::VectorXd LowRankInverse::projection() const {
  Eigen::VectorXd u(2 * count_);
  u << sg_.head(count_), gamma_ * zg_.head(count_);
  return u;
}

LowRankInverse::Rows LowRankInverse::rows(std::ptrdiff_t first) const {
  const auto part = [first](const float* column) {
    return Eigen::Map<const Eigen::Vector3f>(column + first).cast<double>();
  };
  Rows out(3, 2 * count_);
  for (int k = 0; k < count_; ++k) {
    out.col(k) = part(s(k));
    out.col(count_ + k) = gamma_ * part(z(k));
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

void LowRankInverse::apply(const float* inverse_v, const Eigen::VectorXd& u, double sign, float* out) const {
  std::vector<const float*> all = columns();
  all.push_back(inverse_v);
  Eigen::VectorXd weights(2 * count_ + 1);
  weights << sign * u.head(count_), sign * gamma_ * u.tail(count_), sign * gamma_;
  combine(all, weights.cast<float>(), out, size_);
}

}  // namespace phiz
