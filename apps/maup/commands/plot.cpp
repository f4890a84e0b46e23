#include "numbers.hpp"
#include "outcome.hpp"
#include "output_files.hpp"
#include "run_options.hpp"

#include <fmt/format.h>

#include <maupertuis/plot.hpp>

namespace maupertuis::app {
namespace {

struct PlotCommandOptions {
  ModelOptions model;
  RunOptions run;
  PlotOptions picture;
  std::string output = "-";
};

ExitCode plot_model(const PlotCommandOptions& options, Console& console) {
  Study study(options.model.path, options.model.overrides);
  Json document = json_document("plot");
  document["file"] = options.output;
  const bool readable_model = !study.wrong();
  SimulationOptions settings = simulation_options(options.run, study.diagnostics(), study.tree());
  if (settings.errors != ErrorEstimates::None) settings.errors = ErrorEstimates::Rows;
  if (options.output != "-") check_output_files({{"-o", options.output, FileKind::Picture}}, options.model.path, study.diagnostics());
  if (readable_model && study.wrong()) {
    finish(console, study, document);
    return ExitCode::Usage;
  }
  put_in_run(options.run, study);
  const auto result = run_model(study, settings, console);
  if (!result) return finish(console, study, document);

  PlotOptions picture = options.picture;
  if (picture.title.empty()) picture.title = study.model()->system.title;
  const std::string problem = plot_problem(result->trajectory, picture);
  if (!problem.empty()) {
    study.diagnostics().error("E0811", {}, problem);
    finish(console, study, document);
    return ExitCode::Usage;
  }
  check_numbers(result->trajectory, study.diagnostics());
  const std::string svg = plot_svg(result->trajectory, picture);
  if (options.output != "-") write_picture(options.output, svg, study.diagnostics());
  else if (console.json()) document["svg"] = svg;
  else console.print(svg);
  const bool written = !study.wrong();
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
  command.add_option("-o,--output", options->output, "The picture (default: standard output)")->type_name("FILE.svg|png|pdf");
  command.add_option("--y", picture.columns, "What to draw, e.g. θ,\"θ'\" (default: everything)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("NAME,...");
  command.add_option("--x", picture.against, "Against what (default: time); a column gives a phase portrait")
      ->type_name("NAME");
  command.add_option("--title", picture.title, "Title (default: that of the system)");
  command.add_flag("--degrees", picture.degrees, "Angles in degrees");
  command.add_flag_callback("--dark", [&picture] { picture.theme = PlotTheme::Dark; }, "Light on dark");
}

}  // namespace maupertuis::app
