#pragma once
#include "simulation/observables.hpp"

#include <maupertuis/close_evaluation.hpp>

#include <unordered_map>

/// What rounding makes of the formulas that a run tells the values of: 1 − cos θ at θ = 1e-7 has two digits in double.
namespace maupertuis {

/// Those of some formulas that are functions of given symbols and more than one of them alone.
class KnownFormulas {
 public:
  /// `symbols`: those of which numbers are given, in their order.
  KnownFormulas(const EquationsOfMotion& equations, std::span<const Expr> formulas, const ExprVector& symbols);

  const std::vector<std::size_t>& which() const { return which_; }
  /// [which] See CloseEvaluation.
  CloseEvaluation::Values closely(std::span<const double> numbers) const { return evaluation_(lookup(numbers)); }
  CloseEvaluation::Values in_double(std::span<const double> numbers) const {
    return evaluation_.in_double(lookup(numbers));
  }

 private:
  CloseEvaluation::ValueOf lookup(std::span<const double> numbers) const {
    return [this, numbers](Expr symbol) { return numbers[places_.at(symbol)]; };
  }

  std::unordered_map<Expr, std::size_t, ExprHash> places_;  // of symbols, among the numbers
  std::vector<std::size_t> which_;
  CloseEvaluation evaluation_;
};

/// Forces and probes of single states, evaluated with more digits where their terms cancel. Those that hold forces of
/// contacts stay what the kernel found.
class CloseObservables {
 public:
  CloseObservables(const EquationsOfMotion& equations, const Observables& observables);

  /// In place of the kernel's values. How far each observable may be off by rounding; 0 where nothing is known.
  /// `parameters`: those of the system; others may follow.
  std::vector<double> put_into(Sample& sample, std::span<const double> parameters) const;

 private:
  std::size_t freedoms_, multipliers_, parameters_, first_, count_;
  KnownFormulas formulas_;
};

/// Of the rows of a trajectory.
class RoundingOfRows {
 public:
  RoundingOfRows(const EquationsOfMotion& equations, const Observables& observables);

  /// How far the columns behind q and q̇ may be off by rounding; 0 where nothing is known. `row`: all columns.
  std::vector<double> errors(double t, std::span<const double> row) const;

 private:
  std::size_t freedoms_, count_;
  std::vector<double> parameters_;
  KnownFormulas formulas_;
};

}  // namespace maupertuis
