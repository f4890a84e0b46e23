#pragma once
#include <maupertuis/diagnostic.hpp>
#include <maupertuis/syntax_tree.hpp>

#include <optional>
#include <string>

namespace maupertuis::app {

/// E0809 where the unit of a time in an option is the name of a parameter that makes a time of the number, too: `run 3
/// s` of a dimensionless model with `param s = 5` means 3 * s. Of a text that is no time nothing is said. `tree` may be
/// null.
void refuse_unit_that_is_a_name(const std::string& option, const std::string& text, const syntax::SyntaxTree* tree,
                                Diagnostics& diagnostics);
/// The same of an option that is a time, or a part of π of one; E0809 where it is none.
void check_time_option(const char* option, const std::optional<std::string>& text, const syntax::SyntaxTree* tree,
                       Diagnostics& diagnostics);
/// The time of --budget; nothing for "none". What is no time is an error (E0809).
std::optional<double> budget_seconds(const std::string& text, Diagnostics& diagnostics);

}  // namespace maupertuis::app
