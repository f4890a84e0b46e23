#include <maupertuis/field_statements.hpp>
#include <maupertuis/field_system.hpp>
#include <maupertuis/print.hpp>

#include "system/elaboration.hpp"
#include "system/field_places.hpp"
#include "system/unit_expression.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

/// field, density, boundary and the forces on fields.
namespace maupertuis::elaboration {
namespace {

using syntax::Expression;
using syntax::FieldDeclaration;
using Kind = Declaration::Kind;
using Side = BoundaryCondition::Side;

template <class Clause, class Visit>
void each_clause(const Elaboration& e, Visit visit) {
  for (const syntax::Statement& s : e.tree.statements)
    if (const auto* f = std::get_if<syntax::FieldStatement>(&s.body))
      if (const auto* clause = std::get_if<Clause>(&f->said->body)) visit(*clause, s.span);
}

FieldSystem& system_of(Elaboration& e) { return e.fields->system; }

// --------------------------------------------------------------------------------------------------------- the space

struct End {
  Expr value;
  Dimension dimension;
};

/// An end of a domain: known before the run, of the dimension that the variable has.
std::optional<End> end_of_range(Elaboration& e, const Expression& x) {
  Place place;
  place.inline_constants = true;
  const Value v = evaluate_formula(e, x, place);
  if (v.poisoned) return std::nullopt;
  if (v.is_vector || e.context.depends_on_time(v.scalar().id()) || !constant_value(e, v.scalar())) {
    e.diagnostics.error("E0284", x.span, "an end of a domain must be known before the run",
                        "A field lives between places that stand in the model: numbers and parameters.",
                        "Write a number or a parameter there.");
    return std::nullopt;
  }
  return End{v.scalar(), v.fits_any ? e.dimension(dimensions::length()) : v.dimension};
}

void range_of(Elaboration& e, const FieldDeclaration::Range& range) {
  SpaceVariable* variable = nullptr;
  for (SpaceVariable& x : system_of(e).space)
    if (x.name == range.variable.text) variable = &x;
  if (!variable) {
    e.diagnostics.error("E0284", range.variable.span,
                        fmt::format("`{}` is no variable of this field", range.variable.text),
                        "A domain gives each space variable of the field its two ends.",
                        "Write a variable that stands in the brackets of the field.");
    return;
  }
  const auto to = end_of_range(e, *range.to), from = end_of_range(e, *range.from);
  if (!to || !from) return;
  variable->dimension = to->dimension;
  const auto a = constant_value(e, from->value), b = constant_value(e, to->value);
  if (*a < *b) {
    variable->from = from->value;
    variable->to = to->value;
    return;
  }
  e.diagnostics.error("E0284", cover(range.from->span, range.to->span), "the domain ends before it begins",
                      fmt::format("{} goes from the smaller value to the larger one.", variable->name),
                      "Exchange the two ends.");
}

/// A whole number that is known; 0, and a message, if it is none.
int whole_number(Elaboration& e, const Expression& x, const char* what, double least, double most) {
  const Value v = constant_of(e, x, Dimension{}, what);
  if (v.poisoned) return 0;
  const double n = constant_value(e, v.scalar()).value_or(0);
  if (n >= least && n <= most && n == std::floor(n)) return static_cast<int>(n);
  e.diagnostics.error("E0287", x.span, fmt::format("{} is a whole number from {} to {}", what, least, most),
                      most > 100 ? "A finer mesh would not fit into memory, nor be finished in a lifetime." : "",
                      most > 100 ? "Write fewer cells, or a higher order of the elements." : "");
  return 0;
}

void declare_space(Elaboration& e, const FieldDeclaration& s) {
  FieldSystem& system = system_of(e);
  for (const syntax::Name& x : s.items.front().variables) {
    Declaration* d = e.table.find(x.text);
    if (!d || d->kind != Kind::Space) continue;
    if (std::any_of(system.space.begin(), system.space.end(), [&](const auto& one) { return one.name == x.text; })) {
      e.diagnostics.error("E0202", x.span, fmt::format("`{}` is declared twice", x.text),
                          "It is a space variable of this field already.", "Give one of them another name.");
    }
    system.space.push_back(
        {x.text, e.context.symbol(x.text, Role::Auxiliary), e.dimension(dimensions::length()), {}, {}, 0, x.span});
  }
  if (system.space.size() > 3)
    e.diagnostics.error("E0284", s.items.front().variables[3].span, "a field of more than three space variables",
                        "Space has three dimensions.", "Leave the fourth variable out.");
  for (const FieldDeclaration::Range& range : s.ranges) range_of(e, range);
  constexpr double most_cells = 1e6;
  for (std::size_t i = 0; i < s.cells.size(); ++i) {
    if (i >= system.space.size()) {
      e.diagnostics.error("E0287", s.cells[i]->span, "more numbers of cells than space variables",
                          "A mesh has one number of cells for each space variable.", "");
      break;
    }
    system.space[i].cells = whole_number(e, *s.cells[i], "the number of cells", 1, most_cells);
  }
  double all = 1;
  for (const SpaceVariable& x : system.space) all *= std::max(x.cells, 1);
  if (all > most_cells)
    e.diagnostics.error("E0287", cover(s.cells.front()->span, s.cells.back()->span),
                        fmt::format("a mesh of {:.3g} cells is too large", all),
                        fmt::format("A mesh may have {:.0g} cells: a finer one would not fit into memory.", most_cells),
                        "Write fewer cells, or a higher order of the elements.");
  if (s.order) system.element_order = whole_number(e, *s.order, "the order of the elements", 1, 20);
  system.periodic = s.periodic;
}

bool same_variables(const FieldSystem& system, const std::vector<syntax::Name>& variables) {
  if (variables.size() != system.space.size()) return false;
  for (std::size_t i = 0; i < variables.size(); ++i)
    if (variables[i].text != system.space[i].name) return false;
  return true;
}

/// E0284 where two fields live on different variables.
bool check_variables(Elaboration& e, const std::vector<syntax::Name>& variables) {
  if (same_variables(system_of(e), variables)) return true;
  std::string names;
  for (const SpaceVariable& x : system_of(e).space) names += (names.empty() ? "" : ", ") + x.name;
  e.diagnostics.error(
      "E0284", cover(variables.front().span, variables.back().span), "fields of different variables",
      fmt::format("One density holds all fields of a model, so that they live on the same space: {}.", names),
      fmt::format("Write ({}).", names));
  return false;
}

Dimension dimension_of_field(Elaboration& e, const FieldDeclaration::Item& item) {
  if (item.unit) {
    const std::optional<Unit> unit = unit_of(e, *item.unit);
    return unit ? unit->dimension : Dimension{};
  }
  const std::string& kind = item.kind.text;
  return e.dimension(kind == "angle"    ? dimensions::angle()
                     : kind == "length" ? dimensions::length()
                     : kind == "charge" ? dimensions::charge()
                                        : Dimension{});
}

void declare_field(Elaboration& e, const FieldDeclaration::Item& item) {
  Declaration* d = e.table.find(item.name.text);
  if (!d || d->kind != Kind::Field) return;
  d->done = true;
  d->used = true;
  d->value = Value::poison();
  if (!check_variables(e, item.variables)) return;
  d->index = system_of(e).fields.size();
  Field f{item.name.text, dimension_of_field(e, item), item.kind.text, false, {}, item.name.span};
  d->value = Value::of(e.context.symbol(f.name, Role::Coordinate, 0), f.dimension, 0);
  system_of(e).fields.push_back(std::move(f));
}

/// input q(x) : [N/m]
void declare_given(Elaboration& e) {
  for (const syntax::Statement& s : e.tree.statements) {
    const auto* input = std::get_if<syntax::InputStatement>(&s.body);
    Declaration* d = input && !input->variables.empty() ? e.table.find(input->name.text) : nullptr;
    if (!d || d->kind != Kind::Input) continue;
    d->done = true;
    d->value = Value::poison();
    if (!check_variables(e, input->variables)) continue;
    const std::optional<Unit> unit = input->unit ? unit_of(e, *input->unit) : std::optional<Unit>(Unit{});
    if (!unit) continue;
    Field f{input->name.text, unit->dimension, "", true, {}, input->name.span};
    d->value = Value::of(e.context.symbol(f.name, Role::Input, 0), f.dimension);
    system_of(e).fields.push_back(std::move(f));
  }
}

/// E0290: u_x would be two things.
void check_reserved(Elaboration& e) {
  for (const Declaration& d : e.table.declarations()) {
    if (d.kind == Kind::Field || d.kind == Kind::Energy || !d.statement) continue;
    const std::optional<FieldJet> jet = system_of(e).jet_of_name(d.name);
    if (!jet || jet->order() == 0) continue;
    e.diagnostics.error(
        "E0290", d.span,
        fmt::format("`{}` is a derivative of the field {}", d.name, system_of(e).fields[jet->field].name),
        "The name of a field with an underscore and variables is its derivative.", "Give it another name.");
  }
}

/// ω and k of waves, under names that the model does not have.
void name_waves(Elaboration& e) {
  const auto symbol = [&](std::string name) {
    while (e.table.find(name)) name += "_w";
    return e.context.symbol(name, Role::Auxiliary);
  };
  const std::vector<SpaceVariable>& space = system_of(e).space;
  e.fields->omega = symbol("ω");
  for (const SpaceVariable& x : space)
    e.fields->wave_numbers.push_back(symbol(space.size() == 1 ? "k" : "k_" + x.name));
}

// ------------------------------------------------------------------------------------------------------- the density

Dimension density_dimension(Elaboration& e) {
  Dimension out = e.dimension(dimensions::energy());
  for (const SpaceVariable& x : system_of(e).space) out = out / x.dimension;
  return out;
}

/// E0299 for a value at a place, which would act on every piece of the field at once.
bool refuse_values_at_places(Elaboration& e, Expr value, const Expression& x) {
  const std::vector<Expr> symbols = symbols_of({&value, 1});
  for (const PlaceValue& place : e.fields->places) {
    if (std::find(symbols.begin(), symbols.end(), place.symbol) == symbols.end()) continue;
    e.diagnostics.error("E0299", x.span, fmt::format("`{}` stands in a density", e.texts.slice(place.span)),
                        "A density is local: what it says of a piece of space is the field there.",
                        "Values at places stand in T, V, L, D, constraints and forces at places.");
    return true;
  }
  return false;
}

/// E0282, E0283 and E0299 for what a density cannot hold; `time` and `space`: derivatives that it may hold.
bool check_jets(Elaboration& e, Expr value, const Expression& x, int time, int space) {
  if (refuse_values_at_places(e, value, x)) return false;
  for (const Expr& symbol : system_of(e).jets_in(value)) {
    const FieldJet jet = *system_of(e).jet_of(symbol);
    if (system_of(e).fields[jet.field].given) continue;
    if (jet.time > time) {
      Span at = culprit_of_order(e, x, time + 1);
      e.diagnostics.error(
          "E0282", at.end > at.begin ? at : x.span,
          fmt::format("`{}` stands in the density", system_of(e).jet_name(jet)),
          "A density depends on fields and their velocities; accelerations are what the field equations give.",
          "Write it with first derivatives in time.");
      return false;
    }
    if (jet.order() <= space) continue;
    e.diagnostics.error("E0283", x.span, fmt::format("`{}` stands in the density", system_of(e).jet_name(jet)),
                        "A density holds derivatives up to the second.",
                        "Name what is differentiated as a field of its own.");
    return false;
  }
  return true;
}

Expr drives_as_formulas(Elaboration& e, Expr value) {
  return expand_time_derivatives(with_inputs_as_formulas(e.system(), value));
}

/// E0293: a density in complex fields has no imaginary part.
bool check_real(Elaboration& e, const syntax::DensityText& s, const Dimension& dimension) {
  const Value v = scalar_of(e, *s.imaginary, dimension, "the imaginary part of the density");
  if (v.poisoned) return false;
  const Expr imaginary = drives_as_formulas(e, v.scalar());
  if (zero_test(imaginary).verdict == Verdict::Zero) return true;
  e.diagnostics.error(
      "E0293", s.value->span, "this density is not real",
      fmt::format("Its imaginary part is {}; an action is a real number.", to_plain(imaginary, ReadingOrder{})),
      "Write for example i/2 (conj(ψ) ψ' - ψ conj(ψ')) in the place of i conj(ψ) ψ'.");
  return false;
}

void densities(Elaboration& e) {
  FieldSystem& system = system_of(e);
  std::optional<Span> first[2];
  std::vector<Expr> parts[2];
  each_clause<syntax::DensityText>(e, [&](const syntax::DensityText& s, Span) {
    const char* what = s.dissipation ? "the dissipation density" : "the density";
    if (first[s.dissipation] && !s.adds) {
      e.diagnostics.error("E0207", s.name_span, fmt::format("{} is given twice", what),
                          fmt::format("It is already given in line {}.", e.texts.locate(*first[s.dissipation]).line),
                          "Write `density += …` to add to it.");
      return;
    }
    first[s.dissipation] = s.name_span;
    const Dimension dimension =
        s.dissipation ? system.density_dimension / system.time_dimension : system.density_dimension;
    const Value v = scalar_of(e, *s.value, dimension, what);
    if (v.poisoned) return;
    const Expr value = drives_as_formulas(e, v.scalar());
    if (s.imaginary && !check_real(e, s, dimension)) return;
    if (check_jets(e, value, *s.value, 1, 2)) parts[s.dissipation].push_back(value);
  });
  if (!first[0]) {
    if (!e.diagnostics.has_errors())  // else it was lost with a mistake of its own
      e.diagnostics.error("E0280",
                          system.fields.empty() ? std::nullopt : std::optional<Span>(system.fields.front().span),
                          "the field has no density",
                          "The action of a field is the integral of its Lagrangian density over space and time.",
                          "Write it, for example `density = 1/2 ρ u'^2 - 1/2 T u_x^2`.");
    return;
  }
  system.density_span = *first[0];
  system.density = sum_of(parts[0], e.context);
  if (first[1]) system.dissipation = sum_of(parts[1], e.context);
  for (const Field& f : system.fields) {
    if (f.given) continue;
    bool stands = false;
    for (const Expr& symbol : system.jets_in(system.density))
      stands = stands || &system.fields[system.jet_of(symbol)->field] == &f;
    if (!stands && !parts[0].empty())
      e.diagnostics.error("E0280", f.span, fmt::format("the field `{}` does not stand in the density", f.name),
                          "Without a part in the density no equation says what it does.",
                          "Leave it out, or add its part with `density += …`.");
  }
}

// ----------------------------------------------------------------------------------------------------- the boundary

std::optional<FieldJet> jet_named(Elaboration& e, const Expression& x) {
  if (x.kind != Expression::Kind::Name && x.kind != Expression::Kind::Call) return std::nullopt;
  std::optional<FieldJet> jet = system_of(e).jet_of_name(x.text);
  if (jet) jet->time += x.primes;
  if (jet && system_of(e).fields[jet->field].given) return std::nullopt;
  return jet;
}

const char* name_of(Side side) {
  constexpr const char* names[] = {"left", "right", "bottom", "top"};
  return names[static_cast<int>(side)];
}

/// A value at the boundary: known at every time, whatever the field does.
Expr boundary_value(Elaboration& e, const Expression& x, const Dimension& dimension, const std::string& what) {
  Place place;
  place.inline_constants = true;
  const Value v = scalar_of(e, x, dimension, what, place);
  if (v.poisoned) return {};
  if (v.order < 0) return drives_as_formulas(e, v.scalar());
  e.diagnostics.error("E0285", x.span, "a value at the boundary that depends on a field",
                      "A condition at the boundary says what the field is there: a formula of t.", "");
  return {};
}

/// A formula of x, as it is on the side across x.
Expr on_side(const FieldSystem& system, Expr value, Side side) {
  const SpaceVariable& x = system.space[side == Side::Left || side == Side::Right ? 0 : 1];
  return substitute(value, {{x.symbol, side == Side::Right || side == Side::Top ? x.to : x.from}});
}

/// u = 0, u_x = 0 at one side
void condition_at(Elaboration& e, Side side, const syntax::Equation& s) {
  FieldSystem& system = system_of(e);
  const auto jet = jet_named(e, *s.left);
  const std::size_t along = side == Side::Left || side == Side::Right ? 0 : 1;
  const bool normal = jet && jet->time == 0 && jet->order() <= 1 && (jet->order() == 0 || jet->space[along] == 1);
  if (!normal || s.left->kind != Expression::Kind::Name) {
    e.diagnostics.error(
        "E0285", s.left->span, "this is no condition at a boundary",
        "A boundary condition gives the field or its slope: u = …, u_x = …. All others are natural: they "
        "follow from the density.",
        "`maup derive` shows the natural conditions.");
    return;
  }
  Expr value = boundary_value(e, *s.right, system.dimension_of(*jet), "a value at the boundary");
  if (!value) return;
  value = on_side(system, value, side);
  for (const BoundaryCondition& other : system.boundary) {
    if (other.side != side || other.jet.field != jet->field || other.jet.order() != jet->order()) continue;
    e.diagnostics.error(
        "E0285", s.left->span, fmt::format("`{}` is given twice at the {} end", system.jet_name(*jet), name_of(side)),
        fmt::format("It is already given in line {}.", e.texts.locate(other.span).line), "Keep one of them.");
    return;
  }
  system.boundary.push_back({side, *jet, value, cover(s.left->span, s.right->span)});
}

std::optional<Side> side_named(Elaboration& e, const syntax::Name& name) {
  const std::size_t sides = std::min<std::size_t>(2 * system_of(e).space.size(), 4);
  for (std::size_t i = 0; i < sides; ++i)
    if (name.text == name_of(static_cast<Side>(i))) return static_cast<Side>(i);
  e.diagnostics.error("E0286", name.span, fmt::format("this model has no boundary `{}`", name.text),
                      sides == 2 ? "A field of one space variable has the ends left and right."
                                 : "A rectangle has the sides left, right, bottom and top.",
                      "");
  return std::nullopt;
}

void refuse_without_domain(Elaboration& e, Span span) {
  e.diagnostics.error("E0286", span, "a boundary without a domain", "Without ends the field fills all space.",
                      "Give the domain of the field: `on x = 0 .. l`.");
}

void boundaries(Elaboration& e) {
  FieldSystem& system = system_of(e);
  const bool bounded = !system.space.empty() && system.space.front().from;
  each_clause<FieldDeclaration>(e, [&](const FieldDeclaration& s, Span) {
    if (s.boundary.empty() && !s.periodic) return;
    if (!bounded) return refuse_without_domain(e, s.boundary_span);
    for (const syntax::Equation& one : s.boundary)
      for (std::size_t side = 0; side < 2 * std::min<std::size_t>(system.space.size(), 2); ++side)
        condition_at(e, static_cast<Side>(side), one);
  });
  each_clause<syntax::BoundaryText>(e, [&](const syntax::BoundaryText& s, Span span) {
    std::vector<Side> sides;
    if (s.side.text.empty())
      for (std::size_t i = 0; i < 2 * std::min<std::size_t>(system.space.size(), 2); ++i)
        sides.push_back(static_cast<Side>(i));
    else if (const auto side = side_named(e, s.side))
      sides.push_back(*side);
    if (sides.empty()) return;
    if (!bounded) return refuse_without_domain(e, span);
    if (system.periodic) {
      e.diagnostics.error("E0285", span, "a boundary of a periodic domain",
                          "Its ends are one place: the field goes on from one to the other.",
                          "Leave out `boundary periodic`, or this statement.");
      return;
    }
    for (const syntax::Equation& one : s.conditions)
      for (const Side side : sides) condition_at(e, side, one);
  });
}

/// u_x at an end is the force there where the density has no second derivative of u: beside a given u it says nothing.
void refuse_slopes_beside_values(Elaboration& e) {
  const FieldSystem& system = system_of(e);
  for (const BoundaryCondition& slope : system.boundary) {
    if (slope.jet.order() == 0 || !system.density) continue;
    bool bends = false;
    for (const Expr& one : system.jets_in(system.density)) {
      const FieldJet jet = *system.jet_of(one);
      bends = bends || (jet.field == slope.jet.field && jet.order() - jet.time > 1);
    }
    for (const BoundaryCondition& value : system.boundary) {
      if (bends || value.jet.order() != 0 || value.jet.field != slope.jet.field || value.side != slope.side) continue;
      e.diagnostics.error(
          "E0285", slope.span,
          fmt::format("`{}` and `{}` are both given at the {} end", system.jet_name(value.jet),
                      system.jet_name(slope.jet), name_of(slope.side)),
          "The density holds first derivatives alone: an end takes one condition, and the slope there is what "
          "the support makes of it.",
          "Keep one of them.");
      return;
    }
  }
}

// ------------------------------------------------------------------------------------------------------- the forces

/// force density u = f
void force_density(Elaboration& e, const syntax::FieldForce& s, const FieldJet& jet) {
  FieldSystem& system = system_of(e);
  const Value v = scalar_of(e, *s.value, system.density_dimension / system.fields[jet.field].dimension,
                            fmt::format("the force density on {}", system.fields[jet.field].name));
  if (v.poisoned) return;
  const Expr value = drives_as_formulas(e, v.scalar());
  if (!check_jets(e, value, *s.value, 1, 2)) return;
  Expr& force = system.forces[jet.field];
  force = force ? force + value : value;
}

/// Whether a place is a function of coordinates or t.
bool moves(Elaboration& e, const Expression& place) {
  Place quiet;
  quiet.inline_constants = true;
  const Value read = evaluate_formula(e, place, quiet);
  return !read.poisoned && !read.is_vector && !constant_value(e, read.scalar());
}

/// force u(l) = F at an end of the domain; beside bodies, or inside, a force on a coordinate
void force_at_place(Elaboration& e, const syntax::FieldForce& s, const FieldJet& jet, Span span) {
  if (!e.fields->coupled) e.fields->coupled = moves(e, *s.on->arguments.front());
  if (e.fields->coupled) return force_on_place(e, s, jet, span);
  FieldSystem& system = system_of(e);
  const SpaceVariable& x = system.space.front();
  const Value place = constant_of(e, *s.on->arguments.front(), x.dimension, "a place");
  if (place.poisoned) return;
  const double at = constant_value(e, place.scalar()).value_or(0);
  const double a = x.from ? *constant_value(e, x.from) : 0, b = x.from ? *constant_value(e, x.to) : 0;
  const double near = 1e-12 * (b - a);
  const bool at_end = x.from && !system.periodic && (std::abs(at - a) <= near || std::abs(at - b) <= near);
  if (!at_end) {
    e.fields->coupled = true;
    return force_on_place(e, s, jet, span);
  }
  const Dimension dimension = e.dimension(dimensions::energy()) / system.dimension_of(jet);
  const Expr value = boundary_value(e, *s.value, dimension, "a force at an end");
  const Side side = std::abs(at - a) <= near ? Side::Left : Side::Right;
  if (value) system.end_forces.push_back({side, jet, on_side(system, value, side), span});
}

void forces(Elaboration& e) {
  system_of(e).forces.resize(system_of(e).fields.size());
  each_clause<syntax::FieldForce>(e, [&](const syntax::FieldForce& s, Span span) {
    const auto jet = jet_named(e, *s.on);
    const bool place = s.on->kind == Expression::Kind::Call;
    if (jet && jet->time == 0 && !place && jet->order() == 0) return force_density(e, s, *jet);
    if (jet && jet->time == 0 && place && jet->order() <= 1 && system_of(e).space.size() == 1)
      return force_at_place(e, s, *jet, span);
    e.diagnostics.error("E0288", s.on->span, "a force acts on a field or at its end",
                        "The virtual work of a force density is f δu in each piece of space, of an end force F δu.",
                        "Write `force density u = …` or `force u(l) = …`.");
  });
}

void given_formulas(Elaboration& e) {
  for (const syntax::Statement& s : e.tree.statements) {
    const auto* input = std::get_if<syntax::InputStatement>(&s.body);
    if (!input || input->variables.empty() || !input->value) continue;
    for (Field& f : system_of(e).fields) {
      if (!f.given || f.name != input->name.text) continue;
      const Value v = scalar_of(e, *input->value, f.dimension, fmt::format("the input {}", f.name));
      if (!v.poisoned && v.order < 0) f.formula = drives_as_formulas(e, v.scalar());
    }
  }
}

/// E0281 where a density or a boundary stands in a model without a field, unless one may be among the statements that
/// were left out because of a mistake.
void refuse_without_field(Elaboration& e) {
  if (!e.tree.lost_names.empty()) return;
  for (const syntax::Statement& s : e.tree.statements) {
    const auto* f = std::get_if<syntax::FieldStatement>(&s.body);
    if (!f) continue;
    e.diagnostics.error("E0281", s.span, fmt::format("`{}` stands in a model without a field", f->what),
                        "It is a part of the action of a field.", "Declare one, for example `field u(x) : length`.");
    return;
  }
}

}  // namespace

bool declare_fields(Elaboration& e) {
  bool any = false;
  each_clause<FieldDeclaration>(e, [&](const FieldDeclaration& s, Span) {
    if (!any) {
      e.fields = std::make_shared<FieldModel>();
      system_of(e).context = e.system().context;
      system_of(e).time_dimension = e.time();
      declare_space(e, s);
    } else if (!s.ranges.empty() || !s.cells.empty() || s.order) {
      e.diagnostics.error("E0284", s.items.front().name.span, "a second domain",
                          "All fields of a model live on the domain of the first one.", "Leave the domain out here.");
    }
    any = true;
    for (const FieldDeclaration::Item& item : s.items) declare_field(e, item);
  });
  if (!any) return false;
  declare_given(e);
  for (const SpaceVariable& x : system_of(e).space)
    if (Declaration* d = e.table.find(x.name); d && d->kind == Kind::Space) {
      d->done = d->used = true;
      d->value = Value::of(x.symbol, x.dimension);
    }
  for (Declaration& d : e.table.declarations())  // of a field that was refused
    if (d.kind == Kind::Space && !d.done) d.done = true, d.value = Value::poison();
  system_of(e).density_dimension = density_dimension(e);
  check_reserved(e);
  e.fields->coupled = couples_mechanics(e);
  refuse_beside_fields(e);
  name_waves(e);
  return true;
}

void elaborate_fields(Elaboration& e) {
  if (!e.fields) return refuse_without_field(e);
  given_formulas(e);
  densities(e);
  boundaries(e);
  refuse_slopes_beside_values(e);
  forces(e);
  for (const Definition& d : e.system().definitions)
    if (d.symbol) system_of(e).definitions[d.symbol] = d.value;
  check_places(e);
  e.fields->complete = true;
}

bool start_of_field(Elaboration& e, const syntax::StartStatement::Item& item) {
  if (!e.fields) return false;
  const auto jet = jet_named(e, *item.variable);
  if (!jet) return false;
  if (item.variable->kind == Expression::Kind::Call) {
    e.diagnostics.error("E0223", item.variable->span,
                        fmt::format("`{}` cannot be chosen", e.texts.slice(item.variable->span)),
                        "A start gives the field and its velocity everywhere, and so at each place.",
                        fmt::format("Write `start {} = …` as a formula of space.", item.variable->text));
    return true;
  }
  const Dimension dimension = system_of(e).dimension_of(*jet);
  Place place;
  place.inline_constants = true;
  const Value v = scalar_of(e, *item.value, dimension, fmt::format("`{}`", e.texts.slice(item.variable->span)), place);
  const std::string text(e.texts.slice(item.variable->span));
  if (jet->time > 1 || jet->order() > jet->time) {
    e.diagnostics.error("E0223", item.variable->span, fmt::format("`{}` cannot be chosen", text),
                        "A start gives the field and its velocity everywhere; their derivatives follow.",
                        "Leave it out.");
    return true;
  }
  if (v.poisoned) return true;
  if (e.context.depends_on_time(v.scalar().id())) {
    e.diagnostics.error("E0222", item.value->span, fmt::format("`{}` must be known before the run", text),
                        "It is a formula of the space variables and parameters.", "");
    return true;
  }
  for (const FieldStart& other : e.fields->start)
    if (other.field == jet->field && other.order == jet->time) {
      e.diagnostics.error("E0208", item.variable->span, fmt::format("`{}` starts twice", text),
                          fmt::format("Its start is already given in line {}.", e.texts.locate(other.span).line),
                          "Keep one of them.");
      return true;
    }
  e.fields->start.push_back({jet->field, jet->time, v.scalar(), item.variable->span});
  return true;
}

std::optional<Value> value_of_jet(Elaboration& e, const syntax::Expression& x) {
  if (!e.fields) return std::nullopt;
  std::optional<FieldJet> jet = system_of(e).jet_of_name(x.text);
  if (!jet) return std::nullopt;
  jet->time += x.primes;
  const bool given = system_of(e).fields[jet->field].given;
  return Value::of(system_of(e).jet_symbol(*jet), system_of(e).dimension_of(*jet), given ? -1 : jet->time);
}

bool refuse_without_place(Elaboration& e, Expr value, const syntax::Expression& x) {
  if (!e.fields) return false;
  const FieldSystem& system = system_of(e);
  std::string name;
  for (const Expr& symbol : symbols_of({&value, 1})) {
    if (const auto jet = system.jet_of(symbol)) name = system.jet_name(*jet);
    for (const SpaceVariable& v : system.space)
      if (v.symbol == symbol) name = v.name;
  }
  if (name.empty()) return false;
  e.diagnostics.error("E0289", x.span, fmt::format("`{}` stands without a place", name),
                      "A field has a value at each place; a value that is asked for needs one.",
                      "Write u(3 m), u_x(3 m), or for the velocity u_t(3 m); or `total` for the integral.");
  return true;
}

namespace {

bool is_outside(Elaboration& e, const SpaceVariable& along, double at) {
  return along.from && (at < *constant_value(e, along.from) || at > *constant_value(e, along.to));
}

bool holds_field_values(Elaboration& e, Expr place) {
  const std::vector<Expr> symbols = symbols_of({&place, 1});
  return std::any_of(symbols.begin(), symbols.end(), [&](const Expr& symbol) {
    return system_of(e).jet_of(symbol) ||
           std::any_of(e.fields->attached.begin(), e.fields->attached.end(), [&](const PlaceCoordinate& p) {
             const Coordinate& c = e.system().coordinates[p.coordinate];
             return symbol == c.q;
           });
  });
}

/// E0289 where a place that holds t or coordinates is none that can be followed.
bool refuse_moving_place(Elaboration& e, const Expression& x, const FieldJet& jet, const Value& read, Span place) {
  const FieldSystem& system = system_of(e);
  if (!e.fields->coupled || system.space.size() > 1 || read.is_vector) {
    e.diagnostics.error("E0289", place, "this place is not known before the run",
                        fmt::format("`{}(…)` is the value of the field at a place, never a product.", x.text),
                        fmt::format("Write the other factor first, or `{} * (…)`.", x.text));
    return true;
  }
  if (read.order > 0 || holds_field_values(e, read.scalar())) {
    e.diagnostics.error("E0289", place, "this place moves with a velocity, or with the field",
                        "What takes hold of a field does so at a constant place, or at one that coordinates and the "
                        "time tell.",
                        "Write a formula of coordinates, t and parameters.");
    return true;
  }
  if (jet.time <= x.primes) return false;
  const std::string value = fmt::format("{}({})", system.jet_name({jet.field, jet.space, 0}), e.texts.slice(place));
  e.diagnostics.error(
      "E0289", x.span, fmt::format("the velocity `{}` at a place that moves", x.text),
      fmt::format("What rides on the field has the velocity d/dt {}, the field's own and that along its slope.", value),
      fmt::format("Write {}'.", value));
  return true;
}

/// The place along one space variable: a constant, or a function of coordinates and t; nothing, and told, where it is
/// neither.
std::optional<Expr> place_along(Elaboration& e, const Expression& x, const FieldJet& jet, std::size_t i) {
  const SpaceVariable& along = system_of(e).space[i];
  const Expression& written = *x.arguments[i];
  Place quiet;
  quiet.inline_constants = true;
  const Value read = evaluate_formula(e, written, quiet);
  if (!read.poisoned && (read.is_vector || !constant_value(e, read.scalar()))) {
    if (refuse_moving_place(e, x, jet, read, written.span)) return std::nullopt;
    const Value v = scalar_of(e, written, along.dimension, "a place");
    if (v.poisoned) return std::nullopt;
    return drives_as_formulas(e, v.scalar());
  }
  const Value v = read.poisoned ? read : constant_of(e, written, along.dimension, "a place");
  if (v.poisoned) return std::nullopt;
  if (!is_outside(e, along, constant_value(e, v.scalar()).value_or(0))) return v.scalar();
  e.diagnostics.error("E0289", written.span, "this place lies outside of the domain", "The field has no value there.",
                      fmt::format("Choose a place between the ends of {}.", along.name));
  return std::nullopt;
}

}  // namespace

Value value_at_place(Elaboration& e, const syntax::Expression& x) {
  FieldSystem& system = system_of(e);
  std::optional<FieldJet> jet = system.jet_of_name(x.text);
  jet->time += x.primes;
  if (x.arguments.size() != system.space.size()) {
    e.diagnostics.error(
        "E0289", x.span,
        fmt::format("a place has {} coordinate{}", system.space.size(), system.space.size() == 1 ? "" : "s"),
        "It gives each space variable of the field its value.",
        system.space.size() == 1 ? "Write u(3 m)." : "Write them one after the other, u(3 m, 1 m).");
    return Value::poison();
  }
  PlaceValue out{{}, system.jet_symbol(*jet), {}, x.span};
  for (std::size_t i = 0; i < x.arguments.size(); ++i) {
    const std::optional<Expr> place = place_along(e, x, *jet, i);
    if (!place) return Value::poison();
    out.place.push_back(*place);
  }
  if (e.fields->coupled && !e.fields->complete) return coordinate_at_place(e, x, *jet, out.place.front());
  if (e.fields->coupled)
    if (const auto q = attached_symbol(e, *jet, out.place.front()))
      return Value::of(*q, system.dimension_of(*jet), jet->time);
  if (!std::all_of(out.place.begin(), out.place.end(), [&](Expr at) { return constant_value(e, at).has_value(); })) {
    e.diagnostics.error("E0289", x.span, "not supported yet: a place that moves where nothing takes hold of the field",
                        "Runs follow the places of masses and forces; other values are asked for at fixed places.",
                        "Ask at the place where the load is at that time.");
    return Value::poison();
  }
  out.symbol = e.context.symbol(name_of_place_value(e, x, *jet), Role::Coordinate, jet->time);
  const Expr symbol = out.symbol;
  const bool known = std::any_of(e.fields->places.begin(), e.fields->places.end(),
                                 [&](const PlaceValue& p) { return p.symbol == symbol; });
  if (!known) e.fields->places.push_back(std::move(out));
  return Value::of(symbol, system.dimension_of(*jet), jet->time);
}

}  // namespace maupertuis::elaboration
