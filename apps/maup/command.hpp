#pragma once
#include "console.hpp"
#include "exit_code.hpp"
#include "options.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace maupertuis::app {

/// Does what a command is for, once its options are read.
using Action = std::function<ExitCode(Console&)>;

/// The command line under construction. Each file of commands/ adds one command to it.
class CommandLine {
 public:
  CommandLine();
  ~CommandLine();

  /// Adds a command with --json and --color. `examples`: three lines that open its --help.
  Command& add(const std::string& name, const std::string& summary, const std::string& examples, Action action);

  /// Reads the arguments and runs the command that they name.
  ExitCode run(int argc, char** argv);

  /// What --help says, in parts.
  OptionTable table() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// The positional MODEL, and --set and --start.
struct ModelOptions {
  std::string path;
  std::vector<std::string> set, start;  // as written
  std::optional<std::string> mode;      // of contacts and friction
};
void add_model_options(Command& command, ModelOptions& options);

void add_check(CommandLine& line);
void add_derive(CommandLine& line);
void add_simulate(CommandLine& line);
void add_test(CommandLine& line);
void add_invariants(CommandLine& line);
void add_hamiltonian(CommandLine& line);
void add_compare(CommandLine& line);
void add_reduce(CommandLine& line);
void add_modes(CommandLine& line);
void add_orbits(CommandLine& line);
void add_action(CommandLine& line);
void add_plot(CommandLine& line);
void add_animate(CommandLine& line);
void add_report(CommandLine& line);
void add_fmt(CommandLine& line);
void add_new(CommandLine& line);
void add_explain(CommandLine& line);
void add_lsp(CommandLine& line);
void add_studio(CommandLine& line);
void add_doctor(CommandLine& line);
void add_completions(CommandLine& line);
void add_manual(CommandLine& line);
/// The commands of later versions: they say so.
void add_later_commands(CommandLine& line);

}  // namespace maupertuis::app
