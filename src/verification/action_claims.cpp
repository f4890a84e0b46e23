#include "verification/action_claims.hpp"

#include "verification/judge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

double number(const Model& model, Expr e) { return number_of(model.system, e); }

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

const StationaryPath* ActionClaims::path(int number, ExpectationResult& result) {
  if (!searched_) {
    searched_ = true;
    Diagnostics told;
    found_ = stationary_paths(model_, equations_, ends_of(model_), options_, told);
    if (!found_) trouble_ = first_trouble(told);
  }
  const std::size_t wanted = number > 0 ? static_cast<std::size_t>(number) : 1;
  if (found_ && wanted <= found_->paths.size()) return &found_->paths[wanted - 1];
  result.actual = found_
                      ? fmt::format("{} stationary path{}", found_->paths.size(), found_->paths.size() == 1 ? "" : "s")
                      : "no stationary path";
  result.message = found_ ? "There is no such path; " + found_->bound : trouble_;
  return nullptr;
}

std::string ActionClaims::among_others(int number) const {
  if (found_->paths.size() == 1) return {};
  return number > 1 ? fmt::format("; of {} paths, number {} by the action", found_->paths.size(), number)
                    : fmt::format("; of {} paths, the one with the smallest action", found_->paths.size());
}

void ActionClaims::decide(const expectation::Action& e, ExpectationResult& result) {
  const StationaryPath* stationary = path(e.path, result);
  if (!stationary) return;
  judge(e.expected, stationary->action, stationary->action_error,
        fmt::format("error about {:.1g}{}", stationary->action_error, among_others(e.path)), result);
}

void ActionClaims::decide(const expectation::PathAt& e, ExpectationResult& result) {
  const StationaryPath* stationary = path(e.path, result);
  if (!stationary) return;
  const double t = number(model_, e.time);
  if (!(t >= stationary->path.start && t <= stationary->path.end)) {
    result.message = "The path does not reach there.";
    return;
  }
  const auto value_at = [&](double when) { return value_on(stationary->path, when, e.subject, model_.system); };
  const double size = std::max(
      {std::abs(value_at(stationary->path.start)), std::abs(value_at(t)), std::abs(value_at(stationary->path.end))});
  judge(e.expected, value_at(t), stationary->path_error * size,
        fmt::format("error about {:.1g} of the size{}", stationary->path_error, among_others(e.path)), result);
}

void ActionClaims::decide(const expectation::ActionAlong& e, ExpectationResult& result) {
  std::optional<ActionEnds> ends;
  if (model_.experiment.path && !e.along.from) ends = ends_of(model_);
  const double start = e.along.from ? number(model_, e.along.from) : ends->start,
               end = e.along.to ? number(model_, e.along.to) : ends->end;
  Diagnostics told;
  const auto found = action_of_path(model_, equations_, e.along.q, start, end, ends, options_, told);
  if (!found) {
    result.actual = "no action";
    result.message = first_trouble(told);
    return;
  }
  judge(e.expected, found->action, found->action_error, fmt::format("error about {:.1g}", found->action_error), result);
}

void ActionClaims::decide(const expectation::MorseIndex& e, ExpectationResult& result) {
  const StationaryPath* p = path(e.path, result);
  if (!p) return;
  const double expected = number(model_, e.index);
  result.expected = fmt::format("{:g}", expected);
  result.actual = p->second.index ? std::to_string(*p->second.index) : "unknown";
  result.passed = p->second.index && static_cast<double>(*p->second.index) == expected;
  result.message = p->second.index ? "by inertia and by Jacobi fields" : p->second.reason;
}

/// `error`: by how much `actual` may be off. A hundred times what is allowed proves nothing, as of values of a run.
void ActionClaims::judge(const expectation::Number& expected, double actual, double error, const std::string& ground,
                         ExpectationResult& result) const {
  judge_number(expected, model_.system, actual, result);
  result.message += "; " + ground;
  constexpr double most = 100;
  const double allowed = allowed_difference(expected.tolerance, model_.system, number(model_, expected.value));
  if (result.passed && error > most * allowed) {
    result.passed = false;
    result.message += ", far more than the tolerance: it proves nothing";
  }
}

}  // namespace maupertuis
