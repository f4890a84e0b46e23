#pragma once
#include "random.hpp"

#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace maupertuis::fuzz {

/// The model language as docs/manual/grammar.ebnf says it (ISO 14977), from which sentences are drawn.
class Grammar {
 public:
  /// Throws std::runtime_error where the text is no grammar.
  explicit Grammar(const std::string& ebnf);

  /// A sentence of a rule. `names`: for the rule `name`, so that what is used was often declared. Deep rules come to an
  /// end by themselves.
  std::string sentence(const std::string& rule, const std::vector<std::string>& names, Random& random) const;

  const std::set<std::string>& words() const { return words_; }
  bool has(const std::string& rule) const { return rules_.count(rule) != 0; }

  struct Node {
    enum class Kind { Word, Rule, All, One, Maybe, Many, Free } kind = Kind::Word;
    std::string text;  // of a word, a rule, a description in words
    std::vector<Node> parts;
  };

 private:
  std::map<std::string, Node> rules_;
  std::set<std::string> words_;
};

}  // namespace maupertuis::fuzz
