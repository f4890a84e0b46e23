#include "completions.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace maupertuis::app {
namespace {

constexpr const char* frame = R"(#compdef {0}
# Completion of {0} for zsh, written by `{0} completions zsh`.
_{0}() {{
  local curcontext="$curcontext" state line
  typeset -A opt_args
  local -a commands
  commands=(
{1}  )
  _arguments -C {2} '1:command:->command' '*::argument:->argument'
  case $state in
    command) _describe -t commands '{0} command' commands ;;
    argument)
      case $words[1] in
{3}      esac ;;
  esac
}}
if [[ $zsh_eval_context[-1] == loadautofunc ]]; then _{0} "$@"; else compdef _{0} {0}; fi
)";

/// Within single quotes, with the signs that _arguments and _describe read marked as text.
std::string escaped(const std::string& text, const char* special) {
  std::string out;
  for (const char c : text) {
    if (c == '\'')
      out += "'\\''";
    else if (std::string_view(special).find(c) != std::string_view::npos)
      (out += '\\') += c;
    else
      out += c;
  }
  return out;
}

std::string zsh_argument(const OptionRow& row) {
  switch (argument_kind(row)) {
    case ArgumentKind::Words:
      return fmt::format("({})", fmt::join(row.words, " "));
    case ArgumentKind::Model:
      return "_files -g \"*.lag(-.)\"";
    case ArgumentKind::File:
      return "_files";
    case ArgumentKind::Other:
      return " ";
  }
  return " ";
}

/// '*--set=[Another value of a parameter]:NAME=VALUE: '
std::string option_spec(const OptionRow& row) {
  std::string value;
  if (!row.value.empty())
    value = fmt::format("{}:{}:{}", row.value_optional ? ":" : "", escaped(row.value, ":"), zsh_argument(row));
  const std::string rest = fmt::format("[{}]{}'", escaped(one_line(row.what), "[]"), value);
  const auto with_sign = [&row](const std::string& name) {
    return row.value.empty() ? name : name + (name.rfind("--", 0) == 0 ? "=" : "+");
  };
  if (row.names.size() == 1) return fmt::format("'{}{}{}", row.many ? "*" : "", with_sign(row.names[0]), rest);
  std::vector<std::string> names;
  for (const std::string& name : row.names) names.push_back(with_sign(name));
  return fmt::format("'{}({})'{{{}}}'{}", row.many ? "*" : "", fmt::join(row.names, " "), fmt::join(names, ","), rest);
}

std::string specs(const std::vector<OptionRow>& rows, const char* between) {
  std::vector<std::string> out;
  int place = 0;
  for (const OptionRow& row : rows)
    if (!row.positional)
      out.push_back(option_spec(row));
    else
      out.push_back(fmt::format("'{}:{}:{}'", row.many ? "*" : std::to_string(++place), escaped(row.names[0], ":"),
                                zsh_argument(row)));
  return fmt::format("{}", fmt::join(out, between));
}

}  // namespace

std::string zsh_completions(const OptionTable& table) {
  std::string commands, cases;
  for (const CommandRow& command : table.commands) {
    if (command.later) continue;
    commands += fmt::format("    '{}:{}'\n", command.name, escaped(one_line(command.summary), ":"));
    cases += fmt::format("        {})\n          _arguments {} ;;\n", command.name,
                         specs(command.options, " \\\n            "));
  }
  return fmt::format(fmt::runtime(frame), table.program, commands, specs(table.options, " "), cases);
}

}  // namespace maupertuis::app
