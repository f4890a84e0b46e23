#include "analysis/linearization/families.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

namespace maupertuis {
namespace {

constexpr int turns_from_nearby = 8;  // Newton's method begins a tenth of a typical size away, or is not on the family
constexpr int most_steps_along = 2000;    // of all walks together: each asks for the directions of the family anew
constexpr int most_precise_steps = 5000;  // of all walks together: some tenths of a millisecond each
constexpr int most_tried = 3;             // members of one family that a new one is linked with, the nearest first

double along(const PointEquations::Impl& e, std::size_t i, double from, double to) {
  return e.is_periodic[i] ? std::remainder(to - from, 2 * std::acos(-1.0)) : to - from;
}

OperatingPoint between(const PointEquations::Impl& e, const OperatingPoint& x, const OperatingPoint& y, double part) {
  OperatingPoint out = x;
  for (std::size_t i = 0; i < e.n; ++i) {
    out.q[i] += part * along(e, i, x.q[i], y.q[i]);
    out.v[i] += part * (y.v[i] - x.v[i]);
  }
  return out;
}

void unite(std::vector<std::size_t>& into, const std::vector<std::size_t>& more) {
  std::vector<std::size_t> both;
  std::set_union(into.begin(), into.end(), more.begin(), more.end(), std::back_inserter(both));
  into = std::move(both);
}

}  // namespace

double distance(const PointEquations::Impl& e, const std::vector<double>& sizes, const OperatingPoint& x,
                const OperatingPoint& y) {
  double largest = 0;
  for (std::size_t i = 0; i < e.n; ++i) {
    const double speed = std::max({sizes[i], std::abs(x.v[i]), std::abs(y.v[i])});
    largest = std::max({largest, std::abs(along(e, i, x.q[i], y.q[i])) / sizes[i], std::abs(x.v[i] - y.v[i]) / speed});
  }
  return largest;
}

/// The root of the sum of squares, in typical sizes: on a ring it falls all the way, where the largest part may rise.
double Families::chord(const OperatingPoint& x, const OperatingPoint& y) const {
  double squares = 0;
  for (std::size_t i = 0; i < e_.n; ++i) {
    const double speed = std::max({sizes_[i], std::abs(x.v[i]), std::abs(y.v[i])});
    squares += std::pow(along(e_, i, x.q[i], y.q[i]) / sizes_[i], 2) + std::pow((x.v[i] - y.v[i]) / speed, 2);
  }
  return std::sqrt(squares);
}

bool Families::linked(const Equilibrium& x, const Equilibrium& y, const SteadyState& system) {
  const Walk straight{
      [&](const OperatingPoint& at, double part) { return std::optional(between(e_, at, y.point, part)); },
      [&](const OperatingPoint& a, const OperatingPoint& b) { return distance(e_, sizes_, a, b); }, 0};
  const Walk along_family{[&](const OperatingPoint& at, double part) -> std::optional<OperatingPoint> {
                            if (steps_along_ == most_steps_along) return std::nullopt;
                            ++steps_along_;
                            const OperatingPoint there = between(e_, at, y.point, 1);
                            return system.step_towards(at, there, part * chord(at, there));
                          },
                          [&](const OperatingPoint& a, const OperatingPoint& b) { return chord(a, b); }, 0.05};
  // Straight ahead gets there where the derivatives are nearly singular, and the family's directions not known well.
  return walks(x, y, system, straight) || walks(x, y, system, along_family);
}

std::optional<OperatingPoint> Families::next_to(const OperatingPoint& from, double farthest,
                                                const SteadyState& system) {
  if (const auto found = system.solve(from, false, turns_from_nearby)) return found->point;
  if (precise_steps_ == most_precise_steps) return std::nullopt;
  ++precise_steps_;
  const auto found = system.precise_root(from, farthest);
  return found ? std::optional(found->point) : std::nullopt;
}

bool Families::walks(const Equilibrium& x, const Equilibrium& y, const SteadyState& system, const Walk& walk) {
  constexpr double same = 1e-6, longest = 0.1;  // of typical sizes
  constexpr double most_steps = 200;            // since where V falls off for ever some lie as far out as one likes
  OperatingPoint at = x.point;
  double left = walk.distance(at, y.point);
  const double step = std::max(std::min(left / 4, longest), left / most_steps);
  for (int turns = static_cast<int>(4 * left / std::max(step, same)); left > std::max(step, same); --turns) {
    const auto from = turns > 0 ? walk.beside(at, step / left) : std::nullopt;
    const auto next = from ? next_to(*from, 2 * step, system) : std::nullopt;
    if (!next || walk.distance(at, *next) > 2 * step) return false;
    const double now = walk.distance(*next, y.point);
    if (!(now < left - walk.least * step)) return false;
    at = *next;
    left = now;
  }
  return true;
}

std::size_t Families::leader(std::size_t member) const {
  while (above_[member] != member) member = above_[member];
  return member;
}

void Families::add(Equilibrium candidate, const SteadyState& system) {
  std::vector<std::size_t> near;
  for (std::size_t i = 0; i < members_.size(); ++i)
    if (members_[i].at_rest == candidate.at_rest && members_[i].family == candidate.family) near.push_back(i);
  std::sort(near.begin(), near.end(), [&](std::size_t i, std::size_t j) {
    return distance(e_, sizes_, members_[i].point, candidate.point) <
           distance(e_, sizes_, members_[j].point, candidate.point);
  });
  const std::size_t own = members_.size();
  above_.push_back(own);
  std::map<std::size_t, int> tried;  // of each family
  for (const std::size_t i : near)
    if (leader(i) != leader(own) && ++tried[leader(i)] <= most_tried && linked(members_[i], candidate, system))
      above_[leader(own)] = leader(i);
  members_.push_back(std::move(candidate));
}

std::vector<Equilibrium> Families::representatives(const OperatingPoint& start) const {
  std::vector<std::size_t> chosen(members_.size(), members_.size());  // [leaders]
  std::vector<std::vector<std::size_t>> directions(members_.size());  // [leaders] coordinates
  for (std::size_t i = 0; i < members_.size(); ++i) {
    const std::size_t family = leader(i);
    unite(directions[family], members_[i].family_along);
    if (chosen[family] == members_.size() ||
        distance(e_, sizes_, members_[i].point, start) < distance(e_, sizes_, members_[chosen[family]].point, start))
      chosen[family] = i;
  }
  std::vector<Equilibrium> out;
  for (std::size_t family = 0; family < members_.size(); ++family) {
    if (chosen[family] == members_.size()) continue;
    out.push_back(members_[chosen[family]]);
    out.back().family_along = directions[family];
  }
  return out;
}

}  // namespace maupertuis
