#include "action_text.hpp"
#include "command.hpp"
#include "interrupt.hpp"
#include "outcome.hpp"
#include "output_files.hpp"
#include "quantity.hpp"

#include <fmt/format.h>

#include <maupertuis/action_pictures.hpp>
#include <maupertuis/report.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace maupertuis::app {
namespace {

struct ActionCommand {
  ModelOptions model;
  std::string ends, path;
  std::optional<std::string> from, to, period;  // as written
  bool periodic = false, motion = false;
  std::optional<std::int64_t> paths, turns;
  std::string output, plot, plot_paths;
};

/// What was found, to be written and printed.
struct ActionFindings {
  Answer answer;
  Trajectory rows;
  std::vector<TestVariation> variations;
  std::vector<StationaryPath> paths;
};

void check_counts(const ActionCommand& o, Diagnostics& diagnostics) {
  constexpr std::int64_t most_paths = 1000, most_turns = 100;
  if (o.paths && (*o.paths < 1 || *o.paths > most_paths))
    diagnostics.error("E0809", {}, fmt::format("--paths {} is no number of paths to look for.", *o.paths), {},
                      fmt::format("Write a whole number from 1 to {}.", most_paths));
  if (o.turns && (*o.turns < 0 || *o.turns > most_turns))
    diagnostics.error("E0809", {}, fmt::format("--turns {} is no number of turns.", *o.turns),
                      "Each angle is tried with up to so many whole turns more and less, each a search of its own.",
                      fmt::format("Write a whole number from 0 to {}.", most_turns));
}

/// What an option belongs to, where that was not asked for.
void check_belonging(const ActionCommand& o, Diagnostics& diagnostics) {
  const auto belongs = [&](bool given, bool fits, const char* option, const char* to, const char* help) {
    if (given && !fits) diagnostics.error("E0809", {}, fmt::format("{} belongs to {}.", option, to), {}, help);
  };
  const bool between_ends = o.path.empty() && !o.motion && !o.periodic;
  const char* const search = "the search for paths between two ends";
  belongs(o.paths.has_value(), between_ends, "--paths", search, "Leave it out: here there is one path.");
  belongs(o.turns.has_value(), between_ends, "--turns", search, "Leave it out: here the path says where angles end.");
  belongs(!o.ends.empty(), !o.motion && !o.periodic, "--ends", "paths between two ends, or along --path",
          "Leave it out: a motion ends where it gets.");
  belongs(o.period.has_value(), o.periodic, "--period", "--periodic", "Add --periodic, or leave --period out.");
  for (const auto& [name, given] : {std::pair("--from", o.from.has_value()), std::pair("--to", o.to.has_value())})
    belongs(given, !o.path.empty(), name, "--path",
            "Give the ends of stationary paths with --ends \"(0) at 0 to (1) at 2\".");
  if (!o.path.empty() && o.from.has_value() != o.to.has_value())
    diagnostics.error("E0809", {},
                      fmt::format("{} needs {} beside it.", o.from ? "--from" : "--to", o.from ? "--to" : "--from"), {},
                      "Give both ends of --path, or neither: then they are those of the model's path.");
}

void check_action_usage(const ActionCommand& o, Diagnostics& diagnostics) {
  if (o.period && !parse_time(*o.period))
    diagnostics.error("E0809", {}, fmt::format("--period \"{}\" is no time.", *o.period), {},
                      "Write a number with a unit of time, such as 3s; a bare number is in seconds.");
  if (o.periodic + o.motion + !o.path.empty() > 1)
    diagnostics.error("E0809", {}, "maup action looks at one thing at a time.", {},
                      "Give one of --path, --motion and --periodic.");
  else
    check_belonging(o, diagnostics);
  check_counts(o, diagnostics);
  check_output_files({{"-o", o.output, FileKind::Table},
                      {"--plot", o.plot, FileKind::Picture},
                      {"--plot-paths", o.plot_paths, FileKind::Picture}},
                     o.model.path, diagnostics);
}

/// Without ends in the model or on the command line it is the motion that is looked at.
void check_search(const ActionCommand& o, Study& study) {
  if (study.model()->experiment.path) return;
  for (const auto& [name, given] :
       {std::pair("--paths", o.paths.has_value()), std::pair("--turns", o.turns.has_value())})
    if (given)
      study.diagnostics().error(
          "E0809", {}, fmt::format("{} belongs to the search for paths between two ends, and there are none.", name),
          {}, "Write `path from (…) at 0 to (…) at 1` into the model, or give --ends.");
}

ActionOptions options_of(const ActionCommand& o) {
  ActionOptions out;
  if (o.paths) out.paths = static_cast<std::size_t>(*o.paths);
  if (o.turns) out.turns = static_cast<std::size_t>(*o.turns);
  out.interrupt = &interrupt_flag();
  return out;
}

// --------------------------------------------------------------------------------------------------------- a given
// path

/// Says the formulas of --path and their ends beside the model.
void put_in_path(const ActionCommand& o, Study& study) {
  if (!o.ends.empty()) study.override_with(OverrideKind::Path, "--ends", o.ends);
  if (o.path.empty()) return;
  study.override_with(OverrideKind::GivenPath, "--path", o.path);
  if (o.from) study.override_with(OverrideKind::GivenFrom, "--from", *o.from);
  if (o.to) study.override_with(OverrideKind::GivenTo, "--to", *o.to);
}

/// Formulas have no ends of their own.
void check_ends(const ActionCommand& o, Study& study) {
  const syntax::SyntaxTree* tree = study.tree();
  if (o.path.empty() || o.from || !o.ends.empty() || !tree) return;
  for (const syntax::Statement& s : tree->statements)
    if (std::holds_alternative<syntax::PathStatement>(s.body)) return;
  study.diagnostics().error(
      "E0809", {}, "--path needs to know from where to where.", {},
      "Give --from and --to, the ends of the independent variable, or `path from …` in the model.");
}

std::optional<ActionFindings> find_given(const ActionCommand& o, Study& study) {
  const Model& model = *study.model();
  const PathFormulas& given = *model.experiment.given_path;
  const auto number = [&](Expr x) {
    return evaluate(in_terms_of_motion(model.system, {&x, 1}).front(), parameter_bindings(model.system));
  };
  std::optional<ActionEnds> ends;
  if (model.experiment.path && !given.from) ends = ends_of(model);
  const double start = given.from ? number(given.from) : ends->start, end = given.to ? number(given.to) : ends->end;
  auto found = action_of_path(model, *study.equations(), given.q, start, end, ends, options_of(o), study.diagnostics());
  if (!found) return std::nullopt;
  ActionFindings out{{"given", action_text(*found, model.system), action_json(*found, model.system)},
                     path_rows({&found->path}, model.system),
                     found->variations,
                     {}};
  out.paths.emplace_back();
  out.paths.back().path = found->path;
  return out;
}

// ------------------------------------------------------------------------------------------------------- the other
// ways

std::optional<ActionFindings> find_motion(const ActionCommand& o, Study& study) {
  const auto found = action_of_motion(*study.model(), *study.equations(), options_of(o), study.diagnostics());
  if (!found) return std::nullopt;
  const MechanicalSystem& system = study.model()->system;
  return ActionFindings{{"motion", action_text(*found, system), action_json(*found, system)},
                        found->rows,
                        found->path.second.variations,
                        {found->path}};
}

std::optional<ActionFindings> find_orbit(const ActionCommand& o, Study& study) {
  const auto period = o.period ? parse_time(*o.period) : std::nullopt;
  const auto found = action_of_orbit(*study.model(), *study.equations(), period, options_of(o), study.diagnostics());
  if (!found) return std::nullopt;
  const MechanicalSystem& system = study.model()->system;
  return ActionFindings{{"periodic", action_text(*found, system), action_json(*found, system)},
                        path_rows({&found->path.path}, system),
                        found->path.second.variations,
                        {found->path}};
}

std::optional<ActionFindings> find_paths(const ActionCommand& o, Study& study) {
  const Model& model = *study.model();
  const auto found = stationary_paths(model, *study.equations(), ends_of(model), options_of(o), study.diagnostics());
  if (!found) return std::nullopt;
  std::vector<const ActionPath*> paths;
  for (const StationaryPath& p : found->paths) paths.push_back(&p.path);
  return ActionFindings{{"stationary", action_text(*found, model.system), action_json(*found, model.system)},
                        path_rows(paths, model.system),
                        found->paths.front().second.variations,
                        found->paths};
}

/// The columns of rates that have no value at an end where L is infinite: the text says so as well.
std::vector<std::string> infinite_rates(const std::vector<StationaryPath>& paths, const MechanicalSystem& system) {
  std::vector<std::string> out;
  for (const StationaryPath& p : paths)
    for (const auto* momentum : {&p.start_momentum, &p.end_momentum})
      for (std::size_t i = 0; i < momentum->size(); ++i)
        if (!std::isfinite((*momentum)[i])) out.push_back(system.coordinates[i].name + "'");
  return out;
}

void write_files(const ActionCommand& o, const ActionFindings& found, Study& study) {
  const MechanicalSystem& system = study.model()->system;
  write_rows(o.output, found.rows, study.diagnostics(), infinite_rates(found.paths, system));
  const std::string title = system.title.empty() ? system.name : system.title;
  if (!o.plot.empty()) {
    Diagram d = neighbours_diagram(system, found.variations);
    d.title = picture_title(system, "S of neighbours");
    write_picture(o.plot, diagram_svg(d), study.diagnostics());
  }
  if (o.plot_paths.empty()) return;
  std::vector<const StationaryPath*> paths;
  for (const StationaryPath& p : found.paths) paths.push_back(&p);
  Diagram d = paths_diagram(system, paths);
  d.title = title;
  write_picture(o.plot_paths, diagram_svg(d), study.diagnostics());
}

ExitCode study_action(const ActionCommand& o, Console& console) {
  Study study = open_study(o.model);
  const bool readable_model = !study.wrong();
  check_action_usage(o, study.diagnostics());
  if (readable_model && study.wrong()) return finish_usage(console, study, "action");
  const bool good_text = study.tree() && !study.wrong();
  if (good_text) check_ends(o, study);
  if (good_text && study.wrong()) return finish_usage(console, study, "action");
  put_in_path(o, study);
  const auto along_a_motion = [&] {
    const Experiment& experiment = study.model()->experiment;
    return !experiment.given_path && (o.motion || o.periodic || !experiment.path);
  };
  if (study.refuse_modes() || (study.model() && along_a_motion() && study.refuse_acting_events()) ||
      !study.certificate())
    return finish(console, study, json_document("action"));
  check_search(o, study);
  if (study.wrong()) return finish_usage(console, study, "action");

  const Experiment& experiment = study.model()->experiment;
  const auto found = experiment.given_path          ? find_given(o, study)
                     : o.periodic                   ? find_orbit(o, study)
                     : !o.motion && experiment.path ? find_paths(o, study)
                                                    : find_motion(o, study);
  if (!found) return finish_without(console, study, "action");
  if (!experiment.given_path) study.tell_events_left_out();
  write_files(o, *found, study);
  return finish_with(console, study, "action", found->answer);
}

}  // namespace

void add_action(CommandLine& line) {
  const auto options = std::make_shared<ActionCommand>();
  Command& command = line.add("action", "Stationary paths, the action along them, conjugate points, Morse index",
                              "  maup action oscillator.lag --ends \"(0.4 m) at 0 to (-1.1 m) at 2 s\"\n"
                              "  maup action particle.lag --path \"x = 4 t + 7, y = 3 t + 5\" --from 0s --to 10s\n"
                              "  maup action pendulum.lag --motion --plot neighbours.svg\n",
                              [options](Console& console) { return study_action(*options, console); });
  add_model_options(command, options->model);
  command
      .add_option("--ends", options->ends, "Ends of the path instead of the model's: \"(0, 1) at 0 to (2, free) at 1\"")
      ->type_name("ENDS");
  command.add_option("--paths", options->paths, "At most so many stationary paths (default: 8)")->type_name("N");
  command.add_option("--turns", options->turns, "Angles may end up to so many whole turns further, too (default: 0)")
      ->type_name("N");
  command.add_option("--path", options->path, "S along formulas: \"x = 4 t + 7, y = 3 t + 5\"")->type_name("FORMULAS");
  command.add_option("--from", options->from, "Where the formulas begin (default: as the model's path)")
      ->type_name("TIME");
  command.add_option("--to", options->to, "Where they end")->type_name("TIME");
  command.add_flag("--motion", options->motion,
                   "Along the model's own motion: what happens without a path in the model");
  command.add_flag("--periodic", options->periodic, "The periodic motion next to the model's start, as a closed path");
  command.add_option("--period", options->period, "Of it, or near it")->type_name("TIME");
  command.add_option("--plot", options->plot, "S of neighbouring paths: .svg, .png or .pdf")->type_name("FILE");
  command.add_option("--plot-paths", options->plot_paths, "The paths: .svg, .png or .pdf")->type_name("FILE");
  command.add_option("-o,--output", options->output, "The paths: .csv, .npy or .json")->type_name("FILE");
}

}  // namespace maupertuis::app
