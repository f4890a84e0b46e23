#pragma once
#include <maupertuis/tangent.hpp>

#include <optional>

namespace maupertuis::orbits {

/// ∫ divergence dt over a stretch of the motion, by Gauss's rule with eight nodes in each Taylor step; nothing where
/// there is no divergence (TangentGeometry), or the motion ends before.
std::optional<double> integrated_divergence(const EquationsOfMotion& equations, const TangentGeometry& geometry,
                                            const MotionState& start, double duration);

}  // namespace maupertuis::orbits
