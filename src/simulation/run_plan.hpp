#pragma once
#include <maupertuis/simulation.hpp>

#include <optional>
#include <vector>

namespace maupertuis {

/// States that companions are compared with where no row is to have its errors: so many, about.
inline constexpr std::size_t usual_comparisons = 400;

/// Everything about a run that is known before its first step: numbers only, checked.
struct RunPlan {
  double begin = 0, end = 0;          // s; end < begin: backwards
  bool until = false;                 // stop at the event; not meeting it by `end` is a failure
  Expr condition;                     // the event: a function along the motion, forces of constraints written out
  std::vector<double> q, v;           // [n]
  bool even_rows = true;              // nothing between the output times
  double row_interval = 0;            // s, between even rows
  std::vector<double> output_times;   // in the order of the run, begin and end included
  std::vector<double> times_between;  // of states that companions are compared with where rows are few; in that order
};

/// Nothing, with a diagnostic, when the run has no length or a number is not finite.
std::optional<RunPlan> plan_run(const Model& model, const EquationsOfMotion& equations,
                                const SimulationOptions& options, Diagnostics& diagnostics);

/// Whether the times asked for lie on the way of the run; E0706 if not.
bool requests_lie_ahead(const MechanicalSystem& system, const RunPlan& plan, const SimulationOptions& options,
                        Diagnostics& diagnostics);

}  // namespace maupertuis
