// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>

#include "io/expect_error.h"
#include "io/sample_nouns.h"
#include "io/temporary_folder.h"
#include "io/version1.h"
#include "io/version2.h"
#include "phiz/core/random.h"
#include "phiz/io/container.h"
#include "phiz/io/file_bytes.h"
#include "phiz/io/output_file.h"
#include "phiz/io/take_file.h"

namespace phiz {
namespace {

void expect_same(const TriangleMesh& a, const TriangleMesh& b) {
  EXPECT_EQ(a.V, b.V);
  EXPECT_EQ(a.F, b.F);
  EXPECT_EQ(a.UV, b.UV);
  EXPECT_EQ(a.FUV, b.FUV);
}

void expect_same(const HeadTemplate& a, const HeadTemplate& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.provenance, b.provenance);
  EXPECT_EQ(a.volume.V, b.volume.V);
  EXPECT_EQ(a.volume.T, b.volume.T);
  EXPECT_EQ(a.volume.region, b.volume.region);
  EXPECT_EQ(a.carrier, b.carrier);
  EXPECT_EQ(a.skin_vertices, b.skin_vertices);
  EXPECT_EQ(a.skin_triangles, b.skin_triangles);
  expect_same(a.skin, b.skin);
  EXPECT_EQ(MatrixXd(a.skin_sampling), MatrixXd(b.skin_sampling));
  EXPECT_EQ(MatrixXd(a.skin_interpolation), MatrixXd(b.skin_interpolation));
  EXPECT_EQ(a.skin_regions, b.skin_regions);
  ASSERT_EQ(a.parts.size(), b.parts.size());
  for (std::size_t i = 0; i < a.parts.size(); ++i) {
    EXPECT_EQ(a.parts[i].name, b.parts[i].name);
    EXPECT_EQ(a.parts[i].carrier, b.parts[i].carrier);
    EXPECT_EQ(a.parts[i].shapes, b.parts[i].shapes);
    expect_same(a.parts[i].mesh, b.parts[i].mesh);
  }
  EXPECT_EQ(a.jaw.upper, b.jaw.upper);
  EXPECT_EQ(a.jaw.axis, b.jaw.axis);
  ASSERT_EQ(a.expressions.size(), b.expressions.size());
  EXPECT_EQ(a.expressions[0].name, b.expressions[0].name);
  EXPECT_EQ(a.expressions[0].displacement, b.expressions[0].displacement);
  EXPECT_EQ(a.expressions[0].jaw, b.expressions[0].jaw);
  ASSERT_EQ(a.landmarks.size(), b.landmarks.size());
  EXPECT_EQ(a.landmarks[1].name, b.landmarks[1].name);
  EXPECT_EQ(a.landmarks[1].skin_vertex, b.landmarks[1].skin_vertex);
  ASSERT_EQ(a.skull_landmarks.size(), b.skull_landmarks.size());
  EXPECT_EQ(a.skull_landmarks[0].name, b.skull_landmarks[0].name);
  EXPECT_EQ(a.skull_landmarks[0].bone_vertex, b.skull_landmarks[0].bone_vertex);
  EXPECT_EQ(a.skull_landmarks[0].normal, b.skull_landmarks[0].normal);
  EXPECT_EQ(a.skull_landmarks[0].thickness_deviation, b.skull_landmarks[0].thickness_deviation);
  ASSERT_EQ(a.muscles.size(), b.muscles.size());
  EXPECT_EQ(a.muscles[0].fibres, b.muscles[0].fibres);
  EXPECT_EQ(a.muscles[0].fraction, b.muscles[0].fraction);
  EXPECT_EQ(a.muscles[0].direction, b.muscles[0].direction);
  EXPECT_EQ(a.muscles[0].ring, b.muscles[0].ring);
  expect_same(a.muscles[0].surface, b.muscles[0].surface);
  EXPECT_EQ(a.attachments.vertices, b.attachments.vertices);
  EXPECT_EQ(a.attachments.hold, b.attachments.hold);
  EXPECT_EQ(a.attachments.normals, b.attachments.normals);
  EXPECT_EQ(a.identity.skin, b.identity.skin);
  EXPECT_EQ(a.identity.deviation, b.identity.deviation);
  ASSERT_EQ(a.contact_regions.size(), b.contact_regions.size());
  EXPECT_EQ(a.contact_regions[0].triangles, b.contact_regions[0].triangles);
  ASSERT_EQ(a.contact_pairs.size(), b.contact_pairs.size());
  EXPECT_EQ(a.contact_pairs[0].obstacle, b.contact_pairs[0].obstacle);
  EXPECT_EQ(a.left_eye_centre, b.left_eye_centre);
}

void expect_same(const TakeFrame& a, const TakeFrame& b) {
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.skin, b.skin);
  EXPECT_EQ(a.jaw, b.jaw);
  EXPECT_EQ(a.head.matrix(), b.head.matrix());
  EXPECT_EQ(a.left_eye, b.left_eye);
  EXPECT_EQ(a.right_eye, b.right_eye);
  EXPECT_EQ(a.part_weights, b.part_weights);
  EXPECT_EQ(a.volume, b.volume);
  EXPECT_EQ(a.velocity, b.velocity);
  EXPECT_EQ(a.statistics.converged, b.statistics.converged);
  EXPECT_EQ(a.statistics.contacts, b.statistics.contacts);
  EXPECT_EQ(a.statistics.residual, b.statistics.residual);
  EXPECT_EQ(a.statistics.last_step, b.statistics.last_step);
  EXPECT_EQ(a.statistics.milliseconds, b.statistics.milliseconds);
}

void expect_same(const Take& a, const Take& b) {
  EXPECT_EQ(a.model, b.model);
  EXPECT_EQ(a.frame_rate, b.frame_rate);
  EXPECT_EQ(a.frames_planned, b.frames_planned);
  EXPECT_EQ(a.expressions, b.expressions);
  expect_same(a.skin, b.skin);
  ASSERT_EQ(a.parts.size(), b.parts.size());
  ASSERT_EQ(a.frames.size(), b.frames.size());
  for (std::size_t i = 0; i < a.frames.size(); ++i) expect_same(a.frames[i], b.frames[i]);
}

TEST(Container, heads_and_models_read_back_the_same) {
  const TemporaryFolder folder;
  save(folder.file("new/head.phiz"), sample_head());
  EXPECT_EQ(kind_of(folder.file("new/head.phiz")), ContainerKind::head_template);
  expect_same(sample_head(), load_head_template(folder.file("new/head.phiz")));

  const FaceModel model = sample_model();
  save(folder.file("model.phiz"), model);
  EXPECT_EQ(kind_of(folder.file("model.phiz")), ContainerKind::face_model);
  const FaceModel back = load_face_model(folder.file("model.phiz"));
  ASSERT_EQ(back.shapes.size(), 1u);
  EXPECT_EQ(back.shapes[0].name, "jawOpen");
  EXPECT_EQ(back.shapes[0].tets, model.shapes[0].tets);
  EXPECT_EQ(back.shapes[0].log_rotation, model.shapes[0].log_rotation);
  EXPECT_EQ(back.shapes[0].stretch, model.shapes[0].stretch);
  EXPECT_EQ(back.shapes[0].displacement, model.shapes[0].displacement);
  EXPECT_EQ(load_head_template(folder.file("model.phiz")).name, "sample");  // a model is a head with more
}

TEST(Container, takes_read_back_the_same) {
  const TemporaryFolder folder;
  Take take = sample_take(7);
  save(folder.file("a.phiz"), take);
  EXPECT_EQ(kind_of(folder.file("a.phiz")), ContainerKind::take);
  expect_same(take, load_take(folder.file("a.phiz")));
  for (TakeFrame& frame : take.frames) frame.volume.setRandom(5, 3), frame.velocity.setRandom(5, 3);
  take.expressions.clear();
  for (TakeFrame& frame : take.frames) frame.part_weights.resize(0);
  save(folder.file("a.phiz"), take);
  expect_same(take, load_take(folder.file("a.phiz")));
  take.frames.clear();
  save(folder.file("a.phiz"), take);
  EXPECT_TRUE(load_take(folder.file("a.phiz")).frames.empty());
}

TEST(Container, an_interrupted_take_keeps_its_frames_and_goes_on) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.phiz");
  const Take whole = sample_take(9);
  {
    TakeWriter writer(path, whole);
    for (int i = 0; i < 4; ++i) writer.append(whole.frames[static_cast<std::size_t>(i)]);
    EXPECT_FALSE(std::filesystem::exists(path));
  }
  EXPECT_EQ(TakeReader(path).frames(), 4);
  EXPECT_EQ(TakeReader(path).head().frames_planned, 9);
  {
    TakeWriter writer = TakeWriter::resume(path, whole);
    ASSERT_EQ(writer.frames(), 4);
    for (std::size_t i = 4; i < 9; ++i) writer.append(whole.frames[i]);
    writer.finish();
  }
  expect_same(whole, load_take(path));
  EXPECT_FALSE(std::filesystem::exists(path + ".part"));
}

TEST(Container, a_killed_run_leaves_its_finished_frames) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.phiz");
  const Take whole = sample_take(6);
  TakeWriter writer(path, whole);
  for (std::size_t i = 0; i < 3; ++i) writer.append(whole.frames[i]);
  // What a killed program leaves on the disk is what is there now.
  std::filesystem::create_directories(folder.file("killed"));
  std::filesystem::copy_file(path + ".part", folder.file("killed/a.phiz.part"));
  EXPECT_EQ(TakeReader(folder.file("killed/a.phiz.part")).frames(), 3);
  TakeWriter again = TakeWriter::resume(folder.file("killed/a.phiz"), whole);
  ASSERT_EQ(again.frames(), 3);
  for (std::size_t i = 3; i < 6; ++i) again.append(whole.frames[i]);
  again.finish();
  expect_same(whole, load_take(folder.file("killed/a.phiz")));
}

/// Writes a take in another process, which tells of each finished frame and is killed after some microseconds. Returns
/// the number of frames that it told of.
int write_and_kill(const std::string& path, const Take& take, std::uint32_t microseconds) {
  std::array<int, 2> ends{};
  if (::pipe(ends.data()) != 0) return -1;
  const pid_t child = ::fork();
  if (child == 0) {
    TakeWriter writer(path, take);
    for (const TakeFrame& frame : take.frames) {
      writer.append(frame);
      if (::write(ends[1], "x", 1) != 1) ::_exit(1);
    }
    for (;;) ::pause();
  }
  ::close(ends[1]);
  ::usleep(microseconds);
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  int told = 0;
  for (char c = 0; ::read(ends[0], &c, 1) == 1;) ++told;
  ::close(ends[0]);
  return told;
}

TEST(Container, a_program_killed_at_any_moment_loses_no_frame_that_it_finished) {
  const TemporaryFolder folder;
  const Take whole = sample_take(70);  // more than one block of the arrays of small entries
  Random random(5);
  for (int round = 0; round < 20; ++round) {
    const std::string path = folder.file(std::to_string(round) + ".phiz");
    const int told = write_and_kill(path, whole, random.below(60'000));
    ASSERT_GE(told, 0);
    const int kept = told > 0 ? TakeReader(path + ".part").frames() : 0;
    ASSERT_GE(kept, told) << "round " << round;
    int shown = 0;
    TakeWriter writer = TakeWriter::resume(path, whole, [&shown](const TakeFrame&) { ++shown; });
    EXPECT_EQ(shown, writer.frames());
    for (auto i = static_cast<std::size_t>(writer.frames()); i < whole.frames.size(); ++i)
      writer.append(whole.frames[i]);
    writer.finish();
    expect_same(whole, load_take(path));
  }
}

TEST(Container, what_refuses_a_finished_frame_leaves_the_take_as_it_was) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.phiz");
  const Take take = sample_take(3);
  save(path, take);
  const std::string bytes = read_bytes(path);
  EXPECT_REJECTED(TakeWriter::resume(path, take, [](const TakeFrame&) { reject("a", "not mine"); }), "not mine");
  EXPECT_TRUE(read_bytes(path) == bytes);
  write_bytes(path + ".part", "no take");
  EXPECT_REJECTED(TakeWriter::resume(path, take), "leave out --resume");
  EXPECT_TRUE(read_bytes(path) == bytes);
}

TEST(Container, a_take_of_something_else_is_not_resumed) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.phiz");
  save(path, sample_take(3));
  Take other = sample_take(4);
  EXPECT_REJECTED(TakeWriter::resume(path, other), "3 frames, not 4");
  other = sample_take(3);
  other.model = "somebody";
  EXPECT_REJECTED(TakeWriter::resume(path, other), "somebody");
  EXPECT_FALSE(std::filesystem::exists(path + ".part"));
  EXPECT_EQ(load_take(path).frames.size(), 3u);
}

TEST(Container, frames_that_do_not_fit_are_refused) {
  const TemporaryFolder folder;
  const Take take = sample_take(3);
  TakeWriter writer(folder.file("a.phiz"), take);
  TakeFrame frame = take.frames[0];
  frame.skin.conservativeResize(3, 3);
  message_of([&] { writer.append(frame); }, ErrorKind::failure);
  frame = take.frames[0];
  frame.skin(0, 0) = std::numeric_limits<float>::quiet_NaN();
  message_of([&] { writer.append(frame); }, ErrorKind::failure);
  writer.append(take.frames[0]);
  frame = take.frames[1];
  frame.volume.setZero(4, 3);
  message_of([&] { writer.append(frame); }, ErrorKind::failure);
  EXPECT_EQ(writer.frames(), 1);
}

TEST(Container, a_full_disk_is_an_error_and_the_next_file_is_good) {
  const TemporaryFolder folder;
  const Take take = sample_take(40, 30);
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  rlimit tight = before;
  tight.rlim_cur = 60000;
  setrlimit(RLIMIT_FSIZE, &tight);
  message_of([&] { save(folder.file("full.phiz"), take); }, ErrorKind::failure);
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_FALSE(std::filesystem::exists(folder.file("full.phiz")));
  save(folder.file("good.phiz"), take);
  expect_same(take, load_take(folder.file("good.phiz")));
}

TEST(Container, damage_and_other_files_are_noticed) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.phiz");
  save(path, sample_head());
  const std::string bytes = read_bytes(path);
  std::string broken = bytes;
  broken[bytes.size() / 2] = static_cast<char>(broken[bytes.size() / 2] ^ 4);
  write_bytes(path, broken);
  EXPECT_REJECTED(load_head_template(path), "checksum");
  write_bytes(path, bytes.substr(0, bytes.size() - 10));
  EXPECT_REJECTED(load_head_template(path), "cut off");
  write_bytes(path, "hello");
  EXPECT_REJECTED(kind_of(path), "not a .phiz file");
  EXPECT_REJECTED(kind_of(folder.file("nothing")), "does not exist");
  save(path, sample_take(1));
  EXPECT_REJECTED(load_face_model(path), "holds a take, expected a model");
}

TEST(Container, version_1_still_loads) {
  const TemporaryFolder folder;
  Take take = sample_take(5);
  take.parts.clear();
  version1::write_take(folder.file("a.phiz"), take);
  expect_same(take, load_take(folder.file("a.phiz")));
}

TEST(Container, a_head_of_version_2_has_no_surfaces_attachments_or_people) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.phiz");
  save(path, sample_head());
  version2::strip_head(path);
  const HeadTemplate head = load_head_template(path);
  ASSERT_EQ(head.muscles.size(), 1U);
  EXPECT_EQ(head.muscles[0].fraction[0], 0.4);
  EXPECT_EQ(head.muscles[0].surface.V.rows(), 0);
  EXPECT_FALSE(head.muscles[0].ring);
  EXPECT_EQ(head.attachments.vertices.size(), 0);
  EXPECT_EQ(head.identity.skin.size(), 0);
  EXPECT_EQ(head.contact_regions.size(), 1U);
}

TEST(Container, a_large_part_reads_back_the_same) {
  const TemporaryFolder folder;
  HeadTemplate head = sample_head();
  const Eigen::Index copies = 30000;  // far more than one chunk of 65,536 rows
  Part& part = head.parts[1];
  part.mesh.V = part.mesh.V.replicate(copies, 1).eval();
  part.shapes["tongueOut"] = 0.01 * MatrixX3d::Random(part.mesh.V.rows(), 3);
  save(folder.file("a.phiz"), head);
  const HeadTemplate loaded = load_head_template(folder.file("a.phiz"));
  EXPECT_EQ(loaded.parts[1].mesh.V, part.mesh.V);
  EXPECT_EQ(loaded.parts[1].shapes, part.shapes);
}

TEST(Container, the_same_head_makes_the_same_bytes_at_another_time) {
  const TemporaryFolder folder;
  save(folder.file("a.phiz"), sample_head());
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // HDF5 keeps times in seconds
  save(folder.file("b.phiz"), sample_head());
  EXPECT_TRUE(read_bytes(folder.file("a.phiz")) == read_bytes(folder.file("b.phiz")));
}

TEST(Container, a_take_that_cannot_be_saved_whole_leaves_nothing) {
  const TemporaryFolder folder;
  Take take = sample_take(3);
  take.frames[2].skin(0, 0) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(save(folder.file("a.phiz"), take), Error);
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) ADD_FAILURE() << entry.path();
}

/// Saves the sample head after `spoil` and expects that reading it back is refused with `words`.
template <class Spoil>
void expect_refused(const char* words, Spoil&& spoil) {
  const TemporaryFolder folder;
  HeadTemplate head = sample_head();
  spoil(head);
  save(folder.file("a.phiz"), head);
  EXPECT_REJECTED(load_head_template(folder.file("a.phiz")), words);
}

TEST(Container, wrong_surfaces_of_muscles_are_refused) {
  expect_refused("surface of muscle zygomaticus", [](HeadTemplate& h) {
    h.muscles[0].surface.F.conservativeResize(3, 3);  // open
  });
  expect_refused("inside out",
                 [](HeadTemplate& h) { h.muscles[0].surface.F.col(0).swap(h.muscles[0].surface.F.col(1)); });
  expect_refused("metres", [](HeadTemplate& h) { h.muscles[0].surface.V *= 1000; });
  expect_refused("muscles/0/surface", [](HeadTemplate& h) { h.muscles[0].surface.V(0, 0) = NAN; });
}

TEST(Container, wrong_attachments_are_refused) {
  expect_refused("no bone carries", [](HeadTemplate& h) { h.attachments.vertices[0] = 0; });
  expect_refused("refers to 4", [](HeadTemplate& h) { h.attachments.vertices[0] = 4; });
  expect_refused("unknown hold 3", [](HeadTemplate& h) { h.attachments.hold[0] = 3; });
  expect_refused("not unit", [](HeadTemplate& h) { h.attachments.normals *= 2; });
  expect_refused("not unit", [](HeadTemplate& h) { h.attachments.normals(0, 0) = NAN; });
  expect_refused("different lengths", [](HeadTemplate& h) { h.attachments.hold.resize(0); });
  expect_refused("must ascend", [](HeadTemplate& h) {
    h.attachments.vertices = h.attachments.vertices.replicate(2, 1).eval();
    h.attachments.hold = h.attachments.hold.replicate(2, 1).eval();
    h.attachments.normals = h.attachments.normals.replicate(2, 1).eval();
  });
}

TEST(Container, a_wrong_model_of_people_is_refused) {
  expect_refused("expected 12 x 2", [](HeadTemplate& h) { h.identity.skin.conservativeResize(9, 2); });
  expect_refused("1 deviations for 2 modes", [](HeadTemplate& h) { h.identity.deviation.conservativeResize(1); });
  expect_refused("negative", [](HeadTemplate& h) { h.identity.deviation[1] = -1; });
  expect_refused("not finite", [](HeadTemplate& h) { h.identity.skin(3, 0) = NAN; });
  expect_refused("metres", [](HeadTemplate& h) { h.identity.skin *= 1000; });
  expect_refused("no modes", [](HeadTemplate& h) { h.identity.skin.resize(12, 0), h.identity.deviation.resize(0); });
}

TEST(Container, what_lies_far_from_the_head_is_refused) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.phiz");
  HeadTemplate head = sample_head();
  head.parts[0].mesh.V *= 1000;
  save(path, head);
  EXPECT_REJECTED(load_head_template(path), "metres");
  head = sample_head();
  head.skin.V *= 1000;
  save(path, head);
  EXPECT_REJECTED(load_head_template(path), "drawn skin");
  head = sample_head();
  head.left_eye_centre[1] = 60;
  save(path, head);
  EXPECT_REJECTED(load_head_template(path), "left eye");
  Take take = sample_take(1);
  take.skin.V *= 1e6;
  save(path, take);
  EXPECT_REJECTED(TakeReader(path), "skin");
  take = sample_take(1);
  take.frame_rate = 1e300;
  save(path, take);
  EXPECT_REJECTED(TakeReader(path), "frame_rate");
}

}  // namespace
}  // namespace phiz
