// SPDX-License-Identifier: GPL-3.0-or-later
/// What `phiz render` can show: a mesh, a head, or a take, behind one face.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "phiz/face/simulate.h"
#include "phiz/render/camera.h"
#include "phiz/render/head_view.h"

namespace phiz {

struct SubjectOptions {
  std::string file;
  std::string model;                     ///< the head of a take, or empty
  HeadViewOptions view;                  ///< style, plane, expressions
  std::string quantity;                  ///< of a heat map
  std::string values;                    ///< file with one number per vertex, for a heat map of anything
  double low = 0, high = 0;              ///< ends of the heat map's scale; equal: fitted
  std::optional<SimulateObject> object;  ///< that a take was simulated with: shown beside it
};

struct Subject {
  std::string name;
  int frames = 1;                        ///< 1 for what does not move
  double frame_rate = 0;                 ///< 0 for what does not move
  std::vector<std::string> expressions;  ///< of a head
  /// The scene of a frame. Close-ups keep the head still.
  std::function<Scene(int frame, bool close_up)> scene;
  std::function<Camera(View view, int width, int height)> camera;
  HeatScale scale;  ///< of heat maps
  bool has_legend = false;
  std::vector<LegendEntry> names;  ///< what the colours of a head's anatomy mean; may be empty
  MatrixX3d points;                ///< what whole views frame
  /// Shows these expressions from now on (heads only).
  std::function<void(const std::map<std::string, double>&)> express;
};

/// Opens the file: .phiz heads, models and takes, and meshes in any format. Throws phiz::Error.
Subject open_subject(const SubjectOptions& options);

}  // namespace phiz
