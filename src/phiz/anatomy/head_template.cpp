// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/head_template.h"

#include <algorithm>
#include <string>
#include <vector>

#include "phiz/geometry/operators.h"

namespace phiz {

VectorXi soft_tets(const HeadTemplate& head) {
  std::vector<int> rows;
  for (Eigen::Index t = 0; t < head.volume.T.rows(); ++t) {
    bool free = false;
    for (int k = 0; k < 4; ++k) free |= head.carrier(head.volume.T(t, k)) == static_cast<int>(Carrier::flesh);
    if (free && head.volume.region(t) == Tissue::flesh) rows.push_back(static_cast<int>(t));
  }
  return Eigen::Map<const VectorXi>(rows.data(), static_cast<Eigen::Index>(rows.size()));
}

double active_share(const HeadTemplate& head) {
  const VectorXd volume = tet_volumes(head.volume.V, head.volume.T);
  double active = 0, all = 0;
  for (Eigen::Index t = 0; t < volume.size(); ++t) all += head.volume.region(t) == Tissue::flesh ? volume(t) : 0;
  for (const Muscle& m : head.muscles) active += m.fraction.dot(volume(m.tets));
  return all > 0 ? active / all : 0;
}

const Part* find_part(const HeadTemplate& head, const std::string& name) {
  const auto found = std::find_if(head.parts.begin(), head.parts.end(), [&](const Part& p) { return p.name == name; });
  return found == head.parts.end() ? nullptr : &*found;
}

const Expression* find_expression(const HeadTemplate& head, const std::string& name) {
  const auto found = std::find_if(head.expressions.begin(), head.expressions.end(),
                                  [&](const Expression& e) { return e.name == name; });
  return found == head.expressions.end() ? nullptr : &*found;
}

void translate(HeadTemplate& head, const Vector3d& by) {
  const auto move = [&by](MatrixX3d& points) { points.rowwise() += by.transpose(); };
  move(head.volume.V);
  move(head.skin.V);
  for (Part& part : head.parts) move(part.mesh.V);
  for (Muscle& muscle : head.muscles) {
    move(muscle.surface.V);
    for (MatrixX3d& fibre : muscle.fibres) move(fibre);
  }
  head.jaw.centre += by;
  head.left_eye_centre += by;
  head.right_eye_centre += by;
}

}  // namespace phiz
