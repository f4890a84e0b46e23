#include "grammar.hpp"

#include <cctype>
#include <stdexcept>

namespace maupertuis::fuzz {
namespace {

using Node = Grammar::Node;
using Kind = Node::Kind;

/// ISO 14977 as far as the grammar of models uses it: , | [ ] { } ( ) "…" '…' ? … ? (* … *), and an exception `- …`,
/// which is passed over.
class Reader {
 public:
  Reader(const std::string& text, std::set<std::string>& words) : text_(text), words_(words) {}

  std::map<std::string, Node> rules() {
    std::map<std::string, Node> out;
    for (skip(); at_ < text_.size(); skip()) {
      const std::string name = identifier();
      expect('=');
      out.emplace(name, alternatives());
      expect(';');
    }
    return out;
  }

 private:
  [[noreturn]] void wrong(const std::string& what) const {
    throw std::runtime_error("the grammar at \"" + text_.substr(at_, 30) + "\": " + what);
  }

  void skip() {
    while (at_ < text_.size())
      if (std::isspace(static_cast<unsigned char>(text_[at_])))
        ++at_;
      else if (text_.compare(at_, 2, "(*") == 0)
        at_ = text_.find("*)", at_) == std::string::npos ? text_.size() : text_.find("*)", at_) + 2;
      else
        return;
  }
  char peek() { return skip(), at_ < text_.size() ? text_[at_] : '\0'; }
  bool accept(char c) { return peek() == c && ++at_; }
  void expect(char c) {
    if (!accept(c)) wrong(std::string("no ") + c);
  }

  std::string until(char end) {
    const auto begin = ++at_;
    at_ = text_.find(end, begin);
    if (at_ == std::string::npos) at_ = begin, wrong("an open quotation");
    return text_.substr(begin, at_++ - begin);
  }

  /// Words with single spaces between: `unit in brackets`.
  std::string identifier() {
    std::string out;
    while (std::isalpha(static_cast<unsigned char>(peek()))) {
      if (!out.empty()) out += ' ';
      while (at_ < text_.size() && std::isalnum(static_cast<unsigned char>(text_[at_]))) out += text_[at_++];
    }
    if (out.empty()) wrong("no name");
    return out;
  }

  Node alternatives() {
    Node out{Kind::One, {}, {}};
    do out.parts.push_back(sequence());
    while (accept('|'));
    return out.parts.size() == 1 ? out.parts[0] : out;
  }

  Node sequence() {
    Node out{Kind::All, {}, {}};
    do {
      out.parts.push_back(item());
      if (accept('-')) item();
    } while (accept(','));
    return out.parts.size() == 1 ? out.parts[0] : out;
  }

  Node bracket(Kind kind, char end) {
    Node out{kind, {}, {alternatives()}};
    expect(end);
    return out;
  }

  Node item() {
    if (accept('[')) return bracket(Kind::Maybe, ']');
    if (accept('{')) return bracket(Kind::Many, '}');
    if (accept('(')) return bracket(Kind::All, ')');
    const char c = peek();
    if (c == '?') return {Kind::Free, until('?'), {}};
    if (c == '"' || c == '\'') {
      Node word{Kind::Word, until(c), {}};
      words_.insert(word.text);
      return word;
    }
    if (text_.compare(at_, 13, "any character") == 0) {  // { any character but '"' }
      at_ = text_.find('}', at_);
      return {Kind::Free, "any character", {}};
    }
    return {Kind::Rule, identifier(), {}};
  }

  const std::string& text_;
  std::set<std::string>& words_;
  std::size_t at_ = 0;
};

class Writer {
 public:
  Writer(const std::map<std::string, Node>& rules, const std::vector<std::string>& names, Random& random)
      : rules_(rules), names_(names), random_(random) {}

  void write(const Node& node, int depth) {
    if (++written_ > most) depth = deep + 1;
    switch (node.kind) {
      case Kind::Word:
        add(node.text);
        return;
      case Kind::Free:
        add(node.text == "any character" ? "x" : random_.one_in(2) ? "zxz" : "θ");
        return;
      case Kind::Rule:
        rule(node.text, depth);
        return;
      case Kind::All:
        for (const Node& part : node.parts) write(part, depth);
        return;
      case Kind::One:
        write(choice(node, depth), depth);
        return;
      case Kind::Maybe:
        if (random_.one_in(depth > deep ? 8 : 2)) write(node.parts[0], depth);
        return;
      case Kind::Many:
        while (random_.one_in(depth > deep ? 8 : 3)) write(node.parts[0], depth);
        return;
    }
  }

  std::string take() { return std::move(out_); }

 private:
  static constexpr int most = 120, deep = 14;

  /// Deep down the first alternative that does not go deeper, such as a number.
  const Node& choice(const Node& node, int depth) {
    if (depth > deep)
      for (const Node& part : node.parts)
        if (part.kind == Kind::Word || (part.kind == Kind::Rule && (part.text == "name" || part.text == "number")))
          return part;
    return random_.of(node.parts);
  }

  /// What a person would write, of names that were declared.
  std::string plain_formula(int height) {
    static const std::vector<std::string> functions{"sin",  "cos",  "exp",  "sqrt", "log", "abs",
                                                    "tanh", "atan", "sign", "step", "norm"};
    const auto part = [&] { return plain_formula(height - 1); };
    if (height <= 0) {
      if (names_.empty() || random_.one_in(4)) return std::to_string(random_.below(5));
      return random_.of(names_) + (random_.one_in(8) ? "'" : "");
    }
    switch (random_.below(9)) {
      case 0:
        return part() + " + " + part();
      case 1:
        return part() + " - " + part();
      case 2:
        return part() + "/(" + part() + ")";
      case 3:
        return "(" + part() + ")^" + std::to_string(random_.below(5));
      case 4:
        return random_.of(functions) + "(" + part() + ")";
      case 5:
        return "-(" + part() + ")";
      case 6:
        return random_.one_in(4) ? "(" + part() + ", " + part() + ")" : part() + " + 1";
      default:
        return "(" + part() + ") (" + part() + ")";
    }
  }

  void rule(const std::string& name, int depth) {
    static const std::vector<std::string> numbers{
        "0", "1", "2", "-1", "0.5", "9.81", "1e-3", "3", "1/3", "1e300", "1e-300", "0.1", "12345678901234567890"};
    static const std::vector<std::string> units{"kg",  "m",      "s",  "rad", "deg", "N", "J",  "m/s", "m/s^2",
                                                "N/m", "kg m^2", "Hz", "1",   "A",   "V", "mm", "h"};
    if (name == "name")
      return add(names_.empty() || random_.one_in(12) ? "q" + std::to_string(random_.below(4)) : random_.of(names_));
    if (name == "digits") return add(std::to_string(random_.one_in(20) ? random_.below(100000) : random_.below(5)));
    if (name == "number") return add(random_.one_in(6) ? random_.of(numbers) : std::to_string(random_.below(4)));
    if (name == "units" && !random_.one_in(4)) return add(random_.of(units));
    if (name == "formula" && !random_.one_in(5)) return add(plain_formula(static_cast<int>(random_.below(4))));
    if (name == "text") return add("\"a title\"");
    if (name == "newline") return add("\n");
    if (name == "letter" || name == "digit") return add("x");
    const auto found = rules_.find(name);
    if (found == rules_.end()) throw std::runtime_error("the grammar has no rule \"" + name + "\"");
    write(found->second, depth + 1);
  }

  void add(const std::string& word) {
    if (!out_.empty() && out_.back() != '\n' && out_.back() != '(' && word != "'" && word != ")" && word != ",")
      out_ += ' ';
    out_ += word;
  }

  const std::map<std::string, Node>& rules_;
  const std::vector<std::string>& names_;
  Random& random_;
  std::string out_;
  int written_ = 0;
};

}  // namespace

Grammar::Grammar(const std::string& ebnf) { rules_ = Reader(ebnf, words_).rules(); }

std::string Grammar::sentence(const std::string& rule, const std::vector<std::string>& names, Random& random) const {
  Writer writer(rules_, names, random);
  writer.write({Node::Kind::Rule, rule, {}}, 0);
  return writer.take();
}

}  // namespace maupertuis::fuzz
