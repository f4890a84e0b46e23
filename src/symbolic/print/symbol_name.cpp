#include "symbolic/expression/storage.hpp"
#include "symbolic/print/symbol_name.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

namespace maupertuis::print {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Number of UTF-8 letters.
std::size_t letters(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

constexpr std::array<std::pair<std::string_view, std::string_view>, 49> greek{{
    {"α", "\\alpha"}, {"β", "\\beta"}, {"γ", "\\gamma"}, {"δ", "\\delta"}, {"ε", "\\varepsilon"}, {"ζ", "\\zeta"},
    {"η", "\\eta"}, {"θ", "\\theta"}, {"ι", "\\iota"}, {"κ", "\\kappa"}, {"λ", "\\lambda"}, {"μ", "\\mu"},
    {"ν", "\\nu"}, {"ξ", "\\xi"}, {"ο", "o"}, {"π", "\\pi"}, {"ρ", "\\rho"}, {"σ", "\\sigma"}, {"ς", "\\varsigma"},
    {"τ", "\\tau"}, {"υ", "\\upsilon"}, {"φ", "\\varphi"}, {"χ", "\\chi"}, {"ψ", "\\psi"}, {"ω", "\\omega"},
    {"Α", "A"}, {"Β", "B"}, {"Γ", "\\Gamma"}, {"Δ", "\\Delta"}, {"Ε", "E"}, {"Ζ", "Z"}, {"Η", "H"},
    {"Θ", "\\Theta"}, {"Ι", "I"}, {"Κ", "K"}, {"Λ", "\\Lambda"}, {"Μ", "M"}, {"Ν", "N"}, {"Ξ", "\\Xi"}, {"Ο", "O"},
    {"Π", "\\Pi"}, {"Ρ", "P"}, {"Σ", "\\Sigma"}, {"Τ", "T"}, {"Υ", "\\Upsilon"}, {"Φ", "\\Phi"}, {"Χ", "X"},
    {"Ψ", "\\Psi"}, {"Ω", "\\Omega"}}};

}  // namespace

std::string_view latex_greek(std::string_view letter) {
  const auto place = std::find_if(greek.begin(), greek.end(), [&](const auto& entry) { return entry.first == letter; });
  return place == greek.end() ? std::string_view{} : place->second;
}

SymbolName split_name(std::string_view name) {
  SymbolName result;
  std::size_t cut = name.find('_');
  const bool underscore = cut != std::string_view::npos && cut > 0 && cut + 1 < name.size();
  if (!underscore) {
    cut = name.size();
    while (cut > 0 && is_digit(name[cut - 1])) --cut;
    if (cut == 0) cut = name.size();
  }
  result.body = std::string(name.substr(0, cut));
  result.subscript = std::string(name.substr(std::min(name.size(), underscore ? cut + 1 : cut)));
  if (underscore) {
    // θ1_max: both parts go below.
    std::size_t digits = result.body.size();
    while (digits > 1 && is_digit(result.body[digits - 1])) --digits;
    if (digits < result.body.size()) result.subscript = result.body.substr(digits) + "," + result.subscript;
    result.body.resize(digits);
  }
  std::replace(result.subscript.begin(), result.subscript.end(), '_', ',');
  result.body_is_word = letters(result.body) > 1;
  result.subscript_is_word = letters(result.subscript) > 1 && !std::all_of(result.subscript.begin(), result.subscript.end(),
                                                                            [](char c) { return is_digit(c) || c == ','; });
  return result;
}

ShownSymbol shown_symbol(Expr symbol) {
  const std::string& name = symbol.name();
  const bool primes = symbol.order() > 0 && independent_name(symbol.context()) != "t";
  if (symbol.order() == 0 || !is_integral(name)) return {name, symbol.order(), primes};
  return {name.substr(integral_sign.size()), symbol.order() - 1, primes};
}

std::string independent_name(Context& context) {
  const NodeId time = context.storage().time;  // printing makes no symbol
  return time ? Expr(&context, time).name() : "t";
}

QuantityName split_quantity(std::string_view name) {
  const std::size_t space = name.find(' ');
  if (space == std::string_view::npos || name.empty()) return {std::string(name), {}};
  std::string unit(name.substr(space + 1));
  if (unit.size() > 2 && unit.front() == '[' && unit.back() == ']') unit = unit.substr(1, unit.size() - 2);
  return {std::string(name.substr(0, space)), unit};
}

}  // namespace maupertuis::print
