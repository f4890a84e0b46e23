#include <maupertuis/function_kernel.hpp>
#include <maupertuis/jacobian.hpp>
#include <maupertuis/kinds.hpp>
#include <maupertuis/transform.hpp>

#include "kernel/function/program.hpp"
#include "kernel/straight_line/builder.hpp"

#include <map>
#include <numbers>
#include <stdexcept>
#include <unordered_map>
#include <utility>

namespace maupertuis {
namespace {

using straight::none;
using straight::Term;
using straight::Value;

/// Writes each expression once, after its operands.
class FunctionWriter {
 public:
  explicit FunctionWriter(const FunctionSource& source) : source_(source) {
    for (std::uint32_t i = 0; i < source.inputs.size(); ++i) of_.emplace(source.inputs[i], to_.given(InputArray, i));
    for (std::uint32_t i = 0; i < source.parameters.size(); ++i)
      of_.emplace(source.parameters[i], to_.given(ParameterArray, i));
  }

  FunctionProgram run() {
    for (const Expr& e : topological_order(source_.outputs))
      if (!of_.count(e)) of_.emplace(e, write(e));
    for (std::uint32_t i = 0; i < source_.outputs.size(); ++i) to_.store(at(source_.outputs[i]), ValueArray, i);
    FunctionProgram out;
    out.line = to_.finish(function_arrays, 1, 0);
    out.evaluation = straight::Evaluation(out.line, seldom_arrays);
    out.inputs = source_.inputs.size(), out.parameters = source_.parameters.size();
    find_changes(out);
    return out;
  }

 private:
  Value at(Expr e) const { return of_.at(e); }

  Value write(Expr e) {
    switch (family_of(e.kind())) {
      case Family::Leaf:
        return leaf(e);
      case Family::Algebra:
        return e.is(Kind::Sum) ? sum(e) : e.is(Kind::Product) ? product(e) : power(e[0], e[1]);
      case Family::Function:
      case Family::Switch:
        return to_.call(e.kind(), at(e[0]));
      case Family::Angle:
      case Family::Extremum:
      case Family::Comparison:
        return to_.call(e.kind(), at(e[0]), at(e[1]));
      case Family::Logic:
        return chain(e);
      case Family::Piecewise:
        return piecewise(e);
      case Family::TimeDerivative:
        break;
    }
    throw unknown_kind(e.kind(), "a function kernel");
  }

  Value leaf(Expr e) {
    if (e.is_number()) return to_.literal(e.number().to_double());
    if (e.is(Kind::Pi)) return to_.literal(std::numbers::pi);
    throw std::logic_error("a function kernel met the unlisted symbol `" + e.name() + "`; please report");
  }

  Value sum(Expr e) {
    std::vector<Term> terms;
    for (std::size_t i = 0; i < e.size(); ++i) terms.push_back(term(e[i]));
    return to_.sum(std::move(terms));
  }

  static const Rational* negative_exponent(Expr e) {
    const Rational* const exponent = e.is(Kind::Power) ? e[1].number_or_null() : nullptr;
    return exponent && exponent->sign() < 0 ? exponent : nullptr;
  }

  /// Of a sum: up to three factors beside a number are written in it.
  Term term(Expr e) {
    if (!e.is(Kind::Product)) return {1, at(e)};
    Term out;
    std::vector<Value> factors;
    for (std::size_t i = 0; i < e.size(); ++i) {
      if (negative_exponent(e[i])) return {1, at(e)};
      if (const Rational* const value = e[i].number_or_null())
        out.factor *= value->to_double();
      else
        factors.push_back(at(e[i]));
    }
    if (factors.size() > 3) return {1, at(e)};
    factors.resize(3, none);
    return {out.factor, factors[0], factors[1], factors[2]};
  }

  /// Factors with a negative exponent go below the fraction line.
  Value product(Expr e) {
    std::vector<Value> above, below;
    for (std::size_t i = 0; i < e.size(); ++i) {
      if (const Rational* const exponent = negative_exponent(e[i]))
        below.push_back(power(e[i][0], -*exponent));
      else
        above.push_back(at(e[i]));
    }
    return multiply(above, below.empty() ? none : multiply(below));
  }

  /// Three at a time.
  Value multiply(std::vector<Value> factors, Value over = none) {
    while (factors.size() > 3) {
      const Value three = to_.sum({{1, factors[0], factors[1], factors[2]}});
      factors.erase(factors.begin(), factors.begin() + 3);
      factors.insert(factors.begin(), three);
    }
    factors.resize(3, none);
    return to_.sum({{1, factors[0], factors[1], factors[2]}}, none, over);
  }

  Value power(Expr base, Expr exponent) {
    const Rational* const number = exponent.number_or_null();
    if (!number) return to_.call(Kind::Power, at(base), at(exponent));
    return number->sign() < 0 ? to_.reciprocal(power(base, -*number)) : power(base, *number);
  }

  /// For a positive number.
  Value power(Expr base, const Rational& exponent) {
    const auto twice = (exponent * Rational(2)).as_integer();
    if (!twice || *twice > 128) return to_.call(Kind::Power, at(base), to_.literal(exponent.to_double()));
    std::vector<Value> factors;
    if (*twice >= 2) factors.push_back(whole_power(at(base), static_cast<std::uint32_t>(*twice / 2)));
    if (*twice % 2 != 0) factors.push_back(once(at(base), 0, [&] { return to_.root(at(base)); }));
    return multiply(factors);
  }

  Value whole_power(Value base, std::uint32_t exponent) {
    if (exponent == 1) return base;
    return once(base, exponent, [&] {
      const Value half = whole_power(base, exponent / 2);
      return exponent % 2 == 0 ? to_.product(1, half, half) : to_.sum({{1, base, half, half}});
    });
  }

  /// Powers by their exponent, roots as 0.
  template <class F>
  Value once(Value base, std::uint32_t exponent, F&& make) {
    if (const auto found = powers_.find({base, exponent}); found != powers_.end()) return found->second;
    return powers_[{base, exponent}] = make();
  }

  Value piecewise(Expr e) {
    Value result = at(e[e.size() - 1]);
    for (std::size_t i = e.size() - 1; i >= 2; i -= 2) result = to_.choose(at(e[i - 2]), at(e[i - 1]), result);
    return result;
  }

  Value chain(Expr e) {
    Value result = at(e[0]);
    for (std::size_t i = 1; i < e.size(); ++i) result = to_.call(e.kind(), result, at(e[i]));
    return result;
  }

  static void find_changes(FunctionProgram& program) {
    std::vector<bool> changes(program.line.nodes.size(), false);
    program.used.assign(program.inputs, false);
    for (Value v = 0; v < changes.size(); ++v) {
      const straight::Node& node = program.line.nodes[v];
      const bool is_input = node.what == straight::Node::Given && node.array == InputArray;
      if (is_input) program.used[node.index] = true;
      changes[v] = is_input;
      straight::for_operands(program.line, node, [&](Value w) { changes[v] = changes[v] || changes[w]; });
      program.size += changes[v] && !is_input;
    }
  }

  const FunctionSource& source_;
  straight::Builder to_;
  std::unordered_map<Expr, Value, ExprHash> of_;
  std::map<std::pair<Value, std::uint32_t>, Value> powers_;
};

}  // namespace

FunctionKernel build_function(const FunctionSource& source) {
  return FunctionKernel(std::make_shared<const FunctionProgram>(FunctionWriter(source).run()));
}

DifferentiableKernel build_differentiable(const FunctionSource& source) {
  return build_differentiable(source, 0, source.inputs.size());
}

DifferentiableKernel build_differentiable(const FunctionSource& source, std::size_t first, std::size_t last) {
  const auto variables = std::span(source.inputs).subspan(first, last - first);
  DifferentiableKernel result;
  result.values = build_function(source);
  FunctionSource with_entries = source;
  for (const DerivativeEntry& derivative : jacobian(source.outputs, variables)) {
    result.entries.push_back({derivative.row, first + derivative.column});
    with_entries.outputs.push_back(derivative.value);
  }
  result.values_and_entries = build_function(with_entries);
  return result;
}

}  // namespace maupertuis
