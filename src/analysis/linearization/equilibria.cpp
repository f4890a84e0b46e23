#include "analysis/linearization/families.hpp"
#include "analysis/linearization/second_names.hpp"
#include "analysis/linearization/steady_state.hpp"

#include <maupertuis/arguments.hpp>
#include <maupertuis/require.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

/// Where to begin, what to keep, and which of the points found are the same.
namespace maupertuis {
namespace {

constexpr double turn = 2 * std::numbers::pi;
constexpr double same = 1e-6;           // of typical sizes: closer points are one
constexpr double box = 10;              // of typical sizes: equilibria further from the start are not meant
constexpr double straight_snap = 1e-7;  // a coordinate so near to a plain value is tried there
constexpr double proved_snap = 1e-11;   // one that is known to 100 digits, or as the limit of a series

double wrapped(double angle) {
  const double x = std::remainder(angle, turn);
  return x <= -std::numbers::pi + 1e-12 ? x + turn : x;
}

class Search {
 public:
  Search(const PointEquations& equations, const EquilibriumSearch& search)
      : equations_(equations),
        e_(equations.impl()),
        search_(search),
        sizes_(typical_sizes(equations.system(), search.start)),
        translations_(equations.translations(preferred())),
        second_names_(e_, translations_),
        families_(e_, sizes_) {}

  EquilibriumSearchResult all() {
    names_as_found_ = false;
    EquilibriumSearchResult result;
    const std::vector<OperatingPoint> starts = starting_points();
    result.starts = starts.size();
    if (may_rest()) from_each(starts, true);
    if (search_.steady && may_move()) from_each(starts, false);
    result.found = all_found();
    if (search_.guesses.empty()) result.outside = leave_out_far_ones(result.found);
    put_in_order(result.found);
    result.translations = translations_;
    return result;
  }

  std::vector<Equilibrium> nearest() {
    const std::vector<OperatingPoint> starts{model_start()};
    if (may_rest()) from_each(starts, true);
    if (all_found().empty() && search_.steady && may_move()) from_each(starts, false);
    return all_found();
  }

 private:
  // Rates that are given decide which coordinate stands for a translation; then those that move at the start.
  std::vector<bool> preferred() const {
    std::vector<bool> out(e_.n, false);
    for (std::size_t i = 0; i < e_.n; ++i)
      out[i] = !search_.fixed.v.empty() ? search_.fixed.v[i] : search_.start.v[i] != 0;
    return out;
  }

  bool moves(std::size_t i) const { return !search_.fixed.v.empty() && search_.fixed.v[i] && search_.start.v[i] != 0; }
  bool may_rest() const {
    for (std::size_t i = 0; i < e_.n; ++i)
      if (moves(i)) return false;
    return true;
  }
  /// A translation can go on: with given rates, with the momentum of the start, or driven.
  bool may_move() const {
    if (search_.fixed.any() && !translations_.empty()) return true;
    const Vector p = translations_.empty() ? Vector() : e_.value(e_.momenta, model_start());
    for (std::size_t k = 0; k < translations_.size(); ++k)
      if (!translations_[k].conserved || rate_is_held(k) || std::abs(search_.start.v[translations_[k].pivot]) > 0 ||
          moves_along(k) || has_momentum(k, p))
        return true;
    return false;
  }
  /// A wheel that does not turn in a body that does has some.
  bool has_momentum(std::size_t k, const Vector& p) const {
    const Vector direction = to_eigen(translations_[k].direction);
    constexpr double rounding = 1e-12;
    return std::abs(direction.dot(p)) > rounding * direction.cwiseAbs().dot(p.cwiseAbs());
  }
  bool moves_along(std::size_t k) const {
    for (std::size_t i = 0; i < e_.n; ++i)
      if (translations_[k].direction[i] != 0 && search_.start.v[i] != 0) return true;
    return false;
  }
  bool rate_is_held(std::size_t k) const { return !search_.fixed.v.empty() && search_.fixed.v[translations_[k].pivot]; }

  OperatingPoint model_start() const {
    OperatingPoint point{search_.start.t,           search_.start.q,           search_.start.v,
                         std::vector<double>(e_.n), std::vector<double>(e_.m), equations_.inputs_at(search_.start.t)};
    return point;
  }

  // --------------------------------------------------------------------------------------------------- starting points

  std::size_t count_of_starts() const {
    if (search_.starts > 0) return search_.starts;
    const std::size_t size = e_.n + e_.m;
    return std::clamp<std::size_t>(40'000 / (size * size + 1), 2, 64);
  }

  bool held(std::size_t i) const {
    if (!search_.fixed.q.empty() && search_.fixed.q[i]) return true;
    for (const Translation& t : translations_)
      if (t.pivot == i) return true;
    return false;
  }

  std::vector<OperatingPoint> starting_points() const {
    const OperatingPoint first = model_start();
    std::vector<OperatingPoint> out = search_.guesses;
    out.push_back(first);
    OperatingPoint zero = first;
    for (std::size_t i = 0; i < e_.n; ++i)
      if (!held(i)) zero.q[i] = 0;
    out.push_back(zero);
    add_corners(out, zero);
    add_scattered(out, first);
    if (search_.everywhere) add_far_ones(out, first);
    return out;
  }

  /// All angles at 0 or π.
  void add_corners(std::vector<OperatingPoint>& out, const OperatingPoint& zero) const {
    std::vector<std::size_t> angles;
    for (std::size_t i = 0; i < e_.n; ++i)
      if (e_.is_periodic[i] && !held(i)) angles.push_back(i);
    constexpr std::size_t most = 5;
    if (angles.empty() || angles.size() > most) return;
    for (const bool lengths_of_start : {false, true})
      for (std::size_t corner = lengths_of_start ? 0 : 1; corner < (std::size_t{1} << angles.size()); ++corner) {
        OperatingPoint point = lengths_of_start ? model_start() : zero;
        for (std::size_t k = 0; k < angles.size(); ++k) point.q[angles[k]] = corner >> k & 1 ? std::numbers::pi : 0;
        out.push_back(point);
      }
  }

  /// The same points in every run: angles anywhere, lengths about their typical size, most of them positive.
  void add_scattered(std::vector<OperatingPoint>& out, const OperatingPoint& first) const {
    std::mt19937_64 random(1744);
    const auto uniform = [&](double low, double high) {
      return low + (high - low) * std::generate_canonical<double, 53>(random);
    };
    const std::size_t count = count_of_starts();
    for (std::size_t s = 0; s < count; ++s) {
      OperatingPoint point = first;
      for (std::size_t i = 0; i < e_.n; ++i) {
        const bool angle = e_.system->coordinates[i].kind == "angle";
        const double x = angle ? uniform(-std::numbers::pi, std::numbers::pi) : sizes_[i] * uniform(-1.5, 2.5);
        if (!held(i)) point.q[i] = x;
      }
      out.push_back(point);
    }
  }

  /// As many again up to where a search looks: lengths of any order from a typical size on, of both signs.
  void add_far_ones(std::vector<OperatingPoint>& out, const OperatingPoint& first) const {
    std::mt19937_64 random(1788);
    const auto uniform = [&] { return 2 * std::generate_canonical<double, 53>(random) - 1; };
    const std::size_t count = count_of_starts();
    for (std::size_t s = 0; s < count; ++s) {
      OperatingPoint point = first;
      for (std::size_t i = 0; i < e_.n; ++i) {
        const double x = uniform();
        const bool angle = e_.system->coordinates[i].kind == "angle";
        if (!held(i)) point.q[i] += angle ? turn * x : std::copysign(sizes_[i] * std::pow(box, std::abs(x)), x);
      }
      out.push_back(point);
    }
  }

  // -------------------------------------------------------------------------------------------------------- solving

  SteadyState equations_of(bool at_rest) const {
    SteadyState::Held held_unknowns{std::vector<bool>(e_.n), std::vector<bool>(translations_.size(), at_rest)};
    for (std::size_t i = 0; i < e_.n; ++i) held_unknowns.q[i] = held(i);
    std::vector<double> momenta(translations_.size(), std::numeric_limits<double>::quiet_NaN());
    if (!at_rest) {
      const Vector p = e_.value(e_.momenta, model_start());
      for (std::size_t k = 0; k < translations_.size(); ++k) {
        held_unknowns.rates[k] = rate_is_held(k);
        if (translations_[k].conserved && !search_.fixed.any())
          momenta[k] = to_eigen(translations_[k].direction).dot(p);
      }
    }
    return SteadyState(e_, translations_, held_unknowns, momenta, sizes_);
  }

  void from_each(const std::vector<OperatingPoint>& starts, bool at_rest) {
    const SteadyState system = equations_of(at_rest);
    for (OperatingPoint from : starts) {
      if (at_rest) std::fill(from.v.begin(), from.v.end(), 0);
      auto solution = solved_within_turns(from, system);
      if (!solution) continue;
      settle(*solution, system);
      if (!names_as_found_) solution->point = second_names_.first_name(solution->point);
      if (search_.fixed.any()) find_all_ways(*solution, at_rest);
      if (!balances(*solution, system) || is_edge(solution->point)) continue;
      if (search_.fixed.any() && system.is_unbalanced(solution->point)) continue;
      if (!at_rest && is_at_rest(solution->point)) continue;
      if (!holds_for_all_times(solution->point)) continue;
      keep({solution->point, at_rest, solution->residual, solution->family, solution->along, false, {}});
    }
    families_.link(at_rest, system);
  }

  /// An angle of 1e15 rad has no digits left within its turn: from where it is within one, the search begins again.
  std::optional<SteadyState::Solution> solved_within_turns(OperatingPoint from, const SteadyState& system) const {
    constexpr int most_returns = 3;
    for (int returns = 0; returns <= most_returns; ++returns) {
      auto solution = system.solve(from, !search_.fixed.any());  // values that are given are rounded
      if (!solution || !is_many_turns_away(solution->point)) return solution;
      from = solution->point;
      wrap_angles(from);
    }
    return std::nullopt;
  }

  bool is_many_turns_away(const OperatingPoint& point) const {
    constexpr double many = 100;  // rad: known to 1e-14 within the turn
    for (std::size_t i = 0; i < e_.n; ++i)
      if (e_.is_periodic[i] && !held(i) && std::abs(point.q[i]) > many) return true;
    return false;
  }

  void wrap_angles(OperatingPoint& point) const {
    for (std::size_t i = 0; i < e_.n; ++i)
      if (e_.is_periodic[i] && !held(i)) point.q[i] = wrapped(point.q[i]);
  }

  /// How it can be moved on and stay a solution, whatever was given: a family is one of the equations.
  void find_all_ways(SteadyState::Solution& solution, bool at_rest) const {
    SteadyState::Held pivots{std::vector<bool>(e_.n), std::vector<bool>(translations_.size(), at_rest)};
    std::vector<double> momenta(translations_.size(), std::numeric_limits<double>::quiet_NaN());
    const Vector p = at_rest ? Vector() : e_.value(e_.momenta, solution.point);
    for (std::size_t k = 0; k < translations_.size(); ++k) {
      pivots.q[translations_[k].pivot] = true;
      if (!at_rest && translations_[k].conserved) momenta[k] = to_eigen(translations_[k].direction).dot(p);
    }
    const auto there = SteadyState(e_, translations_, pivots, momenta, sizes_).solve(solution.point);
    if (there) solution.family = there->family, solution.along = there->along;
  }

  bool is_at_rest(const OperatingPoint& point) const {
    for (std::size_t i = 0; i < e_.n; ++i)
      if (std::abs(point.v[i]) > same * std::max(sizes_[i], std::abs(search_.start.v[i]))) return false;
    return true;
  }

  /// Angles into (−π, π]; and plain values, 0 and multiples of π/12, where the equations hold there as well.
  void settle(SteadyState::Solution& solution, const SteadyState& system) const {
    wrap_angles(solution.point);
    OperatingPoint plain = solution.point;
    for (std::size_t i = 0; i < e_.n; ++i) {
      if (held(i)) continue;
      const double step = e_.system->coordinates[i].kind == "angle" ? std::numbers::pi / 12 : HUGE_VAL;
      const double nearest = std::isfinite(step) ? step * std::round(plain.q[i] / step) : 0;
      const double snap = solution.proved ? proved_snap : straight_snap;
      if (std::abs(plain.q[i] - nearest) < snap * sizes_[i]) plain.q[i] = nearest;
    }
    const double residual = system.residual_at(plain);
    if (!(residual <= std::max(solution.residual, 1e-14))) return;
    solution.point = plain;
    solution.residual = residual;
  }

  /// The forces balance at the very point that is told, whose angles may have been taken back by many turns; and with
  /// q̇ = 0 put into R as a number, since x'/|x'| has no value there. So has the energy a value: −1/x balances forces
  /// where x < 0, but −log x is no potential there.
  bool balances(const SteadyState::Solution& solution, const SteadyState& system) const {
    constexpr double balanced = 1e-9;
    OperatingPoint told = solution.point;
    return (solution.proved || system.residual_at(told) <= balanced) && e_.value(e_.balance, told).allFinite() &&
           std::isfinite(e_.energy_at(told));
  }

  /// Whether forces have no value beside the point, as those of x^1.5 for x < 0, and are not smaller there than half
  /// the way to that edge further: derivatives that grow without bound let any force pass as rounding of the place, and
  /// what vanishes at the edge alone does not rest there, since nothing is known beyond.
  bool is_edge(const OperatingPoint& point) const {
    constexpr double beside = 1e-6, much_less = 1e-3;  // of sizes; of forces
    const auto works = [&](const Vector& forces) {
      return forces.cwiseAbs().dot(Eigen::Map<const Vector>(sizes_.data(), forces.size()));
    };
    const double here = works(e_.value(e_.balance, point));
    for (std::size_t i = 0; i < e_.n; ++i) {
      const auto at = [&](double way) {
        OperatingPoint moved = point;
        moved.q[i] += way;
        return works(e_.value(e_.balance, moved));
      };
      const auto has_value = [&](double way) { return std::isfinite(at(way)) && std::isfinite(at(-way)); };
      double way = beside * sizes_[i];
      if (has_value(way)) continue;
      while (way > 0 && !has_value(way)) way /= 4;
      if (way == 0 || !(here <= much_less * std::max(at(way / 2), at(-way / 2)))) return true;
    }
    return false;
  }

  /// Where t stands in the equations, they must hold whatever t is.
  bool holds_for_all_times(const OperatingPoint& point) const {
    if (e_.is_autonomous()) return true;
    const SteadyState system = equations_of(true);
    for (const double t : {0.1234, 0.777, 1.9, 3.4, 7.7, 23.1}) {
      OperatingPoint later = point;
      later.t = t;
      if (!(system.residual_at(later) <= 1e-9)) return false;
    }
    return true;
  }

  void keep(const Equilibrium& candidate) {
    if (candidate.family > 0) return families_.add(candidate);
    for (const Equilibrium& other : found_)
      if (distance(e_, sizes_, candidate.point, other.point) < same) return;
    found_.push_back(candidate);
  }

  std::vector<Equilibrium> all_found() const {
    std::vector<Equilibrium> out = families_.representatives(model_start());
    const auto families = static_cast<std::ptrdiff_t>(out.size());
    for (const Equilibrium& x : found_)  // unless it is the member that is told, where families cross
      if (std::none_of(out.begin(), out.begin() + families,
                       [&](const Equilibrium& y) { return distance(e_, sizes_, x.point, y.point) < same; }))
        out.push_back(x);
    return out;
  }

  // ---------------------------------------------------------------------------------------------- what is shown, and
  // where

  /// Newton's method may end anywhere, and a potential that repeats in a length has equilibria without end. A person
  /// means those about the start.
  bool is_far(const Equilibrium& x) const {
    for (std::size_t i = 0; i < e_.n; ++i)
      if (!e_.is_periodic[i] && !held(i) && std::abs(x.point.q[i] - search_.start.q[i]) > box * sizes_[i]) return true;
    return false;
  }

  /// How many were left out: none where all are far.
  std::size_t leave_out_far_ones(std::vector<Equilibrium>& found) const {
    std::vector<Equilibrium> near;
    for (const Equilibrium& x : found)
      if (!is_far(x)) near.push_back(x);
    if (near.empty()) return 0;
    const std::size_t outside = found.size() - near.size();
    found = std::move(near);
    return outside;
  }

  /// How far the start would have to be displaced; of equals the one with less energy.
  double displacement(const Equilibrium& x) const {
    double largest = 0;
    for (std::size_t i = 0; i < e_.n; ++i) {
      if (held(i)) continue;
      const double dq = x.point.q[i] - search_.start.q[i];
      largest = std::max(largest, std::abs(e_.is_periodic[i] ? std::remainder(dq, turn) : dq) / sizes_[i]);
    }
    return largest;
  }

  /// Rests before motions; of each the one nearest to the start, then by energy.
  void put_in_order(std::vector<Equilibrium>& found) const {
    std::stable_sort(found.begin(), found.end(), [&](const auto& x, const auto& y) { return before(x, y); });
    const auto moves = std::find_if(found.begin(), found.end(), [](const Equilibrium& x) { return !x.at_rest; });
    for (const auto& [begin, end] : {std::pair(found.begin(), moves), std::pair(moves, found.end())}) {
      auto nearest = begin;
      for (auto x = begin; x != end; ++x)
        if (displacement(*x) < displacement(*nearest) - same) nearest = x;
      if (nearest != end) std::rotate(begin, nearest, nearest + 1);
    }
  }

  bool before(const Equilibrium& x, const Equilibrium& y) const {
    if (x.at_rest != y.at_rest) return x.at_rest;
    const double ex = e_.energy_at(x.point), ey = e_.energy_at(y.point);
    if (std::abs(ex - ey) > 1e-9 * (std::abs(ex) + std::abs(ey))) return ex < ey;
    for (std::size_t i = 0; i < e_.n; ++i)
      if (std::abs(x.point.q[i] - y.point.q[i]) > same * sizes_[i]) return x.point.q[i] < y.point.q[i];
    return false;
  }

  const PointEquations& equations_;
  PointEquations::Impl& e_;
  const EquilibriumSearch& search_;
  std::vector<double> sizes_;
  std::vector<Translation> translations_;
  SecondNames second_names_;
  bool names_as_found_ = true;      // of a point that was asked for
  std::vector<Equilibrium> found_;  // those that stand alone
  Families families_;
};

void mark_failing_coordinates(const PointEquations& equations, std::vector<Equilibrium>& found) {
  for (Equilibrium& x : found) x.coordinates_fail = linearize(equations, x.point).singular;
}

}  // namespace

bool FixedValues::any() const {
  return std::find(q.begin(), q.end(), true) != q.end() || std::find(v.begin(), v.end(), true) != v.end();
}

namespace {

void check_search(const PointEquations& equations, const EquilibriumSearch& search) {
  const std::size_t n = equations.system().coordinates.size();
  const auto none_or_n = [&](const std::vector<bool>& list) { return list.empty() || list.size() == n; };
  check_argument(search.start.q.size() == n && search.start.v.size() == n,
                 "EquilibriumSearch: q or v of the start has another length than the system has coordinates");
  check_argument(none_or_n(search.fixed.q) && none_or_n(search.fixed.v),
                 "EquilibriumSearch: `fixed` has another length than the system has coordinates");
}

}  // namespace

EquilibriumSearchResult find_equilibria(const PointEquations& equations, const EquilibriumSearch& search) {
  check_search(equations, search);
  EquilibriumSearchResult result = Search(equations, search).all();
  mark_failing_coordinates(equations, result.found);
  return result;
}

std::vector<Equilibrium> equilibrium_near(const PointEquations& equations, const EquilibriumSearch& search) {
  check_search(equations, search);
  std::vector<Equilibrium> found = Search(equations, search).nearest();
  mark_failing_coordinates(equations, found);
  return found;
}

}  // namespace maupertuis
