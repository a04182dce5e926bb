// SPDX-License-Identifier: GPL-3.0-or-later
// phiz template build: makes the open-anatomy head from raw data.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "made_head.h"
#include "options.h"
#include "phiz/anatomy/open/open_head.h"
#include "phiz/core/error.h"
#include "phiz/core/progress.h"
#include "phiz/core/version.h"
#include "phiz/io/container.h"
#include "phiz/io/open_data.h"
#include "phiz/io/output_file.h"
#include "report.h"
#include "verbs.h"

namespace phiz {

namespace {

struct BuildArguments {
  std::string ict, bodyparts3d, size = "standard", output;
  bool fresh = false;
  Report report;
};

/// $PHIZ_CACHE, else the user's cache folder; empty when there is none.
std::filesystem::path cache_folder() {
  const auto variable = [](const char* name) {
    const char* value = std::getenv(name);
    return std::filesystem::path(value != nullptr ? value : "");
  };
  if (const auto own = variable("PHIZ_CACHE"); !own.empty()) return own;
  if (const auto caches = variable("XDG_CACHE_HOME"); !caches.empty()) return caches / "phiz";
  const auto home = variable("HOME");
  return home.empty() ? home : home / ".cache" / "phiz";
}

/// Where the head made of these data, in this size, by this Phiz, is kept. Empty: nowhere.
std::filesystem::path cached_head(const BuildArguments& a) {
  const std::filesystem::path folder = cache_folder();
  if (folder.empty() || commit().ends_with('+')) return {};
  return folder / fmt::format("open-{}-{}-{}-{:016x}-{:016x}.phiz", a.size, version(), commit(),
                              fingerprint_face_kit(a.ict), fingerprint_body_parts(a.bodyparts3d));
}

/// Builds the head, or takes it from the cache.
HeadTemplate open_head(const BuildArguments& arguments, bool& cached) {
  Progress progress("open head", open_head_steps + 3);
  progress.begin("look at the data");
  const std::filesystem::path kept = cached_head(arguments);
  std::error_code error;
  cached = !arguments.fresh && !kept.empty() && std::filesystem::exists(kept, error);
  if (cached) try {
      return load_head_template(kept.string());
    } catch (const Error&) {
      cached = false;  // damaged: it is made anew
    }
  progress.begin("read the data");
  const BodyParts parts = read_body_parts(arguments.bodyparts3d);
  const FaceKit kit = read_face_kit(arguments.ict);
  OpenHeadOptions options;
  options.size = head_size(arguments.size);
  options.report = [&progress](const std::string& step) { progress.begin(step); };
  HeadTemplate head = build_open_head(kit, parts, options);
  progress.begin("keep in the cache");
  if (!kept.empty()) try {
      std::filesystem::create_directories(kept.parent_path());
      save(kept.string(), head);
    } catch (const std::exception&) {
      // A cache that cannot be written to is done without.
    }
  return head;
}

void make_open_head(const BuildArguments& arguments) {
  const auto start = std::chrono::steady_clock::now();
  require_writable(arguments.output);
  for (const std::string& folder : {arguments.ict, arguments.bodyparts3d})
    if (!std::filesystem::is_directory(folder)) reject(folder, "there is no such folder");
  bool cached = false;
  const HeadTemplate head = open_head(arguments, cached);
  save_and_report(arguments.output, head, start, arguments.report, cached ? " (from the cache)" : "",
                  {{"cached", cached}});
}

}  // namespace

void add_template_build(CLI::App& verb) {
  CLI::App* build = verb.add_subcommand("build", "Make the open-anatomy head from ICT-FaceKit and BodyParts3D");
  auto arguments = std::make_shared<BuildArguments>();
  build->add_option("--ict", arguments->ict, "Folder of ICT Face Model Light (plain files, or in an archive)")
      ->required()
      ->type_name("DIR");
  build->add_option("--bodyparts3d", arguments->bodyparts3d, "Folder of BodyParts3D with files named FMA...")
      ->required()
      ->type_name("DIR");
  build->add_option("--size", arguments->size, "preview (8k soft tets), standard (about 36k) or fine (150k and more)")
      ->check(CLI::IsMember({"preview", "standard", "fine"}))
      ->capture_default_str();
  build->add_option("-o,--output", arguments->output, "The head, a .phiz file")
      ->required()
      ->check(phiz_name())
      ->type_name("FILE");
  build->add_flag("--fresh", arguments->fresh, "Build anew, even when the same head is in the cache");
  add_report(*build, arguments->report);
  build->footer(
      "A head once built is kept in $PHIZ_CACHE, else in the user's cache folder, and used again for the same data.\n"
      "Example:\n  phiz template build --ict FaceXModel --bodyparts3d bodyparts3d -o open.phiz");
  build->callback([arguments] { make_open_head(*arguments); });
}

}  // namespace phiz
