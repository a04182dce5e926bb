// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "io/expect_error.h"
#include "io/sample_nouns.h"
#include "io/temporary_folder.h"
#include "phiz/io/container.h"
#include "phiz/io/inspect.h"
#include "phiz/io/live_link.h"
#include "phiz/io/mesh_file.h"
#include "phiz/io/obj.h"
#include "phiz/io/png.h"
#include "phiz/io/take_export.h"
#include "phiz/io/take_file.h"
#include "phiz/io/take_gltf.h"

namespace phiz {
namespace {

TEST(Inspect, a_take_tells_its_frames_and_statistics) {
  const TemporaryFolder folder;
  Take take = sample_take(5);
  take.frames_planned = 8;
  take.frames[2].statistics.converged = false;
  save(folder.file("a.phiz"), take);
  const auto json = inspect(folder.file("a.phiz"));
  EXPECT_EQ(json["kind"], "take");
  EXPECT_EQ(json["frames"], 5);
  EXPECT_EQ(json["frames_planned"], 8);
  EXPECT_EQ(json["complete"], false);
  EXPECT_EQ(json["statistics"]["frames_not_converged"], 1);
  EXPECT_EQ(json["statistics"]["ms_max"], 18);
  EXPECT_EQ(json["statistics"]["contacts_max"], 4);
  EXPECT_NE(readable(json).find("frames: 5\n"), std::string::npos);
}

TEST(Inspect, every_kind_of_file_is_described) {
  const TemporaryFolder folder;
  save(folder.file("head.phiz"), sample_head());
  save(folder.file("model.phiz"), sample_model());
  save(folder.file("performance.phiz"), sample_performance());
  write_live_link(folder.file("a.csv"), sample_performance());
  write_png(folder.file("a.png"), Image{2, 1, 3, {1, 2, 3, 4, 5, 6}});
  write_obj(folder.file("a.obj"), sample_cube());
  write_mesh(folder.file("a.stl"), sample_tetrahedron());
  export_take_gltf(sample_take(3), folder.file("a.glb"));
  export_take_point_cache(sample_take(3), folder.file("b.mdd"));
  export_take_point_cache(sample_take(3), folder.file("b.pc2"));
  EXPECT_EQ(inspect(folder.file("head.phiz"))["soft_tets"], 1);
  EXPECT_EQ(inspect(folder.file("model.phiz"))["volumetric_shapes"][0]["name"], "jawOpen");
  EXPECT_EQ(inspect(folder.file("performance.phiz"))["frames"], 10);
  EXPECT_EQ(inspect(folder.file("a.csv"))["frames"], 10);
  EXPECT_EQ(inspect(folder.file("a.png"))["width"], 2);
  EXPECT_EQ(inspect(folder.file("a.obj"))["quads"], 6);
  EXPECT_EQ(inspect(folder.file("a.obj"))["closed"], true);
  EXPECT_EQ(inspect(folder.file("a.stl"))["triangles"], 4);
  EXPECT_EQ(inspect(folder.file("a.glb"))["animations"][0]["frames"], 3);
  EXPECT_EQ(inspect(folder.file("b.mdd"))["frames"], 3);
  EXPECT_EQ(inspect(folder.file("b.pc2"))["points"], 36);
  for (const char* name : {"head.phiz", "model.phiz", "a.csv", "a.glb", "a.obj", "a.png"}) {
    EXPECT_GT(readable(inspect(folder.file(name))).size(), 50u) << name;
  }
  for (const char* name : {"a.obj", "a.glb"}) EXPECT_FALSE(inspect(folder.file(name)).contains("problems")) << name;
  EXPECT_REJECTED(inspect(folder.file("a.xyz")), "does not exist");
  EXPECT_REJECTED(inspect(folder.file("none.phiz")), "does not exist");
}

TEST(Inspect, a_mesh_in_another_unit_is_described_with_the_problem) {
  const TemporaryFolder folder;
  TriangleMesh mesh = sample_tetrahedron();
  mesh.V *= 250 / suspect_unit(mesh.V).extent;
  for (const char* name : {"a.obj", "a.ply", "a.stl", "a.glb"}) {
    write_mesh(folder.file(name), mesh);
    const auto json = inspect(folder.file(name));
    EXPECT_EQ(json["bounds"]["unit"], "millimetres") << name;
    ASSERT_EQ(json["problems"].size(), 1u) << name;
    EXPECT_NE(json["problems"][0].get<std::string>().find("0.001"), std::string::npos) << name;
  }
}

}  // namespace
}  // namespace phiz
