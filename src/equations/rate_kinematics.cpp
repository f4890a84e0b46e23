#include "equations/rate_kinematics.hpp"
#include "equations/simplified.hpp"
#include "linear_algebra/independent_rows.hpp"

#include <maupertuis/evaluate.hpp>
#include <maupertuis/integral_symbol.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace maupertuis {
namespace {

/// Beyond it nobody reads the equations, and the inverse of Y fills pages.
constexpr std::size_t most_coordinates = 40;

// -------------------------------------------------------------------------------------------------- the choice of σ

ExprVector velocity_symbols(const MechanicalSystem& system) {
  ExprVector out;
  for (const Coordinate& c : system.coordinates) out.push_back(c.velocity);
  return out;
}

/// Every symbol of the roots at a scattered value; parameters too, since what holds for one value alone is no rule.
Bindings scattered(std::span<const Expr> roots) {
  Bindings at;
  double next = 0.1;
  for (const Expr& s : symbols_of(roots)) {
    next = std::fmod(next + 0.6180339887498949, 1.0);
    at[s] = 0.3 + next;
  }
  return at;
}

bool is_linear(Expr value, const ExprVector& velocities) {
  for (const Expr& slope : gradient(value, velocities))
    for (const Expr& again : gradient(slope, velocities))
      if (!again.is_zero() && zero_test(again).verdict != Verdict::Zero) return false;
  return true;
}

/// Collects σ: independent constraints, then the named rates, then velocities that stay.
class Choice {
 public:
  Choice(const EquationsOfMotion& equations, const std::vector<Rate>& rates)
      : system_(*equations.system), velocities_(velocity_symbols(system_)) {
    constraints_ = expand_time_derivatives(equations.constraint_rates);
    ExprVector all = constraints_;
    for (const Rate& r : rates) all.push_back(r.value);
    for (Expr e : all)
      for (const Expr& slope : gradient(e, velocities_)) roots_.push_back(slope);
    for (const Coordinate& c : system_.coordinates) roots_.push_back(c.velocity);
    at_ = scattered(roots_);
    for (const Coordinate& c : system_.coordinates) at_.try_emplace(c.q, 0.5);
  }

  bool linear() const {
    return std::all_of(constraints_.begin(), constraints_.end(), [&](Expr e) { return is_linear(e, velocities_); });
  }

  RateKinematics make(const std::vector<Rate>& rates) {
    ExprVector held;
    for (const Expr& c : constraints_)
      if (add(c)) held.push_back(c);
    RateKinematics k;
    for (const Rate& r : rates)
      if (add(r.value)) take(k, r.symbol, r.value, false);
    for (const Coordinate* c : by_entanglement(rates))
      if (add(c->velocity)) take(k, c->velocity, c->velocity, true);
    k.free = k.sigma.size();
    for (std::size_t c = 0; c < held.size(); ++c)
      take(k, rate_of_integral(*system_.context, "σ_" + std::to_string(c + 1) + "∫"), held[c], false);
    return k;
  }

 private:
  bool add(Expr e) { return rows_.add(evaluate(gradient(e, velocities_), at_)); }
  static void take(RateKinematics& k, Expr sigma, Expr value, bool is_velocity) {
    k.sigma.push_back(sigma);
    k.values.push_back(value);
    k.is_velocity.push_back(is_velocity);
  }
  /// Velocities that stand in few rates and constraints first: they stay the better.
  std::vector<const Coordinate*> by_entanglement(const std::vector<Rate>& rates) const {
    std::map<NodeId, int> count;
    const auto look = [&](Expr e) {
      for (const Expr& s : symbols_of({&e, 1})) ++count[s.id()];
    };
    for (const Rate& r : rates) look(r.value);
    for (const Expr& c : constraints_) look(c);
    std::vector<const Coordinate*> out;
    for (const Coordinate& c : system_.coordinates) out.push_back(&c);
    std::stable_sort(out.begin(), out.end(), [&](const Coordinate* a, const Coordinate* b) {
      return count[a->velocity.id()] < count[b->velocity.id()];
    });
    return out;
  }

  const MechanicalSystem& system_;
  ExprVector velocities_, constraints_, roots_;
  Bindings at_;
  IndependentRows rows_;
};

// ----------------------------------------------------------------------------------------------------- solving for q̇

/// 0: a number; 1: parameters alone; 2: depends on the motion.
int kind_of_pivot(Expr e) {
  if (e.is_number()) return 0;
  for (const Expr& s : symbols_of({&e, 1}))
    if (s.role() != Role::Parameter && s.role() != Role::Constant && s.role() != Role::Auxiliary) return 2;
  return 1;
}

/// Σ_j coefficients_j q̇_j = right.
struct LinearRow {
  ExprVector coefficients;  // [n]
  Expr right;
};

/// Rows for the velocities, solved in formulas: single entries first, then groups of orthogonal rows by their
/// transpose, then constant pivots, at last Cramer's rule.
class VelocitySolver {
 public:
  VelocitySolver(std::vector<LinearRow> rows, const ReadingOrder& order, const UnitQuaternions& spheres)
      : rows_(std::move(rows)), order_(order), spheres_(spheres), solution_(rows_.size()) {
    for (LinearRow& row : rows_) tidy(row);
  }

  /// q̇ [n]; empty where some could not be solved for.
  ExprVector solve() {
    while (!rows_.empty())
      if (!eliminate(true) && !orthogonal_group() && !eliminate(false) && !cramer()) return {};
    for (auto k = eliminated_.rbegin(); k != eliminated_.rend(); ++k) {
      Expr value = k->row.right;
      for (std::size_t j = 0; j < k->row.coefficients.size(); ++j)
        if (j != k->column && !k->row.coefficients[j].is_zero()) value = value - k->row.coefficients[j] * solution_[j];
      solution_[k->column] = value / k->row.coefficients[k->column];
    }
    return solution_;
  }

 private:
  struct Eliminated {
    LinearRow row;
    std::size_t column = 0;
  };
  struct Group {
    std::vector<std::size_t> rows, columns;
  };

  void tidy(LinearRow& row) const {
    for (Expr& c : row.coefficients)
      if (!c.is_number()) c = spheres_.shortest(c, order_);
  }

  static std::size_t entries(const LinearRow& row) {
    return static_cast<std::size_t>(
        std::count_if(row.coefficients.begin(), row.coefficients.end(), [](const Expr& c) { return !c.is_zero(); }));
  }

  /// One row gives one velocity by the others; `alone`: by none.
  bool eliminate(bool alone) {
    std::size_t best = rows_.size(), column = 0;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const std::size_t count = entries(rows_[i]);
      if (count == 0 || (alone && count > 1) || (best < rows_.size() && entries(rows_[best]) <= count)) continue;
      for (std::size_t j = 0; j < rows_[i].coefficients.size(); ++j)
        if (const Expr& c = rows_[i].coefficients[j]; !c.is_zero() && (alone || kind_of_pivot(c) < 2)) {
          best = i, column = j;
          break;
        }
    }
    if (best == rows_.size()) return false;
    const LinearRow row = rows_[best];
    rows_.erase(rows_.begin() + static_cast<std::ptrdiff_t>(best));
    for (LinearRow& other : rows_) {
      if (other.coefficients[column].is_zero()) continue;
      const Expr ratio = other.coefficients[column] / row.coefficients[column];
      for (std::size_t j = 0; j < other.coefficients.size(); ++j)
        other.coefficients[j] =
            j == column ? ratio.context().number(0) : other.coefficients[j] - ratio * row.coefficients[j];
      other.right = other.right - ratio * row.right;
      tidy(other);
    }
    eliminated_.push_back({row, column});
    return true;
  }

  /// Rows that share columns, each group whole.
  std::vector<Group> groups() const {
    const std::size_t n = rows_.size(), columns = rows_.front().coefficients.size();
    std::vector<std::size_t> leader(n + columns);
    std::iota(leader.begin(), leader.end(), std::size_t{0});
    const auto find = [&](std::size_t i) {
      while (leader[i] != i) i = leader[i];
      return i;
    };
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < columns; ++j)
        if (!rows_[i].coefficients[j].is_zero()) leader[find(i)] = find(n + j);
    std::map<std::size_t, Group> found;
    for (std::size_t i = 0; i < n; ++i) found[find(i)].rows.push_back(i);
    for (std::size_t j = 0; j < columns; ++j)
      if (const auto group = found.find(find(n + j)); group != found.end()) group->second.columns.push_back(j);
    std::vector<Group> out;
    for (auto& [key, group] : found) out.push_back(std::move(group));
    return out;
  }

  Expr dot(std::size_t a, std::size_t b) const {
    ExprVector terms;
    for (std::size_t j = 0; j < rows_[a].coefficients.size(); ++j)
      terms.push_back(rows_[a].coefficients[j] * rows_[b].coefficients[j]);
    return rows_[a].right.context().sum(terms);
  }

  void drop(std::vector<std::size_t> rows) {
    std::sort(rows.rbegin(), rows.rend());
    for (const std::size_t i : rows) rows_.erase(rows_.begin() + static_cast<std::ptrdiff_t>(i));
  }

  /// q̇ = Yᵀ (Y Yᵀ)⁻¹ σ where Y Yᵀ is diagonal: components on turned axes, quaternions.
  bool orthogonal_group() {
    for (const Group& group : groups()) {
      if (group.rows.size() != group.columns.size() || group.rows.size() < 2) continue;
      if (!is_orthogonal(group)) continue;
      ExprVector scaled;
      for (const std::size_t i : group.rows) scaled.push_back(rows_[i].right / spheres_.shortest(dot(i, i), order_));
      for (const std::size_t j : group.columns) {
        ExprVector terms;
        for (std::size_t k = 0; k < group.rows.size(); ++k)
          terms.push_back(rows_[group.rows[k]].coefficients[j] * scaled[k]);
        solution_[j] = scaled.front().context().sum(terms);
      }
      drop(group.rows);
      return true;
    }
    return false;
  }

  bool is_orthogonal(const Group& group) const {
    for (std::size_t a = 0; a < group.rows.size(); ++a)
      for (std::size_t b = 0; b < a; ++b)
        if (const Expr product = dot(group.rows[a], group.rows[b]);
            !product.is_zero() && zero_test(product).verdict != Verdict::Zero)
          return false;
    return true;
  }

  bool cramer() {
    for (const Group& group : groups()) {
      constexpr std::size_t largest = 6;
      if (group.rows.size() != group.columns.size() || group.rows.size() > largest) continue;
      minors_.clear();
      const unsigned all = (1u << group.rows.size()) - 1;
      const Expr determinant = minor(group, all, all);
      if (!determinant || zero_test(determinant).verdict != Verdict::Nonzero) return false;
      for (std::size_t j = 0; j < group.columns.size(); ++j) {
        ExprVector terms;
        for (std::size_t i = 0; i < group.rows.size(); ++i) {
          const Expr cofactor = minor(group, all & ~(1u << i), all & ~(1u << j));
          if (!cofactor) return false;
          const Expr part = spheres_.shortest(cofactor / determinant, order_) * rows_[group.rows[i]].right;
          terms.push_back((i + j) % 2 ? -part : part);
        }
        solution_[group.columns[j]] = determinant.context().sum(terms);
      }
      drop(group.rows);
      return true;
    }
    return false;
  }

  /// The determinant of the rows and columns whose bits are set, in its best form; empty where it is long.
  Expr minor(const Group& group, unsigned rows, unsigned columns) {
    Context& context = rows_.front().right.context();
    if (rows == 0) return context.number(1);
    const auto [known, is_new] = minors_.try_emplace({rows, columns});
    if (!is_new) return known->second;
    std::size_t row = 0;
    while (!(rows >> row & 1)) ++row;
    ExprVector terms;
    bool negative = false;
    for (std::size_t column = 0; column < group.columns.size(); ++column) {
      if (!(columns >> column & 1)) continue;
      const Expr entry = rows_[group.rows[row]].coefficients[group.columns[column]];
      const Expr rest = entry.is_zero() ? entry : minor(group, rows & ~(1u << row), columns & ~(1u << column));
      if (!rest) return Expr();
      terms.push_back(negative ? -(entry * rest) : entry * rest);
      negative = !negative;
    }
    constexpr std::size_t most_terms = 200;
    const Expr whole = context.sum(terms);
    const Expr canonical = fourier_form(whole, most_terms);
    return minors_[{rows, columns}] = canonical ? spheres_.shortest(canonical, order_) : Expr();
  }

  std::vector<LinearRow> rows_;
  const ReadingOrder& order_;
  const UnitQuaternions& spheres_;
  ExprVector solution_;
  std::vector<Eliminated> eliminated_;
  std::map<std::pair<unsigned, unsigned>, Expr> minors_;
};

/// Y q̇ = σ − y
std::vector<LinearRow> rows_of(const RateKinematics& k, const ExprVector& velocities) {
  Context& context = k.sigma.front().context();
  ExprMap at_rest;
  for (const Expr& v : velocities) at_rest.emplace(v, context.number(0));
  std::vector<LinearRow> rows;
  for (std::size_t a = 0; a < k.sigma.size(); ++a) {
    // A rate in the place of a velocity that stays keeps its name: q' = q'.
    const ExprVector slopes = gradient(k.values[a], velocities);
    rows.push_back({substitute(slopes, at_rest), k.sigma[a] - substitute(k.values[a], at_rest)});
  }
  return rows;
}

}  // namespace

ExprMap RateKinematics::on_constraints() const {
  ExprMap zero;
  for (std::size_t a = free; a < sigma.size(); ++a) zero.emplace(sigma[a], sigma[a].context().number(0));
  return zero;
}

Expr RateKinematics::in_rates(const MechanicalSystem& system, Expr e) const {
  ExprMap whole, rest;
  for (std::size_t a = 0; a < sigma.size(); ++a)
    if (!values[a].is_symbol()) whole.emplace(values[a], sigma[a]);
  for (std::size_t i = 0; i < velocities.size(); ++i)
    if (velocities[i] != system.coordinates[i].velocity) rest.emplace(system.coordinates[i].velocity, velocities[i]);
  return substitute(substitute(e, whole), rest);
}

Expr RateKinematics::by_coefficients(Expr e, const ReadingOrder& order, const UnitQuaternions& spheres) const {
  const auto has_rate = [&](Expr x) {
    const std::vector<Expr> symbols = symbols_of({&x, 1});
    return std::any_of(sigma.begin(), sigma.end(),
                       [&](Expr s) { return std::find(symbols.begin(), symbols.end(), s) != symbols.end(); });
  };
  ExprMap at_rest;
  for (const Expr& s : sigma) at_rest.emplace(s, e.context().number(0));
  ExprVector terms{spheres.shortest(substitute(e, at_rest), order)};
  for (std::size_t a = 0; a < sigma.size(); ++a) {
    const Expr slope = differentiate(e, sigma[a]);
    if (slope.is_zero()) continue;
    terms.push_back(spheres.shortest(substitute(slope, at_rest), order) * sigma[a]);
    for (std::size_t b = 0; b <= a; ++b) {
      const Expr second = differentiate(slope, sigma[b]);
      if (has_rate(second)) return e;
      const Expr coefficient = spheres.shortest(second, order);
      terms.push_back((a == b ? Rational(1, 2) * coefficient : coefficient) * sigma[a] * sigma[b]);
    }
  }
  return e.context().sum(terms);
}

ReadingOrder order_with_rates(const EquationsOfMotion& equations, const std::vector<Rate>& rates) {
  ReadingOrder order = equations.order;
  order.places = nullptr;
  for (const Rate& r : rates)
    order.coordinates.push_back(equations.system->context->symbol(r.symbol.name(), Role::Coordinate));
  return order;
}

ExprMap RateKinematics::replacements(const MechanicalSystem& system) const {
  ExprMap replaced;
  const ExprVector held = substitute(velocities, on_constraints());
  for (std::size_t i = 0; i < held.size(); ++i) replaced.emplace(system.coordinates[i].velocity, held[i]);
  return replaced;
}

std::optional<RateKinematics> rate_kinematics(const EquationsOfMotion& equations, const std::vector<Rate>& rates,
                                              const ReadingOrder& order, const UnitQuaternions& spheres,
                                              std::string& reason) {
  const MechanicalSystem& system = *equations.system;
  const std::size_t n = system.coordinates.size();
  if (n > most_coordinates) {
    reason = "The velocities are too many to be solved for in formulas.";
    return std::nullopt;
  }
  Choice choice(equations, rates);
  if (!choice.linear()) {
    reason = "A constraint is not linear in the velocities, so that they are no linear functions of rates.";
    return std::nullopt;
  }
  RateKinematics k = choice.make(rates);
  const ExprVector velocities = velocity_symbols(system);
  ExprVector solved;
  if (k.sigma.size() == n) solved = VelocitySolver(rows_of(k, velocities), order, spheres).solve();
  if (solved.empty()) {
    reason = "The velocities cannot be solved for in formulas of a few lines.";
    return std::nullopt;
  }
  ExprMap at_rest;
  for (const Expr& s : k.sigma) at_rest.emplace(s, s.context().number(0));
  k.x = {n, n, {}};
  for (std::size_t i = 0; i < n; ++i) {
    ExprVector terms{spheres.shortest(substitute(solved[i], at_rest), order)};
    for (std::size_t a = 0; a < n; ++a) {
      k.x.entries.push_back(spheres.shortest(differentiate(solved[i], k.sigma[a]), order));
      terms.push_back(k.x.entries.back() * k.sigma[a]);
    }
    k.velocities.push_back(system.context->sum(terms));
  }
  return k;
}

}  // namespace maupertuis
