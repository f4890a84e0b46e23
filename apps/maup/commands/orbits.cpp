#include "interrupt.hpp"
#include "orbits_options.hpp"
#include "orbits_text.hpp"
#include "outcome.hpp"
#include "output_files.hpp"
#include "quantity.hpp"
#include "time_options.hpp"

#include <fmt/format.h>

#include <maupertuis/report.hpp>

namespace maupertuis::app {
namespace {

struct Options {
  ModelOptions model;
  OrbitsOptions orbits;
  std::optional<std::string> duration;
  std::string output, plot;
};

/// What is left to write and to print once an analysis is done.
struct Findings {
  Answer answer;
  Trajectory rows;
  PlotOptions picture;
};

void check_orbits_usage(const Options& o, const syntax::SyntaxTree* tree, Diagnostics& diagnostics) {
  check_orbits_options(o.orbits, tree, diagnostics);
  check_time_option("--duration", o.duration, tree, diagnostics);
  if (o.orbits.floquet + o.orbits.lyapunov + o.orbits.has_section() != 1)
    diagnostics.error("E0809", {}, "maup orbits does one thing at a time.", {},
                      "Give --floquet, --section \"x = 0 rising\", --strobe 2s or --lyapunov.");
  check_output_files({{"-o", o.output, FileKind::Table}, {"--plot", o.plot, FileKind::Picture}}, o.model.path,
                     diagnostics);
  if (o.orbits.floquet && (!o.plot.empty() || !o.output.empty()))
    diagnostics.error("E0809", {}, "--floquet has no table and no picture.", {},
                      "Leave --plot and -o out, or take --json.");
}

std::optional<Findings> find_floquet(const Options& o, Study& study) {
  const auto result = floquet(*study.model(), *study.equations(), floquet_options(o.orbits), study.diagnostics());
  if (!result) return {};
  const MechanicalSystem& system = study.model()->system;
  return Findings{{"floquet", floquet_text(*result, system), floquet_json(*result, system)}, {}, {}};
}

std::optional<Findings> find_section(const Options& o, Study& study, const Console& console) {
  const auto result =
      poincare_section(*study.model(), *study.equations(), section_options(o.orbits, study), study.diagnostics());
  if (!result) return {};
  const Saving saving;  // of crossings there may be very many
  const MechanicalSystem& system = study.model()->system;
  const std::string what = section_text(o.orbits);
  return Findings{
      {"section", section_text(*result, what, system), console.json() ? section_json(*result, what, system) : Json()},
      section_rows(*result, system),
      section_picture(*result, what, system)};
}

std::optional<Findings> find_lyapunov(const Options& o, Study& study) {
  LyapunovOptions options = lyapunov_options(o.orbits);
  if (o.duration) options.duration = parse_time(*o.duration);
  const auto result = lyapunov_exponents(*study.model(), *study.equations(), options, study.diagnostics());
  if (!result) return {};
  const MechanicalSystem& system = study.model()->system;
  Findings out{{"lyapunov", lyapunov_text(*result), lyapunov_json(*result)}, lyapunov_rows(*result, system), {}};
  out.picture.title = picture_title(system, "Lyapunov exponents, averages up to t");
  return out;
}

ExitCode study_orbits(const Options& o, Console& console) {
  Study study = open_study(o.model);
  const bool readable_model = !study.wrong();
  check_orbits_usage(o, study.tree(), study.diagnostics());
  if (readable_model && study.wrong()) return finish_usage(console, study, "orbits");
  put_in_section(o.orbits, study);
  if (study.refuse_held_integrals() || study.refuse_without_time() || !study.certificate())
    return finish(console, study, json_document("orbits"));
  const auto found = o.orbits.has_section() ? find_section(o, study, console)
                     : o.orbits.floquet     ? find_floquet(o, study)
                                            : find_lyapunov(o, study);
  if (!found) return finish_without(console, study, "orbits");
  write_rows(o.output, found->rows, study.diagnostics());
  if (!o.plot.empty()) write_picture(o.plot, plot_svg(found->rows, found->picture), study.diagnostics());
  return finish_with(console, study, "orbits", found->answer);
}

}  // namespace

void add_orbits(CommandLine& line) {
  const auto options = std::make_shared<Options>();
  Command& command =
      line.add("orbits", "Periodic motions with their Floquet multipliers, Poincaré sections, Lyapunov exponents",
               "  maup orbits pendulum.lag --floquet\n"
               "  maup orbits henon_heiles.lag --section \"x = 0 rising\" --starts 24 --plot section.svg\n"
               "  maup orbits double_pendulum.lag --lyapunov --duration 500s --plot exponents.svg\n",
               [options](Console& console) { return study_orbits(*options, console); });
  add_model_options(command, options->model);
  add_orbits_options(command, options->orbits);
  command.add_option("--duration", options->duration, "How long to average exponents (default: the model's run)")
      ->type_name("TIME");
  command.add_option("-o,--output", options->output, "The points, or the averages: .csv, .npy or .json")
      ->type_name("FILE");
  command.add_option("--plot", options->plot, "Their picture: .svg, .png or .pdf")->type_name("FILE");
}

}  // namespace maupertuis::app
