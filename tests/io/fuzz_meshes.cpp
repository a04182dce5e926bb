// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "io/mutate.h"
#include "io/sample_meshes.h"
#include "io/temporary_folder.h"
#include "phiz/geometry/validate.h"
#include "phiz/io/file_bytes.h"
#include "phiz/io/obj.h"
#include "phiz/io/ply.h"
#include "phiz/io/stl.h"

namespace phiz {
namespace {

/// What write(path) wrote.
template <class Write>
std::string bytes_of(Write&& write) {
  const TemporaryFolder folder;
  write(folder.file("seed"));
  return read_bytes(folder.file("seed"));
}

TEST(FuzzObj, every_mutation_is_read_or_refused) {
  const std::string cube = bytes_of([](const std::string& path) { write_obj(path, sample_cube()); });
  const std::string odd =
      "o a\r\nv 0 0 0 1 0 0\r\nv 1e-1 0 0\r\nv 0 +1 \\\r\n0\r\nvt 0\r\nvt 1 1\r\nvn 0 0 1\r\ng x y\r\nf -3/1/1 -2/2/1 "
      "-1/1/1\r\n"
      "f 1//1 2//1 3//1\r\nl 1 2\r\nusemtl m\r\n";
  expect_survives({cube, odd}, 5000, [](const std::string& text) { validate(parse_obj(text, "fuzz"), "fuzz"); });
}

TEST(FuzzPly, every_mutation_is_read_or_refused) {
  PlyAttributes attributes;
  attributes.normals = MatrixX3d::Constant(8, 3, 0.5);
  attributes.colours = MatrixX3d::Constant(8, 3, 0.2);
  std::vector<std::string> seeds;
  for (const PlyEncoding e : {PlyEncoding::ascii, PlyEncoding::binary_little_endian, PlyEncoding::binary_big_endian}) {
    seeds.push_back(bytes_of([&](const std::string& path) { write_ply(path, sample_cube(), attributes, e); }));
  }
  expect_survives(seeds, 5000, [](const std::string& bytes) {
    PlyAttributes found;
    const PolygonMesh mesh = parse_ply(bytes, "fuzz", &found);
    validate(mesh, "fuzz");
    EXPECT_TRUE(found.normals.allFinite() && found.colours.allFinite());
  });
}

TEST(FuzzStl, every_mutation_is_read_or_refused) {
  std::vector<std::string> seeds;
  for (const StlEncoding e : {StlEncoding::binary, StlEncoding::ascii}) {
    seeds.push_back(bytes_of([&](const std::string& path) { write_stl(path, sample_tetrahedron(), e); }));
  }
  expect_survives(seeds, 5000, [](const std::string& bytes) { validate(parse_stl(bytes, "fuzz"), "fuzz"); });
}

}  // namespace
}  // namespace phiz
