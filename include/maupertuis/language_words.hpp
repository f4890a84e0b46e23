#pragma once
#include <span>
#include <string>
#include <string_view>

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

bool is_statement_word(std::string_view word);
bool is_clause_word(std::string_view word);
const Function* find_function(std::string_view word);

/// Names with a meaning of their own that a model need not declare: t, pi, O.
bool is_predefined(std::string_view word);

/// theta → θ, theta_1 → θ1, θ_1 → θ1, Omega → Ω; any other name as it is; π → pi.
std::string normalize_name(std::string name);
/// The same backwards, as a keyboard without Greek letters types it: θ1 → theta1; any other name as it is.
std::string spelled_out(const std::string& name);

}  // namespace maupertuis::syntax
