#include "equations/degenerate/lagrange_problem.hpp"
#include "linear_algebra/dense.hpp"

#include <maupertuis/degenerate.hpp>
#include <maupertuis/evaluate.hpp>
#include <maupertuis/transform.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <random>

namespace maupertuis {
namespace {

bool has_velocity(Expr e) {
  for (const Expr& s : symbols_of({&e, 1}))
    if (s.role() == Role::Coordinate && s.order() > 0) return true;
  return false;
}

/// What the new system holds as constraints: the gauges and what was found, without what follows from another one.
struct Held {
  std::string name;
  Expr value;
  Constraint::Level level;
  Span span;
};

std::vector<Held> held_relations(const MechanicalSystem& system, const DegenerateAnalysis& analysis,
                                 const ExprVector& gauge_values) {
  std::vector<Held> out;
  const auto add = [&](std::string name, Expr value, Span span) {
    using Level = Constraint::Level;
    out.push_back({std::move(name), value, has_velocity(value) ? Level::Velocity : Level::Position, span});
  };
  for (std::size_t k = 0; k < analysis.gauges; ++k)
    add("the gauge " + system.gauges[k].text, gauge_values[k], system.gauges[k].span);
  std::size_t number = 0;
  for (const FoundConstraint& c : analysis.chain.constraints) {
    ++number;
    if (!c.follows) add(fmt::format("constraint {} of L", number), c.value, {});
  }
  return out;
}

/// The row of A that a kernel makes of a relation: ∂φ/∂q or ∂ψ/∂q̇, and 0 for the multipliers.
LinearCondition row_of(const Held& held, const MechanicalSystem& system, std::size_t multipliers) {
  ExprVector symbols;
  for (const Coordinate& c : system.coordinates)
    symbols.push_back(held.level == Constraint::Level::Position ? c.q : c.velocity);
  LinearCondition row{gradient(held.value, symbols), held.value};
  row.coefficients.resize(symbols.size() + multipliers, held.value.context().number(0));
  return row;
}

/// Which relations are independent of those of the model, and which of Lagrange's rows determine what they leave.
struct Choice {
  std::vector<Held> held;
  std::vector<bool> keeps_row;  // [n]
};

/// Whether the last row is independent of those before it at each of the points where they are defined.
bool last_adds_at_all(const std::vector<LinearCondition>& rows, const std::vector<Bindings>& points) {
  return std::all_of(points.begin(), points.end(), [&](const Bindings& point) {
    const std::vector<std::size_t> independent = independent_conditions(rows, {point});
    return !independent.empty() && independent.back() + 1 == rows.size();
  });
}

/// The points, and the same with all velocities 0, where a row like that of v² + … vanishes: what it says is then left
/// to the motion, which keeps it.
std::vector<Bindings> with_rest(const std::vector<Bindings>& points) {
  std::vector<Bindings> out;
  for (Bindings point : points) {
    for (auto& [symbol, value] : point)
      if (symbol.role() == Role::Coordinate && symbol.order() == 1) value = 0;
    out.push_back(std::move(point));
  }
  return out;
}

/// Whether the determinant of the rows has one sign wherever it is looked at, on the constraints or beside them: where
/// it changes its sign there are states at which the rows do not determine what is sought.
bool keep_their_sign(const std::vector<LinearCondition>& rows, Bindings at) {
  ExprVector entries;
  for (const LinearCondition& row : rows)
    entries.insert(entries.end(), row.coefficients.begin(), row.coefficients.end());
  const auto size = static_cast<Eigen::Index>(rows.size());
  if (entries.size() != rows.size() * rows.size()) return false;
  std::mt19937_64 random(1744);
  constexpr int states = 64;
  int positive = 0, negative = 0;
  for (int state = 0; state < states; ++state) {
    for (auto& [symbol, value] : at)
      if (symbol.role() == Role::Coordinate) value = 4 * std::generate_canonical<double, 53>(random) - 2;
    const std::vector<double> numbers = evaluate(entries, at);
    const double found =
        Eigen::FullPivLU<Eigen::MatrixXd>(Eigen::Map<const Eigen::MatrixXd>(numbers.data(), size, size)).determinant();
    positive += found > 0, negative += found < 0;
  }
  return (positive == 0) != (negative == 0);
}

/// Relations that are held by rows of their own are met to rounding; so they come before Lagrange's rows, which keep
/// them too. Where that makes equations that are singular somewhere, and Lagrange's rows first do not, these are first.
Choice choose_rows(const EquationsOfMotion& equations, const DegenerateAnalysis& analysis, std::vector<Held> held) {
  const std::size_t n = equations.system->coordinates.size(), m = equations.multipliers.size();
  const auto& all = analysis.chain.conditions;
  const std::vector<LinearCondition> given(all.begin() + static_cast<std::ptrdiff_t>(n),
                                           all.begin() + static_cast<std::ptrdiff_t>(n + m));
  const std::vector<LinearCondition> lagrange(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(n));
  const PointsWhere& where = *analysis.chain.where;
  const auto& points = where.points();
  std::vector<LinearCondition> safe = given;  // then those of what is held
  std::vector<Held> kept;
  for (const Held& h : held) {
    std::vector<LinearCondition> with_it = safe;
    with_it.push_back(row_of(h, *equations.system, m));
    const bool everywhere =
        last_adds_at_all(with_zeros_of(where, with_it), points) && last_adds_at_all(with_it, with_rest(points));
    if (!everywhere && h.level == Constraint::Level::Velocity) continue;
    safe = std::move(with_it);
    kept.push_back(h);
  }

  struct Tried {
    Choice choice;
    bool keeps_sign = false, regular_at_start = false;
  };
  const auto chosen = [&](bool lagrange_first, bool by_size) {
    std::vector<LinearCondition> rows = lagrange_first ? given : safe;
    rows.insert(rows.end(), lagrange.begin(), lagrange.end());
    if (lagrange_first) rows.insert(rows.end(), safe.begin() + static_cast<std::ptrdiff_t>(m), safe.end());
    const std::size_t first_held = lagrange_first ? m + n : m, first_row = lagrange_first ? m : m + kept.size();
    Tried out;
    out.choice.keeps_row.assign(n, false);
    std::vector<LinearCondition> taken;
    for (const std::size_t r : by_size ? independent_by_size(rows, first_row, *analysis.start)
                                       : independent_conditions(with_zeros_of(where, rows), points)) {
      taken.push_back(rows[r]);
      if (r >= first_held && r < first_held + kept.size())
        out.choice.held.push_back(kept[r - first_held]);
      else if (r >= first_row && r < first_row + n)
        out.choice.keeps_row[r - first_row] = true;
    }
    Context& context = *equations.system->context;
    for (const std::size_t f : analysis.free) {
      taken.push_back({ExprVector(n + m, context.number(0)), context.number(0)});
      taken.back().coefficients[f] = context.number(1);
    }
    out.keeps_sign = keep_their_sign(taken, points.front());
    out.regular_at_start = !analysis.start || independent_conditions(taken, {*analysis.start}).size() == taken.size();
    return out;
  };
  Tried out = chosen(false, false);
  if (!out.regular_at_start)
    if (Tried better = chosen(false, true); better.regular_at_start) out = std::move(better);
  if (out.keeps_sign) return out.choice;
  Tried other = chosen(true, false);
  if (out.regular_at_start && !other.regular_at_start) return out.choice;
  return other.keeps_sign ? other.choice : out.choice;
}

Constraint as_constraint(const Held& held, std::size_t number, Context& context) {
  Constraint c;
  c.level = held.level;
  c.name = held.name;
  c.value = held.value;
  c.multiplier = context.symbol(fmt::format("rest {}", number), Role::Multiplier);
  c.reaction = context.symbol(fmt::format("reaction(rest {})", number), Role::Multiplier);
  c.span = held.span;
  c.forceless = true;
  return c;
}

void hold(EquationsOfMotion& out, MechanicalSystem& system, const Constraint& c) {
  Context& context = *system.context;
  const Expr rate = c.level == Constraint::Level::Position ? context.time_derivative(c.value) : c.value;
  out.multipliers.push_back(c.multiplier);
  out.constraint_rates.push_back(rate);
  out.constraint_accelerations.push_back(context.time_derivative(rate));
  system.constraints.push_back(c);
}

}  // namespace

std::optional<EquationsOfMotion> determined_equations(const EquationsOfMotion& equations,
                                                      const DegenerateAnalysis& analysis) {
  if (!analysis.closed()) return std::nullopt;
  const ConstraintProblem problem = lagrange_problem(equations, analysis.gauges > 0);
  const ExprVector gauge_values(problem.relations.end() - static_cast<std::ptrdiff_t>(analysis.gauges),
                                problem.relations.end());
  const Choice choice = choose_rows(equations, analysis, held_relations(*equations.system, analysis, gauge_values));
  EquationsOfMotion out = equations;
  out.written = nullptr;
  auto system = std::make_shared<MechanicalSystem>(*equations.system);
  Context& context = *system->context;
  const std::size_t n = system->coordinates.size();
  if (out.constraint_forces.empty()) out.constraint_forces.assign(n, context.number(0));

  std::vector<std::size_t> dropped;
  for (std::size_t i = 0; i < n; ++i)
    if (!choice.keeps_row[i]) dropped.push_back(i);
  // A free acceleration takes a row that is dropped, its own where that is one.
  for (const std::size_t f : analysis.free) {
    if (dropped.empty()) return std::nullopt;
    const auto own = std::find(dropped.begin(), dropped.end(), f);
    const std::size_t row = own == dropped.end() ? dropped.back() : f;
    dropped.erase(own == dropped.end() ? dropped.end() - 1 : own);
    out.residual[row] = system->coordinates[f].acceleration;
    out.constraint_forces[row] = context.number(0);
  }
  for (std::size_t k = 0; k < choice.held.size(); ++k) {
    const Constraint c = as_constraint(choice.held[k], k + 1, context);
    hold(out, *system, c);
    if (k >= dropped.size()) continue;
    out.residual[dropped[k]] = c.multiplier;
    out.constraint_forces[dropped[k]] = context.number(0);
  }
  system->written = nullptr;
  system->gauges.clear();
  out.system = std::move(system);
  return out;
}

const EquationsOfMotion& solvable_equations(const EquationsOfMotion& equations) {
  return equations.determined ? *equations.determined : equations;
}

bool has_free_functions(const EquationsOfMotion& equations) {
  return equations.degenerate && !equations.degenerate->free.empty();
}

bool refuse_free_functions(const EquationsOfMotion& equations, std::string_view who, Diagnostics& diagnostics) {
  if (!has_free_functions(equations)) return false;
  diagnostics.error("E0631", std::nullopt,
                    fmt::format("functions of this motion are free, and {} want one choice of them", who),
                    "The Lagrangian leaves them open; a run in double shows what does not depend on them.",
                    "`gauge EXPR = EXPR` makes a choice.");
  return true;
}

Model with_determined_system(const Model& model, const EquationsOfMotion& equations) {
  Model out = model;
  out.system = *equations.determined->system;
  return out;
}

}  // namespace maupertuis
