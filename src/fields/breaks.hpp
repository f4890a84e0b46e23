#pragma once
#include <maupertuis/fields.hpp>

namespace maupertuis {

/// W0651 for each jump or kink of the start in x (and y), also between the ends of a periodic domain. Waves of every
/// length come from there, of which a mesh follows the long ones alone, so that errors fall slowly with the width of a
/// cell, whatever the order: whether there is one. (A density that jumps has elements with borders there.)
///
/// Starts with abs, min, max, piecewise or broken powers are sampled along lines, and differences that stay as pieces
/// are halved are breaks. At most one for each line of the start. In fields without inertia no waves run: nothing is
/// told of theirs.
bool warn_of_breaks(const FieldEquations& equations, const std::vector<int>& cells, Diagnostics& diagnostics);

}  // namespace maupertuis
