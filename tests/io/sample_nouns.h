// SPDX-License-Identifier: GPL-3.0-or-later
/// The smallest values of each noun that have something in every field and pass validation.
#pragma once

#include "io/sample_meshes.h"
#include "phiz/face/face_model.h"
#include "phiz/face/performance.h"
#include "phiz/face/take.h"

namespace phiz {

/// One tetrahedron of flesh, 0.1 m.
inline HeadTemplate sample_head() {
  const TriangleMesh skin = sample_tetrahedron();
  HeadTemplate head;
  head.name = "sample";
  head.provenance = "made by the tests";
  head.volume.V = skin.V;
  head.volume.T.resize(1, 4);
  head.volume.T << 0, 1, 2, 3;
  head.volume.region = VectorXi::Constant(1, Tissue::flesh);
  head.carrier = VectorXi::Zero(4);
  head.carrier[3] = static_cast<int>(Carrier::skull);
  head.skin_vertices = VectorXi::LinSpaced(4, 0, 3);
  head.skin_triangles = skin.F;
  head.skin = skin;
  head.skin.UV.resize(3, 2);
  head.skin.UV << 0, 0, 1, 0, 0, 1;
  head.skin.FUV = MatrixX3i::Zero(4, 3);
  head.skin_sampling.resize(4, 4);
  head.skin_sampling.setIdentity();
  head.skin_interpolation = head.skin_sampling;
  head.skin_regions["upperLip"] = VectorXi::LinSpaced(2, 1, 2);
  head.skin_regions["empty"] = VectorXi();
  Part tongue{"tongue", sample_tetrahedron(), Carrier::mandible, {}};
  tongue.shapes["tongueOut"] = MatrixX3d::Constant(4, 3, 0.01);
  head.parts = {tongue, {"skull", sample_tetrahedron(), Carrier::skull, {}}};
  head.jaw.lower = JawPose::Constant(-0.1);
  head.jaw.upper = JawPose::Constant(0.5);
  head.expressions.push_back({"jawOpen", MatrixX3d::Constant(4, 3, 0.002), JawPose::Constant(0.1)});
  head.landmarks = {{"0", 1}, {"67", 2}};
  head.skull_landmarks.push_back({"nasion", 3, Vector3d::UnitZ(), 2, 0.005, 0.001});
  Muscle muscle;
  muscle.name = "zygomaticus";
  muscle.fibres = {MatrixX3d::Constant(3, 3, 0.01), MatrixX3d::Constant(2, 3, 0.02)};
  muscle.tets = VectorXi::Zero(1);
  muscle.fraction = VectorXd::Constant(1, 0.4);
  muscle.direction = Vector3d::UnitY().transpose();
  muscle.surface = sample_tetrahedron();
  muscle.ring = true;
  head.muscles = {muscle};
  head.attachments.vertices = VectorXi::Constant(1, 3);
  head.attachments.hold = VectorXi::Constant(1, static_cast<int>(Hold::slide));
  head.attachments.normals = Vector3d::UnitZ().transpose();
  head.identity.skin = Eigen::MatrixXf::Constant(12, 2, 0.001F);
  head.identity.skin(5, 1) = -0.002F;
  head.identity.deviation = VectorXd::LinSpaced(2, 0.002, 0.001);
  head.contact_regions.push_back({"lips", VectorXi::Zero(1), skin.F.topRows(2)});
  head.contact_pairs = {{"lips", "skull"}};
  head.left_eye_centre = Vector3d(0.03, 0.02, 0.05);
  head.right_eye_centre = Vector3d(-0.03, 0.02, 0.05);
  return head;
}

inline FaceModel sample_model() {
  FaceModel model{sample_head(), {}};
  VolumetricShape shape;
  shape.name = "jawOpen";
  shape.jaw = JawPose::Constant(0.2);
  shape.tets = VectorXi::Zero(1);
  shape.log_rotation.setRandom(1, 3);
  shape.stretch.setRandom(1, 6);
  shape.displacement.setRandom(4, 3);
  shape.displacement *= 0.01F;
  model.shapes = {shape};
  return model;
}

inline Performance sample_performance() {
  Performance p;
  p.expressions = {"jawOpen", "mouthSmileLeft"};
  p.frame_rate = 30;
  p.time = VectorXd::LinSpaced(10, 0, 0.3);
  p.weights = MatrixXd::Random(10, 2).cwiseAbs();
  p.head = MatrixX3d::Random(10, 3) * 0.2;
  p.left_eye = MatrixX3d::Random(10, 3) * 0.2;
  p.right_eye = MatrixX3d::Random(10, 3) * 0.2;
  return p;
}

/// The skin is a regular grid of `side` x `side` vertices that waves; parts as in sample_head, and two eyes.
inline Take sample_take(int frames, int side = 6) {
  Take take;
  take.model = "sample";
  take.frame_rate = 25;
  take.frames_planned = frames;
  take.expressions = {"tongueOut"};
  take.skin.V.resize(side * side, 3);
  take.skin.UV.resize(side * side, 2);
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const double u = x / (side - 1.0), v = y / (side - 1.0);
      take.skin.V.row(y * side + x) << 0.2 * u - 0.1, 0.2 * v - 0.1, 0.1;
      take.skin.UV.row(y * side + x) << u, v;
    }
  }
  take.skin.F.resize(2 * (side - 1) * (side - 1), 3);
  Eigen::Index f = 0;
  for (int y = 0; y + 1 < side; ++y) {
    for (int x = 0; x + 1 < side; ++x) {
      const int a = y * side + x;
      take.skin.F.row(f++) << a, a + 1, a + side;
      take.skin.F.row(f++) << a + 1, a + side + 1, a + side;
    }
  }
  take.skin.FUV = take.skin.F;
  take.parts = sample_head().parts;
  take.left_eye_centre = Vector3d(0.03, 0.02, 0.05);
  take.right_eye_centre = Vector3d(-0.03, 0.02, 0.05);
  for (const auto& [name, carrier, centre] : {std::tuple{"leftEye", Carrier::left_eye, take.left_eye_centre},
                                              std::tuple{"rightEye", Carrier::right_eye, take.right_eye_centre}}) {
    Part eye{name, sample_tetrahedron(), carrier, {}};
    eye.mesh.V.rowwise() += centre.transpose();
    take.parts.push_back(eye);
  }
  for (int i = 0; i < frames; ++i) {
    TakeFrame frame;
    frame.time = i / take.frame_rate;
    frame.skin = take.skin.V.cast<float>();
    for (Eigen::Index k = 0; k < frame.skin.rows(); ++k) {
      frame.skin(k, 2) += static_cast<float>(0.01 * std::sin(0.4 * i + 20 * take.skin.V(k, 0)));
    }
    frame.jaw[0] = 0.02 * i;
    frame.head = Eigen::Translation3d(0, 0.001 * i, 0) * Eigen::AngleAxisd(0.05 * i, Vector3d::UnitY());
    frame.left_eye = Eigen::AngleAxisd(0.02 * i, Vector3d::UnitX()).toRotationMatrix();
    frame.right_eye = frame.left_eye.transpose();
    frame.part_weights = VectorXd::Constant(1, 0.1 * (i % 10));
    frame.statistics = {true, 6, 4e-4, 1.5, i, 1e-5, -0.01, 2e-6, 14.0 + i};
    take.frames.push_back(frame);
  }
  return take;
}

}  // namespace phiz
