#include <maupertuis/print.hpp>

#include "symbolic/expression/kind_table.hpp"
#include "symbolic/print/layout.hpp"
#include "symbolic/print/symbol_name.hpp"

#include <maupertuis/escape_xml.hpp>

/// Presentation MathML: what browsers draw without any script.
namespace maupertuis {
namespace print {
namespace {

const std::string thin_space = "<mspace width=\"0.17em\"/>";
const std::string times = "<mo>&#x2062;</mo>" + thin_space;  // invisible, and a space that keeps names apart
const std::string application = "<mo>&#x2061;</mo>";
const std::string minus_sign = "<mo>&#x2212;</mo>";

std::string tag(const char* name, const std::string& content) {
  return std::string("<") + name + ">" + content + "</" + name + ">";
}
std::string row(const std::string& content) { return tag("mrow", content); }

// ---------------------------------------------------------------------------------------------------------- names

/// A letter is set in italics, a word upright: that is what <mi> does by itself.
std::string identifier(std::string_view text) { return tag("mi", escape_xml(text)); }

std::string write_index(const std::string& part) {
  if (is_digits(part)) return tag("mn", part);
  const SymbolName name = split_name(part);
  if (letter_count(name.body) != 1 || name.below.size() != 1 || !is_digits(name.below[0])) return identifier(part);
  return tag("msub", identifier(name.body) + tag("mn", name.below[0]));
}

std::string write_below(const std::vector<std::string>& parts) {
  if (parts.size() == 1) return write_index(parts[0]);
  std::string text;
  for (const std::string& part : parts)
    text += (text.empty() ? "" : "<mo separator=\"true\">,</mo>") + write_index(part);
  return row(text);
}

std::string dotted(const std::string& body, int order) {
  constexpr const char* dots[] = {"", "&#x02D9;", "&#x00A8;", "&#x20DB;"};
  if (order == 0) return body;
  if (order <= 3) return "<mover accent=\"true\">" + body + tag("mo", dots[order]) + "</mover>";
  return tag("msup", body + row("<mo>(</mo>" + tag("mn", std::to_string(order)) + "<mo>)</mo>"));
}

/// A name in its parts, so that an exponent can stand above what is below it. Without primes, dots stand on the body.
struct Script {
  std::string base, below, above;  // the elements; empty: none

  std::string text() const {
    if (!below.empty() && !above.empty()) return tag("msubsup", base + below + above);
    if (!below.empty()) return tag("msub", base + below);
    return above.empty() ? base : tag("msup", base + above);
  }
};

Script script_of(const std::string& text, int dots, bool primes) {
  const SymbolName name = split_name(text);
  Script script{identifier(name.body), name.below.empty() ? std::string() : write_below(name.below), {}};
  if (!primes) {
    script.base = dotted(script.base, dots);
    return script;
  }
  for (int i = 0; i < dots; ++i) script.above += "&#x2032;";
  if (!script.above.empty()) script.above = tag("mo", script.above);
  return script;
}

Script script_of_symbol(Expr symbol, const std::string& within_body) {
  if (symbol.role() == Role::Constant) {
    const QuantityName quantity = split_quantity(symbol.name());
    const std::string number = tag("mn", escape_xml(quantity.number));
    if (quantity.unit.empty()) return {number, {}, {}};
    return {row(number + thin_space + tag("mtext", escape_xml(quantity.unit))), {}, {}};
  }
  const ShownSymbol shown = shown_symbol(symbol, within_body);
  const std::size_t cut = shown.name.find('_');
  if (!is_integral(symbol.name()) || cut == std::string::npos) return script_of(shown.name, shown.dots, shown.primes);
  // p with θ₁ below: what stands below a momentum is the name of its coordinate.
  Script script = script_of(shown.name.substr(0, cut), shown.dots, shown.primes);
  script.below = script_of(shown.name.substr(cut + 1), 0, false).text();
  return script;
}

// ------------------------------------------------------------------------------------------------------- formulas

std::string write(const Layout& l);

/// Brackets of plain height are letters; else they would carry the sides of their large forms.
std::string bracketed(const std::string& content, bool tall) {
  const std::string kind = tall ? "" : " stretchy=\"false\"";
  return row("<mo" + kind + ">(</mo>" + content + "<mo" + kind + ">)</mo>");
}
std::string bracketed(const Layout& l) { return bracketed(write(l), is_tall(l)); }

std::string write_part(const std::vector<Layout>& parts, std::size_t i) {
  return needs_brackets(parts, i) ? bracketed(parts[i]) : write(parts[i]);
}

std::string joined(const std::vector<Layout>& parts, const std::string& separator) {
  std::string text;
  for (std::size_t i = 0; i < parts.size(); ++i) text += (i ? separator : "") + write(parts[i]);
  return text;
}

std::string write_sum(const Layout& l) {
  std::string text;
  for (std::size_t i = 0; i < l.parts.size(); ++i) {
    if (l.minus[i])
      text += minus_sign;
    else if (i > 0)
      text += "<mo>+</mo>";
    text += write_part(l.parts, i);
  }
  return row(text);
}

std::string write_product(const Layout& l) {
  std::string text;
  for (std::size_t i = 0; i < l.parts.size(); ++i) {
    if (i > 0) text += starts_with_number(l.parts[i]) ? "<mo>&#x22C5;</mo>" : times;
    text += write_part(l.parts, i);
  }
  return row(text);
}

/// Fractions in an exponent stand on one line: 3/2, b/(c x).
std::string write_exponent(const Layout& l) {
  if (l.shape != Shape::Quotient) return write(l);
  const auto side = [](const Layout& part, bool brackets) { return brackets ? bracketed(part) : write(part); };
  return row((l.negative ? minus_sign : "") + side(l.parts[0], needs_brackets_above_slash(l.parts[0])) + "<mo>/</mo>" +
             side(l.parts[1], needs_brackets_below_slash(l.parts[1])));
}

Script script_of(const Layout& l) {
  if (l.shape == Shape::Symbol) return script_of_symbol(l.symbol, l.text);
  if (l.shape == Shape::Name) return script_of(l.text, l.dots, l.primes);
  return {write(l), {}, {}};
}

std::string write_power(const Layout& l) {
  if (!is_simple_base(l.parts[0])) return tag("msup", bracketed(l.parts[0]) + write_exponent(l.parts[1]));
  Script base = script_of(l.parts[0]);
  if (base.above.empty())
    base.above = write_exponent(l.parts[1]);
  else
    base = {row(base.text()), {}, write_exponent(l.parts[1])};  // y'^2
  return base.text();
}

std::string function_head(const Layout& l) {
  const std::string head = tag("mi", std::string(kind_info(l.function).mathml));
  return (l.text.empty() ? head : tag("msup", head + tag("mn", l.text))) + application;
}

std::string write_apply(const Layout& l) {
  if (l.function == Kind::Abs) return row("<mo>|</mo>" + write(l.parts[0]) + "<mo>|</mo>");
  if (has_bare_argument(l)) return row(function_head(l) + thin_space + write(l.parts[0]));
  bool tall = false;
  for (const Layout& part : l.parts) tall = tall || is_tall(part);
  return row(function_head(l) + bracketed(joined(l.parts, "<mo separator=\"true\">,</mo>"), tall));
}

std::string write_logic(const Layout& l) {
  std::string text;
  for (const Layout& part : l.parts) {
    if (!text.empty()) text += l.function == Kind::And ? "<mo>&#x2227;</mo>" : "<mo>&#x2228;</mo>";
    text += part.shape == Shape::Logic && part.function != l.function ? bracketed(part) : write(part);
  }
  return row(text);
}

std::string write_cases(const Layout& l) {
  std::string rows;
  for (std::size_t i = 0; i + 1 < l.parts.size(); i += 2)
    rows += tag("mtr", tag("mtd", write(l.parts[i + 1])) + tag("mtd", write(l.parts[i])));
  rows += tag("mtr", tag("mtd", write(l.parts.back())) + tag("mtd", tag("mtext", "otherwise")));
  return row("<mo>{</mo>" + tag("mtable", rows));
}

// ------------------------------------------------------------------------------------------ beside expressions

std::string write_indexed(const Layout& l) {
  const std::vector<Layout> below(l.parts.begin() + 1, l.parts.end());
  const std::string base = is_simple_base(l.parts[0]) ? write(l.parts[0]) : bracketed(l.parts[0]);
  return tag("msub", base + row(joined(below, "<mo separator=\"true\">,</mo>")));
}

std::string write_partial(const Layout& l) {
  const auto raised = [](const std::string& base, std::size_t times) {
    return times > 1 ? tag("msup", base + "<mn>" + std::to_string(times) + "</mn>") : base;
  };
  const std::size_t order = l.parts.size() - 1;
  std::string below;
  for (std::size_t i = 1; i <= order;) {
    const std::string by = write(l.parts[i]);
    std::size_t times = 1;
    while (i + times <= order && write(l.parts[i + times]) == by) ++times;
    below += "<mo>∂</mo>" + raised(by, times);
    i += times;
  }
  return tag("mfrac", row(raised("<mo>∂</mo>", order) + write(l.parts[0])) + row(below));
}

std::string write_rate(const Layout& l) {
  const std::string d = "<mi mathvariant=\"normal\">d</mi>";
  return tag("mfrac", (l.parts[0].empty() ? d : row(d + write(l.parts[0]))) + row(d + write(l.parts[1])));
}

std::string write_matrix(const Layout& l) {
  std::string rows, entries;
  for (std::size_t i = 0; i < l.parts.size(); ++i) {
    entries += tag("mtd", write(l.parts[i]));
    if ((i + 1) % l.columns == 0) rows += tag("mtr", entries), entries.clear();
  }
  return row("<mo>(</mo>" + tag("mtable", rows) + "<mo>)</mo>");
}

std::string write_sign(const Layout& l) {
  const std::string form = l.text == "/" || l.text == "⋅" ? "" : l.negative ? " form=\"prefix\"" : " form=\"infix\"";
  return "<mo" + form + ">" + (l.text == "-" ? "&#x2212;" : l.text) + "</mo>";
}

/// The brackets of a broken line stand in different pieces, at the height of what they enclose.
std::string broken_bracket(const Layout& l, const char* bracket, const char* form) {
  const std::string size = l.tall ? " stretchy=\"true\" minsize=\"2.4em\" maxsize=\"2.4em\"" : " stretchy=\"false\"";
  return "<mo" + size + " form=\"" + form + "\">" + bracket + "</mo>";
}

std::string write_open(const Layout& l) {
  const bool head = l.function != Kind::Number && l.function != Kind::Abs;
  return (head ? function_head(l) : std::string()) + broken_bracket(l, l.function == Kind::Abs ? "|" : "(", "prefix");
}

std::string write_close(const Layout& l) {
  const std::string bracket = broken_bracket(l, l.function == Kind::Abs ? "|" : ")", "postfix");
  return l.parts.empty() ? bracket : tag("msup", bracket + write_exponent(l.parts[0]));
}

std::string write_row(const Layout& l) {
  std::string text;
  for (std::size_t i = 0; i < l.parts.size(); ++i) {
    const auto is_factor = [](const Layout& part) {
      return part.shape != Shape::Sign && part.shape != Shape::Open && part.shape != Shape::Close;
    };
    if (i > 0 && is_factor(l.parts[i]) && (is_factor(l.parts[i - 1]) || l.parts[i - 1].shape == Shape::Close))
      text += times;
    text += write(l.parts[i]);
  }
  return row(text);
}

std::string write_unsigned(const Layout& l) {
  switch (l.shape) {
    case Shape::Empty:
      return {};
    case Shape::Number:
      return tag("mn", l.text);
    case Shape::Symbol:
    case Shape::Name:
      return script_of(l).text();
    case Shape::Pi:
      return tag("mi", "π");
    case Shape::Sum:
      return write_sum(l);
    case Shape::Product:
      return write_product(l);
    case Shape::Quotient:
      return tag("mfrac", write(l.parts[0]) + write(l.parts[1]));
    case Shape::Power:
      return write_power(l);
    case Shape::Root:
      return tag("msqrt", write(l.parts[0]));
    case Shape::Apply:
      return write_apply(l);
    case Shape::Derivative:
      return row("<mfrac><mi mathvariant=\"normal\">d</mi>" +
                 row("<mi mathvariant=\"normal\">d</mi>" + script_of(l.text, 0, false).text()) + "</mfrac>" +
                 bracketed(l.parts[0]));
    case Shape::Comparison:
      return row(joined(l.parts, l.function == Kind::Less ? "<mo>&lt;</mo>" : "<mo>&#x2264;</mo>"));
    case Shape::Logic:
      return write_logic(l);
    case Shape::Cases:
      return write_cases(l);
    case Shape::Bold:
      return dotted("<mi mathvariant=\"bold\">" + escape_xml(l.text) + "</mi>", l.dots);
    case Shape::Words:
      return tag("mtext", escape_xml(l.text));
    case Shape::Indexed:
      return write_indexed(l);
    case Shape::Partial:
      return write_partial(l);
    case Shape::Rate:
      return write_rate(l);
    case Shape::Braces:
      return row("<mo>{</mo>" + joined(l.parts, "<mo separator=\"true\">,</mo>") + "<mo>}</mo>");
    case Shape::Matrix:
      return write_matrix(l);
    case Shape::Labelled:
      return write(l.parts[0]);
    case Shape::Row:
      return write_row(l);
    case Shape::Sign:
      return write_sign(l);
    case Shape::Open:
      return write_open(l);
    case Shape::Close:
      return write_close(l);
  }
  return {};
}

std::string write(const Layout& l) {
  return l.negative && l.shape != Shape::Sign ? row(minus_sign + write_unsigned(l)) : write_unsigned(l);
}

}  // namespace
}  // namespace print

std::string to_mathml(const Layout& layout) {
  return layout.empty() ? std::string() : "<mrow>" + print::write(layout) + "</mrow>";
}

std::string to_mathml(Expr e, const ReadingOrder& order) { return to_mathml(lay_out(e, order)); }

std::string to_mathml(const ReadableForm& form, const ReadingOrder& order) { return to_mathml(lay_out(form, order)); }

}  // namespace maupertuis
