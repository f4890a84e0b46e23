#pragma once
#include <maupertuis/mechanical_system.hpp>

#include <functional>
#include <span>
#include <vector>

namespace maupertuis {

/// Calls `visit` on every expression of the system that the equations come from, always in the same order.
void for_each_expression(MechanicalSystem& system, const std::function<void(Expr&)>& visit);

/// The same system in a context of its own, without `written`; what is in `along` goes there with it. What is derived
/// from it does not depend on what else has been derived from the given system, terms of sums in their order included,
/// and threads may derive side by side as long as nobody makes nodes in the given context.
/// Precondition: an expression of the given context has been made by context->time() before threads are.
/// Cost: O(nodes).
MechanicalSystem in_own_context(const MechanicalSystem& system, std::span<std::vector<Expr>* const> along);

}  // namespace maupertuis
