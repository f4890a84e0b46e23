#pragma once
#include <maupertuis/language_words.hpp>
#include <maupertuis/syntax_tree.hpp>

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// What else there is to know about words (language_words.hpp).
namespace maupertuis::syntax {

/// `asin` for arcsin, `log` for ln; empty for words that are no function elsewhere either.
std::string_view function_of_habit(std::string_view word);
/// The same for those that take another form here: `log(x)/log(10)` for log10.
std::string_view formula_of_habit(std::string_view word);

/// conj, re, im: functions in models with complex fields alone.
const Function* find_complex_function(std::string_view word);

/// T, V, U, L, D and their long names.
std::optional<EnergyStatement::Which> energy_of(std::string_view word);
/// `kinetic` for `T`, ...
std::string_view long_energy_name(EnergyStatement::Which which);
bool is_short_energy(std::string_view word);

std::vector<std::string> as_strings(std::span<const std::string_view> words);

}  // namespace maupertuis::syntax
