#include "syntax/words.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

namespace maupertuis::syntax {
namespace {

using namespace std::string_view_literals;

constexpr std::array kStatementWords = {
    "system"sv,
    "source"sv,
    "note"sv,
    "dimensionless"sv,
    "param"sv,
    "coord"sv,
    "let"sv,
    "input"sv,
    "frame"sv,
    "point"sv,
    "body"sv,
    "gravity"sv,
    "spring"sv,
    "damper"sv,
    "torsion"sv,
    "T"sv,
    "V"sv,
    "U"sv,
    "L"sv,
    "D"sv,
    "kinetic"sv,
    "potential"sv,
    "generalized_potential"sv,
    "lagrangian"sv,
    "dissipation"sv,
    "force"sv,
    "torque"sv,
    "friction"sv,
    "constraint"sv,
    "gauge"sv,
    "reaction"sv,
    "contact"sv,
    "impact"sv,
    "event"sv,
    "start"sv,
    "run"sv,
    "output"sv,
    "method"sv,
    "precision"sv,
    "sweep"sv,
    "draw"sv,
    "independent"sv,
    "path"sv,
    "rates"sv,
    "field"sv,
    "density"sv,
    "boundary"sv,
    "expect"sv,
    "claim"sv,
};

constexpr std::array kClauseWords = {
    "name"sv,    "at"sv,       "in"sv,          "mass"sv,     "length"sv,   "stiffness"sv, "coefficient"sv,
    "inertia"sv, "rotation"sv, "restitution"sv, "friction"sv, "static"sv,   "slip"sv,      "normal"sv,
    "limit"sv,   "when"sv,     "rising"sv,      "falling"sv,  "within"sv,   "rel"sv,       "on"sv,
    "from"sv,    "to"sv,       "by"sv,          "steps"sv,    "cells"sv,    "boundary"sv,  "rest"sv,
    "angle"sv,   "axis"sv,     "until"sv,       "every"sv,    "exactly"sv,  "is"sv,        "not"sv,
    "and"sv,     "or"sv,       "else"sv,        "where"sv,    "sticking"sv, "with"sv,
};

constexpr Function kFunctions[] = {
    {"sin", 1, 1, true},
    {"cos", 1, 1, true},
    {"tan", 1, 1, true},
    {"sec", 1, 1, true},
    {"csc", 1, 1, true},
    {"cot", 1, 1, true},
    {"sinh", 1, 1, true},
    {"cosh", 1, 1, true},
    {"tanh", 1, 1, true},
    {"sech", 1, 1, true},
    {"asin"},
    {"acos"},
    {"atan"},
    {"atan2", 2, 2},
    {"asinh"},
    {"acosh"},
    {"atanh"},
    {"exp"},
    {"log"},
    {"erf"},
    {"lambert_w"},
    {"sqrt"},
    {"abs"},
    {"sign"},
    {"min", 2, 0},
    {"max", 2, 0},
    {"step"},
    {"piecewise", 1, 0},
    {"dot", 1, 2},
    {"cross", 2, 2},
    {"norm"},
    {"multiplier"},
    {"reaction"},
};

constexpr std::array<std::pair<std::string_view, std::string_view>, 35> kGreek = {{
    {"alpha", "α"}, {"beta", "β"},    {"gamma", "γ"},   {"delta", "δ"},  {"epsilon", "ε"}, {"zeta", "ζ"},
    {"eta", "η"},   {"theta", "θ"},   {"iota", "ι"},    {"kappa", "κ"},  {"lambda", "λ"},  {"mu", "μ"},
    {"nu", "ν"},    {"xi", "ξ"},      {"omicron", "ο"}, {"pi", "π"},     {"rho", "ρ"},     {"sigma", "σ"},
    {"tau", "τ"},   {"upsilon", "υ"}, {"phi", "φ"},     {"chi", "χ"},    {"psi", "ψ"},     {"omega", "ω"},
    {"Gamma", "Γ"}, {"Delta", "Δ"},   {"Theta", "Θ"},   {"Lambda", "Λ"}, {"Xi", "Ξ"},      {"Pi", "Π"},
    {"Sigma", "Σ"}, {"Upsilon", "Υ"}, {"Phi", "Φ"},     {"Psi", "Ψ"},    {"Omega", "Ω"},
}};

bool all_digits(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

// The letter that `stem` names or is; empty when it is neither.
std::string_view greek_letter(std::string_view stem) {
  for (const auto& [word, letter] : kGreek) {
    if (stem == word || stem == letter) return letter;
  }
  return {};
}

constexpr std::array<std::pair<std::string_view, EnergyStatement::Which>, 10> kEnergies = {{
    {"T", EnergyStatement::Which::T},
    {"V", EnergyStatement::Which::V},
    {"U", EnergyStatement::Which::U},
    {"L", EnergyStatement::Which::L},
    {"D", EnergyStatement::Which::D},
    {"kinetic", EnergyStatement::Which::T},
    {"potential", EnergyStatement::Which::V},
    {"generalized_potential", EnergyStatement::Which::U},
    {"lagrangian", EnergyStatement::Which::L},
    {"dissipation", EnergyStatement::Which::D},
}};

using Pair = std::pair<std::string_view, std::string_view>;

// Functions of textbooks and of other languages.
constexpr Pair kFunctionHabits[] = {
    {"ln", "log"},
    {"Log", "log"},
    {"Ln", "log"},
    {"Exp", "exp"},
    {"Sqrt", "sqrt"},
    {"root", "sqrt"},
    {"Abs", "abs"},
    {"fabs", "abs"},
    {"sgn", "sign"},
    {"Sign", "sign"},
    {"signum", "sign"},
    {"sine", "sin"},
    {"cosine", "cos"},
    {"tangent", "tan"},
    {"Sin", "sin"},
    {"Cos", "cos"},
    {"Tan", "tan"},
    {"SIN", "sin"},
    {"COS", "cos"},
    {"TAN", "tan"},
    {"tg", "tan"},
    {"ctg", "cot"},
    {"cotan", "cot"},
    {"cosec", "csc"},
    {"arcsin", "asin"},
    {"arccos", "acos"},
    {"arctan", "atan"},
    {"arctg", "atan"},
    {"arctan2", "atan2"},
    {"Arcsin", "asin"},
    {"Arccos", "acos"},
    {"Arctan", "atan"},
    {"arsinh", "asinh"},
    {"arcosh", "acosh"},
    {"artanh", "atanh"},
    {"arcsinh", "asinh"},
    {"arccosh", "acosh"},
    {"arctanh", "atanh"},
    {"sh", "sinh"},
    {"ch", "cosh"},
    {"th", "tanh"},
    {"heaviside", "step"},
    {"Heaviside", "step"},
    {"lambertw", "lambert_w"},
    {"LambertW", "lambert_w"},
};
constexpr Pair kFormulaHabits[] = {
    {"log10", "log(x)/log(10)"},
    {"lg", "log(x)/log(10)"},
    {"log2", "log(x)/log(2)"},
    {"pow", "x^2 for pow(x, 2)"},
    {"sqr", "x^2"},
    {"square", "x^2"},
    {"cbrt", "x^(1/3)"},
    {"csch", "1/sinh(x)"},
    {"coth", "1/tanh(x)"},
    {"if", "piecewise(x < 0 : a, else : b)"},
    {"diff", "x' for diff(x, t)"},
    {"Derivative", "x' for Derivative(x, t)"},
    {"derivative", "x' for derivative(x, t)"},
    {"vec", "the components in brackets: (a, b)"},
};

std::string_view find_in(std::span<const Pair> pairs, std::string_view word) {
  const auto found = std::find_if(pairs.begin(), pairs.end(), [&](const Pair& pair) { return pair.first == word; });
  return found == pairs.end() ? std::string_view() : found->second;
}

}  // namespace

std::string_view function_of_habit(std::string_view word) { return find_in(kFunctionHabits, word); }
std::string_view formula_of_habit(std::string_view word) { return find_in(kFormulaHabits, word); }

std::span<const std::string_view> statement_words() { return kStatementWords; }
std::span<const std::string_view> clause_words() { return kClauseWords; }
std::span<const Function> functions() { return kFunctions; }

bool is_statement_word(std::string_view word) {
  return std::find(kStatementWords.begin(), kStatementWords.end(), word) != kStatementWords.end();
}

bool is_clause_word(std::string_view word) {
  return std::find(kClauseWords.begin(), kClauseWords.end(), word) != kClauseWords.end();
}

const Function* find_function(std::string_view word) {
  const auto found =
      std::find_if(std::begin(kFunctions), std::end(kFunctions), [&](const Function& f) { return f.name == word; });
  return found == std::end(kFunctions) ? nullptr : &*found;
}

const Function* find_complex_function(std::string_view word) {
  static constexpr Function functions[] = {{"conj"}, {"re"}, {"im"}};
  const auto found =
      std::find_if(std::begin(functions), std::end(functions), [&](const Function& f) { return f.name == word; });
  return found == std::end(functions) ? nullptr : &*found;
}

std::optional<EnergyStatement::Which> energy_of(std::string_view word) {
  for (const auto& [name, which] : kEnergies) {
    if (name == word) return which;
  }
  return std::nullopt;
}

std::string_view long_energy_name(EnergyStatement::Which which) {
  const auto long_names_begin = kEnergies.begin() + 5;
  return (long_names_begin + static_cast<int>(which))->first;
}

bool is_short_energy(std::string_view word) { return word.size() == 1 && energy_of(word).has_value(); }

bool is_predefined(std::string_view word) { return word == "t" || word == "pi" || word == "O"; }

std::vector<std::string> as_strings(std::span<const std::string_view> words) { return {words.begin(), words.end()}; }

std::string normalize_name(std::string name) {
  // The stem is what stands before the digits or the underscore: theta|1, theta|_rod. Greek letters are not ASCII,
  // so the scan stops at the first ASCII digit or underscore only.
  const std::size_t stem_length = std::min(name.find_first_of("0123456789_"), name.size());
  const std::string_view letter = greek_letter(std::string_view(name).substr(0, stem_length));
  if (letter.empty()) return name;
  std::string_view tail = std::string_view(name).substr(stem_length);
  if (!tail.empty() && tail.front() != '_' && !all_digits(tail.substr(0, std::min(tail.find('_'), tail.size()))))
    return name;
  if (tail.empty() && letter == "π") return "pi";
  if (tail.size() > 1 && tail.front() == '_' && all_digits(tail.substr(1))) tail.remove_prefix(1);
  return std::string(letter) + std::string(tail);
}

std::string spelled_out(const std::string& name) {
  for (const auto& [word, letter] : kGreek)
    if (name.compare(0, letter.size(), letter) == 0) return std::string(word) + name.substr(letter.size());
  return name;
}

}  // namespace maupertuis::syntax
