#include "command.hpp"
#include "interrupt.hpp"
#include "lsp/server.hpp"

#include <unistd.h>

namespace maupertuis::app {
namespace {

ExitCode serve(Console& console) {
  console.end_progress();
  if (isatty(STDIN_FILENO) == 1)
    console.say("maup lsp waits for an editor: it speaks the Language Server Protocol. Ctrl-C ends it.\n");
  lsp::Server server(STDIN_FILENO, STDOUT_FILENO, interrupt_flag());
  const bool good = server.run();
  if (good || interrupt_flag()) return ExitCode::Fine;
  if (server.output_failed()) {
    Diagnostics diagnostics;
    diagnostics.error("E0805", {}, "The answers could not be written to standard output.",
                      "The editor no longer reads them, or they go to a file on a full disk.");
    console.show(diagnostics, SourceText("standard output", ""));
    return ExitCode::RunFailed;
  }
  console.say("maup lsp: the editor left without `shutdown` and `exit`.\n");
  return ExitCode::ModelWrong;
}

}  // namespace

void add_lsp(CommandLine& line) {
  const auto stdio = std::make_shared<bool>(false);
  Command& command =
      line.add("lsp", "What an editor starts: mistakes, completion, hover and more while you type",
               "  maup lsp                               # waits for an editor on standard input\n"
               "  maup lsp --stdio                       # the same, as some editors say it\n"
               "  maup lsp --help                        # docs/manual/editors.md has each editor's settings\n",
               [stdio](Console& console) { return serve(console); });
  command.add_flag("--stdio", *stdio, "Standard input and output, which are taken in any case");
}

}  // namespace maupertuis::app
