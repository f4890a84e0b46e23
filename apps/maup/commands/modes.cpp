#include "field_modes_text.hpp"
#include "fields_text.hpp"
#include "interrupt.hpp"
#include "modes_text.hpp"
#include "orbits_text.hpp"
#include "outcome.hpp"
#include "output_files.hpp"
#include "quantity.hpp"
#include "run_options.hpp"

#include <fmt/format.h>

#include <maupertuis/degenerate.hpp>
#include <maupertuis/mode_pictures.hpp>
#include <maupertuis/modes.hpp>
#include <maupertuis/orbits.hpp>
#include <maupertuis/regulator.hpp>
#include <maupertuis/symbolic_linearization.hpp>

#include <cmath>
#include <cstdlib>
#include <limits>

namespace maupertuis::app {
namespace {

struct ModesOptions {
  ModelOptions model;
  std::string at;
  bool all = false, dispersion = false;
  std::string q, r;  // weights, as written
  std::string sweep, plot, roots, csv;
  std::vector<std::string> outputs;  // what is measured, as written
  std::optional<std::string> orbit;  // about the periodic motion near the start: its period, or empty
  /// What needs one set of equations.
  bool asks_of_one_point() const { return !orbit && (locus() || !(at.empty() && q.empty() && outputs.empty())); }
  bool locus() const { return !sweep.empty() || !plot.empty() || !roots.empty() || !csv.empty(); }
};

/// The state of the motion at a time, by a run that lands on it.
std::optional<MotionState> state_at(Study& study, double time, const Console& console) {
  SimulationOptions options;
  options.duration = 0.0;
  options.errors = ErrorEstimates::None;
  options.at = {time};
  const auto run = run_model(study, options, console);
  if (!run) return std::nullopt;
  if (run->at.front().q.empty()) {
    study.diagnostics().error("E1305", {}, fmt::format("the motion does not reach t = {} s", brief(time)), run->reason,
                              "Take a time before the run ends.");
    return std::nullopt;
  }
  return MotionState{time, run->at.front().q, run->at.front().v};
}

std::optional<ModalStudy> carry_out(const ModesOptions& options, Study& study, const PointEquations& equations,
                                    const MotionState& start, const Console& console) {
  Diagnostics& diagnostics = study.diagnostics();
  if (const auto time = parse_time(options.at)) {
    const auto state = state_at(study, *time, console);
    return state ? modal_study_of(equations, *state, diagnostics) : std::nullopt;
  }
  return options.at.empty() ? modal_study(equations, start, diagnostics)
                            : modal_study_at(equations, start, study.model()->experiment.at, diagnostics);
}

// ----------------------------------------------------------------------------------------------------------------
// outputs

/// What --y asks for.
ExprVector measured(const Model& model) {
  ExprVector found;
  for (const AskedFormula& y : model.experiment.asked) found.push_back(y.value);
  return found;
}

/// What --y asks for, then what the rates of the model need.
ExprVector measured_and_rates(const Model& model) {
  ExprVector found = measured(model);
  const ExprVector rates = rates_as_outputs(model.system);
  found.insert(found.end(), rates.begin(), rates.end());
  return found;
}

/// The linearization in the rates of the model beside each that was found; measured is what --y asks for again.
void put_in_rates(ModalStudy& found, const Model& model) {
  const std::size_t asked = model.experiment.asked.size();
  for (ModalEntry& entry : found.entries) {
    entry.in_rates = in_rates(entry.linearization, asked, model.system.rates.size());
    keep_first_outputs(entry.linearization, asked);
  }
}

/// Numbers that are none are not shown.
bool check_outputs(const ModesOptions& options, const ModalStudy& found, Study& study) {
  const Model& model = *study.model();
  std::vector<OutputName> names;
  for (std::size_t i = 0; i < options.outputs.size(); ++i)
    names.push_back({options.outputs[i], model.experiment.asked[i].span});
  return check_measured(model.system, found, names, study.diagnostics());
}

// --------------------------------------------------------------------------------------------------------------
// regulator

/// "1, 2, 3" a diagonal, "1, 0; 0, 2" rows, "0.1" a multiple of 1. Nothing, and a message, where it is none of these.
std::optional<RealMatrix> weights(const char* option, const std::string& text, std::size_t size, Study& study) {
  const auto wrong = [&](std::string message, std::size_t begin, std::size_t end) {
    refuse_option(study, option, text, std::move(message), "",
                  "Write a diagonal \"1, 10\", rows \"1, 0; 0, 10\", or one number.",
                  Span{static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)});
    return std::nullopt;
  };
  std::vector<std::vector<double>> rows(1);
  for (const char* at = text.c_str(); *at;) {
    char* end = nullptr;
    const double value = std::strtod(at, &end);
    if (end != at && std::isfinite(value)) {
      rows.back().push_back(value);
      at = end;
    } else if (*at == ';') {
      rows.emplace_back();
      ++at;
    } else if (*at == ',' || *at == ' ') {
      ++at;
    } else {
      const std::size_t begin = static_cast<std::size_t>(at - text.c_str());
      return wrong(fmt::format("{} {}: here stands no number", option, text), begin,
                   std::min(text.find_first_of(" ,;", begin), text.size()));
    }
  }
  RealMatrix out{rows.size(), rows[0].size(), {}};
  if (rows.size() == 1) {
    if (rows[0].size() == 1) rows[0].assign(size, rows[0][0]);
    out = {rows[0].size(), rows[0].size(), std::vector<double>(rows[0].size() * rows[0].size(), 0.0)};
    for (std::size_t i = 0; i < out.rows; ++i) out.entries[i * out.rows + i] = rows[0][i];
    return out;
  }
  for (const auto& row : rows) {
    if (row.size() != out.columns)
      return wrong(fmt::format("{} {}: its rows are of different lengths", option, text), 0, text.size());
    out.entries.insert(out.entries.end(), row.begin(), row.end());
  }
  return out;
}

std::optional<Regulator> regulator_of(const ModesOptions& options, const ModalStudy& found, Study& study) {
  if (found.entries.empty()) {
    study.diagnostics().error("E0809", {}, "--Q has no equilibrium to work about.",
                              "A regulator holds a system at a point, and no point with a linearization was found.",
                              "Give one with --at.");
    return std::nullopt;
  }
  const Linearization& l = found.entries.front().linearization;
  const auto q = weights("--Q", options.q, l.a.rows, study);
  const auto r = weights("--R", options.r.empty() ? "1" : options.r, l.b.columns, study);
  if (!q || !r) return std::nullopt;
  return linear_quadratic_regulator(l, *q, *r, study.diagnostics());
}

// ------------------------------------------------------------------------------------------------------------------
// locus

bool write_locus(const ModesOptions& options, const MechanicalSystem& system, const Locus& locus,
                 Diagnostics& diagnostics) {
  bool good = true;
  if (!options.csv.empty()) good = write_result(options.csv, to_csv(system, locus), diagnostics) && good;
  if (!options.roots.empty()) {
    Diagram d = root_locus(system, locus);
    d.title = system.title;
    good = write_picture(options.roots, diagram_svg(d), diagnostics) && good;
  }
  if (options.plot.empty()) return good;
  std::vector<Diagram> diagrams = bifurcation_diagrams(system, locus, 1);
  if (diagrams.empty()) return good;
  diagrams.front().title = system.title;
  return write_picture(options.plot, diagram_svg(diagrams.front()), diagnostics) && good;
}

ExitCode locus(const ModesOptions& options, Study& study, PointEquations& equations, const MotionState& start,
               Console& console) {
  const auto& sweep = study.model()->experiment.sweep;
  if (!sweep) {
    study.diagnostics().error(
        "E1320", {}, "the model has no sweep", "A locus follows equilibria while one parameter changes.",
        "Write `sweep NAME = FROM .. TO steps N` into the model, or give --sweep \"NAME = FROM .. TO steps N\".");
    return finish(console, study, json_document("modes"));
  }
  const MechanicalSystem& system = study.model()->system;
  const auto value = [&](Expr e) {
    return evaluate(in_terms_of_motion(system, {&e, 1}).front(), parameter_bindings(system));
  };
  const Locus result =
      parameter_locus(equations, start, sweep->parameter, value(sweep->from), value(sweep->to), sweep->steps,
                      driven_neighbours(*study.model(), *study.equations(), sweep->parameter, &interrupt_flag()));
  const bool written = write_locus(options, system, result, study.diagnostics());
  if (!console.json()) console.print(locus_text(system, result));
  const ExitCode code = finish(console, study, locus_document(system, result));
  return written ? code : ExitCode::RunFailed;
}

// ----------------------------------------------------------------------------------------------------------------
// command

ExitCode points(const ModesOptions& options, Study& study, const PointEquations& equations, const MotionState& start,
                Console& console) {
  auto result = carry_out(options, study, equations, start, console);
  std::vector<std::optional<FloquetResult>> neighbours;
  if (result && !parse_time(options.at))
    neighbours = settle_driven(*result, equations, *study.model(), *study.equations(), &interrupt_flag());
  if (result) put_in_rates(*result, *study.model());
  if (!result || !check_outputs(options, *result, study)) return finish(console, study, json_document("modes"));
  const MechanicalSystem& system = study.model()->system;
  constexpr std::size_t usually = 4;
  const std::size_t detailed = options.all ? std::numeric_limits<std::size_t>::max() : usually;
  Json document = modes_document(system, *result);
  for (std::size_t i = 0; i < neighbours.size(); ++i)
    document["points"][i]["floquet"] = neighbours[i] ? floquet_json(*neighbours[i], system) : Json(nullptr);
  std::vector<std::optional<SymbolicLinearization>> formulas;
  for (std::size_t i = 0; i < result->entries.size() && i < detailed; ++i) {
    const bool settled = result->starts > 0 || !options.at.empty();
    formulas.push_back(
        settled && result->entries[i].side.empty()
            ? symbolic_linearization(*study.equations(), result->entries[i].linearization, result->translations)
            : std::nullopt);
    document["points"][i]["formulas"] =
        formulas.back() ? symbolic_json(*formulas.back(), study.equations()->order) : Json(nullptr);
  }
  if (!console.json())
    console.print(modes_text(system, *result, formulas, study.equations()->order, options.outputs, neighbours));
  if (options.q.empty()) return finish(console, study, document);
  const auto regulator = regulator_of(options, *result, study);
  if (regulator) document["regulator"] = regulator_json(*regulator);
  if (regulator && !console.json())
    console.print(regulator_text(system, result->entries.front().linearization, *regulator));
  return finish(console, study, document);
}

/// With contacts and friction: the points of rest of all modes.
ExitCode rest(Study& study, const MotionState& start, Console& console) {
  MechanicalSystem system = study.model()->system;
  for (Friction& f : system.frictions)
    if (f.normal) f.normal = with_reactions(*study.equations(), {&f.normal, 1}).front();
  const RestingModes rests = resting_modes(system, start, study.diagnostics());
  Json document = json_document("modes");
  document["system"] = system.name;
  document["resting"] = Json::array();
  document["sets_of_contacts"] = {{"looked_at", rests.sets_looked_at}, {"all", rests.sets}};
  for (const RestingMode& mode : rests.found) {
    document["resting"].push_back(resting_document(mode));
    if (!console.json()) console.print(resting_text(mode, &mode == &rests.found.front()));
  }
  if (!console.json() && !rests.found.empty() && !rests.all_sets())
    console.print(
        fmt::format("\n{} of {:.6g} sets of closed contacts were looked at: those of the start and of the "
                    "lowest place, all, and the smaller ones. --mode NAME looks at another.\n",
                    rests.sets_looked_at, rests.sets));
  return finish(console, study, document);
}

/// The modes of a periodic motion are those of its monodromy: Floquet multipliers.
ExitCode orbit(const ModesOptions& options, Study& study, Console& console) {
  FloquetOptions wanted{std::nullopt, &interrupt_flag()};
  if (!options.orbit->empty()) wanted.period = parse_time(*options.orbit);
  if (!options.orbit->empty() && !wanted.period) {
    study.diagnostics().error("E0809", {}, fmt::format("--orbit \"{}\" is no time.", *options.orbit), {},
                              "Write its period with a unit of time, such as 3s, or --orbit alone.");
    finish(console, study, json_document("modes"));
    return ExitCode::Usage;
  }
  Json document = json_document("modes");
  const MechanicalSystem& system = study.model()->system;
  document["system"] = system.name;
  const auto result = floquet(*study.model(), *study.equations(), wanted, study.diagnostics());
  if (result) document["floquet"] = floquet_json(*result, system);
  if (result && !console.json()) console.print(floquet_text(*result, system));
  const ExitCode code = finish(console, study, document);
  return result ? code : interrupt_flag().load() ? ExitCode::Interrupted : ExitCode::RunFailed;
}

/// Options that ask for different points exclude each other.
bool check_usage(const ModesOptions& o, Diagnostics& diagnostics) {
  if (o.q.empty() && !o.r.empty()) {
    diagnostics.error("E0809", {}, "--R belongs to --Q.",
                      "The prices of the inputs count beside the weights of the states.",
                      "Give --Q as well, or leave --R out.");
    return false;
  }
  if (!o.orbit && o.locus() && !(o.at.empty() && o.q.empty() && o.outputs.empty())) {
    diagnostics.error(
        "E0809", {}, "A locus (--sweep, --plot, --roots, --csv) has neither --at, --y nor a regulator beside it.",
        "It follows all equilibria along a parameter; these options look at single points.", "Leave one of them out.");
    return false;
  }
  check_output_files(
      {{"--plot", o.plot, FileKind::Picture}, {"--roots", o.roots, FileKind::Picture}, {"--csv", o.csv, FileKind::Csv}},
      o.model.path, diagnostics);
  if (diagnostics.has_errors()) return false;
  if (!o.orbit || (o.at.empty() && !o.locus() && o.q.empty() && o.outputs.empty())) return true;
  diagnostics.error("E0809", {}, "--orbit has neither --at, --sweep, --y nor a regulator beside it.",
                    "The multipliers of a periodic motion belong to the whole orbit, and not to a point.",
                    "Leave one of them out.");
  return false;
}

/// Frequencies of small motions, or the dispersion relation.
ExitCode modes_of_fields(const ModesOptions& options, Study& study, Console& console) {
  constexpr std::size_t shown = 8;
  Json document = json_document("modes");
  if (options.orbit || options.asks_of_one_point()) {
    study.diagnostics().error(
        "E0809", {},
        "--at, --sweep, --plot, --roots, --csv, --Q, --y and --orbit are about coordinates, and the model has fields.",
        "Modes of fields are those about rest, for the values of the model.",
        "Leave these options out; other values are given by `--set k=2`.");
    finish(console, study, std::move(document));
    return ExitCode::Usage;
  }
  if (!study.field_equations()) return finish(console, study, std::move(document));
  const InterruptScope scope = study.interruptible();
  if (options.dispersion) {
    std::string trouble;
    const std::string relation = dispersion_text(study, trouble);
    if (relation.empty()) {
      study.diagnostics().error(
          "E0644", study.field_equations()->system().density_span, "there is no dispersion relation", trouble,
          "Waves need a field at rest whose coefficients are the same everywhere and at all times.");
      return finish(console, study, std::move(document));
    }
    document["dispersion"] = relation;
    if (!console.json()) console.print(relation + "\n");
    return finish(console, study, std::move(document));
  }
  const FieldModes modes = field_modes(*study.field_equations(), shown, study.diagnostics());
  const std::vector<double>& found = modes.frequencies;
  std::string text = equilibrium_text(*study.field_equations(), modes);
  if (!found.empty())
    text += fmt::format("Frequencies of small motions about {}\n", modes.about.empty() ? "rest" : modes.about);
  if (modes.equilibrium) document["equilibrium"] = equilibrium_json(*study.field_equations(), *modes.equilibrium);
  if (!modes.about.empty()) document["about"] = modes.about;
  document["frequencies"] = Json::array();
  for (std::size_t i = 0; i < found.size(); ++i) {
    const double omega = found[i];
    document["frequencies"].push_back(omega);
    text += omega < 0 ? fmt::format("  grows at the rate {:.12g} 1/s", -omega)
                      : fmt::format("  {:.12g} rad/s  {:.12g} Hz", omega, omega / (2 * std::acos(-1.0)));
    if (i < modes.errors.size()) text += fmt::format("  ± {:.1g}", modes.errors[i]);
    text += shape_of_bodies(*study.field_equations(), modes, i) + "\n";
  }
  if (!modes.errors.empty()) document["errors"] = modes.errors;
  document["shapes"] = shapes_json(*study.field_equations(), modes);
  if (!console.json()) console.print(text);
  return finish(console, study, std::move(document));
}

ExitCode modes(const ModesOptions& options, Console& console) {
  Study study = open_study(options.model);
  if (!study.wrong() && !check_usage(options, study.diagnostics())) {
    finish(console, study, json_document("modes"));
    return ExitCode::Usage;
  }
  if (!options.at.empty() && !parse_time(options.at)) study.override_with(OverrideKind::At, "--at", options.at);
  if (!options.sweep.empty()) study.override_with(OverrideKind::Sweep, "--sweep", options.sweep);
  for (const std::string& y : options.outputs) study.ask("--y", y);
  if (study.has_fields()) return modes_of_fields(options, study, console);
  if (options.dispersion && !study.wrong()) {
    study.diagnostics().error("E0809", {}, "--dispersion asks for waves, and the model has no field.", {},
                              "Leave it out.");
    return finish_usage(console, study, "modes");
  }
  const EquationsOfMotion* equations = study.equations();
  if (!equations || study.refuse_held_integrals() || (options.asks_of_one_point() && study.refuse_modes()) ||
      study.refuse_without_time() || !study.certificate())
    return finish(console, study, json_document("modes"));
  if (options.orbit) return orbit(options, study, console);
  study.tell_events_left_out();
  const InterruptScope scope = study.interruptible();
  const auto start = consistent_start(*study.model(), *equations, study.diagnostics());
  if (!start) return finish(console, study, json_document("modes"));
  if (study.model()->system.has_modes()) return rest(study, start->state, console);
  if (refuse_free_functions(*equations, "modes", study.diagnostics()))
    return finish(console, study, json_document("modes"));
  PointEquations at_points(solvable_equations(*equations), measured_and_rates(*study.model()));
  return options.locus() ? locus(options, study, at_points, start->state, console)
                         : points(options, study, at_points, start->state, console);
}

}  // namespace

void add_modes(CommandLine& line) {
  const auto options = std::make_shared<ModesOptions>();
  Command& command = line.add("modes", "Equilibria, linearization, frequencies, mode shapes, stability",
                              "  maup modes double_pendulum.lag\n"
                              "  maup modes balanced_cart.lag --at \"θ=180deg\" --Q \"1, 1, 0, 0\" --R 0.1\n"
                              "  maup modes bead_on_hoop.lag --plot bifurcation.svg --csv locus.csv\n",
                              [options](Console& console) { return modes(*options, console); });
  add_model_options(command, options->model);
  command
      .add_option("--at", options->at,
                  "One equilibrium or steady motion, e.g. \"θ=0, φ'=2 rad/s\", or a time of the motion, e.g. 3s")
      ->type_name("POINT|TIME");
  command
      .add_option("--y", options->outputs,
                  "What is measured, y = y0 + C x + D u: formulas in q, q', q'', reactions and inputs, e.g. \"x + l "
                  "sin θ\" \"θ'\"")
      ->type_name("FORMULA ...");
  command
      .add_option_function(
          "--orbit",
          [options](const std::vector<std::string>& given) { options->orbit = given.empty() ? "" : given.front(); },
          "Floquet multipliers of the periodic motion near the start instead; its period where it is known")
      ->expected(0, 1)
      ->type_name("[PERIOD]");
  command.add_option("--Q", options->q, "Weights of the states: a linear-quadratic regulator about the point of --at")
      ->type_name("WEIGHTS");
  command.add_option("--R", options->r, "Prices of the inputs (default: 1)")->type_name("WEIGHTS");
  command
      .add_option("--sweep", options->sweep,
                  "A locus over values of one parameter, e.g. \"Ω = 0 .. 12 rad/s steps 121\"")
      ->not_empty()
      ->type_name("SWEEP");
  command.add_option("--plot", options->plot, "The bifurcation diagram of the sweep: .svg, .png or .pdf")
      ->type_name("FILE");
  command
      .add_option("--roots", options->roots, "The eigenvalues of the sweep in the complex plane: .svg, .png or .pdf")
      ->type_name("FILE");
  command.add_option("--csv", options->csv, "The locus as numbers: .csv")->type_name("FILE");
  command.add_flag("--dispersion", options->dispersion, "The dispersion relation of a field, in symbols");
  command.add_flag("--all", options->all, "The modes of all points that were found, not of the first four alone");
}

}  // namespace maupertuis::app
