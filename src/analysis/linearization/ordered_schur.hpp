#pragma once
#include "analysis/linearization/matrices.hpp"

#include <optional>

namespace maupertuis {

/// An orthonormal basis [2s × s] of the invariant subspace of a matrix [2s × 2s] for its eigenvalues with negative real
/// parts; nothing where their number is not s, or LAPACK's iteration fails.
std::optional<Matrix> stable_subspace(const Matrix& matrix);

}  // namespace maupertuis
