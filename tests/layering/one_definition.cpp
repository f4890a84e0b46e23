// Two classes of one name in one namespace, defined in two files, are one class to the linker: it keeps one of the two
// destructors and copy constructors, and the other file runs it on its own objects. Nothing warns. Classes of one file
// alone stand in unnamed namespaces.
#include "source_tree.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cctype>
#include <iterator>
#include <map>
#include <regex>
#include <set>

namespace {

/// Of a build only one of these is compiled.
const std::set<std::string> alternatives{"src/integrator/stiff/absent.cpp"};

/// The text without comments, literals and directives; line breaks stay.
std::string bare(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool line_begin =
        out.find_last_not_of(" \t") == std::string::npos || out[out.find_last_not_of(" \t")] == '\n';
    if (text.compare(i, 2, "//") == 0 || (text[i] == '#' && line_begin)) {
      const bool directive = text[i] == '#';
      while (i < text.size() && (text[i] != '\n' || (directive && text[i - 1] == '\\'))) ++i;
      out += '\n';
    } else if (text.compare(i, 2, "/*") == 0) {
      i = std::min(text.find("*/", i), text.size() - 2) + 1;
    } else if (text.compare(i, 2, "R\"") == 0 && (i == 0 || !std::isalnum(static_cast<unsigned char>(text[i - 1])))) {
      const std::size_t open = text.find('(', i);
      const std::string close = ")" + text.substr(i + 2, open - i - 2) + "\"";
      i = text.find(close, open) + close.size() - 1;
    } else if (text[i] == '"' ||
               (text[i] == '\'' && !(i > 0 && std::isdigit(static_cast<unsigned char>(text[i - 1]))))) {
      const char mark = text[i];
      for (++i; i < text.size() && text[i] != mark; ++i) i += text[i] == '\\';
      out += ' ';
    } else {
      out += text[i];
    }
  }
  return out;
}

std::string trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(" \t\n"), end = text.find_last_not_of(" \t\n");
  return begin == std::string::npos ? std::string() : text.substr(begin, end - begin + 1);
}

struct Scope {
  enum class Kind { Namespace, Type, Other } kind = Kind::Other;
  std::string name;  // empty: an unnamed namespace
};

/// What the words before an opening brace open.
Scope opened_by(std::string head) {
  static const std::regex space(R"((?:inline\s+)?namespace\s*([\w:]*))"),
      of_template(R"(template\s*<[^{}]*>\s*(?=struct|class|union))"),
      type(
          R"((?:struct|class|union|enum|enum\s+class)\s+(?:alignas\([^)]*\)\s*)?([\w:]+(?:\s*<[^{}]*>)?)(?:\s+final)?)"
          R"(\s*(?::[^{}]*)?)");
  std::smatch m;
  head = trimmed(head);
  if (std::regex_match(head, m, space)) return {Scope::Kind::Namespace, m[1]};
  head = trimmed(std::regex_replace(head, of_template, ""));
  if (head.size() < 2000 && std::regex_match(head, m, type)) return {Scope::Kind::Type, m[1]};
  return {};
}

/// The classes that a file defines in named namespaces, each with its namespaces before it.
std::set<std::string> classes_of(const std::string& text) {
  std::set<std::string> found;
  std::vector<Scope> scopes;
  const std::string code = bare(text);
  std::size_t begin = 0;
  for (std::size_t i = 0; i < code.size(); ++i) {
    if (code[i] != '{' && code[i] != '}' && code[i] != ';') continue;
    if (code[i] == '{') {
      const Scope scope = opened_by(code.substr(begin, i - begin));
      bool named = true;
      std::string name;
      for (const Scope& outer : scopes) {
        named = named && outer.kind == Scope::Kind::Namespace && !outer.name.empty();
        name += outer.name + "::";
      }
      if (named && scope.kind == Scope::Kind::Type) found.insert(name + scope.name);
      scopes.push_back(scope);
    } else if (code[i] == '}' && !scopes.empty()) {
      scopes.pop_back();
    }
    begin = i + 1;
  }
  return found;
}

std::string text_of(const source_tree::File& file) {
  std::string text;
  for (const std::string& line : file.lines) text += line + "\n";
  return text;
}

/// Class → the files that define it, where there are several.
std::map<std::string, std::vector<std::string>> defined_twice(const std::vector<source_tree::File>& files,
                                                              std::size_t* classes = nullptr) {
  std::map<std::string, std::vector<std::string>> places;
  for (const source_tree::File& file : files)
    if (!alternatives.count(file.path))
      for (const std::string& name : classes_of(text_of(file))) places[name].push_back(file.path);
  if (classes) *classes = places.size();
  for (auto it = places.begin(); it != places.end();) it = it->second.size() > 1 ? std::next(it) : places.erase(it);
  return places;
}

}  // namespace

TEST_CASE("no class is defined twice in one namespace") {
  std::size_t classes = 0;
  for (const auto& [name, files] : defined_twice(source_tree::sources({"src", "include", "apps", "tests"}), &classes))
    FAIL_CHECK(files[0] << " and " << files[1] << ": " << name
                        << " is defined in both; put one into an unnamed namespace, or rename it");
  CHECK(classes > 500);
}

TEST_CASE("classes of one name are seen through namespaces, templates, comments and literals") {
  using Names = std::set<std::string>;
  CHECK(classes_of("namespace a::b { struct S { struct Inner {}; int f() { struct Local {}; } }; }") ==
        Names{"a::b::S"});
  CHECK(classes_of("namespace a { namespace { class S : public T<int> {}; } class U final : V {}; }") == Names{"a::U"});
  CHECK(classes_of("namespace a { template <class T, int n = 3> struct S {}; template <> struct S<int> {}; enum class "
                   "E { A }; }") == Names{"a::S", "a::S<int>", "a::E"});
  CHECK(classes_of("namespace a { struct S* f() { return {}; } struct T; const char* x = \"struct U {\"; // struct V "
                   "{\n/* struct W { */ }")
            .empty());
  CHECK(classes_of("namespace a { struct S::Impl { int x = 1'000; char c = '{'; }; }") == Names{"a::S::Impl"});
  CHECK(classes_of("#define X struct Y { \\\n }\nnamespace a { auto r = R\"(struct Z {)\"; struct S {}; }") ==
        Names{"a::S"});
  const auto file = [](const char* path, const char* text) { return source_tree::File{path, {text}}; };
  CHECK(defined_twice({file("x.cpp", "namespace a { class L {}; }"), file("y.hpp", "namespace a { struct L {}; }")})
            .size() == 1);
  CHECK(defined_twice(
            {file("x.cpp", "namespace a { namespace { class L {}; } }"), file("y.hpp", "namespace a { struct L {}; }")})
            .empty());
  CHECK(defined_twice({file("x.cpp", "namespace a { class L {}; }"), file("y.hpp", "namespace b { struct L {}; }")})
            .empty());
}
