#include "fields/semi_discrete.hpp"

#include <maupertuis/coupled_fields.hpp>
#include <maupertuis/evaluate.hpp>

#include "fields/given_fields.hpp"
#include "linear_algebra/quadrature.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace maupertuis {
namespace {

using Side = BoundaryCondition::Side;
using EKind = ElementSpace::Kind;

constexpr std::size_t most_degrees_of_freedom = 200;

std::nullopt_t refuse_run(Diagnostics& diagnostics, Span span, const std::string& what) {
  diagnostics.error("E0508", span, fmt::format("not supported yet: a run of {}", what),
                    "Fields with bodies run on one space variable with a bounded domain.",
                    "`maup derive` and expectations about formulas work for all fields.");
  return std::nullopt;
}

/// The highest space derivative of a field in the density, the dissipation and the forces.
int depth_of(const FieldEquations& equations, std::size_t field) {
  const FieldSystem& s = equations.system();
  int depth = 1;
  const auto look = [&](Expr e) {
    if (!e) return;
    for (const Expr& one : s.jets_in(e))
      if (const FieldJet jet = *s.jet_of(one); jet.field == field) depth = std::max(depth, jet.space[0]);
  };
  look(s.density), look(s.dissipation);
  for (const Expr& f : s.forces) look(f);
  return depth;
}

/// `cells` elements over the whole, at least one between two neighbours of `fixed`.
std::vector<double> borders_of(const std::vector<double>& fixed, int cells) {
  const double whole = fixed.back() - fixed.front();
  std::vector<double> out{fixed.front()};
  for (std::size_t i = 0; i + 1 < fixed.size(); ++i) {
    const double width = fixed[i + 1] - fixed[i];
    const int n = std::max(1, static_cast<int>(std::lround(cells * width / whole)));
    for (int k = 1; k < n; ++k) out.push_back(fixed[i] + width * k / n);
    out.push_back(fixed[i + 1]);
  }
  return out;
}

}  // namespace

std::vector<double> element_borders(const FieldEquations& equations, int cells) {
  const FieldSystem& s = equations.system();
  Bindings values;
  for (const Parameter& p : equations.model->parameters) values[p.symbol] = p.si_value;
  const double left = evaluate(s.expanded(s.space.front().from), values),
               right = evaluate(s.expanded(s.space.front().to), values), near = 1e-12 * (right - left);
  std::vector<double> fixed{left, right};
  for (const PlaceCoordinate& p : equations.model->attached)
    if (!p.moves) fixed.push_back(evaluate(s.expanded(p.place), values));
  for (const DensityBorder& b : density_borders(equations)) fixed.push_back(b.at);
  std::sort(fixed.begin(), fixed.end());
  fixed.erase(std::unique(fixed.begin(), fixed.end(), [&](double a, double b) { return b - a <= near; }), fixed.end());
  return borders_of(fixed, cells);
}

SemiDiscrete::SemiDiscrete(const Model& model, const FieldEquations& equations)
    : model_(model), equations_(&equations) {
  for (const Parameter& p : model.system.parameters) numbers_[p.symbol] = p.si_value;
}

std::optional<SemiDiscrete> SemiDiscrete::make(const Model& model, const FieldEquations& equations, int cells,
                                               int order, Diagnostics& diagnostics) {
  const FieldSystem& s = equations.system();
  if (s.space.size() != 1) return refuse_run(diagnostics, s.density_span, "fields of several space variables");
  if (!s.space.front().from) return refuse_run(diagnostics, s.density_span, "a field without a domain");
  SemiDiscrete out(model, equations);
  out.model_.system.written = nullptr;
  out.model_.fields = nullptr;
  out.model_.experiment.expectations.clear();
  for (std::size_t f = 0; f < s.fields.size(); ++f) {
    if (!s.fields[f].given) continue;
    if (!s.fields[f].formula) return refuse_run(diagnostics, s.fields[f].span, "an input without a formula");
  }
  if (!out.set_mesh(cells, order, diagnostics)) return std::nullopt;
  out.set_quadrature();
  out.set_degrees_of_freedom();
  out.hold_ends();
  if (!out.add_lagrangian(diagnostics) || !out.add_given_slopes(diagnostics)) return std::nullopt;
  out.add_force_densities();
  out.add_end_forces();
  if (!out.set_start(diagnostics)) return std::nullopt;
  out.follow_at_once();
  if (!out.set_moving_places(diagnostics) || !out.replace_places(diagnostics)) return std::nullopt;
  return out;
}

/// What rides on a field has the velocity u_t + X' u_x, which must not jump where it passes from one element to the
/// next.
bool SemiDiscrete::has_slopes(std::size_t field) const {
  const std::vector<PlaceCoordinate>& places = equations_->model->attached;
  return depth_of(*equations_, field) > 1 || std::any_of(places.begin(), places.end(), [&](const PlaceCoordinate& p) {
           return p.moves && p.jet.field == field;
         });
}

bool SemiDiscrete::bends() const {
  const std::vector<PlaceCoordinate>& places = equations_->model->attached;
  return std::all_of(places.begin(), places.end(),
                     [&](const PlaceCoordinate& p) { return !p.moves || depth_of(*equations_, p.jet.field) > 1; });
}

bool SemiDiscrete::set_mesh(int cells, int order, Diagnostics& diagnostics) {
  const FieldSystem& s = equations_->system();
  mesh_.borders = element_borders(*equations_, cells);
  bool bends = false;
  for (const std::size_t f : equations_->varied) bends = bends || has_slopes(f);
  mesh_.degree = bends ? std::max(order, 5) : order;
  // Lobatto's rule of the nodes where masses are to be diagonal; else one that is exact for products.
  mesh_.points = bends ? mesh_.degree + 2 : mesh_.degree;
  mesh_.periodic = s.periodic(0);
  for (const std::size_t f : equations_->varied)
    spaces_.emplace_back(mesh_, has_slopes(f) ? EKind::Smooth : bends ? EKind::Continuous : EKind::Nodal);
  for (const ElementSpace& space : spaces_) dofs_ += space.size();
  if (dofs_ <= most_degrees_of_freedom) return true;
  const bool bodies = equations_->model->coupled;  // else a density that changes at a place
  diagnostics.error(
      "E0656", s.density_span,
      fmt::format("{} elements of order {} have {} unknowns, too many for a run {}", elements(), mesh_.degree, dofs_,
                  bodies ? "with bodies" : "of a density with borders"),
      fmt::format("{} run as one system of at most {} coordinates of elements.",
                  bodies ? "Fields with bodies" : "Fields whose density changes at a place", most_degrees_of_freedom),
      "Write fewer cells; elements of a higher order need fewer of them.");
  return false;
}

/// Borders whose value stands in the gap of a contact that throws back.
std::set<std::size_t> SemiDiscrete::struck_borders() const {
  const MechanicalSystem& system = equations_->bodies ? *equations_->bodies->system : model_.system;
  const double near = 1e-12 * (mesh_.borders.back() - mesh_.borders.front());
  std::set<std::size_t> out;
  for (const PlaceCoordinate& p : equations_->model->attached) {
    if (p.moves || p.jet.order() != 0) continue;
    const Expr q = system.coordinates[p.coordinate].q;
    const bool struck = std::any_of(system.contacts.begin(), system.contacts.end(), [&](const Contact& c) {
      return number(c.restitution) > 0 && !differentiate(expand_time_derivatives(c.gap), q).is_zero();
    });
    for (std::size_t i = 0; struck && i < mesh_.borders.size(); ++i)
      if (std::abs(mesh_.borders[i] - number(p.place)) <= near) out.insert(i);
  }
  return out;
}

/// The rule of the elements; beside a body that is hit Radau's, which leaves the body's place out and is exact for
/// products of slopes all the same. So the impulse acts on the body alone, as it does on a body that a string holds,
/// and not on the piece of string that the node at its place stands for. A body that stays where it hits needs no such
/// rule, and its force is less rough without.
void SemiDiscrete::set_quadrature() {
  const bool nodal =
      std::all_of(spaces_.begin(), spaces_.end(), [](const ElementSpace& s) { return s.kind() == EKind::Nodal; });
  const std::set<std::size_t> struck = nodal ? struck_borders() : std::set<std::size_t>{};
  const Lobatto all(mesh_.points);
  const Radau left(mesh_.degree);
  for (std::size_t e = 0; e < elements(); ++e) {
    const bool leaves_left = struck.count(e), leaves_right = struck.count(e + 1);
    const bool one_side = leaves_left != leaves_right;
    const std::vector<double>&x = one_side ? left.x : all.x, &w = one_side ? left.w : all.w;
    const double begin = mesh_.borders[e], half = (mesh_.borders[e + 1] - begin) / 2;
    for (std::size_t q = 0; q < x.size(); ++q) {
      const double xi = one_side && leaves_left ? -x[q] : x[q];
      Point point{e, begin + half * (1 + xi), half * w[q], {}};
      for (const ElementSpace& space : spaces_) point.parts.push_back(space.in(e, xi));
      points_.push_back(std::move(point));
    }
  }
}

/// The degree of freedom of a value or a slope at a place, where elements have a border.
std::size_t SemiDiscrete::dof_at(std::size_t a, const PlaceCoordinate& place) const {
  const double at = number(place.place), near = 1e-12 * (mesh_.borders.back() - mesh_.borders.front());
  std::size_t border = 0;
  while (std::abs(mesh_.borders[border] - at) > near) ++border;
  return place.jet.space[0] == 0 ? spaces_[a].value_at_border(border) : spaces_[a].slope_at_border(border);
}

void SemiDiscrete::set_degrees_of_freedom() {
  const FieldSystem& s = equations_->system();
  MechanicalSystem& system = model_.system;
  for (std::size_t a = 0; a < spaces_.size(); ++a) {
    const std::size_t field = equations_->varied[a];
    const ElementSpace& space = spaces_[a];
    values_.emplace_back(space.size());
    coordinates_.emplace_back(space.size());
    for (const PlaceCoordinate& p : equations_->model->attached) {
      if (p.jet.field != field || p.moves) continue;
      const std::size_t dof = dof_at(a, p);
      coordinates_[a][dof] = p.coordinate;
      values_[a][dof] = system.coordinates[p.coordinate].q;
    }
    for (std::size_t j = 0; j < space.size(); ++j) {
      if (values_[a][j]) continue;
      Coordinate c;
      c.name = fmt::format("{}[{}]", s.fields[field].name, j);
      c.q = s.context->symbol(c.name, Role::Coordinate, 0);
      c.velocity = s.context->symbol(c.name, Role::Coordinate, 1);
      c.acceleration = s.context->symbol(c.name, Role::Coordinate, 2);
      c.dimension = s.fields[field].dimension;
      values_[a][j] = c.q;
      coordinates_[a][j] = system.coordinates.size();
      system.coordinates.push_back(std::move(c));
    }
  }
}

/// What is given at an end takes the place of its degree of freedom, whose coordinate goes.
void SemiDiscrete::hold_ends() {
  const FieldSystem& s = equations_->system();
  std::set<std::size_t> gone;
  for (const BoundaryCondition& b : s.boundary) {
    std::size_t a = 0;
    while (equations_->varied[a] != b.jet.field) ++a;
    const std::size_t border = b.side == Side::Right ? mesh_.borders.size() - 1 : 0;
    if (b.jet.order() == 1 && depth_of(*equations_, b.jet.field) < 2) continue;
    const std::size_t dof =
        b.jet.order() == 0 ? spaces_[a].value_at_border(border) : spaces_[a].slope_at_border(border);
    if (coordinates_[a][dof]) gone.insert(*coordinates_[a][dof]);
    coordinates_[a][dof].reset();
    values_[a][dof] = s.expanded(b.value);
    forced_ = forced_ || s.context->depends_on_time(b.value.id());
  }
  remove_coordinates(gone);
}

/// Whatever says a coordinate by its number says it by the new one.
void SemiDiscrete::remove_coordinates(const std::set<std::size_t>& gone) {
  std::vector<Coordinate>& list = model_.system.coordinates;
  std::vector<Coordinate> kept;
  std::vector<std::size_t> now(list.size());
  for (std::size_t i = 0; i < list.size(); ++i) {
    now[i] = kept.size();
    if (!gone.count(i)) kept.push_back(list[i]);
  }
  list = std::move(kept);
  for (auto& row : coordinates_)
    for (auto& c : row)
      if (c) c = now[*c];
  for (AppliedForce& f : model_.system.forces)
    if (f.kind == AppliedForce::Kind::Generalized) f.coordinate = now[f.coordinate];
  for (StartValue& v : model_.experiment.start) v.coordinate = now[v.coordinate];
  for (ModelEvent& event : model_.experiment.events)
    for (ModelEvent::Assignment& a : event.sets) a.coordinate = now[a.coordinate];
}

Expr SemiDiscrete::constant(double value) const {
  return equations_->system().context->number(Rational::from_double(value));
}

double SemiDiscrete::begin() const { return model_.experiment.start_time ? number(model_.experiment.start_time) : 0; }

double SemiDiscrete::number(Expr e) const { return evaluate(equations_->system().expanded(e), numbers_); }

Expr SemiDiscrete::combination(std::size_t a, const std::vector<ElementSpace::Part>& parts, int by_space,
                               int by_time) const {
  Context& context = *equations_->system().context;
  std::vector<Expr> terms;
  const auto value = [&](std::size_t dof) {
    Expr v = values_[a][dof];
    for (int k = 0; k < by_time; ++k) v = total_time_derivative(v);
    return v;
  };
  // Slopes of nodal elements act on differences, which keeps the digits of small ones on a large value.
  const bool differences = by_space == 1 && spaces_[a].kind() == EKind::Nodal;
  std::size_t base = 0;
  for (std::size_t m = 1; m < parts.size(); ++m)
    if (std::abs(parts[m].of[0]) > std::abs(parts[base].of[0])) base = m;
  for (std::size_t m = 0; m < parts.size(); ++m) {
    const double c = parts[m].of[by_space];
    if (c == 0 || (differences && m == base)) continue;
    const Expr v = value(parts[m].dof);
    terms.push_back(constant(c) * (differences ? v - value(parts[base].dof) : v));
  }
  return context.sum(terms);
}

Expr SemiDiscrete::at_point(Expr f, const std::vector<Expr>& jets, const Point& point) const {
  const FieldSystem& s = equations_->system();
  // A border belongs to the element that is summed: the formulas of its own side hold there.
  const double left = mesh_.borders[point.element], right = mesh_.borders[point.element + 1];
  const double near = 1e-13 * (right - left);
  ExprMap map{{s.space.front().symbol, constant(std::clamp(point.x, left + near, right - near))}};
  for (const Expr& symbol : jets) {
    const FieldJet jet = *s.jet_of(symbol);
    std::size_t a = 0;
    while (a < spaces_.size() && equations_->varied[a] != jet.field) ++a;
    if (a < spaces_.size()) map[symbol] = combination(a, point.parts[a], jet.space[0], jet.time);
  }
  return substitute(f, map);
}

Expr SemiDiscrete::integral(Expr density) const {
  const FieldSystem& s = equations_->system();
  const Expr e = with_given_fields(s, density);
  const std::vector<Expr> jets = s.jets_in(e);
  std::vector<Expr> terms;
  for (const Point& q : points_) terms.push_back(constant(q.weight) * at_point(e, jets, q));
  return s.context->sum(terms);
}

bool SemiDiscrete::add_lagrangian(Diagnostics&) {
  const FieldSystem& s = equations_->system();
  MechanicalSystem& system = model_.system;
  const Expr l = integral(s.density);
  if (system.lagrangian_given)
    system.lagrangian_given->value = system.lagrangian_given->value + l;
  else
    system.lagrangian_extra.push_back({l, "density", s.density_span});
  const Expr density = with_given_fields(s, s.density);
  forced_ = forced_ || !differentiate(density, s.context->time()).is_zero();
  if (!s.dissipation) return true;
  system.dissipation.push_back({integral(s.dissipation), "dissipation density", s.density_span});
  forced_ = true;
  return true;
}

void SemiDiscrete::generalized_force(std::size_t a, std::size_t dof, Expr force, Span span) {
  if (!coordinates_[a][dof] || force.is_zero()) return;
  AppliedForce f;
  f.kind = AppliedForce::Kind::Generalized;
  f.coordinate = *coordinates_[a][dof];
  f.target = model_.system.coordinates[f.coordinate].name;
  f.components = {force};
  f.span = span;
  model_.system.forces.push_back(std::move(f));
  forced_ = true;
}

void SemiDiscrete::add_force_densities() {
  const FieldSystem& s = equations_->system();
  for (std::size_t a = 0; a < spaces_.size(); ++a) {
    if (!s.forces[equations_->varied[a]]) continue;
    const Expr f = with_given_fields(s, s.forces[equations_->varied[a]]);
    const std::vector<Expr> jets = s.jets_in(f);
    std::vector<std::vector<Expr>> sums(spaces_[a].size());
    for (const Point& q : points_) {
      const Expr here = at_point(f, jets, q);
      for (const ElementSpace::Part& part : q.parts[a])
        if (part.of[0] != 0) sums[part.dof].push_back(constant(q.weight * part.of[0]) * here);
    }
    for (std::size_t j = 0; j < sums.size(); ++j) generalized_force(a, j, s.context->sum(sums[j]), s.density_span);
  }
}

void SemiDiscrete::add_end_forces() {
  const FieldSystem& s = equations_->system();
  for (const EndForce& f : s.end_forces) {
    std::size_t a = 0;
    while (equations_->varied[a] != f.jet.field) ++a;
    const std::size_t border = f.side == Side::Right ? mesh_.borders.size() - 1 : 0;
    const bool slope = f.jet.order() == 1;
    if (slope && depth_of(*equations_, f.jet.field) < 2) continue;
    generalized_force(a, slope ? spaces_[a].slope_at_border(border) : spaces_[a].value_at_border(border),
                      s.expanded(f.value), f.span);
  }
}

/// u_x = a of a field without bending energy: the end force that ∂ℒ/∂u_x balances, p + F = 0 on the right.
bool SemiDiscrete::add_given_slopes(Diagnostics& diagnostics) {
  const FieldSystem& s = equations_->system();
  for (const BoundaryCondition& b : s.boundary) {
    std::size_t a = 0;
    while (equations_->varied[a] != b.jet.field) ++a;
    if (b.jet.order() != 1 || depth_of(*equations_, b.jet.field) > 1) continue;
    const bool right = b.side == Side::Right;
    const FieldJet strain{b.jet.field, b.jet.space, 1};
    Expr slope = differentiate(with_given_fields(s, s.density), s.jet_symbol(b.jet));
    if (s.dissipation) slope = slope - differentiate(with_given_fields(s, s.dissipation), s.jet_symbol(strain));
    const Expr p = substitute(slope, {{s.jet_symbol(b.jet), s.expanded(b.value)},
                                      {s.jet_symbol(strain), total_time_derivative(s.expanded(b.value))},
                                      {s.space.front().symbol, right ? s.space.front().to : s.space.front().from}});
    if (!s.jets_in(p).empty()) {
      diagnostics.error("E0292", b.span, "this condition clashes with the natural one",
                        "What the variation leaves at a free end is ∂ℒ/∂u_x = 0; a given slope does not say what "
                        "∂ℒ/∂u_x is, as other derivatives stand in it.",
                        "Give the field itself, or leave the end natural.");
      return false;
    }
    generalized_force(a, spaces_[a].value_at_border(right ? mesh_.borders.size() - 1 : 0), s.expanded(right ? -p : p),
                      b.span);
  }
  return true;
}

Expr SemiDiscrete::value_at(std::size_t a, int by_time, int by_space, double x) const {
  return combination(a, spaces_[a].at(x, x >= mesh_.borders.back()), by_space, by_time);
}

double SemiDiscrete::inside(double x) const { return std::clamp(x, mesh_.borders.front(), mesh_.borders.back()); }

/// What coordinates that are values of fields at places at rest are beside these.
ExprMap SemiDiscrete::beside_attached(double shift) const {
  ExprMap out;
  for (const PlaceCoordinate& p : equations_->model->attached) {
    if (p.moves) continue;
    const Coordinate& c = equations_->bodies->system->coordinates[p.coordinate];
    std::size_t a = 0;
    while (equations_->varied[a] != p.jet.field) ++a;
    const double x = inside(number(p.place) + shift);
    out[c.q] = value_at(a, 0, p.jet.space[0], x), out[c.velocity] = value_at(a, 1, p.jet.space[0], x);
  }
  return out;
}

bool SemiDiscrete::has_inertia(const Coordinate& c) const {
  return equations_->bodies && !differentiate(equations_->bodies->lagrangian_expanded, c.velocity).is_zero();
}

bool SemiDiscrete::stands_on_masses(const FieldQuestion& question) const {
  if (question.total || !equations_->bodies) return false;
  const std::vector<Expr> asked = symbols_of({&question.value, 1});
  const auto holds = [&](const Expr& e) { return std::find(asked.begin(), asked.end(), e) != asked.end(); };
  for (const PlaceValue& place : equations_->model->places)
    if (holds(place.symbol)) return false;
  bool any = false;
  for (const PlaceCoordinate& p : equations_->model->attached) {
    const Coordinate& c = equations_->bodies->system->coordinates[p.coordinate];
    if (!holds(c.q) && !holds(c.velocity)) continue;
    if (p.moves || !has_inertia(c)) return false;
    any = true;
  }
  return any;
}

Expr SemiDiscrete::discretised(const FieldQuestion& question, Diagnostics& diagnostics, double shift) const {
  const FieldSystem& s = equations_->system();
  if (question.total) return integral(question.value);
  const Expr roots[] = {question.value};
  const std::vector<Expr> asked = symbols_of(roots);
  ExprMap map = shift == 0 ? ExprMap{} : beside_attached(shift);
  for (const PlaceValue& place : equations_->model->places) {
    if (std::find(asked.begin(), asked.end(), place.symbol) == asked.end()) continue;
    const FieldJet jet = *s.jet_of(place.jet);
    std::size_t a = 0;
    while (a < spaces_.size() && equations_->varied[a] != jet.field) ++a;
    const int known = a < spaces_.size() && spaces_[a].kind() == EKind::Smooth ? 2 : 1;
    if (a < spaces_.size() && place.side == 0 && jet.space[0] <= known && jet.time <= 2) {
      map[place.symbol] = value_at(a, jet.time, jet.space[0], inside(number(place.place[0]) + shift));
      continue;
    }
    diagnostics.error("E0508", place.span,
                      place.side != 0 ? "not supported yet: a limit from one side in a run"
                                      : fmt::format("not supported yet: the value of `{}` at a place", s.jet_name(jet)),
                      "Runs have the fields, their slopes and, where the density bends, their curvatures at places.",
                      place.side != 0 ? "Ask beside the place." : "");
    return {};
  }
  return substitute(s.expanded(substitute(s.expanded(question.value), map)), moving_);
}

/// Values at places in events and in the end of the run.
/// What the start says of a point that hangs on a field is said of the field, which has a start of its own.
bool SemiDiscrete::refuse_starts_of_places(Diagnostics& diagnostics) const {
  for (const StartCondition& c : model_.experiment.start_conditions) {
    const std::vector<Expr> held = symbols_of({&c.formula, 1});
    for (const PlaceValue& place : equations_->model->places) {
      if (std::find(held.begin(), held.end(), place.symbol) == held.end()) continue;
      diagnostics.error("E0504", c.span, fmt::format("a start of `{}`, which the field moves", c.name),
                        "Where the field is at the start, and how it moves, its own start says.",
                        "Write it into the start of the field, or give coordinates alone.");
      return true;
    }
  }
  return false;
}

bool SemiDiscrete::replace_places(Diagnostics& diagnostics) {
  bool good = true;
  const auto replace = [&](Expr& e) {
    if (!e || !good) return;
    const Expr replaced = discretised({e, false, 0}, diagnostics);
    good = static_cast<bool>(replaced);
    if (good) e = replaced;
  };
  for (ModelEvent& event : model_.experiment.events) {
    replace(event.function);
    for (ModelEvent::Assignment& a : event.sets) replace(a.value);
  }
  replace(model_.experiment.until);
  return good && !refuse_starts_of_places(diagnostics);
}

}  // namespace maupertuis
