// SPDX-License-Identifier: GPL-3.0-or-later
/// What verbs that simulate read: models and performances, from any file that holds one.
#pragma once

#include <string>

#include "phiz/face/face_model.h"
#include "phiz/face/performance.h"

namespace phiz {

/// Carries the expressions of a head into its flesh, with progress on the terminal.
FaceModel model_of(HeadTemplate head);

/// The model in a .phiz file, or that of the head in it.
FaceModel load_model(const std::string& path);

/// A performance in a .phiz file, or a recording as CSV, whose notes go to the terminal.
Performance load_any_performance(const std::string& path);

}  // namespace phiz
