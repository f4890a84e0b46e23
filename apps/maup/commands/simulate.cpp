#include "columns.hpp"
#include "extended_text.hpp"
#include "field_table.hpp"
#include "field_views.hpp"
#include "fields_text.hpp"
#include "happenings_text.hpp"
#include "interrupt.hpp"
#include "numbers.hpp"
#include "outcome.hpp"
#include "output_files.hpp"
#include "quantity.hpp"
#include "run_options.hpp"

#include <fmt/format.h>

#include <cmath>

#include <maupertuis/motion_pictures.hpp>
#include <maupertuis/plot.hpp>
#include <maupertuis/uncertainty.hpp>

namespace maupertuis::app {
namespace {

struct SimulateOptions {
  ModelOptions model;
  RunOptions run;
  std::string output, plot;
  std::vector<std::string> columns;      // lists, as written; none: every column
  std::optional<std::string> precision;  // none: that of the model
  bool errors = false;
};

/// Before the run: a wrong ending must not cost an hour of computing.
void check_endings(const SimulateOptions& options, Diagnostics& diagnostics) {
  if (options.errors && (options.run.no_errors || options.output.empty()))
    diagnostics.error(
        "E0809", {},
        options.run.no_errors ? "--errors and --no-errors exclude each other."
                              : "--errors is about the file of -o, and there is none.",
        "It writes the errors of each row beside it; those of the states that are printed stand there anyway.",
        options.run.no_errors ? "Leave one of them out." : "Add -o motion.csv, or leave --errors out.");
  if (!options.columns.empty() && options.output.empty() && options.plot.empty())
    diagnostics.error("E0809", {}, "--columns is about the files of -o and --plot, and there is none.",
                      "It chooses what stands in them.", "Add -o motion.csv or --plot motion.svg.");
  check_output_files({{"-o", options.output, FileKind::Table}, {"--plot", options.plot, FileKind::Picture}},
                     options.model.path, diagnostics);
}

/// A λ that the equations do not determine is null.
Json number_or_null(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }

/// As numbers of `state`; null where no digit is certain.
bool is_determined(const SimulationResult& result, const std::string& name) {
  return std::find(result.undetermined.begin(), result.undetermined.end(), name) == result.undetermined.end();
}

Json errors_json(const State& state, const SimulationResult& result, const MechanicalSystem& system) {
  Json out = Json::object();
  const StateErrors& errors = *state.errors;
  if (errors.t != 0) out["t"] = number_or_null(errors.t);
  for (std::size_t i = 0; i < errors.q.size(); ++i) {
    const std::string& name = system.coordinates[i].name;
    if (is_determined(result, name)) out[name] = number_or_null(errors.q[i]);
    if (is_determined(result, name + "'")) out[name + "'"] = number_or_null(errors.v[i]);
  }
  for (std::size_t i = 0; i < errors.quantities.size(); ++i)
    out[result.quantities[i].name] = number_or_null(errors.quantities[i]);
  for (std::size_t i = 0; i < errors.multipliers.size(); ++i)
    out[system.constraints[i].multiplier.name()] = number_or_null(errors.multipliers[i]);
  for (std::size_t i = 0; i < errors.reactions.size(); ++i)
    out[result.reactions[i].name] = number_or_null(errors.reactions[i]);
  return out;
}

Json state_json(const State& state, const SimulationResult& result, const MechanicalSystem& system) {
  Json values = Json::object();
  for (std::size_t i = 0; i < state.q.size(); ++i) {
    const std::string& name = system.coordinates[i].name;
    if (is_determined(result, name)) values[name] = state.q[i];
    if (is_determined(result, name + "'")) values[name + "'"] = state.v[i];
  }
  for (std::size_t i = 0; i < state.quantities.size(); ++i)
    values[result.quantities[i].name] = number_or_null(state.quantities[i]);
  Json multipliers = Json::object(), reactions = Json::object();
  for (std::size_t i = 0; i < state.multipliers.size(); ++i)
    multipliers[system.constraints[i].multiplier.name()] = number_or_null(state.multipliers[i]);
  for (std::size_t i = 0; i < state.reactions.size(); ++i)
    reactions[result.reactions[i].name] = number_or_null(state.reactions[i]);
  Json out = {{"t", state.t},
              {"state", std::move(values)},
              {"multipliers", std::move(multipliers)},
              {"reactions", std::move(reactions)}};
  if (state.errors) out["errors"] = errors_json(state, result, system);
  return out;
}

Json uncertain_json(const SimulationResult& result) {
  Json names = Json::array();
  for (const std::size_t column : result.uncertain.columns) names.push_back(result.trajectory.columns[column].name);
  if (names.empty()) return nullptr;
  return {{"from", result.uncertain.from}, {"what", std::move(names)}, {"everything", result.uncertain.everything}};
}

/// `shown`: as JSON. Else it is there for its numbers to be looked at, and events, of which there may be a hundred
/// thousand as impacts accumulate, would take the time that Ctrl-C leaves.
Json document_of(const SimulationResult& result, const MechanicalSystem& system, bool shown) {
  const Saving saving;
  Json document = json_document("simulate");
  document["system"] = system.name;
  document["final"] = state_json(result.final, result, system);
  document["at"] = Json::array();
  for (const State& state : result.at) document["at"].push_back(state_json(state, result, system));
  const SimulationStatistics& s = result.statistics;
  document["statistics"] = {{"steps", s.steps},
                            {"rejected", s.rejected},
                            {"seconds", s.seconds},
                            {"compile_seconds", s.compile_seconds},
                            {"order", s.order},
                            {"method", s.method},
                            {"backend", s.backend},
                            {"energy_drift", s.energy_drift},
                            {"constraint_residual", s.constraint_residual},
                            {"switches", s.switches},
                            {"rows", result.trajectory.rows()},
                            {"companions", s.companions},
                            {"companion_seconds", s.companion_seconds}};
  document["uncertain"] = uncertain_json(result);
  if (shown) put_happenings(document, chronicle_of(result), system);
  document["ended"] = {{"reason", result.reason.empty() ? std::string(word_of(result.ending)) : result.reason},
                       {"kind", word_of(result.ending)},
                       {"ok", result.ok()}};
  return document;
}

/// -5.0034072(1) rad; where nobody asked for errors all 17 digits.
std::string number_text(double value, const std::optional<StateErrors>& errors, double error, const std::string& unit) {
  const std::string with_blank = unit.empty() || unit == "1" ? "" : " " + unit;
  if (!errors) return exact(value) + with_blank;
  if (std::isinf(error)) return "?  (no digit is certain)";
  return with_uncertainty(value, error) + with_blank;
}

std::string state_text(const State& state, const SimulationResult& result, const MechanicalSystem& system) {
  if (state.q.empty()) return system.moment(exact(state.t)) + "\n  not reached\n";
  const auto& errors = state.errors;
  const bool located = errors && errors->t != 0;
  std::string out = system.moment(!located                ? exact(state.t)
                                  : std::isinf(errors->t) ? "?"
                                                          : with_uncertainty(state.t, errors->t)) +
                    "\n";
  const auto line = [&](const std::string& name, double value, double error, const std::string& unit) {
    out += std::isfinite(value) ? fmt::format("  {} = {}\n", name, number_text(value, errors, error, unit))
                                : fmt::format("  {} has no value\n", name);
  };
  for (std::size_t i = 0; i < state.q.size(); ++i) {
    const Coordinate& c = system.coordinates[i];
    if (is_determined(result, c.name))
      line(c.name, state.q[i], errors ? errors->q[i] : 0, system.dimensionless ? "" : to_string(c.dimension));
    if (is_determined(result, c.name + "'"))
      line(c.name + "'", state.v[i], errors ? errors->v[i] : 0,
           system.dimensionless ? "" : to_string(c.dimension / system.independent_dimension));
  }
  for (std::size_t i = 0; i < state.quantities.size(); ++i)
    line(result.quantities[i].name, state.quantities[i], errors ? errors->quantities[i] : 0, result.quantities[i].unit);
  for (std::size_t i = 0; i < state.reactions.size(); ++i) {
    const Trajectory::Column& column = result.reactions[i];
    if (std::isnan(state.reactions[i]))
      out += fmt::format("  {}: not determined\n", column.name);
    else
      line(column.name, state.reactions[i], errors ? errors->reactions[i] : 0, column.unit);
  }
  return out;
}

/// From when on nothing is certain; empty where something is all along the run.
std::string uncertain_text(const SimulationResult& result, const MechanicalSystem& system) {
  const Uncertainty& uncertain = result.uncertain;
  if (uncertain.columns.empty()) return {};
  std::string names;
  for (const std::size_t column : uncertain.columns)
    names += (names.empty() ? "" : ", ") + result.trajectory.columns[column].name;
  const std::string from = system.moment(brief(uncertain.from));
  constexpr double much_earlier = 0.5;
  if (uncertain.everything && std::abs(uncertain.first) < much_earlier * std::abs(uncertain.from))
    return fmt::format("From {} on not all is certain, and from {} on nothing is certain of this motion.\n",
                       system.moment(brief(uncertain.first)), from);
  return uncertain.everything ? fmt::format("From {} on nothing is certain of this motion.\n", from)
                              : fmt::format("From {} on no digit is certain of {}.\n", from, names);
}

std::string text_of(const SimulationResult& result, const MechanicalSystem& system) {
  std::string out = happenings_text(chronicle_of(result), system);
  for (const State& state : result.at) out += state_text(state, result, system);
  if (result.at.empty() || result.at.back().t != result.final.t) out += state_text(result.final, result, system);
  const SimulationStatistics& s = result.statistics;
  if (result.ending == Ending::Interrupted && s.companions == 0)
    out += "How far off these numbers are is not known: the run was interrupted before its companions told it.\n";
  const std::string method = s.method == "taylor"  ? fmt::format("of order {}", s.order)
                             : s.method == "stiff" ? "of the stiff method"
                                                   : fmt::format("of the variational method, order {},", s.order);
  const std::string energy =
      s.energy_vanishes ? "h_E = 0 at every state" : fmt::format("energy drift {}", brief(s.energy_drift));
  const std::string residual =
      system.constrained() ? fmt::format("; constraint residual {}", brief(s.constraint_residual)) : "";
  const std::string companions =
      s.companions > 0 ? fmt::format("; errors from {} companions in {} s", s.companions, brief(s.companion_seconds))
                       : "";
  return out + uncertain_text(result, system) +
         fmt::format("{} steps {} in {} s ({}, ready in {} s); {}{}{}\n", s.steps, method, brief(s.seconds), s.backend,
                     brief(s.compile_seconds), energy, residual, companions);
}

/// "The run ended at t = 2 s: the condition of `run until` was met"; a reason that a diagnostic tells is left to that.
std::string ending_line(const std::string& moment, const std::string& reason, const Diagnostics& diagnostics) {
  const auto told = diagnostics.items();
  const bool is_told = std::any_of(told.begin(), told.end(), [&](const Diagnostic& d) { return d.reason == reason; });
  return is_told ? fmt::format("The run ended at {}.\n", moment)
                 : fmt::format("The run ended at {}: {}\n", moment, reason);
}

/// What was computed is written whatever the ending.
void write_files(const SimulateOptions& options, const AskedColumns& columns, const SimulationResult& result,
                 Study& study) {
  Diagnostics& diagnostics = study.diagnostics();
  const auto rows = columns.empty() ? result.trajectory : columns.chosen_from(result.trajectory, study);
  if (!rows) return;
  const WrittenColumns formulas = columns.formulas(study);
  if (!options.output.empty())
    write_rows(options.output, options.errors ? with_error_columns(*rows) : *rows, diagnostics, {}, formulas);
  const bool began = result.ok() || result.trajectory.rows() > 1;  // else the reason of the end says it all
  if (options.output.empty() && began && check_numbers(result.trajectory, diagnostics))
    check_picture(*rows, diagnostics, formulas);
  if (!options.plot.empty()) {
    PlotOptions picture;
    picture.title = study.model()->system.title;
    show_happenings(picture, result, study.model()->system);
    write_picture(options.plot, plot_svg(*rows, picture), diagnostics);
  }
}

ExitCode simulate_model(const SimulateOptions& options, Study& study, Console& console) {
  const bool readable_model = !study.wrong();
  check_endings(options, study.diagnostics());
  const AskedColumns columns("--columns", options.columns, study);
  SimulationOptions settings = simulation_options(options.run, study.diagnostics(), study.tree());
  const bool rows_wanted = options.errors || !options.plot.empty();
  if (rows_wanted && settings.errors != ErrorEstimates::None) settings.errors = ErrorEstimates::Rows;
  settings.rows_of_steps = !options.plot.empty() && options.output.empty();  // a file keeps its even rows
  if (readable_model && study.wrong()) {
    finish(console, study, json_document("simulate"));
    return ExitCode::Usage;
  }
  put_in_run(options.run, study);

  const auto result = run_model(study, settings, console);
  if (!result) return finish(console, study, json_document("simulate"));
  write_files(options, columns, *result, study);
  const MechanicalSystem& system = study.model()->system;
  if (!console.json()) {
    console.print(text_of(*result, system));
    if (result->ending != Ending::Finished)
      console.say(ending_line(system.moment(exact(result->final.t)), result->reason, study.diagnostics()));
  }
  const bool files_written = !study.wrong();
  const ExitCode told = finish(console, study, document_of(*result, system, console.json()));
  return files_written && told != ExitCode::RunFailed ? exit_code(result->ending) : ExitCode::RunFailed;
}

/// Pictures and binary trajectories hold doubles; the digits that are printed are the errors.
void check_extended_files(const SimulateOptions& options, Diagnostics& diagnostics) {
  if (options.errors || options.run.no_errors)
    diagnostics.error(
        "E0809", {}, fmt::format("{} belongs to runs in double.", options.errors ? "--errors" : "--no-errors"),
        "In many digits those are written of which several runs agree: their number tells the error.", "Leave it out.");
  if (!options.columns.empty())
    diagnostics.error("E0809", {}, "--columns belongs to runs in double.", "In many digits every column is written.",
                      "Leave it out, or give --precision double.");
  if (!options.plot.empty())
    diagnostics.error("E0809", {}, "--plot draws what double computes.", "A picture shows no more digits.",
                      "Give --precision double for it.");
  check_output_files({{"-o", options.output, FileKind::Csv}}, options.model.path, diagnostics);
}

ExitCode simulate_extended_model(const SimulateOptions& options, const std::string& digits, Study& study,
                                 Console& console) {
  const bool readable_model = !study.wrong();
  check_extended_files(options, study.diagnostics());
  const Precision precision = digits == "quad" ? Precision::Quad : Precision::Digits100;
  ExtendedSimulationOptions settings = extended_options(options.run, precision, study.diagnostics(), study.tree());
  settings.rows = !options.output.empty();
  if (readable_model && study.wrong()) {
    finish(console, study, json_document("simulate"));
    return ExitCode::Usage;
  }
  put_in_run(options.run, study);

  const auto result = run_model(study, settings, console);
  if (!result) return finish(console, study, json_document("simulate"));
  if (!options.output.empty()) write_result(options.output, to_csv(*result), study.diagnostics());
  const MechanicalSystem& system = study.model()->system;
  if (!console.json()) {
    console.print(extended_text(*result, system));
    if (result->ending != Ending::Finished)
      console.say(ending_line(system.moment(exact(result->reached)), result->reason, study.diagnostics()));
  }
  const bool files_written = !study.wrong();
  const ExitCode told = finish(console, study, extended_document(*result, digits, system));
  return files_written && told != ExitCode::RunFailed ? exit_code(result->ending) : ExitCode::RunFailed;
}

/// Of fields alone: where bodies take part, what the field has is not conserved.
std::optional<FieldCurrents> currents_of_run(Study& study) {
  const FieldEquations& equations = *study.field_equations();
  if (runs_as_one_system(equations)) return std::nullopt;
  const InterruptScope scope = study.interruptible();
  return field_currents(equations);
}

/// --at and --errors of fields are about the formulas of --columns.
void check_field_columns(const SimulateOptions& options, Diagnostics& diagnostics) {
  for (const auto& [name, given] : {std::pair{"--at", !options.run.at.empty()}, {"--errors", options.errors}})
    if (given && options.columns.empty())
      diagnostics.error("E0809", {}, fmt::format("{} is about the values of --columns, and there are none.", name),
                        "A field has a value at each place: formulas say at which.",
                        "Add for example --columns \"u(3 m), u_x(1 m)\".");
  if (options.errors && (options.output.empty() || options.run.no_errors))
    diagnostics.error(
        "E0809", {},
        options.output.empty() ? "--errors is about the file of -o, and there is none."
                               : "--errors and --no-errors exclude each other.",
        "It writes the errors of each row beside it; those of values that are printed stand there anyway.",
        options.output.empty() ? "Add -o values.csv, or leave --errors out." : "Leave one of them out.");
}

ExitCode simulate_fields(const SimulateOptions& options, Study& study, Console& console) {
  Json document = json_document("simulate");
  check_output_files({{"-o", options.output, FileKind::Table}, {"--plot", options.plot, FileKind::Picture}},
                     options.model.path, study.diagnostics());
  refuse_options_of_motions(options.run, {}, study.diagnostics());
  check_field_columns(options, study.diagnostics());
  const SimulationOptions settings = simulation_options(options.run, study.diagnostics(), study.tree());
  if (study.wrong()) return finish_usage(console, study, "simulate");
  if (options.precision && *options.precision != "double")
    study.diagnostics().error("E0809", {}, "Fields are run in double.", "The mesh limits the digits, not the numbers.",
                              "Leave --precision out.");
  FieldTable table(options.columns, study);
  const FieldEquations* equations = study.field_equations();
  if (!equations) return finish(console, study, std::move(document));
  const bool rows_of_table = !table.empty() && !options.output.empty();
  const std::vector<FieldQuestion> questions = table.questions(study, settings, rows_of_table);
  if (study.wrong()) return finish_usage(console, study, "simulate");
  const std::optional<FieldCurrents> currents = currents_of_run(study);
  FieldMotionOptions kept{(!options.output.empty() && !rows_of_table) || !options.plot.empty(),
                          options.output.empty() || rows_of_table,
                          {},
                          currents ? &*currents : nullptr};
  kept.questions = questions, kept.errors = !options.run.no_errors;
  const auto run = run_model(study, settings, kept, console);
  if (!run) return finish(console, study, std::move(document));
  if (!options.output.empty())
    write_rows(options.output, rows_of_table ? table.rows(*run, options.errors) : run->trajectory, study.diagnostics());
  if (!options.plot.empty() && has_pictures(*run, study.diagnostics()))
    write_picture(options.plot, pictures_of_fields(study, *equations, *run, {}), study.diagnostics());
  if (!console.json()) console.print(field_run_text(*run, study.model()->system) + table.text(*run));
  document = field_run_json(*run, study.model()->system);
  if (!table.empty()) document["at"] = table.json(*run);
  const ExitCode told = finish(console, study, std::move(document));
  return run->trouble.empty() || told != ExitCode::Fine ? told : ExitCode::RunFailed;
}

/// The precision of the command line, else that of the model. A word that is none is for the model to refuse.
ExitCode simulate_in_any_precision(const SimulateOptions& options, Console& console) {
  Study study = open_study(options.model);
  if (declares_fields(study.tree())) return simulate_fields(options, study, console);
  const std::string digits = options.precision ? *options.precision : precision_of(study.tree());
  return digits == "quad" || digits == "100" ? simulate_extended_model(options, digits, study, console)
                                             : simulate_model(options, study, console);
}

}  // namespace

void add_simulate(CommandLine& line) {
  const auto options = std::make_shared<SimulateOptions>();
  Command& command = line.add("simulate", "Run the experiment of a model",
                              "  maup simulate pendulum.lag\n"
                              "  maup simulate pendulum.lag --at 3s -o motion.csv --plot motion.svg\n"
                              "  maup simulate pendulum.lag --set l=2m --start θ=170deg --duration -5s --json\n",
                              [options](Console& console) { return simulate_in_any_precision(*options, console); });
  add_model_options(command, options->model);
  add_span_options(command, options->run);
  add_method_options(command, options->run);
  add_errors_option(command, options->run);
  command.add_flag("--errors", options->errors, "Columns error(θ), … of the errors of each row in the file of -o");
  command
      .add_option("--precision", options->precision,
                  "double, quad (113 bits) or 100 (decimal digits): as many digits as two runs agree on; default: the "
                  "model's `precision`, or double")
      ->one_of({"double", "quad", "100"})
      ->type_name("DIGITS");
  command.add_option("-o,--output", options->output, "The trajectory: .csv, .npy or .json")->type_name("FILE");
  command.add_option("--plot", options->plot, "Its time series as a picture: .svg, .png or .pdf")->type_name("FILE");
  command
      .add_option(
          "--columns", options->columns,
          "What stands in these files: columns and formulas, e.g. \"θ1 - θ2, B.x, energy\" (default: every column)")
      ->allow_extra_args(false)
      ->type_name("FORMULA,...");
}

}  // namespace maupertuis::app
