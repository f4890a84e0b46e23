#include <maupertuis/function_kernel.hpp>
#include <maupertuis/kinds.hpp>
#include <maupertuis/transform.hpp>

#include "kernel/function/program.hpp"

#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <stdexcept>
#include <tuple>
#include <unordered_map>
#include <utility>

namespace maupertuis {
namespace {

using Id = std::uint32_t;
using Op = FunctionOp;

/// What is computed from one or two operands and nothing else.
FunctionOp op_of(Kind kind) {
  static constexpr std::pair<Kind, Op> ops[] = {
      {Kind::Abs, Op::Abs}, {Kind::Sign, Op::Sign}, {Kind::Step, Op::Step}, {Kind::Atan2, Op::Atan2}, {Kind::Min, Op::Min},
      {Kind::Max, Op::Max}, {Kind::Less, Op::Less}, {Kind::LessEqual, Op::LessEqual}, {Kind::And, Op::And}, {Kind::Or, Op::Or}};
  for (const auto& [from, op] : ops)
    if (from == kind) return op;
  throw unknown_kind(kind, "a function kernel");
}

/// Value-numbered instructions in the order of their making; `finish` lays them out in slots.
class Builder {
 public:
  explicit Builder(const FunctionSource& source) : source_(source) {
    for (const Expr& e : source.inputs) of_.emplace(e, add_leaf({Leaf::Input, 0}));
    for (const Expr& e : source.parameters) of_.emplace(e, add_leaf({Leaf::Parameter, 0}));
  }

  FunctionProgram build() {
    for (const Expr& e : topological_order(source_.outputs))
      if (!of_.count(e)) of_.emplace(e, lower(e));
    return finish();
  }

 private:
  struct Leaf {
    enum Kind { Input, Parameter, Number, None } kind = None;
    double number = 0;
  };
  struct Value {
    Leaf leaf;
    FunctionInstruction instruction;
    bool changes = false;  // depends on an input
    bool needed = false;
  };

  Id add_leaf(Leaf leaf) {
    values_.push_back({leaf, {}, leaf.kind == Leaf::Input, false});
    return static_cast<Id>(values_.size() - 1);
  }

  Id number(double x) {
    const auto [found, made] = numbers_.try_emplace(x, 0);
    if (made) found->second = add_leaf({Leaf::Number, x});
    return found->second;
  }

  Id make(Op op, Id a, Id b = 0, Id c = 0, std::int32_t exponent = 0, Kind function = Kind::Exp) {
    const bool commutes = op == Op::Add || op == Op::Multiply;
    if (commutes && b < a) std::swap(a, b);
    const auto [found, made] = instructions_.try_emplace(std::tuple(op, function, exponent, a, b, c), 0);
    if (!made) return found->second;
    Value value{{}, {op, function, exponent, 0, a, b, c}, false, false};
    for_operands(value.instruction, [&](Id operand) { value.changes |= values_[operand].changes; });
    values_.push_back(value);
    return found->second = static_cast<Id>(values_.size() - 1);
  }

  template <class F>
  static void for_operands(const FunctionInstruction& i, F&& f) {
    f(i.a);
    if (i.op <= Op::Multiply || i.op == Op::Divide || i.op == Op::Power || i.op >= Op::Atan2) f(i.b);
    if (i.op == Op::Choose) f(i.c);
  }

  Id at(Expr e) const { return of_.at(e); }

  Id lower(Expr e) {
    switch (family_of(e.kind())) {
      case Family::Leaf: return leaf(e);
      case Family::Algebra:
        return e.is(Kind::Sum) ? lower_sum(e) : e.is(Kind::Product) ? lower_product(e) : lower_power(e[0], e[1]);
      case Family::Function: return make(Op::Function, at(e[0]), 0, 0, 0, e.kind());
      case Family::Switch: return make(op_of(e.kind()), at(e[0]));
      case Family::Angle: case Family::Extremum: case Family::Comparison: return make(op_of(e.kind()), at(e[0]), at(e[1]));
      case Family::Logic: return lower_chain(e);
      case Family::Piecewise: return lower_piecewise(e);
      case Family::TimeDerivative: break;
    }
    throw unknown_kind(e.kind(), "a function kernel");
  }

  Id leaf(Expr e) {
    if (e.is_number()) return number(e.number().to_double());
    if (e.is(Kind::Pi)) return number(std::numbers::pi);
    throw std::logic_error("a function kernel met the unlisted symbol `" + e.name() + "`; please report");
  }

  /// Terms with a negative coefficient are subtracted; the first positive one begins.
  Id lower_sum(Expr e) {
    std::vector<Id> plus, minus;
    for (std::size_t i = 0; i < e.size(); ++i) {
      const ScaledTerm term = split_coefficient(e[i]);
      const bool negated = term.coefficient == Rational(-1) && !e[i].is_number();
      if (!negated) plus.push_back(at(e[i]));
      else minus.push_back(of_.count(term.rest) ? at(term.rest) : of_.emplace(term.rest, lower(term.rest)).first->second);
    }
    Id sum = 0;
    std::size_t next = 0;
    if (plus.empty()) sum = make(Op::Negate, minus[next++]);
    else sum = plus.front();
    for (std::size_t i = 1; i < plus.size(); ++i) sum = make(Op::Add, sum, plus[i]);
    for (; next < minus.size(); ++next) sum = make(Op::Subtract, sum, minus[next]);
    return sum;
  }

  /// Factors with a negative exponent go below the fraction line.
  Id lower_product(Expr e) {
    std::vector<Id> above, below;
    bool negated = false;
    for (std::size_t i = 0; i < e.size(); ++i) {
      const Rational* value = e[i].number_or_null();
      const Rational* exponent = e[i].is(Kind::Power) ? e[i][1].number_or_null() : nullptr;
      if (value && *value == Rational(-1)) negated = true;
      else if (exponent && exponent->sign() < 0) below.push_back(power(e[i][0], -*exponent));
      else above.push_back(at(e[i]));
    }
    const Id top = above.empty() ? number(1) : multiply(above);
    const Id result = below.empty() ? top : make(Op::Divide, top, multiply(below));
    return negated ? make(Op::Negate, result) : result;
  }

  Id multiply(const std::vector<Id>& factors) {
    Id product = factors.front();
    for (std::size_t i = 1; i < factors.size(); ++i) product = make(Op::Multiply, product, factors[i]);
    return product;
  }

  Id lower_power(Expr base, Expr exponent) {
    const Rational* number_exponent = exponent.number_or_null();
    if (!number_exponent) return make(Op::Power, at(base), at(exponent));
    if (number_exponent->sign() < 0) return make(Op::Divide, number(1), power(base, -*number_exponent));
    return power(base, *number_exponent);
  }

  /// base^exponent for a positive number.
  Id power(Expr base, const Rational& exponent) {
    const auto twice = (exponent * Rational(2)).as_integer();
    if (!twice || *twice > 128) return make(Op::Power, at(base), number(exponent.to_double()));
    const Id root = *twice % 2 ? make(Op::Sqrt, at(base)) : 0;
    const auto whole = static_cast<std::int32_t>(*twice / 2);
    if (whole == 0) return root;
    const Id integer = whole == 1   ? at(base)
                       : whole == 2 ? make(Op::Square, at(base))
                                    : make(Op::PowerInteger, at(base), 0, 0, whole);
    return *twice % 2 ? make(Op::Multiply, integer, root) : integer;
  }

  Id lower_piecewise(Expr e) {
    Id result = at(e[e.size() - 1]);
    for (std::size_t i = e.size() - 1; i >= 2; i -= 2) result = make(Op::Choose, at(e[i - 1]), result, at(e[i - 2]));
    return result;
  }

  Id lower_chain(Expr e) {
    Id result = at(e[0]);
    for (std::size_t i = 1; i < e.size(); ++i) result = make(op_of(e.kind()), result, at(e[i]));
    return result;
  }

  FunctionProgram finish() {
    for (const Expr& e : source_.outputs) values_[at(e)].needed = true;
    for (std::size_t i = values_.size(); i-- > 0;)
      if (values_[i].needed && values_[i].leaf.kind == Leaf::None)
        for_operands(values_[i].instruction, [&](Id operand) { values_[operand].needed = true; });

    FunctionProgram program;
    program.inputs = source_.inputs.size();
    program.parameters = source_.parameters.size();
    std::vector<Id> slot(values_.size());
    Id next = 0;
    for (; next < program.inputs + program.parameters; ++next) slot[next] = next;
    for (Id i = 0; i < program.inputs; ++i) program.used.push_back(values_[i].needed);
    for (Id i = next; i < values_.size(); ++i)
      if (values_[i].leaf.kind == Leaf::Number) {
        slot[i] = next++;
        program.numbers.push_back(values_[i].leaf.number);
      }
    for (Id i = 0; i < values_.size(); ++i) {
      const Value& value = values_[i];
      if (value.leaf.kind != Leaf::None || !value.needed) continue;
      slot[i] = next++;
      FunctionInstruction placed = value.instruction;
      placed.out = slot[i];
      for (Id* operand : {&placed.a, &placed.b, &placed.c}) *operand = slot[*operand];
      (value.changes ? program.changing : program.fixed).push_back(placed);
    }
    program.slots = std::max<std::size_t>(next, 1);
    for (const Expr& e : source_.outputs) program.outputs.push_back(slot[at(e)]);
    return program;
  }

  const FunctionSource& source_;
  std::vector<Value> values_;
  std::unordered_map<Expr, Id, ExprHash> of_;
  std::map<double, Id> numbers_;
  std::map<std::tuple<Op, Kind, std::int32_t, Id, Id, Id>, Id> instructions_;
};

}  // namespace

FunctionKernel build_function(const FunctionSource& source) {
  return FunctionKernel(std::make_shared<const FunctionProgram>(Builder(source).build()));
}

DifferentiableKernel build_differentiable(const FunctionSource& source) {
  return build_differentiable(source, 0, source.inputs.size());
}

DifferentiableKernel build_differentiable(const FunctionSource& source, std::size_t first, std::size_t last) {
  const auto variables = std::span(source.inputs).subspan(first, last - first);
  DifferentiableKernel result;
  result.values = build_function(source);
  FunctionSource with_entries = source;
  for (std::size_t row = 0; row < source.outputs.size(); ++row) {
    const auto derivatives = gradient(source.outputs[row], variables);
    for (std::size_t column = 0; column < derivatives.size(); ++column) {
      if (derivatives[column].is_zero()) continue;
      result.entries.push_back({row, first + column});
      with_entries.outputs.push_back(derivatives[column]);
    }
  }
  result.values_and_entries = build_function(with_entries);
  return result;
}

}  // namespace maupertuis
