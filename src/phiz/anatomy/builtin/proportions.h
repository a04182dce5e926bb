// SPDX-License-Identifier: GPL-3.0-or-later
/// Mean positions of the soft-tissue and bony points that skin and skull are both built from.
///
/// Head frame (+x person's left, +y up, +z forward, origin midway between the mandibular condyles), metres. Derived
/// from published facial distances (doi 10.1186/s40902-019-0191-7 and doi 10.1186/2196-1042-14-32, averaged over the
/// sexes and rounded to the millimetre); flesh thickness after Stephan and Simpson (2008), rounded.
#pragma once

#include "phiz/geometry/mesh.h"

namespace phiz {

struct Proportions {
  // Midline of the skin, x = 0: (y, z).
  Vector2d vertex{0.140, -0.012}, opisthocranion{0.050, -0.1105}, trichion{0.103, 0.058}, glabella{0.047, 0.074},
      nasion{0.036, 0.071}, pronasale{0.000, 0.099}, subnasale{-0.013, 0.084}, labrale_superius{-0.030, 0.088},
      stomion{-0.037, 0.084}, labrale_inferius{-0.045, 0.086}, sublabiale{-0.056, 0.078}, pogonion{-0.069, 0.083},
      menton{-0.083, 0.070};
  // Left side; the right side mirrors x.
  Vector3d eye_centre{0.0315, 0.027, 0.0525};
  double eye_radius = 0.0120;
  Vector3d endocanthion{0.016, 0.0255, 0.0580}, exocanthion{0.0465, 0.0275, 0.0550};
  Vector3d alare{0.0185, -0.005, 0.0800}, cheilion{0.0245, -0.038, 0.0735};
  Vector3d zygion{0.0665, 0.008, 0.0330}, gonion{0.0520, -0.052, 0.0020}, tragion{0.0720, 0.003, -0.0120},
      euryon{0.0760, 0.075, -0.0250};
  Vector3d condyle{0.0500, 0.0, 0.0};
  // Teeth: outer (labial) surface of the upper arch is the half ellipse z = z0 + depth * sqrt(1 - (x / half_width)^2).
  struct DentalArch {
    double half_width = 0.0290, depth = 0.0430, z0 = 0.0300;
    double upper_gum = -0.0285, upper_edge = -0.0390;       // y of the upper gum line and of the incisal edges
    double lower_edge = -0.0372, lower_gum = -0.0475;       // y of the lower ones (2 mm overbite)
    double lower_inset = 0.0018;                            // the lower arch lies this much inside the upper one
    double upper_sulcus = -0.0170, lower_sulcus = -0.0600;  // y of the folds between gums and lips or cheeks
  } arch;
};

/// All points moved by `by`; the teeth stay.
Proportions translated(Proportions proportions, const Vector3d& by);

}  // namespace phiz
