#include "action_text.hpp"
#include "command.hpp"
#include "interrupt.hpp"
#include "outcome.hpp"
#include "quantity.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <maupertuis/action_pictures.hpp>

#include <algorithm>

namespace maupertuis::app {
namespace {

struct ActionCommand {
  ModelOptions model;
  std::string ends, path;
  std::optional<std::string> from, to, period;  // as written
  bool periodic = false, motion = false;
  std::size_t paths = 8, turns = 0;
  std::string output, plot, plot_paths;
};

/// What was found, to be written and printed.
struct ActionFindings {
  const char* kind = "";
  std::string text;
  Json json;
  Trajectory rows;
  std::vector<TestVariation> variations;
  std::vector<StationaryPath> paths;
};

bool ends_with(const std::string& text, std::string_view end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

void check_usage(const ActionCommand& o, Diagnostics& diagnostics) {
  for (const auto& [name, value] : {std::pair("--from", &o.from), std::pair("--to", &o.to), std::pair("--period", &o.period)})
    if (*value && !parse_time(**value))
      diagnostics.error("E0809", {}, fmt::format("{} \"{}\" is no time.", name, **value), {},
                        "Write a number with a unit of time, such as 3s; a bare number is in SI units of the independent variable.");
  if (o.periodic + o.motion + !o.path.empty() > 1)
    diagnostics.error("E0809", {}, "maup action looks at one thing at a time.", {}, "Give one of --path, --motion and --periodic.");
  if ((o.from || o.to) && o.path.empty())
    diagnostics.error("E0809", {}, "--from and --to belong to --path.", {}, "Give the ends of stationary paths with --ends \"(0) at 0 to (1) at 2\".");
  if (o.paths == 0) diagnostics.error("E0809", {}, "--paths 0 looks for nothing.", {}, "Give a number of paths.");
  for (const std::string* file : {&o.plot, &o.plot_paths})
    if (!file->empty() && !ends_with(*file, ".svg"))
      diagnostics.error("E0810", {}, fmt::format("{} names no format of a picture.", *file), {}, "Take .svg.");
  const bool known = ends_with(o.output, ".csv") || ends_with(o.output, ".npy") || ends_with(o.output, ".json");
  if (!o.output.empty() && !known)
    diagnostics.error("E0810", {}, fmt::format("{} names no format of a table.", o.output), {}, "Take an ending .csv, .npy or .json.");
}

ActionOptions options_of(const ActionCommand& o) { return {o.paths, o.turns, true, &interrupt_flag()}; }

// --------------------------------------------------------------------------------------------------------- a given path

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(' '), last = text.find_last_not_of(' ');
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

/// "x = 4 t + 7, y = atan2(t, 1)" → pieces between commas outside of brackets.
std::vector<std::string> pieces_of(const std::string& text) {
  std::vector<std::string> out(1);
  int depth = 0;
  for (const char c : text) {
    depth += (c == '(') - (c == ')');
    if (c == ',' && depth == 0) out.emplace_back();
    else out.back() += c;
  }
  return out;
}

/// The formulas in the order of the coordinates: "(4 t + 7, 3 t + 5)".
std::optional<std::string> formulas_of(const std::string& text, const MechanicalSystem& system, Diagnostics& diagnostics) {
  std::vector<std::string> formulas(system.coordinates.size());
  std::string wrong;
  for (const std::string& piece : pieces_of(text)) {
    const auto equals = piece.find('=');
    const std::string name = trimmed(piece.substr(0, equals));
    const auto found = std::find_if(system.coordinates.begin(), system.coordinates.end(), [&](const Coordinate& c) { return c.name == name; });
    if (equals == std::string::npos || found == system.coordinates.end()) wrong = piece;
    else formulas[static_cast<std::size_t>(found - system.coordinates.begin())] = trimmed(piece.substr(equals + 1));
  }
  std::string out, names;
  for (std::size_t i = 0; i < formulas.size(); ++i) {
    names += fmt::format("{}{} = …", i ? ", " : "", system.coordinates[i].name);
    out += (i ? ", " : "") + formulas[i];
    if (formulas[i].empty() && wrong.empty()) wrong = text;
  }
  if (wrong.empty()) return "(" + out + ")";
  diagnostics.error("E0809", {}, fmt::format("--path \"{}\": \"{}\" gives no path.", text, trimmed(wrong)), {},
                    fmt::format("Write a formula for each coordinate: \"{}\".", names));
  return std::nullopt;
}

/// A path is read as the expectation of a model of its own, so that it may hold whatever a formula may.
std::unique_ptr<Study> study_of_path(const ActionCommand& o, Study& as_written) {
  const auto formulas = formulas_of(o.path, as_written.model()->system, as_written.diagnostics());
  if (!formulas) return nullptr;
  const std::string& independent = as_written.model()->system.independent;
  std::string statement = "expect action of " + *formulas;
  if (o.from && o.to) statement += fmt::format(" from {} to {}", *o.from, *o.to);
  else if (!as_written.model()->experiment.path) {
    as_written.diagnostics().error("E0809", {}, "--path needs to know from where to where.", {},
                                   fmt::format("Give --from and --to, the ends of {}, or `path from …` in the model.", independent));
    return nullptr;
  }
  return std::make_unique<Study>(SourceText(as_written.source().name() + " with --path", std::string(as_written.source().text()) + "\n" + statement + " = 0 rel 1\n"),
                                 o.model.overrides);
}

std::optional<ActionFindings> find_given(const ActionCommand& o, Study& study) {
  const Model& model = *study.model();
  const Expectation& e = model.experiment.expectations.back();
  const auto number = [&](Expr x) { return evaluate(in_terms_of_motion(model.system, {&x, 1}).front(), parameter_bindings(model.system)); };
  std::optional<ActionEnds> ends;
  if (model.experiment.path && !e.from) ends = ends_of(model);
  const double start = e.from ? number(e.from) : ends->start, end = e.to ? number(e.to) : ends->end;
  auto found = action_of_path(model, *study.equations(), e.values, start, end, ends, options_of(o), study.diagnostics());
  if (!found) return std::nullopt;
  ActionFindings out{"given", action_text(*found, model.system), action_json(*found, model.system), path_rows({&found->path}, model.system), found->variations, {}};
  out.paths.emplace_back();
  out.paths.back().path = found->path;
  return out;
}

// ------------------------------------------------------------------------------------------------------- the other ways

std::optional<ActionFindings> find_motion(const ActionCommand& o, Study& study) {
  const auto found = action_of_motion(*study.model(), *study.equations(), options_of(o), study.diagnostics());
  if (!found) return std::nullopt;
  const MechanicalSystem& system = study.model()->system;
  return ActionFindings{"motion", action_text(*found, system), action_json(*found, system), found->rows, found->path.second.variations, {found->path}};
}

std::optional<ActionFindings> find_orbit(const ActionCommand& o, Study& study) {
  const auto period = o.period ? parse_time(*o.period) : std::nullopt;
  const auto found = action_of_orbit(*study.model(), *study.equations(), period, options_of(o), study.diagnostics());
  if (!found) return std::nullopt;
  const MechanicalSystem& system = study.model()->system;
  return ActionFindings{"periodic", action_text(*found, system), action_json(*found, system), path_rows({&found->path.path}, system), found->path.second.variations, {found->path}};
}

std::optional<ActionFindings> find_paths(const ActionCommand& o, Study& study) {
  const Model& model = *study.model();
  const auto found = stationary_paths(model, *study.equations(), ends_of(model), options_of(o), study.diagnostics());
  if (!found) return std::nullopt;
  std::vector<const ActionPath*> paths;
  for (const StationaryPath& p : found->paths) paths.push_back(&p.path);
  return ActionFindings{"stationary", action_text(*found, model.system), action_json(*found, model.system), path_rows(paths, model.system),
                        found->paths.front().second.variations, found->paths};
}

void write_files(const ActionCommand& o, const ActionFindings& found, Study& study) {
  const MechanicalSystem& system = study.model()->system;
  if (!o.output.empty())
    if (const std::string failure = write_trajectory(found.rows, o.output); !failure.empty()) cannot_write(failure, study.diagnostics());
  const std::string title = system.title.empty() ? system.name : system.title;
  if (!o.plot.empty()) {
    Diagram d = neighbours_diagram(system, found.variations);
    d.title = title + ": S of neighbours";
    write_result(o.plot, diagram_svg(d), study.diagnostics());
  }
  if (o.plot_paths.empty()) return;
  std::vector<const StationaryPath*> paths;
  for (const StationaryPath& p : found.paths) paths.push_back(&p);
  Diagram d = paths_diagram(system, paths);
  d.title = title;
  write_result(o.plot_paths, diagram_svg(d), study.diagnostics());
}

ExitCode study_action(const ActionCommand& o, Console& console) {
  Study as_written(o.model.path, o.model.overrides);
  const bool readable_model = !as_written.wrong();
  check_usage(o, as_written.diagnostics());
  if (readable_model && as_written.wrong()) return finish(console, as_written, json_document("action")), ExitCode::Usage;
  if (!o.ends.empty()) as_written.replace_path("path from " + o.ends);
  if (!as_written.certificate()) return finish(console, as_written, json_document("action"));
  const auto own = o.path.empty() ? nullptr : study_of_path(o, as_written);
  if (as_written.wrong()) return finish(console, as_written, json_document("action")), ExitCode::Usage;
  Study& study = own ? *own : as_written;
  if (!study.equations()) return finish(console, study, json_document("action"));

  const auto found = own                                ? find_given(o, study)
                     : o.periodic                       ? find_orbit(o, study)
                     : !o.motion && study.model()->experiment.path ? find_paths(o, study)
                                                        : find_motion(o, study);
  if (!found) {
    const ExitCode code = finish(console, study, json_document("action"));
    if (interrupt_flag().load()) return ExitCode::Interrupted;
    return code == ExitCode::ModelWrong ? ExitCode::RunFailed : code;
  }
  write_files(o, *found, study);
  if (!console.json()) console.print(found->text);
  Json document = json_document("action");
  document["system"] = study.model()->system.name;
  document[found->kind] = found->json;
  const bool written = !study.wrong();
  finish(console, study, document);
  return written ? ExitCode::Fine : ExitCode::RunFailed;
}

}  // namespace

void add_action(CommandLine& line) {
  const auto options = std::make_shared<ActionCommand>();
  CLI::App& command = line.add("action", "Stationary paths, the action along them, conjugate points, Morse index",
                               "  maup action oscillator.lag --ends \"(0.4 m) at 0 to (-1.1 m) at 2 s\"\n"
                               "  maup action particle.lag --path \"x = 4 t + 7, y = 3 t + 5\" --from 0s --to 10s\n"
                               "  maup action pendulum.lag --motion --plot neighbours.svg\n",
                               [options](Console& console) { return study_action(*options, console); });
  add_model_options(command, options->model);
  command.add_option("--ends", options->ends, "Ends of the path instead of the model's: \"(0, 1) at 0 to (2, free) at 1\"")->type_name("ENDS");
  command.add_option("--paths", options->paths, "At most so many stationary paths (default: 8)")->type_name("N");
  command.add_option("--turns", options->turns, "Angles may end up to so many whole turns further, too (default: 0)")->type_name("N");
  command.add_option("--path", options->path, "S along formulas: \"x = 4 t + 7, y = 3 t + 5\"")->type_name("FORMULAS");
  command.add_option("--from", options->from, "Where the formulas begin (default: as the model's path)")->type_name("TIME");
  command.add_option("--to", options->to, "Where they end")->type_name("TIME");
  command.add_flag("--motion", options->motion, "Along the model's own motion: what happens without a path in the model");
  command.add_flag("--periodic", options->periodic, "The periodic motion next to the model's start, as a closed path");
  command.add_option("--period", options->period, "Of it, or near it")->type_name("TIME");
  command.add_option("--plot", options->plot, "S of neighbouring paths: .svg")->type_name("FILE");
  command.add_option("--plot-paths", options->plot_paths, "The paths: .svg")->type_name("FILE");
  command.add_option("-o,--output", options->output, "The paths: .csv, .npy or .json")->type_name("FILE");
}

}  // namespace maupertuis::app
