#include "verification/critical_claims.hpp"

#include "verification/judge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace maupertuis {
namespace {

constexpr int samples = 24;

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
    for (int k = 0; k < samples; ++k)
      if (const double d = sample(k); !holds(d)) {
        result.message = fmt::format("It is not {} at {}.", word(), shown(d));
        return;
      }
    result.passed = true;
    result.message = fmt::format("changes at {}; the same verdict at {} values as far as {}", shown(*change), samples,
                                 shown(reach_));
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

  bool holds(double distance) {
    equations_.set_parameter(e_.parameter, value_ + sign_ * distance);
    Diagnostics unheard;
    const auto study = modal_study_at(equations_, start_, e_.at, unheard);
    if (!study || study->entries.empty() || !study->kinks.empty()) return false;
    return std::all_of(study->entries.begin(), study->entries.end(), [&](const ModalEntry& entry) {
      const Stability verdict = entry.analysis.stability.verdict;
      const bool stable = verdict == Stability::Energetic || verdict == Stability::Asymptotic;
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
