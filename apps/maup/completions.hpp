#pragma once
#include "option_table.hpp"

#include <string>

namespace maupertuis::app {

/// Scripts that a shell loads: after them Tab knows the commands, their options, the words that an option takes, and
/// which arguments are models.
std::string bash_completions(const OptionTable& table);
std::string zsh_completions(const OptionTable& table);
std::string fish_completions(const OptionTable& table);

/// The page of `man maup`, in the macros of man(7).
std::string manual_page(const OptionTable& table);

/// What an argument is, as far as a shell can help with it.
enum class ArgumentKind { Words, Model, File, Other };
ArgumentKind argument_kind(const OptionRow& row);

/// One line of a list: what an option does, cut at a joint of the sentence where it is long.
std::string one_line(const std::string& what);

}  // namespace maupertuis::app
