// SPDX-License-Identifier: GPL-3.0-or-later
/// Base64, as glTF files carry their buffers in.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace phiz {

std::string to_base64(std::string_view bytes);
/// Nothing when the text is not base64.
std::optional<std::string> from_base64(std::string_view text);

}  // namespace phiz
