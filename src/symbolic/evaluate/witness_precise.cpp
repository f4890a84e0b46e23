#include "symbolic/evaluate/branch_search.hpp"
#include "symbolic/evaluate/real100.hpp"
#include "symbolic/evaluate/real_numbers.hpp"
#include "symbolic/evaluate/witness.hpp"

#include <maupertuis/switches.hpp>

namespace maupertuis::evaluation {
namespace {

constexpr int starts_on_leaf = 6;

/// The value of a root that interval arithmetic shows to be another than 0 at the point.
template <class Real>
std::optional<Witness> witness_at(const Tape& tape, const Bindings& point) {
  using std::isfinite;
  std::vector<Interval<Real>> values;
  RealNumbers<Interval<Real>> numbers([&](Expr symbol) {
    const Real x = point.at(symbol);
    return Interval<Real>{x, x};
  });
  run(tape, numbers, values);
  for (std::size_t i = 0; i < tape.roots().size(); ++i) {
    const Interval<Real>& v = values[tape.roots()[i]];
    if (!v.is_nan() && !v.contains_zero() && isfinite(v.low) && isfinite(v.high))
      return Witness{point, static_cast<double>(Real((v.low + v.high) / 2)), i};
  }
  return std::nullopt;
}

/// Whether interval arithmetic shows the functions to have these signs at a point.
bool has_signs(const Tape& tape, const Signs& wanted, const Bindings& point) {
  std::vector<Interval<double>> values;
  RealNumbers<Interval<double>> numbers([&](Expr symbol) {
    const double x = point.at(symbol);
    return Interval<double>{x, x};
  });
  run(tape, numbers, values);
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const Interval<double>& g = values[tape.roots()[i]];
    if (g.is_nan() || !(wanted[i] > 0 ? g.low > 0 : g.high < 0)) return false;
  }
  return true;
}

/// The search is led by the first `led_by` sides. Those that were asked for last say most: between which two of its
/// places a piece of a table lies.
bool any_point_led_by(std::size_t led_by, const std::vector<Side>& sides, std::span<const Expr> symbols,
                      std::uint64_t seed, const std::function<bool(const Bindings&)>& accept) {
  std::vector<Expr> all(symbols.begin(), symbols.end()), switches;
  Signs wanted;
  for (const Side& side : sides) {
    all.push_back(side.g);
    switches.push_back(side.g);
    wanted.push_back(side.above ? 1 : -1);
  }
  const Tape tape(switches);
  const SwitchSearch search{symbols_of(all), random_real_point(Tape(all), 2, seed), 0, seed};
  BranchSearch branches(std::span<const Expr>(switches).first(led_by), search);
  const Signs leading(wanted.begin(), wanted.begin() + static_cast<std::ptrdiff_t>(led_by));
  for (int turn = 0; turn < starts_on_leaf; ++turn) {
    Bindings point = turn == 0 ? search.center : branches.draw();
    if (branches.reach(point, leading) && has_signs(tape, wanted, point) && accept(point)) return true;
  }
  return false;
}

}  // namespace

std::optional<Witness> find_precise_witness(const Tape& tape, int points, std::uint64_t seed) {
  for (int trial = 0; trial < points; ++trial)
    if (const auto found = witness_at<Real100>(tape, random_real_point(tape, trial, seed))) return found;
  return std::nullopt;
}

std::optional<Witness> find_witness_in_branches(std::span<const Expr> roots, std::uint64_t seed) {
  const std::vector<Expr> switches = switches_of(roots);
  if (switches.empty()) return std::nullopt;
  const Tape tape(roots);
  SwitchSearch search{symbols_of(roots), random_real_point(tape, 2, seed), 0, seed};
  const std::vector<Bindings> points = points_in_branches(switches, search).points;
  for (const Bindings& point : points)
    if (const auto found = witness_at<double>(tape, point)) return found;
  for (const Bindings& point : points)
    if (const auto found = witness_at<Real100>(tape, point)) return found;
  return std::nullopt;
}

bool any_point_on_sides(const std::vector<Side>& sides, std::span<const Expr> symbols, std::uint64_t seed,
                        const std::function<bool(const Bindings&)>& accept) {
  constexpr std::size_t few = 12;
  return (sides.size() > few && any_point_led_by(few, sides, symbols, seed, accept)) ||
         any_point_led_by(sides.size(), sides, symbols, seed, accept);
}

std::optional<Witness> find_witness_on_sides(Expr formula, const std::vector<Side>& sides, std::uint64_t seed) {
  const Tape tape({&formula, 1});
  std::optional<Witness> found;
  any_point_on_sides(sides, symbols_of({&formula, 1}), seed, [&](const Bindings& point) {
    found = witness_at<double>(tape, point);
    if (!found) found = witness_at<Real100>(tape, point);
    return found.has_value();
  });
  return found;
}

}  // namespace maupertuis::evaluation
