#include "analysis/linearization/branch_walk.hpp"
#include "analysis/linearization/point_equations.hpp"

#include <maupertuis/interrupt.hpp>
#include <maupertuis/locus.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>
#include <set>

namespace maupertuis {
namespace {

constexpr double longest_step = 1.0 / 3, short_step = 0.1, one_place = 1e-5;  // of typical sizes

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

class Tracer {
 public:
  Tracer(PointEquations& equations, const MotionState& start, std::size_t parameter, const NeighboursAt& driven)
      : equations_(equations),
        start_(start),
        parameter_(parameter),
        driven_(driven),
        sizes_(typical_sizes(equations.system(), start)) {
    locus_.parameter = parameter;
  }

  /// Interrupted, what there is after the first value.
  Locus trace(double from, double to, std::size_t steps) {
    std::size_t whole = 0;  // values whose points are joined
    try {
      for (; whole < steps; ++whole)
        add_value(from + (to - from) * static_cast<double>(whole) / static_cast<double>(steps - 1),
                  whole == 0 || whole == steps / 2 || whole == steps - 1);
      for (std::size_t b = 0; b < locus_.branches.size(); ++b) extend(b, true);
      find_folds();
      drop_points_of_folds();
      look_between();
      find_changes();
      join_births();
    } catch (const Interrupted&) {
      if (whole == 0) throw;
      locus_.values.resize(whole);
      locus_.interrupted = true;
    }
    std::stable_sort(locus_.changes.begin(), locus_.changes.end(),
                     [](const auto& x, const auto& y) { return x.parameter < y.parameter; });
    std::stable_sort(locus_.folds.begin(), locus_.folds.end(),
                     [](const auto& x, const auto& y) { return x.parameter < y.parameter; });
    return std::move(locus_);
  }

 private:
  void add_value(double value, bool everywhere) {
    locus_.values.push_back(value);
    set_parameter(value);
    note_translations(locus_.values.size() == 1);
    join(points_at(value, everywhere));
  }

  /// A force that vanishes at one value leaves symmetries there that the others do not have.
  void set_parameter(double value) {
    equations_.set_parameter(parameter_, value);
    symmetries_ = equations_.translations();
  }

  /// Those of the locus are the ones at all values.
  void note_translations(bool first) {
    if (first) locus_.translations = symmetries_;
    std::erase_if(locus_.translations, [&](const Translation& x) {
      return std::none_of(symmetries_.begin(), symmetries_.end(), [&](const Translation& y) { return is_same(x, y); });
    });
  }

  bool is_same(const Translation& x, const Translation& y) const {
    constexpr double rounding = 1e-6;  // of typical sizes
    if (x.pivot != y.pivot || x.conserved != y.conserved) return false;
    for (std::size_t i = 0; i < sizes_.size(); ++i)
      if (std::abs(x.direction[i] - y.direction[i]) * sizes_[x.pivot] > rounding * sizes_[i]) return false;
    return true;
  }

  bool in_time() const { return driven_ && !equations_.autonomous(); }

  LocusPoint judged(double value, const Equilibrium& x) {
    if (in_time())
      if (auto neighbours = driven_(value, x)) {
        locus_.driven = true;
        return {value, x, std::move(neighbours->stability), std::move(neighbours->exponents),
                std::move(neighbours->passes)};
      }
    const Linearization l = linearize(equations_, x.point).linearization;
    const ModalAnalysis analysis = modal_analysis(equations_, l, symmetries_, &x);
    return {value, x, analysis.stability, analysis.eigenvalues, {product_of_eigenvalues(analysis, x)}};
  }

  /// Smooth in the parameter, 0 where one passes 0; but for those that vanish by a symmetry or along a family.
  double product_of_eigenvalues(const ModalAnalysis& analysis, const Equilibrium& x) const {
    std::size_t explained = x.family;
    for (const Translation& t : symmetries_) explained += 1 + t.conserved;
    std::complex<double> out = 1;
    for (const std::complex<double>& z : analysis.eigenvalues)
      if (z != 0.0)
        out *= z;
      else if (explained > 0)
        --explained;
      else
        out = 0;
    return out.real();
  }

  std::vector<LocusPoint> points_at(double value, bool everywhere) {
    EquilibriumSearch search;
    search.start = start_;
    search.everywhere = everywhere;
    for (const std::size_t b : open_) search.guesses.push_back(locus_.branches[b].points.back().equilibrium.point);
    std::vector<LocusPoint> out;
    for (const Equilibrium& x : find_equilibria(equations_, search).found)
      if (!x.coordinates_fail) out.push_back(judged(value, x));
    return out;
  }

  double distance(const Equilibrium& x, const Equilibrium& y) const {
    if (x.at_rest != y.at_rest) return HUGE_VAL;
    double out = 0;
    for (std::size_t i = 0; i < x.point.q.size(); ++i) out = std::max(out, std::abs(along(i, x, y)) / sizes_[i]);
    return out;
  }

  struct Arrival {
    std::size_t branch = 0, point = 0;
    double surprise = 0;
  };
  /// How far a point is from the straight line on which the branch went there.
  double surprise(const LocusBranch& branch, const Equilibrium& there) const {
    const LocusPoint& last = branch.points.back();
    if (branch.points.size() < 2) return distance(last.equilibrium, there);
    const LocusPoint& before = branch.points.end()[-2];
    const Step line[] = {{before.parameter, before.equilibrium}, {last.parameter, last.equilibrium}};
    return distance(on_line(line[0], line[1], locus_.values.back()), there);
  }
  /// One curve alone goes through it.
  static bool is_regular(const LocusPoint& x) { return x.stability.verdict != Stability::Undecided; }

  /// Where two branches cross they have one point, and each goes on from it; where one ends on another, Newton's method
  /// slips along that. What no branch arrives at begins one.
  void join(std::vector<LocusPoint> points) {
    std::vector<std::size_t> still_open, unclear;
    std::vector<Arrival> arrivals;
    for (const std::size_t b : open_) {
      if (!is_followed(locus_.branches[b].points.back().equilibrium)) {
        unclear.push_back(b);
        continue;
      }
      const auto there = continued(locus_.branches[b].points);
      if (!there) continue;
      const auto same = std::find_if(points.begin(), points.end(),
                                     [&](const LocusPoint& p) { return distance(p.equilibrium, *there) <= one_place; });
      arrivals.push_back({b, static_cast<std::size_t>(same - points.begin()), surprise(locus_.branches[b], *there)});
      if (same == points.end()) points.push_back(judged(locus_.values.back(), *there));
    }
    std::vector<bool> placed(points.size(), false);
    for (const Arrival& x : arrivals) {
      placed[x.point] = true;
      if (is_regular(points[x.point]) && std::any_of(arrivals.begin(), arrivals.end(), [&](const Arrival& y) {
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

  /// A member of a family, or a motion that keeps the momenta of the start, is no curve that one could follow.
  static bool is_followed(const Equilibrium& x) { return x.at_rest && x.family == 0; }

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
        if (const double d = distance(locus_.branches[b].points.back().equilibrium, points[p].equilibrium);
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

  /// A search can miss a branch at some values, one that begins far from the start for instance: from where it was met
  /// it is followed to the values before, or after.
  void extend(std::size_t b, bool front) {
    for (;;) {
      const LocusBranch& branch = locus_.branches[b];
      const LocusPoint& end = front ? branch.points.front() : branch.points.back();
      const auto value = value_next_to(end.parameter, front);
      if (!value || !is_followed(end.equilibrium)) return;
      const auto next = extended(branch, front, *value);
      if (!next) return;
      auto& points = locus_.branches[b].points;
      points.insert(front ? points.begin() : points.end(), *next);
    }
  }
  /// Nothing where it does not lead there, or other branches pass.
  std::optional<LocusPoint> extended(const LocusBranch& branch, bool front, double value) {
    const std::vector<LocusPoint> along =
        front ? std::vector<LocusPoint>(branch.points.rbegin(), branch.points.rend()) : branch.points;
    const auto there = continued(along, value);
    if (!there || branch_at(value, *there)) return std::nullopt;
    return judged(value, *there);
  }

  std::optional<std::size_t> branch_at(double value, const Equilibrium& x) const {
    for (std::size_t b = 0; b < locus_.branches.size(); ++b)
      for (const LocusPoint& p : locus_.branches[b].points)
        if (p.parameter == value && distance(p.equilibrium, x) <= one_place) return b;
    return std::nullopt;
  }

  std::optional<Equilibrium> continued(const std::vector<LocusPoint>& points) {
    return continued(points, locus_.values.back());
  }
  /// The point of a branch at another value. Along the curve itself, as far as that can be followed; beyond a fold
  /// another branch begins.
  std::optional<Equilibrium> continued(const std::vector<LocusPoint>& points, double to) {
    const LocusPoint& last = points.back();
    if (!is_curve()) return in_steps(points, to);
    if (is_regular(last)) {
      const BranchWalk walk = walk_from(last, to);
      if (walk.end == BranchWalk::End::Arrived && walk.folds.empty()) return settled(last.equilibrium, walk.last);
      if (walk.end != BranchWalk::End::Lost || !walk.folds.empty()) return std::nullopt;
    }
    const auto there = in_steps(points, to);
    if (!there || is_regular(last)) return there;
    // From a singular point several ways may lead on: those on which it is a fold are branches of their own.
    const BranchWalk back = walk_from({to, *there, {}, {}, {}}, last.parameter);
    return back.folds.empty() ? there : std::nullopt;
  }

  bool is_curve() const { return !in_time(); }

  BranchWalk walk_from(const LocusPoint& from, double to) {
    set_parameter(from.parameter);
    const BranchWalk out =
        walk_along(equations_.impl(), {from.equilibrium.point, parameter_, from.parameter, to, sizes_, symmetries_});
    set_parameter(to);
    return out;
  }

  /// The rest next to a place that a walk has come to, as a search tells it.
  std::optional<Equilibrium> settled(const Equilibrium& like, const RestAt& place) {
    set_parameter(place.value);
    Equilibrium guess = like;
    guess.point = place.rest;
    const auto found = near(guess);
    return found && distance(*found, guess) <= one_place ? found : std::nullopt;
  }

  /// The point at a value next to the last of a branch, in steps that are halved where they are long, or lead nowhere:
  /// at the end of a branch, where it turns back, all of them do.
  std::optional<Equilibrium> in_steps(const std::vector<LocusPoint>& points, double to) {
    constexpr double least = 1.0 / 4096;  // of a step of the sweep
    Step last{points.back().parameter, points.back().equilibrium};
    std::optional<Step> before;
    if (points.size() > 1) before = {points.end()[-2].parameter, points.end()[-2].equilibrium};
    for (double length = to - last.parameter; last.parameter != to;) {
      const bool is_last = std::abs(length) >= std::abs(to - last.parameter);
      const double value = is_last ? to : last.parameter + length;
      set_parameter(value);
      const auto next = near(before ? on_line(*before, last, value) : last.equilibrium);
      if (!next || distance(*next, last.equilibrium) > short_step) {
        length /= 2;
        if (std::abs(length) < least * std::abs(step())) break;
        continue;
      }
      before = last;
      last = {value, *next};
      length *= 2;
    }
    set_parameter(to);
    return last.parameter == to ? std::optional(last.equilibrium) : std::nullopt;
  }

  struct Step {
    double parameter = 0;
    Equilibrium equilibrium;
  };
  /// On the straight line through two points of a branch.
  Equilibrium on_line(const Step& a, const Step& b, double value) const {
    Equilibrium out = b.equilibrium;
    const double part = (value - b.parameter) / (b.parameter - a.parameter);
    for (std::size_t i = 0; i < out.point.q.size(); ++i)
      out.point.q[i] += part * along(i, a.equilibrium, b.equilibrium);
    return out;
  }
  double along(std::size_t i, const Equilibrium& x, const Equilibrium& y) const {
    const double dq = y.point.q[i] - x.point.q[i];
    return equations_.periodic()[i] ? std::remainder(dq, 2 * std::numbers::pi) : dq;
  }

  // ---------------------------------------------------------------------------------------------------- changes of
  // verdict

  /// The equilibrium of a branch near a guess, at any value of the parameter.
  std::optional<LocusPoint> follow(double value, const Equilibrium& guess) {
    set_parameter(value);
    const auto x = near(guess);
    return x ? std::optional(judged(value, *x)) : std::nullopt;
  }

  std::optional<Equilibrium> near(const Equilibrium& guess) const {
    EquilibriumSearch search;
    search.start = {guess.point.t, guess.point.q, start_.v};
    search.steady = !guess.at_rest;
    for (const Equilibrium& x : equilibrium_near(equations_, search))
      if (x.at_rest == guess.at_rest && !x.coordinates_fail && distance(x, guess) <= longest_step) return x;
    return std::nullopt;
  }

  /// A verdict may hold in a window narrower than the step: it opens where a multiplier comes nearest to 1 or −1, or an
  /// eigenvalue to 0.
  void look_between() {
    for (LocusBranch& branch : locus_.branches) {
      std::vector<LocusPoint> found;
      for (std::size_t which = 0; which < branch.points.front().passes.size(); ++which)
        for (std::size_t i = 0; i < branch.points.size() && branch.points.size() > 1; ++i)
          if (const auto window = window_about(branch.points, i, which)) found.push_back(*window);
      for (LocusPoint& x : found) {
        const auto after = std::find_if(branch.points.begin(), branch.points.end(),
                                        [&](const LocusPoint& y) { return (y.parameter - x.parameter) * step() > 0; });
        branch.points.insert(after, std::move(x));
      }
    }
  }

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
    const auto inside = between(end, next, end.parameter + little * (next.parameter - end.parameter));
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
    const double side = std::copysign(1.0, middle.passes[which]);
    const auto off = [&](const LocusPoint& p) { return side * p.passes[which]; };
    if (!(off(middle) <= off(low) && off(middle) <= off(high))) return std::nullopt;
    for (int k = 0; k < most; ++k) {
      const Parabola through({low.parameter, off(low)}, {middle.parameter, off(middle)}, {high.parameter, off(high)});
      const double width = std::abs((high.parameter - low.parameter) / step());
      if (width < narrowest || (width < short_way && through.least > far * off(middle))) return std::nullopt;
      const double at = k % 2 == 0 ? through.at : golden(low.parameter, middle.parameter, high.parameter);
      const bool above = (at - middle.parameter) * step() > 0;
      if (at == middle.parameter) continue;
      if (!((at - low.parameter) * (high.parameter - at) > 0)) return std::nullopt;  // rounding of the parameter
      const auto here = above ? between(middle, high, at) : between(low, middle, at);
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

  void find_changes() {
    for (std::size_t b = 0; b < locus_.branches.size(); ++b) {
      const auto points = locus_.branches[b].points;
      for (std::size_t i = 1; i < points.size(); ++i) {
        const Stability before = points[i - 1].stability.verdict, here = points[i].stability.verdict;
        // Of a driven system that verdict is one of a whole range: all multipliers lie on the unit circle.
        const bool stands_on_it = !in_time() && here == Stability::Undecided && i + 1 < points.size() &&
                                  points[i + 1].stability.verdict != Stability::Undecided &&
                                  before != Stability::Undecided;
        const LocusPoint& after = points[stands_on_it ? ++i : i];
        if (after.stability.verdict != before) bisect(b, stands_on_it ? points[i - 2] : points[i - 1], after);
      }
    }
  }

  /// A value of the sweep can stand on the change itself, with a verdict of its own: the ends decide. Where the branch
  /// is lost on the way the place is not known, and none is told.
  void bisect(std::size_t branch, LocusPoint low, LocusPoint high) {
    const Stability before = low.stability.verdict, after = high.stability.verdict;
    if (const auto place = in_time() ? passed_between(low, high) : std::nullopt) {
      locus_.changes.push_back({*place, branch, before, after});
      return;
    }
    for (int k = 0; k < 60; ++k) {
      const double middle = low.parameter + (high.parameter - low.parameter) / 2;
      if (middle == low.parameter || middle == high.parameter) break;
      const auto point = between(low, high, middle);
      if (!point) return;
      (point->stability.verdict == before ? low : high) = *point;
    }
    locus_.changes.push_back({(low.parameter + high.parameter) / 2, branch, before, after});
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
      const double side = std::copysign(std::min(beside * std::abs(step()), std::abs(end->parameter - *place) / 2),
                                        end->parameter - *place);
      const auto there = between(from, to, *place + side);
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
      if (std::abs(at - high.parameter) <= close * std::abs(step())) return at;
      const auto here = between(low, high, at);
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

  /// Next to the straight line, much nearer than the ends are to each other; else from one of the ends.
  std::optional<LocusPoint> between(const LocusPoint& low, const LocusPoint& high, double middle) {
    constexpr double near_line = 0.1;
    const Step ends[] = {{low.parameter, low.equilibrium}, {high.parameter, high.equilibrium}};
    const Equilibrium guess = on_line(ends[0], ends[1], middle);
    const double most = near_line * distance(low.equilibrium, high.equilibrium) + one_place;
    if (auto point = follow(middle, guess);
        point && (!is_followed(guess) || distance(point->equilibrium, guess) <= most))
      return point;
    for (const LocusPoint* end : {&low, &high})
      if (const auto there = continued({*end}, middle)) return judged(middle, *there);
    return std::nullopt;
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

  // ------------------------------------------------------------------------------------------------------------ folds

  /// A branch that begins or ends between two values of the sweep, and out of no other one, turns back there. The arms
  /// beyond are branches too, also where no start led to them.
  void find_folds() {
    if (!is_curve()) return;
    constexpr std::size_t most_branches = 1000;
    for (std::size_t b = 0; b < std::min(most_branches, locus_.branches.size()); ++b)
      for (const bool front : {true, false}) {
        const LocusPoint end = end_of(b, front);
        const auto beyond = value_next_to(end.parameter, front);
        if (!beyond || !is_followed(end.equilibrium) || !is_regular(end)) continue;
        const BranchWalk walk = walk_from(end, *beyond);
        if (!walk.folds.empty()) add_folds(b, front, end, walk);
      }
  }

  LocusPoint end_of(std::size_t b, bool front) const {
    const auto& points = locus_.branches[b].points;
    return front ? points.front() : points.back();
  }

  /// The value of the sweep before or after that of a point; nothing beyond its ends, and of points between.
  std::optional<double> value_next_to(double value, bool before) const {
    const auto k = std::find(locus_.values.begin(), locus_.values.end(), value);
    if (k == locus_.values.end() || (before ? k == locus_.values.begin() : k + 1 == locus_.values.end()))
      return std::nullopt;
    return before ? *(k - 1) : *(k + 1);
  }

  /// From the end of a branch through all folds of the walk: arms within one step of the sweep have points at their
  /// folds and one between, the last one goes on from where the walk ends.
  void add_folds(std::size_t b, bool front, const LocusPoint& end, const BranchWalk& walk) {
    std::size_t fold = add_fold(b, front, end, walk.folds.front());
    for (std::size_t k = 0; k < walk.arms.size(); ++k) {
      const Fold next = fold_at(end, walk.folds[k + 1]);
      const std::size_t there = known_fold(next);
      if (there < locus_.folds.size() && locus_.folds[there].branches.size() > 1) return;  // the arms are there
      const LocusPoint middle = judged_at(end, walk.arms[k]);
      // Of two folds one is met first along the sweep.
      const bool forward = (walk.folds[k + 1].value - walk.folds[k].value) * step() > 0;
      locus_.branches.push_back({{middle}});
      const std::size_t arm = locus_.branches.size() - 1;
      attach_to(fold, arm, forward, middle);
      fold = add_fold(arm, !forward, middle, walk.folds[k + 1]);
    }
    if (walk.end == BranchWalk::End::Lost) return;
    const bool returned = walk.end == BranchWalk::End::Returned;
    add_last_arm(fold, returned == front, end, walk.last);
  }

  /// `front`: whether the arm begins at the fold, in the direction of the sweep.
  void add_last_arm(std::size_t fold, bool front, const LocusPoint& like, const RestAt& place) {
    const auto there = settled(like.equilibrium, place);
    if (!there) return;
    auto arm = branch_at(place.value, *there);
    const bool is_new = !arm;
    if (is_new) {
      arm = locus_.branches.size();
      locus_.branches.push_back({{judged(place.value, *there)}});
    }
    if (const LocusPoint end = end_of(*arm, front); end.parameter == place.value) attach_to(fold, *arm, front, end);
    if (is_new) extend(*arm, !front);
  }

  Fold fold_at(const LocusPoint& like, const RestAt& place) const {
    Equilibrium x = like.equilibrium;
    x.point = place.rest;
    return {place.value, x, {}};
  }
  LocusPoint judged_at(const LocusPoint& like, const RestAt& place) {
    set_parameter(place.value);
    return judged(place.value, fold_at(like, place).equilibrium);
  }

  /// Its number; that of a new one where there is none.
  std::size_t known_fold(const Fold& fold) const {
    const auto found = std::find_if(locus_.folds.begin(), locus_.folds.end(), [&](const Fold& f) {
      return std::abs(f.parameter - fold.parameter) <= one_place * std::abs(step()) &&
             distance(f.equilibrium, fold.equilibrium) <= one_place;
    });
    return static_cast<std::size_t>(found - locus_.folds.begin());
  }

  std::size_t add_fold(std::size_t b, bool front, const LocusPoint& end, const RestAt& turn) {
    const Fold fold = fold_at(end, turn);
    const std::size_t number = known_fold(fold);
    if (number == locus_.folds.size()) locus_.folds.push_back(fold);
    attach_to(number, b, front, end);
    return number;
  }

  /// The fold is the last point of the branch there, with the verdict of its neighbour.
  void attach_to(std::size_t number, std::size_t b, bool front, const LocusPoint& end) {
    Fold& fold = locus_.folds[number];
    if (std::find(fold.branches.begin(), fold.branches.end(), b) != fold.branches.end() || fold.branches.size() > 1)
      return;
    fold.branches.push_back(b);
    set_parameter(fold.parameter);
    LocusPoint last = judged(fold.parameter, fold.equilibrium);
    last.stability = end.stability;
    auto& points = locus_.branches[b].points;
    points.insert(front ? points.begin() : points.end(), last);
  }

  /// A fold at a value of the sweep is found by the search too, as a point of no branch.
  void drop_points_of_folds() {
    constexpr double of_double_root = 1e-4;  // as far as rounding of the forces leaves it open
    std::vector<std::size_t> numbers;        // new ones
    std::vector<LocusBranch> left;
    for (const LocusBranch& b : locus_.branches) {
      const LocusPoint& x = b.points.front();
      const bool is_fold =
          b.points.size() == 1 && std::any_of(locus_.folds.begin(), locus_.folds.end(), [&](const Fold& f) {
            return f.parameter == x.parameter && distance(f.equilibrium, x.equilibrium) <= of_double_root;
          });
      numbers.push_back(left.size());
      if (!is_fold) left.push_back(b);
    }
    locus_.branches = std::move(left);
    for (Fold& f : locus_.folds)
      for (std::size_t& b : f.branches) b = numbers[b];
    for (Fold& f : locus_.folds) std::sort(f.branches.begin(), f.branches.end());
  }

  double step() const { return locus_.values[1] - locus_.values[0]; }
  /// x in (y − step, y) in the direction of the sweep.
  bool is_before(double x, double y) const {
    constexpr double rounding = 1e-9;
    const double along = (y - x) / step();
    return along > 0 && along <= 1 + rounding;
  }

  void attach(std::size_t b, const StabilityChange& change, const LocusPoint& end, bool front) {
    const LocusPoint* parent = nullptr;
    for (const LocusPoint& p : locus_.branches[change.branch].points)
      if (!parent || std::abs(p.parameter - change.parameter) < std::abs(parent->parameter - change.parameter))
        parent = &p;
    if (!parent || distance(parent->equilibrium, end.equilibrium) > 2 * longest_step) return;
    auto point = follow(change.parameter, parent->equilibrium);
    if (!point) return;
    point->stability = end.stability;
    auto& points = locus_.branches[b].points;
    points.insert(front ? points.begin() : points.end(), *point);
  }

  PointEquations& equations_;
  const MotionState& start_;
  std::size_t parameter_;
  const NeighboursAt& driven_;
  std::vector<double> sizes_;
  std::vector<Translation> symmetries_;  // at the present value
  std::vector<std::size_t> open_;        // branches that have a point at the last value
  Locus locus_;
};

}  // namespace

Locus parameter_locus(PointEquations& equations, const MotionState& start, std::size_t parameter, double from,
                      double to, std::size_t steps, const NeighboursAt& driven) {
  const double own = equations.parameter(parameter);
  Locus out = Tracer(equations, start, parameter, driven).trace(from, to, steps);
  equations.set_parameter(parameter, own);
  return out;
}

std::vector<double> values_without_points(const Locus& locus) {
  std::set<double> seen;
  for (const LocusBranch& b : locus.branches)
    for (const LocusPoint& x : b.points) seen.insert(x.parameter);
  std::vector<double> out;
  std::copy_if(locus.values.begin(), locus.values.end(), std::back_inserter(out),
               [&](double value) { return seen.count(value) == 0; });
  return out;
}

std::string to_csv(const MechanicalSystem& system, const Locus& locus) {
  const auto unit = [&](const Dimension& d) {
    const std::string word = system.dimensionless ? "1" : to_string(d);
    return word == "1" ? std::string() : " [" + word + "]";
  };
  const Parameter& p = system.parameters[locus.parameter];
  std::string out = p.name + unit(p.dimension) + ",branch,verdict";
  for (const Coordinate& c : system.coordinates) out += fmt::format(",{}{}", c.name, unit(c.dimension));
  for (const Coordinate& c : system.coordinates)
    out += fmt::format(",{}'{}", c.name, unit(c.dimension / system.independent_dimension));
  std::size_t eigenvalues = 0;
  for (const LocusBranch& b : locus.branches)
    for (const LocusPoint& x : b.points) eigenvalues = std::max(eigenvalues, x.eigenvalues.size());
  for (std::size_t i = 1; i <= eigenvalues; ++i) out += fmt::format(",re{0},im{0}", i);
  out += "\r\n";
  for (std::size_t b = 0; b < locus.branches.size(); ++b)
    for (const LocusPoint& x : locus.branches[b].points) {
      out += fmt::format("{:.17g},{},{}", x.parameter, b + 1, stability_word(x.stability.verdict));
      for (const auto* list : {&x.equilibrium.point.q, &x.equilibrium.point.v})
        for (const double value : *list) out += fmt::format(",{:.17g}", value);
      for (std::size_t i = 0; i < eigenvalues; ++i)
        out += i < x.eigenvalues.size()
                   ? fmt::format(",{:.17g},{:.17g}", x.eigenvalues[i].real(), x.eigenvalues[i].imag())
                   : ",nan,nan";
      out += "\r\n";
    }
  return out;
}

}  // namespace maupertuis
