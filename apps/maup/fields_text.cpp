#include "fields_text.hpp"

#include "derivation_text.hpp"
#include "happenings_text.hpp"
#include "outcome.hpp"

#include <fmt/format.h>

#include <maupertuis/coupled_fields.hpp>
#include <maupertuis/diagram.hpp>
#include <maupertuis/print.hpp>
#include <maupertuis/stress_energy.hpp>

#include <cmath>

namespace maupertuis::app {
namespace {

std::string number_text(double value) { return fmt::format("{:.6g}", value); }

const FieldEquations& equations_of(Study& study) { return *study.field_equations(); }

Layout shown(const FieldEquations& equations, Expr e) {
  return field_layout(equations.system(), lay_out(readable(e, equations.order), equations.order));
}

std::string plain_of(const FieldEquations& equations, Expr e) { return to_plain(shown(equations, e)); }

/// "at both ends of x", "where u is not given"
std::string where_natural(const FieldEquations& equations, const NaturalAtEnds& at) {
  const FieldSystem& s = equations.system();
  const NaturalCondition& n = equations.natural[at.natural];
  const std::string& x = s.space[n.along].name;
  const std::string name = s.fields[n.field].name + (n.moment ? "_" + x : "");
  if (s.periodic(n.along))
    return fmt::format("where δ{} is free; the domain is periodic{} and has no end{}", name,
                       s.periodic() ? "" : " along " + x, s.periodic() ? "" : " there");
  if (!s.space[n.along].from) return fmt::format("at an end of {} where {} is free", x, name);
  if (at.first && at.last) return fmt::format("at both ends of {}, where {} is free", x, name);
  const char* const ends[][2] = {{"left", "right"}, {"bottom", "top"}, {"first", "last"}};
  if (at.first || at.last) return fmt::format("at the {} end of {}, where {} is free", ends[n.along][at.last], x, name);
  return fmt::format("nowhere: {} is given or held at both ends of {}", name, x);
}

FormulaLine line_of(Layout left, Layout right, std::string section, std::string note) {
  FormulaLine line;
  line.left = std::move(left);
  line.right = std::move(right);
  line.section = std::move(section);
  line.note = std::move(note);
  return line;
}

Layout zero() { return layouts::number("0"); }

/// δℒ/δφ step by step: the partial derivatives of ℒ, their total derivatives, the equation.
void add_steps(const FieldEquations& equations, std::vector<FormulaLine>& out) {
  const FieldSystem& s = equations.system();
  const std::string section = "Partial derivatives of the density";
  out.push_back(line_of(layouts::name("ℒ"), shown(equations, s.density), "The density", "given"));
  for (const Expr& symbol : s.jets_in(s.density)) {
    if (s.fields[s.jet_of(symbol)->field].given) continue;
    const Expr slope = differentiate(s.density, symbol);
    const FieldJet jet = *s.jet_of(symbol);
    out.push_back(line_of(layouts::labelled(fmt::format("∂ℒ/∂{}", s.jet_name(jet)),
                                            layouts::partial(layouts::name("ℒ"), jet_with_subscripts(s, jet))),
                          shown(equations, slope), section, "all other derivatives held fixed"));
  }
}

constexpr const char* interface_section = "Conditions where fields and bodies meet";
constexpr const char* coordinate_section = "Equations of the coordinates";
constexpr const char* constraint_section = "Constraints";

std::string where_interface(const FieldEquations& equations, const InterfaceCondition& c) {
  const FieldSystem& s = equations.system();
  const std::string place = fmt::format("{} = {}", s.space.front().name, place_text(equations, c.place));
  if (!c.coordinate) return fmt::format("at {}, where the density changes", place);
  return fmt::format("at {}{}", place, c.end ? "" : ", from both sides");
}

/// A row = 0 and what its names stand for.
void add_row(const FieldEquations& equations, Expr row, Expr own, const char* section, const std::string& note,
             std::vector<FormulaLine>& out) {
  ReadingOrder order = coupled_order(equations);
  order.own = own;
  const auto page = [&](Layout l) { return field_layout(equations.system(), coupled_layout(equations, std::move(l))); };
  const ReadableForm form = readable_row(equations, row, own);
  out.push_back(line_of(page(lay_out(form, order)), zero(), section, note));
  for (const Intermediate& i : form.intermediates)
    out.push_back(line_of(layouts::symbol(i.symbol), page(lay_out(i.value, order)), section, ""));
}

void add_coupled_lines(const FieldEquations& equations, std::vector<FormulaLine>& out) {
  for (const InterfaceCondition& c : equations.interfaces)
    add_row(equations, c.value, jet_at_place(equations, {c.field, {c.moment}, 0}, c.place, 0), interface_section,
            where_interface(equations, c), out);
  if (!equations.bodies) return;
  const MechanicalSystem& system = *equations.bodies->shown().system;
  for (const CoordinateRow& r : coordinate_rows(equations))
    add_row(equations, r.value, system.coordinates[r.coordinate].q, coordinate_section, "", out);
  for (std::size_t i = 0; i < system.constraints.size(); ++i)
    add_row(equations, system.constraints[i].value, {}, constraint_section, system.constraint_label(i), out);
}

}  // namespace

std::vector<FormulaLine> field_lines(Study& study, bool with_steps) {
  const FieldEquations& equations = equations_of(study);
  const FieldSystem& s = equations.system();
  std::vector<FormulaLine> out;
  if (with_steps) add_steps(equations, out);
  for (std::size_t a = 0; a < equations.varied.size(); ++a) {
    const ReadableForm form = readable_residual(equations, a);
    ReadingOrder order = equations.order;
    order.own = s.jet_symbol({equations.varied[a], std::vector<int>(s.space.size(), 0), 0});
    out.push_back(line_of(field_layout(s, lay_out(form, order)), zero(), "Field equations", ""));
    for (const Intermediate& i : form.intermediates)
      out.push_back(
          line_of(layouts::symbol(i.symbol), field_layout(s, lay_out(i.value, order)), "Field equations", ""));
  }
  for (const NaturalAtEnds& n : natural_at_ends(equations)) {
    out.push_back(
        line_of(shown(equations, n.value), zero(), "Natural boundary conditions", where_natural(equations, n)));
    out.back().declared = "natural";  // as `expect` has it
  }
  add_coupled_lines(equations, out);
  return out;
}

namespace {

/// i ψ' + 1/2 ψ_xx + abs(ψ)^2 ψ = 0
std::string complex_text(const FieldEquations& equations) {
  std::string out;
  for (const ComplexEquation& e : complex_equations(equations)) {
    const auto text = [&](Expr part) { return to_plain(readable(part, equations.order), equations.order); };
    std::string left = e.im.is_zero() ? "" : e.im.is(Kind::Sum) ? "i (" + text(e.im) + ")" : "i " + text(e.im);
    if (!e.re.is_zero()) left += (left.empty() ? "" : " + ") + text(e.re);
    out += fmt::format("  {} = 0\n", left.empty() ? "0" : left);
  }
  return out.empty() ? out : "\nIn complex form, δℒ/δψ* = 0\n" + out;
}

}  // namespace

namespace {

/// w, S and Θ with their names; `spin`: what the tensor differs from the canonical one by, too.
std::string tensor_text(const FieldEquations& equations, const StressEnergy& tensor, bool spin) {
  const FieldSystem& s = equations.system();
  const std::size_t n = s.space.size();
  const auto name = [&](std::size_t mu) { return mu == n ? std::string("t") : s.space[mu].name; };
  std::string out = fmt::format("\nSymmetric stress-energy tensor, Lorentz-invariant: speed^2 = {}\n",
                                plain_of(equations, tensor.c_squared));
  const auto line = [&](const std::string& head, Expr e) {
    out += fmt::format("  {:<5} = {}\n", head, plain_of(equations, e));
  };
  line("w", tensor.energy_density());
  for (std::size_t i = 0; i < n; ++i) line("S_" + name(i), tensor.energy_flux(i));
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i; j < n; ++j) line("Θ^" + name(i) + name(j), tensor.stress(i, j));
  out += "  w: density of energy, S: its flux, S/speed^2: density of momentum, Θ: its flux\n";
  if (!tensor.has_spin())
    return out + "  It is the canonical tensor.\n  Certified: symmetric, ∂_μ Θ^μν = 0 on solutions.\n";
  if (spin) {
    out += "  It differs from the canonical one by ∂_λ B^λμν, B^λμν = -B^μλν\n";
    for (std::size_t l = 0; l <= n; ++l)
      for (std::size_t m = l + 1; m <= n; ++m)
        for (std::size_t k = 0; k <= n; ++k)
          if (const Expr b = tensor.spin(l, m, k); !b.is_zero()) line("B^" + name(l) + name(m) + name(k), b);
  }
  return out + "  Certified: symmetric, ∂_μ Θ^μν = 0 and Θ^μν - T^μν = ∂_λ B^λμν on solutions.\n";
}

std::optional<StressEnergy> tensor_of(Study& study) {
  const FieldEquations& equations = equations_of(study);
  const InterruptScope scope = study.interruptible();
  return stress_energy(equations, field_currents(equations));
}

Json tensor_json(const FieldEquations& equations, const StressEnergy& tensor) {
  const std::size_t n = tensor.dimensions;
  Json out{{"c_squared", plain_of(equations, tensor.c_squared)},
           {"energy_density", plain_of(equations, tensor.energy_density())},
           {"certified", tensor.certified()}};
  for (std::size_t i = 0; i < n; ++i) {
    Json row = Json::array();
    for (std::size_t j = 0; j < n; ++j) row.push_back(plain_of(equations, tensor.stress(i, j)));
    out["energy_flux"].push_back(plain_of(equations, tensor.energy_flux(i)));
    out["stress"].push_back(row);
  }
  out["spin_part"] = Json::object();
  const FieldSystem& s = equations.system();
  const auto name = [&](std::size_t mu) { return mu == n ? std::string("t") : s.space[mu].name; };
  for (std::size_t l = 0; l <= n; ++l)
    for (std::size_t m = l + 1; m <= n; ++m)
      for (std::size_t k = 0; k <= n; ++k)
        if (const Expr b = tensor.spin(l, m, k); !b.is_zero())
          out["spin_part"][name(l) + name(m) + name(k)] = plain_of(equations, b);
  return out;
}

}  // namespace

std::string fields_lecture(Study& study, bool with_steps) {
  const FieldEquations& equations = equations_of(study);
  std::string out, section;
  for (const FormulaLine& line : field_lines(study, with_steps)) {
    if (line.section != section) out += fmt::format("{}{}\n", out.empty() ? "" : "\n", section = line.section);
    out += fmt::format("  {}{}\n", plain_text(line), line.note.empty() ? "" : "    " + line.note);
  }
  out += complex_text(equations);
  std::string b;
  for (std::size_t mu = 0; mu < equations.boundary_terms.size(); ++mu) {
    const FieldSystem& s = equations.system();
    const std::string name = mu == s.space.size() ? "t" : s.space[mu].name;
    b += fmt::format(
        "  B^{} = {}\n", name,
        to_plain(field_layout(equations.with_variations,
                              lay_out(readable(equations.boundary_terms[mu], equations.order), equations.order))));
  }
  out += fmt::format("\nWhat the variation leaves, δℒ = E·δφ + ∂_μ B^μ\n{}", b);
  if (const auto tensor = tensor_of(study)) out += tensor_text(equations, *tensor, false);
  return out + "\n" + certificate_text(*study.field_certificate());
}

Json fields_json(Study& study) {
  Json document = json_document("derive");
  if (!study.field_equations()) return document;
  const FieldEquations& equations = equations_of(study);
  const FieldSystem& s = equations.system();
  document["system"] = study.model()->system.name;
  document["fields"] = Json::array();
  for (const std::size_t f : equations.varied) document["fields"].push_back(s.fields[f].name);
  document["independent"] = Json::array({"t"});
  for (const SpaceVariable& x : s.space) document["independent"].push_back(x.name);
  document["equations"] = Json::array();
  document["natural"] = Json::array();
  if (equations.bodies || !equations.interfaces.empty())
    for (const char* name : {"interfaces", "coordinates", "constraints"}) document[name] = Json::array();
  std::size_t a = 0;
  for (const FormulaLine& line : field_lines(study, false)) {
    const Json one{{"plain", plain_text(line)}, {"latex", latex_text(line)}};
    if (line.section == interface_section) {
      document["interfaces"].push_back(one);
      document["interfaces"].back()["where"] = line.note;
    } else if (line.section == coordinate_section || line.section == constraint_section) {
      document[line.section == coordinate_section ? "coordinates" : "constraints"].push_back(one);
    } else if (line.section == "Field equations") {
      document["equations"].push_back(one);
      if (a < equations.varied.size()) document["equations"].back()["field"] = s.fields[equations.varied[a++]].name;
    } else {
      document["natural"].push_back(one);
      document["natural"].back()["where"] = line.note;
    }
  }
  document["density"] = plain_of(equations, s.density);
  document["certificate"] = to_json(*study.field_certificate());
  if (const auto tensor = tensor_of(study)) document["stress_energy"] = tensor_json(equations, *tensor);
  return document;
}

namespace {

/// "periodic", "periodic along x"; empty where the domain has all its sides.
std::string periodic_text(const FieldSystem& s) {
  if (s.periodic()) return "periodic";
  std::string out;
  for (std::size_t i = 0; i < s.space.size(); ++i)
    if (s.periodic(i)) out += (out.empty() ? "periodic along " : ", ") + s.space[i].name;
  return out;
}

}  // namespace

std::string fields_summary(Study& study) {
  const FieldEquations& equations = equations_of(study);
  const FieldSystem& s = equations.system();
  const MechanicalSystem& system = study.model()->system;
  std::string out =
      fmt::format("{}{}\n", spoken_name(system), system.title.empty() ? "" : fmt::format(" — {}", system.title));
  const auto line = [&](const std::string& head, const std::string& text) {
    if (!text.empty()) out += fmt::format("  {:<22} {}\n", head, text);
  };
  std::string names, domain;
  for (const std::size_t f : equations.varied)
    names += fmt::format("{}{} : {}", names.empty() ? "" : ", ", s.fields[f].name,
                         s.fields[f].kind.empty() ? to_string(s.fields[f].dimension) : s.fields[f].kind);
  line("fields", names);
  if (equations.bodies) {
    std::string coordinates, places;
    for (const Coordinate& c : system.coordinates) {
      const bool place = s.jet_of_name(std::string_view(c.name).substr(0, c.name.find('('))).has_value();
      std::string& list = place ? places : coordinates;
      list += fmt::format("{}{}", list.empty() ? "" : ", ", c.name);
    }
    line("coordinates", coordinates);
    line("held at places", places);
  }
  Bindings values;
  for (const Parameter& p : system.parameters) values[p.symbol] = p.si_value;
  for (const SpaceVariable& x : s.space) {
    if (!x.from) continue;
    const std::string cells = x.cells ? fmt::format(", {} cells", x.cells) : "";
    domain +=
        fmt::format("{}{} from {} to {} {}{}", domain.empty() ? "" : "; ", x.name,
                    number_text(evaluate(s.expanded(x.from), values)), number_text(evaluate(s.expanded(x.to), values)),
                    system.dimensionless ? "" : to_string(x.dimension), cells);
  }
  line("domain", domain.empty() ? "all space" : domain);
  std::string boundary = periodic_text(s);
  constexpr const char* sides[] = {"left", "right", "bottom", "top"};
  for (const BoundaryCondition& b : s.boundary)
    boundary += fmt::format("{}{} at the {}", boundary.empty() ? "" : ", ",
                            s.jet_name(b.jet) + " = " + plain_of(equations, b.value), sides[static_cast<int>(b.side)]);
  line("boundary", boundary.empty() ? "natural" : boundary);
  std::string contacts, frictions;
  for (std::size_t i = 0; i < system.contacts.size(); ++i) contacts += (i ? ", " : "") + system.contact_label(i);
  for (const Friction& f : system.frictions) frictions += (frictions.empty() ? "" : ", ") + f.name;
  line("contacts", contacts), line("dry friction along", frictions);
  std::string parameters;
  for (const Parameter& p : system.parameters)
    if (p.symbol.role() == Role::Parameter)
      parameters += fmt::format("{}{} = {} {}", parameters.empty() ? "" : ", ", p.name,
                                number_text(p.si_value / p.unit_factor), p.unit);
  line("parameters", parameters);
  line("density", plain_of(equations, s.density));
  const std::size_t expectations = study.model()->experiment.expectations.size() + equations.model->expectations.size();
  if (expectations) line("expectations", fmt::format("{} (run them with `maup test`)", expectations));
  return out + "No mistakes found.\n";
}

std::string currents_text(Study& study) {
  const FieldEquations& equations = equations_of(study);
  const FieldSystem& s = equations.system();
  const FieldCurrents found = field_currents(equations);
  const bool broken = std::any_of(found.currents.begin(), found.currents.end(),
                                  [](const FieldCurrent& c) { return static_cast<bool>(c.source); });
  std::string out = std::string(broken ? "Balance laws" : "Conservation laws") + " ∂_t j^t + ∂_i j^i = Q·E\n";
  for (const FieldCurrent& c : found.currents) {
    out += fmt::format("\n{}: {}\n  j^t = {}\n", c.name, c.meaning, plain_of(equations, c.density));
    for (std::size_t x = 0; x < c.fluxes.size(); ++x)
      out += fmt::format("  j^{} = {}\n", s.space[x].name, plain_of(equations, c.fluxes[x]));
    std::string q;
    for (const Expr& one : c.characteristic) q += (q.empty() ? "" : ", ") + plain_of(equations, one);
    out += fmt::format("  Q   = {}\n", q);
    if (c.source)
      out +=
          fmt::format("  not conserved: Q·E = {} on motions, by friction and forces\n", plain_of(equations, c.source));
    else if (broken)
      out += "  conserved all the same: Q·E = 0 on motions\n";
  }
  if (found.currents.empty()) out += "\nNone was found.\n";
  if (const auto tensor = stress_energy(equations, found)) out += tensor_text(equations, *tensor, true);
  return out + fmt::format("\n{}\n", found.basis);
}

Json currents_json(Study& study) {
  Json document = json_document("invariants");
  if (!study.field_equations()) return document;
  const FieldEquations& equations = equations_of(study);
  const FieldCurrents found = field_currents(equations);
  document["currents"] = Json::array();
  for (const FieldCurrent& c : found.currents) {
    Json fluxes = Json::array(), q = Json::array();
    for (const Expr& one : c.fluxes) fluxes.push_back(plain_of(equations, one));
    for (const Expr& one : c.characteristic) q.push_back(plain_of(equations, one));
    document["currents"].push_back({{"name", c.name},
                                    {"meaning", c.meaning},
                                    {"density", plain_of(equations, c.density)},
                                    {"fluxes", fluxes},
                                    {"characteristic", q},
                                    {"certified", c.certified},
                                    {"conserved", !c.source},
                                    {"source", c.source ? Json(plain_of(equations, c.source)) : Json(0)}});
  }
  document["basis"] = found.basis;
  if (const auto tensor = stress_energy(equations, found)) document["stress_energy"] = tensor_json(equations, *tensor);
  return document;
}

std::optional<FieldRunResult> run_of_fields(Study& study, const SimulationOptions& settings,
                                            const FieldMotionOptions& kept) {
  if (settings.duration && !(*settings.duration > 0)) {
    study.diagnostics().error("E0809", std::nullopt, "a run of a field goes forward",
                              "Its mesh is started at t = 0 and steps on from there.", "Give a positive --duration.");
    return std::nullopt;
  }
  return study.field_motion(settings, kept);
}

std::string dispersion_text(Study& study, std::string& trouble) {
  const FieldEquations& equations = equations_of(study);
  const auto relation = dispersion(equations, trouble);
  if (!relation) return {};
  return plain_of(equations, with_imaginary_unit(*relation)) + " = 0";
}

namespace {

std::string coupled_run_text(const FieldRunResult& run, const MechanicalSystem& system) {
  std::string out = fmt::format("{} elements of order {} ({} unknowns), {} {} to {:.10g} s\n", run.cells, run.order,
                                run.nodes, run.steps, run.method, run.end);
  for (const FieldRunResult::Coordinate& c : run.final_coordinates)
    out += fmt::format("  {:<30} {:.10g}, {}' {:.10g}\n", c.name, c.q, c.name, c.v);
  out += happenings_text(chronicle_of(run), system);
  out += fmt::format("  energy                         {:.16g}\n", run.energy);
  out += run.energy_drift < 0 ? std::string("  energy drift                   forces act: it is not conserved\n")
                              : fmt::format("  energy drift                   {:.3g} of its terms\n", run.energy_drift);
  if (!run.trouble.empty()) out += fmt::format("  it ended early                 {}\n", run.trouble);
  return out + fmt::format("  computed in                    {:.3g} s\n", run.seconds);
}

}  // namespace

namespace {

/// Charges of one label are told apart by their place in the list of conserved quantities.
std::string label_of(const FieldCharge& c, const std::vector<FieldCharge>& all) {
  const auto alike =
      std::count_if(all.begin(), all.end(), [&](const FieldCharge& x) { return x.label() == c.label(); });
  return alike > 1 ? fmt::format("{}, current {}", c.label(), c.current + 1) : c.label();
}

std::string charges_text(const FieldRunResult& run) {
  if (run.charges.empty()) return {};
  std::string out = fmt::format("\n  {:<30} {:>14} {:>14} {:>16}   {}\n", "conserved charges", "at the start",
                                "at the end", "flowed out", "left over");
  for (const FieldCharge& c : run.charges) {
    const std::string out_of = c.booked ? fmt::format("{:.8g}", c.outflow) : "not measured";
    const std::string left = c.booked ? fmt::format("{:.2g} of its terms", c.left_over()) : "";
    out += fmt::format("  {:<30} {:>14.8g} {:>14.8g} {:>16}   {}\n", label_of(c, run.charges), c.start, c.end, out_of,
                       left);
  }
  return out + "\n";
}

Json charges_json(const FieldRunResult& run) {
  Json out = Json::array();
  for (const FieldCharge& c : run.charges)
    out.push_back({{"name", c.name},
                   {"meaning", c.meaning},
                   {"current", c.current},
                   {"start", c.start},
                   {"end", c.end},
                   {"outflow", c.booked ? Json(c.outflow) : Json(nullptr)},
                   {"imbalance", c.booked ? Json(c.imbalance) : Json(nullptr)},
                   {"size", c.size}});
  return out;
}

}  // namespace

std::string field_run_text(const FieldRunResult& run, const MechanicalSystem& system) {
  if (run.coupled) return coupled_run_text(run, system);
  const std::string upwards = run.cells_upwards ? fmt::format(" × {}", run.cells_upwards) : std::string();
  std::string out = fmt::format("{}{} cells of order {} ({} nodes), {} {} to {:.10g} s\n", run.cells, upwards,
                                run.order, run.nodes, run.steps, run.method, run.end);
  out += run.omega_max > 0 ? fmt::format("  highest frequency of the mesh  {:.6g} rad/s, steps at most {:.4g} s\n",
                                         run.omega_max, run.step)
                           : fmt::format("  steps                          at most {:.4g} s\n", run.step);
  for (const FieldRunResult::Range& r : run.at_end)
    out += fmt::format("  {:<30} from {:.6g} to {:.6g}{}\n", r.name + " at the end", r.low, r.high,
                       r.unit == "1" ? "" : " " + r.unit);
  out += fmt::format("  energy                         {:.16g}\n", run.energy);
  out += run.energy_drift < 0 ? std::string("  energy drift                   forces act: it is not conserved\n")
                              : fmt::format("  energy drift                   {:.3g} of its terms\n", run.energy_drift);
  out += charges_text(run);
  return out + fmt::format("  computed in                    {:.3g} s\n", run.seconds);
}

Json field_run_json(const FieldRunResult& run, const MechanicalSystem& system) {
  Json document = json_document("simulate");
  document["statistics"] = {{"cells", run.cells},         {"element_order", run.order}, {"nodes", run.nodes},
                            {"steps", run.steps},         {"method", run.method},       {"step", run.step},
                            {"omega_max", run.omega_max}, {"energy", run.energy},       {"seconds", run.seconds}};
  document["statistics"]["energy_drift"] = run.energy_drift < 0 ? Json(nullptr) : Json(run.energy_drift);
  document["end"] = run.end;
  for (const FieldRunResult::Range& r : run.at_end)
    document["at_end"].push_back({{"field", r.name}, {"unit", r.unit}, {"low", r.low}, {"high", r.high}});
  if (run.coupled) {
    document["final"] = Json::object();
    for (const FieldRunResult::Coordinate& c : run.final_coordinates)
      document["final"][c.name] = c.q, document["final"][c.name + "'"] = c.v;
    put_happenings(document, chronicle_of(run), system);
    if (!run.trouble.empty()) document["trouble"] = run.trouble;
  }
  if (!run.charges.empty()) document["charges"] = charges_json(run);
  if (run.cells_upwards) document["statistics"]["cells_y"] = run.cells_upwards;
  return document;
}

}  // namespace maupertuis::app
