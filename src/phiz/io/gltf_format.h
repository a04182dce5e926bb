// SPDX-License-Identifier: GPL-3.0-or-later
/// Numbers that the glTF 2.0 specification fixes. Private to reader and writer.
#pragma once

#include <cstdint>

namespace phiz::gltf {

inline constexpr std::uint32_t glb_magic = 0x46546C67;     // "glTF"
inline constexpr std::uint32_t json_chunk = 0x4E4F534A;    // "JSON"
inline constexpr std::uint32_t binary_chunk = 0x004E4942;  // "BIN"

inline constexpr int int8 = 5120, uint8 = 5121, int16 = 5122, uint16 = 5123, uint32 = 5125, float32 = 5126;
inline constexpr int array_buffer = 34962, element_array_buffer = 34963;
inline constexpr int triangles = 4, triangle_strip = 5, triangle_fan = 6;
inline constexpr int linear = 9729, linear_mipmap_linear = 9987;

}  // namespace phiz::gltf
