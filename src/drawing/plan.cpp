#include "drawing/outlines.hpp"
#include "drawing/shapes.hpp"

#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/reactions.hpp>

#include <algorithm>
#include <cmath>

/// What the model asks for; and what it shows of itself where it asks for nothing.
namespace maupertuis::drawing {
namespace {

using Item = syntax::DrawItem::Kind;
using Kind = Drawing::Kind;

/// Of what is the same everywhere, whatever symbols stand in it.
double value_of(const MechanicalSystem& system, Expr e, const Bindings& parameters) {
  if (!e) return 0;
  Bindings somewhere = parameters;
  somewhere[system.context->time()] = 0.3;
  for (const Coordinate& c : system.coordinates) somewhere.insert({{c.q, 0.7}, {c.velocity, 0.0}});
  return evaluate(in_terms_of_motion(system, {&e, 1}).front(), somewhere);
}

double mass_of(const MechanicalSystem& system, const std::string& name, const Bindings& parameters) {
  if (const Point* point = system.find_point(name)) return value_of(system, point->mass, parameters);
  if (const Body* body = system.find_body(name)) return value_of(system, body->mass, parameters);
  return 0;
}

class Planner {
 public:
  Planner(const Model& model, const Bindings& parameters, const EquationsOfMotion* equations, const Trajectory& run)
      : model_(model),
        system_(model.system),
        parameters_(parameters),
        equations_(equations),
        run_(run),
        dimension_(static_cast<std::size_t>(model.system.space_dimension)) {}

  Plan plan(ForcesShown forces) {
    for (const DrawElement& element : model_.experiment.drawing) add(element);
    if (model_.experiment.drawing.empty()) add_what_is_there();
    add_bobs_of_trails();
    add_links();
    if (forces == ForcesShown::All) {
      add_reactions();
      add_acting_forces(system_, plan_);
    }
    return std::move(plan_);
  }

 private:
  void add(const DrawElement& e);
  void add_what_is_there();
  void add_bobs_of_trails();
  void add_links();
  void add_reactions();

  Outline& path(const std::vector<ExprVector>& places, const std::vector<std::string>& names, Kind kind) {
    Outline outline;
    outline.element.kind = kind;
    outline.element.points = places.size();
    outline.element.names = names;
    for (const std::string& name : names) outline.element.masses.push_back(mass_of(system_, name, parameters_));
    for (const ExprVector& p : places) outline.values.insert(outline.values.end(), p.begin(), p.end());
    plan_.outlines.push_back(std::move(outline));
    return plan_.outlines.back();
  }

  /// How the thing of this name is turned; null where it is a point.
  const ExprMatrix* rotation_of(const std::string& name) const {
    if (const Body* body = system_.find_body(name)) return &body->rotation;
    for (const Frame& frame : system_.frames)
      if (frame.name == name) return &frame.rotation;
    return nullptr;
  }

  Outline& solid(SolidShape shape, const ExprVector& origin, const ExprMatrix* rotation,
                 const std::vector<std::vector<double>>& axes);
  /// A solid that shows spokes where it turns about its own axis, so that rolling is seen.
  Outline& round(SolidShape shape, const ExprVector& origin, const ExprMatrix* rotation,
                 const std::vector<std::vector<double>>& axes) {
    Outline& outline = solid(std::move(shape), origin, rotation, axes);
    outline.fitting = Outline::Fitting::Wheel;
    return outline;
  }
  Outline& wheel(const DrawElement& e, bool filled);
  void solid_of_inertia(const Body& body);
  void link(const ExprVector& from, const ExprVector& to, const std::string& from_name, const std::string& to_name,
            bool spring);
  void arrows(const std::string& name);
  void pivots(const std::vector<ExprVector>& places);
  void pivot(const ExprVector& place) {
    Outline& outline = solid(shapes::pivot(), place, nullptr, {{1, 0}, {0, 1}});
    outline.fitting = Outline::Fitting::Pivot;
    outline.element.still = same_everywhere(system_, place, parameters_);
  }
  bool keeps_distance(const ExprVector& a, const ExprVector& b) const;
  bool drawn_between(const Link& link) const;
  double side_of(const ExprVector& from, const ExprVector& to, bool spring) const;

  const Model& model_;
  const MechanicalSystem& system_;
  const Bindings& parameters_;
  const EquationsOfMotion* equations_;
  const Trajectory& run_;
  std::size_t dimension_;
  Plan plan_;
  std::vector<ExprVector> pivots_;  // drawn already
};

/// `axes`: where the tips of the solid's axes are, in those of what carries it.
Outline& Planner::solid(SolidShape shape, const ExprVector& origin, const ExprMatrix* rotation,
                        const std::vector<std::vector<double>>& axes) {
  Outline outline;
  Context& c = *system_.context;
  outline.element.kind = Kind::Solid;
  outline.element.points = dimension_ + 1;
  outline.element.shape = std::move(shape);
  outline.values = origin;
  const auto constant = [&](double x) { return c.number(Rational::from_double(x)); };
  for (const std::vector<double>& axis : axes)
    for (std::size_t i = 0; i < dimension_; ++i) {
      Expr tip = origin[i];
      for (std::size_t k = 0; k < dimension_; ++k)
        if (rotation && axis[k] != 0) tip = tip + rotation->at(i, k) * constant(axis[k]);
      if (!rotation && axis[i] != 0) tip = tip + constant(axis[i]);
      outline.values.push_back(tip);
    }
  plan_.outlines.push_back(std::move(outline));
  return plan_.outlines.back();
}

// The third axis of what carries it, or one that is written, in its axes; of a point in the axes of the world.
Outline& Planner::wheel(const DrawElement& e, bool filled) {
  const double r = value_of(system_, e.sizes[0], parameters_);
  const ExprMatrix* rotation = rotation_of(e.names[0]);
  const int dimension = system_.space_dimension;
  SolidShape shape = filled ? shapes::disc(dimension) : shapes::hoop(dimension);
  if (dimension_ == 2) return round(std::move(shape), e.path[0], rotation, {{r, 0}, {0, r}});
  ExprVector axis = e.direction;
  if (axis.empty()) axis = {system_.context->number(0), system_.context->number(0), system_.context->number(1)};
  if (same_everywhere(system_, axis, parameters_)) {
    std::array<double, 3> n{};
    for (std::size_t k = 0; k < 3; ++k) n[k] = value_of(system_, axis[k], parameters_);
    const auto basis = shapes::basis_about(n);
    std::vector<std::vector<double>> axes;
    for (const auto& b : basis) axes.push_back({r * b[0], r * b[1], r * b[2]});
    return round(std::move(shape), e.path[0], rotation, axes);
  }
  Outline outline;
  outline.element.kind = Kind::Solid;
  outline.element.points = 4;
  outline.element.shape = std::move(shape);
  outline.placement = Outline::Placement::AboutAxis;
  outline.size = r;
  outline.values = e.path[0];
  for (std::size_t i = 0; i < 3; ++i) {
    Expr component = rotation ? system_.context->number(0) : axis[i];
    for (std::size_t k = 0; rotation && k < 3; ++k) component = component + rotation->at(i, k) * axis[k];
    outline.values.push_back(component);
  }
  plan_.outlines.push_back(std::move(outline));
  return plan_.outlines.back();
}

void Planner::solid_of_inertia(const Body& body) {
  if (body.inertia.rows == 0) return;
  const double mass = body.mass ? value_of(system_, body.mass, parameters_) : 0;
  if (dimension_ == 2) {  // I = m r²/2
    const double moment = value_of(system_, body.inertia.at(0, 0), parameters_),
                 r = mass > 0 ? std::sqrt(2 * std::max(0.0, moment) / mass) : 1;
    if (r > 0) round(shapes::disc(2), body.position, &body.rotation, {{r, 0}, {0, r}});
    return;
  }
  std::array<std::array<double, 3>, 3> inertia{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) inertia[i][k] = value_of(system_, body.inertia.at(i, k), parameters_);
  const shapes::Ellipsoid e = shapes::ellipsoid_of_inertia(inertia, mass);
  if (!(*std::max_element(e.semi_axes.begin(), e.semi_axes.end()) > 0)) return;
  std::vector<std::vector<double>> axes;
  for (std::size_t k = 0; k < 3; ++k)
    axes.push_back({e.semi_axes[k] * e.axes[k][0], e.semi_axes[k] * e.axes[k][1], e.semi_axes[k] * e.axes[k][2]});
  solid(shapes::ball(true), body.position, &body.rotation, axes);
}

/// A spring and a damper between the same places stand side by side: the spring to the left of its own way. 0 where
/// there is no other.
double Planner::side_of(const ExprVector& from, const ExprVector& to, bool spring) const {
  for (const Link& l : system_.links) {
    if ((l.kind == Link::Kind::Spring) == spring) continue;
    if (l.from == from && l.to == to) return spring ? 1 : -1;
    if (l.from == to && l.to == from) return 1;  // the damper goes the other way, and its left is the spring's right
  }
  return 0;
}

void Planner::link(const ExprVector& from, const ExprVector& to, const std::string& from_name,
                   const std::string& to_name, bool spring) {
  const double side = side_of(from, to, spring);
  const auto between = [&](const ExprVector& a, const ExprVector& b, Outline::Fitting fitting) {
    Outline outline;
    outline.element.kind = Kind::Solid;
    outline.element.points = dimension_ + 1;
    outline.placement = spring ? Outline::Placement::Between : Outline::Placement::Along;
    outline.fitting = fitting;
    outline.values = a;
    outline.values.insert(outline.values.end(), b.begin(), b.end());
    constexpr double apart = 1.3;  // thicknesses
    outline.aside = apart * (fitting == Outline::Fitting::Plate ? -side : side);  // a plate looks the other way
    plan_.outlines.push_back(std::move(outline));
  };
  between(from, to, spring ? Outline::Fitting::Spring : Outline::Fitting::Cup);
  if (!spring) between(to, from, Outline::Fitting::Plate);
  for (const auto& [place, name] : {std::pair{&from, &from_name}, {&to, &to_name}})
    if (mass_of(system_, *name, parameters_) > 0) path({*place}, {*name}, Kind::Path);
  // Hatched ground across the end that stands still.
  const bool fixed_from = same_everywhere(system_, from, parameters_),
             fixed_to = same_everywhere(system_, to, parameters_);
  if (dimension_ != 2 || fixed_from == fixed_to) return;
  const ExprVector& end = fixed_from ? from : to;
  if (std::find(pivots_.begin(), pivots_.end(), end) != pivots_.end()) return;
  pivots_.push_back(end);
  Outline outline;
  outline.element.kind = Kind::Solid;
  outline.element.points = 3;
  outline.element.still = true;
  outline.element.shape = shapes::anchor();
  outline.fitting = Outline::Fitting::Anchor;
  outline.placement = Outline::Placement::Along;
  outline.values = end;
  const ExprVector& other = fixed_from ? to : from;
  outline.values.insert(outline.values.end(), other.begin(), other.end());
  plan_.outlines.push_back(std::move(outline));
}

// Fixed joints of a mechanism in the plane stand on the ground.
void Planner::pivots(const std::vector<ExprVector>& places) {
  if (dimension_ != 2) return;
  for (const ExprVector& place : places) {
    if (std::find(pivots_.begin(), pivots_.end(), place) != pivots_.end() ||
        !same_everywhere(system_, place, parameters_))
      continue;
    pivots_.push_back(place);
    pivot(place);
  }
}

/// The arrows of one reaction. Its value and its force are proportional to one multiplier, so that their ratio depends
/// on the configuration alone: the run knows the value.
void Planner::arrows(const std::string& name) {
  ExprMap once;  // λ = 1 at rest
  for (const Expr& multiplier : equations_->multipliers) once.emplace(multiplier, system_.context->number(1));
  for (const Coordinate& c : system_.coordinates) once.emplace(c.acceleration, system_.context->number(0));
  const auto column = run_.column("reaction(" + name + ")");
  if (!column) return;
  for (const Reaction& r : reactions(*equations_)) {
    if (r.name != name || !r.value) continue;
    for (const ForceArrow& arrow : r.arrows) {
      Outline outline;
      outline.element.kind = Kind::Arrow;
      outline.element.points = 2;
      outline.element.names = {name, ""};
      outline.element.text = name_parts(name);
      outline.placement = Outline::Placement::Force;
      outline.values = arrow.position;
      outline.reaction = column;
      for (const Expr& f : arrow.force) outline.values.push_back(substitute(f / r.value, once));
      plan_.outlines.push_back(std::move(outline));
    }
  }
}

/// Of constraints, those that the model does not ask for.
void Planner::add_reactions() {
  if (!equations_) return;
  for (std::size_t i = 0; i < system_.constraints.size(); ++i) {
    const std::string name = system_.constraint_label(i);
    const auto shown = [&](const Outline& o) {
      return o.placement == Outline::Placement::Force && o.element.names[0] == name;
    };
    const std::size_t before = plan_.outlines.size();
    if (std::none_of(plan_.outlines.begin(), plan_.outlines.end(), shown)) arrows(name);
    for (std::size_t k = before; k < plan_.outlines.size(); ++k)
      plan_.outlines[k].element.origin = Drawing::ForceOrigin::Reaction;
  }
}

void Planner::add(const DrawElement& e) {
  const auto size = [&](std::size_t i) { return i < e.sizes.size() ? value_of(system_, e.sizes[i], parameters_) : 0; };
  const ExprMatrix* rotation = e.names.size() == 1 ? rotation_of(e.names[0]) : nullptr;
  switch (e.kind) {
    case Item::Line:
      path(e.path, e.names, Kind::Path);
      pivots(e.path);
      break;
    case Item::Trail:
      path(e.path, e.names, Kind::Trail);
      break;
    case Item::Reaction:
      if (equations_ && !e.names.empty()) arrows(e.names[0]);
      break;
    case Item::Circle:
      if (dimension_ == 2)
        round(shapes::disc(2), e.path[0], rotation, {{size(0), 0}, {0, size(0)}});
      else
        solid(shapes::ball(rotation != nullptr), e.path[0], rotation,
              {{size(0), 0, 0}, {0, size(0), 0}, {0, 0, size(0)}});
      break;
    case Item::Disc:
      wheel(e, true);
      break;
    case Item::Hoop:
      wheel(e, false);
      break;
    case Item::Box: {
      const double w = size(0) / 2, h = size(1) / 2, d = size(2) / 2;
      if (dimension_ == 2)
        solid(shapes::box(2, true), e.path[0], rotation, {{w, 0}, {0, h}});
      else if (e.sizes.size() > 2)
        solid(shapes::box(3, false), e.path[0], rotation, {{w, 0, 0}, {0, h, 0}, {0, 0, d}});
      else if (rotation)
        solid(shapes::box(3, true), e.path[0], rotation, {{w, 0, 0}, {0, h, 0}, {0, 0, 0.01 * w}});
      else
        solid(shapes::box(3, true), e.path[0], nullptr, {{w, 0, 0}, {0, 0, h}, {0, 0.01 * w, 0}});  // upright
      break;
    }
    case Item::Ellipsoid:
      if (dimension_ == 2)
        round(shapes::disc(2), e.path[0], rotation, {{size(0), 0}, {0, size(1)}});
      else
        solid(shapes::ball(true), e.path[0], rotation,
              {{size(0), 0, 0}, {0, size(1), 0}, {0, 0, e.sizes.size() > 2 ? size(2) : size(1)}});
      break;
    case Item::Spring:
    case Item::Damper:
      link(e.path[0], e.path[1], e.names[0], e.names[1], e.kind == Item::Spring);
      break;
    case Item::Pivot:
      if (dimension_ == 2)
        pivots_.push_back(e.path[0]), pivot(e.path[0]);
      else
        path(e.path, e.names, Kind::Path);
      break;
    case Item::Ground:
    case Item::Wall:
      plan_.grounds.push_back({e.path[0], e.direction, e.kind == Item::Wall});
      break;
    case Item::Label: {
      Drawing::Element& label = path(e.path, e.names, Kind::Label).element;
      label.text = e.text.empty() ? name_parts(e.names[0]) : NameParts{e.text, "", 0, true};
      break;
    }
    case Item::Follow:
      plan_.follow = e.path[0];
      break;
  }
  if (!plan_.outlines.empty() && plan_.outlines.back().element.kind == Kind::Solid &&
      plan_.outlines.back().element.names.empty() && e.names.size() == 1)
    plan_.outlines.back().element.names = e.names;
}

/// `draw trail P` shows P too, where it has mass and nothing else shows it.
void Planner::add_bobs_of_trails() {
  const std::vector<DrawElement>& drawing = model_.experiment.drawing;
  const auto shows = [](const DrawElement& e, const ExprVector& place) {
    const bool beside = e.kind == Item::Trail || e.kind == Item::Label || e.kind == Item::Follow;
    return !beside && std::find(e.path.begin(), e.path.end(), place) != e.path.end();
  };
  for (const DrawElement& e : drawing) {
    if (e.kind != Item::Trail || e.names.empty()) continue;
    const Point* point = system_.find_point(e.names[0]);
    const bool shown =
        std::any_of(drawing.begin(), drawing.end(), [&](const DrawElement& other) { return shows(other, e.path[0]); });
    if (point && point->mass && !shown) path(e.path, e.names, Kind::Path);
  }
}

/// Whether a draw statement shows the link already, as what it is or as a line.
bool Planner::drawn_between(const Link& link) const {
  const auto shows = [&](const DrawElement& e) {
    if (e.kind != Item::Spring && e.kind != Item::Damper && e.kind != Item::Line) return false;
    for (std::size_t i = 0; i + 1 < e.path.size(); ++i)
      if ((e.path[i] == link.from && e.path[i + 1] == link.to) || (e.path[i] == link.to && e.path[i + 1] == link.from))
        return true;
    return false;
  };
  return std::any_of(model_.experiment.drawing.begin(), model_.experiment.drawing.end(), shows);
}

void Planner::add_links() {
  for (const Link& l : system_.links)
    if (!drawn_between(l)) link(l.from, l.to, l.from_name, l.to_name, l.kind == Link::Kind::Spring);
}

/// In every configuration; or along the run of a system whose constraints may be what keeps it.
bool Planner::keeps_distance(const ExprVector& a, const ExprVector& b) const {
  Expr square = system_.context->number(0);
  for (std::size_t k = 0; k < a.size(); ++k) square = square + (a[k] - b[k]) * (a[k] - b[k]);
  if (same_everywhere(system_, {square}, parameters_)) return value_of(system_, square, parameters_) != 0;
  if (system_.constraints.empty() || run_.rows() < 2) return false;
  square = in_terms_of_motion(system_, {&square, 1}).front();
  double low = HUGE_VAL, high = -HUGE_VAL;
  const std::size_t stride = std::max<std::size_t>(1, run_.rows() / 40);
  for (std::size_t row = 0; row < run_.rows(); row += stride) {
    Bindings state = parameters_;
    state[system_.context->time()] = run_.times[row];
    for (const Coordinate& c : system_.coordinates) {
      const auto q = run_.column(c.name), v = run_.column(c.name + "'");
      if (!q || !v) return false;
      state[c.q] = run_.at(row, *q);
      state[c.velocity] = run_.at(row, *v);
    }
    const double value = evaluate(square, state);
    low = std::min(low, value);
    high = std::max(high, value);
  }
  return high > 0 && high - low < 1e-9 * high;
}

void Planner::add_what_is_there() {
  struct Place {
    std::string name;
    const ExprVector* position;
    bool massive;
  };
  std::vector<Place> places;
  const ExprVector origin(dimension_, system_.context->number(0));
  if (const Point* own = system_.find_point("O"))
    places.push_back({"O", &own->position, false});
  else
    places.push_back({"O", &origin, false});
  for (const Point& p : system_.points)
    if (p.name != "O") places.push_back({p.name, &p.position, static_cast<bool>(p.mass)});
  for (const Body& b : system_.bodies) places.push_back({b.name, &b.position, static_cast<bool>(b.mass)});
  constexpr std::size_t most_trails = 3;
  std::size_t trails = 0;
  for (const Place& p : places)
    if (p.massive && trails < most_trails && !same_everywhere(system_, *p.position, parameters_)) {
      path({*p.position}, {p.name}, Kind::Trail);
      ++trails;
    }
  for (const Body& b : system_.bodies) solid_of_inertia(b);
  // A rod from each moving place to the last one before it whose distance is kept.
  for (std::size_t i = 1; i < places.size(); ++i) {
    if (same_everywhere(system_, *places[i].position, parameters_)) continue;
    for (std::size_t k = i; k-- > 0;)
      if (keeps_distance(*places[k].position, *places[i].position)) {
        path({*places[k].position, *places[i].position}, {places[k].name, places[i].name}, Kind::Path);
        pivots({*places[k].position});
        break;
      }
  }
  for (const Point& p : system_.points) path({p.position}, {p.name}, Kind::Path);
}

}  // namespace

bool same_everywhere(const MechanicalSystem& system, const std::vector<Expr>& expressions, const Bindings& parameters) {
  const std::vector<Expr> wanted = in_terms_of_motion(system, expressions);
  std::vector<double> first;
  for (int trial = 0; trial < 3; ++trial) {
    Bindings state = parameters;
    double seed = 0.1 + trial;
    const auto next = [&] { return seed = std::fmod(seed * 1.618033988749895 + 0.2718281828, 1.7) + 0.05; };
    state[system.context->time()] = next();
    for (const Coordinate& c : system.coordinates) state[c.q] = next(), state[c.velocity] = next();
    const std::vector<double> values = evaluate(wanted, state);
    if (trial == 0) first = values;
    for (std::size_t i = 0; i < values.size(); ++i)
      if (!(std::abs(values[i] - first[i]) <= 1e-12 * std::max(1.0, std::abs(first[i])))) return false;
  }
  return true;
}

Plan plan_of(const Model& model, const Bindings& parameters, const EquationsOfMotion* equations,
             const Trajectory& run, ForcesShown forces) {
  return Planner(model, parameters, equations, run).plan(forces);
}

}  // namespace maupertuis::drawing
