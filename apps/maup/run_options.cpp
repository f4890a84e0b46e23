#include "run_options.hpp"

#include "fields_text.hpp"

#include "interrupt.hpp"
#include "quantity.hpp"
#include "time_options.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <map>

namespace maupertuis::app {
namespace {

std::optional<Rational> exact_time_option(const char* option, const std::string& text, Diagnostics& diagnostics) {
  const std::optional<Rational> value = parse_exact_time(text);
  if (!value || !std::isfinite(value->to_double())) {
    diagnostics.error("E0809", {}, fmt::format("{} \"{}\" is no time.", option, text), {},
                      "Write a number with a unit of time, such as 3s, 250ms or \"2 min\".");
    return {};
  }
  return value;
}

std::optional<double> time_option(const char* option, const std::string& text, Diagnostics& diagnostics) {
  const std::optional<Rational> value = exact_time_option(option, text, diagnostics);
  return value ? std::optional(value->to_double()) : std::nullopt;
}

/// What the line of progress says of a run: a fraction of it is done.
std::function<void(double)> progress_of_run(const Console& console) {
  using Clock = std::chrono::steady_clock;
  if (!console.progress()) return {};
  return [line = console.progress(), begin = Clock::now()](double fraction) {
    const double passed = std::chrono::duration<double>(Clock::now() - begin).count();
    line->measure(fraction > 0 && fraction < 1
                      ? fmt::format("{:.0f} %, {:.0f} s to go", 100 * fraction, passed / fraction - passed)
                      : std::string());
  };
}

}  // namespace

void add_method_options(Command& command, RunOptions& options) {
  command
      .add_option(
          "--method", options.method,
          "How to step: auto (Taylor's, and the stiff one from where stability limits them), taylor, variational "
          "(needs --step), stiff; default: the model's `method`, or auto")
      ->one_of({"auto", "taylor", "variational", "stiff"})
      ->type_name("METHOD");
  command.add_option("--step", options.step, "The length of the steps of --method variational")->type_name("TIME");
  command.add_option("--order", options.order, "The order of the steps (variational: 2, 4, … 12)")->type_name("NUMBER");
  command.add_option("--tol", options.tolerance, "Relative tolerance of a step (default: rounding level)")
      ->type_name("NUMBER");
  command
      .add_option("--backend", options.backend,
                  "What carries the steps out: auto (machine code where the run is long enough to pay for it), "
                  "interpreter, compiled")
      ->one_of({"auto", "interpreter", "compiled"})
      ->type_name("BACKEND");
  command.add_flag("--no-cache", options.no_cache, "Neither read nor keep machine code of other runs");
}

void add_errors_option(Command& command, RunOptions& options) {
  command.add_flag("--no-errors", options.no_errors,
                   "No companion runs: numbers without what is known of their errors");
}

void add_span_options(Command& command, RunOptions& options) {
  const auto duration =
      command.add_option("--duration", options.duration, "Run this long instead; negative: backwards in time")
          ->type_name("TIME");
  const auto until = command.add_option("--until", options.until, "Run until this holds instead, e.g. \"P.y = 0\"")
                         ->type_name("EQUATION")
                         ->excludes(duration);
  command.add_option("--within", options.within, "The longest time for --until (default 60s)")
      ->type_name("TIME")
      ->needs(until);
  command.add_option("--every", options.every, "Time between the rows of the trajectory")->type_name("TIME");
  command.add_option("--at", options.at, "Also print the state at these times, e.g. 3s or 1s,2s,5s")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("TIME,...");
}

namespace {

double tolerance_option(const RunOptions& options, Diagnostics& diagnostics) {
  if (!options.tolerance) return 0;
  if (*options.tolerance > 0 && *options.tolerance < 1) return *options.tolerance;
  diagnostics.error("E0809", {}, fmt::format("--tol {} is no tolerance.", brief(*options.tolerance)), {},
                    "Write a positive number below 1, such as 1e-10.");
  return 0;
}

StepMethod method_named(const std::string& word) {
  static const std::map<std::string, StepMethod> methods{{"auto", StepMethod::Automatic},
                                                         {"taylor", StepMethod::Taylor},
                                                         {"variational", StepMethod::Variational},
                                                         {"stiff", StepMethod::Stiff}};
  const auto method = methods.find(word);
  return method != methods.end() ? method->second : StepMethod::Automatic;
}

std::optional<StepMethod> method_option(const RunOptions& options) {
  return options.method ? std::optional(method_named(*options.method)) : std::nullopt;
}

/// The first statement of its kind; null without one.
template <class Statement>
const Statement* statement_of(const syntax::SyntaxTree* tree) {
  if (tree)
    for (const syntax::Statement& s : tree->statements)
      if (const auto* found = std::get_if<Statement>(&s.body)) return found;
  return nullptr;
}

void refuse_units_that_are_names(const RunOptions& options, const syntax::SyntaxTree* tree, Diagnostics& diagnostics) {
  for (const auto& [option, text] : {std::pair("--duration", options.duration), std::pair("--every", options.every),
                                     std::pair("--step", options.step)})
    if (text) refuse_unit_that_is_a_name(option, *text, tree, diagnostics);
  for (const std::string& text : options.at) refuse_unit_that_is_a_name("--at", text, tree, diagnostics);
}

}  // namespace

SimulationOptions simulation_options(const RunOptions& options, Diagnostics& diagnostics,
                                     const syntax::SyntaxTree* tree) {
  SimulationOptions out;
  out.tolerance = tolerance_option(options, diagnostics);
  out.method = method_option(options);
  if (options.step)
    if (const auto step = time_option("--step", *options.step, diagnostics)) out.step = *step;
  if (options.order) out.order = *options.order;
  out.backend = options.backend == "compiled"      ? Backend::Compiled
                : options.backend == "interpreter" ? Backend::Interpreter
                                                   : Backend::Automatic;
  out.cache = !options.no_cache;
  if (options.no_errors) out.errors = ErrorEstimates::None;
  const auto* written = statement_of<syntax::MethodStatement>(tree);
  const StepMethod method = out.method ? *out.method : method_named(written ? written->word.text : "auto");
  refuse_units_that_are_names(options, tree, diagnostics);
  const bool fixed_steps = method == StepMethod::Variational;
  if (options.step && !fixed_steps)
    diagnostics.error("E0809", {}, "--step belongs to --method variational.",
                      "The other methods choose their steps by the tolerance.",
                      "Add --method variational, or use --tol.");
  if (options.order && !fixed_steps && (*options.order < 2 || *options.order > 60 || method == StepMethod::Stiff))
    diagnostics.error("E0809", {}, fmt::format("--order {} is no order of this method.", *options.order),
                      method == StepMethod::Stiff ? "The stiff method chooses its order from 1 to 5 itself."
                                                  : "Taylor's steps take orders from 2 to 60.",
                      "Leave --order out, or use --tol.");
  if (options.duration) out.duration = time_option("--duration", *options.duration, diagnostics);
  if (options.every) out.output_every = time_option("--every", *options.every, diagnostics);
  if (out.output_every && !(*out.output_every > 0))
    diagnostics.error("E0809", {}, "--every must be a positive time.", {},
                      "Rows stand so far apart, for example --every 0.1.");
  for (const std::string& text : options.at)
    if (const auto t = time_option("--at", text, diagnostics)) out.at.push_back(*t);
  out.interrupt = &interrupt_flag();
  return out;
}

std::string precision_of(const syntax::SyntaxTree* tree) {
  const auto* written = statement_of<syntax::PrecisionStatement>(tree);
  return written ? written->word.text : "double";
}

ExtendedSimulationOptions extended_options(const RunOptions& options, Precision precision, Diagnostics& diagnostics,
                                           const syntax::SyntaxTree* tree) {
  ExtendedSimulationOptions out;
  refuse_units_that_are_names(options, tree, diagnostics);
  out.precision = precision;
  out.tolerance = tolerance_option(options, diagnostics);
  out.method = method_option(options);
  if (options.step)
    diagnostics.error("E0809", {}, "--step belongs to --method variational.",
                      "Runs in many digits choose their steps by the tolerance.", "Leave --step out, or use --tol.");
  if (options.order && (*options.order < 2 || *options.order > 400))
    diagnostics.error("E0809", {}, fmt::format("--order {} is no order of this method.", *options.order),
                      "In many digits Taylor's steps take orders from 2 to 400.", "Leave --order out, or use --tol.");
  out.order = options.order.value_or(0);
  if (options.duration) out.duration = exact_time_option("--duration", *options.duration, diagnostics);
  if (options.every) out.output_every = exact_time_option("--every", *options.every, diagnostics);
  if (out.output_every && out.output_every->sign() <= 0)
    diagnostics.error("E0809", {}, "--every must be a positive time.", {},
                      "Rows stand so far apart, for example --every 0.1.");
  for (const std::string& text : options.at)
    if (const auto t = exact_time_option("--at", text, diagnostics)) out.at.push_back(*t);
  out.interrupt = &interrupt_flag();
  return out;
}

namespace {

/// What is no equation: a time, which belongs to --duration, or half of one.
bool refuse_until(Study& study, const std::string& until) {
  if (until.find('=') != std::string::npos) return false;
  const std::string quoted = until.find(' ') == std::string::npos ? until : "\"" + until + "\"";
  if (parse_exact_time(until))
    refuse_option(study, "--until", until, fmt::format("--until {} is a time, and no condition", quoted),
                  "A run ends when the equation of --until holds.",
                  fmt::format("Write --duration {} to run that long.", quoted));
  else
    refuse_option(study, "--until", until, fmt::format("--until {} is no equation", quoted),
                  "A run ends when the two sides of it become equal.",
                  fmt::format("Write for example --until \"{} = 0\".", until));
  return true;
}

}  // namespace

void put_in_run(const RunOptions& options, Study& study) {
  if (options.until.empty() || refuse_until(study, options.until)) return;
  study.override_with(OverrideKind::Until, "--until", options.until);
  if (!options.within.empty()) study.override_with(OverrideKind::Within, "--within", options.within);
}

std::optional<SimulationResult> run_model(Study& study, const SimulationOptions& options, const Console& console) {
  SimulationOptions with_progress = options;
  with_progress.progress = progress_of_run(console);
  return study.motion(with_progress);
}

std::optional<FieldRunResult> run_model(Study& study, const SimulationOptions& options, FieldMotionOptions kept,
                                        const Console& console) {
  SimulationOptions with_progress = options;
  with_progress.progress = progress_of_run(console);
  kept.announce = [&console](const std::string& sentence) { console.say(sentence + "\n"); };
  return run_of_fields(study, with_progress, kept);
}

std::optional<ExtendedResult> run_model(Study& study, const ExtendedSimulationOptions& options,
                                        const Console& console) {
  ExtendedSimulationOptions with_progress = options;
  with_progress.progress = progress_of_run(console);
  return study.motion(with_progress);
}

ExitCode exit_code(Ending ending) {
  if (ending == Ending::Finished || ending == Ending::UntilReached || ending == Ending::Stopped) return ExitCode::Fine;
  return ending == Ending::Interrupted ? ExitCode::Interrupted : ExitCode::RunFailed;
}

}  // namespace maupertuis::app
