#include "command_line.hpp"

#include "command.hpp"
#include "interrupt.hpp"
#include "json.hpp"
#include "option_table_of.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <csignal>
#include <exception>
#include <map>
#include <vector>

namespace maupertuis::app {
namespace {

constexpr const char* version_text = "maup " MAUPERTUIS_VERSION;

/// --help of a command opens with its examples.
class HelpWithExamples : public CLI::Formatter {
 public:
  explicit HelpWithExamples(std::string examples) : examples_(std::move(examples)) { column_width(34); }
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
    return "Examples:\n" + examples_ + "\n" + CLI::Formatter::make_help(app, std::move(name), mode);
  }

 private:
  std::string examples_;
};

std::string last_resort(const char* what) {
  return fmt::format(
      "maup: internal error: {}\nThis is a defect of maup, not of your model. Please report it, with the model and the "
      "command.\n",
      what);
}

}  // namespace

struct CommandLine::Implementation {
  CLI::App app{"Lagrangian mechanics: a model file in, certified equations and machine-precision motion out.", "maup"};
  Console console;
  bool json = false;
  Console::Color color = Console::Color::Auto;
  Action chosen;
  std::map<std::string, std::string> examples;  // by command
};

CommandLine::CommandLine() : implementation_(std::make_unique<Implementation>()) {
  CLI::App& app = implementation_->app;
  app.require_subcommand(1);
  app.set_version_flag("--version", version_text);
  app.get_formatter()->column_width(16);
  app.footer("\n`maup COMMAND --help` shows examples and options. A first model: maup new pendulum");
}

CommandLine::~CommandLine() = default;

CLI::App& CommandLine::add(const std::string& name, const std::string& summary, const std::string& examples,
                           Action action) {
  Implementation& line = *implementation_;
  CLI::App& command = *line.app.add_subcommand(name, summary);
  command.formatter(std::make_shared<HelpWithExamples>(examples));
  line.examples[name] = examples;
  command.add_flag("--json", line.json, "The result as a JSON document on standard output");
  command
      .add_option_function<std::string>(
          "--color",
          [&line](const std::string& word) {
            line.color = word == "always" ? Console::Color::Always
                         : word == "never" ? Console::Color::Never
                                           : Console::Color::Auto;
          },
          "Color in messages; NO_COLOR is honoured")
      ->check(CLI::IsMember({"auto", "always", "never"}))
      ->type_name("auto|always|never");
  command.callback([&line, action = std::move(action)] { line.chosen = action; });
  return command;
}

ExitCode CommandLine::run(int argc, char** argv) {
  Implementation& line = *implementation_;
  try {
    line.app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return line.app.exit(error) == 0 ? ExitCode::Fine : ExitCode::Usage;
  }
  line.console.use_json(line.json);
  line.console.use_color(line.color);
  ExitCode code = line.chosen(line.console);
  if (interrupt_flag().load() && code != ExitCode::Interrupted) {
    line.console.say("Interrupted: what stands here is not the whole of it.\n");
    code = ExitCode::Interrupted;
  }
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
  OptionTable table;
  fill_option_table(implementation_->app, table);
  table.version = version_text;
  for (CommandRow& command : table.commands) command.examples = implementation_->examples.at(command.name);
  return table;
}

void add_model_options(CLI::App& command, ModelOptions& options) {
  command.add_option("MODEL", options.path, "The model file (.lag), or - for standard input")->required();
  command.add_option("--set", options.overrides.parameters, "Another value of a parameter, e.g. m=2kg")
      ->allow_extra_args(false)
      ->type_name("NAME=VALUE");
  command.add_option("--start", options.overrides.start, "Another start value, e.g. θ=10deg or \"θ'=1 rad/s\"")
      ->allow_extra_args(false)
      ->type_name("NAME=VALUE");
}

namespace {

void add_all_commands(CommandLine& line) {
  add_check(line);
  add_derive(line);
  add_simulate(line);
  add_test(line);
  add_invariants(line);
  add_hamiltonian(line);
  add_compare(line);
  add_reduce(line);
  add_modes(line);
  add_orbits(line);
  add_action(line);
  add_plot(line);
  add_report(line);
  add_fmt(line);
  add_new(line);
  add_explain(line);
  add_doctor(line);
  add_completions(line);
  add_manual(line);
  add_later_commands(line);
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
    add_all_commands(line);
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
