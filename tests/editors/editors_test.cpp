// The grammars of editors/ know the words of the parser, all of them and no others; the snippets are those of
// completion. With MAUP_PROMOTE=1 the file of the snippets is written anew.
#include <maupertuis/language_services.hpp>
#include <maupertuis/language_words.hpp>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <cstdlib>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>

namespace {

using namespace maupertuis;
using Words = std::set<std::string>;

const std::string folder = std::string(PROJECT_DIR) + "/editors/";

std::string read(const std::string& name) {
  std::ifstream in(folder + name);
  REQUIRE(in.good());
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

template <class List>
Words as_words(const List& list) {
  return {list.begin(), list.end()};
}

Words statements() { return as_words(syntax::statement_words()); }
Words clauses() { return as_words(syntax::clause_words()); }
Words functions() {
  Words out;
  for (const syntax::Function& function : syntax::functions()) out.insert(std::string(function.name));
  return out;
}
/// Words that are not reserved, and have a meaning behind a statement word. Letters alone are names of quantities.
Words others() {
  Words out;
  for (const language::WordHelp& word : language::words()) {
    const std::string text(word.word);
    if (!word.statements.empty() && text.size() > 1 && !clauses().count(text) && !functions().count(text))
      out.insert(text);
  }
  return out;
}

Words letters_of(const Words& words, bool letters) {
  Words out;
  for (const std::string& word : words)
    if ((word.size() == 1) == letters) out.insert(word);
  return out;
}

/// The words between the brackets of (a|b|c).
Words alternatives(const std::string& pattern) {
  std::smatch m;
  REQUIRE(std::regex_search(pattern, m, std::regex(R"(\(([a-zA-Z0-9_|\\]+)\))")));
  Words out;
  std::istringstream in(std::regex_replace(m[1].str(), std::regex(R"(\\\||\\|\|)"), " "));
  for (std::string word; in >> word;) out.insert(word);
  return out;
}

Words joined(Words a, const Words& b) {
  a.insert(b.begin(), b.end());
  return a;
}

}  // namespace

TEST_CASE("Visual Studio Code: the grammar has the words of the language") {
  const auto grammar = nlohmann::json::parse(read("vscode/syntaxes/lag.tmLanguage.json"));
  CHECK(grammar["scopeName"] == "source.lag");
  const auto pattern = [&](const char* name) { return grammar["repository"][name]["match"].get<std::string>(); };
  CHECK(alternatives(pattern("clause")) == clauses());
  CHECK(alternatives(pattern("function")) == functions());
  CHECK(alternatives(pattern("word")) == others());
  Words begin;
  for (const auto& rule : grammar["patterns"])
    if (rule.contains("name") && rule["name"] == "keyword.control.lag")
      begin = joined(begin, alternatives(rule["match"]));
  CHECK(begin == statements());
}

TEST_CASE("Visual Studio Code: the files that package.json names are there, for the language lag") {
  const auto package = nlohmann::json::parse(read("vscode/package.json"));
  const auto& contributes = package["contributes"];
  CHECK(contributes["languages"][0]["extensions"][0] == ".lag");
  for (const auto& path : {contributes["languages"][0]["configuration"], contributes["grammars"][0]["path"],
                           contributes["snippets"][0]["path"]})
    CHECK(!read("vscode/" + path.get<std::string>()).empty());
  CHECK(nlohmann::json::accept(read("vscode/language-configuration.json")));
}

TEST_CASE("Visual Studio Code: the snippets are those that completion offers") {
  language::Document empty{SourceText("", "")};
  nlohmann::ordered_json wanted;
  for (const language::Completion& c : language::complete(empty, 0).items) {
    if (!c.snippet) continue;
    nlohmann::ordered_json body = nlohmann::ordered_json::array();
    std::istringstream in(c.insert);
    for (std::string line; std::getline(in, line);) body.push_back(line);
    wanted[c.label] = {{"prefix", c.label}, {"description", c.detail}, {"body", body}};
  }
  const std::string text = wanted.dump(2) + "\n";
  if (std::getenv("MAUP_PROMOTE")) std::ofstream(folder + "vscode/snippets/lag.json") << text;
  CHECK(read("vscode/snippets/lag.json") == text);
}

TEST_CASE("Vim: the syntax has the words of the language") {
  std::istringstream in(read("vim/syntax/lag.vim"));
  Words begin, words, known;
  const std::regex keyword(R"(syntax keyword (lagWord|lagFunction) (.*))"),
      statement(R"(syntax match lagStatement /\^\\s\*\\zs(\w+)\\ze.*)"),
      letters(R"(syntax match lagStatement /\^\\s\*\\zs\[(\w+)\].*)");
  for (std::string line; std::getline(in, line);) {
    std::smatch m;
    if (std::regex_match(line, m, statement)) begin.insert(m[1]);
    if (std::regex_match(line, m, letters))
      for (const char c : m[1].str()) begin.insert(std::string(1, c));
    if (std::regex_match(line, m, keyword)) {
      std::istringstream list(m[2]);
      for (std::string word; list >> word;) (m[1] == "lagWord" ? words : known).insert(word);
    }
    const bool of_functions = line.rfind("syntax match lagFunction ", 0) == 0;
    if (of_functions || line.rfind("syntax match lagWord ", 0) == 0) {
      Words& into = of_functions ? known : words;
      const std::size_t open = line.find("\\("), close = line.find("\\)");
      into = joined(into, alternatives("(" + line.substr(open + 2, close - open - 2) + ")"));
    }
  }
  CHECK(begin == statements());
  CHECK(words == joined(clauses(), others()));
  CHECK(known == functions());
}

TEST_CASE("Emacs: the mode has the words of the language") {
  const std::string mode = read("emacs/lag-mode.el");
  const auto list = [&](const std::string& name) {
    const std::size_t begin = mode.find("(defconst " + name + "\n"), end = mode.find(")\n", begin);
    REQUIRE(begin != std::string::npos);
    const std::string text = mode.substr(begin, end - begin);
    Words out;
    const std::regex word("\"(\\w+)\"");
    for (std::sregex_iterator it(text.begin(), text.end(), word), last; it != last; ++it) out.insert((*it)[1]);
    return out;
  };
  CHECK(list("lag-statement-words") == letters_of(statements(), false));
  CHECK(list("lag-energy-words") == letters_of(statements(), true));
  CHECK(list("lag-words") == joined(clauses(), others()));
  CHECK(list("lag-functions") == functions());
}
