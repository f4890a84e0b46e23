#include "analysis/linearization/locus_parts.hpp"

#include <maupertuis/interrupt.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace maupertuis {
namespace {

/// Equilibria at the values of a sweep, one after another, joined to branches.
class Tracer {
 public:
  Tracer(PointEquations& equations, const MotionState& start, std::size_t parameter, double step,
         const NeighboursAt& driven)
      : equations_(equations), start_(start), follow_(equations, start, parameter, step, driven) {
    locus_.parameter = parameter;
  }

  /// Interrupted, what there is after the first value.
  Locus trace(double from, double to, std::size_t steps) {
    std::size_t whole = 0;  // values whose points are joined
    try {
      for (; whole < steps; ++whole)
        add_value(from + (to - from) * static_cast<double>(whole) / static_cast<double>(steps - 1),
                  whole == 0 || whole == steps / 2 || whole == steps - 1);
      for (std::size_t b = 0; b < locus_.branches.size(); ++b) extend_branch(follow_, locus_, b, true);
      find_folds(follow_, locus_);
      look_between(follow_, locus_);
      find_changes(follow_, locus_);
    } catch (const Interrupted&) {
      if (whole == 0) throw;
      locus_.values.resize(whole);
      locus_.interrupted = true;
    }
    std::stable_sort(locus_.changes.begin(), locus_.changes.end(),
                     [](const auto& x, const auto& y) { return x.parameter < y.parameter; });
    std::stable_sort(locus_.folds.begin(), locus_.folds.end(),
                     [](const auto& x, const auto& y) { return x.parameter < y.parameter; });
    locus_.driven = follow_.was_driven();
    return std::move(locus_);
  }

 private:
  void add_value(double value, bool everywhere) {
    locus_.values.push_back(value);
    follow_.set_parameter(value);
    note_translations(locus_.values.size() == 1);
    join(points_at(value, everywhere));
  }

  /// Those of the locus are the ones at all values.
  void note_translations(bool first) {
    if (first) locus_.translations = follow_.symmetries();
    std::erase_if(locus_.translations, [&](const Translation& x) {
      return std::none_of(follow_.symmetries().begin(), follow_.symmetries().end(),
                          [&](const Translation& y) { return is_same(x, y); });
    });
  }

  bool is_same(const Translation& x, const Translation& y) const {
    constexpr double rounding = 1e-6;  // of typical sizes
    if (x.pivot != y.pivot || x.conserved != y.conserved) return false;
    for (std::size_t i = 0; i < follow_.sizes().size(); ++i)
      if (std::abs(x.direction[i] - y.direction[i]) * follow_.sizes()[x.pivot] > rounding * follow_.sizes()[i])
        return false;
    return true;
  }

  std::vector<LocusPoint> points_at(double value, bool everywhere) {
    EquilibriumSearch search;
    search.start = start_;
    search.everywhere = everywhere;
    for (const std::size_t b : open_) search.guesses.push_back(locus_.branches[b].points.back().equilibrium.point);
    std::vector<LocusPoint> out;
    for (const Equilibrium& x : find_equilibria(equations_, search).found)
      if (!x.coordinates_fail) out.push_back(follow_.judged(value, x));
    return out;
  }

  struct Arrival {
    std::size_t branch = 0, point = 0;
    double surprise = 0;
  };
  /// How far a point is from the straight line on which the branch went there.
  double surprise(const LocusBranch& branch, const Equilibrium& there) const {
    const LocusPoint& last = branch.points.back();
    if (branch.points.size() < 2) return follow_.distance(last.equilibrium, there);
    const LocusPoint& before = branch.points.end()[-2];
    return follow_.distance(follow_.on_line(before, last, locus_.values.back()), there);
  }
  /// Where two branches cross they have one point, and each goes on from it; where one ends on another, Newton's method
  /// slips along that. What no branch arrives at begins one.
  void join(std::vector<LocusPoint> points) {
    std::vector<std::size_t> still_open, unclear;
    std::vector<Arrival> arrivals;
    for (const std::size_t b : open_) {
      if (!follow_.is_followed(locus_.branches[b].points.back().equilibrium)) {
        unclear.push_back(b);
        continue;
      }
      const auto there = follow_.continued(locus_.branches[b].points, locus_.values.back());
      if (!there) continue;
      const auto same = std::find_if(points.begin(), points.end(), [&](const LocusPoint& p) {
        return follow_.distance(p.equilibrium, *there) <= one_place;
      });
      arrivals.push_back({b, static_cast<std::size_t>(same - points.begin()), surprise(locus_.branches[b], *there)});
      if (same == points.end()) points.push_back(follow_.judged(locus_.values.back(), *there));
    }
    std::vector<bool> placed(points.size(), false);
    for (const Arrival& x : arrivals) {
      placed[x.point] = true;
      if (follow_.is_regular(points[x.point]) && std::any_of(arrivals.begin(), arrivals.end(), [&](const Arrival& y) {
            return y.point == x.point && std::pair(y.surprise, y.branch) < std::pair(x.surprise, x.branch);
          }))
        continue;
      locus_.branches[x.branch].points.push_back(points[x.point]);
      still_open.push_back(x.branch);
    }
    join_nearest(unclear, points, placed, still_open);
    for (std::size_t p = 0; p < points.size(); ++p) {
      if (placed[p]) continue;
      still_open.push_back(locus_.branches.size());
      locus_.branches.push_back({{points[p]}});
    }
    std::sort(still_open.begin(), still_open.end());
    open_ = std::move(still_open);
  }

  /// Nearest pairs of branch ends and new points first.
  void join_nearest(const std::vector<std::size_t>& branches, const std::vector<LocusPoint>& points,
                    std::vector<bool>& placed, std::vector<std::size_t>& still_open) {
    struct Pair {
      double distance;
      std::size_t branch, point;
    };
    std::vector<Pair> pairs;
    for (const std::size_t b : branches)
      for (std::size_t p = 0; p < points.size(); ++p)
        if (const double d = follow_.distance(locus_.branches[b].points.back().equilibrium, points[p].equilibrium);
            d <= longest_step && !placed[p])
          pairs.push_back({d, b, p});
    std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& x, const Pair& y) { return x.distance < y.distance; });
    for (const Pair& pair : pairs) {
      if (placed[pair.point] || std::find(still_open.begin(), still_open.end(), pair.branch) != still_open.end())
        continue;
      placed[pair.point] = true;
      locus_.branches[pair.branch].points.push_back(points[pair.point]);
      still_open.push_back(pair.branch);
    }
  }

  PointEquations& equations_;
  const MotionState& start_;
  BranchFollower follow_;
  std::vector<std::size_t> open_;  // branches that have a point at the last value
  Locus locus_;
};

/// The point of a branch at a value next to its end. Nothing where it does not lead there, or other branches pass.
std::optional<LocusPoint> extended(BranchFollower& follow, const Locus& locus, const LocusBranch& branch, bool front,
                                   double value) {
  const std::vector<LocusPoint> along =
      front ? std::vector<LocusPoint>(branch.points.rbegin(), branch.points.rend()) : branch.points;
  const auto there = follow.continued(along, value);
  if (!there || branch_at(follow, locus, value, *there)) return std::nullopt;
  return follow.judged(value, *there);
}

}  // namespace

std::optional<double> value_next_to(const Locus& locus, double value, bool before) {
  const auto k = std::find(locus.values.begin(), locus.values.end(), value);
  if (k == locus.values.end() || (before ? k == locus.values.begin() : k + 1 == locus.values.end()))
    return std::nullopt;
  return before ? *(k - 1) : *(k + 1);
}

std::optional<std::size_t> branch_at(const BranchFollower& follow, const Locus& locus, double value,
                                     const Equilibrium& x) {
  for (std::size_t b = 0; b < locus.branches.size(); ++b)
    for (const LocusPoint& p : locus.branches[b].points)
      if (p.parameter == value && follow.distance(p.equilibrium, x) <= one_place) return b;
  return std::nullopt;
}

void extend_branch(BranchFollower& follow, Locus& locus, std::size_t b, bool front) {
  for (;;) {
    const LocusBranch& branch = locus.branches[b];
    const LocusPoint& end = front ? branch.points.front() : branch.points.back();
    const auto value = value_next_to(locus, end.parameter, front);
    if (!value || !follow.is_followed(end.equilibrium)) return;
    const auto next = extended(follow, locus, branch, front, *value);
    if (!next) return;
    auto& points = locus.branches[b].points;
    points.insert(front ? points.begin() : points.end(), *next);
  }
}

Locus parameter_locus(PointEquations& equations, const MotionState& start, std::size_t parameter, double from,
                      double to, std::size_t steps, const NeighboursAt& driven) {
  const double own = equations.parameter(parameter);
  Locus out =
      Tracer(equations, start, parameter, (to - from) / static_cast<double>(steps - 1), driven).trace(from, to, steps);
  equations.set_parameter(parameter, own);
  return out;
}

}  // namespace maupertuis
