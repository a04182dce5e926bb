// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/io/inspect_nouns.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "phiz/geometry/operators.h"
#include "phiz/io/container.h"
#include "phiz/io/take_file.h"

namespace phiz {

using nlohmann::json;

namespace {

constexpr double to_millimetres = 1e3;
constexpr double to_millilitres = 1e6;

json describe(const HeadTemplate& head) {
  const auto tets_of = [&head](int tissue) { return (head.volume.region.array() == tissue).count(); };
  json parts = json::array(), expressions = json::array(), muscles = json::array();
  for (const Part& part : head.parts) {
    parts.push_back({{"name", part.name}, {"vertices", part.mesh.V.rows()}, {"triangles", part.mesh.F.rows()}});
  }
  for (const Expression& e : head.expressions) expressions.push_back(e.name);
  const VectorXd volume = tet_volumes(head.volume.V, head.volume.T);
  for (const Muscle& m : head.muscles) {
    muscles.push_back({{"name", m.name},
                       {"ring", m.ring},
                       {"volume_ml", to_millilitres * m.fraction.dot(volume(m.tets))},
                       {"tets", m.tets.size()},
                       {"fibres", m.fibres.size()},
                       {"surface_triangles", m.surface.F.rows()}});
  }
  const auto held = [&head](Hold hold) { return (head.attachments.hold.array() == static_cast<int>(hold)).count(); };
  const Eigen::RowVector3d size = head.skin.V.colwise().maxCoeff() - head.skin.V.colwise().minCoeff();
  return {{"kind", "head"},
          {"name", head.name},
          {"provenance", head.provenance},
          {"tets", head.volume.T.rows()},
          {"soft_tets", soft_tets(head).size()},
          {"flesh_tets", tets_of(Tissue::flesh)},
          {"skull_tets", tets_of(Tissue::skull)},
          {"mandible_tets", tets_of(Tissue::mandible)},
          {"vertices", head.volume.V.rows()},
          {"skin_vertices", head.skin.V.rows()},
          {"skin_triangles", head.skin.F.rows()},
          {"size_mm", {to_millimetres * size[0], to_millimetres * size[1], to_millimetres * size[2]}},
          {"parts", parts},
          {"expressions", expressions},
          {"muscles", muscles},
          {"active_share", active_share(head)},
          {"attachments", {{"pins", held(Hold::pin)}, {"slides", held(Hold::slide)}}},
          {"identity_modes", head.identity.skin.cols()},
          {"landmarks", head.landmarks.size()},
          {"skull_landmarks", head.skull_landmarks.size()},
          {"contact_pairs", head.contact_pairs.size()}};
}

/// Value below which the share q of the sorted list lies.
double quantile(const std::vector<double>& sorted, double q) {
  const auto last = static_cast<double>(sorted.size() - 1);
  return sorted[static_cast<std::size_t>(std::lround(q * last))];
}

json describe_take(const std::string& path) {
  const TakeReader reader(path);
  const Take& head = reader.head();
  std::vector<double> times;
  double residual = 0, penetration = 0, volume_change = 0, moved = 0, last = 0, first = 0;
  int iterations = 0, contacts = 0, unconverged = 0;
  for (int i = 0; i < reader.frames(); ++i) {
    const TakeFrame frame = reader.frame(i);
    const SolveStatistics& s = frame.statistics;
    times.push_back(s.milliseconds);
    residual = std::max(residual, s.residual);
    penetration = std::max(penetration, s.penetration);
    volume_change = std::max(volume_change, std::abs(s.volume_change));
    iterations = std::max(iterations, s.iterations);
    contacts = std::max(contacts, s.contacts);
    unconverged += s.converged ? 0 : 1;
    moved = std::max(moved, (frame.skin.cast<double>() - head.skin.V).rowwise().norm().maxCoeff());
    first = i == 0 ? frame.time : first;
    last = frame.time;
  }
  json parts = json::array();
  for (const Part& part : head.parts) parts.push_back(part.name);
  json result = {{"kind", "take"},
                 {"model", head.model},
                 {"frames", reader.frames()},
                 {"frames_planned", head.frames_planned},
                 {"complete", reader.frames() >= head.frames_planned},
                 {"frame_rate", head.frame_rate},
                 {"duration_s", last - first},
                 {"skin_vertices", head.skin.V.rows()},
                 {"skin_triangles", head.skin.F.rows()},
                 {"motion_mm_max", to_millimetres * moved},
                 {"parts", parts}};
  if (!times.empty()) {
    std::sort(times.begin(), times.end());
    result["statistics"] = {{"frames_not_converged", unconverged},
                            {"iterations_max", iterations},
                            {"residual_max", residual},
                            {"contacts_max", contacts},
                            {"penetration_mm_max", to_millimetres * penetration},
                            {"volume_change_max", volume_change},
                            {"ms_median", quantile(times, 0.5)},
                            {"ms_p95", quantile(times, 0.95)},
                            {"ms_max", times.back()}};
  }
  return result;
}

}  // namespace

json describe(const Performance& p) {
  json used = json::object();
  for (std::size_t i = 0; i < p.expressions.size(); ++i) {
    const double largest = p.weights.col(static_cast<Eigen::Index>(i)).maxCoeff();
    if (largest > 0.01) used[p.expressions[i]] = std::round(1000 * largest) / 1000;
  }
  const double duration = p.time.size() > 0 ? p.time[p.time.size() - 1] - p.time[0] : 0;
  return {{"kind", "performance"},
          {"frames", p.time.size()},
          {"frame_rate", p.frame_rate},
          {"duration_s", duration},
          {"expressions", p.expressions.size()},
          {"largest_weights", used}};
}

json describe_container(const std::string& path) {
  switch (kind_of(path)) {
    case ContainerKind::head_template:
      return describe(load_head_template(path));
    case ContainerKind::performance:
      return describe(load_performance(path));
    case ContainerKind::take:
      return describe_take(path);
    case ContainerKind::face_model:
      break;
  }
  const FaceModel model = load_face_model(path);
  json result = describe(model.head);
  result["kind"] = "model";
  json shapes = json::array();
  for (const VolumetricShape& shape : model.shapes)
    shapes.push_back({{"name", shape.name}, {"tets", shape.tets.size()}});
  result["volumetric_shapes"] = shapes;
  return result;
}

}  // namespace phiz
