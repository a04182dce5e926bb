// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/people/person.h"

#include <cmath>

#include "phiz/anatomy/people/reshape_head.h"
#include "phiz/core/error.h"
#include "phiz/core/random.h"

namespace phiz {

VectorXd random_coefficients(const IdentityModel& model, std::uint64_t seed) {
  constexpr double most = 2;
  Random random(seed, 0x9e091e);
  VectorXd coefficients(model.skin.cols());
  for (double& c : coefficients) do
      c = random.normal();
    while (std::abs(c) > most);
  return coefficients;
}

MatrixX3d person_skin(const HeadTemplate& head, const VectorXd& coefficients) {
  const Eigen::Index modes = head.identity.skin.cols();
  if (coefficients.size() != modes || !coefficients.allFinite())
    throw Error(ErrorKind::usage, "a person of " + head.name + " needs " + std::to_string(modes) +
                                      " finite coefficients, not " + std::to_string(coefficients.size()));
  const VectorXd displacement = head.identity.skin.cast<double>() * coefficients;
  return head.skin.V + displacement.reshaped<Eigen::RowMajor>(head.skin.V.rows(), 3);
}

HeadTemplate make_person(const HeadTemplate& head, const VectorXd& coefficients) {
  if (head.identity.skin.cols() == 0)
    reject(head.name, "it has no model of people: it may be one person's head; take the template that it came from");
  return reshape_head(head, person_skin(head, coefficients));
}

}  // namespace phiz
