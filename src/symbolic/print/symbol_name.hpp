#pragma once
#include <maupertuis/expression.hpp>
#include <maupertuis/integral_symbol.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace maupertuis::print {

/// A name of the model language as typography sees it. What follows an underscore stands below, and so do digits at the
/// end: θ_max, l12, θ1_max (θ with 1, max below). Two letters are a letter with one below: mt is m_t, Jw is J_w. More
/// are an upright word, and so are EI, GJ, ρA. A component of a body, ball.qw, has the body below: q with w, ball; so
/// has ball.ω.x: ω with 1, ball.
struct SymbolName {
  std::string body;                // one letter, or a word
  std::vector<std::string> below;  // separated by commas
};
SymbolName split_name(std::string_view name);

/// Number of letters as a reader counts them: marks above a letter are no letters of their own.
std::size_t letter_count(std::string_view text);
bool is_digits(std::string_view text);
/// The UTF-8 letters of a word, each with the marks above it.
std::vector<std::string_view> letters_of(std::string_view text);

/// "ball.qw" without the name of the body: "qw"; "p_ball.qw": "p_qw". Empty where the name is not of this body.
std::string name_within_body(std::string_view name, std::string_view body);

/// "\theta" for "θ", and so for ħ and ℓ; empty if the letter is neither Greek nor one of these. Letters that LaTeX
/// lacks because they look Latin (ο, Α) are given as Latin ones.
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
  bool primes = false;  // y' in the place of ẏ: the independent variable is not t
};
/// `within_body`: the name that a layout has in its place, without that of the only body; empty: the symbol's own.
ShownSymbol shown_symbol(Expr symbol, const std::string& within_body = {});
/// The name of the independent variable.
std::string independent_name(Context& context);

}  // namespace maupertuis::print
