#include "analysis/linearization/point_equations.hpp"

#include <maupertuis/locus.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace maupertuis {
namespace {

constexpr double longest_step = 1.0 / 3;  // of typical sizes

class Tracer {
 public:
  Tracer(PointEquations& equations, const MotionState& start, std::size_t parameter)
      : equations_(equations), start_(start), parameter_(parameter), sizes_(typical_sizes(equations.system(), start)) {
    locus_.parameter = parameter;
  }

  Locus trace(double from, double to, std::size_t steps) {
    for (std::size_t i = 0; i < steps; ++i) {
      const double value = from + (to - from) * static_cast<double>(i) / static_cast<double>(steps - 1);
      locus_.values.push_back(value);
      set_parameter(value);
      note_translations(i == 0);
      join(points_at(value));
    }
    find_changes();
    join_births();
    return std::move(locus_);
  }

 private:
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

  LocusPoint judged(double value, const Equilibrium& x) const {
    const Linearization l = linearize(equations_, x.point).linearization;
    const ModalAnalysis analysis = modal_analysis(equations_, l, symmetries_, &x);
    return {value, x, analysis.stability, analysis.eigenvalues};
  }

  std::vector<LocusPoint> points_at(double value) {
    EquilibriumSearch search;
    search.start = start_;
    for (const std::size_t b : open_) search.guesses.push_back(locus_.branches[b].points.back().equilibrium.point);
    std::vector<LocusPoint> out;
    for (const Equilibrium& x : find_equilibria(equations_, search).found)
      if (!x.coordinates_fail) out.push_back(judged(value, x));
    return out;
  }

  double distance(const Equilibrium& x, const Equilibrium& y) const {
    if (x.at_rest != y.at_rest) return HUGE_VAL;
    double out = 0;
    for (std::size_t i = 0; i < x.point.q.size(); ++i) {
      double dq = x.point.q[i] - y.point.q[i];
      if (equations_.periodic()[i]) dq = std::remainder(dq, 2 * std::numbers::pi);
      out = std::max(out, std::abs(dq) / sizes_[i]);
    }
    return out;
  }

  /// Nearest pairs of branch ends and new points first; what is left over begins branches, or ends them.
  void join(std::vector<LocusPoint> points) {
    struct Pair {
      double distance;
      std::size_t branch, point;
    };
    std::vector<Pair> pairs;
    for (const std::size_t b : open_)
      for (std::size_t p = 0; p < points.size(); ++p)
        if (const double d = distance(locus_.branches[b].points.back().equilibrium, points[p].equilibrium);
            d <= longest_step)
          pairs.push_back({d, b, p});
    std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& x, const Pair& y) { return x.distance < y.distance; });
    std::vector<std::size_t> still_open;
    std::vector<bool> placed(points.size(), false);
    for (const Pair& pair : pairs) {
      if (placed[pair.point] || std::find(still_open.begin(), still_open.end(), pair.branch) != still_open.end())
        continue;
      placed[pair.point] = true;
      locus_.branches[pair.branch].points.push_back(points[pair.point]);
      still_open.push_back(pair.branch);
    }
    for (std::size_t p = 0; p < points.size(); ++p) {
      if (placed[p]) continue;
      still_open.push_back(locus_.branches.size());
      locus_.branches.push_back({{points[p]}});
    }
    std::sort(still_open.begin(), still_open.end());
    open_ = std::move(still_open);
  }

  // ---------------------------------------------------------------------------------------------------- changes of
  // verdict

  /// The equilibrium of a branch near a guess, at any value of the parameter.
  std::optional<LocusPoint> follow(double value, const Equilibrium& guess) {
    set_parameter(value);
    EquilibriumSearch search;
    search.start = {guess.point.t, guess.point.q, start_.v};
    search.steady = !guess.at_rest;
    for (const Equilibrium& x : equilibrium_near(equations_, search))
      if (x.at_rest == guess.at_rest && !x.coordinates_fail && distance(x, guess) <= longest_step)
        return judged(value, x);
    return std::nullopt;
  }

  void find_changes() {
    for (std::size_t b = 0; b < locus_.branches.size(); ++b) {
      const auto points = locus_.branches[b].points;
      for (std::size_t i = 1; i < points.size(); ++i)
        if (points[i].stability.verdict != points[i - 1].stability.verdict) bisect(b, points[i - 1], points[i]);
    }
    std::stable_sort(locus_.changes.begin(), locus_.changes.end(),
                     [](const auto& x, const auto& y) { return x.parameter < y.parameter; });
  }

  /// A value of the sweep can stand on the change itself, with a verdict of its own: the ends decide.
  void bisect(std::size_t branch, LocusPoint low, LocusPoint high) {
    const Stability before = low.stability.verdict, after = high.stability.verdict;
    for (int k = 0; k < 60; ++k) {
      const double middle = low.parameter + (high.parameter - low.parameter) / 2;
      if (middle == low.parameter || middle == high.parameter) break;
      const auto point = follow(middle, low.equilibrium);
      if (!point) break;
      (point->stability.verdict == before ? low : high) = *point;
    }
    locus_.changes.push_back({(low.parameter + high.parameter) / 2, branch, before, after});
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

  double step() const { return locus_.values[1] - locus_.values[0]; }
  /// x in (y − step, y) in the direction of the sweep.
  bool is_before(double x, double y) const {
    const double along = (y - x) / step();
    return along > 0 && along <= 1;
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
  std::vector<double> sizes_;
  std::vector<Translation> symmetries_;  // at the present value
  std::vector<std::size_t> open_;        // branches that have a point at the last value
  Locus locus_;
};

}  // namespace

Locus parameter_locus(PointEquations& equations, const MotionState& start, std::size_t parameter, double from,
                      double to, std::size_t steps) {
  const double own = equations.parameter(parameter);
  Locus out = Tracer(equations, start, parameter).trace(from, to, steps);
  equations.set_parameter(parameter, own);
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
