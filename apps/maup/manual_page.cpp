// The page of `man maup`: the tables of options, and what holds for the whole program.
#include "completions.hpp"
#include "exit_code.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sstream>

namespace maupertuis::app {
namespace {

struct Term {
  const char* name;
  const char* what;
};

constexpr Term environment[] = {
    {"NO_COLOR", "If it is set and not empty, messages have no color."},
    {"TERM", "If it is dumb, messages have no color and no progress is drawn."},
    {"PATH", "Where ffmpeg is looked for, which makes films."},
    {"XDG_CACHE_HOME",
     "Machine code of earlier runs is kept in its folder maupertuis, which is the user's alone; else in HOME/.cache."},
    {"HOME", "See XDG_CACHE_HOME."},
    {"MAUPERTUIS_LLVM_MODULE",
     "The file of the module that makes machine code, instead of the one installed with the program."},
    {"MAUPERTUIS_INSTRUCTIONS",
     "avx2 or none: do without wider vector instructions, as on a processor that lacks them."},
};

/// Text as groff shows it sign by sign: no escape, no request, no typographic quotes, and hyphens that can be searched
/// for.
std::string roff(const std::string& text) {
  std::string out;
  bool line_begins = true;
  for (const char c : text) {
    if (line_begins && (c == '.' || c == '\'')) out += "\\&";
    line_begins = c == '\n';
    switch (c) {
      case '\\':
        out += "\\e";
        break;
      case '-':
        out += "\\-";
        break;
      case '\'':
        out += "\\(aq";
        break;
      case '`':
        out += "\\(ga";
        break;
      case '^':
        out += "\\(ha";
        break;
      case '~':
        out += "\\(ti";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string bold(const std::string& text) { return "\\fB" + roff(text) + "\\fR"; }
std::string italic(const std::string& text) { return "\\fI" + roff(text) + "\\fR"; }

std::string value_text(const OptionRow& row) {
  if (row.value.empty()) return {};
  std::vector<std::string> words;
  for (const std::string& word : row.words) words.push_back(bold(word));
  // Many words, such as the codes of all messages, would fill the page.
  const bool listed = !words.empty() && words.size() <= 8;
  return " " + (listed ? fmt::format("{}", fmt::join(words, "|")) : italic(row.value));
}

std::string entry(const OptionRow& row) {
  std::vector<std::string> names;
  for (const std::string& name : row.names) names.push_back(row.positional ? italic(name) : bold(name));
  return fmt::format(".TP\n{}{}\n{}\n", fmt::join(names, ", "), row.positional ? "" : value_text(row),
                     roff(row.what + "."));
}

std::string synopsis(const std::string& program, const CommandRow& command) {
  std::string out = bold(program) + " " + bold(command.name);
  for (const OptionRow& row : command.options) {
    if (!row.positional) continue;
    const std::string name = italic(row.names[0]) + (row.many ? "..." : "");
    out += row.required ? " " + name : " [" + name + "]";
  }
  return out + " [" + italic("options") + "]\n";
}

/// One of its examples a line, without their indentation.
std::string examples(const CommandRow& command) {
  std::string out = ".PP\n.nf\n";
  std::istringstream lines(command.examples);
  for (std::string line; std::getline(lines, line);)
    out += "    " + roff(line.substr(std::min(line.find_first_not_of(' '), line.size()))) + "\n";
  return out + ".fi\n";
}

std::string command_section(const std::string& program, const CommandRow& command) {
  std::string out =
      ".SS " + command.name + "\n" + synopsis(program, command) + ".PP\n" + roff(command.summary + ".") + "\n";
  for (const bool positional : {true, false})
    for (const OptionRow& row : command.options)
      if (row.positional == positional && row.names.back() != "--help") out += entry(row);
  return out + examples(command);
}

std::string exit_status() {
  std::string out = ".SH EXIT STATUS\n";
  for (const ExitCodeRow& row : exit_codes)
    out += fmt::format(".TP\n\\fB{}\\fR\n{}\n", static_cast<int>(row.code), roff(row.meaning) + ".");
  return out;
}

}  // namespace

std::string manual_page(const OptionTable& table) {
  std::string out =
      fmt::format(".TH {} 1 \"\" \"{}\" \"User Commands\"\n.SH NAME\n{} \\- {}\n.SH SYNOPSIS\n{} {} [{}] [{}]\n",
                  "MAUP", table.version, table.program, "Lagrangian mechanics from a text model", bold(table.program),
                  italic("command"), italic("model.lag"), italic("options"));
  out += ".SH DESCRIPTION\n" + roff(table.summary) +
         "\n.PP\nStandard output carries data, standard error carries messages. " + bold("-") +
         " as the model reads standard input.\n";
  out += ".SH OPTIONS\n";
  for (const OptionRow& row : table.options) out += entry(row);
  out += ".SH COMMANDS\n";
  for (const CommandRow& command : table.commands)
    if (!command.later) out += command_section(table.program, command);
  out += exit_status() + ".SH ENVIRONMENT\n";
  for (const Term& term : environment) out += fmt::format(".TP\n.B {}\n{}\n", term.name, roff(term.what));
  out += ".SH FILES\n.TP\n.I ~/.cache/maupertuis\nMachine code of earlier runs, at most 256 MB.\n";
  return out;
}

}  // namespace maupertuis::app
