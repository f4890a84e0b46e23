#include "command.hpp"
#include "outcome.hpp"

#include <fmt/format.h>

namespace maupertuis::app {
namespace {

ExitCode not_supported_yet(const std::string& name, Console& console) {
  Diagnostics diagnostics;
  diagnostics.error("E0806", {}, fmt::format("not supported yet: maup {}", name),
                    "The command is planned; this version does not have it.",
                    "`maup --help` lists the commands that work today.");
  const SourceText nowhere("maup " + name, "");
  if (console.json()) {
    Json document = json_document(name.c_str());
    document["ok"] = false;
    document["diagnostics"] = to_json(diagnostics, nowhere);
    console.print_document(document);
  }
  console.show(diagnostics, nowhere);
  return ExitCode::ModelWrong;
}

}  // namespace

void add_later_commands(CommandLine& line) {
  const std::pair<const char*, const char*> commands[] = {
      {"sweep", "parameter studies and ensembles"},
      {"export", "c, python, latex, fmu, html"},
  };
  for (const auto& [name, what] : commands) {
    Command& command =
        line.add(name, fmt::format("Not supported yet: {}", what), "  (none yet)\n",
                 [name = std::string(name)](Console& console) { return not_supported_yet(name, console); });
    command.allow_extras();
    command.group("Commands of later versions");
  }
}

}  // namespace maupertuis::app
