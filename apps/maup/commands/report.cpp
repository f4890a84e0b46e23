#include "interrupt.hpp"
#include "orbits_options.hpp"
#include "outcome.hpp"
#include "output_files.hpp"
#include "run_options.hpp"

#include <fmt/format.h>

#include <maupertuis/invariants.hpp>
#include <maupertuis/report.hpp>
#include <maupertuis/verification.hpp>

namespace maupertuis::app {
namespace {

struct ReportOptions {
  ModelOptions model;
  RunOptions run;
  std::string output;  // empty: NAME.html of the system
  bool without_run = false;
  OrbitsOptions orbits;
};

struct EquilibriumParts {
  std::optional<ModalStudy> study;
  std::optional<Locus> locus;
};

/// What can be said of equilibria; a model without any has no such part, and that is no mistake of a report.
EquilibriumParts equilibrium_parts(const Model& model, const EquationsOfMotion& equations) {
  EquilibriumParts out;
  Diagnostics unheard;
  const auto start = consistent_start(model, equations, unheard);
  if (!start) return out;
  PointEquations at_points(equations);
  out.study = modal_study(at_points, start->state, unheard);
  if (out.study) settle_driven(*out.study, at_points, model, equations, &interrupt_flag());
  if (const auto& sweep = model.experiment.sweep) {
    const auto value = [&](Expr e) { return evaluate(in_terms_of_motion(model.system, {&e, 1}).front(), parameter_bindings(model.system)); };
    out.locus = parameter_locus(at_points, start->state, sweep->parameter, value(sweep->from), value(sweep->to), sweep->steps);
  }
  return out;
}

/// What was asked about the long run.
struct LongRun {
  std::optional<FloquetResult> floquet;
  std::optional<SectionResult> section;
  std::string section_what;
  std::optional<LyapunovResult> lyapunov;
};

void find_section(const ReportOptions& options, Study& study, LongRun& out) {
  const SectionStudy section = section_study(options.orbits, options.model, study);
  Study& own = *section.study;
  out.section_what = section.what;
  if (own.equations()) out.section = poincare_section(*own.model(), *own.equations(), section.options, own.diagnostics());
  for (const Diagnostic& d : own.diagnostics().items())  // without their places, which are in a text of their own
    if (d.severity == Severity::Error) study.diagnostics().error(d.code, {}, d.message, d.reason, d.help);
}

/// What cannot be had is an error of the study, and no page is written.
LongRun long_run(const ReportOptions& options, Study& study) {
  LongRun out;
  const Model& model = *study.model();
  const EquationsOfMotion& equations = *study.equations();
  const OrbitsOptions& asked = options.orbits;
  const bool any = asked.has_section() || asked.floquet || asked.lyapunov;
  if (any && refuse_without_time(study)) return out;
  if (asked.has_section()) find_section(options, study, out);
  if (asked.floquet) out.floquet = floquet(model, equations, floquet_options(asked), study.diagnostics());
  if (asked.lyapunov) out.lyapunov = lyapunov_exponents(model, equations, lyapunov_options(asked), study.diagnostics());
  return out;
}

/// The page; a model that cannot run (no start, no `run`) still gets its equations.
std::string page_of(Study& study, const std::optional<SimulationResult>& result, const SimulationOptions& settings,
                    const LongRun& orbits, const std::optional<PathSearch>& paths) {
  const Model& model = *study.model();
  const EquationsOfMotion& equations = *study.equations();
  ReportParts parts;
  if (paths) parts.paths = &*paths;
  Verification verification;
  EquilibriumParts equilibria;
  if (moves_in_time(model.system)) equilibria = equilibrium_parts(model, equations);
  if (equilibria.study) parts.modes = &*equilibria.study;
  if (equilibria.locus) parts.locus = &*equilibria.locus;
  if (result) parts.simulation = &*result;
  if (orbits.floquet) parts.floquet = &*orbits.floquet;
  if (orbits.section) parts.section = &*orbits.section;
  if (orbits.lyapunov) parts.lyapunov = &*orbits.lyapunov;
  parts.section_what = orbits.section_what;
  // What the page cannot say of a system is no mistake of the model.
  Diagnostics unheard;
  if (result && !model.experiment.expectations.empty()) {
    verification = verify(model, equations, study.source(), settings, unheard);
    parts.verification = &verification;
  }
  // A page is not worth a long search.
  InvariantsOptions search;
  search.largest_basis = 600;
  search.drift = false;
  const auto invariants = find_invariants(model, equations, search, unheard);
  if (invariants) parts.invariants = &*invariants;
  return report_html(compose_report(model, study.source(), equations, *study.derivation(true), *study.certificate(),
                                    study.diagnostics(), parts));
}

/// It says between what ends its paths run, and nothing of a run.
bool is_about_paths_alone(const Model& model) {
  const Experiment& e = model.experiment;
  return e.path && !e.duration && !e.until;
}

ExitCode report(const ReportOptions& options, Console& console) {
  Study study(options.model.path, options.model.overrides);
  Json document = json_document("report");
  const bool readable_model = !study.wrong();
  const SimulationOptions settings = simulation_options(options.run, study.diagnostics(), study.tree());
  check_orbits_options(options.orbits, study.diagnostics());
  if (options.output != "-") check_output_files({{"-o", options.output, FileKind::Page}}, options.model.path, study.diagnostics());
  if (readable_model && study.wrong()) return finish_usage(console, study, "report");
  if (const std::string statement = run_statement(options.run); !statement.empty()) study.replace_run(statement);
  if (refuse_held_integrals(study)) return finish(console, study, document);
  study.derivation(true);  // before the certificate, so that it vouches for the readable form too
  if (!study.certificate()) return finish(console, study, document);

  std::optional<SimulationResult> result;
  if (!options.without_run && !is_about_paths_alone(*study.model())) {
    SimulationOptions of_run = report_run(*study.model(), settings);
    if (of_run.errors != ErrorEstimates::None) of_run.errors = ErrorEstimates::Rows;
    result = run_model(study, of_run, console);
  }
  if (study.wrong()) return finish(console, study, document);
  const LongRun orbits = long_run(options, study);
  std::optional<PathSearch> paths;
  if (const Model& model = *study.model(); model.experiment.path) {
    ActionOptions search;
    search.interrupt = &interrupt_flag();
    paths = stationary_paths(model, *study.equations(), ends_of(model), search, study.diagnostics());
  }
  if (study.wrong()) return finish_without(console, study, "report");
  const std::string page = page_of(study, result, settings, orbits, paths);
  const std::string path = options.output.empty() ? study.model()->system.name + ".html" : options.output;
  if (path == "-") console.print(page);
  else write_result(path, page, study.diagnostics());
  document["file"] = path;
  document["bytes"] = page.size();
  const bool written = !study.wrong();
  if (written && path != "-" && !console.json())
    console.say(fmt::format("Wrote {} ({} kB). Open it in any browser.\n", path, (page.size() + 999) / 1000));
  if (result && !result->ok() && !console.json()) console.say(fmt::format("The run ended early: {}\n", result->reason));
  finish(console, study, document);
  if (!written) return ExitCode::RunFailed;
  return result ? exit_code(result->ending) : ExitCode::Fine;
}

}  // namespace

void add_report(CommandLine& line) {
  const auto options = std::make_shared<ReportOptions>();
  Command& command = line.add("report", "The whole study on one page that needs no network",
                              "  maup report pendulum.lag               # writes pendulum.html\n"
                              "  maup report pendulum.lag -o study.html\n"
                              "  maup report pendulum.lag --set l=2m --duration 60s -o long.html\n",
                              [options](Console& console) { return report(*options, console); });
  add_model_options(command, options->model);
  add_span_options(command, options->run);
  add_method_options(command, options->run);
  add_errors_option(command, options->run);
  command.add_option("-o,--output", options->output, "The page (default: SYSTEM.html), or - for standard output")
      ->type_name("FILE.html");
  add_orbits_options(command, options->orbits);
  command.add_flag("--no-run", options->without_run, "Equations alone: no motion, no pictures");
}

}  // namespace maupertuis::app
