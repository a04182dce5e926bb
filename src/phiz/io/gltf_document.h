// SPDX-License-Identifier: GPL-3.0-or-later
/// A glTF document with its buffers: checked access to JSON members and accessors. Private to the reader.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace phiz {

class GltfDocument {
 public:
  /// Splits a GLB, parses the JSON and fetches the buffers. Throws phiz::Error(bad_input).
  GltfDocument(std::string_view bytes, std::string where, const std::string& folder);

  /// The list of that name at the top of the document; empty when there is none.
  const nlohmann::json& list(const char* name) const;

  /// File and item for messages: "a.glb: meshes[2]".
  std::string where(const std::string& item) const { return where_ + ": " + item; }

  const nlohmann::json& root() const { return document_; }

  /// Members of objects. `item` names the object in messages.
  std::optional<long long> integer(const nlohmann::json& object, const char* name, const std::string& item) const;
  std::optional<double> number(const nlohmann::json& object, const char* name, const std::string& item) const;
  std::string text(const nlohmann::json& object, const char* name) const;  ///< empty when absent
  /// A list of `count` finite numbers; empty when absent.
  std::vector<double> numbers(const nlohmann::json& object, const char* name, std::size_t count,
                              const std::string& item) const;
  /// A row of the list `name` at the top of the document; nothing when absent.
  std::optional<int> row(const nlohmann::json& object, const char* member, const char* list_name,
                         const std::string& item) const;

  /// Elements of an accessor as floats, one row each. `columns`: 1 to 4 required, 0 any. Throws when any byte lies
  /// outside of its buffer or a value is not finite.
  using Values = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Values values(int accessor, int columns) const;
  /// Elements of a scalar accessor of unsigned integers.
  std::vector<std::uint32_t> indices(int accessor) const;

 private:
  struct Span;
  Span span(int accessor, const std::string& item) const;
  void split(std::string_view bytes);
  void fetch_buffers(const std::string& folder);
  void spend(std::uint64_t values, const std::string& item) const;

  std::string where_;
  nlohmann::json document_;
  std::string_view binary_;
  std::vector<std::string> buffers_;
  mutable std::uint64_t budget_ = 0;  ///< values that may still be read: a small file must not expand without end
};

}  // namespace phiz
