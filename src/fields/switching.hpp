#pragma once
#include <maupertuis/evaluate.hpp>
#include <maupertuis/fields.hpp>

#include <optional>
#include <string>
#include <vector>

namespace maupertuis {

/// Moments between begin and end at which what is given at the sides (values, slopes, forces) goes over from one branch
/// to another: where a switch of the time alone changes its sign. Nothing where there are too many to stop at. Cost:
/// 20,000 evaluations a switch.
std::optional<std::vector<double>> switching_moments(const FieldEquations& equations, double begin, double end);

/// f with those branches of its switches of the time alone that hold from one moment to another.
Expr branches_between(Expr f, const FieldSystem& system, const Bindings& parameters, double from, double until);

/// Of a switching moment: what jumps there of what is given.
struct SwitchingBreak {
  Span span;
  double moment = 0;
  int derivative = 0;  // by t, of what is given
  int order = 0;       // of the derivative of the wave that jumps: one more for slopes and forces
  double before = 0, behind = 0;
};

/// The break of the lowest order; nothing where at most derivatives beyond the fourth jump.
std::optional<SwitchingBreak> lowest_break(const FieldEquations& equations, const std::vector<double>& moments,
                                           double begin, double end);

/// W0650: waves of every length run in from a side whose motion has a jump or a kink, or whose force jumps.
void warn_of_switching(const SwitchingBreak& found, Diagnostics& diagnostics);

}  // namespace maupertuis
