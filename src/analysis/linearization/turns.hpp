#pragma once
#include "analysis/linearization/point_equations.hpp"

namespace maupertuis {

/// Whether the equations are the same 2π further along a coordinate, proved, with these values of symbols: numbers at
/// random points do not see a spring beside another that is 10¹³ times stiffer.
bool repeats_each_turn(const PointEquations::Impl& e, std::size_t coordinate, const ExprMap& values);

}  // namespace maupertuis
