#include "studio/in_rates.hpp"
#include "studio/requests.hpp"
#include "studio/stroboscopic.hpp"
#include "studio/verified.hpp"

#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/contact_mode.hpp>
#include <maupertuis/evaluate.hpp>
#include <maupertuis/field_report.hpp>
#include <maupertuis/field_verification.hpp>
#include <maupertuis/invariants.hpp>
#include <maupertuis/print.hpp>
#include <maupertuis/transform.hpp>

#include <algorithm>

namespace maupertuis::studio {
namespace {

std::string unit_of(const MechanicalSystem& system, const Dimension& dimension) {
  const std::string unit = system.dimensionless ? std::string() : to_string(dimension);
  return unit == "1" ? std::string() : unit;
}

/// Sliders need numbers where a report has words.
Json coordinates_json(const Model& model, const ReadingOrder& order, const std::optional<ConsistentStart>& start) {
  const MechanicalSystem& system = model.system;
  Json list = Json::array();
  for (std::size_t i = 0; i < system.coordinates.size(); ++i) {
    const Coordinate& c = system.coordinates[i];
    list.push_back({{"name", c.name},
                    {"symbol", formula_json(lay_out(c.q, order))},
                    {"velocity", formula_json(lay_out(c.velocity, order))},
                    {"kind", c.kind},
                    {"unit", unit_of(system, c.dimension)},
                    {"velocity_unit", unit_of(system, c.dimension / system.independent_dimension)},
                    {"q", start ? number_or_null(start->state.q[i]) : Json()},
                    {"v", start ? number_or_null(start->state.v[i]) : Json()}});
  }
  return list;
}

Json parameters_json(const MechanicalSystem& system, const ReadingOrder& order, const Units& units) {
  Json list = Json::array();
  for (const Parameter& p : system.parameters) {
    if (p.symbol.role() != Role::Parameter) continue;
    const std::string si_unit = unit_of(system, p.dimension);
    const bool converted = !p.unit.empty() && p.unit_factor != 1;
    list.push_back({{"name", p.name},
                    {"symbol", formula_json(lay_out(p.symbol, order))},
                    {"value", number_or_null(converted ? p.si_value / p.unit_factor : p.si_value)},
                    {"unit", p.unit.empty() ? si_unit : p.unit},
                    {"si", number_or_null(p.si_value)},
                    {"si_unit", si_unit},
                    {"used", p.used},
                    {"from", units.of_byte(p.span.begin)},
                    {"to", units.of_byte(p.span.end)}});
  }
  return list;
}

Json checks_json(const std::vector<ReportContent::Check>& checks) {
  Json list = Json::array();
  for (const auto& c : checks)
    list.push_back({{"name", c.name},
                    {"statement", c.statement},
                    {"verdict", c.verdict},
                    {"passed", c.passed},
                    {"applies", c.applies},
                    {"points", c.points},
                    {"error_bound", c.error_bound}});
  return list;
}

Json content_json(const ReportContent& content, bool with_steps) {
  Json out = {{"name", content.name},
              {"title", content.title},
              {"source", content.source},
              {"summary", pairs_json(content.summary)},
              {"certified", content.certified},
              {"certificate", checks_json(content.certificate)},
              {"definitions", lines_json(content.definitions)},
              {"energies", lines_json(content.energies)},
              {"energies_title", content.energies_title},
              {"equations", lines_json(content.equations)},
              {"intermediates", lines_json(content.intermediates)},
              {"conserved", conserved_json(content.conserved)},
              {"first_notes", content.notes},
              {"last_notes", content.last_notes}};
  if (with_steps) out["derivation"] = sections_json(content.derivation);
  return out;
}

Json equations_of_fields(Desk& desk, Study& study, bool steps) {
  const FieldEquations& equations = *study.field_equations();
  const FieldCurrents currents = field_currents(equations);
  FieldReportParts parts;
  parts.currents = &currents;
  parts.with_derivation = steps;
  const ReportContent content =
      compose_field_report(*study.model(), study.source(), equations, *study.field_certificate(), parts);
  Json out = content_json(content, steps);
  out["coordinates"] = Json::array();
  out["parameters"] = parameters_json(study.model()->system, equations.order, desk.units());
  out["contacts"] = Json::array();
  return out;
}

/// The names of the modes of contacts and frictions that a reader may ask for, the free one first.
Json modes_json(const MechanicalSystem& system) {
  constexpr std::size_t most = 16;
  Json list = Json::array();
  for (const ContactMode& mode : modes_to_show(system, open_mode(system), most)) {
    const std::string text = mode_text(system, mode);
    list.push_back(text.empty() ? "free" : text);
  }
  return list;
}

/// When the equations of a model with contacts or dry friction hold.
std::string when_they_hold(const std::string& mode) {
  if (mode.empty())
    return "These are the equations without contact and without dry friction. While a contact is closed, or friction "
           "sticks or slides, others hold: those of its mode.";
  if (mode == "free") return "These are the equations without contact and without dry friction.";
  return "These are the equations of the mode `" + mode + "`.";
}

/// Of the text as it stands: a system that is in one mode has no other.
void add_modes(Json& out, Desk& desk, const Work& work) {
  const Model* whole = desk.document().model();
  if (!whole || !whole->system.has_modes()) return;
  out["modes"] = modes_json(whole->system);
  out["holds"] = when_they_hold(text_of(work.request, "mode"));
}

/// In the order of the text; `notes` of the sections of a derivation say where they are read out.
Json notes_json(const Study& study, const Model& model) {
  Json list = Json::array();
  for (const Note& note : model.notes)
    list.push_back({{"line", study.source().locate(note.span.begin).line}, {"text", note.text}});
  return list;
}

}  // namespace

Json equations(Desk& desk, const Work& work) {
  const bool steps = is_true(work.request, "steps");
  Study& study = desk.certified(work.request);
  Json out;
  Diagnostics found;
  if (study.has_fields()) {
    const InterruptScope scope = study.interruptible();
    out = equations_of_fields(desk, study, steps);
  } else {
    const Model& model = *study.model();
    const EquationsOfMotion& equations = *study.equations();
    const InterruptScope scope = study.interruptible();
    const auto wanted = [&](std::string_view section, const std::function<void()>& part) {
      const bool shown =
          section == "model" || section == "equations" || section == "conserved" || (section == "derivation" && steps);
      if (shown) part();
      return shown;
    };
    const ReportContent content =
        compose_report(model, study.source(), equations, *study.derivation(true), *study.certificate(), {}, wanted);
    out = content_json(content, steps);
    if (Json in_rates = equations_in_rates_json(study, content); !in_rates.is_null()) {
      out["certificate"].push_back(in_rates["check"]);
      in_rates.erase("check");
      out["in_rates"] = std::move(in_rates);
    }
    const auto start = look_into_start(model, equations, found).start;
    out["coordinates"] = coordinates_json(model, equations.order, start);
    out["parameters"] = parameters_json(model.system, equations.order, desk.units());
    out["sections"] = stroboscopic_sections(equations);
    out["contacts"] = Json::array();
    for (std::size_t k = 0; k < model.system.contacts.size(); ++k)
      out["contacts"].push_back({{"name", model.system.contact_label(k)}});
  }
  add_modes(out, desk, work);
  out["notes"] = notes_json(study, *study.model());
  out["diagnostics"] = desk.diagnostics(study, found);
  return out;
}

Json phase_space(Desk& desk, const Work& work) {
  Study& study = desk.certified(work.request);
  if (study.refuse_modes() || !study.equations()) desk.refuse(study);
  const InterruptScope scope = study.interruptible();
  const ReportContent content =
      compose_report(*study.model(), study.source(), *study.equations(), *study.derivation(true), *study.certificate(),
                     {}, [](std::string_view section, const std::function<void()>& part) {
                       if (section == "phase-space") part();
                       return section == "phase-space";
                     });
  return {{"sections", sections_json(content.phase_space)}, {"certified", content.phase_space_certified}};
}

Json conserved(Desk& desk, const Work& work) {
  Study& study = desk.certified(work.request);
  if (study.refuse_modes() || !study.equations()) desk.refuse(study);
  const InterruptScope scope = study.interruptible();
  InvariantsOptions search;
  search.largest_basis = 600;  // a page is not worth a long search
  search.drift = false;
  Diagnostics said;
  const auto found = find_invariants(*study.model(), *study.equations(), search, said);
  ReportParts parts;
  parts.invariants = found ? &*found : nullptr;
  const ReportContent content =
      compose_report(*study.model(), study.source(), *study.equations(), *study.derivation(true), *study.certificate(),
                     parts, [](std::string_view section, const std::function<void()>& part) {
                       if (section == "conserved") part();
                       return section == "conserved";
                     });
  return {{"conserved", conserved_json(content.conserved)},
          {"diagnostics", diagnostics_json(said, study.texts(), desk.units())}};
}

Json result_json(const ExpectationResult& r) {
  return {{"line", r.line},       {"text", r.text},         {"claim", r.claim},         {"passed", r.passed},
          {"actual", r.actual},   {"expected", r.expected}, {"tolerance", r.tolerance}, {"uncertainty", r.uncertainty},
          {"message", r.message}, {"pitfall", r.pitfall},   {"where", r.where}};
}

std::optional<Verification> verification_of(Study& study, const Interrupt& interrupt) {
  SimulationOptions options;
  options.interrupt = interrupt;
  auto out = study.verification(options);
  interrupt.throw_if_asked();
  return out;
}

Json expectations(Desk& desk, const Work& work) {
  Study& study = desk.study(work.request);
  const auto found = verification_of(study, work.interrupt);
  if (!found) desk.refuse(study);
  Json results = Json::array();
  for (const ExpectationResult& r : found->results) results.push_back(result_json(r));
  return {{"results", std::move(results)}, {"diagnostics", desk.diagnostics(study)}};
}

}  // namespace maupertuis::studio
