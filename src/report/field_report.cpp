#include "report/motion_parts.hpp"
#include "report/notation.hpp"

#include <maupertuis/coupled_fields.hpp>
#include <maupertuis/field_pictures.hpp>
#include <maupertuis/field_report.hpp>
#include <maupertuis/stress_energy.hpp>
#include <maupertuis/uncertainty.hpp>

#include <fmt/format.h>

#include <algorithm>

#include <cmath>

/// A study of fields as plain data for a page.
namespace maupertuis {
namespace {

using Formula = ReportContent::Formula;

class FieldComposer {
 public:
  FieldComposer(const Model& model, const FieldEquations& equations)
      : model_(model), e_(equations), s_(equations.system()) {}

  void add_model(ReportContent& out, const SourceText& source) const {
    out.name = model_.system.name;
    out.title = model_.system.title.empty() ? model_.system.name : model_.system.title;
    out.source = model_.system.source;
    out.file = source.name() == "-" ? "" : source.name().substr(source.name().rfind('/') + 1);
    out.model_text = source.text();
    if (model_.system.dimensionless) out.summary.emplace_back("units", "dimensionless");
    Bindings values;
    for (const Parameter& p : model_.system.parameters) values[p.symbol] = p.si_value;
    for (const SpaceVariable& x : s_.space)
      out.summary.emplace_back(x.name,
                               x.from ? fmt::format("{} … {}", short_number(evaluate(s_.expanded(x.from), values), 8),
                                                    quantity(evaluate(s_.expanded(x.to), values), unit(x.dimension), 8))
                                      : std::string("all space"));
    if (s_.space.front().from) out.summary.emplace_back("boundary", boundary());
    for (const std::size_t f : e_.varied) {
      const FieldJet field{f, std::vector<int>(s_.space.size(), 0), 0};
      const std::string of = unit(s_.fields[f].dimension);
      out.coordinates.push_back({lay_out(s_.jet_symbol(field), e_.order),
                                 {},
                                 "",
                                 s_.fields[f].kind.empty() || s_.fields[f].kind == "number"
                                     ? (of.empty() || of == "1" ? "field" : "field in " + of)
                                     : "field, " + s_.fields[f].kind,
                                 "",
                                 ""});
    }
    const auto& attached = e_.model->attached;
    for (std::size_t i = 0; i < model_.system.coordinates.size(); ++i) {
      if (std::any_of(attached.begin(), attached.end(), [i](const auto& a) { return a.coordinate == i; }))
        continue;  // the value of a field at a place
      const Coordinate& c = model_.system.coordinates[i];
      const std::string of = unit(c.dimension);
      out.coordinates.push_back({lay_out(c.q, e_.order), lay_out(c.velocity, e_.order), "",
                                 !c.kind.empty() && c.kind != "number" ? c.kind
                                 : of.empty() || of == "1"             ? "number"
                                                                       : "in " + of,
                                 "", ""});
    }
    for (const Parameter& p : model_.system.parameters)
      if (p.symbol.role() == Role::Parameter)
        out.parameters.push_back({lay_out(p.symbol, e_.order), short_number(p.si_value / p.unit_factor, 10),
                                  p.unit.empty() ? unit(p.dimension) : p.unit,
                                  p.unit_factor == 1 ? "" : quantity(p.si_value, unit(p.dimension), 10)});
    for (const Definition& d : model_.system.definitions)
      if (d.symbol) out.definitions.push_back({lay_out(d.symbol, e_.order), shown(d.value), "", ""});
  }

  /// A condition where fields and bodies meet, or the row of a coordinate.
  void add_row(ReportContent& out, Expr row, Expr own, std::string note) const {
    ReadingOrder order = coupled_order(e_);
    order.own = own;
    const auto page = [&](Layout l) { return field_layout(s_, coupled_layout(e_, std::move(l))); };
    const ReadableForm form = readable_row(e_, row, own);
    out.equations.push_back({page(lay_out(form, order)), layouts::number("0"), std::move(note), ""});
    for (const Intermediate& i : form.intermediates)
      out.intermediates.push_back({layouts::symbol(i.symbol), page(lay_out(i.value, order)), "", ""});
  }

  void add_equations(ReportContent& out) const {
    for (std::size_t a = 0; a < e_.varied.size(); ++a) {
      const ReadableForm form = readable_residual(e_, a);
      ReadingOrder order = e_.order;
      order.own = s_.jet_symbol({e_.varied[a], std::vector<int>(s_.space.size(), 0), 0});
      out.equations.push_back({field_layout(s_, lay_out(form, order)), layouts::number("0"), "", ""});
      for (const Intermediate& i : form.intermediates)
        out.intermediates.push_back({layouts::symbol(i.symbol), field_layout(s_, lay_out(i.value, order)), "", ""});
    }
    for (const InterfaceCondition& c : e_.interfaces)
      add_row(out, c.value, jet_at_place(e_, {c.field, {c.moment}, 0}, c.place, 0),
              fmt::format("at {} = {}{}", s_.space.front().name, place_text(e_, c.place),
                          c.end ? "" : ", from both sides"));
    for (const CoordinateRow& r : coordinate_rows(e_))
      add_row(out, r.value, e_.bodies->shown().system->coordinates[r.coordinate].q, "");
    if (e_.bodies)
      for (const Constraint& c : e_.bodies->shown().system->constraints) add_row(out, c.value, {}, "constraint");
    out.energies_title = "Density";
    out.energies.push_back({layouts::name("ℒ"), shown(s_.density), "", ""});
    if (s_.dissipation) out.energies.push_back({layouts::name("𝒟"), shown(s_.dissipation), "", ""});
  }

  void add_derivation(ReportContent& out) const {
    ReportContent::Section slopes{"Partial derivatives of the density", {}}, natural{"Natural boundary conditions", {}},
        left{"What the variation leaves: δℒ = E·δφ + ∂_μ B^μ", {}};
    for (const Expr& symbol : s_.jets_in(s_.density)) {
      if (s_.fields[s_.jet_of(symbol)->field].given) continue;
      const FieldJet jet = *s_.jet_of(symbol);
      slopes.lines.push_back({layouts::partial(layouts::name("ℒ"), jet_with_subscripts(s_, jet)),
                              shown(differentiate(s_.density, symbol)), "all other derivatives held fixed", ""});
    }
    for (const NaturalAtEnds& at : natural_at_ends(e_)) {
      const NaturalCondition& n = e_.natural[at.natural];
      const char* const end = at.first == at.last ? "an end" : at.first ? "the first end" : "the last end";
      natural.lines.push_back({shown(at.value), layouts::number("0"),
                               fmt::format("at {} {} = const. where {} is free", end, s_.space[n.along].name,
                                           n.moment ? "the slope" : "the field"),
                               ""});
    }
    for (std::size_t mu = 0; mu < e_.boundary_terms.size(); ++mu)
      left.lines.push_back(
          {layouts::power(layouts::name("B"), layouts::name(mu == s_.space.size() ? "t" : s_.space[mu].name)),
           field_layout(e_.with_variations, lay_out(readable(e_.boundary_terms[mu], e_.order), e_.order)), "", ""});
    for (ReportContent::Section* part : {&slopes, &natural, &left})
      if (!part->lines.empty()) out.derivation.push_back(std::move(*part));
  }

  void add_currents(ReportContent& out, const FieldCurrents& found, const FieldRunResult* run) const {
    for (const FieldCurrent& c : found.currents) {
      out.conserved.push_back({c.name + ": " + c.meaning, {current("t"), shown(c.density), "", ""}, "", ""});
      for (std::size_t x = 0; x < c.fluxes.size(); ++x)
        out.conserved.push_back({"", {current(s_.space[x].name), shown(c.fluxes[x]), "", ""}, "", ""});
      if (c.source)
        out.conserved.push_back({"Not conserved: friction and forces make the divergence",
                                 {layouts::name("Q·E"), shown(c.source), "", ""},
                                 "",
                                 ""});
      add_charge(out, static_cast<std::size_t>(&c - found.currents.data()), run);
    }
    add_stress_energy(out, found);
    if (!found.basis.empty()) out.conserved.push_back({found.basis, {}, "", ""});
  }

  /// Of a Lorentz-invariant density.
  void add_stress_energy(ReportContent& out, const FieldCurrents& found) const {
    const auto tensor = stress_energy(e_, found);
    if (!tensor) return;
    out.conserved.push_back(
        {"The symmetric stress-energy tensor: density w and flux S of the energy, flux Θ of the "
         "momentum, whose density is S over the square of the speed. Symmetric and free of "
         "divergence on solutions, by the zero test. The square of the speed is",
         {{}, shown(tensor->c_squared), "", ""},
         "",
         ""});
    const auto add = [&](Layout left, Expr e) { out.conserved.push_back({"", {left, shown(e), "", ""}, "", ""}); };
    add(layouts::name("w"), tensor->energy_density());
    const auto index = [&](std::size_t i) { return layouts::name(s_.space[i].name); };
    for (std::size_t i = 0; i < tensor->dimensions; ++i)
      add(layouts::indexed(layouts::name("S"), {index(i)}), tensor->energy_flux(i));
    for (std::size_t i = 0; i < tensor->dimensions; ++i)
      for (std::size_t j = i; j < tensor->dimensions; ++j)
        add(layouts::power(layouts::name("Θ"), layouts::product({index(i), index(j)})), tensor->stress(i, j));
  }

  /// What the charge of a current is in the run.
  static void add_charge(ReportContent& out, std::size_t current, const FieldRunResult* run) {
    if (!run) return;
    for (const FieldCharge& charge : run->charges) {
      if (charge.current != current) continue;
      std::string text = fmt::format("In the run ∫ j^t is {} at the start and {} at the end",
                                     short_number(charge.start, 8), short_number(charge.end, 8));
      if (charge.booked)
        text += fmt::format("; {} flowed out at the sides. What is left over is at most {} of its terms",
                            short_number(charge.outflow, 8), short_number(charge.left_over(), 2));
      out.conserved.push_back({text + ".", {}, "", ""});
    }
  }

  /// Fields at rest: what they are worth, and a picture of each.
  void add_equilibrium(ReportContent& out, const FieldModes& modes) const {
    const FieldEquilibrium& found = *modes.equilibrium;
    ReportContent::ModePoint rest;
    rest.name = "Equilibrium next to the start";
    rest.stable = found.falling == 0 && found.lowest.value_or(0) > 0;
    rest.stability = (rest.stable         ? "A minimum of the energy, which is "
                      : found.falling > 0 ? "No minimum of the energy, which is "
                                          : "Not decided to second order; the energy is ") +
                     with_error(found.energy, found.energy_error, "J") + ".";
    FieldPictureOptions options;
    options.theme = PlotTheme::Page, options.dimensionless = model_.system.dimensionless, options.width = 320;
    for (options.field = 0; options.field < found.fields.size(); ++options.field)
      rest.shapes.push_back({fmt::format("{} at rest", s_.fields[e_.varied[options.field]].name), std::nullopt,
                             std::nullopt, field_equilibrium_svg(e_, found, options)});
    out.mode_points.push_back(std::move(rest));
  }

  void add_waves(ReportContent& out, const FieldReportParts& parts) const {
    if (parts.modes && parts.modes->equilibrium) add_equilibrium(out, *parts.modes);
    if (!parts.dispersion && (!parts.modes || parts.modes->frequencies.empty())) return;
    ReportContent::ModePoint rest;
    rest.name = "Waves and modes about the field at rest";
    if (parts.modes && !parts.modes->about.empty()) rest.name += ", modes about " + parts.modes->about;
    rest.stability = parts.dispersion ? "Waves exp(i(k·x − ω t)) of the linearized equations obey" : "";
    if (parts.dispersion)
      rest.formulas.push_back({shown(with_imaginary_unit(*parts.dispersion)), layouts::number("0"), "", ""});
    if (parts.modes) {
      for (std::size_t i = 0; i < parts.modes->frequencies.size(); ++i) rest.rows.push_back(mode_row(*parts.modes, i));
      add_shapes(rest, *parts.modes);
    }
    out.mode_points.push_back(std::move(rest));
  }

  /// In the plane with as many digits as its error leaves.
  std::string with_error(double value, double error, const char* unit) const {
    const bool bare = model_.system.dimensionless;
    if (!(error > 0)) return quantity(value, bare ? "" : unit, 10);
    return with_uncertainty(value, error) + (bare ? std::string() : std::string(" ") + unit);
  }

  ReportContent::ModeRow mode_row(const FieldModes& modes, std::size_t i) const {
    constexpr double turn = 2 * 3.14159265358979323846;
    const double w = modes.frequencies[i], error = i < modes.errors.size() ? modes.errors[i] : 0;
    if (w == 0) return {"free", "0", "", "", ""};
    if (w < 0) return {"grows", with_error(-w, error, "1/s"), "", "", ""};
    return {"oscillation", with_error(w, error, "rad/s"), with_error(w / turn, error / turn, "Hz"),
            with_error(turn / w, turn / w * error / w, "s"), ""};
  }

  void add_shapes(ReportContent::ModePoint& rest, const FieldModes& modes) const {
    constexpr std::size_t most_shapes = 6;
    FieldPictureOptions options;
    options.theme = PlotTheme::Page, options.dimensionless = model_.system.dimensionless, options.width = 320;
    for (std::size_t i = 0; i < std::min(modes.shapes.size(), most_shapes); ++i) {
      const std::size_t pictures = s_.space.size() == 2 ? e_.varied.size() : 1;
      for (options.field = 0; options.field < pictures; ++options.field) {
        const std::string of = pictures > 1 ? s_.fields[e_.varied[options.field]].name + " of mode" : "Mode";
        rest.shapes.push_back({fmt::format("{} {}: {} {}", of, i + 1,
                                           modes.frequencies[i] < 0 ? "grows at" : "ω =", rest.rows[i].frequency),
                               std::nullopt, std::nullopt, field_shape_svg(e_, modes, i, options)});
      }
    }
  }

  /// The first of them: "wall impact at 0.1 s, …".
  static std::string happenings_line(const FieldRunResult& run, bool bare) {
    constexpr std::size_t most = 8;
    std::string out;
    for (std::size_t i = 0; i < std::min(run.happenings.size(), most); ++i) {
      const Happening& h = run.happenings[i];
      out += fmt::format("{}{} {} at {}", i ? ", " : "", h.name, word_of(h.kind), quantity(h.t, bare ? "" : "s", 8));
    }
    return run.happenings.size() > most ? fmt::format("{}, … {} in all", out, run.happenings.size()) : out;
  }

  void add_run(ReportContent& out, const FieldRunResult& run) const {
    const bool bare = model_.system.dimensionless;
    const auto add = [&](const char* name, std::string value) { out.statistics.emplace_back(name, std::move(value)); };
    add("mesh", run.cells_upwards ? fmt::format("{} × {} cells of order {}, {} nodes", run.cells, run.cells_upwards,
                                                run.order, run.nodes)
                                  : fmt::format("{} cells of order {}, {} nodes", run.cells, run.order, run.nodes));
    add("steps", run.method.empty()
                     ? fmt::format("{} to {}", run.steps, quantity(run.end, bare ? "" : "s", 10))
                     : fmt::format("{} {} to {}", run.steps, run.method, quantity(run.end, bare ? "" : "s", 10)));
    if (run.omega_max > 0) add("highest frequency of the mesh", quantity(run.omega_max, bare ? "" : "rad/s", 6));
    add("energy", quantity(run.energy, bare ? "" : "J", 12));
    add("energy drift", run.energy_drift < 0 ? std::string("forces act: it is not conserved")
                                             : fmt::format("{:.3g} of its terms", run.energy_drift));
    if (!run.happenings.empty()) add("contacts, friction and events", happenings_line(run, bare));
    if (run.books)
      add("energy lost",
          fmt::format("impacts {}, friction {}, dampers {}", quantity(run.books->impacts, bare ? "" : "J", 6),
                      quantity(run.books->friction, bare ? "" : "J", 6),
                      quantity(run.books->dampers, bare ? "" : "J", 6)));
    if (!run.trouble.empty()) add("it ended early", run.trouble);
    if (run.trajectory.rows() < 2) return;  // it ended at its start
    for (std::size_t a = 0; a < e_.varied.size(); ++a) {
      FieldPictureOptions options;
      options.field = a, options.theme = PlotTheme::Page, options.dimensionless = bare;
      const std::string& name = s_.fields[e_.varied[a]].name;
      out.figures.emplace_back(
          s_.space.size() == 1 ? fmt::format("{} at moments, and over space and time; marks at the right of the map "
                                             "say when the curves are taken",
                                             name)
                               : name + " at moments",
          field_picture_svg(e_, run, options));
    }
  }

 private:
  std::string unit(const Dimension& d) const {
    const std::string text = to_string(d);
    return model_.system.dimensionless || text == "1" ? std::string() : text;
  }
  Layout shown(Expr e) const { return field_layout(s_, lay_out(readable(e, e_.order), e_.order)); }
  static Layout current(const std::string& along) { return layouts::power(layouts::name("j"), layouts::name(along)); }
  std::string boundary() const {
    if (s_.periodic()) return "periodic";
    constexpr const char* sides[] = {"left", "right", "bottom", "top"};
    std::string out;
    for (std::size_t i = 0; i < s_.space.size(); ++i)
      if (s_.periodic(i)) out += (out.empty() ? "periodic along " : ", ") + s_.space[i].name;
    for (const BoundaryCondition& b : s_.boundary)
      out += fmt::format("{}{}: {} = {}", out.empty() ? "" : ", ", sides[static_cast<int>(b.side)], s_.jet_name(b.jet),
                         to_plain(shown(b.value)));
    return out.empty() ? "natural" : out;
  }

  const Model& model_;
  const FieldEquations& e_;
  const FieldSystem& s_;
};

}  // namespace

ReportContent compose_field_report(const Model& model, const SourceText& source, const FieldEquations& equations,
                                   const Certificate& certificate, const FieldReportParts& parts) {
  ReportContent out;
  const FieldComposer composer(model, equations);
  composer.add_model(out, source);
  if (parts.with_equations) composer.add_equations(out);
  if (parts.with_derivation) composer.add_derivation(out);
  add_notes(out, model);
  add_certificate(out, certificate);
  if (parts.currents) composer.add_currents(out, *parts.currents, parts.run);
  composer.add_waves(out, parts);
  if (parts.run) composer.add_run(out, *parts.run);
  if (parts.verification) out.expectations = parts.verification->results;
  return out;
}

}  // namespace maupertuis
