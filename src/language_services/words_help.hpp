#pragma once
#include <maupertuis/language_services.hpp>

#include <span>
#include <string_view>

namespace maupertuis::language {

/// Words of the language with their forms: those that begin statements, and those that stand behind one of them.
std::span<const WordHelp> word_table();
/// The entry that begins a statement.
const WordHelp* find_statement_word(std::string_view word);
/// The entry of a word behind a statement word; null where it has no meaning there.
const WordHelp* find_word_in(std::string_view word, std::string_view statement);
bool stands_in(const WordHelp& entry, std::string_view statement);

struct FunctionHelp {
  std::string_view name, parameters, help;  // parameters: "y, x"
};
std::span<const FunctionHelp> function_table();
const FunctionHelp* find_function_help(std::string_view name);

/// Statements with places to fill in.
struct SnippetHelp {
  std::string_view label, detail, text;
};
std::span<const SnippetHelp> snippet_table();

}  // namespace maupertuis::language
