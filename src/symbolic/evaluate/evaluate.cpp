#include <maupertuis/evaluate.hpp>
#include <maupertuis/repeated_evaluation.hpp>
#include <maupertuis/require.hpp>

#include "symbolic/evaluate/real_numbers.hpp"

namespace maupertuis {

namespace {

std::vector<double> values_of_roots(const evaluation::Tape& tape, const std::function<double(Expr)>& value_of) {
  evaluation::RealNumbers<double> numbers(value_of);
  std::vector<double> values;
  evaluation::run(tape, numbers, values);
  std::vector<double> out;
  out.reserve(tape.roots().size());
  for (const evaluation::Position root : tape.roots()) out.push_back(values[root]);
  return out;
}

}  // namespace

std::vector<double> evaluate(std::span<const Expr> roots, const Bindings& bindings) {
  return values_of_roots(evaluation::Tape(roots), [&](Expr symbol) {
    const auto found = bindings.find(symbol);
    MAUP_REQUIRE(found != bindings.end() && "every symbol must be bound");
    return found->second;
  });
}

struct RepeatedEvaluation::Layout {
  evaluation::Tape tape;
};

RepeatedEvaluation::RepeatedEvaluation(std::span<const Expr> roots)
    : layout_(std::make_unique<Layout>(Layout{evaluation::Tape(roots)})) {}
RepeatedEvaluation::~RepeatedEvaluation() = default;
RepeatedEvaluation::RepeatedEvaluation(RepeatedEvaluation&&) noexcept = default;

std::vector<double> RepeatedEvaluation::operator()(const std::function<double(Expr)>& value_of) const {
  return values_of_roots(layout_->tape, value_of);
}

double evaluate(Expr e, const Bindings& bindings) { return evaluate({&e, 1}, bindings).front(); }

}  // namespace maupertuis
