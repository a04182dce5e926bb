// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>

#include "io/expect_error.h"
#include "io/sample_meshes.h"
#include "io/temporary_folder.h"
#include "phiz/geometry/surface.h"
#include "phiz/io/file_bytes.h"
#include "phiz/io/mesh_file.h"
#include "phiz/io/obj.h"
#include "phiz/io/ply.h"
#include "phiz/io/polygons.h"
#include "phiz/io/stl.h"

namespace phiz {
namespace {

void expect_same(const PolygonMesh& a, const PolygonMesh& b) {
  ASSERT_EQ(a.V.rows(), b.V.rows());
  EXPECT_LT((a.V - b.V).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_EQ(a.faces, b.faces);
  EXPECT_EQ(a.face_uvs, b.face_uvs);
  EXPECT_EQ(a.UV, b.UV);
}

TEST(Obj, a_written_mesh_reads_back_the_same) {
  const TemporaryFolder folder;
  const PolygonMesh cube = sample_cube();
  write_obj(folder.file("new/cube.obj"), cube);
  const PolygonMesh back = read_obj(folder.file("new/cube.obj"));
  expect_same(cube, back);
  ASSERT_EQ(back.face_group.size(), 6u);
  EXPECT_EQ(back.groups[static_cast<std::size_t>(back.face_group[0])], "caps");
  EXPECT_EQ(back.groups[static_cast<std::size_t>(back.face_group[5])], "sides");
}

TEST(Obj, reads_what_modellers_write) {
  const std::string text =
      "\xEF\xBB\xBF# head\r\nmtllib a.mtl\r\nv 1e-1 +2.5E+0 -.5 1.0\r\nv 0 0 0\r\nv 1 \\\r\n 0 0\r\nv 1 1 0\r\n"
      "vt 0 0\r\nvt 1 0\r\nvt 1 1 0\r\nvn 0 0 1\r\ng lips upper\r\ns off\r\nf -3/1/1 -2/2/1 -1/3/1 # comment\r\nf 1 2 "
      "3 4\r\n";
  const PolygonMesh mesh = parse_obj(text, "t.obj");
  EXPECT_EQ(mesh.V.rows(), 4);
  EXPECT_DOUBLE_EQ(mesh.V(0, 0), 0.1);
  EXPECT_DOUBLE_EQ(mesh.V(0, 1), 2.5);
  EXPECT_DOUBLE_EQ(mesh.V(2, 0), 1);
  ASSERT_EQ(mesh.faces.size(), 2u);
  EXPECT_EQ(mesh.faces[0], (std::vector<int>{1, 2, 3}));
  EXPECT_EQ(mesh.faces[1].size(), 4u);
  EXPECT_EQ(mesh.groups, std::vector<std::string>{"lips upper"});
  ASSERT_EQ(mesh.face_uvs[1].size(), 4u);  // got the origin
  EXPECT_EQ(mesh.UV.row(mesh.face_uvs[1][0]), Eigen::RowVector2d(0, 0));
}

TEST(Obj, names_the_line_of_what_is_wrong) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  EXPECT_REJECTED(parse_obj(vertices + "f 1 2 4\n", "a.obj"), "a.obj:4");
  EXPECT_REJECTED(parse_obj(vertices + "f 1 2 -4\n", "a.obj"), "a.obj:4");
  EXPECT_REJECTED(parse_obj(vertices + "f 1 2 0\n", "a.obj"), "indices start at 1");
  EXPECT_REJECTED(parse_obj(vertices + "f 1 2\n", "a.obj"), "at least 3");
  EXPECT_REJECTED(parse_obj(vertices + "f 1 2 2\n", "a.obj"), "vertex 2 twice");
  EXPECT_REJECTED(parse_obj(vertices + "f 1 2 99999999999999999999\n", "a.obj"), "a.obj:4");
  EXPECT_REJECTED(parse_obj(vertices + "f 1/1 2/1 3/1\n", "a.obj"), "texture coordinate");
  EXPECT_REJECTED(parse_obj("v 0 nan 0\n", "a.obj"), "a.obj:1");
  EXPECT_REJECTED(parse_obj("v 0 1e999 0\n", "a.obj"), "finite");
  EXPECT_REJECTED(parse_obj("v 0 x 0\n", "a.obj"), "'x'");
  EXPECT_REJECTED(parse_obj("v 0 1\n", "a.obj"), "expected 3");
  EXPECT_REJECTED(parse_obj("hello\n", "a.obj"), "no vertices");
  EXPECT_REJECTED(read_obj("/nowhere/a.obj"), "does not exist");
}

TEST(Obj, numbers_frames_of_a_sequence) {
  EXPECT_EQ(sequence_name("out/a.obj", 7), "out/a.0007.obj");
}

TEST(Ply, every_encoding_reads_back_the_same) {
  const TemporaryFolder folder;
  PolygonMesh cube = sample_cube();
  cube.UV.resize(0, 2);
  cube.face_uvs.clear();
  PlyAttributes attributes;
  attributes.normals = MatrixX3d::Constant(8, 3, 0.5);
  attributes.colours = MatrixX3d::Constant(8, 3, 0.2);
  for (const PlyEncoding e : {PlyEncoding::ascii, PlyEncoding::binary_little_endian, PlyEncoding::binary_big_endian}) {
    write_ply(folder.file("cube.ply"), cube, attributes, e);
    PlyAttributes found;
    expect_same(cube, read_ply(folder.file("cube.ply"), &found));
    EXPECT_EQ(found.normals, attributes.normals);
    EXPECT_LT((found.colours - attributes.colours).norm(), 1e-6);
  }
}

TEST(Ply, skips_what_it_does_not_know) {
  const PolygonMesh mesh = parse_ply(
      "ply\r\nformat ascii 1.0\r\ncomment x\r\nelement camera 1\r\nproperty list uchar float view\r\nelement vertex "
      "3\r\n"
      "property float x\r\nproperty float confidence\r\nproperty float y\r\nproperty float z\r\nelement face 1\r\n"
      "property list uchar int vertex_indices\r\nproperty uchar flag\r\nend_header\r\n"
      "2 1 2\r\n0 9 0 0\r\n1 9 0 0\r\n0 9 1 0\r\n3 0 1 2 7\r\n",
      "a.ply");
  EXPECT_EQ(mesh.V(2, 1), 1);
  EXPECT_EQ(mesh.faces, (std::vector<std::vector<int>>{{0, 1, 2}}));
}

TEST(Ply, refuses_claims_that_the_file_cannot_hold) {
  const std::string head = "ply\nformat binary_little_endian 1.0\nelement vertex ";
  const std::string properties = "\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
  EXPECT_REJECTED(parse_ply(head + "1000000000000" + properties + "abc", "a.ply"), "claims 1000000000000");
  EXPECT_REJECTED(parse_ply(head + "-1" + properties, "a.ply"), "a.ply:3");
  EXPECT_REJECTED(parse_ply(head + "0" + properties, "a.ply"), "no vertices");
  EXPECT_REJECTED(parse_ply("ply\nformat ascii 1.0\n", "a.ply"), "end_header");
  EXPECT_REJECTED(parse_ply("solid", "a.ply"), "not a PLY file");
  EXPECT_REJECTED(parse_ply("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                            "property float z\nend_header\n0 nan 0\n",
                            "a.ply"),
                  "a.ply:8");
}

TEST(Stl, welds_equal_corners_in_both_encodings) {
  const TemporaryFolder folder;
  const TriangleMesh mesh = sample_tetrahedron();
  for (const StlEncoding e : {StlEncoding::binary, StlEncoding::ascii}) {
    write_stl(folder.file("t.stl"), mesh, e);
    const TriangleMesh back = read_stl(folder.file("t.stl"));
    EXPECT_EQ(back.V.rows(), 4);
    EXPECT_EQ(back.F.rows(), 4);
    EXPECT_NEAR(signed_volume(back.V, back.F), signed_volume(mesh.V, mesh.F), 1e-9);
  }
}

TEST(Stl, refuses_damaged_files) {
  const TemporaryFolder folder;
  write_stl(folder.file("t.stl"), sample_tetrahedron());
  const std::string bytes = read_bytes(folder.file("t.stl"));
  EXPECT_REJECTED(parse_stl(bytes.substr(0, bytes.size() - 1), "a.stl"), "4 triangles");
  EXPECT_REJECTED(parse_stl("solid x\nfacet\nouter loop\nvertex 0 0 0\nendloop\n", "a.stl"), "a.stl:5");
  EXPECT_REJECTED(parse_stl("solid x\nendsolid\n", "a.stl"), "no triangles");
  const std::string corners = "solid x\nfacet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n";
  EXPECT_REJECTED(parse_stl(corners, "a.stl"), "inside a triangle");
  EXPECT_REJECTED(parse_stl(corners + "endloop\nendfacet\n", "a.stl"), "endsolid");
  EXPECT_REJECTED(parse_stl("hello", "a.stl"), "not an STL file");
}

TEST(MeshFile, chooses_the_format_by_the_extension) {
  const TemporaryFolder folder;
  const TriangleMesh mesh = sample_tetrahedron();
  for (const char* name : {"a.obj", "a.PLY", "a.stl"}) {
    write_mesh(folder.file(name), mesh);
    EXPECT_EQ(read_mesh(folder.file(name)).faces.size(), 4u) << name;
  }
  EXPECT_REJECTED(read_mesh(folder.file("a.max")), ".obj");
}

TEST(MeshFile, names_the_unit_of_a_head_that_is_not_in_metres) {
  const MatrixX3d head = sample_cube().V;
  EXPECT_EQ(suspect_unit(head).name, "metres");
  EXPECT_EQ(suspect_unit(head * 100).name, "centimetres");
  EXPECT_EQ(suspect_unit(head * 1000).name, "millimetres");
  EXPECT_EQ(suspect_unit(head * 1e-4).name, "unknown");
  EXPECT_EQ(unit_defect(head), "");
  EXPECT_NE(unit_defect(head * 100).find("scale it by 0.01"), std::string::npos);
  EXPECT_NE(unit_defect(head * 1000).find("millimetres, expected metres; scale it by 0.001"), std::string::npos);
  EXPECT_EQ(unit_defect(MatrixX3d()), "");
}

TEST(OutputFile, leaves_nothing_behind_when_it_is_not_committed) {
  const TemporaryFolder folder;
  {
    OutputFile file(folder.file("a.txt"));
    file.write("half");
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  EXPECT_NE(message_of([&] { write_bytes(folder.file(""), "x"); }, ErrorKind::failure).find("folder"),
            std::string::npos);
}

TEST(OutputFile, reports_a_full_disk) {
  const TemporaryFolder folder;
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  rlimit tight = before;
  tight.rlim_cur = 1000;
  setrlimit(RLIMIT_FSIZE, &tight);
  const std::string message =
      message_of([&] { write_bytes(folder.file("a.txt"), std::string(100000, 'x')); }, ErrorKind::failure);
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_NE(message.find("cannot write"), std::string::npos) << message;
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace phiz
