#pragma once
#include <maupertuis/expression.hpp>
#include <maupertuis/integral_symbol.hpp>

#include <string>
#include <string_view>

namespace maupertuis::print {

/// A name of the model language as typography sees it: θ_max → body θ, subscript max; l12 → body l, subscript 12.
struct SymbolName {
  std::string body;            // one letter, or a word
  std::string subscript;       // empty: none
  bool body_is_word = false;   // more than one letter: upright
  bool subscript_is_word = false;
};
SymbolName split_name(std::string_view name);

/// "\theta" for "θ"; empty if the letter is not Greek. Letters that LaTeX lacks because they look Latin (ο, Α) are
/// given as Latin ones.
std::string_view latex_greek(std::string_view letter);

/// A quantity as it stood in the model, "3 J" or "3 [J]": its number and its unit. The unit is empty for other names.
struct QuantityName {
  std::string number, unit;
};
QuantityName split_quantity(std::string_view name);

/// The name and the number of dots that a symbol is shown with: the rate of ∫p_θ is p_θ.
struct ShownSymbol {
  std::string name;
  int dots = 0;
  bool primes = false;         // y' in the place of ẏ: the independent variable is not t
};
ShownSymbol shown_symbol(Expr symbol);
/// The name of the independent variable.
std::string independent_name(Context& context);

}  // namespace maupertuis::print
