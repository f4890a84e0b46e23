#include "command.hpp"
#include "outcome.hpp"
#include "output_files.hpp"
#include "starters.hpp"

#include <fmt/format.h>

namespace maupertuis::app {
namespace {

struct NewOptions {
  std::string name;
  std::string output;  // empty: NAME.lag; "-": standard output
  int links = 3;
  bool force = false;
  bool list = false;
};

std::string text_of(const NewOptions& options) {
  if (options.name == "chain") return chain_starter(options.links);
  for (const Starter& starter : starters())
    if (starter.name == options.name) return std::string(starter.text);
  return {};
}

void unknown_starter(const std::string& name, Diagnostics& diagnostics) {
  const std::string near = did_you_mean(name, starter_names());
  diagnostics.error("E0808", {}, fmt::format("There is no starter named {}.", name), {},
                    near.empty() ? fmt::format("The starters are {}.", fmt::join(starter_names(), ", "))
                                 : fmt::format("Did you mean {}?", near));
}

ExitCode finish_new(ExitCode code, const std::string& path, const Diagnostics& diagnostics, Console& console) {
  const SourceText nowhere("maup new", "");
  console.show(diagnostics, nowhere);
  if (console.json()) {
    Json document = json_document("new");
    document["ok"] = code == ExitCode::Fine;
    document["file"] = path;
    document["diagnostics"] = to_json(diagnostics, nowhere);
    console.print_document(document);
  }
  return code;
}

ExitCode list_starters(Console& console) {
  Json document = json_document("new");
  document["starters"] = starter_names();
  if (console.json())
    console.print_document(document);
  else
    console.print(fmt::format("{}\n", fmt::join(starter_names(), "\n")));
  return ExitCode::Fine;
}

ExitCode write_starter(const NewOptions& options, Console& console) {
  if (options.list || options.name.empty()) return list_starters(console);
  Diagnostics diagnostics;
  const std::string text = text_of(options);
  const std::string path = options.output.empty() ? options.name + ".lag" : options.output;
  if (text.empty()) {
    unknown_starter(options.name, diagnostics);
    return finish_new(ExitCode::Usage, path, diagnostics, console);
  }
  if (path == "-") {
    console.print(text);
    return ExitCode::Fine;
  }
  check_output_files({{"-o", path, FileKind::Model}}, "", diagnostics);
  check_is_new(path, options.force, diagnostics);
  if (diagnostics.has_errors()) return finish_new(ExitCode::Usage, path, diagnostics, console);
  if (!write_result(path, text, diagnostics)) return finish_new(ExitCode::RunFailed, path, diagnostics, console);
  if (!console.json()) console.say(fmt::format("Wrote {}. Next: maup check {}\n", path, path));
  return finish_new(ExitCode::Fine, path, diagnostics, console);
}

}  // namespace

std::vector<std::string> starter_names() {
  std::vector<std::string> all{"chain"};
  for (const Starter& starter : starters()) all.emplace_back(starter.name);
  std::sort(all.begin(), all.end());
  return all;
}

void add_new(CommandLine& line) {
  const auto options = std::make_shared<NewOptions>();
  Command& command = line.add("new", "Write a starter model",
                              "  maup new pendulum                      # writes pendulum.lag\n"
                              "  maup new chain --links 100 -o chain.lag\n"
                              "  maup new --list\n",
                              [options](Console& console) { return write_starter(*options, console); });
  command.add_option("NAME", options->name, "Which starter");
  command.add_option("-o,--output", options->output,
                     "The file to write (NAME.lag by default), or - for standard output");
  command.add_option("--links", options->links, "Number of links of the chain")->between(1, 10000);
  command.add_flag("--force", options->force, "Overwrite a file that exists");
  command.add_flag("--list", options->list, "Name the starters");
}

}  // namespace maupertuis::app
