// SPDX-License-Identifier: GPL-3.0-or-later
/// The .phiz container: one file format for every noun. Layout and versions: docs/format.md. Takes: take_file.h.
///
/// Saving writes under a temporary name and renames. Loading checks the checksum, every size, every index and every
/// number and throws phiz::Error(bad_input) naming the file and the item; files of all earlier versions load.
#pragma once

#include <string>

#include "phiz/anatomy/head_template.h"
#include "phiz/face/face_model.h"
#include "phiz/face/performance.h"

namespace phiz {

/// What a .phiz file holds.
enum class ContainerKind { head_template, face_model, performance, take };

/// The version that this program writes; it reads all versions from 1 to this.
inline constexpr int container_version = 3;

/// Looks at the beginning of the file and its root only. Throws phiz::Error(bad_input) when it is no .phiz file.
ContainerKind kind_of(const std::string& path);
/// "head", "model", "performance" or "take".
std::string name_of(ContainerKind kind);

void save(const std::string& path, const HeadTemplate& head);
void save(const std::string& path, const FaceModel& model);
void save(const std::string& path, const Performance& performance);

HeadTemplate load_head_template(const std::string& path);
FaceModel load_face_model(const std::string& path);
Performance load_performance(const std::string& path);

}  // namespace phiz
