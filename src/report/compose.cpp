#include "report/action.hpp"
#include "report/mode_parts.hpp"
#include "report/motion_parts.hpp"
#include "report/notation.hpp"
#include "report/orbits.hpp"

#include <maupertuis/constraint_analysis.hpp>
#include <maupertuis/hamiltonian.hpp>
#include <maupertuis/interrupt_scope.hpp>
#include <maupertuis/print.hpp>
#include <maupertuis/report.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>

/// From the artifacts of a study to plain data: what stands here chooses and names, html.cpp lays out.
namespace maupertuis {
namespace {

using Formula = ReportContent::Formula;

std::string unit_symbol(const MechanicalSystem& system, const Dimension& dimension) {
  return system.dimensionless ? std::string() : to_string(dimension);
}

/// A start in the unit that the text gives it in.
std::string start_text(const Model& model, std::size_t coordinate, int order, double value,
                       const std::string& si_unit) {
  for (const StartValue& s : model.experiment.start)
    if (s.coordinate == coordinate && s.order == order && !s.unit.empty())
      return quantity(value / s.unit_factor, s.unit);
  return quantity(value, si_unit);
}

ReportContent::Coordinate coordinate_row(const Model& model, const EquationsOfMotion& equations, std::size_t i,
                                         const SimulationResult* run) {
  const MechanicalSystem& system = *equations.system;
  const Coordinate& c = system.coordinates[i];
  const std::string unit = unit_symbol(system, c.dimension);
  ReportContent::Coordinate row{
      lay_out(c.q, equations.order), lay_out(c.velocity, equations.order), "", c.kind, "", ""};
  if (c.name.find('.') != std::string::npos) row.name = c.name;
  if (row.kind.empty() || row.kind == "number") row.kind = unit.empty() || unit == "1" ? "number" : "in " + unit;
  if (!run || run->start.q.size() <= i) return row;
  row.start = start_text(model, i, 0, run->start.q[i], unit);
  row.start_velocity =
      start_text(model, i, 1, run->start.v[i], unit_symbol(system, c.dimension / system.independent_dimension));
  return row;
}

// The value as the text has it, 60 cm, with 0.6 m beside it.
ReportContent::Parameter parameter_row(const EquationsOfMotion& equations, const Parameter& parameter) {
  const std::string si_unit = unit_symbol(*equations.system, parameter.dimension);
  const double factor = parameter.unit_factor;
  const Layout symbol = lay_out(parameter.symbol, equations.order);
  if (parameter.unit.empty()) return {symbol, short_number(parameter.si_value, 10), si_unit == "1" ? "" : si_unit, ""};
  const bool same = parameter.unit == si_unit || factor == 1;
  return {symbol, short_number(parameter.si_value / factor, 10), parameter.unit,
          same ? std::string() : quantity(parameter.si_value, si_unit, 10)};
}

/// Freedoms, and what each constraint is, near where the run begins.
void add_freedoms(ReportContent& content, const EquationsOfMotion& equations, const SimulationResult* run) {
  const MechanicalSystem& system = *equations.system;
  const auto add = [&](std::string name, std::string value) {
    content.summary.emplace_back(std::move(name), std::move(value));
  };
  if (!system.constrained()) return add("freedoms", fmt::format("{}", system.coordinates.size()));
  MotionState start;
  if (run) start = {run->start.t, run->start.q, run->start.v};
  const ConstraintAnalysis analysis = analyse_constraints(equations, run ? &start : nullptr);
  add("freedoms", fmt::format("{}", analysis.configuration_freedoms));
  if (analysis.instantaneous_freedoms != analysis.configuration_freedoms)
    add("instantaneous freedoms", fmt::format("{}", analysis.instantaneous_freedoms));
  for (std::size_t i = 0; i < analysis.constraints.size(); ++i) {
    const ConstraintReport& c = analysis.constraints[i];
    add(system.constraint_label(i),
        fmt::format("{}, {}{}", words(c.constraint_class), c.scleronomic ? "scleronomic" : "rheonomic",
                    c.redundant ? ", redundant" : ""));
  }
}

void add_model(ReportContent& content, const Model& model, const SourceText& source, const EquationsOfMotion& equations,
               const SimulationResult* run) {
  const MechanicalSystem& system = model.system;
  content.name = system.name;
  content.title = system.title.empty() ? system.name : system.title;
  content.source = system.source;
  content.file = source.name() == "-" ? "" : source.name().substr(source.name().rfind('/') + 1);
  content.model_text = source.text();
  if (system.dimensionless) content.summary.emplace_back("units", "dimensionless");
  for (std::size_t i = 0; i < system.coordinates.size(); ++i)
    content.coordinates.push_back(coordinate_row(model, equations, i, run));
  for (const Parameter& parameter : system.parameters)
    if (parameter.symbol.role() == Role::Parameter) content.parameters.push_back(parameter_row(equations, parameter));
  for (const Definition& definition : system.definitions)
    if (definition.symbol)
      content.definitions.push_back(
          {lay_out(definition.symbol, equations.order), lay_out(definition.value, equations.order), "", ""});
  for (const Input& input : system.inputs)
    content.definitions.push_back(
        {lay_out(input.symbol, equations.order), lay_out(input.formula, equations.order), "", ""});
}

std::vector<Formula> intermediate_rows(std::span<const Intermediate> intermediates, const ReadingOrder& order) {
  std::vector<Formula> rows;
  for (const Intermediate& i : intermediates)
    rows.push_back({lay_out(i.symbol, order), lay_out(i.value, order), "", ""});
  return rows;
}

void add_equations(ReportContent& content, const Derivation& derivation, const ReadingOrder& order) {
  for (std::size_t i = 0; i < derivation.equations.size(); ++i) {
    const bool constrained = !derivation.constraint_forces.empty();
    content.equations.push_back({lay_out(derivation.equations[i], order),
                                 constrained ? lay_out(derivation.constraint_forces[i], order) : layouts::number("0"),
                                 "", ""});
  }
  for (const ConstraintEquation& c : derivation.constraints)
    content.equations.push_back({lay_out(c.left, order), lay_out(c.right, order), "", c.name});
  content.intermediates = intermediate_rows(derivation.intermediates, order);
  static constexpr std::array<std::string_view, 5> energies{"T", "V", "U", "D", "L"};
  for (const auto name : energies)
    for (const DerivationStep& step : derivation.steps)
      if (step.right && to_plain(step.left) == name)
        content.energies.push_back({step.left, lay_out(step.right, order), "", ""});
}

constexpr std::size_t most_names = 100;  // of a section: of an arm's equations in full there are thousands

/// What stands in the lines of a section and is not written there.
void tell_names_left_out(std::vector<ReportContent::Section>& sections, std::size_t names, std::string_view command) {
  if (names == 0) return;
  sections.back().lines.push_back(
      {{}, {}, "", fmt::format("{} more names stand in these lines; `maup {}` writes them all.", names, command)});
}

/// Ends with Interrupted between two steps: a table of thousands of pieces stands in many of them.
std::vector<ReportContent::Section> sections_of(const std::vector<DerivationStep>& steps, const ReadingOrder& order,
                                                const Interrupt& interrupt, std::string_view command) {
  std::vector<ReportContent::Section> sections;
  std::size_t names = 0;  // of this section
  const auto left_out = [&] { return names > most_names ? names - most_names : 0; };
  for (const DerivationStep& step : steps) {
    interrupt.throw_if_asked();
    if (sections.empty() || sections.back().title != step.section) {
      tell_names_left_out(sections, left_out(), command);
      sections.push_back({step.section, {}});
      names = 0;
    }
    auto& lines = sections.back().lines;
    Formula line{step.left, {}, step.rule, step.sentence};
    if (step.right)
      line.right = lay_out(step.right, order);
    else
      line.left = {};
    // An equation reads `… = 0`, not `0 = …`.
    if (step.is_equation()) std::swap(line.left, line.right);
    lines.push_back(line);
    const std::size_t shown = std::min(step.intermediates.size(), most_names - std::min(most_names, names));
    for (Formula& where : intermediate_rows(std::span(step.intermediates).first(shown), order)) {
      where.rule = "with";
      lines.push_back(std::move(where));
    }
    names += step.intermediates.size();
  }
  tell_names_left_out(sections, left_out(), command);
  return sections;
}

void add_phase_space(ReportContent& content, const EquationsOfMotion& equations) {
  const Hamiltonian h = hamiltonian(equations);
  const auto r = routhian(equations, h);
  content.phase_space = sections_of(phase_space_lines(h, r ? &*r : nullptr, equations), h.order,
                                    interrupt_of(*equations.system->context), "hamiltonian");
  content.phase_space_certified =
      h.value && certify(h, equations).passed() && (!r || !r->value || certify(*r, h, equations).passed());
}

std::string_view verdict_word(Verdict verdict) {
  return verdict == Verdict::Zero ? "agrees" : verdict == Verdict::Nonzero ? "differs" : "undecided";
}

}  // namespace

void add_certificate(ReportContent& content, const Certificate& certificate) {
  content.certified = certificate.passed();
  for (const CertificateCheck& check : certificate.checks) {
    std::string statement = check.statement;
    if (check.applies && check.verdict != Verdict::Zero && !check.reason.empty()) statement += " " + check.reason;
    content.certificate.push_back({check.name, statement, std::string(verdict_word(check.verdict)),
                                   check.verdict == Verdict::Zero, check.applies, check.points, check.error_bound});
  }
}

void add_messages(ReportContent& content, const Diagnostics& diagnostics, const SourceText& source) {
  for (const Diagnostic& d : diagnostics.items()) {
    if (d.severity == Severity::Error) continue;
    ReportContent::Message message{d.severity, d.code, d.message, d.reason, d.help, 0, ""};
    if (d.span && d.span->source == source.id()) {  // else it is about a text beside the model
      message.line = source.locate(d.span->begin).line;
      message.text = source.line(message.line);
    }
    content.messages.push_back(std::move(message));
  }
}

namespace {

/// The titles of the derivation that a note of this place goes to, the best one first.
std::vector<std::string_view> sections_for(Note::Place place) {
  switch (place) {
    case Note::Place::Coordinates:
      return {"Coordinates"};
    case Note::Place::Positions:
      return {"Positions", "Angular velocities", "Kinetic energy"};
    case Note::Place::KineticEnergy:
      return {"Kinetic energy", "Lagrangian"};
    case Note::Place::PotentialEnergy:
      return {"Potential energy", "Lagrangian"};
    case Note::Place::Lagrangian:
      return {"Lagrangian", "Lagrangian density"};
    case Note::Place::Forces:
      return {"Generalized forces", "Lagrangian"};
    case Note::Place::Constraints:
      return {"Constraints"};
    case Note::Place::Beginning:
    case Note::Place::End:
      return {};
  }
  return {};
}

}  // namespace

void add_notes(ReportContent& content, const Model& model) {
  for (const Note& note : model.notes) {
    std::vector<std::string>* notes = note.place == Note::Place::End ? &content.last_notes : &content.notes;
    for (const std::string_view title : sections_for(note.place)) {
      const auto found = std::find_if(content.derivation.begin(), content.derivation.end(),
                                      [&](const auto& section) { return section.title == title; });
      if (found == content.derivation.end()) continue;
      notes = &found->notes;
      break;
    }
    notes->push_back(note.text);
  }
}

ReportContent compose_report(const Model& model, const SourceText& source, const EquationsOfMotion& equations,
                             const Derivation& derivation, const Certificate& certificate, const ReportParts& parts,
                             const SectionGuard& guard) {
  ReportContent content;
  // What a section has put into the content before it was given up is taken back.
  const auto section = [&](std::string_view name, const std::function<void()>& work) {
    if (!guard) return work();
    ReportContent before = content;
    if (!guard(name, work)) content = std::move(before);
  };
  section("model", [&] { add_freedoms(content, equations, parts.simulation); });
  add_model(content, model, source, equations, parts.simulation);
  section("equations", [&] { add_equations(content, derivation, equations.order); });
  section("derivation", [&] {
    content.derivation =
        sections_of(derivation.steps, equations.order, interrupt_of(*equations.system->context), "derive --steps");
  });
  add_notes(content, model);
  section("phase-space", [&] { add_phase_space(content, equations); });
  add_certificate(content, certificate);
  section("conserved", [&] {
    add_conserved(content, equations, conserved_quantities(equations), parts.simulation, parts.invariants);
  });
  if (parts.simulation)
    section("motion", [&] {
      add_motion(content, model, equations, conserved_quantities(equations).energy_conserved, *parts.simulation);
    });
  section("modes", [&] {
    if (parts.modes) add_modes(content, model, equations, *parts.modes);
    if (parts.locus) add_loci(content, model.system, *parts.locus);
  });
  section("orbits", [&] { add_orbits(content, model.system, parts); });
  if (parts.paths) section("paths", [&] { add_action(content, model.system, *parts.paths); });
  if (parts.verification) content.expectations = parts.verification->results;
  return content;
}

}  // namespace maupertuis
