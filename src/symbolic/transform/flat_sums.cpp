#include <maupertuis/transform.hpp>

#include "symbolic/transform/rebuild.hpp"

namespace maupertuis {
namespace {

/// The sum with the terms of inner sums among its own.
Expr with_inner_terms(Expr sum) {
  std::vector<Expr> terms;
  for (std::size_t i = 0; i < sum.size(); ++i) {
    const ScaledTerm term = split_coefficient(sum[i]);
    if (term.rest.is(Kind::Sum))
      for (std::size_t k = 0; k < term.rest.size(); ++k) terms.push_back(term.coefficient * term.rest[k]);
    else
      terms.push_back(sum[i]);
  }
  return sum.context().sum(terms);
}

}  // namespace

Expr with_flat_sums(Expr e) {
  ExprMap flat;
  for (const Expr& node : topological_order({&e, 1})) {
    const Expr made = rebuild(node, [&](Expr argument) { return flat.at(argument); });
    flat.emplace(node, made.is(Kind::Sum) ? with_inner_terms(made) : made);
  }
  return flat.at(e);
}

}  // namespace maupertuis
