// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/face/blend.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "phiz/core/error.h"
#include "phiz/core/parallel.h"
#include "phiz/face/blend_kernel.h"
#include "phiz/face/flesh.h"

namespace phiz {

namespace {

constexpr std::ptrdiff_t entry_size = blend_values * blend_width;
static_assert(blend_width == ElementBlocks<float>::width);
constexpr float largest_entry = 32767;

Matrix3d symmetric(const Eigen::Matrix<double, 1, 6>& s) {
  Matrix3d S;
  S << s[0], s[3], s[4], s[3], s[1], s[5], s[4], s[5], s[2];
  return S;
}

/// What is blended of every tet of a shape.
Eigen::Array<float, Eigen::Dynamic, blend_values> blended_values(const VolumetricShape& shape) {
  Eigen::Array<float, Eigen::Dynamic, blend_values> values(shape.tets.size(), blend_values);
  for (Eigen::Index i = 0; i < shape.tets.size(); ++i) {
    const double det = (Matrix3d::Identity() + symmetric(shape.stretch.row(i).cast<double>())).determinant();
    values.row(i) << shape.log_rotation.row(i).array(), shape.stretch.row(i).array(),
        static_cast<float>(excused_volume(det) / 3);
  }
  return values;
}

}  // namespace

double excused_volume(double det) {
  constexpr double kept = 0.15;
  const double log = std::log(std::max(det, 0.1));
  return std::copysign(std::max(0.0, std::abs(log) - kept), log);
}

JawPose blend_jaw(const FaceModel& model, const VectorXd& weights) {
  JawPose pose = JawPose::Zero();
  for (std::size_t m = 0; m < model.shapes.size(); ++m)
    pose += weights[static_cast<Eigen::Index>(m)] * model.shapes[m].jaw;
  return clamp_to_limits(model.head.jaw, pose);
}

Matrix3d rotation_exponential(const Vector3d& v) {
  const double angle = v.norm();
  if (angle < 1e-300) return Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, v / angle).toRotationMatrix();
}

Matrix3d polar_blend(const MatrixX3d& log_rotations, const Eigen::Matrix<double, Eigen::Dynamic, 6>& stretches,
                     const VectorXd& weights) {
  const Vector3d log = log_rotations.transpose() * weights;
  return rotation_exponential(log) * (Matrix3d::Identity() + symmetric((weights.transpose() * stretches).eval()));
}

Matrix3d linear_blend(const MatrixX3d& log_rotations, const Eigen::Matrix<double, Eigen::Dynamic, 6>& stretches,
                      const VectorXd& weights) {
  Matrix3d out = Matrix3d::Identity();
  for (Eigen::Index m = 0; m < weights.size(); ++m)
    out += weights[m] *
           (rotation_exponential(log_rotations.row(m)) * (Matrix3d::Identity() + symmetric(stretches.row(m))) -
            Matrix3d::Identity());
  return out;
}

struct TargetBlender::Table {
  Eigen::Index shapes = 0;
  std::ptrdiff_t blocks = 0;
  std::vector<std::ptrdiff_t> start;  ///< first entry of each block
  std::vector<int> shape;             ///< per entry
  /// blend_values x blend_width per entry: in 16 bits, since the blend waits for memory; a strain is good to 1e-4.
  hwy::AlignedFreeUniquePtr<std::int16_t[]> values;
  Eigen::Array<float, blend_values, Eigen::Dynamic> unit;  ///< of one step of the values, per shape
};

TargetBlender::~TargetBlender() = default;
TargetBlender::TargetBlender(TargetBlender&&) noexcept = default;
TargetBlender& TargetBlender::operator=(TargetBlender&&) noexcept = default;

TargetBlender::TargetBlender(const FaceModel& model, const VectorXi& soft, const std::vector<std::ptrdiff_t>& slot)
    : table_(std::make_unique<Table>()) {
  Table& table = *table_;
  table.shapes = static_cast<Eigen::Index>(model.shapes.size());
  table.blocks = (soft.size() + blend_width - 1) / blend_width;
  std::vector<std::ptrdiff_t> slot_of(static_cast<std::size_t>(model.head.volume.T.rows()), -1);
  for (Eigen::Index t = 0; t < soft.size(); ++t)
    slot_of[static_cast<std::size_t>(soft[t])] = slot[static_cast<std::size_t>(t)];

  std::vector<std::vector<char>> touched(model.shapes.size(),
                                         std::vector<char>(static_cast<std::size_t>(table.blocks), 0));
  table.start.assign(static_cast<std::size_t>(table.blocks) + 1, 0);
  for (std::size_t m = 0; m < model.shapes.size(); ++m) {
    const VolumetricShape& shape = model.shapes[m];
    if (shape.log_rotation.rows() != shape.tets.size() || shape.stretch.rows() != shape.tets.size())
      reject("volumetric shape " + shape.name, "needs one rotation and one stretch per tet");
    for (const int t : shape.tets) {
      if (t < 0 || t >= model.head.volume.T.rows())
        reject("volumetric shape " + shape.name, "names a tet that does not exist");
      const std::ptrdiff_t s = slot_of[static_cast<std::size_t>(t)];
      if (s >= 0) touched[m][static_cast<std::size_t>(s / blend_width)] = 1;
    }
    for (std::size_t b = 0; b < touched[m].size(); ++b) table.start[b + 1] += touched[m][b];
  }
  for (std::size_t b = 0; b < static_cast<std::size_t>(table.blocks); ++b) table.start[b + 1] += table.start[b];
  const std::ptrdiff_t entries = table.start.back();
  table.shape.resize(static_cast<std::size_t>(entries));
  table.values =
      hwy::AllocateAligned<std::int16_t>(static_cast<std::size_t>(std::max<std::ptrdiff_t>(entries, 1) * entry_size));
  std::fill_n(table.values.get(), entries * entry_size, std::int16_t{0});
  table.unit.setZero(blend_values, table.shapes);
  std::vector<std::ptrdiff_t> next(table.start.begin(), table.start.end() - 1);
  for (std::size_t m = 0; m < model.shapes.size(); ++m) {
    const VolumetricShape& shape = model.shapes[m];
    const Eigen::Array<float, Eigen::Dynamic, blend_values> all = blended_values(shape);
    auto unit = table.unit.col(static_cast<Eigen::Index>(m));
    if (all.rows() > 0) unit = all.abs().colwise().maxCoeff().transpose() / largest_entry;
    for (Eigen::Index i = 0; i < shape.tets.size(); ++i) {
      const std::ptrdiff_t s = slot_of[static_cast<std::size_t>(shape.tets[i])];
      if (s < 0) continue;
      const std::ptrdiff_t entry = next[static_cast<std::size_t>(s / blend_width)];
      table.shape[static_cast<std::size_t>(entry)] = static_cast<int>(m);
      std::int16_t* values = table.values.get() + entry * entry_size + s % blend_width;
      for (Eigen::Index k = 0; k < blend_values; ++k)
        if (unit[k] > 0) values[k * blend_width] = static_cast<std::int16_t>(std::lround(all(i, k) / unit[k]));
    }
    for (std::size_t b = 0; b < touched[m].size(); ++b) next[b] += touched[m][b];
  }
}

void TargetBlender::blend(const VectorXd& weights, ElementBlocks<float>& elements) const {
  const Table& table = *table_;
  if (weights.size() != table.shapes || !weights.allFinite())
    reject("blend", "needs one finite weight per volumetric shape");
  Eigen::Array<float, blend_values, Eigen::Dynamic> scaled = table.unit;
  for (Eigen::Index m = 0; m < weights.size(); ++m)
    scaled.col(m) *= std::abs(weights[m]) < least_blend_weight ? 0.0F : static_cast<float>(weights[m]);
  parallel_for(
      table.blocks,
      [&](std::ptrdiff_t b) {
        const std::ptrdiff_t first = table.start[static_cast<std::size_t>(b)];
        const std::ptrdiff_t slot = b * blend_width;
        blend_block(table.values.get() + first * entry_size, table.shape.data() + first,
                    table.start[static_cast<std::size_t>(b) + 1] - first, scaled.data(),
                    elements.target.get() + 9 * slot, elements.stretch.get() + 6 * slot, elements.goal.get() + slot);
      },
      32);
}

}  // namespace phiz
