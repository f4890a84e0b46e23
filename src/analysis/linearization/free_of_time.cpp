#include "analysis/linearization/free_of_time.hpp"

#include <maupertuis/evaluate.hpp>
#include <maupertuis/transform.hpp>

namespace maupertuis {

bool free_of_time(std::span<const Expr> expressions, const MechanicalSystem& system) {
  ExprVector rates;
  for (const Expr& e : expressions) {
    const Expr rate = differentiate(e, system.context->time());
    if (!rate.is_zero()) rates.push_back(rate);
  }
  if (rates.empty()) return true;
  ExprMap zeros;
  for (const Parameter& p : system.parameters)
    if (p.si_value == 0) zeros.emplace(p.symbol, system.context->number(0));
  return zero_test(substitute(rates, zeros)).verdict == Verdict::Zero;
}

}  // namespace maupertuis
