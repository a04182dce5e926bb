// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "phiz/core/error.h"
#include "phiz/core/parallel.h"
#include "phiz/render/materials.h"
#include "phiz/render/render.h"
#include "render/shapes.h"

namespace phiz {
namespace {

Camera looking_down_z(double distance, int size) {
  Camera camera;
  camera.eye = {0, 0, distance};
  camera.width = camera.height = size;
  return camera;
}

Scene white_on_black(Surface surface) {
  surface.material.albedo = Vector3d::Ones();
  surface.material.unlit = 1;
  Scene scene;
  scene.surroundings.backdrop_top = scene.surroundings.backdrop_bottom = Vector3d::Zero();
  scene.surfaces.push_back(std::move(surface));
  return scene;
}

/// Pixels that are covered, counting partly covered ones in linear light.
double covered(const Image& image) {
  double sum = 0;
  for (std::size_t i = 0; i < image.pixels.size(); i += 3) {
    const double v = image.pixels[i] / 255.0;
    sum += v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
  }
  return sum;
}

TEST(Render, SilhouetteOfASphereHasItsArea) {
  Surface ball = test::surface_of(test::sphere(0.1, 6));
  const Camera camera = looking_down_z(1.0, 400);
  const Image image = render(white_on_black(ball), camera);
  // The outline is the circle where the view cone touches: slope r / sqrt(d^2 - r^2).
  const double slope = 0.1 / std::sqrt(1 - 0.01);
  const double radius = slope * 400 / (2 * std::tan(camera.vertical_fov / 2));
  EXPECT_NEAR(covered(image), M_PI * radius * radius, 0.003 * M_PI * radius * radius);
}

TEST(Render, NearPlaneHidesWhatIsCloser) {
  const Surface ball = test::surface_of(test::sphere(0.1, 6));
  Camera camera = looking_down_z(1.0, 400);
  camera.near = 1.0;  // cuts the ball in half: the far half is seen from inside, through its rim of radius 0.1
  const double radius = 0.1 * 400 / (2 * std::tan(camera.vertical_fov / 2));
  EXPECT_NEAR(covered(render(white_on_black(ball), camera)), M_PI * radius * radius, 0.003 * M_PI * radius * radius);
  camera.near = 1.2;
  EXPECT_EQ(covered(render(white_on_black(ball), camera)), 0);
}

TEST(Render, ProjectionAgreesWithTheRays) {
  const Vector3d corner(0.02, -0.035, 0.01);
  Surface dot = test::surface_of(test::sphere(0.002, 3));
  dot.transform.translation() = corner;
  Camera camera = looking_down_z(0.8, 300);
  camera.eye += Vector3d(0.1, 0.05, 0);
  const Image image = render(white_on_black(dot), camera);
  double x = 0, y = 0, mass = 0;
  for (int row = 0; row < 300; ++row) {
    for (int column = 0; column < 300; ++column) {
      const double w = *image.at(column, row);
      x += w * (column + 0.5);
      y += w * (row + 0.5);
      mass += w;
    }
  }
  const Vector3d expected = project(camera, corner);
  EXPECT_NEAR(x / mass, expected.x(), 0.05);
  EXPECT_NEAR(y / mass, expected.y(), 0.05);
}

TEST(Render, IsTheSameForAnyNumberOfThreads) {
  Surface ball = test::surface_of(test::sphere(0.1, 5));
  ball.material = skin_material();
  ball.wireframe.shown = true;
  Surface block = test::surface_of(test::box({-0.2, -0.2, -0.2}, {0.2, -0.08, 0.2}));
  block.material.opacity = 0.5;
  Scene scene;
  scene.surfaces = {ball, block};
  const Camera camera = looking_down_z(1.2, 150);
  Image one, four;
  {
    const ThreadLimit limit(1);
    one = render(scene, camera);
  }
  {
    const ThreadLimit limit(4);
    four = render(scene, camera);
  }
  EXPECT_EQ(one.pixels, four.pixels);
}

TEST(Render, LitMattPlateFollowsLambert) {
  // One small light, no ambient light, no gloss, no tone curve reached: radiance = albedo * irradiance * cos / pi.
  Surface plate = test::surface_of(test::box({-1, -1, -0.1}, {1, 1, 0}));
  plate.flat = true;
  plate.material.albedo = Vector3d::Constant(0.5);
  plate.material.specular = 0;
  plate.material.roughness = 1;
  Scene scene;
  scene.surroundings.sky = scene.surroundings.ground = Vector3d::Zero();
  scene.surfaces.push_back(plate);
  for (const double angle : {0.0, 30.0, 60.0}) {
    const double a = angle * M_PI / 180;
    scene.lights = {AreaLight{Vector3d(0, std::sin(a), std::cos(a)) * 50, 0.01, Vector3d::Constant(2)}};
    const Image image = render(scene, looking_down_z(1, 31));
    const double v = *image.at(15, 15) / 255.0;
    const double linear = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
    EXPECT_NEAR(linear, 0.5 * 2 * std::cos(a) / M_PI, 0.02) << angle;
  }
}

TEST(Render, ShadowsFallBehindAnObstacle) {
  Surface plate = test::surface_of(test::box({-1, -1, -0.1}, {1, 1, 0}));
  plate.flat = true;
  plate.material.specular = 0;
  plate.material.albedo = Vector3d::Constant(0.8);
  Surface obstacle = test::surface_of(test::box({-0.02, 0.08, 0.05}, {0.02, 0.12, 0.09}));
  Scene scene;
  scene.surroundings.sky = scene.surroundings.ground = Vector3d::Zero();
  scene.surfaces = {plate, obstacle};
  scene.lights = {AreaLight{Vector3d(0, 5, 3.5), 0.01, Vector3d::Constant(2)}};  // slope 10 : 7
  const Image image = render(scene, looking_down_z(2, 201));
  const Vector3d shadow = project(looking_down_z(2, 201), {0, 0, 0});  // 0.1 below, 0.07 behind the obstacle
  const Vector3d free = project(looking_down_z(2, 201), {0.1, 0, 0});
  EXPECT_LT(*image.at(static_cast<int>(shadow.x()), static_cast<int>(shadow.y())), 12);
  EXPECT_GT(*image.at(static_cast<int>(free.x()), static_cast<int>(free.y())), 90);
}

TEST(Render, AmbientLightIsHalvedInACorner) {
  // A point beside a high wall sees half of the sky: with uniform ambient light a grey floor gets less than in the
  // open.
  Surface floor = test::surface_of(test::box({-5, -0.1, -5}, {5, 0, 5}));
  Surface wall = test::surface_of(test::box({-5, 0, -5.2}, {5, 5, -0.01}));
  for (Surface* s : {&floor, &wall}) {
    s->flat = true;
    s->material.specular = 0;
    s->material.roughness = 1;
    s->material.albedo = Vector3d::Constant(0.18);
  }
  Scene scene;
  scene.surroundings.sky = scene.surroundings.ground = Vector3d::Ones();
  scene.lights = {AreaLight{Vector3d(0, -50, 0), 0.01, Vector3d::Zero()}};
  Camera camera;
  camera.eye = {0, 2, 1.5};
  camera.target = {0, 0, 0.05};
  camera.width = camera.height = 33;
  camera.vertical_fov = 0.02;
  RenderOptions options;
  options.ambient_samples = 64;
  options.ambient_reach = 1;
  const auto brightness = [&](std::vector<Surface> surfaces) {
    scene.surfaces = std::move(surfaces);
    const double v = *render(scene, camera, options).at(16, 16) / 255.0;
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
  };
  const double open = brightness({floor}), corner = brightness({floor, wall});
  EXPECT_NEAR(open, 0.18, 0.01);
  EXPECT_GT(corner, 0.45 * open);
  EXPECT_LT(corner, 0.75 * open);
}

/// A square before the camera, seen without light and shade.
Surface plain_square(double left, double right, const Vector3d& colour) {
  Surface s = test::surface_of(test::box({left, -1, -0.01}, {right, 1, 0}));
  s.material.albedo = colour;
  s.material.unlit = 1;
  return s;
}

TEST(Render, StreaksRunAlongTheFibres) {
  Scene scene;
  scene.surfaces = {plain_square(-1, 1, {0.4, 0.4, 0.4})};
  Surface& s = scene.surfaces[0];
  s.material.striation = 1;
  s.fibre = Eigen::RowVector3d::UnitY().replicate(s.mesh.V.rows(), 1);
  const Image image = render(scene, looking_down_z(0.2, 64));
  double along = 0, across = 0;
  for (int y = 8; y < 56; ++y) {
    for (int x = 8; x < 56; ++x) {
      along += std::abs(*image.at(x, y) - *image.at(x, y + 1));
      across += std::abs(*image.at(x, y) - *image.at(x + 1, y));
    }
  }
  EXPECT_GT(across, 2 * along);
  EXPECT_GT(across, 48 * 48);
}

TEST(Render, OutlinesDarkenTheLineBetweenSurfacesOnly) {
  Scene scene;
  scene.surfaces = {plain_square(-1, 0, {0.4, 0.4, 0.4}), plain_square(0, 1, {0.4, 0.4, 0.4})};
  const Camera camera = looking_down_z(0.2, 64);
  const Image plain = render(scene, camera);
  scene.surfaces[0].outline = 0.8;
  const Image outlined = render(scene, camera);
  EXPECT_LT(*outlined.at(31, 32), 0.8 * *plain.at(31, 32));
  EXPECT_LT(*outlined.at(32, 32), 0.8 * *plain.at(32, 32));
  EXPECT_NEAR(*outlined.at(10, 32), *plain.at(10, 32), 1);
}

TEST(Render, EmptySceneIsTheBackdrop) {
  const Image image = render(Scene(), looking_down_z(1, 16));
  EXPECT_EQ(image.pixels.size(), 16U * 16U * 3U);
}

TEST(Render, RefusesWhatItCannotDraw) {
  const Camera camera = looking_down_z(1, 16);
  Scene scene;
  scene.surfaces.push_back(test::surface_of(test::sphere(0.1, 1)));
  Scene broken = scene;
  broken.surfaces[0].mesh.F(0, 0) = 1000;
  EXPECT_THROW(render(broken, camera), Error);
  broken = scene;
  broken.surfaces[0].mesh.V(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(render(broken, camera), Error);
  broken = scene;
  broken.surfaces[0].colour = MatrixX3d::Ones(3, 3);
  EXPECT_THROW(render(broken, camera), Error);
  Camera nowhere = camera;
  nowhere.target = nowhere.eye;
  EXPECT_THROW(render(scene, nowhere), Error);
  RenderOptions options;
  options.samples = 0;
  EXPECT_THROW(render(scene, camera, options), Error);
}

}  // namespace
}  // namespace phiz
