#include "completions.hpp"

#include "codes.hpp"
#include "command.hpp"
#include "command_line.hpp"
#include "json.hpp"
#include "starters.hpp"

namespace maupertuis::app {
namespace {

/// Words that no check of an option tells, since any other word has an answer of its own.
OptionTable with_known_words(OptionTable table) {
  const auto add = [&table](const char* command, const char* argument, const std::vector<std::string>& words) {
    for (CommandRow& row : table.commands)
      for (OptionRow& option : row.options)
        if (row.name == command && option.names[0] == argument) option.words = words;
  };
  std::vector<std::string> codes;
  for (const CodeEntry& entry : all_codes()) codes.emplace_back(entry.code);
  add("explain", "CODE", codes);
  add("new", "NAME", starter_names());
  return table;
}

ExitCode print_text(const char* command, const std::string& text, Console& console) {
  if (!console.json()) {
    console.print(text);
    return ExitCode::Fine;
  }
  Json document = json_document(command);
  document["text"] = text;
  console.print_document(document);
  return ExitCode::Fine;
}

ExitCode completions_of(const std::string& shell, const OptionTable& table, Console& console) {
  const auto script = shell == "bash" ? bash_completions : shell == "zsh" ? zsh_completions : fish_completions;
  return print_text("completions", script(table), console);
}

}  // namespace

void add_completions(CommandLine& line) {
  const auto shell = std::make_shared<std::string>();
  Command& command =
      line.add("completions", "What makes Tab complete commands and options in a shell",
               "  source <(maup completions bash)        # for this session; in ~/.bashrc for all\n"
               "  maup completions zsh > ~/.zfunc/_maup  # a folder of fpath\n"
               "  maup completions fish > ~/.config/fish/completions/maup.fish\n",
               [shell](Console& console) { return completions_of(*shell, with_known_words(option_table()), console); });
  command.add_option("SHELL", *shell, "bash, zsh or fish")->required()->one_of({"bash", "zsh", "fish"});
}

void add_manual(CommandLine& line) {
  line.add("manual", "The manual page: all commands with all options",
           "  maup manual | man -l -\n"
           "  maup manual > ~/.local/share/man/man1/maup.1\n"
           "  maup manual | mandoc -T html > maup.html\n",
           [](Console& console) { return print_text("manual", manual_page(option_table()), console); });
}

}  // namespace maupertuis::app
