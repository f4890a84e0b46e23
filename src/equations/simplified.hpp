#pragma once
#include <maupertuis/print.hpp>

namespace maupertuis {

/// The sum with the terms of inner sums among its own, so that equal ones join: x − (x + r) is −r.
inline Expr with_inner_sums(Expr sum) {
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

/// e with every sum in it flat, and nothing else multiplied out.
inline Expr with_flat_sums(Expr e) {
  ExprMap flat;
  for (const Expr& node : topological_order({&e, 1})) {
    if (node.size() == 0) continue;
    const auto of = [&](Expr argument) { return argument.size() == 0 ? argument : flat.at(argument); };
    std::vector<Expr> arguments;
    for (std::size_t i = 0; i < node.size(); ++i) arguments.push_back(of(node[i]));
    const Expr made = node.context().make(node.kind(), arguments);
    flat.emplace(node, made.is(Kind::Sum) ? with_inner_sums(made) : made);
  }
  return e.size() == 0 ? e : flat.at(e);
}

/// e in its readable form; as it is where that would need named intermediates, or, with flat sums, where it is written
/// shorter, as the derivative of a root may be: (x - a)/sqrt((x - a)^2 + y^2).
inline Expr simplified(Expr e, const ReadingOrder& order = {}) {
  const Expr plain = expand_time_derivatives(e);
  const ReadableForm form = readable(plain, order);
  if (!form.intermediates.empty()) return plain;
  const bool has_root = [&] {
    for (const Expr& node : topological_order({&plain, 1}))
      if (node.is(Kind::Power) && node[1].is_number() && !node[1].number().is_integer()) return true;
    return false;
  }();
  if (!has_root) return form.value;
  const Expr flat = with_flat_sums(plain);
  return to_plain(flat, order).size() < to_plain(form.value, order).size() ? flat : form.value;
}

}  // namespace maupertuis
