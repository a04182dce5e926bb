// SPDX-License-Identifier: GPL-3.0-or-later
// phiz template person: makes a random person from a template's model of people.
#include <CLI/CLI.hpp>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "made_head.h"
#include "options.h"
#include "phiz/anatomy/people/person.h"
#include "phiz/io/container.h"
#include "phiz/io/output_file.h"
#include "verbs.h"

namespace phiz {

namespace {

struct PersonArguments {
  std::string head, output;
  std::uint64_t seed = 1;
  double spread = 1;
  Report report;
};

void make_random_person(const PersonArguments& arguments) {
  const auto start = std::chrono::steady_clock::now();
  require_writable(arguments.output);
  const HeadTemplate head = arguments.head.empty() ? make_builtin_head({}) : load_head_template(arguments.head);
  const VectorXd coefficients = arguments.spread * random_coefficients(head.identity, arguments.seed);
  HeadTemplate person = make_person(head, coefficients);
  person.name += "-" + std::to_string(arguments.seed);
  validate(person, person.name);
  save_and_report(arguments.output, person, start, arguments.report, "",
                  {{"template", head.name},
                   {"seed", arguments.seed},
                   {"coefficients", std::vector<double>(coefficients.begin(), coefficients.end())}});
}

}  // namespace

void add_template_person(CLI::App& verb) {
  CLI::App* person = verb.add_subcommand("person", "Make a random person of a template, anatomy included");
  auto arguments = std::make_shared<PersonArguments>();
  person
      ->add_option("head", arguments->head,
                   "The template, a .phiz file with a model of people; the built-in head without")
      ->check(CLI::ExistingFile)
      ->type_name("HEAD");
  person->add_option("--seed", arguments->seed, "Which person: the same for the same number")->capture_default_str();
  person->add_option("--spread", arguments->spread, "How far from the mean, 1: as people are")
      ->check(CLI::Range(0.0, 1.5))
      ->capture_default_str();
  person->add_option("-o,--output", arguments->output, "The person's head, a .phiz file")
      ->required()
      ->check(phiz_name())
      ->type_name("FILE");
  add_report(*person, arguments->report);
  person->footer(
      "Examples:\n  phiz template person open.phiz --seed 7 -o person.phiz\n  phiz template person --seed 7 -o "
      "person.phiz");
  person->callback([arguments] { make_random_person(*arguments); });
}

}  // namespace phiz
