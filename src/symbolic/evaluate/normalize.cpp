#include "symbolic/evaluate/normalize.hpp"

#include <maupertuis/transform.hpp>

#include <array>
#include <unordered_map>

namespace maupertuis::evaluation {
namespace {

// Beyond this many terms an argument stays as it is: one basis element of its own.
constexpr std::size_t argument_budget = 64;

bool takes_flat_argument(Kind kind) {
  switch (kind) {
    case Kind::Sin: case Kind::Cos: case Kind::Tan: case Kind::Sinh: case Kind::Cosh: case Kind::Tanh: case Kind::Exp:
      return true;
    default: return false;
  }
}

/// A sum of numbers times monomials already, without a sum inside that could be multiplied out?
bool is_flat(Expr e, bool inside_sum = false) {
  switch (e.kind()) {
    case Kind::Sum:
      if (inside_sum) return false;
      for (std::size_t i = 0; i < e.size(); ++i)
        if (!is_flat(e[i], true)) return false;
      return true;
    case Kind::Product:
      for (std::size_t i = 0; i < e.size(); ++i)
        if (!is_flat(e[i], true)) return false;
      return true;
    // A sum below is multiplied out, or gives up its content where the exponent is not a positive integer.
    case Kind::Power: return !(e[0].is(Kind::Sum) && e[1].is_number());
    default: return true;
  }
}

Expr flat(Expr e) {
  if (is_flat(e)) return e;
  const Expr expanded = expand(e, argument_budget);
  return expanded ? expanded : e;
}

/// The factors of the argument of a logarithm stay apart, since log takes products apart; but each sum among them is
/// flat, so that its content does not depend on how it is nested: log(2 + (2 + x)) is log(4 + x).
Expr flat_factors(Expr e) {
  switch (e.kind()) {
    case Kind::Sum: return flat(e);
    case Kind::Power: return e.context().power(flat_factors(e[0]), e[1]);
    case Kind::Product: {
      std::vector<Expr> factors;
      for (std::size_t i = 0; i < e.size(); ++i) factors.push_back(flat_factors(e[i]));
      return e.context().product(factors);
    }
    default: return e;
  }
}

Expr with_arguments(Expr node, std::span<const Expr> arguments) {
  Context& context = node.context();
  switch (node.kind()) {
    case Kind::Sum: return context.sum(arguments);
    case Kind::Product: return context.product(arguments);
    case Kind::Power: return context.power(arguments[0], arguments[1]);
    case Kind::TimeDerivative: return context.time_derivative(arguments[0]);
    default: return context.function(node.kind(), arguments);
  }
}

}  // namespace

std::vector<Expr> flatten_arguments(std::span<const Expr> roots) {
  std::unordered_map<NodeId, Expr> changed;
  const auto current = [&](Expr e) {
    const auto found = changed.find(e.id());
    return found == changed.end() ? e : found->second;
  };
  std::vector<Expr> arguments;
  for (const Expr& node : topological_order(roots)) {
    if (node.size() == 0) continue;
    bool differs = false;
    arguments.clear();
    for (std::size_t i = 0; i < node.size(); ++i) {
      Expr argument = changed.empty() ? node[i] : current(node[i]);
      const bool has_logarithm = node.is(Kind::Log) || (node.is(Kind::Power) && !node[1].is_number());
      const bool is_exponent = node.is(Kind::Power) && i == 1 && !argument.is_number();
      if (has_logarithm && i == 0) argument = flat_factors(argument);
      else if (is_exponent || takes_flat_argument(node.kind())) argument = flat(argument);
      differs |= argument != node[i];
      arguments.push_back(argument);
    }
    if (differs) changed.emplace(node.id(), with_arguments(node, arguments));
  }
  std::vector<Expr> out;
  out.reserve(roots.size());
  for (const Expr& root : roots) out.push_back(current(root));
  return out;
}

}  // namespace maupertuis::evaluation
