// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/io/gltf_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "phiz/core/error.h"
#include "phiz/io/base64.h"
#include "phiz/io/byte_order.h"
#include "phiz/io/file_bytes.h"
#include "phiz/io/gltf_format.h"
#include "phiz/io/text_scanner.h"

namespace phiz {

using nlohmann::json;

namespace {

constexpr std::size_t most_items = 1u << 20;  // in a list at the top of the document
constexpr std::size_t deepest_nesting = 64;   // of the JSON text

/// Refuses JSON that is nested deeper than any glTF is.
bool is_nested_deeply(std::string_view text) {
  std::size_t depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '{' || c == '[') {
      if (++depth > deepest_nesting) return true;
    } else if ((c == '}' || c == ']') && depth > 0) {
      --depth;
    }
  }
  return false;
}

std::size_t size_of_component(long long type) {
  switch (type) {
    case gltf::int8:
    case gltf::uint8:
      return 1;
    case gltf::int16:
    case gltf::uint16:
      return 2;
    case gltf::uint32:
    case gltf::float32:
      return 4;
    default:
      return 0;
  }
}

int columns_of(const std::string& type) {
  if (type == "SCALAR") return 1;
  if (type == "VEC2") return 2;
  if (type == "VEC3") return 3;
  if (type == "VEC4") return 4;
  return 0;
}

/// One component as float; normalised integers map to [0, 1] or [-1, 1].
float component(std::string_view bytes, std::size_t at, int type, bool normalised) {
  const auto scaled = [normalised](auto value) {
    if (!normalised) return static_cast<float>(value);
    constexpr auto most = static_cast<float>(std::numeric_limits<decltype(value)>::max());
    return std::max(static_cast<float>(value) / most, -1.0f);
  };
  switch (type) {
    case gltf::int8:
      return scaled(load_number<std::int8_t>(bytes, at));
    case gltf::uint8:
      return scaled(load_number<std::uint8_t>(bytes, at));
    case gltf::int16:
      return scaled(load_number<std::int16_t>(bytes, at));
    case gltf::uint16:
      return scaled(load_number<std::uint16_t>(bytes, at));
    case gltf::uint32:
      return scaled(load_number<std::uint32_t>(bytes, at));
    default:
      return load_number<float>(bytes, at);
  }
}

}  // namespace

/// Where the elements of an accessor lie.
struct GltfDocument::Span {
  std::string_view bytes;  ///< from the first element on; empty when the accessor is all zeros
  std::size_t count = 0;
  std::size_t stride = 0;
  int columns = 0;
  int component_type = 0;
  bool normalised = false;
};

GltfDocument::GltfDocument(std::string_view bytes, std::string where, const std::string& folder)
    : where_(std::move(where)) {
  split(bytes);
  const json* asset = document_.contains("asset") ? &document_["asset"] : nullptr;
  if (asset == nullptr || !asset->is_object() || !text(*asset, "version").starts_with("2.")) {
    reject(where_, "not glTF version 2: asset.version is missing or another one");
  }
  for (const json& extension : list("extensionsRequired")) {
    const std::string name = extension.is_string() ? extension.get<std::string>() : "";
    reject(where_, "the file requires the extension " + quoted_word(name),
           "export it without extensions or compression");
  }
  fetch_buffers(folder);
}

void GltfDocument::split(std::string_view bytes) {
  std::string_view text = bytes;
  if (bytes.starts_with("glTF")) {
    if (bytes.size() < 20) reject(where_, "the GLB header is cut off");
    const auto version = load_number<std::uint32_t>(bytes, 4);
    const auto length = load_number<std::uint32_t>(bytes, 8);
    if (version != 2) reject(where_, fmt::format("GLB version {}, expected 2", version));
    if (length != bytes.size()) {
      reject(where_, fmt::format("the GLB header says {} bytes, the file has {}", length, bytes.size()),
             "it is cut off");
    }
    bytes.remove_prefix(12);
    for (int chunk = 0; bytes.size() >= 8; ++chunk) {
      const auto size = load_number<std::uint32_t>(bytes, 0);
      const auto type = load_number<std::uint32_t>(bytes, 4);
      if (size > bytes.size() - 8) reject(where_, fmt::format("chunk {} is longer than the file", chunk));
      if (chunk == 0 && type != gltf::json_chunk) reject(where_, "the first chunk is not JSON");
      if (chunk == 0) text = bytes.substr(8, size);
      if (chunk == 1 && type == gltf::binary_chunk) binary_ = bytes.substr(8, size);
      bytes.remove_prefix(8 + size);
    }
  }
  if (is_nested_deeply(text)) reject(where_, "the JSON is nested too deeply");
  document_ = json::parse(text.begin(), text.end(), nullptr, false);
  if (document_.is_discarded() || !document_.is_object()) reject(where_, "neither GLB nor a JSON object");
}

void GltfDocument::fetch_buffers(const std::string& folder) {
  const json& list_of_buffers = list("buffers");
  for (std::size_t i = 0; i < list_of_buffers.size(); ++i) {
    const std::string item = fmt::format("buffers[{}]", i);
    const json& buffer = list_of_buffers[i];
    const auto length = integer(buffer, "byteLength", item);
    if (!length || *length < 1) reject(where(item), "byteLength is missing or below 1");
    const std::string uri = text(buffer, "uri");
    std::string content;
    if (uri.empty()) {
      if (i != 0 || binary_.empty()) reject(where(item), "has no uri and there is no binary chunk");
      content = binary_;
    } else if (uri.starts_with("data:")) {
      const std::size_t comma = uri.find(";base64,");
      const auto decoded = comma == std::string::npos ? std::optional<std::string>{}
                                                      : from_base64(std::string_view(uri).substr(comma + 8));
      if (!decoded) reject(where(item), "its data uri is not base64");
      content = *decoded;
    } else {
      const std::filesystem::path path(uri);
      const bool inside = !folder.empty() && path.is_relative() &&
                          std::find(path.begin(), path.end(), std::filesystem::path("..")) == path.end();
      if (!inside) reject(where(item), "refers to " + quoted_word(uri) + ", which is not a file beside it");
      try {
        content = read_bytes((std::filesystem::path(folder) / path).string());
      } catch (const Error& error) {
        reject(where(item), error.what());
      }
    }
    if (content.size() < static_cast<std::size_t>(*length)) {
      reject(where(item), fmt::format("{} bytes, byteLength claims {}", content.size(), *length), "it is cut off");
    }
    content.resize(static_cast<std::size_t>(*length));
    budget_ += 16 * content.size();
    buffers_.push_back(std::move(content));
  }
}

void GltfDocument::spend(std::uint64_t values, const std::string& item) const {
  if (values > budget_)
    reject(where(item), "the file reads its buffers again and again", "it is not a usual glTF file");
  budget_ -= values;
}

const json& GltfDocument::list(const char* name) const {
  static const json none = json::array();
  const auto place = document_.find(name);
  if (place == document_.end()) return none;
  if (!place->is_array() || place->size() > most_items) reject(where_, fmt::format("'{}' is not a list", name));
  return *place;
}

std::optional<long long> GltfDocument::integer(const json& object, const char* name, const std::string& item) const {
  if (!object.is_object()) reject(where(item), "is not an object");
  const auto place = object.find(name);
  if (place == object.end()) return std::nullopt;
  if (!place->is_number()) reject(where(item), fmt::format("'{}' is not a number", name));
  const auto value = place->get<double>();
  constexpr double most = 1e15;
  if (!(std::abs(value) < most) || value != std::floor(value)) {
    reject(where(item), fmt::format("'{}' is not a whole number", name));
  }
  return static_cast<long long>(value);
}

std::optional<double> GltfDocument::number(const json& object, const char* name, const std::string& item) const {
  if (!object.is_object()) reject(where(item), "is not an object");
  const auto place = object.find(name);
  if (place == object.end()) return std::nullopt;
  if (!place->is_number() || !std::isfinite(place->get<double>())) {
    reject(where(item), fmt::format("'{}' is not a finite number", name));
  }
  return place->get<double>();
}

std::string GltfDocument::text(const json& object, const char* name) const {
  if (!object.is_object()) return {};
  const auto place = object.find(name);
  return place != object.end() && place->is_string() ? place->get<std::string>() : std::string();
}

std::vector<double> GltfDocument::numbers(const json& object, const char* name, std::size_t count,
                                          const std::string& item) const {
  if (!object.is_object()) reject(where(item), "is not an object");
  const auto place = object.find(name);
  if (place == object.end()) return {};
  std::vector<double> result;
  if (place->is_array() && place->size() == count) {
    for (const json& value : *place) {
      if (value.is_number() && std::isfinite(value.get<double>())) result.push_back(value.get<double>());
    }
  }
  if (result.size() != count) reject(where(item), fmt::format("'{}' is not a list of {} finite numbers", name, count));
  return result;
}

std::optional<int> GltfDocument::row(const json& object, const char* member, const char* list_name,
                                     const std::string& item) const {
  const auto value = integer(object, member, item);
  if (!value) return std::nullopt;
  const auto size = static_cast<long long>(list(list_name).size());
  if (*value < 0 || *value >= size) {
    reject(where(item), fmt::format("'{}' is {}, but there are {} {}", member, *value, size, list_name));
  }
  return static_cast<int>(*value);
}

GltfDocument::Span GltfDocument::span(int accessor, const std::string& item) const {
  const json& a = list("accessors")[static_cast<std::size_t>(accessor)];
  const auto count = integer(a, "count", item);
  const auto component_type = integer(a, "componentType", item);
  const std::size_t size = size_of_component(component_type.value_or(0));
  Span s;
  s.columns = columns_of(text(a, "type"));
  if (!count || *count < 1 || size == 0 || s.columns == 0) {
    reject(where(item), "count, componentType or type is missing or unknown");
  }
  if (a.contains("sparse")) reject(where(item), "is sparse, which is not supported", "export without sparse accessors");
  s.count = static_cast<std::size_t>(*count);
  s.component_type = static_cast<int>(*component_type);
  s.normalised = a.contains("normalized") && a["normalized"].is_boolean() && a["normalized"].get<bool>();
  const std::size_t element = size * static_cast<std::size_t>(s.columns);
  const auto view_row = row(a, "bufferView", "bufferViews", item);
  if (!view_row) reject(where(item), "has no bufferView");
  const std::string view_item = fmt::format("bufferViews[{}]", *view_row);
  const json& view = list("bufferViews")[static_cast<std::size_t>(*view_row)];
  const auto buffer = row(view, "buffer", "buffers", view_item);
  const auto view_offset = integer(view, "byteOffset", view_item).value_or(0);
  const auto view_length = integer(view, "byteLength", view_item);
  const auto stride = integer(view, "byteStride", view_item).value_or(static_cast<long long>(element));
  const auto offset = integer(a, "byteOffset", item).value_or(0);
  if (!buffer || !view_length || *view_length < 1 || view_offset < 0) {
    reject(where(view_item), "buffer, byteOffset or byteLength is missing or wrong");
  }
  const auto buffer_length = static_cast<long long>(buffers_[static_cast<std::size_t>(*buffer)].size());
  if (view_offset > buffer_length || *view_length > buffer_length - view_offset) {
    reject(where(view_item), fmt::format("reaches beyond its buffer of {} bytes", buffer_length));
  }
  if (stride < static_cast<long long>(element) || stride > 255 + static_cast<long long>(element) || offset < 0) {
    reject(where(item), "byteStride or byteOffset is wrong");
  }
  s.stride = static_cast<std::size_t>(stride);
  const long long room = *view_length - offset - static_cast<long long>(element);
  if (room < 0 || *count - 1 > room / stride) {
    reject(where(item), fmt::format("{} elements do not fit into a view of {} bytes", *count, *view_length));
  }
  s.bytes =
      std::string_view(buffers_[static_cast<std::size_t>(*buffer)])
          .substr(static_cast<std::size_t>(view_offset + offset), static_cast<std::size_t>(*view_length - offset));
  return s;
}

GltfDocument::Values GltfDocument::values(int accessor, int columns) const {
  const std::string item = fmt::format("accessors[{}]", accessor);
  const Span s = span(accessor, item);
  if (columns != 0 && s.columns != columns) {
    reject(where(item), fmt::format("{} components, expected {}", s.columns, columns));
  }
  const std::size_t size = size_of_component(s.component_type);
  spend(s.count * static_cast<std::size_t>(s.columns), item);
  Values result(static_cast<Eigen::Index>(s.count), s.columns);
  for (std::size_t i = 0; i < s.count; ++i) {
    for (int k = 0; k < s.columns; ++k) {
      const std::size_t at = i * s.stride + static_cast<std::size_t>(k) * size;
      const float value = component(s.bytes, at, s.component_type, s.normalised);
      if (!std::isfinite(value)) reject(where(item), fmt::format("element {} is not finite", i));
      result(static_cast<Eigen::Index>(i), k) = value;
    }
  }
  return result;
}

std::vector<std::uint32_t> GltfDocument::indices(int accessor) const {
  const std::string item = fmt::format("accessors[{}]", accessor);
  const Span s = span(accessor, item);
  spend(s.count, item);
  std::vector<std::uint32_t> result(s.count);
  for (std::size_t i = 0; i < s.count; ++i) {
    const std::size_t at = i * s.stride;
    if (s.columns != 1) reject(where(item), "indices must be scalars");
    if (s.component_type == gltf::uint8) {
      result[i] = load_number<std::uint8_t>(s.bytes, at);
    } else if (s.component_type == gltf::uint16) {
      result[i] = load_number<std::uint16_t>(s.bytes, at);
    } else if (s.component_type == gltf::uint32) {
      result[i] = load_number<std::uint32_t>(s.bytes, at);
    } else {
      reject(where(item), "indices must be unsigned integers");
    }
  }
  return result;
}

}  // namespace phiz
