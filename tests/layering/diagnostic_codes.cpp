// Every code that the sources give has its entry in a catalogue (codes.cpp), and every entry is given somewhere.
#include "source_tree.hpp"

#include <doctest/doctest.h>

#include <map>
#include <regex>

namespace {

/// Code → the first place that names it.
using Places = std::map<std::string, std::string>;

bool is_catalogue(const source_tree::File& file) { return std::filesystem::path(file.path).filename() == "codes.cpp"; }

/// An entry opens an initializer: {"E0101", "title", …}, on the line of the brace or on the next one.
Places entries() {
  Places found;
  const std::regex entry(R"re(.*\{\s*"([EWN]\d{4})",.*)re"), continued(R"re(\s*"([EWN]\d{4})",.*)re"),
      open(R"re(.*\{\s*)re");
  for (const source_tree::File& file : source_tree::sources({"src", "apps"})) {
    if (!is_catalogue(file)) continue;
    for (std::size_t i = 0; i < file.lines.size(); ++i) {
      std::smatch m;
      const bool follows = i > 0 && std::regex_match(file.lines[i - 1], open);
      if (!std::regex_match(file.lines[i], m, entry) && !(follows && std::regex_match(file.lines[i], m, continued)))
        continue;
      const std::string place = file.path + ":" + std::to_string(i + 1);
      CHECK_MESSAGE(found.emplace(m[1], place).second, place << ": " << m[1].str() << " has two entries");
    }
  }
  return found;
}

Places uses() {
  Places found;
  const std::regex code(R"re("([EWN]\d{4})")re");
  for (const source_tree::File& file : source_tree::sources({"src", "apps"})) {
    if (is_catalogue(file)) continue;
    for (std::size_t i = 0; i < file.lines.size(); ++i)
      for (std::sregex_iterator it(file.lines[i].begin(), file.lines[i].end(), code), end; it != end; ++it)
        found.emplace((*it)[1], file.path + ":" + std::to_string(i + 1));
  }
  return found;
}

}  // namespace

TEST_CASE("every diagnostic code has one entry, and every entry is used") {
  const Places in_catalogue = entries(), in_sources = uses();
  REQUIRE(in_sources.size() > 20);
  for (const auto& [code, place] : in_sources)
    if (!in_catalogue.count(code)) FAIL_CHECK(place << ": " << code << " has no entry for `maup explain`");
  for (const auto& [code, place] : in_catalogue)
    if (!in_sources.count(code)) FAIL_CHECK(place << ": " << code << " is never given");
}
