#include "verification/action_claims.hpp"

#include <fmt/format.h>

#include <cmath>

namespace maupertuis {
namespace {

using Asked = syntax::ExpectStatement::Kind;

double number(const Model& model, Expr e) {
  return evaluate(in_terms_of_motion(model.system, {&e, 1}).front(), parameter_bindings(model.system));
}

std::string first_trouble(const Diagnostics& told) {
  for (const Diagnostic& d : told.items())
    if (d.severity == Severity::Error) return d.message + ". " + d.reason;
  return "Nothing was found.";
}

/// The value of a subject in q, q', t on a path.
double value_on(const ActionPath& path, double t, Expr subject, const MechanicalSystem& system) {
  const MotionState s = path.at(t);
  Bindings bindings = parameter_bindings(system);
  bindings[system.context->time()] = t;
  for (std::size_t i = 0; i < system.coordinates.size(); ++i) {
    bindings[system.coordinates[i].q] = s.q[i];
    bindings[system.coordinates[i].velocity] = s.v[i];
  }
  return evaluate(expand_time_derivatives(in_terms_of_motion(system, {&subject, 1})).front(), bindings);
}

}  // namespace

const StationaryPath* ActionClaims::path(ExpectationResult& result) {
  if (!searched_) {
    searched_ = true;
    Diagnostics told;
    found_ = stationary_paths(model_, equations_, ends_of(model_), options_, told);
    if (!found_) trouble_ = first_trouble(told);
  }
  if (found_) return &found_->paths.front();
  result.actual = "no stationary path";
  result.message = trouble_;
  return nullptr;
}

void ActionClaims::decide(const Expectation& e, ExpectationResult& result) {
  if (e.kind == Asked::Action && !e.values.empty()) return decide_given(e, result);
  const StationaryPath* stationary = path(result);
  if (!stationary) return;
  if (e.kind == Asked::MorseIndex) return decide_index(e, *stationary, result);
  const std::string among = found_->paths.size() == 1 ? "" : fmt::format("; of {} paths, the one with the smallest action", found_->paths.size());
  if (e.kind == Asked::Action)
    return judge(e, stationary->action, fmt::format("error about {:.1g}{}", stationary->action_error, among), result);
  const double t = number(model_, e.time);
  if (!(t >= stationary->path.start && t <= stationary->path.end)) {
    result.message = "The path does not reach there.";
    return;
  }
  judge(e, value_on(stationary->path, t, e.subject, model_.system), fmt::format("error about {:.1g} of the size{}", stationary->path_error, among), result);
}

void ActionClaims::decide_given(const Expectation& e, ExpectationResult& result) {
  std::optional<ActionEnds> ends;
  if (model_.experiment.path && !e.from) ends = ends_of(model_);
  Diagnostics told;
  const double start = e.from ? number(model_, e.from) : ends->start, end = e.to ? number(model_, e.to) : ends->end;
  const auto found = action_of_path(model_, equations_, e.values, start, end, ends, options_, told);
  if (!found) {
    result.actual = "no action";
    result.message = first_trouble(told);
    return;
  }
  judge(e, found->action, fmt::format("error about {:.1g}", found->action_error), result);
}

void ActionClaims::decide_index(const Expectation& e, const StationaryPath& p, ExpectationResult& result) const {
  const double expected = number(model_, e.value);
  result.expected = fmt::format("{:g}", expected);
  result.actual = p.second.index ? std::to_string(*p.second.index) : "unknown";
  result.passed = p.second.index && static_cast<double>(*p.second.index) == expected;
  result.message = p.second.index ? "by inertia and by Jacobi fields" : p.second.reason;
}

void ActionClaims::judge(const Expectation& e, double actual, const std::string& ground, ExpectationResult& result) const {
  const double expected = number(model_, e.value);
  const double tolerance = !e.tolerance ? 1e-9 * std::abs(expected) : number(model_, e.tolerance) * (e.relative ? std::abs(expected) : 1.0);
  const std::string unit = e.display_unit.empty() ? "" : " " + e.display_unit;
  result.actual = fmt::format("{:.17g}{}", actual / e.display_factor, unit);
  result.expected = fmt::format("{:.17g}{}", expected / e.display_factor, unit);
  result.tolerance = e.relative ? fmt::format("rel {:g}", number(model_, e.tolerance)) : fmt::format("± {:g}{}", tolerance / e.display_factor, unit);
  const double error = std::abs(actual - expected);
  result.passed = error <= tolerance;
  result.message = fmt::format("off by {:.2g}{}; {}", error / e.display_factor, unit, ground);
}

}  // namespace maupertuis
