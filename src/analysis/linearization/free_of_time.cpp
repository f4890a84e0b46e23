#include "analysis/linearization/free_of_time.hpp"

#include <maupertuis/evaluate.hpp>
#include <maupertuis/switches.hpp>
#include <maupertuis/transform.hpp>

namespace maupertuis {

bool free_of_time(std::span<const Expr> expressions, const MechanicalSystem& system) {
  ExprVector functions(expressions.begin(), expressions.end());
  const ExprVector switches = switches_of(expressions);  // sign(sin t) has the rate 0 on both sides of its jumps
  functions.insert(functions.end(), switches.begin(), switches.end());
  ExprVector rates;
  for (const Expr& e : functions) {
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
