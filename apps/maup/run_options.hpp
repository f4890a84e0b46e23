#pragma once
#include "command.hpp"
#include "open_study.hpp"

#include <maupertuis/extended_simulation.hpp>
#include <maupertuis/simulation.hpp>

#include <optional>
#include <string>
#include <vector>

namespace maupertuis::app {

/// How a run is to differ from what the model says; shared by simulate, plot, report and test.
struct RunOptions {
  std::optional<std::string> method;  // none: that of the model
  std::optional<std::string> step;    // as written
  std::optional<int> order;
  std::optional<double> tolerance;
  std::optional<std::string> duration, every;  // as written
  std::string until, within;
  std::string backend = "auto";
  bool no_cache = false;
  bool no_errors = false;
  std::vector<std::string> at;
};

/// --method, --step, --order, --tol, --backend, --no-cache.
void add_method_options(Command& command, RunOptions& options);
/// --no-errors.
void add_errors_option(Command& command, RunOptions& options);
/// --duration, --backward, --until, --within, --every, --at.
void add_span_options(Command& command, RunOptions& options);

/// The options in numbers, with the flag of Ctrl-C. A wrong value is a diagnostic (E0809). `tree`: of the model whose
/// `method` a step or an order without --method belongs to, and whose parameters may have the names of units; may be
/// null.
SimulationOptions simulation_options(const RunOptions& options, Diagnostics& diagnostics,
                                     const syntax::SyntaxTree* tree = nullptr);

/// What the statement `precision` says: "double", "quad", "100"; "double" without one.
std::string precision_of(const syntax::SyntaxTree* tree);

/// The same for a run in many digits: times exactly as written.
ExtendedSimulationOptions extended_options(const RunOptions& options, Precision precision, Diagnostics& diagnostics,
                                           const syntax::SyntaxTree* tree = nullptr);

/// Says --until and --within beside the model; nothing without them.
void put_in_run(const RunOptions& options, Study& study);

/// Certifies, runs, draws progress. Nothing when the model does not allow a run.
std::optional<SimulationResult> run_model(Study& study, const SimulationOptions& options, const Console& console);

/// The same in many digits.
/// Of fields: beside progress, what a long run takes is said as it begins.
std::optional<FieldRunResult> run_model(Study& study, const SimulationOptions& options, FieldMotionOptions kept,
                                        const Console& console);
std::optional<ExtendedResult> run_model(Study& study, const ExtendedSimulationOptions& options, const Console& console);

/// 0, 3 or 130 by how a run ended.
ExitCode exit_code(Ending ending);

}  // namespace maupertuis::app
