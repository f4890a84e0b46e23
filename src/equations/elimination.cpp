#include <maupertuis/equations_of_motion.hpp>
#include <maupertuis/evaluate.hpp>
#include <maupertuis/print.hpp>

#include "equations/multiplier_forces.hpp"
#include "equations/simplified.hpp"

#include <algorithm>

namespace maupertuis {
namespace {

constexpr std::size_t longest_row = 400;  // characters: beyond it elimination hides more than it shows

/// 0: a number; 1: parameters alone; 2: depends on the motion.
int pivot_class(Expr e) {
  if (e.is_number()) return 0;
  for (const Expr& s : symbols_of({&e, 1}))
    if (s.role() != Role::Parameter && s.role() != Role::Constant && s.role() != Role::Auxiliary) return 2;
  return 1;
}

/// A, or the forces of the multipliers, brought to a form in which every row has a pivot column of its own, without
/// fractions.
class RowReduction {
 public:
  RowReduction(ExprMatrix a, ExprVector b, const ReadingOrder& order)
      : order_(order), a_(std::move(a)), b_(std::move(b)) {
    for (std::size_t row = 0; row < a_.rows; ++row) tidy(row);
  }

  /// In these pivot columns, or else in the best. False: the rank is less than the number of rows, as far as can be
  /// seen.
  bool reduce(const std::vector<std::size_t>& columns = {}) {
    for (std::size_t row = 0; row < a_.rows; ++row) {
      const auto column = columns.empty() ? best_pivot(row) : std::optional(columns[row]);
      if (!column || a_.at(row, *column).is_zero()) return false;
      pivots_.push_back(*column);
      for (std::size_t other = 0; other < a_.rows; ++other)
        if (other != row && !a_.at(other, *column).is_zero()) clear(other, row, *column);
    }
    return true;
  }

  const ExprMatrix& matrix() const { return a_; }
  const std::vector<std::size_t>& pivots() const { return pivots_; }
  Expr pivot(std::size_t row) const { return a_.at(row, pivots_[row]); }
  Expr bias(std::size_t row) const { return b_[row]; }
  bool is_dependent(std::size_t column) const {
    return std::find(pivots_.begin(), pivots_.end(), column) != pivots_.end();
  }
  bool constant_pivots() const {
    for (std::size_t row = 0; row < a_.rows; ++row)
      if (pivot_class(pivot(row)) == 2) return false;
    return true;
  }

 private:
  /// Entries in their best form, common denominators and a numeric factor of the whole row taken out: zeros become
  /// visible.
  void tidy(std::size_t row) {
    for (std::size_t j = 0; j < a_.columns; ++j) a_.at(row, j) = simplified(a_.at(row, j), order_);
    for (const Expr& factor : common_denominators(row)) {
      for (std::size_t j = 0; j < a_.columns; ++j) a_.at(row, j) = a_.at(row, j) / factor;
      b_[row] = b_[row] / factor;
    }
    take_out_number(row);
  }

  /// Factors u^(-k) that stand in every entry of the row.
  ExprVector common_denominators(std::size_t row) const {
    const auto factors_of = [](Expr e) {
      ExprVector factors;
      if (!e.is(Kind::Product)) return ExprVector{e};
      for (std::size_t i = 0; i < e.size(); ++i) factors.push_back(e[i]);
      return factors;
    };
    std::optional<ExprVector> common;
    for (std::size_t j = 0; j < a_.columns; ++j) {
      if (a_.at(row, j).is_zero()) continue;
      const ExprVector here = factors_of(a_.at(row, j));
      if (!common) common = here;
      std::erase_if(*common, [&](Expr f) {
        return split_power(f).exponent.sign() > 0 || std::find(here.begin(), here.end(), f) == here.end();
      });
    }
    return common.value_or(ExprVector{});
  }

  void take_out_number(std::size_t row) {
    std::optional<Rational> factor;
    bool common = true;
    for (std::size_t j = 0; j < a_.columns; ++j) {
      const Expr entry = a_.at(row, j);
      if (entry.is_zero()) continue;
      Rational size = split_coefficient(entry).coefficient;
      if (size.sign() < 0) size = Rational(0) - size;
      if (factor && !(*factor == size)) common = false;
      factor = size;
    }
    if (!factor || !common) return;
    for (std::size_t j = 0; j < a_.columns; ++j) a_.at(row, j) = a_.at(row, j) / *factor;
    b_[row] = b_[row] / *factor;
  }

  std::optional<std::size_t> best_pivot(std::size_t row) const {
    std::optional<std::size_t> best;
    for (std::size_t j = 0; j < a_.columns; ++j) {
      if (a_.at(row, j).is_zero() || is_dependent(j)) continue;
      if (!best || pivot_class(a_.at(row, j)) < pivot_class(a_.at(row, *best))) best = j;
    }
    return best;
  }

  void clear(std::size_t row, std::size_t by, std::size_t column) {
    const Expr p = a_.at(by, column), f = a_.at(row, column);
    const Expr ratio = pivot_class(p) == 0 ? f / p : Expr();  // a number needs no common denominator
    const auto combined = [&](Expr own, Expr other) { return ratio ? own - ratio * other : p * own - f * other; };
    for (std::size_t j = 0; j < a_.columns; ++j) a_.at(row, j) = combined(a_.at(row, j), a_.at(by, j));
    b_[row] = combined(b_[row], b_[by]);
    tidy(row);
  }

  const ReadingOrder& order_;
  ExprMatrix a_;
  ExprVector b_;
  std::vector<std::size_t> pivots_;
};

/// A denominator in it changes with the motion, or is a sum, as friction makes it of sines and cosines.
bool has_awkward_denominator(Expr e, bool of_friction) {
  for (const Expr& node : topological_order({&e, 1}))
    if (node.is(Kind::Power) && node[1].is_number() && node[1].number().sign() < 0 &&
        (pivot_class(node[0]) == 2 || (of_friction && node[0].is(Kind::Sum))))
      return true;
  return false;
}

/// (a − b)/(b − a) is −1.
Expr ratio_of(Expr a, Expr b, const ReadingOrder& order) {
  const bool are_sums = a.is(Kind::Sum) && b.is(Kind::Sum);
  if (are_sums && zero_test(a + b).verdict == Verdict::Zero) return a.context().number(-1);
  if (are_sums && zero_test(a - b).verdict == Verdict::Zero) return a.context().number(1);
  return simplified(a / b, order);
}

/// A vector that the rows do not see, with the component `column` of the independent coordinates alone, its
/// denominators multiplied away.
ExprVector kernel_vector(const RowReduction& reduction, std::size_t column, const EquationsOfMotion& equations,
                         bool of_friction) {
  const ExprMatrix& a = reduction.matrix();
  Context& context = *equations.system->context;
  Expr scale = context.number(1);
  ExprVector ratios;  // empty: as a fraction of the pivot, which is a factor of the scale
  for (std::size_t row = 0; row < a.rows; ++row) {
    const Expr ratio = ratio_of(a.at(row, column), reduction.pivot(row), equations.order);
    ratios.push_back(has_awkward_denominator(ratio, of_friction) ? Expr() : ratio);
    if (!ratios[row]) scale = scale * reduction.pivot(row);
  }
  ExprVector z(a.columns, context.number(0));
  z[column] = scale;
  for (std::size_t row = 0; row < a.rows; ++row)
    z[reduction.pivots()[row]] =
        -(ratios[row] ? scale * ratios[row] : scale / reduction.pivot(row) * a.at(row, column));
  return z;
}

/// The dependent accelerations from A q̈ = b.
ExprMap dependent_accelerations(const RowReduction& reduction, const MechanicalSystem& system) {
  ExprMap replaced;
  const ExprMatrix& a = reduction.matrix();
  for (std::size_t row = 0; row < a.rows; ++row) {
    ExprVector terms{reduction.bias(row)};
    for (std::size_t j = 0; j < a.columns; ++j)
      if (!reduction.is_dependent(j)) terms.push_back(-(a.at(row, j) * system.coordinates[j].acceleration));
    replaced.emplace(system.coordinates[reduction.pivots()[row]].acceleration,
                     system.context->sum(terms) / reduction.pivot(row));
  }
  return replaced;
}

}  // namespace

std::optional<EliminatedEquations> eliminate_multipliers(const EquationsOfMotion& equations) {
  const MechanicalSystem& system = *equations.system;
  Context& context = *system.context;
  RowReduction reduction(constraint_matrix(equations), constraint_bias(equations), equations.order);
  const auto of_multipliers = multiplier_forces(equations);
  if (!of_multipliers || !reduction.reduce()) return std::nullopt;
  RowReduction forces(of_multipliers->rows, ExprVector(system.constraints.size(), context.number(0)), equations.order);
  if (!forces.reduce(reduction.pivots())) return std::nullopt;
  EliminatedEquations result;
  result.dependent = reduction.pivots();
  result.dependent_replaced = reduction.constant_pivots();
  const ExprVector balance = expand_time_derivatives(equations.balance());
  const ExprMap replaced = result.dependent_replaced ? dependent_accelerations(reduction, system) : ExprMap{};
  for (std::size_t j = 0; j < system.coordinates.size(); ++j) {
    if (reduction.is_dependent(j)) continue;
    const ExprVector z = kernel_vector(forces, j, equations, of_multipliers->of_friction);
    ExprVector of_residual, of_balance;
    for (std::size_t i = 0; i < z.size(); ++i) {
      of_residual.push_back(z[i] * of_multipliers->residual[i]);
      of_balance.push_back(z[i] * balance[i]);
    }
    const ExprVector row{substitute(context.sum(of_residual), replaced)};
    ReadableForm form = readable_equations(row, equations.order).front();
    form.own = system.coordinates[j].q;
    if (!form.intermediates.empty() || to_plain(form, equations.order).size() > longest_row) return std::nullopt;
    // The multipliers cancel: the row is a combination of the equations with all that is made of λ.
    if (zero_test(form.value - substitute(context.sum(of_balance), replaced)).verdict != Verdict::Zero)
      return std::nullopt;
    result.independent.push_back(j);
    result.rows.push_back(std::move(form));
  }
  return result;
}

}  // namespace maupertuis
