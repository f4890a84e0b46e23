#include "hamiltonian_text.hpp"

#include "derivation_text.hpp"

#include <fmt/format.h>

#include <maupertuis/print.hpp>

namespace maupertuis::app {
namespace {

const char* word_of(LegendreKind kind) {
  switch (kind) {
    case LegendreKind::Quadratic:
      return "quadratic";
    case LegendreKind::Implicit:
      return "implicit";
    case LegendreKind::Root:
      return "root";
    case LegendreKind::Singular:
      return "singular";
    case LegendreKind::Unsolved:
      return "unsolved";
  }
  return "";
}

std::vector<DerivationStep> all_lines(const PhaseSpace& found) {
  const ReadingOrder& order = found.hamiltonian.order;
  std::vector<DerivationStep> lines = found.lines;
  for (const Bracket& b : found.brackets)
    lines.push_back({b.dirac ? "Dirac brackets" : "Poisson brackets",
                     {},
                     layouts::braces(lay_out(b.a, order), lay_out(b.b, order)),
                     b.value.value,
                     {},
                     b.value.intermediates});
  return lines;
}

std::string plain_line(const DerivationStep& line, const ReadingOrder& order) {
  if (!line.right) return line.sentence;
  const std::string right = to_plain(line.right, order);
  return line.is_equation() ? right + " = 0" : to_plain(line.left) + " = " + right;
}

/// What the names in a form stand for that are its own.
Json intermediates_json(const ReadableForm& form, const ReadingOrder& order) {
  Json list = Json::array();
  for (const Intermediate& i : form.intermediates)
    list.push_back({{"name", to_plain(i.symbol, order)},
                    {"plain", to_plain(i.value, order)},
                    {"latex", to_latex(i.value, order)}});
  return list;
}

Json form_json(const ReadableForm& form, const ReadingOrder& order) {
  if (!form.value) return {};
  return {{"plain", to_plain(form, order)},
          {"latex", to_latex(form, order)},
          {"intermediates", intermediates_json(form, order)}};
}

/// As the text has it: rows that would fill pages are written by shared parts there, whose names are definitions.
ReadableForm as_shown(const PhaseSpace& found, const std::string& section, Expr left, const ReadableForm& otherwise) {
  const std::string wanted = to_plain(left, found.hamiltonian.order);
  for (const DerivationStep& line : found.lines)
    if (line.section == section && line.right && to_plain(line.left) == wanted)
      return {line.right, line.intermediates, {}};
  return otherwise;
}

constexpr const char* canonical_equations = "Canonical equations";

std::vector<CanonicalEquation> as_shown(const PhaseSpace& found, std::vector<CanonicalEquation> equations) {
  for (CanonicalEquation& e : equations)
    if (e.right.value) e.right = as_shown(found, canonical_equations, e.left, e.right);
  return equations;
}

Json equations_json(const std::vector<CanonicalEquation>& equations, const ReadingOrder& order) {
  Json list = Json::array();
  for (const CanonicalEquation& e : equations) {
    Json one{{"left", symbol_to_plain(e.left)}};
    if (e.right.value) one.update(form_json(e.right, order));
    one["has_velocities"] = e.has_velocities;
    list.push_back(std::move(one));
  }
  return list;
}

ReadableForm momentum_form(const PhaseSpace& found, std::size_t i) {
  const Hamiltonian& h = found.hamiltonian;
  return as_shown(found, "Momenta", h.momenta[i], {h.momentum_values[i], {}, {}});
}

/// q' = …; of a velocity that is not written out the equation it follows from, together with the others of its group: p
/// = ….
Json velocities_json(const PhaseSpace& found) {
  const Hamiltonian& h = found.hamiltonian;
  Json list = equations_json(as_shown(found, h.velocities), h.order);
  for (std::size_t i = 0; i < h.velocities.size(); ++i) {
    list[i]["implicit"] = !h.velocities[i].right.value;
    if (h.velocities[i].right.value) continue;
    list[i]["velocity"] = list[i]["left"];
    list[i]["left"] = symbol_to_plain(h.momenta[i]);
    list[i]["has_velocities"] = true;
    list[i].update(form_json(momentum_form(found, i), h.order));
  }
  return list;
}

/// H as the text has it: in momenta, and where M⁻¹ is too long to be written out in velocities as well.
Json energy_json(const PhaseSpace& found) {
  const Hamiltonian& h = found.hamiltonian;
  if (h.legendre.readable.value) return form_json(h.legendre.readable, h.order);
  for (const DerivationStep& line : found.lines)
    if (line.right && to_plain(line.left) == "H") {
      Json out = form_json({line.right, line.intermediates, {}}, h.order);
      out["has_velocities"] = true;
      return out;
    }
  return {};
}

Json routhian_json(const Routhian& r, const Hamiltonian& h) {
  const auto names = [&](const std::vector<std::size_t>& coordinates) {
    Json list = Json::array();
    for (const std::size_t i : coordinates) list.push_back(h.system->coordinates[i].name);
    return list;
  };
  Json rows = Json::array();
  for (const ReadableForm& row : r.equations) rows.push_back(form_json(row, r.order));
  return {{"replaced", names(r.replaced)},
          {"conserved", r.conserved},
          {"value", form_json(r.readable, r.order)},
          {"effective_potential", form_json(r.effective_potential, r.order)},
          {"velocities", equations_json(r.velocities, r.order)},
          {"equations", std::move(rows)}};
}

Json dirac_json(const DiracAnalysis& dirac, const Hamiltonian& h) {
  Json constraints = Json::array(), generators = Json::array();
  for (const PhaseConstraint& c : dirac.constraints)
    constraints.push_back({{"generation", c.generation}, {"plain", to_plain(c.value, h.order)}});
  for (const GaugeGenerator& g : dirac.generators) {
    Json parts = Json::array();
    for (const Expr& part : g.parts) parts.push_back(to_plain(part, h.order));
    generators.push_back(std::move(parts));
  }
  const bool closed = dirac.outcome == ConstraintChain::Outcome::Closed;
  return {{"closed", closed},
          {"constraints", std::move(constraints)},
          {"first_class", dirac.first_class},
          {"second_class", dirac.second_class},
          {"physical_dimension", dirac.physical_dimension},
          {"free_multipliers", dirac.primary_first_class},
          {"gauge_generators", std::move(generators)}};
}

}  // namespace

std::string phase_space_text(const PhaseSpace& found) {
  const Hamiltonian& h = found.hamiltonian;
  std::string out = h.system->name.empty() ? "Phase space\n" : fmt::format("Phase space of {}\n", h.system->name),
              section;
  for (const DerivationStep& line : all_lines(found)) {
    if (line.section != section) out += fmt::format("\n{}\n", section = line.section);
    out += "  " + plain_line(line, h.order) + "\n";
    for (const Intermediate& i : line.intermediates)
      out += fmt::format("    with {} = {}\n", to_plain(i.symbol, h.order), to_plain(i.value, h.order));
  }
  if (!h.legend.empty()) out += "\nDefinitions\n";
  for (const Intermediate& i : h.legend)
    out += fmt::format("  {} = {}\n", to_plain(i.symbol, h.order), to_plain(i.value, h.order));
  return found.certificate.checks.empty() ? out : out + certificate_text(found.certificate);
}

std::string phase_space_text(const PhaseSpace& found, Notation notation) {
  const MechanicalSystem& system = *found.hamiltonian.system;
  const ReadingOrder& order = found.hamiltonian.order;
  std::vector<FormulaLine> lines;
  for (FormulaLine& line : step_lines(all_lines(found), system, order)) {
    line.note.clear();
    line.section.clear();
    if (!line.right.empty()) lines.push_back(std::move(line));
  }
  for (const Intermediate& i : found.hamiltonian.legend) lines.push_back(definition_line(i, system, order));
  return document(lines, notation);
}

void add_to(Json& document, const PhaseSpace& found) {
  const Hamiltonian& h = found.hamiltonian;
  document["system"] = h.system->name;
  document["coordinates"] = document["momenta"] = document["groups"] = Json::array();
  for (std::size_t i = 0; i < h.momenta.size(); ++i) {
    document["coordinates"].push_back(h.system->coordinates[i].name);
    Json row{{"name", symbol_to_plain(h.momenta[i])}};
    row.update(form_json(momentum_form(found, i), h.order));
    document["momenta"].push_back(std::move(row));
  }
  for (const LegendreBlock& block : h.legendre.blocks) {
    Json names = Json::array(), constraints = Json::array();
    for (const std::size_t i : block.coordinates) names.push_back(h.system->coordinates[i].name);
    for (const Expr& c : block.primary_constraints) constraints.push_back(to_plain(c, h.order));
    document["groups"].push_back({{"coordinates", std::move(names)},
                                  {"kind", word_of(block.kind)},
                                  {"primary_constraints", std::move(constraints)}});
  }
  document["regular"] = h.regular();
  document["hamiltonian"] = energy_json(found);
  document["velocities"] = velocities_json(found);
  document["forces"] = equations_json(as_shown(found, h.forces), h.order);
  document["routhian"] = found.routhian ? routhian_json(*found.routhian, h) : Json();
  document["dirac"] = found.dirac ? dirac_json(*found.dirac, h) : Json();
  document["brackets"] = Json::array();
  for (const Bracket& b : found.brackets) {
    Json one{{"a", to_plain(b.a, h.order)}, {"b", to_plain(b.b, h.order)}, {"kind", b.dirac ? "dirac" : "poisson"}};
    one.update(form_json(b.value, h.order));
    document["brackets"].push_back(std::move(one));
  }
  document["definitions"] = Json::array();
  for (const Intermediate& i : h.legend)
    document["definitions"].push_back({{"name", to_plain(i.symbol, h.order)}, {"plain", to_plain(i.value, h.order)}});
  for (const DerivationStep& line : found.lines)
    for (const Json& i : intermediates_json({line.right, line.intermediates, {}}, h.order))
      document["definitions"].push_back({{"name", i["name"]}, {"plain", i["plain"]}});
  document["certificate"] = to_json(found.certificate);
}

}  // namespace maupertuis::app
