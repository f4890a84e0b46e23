#include "command.hpp"
#include "fields_text.hpp"
#include "invariants_text.hpp"
#include "outcome.hpp"

namespace maupertuis::app {
namespace {

struct CommandOptions {
  ModelOptions model;
  InvariantsOptions search;
  bool no_drift = false;
  bool all = false;
};

ExitCode invariants_of_model(const CommandOptions& options, Console& console) {
  Study study = open_study(options.model);
  if (study.has_fields()) {
    const bool good = study.field_equations() != nullptr;
    const InterruptScope fields_scope = study.interruptible();
    if (!console.json() && good) console.print(currents_text(study));
    return finish(console, study, console.json() ? currents_json(study) : Json{});
  }
  Json document = json_document("invariants");
  const EquationsOfMotion* equations = study.equations();
  if (!equations || study.refuse_held_integrals() || !study.certificate()) return finish(console, study, document);
  InvariantsOptions search = options.search;
  search.drift = !options.no_drift;
  const InterruptScope scope = study.interruptible();
  const auto found = find_invariants(*study.model(), *equations, search, study.diagnostics());
  if (!found) return finish(console, study, document);
  document["system"] = equations->system->name;
  add_invariants_json(document, *found, *equations);
  std::vector<IntegralThroughModes> through;
  const bool has_modes = equations->system->has_modes(), in_parts = is_in_parts(*study.model());
  if (in_parts) {
    std::vector<Expr> integrals;
    for (const ConservedFunction& i : found->integrals) integrals.push_back(i.value);
    through = integrals_through_modes(*study.model(), *equations, integrals);
    add_through_modes_json(document, through);
  }
  if (!console.json())
    console.print(invariants_text(*found, *equations, options.all) +
                  (in_parts ? through_modes_text(*found, through, has_modes, options.all) : ""));
  return finish(console, study, document);
}

}  // namespace

void add_invariants(CommandLine& line) {
  const auto options = std::make_shared<CommandOptions>();
  Command& command = line.add("invariants", "Symmetries and conserved quantities, proved",
                              "  maup invariants kepler.lag\n"
                              "  maup invariants kovalevskaya_top.lag --degree 4\n"
                              "  maup invariants double_pendulum.lag --set g=0 --json\n",
                              [options](Console& console) { return invariants_of_model(*options, console); });
  add_model_options(command, options->model);
  command
      .add_option("--degree", options->search.velocity_degree,
                  "Search polynomials of the velocities up to this degree (2)")
      ->between(1, 4);
  command
      .add_option("--largest-basis", options->search.largest_basis, "At most so many functions in one search (1400)")
      ->between(10, 20000);
  command.add_flag("--all", options->all, "Also those that are functions of others and have no name");
  command.add_flag("--no-drift", options->no_drift, "Leave out the run that measures the drift");
}

}  // namespace maupertuis::app
