#include <maupertuis/coupled_fields.hpp>
#include <maupertuis/evaluate.hpp>
#include <maupertuis/switches.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

/// Where fields and bodies meet. The variation of the action at a place is −R δu of the bodies and ±B of the density on
/// each side; it vanishes for every δu there.
namespace maupertuis {
namespace {

using Side = BoundaryCondition::Side;

Bindings parameter_values(const FieldEquations& equations) {
  Bindings out;
  for (const Parameter& p : equations.model->parameters) out[p.symbol] = p.si_value;
  return out;
}

bool has_derivative(const FieldSystem& s, std::size_t field, int order) {
  for (const Expr& one : s.jets_in(s.density)) {
    const FieldJet jet = *s.jet_of(one);
    if (jet.field == field && jet.space[0] >= order) return true;
  }
  return false;
}

const PlaceCoordinate* attached_at(const FieldEquations& equations, const FieldJet& jet, Expr place) {
  for (const PlaceCoordinate& p : equations.model->attached)
    if (p.place == place && p.jet.field == jet.field && p.jet.space == jet.space) return &p;
  return nullptr;
}

/// Of what moves with a place, X'; 0 of a place at rest.
Expr velocity_of(const FieldEquations& equations, Expr place) {
  return total_time_derivative(equations.system().expanded(place));
}

/// Its value: of a place that moves none, which no border of the density can be told by.
double number_of(const FieldEquations& equations, Expr place, const Bindings& parameters) {
  if (equations.system().context->depends_on_time(place.id())) return std::nan("");
  return evaluate(equations.system().expanded(place), parameters);
}

/// Whether a condition without symbols holds.
bool holds(Expr condition) {
  Context& c = condition.context();
  const std::array pieces{condition, c.number(1), c.number(0)};
  return evaluate(c.function(Kind::Piecewise, pieces), {}) == 1;
}

/// Pieces whose conditions are decided are taken, or left out.
Expr without_decided_pieces(Expr e) {
  ExprMap taken;
  for (const Expr& node : topological_order({&e, 1})) {
    if (!node.is(Kind::Piecewise)) continue;
    std::vector<Expr> left;
    std::size_t i = 0;
    for (; i + 1 < node.size(); i += 2) {
      const Expr condition = node[i];
      if (!symbols_of({&condition, 1}).empty())
        left.push_back(condition), left.push_back(node[i + 1]);
      else if (holds(condition))
        break;
    }
    const Expr last = i + 1 < node.size() ? node[i + 1] : node[node.size() - 1];
    if (left.size() + 1 == node.size()) continue;
    left.push_back(last);
    taken.emplace(node, left.size() == 1 ? last : e.context().function(Kind::Piecewise, left));
  }
  return taken.empty() ? e : without_decided_pieces(substitute(e, taken));
}

/// e as it is at a place, in the limit from one side.
Expr limit_at(const FieldEquations& equations, Expr e, Expr place, int side, const std::vector<DensityBorder>& borders,
              double at) {
  const FieldSystem& s = equations.with_variations;
  for (const DensityBorder& b : borders)
    if (std::abs(b.at - at) <= 1e-12 * (1 + std::abs(at)) && side != 0)
      e = without_decided_pieces(on_side({&e, 1}, b.switching, b.rising == (side > 0)).front());
  ExprMap map{{s.space.front().symbol, place}};
  for (const Expr& symbol : s.jets_in(e)) map[symbol] = jet_at_place(equations, *s.jet_of(symbol), place, side);
  return substitute(e, map);
}

Expr natural_of(const FieldEquations& equations, std::size_t field, bool moment) {
  for (const NaturalCondition& n : equations.natural)
    if (n.field == field && n.moment == moment) return n.value;
  return equations.system().context->number(0);
}

/// The part of p and m that a place takes along as it moves: what B^t has with δφ or δφ_x.
Expr carried_by(const FieldEquations& equations, std::size_t field, bool moment) {
  const FieldSystem& s = equations.with_variations;
  std::size_t a = 0;
  while (equations.varied[a] != field) ++a;
  return differentiate(equations.boundary_terms.back(), s.jet_symbol({equations.variation_of(a), {moment ? 1 : 0}, 0}));
}

/// What the density adds to the row of a place: ∓p at ends, the jump inside.
Expr share_of_density(const FieldEquations& equations, Expr p, Expr place, std::optional<Side> end,
                      const std::vector<DensityBorder>& borders, double at) {
  if (end == Side::Right) return -limit_at(equations, p, place, 0, borders, at);
  if (end == Side::Left) return limit_at(equations, p, place, 0, borders, at);
  return limit_at(equations, p, place, 1, borders, at) - limit_at(equations, p, place, -1, borders, at);
}

void add_interface(FieldEquations& out, std::size_t field, bool moment, Expr place, std::optional<Side> end,
                   std::optional<std::size_t> coordinate, const std::vector<DensityBorder>& borders, double at) {
  Expr p = natural_of(out, field, moment);
  const Expr velocity = velocity_of(out, place);
  if (!velocity.is_zero()) p = p - velocity * carried_by(out, field, moment);
  Expr value = share_of_density(out, p, place, end, borders, at);
  if (coordinate) value = out.bodies->shown().balance()[*coordinate] + value;
  out.interfaces.push_back({field, moment, place, end, coordinate, value});
}

/// What the row of a coordinate has of a place X that it moves. On each side of the path δφ = δU − φ_x δX and
/// δφ_x = δU_x − φ_xx δX, and the sides change by ∓ℒ δX: [ℒ − Π φ_x − Μ φ_xx] ∂X/∂q, with Π = p − X' ∂ℒ/∂φ' and Μ
/// alike.
Expr stress_across(const FieldEquations& equations, Expr place, Expr coordinate) {
  const FieldSystem& s = equations.system();
  const Expr along = differentiate(s.expanded(place), coordinate);
  if (along.is_zero()) return along;
  Expr stress = s.density;
  for (const std::size_t field : equations.varied)
    for (const bool moment : {false, true}) {
      const Expr p =
          natural_of(equations, field, moment) - velocity_of(equations, place) * carried_by(equations, field, moment);
      stress = stress - p * s.jet_symbol({field, {moment ? 2 : 1}, 0});
    }
  return share_of_density(equations, stress, place, {}, density_borders(equations), std::nan("")) * along;
}

/// Each place once.
std::vector<Expr> moving_places(const FieldEquations& equations) {
  std::vector<Expr> out;
  for (const PlaceCoordinate& p : equations.model->attached)
    if (p.moves && std::find(out.begin(), out.end(), p.place) == out.end()) out.push_back(p.place);
  return out;
}

}  // namespace

std::string place_text(const FieldEquations& equations, Expr place) {
  const FieldModel& model = *equations.model;
  for (const PlaceCoordinate& p : model.attached)
    if (p.place == place && equations.bodies) {
      const std::string& name = equations.bodies->system->coordinates[p.coordinate].name;
      const std::size_t open = name.find('(');
      return name.substr(open + 1, name.size() - open - 2);
    }
  return to_plain(lay_out(place, equations.order));
}

namespace {

/// u_x(l), whose rate is its order; at a place that moves u_t(X), which is none of d/dt u(X).
std::string place_jet_name(const FieldSystem& s, const FieldJet& jet, bool moves) {
  if (!moves) return s.jet_name({jet.field, jet.space, 0});
  if (jet.space[0] > 0) return s.jet_name(jet);
  return s.fields[jet.field].name + "_" + std::string(static_cast<std::size_t>(jet.time), 't');
}

}  // namespace

Expr jet_at_place(const FieldEquations& equations, const FieldJet& jet, Expr place, int side) {
  const FieldSystem& s = equations.with_variations;
  const PlaceCoordinate* p = attached_at(equations, {jet.field, jet.space, 0}, place);
  const bool along = jet.time > 0 && s.context->depends_on_time(place.id());  // not d/dt of the value there
  if (p && !along)
    return s.context->symbol(equations.bodies->system->coordinates[p->coordinate].name, Role::Coordinate, jet.time);
  const std::size_t varied = jet.field < equations.system().fields.size()
                                 ? jet.field
                                 : equations.varied[jet.field - equations.system().fields.size()];
  const int slopes = jet.space[0] + (along ? jet.time : 0);
  // Where no moment acts, curvatures do not jump either, nor with them u_tx and u_tt along a path.
  const bool moved = s.context->depends_on_time(place.id()) && !attached_at(equations, {varied, {1}, 0}, place);
  const bool continuous = slopes == 0 || (slopes <= (moved ? 2 : 1) && has_derivative(s, varied, 2));
  const char* mark = side == 0 || continuous ? "" : side > 0 ? " + 0" : " - 0";
  const int order = along ? 0 : jet.time;  // u_t(v t+) is a name
  const std::string name = fmt::format("{}({}{})", place_jet_name(s, jet, along), place_text(equations, place), mark);
  return s.context->symbol(name, Role::Coordinate, order);
}

std::vector<DensityBorder> density_borders(const FieldEquations& equations) {
  return equations.system().space.size() == 1 ? density_borders_along(equations, 0) : std::vector<DensityBorder>{};
}

std::vector<DensityBorder> density_borders_along(const FieldEquations& equations, std::size_t direction) {
  const FieldSystem& s = equations.system();
  const SpaceVariable& along = s.space[direction];
  std::vector<Expr> roots{expand_time_derivatives(s.density)};
  if (s.dissipation) roots.push_back(s.dissipation);
  for (const Expr& f : s.forces)
    if (f) roots.push_back(f);
  const Expr x = along.symbol;
  Bindings values = parameter_values(equations);
  std::vector<DensityBorder> out;
  for (const Expr& g : switches_of(roots)) {
    const Expr slope = differentiate(g, x), rest = substitute(g, {{x, s.context->number(0)}});
    const Expr parts[] = {s.expanded(slope), s.expanded(rest)};
    bool constant = !slope.is_zero();
    for (const Expr& symbol : symbols_of(parts)) constant = constant && values.count(symbol);
    if (!constant) continue;
    const Expr place = readable(-rest / slope, equations.order).value;
    const double at = evaluate(s.expanded(place), values), up = evaluate(s.expanded(slope), values);
    const bool inside =
        !along.from || (at > evaluate(s.expanded(along.from), values) && at < evaluate(s.expanded(along.to), values));
    if (std::isfinite(at) && inside) out.push_back({place, at, g, up > 0});
  }
  std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.at < b.at; });
  return out;
}

namespace {

/// Whether an impulse changes the velocity of a coordinate by what the bodies have of mass, there or where a
/// constraint leads it.
bool has_inertia(const EquationsOfMotion& bodies, std::size_t coordinate) {
  const MechanicalSystem& system = *bodies.system;
  const ExprMatrix mass = mass_matrix(bodies);
  const std::size_t n = system.coordinates.size();
  for (std::size_t j = 0; j < n; ++j)
    if (!mass.entries[coordinate * n + j].is_zero()) return true;
  const Coordinate& c = system.coordinates[coordinate];
  return std::any_of(system.constraints.begin(), system.constraints.end(), [&](const Constraint& one) {
    const Expr value = expand_time_derivatives(one.value);
    return !differentiate(value, c.q).is_zero() || !differentiate(value, c.velocity).is_zero();
  });
}

/// E0657 where an impact would act on a field alone.
void refuse_impacts_without_mass(const FieldEquations& equations, Diagnostics& diagnostics) {
  const EquationsOfMotion& bodies = *equations.bodies;
  for (const Contact& contact : bodies.system->contacts)
    for (const PlaceCoordinate& p : equations.model->attached) {
      const Coordinate& c = bodies.system->coordinates[p.coordinate];
      bool acts = !differentiate(expand_time_derivatives(contact.gap), c.q).is_zero();
      for (const Expr& slip : contact.friction.slip) acts = acts || !differentiate(slip, c.velocity).is_zero();
      if (!acts || has_inertia(bodies, p.coordinate)) continue;
      const bool slope = p.jet.order() == 1;
      diagnostics.error(
          "E0657", contact.span,
          fmt::format("an impact acts on {}, where no {} is", c.name, slope ? "inertia" : "mass"),
          "An impulse on a field alone has no mass to act upon: what it changes would be that of a piece of the mesh, "
          "and another one on every mesh.",
          slope ? fmt::format("Attach an inertia, T = 1/2 J {}'^2, or let a stiff spring take the blow.", c.name)
                : fmt::format("Attach a mass, T = 1/2 m {}'^2, or let a stiff spring take the blow.", c.name));
      break;
    }
}

/// E0659 where a field without a mass would be let go by friction with a jump of its force.
void refuse_static_friction_without_mass(const FieldEquations& equations, Diagnostics& diagnostics) {
  const EquationsOfMotion& bodies = *equations.bodies;
  for (const Friction& friction : bodies.system->frictions)
    for (const PlaceCoordinate& p : equations.model->attached) {
      const Coordinate& c = bodies.system->coordinates[p.coordinate];
      if (differentiate(friction.slip.front(), c.velocity).is_zero() || has_inertia(bodies, p.coordinate)) continue;
      if (zero_test(friction.static_ - friction.kinetic).verdict == Verdict::Zero) continue;
      diagnostics.error(
          "E0659", friction.span, fmt::format("friction that holds {} more than it brakes, where no mass is", c.name),
          "Where it gives way its force falls at once, and a field without a mass there has another velocity at once: "
          "on a mesh that jump rings, and friction catches the field again and again.",
          fmt::format("Attach a mass, T = 1/2 m {}'^2, or leave `static` out.", c.name));
    }
}

}  // namespace

void attach_bodies(FieldEquations& equations, std::shared_ptr<const Model> model, Diagnostics& diagnostics) {
  const FieldSystem& s = equations.system();
  if (equations.model->coupled) {
    equations.body_start = model->experiment.start;
    auto bodies = euler_lagrange(std::shared_ptr<const MechanicalSystem>(model, &model->system), diagnostics);
    if (!bodies) return;
    equations.bodies = std::make_shared<const EquationsOfMotion>(std::move(*bodies));
    refuse_impacts_without_mass(equations, diagnostics);
    refuse_static_friction_without_mass(equations, diagnostics);
  }
  if (s.space.size() != 1) return;
  const Bindings values = parameter_values(equations);
  const std::vector<DensityBorder> borders = density_borders(equations);
  for (const PlaceCoordinate& p : equations.model->attached)
    add_interface(equations, p.jet.field, p.jet.space[0] == 1, p.place, p.end, p.coordinate, borders,
                  number_of(equations, p.place, values));
  std::vector<double> done;  // a place may be the border of several formulas
  for (const DensityBorder& b : borders) {
    const auto same = [&](double at) { return std::abs(at - b.at) <= 1e-12 * (1 + std::abs(at)); };
    if (std::any_of(done.begin(), done.end(), same)) continue;
    done.push_back(b.at);
    for (const NaturalCondition& n : equations.natural) {
      const bool attached = std::any_of(equations.model->attached.begin(), equations.model->attached.end(),
                                        [&](const PlaceCoordinate& p) {
                                          return p.jet.field == n.field && (p.jet.space[0] == 1) == n.moment &&
                                                 same(number_of(equations, p.place, values));
                                        });
      if (!attached) add_interface(equations, n.field, n.moment, b.place, {}, {}, borders, b.at);
    }
  }
}

std::vector<CoordinateRow> coordinate_rows(const FieldEquations& equations) {
  std::vector<CoordinateRow> out;
  if (!equations.bodies) return out;
  const ExprVector rows = equations.bodies->shown().balance();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const bool place = std::any_of(equations.model->attached.begin(), equations.model->attached.end(),
                                   [&](const PlaceCoordinate& p) { return p.coordinate == i; });
    if (place) continue;
    Expr row = rows[i];
    for (const Expr& x : moving_places(equations))
      row = row + stress_across(equations, x, equations.bodies->system->coordinates[i].q);
    out.push_back({i, row});
  }
  return out;
}

std::optional<bool> row_of_bodies(const FieldEquations& equations, Expr difference) {
  const FieldSystem& s = equations.system();
  Expr e = s.expanded(expand_time_derivatives(difference));
  ExprMap places;
  for (const PlaceValue& p : equations.model->places) {
    const FieldJet jet = *s.jet_of(p.jet);
    Expr place = p.place.front();
    for (const InterfaceCondition& c : equations.interfaces)
      if (zero_test(c.place - place).verdict == Verdict::Zero) place = c.place;
    places[p.symbol] = jet_at_place(equations, jet, place, p.side);
  }
  const Expr roots[] = {e};
  bool of_bodies = false;
  for (const Expr& symbol : symbols_of(roots))
    of_bodies = of_bodies || places.count(symbol) || (symbol.role() == Role::Coordinate && !s.jet_of(symbol));
  if (!of_bodies) return std::nullopt;
  e = substitute(e, places);
  std::vector<Expr> rows;
  for (const InterfaceCondition& c : equations.interfaces) rows.push_back(c.value);
  for (const CoordinateRow& r : coordinate_rows(equations)) rows.push_back(r.value);
  for (const Expr& written : rows) {
    const Expr row = s.expanded(expand_time_derivatives(written));
    const Expr of_row[] = {row};
    for (const Expr& symbol : symbols_of(of_row)) {
      if (symbol.role() != Role::Coordinate) continue;
      const Expr slope = differentiate(row, symbol), other = differentiate(e, symbol);
      const Expr factors[] = {slope, other};
      const std::vector<Expr> in_factors = symbols_of(factors);
      const bool of_parameters = std::none_of(in_factors.begin(), in_factors.end(),
                                              [](const Expr& f) { return f.role() == Role::Coordinate; });
      if (!of_parameters || zero_test(other).verdict != Verdict::Nonzero) continue;
      if (zero_test(e * slope - row * other).verdict == Verdict::Zero) return true;
    }
  }
  return false;
}

// ----------------------------------------------------------------------------------------------------------
// certificate

namespace {

Expr variation_of(const FieldEquations& equations, std::size_t coordinate) {
  return equations.system().context->symbol("δ" + equations.bodies->system->coordinates[coordinate].name,
                                            Role::Coordinate, 0);
}

/// B(η) where the variation of coordinates moves the place by δX: the field there changes by δU = η + φ_x δX, and what
/// the sides of the path hold of the action by ℒ δX.
Expr beside_path(const FieldEquations& equations, Expr b, Expr place) {
  const FieldSystem& s = equations.with_variations;
  Expr shift = s.context->number(0);
  if (equations.bodies && !velocity_of(equations, place).is_zero())
    for (std::size_t i = 0; i < equations.bodies->system->coordinates.size(); ++i)
      shift = shift +
              differentiate(s.expanded(place), equations.bodies->system->coordinates[i].q) * variation_of(equations, i);
  if (shift.is_zero()) return b;
  ExprMap changed;
  for (std::size_t a = 0; a < equations.varied.size(); ++a)
    for (int order = 0; order <= 1; ++order) {
      const Expr eta = s.jet_symbol({equations.variation_of(a), {order}, 0});
      changed[eta] = eta - s.jet_symbol({equations.varied[a], {order + 1}, 0}) * shift;
    }
  return substitute(b, changed) + s.density * shift;
}

/// B^x(η), what the variation η of the fields takes along x. Internal friction does virtual work along δφ_x and δφ_xx,
/// as stresses do.
Expr flux_along(const FieldEquations& equations) {
  const FieldSystem& s = equations.with_variations;
  Expr out = equations.boundary_terms.front();
  for (std::size_t a = 0; s.dissipation && a < equations.varied.size(); ++a) {
    const auto friction = [&](int order) {
      return differentiate(s.dissipation, s.jet_symbol({equations.varied[a], {order}, 1}));
    };
    const Expr eta = s.jet_symbol({equations.variation_of(a), {0}, 0}),
               slope = s.jet_symbol({equations.variation_of(a), {1}, 0});
    out = out - friction(1) * eta - friction(2) * slope + s.total_derivative(friction(2), 0) * eta;
  }
  return out;
}

/// −R η of the bodies and B(η) of the density on each side, against −(the row) η, for any η and η_x at the place.
CertificateCheck interface_identity(const FieldEquations& equations) {
  CertificateCheck check;
  check.name = "interface_identity";
  check.statement = "What the variation leaves at each place, -R·δu and B of both sides, is the conditions times δu.";
  const FieldSystem& s = equations.with_variations;
  const std::vector<DensityBorder> borders = density_borders(equations);
  const Bindings values = parameter_values(equations);
  std::vector<Expr> differences;
  Expr moved = s.context->number(0);  // what δq leaves, of coordinates that move places
  ExprMap still;
  if (equations.bodies)
    for (std::size_t i = 0; i < equations.bodies->system->coordinates.size(); ++i)
      still[variation_of(equations, i)] = s.context->number(0);
  std::vector<std::pair<Expr, std::optional<Side>>> places;
  for (const InterfaceCondition& c : equations.interfaces)
    if (std::none_of(places.begin(), places.end(), [&](const auto& p) { return p.first == c.place; }))
      places.push_back({c.place, c.end});
  const Expr b_along = flux_along(equations);
  for (const auto& [place, end] : places) {
    const double at = number_of(equations, place, values);
    // A place that moves leaves B^x − X' B^t on each side of its path.
    Expr b = b_along - velocity_of(equations, place) * equations.boundary_terms.back();
    b = beside_path(equations, b, place);
    Expr left = s.context->number(0);
    if (end != Side::Left) left = left + limit_at(equations, b, place, end ? 0 : -1, borders, at);
    if (end != Side::Right) left = left - limit_at(equations, b, place, end ? 0 : 1, borders, at);
    // Variations that no condition of this place is about stay in the natural conditions.
    ExprMap silent;
    for (std::size_t a = 0; a < equations.varied.size(); ++a)
      for (int order = 0; order <= 1; ++order) {
        const Expr eta = jet_at_place(equations, {equations.variation_of(a), {order}, 0}, place, 0);
        Expr row;
        for (const InterfaceCondition& c : equations.interfaces) {
          if (c.place != place || c.field != equations.varied[a] || c.moment != (order == 1)) continue;
          row = c.coordinate ? c.value - equations.bodies->shown().balance()[*c.coordinate] : c.value;
        }
        if (row)
          left = left + row * eta;
        else
          silent[eta] = s.context->number(0);
        for (const int side : {-1, 1})  // δu_x of a field without bending energy stands in no B
          if (!row)
            silent[jet_at_place(equations, {equations.variation_of(a), {order}, 0}, place, side)] =
                s.context->number(0);
      }
    left = s.expanded(substitute(left, silent));
    differences.push_back(substitute(left, still));
    moved = moved + left - differences.back();
  }
  for (const CoordinateRow& row : coordinate_rows(equations))
    moved = moved + s.expanded(row.value - equations.bodies->shown().balance()[row.coordinate]) *
                        variation_of(equations, row.coordinate);
  differences.push_back(moved);
  const ZeroTest test = zero_test(differences);
  check.verdict = test.verdict, check.points = test.points, check.error_bound = test.error_bound;
  check.reason = test.reason;
  return check;
}

CertificateCheck rows_agree(const FieldEquations& equations) {
  CertificateCheck check;
  check.name = "rows_agree";
  check.statement = "The conditions and rows of coordinates shown are the computed ones.";
  std::vector<std::pair<Expr, Expr>> rows;
  for (const InterfaceCondition& c : equations.interfaces) rows.push_back({c.value, {}});
  for (const CoordinateRow& r : coordinate_rows(equations)) rows.push_back({r.value, {}});
  std::vector<Expr> differences;
  for (const auto& [row, own] : rows) {
    const ReadableForm form = readable_row(equations, row, own);
    Expr shown = form.value;
    for (auto i = form.intermediates.rbegin(); i != form.intermediates.rend(); ++i)
      shown = substitute(shown, {{i->symbol, i->value}});
    const Expr same = equations.system().expanded(shown - row), turned = equations.system().expanded(shown + row);
    differences.push_back(zero_test(turned).verdict == Verdict::Zero ? turned : same);
  }
  const ZeroTest test = zero_test(differences);
  check.verdict = test.verdict, check.points = test.points, check.error_bound = test.error_bound;
  check.reason = test.reason;
  return check;
}

}  // namespace

void certify_bodies(const FieldEquations& equations, Certificate& certificate) {
  if (equations.bodies)
    for (CertificateCheck& check : certify(*equations.bodies, nullptr).checks) certificate.checks.push_back(check);
  if (equations.interfaces.empty() && !equations.bodies) return;
  if (!equations.interfaces.empty()) certificate.checks.push_back(interface_identity(equations));
  certificate.checks.push_back(rows_agree(equations));
}

// --------------------------------------------------------------------------------------------------------------- print

ReadingOrder coupled_order(const FieldEquations& equations) {
  ReadingOrder order = equations.bodies ? reading_order(*equations.bodies->shown().system) : equations.order;
  const auto add = [](std::vector<Expr>& list, Expr e) {
    if (std::find(list.begin(), list.end(), e) == list.end()) list.push_back(e);
  };
  for (const Expr& p : equations.order.parameters) add(order.parameters, p);
  for (const Expr& q : equations.order.coordinates) add(order.coordinates, q);
  order.places.reset();
  return order;
}

ReadableForm readable_row(const FieldEquations& equations, Expr row, Expr own) {
  ReadingOrder order = coupled_order(equations);
  order.own = own;
  const Expr rows[] = {row};
  ReadableForm form = readable_equations(rows, order).front();
  const Layout page = lay_out(form, order);
  if (!page.negative && (page.shape != Shape::Sum || !page.minus.front())) return form;
  const Expr turned[] = {-row};  // the first term of an equation is read without a sign
  return readable_equations(turned, order).front();
}

namespace {

/// u_x(l + 0) of a symbol of that name: ∂u/∂x, and the place.
Layout place_layout(const FieldEquations& equations, Layout layout) {
  const FieldSystem& s = equations.system();
  const std::string& name = layout.symbol.name();
  const std::size_t open = name.find('(');
  if (open == std::string::npos || name.back() != ')') return layout;
  const auto jet = s.jet_of_name(std::string_view(name).substr(0, open));
  if (!jet) return layout;
  const auto as_written = [](std::string text) {
    Layout out;
    out.shape = Shape::Sign;
    out.text = std::move(text);
    return out;
  };
  Layout partial;
  partial.shape = Shape::Partial;
  partial.parts.push_back(layouts::symbol(s.jet_symbol({jet->field, std::vector<int>(s.space.size(), 0), 0})));
  for (int k = 0; k < layout.symbol.order() + jet->time; ++k) partial.parts.push_back(layouts::name("t"));
  for (std::size_t x = 0; x < s.space.size(); ++x)
    for (int k = 0; k < jet->space[x]; ++k) partial.parts.push_back(layouts::symbol(s.space[x].symbol));
  Layout typeset;
  typeset.shape = Shape::Row;
  typeset.parts.push_back(partial.parts.size() == 1 ? partial.parts.front() : partial);
  typeset.parts.push_back(as_written(name.substr(open)));
  std::string plain = name + std::string(static_cast<std::size_t>(layout.symbol.order()), '\'');
  return layouts::labelled(std::move(plain), std::move(typeset));
}

}  // namespace

Layout coupled_layout(const FieldEquations& equations, Layout layout) {
  if (layout.shape == Shape::Symbol) return place_layout(equations, std::move(layout));
  for (Layout& part : layout.parts) part = coupled_layout(equations, std::move(part));
  return layout;
}

}  // namespace maupertuis
