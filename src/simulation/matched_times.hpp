#pragma once
#include <span>
#include <vector>

namespace maupertuis {

/// What happened in one run beside what happened, of the same kind, in another that began a rounding aside: for each of
/// `times` the one of `others` that belongs to it. Both are in order, and stay so. Mostly they belong together one by
/// one. But rounding may hide a touch of zero, or make two crossings of it, in one of them alone:
///
///     times     |        |            ||           |
///     others  | |        |            |            |        the first is a touch at the start, hidden in `times`
///
/// What is left alone costs as much as the median of the ways between `times`, a pair the difference of its times; the
/// whole costs least (alignment of sequences, as Needleman and Wunsch 1970). Pairs are shifted by three against each
/// other, and by what one run has more, at most: runs that have nothing to do with each other stay far apart.
///
/// What the other run has not has the nearer of the times beside it, but behind the last pair, and its instant, none:
/// there the other run may have ended. None is infinity. Cost: the lengths' difference and seven, times the length; one
/// by one where that is more than a few million.
std::vector<double> matched_times(std::span<const double> times, std::span<const double> others);

}  // namespace maupertuis
