#include "analysis/linearization/locus_parts.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace maupertuis {
namespace {

/// The vertex of the parabola through three points (x, y), the middle one not above the others.
struct Parabola {
  double at = 0, least = 0;

  Parabola(std::pair<double, double> a, std::pair<double, double> b, std::pair<double, double> c) {
    const double left = (b.second - a.second) / (b.first - a.first),
                 right = (c.second - b.second) / (c.first - b.first), bend = (right - left) / (c.first - a.first),
                 slope = left + bend * (b.first - a.first);
    at = bend > 0 ? b.first - slope / (2 * bend) : b.first;
    least = bend > 0 ? b.second - slope * slope / (4 * bend) : b.second;
  }
};

class WindowSearch {
 public:
  WindowSearch(BranchFollower& follow, Locus& locus) : follow_(follow), locus_(locus) {}

  /// A verdict may hold in a window narrower than the step: it opens where a multiplier comes nearest to 1 or −1, or an
  /// eigenvalue to 0.
  void run() {
    for (LocusBranch& branch : locus_.branches) {
      std::vector<LocusPoint> found;
      for (std::size_t which = 0; which < branch.points.front().passes.size(); ++which)
        for (std::size_t i = 0; i < branch.points.size() && branch.points.size() > 1; ++i)
          if (const auto window = window_about(branch.points, i, which)) found.push_back(*window);
      for (LocusPoint& x : found) {
        const auto after = std::find_if(branch.points.begin(), branch.points.end(), [&](const LocusPoint& y) {
          return (y.parameter - x.parameter) * follow_.step() > 0;
        });
        branch.points.insert(after, std::move(x));
      }
    }
  }

 private:
  /// At an end of the branch a place a little further inwards stands in the middle.
  std::optional<LocusPoint> window_about(const std::vector<LocusPoint>& points, std::size_t i, std::size_t which) {
    constexpr double little = 1e-3;  // of the way to the next point
    if (i > 0 && i + 1 < points.size()) return window_beside(points[i - 1], points[i], points[i + 1], which);
    const LocusPoint &end = points[i], &next = i == 0 ? points[1] : points[i - 1];
    if (end.parameter != locus_.values.front() && end.parameter != locus_.values.back()) return std::nullopt;
    const auto is_less = [&](const LocusPoint& x, const LocusPoint& y) {
      return x.passes.size() > which && y.passes.size() > which &&
             std::abs(x.passes[which]) <= std::abs(y.passes[which]);
    };
    if (!is_less(end, next) || end.stability.verdict != next.stability.verdict) return std::nullopt;
    const auto inside = follow_.between(end, next, end.parameter + little * (next.parameter - end.parameter));
    if (!inside || !is_less(*inside, end)) return std::nullopt;
    if (inside->stability.verdict != end.stability.verdict) return inside;
    return i == 0 ? window_beside(end, *inside, next, which) : window_beside(next, *inside, end, which);
  }

  /// Three neighbours of one verdict, the middle one nearest to a pass: the minimum of the distance between the outer
  /// ones, by parabolas and golden sections in turn, until the verdict is another or it is clear that it never is.
  std::optional<LocusPoint> window_beside(LocusPoint low, LocusPoint middle, LocusPoint high, std::size_t which) {
    constexpr int most = 60;
    constexpr double far = 0.5;                               // of the distance at the middle
    constexpr double short_way = 1.0 / 8, narrowest = 1e-10;  // of the step: there it is a parabola; there is none
    for (const LocusPoint* p : {&low, &high})
      if (p->passes.size() <= which || p->stability.verdict != middle.stability.verdict) return std::nullopt;
    if (middle.passes[which] == 0) return std::nullopt;  // it passes here, or is 0 at all values
    const double side = std::copysign(1.0, middle.passes[which]);
    const auto off = [&](const LocusPoint& p) { return side * p.passes[which]; };
    if (!(off(middle) <= off(low) && off(middle) <= off(high))) return std::nullopt;
    for (int k = 0; k < most; ++k) {
      const Parabola through({low.parameter, off(low)}, {middle.parameter, off(middle)}, {high.parameter, off(high)});
      const double width = std::abs((high.parameter - low.parameter) / follow_.step());
      if (width < narrowest || (width < short_way && through.least > far * off(middle))) return std::nullopt;
      const double at = k % 2 == 0 ? through.at : golden(low.parameter, middle.parameter, high.parameter);
      const bool above = (at - middle.parameter) * follow_.step() > 0;
      if (at == middle.parameter) continue;
      if (!((at - low.parameter) * (high.parameter - at) > 0)) return std::nullopt;  // rounding of the parameter
      const auto here = above ? follow_.between(middle, high, at) : follow_.between(low, middle, at);
      if (!here || here->passes.size() <= which) return std::nullopt;
      if (here->stability.verdict != middle.stability.verdict) return here;
      if (off(*here) <= off(middle)) {
        (above ? low : high) = middle;
        middle = *here;
      } else {
        (above ? high : low) = *here;
      }
    }
    return std::nullopt;
  }

  static double golden(double low, double middle, double high) {
    constexpr double part = 0.3819660112501051;
    const double longer = std::abs(high - middle) > std::abs(middle - low) ? high : low;
    return middle + part * (longer - middle);
  }

  BranchFollower& follow_;
  Locus& locus_;
};

}  // namespace

void look_between(BranchFollower& follow, Locus& locus) { WindowSearch(follow, locus).run(); }

}  // namespace maupertuis
