#pragma once
#include <maupertuis/syntax_tree.hpp>

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// The words of the model language. docs/manual/grammar.ebnf lists the same words; a test compares the two.
namespace maupertuis::syntax {

/// Begin a statement; reserved at the start of a line only.
std::span<const std::string_view> statement_words();
/// End a formula inside a statement; never names.
std::span<const std::string_view> clause_words();

struct Function {
  std::string_view name;
  int least = 1, most = 1;  // arguments; most 0: any number
  bool bare = false;        // circular and hyperbolic: may stand without brackets
};
std::span<const Function> functions();

/// `asin` for arcsin, `log` for ln; empty for words that are no function elsewhere either.
std::string_view function_of_habit(std::string_view word);
/// The same for those that take another form here: `log(x)/log(10)` for log10.
std::string_view formula_of_habit(std::string_view word);

bool is_statement_word(std::string_view word);
bool is_clause_word(std::string_view word);
const Function* find_function(std::string_view word);
/// conj, re, im: functions in models with complex fields alone.
const Function* find_complex_function(std::string_view word);

/// T, V, U, L, D and their long names.
std::optional<EnergyStatement::Which> energy_of(std::string_view word);
/// `kinetic` for `T`, ...
std::string_view long_energy_name(EnergyStatement::Which which);
bool is_short_energy(std::string_view word);

/// Names with a meaning of their own that a model need not declare: t, pi, O.
bool is_predefined(std::string_view word);

std::vector<std::string> as_strings(std::span<const std::string_view> words);

/// theta → θ, theta_1 → θ1, θ_1 → θ1, Omega → Ω; any other name as it is; π → pi.
std::string normalize_name(std::string name);

}  // namespace maupertuis::syntax
