#include "command.hpp"
#include "comparison_text.hpp"
#include "interrupt.hpp"
#include "outcome.hpp"
#include "quantity.hpp"
#include "run_options.hpp"
#include "time_options.hpp"

#include <fmt/format.h>

#include <algorithm>

#include <maupertuis/comparison.hpp>
#include <maupertuis/integrals_through_modes.hpp>

namespace maupertuis::app {
namespace {

struct CompareOptions {
  std::string a, b, map;
  RunOptions run;
};

const char* sameness_word(Sameness verdict) {
  switch (verdict) {
    case Sameness::Same:
      return "same";
    case Sameness::Part:
      return "part";
    case Sameness::Different:
      return "different";
    case Sameness::Undecided:
      return "undecided";
  }
  return "";
}

const char* energy_word(EnergyRelation relation) {
  switch (relation) {
    case EnergyRelation::Equal:
      return "equal";
    case EnergyRelation::EqualButConstant:
      return "equal up to a constant";
    case EnergyRelation::Different:
      return "different functions";
    case EnergyRelation::Undecided:
      return "not decided";
  }
  return "";
}

std::string verdict_text(const Comparison& c) {
  switch (c.verdict) {
    case Sameness::Same:
      return (c.proved() ? "the same motion: " : "the same motion, by evidence and not proved: ") + ground_text(c);
    case Sameness::Part:
      return fmt::format("not the same: {}\n  equations           {}", c.reason, ground_text(c));
    case Sameness::Different:
      return "differs: " + c.reason;
    case Sameness::Undecided:
      return "undecided: " + c.reason;
  }
  return {};
}

std::string freedoms_text(std::size_t freedoms, std::size_t instantaneous) {
  return freedoms == instantaneous ? std::to_string(freedoms)
                                   : fmt::format("{} ({} instantaneous)", freedoms, instantaneous);
}

/// Coordinates with their velocities, as many as fit some lines; --json has all.
std::string witness_state_text(const MotionState& state, const MechanicalSystem& system) {
  constexpr std::size_t most = 8;
  std::string text;
  for (std::size_t i = 0; i < std::min(most, system.coordinates.size()); ++i)
    text += fmt::format("{0}{1} = {2}, {1}' = {3}", i ? ", " : "", system.coordinates[i].name, brief(state.q[i]),
                        brief(state.v[i]));
  if (system.coordinates.size() > most) text += ", …";
  return state.t == 0 ? text : text + fmt::format(", t = {} s", brief(state.t));
}

std::string text_of(const Comparison& c, const Model& a, const CoordinateMap& map) {
  const MechanicalSystem& b = map.b->system;
  std::string out = fmt::format("{} and {}\n", c.name_a, c.name_b);
  const auto line = [&out](const char* head, const std::string& text) {
    out += fmt::format("  {:<20}{}\n", head, text);
  };
  for (std::size_t i = 0; i < map.written.size(); ++i)
    if (map.written[i] != a.system.coordinates[i].name)
      line(i == 0 || out.find("  map ") == std::string::npos ? "map" : "",
           a.system.coordinates[i].name + " = " + map.written[i]);
  out += verdict_text(c) + "\n";
  line("freedoms",
       fmt::format("{} and {}; rank of the map {}{}", freedoms_text(c.freedoms_a, c.instantaneous_freedoms_a),
                   freedoms_text(c.freedoms_b, c.instantaneous_freedoms_b), c.rank,
                   c.degenerate.empty() ? "" : ", less at " + c.degenerate));
  line("energy functions", energy_word(c.energies));
  if (c.disagreement) {
    const Disagreement& d = *c.disagreement;
    const std::string name = a.system.coordinates[d.coordinate].name;
    line("witness", "at " + witness_state_text(d.state, b));
    line("", fmt::format("{}'' = {:.12g} by {}, {:.12g} by {}", name, d.of_a, c.name_a, d.of_b, c.name_b));
  }
  if (c.run.ran)
    line("run of both", fmt::format("{} s from a common start: {}{}", brief(c.run.duration),
                                    c.run.difference > 0 ? fmt::format("{} differs by {:.2g} of its size at t = {} s",
                                                                       a.system.coordinates[c.run.coordinate].name,
                                                                       c.run.difference, brief(c.run.time))
                                                         : "the same to the last digit",
                                    c.run.reason.empty() ? "" : "; " + c.run.reason));
  else if (!c.run.reason.empty())
    line("run of both", "none: " + c.run.reason);
  return out;
}

Json comparison_json(const Comparison& c, const Model& a, const CoordinateMap& map) {
  const MechanicalSystem& b = map.b->system;
  Json document = json_document("compare");
  document["systems"] = {a.system.name, b.name};
  for (std::size_t i = 0; i < map.written.size(); ++i) document["map"][a.system.coordinates[i].name] = map.written[i];
  document["verdict"] = c.verdict == Sameness::Same && !c.proved() ? "evidence" : sameness_word(c.verdict);
  document["reason"] = c.reason;
  document["points"] = c.ground.points;
  document["error_bound"] = c.ground.error_bound;
  document["parameters"] = c.parameters == Comparison::Parameters::Any         ? "any"
                           : c.parameters == Comparison::Parameters::NearThese ? "near these"
                                                                               : "these alone";
  document["freedoms"] = {c.freedoms_a, c.freedoms_b};
  document["instantaneous_freedoms"] = {c.instantaneous_freedoms_a, c.instantaneous_freedoms_b};
  document["rank"] = c.rank;
  document["degenerate_at"] = c.degenerate.empty() ? Json(nullptr) : Json(c.degenerate);
  document["energies"] = energy_word(c.energies);
  document["witness"] = nullptr;
  if (c.disagreement) {
    const Disagreement& d = *c.disagreement;
    Json state;
    for (std::size_t i = 0; i < b.coordinates.size(); ++i) {
      state[b.coordinates[i].name] = d.state.q[i];
      state[b.coordinates[i].name + "'"] = d.state.v[i];
    }
    document["witness"] = {{"t", d.state.t},
                           {"state", state},
                           {"coordinate", a.system.coordinates[d.coordinate].name},
                           {"accelerations", {d.of_a, d.of_b}}};
  }
  document["run"] = nullptr;
  if (c.run.ran)
    document["run"] = {{"duration", c.run.duration},
                       {"difference", c.run.difference},
                       {"coordinate", a.system.coordinates[c.run.coordinate].name},
                       {"t", c.run.time},
                       {"ended", c.run.reason}};
  return document;
}

/// Shows what both models and the map have to say; under --json all of it stands in the document.
ExitCode finish_all(Console& console, Study& a, Study& b, const Diagnostics& of_map, const SourceText& map,
                    Json document, ExitCode code) {
  const bool same_file = a.source().text() == b.source().text();
  if (console.json()) {
    document["ok"] = code == ExitCode::Fine;
    document["diagnostics"] = Json::array();
    const auto add = [&](const Diagnostics& diagnostics, const SourceText& source) {
      for (Json& d : app::to_json(diagnostics, source)) {
        d["file"] = source.name();
        document["diagnostics"].push_back(std::move(d));
      }
    };
    add(a.diagnostics(), a.source());
    if (!same_file) add(b.diagnostics(), b.source());
    add(of_map, map);
    console.print_document(document);
    return code;
  }
  console.show(a.diagnostics(), a.source());
  if (!same_file) console.show(b.diagnostics(), b.source());
  console.show(of_map, map);
  return code;
}

/// E0834: what is proved rests on motions that exist from every state of the constraints, one from each.
bool refuse_degenerate(Study& study) {
  if (!study.equations()->degenerate) return false;
  study.diagnostics().error(
      "E0834", {}, "models with degenerate Lagrangians are not compared",
      "It asks more of a state than constraints do, or leaves functions of time free: that every motion of "
      "the one is one of the other cannot be read off the equations as it is elsewhere.",
      "`maup derive` shows its constraints; `maup simulate` of both from one start compares motions.");
  return true;
}

/// E0835: equations of motion are compared, and these are the equations of parts of it.
bool refuse_parts(Study& study) {
  if (!study.model() || !is_in_parts(*study.model())) return false;
  const Model& model = *study.model();
  const auto& events = model.experiment.events;
  const auto sets = std::find_if(events.begin(), events.end(), [](const ModelEvent& e) { return !e.sets.empty(); });
  const Span span = !model.system.contacts.empty()    ? model.system.contacts.front().span
                    : !model.system.frictions.empty() ? model.system.frictions.front().span
                                                      : sets->span;
  study.diagnostics().error(
      "E0835", span, "models with contacts, dry friction or events that set the state are not compared",
      "Two equations of motion are compared for all time, and here they hold between such instants alone.",
      "Leave these statements out of both models to compare what moves between, or `maup simulate` both.");
  return true;
}

ExitCode compare_models(const CompareOptions& options, Console& console) {
  Study a = open_study(options.a), b = open_study(options.b);
  Diagnostics of_map;
  const SourceText map_text("--map", options.map);
  const SimulationOptions settings = simulation_options(options.run, of_map, a.tree());
  if (!of_map.has_errors() && options.run.duration)
    refuse_unit_that_is_a_name("--duration", *options.run.duration, b.tree(), of_map);
  const auto end = [&](Json document, ExitCode code) {
    return finish_all(console, a, b, of_map, map_text, std::move(document), code);
  };
  if (of_map.has_errors()) return end(json_document("compare"), ExitCode::Usage);
  const bool readable = !unreadable(a.diagnostics()) && !unreadable(b.diagnostics());
  const EquationsOfMotion* a_equations = a.equations();
  if (!b.equations() || !a_equations || a.refuse_held_integrals() || refuse_parts(a) || refuse_parts(b) ||
      b.refuse_held_integrals() || !a.certificate() || !b.certificate())
    return end(json_document("compare"), readable ? ExitCode::ModelWrong : ExitCode::Usage);
  if (refuse_degenerate(a) || refuse_degenerate(b)) return end(json_document("compare"), ExitCode::ModelWrong);

  const InterruptScope of_a = a.interruptible(), of_b = b.interruptible();
  const auto map = read_map(*a.model(), b.source(), map_text, of_map);
  if (!map) return end(json_document("compare"), ExitCode::ModelWrong);
  const auto b_system = std::shared_ptr<const MechanicalSystem>(map->b, &map->b->system);
  const InterruptScope of_pair(*b_system->context, &interrupt_flag());
  const auto b_equations = euler_lagrange(b_system, of_map);
  if (!b_equations) return end(json_document("compare"), ExitCode::ModelWrong);
  ComparisonOptions how;
  how.simulation = settings;
  const Comparison result = compare(*a.model(), *a_equations, *map, *b_equations, how, of_map);
  if (of_map.has_errors()) return end(json_document("compare"), ExitCode::ModelWrong);
  if (!console.json()) console.print(text_of(result, *a.model(), *map));
  return end(comparison_json(result, *a.model(), *map), result.proved() ? ExitCode::Fine
                                                        : result.verdict == Sameness::Same
                                                            ? ExitCode::NotProved
                                                            : ExitCode::ExpectationFailed);
}

}  // namespace

void add_compare(CommandLine& line) {
  const auto options = std::make_shared<CompareOptions>();
  Command& command = line.add(
      "compare", "Whether two models give the same motion; exit 4 if not, 5 if it is not proved",
      "  maup compare cartesian.lag angle.lag --map \"x = l sin θ, y = -l cos θ\"\n"
      "  maup compare inertial.lag rotating.lag --map \"x = u cos(Ω t) - v sin(Ω t), y = u sin(Ω t) + v cos(Ω t)\"\n"
      "  maup compare lagrangian.lag with_gauge.lag --json\n",
      [options](Console& console) { return compare_models(*options, console); });
  command.add_option("A", options->a, "The first model, or - for standard input")->required();
  command.add_option("B", options->b, "The second model")->required();
  command.add_option("--map", options->map, "Coordinates of A as formulas of B; equal names are mapped to themselves");
  command.add_option("--duration", options->run.duration, "How long both are run, e.g. 20s");
  add_method_options(command, options->run);
}

}  // namespace maupertuis::app
