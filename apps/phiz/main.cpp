// SPDX-License-Identifier: GPL-3.0-or-later
// The command `phiz`: parses, calls a verb, turns errors into messages and exit codes.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <memory>
#include <new>
#include <string>

#include "options.h"
#include "phiz/core/error.h"
#include "phiz/core/parallel.h"
#include "phiz/core/progress.h"
#include "phiz/core/version.h"
#include "usage.h"
#include "verbs.h"

namespace {

std::string version_line() {
  std::string line = "phiz " + std::string(phiz::version());
  if (!phiz::commit().empty()) line += " (" + std::string(phiz::commit()) + ")";
  return line;
}

int complain(const char* message, int code) {
  std::fprintf(stderr, "phiz: %s\n", message);
  return code;
}

int run(int argc, char** argv) {
  CLI::App app("Physics-based digital humans: build heads, animate them, export and render the result.\n", "phiz");
  app.set_version_flag("--version", version_line());
  app.require_subcommand(1);
  app.fallthrough();
  app.footer("Exit codes: 0 ok, 1 failure, 2 usage, 3 bad input. `phiz VERB --help` shows options and an example.");
  int threads = 0;
  bool quiet = false;
  std::unique_ptr<phiz::ThreadLimit> limit;
  app.add_option("--threads", threads, "Number of threads; 0 means all cores")->check(phiz::between(0, 1024));
  app.add_flag("--quiet,-q", quiet, "No progress on standard error");
  app.parse_complete_callback([&] {
    limit = std::make_unique<phiz::ThreadLimit>(threads);
    phiz::Progress::set_quiet(quiet);
  });
  phiz::add_template(app);
  phiz::add_animate(app);
  phiz::add_simulate(app);
  phiz::add_export(app);
  phiz::add_inspect(app);
  phiz::add_render(app);
  phiz::add_bench(app);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& event) {
    if (event.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success))
      return app.exit(event);  // --help, --version
    if (argc <= 1) std::fputs(app.help().c_str(), stderr);
    return complain(phiz::usage_mistake(app, event).c_str(), 2);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const phiz::Error& error) {
    return complain(error.what(), phiz::exit_code(error.kind()));
  } catch (const std::bad_alloc&) {
    return complain("out of memory; close other programs or use a smaller --size", 1);
  } catch (const std::exception& error) {
    return complain(error.what(), 1);
  } catch (...) {
    return complain("unknown failure", 1);
  }
}
