#include "analysis/invariants/drift.hpp"

#include <maupertuis/interrupt_scope.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace maupertuis::invariants {
namespace {

constexpr int samples = 200;
constexpr std::size_t most_steps = 500'000;  // some seconds: a check beside the answer is not what one waits for

/// Σ term² of an integral written as a sum.
Expr sum_of_squares(Expr integral) {
  const Expr expanded = expand(integral);
  const Expr e = expanded ? expanded : integral;
  std::vector<Expr> squares;
  for (std::size_t i = 0; i < (e.is(Kind::Sum) ? e.size() : 1); ++i)
    squares.push_back(pow(e.is(Kind::Sum) ? e[i] : e, Rational(2)));
  return e.context().sum(squares);
}

double drift_of_column(const Probe& probe, std::size_t integral, std::size_t squares) {
  double low = std::numeric_limits<double>::infinity(), high = -low, largest = 0;
  for (const auto& row : probe.values) {
    if (row.empty()) continue;
    low = std::min(low, row[integral]);
    high = std::max(high, row[integral]);
    largest = std::max(largest, std::sqrt(row[squares]));
  }
  return largest > 0 ? (high - low) / largest : 0;
}

}  // namespace

void measure_drift(Invariants& result, const Model& model, const EquationsOfMotion& equations,
                   Diagnostics& diagnostics) {
  const Experiment& experiment = model.experiment;
  const Expr length = experiment.duration ? experiment.duration : experiment.within;
  if (!length || result.integrals.empty()) return;
  const auto number = [&](Expr e) {
    return evaluate(in_terms_of_motion(model.system, {&e, 1}).front(), parameter_bindings(model.system));
  };
  const double begin = experiment.start_time ? number(experiment.start_time) : 0, duration = number(length);
  SimulationOptions options;
  options.duration = duration;
  options.errors = ErrorEstimates::None;
  options.maximum_steps = most_steps;
  options.interrupt = interrupt_of(*model.system.context);
  for (int k = 0; k <= samples; ++k) options.at.push_back(begin + duration * k / samples);
  Probe probe;
  const std::size_t count = result.integrals.size();
  for (const ConservedFunction& integral : result.integrals) probe.expressions.push_back(integral.value);
  for (const ConservedFunction& integral : result.integrals)
    probe.expressions.push_back(sum_of_squares(integral.value));
  Diagnostics of_the_run;
  const auto run = simulate(model, equations, options, of_the_run, &probe);
  interrupt_of(*model.system.context).throw_if_asked();
  if (!run || !run->ok()) {
    diagnostics.warning(
        "W1004", {}, "the drift of the integrals was not measured",
        run ? "The run of the model ended before its time: " + run->reason + (run->reason.ends_with('.') ? "" : ".")
            : "The run of the model could not start.",
        "`maup simulate` says more; --no-drift leaves the run out.");
    return;
  }
  for (std::size_t i = 0; i < count; ++i) result.integrals[i].drift = drift_of_column(probe, i, count + i);
}

}  // namespace maupertuis::invariants
