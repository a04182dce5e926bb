// SPDX-License-Identifier: GPL-3.0-or-later
/// Groups, arrays and attributes of an HDF5 file: private to the .phiz reader and writer. Every function throws
/// phiz::Error: bad_input with the file and the item when reading, failure when writing.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "phiz/geometry/mesh.h"

namespace phiz {

/// Owner of an HDF5 identifier (file, group, dataset, ...).
class Hdf5Handle {
 public:
  using Closer = int (*)(std::int64_t);
  Hdf5Handle() = default;
  Hdf5Handle(std::int64_t id, Closer closer) : id_(id), closer_(closer) {}
  Hdf5Handle(Hdf5Handle&& other) noexcept : id_(other.id_), closer_(other.closer_) { other.id_ = -1; }
  Hdf5Handle& operator=(Hdf5Handle&& other) noexcept;
  ~Hdf5Handle() { close(); }
  bool valid() const { return id_ >= 0; }
  std::int64_t get() const { return id_; }
  /// False when HDF5 could not write what it still held.
  bool close();

 private:
  std::int64_t id_ = -1;
  Closer closer_ = nullptr;
};

enum class Scalar { float32, float64, int32 };
template <class Number>
constexpr Scalar scalar_of();
template <>
constexpr Scalar scalar_of<float>() {
  return Scalar::float32;
}
template <>
constexpr Scalar scalar_of<double>() {
  return Scalar::float64;
}
template <>
constexpr Scalar scalar_of<int>() {
  return Scalar::int32;
}

using Dimensions = std::vector<std::uint64_t>;

/// The file that a group belongs to, for messages and for the check of claimed sizes.
struct Hdf5Origin {
  std::string path;
  std::uint64_t bytes = 0;  ///< length of the file
};

class Hdf5Group {
 public:
  Hdf5Group() = default;
  Hdf5Group(Hdf5Handle handle, std::shared_ptr<const Hdf5Origin> origin, std::string name);

  /// File and item for messages, e.g. "head.phiz: muscles/3".
  std::string where(const std::string& item = {}) const;

  bool has_group(const std::string& name) const;
  bool has_array(const std::string& name) const;
  Hdf5Group group(const std::string& name) const;
  Hdf5Group create_group(const std::string& name) const;

  /// Attributes.
  void set(const std::string& name, double value) const;
  void set(const std::string& name, int value) const;
  void set(const std::string& name, const std::string& value) const;
  double number(const std::string& name) const;  ///< finite
  int integer(const std::string& name) const;
  std::string text(const std::string& name) const;

  /// Lists of strings.
  void write_strings(const std::string& name, const std::vector<std::string>& values) const;
  std::vector<std::string> read_strings(const std::string& name) const;

  /// Dense arrays, stored row by row; vectors (one column at compile time) with one dimension.
  template <class Derived>
  void write(const std::string& name, const Eigen::MatrixBase<Derived>& m) const {
    using Number = typename Derived::Scalar;
    const Eigen::Matrix<Number, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows = m;
    Dimensions dimensions = {static_cast<std::uint64_t>(m.rows())};
    if (Derived::ColsAtCompileTime != 1) dimensions.push_back(static_cast<std::uint64_t>(m.cols()));
    write_array(name, scalar_of<Number>(), dimensions, rows.data());
  }
  /// Sizes that the type fixes are required; the other ones come from the file.
  template <class Result>
  Result read(const std::string& name) const {
    using Number = typename Result::Scalar;
    constexpr int rows_fixed = Result::RowsAtCompileTime, cols_fixed = Result::ColsAtCompileTime;
    const Dimensions d = dimensions(name, cols_fixed == 1 ? 1 : 2);
    const std::uint64_t cols = cols_fixed == 1 ? 1 : d[1];
    if (cols_fixed != Eigen::Dynamic) require_size(name, cols, cols_fixed);
    if (rows_fixed != Eigen::Dynamic) require_size(name, d[0], rows_fixed);
    Eigen::Matrix<Number, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> values(static_cast<Eigen::Index>(d[0]),
                                                                                  static_cast<Eigen::Index>(cols));
    read_array(name, scalar_of<Number>(), values.data());
    return Result(values);
  }

  /// Arrays that grow by one entry of the given shape per frame; compressed.
  void create_frames(const std::string& name, Scalar scalar, const Dimensions& shape) const;
  void append_frame(const std::string& name, Scalar scalar, std::uint64_t frame, const void* values) const;
  /// Shape of one frame; throws unless there are at least `frames` of them and the shape has `rank` dimensions.
  Dimensions frame_shape(const std::string& name, std::uint64_t frames, std::size_t rank) const;
  void read_frame(const std::string& name, Scalar scalar, std::uint64_t frame, void* values) const;

 private:
  Dimensions dimensions(const std::string& name, std::size_t rank) const;
  void require_size(const std::string& name, std::uint64_t found, std::uint64_t expected) const;
  void write_array(const std::string& name, Scalar scalar, const Dimensions& dimensions, const void* values) const;
  void read_array(const std::string& name, Scalar scalar, void* values) const;
  Hdf5Handle open_array(const std::string& name) const;

  Hdf5Handle handle_;
  std::shared_ptr<const Hdf5Origin> origin_;
  std::string name_;
};

}  // namespace phiz
