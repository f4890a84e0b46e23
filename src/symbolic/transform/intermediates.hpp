#pragma once
#include <maupertuis/transform.hpp>

#include <span>
#include <vector>

namespace maupertuis::terms {

/// The form of systems that are too large to be multiplied out: sub-expressions that occur more than once get names
/// (c1 = cos q1, k12 = …), shared over all rows, and each row is collected by its accelerations. Equal by construction:
/// nothing is expanded. Every row lists all intermediates, in order of use. Precondition: no TimeDerivative nodes.
std::vector<ReadableForm> with_intermediates(std::span<const Expr> rows, const ReadingOrder& order);

}  // namespace maupertuis::terms
