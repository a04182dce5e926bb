// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/builtin/mouth/teeth.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "phiz/anatomy/builtin/mouth/crown.h"
#include "phiz/anatomy/builtin/mouth/dentition.h"
#include "phiz/anatomy/builtin/mouth/loft.h"
#include "phiz/geometry/surface.h"

namespace phiz {
namespace {

/// Both halves of an arch. `gum`, `edge`: y of the central incisor's neck and edge, metres.
TriangleMesh make_teeth(const ArchCurve& arch, const HalfDentition& teeth, double gum, double edge) {
  const auto places = tooth_places(arch, teeth);
  const double up = edge > gum ? 1.0 : -1.0;
  const double tall = std::abs(edge - gum) / (1e-3 * teeth[0].height);
  std::vector<TriangleMesh> all;
  for (std::size_t i = 0; i < teeth.size(); ++i) {
    const ToothForm& form = teeth[i];
    const ToothPlace& at = places[i];
    const double thickness = std::min(1.0, 1.04 * at.width / (1e-3 * form.width)) * 1e-3 * form.thickness;
    const double height = 1e-3 * tall * form.height, neck = edge - up * (1e-3 * form.short_by + height);
    TriangleMesh tooth = make_crown(form, (form.cusps.empty() ? 0.99 : 0.955) * at.width, thickness, height);
    const Vector2d tangent = arch.tangent(at.middle), outward = arch.outward(at.middle);
    // The labial face is flat across the tooth and the arch is curved: half the sagitta inwards.
    const double bend = std::abs(arch.outward(at.distal).dot(arch.tangent(at.mesial)));
    const Vector2d origin = arch.point(at.middle) - (0.10 * at.width * bend + 0.0001) * outward;
    for (Eigen::Index v = 0; v < tooth.V.rows(); ++v) {
      const Vector3d q = tooth.V.row(v);
      const Vector2d plane = origin + q.x() * tangent + q.z() * outward;
      tooth.V.row(v) << plane.x(), neck + up * q.y(), plane.y();
    }
    if (up < 0) {  // the map above mirrors the crowns that grow downwards
      tooth.F.col(1).swap(tooth.F.col(2));
      tooth.FUV.col(1).swap(tooth.FUV.col(2));
    }
    all.push_back(tooth);
    all.push_back(mirrored(tooth));
  }
  return joined(all);
}

}  // namespace

TriangleMesh make_upper_teeth(const Proportions& p) {
  return make_teeth(upper_arch(p.arch), upper_dentition(), p.arch.upper_gum, p.arch.upper_edge);
}

TriangleMesh make_lower_teeth(const Proportions& p) {
  return make_teeth(lower_arch(p.arch), lower_dentition(), p.arch.lower_gum, p.arch.lower_edge);
}

}  // namespace phiz
