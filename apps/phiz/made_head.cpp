// SPDX-License-Identifier: GPL-3.0-or-later
#include "made_head.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "phiz/core/progress.h"
#include "phiz/io/container.h"

namespace phiz {

HeadTemplate make_builtin_head(BuiltinOptions options) {
  Progress progress("built-in head", builtin_head_steps);
  options.report = [&progress](const std::string& step) { progress.begin(step); };
  return build_builtin_head(options);
}

void save_and_report(const std::string& file, const HeadTemplate& head, std::chrono::steady_clock::time_point start,
                     const Report& report, const std::string& note, const nlohmann::json& more) {
  save(file, head);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const Eigen::Index soft = soft_tets(head).size();
  report.print(fmt::format("{}: {}, {} tets ({} soft), {} skin vertices, {} expressions, {} muscles, {:.1f} s{}\n",
                           file, head.name, head.volume.T.rows(), soft, head.skin.V.rows(), head.expressions.size(),
                           head.muscles.size(), seconds, note));
  nlohmann::json all{{"file", file},
                     {"name", head.name},
                     {"tets", head.volume.T.rows()},
                     {"soft_tets", soft},
                     {"vertices", head.volume.V.rows()},
                     {"skin_vertices", head.skin.V.rows()},
                     {"expressions", head.expressions.size()},
                     {"muscles", head.muscles.size()},
                     {"identity_modes", head.identity.skin.cols()},
                     {"seconds", seconds}};
  all.update(more);
  report.write(std::move(all));
}

}  // namespace phiz
