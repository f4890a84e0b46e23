#include "command.hpp"
#include "derivation_text.hpp"
#include "emit.hpp"
#include "equation_forms.hpp"
#include "fields_text.hpp"
#include "interrupt.hpp"
#include "outcome.hpp"
#include "rates_form.hpp"
#include "time_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <maupertuis/constraint_analysis.hpp>
#include <maupertuis/contact_mode.hpp>
#include <maupertuis/couplings.hpp>
#include <maupertuis/degenerate.hpp>
#include <maupertuis/higher_order.hpp>
#include <maupertuis/print.hpp>
#include <maupertuis/reactions.hpp>
#include <maupertuis/simulation.hpp>

namespace maupertuis::app {
namespace {

struct DeriveOptions {
  ModelOptions model;
  std::string form;
  bool eliminate = false, steps = false, latex = false, mathml = false, plain = false;
  std::string certify = "standard";
  std::string emit;
  bool modes = false;
  std::optional<std::string> budget;  // of --modes

  Form chosen_form() const {
    if (eliminate) return Form::Eliminated;
    if (form.empty()) return steps || modes ? Form::Standard : Form::Shortest;  // the steps lead to q''
    const std::map<std::string, Form> forms = {{"standard", Form::Standard},
                                               {"solved", Form::Solved},
                                               {"matrix", Form::Matrix},
                                               {"residual", Form::Residual},
                                               {"rates", Form::Rates}};
    return forms.at(form);
  }
};

Json lines_json(const std::vector<EquationLine>& lines, const ReadingOrder& order) {
  Json list = Json::array();
  for (const EquationLine& line : lines)
    list.push_back({{"coordinate", line.coordinate},
                    {"plain", plain_text(shown_line(line, order))},
                    {"latex", latex_text(shown_line(line, order))}});
  return list;
}

using Writer = std::string (*)(Expr, const ReadingOrder&);

/// A formula and what the names in it stand for, after `with`.
std::string readable_line(Expr e, const ReadingOrder& order, Writer write, const char* with) {
  const ReadableForm form = readable(e, order);
  std::string text = write(form.value, order);
  for (const Intermediate& i : form.intermediates)
    text += fmt::format("{} {} = {}", with, write(i.symbol, order), write(i.value, order));
  return text;
}
std::string readable_text(Expr e, const ReadingOrder& order) { return readable_line(e, order, to_plain, " with"); }
std::string readable_latex(Expr e, const ReadingOrder& order) {
  return readable_line(e, order, to_latex, " \\quad \\text{with }");
}

/// multipliers, constraints, A and b of A q'' = b.
void add_constraints(Json& document, Study& study) {
  const EquationsOfMotion& equations = study.equations()->shown();
  const ReadingOrder& order = equations.order;
  document["multipliers"] = Json::array();
  for (const Expr& multiplier : equations.multipliers) document["multipliers"].push_back(symbol_to_plain(multiplier));
  document["constraints"] = Json::array();
  const std::vector<ConstraintEquation>& written = study.derivation(false)->constraints;
  const ConstraintAnalysis analysis = analyse_constraints(*study.equations());
  for (std::size_t k = 0; k < written.size(); ++k) {
    const bool position = equations.system->constraints[k].level == Constraint::Level::Position;
    document["constraints"].push_back(
        {{"name", written[k].name},
         {"level", position ? "position" : "velocity"},
         {"class", word(analysis.constraints[k].constraint_class)},
         {"plain", to_plain(written[k].left, order) + " = " + to_plain(written[k].right, order)},
         {"latex", to_latex(written[k].left, order) + " = " + to_latex(written[k].right, order)}});
  }
  const ExprMatrix a = constraint_matrix(equations);
  document["constraint_matrix"] = Json::array();
  for (std::size_t k = 0; k < a.rows; ++k) {
    Json row = Json::array();
    for (std::size_t j = 0; j < a.columns; ++j) row.push_back(readable_text(a.at(k, j), order));
    document["constraint_matrix"].push_back(std::move(row));
  }
  document["constraint_bias"] = Json::array();
  for (const Expr& b : constraint_bias(equations)) document["constraint_bias"].push_back(readable_text(b, order));
}

Json degenerate_json(const DegenerateAnalysis& analysis, const EquationsOfMotion& equations) {
  Json constraints = Json::array(), free = Json::array();
  for (const FoundConstraint& c : analysis.chain.constraints)
    constraints.push_back({{"generation", c.generation},
                           {"plain", to_plain(c.value, equations.order)},
                           {"latex", to_latex(c.value, equations.order)}});
  for (const std::size_t i : analysis.free) free.push_back(equations.system->coordinates[i].name);
  return {{"constraints", std::move(constraints)},
          {"free", std::move(free)},
          {"manifold_dimension", analysis.chain.manifold_dimension},
          {"motions", analysis.motions}};
}

Json reactions_json(const EquationsOfMotion& equations) {
  Json list = Json::array();
  for (const Reaction& r : reactions(equations)) {
    Json arrows = Json::array();
    for (const ForceArrow& arrow : r.arrows) arrows.push_back(arrow.point);
    list.push_back({{"name", r.name},
                    {"plain", r.value ? Json(readable_text(r.value, equations.order)) : Json()},
                    {"unit", equations.system->dimensionless ? std::string("1") : to_string(r.dimension)},
                    {"meaning", r.sentence},
                    {"acts_on", std::move(arrows)}});
  }
  return list;
}

void add_mass_matrix(Json& document, const EquationsOfMotion& equations) {
  const ExprMatrix m = mass_matrix(equations.shown());
  document["mass_matrix"] = Json::array();
  for (std::size_t i = 0; i < m.rows; ++i) {
    Json row = Json::array();
    for (std::size_t j = 0; j < m.columns; ++j) row.push_back(readable_text(m.at(i, j), equations.order));
    document["mass_matrix"].push_back(std::move(row));
  }
}

Json document_of(const DeriveOptions& options, Study& study, const EquationForm& form, const Certificate* certificate) {
  Json document = json_document("derive");
  const EquationsOfMotion* equations = study.equations();
  if (!equations || !certificate) return document;
  const ReadingOrder& order = equations->order;
  document["system"] = equations->system->name;
  const std::string shown_form = form.in_rates ? "rates" : options.form.empty() ? "standard" : options.form;
  document["form"] = options.eliminate ? "eliminated" : shown_form;
  document["coordinates"] = Json::array();
  const bool higher = !equations->system->higher.empty();
  for (const EquationLine& line : form.lines)
    if (higher) document["coordinates"].push_back(line.coordinate);
  for (const Coordinate& c : equations->system->coordinates)
    if (!higher) document["coordinates"].push_back(c.name);
  const ReadingOrder& rates = form.order(*equations);
  document["equations"] = lines_json(form.lines, rates);
  if (form.in_rates) {
    document["kinematics"] = lines_json(form.kinematics, rates);
    document["rates"] = Json::array();
    for (const FormulaLine& line : rate_definitions(form, *equations))
      document["rates"].push_back(
          {{"name", to_plain(line.left)}, {"plain", plain_text(line)}, {"latex", latex_text(line)}});
  }
  document["intermediates"] = Json::array();
  for (const Intermediate& i : form.intermediates)
    document["intermediates"].push_back({{"name", to_plain(i.symbol, order)}, {"plain", to_plain(i.value, order)}});
  if (higher) {
    document["higher_order"] = steps_json(higher_order_lines(*equations), order);
    if (options.steps) document["steps"] = steps_json(steps_to(form, study), order);
    document["certificate"] = to_json(*certificate);
    return document;
  }
  const bool entry_by_entry = options.form == "matrix" || !couples_too_much_to_read(*equations);
  if (entry_by_entry)
    add_mass_matrix(document, *equations);
  else
    document["left_out"] = Json::array({"mass_matrix", "momenta", "energy", "power"});
  if (equations->system->constrained()) add_constraints(document, study);
  if (Json list = reactions_json(*equations); !list.empty()) document["reactions"] = std::move(list);
  if (entry_by_entry) {
    document["momenta"] = document["momenta_latex"] = Json::array();
    for (const Expr p : equations->shown().momenta) {
      document["momenta"].push_back(readable_text(p, order));
      document["momenta_latex"].push_back(readable_latex(p, order));
    }
    document["energy"] = readable_text(equations->shown().energy_function, order);
    document["energy_latex"] = readable_latex(equations->shown().energy_function, order);
    document["power"] = readable_text(equations->shown().power, order);
  }
  const ConservedQuantities conserved = conserved_quantities(*equations);
  Json names = Json::array();
  for (const std::size_t i : conserved.conserved_momenta)
    names.push_back("p_" + equations->system->coordinates[i].name);
  if (conserved.energy_conserved) names.push_back("energy");
  document["conserved"] = std::move(names);
  document["energy_is_t_plus_v"] = conserved.energy_is_t_plus_v;
  if (study.degenerate()) document["degenerate"] = degenerate_json(*study.degenerate(), *equations);
  if (options.steps) document["steps"] = steps_json(steps_to(form, study), rates);
  document["certificate"] = to_json(with_rates_check(*certificate, form));
  return document;
}

/// In one notation alone, for another program: the steps if asked for, the equations, what their names stand for.
std::string in_notation(const DeriveOptions& options, Notation notation, Study& study, const EquationForm& form) {
  const EquationsOfMotion& equations = *study.equations();
  const ReadingOrder& order = form.order(equations);
  std::vector<FormulaLine> lines;
  if (options.steps) lines = step_lines(steps_to(form, study), *equations.system, order);
  const std::string section = options.steps ? "Equations of motion" : "";
  const auto add = [&](FormulaLine line) {
    line.section = section;
    lines.push_back(std::move(line));
  };
  for (const auto* part : {&form.lines, &form.kinematics, &form.constraints})
    for (const EquationLine& line : *part)
      add(notation == Notation::Plain ? language_line(line, order) : shown_line(line, order));
  if (study.degenerate() && notation != Notation::Plain)
    for (FormulaLine& line :
         step_lines(equations.system->higher.empty() ? degenerate_lines(*study.degenerate(), *equations.system)
                                                     : higher_order_lines(equations),
                    *equations.system, order))
      lines.push_back(std::move(line));
  for (const Intermediate& i : form.intermediates) add(definition_line(i, *equations.system, order));
  if (form.in_rates && notation != Notation::Plain)
    for (FormulaLine& line : rate_definitions(form, equations)) add(std::move(line));
  if (notation == Notation::Plain) return document(lines, notation);
  for (FormulaLine& line : symbol_legend(*equations.system, order)) add(std::move(line));
  return document(lines, notation);
}

ExitCode emit_stage(const DeriveOptions& options, Study& study, Console& console) {
  const std::string text = emit(options.emit, study);
  Json document = json_document("derive");
  document["emit"] = options.emit;
  document["text"] = text;
  if (!console.json() && !study.wrong()) console.print(text);
  return finish(console, study, document);
}

// ------------------------------------------------------------------------------------------------------------- modes

constexpr std::size_t few_modes = 8;  // shown all
constexpr const char* usual_budget = "20s";

/// That of the start, if the model has one from which a motion begins; else all is open and what rubs sticks.
ContactMode first_mode(Study& study) {
  const Model& model = *study.model();
  ContactMode mode = open_mode(model.system);
  if (model.experiment.start.empty() || !study.equations()) return mode;
  Diagnostics unheard;  // of the start: `maup check` tells them
  const auto start = consistent_start(model, *study.equations(), unheard);
  const auto contacts =
      start ? contact_start(model, *study.equations(), start->state, unheard) : std::optional<ContactStart>();
  std::string trouble;
  if (contacts && contacts->trouble.empty())
    if (auto read = read_mode(model.system, contacts->mode, trouble)) mode = *std::move(read);
  return mode;
}

/// The equations of one mode, certified; or why it has none. Adds nothing where it is interrupted.
void add_mode(const DeriveOptions& options, Study& whole, const ContactMode& mode, bool first,
              const Interrupt& interrupt, std::string& text, Json& list) {
  const std::string name = mode_text(whole.model()->system, mode);
  const std::string shown = name.empty() ? "free" : name;
  Study study = study_in_mode(whole.source(), options.model, shown, interrupt);
  study.derivation(false);
  std::optional<InterruptScope> scope;  // of what is written of it, too
  if (study.model()) scope.emplace(*study.model()->system.context, interrupt);
  const Certificate* certificate = study.certificate({.full = options.certify == "full"});
  EquationForm form;
  if (certificate) form = equation_form(options.chosen_form(), study);
  text += fmt::format("Mode {}{}\n", shown, first ? ", in which the motion begins" : "");
  if (!certificate || study.wrong()) {
    const auto items = study.diagnostics().items();
    const auto error =
        std::find_if(items.begin(), items.end(), [](const Diagnostic& d) { return d.severity == Severity::Error; });
    const std::string reason =
        error == items.end() ? "the check of its equations did not come to an end" : error->message;
    text += fmt::format("  no equations: {}\n", reason);
    list.push_back({{"mode", shown}, {"first", first}, {"reason", reason}});
    return;
  }
  text += equations_text(form, study.equations()->order);
  const auto passed = std::count_if(certificate->checks.begin(), certificate->checks.end(),
                                    [](const CertificateCheck& c) { return c.applies && c.verdict == Verdict::Zero; });
  text += fmt::format("Certificate: {}, {} checks\n", verdict_of(*certificate), passed);
  Json entry = document_of(options, study, form, certificate);
  entry["mode"] = shown;
  entry["first"] = first;
  list.push_back(std::move(entry));
}

void warn_of_modes_left_out(std::size_t count, const std::string& budget, Diagnostics& diagnostics) {
  diagnostics.warning("W0827", {}, fmt::format("{} mode{} left out", count, count == 1 ? " is" : "s are"),
                      fmt::format("The budget of {} was used up before {} equations were derived and certified.",
                                  budget, count == 1 ? "its" : "their"),
                      "Give --modes more time, --budget 10min, or ask for one of them, --mode NAME.");
}

ExitCode derive_modes(const DeriveOptions& options, Study& study, Console& console) {
  Json document = json_document("derive");
  if (!study.equations()) return finish(console, study, document);
  const MechanicalSystem& system = study.model()->system;
  if (!system.has_modes()) {
    study.diagnostics().error("E0809", {},
                              "--modes asks for the modes of contacts and dry friction, and the model has none.", {},
                              "Without --modes `maup derive` shows its one set of equations.");
    return finish_usage(console, study, "derive");
  }
  const auto seconds = budget_seconds(options.budget.value_or(usual_budget), study.diagnostics());
  if (study.wrong()) return finish_usage(console, study, "derive");
  Json list = Json::array();
  const ContactMode start = first_mode(study);
  const bool begins = !study.model()->experiment.start.empty();
  const std::vector<ContactMode> modes = modes_to_show(system, start, few_modes);
  const Deadline deadline(seconds);
  for (const ContactMode& mode : modes) {
    std::string text = list.empty() ? "" : "\n";
    try {
      add_mode(options, study, mode, begins && mode == start, &deadline.flag(), text, list);
    } catch (const Interrupted&) {
      break;
    }
    if (!console.json()) console.print(text);
  }
  const std::size_t left_out = modes.size() - list.size();
  const double all = number_of_modes(system);
  document["system"] = system.name;
  document["number_of_modes"] = all;
  document["modes"] = std::move(list);
  document["modes_left_out"] = left_out;
  if (all > static_cast<double>(modes.size()) && !console.json())
    console.print(fmt::format(
        "\n{} of {:.6g} modes: those that one contact or one friction makes of the first. --mode NAME shows "
        "another.\n",
        modes.size() - left_out, all));
  if (left_out > 0 && !interrupt_flag().load())
    warn_of_modes_left_out(left_out, options.budget.value_or(usual_budget), study.diagnostics());
  const Saving saving;
  return finish(console, study, document);
}

ExitCode derive_fields(const DeriveOptions& options, Study& study, Console& console) {
  if (!options.emit.empty() || options.modes || options.eliminate ||
      (!options.form.empty() && options.form != "standard")) {
    study.diagnostics().error("E0809", {}, "Equations of fields have one form.", {},
                              "--steps, --latex, --mathml, --plain and --json show it.");
    return finish_usage(console, study, "derive");
  }
  if (!study.field_equations()) return finish(console, study, json_document("derive"));
  const InterruptScope scope = study.interruptible();
  if (study.model()->system.has_modes())
    study.diagnostics().note(
        "N0505", std::nullopt, "these are the equations without contact and without dry friction",
        "While a contact is closed, or friction sticks or slides, their forces are added.",
        fmt::format("--mode \"{}\" shows those of one mode; `maup simulate` tells which ones a run goes through.",
                    some_mode(study.model()->system)));
  if (console.json()) return finish(console, study, fields_json(study));
  const bool one_notation = options.latex || options.mathml || options.plain;
  if (one_notation)
    console.print(document(field_lines(study, options.steps), options.latex    ? Notation::Latex
                                                              : options.mathml ? Notation::Mathml
                                                                               : Notation::Plain));
  else
    console.print(fields_lecture(study, options.steps));
  return finish(console, study, {});
}

ExitCode derive(const DeriveOptions& options, Console& console) {
  Study study = open_study(options.model);
  if (study.has_fields() && options.emit != "syntax") return derive_fields(options, study, console);
  if (options.modes && (options.steps || options.latex || options.mathml || options.plain || !options.emit.empty() ||
                        options.model.mode)) {
    study.diagnostics().error("E0809", {}, "--modes goes with --form, --eliminate, --certify and --json alone.", {},
                              "--mode NAME shows one of them in every way.");
    return finish_usage(console, study, "derive");
  }
  if (options.budget && !options.modes) {
    study.diagnostics().error("E0809", {}, "--budget belongs to --modes.", "The equations of a model are shown whole.",
                              "Leave it out.");
    return finish_usage(console, study, "derive");
  }
  if (options.modes) return derive_modes(options, study, console);
  if (!options.emit.empty()) return emit_stage(options, study, console);

  if (study.refuse_held_integrals()) return finish(console, study, document_of(options, study, {}, nullptr));
  study.derivation(options.steps);
  if (study.model() && study.model()->system.has_modes())
    study.diagnostics().note(
        "N0505", std::nullopt, "these are the equations without contact and without dry friction",
        "While a contact is closed, or friction sticks or slides, others hold.",
        fmt::format("--modes shows those of its modes, --mode \"{}\" those of one.", some_mode(study.model()->system)));
  const Certificate* certificate = study.certificate({.full = options.certify == "full"});
  EquationForm form;
  if (certificate) form = equation_form(options.chosen_form(), study);
  if (study.wrong()) certificate = nullptr;

  if (console.json()) return finish(console, study, document_of(options, study, form, certificate));
  if (certificate) {
    if (options.latex)
      console.print(in_notation(options, Notation::Latex, study, form));
    else if (options.mathml)
      console.print(in_notation(options, Notation::Mathml, study, form));
    else if (options.plain)
      console.print(in_notation(options, Notation::Plain, study, form));
    else
      console.print(lecture(study, form, *certificate, options.steps));
  }
  return finish(console, study, {});
}

}  // namespace

void add_derive(CommandLine& line) {
  const auto options = std::make_shared<DeriveOptions>();
  Command& command = line.add("derive", "The equations of motion, certified",
                              "  maup derive pendulum.lag\n"
                              "  maup derive pendulum.lag --steps\n"
                              "  maup derive pendulum.lag --form solved --latex > equations.tex\n",
                              [options](Console& console) { return derive(*options, console); });
  add_model_options(command, options->model);
  command.add_flag("--steps", options->steps, "The textbook derivation, line by line, each with its rule");
  command.add_flag(
      "--modes", options->modes,
      "The equations of each mode of contacts and friction; of many those next to where the motion begins");
  command
      .add_option("--budget", options->budget,
                  "The time that --modes may take (default 20s), or none; modes that do not come in it are left out")
      ->type_name("TIME");
  Option* form =
      command
          .add_option("--form", options->form,
                      "standard: R = Aᵀλ, in q''; solved: q'' = …, λ = …; matrix: M, h, A and b of M q'' + h = Aᵀλ, "
                      "A q'' = b; residual: R; rates: in the rates of the model or of its bodies, without "
                      "multipliers. Without it rates where the model names them or they are shorter to read")
          ->one_of({"standard", "solved", "matrix", "residual", "rates"})
          ->type_name("FORM");
  command
      .add_flag("--eliminate", options->eliminate,
                "The equations without multipliers: combinations in which Aᵀλ cancels")
      ->excludes(form);
  const auto latex = command.add_flag("--latex", options->latex, "A LaTeX document of the equations");
  const auto mathml = command.add_flag("--mathml", options->mathml, "MathML")->excludes(latex);
  command.add_flag("--plain", options->plain, "The equations alone, one a line")->excludes(latex)->excludes(mathml);
  command.add_option("--certify", options->certify, "full: also that a gauge term dG/dt changes nothing")
      ->one_of({"standard", "full"})
      ->type_name("standard|full");
  command.add_option("--emit", options->emit, "What a stage made: syntax, system, equations, program or jet")
      ->one_of({"syntax", "system", "equations", "program", "jet"})
      ->type_name("STAGE");
}

}  // namespace maupertuis::app
