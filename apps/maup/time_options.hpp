#pragma once
#include <maupertuis/diagnostic.hpp>
#include <maupertuis/rational.hpp>
#include <maupertuis/syntax_tree.hpp>

#include <string>

namespace maupertuis::app {

/// E0809 where the unit of a time in an option is the name of a parameter that makes a time of the number, too: `run 3
/// s` of a dimensionless model with `param s = 5` means 3 * s. Of a text that is no time nothing is said. `tree` may be
/// null.
void refuse_unit_that_is_a_name(const std::string& option, const std::string& text, const syntax::SyntaxTree* tree,
                                Diagnostics& diagnostics);

}  // namespace maupertuis::app
