// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/builtin/proportions.h"

namespace phiz {

Proportions translated(Proportions p, const Vector3d& by) {
  for (Vector2d Proportions::*point :
       {&Proportions::vertex, &Proportions::opisthocranion, &Proportions::trichion, &Proportions::glabella,
        &Proportions::nasion, &Proportions::pronasale, &Proportions::subnasale, &Proportions::labrale_superius,
        &Proportions::stomion, &Proportions::labrale_inferius, &Proportions::sublabiale, &Proportions::pogonion,
        &Proportions::menton})
    p.*point += by.tail<2>();
  for (Vector3d Proportions::*point :
       {&Proportions::eye_centre, &Proportions::endocanthion, &Proportions::exocanthion, &Proportions::alare,
        &Proportions::cheilion, &Proportions::zygion, &Proportions::gonion, &Proportions::tragion, &Proportions::euryon,
        &Proportions::condyle})
    p.*point += by;
  return p;
}

}  // namespace phiz
