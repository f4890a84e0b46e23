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
constexpr int most_tried = 3;             // pairs of members that two families are linked by, the nearest first

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
  // A step of double along what its derivatives do not tell from none may lead far away.
  if (const auto found = system.solve(from, false, turns_from_nearby))
    if (distance(e_, sizes_, from, found->point) <= farthest / 2) return found->point;
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

void Families::add(Equilibrium candidate) {
  above_.push_back(members_.size());
  members_.push_back(std::move(candidate));
}

/// Near pairs first: most are neighbours on one curve, some steps apart, and what is left then are few.
void Families::link(bool at_rest, const SteadyState& system) {
  struct Pair {
    double distance;
    std::size_t one, other;
  };
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < members_.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (members_[i].at_rest == at_rest && members_[j].at_rest == at_rest && members_[i].family == members_[j].family)
        pairs.push_back({distance(e_, sizes_, members_[i].point, members_[j].point), j, i});
  std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& x, const Pair& y) { return x.distance < y.distance; });
  std::map<std::pair<std::size_t, std::size_t>, int> tried;  // of two families
  for (const Pair& pair : pairs) {
    const std::size_t one = leader(pair.one), other = leader(pair.other), first = std::min(one, other),
                      second = std::max(one, other);
    if (first == second || ++tried[{first, second}] > most_tried) continue;
    if (linked(members_[pair.one], members_[pair.other], system)) above_[second] = first;
  }
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
