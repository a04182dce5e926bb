// SPDX-License-Identifier: GPL-3.0-or-later
/// The contact scene of a head: its contact pairs, and the obstacles that move with the jaw.
#pragma once

#include <vector>

#include "phiz/anatomy/head_template.h"
#include "phiz/elasticity/contact.h"

namespace phiz {

struct HeadContacts {
  /// Throws phiz::Error(bad_input) for pairs that name no region or part.
  HeadContacts(const HeadTemplate& head, const ContactOptions& options);

  /// Places what the mandible carries.
  void place_jaw(const Eigen::Isometry3d& jaw);

  ContactScene scene;
  std::vector<int> on_jaw;  ///< obstacles that the mandible carries
};

}  // namespace phiz
