// SPDX-License-Identifier: GPL-3.0-or-later
/// Implicit shapes of skull and mandible (negative inside, metres). They are drawn once, for the reference proportions;
/// a person's bones are the same functions behind a smooth warp that takes the person's landmarks to the reference
/// ones.
#pragma once

#include "phiz/anatomy/builtin/proportions.h"
#include "phiz/geometry/mesh.h"

namespace phiz {

/// Smooth map from a person's head to the head of the reference proportions (thin-plate interpolation of landmarks).
class ReferenceWarp {
 public:
  explicit ReferenceWarp(const Proportions& person);
  Vector3d operator()(const Vector3d& p) const;

 private:
  MatrixX3d centres_;
  MatrixX3d weights_;  ///< one row per centre, then constant, x, y, z
};

/// The proportions for which the shapes are drawn.
Proportions reference_proportions();

/// Distance-like fields in the reference head, exactly mirror symmetric.
/// Skull: cranium, face and cervical column; when `detailed` with the processes of the vertebrae and the whole nasal
/// opening. Mandible: with condyles and coronoid processes. Struts: the thin parts (orbital rim, zygomatic arch, nasal
/// bones; ramus) that must not break where the flesh over them is thin.
double reference_skull(const Vector3d& p, bool detailed);
double reference_mandible(const Vector3d& p);
double reference_skull_struts(const Vector3d& p);
double reference_mandible_struts(const Vector3d& p);

/// The part of the bones that carries the teeth and lies inside the gums: alveolar processes, in the person's head.
double upper_alveolar_process(const Proportions& person, const Vector3d& p);
double lower_alveolar_process(const Proportions& person, const Vector3d& p);

}  // namespace phiz
