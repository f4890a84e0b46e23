// A public header brings the standard header of every class that it names, itself or by the public headers that it
// includes. The consumer test compiles each of them alone, with these standard headers compiled beforehand, so it
// cannot see that.
#include "source_tree.hpp"

#include <doctest/doctest.h>

#include <map>
#include <regex>
#include <set>

namespace {

const std::map<std::string, std::string> headers_of_classes{{"array", "array"},
                                                            {"atomic", "atomic"},
                                                            {"complex", "complex"},
                                                            {"deque", "deque"},
                                                            {"function", "functional"},
                                                            {"map", "map"},
                                                            {"optional", "optional"},
                                                            {"set", "set"},
                                                            {"shared_ptr", "memory"},
                                                            {"span", "span"},
                                                            {"string", "string"},
                                                            {"string_view", "string_view"},
                                                            {"tuple", "tuple"},
                                                            {"unique_ptr", "memory"},
                                                            {"unordered_map", "unordered_map"},
                                                            {"unordered_set", "unordered_set"},
                                                            {"variant", "variant"},
                                                            {"vector", "vector"}};

struct Header {
  std::set<std::string> includes, classes;
};

Header look_at(const source_tree::File& file) {
  static const std::regex include(R"re(#include <([a-z_0-9/.]+)>.*)re"), name(R"re(std::([a-z_]+))re");
  Header found;
  for (const std::string& line : file.lines) {
    std::smatch m;
    if (std::regex_match(line, m, include)) found.includes.insert(m[1]);
    const std::string code = line.substr(0, line.find("//"));
    for (std::sregex_iterator it(code.begin(), code.end(), name), end; it != end; ++it)
      if (headers_of_classes.contains((*it)[1])) found.classes.insert((*it)[1]);
  }
  return found;
}

using Headers = std::map<std::string, Header>;  // by the name that stands in an #include

void gather(const Headers& headers, const std::string& name, std::set<std::string>& brought) {
  if (!brought.insert(name).second) return;
  if (const auto header = headers.find(name); header != headers.end())
    for (const std::string& next : header->second.includes) gather(headers, next, brought);
}

}  // namespace

TEST_CASE("a public header brings the standard headers of the classes that it names") {
  Headers headers;
  for (const source_tree::File& file : source_tree::sources({"include"}))
    headers.emplace(file.path.substr(std::string("include/").size()), look_at(file));
  REQUIRE(headers.size() > 100);
  for (const auto& [name, header] : headers) {
    std::set<std::string> brought;
    gather(headers, name, brought);
    for (const std::string& used : header.classes)
      if (!brought.contains(headers_of_classes.at(used)))
        FAIL_CHECK(name << " names std::" << used << " and brings no <" << headers_of_classes.at(used) << ">");
  }
}
