#include <doctest/doctest.h>

#include "syntax/words.hpp"

#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>

using namespace maupertuis::syntax;

namespace {

using Words = std::set<std::string>;

// The words in quotes of every rule of docs/manual/grammar.ebnf.
std::map<std::string, Words> rules() {
  std::ostringstream stream;
  stream << std::ifstream(PROJECT_DIR "/docs/manual/grammar.ebnf").rdbuf();
  const std::string text = std::regex_replace(stream.str(), std::regex("\\(\\*[^]*?\\*\\)"), "");
  std::map<std::string, Words> found;
  const std::regex rule("([a-z ]+?) *= ((?:\"[^\"]*\"|'[^']*'|[^\";'])*);");
  const std::regex word("\"([A-Za-z_][A-Za-z_0-9]*)\"");
  for (std::sregex_iterator i(text.begin(), text.end(), rule), end; i != end; ++i) {
    const std::string body = (*i)[2];
    Words& words = found[std::regex_replace((*i)[1].str(), std::regex("^ +"), "")];
    for (std::sregex_iterator w(body.begin(), body.end(), word); w != end; ++w) words.insert((*w)[1]);
  }
  return found;
}

Words set_of(std::span<const std::string_view> words) { return {words.begin(), words.end()}; }

}  // namespace

TEST_CASE("the grammar file and the parser have the same words") {
  const auto grammar = rules();
  REQUIRE(grammar.size() > 50);
  CHECK(grammar.at("statement word") == set_of(statement_words()));
  CHECK(grammar.at("clause word") == set_of(clause_words()));
  Words all, bare;
  for (const Function& function : functions()) {
    all.emplace(function.name);
    if (function.bare) bare.emplace(function.name);
  }
  Words written = grammar.at("function");
  written.insert(grammar.at("bare function").begin(), grammar.at("bare function").end());
  CHECK(written == all);
  CHECK(grammar.at("bare function") == bare);
}

TEST_CASE("every word of the grammar file stands in a rule that uses it") {
  Words used;
  for (const auto& [name, words] : rules()) {
    if (name != "statement word" && name != "clause word") used.insert(words.begin(), words.end());
  }
  for (const std::string_view word : statement_words())
    CHECK_MESSAGE(used.count(std::string(word)) == 1, std::string(word));
  for (const std::string_view word : clause_words())
    CHECK_MESSAGE(used.count(std::string(word)) == 1, std::string(word));
}
