// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/elasticity/coulomb.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace phiz {

namespace {

Eigen::Vector2d in_disk(const Eigen::Vector2d& z, double radius) {
  const double length = z.norm();
  return length > radius ? Eigen::Vector2d(radius / length * z) : z;
}

class Coulomb {
 public:
  Coulomb(const Eigen::MatrixXd& M, const Eigen::VectorXd& q, double mu)
      : M_(M), q_(q), mu_(mu), contacts_(q.size() / 3), scale_(q.size()) {
    for (Eigen::Index i = 0; i < contacts_; ++i) {
      scale_[3 * i] = 1 / M(3 * i, 3 * i);
      scale_[3 * i + 1] = scale_[3 * i + 2] = 1 / (M(3 * i + 1, 3 * i + 1) + M(3 * i + 2, 3 * i + 2));
    }
  }

  /// y less its projection: zero at the solution.
  Eigen::VectorXd defect(const Eigen::VectorXd& y) const {
    const Eigen::VectorXd z = y - scale_.cwiseProduct(M_ * y + q_);
    Eigen::VectorXd out(y.size());
    for (Eigen::Index i = 0; i < contacts_; ++i) {
      const double pressure = std::max(0.0, z[3 * i]);
      out[3 * i] = y[3 * i] - pressure;
      out.segment<2>(3 * i + 1) = y.segment<2>(3 * i + 1) - in_disk(z.segment<2>(3 * i + 1), mu_ * pressure);
    }
    return out;
  }

  Eigen::VectorXd newton_step(const Eigen::VectorXd& y, const Eigen::VectorXd& value) const {
    const Eigen::VectorXd z = y - scale_.cwiseProduct(M_ * y + q_);
    Eigen::MatrixXd J = Eigen::MatrixXd::Identity(y.size(), y.size());
    // dz = dy - scale M dy, row by row where it is needed.
    const auto dz = [&](Eigen::Index row) {
      Eigen::RowVectorXd out = -scale_[row] * M_.row(row);
      out[row] += 1;
      return out;
    };
    for (Eigen::Index i = 0; i < contacts_; ++i) {
      const Eigen::Index n = 3 * i, t = n + 1;
      if (z[n] <= 0) continue;
      const Eigen::RowVectorXd dn = dz(n);
      J.row(n) -= dn;
      Eigen::MatrixXd dt(2, y.size());
      dt.row(0) = dz(t);
      dt.row(1) = dz(t + 1);
      const Eigen::Vector2d zt = z.segment<2>(t);
      const double length = zt.norm(), radius = mu_ * z[n];
      if (length <= radius) {
        J.middleRows<2>(t) -= dt;
      } else {
        const Eigen::Vector2d u = zt / length;
        J.middleRows<2>(t) -= mu_ * u * dn + radius / length * (dt - u * (u.transpose() * dt));
      }
    }
    return J.partialPivLu().solve(-value);
  }

  void sweep(Eigen::VectorXd& y) const {
    for (Eigen::Index i = 0; i < contacts_; ++i) {
      const Eigen::Index n = 3 * i, t = n + 1;
      y[n] = std::max(0.0, y[n] - scale_[n] * (M_.row(n).dot(y) + q_[n]));
      const Eigen::Vector2d w = M_.middleRows<2>(t) * y + q_.segment<2>(t);
      y.segment<2>(t) = in_disk(y.segment<2>(t) - scale_[t] * w, mu_ * y[n]);
    }
  }

 private:
  const Eigen::MatrixXd& M_;
  const Eigen::VectorXd& q_;
  double mu_;
  Eigen::Index contacts_;
  Eigen::VectorXd scale_;
};

}  // namespace

bool solve_coulomb(const Eigen::MatrixXd& M, const Eigen::VectorXd& q, double mu, Eigen::VectorXd& y) {
  constexpr int rounds = 200, sweeps = 20;
  constexpr double tolerance = 1e-12;
  if (y.size() != q.size()) y = Eigen::VectorXd::Zero(q.size());
  const Coulomb problem(M, q, mu);
  Eigen::VectorXd value = problem.defect(y);
  for (int round = 0; round < rounds; ++round) {
    const double size = value.norm();
    if (size <= tolerance * std::max(y.cwiseAbs().maxCoeff(), 1e-300)) return true;
    const Eigen::VectorXd step = problem.newton_step(y, value);
    bool accepted = false;
    for (double alpha = 1; step.allFinite() && alpha > 0.1 && !accepted; alpha *= 0.5) {
      const Eigen::VectorXd trial = y + alpha * step, next = problem.defect(trial);
      accepted = next.norm() < 0.9 * size;
      if (!accepted) continue;
      y = trial;
      value = next;
    }
    if (accepted) continue;
    for (int k = 0; k < sweeps; ++k) problem.sweep(y);
    value = problem.defect(y);
  }
  return false;
}

}  // namespace phiz
