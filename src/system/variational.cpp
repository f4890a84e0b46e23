#include "system/elaboration.hpp"
#include "system/unit_expression.hpp"

#include <fmt/format.h>

/// Variational problems: what stands in the place of t, the ends of the paths, and integrals that paths are held to.
namespace maupertuis::elaboration {
namespace {

// -------------------------------------------------------------------------------------------- independent variable

const syntax::IndependentStatement* find_independent(const Elaboration& e) {
  for (const syntax::Statement& s : e.tree.statements)
    if (const auto* x = std::get_if<syntax::IndependentStatement>(&s.body)) return x;
  return nullptr;
}

/// What a statement of mechanics is called; empty for the others.
std::string word_of_mechanics(const syntax::Statement& s) {
  if (std::get_if<syntax::FrameStatement>(&s.body)) return "frame";
  if (std::get_if<syntax::PointStatement>(&s.body)) return "point";
  if (std::get_if<syntax::BodyStatement>(&s.body)) return "body";
  if (std::get_if<syntax::GravityStatement>(&s.body)) return "gravity";
  if (std::get_if<syntax::SpringStatement>(&s.body)) return "spring";
  if (std::get_if<syntax::TorsionSpringStatement>(&s.body)) return "torsion spring";
  if (std::get_if<syntax::DamperStatement>(&s.body)) return "damper";
  if (std::get_if<syntax::ForceStatement>(&s.body)) return "force";
  if (std::get_if<syntax::ReactionStatement>(&s.body)) return "reaction";
  if (const auto* energy = std::get_if<syntax::EnergyStatement>(&s.body))
    if (energy->which != syntax::EnergyStatement::Which::L)
      return std::string(1, "TVULD"[static_cast<int>(energy->which)]);
  return {};
}

/// One message: the others follow from the same mistake. False after it.
bool allows_mechanics(Elaboration& e) {
  if (e.independent_is_time) return true;
  for (const syntax::Statement& s : e.tree.statements) {
    const std::string word = word_of_mechanics(s);
    if (word.empty()) continue;
    const std::string& x = e.system().independent;
    e.diagnostics.error(
        "E0240", s.span, fmt::format("`{}` stands in a model whose independent variable is {}", word, x),
        fmt::format("Masses, forces and energies belong to motions in time; here {} stands in its place, "
                    "which is no time.",
                    x),
        fmt::format("Give the integrand of the action as `L = …`, or write `independent {} : [s]` if it is a time.",
                    x));
    return false;
  }
  return true;
}

Dimension dimension_of_kind(const Elaboration& e, const syntax::IndependentStatement& s) {
  if (s.kind.text == "angle") return dimensions::angle();
  if (s.kind.text == "length") return dimensions::length();
  if (s.kind.text == "charge") return dimensions::charge();
  if (s.kind.text == "number") return {};
  if (s.name.text == "t") return dimensions::time();
  const std::vector<Coordinate>& coordinates = e.model.system.coordinates;
  return coordinates.empty() ? Dimension{} : coordinates.front().dimension;
}

}  // namespace

void name_independent(Elaboration& e) {
  e.system().independent_dimension = e.dimension(dimensions::time());
  e.system().lagrangian_dimension = e.dimension(dimensions::energy());
  for (const Declaration& d : e.table.declarations()) {
    if (d.kind != Declaration::Kind::Independent) continue;
    e.system().independent = d.name;
    e.context.symbol(d.name, Role::Time);  // before anything asks for time()
    return;
  }
}

bool elaborate_independent(Elaboration& e) {
  const syntax::IndependentStatement* s = find_independent(e);
  if (!s) return true;
  std::optional<Unit> unit = s->unit ? unit_of(e, *s->unit) : std::optional(Unit{});
  const bool bare = s->kind.text.empty() || s->kind.text == "number";
  const Dimension dimension = s->unit && unit ? unit->dimension : dimension_of_kind(e, *s);
  e.system().independent_dimension = e.dimension(dimension);
  // Without units nothing says that a bare number is no time.
  e.independent_is_time = e.dimensionless ? s->unit || bare : dimension.same_as(dimensions::time());
  for (Declaration& d : e.table.declarations()) {
    if (d.kind != Declaration::Kind::Independent) continue;
    const bool first = d.name == e.system().independent;
    d.done = true;
    d.value = first && unit ? Value::of(e.context.time(), e.system().independent_dimension) : Value::poison();
  }
  return allows_mechanics(e);
}

std::string in_words(const Elaboration& e, std::string text) {
  const std::string& x = e.model.system.independent;
  if (x == "t") return text;
  for (const std::string word : {"the time", "time"})
    if (const std::size_t at = text.find(word); at != std::string::npos) return text.replace(at, word.size(), x);
  return text;
}

// ------------------------------------------------------------------------------------------------------- the ends

namespace {

std::string names_of_coordinates(const MechanicalSystem& s) {
  std::string out;
  for (const Coordinate& c : s.coordinates) out += (out.empty() ? "" : ", ") + c.name;
  return out;
}

/// E0241 where there is not one value a coordinate.
bool check_count(Elaboration& e, std::size_t count, Span span, const char* what) {
  const std::size_t n = e.system().coordinates.size();
  if (count == n) return true;
  e.diagnostics.error("E0241", span,
                      fmt::format("{} has {} value{}, and the model {} coordinate{}", what, count,
                                  count == 1 ? "" : "s", n, n == 1 ? "" : "s"),
                      fmt::format("A path gives every coordinate its value, in the order of their declaration: {}.",
                                  names_of_coordinates(e.system())),
                      "Write `free` at the end of a path where a coordinate may have any value.");
  return false;
}

/// What a value of an end is about: q, or q' where q'' stands in L.
struct EndQuantity {
  std::size_t coordinate = 0;
  int order = 0;
};

/// E0241 beside anything but a coordinate, or its rate where its acceleration stands in L.
std::optional<EndQuantity> quantity_of_end(Elaboration& e, const syntax::Expression& x) {
  const auto& list = e.system().coordinates;
  std::optional<std::size_t> found = quaternion_component(e, x);
  for (std::size_t i = 0; i < list.size() && !found; ++i)
    if (x.kind == syntax::Expression::Kind::Name && list[i].name == x.text) found = i;
  if (found && (x.primes == 0 || (x.primes == 1 && e.higher.count(*found)))) return EndQuantity{*found, x.primes};
  e.diagnostics.error("E0241", x.span,
                      found ? fmt::format("`{}` is not for an end of a path to choose", e.texts.slice(x.span))
                            : fmt::format("`{}` is no coordinate", e.texts.slice(x.span)),
                      fmt::format("The ends of a path say values of the coordinates, {}; rates only of those whose "
                                  "second derivatives stand in L, of which an equation of the fourth order asks four.",
                                  names_of_coordinates(e.system())),
                      "");
  return std::nullopt;
}

/// What is given of an end: all coordinates by their order, or some by their names.
bool configuration(Elaboration& e, const syntax::PathStatement::End& end, const char* which, ExprVector& values,
                   ExprVector& rates) {
  const bool named = !end.names.empty();
  if (!named && !check_count(e, end.configuration.size(), end.span, which)) return false;
  values.resize(e.system().coordinates.size());
  rates.resize(values.size());
  bool good = true;
  for (std::size_t i = 0; i < end.configuration.size(); ++i) {
    const auto of = named ? quantity_of_end(e, *end.names[i]) : EndQuantity{i, 0};
    good = good && of;
    if (!of || !end.configuration[i]) continue;
    const Coordinate& c = e.system().coordinates[of->coordinate];
    const Dimension dimension = of->order == 0 ? c.dimension : c.dimension / e.time();
    const syntax::Expression& x = *end.configuration[i];
    const Value v =
        constant_of(e, x, dimension, fmt::format("`{}{}` at the end of a path", c.name, of->order == 0 ? "" : "'"));
    good = good && !v.poisoned;
    if (v.poisoned) continue;
    warn_of_degrees(e, v, dimension, x);
    Expr& place = (of->order == 0 ? values : rates)[of->coordinate];
    if (place)
      e.diagnostics.error("E0208", end.names[i]->span,
                          fmt::format("`{}` has two values at this end", e.texts.slice(end.names[i]->span)), "",
                          "Keep one of them.");
    place = v.scalar();
  }
  return good;
}

/// E0242 unless one comes before the other; nothing is said where a value is not known.
bool in_order(Elaboration& e, const Value& begin, const Value& end, Span span) {
  if (begin.poisoned || end.poisoned) return false;
  const auto from = constant_value(e, begin.scalar()), to = constant_value(e, end.scalar());
  if (!from || !to || *from < *to) return true;
  e.diagnostics.error("E0242", span, "the path ends before it begins",
                      fmt::format("A path goes from an earlier {} to a later one.", in_words(e, "time")),
                      "Exchange the two ends.");
  return false;
}

}  // namespace

void elaborate_path(Elaboration& e, const syntax::PathStatement& s, Span span) {
  if (e.experiment().path) return;  // given twice, which was told
  PathEnds out;
  out.span = span;
  const bool from = configuration(e, s.from, "the beginning of the path", out.from, out.from_rates);
  const bool to = configuration(e, s.to, "the end of the path", out.to, out.to_rates);
  const Value begin = constant_of(e, *s.from.at, e.time(), in_words(e, "the time of an end of a path"));
  const Value end = constant_of(e, *s.to.at, e.time(), in_words(e, "the time of an end of a path"));
  if (!in_order(e, begin, end, s.to.at->span) || !from || !to) return;
  out.start = begin.scalar();
  out.end = end.scalar();
  e.experiment().path = std::move(out);
}

// --------------------------------------------------------------------------------------------------- held integrals

void elaborate_integral_constraint(Elaboration& e, const syntax::ConstraintStatement& s, Span span) {
  const Value integrand = evaluate_formula(e, *s.left);
  if (integrand.is_vector && !integrand.poisoned) {
    e.diagnostics.error("E0210", s.left->span, "an integral constraint holds one number, not a vector", "",
                        "Write one for each component, with .x and .y.");
    return;
  }
  const Dimension expected = integrand.poisoned ? Dimension{} : integrand.dimension * e.time();
  const Value value = integrand.poisoned || integrand.fits_any
                          ? Value::poison()
                          : constant_of(e, *s.right, expected, "the integral of the left side");
  if (!integrand.poisoned && integrand.order < 0) {
    e.diagnostics.error("E0423", span, "this constraint contains no coordinate",
                        "Its integral is the same for every path.",
                        "Write an integrand of coordinates or their derivatives.");
    return;
  }
  if (integrand.poisoned || value.poisoned || refuse_acceleration(e, integrand, *s.left, "an integral constraint"))
    return;
  IntegralConstraint c;
  c.name = s.name ? s.name->text : "";
  c.integrand = integrand.scalar();
  c.value = value.scalar();
  c.dimension = expected;
  c.span = span;
  e.system().integral_constraints.push_back(std::move(c));
}

// ----------------------------------------------------------------------------------------------------- expectations

namespace {

bool states_path(const Elaboration& e) {
  if (e.overrides.path) return true;
  for (const syntax::Statement& s : e.tree.statements)
    if (std::get_if<syntax::PathStatement>(&s.body)) return true;
  return false;
}

bool refuse_without_path(Elaboration& e, Span span) {
  if (states_path(e)) return false;
  e.diagnostics.error("E0243", span, "the model does not say where its path begins and ends",
                      "An action is an integral between two ends, and a stationary path runs from one to the other.",
                      "Add them, for example `path from (0, 1) at 0 to (2, 3) at 1`.");
  return true;
}

/// What one coordinate is along a path; an empty handle after a mistake.
Expr along_path(Elaboration& e, const Coordinate& c, const syntax::Expression& formula) {
  const Value v = scalar_of(e, formula, c.dimension, fmt::format("`{}` along the path", c.name));
  if (v.poisoned) return {};
  if (v.order < 0) return v.scalar();
  const Span at = culprit_of_order(e, formula, 0);
  e.diagnostics.error("E0222", at.end > at.begin ? at : formula.span,
                      fmt::format("a path is a function of {}, not of coordinates", e.system().independent),
                      "It says what the coordinates are, each at its place of the list.", "");
  return {};
}

/// Between what a path that is given runs; `from` null: the ends of the model's path. False after a mistake.
bool given_ends(Elaboration& e, PathFormulas& out, const syntax::ExpressionPtr& from, const syntax::ExpressionPtr& to,
                Span path) {
  if (!from || !to) return !refuse_without_path(e, path);
  const Value begin = constant_of(e, *from, e.time(), in_words(e, "the time of an end of a path"));
  const Value end = constant_of(e, *to, e.time(), in_words(e, "the time of an end of a path"));
  if (!in_order(e, begin, end, to->span)) return false;
  out.from = begin.scalar();
  out.to = end.scalar();
  return true;
}

/// action of (x(t), y(t)) from a to b
std::optional<PathFormulas> given_path(Elaboration& e, const written::ActionAlong& x, Span line) {
  PathFormulas out;
  const Span whole = cover(x.q.front()->span, x.q.back()->span);
  bool good = check_count(e, x.q.size(), whole, "this path");
  for (std::size_t i = 0; i < x.q.size() && good; ++i) {
    out.q.push_back(along_path(e, e.system().coordinates[i], *x.q[i]));
    good = static_cast<bool>(out.q.back());
  }
  return given_ends(e, out, x.from, x.to, line) && good ? std::optional(std::move(out)) : std::nullopt;
}

/// The index of the coordinate that a path gives a value; nothing, and a message, if it is none or has one.
std::optional<std::size_t> coordinate_of_path(Elaboration& e, const syntax::Expression& x, const PathFormulas& path) {
  const auto& list = e.system().coordinates;
  std::optional<std::size_t> found = quaternion_component(e, x);
  for (std::size_t i = 0; i < list.size() && !found; ++i)
    if (x.kind == syntax::Expression::Kind::Name && list[i].name == x.text) found = i;
  if (found && x.primes == 0 && !path.q[*found]) return found;
  e.diagnostics.error("E0241", x.span,
                      found ? fmt::format("`{}` has its value along the path", list[*found].name)
                            : fmt::format("`{}` is no coordinate", e.texts.slice(x.span)),
                      fmt::format("A path gives every coordinate one value: {}.", names_of_coordinates(e.system())),
                      "");
  return std::nullopt;
}

bool check_complete(Elaboration& e, const PathFormulas& path, Span span) {
  for (std::size_t i = 0; i < path.q.size(); ++i) {
    if (path.q[i]) continue;
    e.diagnostics.error(
        "E0241", span, fmt::format("the path does not say what `{}` is", e.system().coordinates[i].name),
        fmt::format("A path gives every coordinate its value: {}.", names_of_coordinates(e.system())), "");
    return false;
  }
  return true;
}

}  // namespace

void override_given_path(Elaboration& e) {
  const std::vector<syntax::Assignment>& written = e.overrides.given_path;
  if (written.empty()) return;
  PathFormulas out;
  out.q.resize(e.system().coordinates.size());
  for (const syntax::Assignment& one : written) {
    const auto coordinate = coordinate_of_path(e, *one.variable, out);
    if (!coordinate) return;
    out.q[*coordinate] = along_path(e, e.system().coordinates[*coordinate], *one.value);
    if (!out.q[*coordinate]) return;
  }
  const Span whole = cover(written.front().variable->span, written.back().value->span);
  if (check_complete(e, out, whole) && given_ends(e, out, e.overrides.given_from, e.overrides.given_to, whole))
    e.experiment().given_path = std::move(out);
}

Expected meaning_of(Elaboration& e, const written::Action& x, Span line) {
  if (refuse_without_path(e, line)) return std::nullopt;
  const auto expected = expected_number(e, x.expected, e.system().lagrangian_dimension * e.time(), "the action");
  return expected ? Expected(expectation::Action{x.path, *expected}) : std::nullopt;
}

Expected meaning_of(Elaboration& e, const written::ActionAlong& x, Span line) {
  auto along = given_path(e, x, line);
  if (!along) return std::nullopt;
  const auto expected = expected_number(e, x.expected, e.system().lagrangian_dimension * e.time(), "the action");
  return expected ? Expected(expectation::ActionAlong{std::move(*along), *expected}) : std::nullopt;
}

Expected meaning_of(Elaboration& e, const written::MorseIndex& x, Span line) {
  const Value v = constant_of(e, *x.index, Dimension{}, "a Morse index");
  if (v.poisoned || refuse_without_path(e, line)) return std::nullopt;
  return expectation::MorseIndex{x.path, v.scalar()};
}

/// Whether all that is differentiated twice and more are coordinates whose q'' stands in L: a path knows these.
bool only_higher_accelerate(const Elaboration& e, Expr subject) {
  const Expr expanded = expand_time_derivatives(subject);
  const auto& list = e.model.system.coordinates;
  for (const Expr& symbol : symbols_of({&expanded, 1})) {
    if (symbol.role() != Role::Coordinate || symbol.order() < 2) continue;
    for (std::size_t i = 0; i < list.size(); ++i)
      if (list[i].name == symbol.name() && !e.higher.count(i)) return false;
  }
  return true;
}

Expected meaning_of(Elaboration& e, const written::PathAt& x, Span line) {
  const auto subject = number_of(e, *x.subject, Place{}, "an expectation");
  const Value at = constant_of(e, *x.time, e.time(), in_words(e, "the time of an expectation"));
  if (!subject || at.poisoned || refuse_without_path(e, line)) return std::nullopt;
  if (!only_higher_accelerate(e, subject->scalar()) &&
      refuse_acceleration(e, *subject, *x.subject, "what is expected of a path"))
    return std::nullopt;
  const Dimension dimension = subject->fits_any ? Dimension{} : subject->dimension;
  const auto expected = expected_number(e, x.expected, dimension, fmt::format("`{}`", e.texts.slice(x.subject->span)));
  if (!expected) return std::nullopt;
  return expectation::PathAt{x.path, subject->scalar(), at.scalar(), *expected};
}

}  // namespace maupertuis::elaboration
