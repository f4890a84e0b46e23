#pragma once
#include "simulation/observables.hpp"
#include "simulation/run_plan.hpp"

#include <maupertuis/extended_simulation.hpp>

namespace maupertuis {

/// The exact counterpart of a plan: what run_extended needs, and where its observables are.
struct ExtendedPlan {
  ExtendedProblem problem;
  std::vector<Expr> numbers;                // the observables of problem.numbers
  std::size_t end_index = 0;                // of the end among them
  std::vector<std::size_t> order_of_times;  // problem time → index in options.at
  std::size_t points = 0, reactions = 0;    // observables: energy, points, reactions
  double begin = 0;
};

ExtendedPlan plan_extended(const Model& model, const EquationsOfMotion& equations,
                           const ExtendedSimulationOptions& options, const RunPlan& plan,
                           const Observables& observables);

/// Whether a model with contacts and events can be run in many digits. E0725 where it cannot.
bool goes_in_many_digits(const Model& model, const EquationsOfMotion& equations, Diagnostics& diagnostics);

/// The kernel of constants.
Kernel kernel_of_numbers(const std::vector<Expr>& numbers);

}  // namespace maupertuis
