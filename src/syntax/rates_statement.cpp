#include "syntax/statement_parser.hpp"

#include <fmt/format.h>

/// rates: the velocities in which the equations of motion are to be written.
namespace maupertuis::syntax {

// rates ω1, ω2, ω3 = B.ω,   rates v = x' cos ψ + y' sin ψ, w = ψ'
StatementBody StatementParser::rates_statement() {
  next();
  RatesStatement rates;
  RatesStatement::Group group;
  list([&] {
    group.names.push_back(new_name("the name of a rate"));
    if (!accept("=")) {
      if (!peek().is(",")) expect("=", "the name of a rate");
      return;  // the names before a sign of equality share its right side
    }
    group.value = formula();
    rates.groups.push_back(std::move(group));
    group = {};
  });
  if (!group.names.empty())
    fail("E0111", group.names.front().span, fmt::format("the rate {} has no value", group.names.front().text),
         "A rate is a combination of velocities.",
         fmt::format("Write for example rates {} = x' cos ψ + y' sin ψ.", group.names.front().text));
  return rates;
}

}  // namespace maupertuis::syntax
