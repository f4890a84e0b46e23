#include "columns.hpp"
#include "field_views.hpp"
#include "fields_text.hpp"
#include "numbers.hpp"
#include "outcome.hpp"
#include "output_files.hpp"
#include "quantity.hpp"
#include "run_options.hpp"

#include <fmt/format.h>

#include <maupertuis/motion_pictures.hpp>
#include <maupertuis/plot.hpp>

#include <cmath>

namespace maupertuis::app {
namespace {

struct PlotCommandOptions {
  ModelOptions model;
  RunOptions run;
  PlotOptions picture;
  std::vector<std::string> y, x;  // lists of columns, as written
  std::string output = "-";
  bool map = false, curves = false;  // of fields: one of both alone
};

ExitCode write_svg(const PlotCommandOptions& options, const std::string& svg, Study& study, Json& document,
                   Console& console) {
  if (options.output != "-")
    write_picture(options.output, svg, study.diagnostics());
  else if (console.json())
    document["svg"] = svg;
  else
    console.print(svg);
  return study.wrong() ? ExitCode::RunFailed : ExitCode::Fine;
}

/// What a model without a run has to show: the equilibrium of its fields; nothing where it is φ = 0, or there is none.
std::optional<FieldEquilibrium> rest_to_draw(const PlotCommandOptions& options, Study& study,
                                             const FieldEquations& equations) {
  if (study.model()->experiment.duration || options.run.duration.has_value()) return std::nullopt;
  Diagnostics unheard;
  return field_modes(equations, 1, unheard).equilibrium;
}

/// u(x) at moments, the space-time map, the plane at moments.
ExitCode plot_fields(const PlotCommandOptions& options, Study& study, Console& console) {
  Json document = json_document("plot");
  document["file"] = options.output;
  refuse_options_of_motions(options.run, {{"--x", !options.x.empty()}, {"--at", !options.run.at.empty()}},
                            study.diagnostics());
  if (options.map && options.curves)
    study.diagnostics().error("E0809", {}, "--map and --curves exclude each other.", {},
                              "Both stand in one picture where neither is given.");
  const SimulationOptions settings = simulation_options(options.run, study.diagnostics(), study.tree());
  if (options.output != "-")
    check_output_files({{"-o", options.output, FileKind::Picture}}, options.model.path, study.diagnostics());
  if (study.wrong()) return finish_usage(console, study, "plot");
  const FieldEquations* equations = study.field_equations();
  if (!equations) return finish(console, study, document);
  if (study.model()->fields->system.space.size() > 1 && (options.map || options.curves))
    study.diagnostics().error("E0809", {}, "--map and --curves are for fields of one space variable.",
                              "In the plane u(x, y) is drawn at moments.", "Leave them out.");
  if (study.wrong()) return finish_usage(console, study, "plot");
  FieldPictureOptions like;
  like.curves = !options.map, like.map = !options.curves;
  like.degrees = options.picture.degrees, like.theme = options.picture.theme, like.title = options.picture.title;
  const auto pictures = field_pictures_of(study, *equations, options.y, like);
  if (study.wrong()) return finish_usage(console, study, "plot");
  if (const auto rest = rest_to_draw(options, study, *equations)) {
    const ExitCode written =
        write_svg(options, pictures_of_rest(*equations, *rest, pictures), study, document, console);
    finish(console, study, document);
    return written;
  }
  const auto run = run_model(study, settings, FieldMotionOptions{true, true}, console);
  if (!run || !has_pictures(*run, study.diagnostics())) return finish(console, study, document);
  const ExitCode written =
      write_svg(options, pictures_of_fields(study, *equations, *run, pictures), study, document, console);
  finish(console, study, document);
  return written;
}

ExitCode plot_model(const PlotCommandOptions& options, Console& console) {
  Study study = open_study(options.model);
  Json document = json_document("plot");
  document["file"] = options.output;
  if (declares_fields(study.tree())) return plot_fields(options, study, console);
  const bool readable_model = !study.wrong();
  for (const auto& [name, given] : {std::pair{"--map", options.map}, {"--curves", options.curves}})
    if (given)
      study.diagnostics().error("E0809", {}, fmt::format("{} is for fields, and the model has none.", name),
                                "It chooses between u(x) at moments and the space-time map.", "Leave it out.");
  const AskedColumns y("--y", options.y, study), x("--x", options.x, study);
  if (x.names().size() > 1)
    study.diagnostics().error("E0809", {}, fmt::format("--x names {} columns.", x.names().size()),
                              "All curves of a picture share what goes across.", "Give one column or formula.");
  SimulationOptions settings = simulation_options(options.run, study.diagnostics(), study.tree());
  if (settings.errors != ErrorEstimates::None) settings.errors = ErrorEstimates::Rows;
  settings.rows_of_steps = true;
  if (options.output != "-")
    check_output_files({{"-o", options.output, FileKind::Picture}}, options.model.path, study.diagnostics());
  if (readable_model && study.wrong()) {
    finish(console, study, document);
    return ExitCode::Usage;
  }
  put_in_run(options.run, study);
  auto result = run_model(study, settings, console);
  if (!result) return finish(console, study, document);
  for (const AskedColumns* asked : {&y, &x}) {
    auto rows = asked->added_to(std::move(result->trajectory), study);
    if (!rows) return finish_usage(console, study, "plot");
    result->trajectory = std::move(*rows);
  }

  PlotOptions picture = options.picture;
  picture.columns = y.names();
  if (!x.empty() && x.names().front() != result->trajectory.independent.name) picture.against = x.names().front();
  if (picture.title.empty()) picture.title = study.model()->system.title;
  const std::string problem = plot_problem(result->trajectory, picture);
  if (!problem.empty()) {
    study.diagnostics().error("E0811", {}, problem);
    finish(console, study, document);
    return ExitCode::Usage;
  }
  if (result->ending == Ending::Interrupted) {
    const std::string moment = study.model()->system.moment(brief(result->final.t));
    picture.title += (picture.title.empty() ? "" : ", ") + fmt::format("interrupted at {}", moment);
    console.leaves(
        fmt::format("{} shows the motion up to {}.", options.output == "-" ? "the picture" : options.output, moment));
  }
  WrittenColumns formulas = y.formulas(study);
  formulas.merge(x.formulas(study));
  check_picture(result->trajectory, study.diagnostics(), formulas);
  show_happenings(picture, *result, study.model()->system);
  const std::string svg = plot_svg(result->trajectory, picture);
  const bool written = write_svg(options, svg, study, document, console) == ExitCode::Fine;
  if (!result->ok()) console.say(fmt::format("The run ended early: {}\n", result->reason));
  finish(console, study, document);
  return written ? exit_code(result->ending) : ExitCode::RunFailed;
}

}  // namespace

void add_plot(CommandLine& line) {
  const auto options = std::make_shared<PlotCommandOptions>();
  Command& command = line.add("plot", "The motion as a picture: SVG, PNG or PDF",
                              "  maup plot pendulum.lag -o pendulum.svg\n"
                              "  maup plot pendulum.lag --y θ --degrees -o angle.pdf\n"
                              "  maup plot pendulum.lag --x θ --y \"θ'\" -o phase.svg\n",
                              [options](Console& console) { return plot_model(*options, console); });
  add_model_options(command, options->model);
  add_span_options(command, options->run);
  add_method_options(command, options->run);
  add_errors_option(command, options->run);
  PlotOptions& picture = options->picture;
  command.add_option("-o,--output", options->output, "The picture (default: standard output)")
      ->type_name("FILE.svg|png|pdf");
  command
      .add_option("--y", options->y,
                  "What to draw: columns and formulas, e.g. \"θ, θ1 - θ2, 1/2 m l^2 θ'^2\" (default: every column)")
      ->allow_extra_args(false)
      ->type_name("FORMULA,...");
  command.add_option("--x", options->x, "Against what (default: time); a column or formula gives a phase portrait")
      ->allow_extra_args(false)
      ->type_name("FORMULA");
  command.add_option("--title", picture.title, "Title (default: that of the system)");
  command.add_flag("--degrees", picture.degrees, "Angles in degrees");
  command.add_flag("--map", options->map, "Of fields: the space-time map alone");
  command.add_flag("--curves", options->curves, "Of fields: u(x) at moments alone");
  command.add_flag_callback(
      "--dark", [&picture] { picture.theme = PlotTheme::Dark; }, "Light on dark");
}

}  // namespace maupertuis::app
