#include "analysis/linearization/branch_follower.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace maupertuis {
namespace {

constexpr double short_step = 0.1;  // of typical sizes

}  // namespace

BranchFollower::BranchFollower(PointEquations& equations, const MotionState& start, std::size_t parameter, double step,
                               const NeighboursAt& driven)
    : equations_(equations),
      start_(start),
      parameter_(parameter),
      step_(step),
      driven_(driven),
      sizes_(typical_sizes(equations.system(), start)) {}

void BranchFollower::set_parameter(double value) {
  equations_.set_parameter(parameter_, value);
  symmetries_ = equations_.translations();
}

LocusPoint BranchFollower::judged(double value, const Equilibrium& x) {
  if (equations_.parameter(parameter_) != value) set_parameter(value);
  if (in_time())
    if (auto neighbours = driven_(value, x)) {
      was_driven_ = true;
      return {value, x, std::move(neighbours->stability), std::move(neighbours->exponents),
              std::move(neighbours->passes)};
    }
  const Linearization l = linearize(equations_, x.point).linearization;
  const ModalAnalysis analysis = modal_analysis(equations_, l, symmetries_, &x);
  return {value, x, analysis.stability, analysis.eigenvalues, {product_of_eigenvalues(analysis, x)}};
}

/// Smooth in the parameter, 0 where one passes 0; but for those that vanish by a symmetry or along a family.
double BranchFollower::product_of_eigenvalues(const ModalAnalysis& analysis, const Equilibrium& x) const {
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

double BranchFollower::distance(const Equilibrium& x, const Equilibrium& y) const {
  if (x.at_rest != y.at_rest) return HUGE_VAL;
  double out = 0;
  for (std::size_t i = 0; i < x.point.q.size(); ++i) out = std::max(out, std::abs(along(i, x, y)) / sizes_[i]);
  return out;
}

std::optional<LocusPoint> BranchFollower::point_near(double value, const Equilibrium& guess) {
  set_parameter(value);
  const auto x = near(guess);
  return x ? std::optional(judged(value, *x)) : std::nullopt;
}

std::optional<Equilibrium> BranchFollower::near(const Equilibrium& guess) const {
  EquilibriumSearch search;
  search.start = {guess.point.t, guess.point.q, start_.v};
  search.steady = !guess.at_rest;
  for (const Equilibrium& x : equilibrium_near(equations_, search))
    if (x.at_rest == guess.at_rest && !x.coordinates_fail && distance(x, guess) <= longest_step) return x;
  return std::nullopt;
}

std::optional<Equilibrium> BranchFollower::continued(const std::vector<LocusPoint>& points, double to) {
  const LocusPoint& last = points.back();
  if (in_time() || !is_followed(last.equilibrium)) return in_steps(points, to);
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

BranchWalk BranchFollower::walk_from(const LocusPoint& from, double to) {
  set_parameter(from.parameter);
  const BranchWalk out =
      walk_along(equations_.impl(), {from.equilibrium.point, parameter_, from.parameter, to, sizes_, symmetries_});
  set_parameter(to);
  return out;
}

std::optional<Equilibrium> BranchFollower::settled(const Equilibrium& like, const RestAt& place) {
  set_parameter(place.value);
  Equilibrium guess = like;
  guess.point = place.rest;
  const auto found = near(guess);
  return found && distance(*found, guess) <= one_place ? found : std::nullopt;
}

/// The point at a value next to the last of a branch, in steps that are halved where they are long, or lead nowhere:
/// at the end of a branch, where it turns back, all of them do.
std::optional<Equilibrium> BranchFollower::in_steps(const std::vector<LocusPoint>& points, double to) {
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

Equilibrium BranchFollower::on_line(const LocusPoint& a, const LocusPoint& b, double value) const {
  return on_line(Step{a.parameter, a.equilibrium}, Step{b.parameter, b.equilibrium}, value);
}

Equilibrium BranchFollower::on_line(const Step& a, const Step& b, double value) const {
  Equilibrium out = b.equilibrium;
  const double part = (value - b.parameter) / (b.parameter - a.parameter);
  for (std::size_t i = 0; i < out.point.q.size(); ++i) out.point.q[i] += part * along(i, a.equilibrium, b.equilibrium);
  return out;
}
double BranchFollower::along(std::size_t i, const Equilibrium& x, const Equilibrium& y) const {
  const double dq = y.point.q[i] - x.point.q[i];
  return equations_.periodic()[i] ? std::remainder(dq, 2 * std::numbers::pi) : dq;
}

std::optional<LocusPoint> BranchFollower::between(const LocusPoint& low, const LocusPoint& high, double middle) {
  constexpr double near_line = 0.1;
  const Equilibrium guess = on_line(low, high, middle);
  const double most = near_line * distance(low.equilibrium, high.equilibrium) + one_place;
  if (auto point = point_near(middle, guess);
      point && (!is_followed(guess) || distance(point->equilibrium, guess) <= most))
    return point;
  for (const LocusPoint* end : {&low, &high})
    if (const auto there = continued({*end}, middle)) return judged(middle, *there);
  return std::nullopt;
}

}  // namespace maupertuis
