// SPDX-License-Identifier: GPL-3.0-or-later
/// What contacts do to a body in a state that a solver found.
#pragma once

#include <vector>

#include "phiz/elasticity/contact.h"

namespace phiz {

/// The force of one contact. The vertex in contact gets pressure * row.normal + friction; the vertices of an obstacle
/// that is a patch of the body get their shares of the opposite.
struct ContactForce {
  ContactRow row;                        ///< with the gap of the final state
  double pressure = 0;                   ///< along the normal, newtons, >= 0
  Vector3d friction = Vector3d::Zero();  ///< across it, newtons
};

/// Sum per vertex of a body of `vertex_count` vertices, n x 3, newtons.
MatrixX3d sum_of_contact_forces(const std::vector<ContactForce>& forces, Eigen::Index vertex_count);

}  // namespace phiz
