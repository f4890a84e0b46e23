#include "command_line.hpp"

#include "command.hpp"
#include "interrupt.hpp"
#include "json.hpp"

#include <fmt/format.h>

#include <maupertuis/interrupt_scope.hpp>
#include <maupertuis/vector_instructions.hpp>

#include <algorithm>
#include <csignal>
#include <exception>
#include <iterator>
#include <sstream>
#include <string_view>
#include <vector>

namespace maupertuis::app {
namespace {

constexpr const char* version_text = "maup " MAUPERTUIS_VERSION;

std::string last_resort(const char* what) {
  return fmt::format(
      "maup: internal error: {}\nThis is a defect of maup, not of your model. Please report it, with the model and the "
      "command.\n",
      what);
}

Console::Color color_named(const std::string& word) {
  return word == "always" ? Console::Color::Always : word == "never" ? Console::Color::Never : Console::Color::Auto;
}

/// Also under --json: no document is about the environment.
void warn_of_environment(const Console& console) {
  const std::string word = unknown_vector_instructions();
  if (word.empty()) return;
  Diagnostics diagnostics;
  diagnostics.warning("W0815", {},
                      fmt::format("MAUPERTUIS_INSTRUCTIONS says `{}`, which is no kind of vector instructions", word),
                      "It is left out of account: the processor decides.", "Write avx512, avx2 or none, or unset it.");
  console.draw(render(diagnostics, SourceText("the environment", ""), {.color = console.colored_messages()}));
}

/// Runs a command; after an interrupt says what there is of it.
ExitCode outcome_of(const Action& action, Console& console) {
  ExitCode code = ExitCode::Interrupted;
  try {
    code = action(console);
  } catch (const Interrupted&) {
    if (!interrupt_flag().load()) throw;  // a deadline that no one waited for
  }
  if (!interrupt_flag().load()) return code;
  console.say(fmt::format("Interrupted: {}\n", !console.left().empty() ? console.left()
                                               : console.has_data()    ? "what stands here is not the whole of it."
                                                                       : "there was nothing to show yet."));
  return ExitCode::Interrupted;
}

}  // namespace

struct CommandLine::Implementation {
  CommandParser parser{"Lagrangian mechanics: a model file in, certified equations and machine-precision motion out.",
                       version_text,
                       "\n`maup COMMAND --help` shows examples and options. A first model: maup new pendulum"};
  Console console;
  bool json = false;
  std::string color, name;
  Action chosen;
};

CommandLine::CommandLine() : implementation_(std::make_unique<Implementation>()) {}

CommandLine::~CommandLine() = default;

Command& CommandLine::add(const std::string& name, const std::string& summary, const std::string& examples,
                          Action action) {
  Implementation& line = *implementation_;
  Command& command = line.parser.add(name, summary, examples, [&line, name, action = std::move(action)] {
    line.chosen = action;
    line.name = name;
  });
  command.add_flag("--json", line.json, "The result as a JSON document on standard output");
  command.add_option("--color", line.color, "Color in messages; NO_COLOR is honoured")
      ->one_of({"auto", "always", "never"})
      ->type_name("auto|always|never");
  return command;
}

ExitCode CommandLine::run(int argc, char** argv) {
  Implementation& line = *implementation_;
  std::ostringstream out, err;
  const CommandParser::Outcome asked = line.parser.parse(argc, argv, out, err);
  line.console.print(out.str());
  line.console.say(err.str());
  switch (asked) {
    case CommandParser::Outcome::Command:
      break;
    case CommandParser::Outcome::Answered:
      return line.console.flush().empty() ? ExitCode::Fine : ExitCode::Usage;
    case CommandParser::Outcome::Mistake:
      return line.console.flush(), ExitCode::Usage;
  }
  line.console.use_json(line.json);
  line.console.use_color(color_named(line.color));
  warn_of_environment(line.console);
  line.console.begin_progress(line.name);
  const ExitCode code = outcome_of(line.chosen, line.console);
  line.console.end_progress();
  const std::string failure = line.console.flush();
  if (failure.empty()) return code;
  Diagnostics diagnostics;
  diagnostics.error("E0805", {}, "The result could not be written to standard output.",
                    fmt::format("The system says: {}.", failure));
  line.console.use_json(false);  // the document is lost: say so where it can be seen
  line.console.show(diagnostics, SourceText("standard output", ""));
  return ExitCode::RunFailed;
}

OptionTable CommandLine::table() const {
  OptionTable table = implementation_->parser.table();
  table.version = version_text;
  return table;
}

void add_model_options(Command& command, ModelOptions& options) {
  command.add_option("MODEL", options.path, "The model file (.lag), or - for standard input")->required();
  command.add_option("--set", options.set, "Another value of a parameter, e.g. m=2kg")
      ->allow_extra_args(false)
      ->type_name("NAME=VALUE");
  command.add_option("--start", options.start, "Another start value, e.g. θ=10deg or \"θ'=1 rad/s\"")
      ->allow_extra_args(false)
      ->type_name("NAME=VALUE");
  command
      .add_option("--mode", options.mode,
                  "The system in one mode of its contacts and frictions, e.g. free, \"floor\" or \"floor sticking\"")
      ->type_name("MODE");
}

namespace {

struct Entry {
  std::string_view name;
  void (*add)(CommandLine&);
};

constexpr Entry entries[] = {
    {"check", add_check},     {"derive", add_derive},         {"simulate", add_simulate},
    {"test", add_test},       {"invariants", add_invariants}, {"hamiltonian", add_hamiltonian},
    {"compare", add_compare}, {"reduce", add_reduce},         {"modes", add_modes},
    {"orbits", add_orbits},   {"action", add_action},         {"plot", add_plot},
    {"animate", add_animate}, {"report", add_report},         {"fmt", add_fmt},
    {"new", add_new},         {"explain", add_explain},       {"lsp", add_lsp},
    {"studio", add_studio},   {"doctor", add_doctor},         {"completions", add_completions},
    {"manual", add_manual},
};

void add_all_commands(CommandLine& line) {
  for (const Entry& entry : entries) entry.add(line);
  add_later_commands(line);
}

/// The one that is asked for where it comes first, as nearly always: to declare the options of all takes a millisecond.
void add_commands(CommandLine& line, int argc, char** argv) {
  const std::string_view first = argc > 1 ? argv[1] : "";
  const auto entry =
      std::find_if(std::begin(entries), std::end(entries), [&](const Entry& e) { return e.name == first; });
  if (entry == std::end(entries)) return add_all_commands(line);
  entry->add(line);
}

}  // namespace

OptionTable option_table() {
  CommandLine line;
  add_all_commands(line);
  return line.table();
}

int run_command_line(int argc, char** argv) {
  try {
    CommandLine line;
    add_commands(line, argc, argv);
    return static_cast<int>(line.run(argc, argv));
  } catch (const std::bad_alloc&) {
    std::fputs("maup: out of memory.\n", stderr);
  } catch (const std::exception& error) {
    std::fputs(last_resort(error.what()).c_str(), stderr);
  } catch (...) {
    std::fputs(last_resort("unknown exception").c_str(), stderr);
  }
  return static_cast<int>(ExitCode::RunFailed);
}

int run(int argc, char** argv) {
  // A closed pipe is then an error of the write, which is said, instead of a signal.
  std::signal(SIGPIPE, SIG_IGN);
  watch_interrupts();
  return run_command_line(argc, argv);
}

}  // namespace maupertuis::app
