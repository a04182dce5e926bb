// SPDX-License-Identifier: GPL-3.0-or-later
/// The built-in head: a HeadTemplate made by code from parameters (Ichim et al. 2017, section 5.1; Kadlecek et al.'s
/// template, section 3), with nothing to download.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "phiz/anatomy/builtin/skin/identity.h"
#include "phiz/anatomy/head_template.h"
#include "phiz/anatomy/head_volume.h"

namespace phiz {

inline constexpr int builtin_head_steps = 6;  ///< how often `report` is called

struct BuiltinOptions {
  HeadSize size = HeadSize::standard;
  std::optional<std::uint64_t> person;             ///< seed of a random person; the mean person without
  std::optional<IdentityParameters> identity;      ///< this person; wins over `person`
  bool expressions = true;                         ///< make the 52 expressions, the longest part of the work
  std::function<void(const std::string&)> report;  ///< told what is being done, when set
};

/// Builds the head. The simulation skin is a level of the skin's limit surface whose vertices come first in
/// HeadTemplate::volume and in HeadTemplate::skin; then follow the vertices of the skull's and of the mandible's
/// surface, then inner ones. Deterministic. Throws phiz::Error when a person cannot be built.
HeadTemplate build_builtin_head(const BuiltinOptions& options = {});

}  // namespace phiz
