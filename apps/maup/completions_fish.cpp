#include "completions.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace maupertuis::app {
namespace {

std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'' || c == '\\') out += '\\';
    out += c;
  }
  return out + "'";
}

/// -s o -l output
std::string names(const OptionRow& row) {
  std::string out;
  for (const std::string& name : row.names)
    out += name.rfind("--", 0) == 0 ? fmt::format(" -l {}", name.substr(2)) : fmt::format(" -s {}", name.substr(1));
  return out;
}

/// What completes an argument: -a with its words, -F for files.
std::string fish_argument(const OptionRow& row) {
  switch (argument_kind(row)) {
    case ArgumentKind::Words:
      return fmt::format(" -f -a {}", quoted(fmt::format("{}", fmt::join(row.words, " "))));
    case ArgumentKind::Model:
      return " -k -f -a '(__fish_complete_suffix .lag)'";
    case ArgumentKind::File:
      return " -F";
    case ArgumentKind::Other:
      return " -f";
  }
  return {};
}

std::string line(const std::string& program, const std::string& condition, const OptionRow& row) {
  std::string out = fmt::format("complete -c {} -n {}", program, quoted(condition));
  if (row.positional)
    return argument_kind(row) == ArgumentKind::Other ? std::string() : out + fish_argument(row) + "\n";
  out += names(row);
  if (!row.value.empty()) out += (row.value_optional ? "" : " -r") + fish_argument(row);
  return fmt::format("{} -d {}\n", out, quoted(one_line(row.what)));
}

}  // namespace

std::string fish_completions(const OptionTable& table) {
  const std::string& program = table.program;
  std::string out =
      fmt::format("# Completion of {0} for fish, written by `{0} completions fish`.\ncomplete -c {0} -f\n", program);
  for (const OptionRow& row : table.options) out += line(program, "__fish_use_subcommand", row);
  for (const CommandRow& command : table.commands)
    if (!command.later)
      out += fmt::format("complete -c {} -n __fish_use_subcommand -a {} -d {}\n", program, command.name,
                         quoted(one_line(command.summary)));
  for (const CommandRow& command : table.commands)
    if (!command.later)
      for (const OptionRow& row : command.options)
        out += line(program, "__fish_seen_subcommand_from " + command.name, row);
  return out;
}

}  // namespace maupertuis::app
