// SPDX-License-Identifier: GPL-3.0-or-later
/// Point caches: positions of the same vertices over time, as modellers play them back. PC2 (3ds Max, Blender) and
/// MDD (LightWave, Blender).
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

namespace phiz {

struct PointCache {
  std::vector<Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>> frames;  ///< n x 3 each
  double frame_rate = 30;                                                        ///< frames per second
};

/// Read PC2 (little-endian) or MDD (big-endian). PC2 knows frames, not seconds: its frame rate comes out as 30 unless
/// given. Throw phiz::Error(bad_input) when the file is not as long as its header says or a value is not finite.
PointCache read_pc2(const std::string& path, double frame_rate = 30);
PointCache parse_pc2(std::string_view bytes, const std::string& where, double frame_rate = 30);
PointCache read_mdd(const std::string& path);
PointCache parse_mdd(std::string_view bytes, const std::string& where);

/// Write. Throw phiz::Error(failure) when frames differ in their number of vertices or there are none.
void write_pc2(const std::string& path, const PointCache& cache);
void write_mdd(const std::string& path, const PointCache& cache);

}  // namespace phiz
