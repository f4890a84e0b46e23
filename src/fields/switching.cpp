#include "fields/switching.hpp"

#include <maupertuis/repeated_evaluation.hpp>
#include <maupertuis/switches.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

constexpr int samples = 20'000;
constexpr std::size_t most_moments = 10'000;

/// What is given at a side, and which derivative of a wave jumps where it does.
struct Given {
  Expr value;
  Span span;
  int order;
};

std::vector<Given> given_at_sides(const FieldEquations& equations) {
  const FieldSystem& s = equations.system();
  std::vector<Given> out;
  for (const BoundaryCondition& b : s.boundary)
    if (b.value) out.push_back({s.expanded(b.value), b.span, b.jet.order()});
  for (const EndForce& f : s.end_forces) out.push_back({s.expanded(f.value), f.span, 1});
  return out;
}

bool is_of_time_alone(Expr g, const FieldSystem& s, const Bindings& parameters) {
  bool holds_time = false;
  for (const Expr& symbol : symbols_of({&g, 1})) {
    const bool time = symbol == s.context->time();
    if (!time && !parameters.count(symbol)) return false;
    holds_time = holds_time || time;
  }
  return holds_time;
}

class OfTime {
 public:
  OfTime(Expr f, Expr time, const Bindings& parameters) : at_({&f, 1}), time_(time), parameters_(parameters) {}
  double operator()(double t) const {
    return at_([&](Expr symbol) { return symbol == time_ ? t : parameters_.at(symbol); }).front();
  }

 private:
  RepeatedEvaluation at_;
  Expr time_;
  const Bindings& parameters_;
};

int sign_of(double x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }

/// The first moment at which g has no longer the sign that it has at `a`.
double first_change(const OfTime& g, double a, double b) {
  const int before = sign_of(g(a));
  for (double middle = a + (b - a) / 2; middle > a && middle < b; middle = a + (b - a) / 2)
    (sign_of(g(middle)) == before ? a : b) = middle;
  return b;
}

void add_changes(const OfTime& g, double begin, double end, std::vector<double>& out) {
  double last = begin;
  int sign = sign_of(g(begin));
  for (int i = 1; i <= samples; ++i) {
    const double t = begin + (end - begin) * i / samples;
    const int now = sign_of(g(t));
    if (now != 0 && sign != 0 && now != sign) out.push_back(first_change(g, last, t));
    if (now != 0) sign = now, last = t;
  }
}

Bindings parameters_of(const FieldEquations& equations) {
  Bindings out;
  for (const Parameter& p : equations.model->parameters) out[p.symbol] = p.si_value;
  return out;
}

/// A jump of derivative k that is more than rounding of terms of the size of the function.
bool is_jump(double before, double behind, double size, double duration, int k) {
  constexpr double rounding = 1e-9;
  return std::abs(behind - before) >
         rounding * std::max({std::abs(before), std::abs(behind), size / std::pow(duration, k)});
}

double size_of(const OfTime& f, double begin, double end) {
  constexpr int places = 64;
  double out = 0;
  for (int i = 0; i <= places; ++i) out = std::max(out, std::abs(f(begin + (end - begin) * i / places)));
  return std::isfinite(out) ? out : 0;
}

}  // namespace

std::optional<std::vector<double>> switching_moments(const FieldEquations& equations, double begin, double end) {
  const FieldSystem& s = equations.system();
  const Bindings parameters = parameters_of(equations);
  std::vector<Expr> values;
  for (const Given& one : given_at_sides(equations)) values.push_back(one.value);
  std::vector<double> all, out;
  for (const Expr& g : switches_of(values))
    if (is_of_time_alone(g, s, parameters)) add_changes(OfTime(g, s.context->time(), parameters), begin, end, all);
  if (all.size() > most_moments) return std::nullopt;
  std::sort(all.begin(), all.end());
  const double near = 1e-13 * std::max({std::abs(begin), std::abs(end), end - begin});
  for (const double t : all)
    if (t - (out.empty() ? begin : out.back()) > near && end - t > near) out.push_back(t);
  return out;
}

Expr branches_between(Expr f, const FieldSystem& system, const Bindings& parameters, double from, double until) {
  Bindings at = parameters;
  at[system.context->time()] = from + (until - from) / 2;
  for (const Expr& g : switches_of({&f, 1}))
    if (is_of_time_alone(g, system, parameters)) f = on_side({&f, 1}, g, evaluate(g, at) > 0).front();
  return f;
}

std::optional<SwitchingBreak> lowest_break(const FieldEquations& equations, const std::vector<double>& moments,
                                           double begin, double end) {
  constexpr int highest = 4;
  const FieldSystem& s = equations.system();
  const Bindings parameters = parameters_of(equations);
  const Expr time = s.context->time();
  std::optional<SwitchingBreak> out;
  for (const Given& given : given_at_sides(equations))
    for (std::size_t i = 0; i < moments.size(); ++i) {
      const double t = moments[i], next = i + 1 < moments.size() ? moments[i + 1] : end;
      Expr before = branches_between(given.value, s, parameters, i > 0 ? moments[i - 1] : begin, t),
           behind = branches_between(given.value, s, parameters, t, next);
      ExprMap fixed;  // along a side, a little off what is symmetric
      for (const SpaceVariable& x : s.space)
        fixed.emplace(x.symbol, s.expanded(x.from) + Rational(37, 100) * (s.expanded(x.to) - s.expanded(x.from)));
      before = substitute(before, fixed), behind = substitute(behind, fixed);
      if (before == behind) continue;
      const double size = std::max(size_of(OfTime(before, time, parameters), begin, t),
                                   size_of(OfTime(behind, time, parameters), t, end));
      for (int k = 0; k + given.order <= highest && (!out || k + given.order < out->order); ++k) {
        const double a = OfTime(before, time, parameters)(t), b = OfTime(behind, time, parameters)(t);
        if (is_jump(a, b, size, end - begin, k)) out = SwitchingBreak{given.span, t, k, k + given.order, a, b};
        before = differentiate(before, time), behind = differentiate(behind, time);
      }
    }
  return out;
}

void warn_of_switching(const SwitchingBreak& found, Diagnostics& diagnostics) {
  diagnostics.warning(
      "W0650", found.span,
      fmt::format("what is given has a {} at t = {:.6g} s: {} goes from {:.6g} to {:.6g} (SI units)",
                  found.derivative == 0 ? "jump" : "kink", found.moment, found.derivative == 0 ? "it" : "its rate",
                  found.before, found.behind),
      "Steps end there and the side is followed, but waves of every length run in from it, and a mesh follows the long "
      "ones alone: values converge slowly.",
      "Round it over the time that waves take through some cells where digits count.");
}

}  // namespace maupertuis
