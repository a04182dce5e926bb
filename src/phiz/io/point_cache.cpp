// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/io/point_cache.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdint>

#include "phiz/core/error.h"
#include "phiz/io/byte_order.h"
#include "phiz/io/file_bytes.h"
#include "phiz/io/output_file.h"

namespace phiz {

namespace {

constexpr std::string_view pc2_magic("POINTCACHE2\0", 12);
constexpr std::size_t pc2_header = 32;
constexpr std::size_t mdd_header = 8;

void require_length(std::string_view bytes, std::size_t header, std::int64_t frames, std::int64_t points,
                    std::size_t bytes_per_frame, const std::string& where) {
  if (frames <= 0 || points <= 0) {
    reject(where, fmt::format("the header claims {} frames of {} points", frames, points));
  }
  // Both counts are below 2^31, so the product of the sizes fits into 128 bits and is compared by division.
  const auto each = static_cast<std::uint64_t>(points) * 12 + bytes_per_frame;
  const std::uint64_t room = bytes.size() - header;
  if (each > room || static_cast<std::uint64_t>(frames) > room / each ||
      static_cast<std::uint64_t>(frames) * each != room) {
    reject(where, fmt::format("the header claims {} frames of {} points, but {} bytes follow", frames, points, room),
           "the file is cut off or not a point cache");
  }
}

void read_frames(std::string_view bytes, std::size_t offset, std::int64_t frames, std::int64_t points,
                 std::endian order, const std::string& where, PointCache& cache) {
  for (std::int64_t f = 0; f < frames; ++f) {
    auto& frame = cache.frames.emplace_back(points, 3);
    for (std::int64_t i = 0; i < 3 * points; ++i, offset += 4) {
      const auto value = load_number<float>(bytes, offset, order);
      if (!std::isfinite(value)) reject(where, fmt::format("frame {}, point {}: a coordinate is not finite", f, i / 3));
      frame.data()[i] = value;
    }
  }
}

void write_cache(const std::string& path, const PointCache& cache, const std::string& header, std::endian order) {
  const auto points = cache.frames.empty() ? 0 : cache.frames[0].rows();
  if (points == 0) fail("cannot write " + path + ": there are no points");
  OutputFile file(path);
  file.write(header);
  std::string bytes;
  for (const auto& frame : cache.frames) {
    if (frame.rows() != points) fail("cannot write " + path + ": the frames differ in their number of points");
    bytes.clear();
    for (Eigen::Index i = 0; i < frame.size(); ++i) append_number(bytes, frame.data()[i], order);
    file.write(bytes);
  }
  file.commit();
}

}  // namespace

PointCache parse_pc2(std::string_view bytes, const std::string& where, double frame_rate) {
  if (!bytes.starts_with(pc2_magic)) reject(where, "not a PC2 file: it must begin with 'POINTCACHE2'");
  if (bytes.size() < pc2_header) reject(where, "the header is cut off");
  const auto version = load_number<std::int32_t>(bytes, 12);
  if (version != 1) reject(where, fmt::format("PC2 version {}, expected 1", version));
  const auto points = load_number<std::int32_t>(bytes, 16);
  const auto frames = load_number<std::int32_t>(bytes, 28);
  require_length(bytes, pc2_header, frames, points, 0, where);
  PointCache cache;
  cache.frame_rate = frame_rate;
  read_frames(bytes, pc2_header, frames, points, std::endian::little, where, cache);
  return cache;
}

PointCache parse_mdd(std::string_view bytes, const std::string& where) {
  if (bytes.size() < mdd_header) reject(where, "not an MDD file: it is too short");
  const auto frames = load_number<std::int32_t>(bytes, 0, std::endian::big);
  const auto points = load_number<std::int32_t>(bytes, 4, std::endian::big);
  require_length(bytes, mdd_header, frames, points, 4, where);
  PointCache cache;
  if (frames > 1) {
    const auto first = load_number<float>(bytes, mdd_header, std::endian::big);
    const auto last =
        load_number<float>(bytes, mdd_header + 4 * (static_cast<std::size_t>(frames) - 1), std::endian::big);
    const double duration = static_cast<double>(last) - first;
    if (!(duration > 0) || !std::isfinite(duration)) reject(where, "the times of the frames do not ascend");
    cache.frame_rate = (frames - 1) / duration;
  }
  const std::size_t positions = mdd_header + 4 * static_cast<std::size_t>(frames);
  read_frames(bytes, positions, frames, points, std::endian::big, where, cache);
  return cache;
}

PointCache read_pc2(const std::string& path, double frame_rate) {
  return parse_pc2(read_bytes(path), path, frame_rate);
}
PointCache read_mdd(const std::string& path) {
  return parse_mdd(read_bytes(path), path);
}

void write_pc2(const std::string& path, const PointCache& cache) {
  std::string header(pc2_magic);
  append_number(header, std::int32_t{1});
  append_number(header, static_cast<std::int32_t>(cache.frames.empty() ? 0 : cache.frames[0].rows()));
  append_number(header, 0.0f);  // first frame
  append_number(header, 1.0f);  // frames between samples
  append_number(header, static_cast<std::int32_t>(cache.frames.size()));
  write_cache(path, cache, header, std::endian::little);
}

void write_mdd(const std::string& path, const PointCache& cache) {
  std::string header;
  append_number(header, static_cast<std::int32_t>(cache.frames.size()), std::endian::big);
  append_number(header, static_cast<std::int32_t>(cache.frames.empty() ? 0 : cache.frames[0].rows()), std::endian::big);
  for (std::size_t f = 0; f < cache.frames.size(); ++f) {
    append_number(header, static_cast<float>(static_cast<double>(f) / cache.frame_rate), std::endian::big);
  }
  write_cache(path, cache, header, std::endian::big);
}

}  // namespace phiz
