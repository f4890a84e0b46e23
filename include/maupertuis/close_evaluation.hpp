#pragma once
#include <maupertuis/expression.hpp>

#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace maupertuis {

/// Values of the same formulas at many points, with what rounding makes of them: 1 − cos θ at θ = 1e-7 has two digits
/// in double. The numbers that symbols are bound to count as exact. Precondition: no TimeDerivative nodes.
class CloseEvaluation {
 public:
  using ValueOf = std::function<double(Expr symbol)>;
  struct Values {
    std::vector<double> values;
    std::vector<double> errors;  // how far each may be off, to first order; NaN where nobody knows
  };

  explicit CloseEvaluation(std::span<const Expr> roots);
  ~CloseEvaluation();
  CloseEvaluation(CloseEvaluation&&) noexcept;
  CloseEvaluation& operator=(CloseEvaluation&&) noexcept;

  /// In double. Cost: some ten nanoseconds a node, two calls more for each function.
  Values in_double(const ValueOf& value_of) const;
  /// Right to four units in the last place: in double where that is enough, else with 100 digits, rounded once. Cost:
  /// then some microseconds a node.
  Values operator()(const ValueOf& value_of) const;

 private:
  struct Layout;
  std::unique_ptr<Layout> layout_;
};

}  // namespace maupertuis
