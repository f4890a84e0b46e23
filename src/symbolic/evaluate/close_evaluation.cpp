#include <maupertuis/close_evaluation.hpp>
#include <maupertuis/rounded_value.hpp>

#include "symbolic/evaluate/real_numbers.hpp"
#include "symbolic/evaluate/running_error.hpp"

#include <cmath>
#include <limits>

namespace maupertuis {

struct CloseEvaluation::Layout {
  evaluation::Tape tape;
};

CloseEvaluation::CloseEvaluation(std::span<const Expr> roots)
    : layout_(std::make_unique<Layout>(Layout{evaluation::Tape(roots)})) {}
CloseEvaluation::~CloseEvaluation() = default;
CloseEvaluation::CloseEvaluation(CloseEvaluation&&) noexcept = default;
CloseEvaluation& CloseEvaluation::operator=(CloseEvaluation&&) noexcept = default;

CloseEvaluation::Values CloseEvaluation::in_double(const ValueOf& value_of) const {
  using evaluation::RunningError;
  evaluation::RealNumbers<RunningError> numbers([&](Expr symbol) { return RunningError{value_of(symbol), 0}; });
  std::vector<RunningError> values;
  evaluation::run(layout_->tape, numbers, values);
  Values out;
  for (const evaluation::Position root : layout_->tape.roots()) {
    out.values.push_back(values[root].value);
    out.errors.push_back(values[root].error);
  }
  return out;
}

CloseEvaluation::Values CloseEvaluation::operator()(const ValueOf& value_of) const {
  constexpr double enough = 4 * std::numeric_limits<double>::epsilon();
  Values out = in_double(value_of);
  std::vector<Expr> unsure;
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < out.values.size(); ++i) {
    if (out.errors[i] <= enough * std::abs(out.values[i])) continue;
    unsure.push_back(layout_->tape.expression(layout_->tape.roots()[i]));
    places.push_back(i);
  }
  if (unsure.empty()) return out;
  const std::vector<double> found = rounded_values(unsure, value_of);
  for (std::size_t k = 0; k < places.size(); ++k) {
    out.values[places[k]] = found[k];
    out.errors[places[k]] = evaluation::unit_roundoff * std::abs(found[k]);
  }
  return out;
}

}  // namespace maupertuis
