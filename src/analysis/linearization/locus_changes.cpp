#include "analysis/linearization/locus_parts.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

class ChangeSearch {
 public:
  ChangeSearch(BranchFollower& follow, Locus& locus) : follow_(follow), locus_(locus) {}

  void run() {
    for (std::size_t b = 0; b < locus_.branches.size(); ++b) {
      const auto points = locus_.branches[b].points;
      for (std::size_t i = 1; i < points.size(); ++i) {
        const Stability before = points[i - 1].stability.verdict, here = points[i].stability.verdict;
        // Of a driven system that verdict is one of a whole range: all multipliers lie on the unit circle.
        const bool stands_on_it = !follow_.in_time() && here == Stability::Undecided && i + 1 < points.size() &&
                                  points[i + 1].stability.verdict != Stability::Undecided &&
                                  before != Stability::Undecided;
        const LocusPoint& after = points[stands_on_it ? ++i : i];
        if (after.stability.verdict != before) bisect(b, stands_on_it ? points[i - 2] : points[i - 1], after);
      }
    }
  }

  /// A branch that begins in the step in which another changes its verdict, beside it, grows out of it there.
  void join_births() {
    for (std::size_t b = 0; b < locus_.branches.size(); ++b) {
      const LocusPoint first = locus_.branches[b].points.front(), last = locus_.branches[b].points.back();
      for (const StabilityChange& change : locus_.changes) {
        if (change.branch == b) continue;
        if (is_before(change.parameter, first.parameter)) attach(b, change, first, true);
        if (is_before(last.parameter, change.parameter)) attach(b, change, last, false);
      }
    }
  }

 private:
  /// A value of the sweep can stand on the change itself, with a verdict of its own: the ends decide. Where the branch
  /// is lost on the way the place is not known, and none is told.
  void bisect(std::size_t branch, LocusPoint low, LocusPoint high) {
    const Stability before = low.stability.verdict, after = high.stability.verdict;
    if (const auto place = follow_.in_time() ? passed_between(low, high) : std::nullopt) {
      locus_.changes.push_back({*place, branch, before, after});
      return;
    }
    for (int k = 0; k < 60; ++k) {
      const double middle = low.parameter + (high.parameter - low.parameter) / 2;
      if (middle == low.parameter || middle == high.parameter) break;
      const auto point = decided_between(low, high, before, after);
      if (!point) return;
      (point->stability.verdict == before ? low : high) = *point;
    }
    locus_.changes.push_back({(low.parameter + high.parameter) / 2, branch, before, after});
  }

  /// In the middle, or where nothing is decided there, beside it: it may be one place alone, as K is singular at x = 0
  /// of (p − p₀)² x²/2 + x⁴/4 where p is p₀, and no change.
  std::optional<LocusPoint> decided_between(const LocusPoint& low, const LocusPoint& high, Stability before,
                                            Stability after) {
    constexpr double beside = 0.4;
    const auto at = [&](double part) {
      return follow_.between(low, high, low.parameter + part * (high.parameter - low.parameter));
    };
    auto point = at(0.5);
    if (!point || follow_.in_time() || point->stability.verdict == before || point->stability.verdict == after)
      return point;
    const auto other = at(beside);
    return other && (other->stability.verdict == before || other->stability.verdict == after) ? other : point;
  }

  /// Where a multiplier passes 1 or −1, by secants (Illinois): smooth there, while the verdict needs a multiplier that
  /// has left the circle beyond its error. Nothing where none passes, or the verdict changes elsewhere.
  std::optional<double> passed_between(const LocusPoint& from, const LocusPoint& to) {
    const auto changes_sign = [&](std::size_t k) {
      return k < to.passes.size() && (from.passes[k] > 0) != (to.passes[k] > 0);
    };
    std::size_t which = 0;
    while (which < from.passes.size() && !changes_sign(which)) ++which;
    if (which == from.passes.size()) return std::nullopt;
    const auto place = zero_of_pass(from, to, which);
    if (!place) return std::nullopt;
    constexpr double beside = 1e-6;  // of the step
    for (const LocusPoint* end : {&from, &to}) {
      const double side = std::copysign(
          std::min(beside * std::abs(follow_.step()), std::abs(end->parameter - *place) / 2), end->parameter - *place);
      const auto there = follow_.between(from, to, *place + side);
      if (!there || there->stability.verdict != end->stability.verdict) return std::nullopt;
    }
    return place;
  }

  std::optional<double> zero_of_pass(const LocusPoint& from, const LocusPoint& to, std::size_t which) {
    constexpr int most = 60;
    constexpr double close = 1e-13;  // of the step
    LocusPoint low = from, high = to;
    double f_low = low.passes[which], f_high = high.passes[which];
    for (int k = 0; k < most && f_high != 0; ++k) {
      const double width = high.parameter - low.parameter;
      const double at = k % 4 == 3 ? low.parameter + width / 2 : high.parameter - f_high * width / (f_high - f_low);
      if (std::abs(at - high.parameter) <= close * std::abs(follow_.step())) return at;
      const auto here = follow_.between(low, high, at);
      if (!here || here->passes.size() <= which) return std::nullopt;
      const double f = here->passes[which];
      if ((f > 0) == (f_high > 0))
        f_low /= 2;
      else
        low = high, f_low = f_high;
      high = *here, f_high = f;
    }
    return high.parameter;
  }

  /// x in (y − step, y) in the direction of the sweep.
  bool is_before(double x, double y) const {
    constexpr double rounding = 1e-9;
    const double along = (y - x) / follow_.step();
    return along > 0 && along <= 1 + rounding;
  }

  void attach(std::size_t b, const StabilityChange& change, const LocusPoint& end, bool front) {
    const LocusPoint* parent = nullptr;
    for (const LocusPoint& p : locus_.branches[change.branch].points)
      if (!parent || std::abs(p.parameter - change.parameter) < std::abs(parent->parameter - change.parameter))
        parent = &p;
    if (!parent || follow_.distance(parent->equilibrium, end.equilibrium) > 2 * longest_step) return;
    auto point = follow_.point_near(change.parameter, parent->equilibrium);
    if (!point) return;
    point->stability = end.stability;
    auto& points = locus_.branches[b].points;
    points.insert(front ? points.begin() : points.end(), *point);
  }

  BranchFollower& follow_;
  Locus& locus_;
};

}  // namespace

void find_changes(BranchFollower& follow, Locus& locus) {
  ChangeSearch search(follow, locus);
  search.run();
  search.join_births();
}

}  // namespace maupertuis
