// SPDX-License-Identifier: GPL-3.0-or-later
/// Which Phiz this is; written into files and reports.
#pragma once

#include <string_view>

namespace phiz {

/// Version of the release, e.g. "0.1.0".
std::string_view version();
/// Short name of the commit it was built from, "+" appended when sources were changed after it; empty outside a
/// checkout.
std::string_view commit();

}  // namespace phiz
