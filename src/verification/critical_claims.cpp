#include "verification/critical_claims.hpp"

#include "verification/judge.hpp"

#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/system_expressions.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace maupertuis {
namespace {

constexpr int samples = 24, grid_of_parts = 400;
constexpr std::size_t most_places = 100;

class Critical {
 public:
  Critical(const expectation::Stable& e, PointEquations& equations, const MotionState& start,
           const Experiment& experiment)
      : e_(e),
        equations_(equations),
        system_(equations.system()),
        start_(start),
        own_(equations.parameter(e.parameter)),
        value_(number_of(system_, e.critical.value)),
        tolerance_(allowed_difference(e.critical.tolerance, system_, value_)),
        sign_(e.above ? 1 : -1),
        reach_(reach(experiment)) {}
  ~Critical() { equations_.set_parameter(e_.parameter, own_); }
  Critical(const Critical&) = delete;
  Critical& operator=(const Critical&) = delete;

  void decide(ExpectationResult& result) {
    result.expected = sentence(value_);
    result.tolerance = tolerance_text(e_.critical.tolerance, e_.critical.unit, system_);
    const bool inside = holds(tolerance_), outside = holds(-tolerance_);
    if (outside && !inside) {
      result.actual = fmt::format("{} on the other side, {} {} {}", word(), system_.parameters[e_.parameter].name,
                                  e_.above ? "<" : ">", number(value_ + sign_ * bisected(-tolerance_, tolerance_)));
      result.message = fmt::format("It is not {} at {}.", word(), shown(tolerance_));
      return;
    }
    const std::optional<double> change =
        inside == outside ? change_elsewhere(inside) : std::optional(bisected(tolerance_, -tolerance_));
    if (!change) {
      result.actual = inside ? fmt::format("{} on both sides", word()) : fmt::format("not {} on either side", word());
      result.message = fmt::format("Looked at {} … {}.", shown(-reach_), shown(reach_));
      return;
    }
    result.actual = sentence(value_ + sign_ * *change);
    if (inside == outside) {
      result.message = "The stability changes elsewhere.";
      return;
    }
    const std::vector<double> looked_at = places();
    for (const double d : looked_at)
      if (!holds(d)) {
        result.message = fmt::format("It is not {} at {}.", word(), shown(d));
        return;
      }
    result.passed = true;
    result.message = fmt::format("changes at {}; the same verdict at {} values as far as {}", shown(*change),
                                 looked_at.size(), shown(reach_));
  }

 private:
  /// How far the side on which the verdict holds is looked at.
  double reach(const Experiment& experiment) const {
    double out = value_ != 0 ? std::abs(value_) : own_ != 0 ? std::abs(own_) : 1.0;
    if (experiment.sweep && experiment.sweep->parameter == e_.parameter)
      for (const Expr& end : {experiment.sweep->from, experiment.sweep->to})
        if (const double d = sign_ * (number_of(system_, end) - value_); d > tolerance_) return d;
    return std::max(out, 2 * tolerance_);
  }

  /// Distances from the critical value into that side; its far end, a vanishing mass perhaps, is left out.
  double sample(int k) const { return tolerance_ + (reach_ - tolerance_) * (k + 0.5) / samples; }

  /// The samples, and each place between them where a part of the formulas that depends on the parameter alone passes
  /// through 0: a window about 2.1337 that is narrower than the samples are apart stands there as Ω − 2.1337.
  std::vector<double> places() const {
    std::vector<double> out;
    for (int k = 0; k < samples; ++k) out.push_back(sample(k));
    const std::vector<Expr> parts = parts_of_parameter();
    if (parts.empty()) return out;
    Bindings at = parameter_bindings(system_);
    const auto values = [&](double distance) {
      at[system_.parameters[e_.parameter].symbol] = value_ + sign_ * distance;
      return evaluate(parts, at);
    };
    const auto grid = [&](int k) { return tolerance_ + (reach_ - tolerance_) * k / grid_of_parts; };
    std::vector<double> before = values(grid(0));
    for (int k = 1; k <= grid_of_parts && out.size() < most_places; ++k) {
      const std::vector<double> here = values(grid(k));
      for (std::size_t i = 0; i < parts.size(); ++i)
        if (before[i] * here[i] < 0) out.push_back(root(values, i, grid(k - 1), grid(k)));
      before = here;
    }
    return out;
  }

  template <class Values>
  static double root(Values values, std::size_t i, double low, double high) {
    const bool rises = values(high)[i] > 0;
    for (int k = 0; k < 60; ++k) {
      const double middle = low + (high - low) / 2;
      ((values(middle)[i] > 0) == rises ? high : low) = middle;
    }
    return low + (high - low) / 2;
  }

  /// The sums in the formulas of the model that depend on this parameter and on nothing that moves.
  std::vector<Expr> parts_of_parameter() const {
    std::vector<Expr> all, parts;
    MechanicalSystem formulas = system_;
    for_each_expression(formulas, [&](Expr& e) {
      if (e) all.push_back(e);
    });
    const Expr parameter = system_.parameters[e_.parameter].symbol;
    for (const Expr& node : topological_order(all)) {
      if (!node.is(Kind::Sum)) continue;
      const std::vector<Expr> symbols = symbols_of({&node, 1});
      const bool rests = std::all_of(symbols.begin(), symbols.end(), [](const Expr& s) {
        return s.role() == Role::Parameter || s.role() == Role::Constant;
      });
      if (rests && std::find(symbols.begin(), symbols.end(), parameter) != symbols.end()) parts.push_back(node);
    }
    return parts;
  }

  bool holds(double distance) {
    equations_.set_parameter(e_.parameter, value_ + sign_ * distance);
    Diagnostics unheard;
    const auto study = modal_study_at(equations_, start_, e_.at, unheard);
    if (!study || study->entries.empty() || !study->kinks.empty()) return false;
    return std::all_of(study->entries.begin(), study->entries.end(), [&](const ModalEntry& entry) {
      const Stability verdict = entry.analysis.stability.verdict;
      const bool stable = verdict != Stability::Unstable && verdict != Stability::Undecided;
      return e_.stable ? stable : verdict == Stability::Unstable;
    });
  }

  /// The verdict holds at `yes` and not at `no`.
  double bisected(double yes, double no) {
    for (int k = 0; k < 60; ++k) {
      const double middle = no + (yes - no) / 2;
      if (middle == yes || middle == no) break;
      (holds(middle) ? yes : no) = middle;
    }
    return no + (yes - no) / 2;
  }

  /// Both ends of the tolerance have one verdict: the nearest change among the samples of the side where it should be.
  std::optional<double> change_elsewhere(bool holds_here) {
    const double side = holds_here ? -1 : 1;
    double last = side * tolerance_;
    for (int k = 0; k < samples; ++k) {
      const double d = side * sample(k);
      if (holds(d) != holds_here) return holds_here ? bisected(last, d) : bisected(d, last);
      last = d;
    }
    return std::nullopt;
  }

  const char* word() const { return e_.stable ? "stable" : "unstable"; }
  std::string number(double value) const {
    return fmt::format("{:.10g}{}", value / e_.critical.unit.factor, unit_after(e_.critical.unit));
  }
  std::string shown(double distance) const {
    return fmt::format("{} = {}", system_.parameters[e_.parameter].name, number(value_ + sign_ * distance));
  }
  std::string sentence(double critical) const {
    return fmt::format("{} for {} {} {}", word(), system_.parameters[e_.parameter].name, e_.above ? ">" : "<",
                       number(critical));
  }

  const expectation::Stable& e_;
  PointEquations& equations_;
  const MechanicalSystem& system_;
  const MotionState& start_;
  double own_, value_, tolerance_, sign_, reach_;
};

}  // namespace

void decide_critical(const expectation::Stable& e, PointEquations& equations, const MotionState& start,
                     ExpectationResult& result, const Experiment& experiment) {
  Critical(e, equations, start, experiment).decide(result);
}

}  // namespace maupertuis
