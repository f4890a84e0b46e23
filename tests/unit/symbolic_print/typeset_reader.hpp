#pragma once
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

/// Reads LaTeX and MathML as a mathematician does, and gives the value: what stands side by side is a product, a slash
/// divides by the next factor alone, the name of a function takes the next factor, brackets group, and nothing else
/// does. Written for these tests, apart from the printers.
namespace typeset_reader {

using ValueOfName = std::function<double(const std::string& name, int dots)>;

inline const std::map<std::string, std::string>& greek() {
  static const std::map<std::string, std::string> names{{"\\theta", "θ"}, {"\\varphi", "φ"}, {"\\lambda", "λ"},
                                                        {"\\omega", "ω"}, {"\\Theta", "Θ"},  {"\\psi", "ψ"}};
  return names;
}

class Latex {
 public:
  Latex(std::string_view text, ValueOfName value) : text_(text), value_(std::move(value)) {}

  double read() {
    const double result = alternatives();
    if (!peek().empty()) fail("left over: " + peek());
    return result;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw std::runtime_error(what + " in " + std::string(text_));
  }

  void skip() {
    while (at_ < text_.size()) {
      if (text_[at_] == ' ' || text_[at_] == '\n')
        ++at_;
      else if (text_.substr(at_, 2) == "\\,")
        at_ += 2;
      else
        break;
    }
  }

  std::string peek() {
    skip();
    if (at_ >= text_.size()) return {};
    if (text_[at_] == '\\') {
      std::size_t end = at_ + 1;
      while (end < text_.size() && std::isalpha(static_cast<unsigned char>(text_[end]))) ++end;
      return std::string(text_.substr(at_, std::max(end, at_ + 2) - at_));
    }
    std::size_t end = at_ + 1;
    if (is_digit(text_[at_]))
      while (end < text_.size() && (is_digit(text_[end]) || text_[end] == '.')) ++end;
    while (end < text_.size() && (text_[end] & 0xC0) == 0x80) ++end;
    return std::string(text_.substr(at_, end - at_));
  }
  static bool is_digit(char c) { return c >= '0' && c <= '9'; }

  bool take(std::string_view wanted) {
    if (peek() != wanted) return false;
    at_ += wanted.size();
    return true;
  }
  std::string next() {
    const std::string token = peek();
    at_ += token.size();
    return token;
  }
  void expect(std::string_view wanted) {
    if (!take(wanted)) fail("no " + std::string(wanted) + " before " + peek());
  }

  // condition := conjunction { ∨ conjunction }
  double alternatives() {
    double value = conjunction();
    while (take("\\vee")) value = (conjunction() != 0) | (value != 0);
    return value;
  }
  double conjunction() {
    double value = comparison();
    while (take("\\wedge")) value = (comparison() != 0) & (value != 0);
    return value;
  }
  double comparison() {
    const double left = sum();
    if (take("<")) return left < sum();
    if (take("\\le")) return left <= sum();
    return left;
  }

  double sum() {
    double value = take("-") ? -product() : product();
    while (true) {
      if (take("+"))
        value += product();
      else if (take("-"))
        value -= product();
      else
        return value;
    }
  }

  bool factor_follows() {
    const std::string t = peek();
    static const std::vector<std::string> ends{"",        "+",     "-", ")",      "}",       ",",
                                               "&",       "\\\\",  "<", "\\le",   "\\wedge", "\\vee",
                                               "\\right", "\\end", "/", "\\cdot", "|"};
    return std::find(ends.begin(), ends.end(), t) == ends.end();
  }

  double product() {
    double value = factor();
    while (true) {
      if (take("\\cdot"))
        value *= factor();
      else if (take("/"))
        value /= factor();
      else if (factor_follows())
        value *= factor();
      else
        return value;
    }
  }

  double factor() {
    double value = atom();
    while (take("^")) value = std::pow(value, group());
    return value;
  }

  double group() {
    expect("{");
    const double value = alternatives();
    expect("}");
    return value;
  }

  double bracketed() {
    const double value = alternatives();
    if (take("\\right"))
      expect(")");
    else
      expect(")");
    return value;
  }

  double atom() {
    const std::string t = peek();
    if (t.empty()) fail("nothing");
    if (is_digit(t[0])) return std::stod(next());
    if (take("(")) return bracketed();
    if (take("\\left")) {
      if (take("(")) return bracketed();
      expect("|");
      const double value = std::fabs(alternatives());
      expect("\\right"), expect("|");
      return value;
    }
    if (take("|")) {
      const double value = std::fabs(alternatives());
      expect("|");
      return value;
    }
    if (take("\\frac")) {
      const double above = group();
      return above / group();
    }
    if (take("\\sqrt")) return std::sqrt(group());
    if (take("\\pi") || take("π")) return std::acos(-1.0);
    if (take("\\begin")) return cases();
    if (t == "\\operatorname" || is_function(t)) return application();
    return name();
  }

  static bool is_function(const std::string& token) {
    return token == "\\sin" || token == "\\cos" || token == "\\tan" || token == "\\exp" || token == "\\ln" ||
           token == "\\min" || token == "\\max";
  }

  double application() {
    std::string f = next().substr(1);
    if (f == "operatorname") f = braces();
    double exponent = 1;
    if (take("^")) exponent = group();
    std::vector<double> arguments;
    const bool large = take("\\left");
    if (take("(")) {
      do arguments.push_back(alternatives());
      while (take(","));
      if (large) expect("\\right");
      expect(")");
    } else {
      arguments.push_back(atom());
    }
    return std::pow(value_of(f, arguments), exponent);
  }

  double value_of(const std::string& f, const std::vector<double>& x) const {
    if (f == "sin") return std::sin(x.at(0));
    if (f == "cos") return std::cos(x.at(0));
    if (f == "tan") return std::tan(x.at(0));
    if (f == "exp") return std::exp(x.at(0));
    if (f == "ln") return std::log(x.at(0));
    if (f == "sgn") return x.at(0) > 0 ? 1 : x.at(0) < 0 ? -1 : 0;
    if (f == "step") return x.at(0) >= 0;
    if (f == "min") return std::min(x.at(0), x.at(1));
    if (f == "max") return std::max(x.at(0), x.at(1));
    if (f == "atan2") return std::atan2(x.at(0), x.at(1));
    fail("an unknown function " + f);
  }

  std::string braces() {
    expect("{");
    std::string text;
    while (peek() != "}") {
      if (peek().empty()) fail("an open brace");
      text += next();
    }
    expect("}");
    return text;
  }

  double cases() {
    if (braces() != "cases") fail("an unknown environment");
    double result = 0;
    bool found = false;
    while (true) {
      const double value = alternatives();
      expect("&");
      const bool otherwise = take("\\text");
      if (otherwise) braces();
      const bool holds = otherwise || alternatives() != 0;
      if (holds && !found) result = value, found = true;
      if (otherwise) break;
      expect("\\\\");
    }
    expect("\\end");
    braces();
    return result;
  }

  // \dot{\theta}_1, m_1, m_{t_1}
  double name() {
    int dots = 0;
    std::string text;
    if (peek() == "\\dot" || peek() == "\\ddot") {
      dots = next() == "\\dot" ? 1 : 2;
      expect("{");
      text = letter();
      expect("}");
    } else {
      text = letter();
    }
    if (take("_")) text += peek() == "{" ? braces() : next();
    return value_(text, dots);
  }

  std::string letter() {
    const std::string token = next();
    if (token == "\\mathrm") return braces();
    if (const auto found = greek().find(token); found != greek().end()) return found->second;
    if (token.size() > 1 && token[0] == '\\') fail("an unknown command " + token);
    if (token == "{" || token == ")" || token == "^") fail("no name: " + token);
    return token;
  }

  std::string_view text_;
  ValueOfName value_;
  std::size_t at_ = 0;
};

/// MathML as LaTeX, element by element: elements side by side stay side by side, and an <mrow> groups nothing for the
/// eye.
class Mathml {
 public:
  explicit Mathml(std::string_view text) : text_(text) {}
  std::string latex() {
    std::string out;
    while (at_ < text_.size()) out += element();
    return out;
  }

 private:
  [[noreturn]] void fail() const { throw std::runtime_error("no MathML: " + std::string(text_)); }

  std::string element() {
    const std::size_t end = text_.find('>', at_);
    if (text_[at_] != '<' || end == std::string_view::npos) fail();
    std::string tag(text_.substr(at_ + 1, end - at_ - 1));
    at_ = end + 1;
    const bool closed = tag.back() == '/';
    tag = tag.substr(0, tag.find_first_of(" /"));
    if (closed) return " ";
    std::vector<std::string> parts;
    std::string leaf;
    while (text_.substr(at_, 2) != "</") {
      if (at_ >= text_.size()) fail();
      if (text_[at_] == '<')
        parts.push_back(element());
      else
        leaf += text_[at_++];
    }
    at_ = text_.find('>', at_) + 1;
    return as_latex(tag, parts, leaf);
  }

  static std::string joined(const std::vector<std::string>& parts) {
    std::string out;
    for (const std::string& part : parts) out += part;
    return out;
  }

  std::string as_latex(const std::string& tag, const std::vector<std::string>& parts, const std::string& leaf) const {
    static const std::map<std::string, std::string> signs{
        {"&#x2062;", " "},        {"&#x2061;", " "},         {"&#x2212;", "-"},
        {"&#x22C5;", " \\cdot "}, {"⋅", " \\cdot "},         {"&lt;", "<"},
        {"&#x2264;", " \\le "},   {"&#x2227;", " \\wedge "}, {"&#x2228;", " \\vee "}};
    if (tag == "mrow")
      return joined(parts).rfind("{", 0) == 0 ? joined(parts).substr(1) : joined(parts);  // the brace before cases
    if (tag == "mn") return " " + leaf + " ";
    if (tag == "mo") return signs.count(leaf) ? signs.at(leaf) : leaf;
    if (tag == "mi") return identifier(leaf);
    if (tag == "mfrac") return "\\frac{" + parts.at(0) + "}{" + parts.at(1) + "}";
    if (tag == "msqrt") return "\\sqrt{" + joined(parts) + "}";
    if (tag == "msup") return parts.at(0) + "^{" + parts.at(1) + "}";
    if (tag == "msub") return parts.at(0) + "_{" + parts.at(1) + "}";
    if (tag == "msubsup") return parts.at(0) + "_{" + parts.at(1) + "}^{" + parts.at(2) + "}";
    if (tag == "mover") return (parts.at(1) == "&#x02D9;" ? "\\dot{" : "\\ddot{") + parts.at(0) + "}";
    if (tag == "mtable")
      return "\\begin{cases}" + joined(parts).substr(0, joined(parts).rfind("\\\\")) + "\\end{cases}";
    if (tag == "mtr") return parts.at(0) + "&" + parts.at(1) + "\\\\";
    if (tag == "mtd") return joined(parts);
    if (tag == "mtext") return "\\text{" + leaf + "}";
    fail();
  }

  static std::string identifier(const std::string& leaf) {
    static const std::vector<std::string> functions{"sin", "cos",  "tan", "exp", "ln",
                                                    "sgn", "step", "min", "max", "atan2"};
    if (std::find(functions.begin(), functions.end(), leaf) != functions.end()) return "\\operatorname{" + leaf + "}";
    return " " + leaf + " ";
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

inline double value_of_latex(const std::string& text, const ValueOfName& value) { return Latex(text, value).read(); }
inline double value_of_mathml(const std::string& text, const ValueOfName& value) {
  return Latex(Mathml(text).latex(), value).read();
}

}  // namespace typeset_reader
