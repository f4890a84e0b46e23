#include "report/notation.hpp"

#include "report/markup.hpp"

#include <maupertuis/plot.hpp>

#include <fmt/format.h>

#include <cmath>

namespace maupertuis {
namespace {

std::string element(std::string_view tag, const std::string& content) { return fmt::format("<{0}>{1}</{0}>", tag, content); }

bool is_number(std::string_view text) { return !text.empty() && text.find_first_not_of("0123456789.,") == std::string_view::npos; }

// A name with its dots and its index; an index may have one of its own, as θ1 in Q_θ1.
std::string name_mathml(std::string_view name, bool primes) {
  if (is_number(name)) return element("mn", std::string(name));
  const NameParts parts = name_parts(name);
  std::string base = element("mi", escape_html(parts.base));
  static constexpr std::string_view dots[] = {"", "&#x02D9;", "&#x00A8;", "&#x20DB;"};
  if (primes && parts.dots > 0) {
    std::string marks;
    for (int i = 0; i < parts.dots; ++i) marks += "&#x2032;";
    base = element(parts.index.empty() ? "msup" : "mrow", base + element("mo", marks));
  } else if (parts.dots >= 1 && parts.dots <= 3)
    base = fmt::format("<mover accent=\"true\">{}<mo>{}</mo></mover>", base, dots[parts.dots]);
  if (parts.index.empty()) return base;
  return element("msub",
                 base + (is_number(parts.index) ? element("mn", parts.index) : name_mathml(parts.index, primes)));
}

std::string partial(std::string_view name, bool primes) {
  return element("mrow", "<mo>∂</mo>" + name_mathml(name, primes));
}

bool starts_with(std::string_view text, std::string_view prefix) { return text.substr(0, prefix.size()) == prefix; }

}  // namespace

std::string left_side_mathml(std::string_view plain, bool primes) {
  constexpr std::string_view rate = "d/d", del = "∂";
  if (plain.empty()) return {};
  if (const auto blank = plain.find(' '); starts_with(plain, rate) && blank != std::string_view::npos)
    return fmt::format("<mfrac><mi>d</mi><mrow><mi>d</mi>{}</mrow></mfrac>",
                       name_mathml(plain.substr(rate.size(), blank - rate.size()), primes)) +
           left_side_mathml(plain.substr(blank + 1), primes);
  if (const auto slash = plain.find("/∂"); starts_with(plain, del) && slash != std::string_view::npos)
    return element("mfrac", partial(plain.substr(del.size(), slash - del.size()), primes) +
                                partial(plain.substr(slash + 1 + del.size()), primes));
  if (const auto bracket = plain.find('('); bracket != std::string_view::npos && plain.back() == ')' && bracket > 0)
    return "<mrow>" + left_side_mathml(plain.substr(0, bracket), primes) + "<mspace width=\"0.3em\"/>" +
           element("mtext", escape_html(plain.substr(bracket))) + "</mrow>";
  if (plain.size() > 2 && plain.substr(plain.size() - 2) == "^2")
    return element("msup", name_mathml(plain.substr(0, plain.size() - 2), primes) + "<mn>2</mn>");
  return name_mathml(plain, primes);
}

bool derivatives_are_primes(const ReadingOrder& order) {
  return !order.coordinates.empty() && order.coordinates.front().context().time().name() != "t";
}

// ------------------------------------------------------------------------------------------------------------ units

namespace {

// unit := factor { ("/" | "·" | " ") factor };  factor := ( word | "(" unit ")" | "1" ) [ "^" integer ]
class UnitReader {
 public:
  explicit UnitReader(std::string_view text) : text_(text) {}

  double read() {
    const double value = product();
    return at_ == text_.size() ? value : 0;
  }

 private:
  double product() {
    double value = factor();
    while (true) {
      skip_spaces();
      if (at_ == text_.size() || text_[at_] == ')') return value;
      const bool divide = text_[at_] == '/';
      if (divide || text_[at_] == '*') ++at_;
      else if (starts_with(text_.substr(at_), "·")) at_ += std::string_view("·").size();
      const double next = factor();
      if (next == 0) return 0;
      value = divide ? value / next : value * next;
    }
  }

  double factor() {
    skip_spaces();
    double value = 0;
    if (at_ < text_.size() && text_[at_] == '(') {
      ++at_;
      value = product();
      if (at_ == text_.size()) return 0;
      ++at_;
    } else {
      const std::size_t end = std::min(text_.find_first_of(" /*^()", at_), text_.size());
      const std::string_view word = text_.substr(at_, end - at_);
      const auto unit = find_unit(word);
      if (word == "1") value = 1;
      else if (unit) value = unit->factor.to_double() * std::pow(3.14159265358979323846, unit->pi_power);
      at_ = end;
    }
    return std::pow(value, exponent());
  }

  int exponent() {
    if (at_ >= text_.size() || text_[at_] != '^') return 1;
    const bool negative = ++at_ < text_.size() && text_[at_] == '-';
    if (negative) ++at_;
    int value = 0;
    while (at_ < text_.size() && text_[at_] >= '0' && text_[at_] <= '9' && value < 100) value = 10 * value + (text_[at_++] - '0');
    return negative ? -value : value;
  }

  void skip_spaces() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

}  // namespace

double unit_factor(std::string_view unit) { return unit.empty() ? 1 : UnitReader(unit).read(); }

std::string short_number(double value, int digits) { return fmt::format("{:.{}g}", value == 0 ? 0 : value, digits); }

std::string quantity(double value, const std::string& unit, int digits) {
  return unit.empty() || unit == "1" ? short_number(value, digits) : short_number(value, digits) + " " + unit;
}

}  // namespace maupertuis
