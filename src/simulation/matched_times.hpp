#pragma once
#include <span>
#include <vector>

namespace maupertuis {

/// What happened in one run beside what happened, of the same kind, in another that began a rounding aside: for each of
/// `times` the one of `others` that belongs to it. Both are in order, and stay so. As
/// many belong together one by one. Where one run has more of them (a touch of zero that it has and the other has not,
/// at its start or on its way), those are left out without which the rest is nearest, by the sum of differences:
///
///     times    |        |          |               others[0] is one of a start that the other run has not
///     others  |.|        |        |
///
/// What the other run has not has the nearest of `others`, but behind the last one that belongs to one nothing: there
/// the other run may have ended. Nothing is infinity.
///
/// Cost: the longer length times the difference of lengths; one by one where that is more than a few million.
std::vector<double> matched_times(std::span<const double> times, std::span<const double> others);

}  // namespace maupertuis
