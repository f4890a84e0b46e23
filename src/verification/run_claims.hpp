#pragma once
#include "verification/extended_claims.hpp"

#include <maupertuis/simulation.hpp>
#include <maupertuis/verification.hpp>

#include <optional>
#include <span>
#include <vector>

namespace maupertuis {

/// What the model's own motion decides: values at times, when `run until` is over, drifts along the run. All lines are
/// gathered first, so that each direction of time is run once.
class RunClaims {
 public:
  RunClaims(const Model& model, const EquationsOfMotion& equations, const SimulationOptions& options,
            Diagnostics& diagnostics)
      : model_(model), equations_(equations), options_(options), diagnostics_(diagnostics) {}

  /// `line`: the index of its result. Precondition: the expectation outlives this.
  void ask(const expectation::ValueAt& expectation, std::size_t line) { timed_.push_back({&expectation, line}); }
  void ask(const expectation::ValueAtUntil& expectation, std::size_t line) {
    ends_.push_back({line, &expectation.expected, expectation.subject});
  }
  void ask(const expectation::UntilAt& expectation, std::size_t line) {
    ends_.push_back({line, &expectation.expected, {}});
  }
  void ask(const expectation::ConservedAlongRun& expectation, std::size_t line) {
    drifts_.push_back({line, &expectation});
  }
  void ask(const expectation::EnergyConserved& expectation, std::size_t line) {
    energies_.push_back({line, &expectation});
  }

  void ask(const expectation::Event& expectation, std::size_t line) { events_.push_back({line, &expectation}); }
  void ask(const expectation::EventCount& expectation, std::size_t line) { counts_.push_back({line, &expectation}); }

  void carry_out(std::vector<ExpectationResult>& results);

 private:
  struct Value {
    std::size_t line;
    const expectation::Number* expected;
    Expr subject;
    double time;
  };
  /// Where a run has the answer to a line: at which of the times asked, in which of the formulas.
  struct Cell {
    std::size_t row, column;
  };
  struct End {
    std::size_t line;
    const expectation::Number* expected;
    Expr subject;  // empty: the time itself
  };
  struct Drift {
    std::size_t line;
    const expectation::ConservedAlongRun* expectation;
  };
  struct Energy {
    std::size_t line;
    const expectation::EnergyConserved* expectation;
  };

  struct Event {
    std::size_t line;
    const expectation::Event* expectation;
  };
  struct EventCount {
    std::size_t line;
    const expectation::EventCount* expectation;
  };

  double number(Expr e, double otherwise = 0) const;
  bool watches_whole_run() const;
  void take_timed(std::vector<ExpectationResult>& results);
  void find_end(std::vector<ExpectationResult>& results);
  void run_direction(bool forwards, std::vector<ExpectationResult>& results);
  std::vector<double> samples() const;
  std::size_t run_once(std::span<const Value> values, bool whole_run, Diagnostics& diagnostics,
                       std::vector<ExpectationResult>& results);
  std::vector<Cell> ask_once(std::span<const Value> values, Probe& probe, std::vector<double>& times) const;
  void judge_value_at(const Value& value, const Cell& cell, const std::optional<SimulationResult>& run,
                      const Probe& probe, std::vector<ExpectationResult>& results) const;
  void judge_value(const expectation::Number& expected, double actual, double uncertainty,
                   ExpectationResult& result) const;
  void judge_drift(const Drift& drift, std::size_t column, const std::optional<SimulationResult>& run,
                   const Probe& probe, ExpectationResult& result) const;
  void judge_event(const Event& event, const std::optional<SimulationResult>& run, ExpectationResult& result) const;
  void judge_count(const EventCount& count, const std::optional<SimulationResult>& run,
                   ExpectationResult& result) const;
  void judge_energy(const Energy& energy, const std::optional<SimulationResult>& run, ExpectationResult& result) const;

  const Model& model_;
  const EquationsOfMotion& equations_;
  const SimulationOptions& options_;
  Diagnostics& diagnostics_;
  std::vector<ExtendedClaims::Line> timed_;
  std::vector<Value> values_;
  std::vector<End> ends_;
  std::vector<Drift> drifts_;
  std::vector<Energy> energies_;
  std::vector<Event> events_;
  std::vector<EventCount> counts_;
};

}  // namespace maupertuis
