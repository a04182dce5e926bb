// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/render/materials.h"

namespace phiz {

Material clay_material() {
  Material m;
  m.albedo = {0.46, 0.43, 0.40};
  m.roughness = 0.48;
  m.specular = 0.035;
  return m;
}

Material skin_material() {
  Material m;
  m.albedo = {0.645, 0.395, 0.290};
  m.roughness = 0.46;
  m.specular = 0.030;
  m.scatter = {0.34, 0.15, 0.09};
  m.grain = 1;
  return m;
}

Material eye_material() {
  Material m;
  m.albedo = {0.64, 0.62, 0.60};
  m.roughness = 0.06;
  m.specular = 0.04;
  m.scatter = {0.12, 0.08, 0.07};
  return m;
}

Material enamel_material() {
  Material m;
  m.albedo = {0.87, 0.79, 0.67};
  m.roughness = 0.20;
  m.specular = 0.05;
  m.scatter = {0.55, 0.50, 0.42};
  m.unlit = 0.16;  // stands in for the light that goes round inside the mouth
  return m;
}

Material gum_material() {
  Material m;
  m.albedo = {0.50, 0.185, 0.17};
  m.roughness = 0.28;
  m.specular = 0.04;
  m.scatter = {0.35, 0.10, 0.08};
  return m;
}

Material hair_material() {
  Material m;
  m.albedo = {0.035, 0.024, 0.018};
  m.roughness = 0.4;
  m.specular = 0.03;
  return m;
}

Material bone_material() {
  Material m;
  m.albedo = {0.66, 0.59, 0.46};
  m.roughness = 0.55;
  m.specular = 0.035;
  m.scatter = {0.08, 0.06, 0.04};
  return m;
}

Material section_material() {
  Material m;
  m.albedo = Vector3d::Ones();
  m.roughness = 0.7;
  m.specular = 0.02;
  m.unlit = 0.65;
  return m;
}

Material muscle_material() {
  Material m;
  m.albedo = Vector3d::Ones();
  m.roughness = 0.40;
  m.specular = 0.04;
  m.scatter = {0.2, 0.05, 0.04};
  m.striation = 1;
  return m;
}

}  // namespace phiz
