// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/elasticity/low_rank_inverse.h"

#include <algorithm>

#include "phiz/core/parallel.h"

namespace phiz {

namespace {

using Segment = Eigen::Map<const Eigen::VectorXd>;
constexpr std::ptrdiff_t grain = 8192;

}  // namespace

Eigen::VectorXd dots(const std::vector<const double*>& left, const double* right, std::ptrdiff_t size) {
  const auto count = static_cast<Eigen::Index>(left.size());
  Eigen::MatrixXd parts(count, (size + grain - 1) / grain);
  parallel_chunks(size, grain, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    const Segment segment(right + begin, end - begin);
    for (Eigen::Index k = 0; k < count; ++k)
      parts(k, begin / grain) = Segment(left[static_cast<std::size_t>(k)] + begin, end - begin).dot(segment);
  });
  return parts.rowwise().sum();
}

double dot(const double* left, const double* right, std::ptrdiff_t size) {
  return dots({left}, right, size)[0];
}

LowRankInverse::LowRankInverse(std::ptrdiff_t size, int history, double gamma)
    : size_(size), history_(std::max(history, 1)), gamma_(gamma), sy_(history_, history_), yz_(history_, history_) {
  for (int k = 0; k < history_; ++k)
    for (auto* set : {&s_, &z_}) set->push_back(hwy::AllocateAligned<double>(static_cast<std::size_t>(size)));
}

void LowRankInverse::clear() {
  first_ = count_ = 0;
  gamma_ = 1;
}

std::vector<const double*> LowRankInverse::columns() const {
  std::vector<const double*> all;
  all.reserve(static_cast<std::size_t>(2 * count_));
  for (int k = 0; k < count_; ++k) all.push_back(s(k));
  for (int k = 0; k < count_; ++k) all.push_back(z(k));
  return all;
}

bool LowRankInverse::add(const double* step, const double* change, const double* inverse_change) {
  std::vector<const double*> left = columns();
  left.insert(left.end(), {step, inverse_change});
  const Eigen::VectorXd products = dots(left, change, size_);
  const double curvature = products[2 * count_], length = products[2 * count_ + 1];
  if (!(length > 0) || !(curvature > 1e-8 * length)) return false;
  int dropped = 0;
  if (count_ == history_) {
    const int kept = history_ - 1;
    sy_.topLeftCorner(kept, kept) = sy_.bottomRightCorner(kept, kept).eval();
    yz_.topLeftCorner(kept, kept) = yz_.bottomRightCorner(kept, kept).eval();
    first_ = slot(1);
    dropped = 1;
  }
  const int before = count_, last = count_ - dropped;
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
  return true;
}

Eigen::VectorXd LowRankInverse::project(const double* v) const {
  Eigen::VectorXd u = dots(columns(), v, size_);
  u.tail(count_) *= gamma_;
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
