#include <maupertuis/codes.hpp>

#include <array>

namespace maupertuis {
namespace {

constexpr std::array entries{
    CodeEntry{"E0701", "the run has no length",
              "A run needs an end: a `run` statement in the model, --duration on the command line, or times asked for "
              "with --at. `run 10 s` runs for ten seconds; `run until P.y = 0 within 60 s` stops when the condition is met.",
              "", ""},
    CodeEntry{"E0702", "a start value is not a finite number",
              "The initial state is computed from the parameters. A division by zero or a root of a negative number in a "
              "start value leaves no state to begin from.",
              "", ""},
    CodeEntry{"E0703", "the length of the run is not a finite number",
              "The duration of a run is computed from the parameters; here it is infinite or undefined.", "", ""},
    CodeEntry{"E0704", "the output interval is not a positive time",
              "`output every 10 ms` sets the time between two rows of the trajectory. It must be positive; the direction "
              "of time follows from the run.",
              "", ""},
    CodeEntry{"E0705", "the trajectory would be too large",
              "The trajectory is kept in memory until it is written. With more than twenty million rows it would not "
              "fit; choose a longer interval between rows. The steps of the integrator are not affected.",
              "", ""},
    CodeEntry{"E0706", "a time that is asked for is not on the way of the run",
              "A run goes one way from its start: forwards, or backwards with a negative duration. States on the other "
              "side of the start need a run of their own.",
              "", ""},
};

}  // namespace

std::span<const CodeEntry> simulation_codes() { return entries; }

}  // namespace maupertuis
