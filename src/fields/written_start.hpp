#pragma once
#include <maupertuis/fields.hpp>
#include <maupertuis/repeated_evaluation.hpp>

namespace maupertuis {

/// What a model writes of the start of a field of one space variable, or of its rates; 0 where it writes nothing.
class WrittenStart {
 public:
  /// Order 0: the field, 1: its rate. `parameters` by their symbols, SI.
  WrittenStart(const FieldEquations& equations, std::size_t varied, int order, const Bindings& parameters);

  bool is_written() const { return is_written_; }
  Span span() const { return span_; }  // where it is written
  /// Its value (by_space = 0) or its slope (1) at x, SI; not finite where the formula is not.
  double at(double x, int by_space = 0) const;

 private:
  Expr x_;
  const Bindings& parameters_;
  bool is_written_ = false;
  Span span_;
  std::vector<RepeatedEvaluation> derivatives_;  // by x
};

}  // namespace maupertuis
