// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/elasticity/muscle_prior.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <string>
#include <unsupported/Eigen/Polynomials>

#include "phiz/core/error.h"

namespace phiz {

namespace {

/// |S|^2 of a symmetric matrix is the sum of these times its squared entries.
const Vector6d frobenius = (Vector6d() << 1, 1, 1, 2, 2, 2).finished();
constexpr double least_strength = 1e-3;

double squared(const Vector6d& a) {
  return frobenius.dot(a.cwiseAbs2());
}

}  // namespace

Matrix3d contracted_stretch(const Vector3d& direction, double contraction) {
  const double across = 1 / std::sqrt(contraction);
  return across * Matrix3d::Identity() + (contraction - across) * direction * direction.transpose();
}

double best_contraction(double p, double q, double r) {
  if (!(p > 0)) return 1;
  // In s = gamma^(-1/2) the stretch is s^-2 along and s across.
  const auto objective = [&](double s) { return p / (s * s * s * s) - 2 * q / (s * s) + 2 * p * s * s - 2 * r * s; };
  const auto slope = [&](double s) { return 2 * p * std::pow(s, 6) - r * std::pow(s, 5) + 2 * q * s * s - 2 * p; };
  const auto curvature = [&](double s) { return 12 * p * std::pow(s, 5) - 5 * r * std::pow(s, 4) + 4 * q * s; };
  Eigen::Matrix<double, 7, 1> coefficients;
  coefficients << -2 * p, 0, 2 * q, 0, 0, -r, 2 * p;
  const Eigen::PolynomialSolver<double, 6> solver(coefficients);
  double best = 1, least = objective(1);
  for (const std::complex<double>& root : solver.roots()) {
    constexpr double nearly_real = 1e-4;  // a double root comes as a pair
    if (!(root.real() > 0) || std::abs(root.imag()) > nearly_real * root.real()) continue;
    double s = root.real();
    for (int k = 0; k < 3; ++k) {
      const double next = s - slope(s) / curvature(s);
      if (std::isfinite(next) && std::abs(slope(next)) < std::abs(slope(s)) && next > 0) s = next;
    }
    if (objective(s) >= least) continue;
    least = objective(s);
    best = s;
  }
  return 1 / (best * best);
}

MusclePrior::MusclePrior(const std::vector<MuscleFibres>& muscles, const VectorXi& tets, const VectorXd& volumes,
                         const MusclePriorWeights& weights)
    : weights_(weights), muscles_(muscles.size()), shares_(tets.size()) {
  if (!(weights.direction >= 0 && weights.sparsity >= 0 && weights.excess >= 0 && weights.change > 0))
    reject("muscle prior", "weights must be 0 or more, that of change more than 0");
  if (!(weights.least_stretch > 0 && weights.least_stretch < 1 && weights.most_stretch > 1))
    reject("muscle prior", "1 must be within the bounds of stretches");
  double muscle_volume = 0;
  for (std::size_t m = 0; m < muscles.size(); ++m) {
    const MuscleFibres& fibres = muscles[m];
    if (fibres.fraction.size() != fibres.tets.size() || fibres.direction.rows() != fibres.tets.size())
      reject("muscle " + std::to_string(m), "needs a fraction and a direction for each of its tets");
    for (Eigen::Index i = 0; i < fibres.tets.size(); ++i) {
      const int* found = std::lower_bound(tets.data(), tets.data() + tets.size(), fibres.tets[i]);
      if (found == tets.data() + tets.size() || *found != fibres.tets[i]) continue;
      const Vector3d direction = fibres.direction.row(i);
      if (!(fibres.fraction[i] >= 0) || !(std::abs(direction.norm() - 1) < 1e-3))
        reject("muscle " + std::to_string(m), "needs fractions of 0 or more and unit directions");
      if (fibres.fraction[i] == 0) continue;
      const double volume = fibres.fraction[i] * volumes[*found];
      muscles_[m].push_back({static_cast<int>(found - tets.data()), volume, direction});
      muscle_volume += volume;
    }
  }
  for (auto& muscle : muscles_)
    for (Part& part : muscle) part.share /= muscle_volume;
  for (Eigen::Index k = 0; k < tets.size(); ++k) shares_[k] = volumes[tets[k]];
  shares_ /= shares_.sum();
  contractions_.setOnes(static_cast<Eigen::Index>(muscles.size()));
}

double MusclePrior::strength(std::size_t muscle, const Activations& a) const {
  double sum = 0, share = 0;
  for (const Part& part : muscles_[muscle]) {
    sum += part.share * squared(a.col(part.column) - neutral_activation());
    share += part.share;
  }
  return std::sqrt(sum + least_strength * least_strength * share);
}

Matrix3d MusclePrior::excess(const Vector6d& a) const {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(activation_stretch(a));
  const Vector3d values = eigen.eigenvalues();
  const Vector3d beyond = values - values.cwiseMax(weights_.least_stretch).cwiseMin(weights_.most_stretch);
  return eigen.eigenvectors() * beyond.asDiagonal() * eigen.eigenvectors().transpose();
}

void MusclePrior::fit(const Activations& a) {
  for (std::size_t m = 0; m < muscles_.size(); ++m) {
    double p = 0, q = 0, r = 0;
    for (const Part& part : muscles_[m]) {
      const Matrix3d S = activation_stretch(a.col(part.column));
      const double along = part.direction.dot(S * part.direction);
      p += part.share;
      q += part.share * along;
      r += part.share * (S.trace() - along);
    }
    contractions_[static_cast<Eigen::Index>(m)] = best_contraction(p, q, r);
  }
}

double MusclePrior::value(const Activations& a) const {
  double direction = 0, sparsity = 0, change = 0, beyond = 0;
  for (std::size_t m = 0; m < muscles_.size(); ++m) {
    const double gamma = contractions_[static_cast<Eigen::Index>(m)];
    for (const Part& part : muscles_[m])
      direction += part.share *
                   (contracted_stretch(part.direction, gamma) - activation_stretch(a.col(part.column))).squaredNorm();
    if (!muscles_[m].empty()) sparsity += strength(m, a);
  }
  for (Eigen::Index k = 0; k < a.cols(); ++k) {
    change += shares_[k] * squared(a.col(k) - neutral_activation());
    beyond += shares_[k] * excess(a.col(k)).squaredNorm();
  }
  return weights_.direction * direction + weights_.sparsity * sparsity + weights_.change * change +
         weights_.excess * beyond;
}

Activations MusclePrior::gradient(const Activations& a) const {
  const Vector6d neutral = neutral_activation();
  Activations out(6, a.cols());
  for (Eigen::Index k = 0; k < a.cols(); ++k)
    out.col(k) = 2 * shares_[k] *
                 frobenius.cwiseProduct(weights_.change * (a.col(k) - neutral) +
                                        weights_.excess * activation_of(excess(a.col(k))));
  for (std::size_t m = 0; m < muscles_.size(); ++m) {
    const double gamma = contractions_[static_cast<Eigen::Index>(m)];
    const double sparsity = weights_.sparsity > 0 ? weights_.sparsity / strength(m, a) : 0;
    for (const Part& part : muscles_[m]) {
      const Vector6d target = activation_of(contracted_stretch(part.direction, gamma));
      out.col(part.column) +=
          part.share * frobenius.cwiseProduct(2 * weights_.direction * (a.col(part.column) - target) +
                                              sparsity * (a.col(part.column) - neutral));
    }
  }
  return out;
}

Activations MusclePrior::curvature(const Activations& a) const {
  Activations out = 2 * weights_.change * frobenius * shares_.transpose();
  for (Eigen::Index k = 0; k < a.cols(); ++k)
    if (!excess(a.col(k)).isZero(0)) out.col(k) += 2 * weights_.excess * shares_[k] * frobenius;
  for (std::size_t m = 0; m < muscles_.size(); ++m) {
    const double each = 2 * weights_.direction + (weights_.sparsity > 0 ? weights_.sparsity / strength(m, a) : 0);
    for (const Part& part : muscles_[m]) out.col(part.column) += each * part.share * frobenius;
  }
  return out;
}

Activations MusclePrior::curvature_times(const Activations& curvature, const Activations& v) const {
  Activations out = curvature.cwiseProduct(v);
  for (std::size_t m = 0; m < muscles_.size(); ++m) {
    const double gamma = contractions_[static_cast<Eigen::Index>(m)], across = -0.5 * std::pow(gamma, -1.5);
    const auto rate = [&](const Part& part) {
      return activation_of(across * Matrix3d::Identity() + (1 - across) * part.direction * part.direction.transpose());
    };
    double along = 0, length2 = 0;
    for (const Part& part : muscles_[m]) {
      const Vector6d weighted = part.share * frobenius.cwiseProduct(rate(part));
      along += weighted.dot(v.col(part.column));
      length2 += weighted.dot(rate(part));
    }
    for (const Part& part : muscles_[m])
      out.col(part.column) -=
          2 * weights_.direction * along / length2 * part.share * frobenius.cwiseProduct(rate(part));
  }
  return out;
}

}  // namespace phiz
