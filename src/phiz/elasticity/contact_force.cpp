// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/elasticity/contact_force.h"

namespace phiz {

MatrixX3d sum_of_contact_forces(const std::vector<ContactForce>& forces, Eigen::Index vertex_count) {
  MatrixX3d sum = MatrixX3d::Zero(vertex_count, 3);
  for (const ContactForce& force : forces) {
    const Vector3d total = force.pressure * force.row.normal + force.friction;
    for (int k = 0; k < force.row.count; ++k)
      sum.row(force.row.vertices[k]) += force.row.coefficients[k] * total.transpose();
  }
  return sum;
}

}  // namespace phiz
