#pragma once
#include "analysis/invariants/motion_sampler.hpp"

#include <optional>
#include <vector>

namespace maupertuis::invariants {

/// Σ_k c_k columns[k] = target, for all rows and all points of the motion: [rows] of [unknowns + 1] expressions.
struct LinearFitRows {
  std::vector<std::vector<Expr>> rows;  // each: the factors of the unknowns, then the target
  std::size_t unknowns = 0;
};

/// Constants c_k, functions of the parameters, that satisfy the rows at random points; the earliest columns are taken
/// where they are not unique. Zeros are empty handles. Nothing where there are none, or they are too long.
/// The fractions are those of ParameterFit.
std::optional<std::vector<Expr>> fit_constants(const MotionRows& motion, const LinearFitRows& fit, std::uint64_t seed);

/// Whether the target column is a combination of the others at a random point, with factors that may differ from point
/// to point.
bool depends_at_a_point(const MotionRows& motion, const LinearFitRows& fit, std::uint64_t seed);

}  // namespace maupertuis::invariants
