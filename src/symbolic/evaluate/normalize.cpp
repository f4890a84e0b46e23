#include "symbolic/evaluate/normalize.hpp"

#include <maupertuis/transform.hpp>

#include <array>
#include <unordered_map>
#include <unordered_set>

namespace maupertuis::evaluation {
namespace {

// Beyond this many terms an argument stays as it is: one basis element of its own.
constexpr std::size_t argument_budget = 64;

/// The image of such a function over a prime field depends on the terms of its argument, not on their sum alone.
bool takes_flat_argument(Kind kind) {
  return kind == Kind::Exp || kind == Kind::Sin || kind == Kind::Cos || kind == Kind::Tan || kind == Kind::Sinh ||
         kind == Kind::Cosh || kind == Kind::Tanh;
}

/// A sum of numbers times monomials already, without a sum inside that could be multiplied out?
bool is_flat(Expr e, bool inside_sum = false) {
  // A sum below is multiplied out, or gives up its content where the exponent is not a positive integer.
  if (e.is(Kind::Power)) return !(e[0].is(Kind::Sum) && e[1].is_number());
  if (!e.is(Kind::Sum) && !e.is(Kind::Product)) return true;
  if (e.is(Kind::Sum) && inside_sum) return false;
  for (std::size_t i = 0; i < e.size(); ++i)
    if (!is_flat(e[i], true)) return false;
  return true;
}

bool is_sine(Expr e) { return e.is(Kind::Sin) || e.is(Kind::Cos); }

/// A product of sines and cosines, or a power of one, somewhere in it: sin x cos x, cos² x.
bool multiplies_sines(Expr e, std::unordered_set<NodeId>& seen) {
  if (!seen.insert(e.id()).second) return false;
  if (e.is(Kind::Power)) return is_sine(e[0]);
  std::size_t sines = 0;
  for (std::size_t i = 0; i < e.size(); ++i) {
    if (multiplies_sines(e[i], seen)) return true;
    sines += is_sine(e[i]);
  }
  return e.is(Kind::Product) && sines > 1;
}

/// A sum of numbers times basis elements. Of products of sines and cosines sums are made, so that sin x cos x and
/// ½ sin 2x are one: as two basis elements each would have an image of its own.
Expr flat(Expr e) {
  Expr expanded = is_flat(e) ? e : expand(e, argument_budget);
  if (!expanded) return e;
  std::unordered_set<NodeId> seen;  // of nested sums the same one may stand at very many places
  if (multiplies_sines(expanded, seen))
    if (const Expr sums = fourier_form(expanded, argument_budget)) return sums;
  return expanded;
}

/// The factors of the argument of a logarithm stay apart, since log takes products apart; but each sum among them is
/// flat, so that its content does not depend on how it is nested: log(2 + (2 + x)) is log(4 + x).
Expr flat_factors(Expr e) {
  if (e.is(Kind::Sum)) return flat(e);
  if (e.is(Kind::Power)) return e.context().power(flat_factors(e[0]), e[1]);
  if (!e.is(Kind::Product)) return e;
  std::vector<Expr> factors;
  for (std::size_t i = 0; i < e.size(); ++i) factors.push_back(flat_factors(e[i]));
  return e.context().product(factors);
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
      if (has_logarithm && i == 0)
        argument = flat_factors(argument);
      else if (is_exponent || takes_flat_argument(node.kind()))
        argument = flat(argument);
      differs |= argument != node[i];
      arguments.push_back(argument);
    }
    if (differs) changed.emplace(node.id(), node.context().make(node.kind(), arguments));
  }
  std::vector<Expr> out;
  out.reserve(roots.size());
  for (const Expr& root : roots) out.push_back(current(root));
  return out;
}

}  // namespace maupertuis::evaluation
