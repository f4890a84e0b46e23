#pragma once
#include <maupertuis/evaluate.hpp>

#include <functional>
#include <span>
#include <vector>

namespace maupertuis {

/// The value of a formula at these doubles, calculated with 100 digits and rounded once: sin(π) is 0 to 1e-100, and
/// exp(a) − 2.71875 has all its digits. Precondition: every symbol is bound, no TimeDerivative nodes. Cost: some
/// microseconds a node.
double rounded_value(Expr e, const Bindings& bindings);
/// Of many, whose common parts are calculated once.
std::vector<double> rounded_values(std::span<const Expr> roots, const std::function<double(Expr symbol)>& value_of);

}  // namespace maupertuis
