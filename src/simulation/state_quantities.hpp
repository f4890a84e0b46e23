#pragma once
#include <maupertuis/close_evaluation.hpp>
#include <maupertuis/evaluate.hpp>
#include <maupertuis/simulation.hpp>

#include <optional>

namespace maupertuis {

/// Functions of q, q̇ and t at the states and rows of a run, with errors from those of q and q̇.
class StateQuantities {
 public:
  StateQuantities(const MechanicalSystem& system, const ExprVector& quantities);

  /// Of its states: [quantities] each, after those that are there.
  void put_into(SimulationResult& result);
  /// As further columns of rows, after those that are there; `all`: the same rows with q and q̇.
  void put_into(Trajectory& rows, const std::vector<Trajectory::Column>& columns, const Trajectory& all);

 private:
  /// Of single states; of rows, where rounding is in the errors.
  enum class Digits { All, OfDouble };
  /// `state`, `errors`: [q, q̇]; the errors may be missing. The values, then as many errors.
  std::vector<double> at(double t, const double* state, const double* errors, Digits digits);
  void put_into(State& state);

  const MechanicalSystem& system_;
  std::size_t count_;
  Bindings bindings_;
  ExprVector symbols_, slopes_;
  std::optional<CloseEvaluation> close_;
};

/// The rates that the model names, at the states of a run.
void add_rates(SimulationResult& result, const MechanicalSystem& system);

}  // namespace maupertuis
