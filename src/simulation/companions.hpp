#pragma once
#include "simulation/close_observables.hpp"
#include "simulation/method.hpp"
#include "simulation/mode_library.hpp"
#include "simulation/observables.hpp"
#include "simulation/rounded_numbers.hpp"

#include <optional>
#include <vector>

/// Runs of the same motion beside the one that counts: other orders, other steps, numbers rounded the other way. What
/// they differ by tells how much of a result is known (docs/design/certain_digits.md).
namespace maupertuis {

/// States of the run at RunPlan::times_between, as far as it came.
struct StatesBetween {
  std::vector<double> times, values;  // [times], [times × 2n]: q, q'
};

/// How far observables [observables] may be off by the rounding of their formulas alone.
struct Roundings {
  std::vector<std::vector<double>> at;  // [options.at]; empty where the run did not come to
  std::vector<double> final;
};

/// What a companion is to follow: the run, and where it is looked at.
struct CompanionPlan {
  const Model& model;
  const EquationsOfMotion& equations;
  const SimulationOptions& options;
  const RunPlan& run;
  const Observables& observables;
  const CloseObservables& close;
  const Roundings& roundings;
  const SimulationResult& result;  // of the run that counts
  const StatesBetween& between;
  std::vector<std::size_t> grid;         // what is compared, in the order of the run: row i of the trajectory, or
                                         // state k between its rows as rows() + k
  bool whole_rows = false;               // all their columns, else q and q' alone
  std::shared_ptr<ModeLibrary> modes{};  // of the run, where it goes through modes
  std::vector<double> accelerations{};   // [n] then: the largest, also of forces that balance

  bool is_row(std::size_t g) const { return grid[g] < result.trajectory.rows(); }
  double time(std::size_t g) const {
    return is_row(g) ? result.trajectory.times[grid[g]] : between.times[grid[g] - result.trajectory.rows()];
  }
  /// Of the run. Precondition: c < columns(); whole rows have no states between them.
  double value(std::size_t g, std::size_t c) const {
    return is_row(g) ? result.trajectory.at(grid[g], c)
                     : between.values[(grid[g] - result.trajectory.rows()) * 2 * run.q.size() + c];
  }
  /// Where companions are asked for the state at t: where t is no short number in binary, 1000.1 s, it was rounded as
  /// any other number, and each looks one unit in the last place before it.
  double looked_at(double t) const;
  std::size_t columns() const { return whole_rows ? result.trajectory.columns.size() : 2 * run.q.size(); }
};

/// What one companion left.
struct CompanionRun {
  std::vector<double> rows;  // [grid × columns]; NaN at times that it did not come to; empty once they are added up
  std::vector<Happening> happenings;
  std::vector<Sample> at;  // [options.at]; q is empty where it did not come to
  std::optional<Sample>
      final;  // at the end of the run that counts, or where it met the condition of `run until` itself
};

struct Companions {
  std::vector<CompanionRun> runs;
  std::vector<double> squares;  // [grid × columns] of the differences, of all runs; infinite where one had no value
  /// [grid × columns] what the two of the variational method differ by; else empty. With a step that is short enough
  /// shorter ones come to the same motion: it is a small part of what they differ from the run by.
  std::vector<double> between;
  double factor = 3;            // the error is so many times the root of the mean square of the differences
  bool running_maximum = true;  // and the largest of these so far
  bool interrupted = false;
};

/// Up to 4 unknowns, and where the kernel fits into lanes, seven side by side; else three, one after the other; of the
/// stiff and the variational method two, with tolerances or steps several times smaller. Cost: seven in lanes about
/// that of the run; else that of the run each, two to three times that for finer steps.
Companions run_companions(const CompanionPlan& plan, const WantedFunctions& wanted, const RoundedNumbers& numbers);

}  // namespace maupertuis
