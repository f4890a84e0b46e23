#include "command.hpp"
#include "constraint_text.hpp"
#include "fields_text.hpp"
#include "interrupt.hpp"
#include "open_study.hpp"
#include "outcome.hpp"
#include "quantity.hpp"

#include <maupertuis/higher_order.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <maupertuis/degenerate.hpp>
#include <maupertuis/print.hpp>
#include <maupertuis/simulation.hpp>

namespace maupertuis::app {
namespace {

std::string in_unit_of(const std::string& number, const Dimension& dimension) {
  const std::string unit = to_string(dimension);
  return unit == "1" || unit.empty() ? number : number + " " + unit;
}

std::string joined_names(const std::vector<std::string>& words) { return fmt::format("{}", fmt::join(words, ", ")); }

/// θ = 120 deg, x' = 2 m/s: as the text has it, in SI where it has a formula.
std::string start_text(const StartValue& start, const MechanicalSystem& system) {
  const Coordinate& c = system.coordinates[start.coordinate];
  const double value = evaluate(in_terms_of_motion(system, {&start.value, 1})[0], parameter_bindings(system));
  const std::string name = c.name + std::string(static_cast<std::size_t>(start.order), '\'');
  if (system.dimensionless) return fmt::format("{} = {}", name, brief(value));
  if (!start.unit.empty()) return fmt::format("{} = {} {}", name, brief(value / start.unit_factor), start.unit);
  return fmt::format("{} = {}", name,
                     in_unit_of(brief(value), start.order ? c.dimension / system.independent_dimension : c.dimension));
}

/// A torque of 0.1 N m is no energy of 0.1 J: the unit of the text where the value is one number of it, else that of
/// SI.
std::string parameter_text(const Parameter& p, const MechanicalSystem& system) {
  const double factor = p.unit_factor;
  return p.unit.empty() || system.dimensionless ? in_unit_of(brief(p.si_value), p.dimension)
                                                : brief(p.si_value / factor) + " " + p.unit;
}

double value_of(Expr e, const MechanicalSystem& system) {
  return evaluate(in_terms_of_motion(system, {&e, 1})[0], parameter_bindings(system));
}

/// (0, free) at t = 2 s
std::string end_text(const std::vector<Expr>& configuration, Expr at, const MechanicalSystem& system) {
  std::vector<std::string> values;
  for (std::size_t i = 0; i < configuration.size(); ++i) {
    const std::string name = written_name(system, i), named = system.higher.empty() ? "" : name + " = ";
    if (name.empty()) continue;
    const std::string number = configuration[i] ? brief(value_of(configuration[i], system)) : "free";
    values.push_back(named + (!configuration[i] || system.dimensionless
                                  ? number
                                  : in_unit_of(number, system.coordinates[i].dimension)));
  }
  return fmt::format("({}) at {}", joined_names(values), system.moment(brief(value_of(at, system))));
}

std::string path_ends_text(const PathEnds& path, const MechanicalSystem& system) {
  return fmt::format("from {} to {}", end_text(path.from, path.start, system), end_text(path.to, path.end, system));
}

/// length: ∫ sqrt(y'^2 + 1) dx = 3 m
std::string held_integral_text(const IntegralConstraint& held, const EquationsOfMotion& equations) {
  const MechanicalSystem& system = *equations.system;
  const std::string value = brief(value_of(held.value, system));
  return fmt::format("{}∫ {} d{} = {}", held.name.empty() ? "" : held.name + ": ",
                     to_plain(held.integrand, equations.order), system.independent,
                     system.dimensionless ? value : in_unit_of(value, held.dimension));
}

/// A coefficient of friction as it was written: of the normal force, not of the multiplier.
double coefficient_of(Expr coefficient, const Friction& friction, const MechanicalSystem& system) {
  return value_of(friction.per_multiplier ? coefficient / friction.per_multiplier : coefficient, system);
}

/// "friction 0.3, static 0.4"
std::string friction_text(const Friction& friction, const MechanicalSystem& system) {
  if (friction.sticking) return "never slides while it is closed";
  const double kinetic = coefficient_of(friction.kinetic, friction, system),
               fixed = coefficient_of(friction.static_, friction, system);
  return fmt::format("friction {}", brief(kinetic)) + (fixed != kinetic ? ", static " + brief(fixed) : "");
}

/// floor: z >= 0, restitution 0.8; at the start open by 1 m
std::string contact_text(const MechanicalSystem& system, std::size_t index, const ReadingOrder& order,
                         const std::optional<ContactStart>& start) {
  const Contact& c = system.contacts[index];
  std::string out = fmt::format("{}: {} >= 0", system.contact_label(index), to_plain(c.gap, order));
  if (const double e = value_of(c.restitution, system); e != 0) out += fmt::format(", restitution {}", brief(e));
  if (c.friction.present()) out += ", " + friction_text(c.friction, system);
  if (!start) return out;
  const auto hit = std::find_if(start->impacts.begin(), start->impacts.end(),
                                [&](const Happening& h) { return h.name == system.contact_label(index); });
  if (hit != start->impacts.end())
    return out + "; at the start it touches and closes: an impact at once" +
           (start->closed[index] ? ", then closed" : "");
  if (start->closed[index]) return out + "; closed at the start";
  const double gap = start->gaps[index];
  if (!start->trouble.empty() && std::abs(gap) < 1e-14) return out + "; touches at the start";
  return out + (std::abs(gap) < 1e-14 ? "; touches at the start without force"
                                      : "; open at the start, by " +
                                            (system.dimensionless ? brief(gap) : in_unit_of(brief(gap), c.dimension)));
}

/// "along x: coefficient 0.3 of m g"; "along θ: at most 0.2 N m"
std::string friction_of_coordinate(const Friction& f, const MechanicalSystem& system, const ReadingOrder& order) {
  if (f.normal)
    return fmt::format("along {}: {} of the normal force {}", f.name, friction_text(f, system),
                       to_plain(f.normal, order));
  return fmt::format("along {}: at most {}{}", f.name, to_plain(f.kinetic, order),
                     f.static_ == f.kinetic ? "" : ", static " + to_plain(f.static_, order));
}

/// "v = x' cos ψ + y' sin ψ"; the name alone where that is long.
std::string rate_text(const Rate& rate, const ReadingOrder& order) {
  constexpr std::size_t longest = 90;
  const std::string value = to_plain(readable(rate.value, order), order);
  return value.size() > longest ? rate.name : rate.name + " = " + value;
}

std::string mode_name(const std::string& mode) { return mode.empty() ? "free" : mode; }

/// The coordinates with their kinds, the parts of each energy, … : one line each, in the order of a lecture.
class Summary {
 public:
  Summary(const Model& model, const EquationsOfMotion& equations, const StartFindings& findings)
      : model_(model), system_(model.system), equations_(equations), findings_(findings) {}

  std::string text() {
    out_ = spoken_name(system_) + (system_.title.empty() ? "" : fmt::format(" — {}", system_.title)) + "\n";
    add_coordinates();
    add_symbols();
    add_energies();
    add_contacts();
    add_experiment();
    return std::move(out_);
  }

 private:
  void line(const char* head, const std::string& text) {
    if (!text.empty()) out_ += fmt::format("  {:<22}{}\n", head, text);
  }
  /// One word for each, as `word` says it.
  template <class List, class Word>
  static std::vector<std::string> words_of(const List& list, Word word) {
    std::vector<std::string> out;
    for (const auto& one : list) out.push_back(word(one));
    return out;
  }

  void add_coordinates() {
    auto words = words_of(system_.coordinates,
                          [](const Coordinate& c) { return c.kind.empty() ? c.name : c.name + " : " + c.kind; });
    if (words.size() > 8)
      words = {fmt::format("{} … {} ({} of them)", words.front(), words.back(), system_.coordinates.size())};
    line("coordinates", joined_names(words));
    if (const std::string unit = system_.independent_unit(); system_.independent != "t")
      line("independent variable",
           unit.empty() ? system_.independent : fmt::format("{} in {}", system_.independent, unit));
    for (std::size_t i = 0; i < system_.rates.size(); ++i)
      line(i == 0 ? "rates" : "", rate_text(system_.rates[i], equations_.order));
    summarise_constraints(equations_, findings_.constraints,
                          [this](const char* head, const std::string& text) { line(head, text); });
    if (equations_.degenerate)
      line("degenerate", fmt::format("{} of the {} numbers of a state are left, {} single{} out a motion",
                                     equations_.degenerate->chain.manifold_dimension, 2 * system_.coordinates.size(),
                                     equations_.degenerate->motions, equations_.degenerate->motions == 1 ? "s" : ""));
  }

  void add_symbols() {
    std::vector<std::string> words;
    for (const Parameter& p : system_.parameters)
      if (p.symbol.role() == Role::Parameter)
        words.push_back(fmt::format("{} = {}", p.name, parameter_text(p, system_)));
    if (words.size() > 12) words = {fmt::format("{} of them", words.size())};
    line("parameters", joined_names(words));
    line("inputs", joined_names(words_of(system_.inputs, [](const Input& u) { return u.name; })));
  }

  void energy(const char* head, const std::vector<EnergyTerm>& terms) {
    auto origins = words_of(terms, [](const EnergyTerm& term) { return term.origin; });
    if (origins.size() > 8)
      origins = {fmt::format("{} terms, from {} to {}", terms.size(), origins.front(), origins.back())};
    line(head, joined_names(origins));
  }

  void add_energies() {
    if (system_.lagrangian_given) {
      line("Lagrangian L", "given");
    } else {
      energy("kinetic energy T", system_.kinetic);
      energy("potential energy V", system_.potential);
      energy("generalized pot. U", system_.generalized_potential);
    }
    energy("added to L", system_.lagrangian_extra);
    energy("dissipation D", system_.dissipation);
    line("forces Q",
         joined_names(words_of(system_.forces, [](const AppliedForce& force) { return "on " + force.target; })));
  }

  void add_contacts() {
    for (std::size_t i = 0; i < system_.contacts.size() && i < 12; ++i)
      line(i == 0 ? "contacts" : "", contact_text(system_, i, equations_.order, findings_.contacts));
    if (system_.contacts.size() > 12) line("", fmt::format("… {} of them", system_.contacts.size()));
    for (std::size_t i = 0; i < system_.frictions.size(); ++i)
      line(i == 0 ? "friction" : "", friction_of_coordinate(system_.frictions[i], system_, equations_.order));
    if (findings_.contacts)
      line("begins", findings_.contacts->trouble.empty() ? "in the mode " + mode_name(findings_.contacts->mode)
                                                         : "not: " + findings_.contacts->trouble);
  }

  std::string start_time(Expr t) const {
    const double value = evaluate(in_terms_of_motion(system_, {&t, 1})[0], parameter_bindings(system_));
    return fmt::format("{} = {}", system_.independent, in_unit_of(brief(value), system_.independent_dimension));
  }

  void add_experiment() {
    const Experiment& experiment = model_.experiment;
    line("events", joined_names(words_of(experiment.events, [](const ModelEvent& event) { return event.name; })));
    auto words = words_of(experiment.start, [this](const StartValue& start) { return start_text(start, system_); });
    if (experiment.start_time) words.insert(words.begin(), start_time(experiment.start_time));
    if (words.size() > 8) words.resize(8), words.push_back("…");
    line("start", joined_names(words));
    if (experiment.path) line("path", path_ends_text(*experiment.path, system_));
    line("integrals held", joined_names(words_of(system_.integral_constraints, [this](const IntegralConstraint& held) {
           return held_integral_text(held, equations_);
         })));
    if (findings_.start) line("consistent start", moved_start(system_, *findings_.start));
    if (!experiment.expectations.empty())
      line("expectations", fmt::format("{} (run them with `maup test`)", experiment.expectations.size()));
  }

  const Model& model_;
  const MechanicalSystem& system_;
  const EquationsOfMotion& equations_;
  const StartFindings& findings_;
  std::string out_;
};

Json friction_json(const Friction& f, const EquationsOfMotion& equations) {
  if (f.sticking) return {{"sticking", true}};
  return {{"kinetic", coefficient_of(f.kinetic, f, *equations.system)},
          {"static", coefficient_of(f.static_, f, *equations.system)}};
}

/// contacts: [{name, gap, restitution, friction, start: {gap, rate, closed, impact}}], frictions: [{along, kinetic,
/// static, normal}], first_mode
void add_contacts(Json& document, const EquationsOfMotion& equations, const std::optional<ContactStart>& start) {
  const MechanicalSystem& system = *equations.system;
  document["contacts"] = Json::array();
  for (std::size_t i = 0; i < system.contacts.size(); ++i) {
    const Contact& c = system.contacts[i];
    Json contact{{"name", system.contact_label(i)},
                 {"gap", to_plain(c.gap, equations.order)},
                 {"restitution", value_of(c.restitution, system)},
                 {"friction", c.friction.present() ? friction_json(c.friction, equations) : Json()},
                 {"start", nullptr}};
    if (start) {
      const bool hit = std::any_of(start->impacts.begin(), start->impacts.end(),
                                   [&](const Happening& h) { return h.name == system.contact_label(i); });
      contact["start"] = {{"gap", start->gaps[i]},
                          {"rate", start->rates[i]},
                          {"closed", static_cast<bool>(start->closed[i])},
                          {"impact", hit}};
    }
    document["contacts"].push_back(std::move(contact));
  }
  document["frictions"] = Json::array();
  for (const Friction& f : system.frictions)
    document["frictions"].push_back({{"along", f.name},
                                     {"kinetic", to_plain(f.kinetic, equations.order)},
                                     {"static", to_plain(f.static_, equations.order)},
                                     {"normal", f.normal ? Json(to_plain(f.normal, equations.order)) : Json()}});
  document["first_mode"] = start && start->trouble.empty() ? Json(mode_name(start->mode)) : Json();
}

/// A start without a motion is told above (W0731).
std::string closing_of(const std::optional<ContactStart>& start) {
  return start && !start->trouble.empty() ? "No motion begins at this start; no other mistakes were found.\n"
                                          : "No mistakes found.\n";
}

ExitCode check(const ModelOptions& options, Console& console) {
  Study study = open_study(options);
  if (study.has_fields()) {
    const bool good = study.field_equations() != nullptr;
    if (!console.json() && good) console.print(fields_summary(study));
    Json document = console.json() ? fields_json(study) : Json{};
    if (console.json()) document["command"] = "check";
    return finish(console, study, std::move(document));
  }
  const Model* model = study.model();
  const EquationsOfMotion* equations = study.equations();  // a singular mass matrix is found here
  std::optional<StartFindings> findings;
  std::optional<InterruptScope> scope;
  if (equations) scope.emplace(*model->system.context, &interrupt_flag());
  if (equations) findings = look_into_start(*model, *equations, study.diagnostics());
  if (console.json()) {
    Json document = json_document("check");
    document["system"] = model ? Json(model->system.name) : Json(nullptr);
    document["coordinates"] = Json::array();
    if (model)
      for (const Coordinate& c : model->system.coordinates) document["coordinates"].push_back(c.name);
    if (model && !model->system.rates.empty()) {
      document["rates"] = Json::array();
      for (const Rate& rate : model->system.rates) document["rates"].push_back(rate.name);
    }
    // Numbers are given only where they are known.
    const bool counted = findings && !study.wrong();
    document["freedoms"] = counted ? Json(findings->constraints.configuration_freedoms) : Json(nullptr);
    document["instantaneous_freedoms"] = counted ? Json(findings->constraints.instantaneous_freedoms) : Json(nullptr);
    document["constraints"] = counted ? constraints_to_json(*equations, findings->constraints) : Json::array();
    if (counted && model->system.has_modes()) add_contacts(document, *equations, findings->contacts);
    return finish(console, study, document);
  }
  if (findings && !study.wrong())
    console.print(Summary(*model, *equations, *findings).text() + closing_of(findings->contacts));
  return finish(console, study, {});
}

}  // namespace

void add_check(CommandLine& line) {
  const auto options = std::make_shared<ModelOptions>();
  Command& command = line.add("check", "Look for mistakes in a model; a summary of the system",
                              "  maup check pendulum.lag\n"
                              "  maup check pendulum.lag --set l=2m --start θ=90deg\n"
                              "  maup new double-pendulum -o - | maup check - --json\n",
                              [options](Console& console) { return check(*options, console); });
  add_model_options(command, *options);
}

}  // namespace maupertuis::app
