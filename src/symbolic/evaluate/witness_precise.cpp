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

std::optional<Witness> find_witness_on_leaf(const Leaf& leaf, std::uint64_t seed) {
  std::vector<Expr> all{leaf.formula}, switches;
  Signs wanted;
  for (const Side& side : leaf.sides) {
    all.push_back(side.g);
    switches.push_back(side.g);
    wanted.push_back(side.above ? 1 : -1);
  }
  const Tape tape({&leaf.formula, 1}), sides(switches);
  const SwitchSearch search{symbols_of(all), random_real_point(Tape(all), 2, seed), 0, seed};
  BranchSearch branches(switches, search);
  for (int turn = 0; turn < starts_on_leaf; ++turn) {
    Bindings point = turn == 0 ? search.center : branches.draw();
    if (!branches.reach(point, wanted) || !has_signs(sides, wanted, point)) continue;
    if (const auto found = witness_at<double>(tape, point)) return found;
    if (const auto found = witness_at<Real100>(tape, point)) return found;
  }
  return std::nullopt;
}

}  // namespace maupertuis::evaluation
