#pragma once
#include <maupertuis/expression.hpp>

#include <span>
#include <unordered_map>
#include <vector>

namespace maupertuis {

/// The place of each symbol in a list.
std::unordered_map<NodeId, std::size_t> places_of(std::span<const Expr> symbols);

/// Adjoints ∂e/∂node of every node below `e`, from the root down, restricted to nodes from which one of `wanted` can
/// be reached. A TimeDerivative node passes −d/dt of its adjoint to its argument (integration by parts), so that the
/// adjoint of a coordinate is the variational derivative. Sources: Griewank-Walther, Evaluating Derivatives, ch. 3;
/// docs/design/computational_form.md.
std::unordered_map<NodeId, Expr> reverse_sweep(Expr e, const std::unordered_map<NodeId, std::size_t>& wanted);

}  // namespace maupertuis
