#include "comparison/cross_check.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis::comparison {
namespace {

constexpr int samples = 50;
constexpr double default_duration = 1;  // s, where no model has a run
constexpr double clearly_different = 1e-6, rounding = 1e-9;

/// The model with another start, and nothing that ends its run.
Model started_at(const Model& model, double t, const std::vector<double>& q, const std::vector<double>& v) {
  Model out = model;
  Context& context = *model.system.context;
  const auto number = [&](double x) { return context.number(Rational::from_double(x)); };
  out.experiment.start.clear();
  out.experiment.start_conditions.clear();
  out.experiment.start_exactly = false;
  out.experiment.until = out.experiment.within = Expr();
  out.experiment.start_time = number(t);
  for (std::size_t i = 0; i < q.size(); ++i) {
    const Coordinate& c = model.system.coordinates[i];
    // A span other than the coordinate's own tells that the value is given.
    const Span given{c.span.begin, c.span.end + 1};
    out.experiment.start.push_back({i, 0, number(q[i]), given, {}});
    out.experiment.start.push_back({i, 1, number(v[i]), given, {}});
  }
  return out;
}

bool finite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); });
}

std::optional<SimulationResult> simulate_from(const Model& model, const EquationsOfMotion& equations,
                                              const MotionState& state, const SimulationOptions& options) {
  if (!finite(state.q) || !finite(state.v)) return std::nullopt;
  Diagnostics silent;
  return simulate(started_at(model, state.t, state.q, state.v), equations, options, silent);
}

}  // namespace

std::optional<SimulationResult> CrossCheck::run_b(const MotionState& state, const SimulationOptions& options) const {
  return simulate_from(b_, b_equations_, state, options);
}

std::optional<SimulationResult> CrossCheck::run_a(const MotionState& b_state, const SimulationOptions& options) const {
  const Bindings at = motions_.at(b_state);
  return simulate_from(a_, a_equations_,
                       {b_state.t, evaluate(pull_back_.positions(), at), evaluate(pull_back_.velocities(), at)},
                       options);
}

std::optional<double> CrossCheck::duration() const {
  if (options_.duration) return options_.duration;
  std::optional<double> shortest;
  for (const Model* model : {&a_, &b_}) {
    const Expr written = model->experiment.duration ? model->experiment.duration : model->experiment.within;
    if (!written) continue;
    const double length =
        evaluate(in_terms_of_motion(model->system, {&written, 1}).front(), parameter_bindings(model->system));
    shortest = shortest ? std::min(*shortest, length) : length;
  }
  return shortest;
}

/// Angles by inverse functions come back to their branch: whole turns do not count.
double CrossCheck::apart(std::size_t coordinate, double x, double y) const {
  const bool angle = a_.system.coordinates[coordinate].dimension == dimensions::angle();
  return angle ? std::remainder(x - y, 2 * std::acos(-1.0)) : x - y;
}

std::vector<double> CrossCheck::common_scale(std::vector<double> sizes) const {
  const auto& coordinates = a_.system.coordinates;
  std::vector<double> out = sizes;
  for (std::size_t i = 0; i < sizes.size(); ++i)
    for (std::size_t k = 0; k < sizes.size(); ++k)
      if (coordinates[i].dimension.same_as(coordinates[k].dimension)) out[i] = std::max(out[i], sizes[k]);
  return out;
}

maupertuis::CrossCheck CrossCheck::run() const {
  maupertuis::CrossCheck out;
  if (motions_.states().empty()) {
    out.reason = "the second model has no consistent start";
    return out;
  }
  // The start, unless the map is singular there.
  for (const MotionState& start : motions_.states())
    if (run_from(start, out)) break;
  return out;
}

/// False where one of them cannot start there.
bool CrossCheck::run_from(const MotionState& start, maupertuis::CrossCheck& out) const {
  SimulationOptions options = options_;
  options.errors = ErrorEstimates::None;
  options.duration = duration().value_or(default_duration);
  options.at.clear();
  for (int k = 1; k <= samples; ++k) options.at.push_back(start.t + *options.duration * k / samples);
  const auto of_b = run_b(start, options);
  const auto of_a = of_b ? run_a(start, options) : std::nullopt;
  if (!of_a || !of_b) {
    out.reason = of_b ? "the first model could not start at the mapped state" : "the second model could not start";
    return false;
  }
  out = {};
  const std::size_t n = a_.system.coordinates.size();
  std::vector<std::vector<double>> mapped, own;
  std::vector<double> sizes(n, 0), times;
  for (std::size_t k = 0; k < options.at.size(); ++k) {
    if (of_a->at[k].q.empty() || of_b->at[k].q.empty()) break;
    mapped.push_back(evaluate(pull_back_.positions(), motions_.at({of_b->at[k].t, of_b->at[k].q, of_b->at[k].v})));
    own.push_back(of_a->at[k].q);
    times.push_back(options.at[k]);
    for (std::size_t i = 0; i < n; ++i)
      sizes[i] = std::max({sizes[i], std::abs(mapped.back()[i]), std::abs(own.back()[i])});
  }
  if (!of_b->ok()) out.reason = "the second model: " + of_b->reason;
  if (!of_a->ok()) out.reason = "the first model: " + of_a->reason;
  out.ran = !times.empty();
  out.duration = times.empty() ? 0 : times.back() - start.t;
  const std::vector<double> scale = common_scale(sizes);
  for (std::size_t k = 0; k < times.size(); ++k)
    for (std::size_t i = 0; i < n; ++i) {
      const double difference = scale[i] > 0 ? std::abs(apart(i, mapped[k][i], own[k][i])) / scale[i] : 0;
      if (!(difference > out.difference)) continue;
      out.difference = difference;
      out.coordinate = i;
      out.time = times[k];
    }
  return true;
}

std::optional<Disagreement> CrossCheck::disagreement(const std::vector<MotionState>& further) const {
  std::optional<Disagreement> best;
  double largest = rounding;
  SimulationOptions options = options_;
  options.errors = ErrorEstimates::None;
  options.duration = 0;
  options.at.clear();
  std::vector<MotionState> states = motions_.states();
  states.insert(states.end(), further.begin(), further.end());
  for (const MotionState& state : states) {
    const auto of_b = run_b(state, options);
    const auto of_a = of_b ? run_a(state, options) : std::nullopt;
    if (!of_a || !of_b || !finite(of_a->start.a) || !finite(of_b->start.a) || of_a->start.a.empty()) continue;
    Bindings at = motions_.at(state);
    for (std::size_t i = 0; i < of_b->start.a.size(); ++i) at[b_.system.coordinates[i].acceleration] = of_b->start.a[i];
    const std::vector<double> mapped = evaluate(pull_back_.accelerations(), at);
    std::vector<double> sizes;
    for (std::size_t i = 0; i < mapped.size(); ++i)
      sizes.push_back(std::max(std::abs(mapped[i]), std::abs(of_a->start.a[i])));
    const std::vector<double> scale = common_scale(sizes);
    for (std::size_t i = 0; i < mapped.size(); ++i) {
      const double difference = scale[i] > 0 ? std::abs(mapped[i] - of_a->start.a[i]) / scale[i] : 0;
      if (difference <= largest) continue;
      largest = difference;
      best = Disagreement{state, i, of_a->start.a[i], mapped[i]};
    }
    if (largest > clearly_different) break;
  }
  return best;
}

}  // namespace maupertuis::comparison
