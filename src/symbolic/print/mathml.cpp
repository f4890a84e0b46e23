#include <maupertuis/print.hpp>

#include "symbolic/expression/kind_table.hpp"
#include "symbolic/print/layout.hpp"
#include "symbolic/print/symbol_name.hpp"

/// Presentation MathML: what browsers draw without any script.
namespace maupertuis {
namespace print {
namespace {

constexpr const char* times = "<mo>&#x2062;</mo>";       // invisible times
constexpr const char* apply = "<mo>&#x2061;</mo>";       // function application
constexpr const char* minus_sign = "<mo>&#x2212;</mo>";

std::string tag(const char* name, const std::string& content) {
  return std::string("<") + name + ">" + content + "</" + name + ">";
}
std::string row(const std::string& content) { return tag("mrow", content); }

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '&') result += "&amp;";
    else if (c == '<') result += "&lt;";
    else if (c == '>') result += "&gt;";
    else result += c;
  }
  return result;
}

std::string write(const Layout& l);

std::string bracketed(const std::string& content) {
  return row("<mo>(</mo>" + content + "<mo>)</mo>");
}

bool needs_brackets(const Layout& l) {
  return l.negative || l.shape == Shape::Sum || l.shape == Shape::Comparison || l.shape == Shape::Logic;
}

std::string write_factor(const Layout& l) { return needs_brackets(l) ? bracketed(write(l)) : write(l); }

std::string identifier(const std::string& text) {
  return tag("mi", escaped(text));
}

std::string write_symbol(Expr symbol) {
  if (symbol.role() == Role::Constant) {
    const QuantityName quantity = split_quantity(symbol.name());
    const std::string number = tag("mn", escaped(quantity.number));
    if (quantity.unit.empty()) return number;
    return row(number + "<mspace width=\"0.17em\"/>" + tag("mtext", escaped(quantity.unit)));
  }
  const ShownSymbol shown = shown_symbol(symbol);
  const SymbolName name = split_name(shown.name);
  std::string body = identifier(name.body);
  constexpr const char* dots[] = {"", "&#x02D9;", "&#x00A8;", "&#x20DB;"};
  if (shown.primes && shown.dots > 0) {
    std::string primes;
    for (int i = 0; i < shown.dots; ++i) primes += "&#x2032;";
    body = tag(name.subscript.empty() ? "msup" : "mrow", body + tag("mo", primes));
  } else if (shown.dots >= 1 && shown.dots <= 3)
    body = "<mover accent=\"true\">" + body + tag("mo", dots[shown.dots]) + "</mover>";
  else if (shown.dots > 3)
    body = tag("msup", body + row("<mo>(</mo>" + tag("mn", std::to_string(shown.dots)) + "<mo>)</mo>"));
  if (name.subscript.empty()) return body;
  const bool digits = name.subscript.find_first_not_of("0123456789") == std::string::npos;
  return tag("msub", body + (digits ? tag("mn", name.subscript) : identifier(name.subscript)));
}

std::string joined(const std::vector<Layout>& parts, const std::string& separator) {
  std::string text;
  for (std::size_t i = 0; i < parts.size(); ++i) text += (i ? separator : "") + write(parts[i]);
  return text;
}

std::string write_sum(const Layout& l) {
  std::string text;
  for (std::size_t i = 0; i < l.parts.size(); ++i) {
    if (l.minus[i]) text += minus_sign;
    else if (i > 0) text += "<mo>+</mo>";
    text += write_factor(l.parts[i]);
  }
  return row(text);
}

std::string write_product(const Layout& l) {
  std::string text;
  for (std::size_t i = 0; i < l.parts.size(); ++i) {
    if (i > 0) text += starts_with_number(l.parts[i]) ? "<mo>&#x22C5;</mo>" : times;
    text += write_factor(l.parts[i]);
  }
  return row(text);
}

/// Fractions in an exponent stand on one line: 3/2.
std::string write_exponent(const Layout& l) {
  if (l.shape != Shape::Quotient || l.negative) return write(l);
  return row(write_factor(l.parts[0]) + "<mo>/</mo>" + write_factor(l.parts[1]));
}

std::string write_power(const Layout& l) {
  const Layout& base = l.parts[0];
  const bool simple = !base.negative && (base.shape == Shape::Symbol || base.shape == Shape::Number || base.shape == Shape::Pi);
  return tag("msup", (simple ? write(base) : bracketed(write(base))) + write_exponent(l.parts[1]));
}

std::string write_apply(const Layout& l) {
  if (l.function == Kind::Abs) return row("<mo>|</mo>" + write(l.parts[0]) + "<mo>|</mo>");
  std::string head = tag("mi", std::string(kind_info(l.function).mathml));
  if (!l.text.empty()) head = tag("msup", head + tag("mn", l.text));
  const Layout& first = l.parts.front();
  const bool bare = is_circular(l.function) && !first.negative && (first.shape == Shape::Symbol || first.shape == Shape::Pi);
  return row(head + apply + (bare ? write(first) : bracketed(joined(l.parts, "<mo>,</mo>"))));
}

std::string write_cases(const Layout& l) {
  std::string rows;
  for (std::size_t i = 0; i + 1 < l.parts.size(); i += 2)
    rows += tag("mtr", tag("mtd", write(l.parts[i + 1])) + tag("mtd", write(l.parts[i])));
  rows += tag("mtr", tag("mtd", write(l.parts.back())) + tag("mtd", tag("mtext", "otherwise")));
  return row("<mo>{</mo>" + tag("mtable", rows));
}

std::string write_unsigned(const Layout& l) {
  switch (l.shape) {
    case Shape::Number: return tag("mn", l.text);
    case Shape::Symbol: return write_symbol(l.symbol);
    case Shape::Pi: return tag("mi", "π");
    case Shape::Sum: return write_sum(l);
    case Shape::Product: return write_product(l);
    case Shape::Quotient: return tag("mfrac", write(l.parts[0]) + write(l.parts[1]));
    case Shape::Power: return write_power(l);
    case Shape::Root: return tag("msqrt", write(l.parts[0]));
    case Shape::Apply: return write_apply(l);
    case Shape::Derivative:
      return row("<mfrac><mi>d</mi>" + row("<mi>d</mi>" + identifier(l.text)) + "</mfrac>" + bracketed(write(l.parts[0])));
    case Shape::Comparison: return row(joined(l.parts, l.function == Kind::Less ? "<mo>&lt;</mo>" : "<mo>&#x2264;</mo>"));
    case Shape::Logic: return row(joined(l.parts, l.function == Kind::And ? "<mo>&#x2227;</mo>" : "<mo>&#x2228;</mo>"));
    case Shape::Cases: return write_cases(l);
  }
  return {};
}

std::string write(const Layout& l) {
  return l.negative ? row(minus_sign + write_unsigned(l)) : write_unsigned(l);
}

}  // namespace
}  // namespace print

std::string to_mathml(Expr e, const ReadingOrder& order) {
  return "<mrow>" + print::write(print::lay_out(e, order)) + "</mrow>";
}

std::string to_mathml(const ReadableForm& form, const ReadingOrder& order) {
  return to_mathml(form.value, print::row_order(order, form));
}

}  // namespace maupertuis
