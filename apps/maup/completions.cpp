// What the completions of all shells have in common, and those for bash.
#include "completions.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace maupertuis::app {
namespace {

constexpr std::size_t longest_line = 72;

constexpr const char* bash_frame = R"(# Completion of {0} for bash, written by `{0} completions bash`.
_{0}() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} command= i
  local options= words= files=
  COMPREPLY=()
  # bash parts --option=value at the sign.
  if [[ $word == = ]]; then word=
  elif [[ $before == = ]]; then before=${{COMP_WORDS[COMP_CWORD-2]}}; fi
  for ((i = 1; i < COMP_CWORD; ++i)); do
    [[ ${{COMP_WORDS[i]}} == -* ]] || {{ command=${{COMP_WORDS[i]}}; break; }}
  done
  case $command in
{1}  esac
  if [[ $word == -* && $files$words != *'!'* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$options" -- "$word")
  elif [[ $files ]]; then
    compopt -o filenames 2>/dev/null
    case $files in
      *model) mapfile -t COMPREPLY < <(compgen -d -- "$word"; compgen -f -X '!*.lag' -- "$word") ;;
      *any) mapfile -t COMPREPLY < <(compgen -f -- "$word") ;;
    esac
  else
    mapfile -t COMPREPLY < <(compgen -W "${{words#!}}" -- "$word")
  fi
}}
complete -F _{0} {0}
)";

/// What completes an argument: the assignments that the frame above reads. The ! says that it is the value of an
/// option, whatever it begins with.
std::string bash_argument(const OptionRow& row) {
  const std::string mark = row.positional ? "" : "!";
  switch (argument_kind(row)) {
    case ArgumentKind::Words:
      return fmt::format("words='{}{}'", mark, fmt::join(row.words, " "));
    case ArgumentKind::Model:
      return fmt::format("files='{}model'", mark);
    case ArgumentKind::File:
      return fmt::format("files='{}any'", mark);
    case ArgumentKind::Other:
      return row.positional ? ":" : "words='!'";
  }
  return ":";
}

std::vector<std::string> option_names(const std::vector<OptionRow>& rows) {
  std::vector<std::string> names;
  for (const OptionRow& row : rows)
    if (!row.positional) names.insert(names.end(), row.names.begin(), row.names.end());
  return names;
}

std::string bash_command(const CommandRow& command) {
  std::string values, rest = ":";
  for (const OptionRow& row : command.options) {
    if (row.positional && rest == ":") rest = bash_argument(row);
    if (row.positional || row.value.empty() || row.value_optional) continue;
    values += fmt::format("        {}) {} ;;\n", fmt::join(row.names, "|"), bash_argument(row));
  }
  return fmt::format("    {})\n      options='{}'\n      case $before in\n{}        *) {} ;;\n      esac ;;\n",
                     command.name, fmt::join(option_names(command.options), " "), values, rest);
}

}  // namespace

ArgumentKind argument_kind(const OptionRow& row) {
  if (!row.words.empty()) return ArgumentKind::Words;
  if (row.value.rfind("FILE", 0) == 0) return ArgumentKind::File;
  const bool of_models = row.what.find("model") != std::string::npos || row.what.find("Model") != std::string::npos;
  return row.positional && of_models ? ArgumentKind::Model : ArgumentKind::Other;
}

std::string one_line(const std::string& what) {
  if (what.size() <= longest_line) return what;
  for (const char* joint : {"; ", " (", ": ", ", "}) {
    const auto at = what.rfind(joint, longest_line);
    if (at != std::string::npos && at > longest_line / 4) return what.substr(0, at);
  }
  return what.substr(0, what.rfind(' ', longest_line)) + " …";
}

std::string bash_completions(const OptionTable& table) {
  std::vector<std::string> names;
  for (const CommandRow& command : table.commands)
    if (!command.later) names.push_back(command.name);
  std::string cases = fmt::format("    '') words='{}' options='{}' ;;\n", fmt::join(names, " "),
                                  fmt::join(option_names(table.options), " "));
  for (const CommandRow& command : table.commands)
    if (!command.later) cases += bash_command(command);
  return fmt::format(fmt::runtime(bash_frame), table.program, cases);
}

}  // namespace maupertuis::app
