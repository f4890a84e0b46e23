#include "fields_text.hpp"

#include "derivation_text.hpp"

#include <fmt/format.h>

#include <maupertuis/diagram.hpp>
#include <maupertuis/print.hpp>

namespace maupertuis::app {
namespace {

std::string number_text(double value) { return fmt::format("{:.6g}", value); }

const FieldEquations& equations_of(Study& study) { return *study.field_equations(); }

Layout shown(const FieldEquations& equations, Expr e) {
  return field_layout(equations.system(), lay_out(readable(e, equations.order), equations.order));
}

std::string plain_of(const FieldEquations& equations, Expr e) { return to_plain(shown(equations, e)); }

bool is_essential(const FieldSystem& s, const NaturalCondition& n, bool right) {
  if (s.periodic) return true;
  for (const BoundaryCondition& b : s.boundary) {
    const bool side = (b.side == BoundaryCondition::Side::Right || b.side == BoundaryCondition::Side::Top) == right;
    const bool along = (static_cast<int>(b.side) / 2) == static_cast<int>(n.along);
    if (side && along && b.jet.field == n.field && (b.jet.order() == 1) == n.moment) return true;
  }
  return false;
}

/// "at both ends of x", "where u is not given"
std::string where_natural(const FieldSystem& s, const NaturalCondition& n) {
  const std::string& x = s.space[n.along].name;
  const std::string name = s.fields[n.field].name + (n.moment ? "_" + x : "");
  if (s.periodic) return fmt::format("where δ{} is free; the domain is periodic and has no end", name);
  const bool left = !is_essential(s, n, false), right = !is_essential(s, n, true);
  if (!s.space[n.along].from) return fmt::format("at an end of {} where {} is free", x, name);
  if (left && right) return fmt::format("at both ends of {}, where {} is free", x, name);
  if (left || right)
    return fmt::format("at the {} end of {}, where {} is free",
                       n.along == 0 ? (left ? "left" : "right") : (left ? "bottom" : "top"), x, name);
  return fmt::format("nowhere: {} is given at both ends of {}", name, x);
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

/// u_tx with subscripts, below a fraction bar.
Layout with_subscripts(const FieldSystem& s, const FieldJet& jet) {
  const Layout field = layouts::symbol(s.jet_symbol({jet.field, std::vector<int>(s.space.size(), 0), 0}));
  std::vector<Layout> below;
  for (int k = 0; k < jet.time; ++k) below.push_back(layouts::name("t"));
  for (std::size_t x = 0; x < s.space.size(); ++x)
    for (int k = 0; k < jet.space[x]; ++k) below.push_back(layouts::symbol(s.space[x].symbol));
  return below.empty() ? field : layouts::indexed(field, {layouts::product(std::move(below))});
}

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
                                            layouts::partial(layouts::name("ℒ"), with_subscripts(s, jet))),
                          shown(equations, slope), section, "all other derivatives held fixed"));
  }
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
  for (const NaturalCondition& n : equations.natural)
    out.push_back(line_of(shown(equations, n.value), zero(), "Natural boundary conditions", where_natural(s, n)));
  return out;
}

std::string fields_lecture(Study& study, bool with_steps) {
  const FieldEquations& equations = equations_of(study);
  std::string out, section;
  for (const FormulaLine& line : field_lines(study, with_steps)) {
    if (line.section != section) out += fmt::format("{}{}\n", out.empty() ? "" : "\n", section = line.section);
    out += fmt::format("  {}{}\n", plain_text(line), line.note.empty() ? "" : "    " + line.note);
  }
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
  std::size_t a = 0;
  for (const FormulaLine& line : field_lines(study, false)) {
    const Json one{{"plain", plain_text(line)}, {"latex", latex_text(line)}};
    if (line.section == "Field equations") {
      document["equations"].push_back(one);
      if (a < equations.varied.size()) document["equations"].back()["field"] = s.fields[equations.varied[a++]].name;
    } else {
      document["natural"].push_back(one);
      document["natural"].back()["where"] = line.note;
    }
  }
  document["density"] = plain_of(equations, s.density);
  Json checks = Json::array();
  for (const CertificateCheck& check : study.field_certificate()->checks)
    checks.push_back({{"name", check.name}, {"points", check.points}, {"error_bound", check.error_bound}});
  document["certificate"] = {{"passed", study.field_certificate()->passed()}, {"checks", checks}};
  return document;
}

std::string fields_summary(Study& study) {
  const FieldEquations& equations = equations_of(study);
  const FieldSystem& s = equations.system();
  const MechanicalSystem& system = study.model()->system;
  std::string out = fmt::format("{}{}\n", system.name, system.title.empty() ? "" : fmt::format(" — {}", system.title));
  const auto line = [&](const std::string& head, const std::string& text) {
    if (!text.empty()) out += fmt::format("  {:<22} {}\n", head, text);
  };
  std::string names, domain;
  for (const std::size_t f : equations.varied)
    names += fmt::format("{}{} : {}", names.empty() ? "" : ", ", s.fields[f].name,
                         s.fields[f].kind.empty() ? to_string(s.fields[f].dimension) : s.fields[f].kind);
  line("fields", names);
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
  std::string boundary = s.periodic ? "periodic" : "";
  constexpr const char* sides[] = {"left", "right", "bottom", "top"};
  for (const BoundaryCondition& b : s.boundary)
    boundary += fmt::format("{}{} at the {}", boundary.empty() ? "" : ", ",
                            s.jet_name(b.jet) + " = " + plain_of(equations, b.value), sides[static_cast<int>(b.side)]);
  line("boundary", boundary.empty() ? "natural" : boundary);
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
  std::string out = "Conservation laws ∂_t j^t + ∂_i j^i = Q·E\n";
  for (const FieldCurrent& c : found.currents) {
    out += fmt::format("\n{}: {}\n  j^t = {}\n", c.name, c.meaning, plain_of(equations, c.density));
    for (std::size_t x = 0; x < c.fluxes.size(); ++x)
      out += fmt::format("  j^{} = {}\n", s.space[x].name, plain_of(equations, c.fluxes[x]));
    std::string q;
    for (const Expr& one : c.characteristic) q += (q.empty() ? "" : ", ") + plain_of(equations, one);
    out += fmt::format("  Q   = {}\n", q);
  }
  if (found.currents.empty()) out += "\nNone was found.\n";
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
                                    {"certified", c.certified}});
  }
  document["basis"] = found.basis;
  return document;
}

std::optional<FieldRunResult> run_of_fields(Study& study, const SimulationOptions& settings, bool rows, bool pictured) {
  const Model& model = *study.model();
  const FieldSystem& s = equations_of(study).system();
  Bindings values;
  for (const Parameter& p : model.system.parameters) values[p.symbol] = p.si_value;
  const auto number = [&](Expr e) { return e ? evaluate(s.expanded(e), values) : 0.0; };
  FieldRunOptions options;
  options.interrupt = settings.interrupt;
  options.duration = settings.duration ? *settings.duration : number(model.experiment.duration);
  options.every = settings.output_every ? *settings.output_every : number(model.experiment.output_every);
  options.trajectory = rows;
  options.errors = false;
  // A map over time shows what happens between a hundred moments.
  const bool line = s.space.size() == 1;
  if (pictured && !(options.every > 0)) options.every = options.duration / (line ? 240 : 60);
  if (pictured) options.least_values = line ? 480 : 64;
  if (settings.duration && !(*settings.duration > 0)) {
    study.diagnostics().error("E0809", std::nullopt, "a run of a field goes forward",
                              "Its mesh is started at t = 0 and steps on from there.", "Give a positive --duration.");
    return std::nullopt;
  }
  if (!(options.duration > 0)) {
    study.diagnostics().error("E0701", std::nullopt, "the model does not say how long it runs",
                              "A run of a field goes on for a time.", "Add `run 10 s`, or give --duration.");
    return std::nullopt;
  }
  const InterruptScope scope = study.interruptible();
  return run_fields(equations_of(study), {}, options, study.diagnostics());
}

std::string dispersion_text(Study& study, std::string& trouble) {
  const FieldEquations& equations = equations_of(study);
  const auto relation = dispersion(equations, trouble);
  if (!relation) return {};
  std::string out;
  for (const Expr& part : {relation->re, relation->im})
    if (const std::string text = plain_of(equations, part); text != "0")
      out += (out.empty() ? "" : "\n") + text + " = 0";
  return out;
}

std::string field_run_text(const FieldRunResult& run) {
  const std::string upwards = run.cells_upwards ? fmt::format(" × {}", run.cells_upwards) : std::string();
  std::string out = fmt::format("{}{} cells of order {} ({} nodes), {} steps of order 8 to {:.10g} s\n", run.cells,
                                upwards, run.order, run.nodes, run.steps, run.end);
  out +=
      fmt::format("  highest frequency of the mesh  {:.6g} rad/s, steps at most {:.4g} s\n", run.omega_max, run.step);
  out += fmt::format("  energy                         {:.16g}\n", run.energy);
  out += run.energy_drift < 0 ? std::string("  energy drift                   forces act: it is not conserved\n")
                              : fmt::format("  energy drift                   {:.3g} of its terms\n", run.energy_drift);
  return out + fmt::format("  computed in                    {:.3g} s\n", run.seconds);
}

Json field_run_json(const FieldRunResult& run) {
  Json document = json_document("simulate");
  document["statistics"] = {{"cells", run.cells},   {"element_order", run.order}, {"nodes", run.nodes},
                            {"steps", run.steps},   {"step", run.step},           {"omega_max", run.omega_max},
                            {"energy", run.energy}, {"seconds", run.seconds}};
  document["statistics"]["energy_drift"] = run.energy_drift < 0 ? Json(nullptr) : Json(run.energy_drift);
  document["end"] = run.end;
  if (run.cells_upwards) document["statistics"]["cells_y"] = run.cells_upwards;
  return document;
}

}  // namespace maupertuis::app
