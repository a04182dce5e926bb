// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/io/stored_frames.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "phiz/core/error.h"

namespace phiz {

namespace {

constexpr double rotation_tolerance = 1e-4;

/// The few numbers of a frame in one row: time, jaw (5), head (3 x 4, row by row), left and right eye (3 x 3, row by
/// row), statistics (converged, iterations, residual, energy, contacts, penetration, milliseconds,
/// volume change, last step).
constexpr int row_length = 1 + 5 + 12 + 9 + 9 + 9;
using FrameRow = Eigen::Matrix<double, row_length, 1>;
using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
using RowMajor34 = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;

FrameRow row_of(const TakeFrame& frame) {
  FrameRow row;
  row[0] = frame.time;
  row.segment<5>(1) = frame.jaw;
  Eigen::Map<RowMajor34>(row.data() + 6) = frame.head.matrix().topRows<3>();
  Eigen::Map<RowMajor3>(row.data() + 18) = frame.left_eye;
  Eigen::Map<RowMajor3>(row.data() + 27) = frame.right_eye;
  const SolveStatistics& s = frame.statistics;
  row.tail<9>() << static_cast<double>(s.converged), s.iterations, s.residual, s.energy, s.contacts, s.penetration,
      s.milliseconds, s.volume_change, s.last_step;
  return row;
}

/// A count stored as a number; what is none becomes 0.
int count_of(double value) {
  return value >= 0 && value <= 1e9 ? static_cast<int>(value) : 0;
}

TakeFrame frame_of(const FrameRow& row) {
  TakeFrame frame;
  frame.time = row[0];
  frame.jaw = row.segment<5>(1);
  frame.head.matrix().topRows<3>() = Eigen::Map<const RowMajor34>(row.data() + 6);
  frame.left_eye = Eigen::Map<const RowMajor3>(row.data() + 18);
  frame.right_eye = Eigen::Map<const RowMajor3>(row.data() + 27);
  const auto s = row.tail<9>();
  frame.statistics.converged = s[0] == 1;
  frame.statistics.iterations = count_of(s[1]);
  frame.statistics.residual = s[2];
  frame.statistics.energy = s[3];
  frame.statistics.contacts = count_of(s[4]);
  frame.statistics.penetration = s[5];
  frame.statistics.milliseconds = s[6];
  frame.statistics.volume_change = s[7];
  frame.statistics.last_step = s[8];
  return frame;
}

bool is_rotation(const Matrix3d& R) {
  return R.allFinite() && (R.transpose() * R - Matrix3d::Identity()).norm() < rotation_tolerance && R.determinant() > 0;
}

constexpr const char* row_name = "numbers";

struct Points {
  const char* name;
  Eigen::Index FrameSizes::*size;
  MatrixX3f TakeFrame::*values;
};
constexpr std::array<Points, 3> point_arrays = {{{"skin", &FrameSizes::skin, &TakeFrame::skin},
                                                 {"volume", &FrameSizes::volume, &TakeFrame::volume},
                                                 {"velocity", &FrameSizes::velocity, &TakeFrame::velocity}}};

}  // namespace

FrameSizes sizes_of(const TakeFrame& frame) {
  return {frame.skin.rows(), frame.part_weights.size(), frame.volume.rows(), frame.velocity.rows()};
}

bool operator==(const FrameSizes& a, const FrameSizes& b) {
  return a.skin == b.skin && a.weights == b.weights && a.volume == b.volume && a.velocity == b.velocity;
}

std::string defect_of(const TakeFrame& frame) {
  if (!std::isfinite(frame.time)) return "the time is not finite";
  for (const Points& points : point_arrays) {
    if (!(frame.*points.values).allFinite()) return fmt::format("a value of '{}' is not finite", points.name);
  }
  if (!is_near(frame.skin) || !is_near(frame.volume)) {
    return fmt::format("a point is more than {} m away from the head", farthest);
  }
  if (!frame.jaw.allFinite() || !frame.part_weights.allFinite()) return "the jaw pose or a weight is not finite";
  if (!is_rotation(frame.head.linear()) || !frame.head.translation().allFinite()) return "the head pose is not rigid";
  if (!is_rotation(frame.left_eye) || !is_rotation(frame.right_eye)) return "the pose of an eye is not a rotation";
  return {};
}

void create_frames(const Hdf5Group& group, const FrameSizes& sizes) {
  group.create_frames(row_name, Scalar::float64, {row_length});
  const auto weights = static_cast<std::uint64_t>(sizes.weights);
  if (weights > 0) group.create_frames("weights", Scalar::float64, {weights});
  for (const Points& points : point_arrays) {
    const auto size = static_cast<std::uint64_t>(sizes.*points.size);
    if (size > 0) group.create_frames(points.name, Scalar::float32, {size, 3});
  }
}

FrameSizes stored_sizes(const Hdf5Group& group, int frames) {
  const auto count = static_cast<std::uint64_t>(frames);
  FrameSizes sizes;
  if (group.frame_shape(row_name, count, 1)[0] != row_length) {
    reject(group.where(row_name), fmt::format("expected {} numbers a frame", row_length));
  }
  if (group.has_array("weights")) {
    sizes.weights = static_cast<Eigen::Index>(group.frame_shape("weights", count, 1)[0]);
  }
  for (const Points& points : point_arrays) {
    if (!group.has_array(points.name)) continue;
    const Dimensions shape = group.frame_shape(points.name, count, 2);
    if (shape[1] != 3) reject(group.where(points.name), "expected 3 coordinates");
    sizes.*points.size = static_cast<Eigen::Index>(shape[0]);
  }
  return sizes;
}

void store_frame(const Hdf5Group& group, int index, const TakeFrame& frame) {
  const auto at = static_cast<std::uint64_t>(index);
  group.append_frame(row_name, Scalar::float64, at, row_of(frame).data());
  if (frame.part_weights.size() > 0) {
    group.append_frame("weights", Scalar::float64, at, frame.part_weights.data());
  }
  for (const Points& points : point_arrays) {
    const MatrixX3f& values = frame.*points.values;
    if (values.rows() > 0) group.append_frame(points.name, Scalar::float32, at, values.data());
  }
}

TakeFrame stored_frame(const Hdf5Group& group, int index, const FrameSizes& sizes) {
  const auto at = static_cast<std::uint64_t>(index);
  FrameRow row;
  group.read_frame(row_name, Scalar::float64, at, row.data());
  TakeFrame frame = frame_of(row);
  frame.part_weights.resize(sizes.weights);
  if (sizes.weights > 0) group.read_frame("weights", Scalar::float64, at, frame.part_weights.data());
  for (const Points& points : point_arrays) {
    MatrixX3f& values = frame.*points.values;
    values.resize(sizes.*points.size, 3);
    if (values.rows() > 0) group.read_frame(points.name, Scalar::float32, at, values.data());
  }
  const std::string defect = defect_of(frame);
  if (!defect.empty()) reject(group.where(fmt::format("frame {}", index)), defect);
  return frame;
}

}  // namespace phiz
