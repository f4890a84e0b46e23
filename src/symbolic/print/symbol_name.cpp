#include "symbolic/print/symbol_name.hpp"
#include "symbolic/expression/storage.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <initializer_list>
#include <utility>

namespace maupertuis::print {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// A combining mark of U+0300 to U+036F, as in λ̃.
bool is_mark(std::string_view letter) {
  return letter.size() == 2 &&
         (letter[0] == '\xcc' || (letter[0] == '\xcd' && static_cast<unsigned char>(letter[1]) <= 0xaf));
}

constexpr std::array<std::pair<std::string_view, std::string_view>, 56> greek{
    {{"α", "\\alpha"},   {"β", "\\beta"},   {"γ", "\\gamma"},  {"δ", "\\delta"},    {"ε", "\\varepsilon"},
     {"ζ", "\\zeta"},    {"η", "\\eta"},    {"θ", "\\theta"},  {"ι", "\\iota"},     {"κ", "\\kappa"},
     {"λ", "\\lambda"},  {"μ", "\\mu"},     {"ν", "\\nu"},     {"ξ", "\\xi"},       {"ο", "o"},
     {"π", "\\pi"},      {"ρ", "\\rho"},    {"σ", "\\sigma"},  {"ς", "\\varsigma"}, {"τ", "\\tau"},
     {"υ", "\\upsilon"}, {"φ", "\\varphi"}, {"χ", "\\chi"},    {"ψ", "\\psi"},      {"ω", "\\omega"},
     {"Α", "A"},         {"Β", "B"},        {"Γ", "\\Gamma"},  {"Δ", "\\Delta"},    {"Ε", "E"},
     {"Ζ", "Z"},         {"Η", "H"},        {"Θ", "\\Theta"},  {"Ι", "I"},          {"Κ", "K"},
     {"Λ", "\\Lambda"},  {"Μ", "M"},        {"Ν", "N"},        {"Ξ", "\\Xi"},       {"Ο", "O"},
     {"Π", "\\Pi"},      {"Ρ", "P"},        {"Σ", "\\Sigma"},  {"Τ", "T"},          {"Υ", "\\Upsilon"},
     {"Φ", "\\Phi"},     {"Χ", "X"},        {"Ψ", "\\Psi"},    {"Ω", "\\Omega"},    {"ϑ", "\\vartheta"},
     {"ϕ", "\\phi"},     {"ϖ", "\\varpi"},  {"ϱ", "\\varrho"}, {"ϵ", "\\epsilon"},  {"ħ", "\\hbar"},
     {"ℓ", "\\ell"}}};

}  // namespace

std::string_view latex_greek(std::string_view letter) {
  const auto place = std::find_if(greek.begin(), greek.end(), [&](const auto& entry) { return entry.first == letter; });
  return place == greek.end() ? std::string_view{} : place->second;
}

std::vector<std::string_view> letters_of(std::string_view text) {
  std::vector<std::string_view> letters;
  for (std::size_t at = 0; at < text.size();) {
    std::size_t end = at + 1;
    while (end < text.size() && (text[end] & 0xC0) == 0x80) ++end;
    const std::string_view letter = text.substr(at, end - at);
    if (is_mark(letter) && !letters.empty())
      letters.back() = text.substr(static_cast<std::size_t>(letters.back().data() - text.data()),
                                   letters.back().size() + letter.size());
    else
      letters.push_back(letter);
    at = end;
  }
  return letters;
}

std::size_t letter_count(std::string_view text) { return letters_of(text).size(); }

bool is_digits(std::string_view text) { return !text.empty() && std::all_of(text.begin(), text.end(), is_digit); }

namespace {

/// What stands between underscores, in order; nothing for two of them.
std::vector<std::string> parts_of(std::string_view text) {
  std::vector<std::string> parts;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find('_', at), text.size());
    if (end > at) parts.emplace_back(text.substr(at, end - at));
    at = end + 1;
  }
  return parts;
}

/// EI, GJ, ρA: a modulus or density times a quantity of a cross-section, written as one word in textbooks.
bool is_of_cross_section(const std::vector<std::string_view>& letters) {
  const auto is_one_of = [](std::string_view letter, std::initializer_list<std::string_view> list) {
    return std::find(list.begin(), list.end(), letter) != list.end();
  };
  return letters.size() == 2 && is_one_of(letters[0], {"E", "G", "ρ"}) && is_one_of(letters[1], {"A", "I", "J"});
}

/// θ1 → θ with 1 below; mt → m with t below; mt1 → m with t1 below. A word keeps its letters.
void take_index(SymbolName& name, std::string_view head) {
  std::size_t digits = head.size();
  while (digits > 0 && is_digit(head[digits - 1])) --digits;
  if (digits == 0) digits = head.size();
  const auto letters = letters_of(head.substr(0, digits));
  const bool two = letters.size() == 2 && !is_digit(letters[1].front()) && !is_of_cross_section(letters);
  const std::size_t cut = two ? letters[0].size() : digits;
  name.body = head.substr(0, cut);
  if (cut < head.size()) name.below.emplace_back(head.substr(cut));
}

}  // namespace

SymbolName split_name(std::string_view name) {
  SymbolName result;
  // Components on body axes have numbers, as in Euler's equations: ω.x is ω_1.
  constexpr std::array<std::pair<std::string_view, std::string_view>, 3> on_axes{
      {{"ω.x", "1"}, {"ω.y", "2"}, {"ω.z", "3"}}};
  for (const auto& [component, number] : on_axes)
    if (name == component) return {"ω", {std::string(number)}};
  if (const std::size_t dot = name.find('.'); dot != std::string_view::npos && dot > 0 && dot + 1 < name.size()) {
    result = split_name(name.substr(dot + 1));
    result.below.emplace_back(name.substr(0, dot));
    return result;
  }
  const auto parts = parts_of(name);
  if (parts.empty() || name.front() == '_') return {std::string(name), {}};
  take_index(result, parts.front());
  result.below.insert(result.below.end(), parts.begin() + 1, parts.end());
  return result;
}

std::string name_within_body(std::string_view name, std::string_view body) {
  if (is_integral(name)) name.remove_prefix(integral_sign.size());
  const std::string prefix = std::string(body) + ".";
  if (name.substr(0, prefix.size()) == prefix) return std::string(name.substr(prefix.size()));
  if (name.substr(0, prefix.size() + 2) == "p_" + prefix) return "p_" + std::string(name.substr(prefix.size() + 2));
  return {};
}

ShownSymbol shown_symbol(Expr symbol, const std::string& within_body) {
  const std::string& name = symbol.name();
  const bool primes = symbol.order() > 0 && independent_name(symbol.context()) != "t";
  const bool quantity = symbol.order() > 0 && is_integral(name);
  const std::string shown = !within_body.empty() ? within_body : quantity ? name.substr(integral_sign.size()) : name;
  return {shown, symbol.order() - (quantity ? 1 : 0), primes};
}

std::string independent_name(Context& context) {
  const NodeId time = context.storage().time;  // printing makes no symbol
  return time ? Expr(&context, time).name() : "t";
}

QuantityName split_quantity(std::string_view name) {
  std::size_t space = 0;  // the first one outside brackets: (10 pi) rad/s
  for (int depth = 0; space < name.size() && (depth > 0 || name[space] != ' '); ++space)
    depth += name[space] == '(' ? 1 : name[space] == ')' ? -1 : 0;
  if (space == name.size()) return {std::string(name), {}};
  std::string unit(name.substr(space + 1));
  if (unit.size() > 2 && unit.front() == '[' && unit.back() == ']') unit = unit.substr(1, unit.size() - 2);
  return {std::string(name.substr(0, space)), unit};
}

}  // namespace maupertuis::print
