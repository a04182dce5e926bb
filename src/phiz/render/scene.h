// SPDX-License-Identifier: GPL-3.0-or-later
/// What a picture shows: surfaces with materials, lights, background. Lengths in any one unit (metres in Phiz); the
/// renderer scales its distances (soft shadows, ambient reach, ray offsets) with the size of the scene.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "phiz/geometry/mesh.h"

namespace phiz {

/// How a surface reflects light. Colours are linear RGB.
struct Material {
  Vector3d albedo{0.55, 0.52, 0.49};  ///< diffuse colour; multiplied by Surface::colour where there is one
  double roughness = 0.55;            ///< GGX roughness, 0.03 (wet) to 1
  double specular = 0.04;             ///< reflectance at normal incidence
  Vector3d scatter{0, 0, 0};          ///< how far light bleeds past the terminator per channel, 0 to 1 (skin: red most)
  double opacity = 1;                 ///< below 1: what lies behind shows through, less so at grazing angles
  double unlit = 0;                   ///< share of the picture's colour that is the plain albedo (heat maps: about 0.5)
  double grain = 0;                   ///< strength of a fine bump over the rest shape (pores), 0 none
  double striation = 0;               ///< strength of streaks in colour and bump along Surface::fibre, 0 none
};

/// Edge lines drawn over a surface.
struct Wireframe {
  bool shown = false;
  Vector3d colour{0.02, 0.03, 0.05};
  double width = 1.1;               ///< pixels
  std::vector<std::uint8_t> edges;  ///< bit k of entry f: draw edge (k, k+1) of triangle f; empty draws all edges
};

struct Surface {
  std::string name;
  TriangleMesh mesh;
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();  ///< world from mesh
  MatrixX3d normals;  ///< unit normal per vertex; empty: angle-weighted normals are computed
  MatrixX3d colour;   ///< linear RGB per vertex, multiplied with the albedo; empty: none
  MatrixX3d rest;     ///< positions that fix the grain of the material to the moving surface; empty: mesh.V
  MatrixX3d fibre;    ///< direction of the streaks per vertex, in the frame of the mesh; empty: none
  std::function<Vector3d(const Vector3d&)> colour_at;  ///< colour pattern at a rest position, multiplied with the
                                                       ///< albedo too; empty: none. Called from several threads.
  Material material;
  Wireframe wireframe;
  bool flat = false;   ///< shade with face normals
  double outline = 0;  ///< how dark a thin line in the picture is where this and another surface meet, 0 none, 1 black
};

/// A round soft box that faces the middle of the scene. `irradiance`: what it gives to a surface that faces it.
struct AreaLight {
  Vector3d position{0, 0, 1};
  double radius = 0.2;
  Vector3d irradiance{1, 1, 1};
};

/// Light from all around (a vertical gradient) and the picture's backdrop.
struct Surroundings {
  Vector3d sky{0.30, 0.32, 0.36};              ///< ambient radiance from above
  Vector3d ground{0.085, 0.080, 0.076};        ///< ambient radiance from below
  Vector3d backdrop_top{0.205, 0.215, 0.235};  ///< backdrop behind the surfaces, display-linear RGB
  Vector3d backdrop_bottom{0.075, 0.08, 0.09};
};

struct Scene {
  std::vector<Surface> surfaces;
  std::vector<AreaLight> lights;  ///< empty: studio_lights(camera, scene) are used
  Surroundings surroundings;
};

/// Smallest box round all surfaces, in the world. Empty scenes give an empty box.
Eigen::AlignedBox3d bounding_box(const Scene& scene);

/// All vertices of all surfaces in the world, one row each.
MatrixX3d world_points(const Scene& scene);

/// Throws phiz::Error(bad_input) naming the surface and what is wrong: indices out of range, values that are not
/// finite, counts that disagree, no triangles at all.
void validate(const Scene& scene);

}  // namespace phiz
