#pragma once
#include <maupertuis/extended.hpp>
#include <maupertuis/rational.hpp>
#include <maupertuis/simulation.hpp>

namespace maupertuis {

/// Quad: 113 bits, up to 33 digits. Digits100: 384 bits, up to 100 digits.
enum class Precision { Quad, Digits100 };

struct ExtendedSimulationOptions {
  Precision precision = Precision::Quad;
  std::optional<StepMethod> method;      // nothing: as for SimulationOptions; Taylor's is the only one
  std::optional<Rational> duration;      // s, instead of the model's run; negative: backwards in time
  std::vector<Rational> at;              // s: times at which the state is wanted
  std::optional<Rational> output_every;  // s
  bool rows = false;                     // a trajectory is wanted
  double tolerance = 0;                  // relative, per step; 0: 2e-34 (Quad), 1e-105 (Digits100)
  int order = 0;                         // 0: from the tolerance
  std::size_t maximum_steps = 100'000'000;
  const StopFlag* interrupt = nullptr;
  std::function<void(double)> progress;
};

/// Numbers that were not `compared`, since the run was interrupted before, have 17 digits of the run to read, and 0 of
/// which it is known that they are right.
struct ExtendedState {
  bool reached = false, compared = false;
  AgreedNumber t;                    // s
  std::vector<AgreedNumber> q, v;    // [n] SI
  std::vector<AgreedNumber> points;  // coordinates of the points
  std::vector<AgreedNumber>
      reactions;        // [ExtendedResult::reactions]; empty text where the equations do not determine it
  AgreedNumber energy;  // J
};

/// An event of the model, or an impulse of a contact that is hit, as Happening.
struct ExtendedHappening {
  Happening::Kind kind = Happening::Kind::Event;
  std::string name;
  AgreedNumber t;
  std::vector<AgreedNumber> q, v;  // [n] before it
  AgreedNumber impulse, speed;     // Impact
};

struct ExtendedStatistics {
  std::size_t steps = 0, check_steps = 0, switches = 0;
  int order = 0, check_order = 0, bits = 0, check_bits = 0;
  double seconds = 0, check_seconds = 0;  // of both runs
  std::size_t companion_steps = 0;        // of the run with another order and other last bits
  int companion_order = 0;
  double companion_seconds = 0;
};

struct ExtendedResult {
  Trajectory::Column independent{"t", "s"};
  std::vector<Trajectory::Column> columns;  // q, q', points, reactions, energy
  std::vector<Trajectory::Column> reactions;
  std::vector<ExtendedState> rows;            // empty if none were wanted
  std::vector<ExtendedState> at;              // in the order asked
  ExtendedState final;                        // not reached: it was not checked
  std::vector<ExtendedHappening> happenings;  // as far as all runs meet the same
  std::vector<std::string> remarks{};         // a sentence each
  double reached = 0;                         // s: how far the run came
  ExtendedStatistics statistics;
  Ending ending = Ending::Finished;
  std::string reason;
  bool ok() const { return ending == Ending::Finished || ending == Ending::UntilReached || ending == Ending::Stopped; }
};

/// Runs the experiment of a model in many digits, three times: a companion has another order, other steps, and numbers
/// without an end in binary one unit of the last place higher or lower; the check has at least a word more of mantissa,
/// a tolerance 1e-4 times smaller and an order that follows. Only the digits of the check that both others agree with
/// are given.
///
/// Parameters, literals, start values and times are taken as written: 9.81 is the decimal, 30 deg is π/6. Where the
/// constraints leave a choice between positions that the start does not give, it is the one of `consistent_start`,
/// moved onto the constraints in all digits. Nothing is returned when the run is not possible in many digits (E0725) or
/// not at all (as `simulate`).
std::optional<ExtendedResult> simulate_extended(const Model& model, const EquationsOfMotion& equations,
                                                const ExtendedSimulationOptions& options, Diagnostics& diagnostics);

/// RFC 4180, as to_csv of a trajectory, with the digits on which all runs agree; empty cells where there are none.
std::string to_csv(const ExtendedResult& result);

}  // namespace maupertuis
