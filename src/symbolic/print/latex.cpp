#include <maupertuis/print.hpp>

#include "symbolic/expression/kind_table.hpp"
#include "symbolic/print/layout.hpp"
#include "symbolic/print/symbol_name.hpp"

/// LaTeX of math mode; needs amsmath (\dfrac is not used; cases, \dddot and \operatorname are).
namespace maupertuis {
namespace print {
namespace {

std::string braces(const std::string& text) { return "{" + text + "}"; }

/// Letters as they are, whatever LaTeX would take for a command made harmless.
std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (std::string("#$%&_{}").find(c) != std::string::npos) result += '\\';
    result += c;
  }
  return result;
}

std::string letter_or_word(const std::string& text, bool is_word) {
  if (is_word) return "\\mathrm" + braces(escaped(text));
  const std::string_view greek = latex_greek(text);
  return greek.empty() ? escaped(text) : std::string(greek);
}

std::string dotted(const std::string& body, int order) {
  switch (order) {
    case 0: return body;
    case 1: return "\\dot" + braces(body);
    case 2: return "\\ddot" + braces(body);
    case 3: return "\\dddot" + braces(body);
    default: return body + "^" + braces("(" + std::to_string(order) + ")");
  }
}

std::string write_name(const std::string& text, int dots, bool primes = false) {
  const SymbolName name = split_name(text);
  const std::string body = dotted(letter_or_word(name.body, name.body_is_word), primes ? 0 : dots);
  const std::string marks = primes ? std::string(static_cast<std::size_t>(dots), '\'') : std::string();  // after what stands below
  if (name.subscript.empty()) return body + marks;
  const std::string below = name.subscript == "max" || name.subscript == "min"
                                ? "\\" + name.subscript : letter_or_word(name.subscript, name.subscript_is_word);
  return body + "_" + (below.size() == 1 ? below : braces(below)) + marks;
}

std::string write(const Layout& l);

std::string bracketed(const std::string& text) { return "\\left(" + text + "\\right)"; }

bool needs_brackets(const Layout& l) {
  return l.negative || l.shape == Shape::Sum || l.shape == Shape::Comparison || l.shape == Shape::Logic;
}

std::string write_factor(const Layout& l) { return needs_brackets(l) ? bracketed(write(l)) : write(l); }

std::string write_base(const Layout& l) {
  const bool simple = !l.negative && (l.shape == Shape::Symbol || l.shape == Shape::Number || l.shape == Shape::Pi) &&
                      !(l.shape == Shape::Symbol && l.symbol.role() == Role::Constant);
  return simple ? write(l) : bracketed(write(l));
}

/// Fractions in an exponent stand on one line: x^{3/2}.
std::string write_exponent(const Layout& l) {
  return l.shape == Shape::Quotient && !l.negative ? write_factor(l.parts[0]) + "/" + write_factor(l.parts[1]) : write(l);
}

std::string joined(const std::vector<Layout>& parts, const char* separator) {
  std::string text;
  for (std::size_t i = 0; i < parts.size(); ++i) text += (i ? separator : "") + write(parts[i]);
  return text;
}

std::string write_sum(const Layout& l) {
  std::string text;
  for (std::size_t i = 0; i < l.parts.size(); ++i) {
    if (i == 0) text += l.minus[i] ? "-" : "";
    else text += l.minus[i] ? " - " : " + ";
    text += write_factor(l.parts[i]);
  }
  return text;
}

/// Thin spaces after bare function arguments and before quantities keep factors apart.
std::string write_product(const Layout& l) {
  std::string text;
  for (std::size_t i = 0; i < l.parts.size(); ++i) {
    const bool after_function = i > 0 && l.parts[i - 1].shape == Shape::Apply;
    if (i > 0) text += starts_with_number(l.parts[i]) ? " \\cdot " : after_function ? "\\, " : " ";
    text += write_factor(l.parts[i]);
  }
  return text;
}

std::string write_apply(const Layout& l) {
  if (l.function == Kind::Abs) return "\\left|" + write(l.parts[0]) + "\\right|";
  std::string text(kind_info(l.function).latex);
  if (!l.text.empty()) text += "^" + braces(l.text);
  const Layout& first = l.parts.front();
  const bool bare = is_circular(l.function) && !first.negative && (first.shape == Shape::Symbol || first.shape == Shape::Pi);
  return bare ? text + " " + write(first) : text + bracketed(joined(l.parts, ", "));
}

std::string write_cases(const Layout& l) {
  std::string text = "\\begin{cases} ";
  for (std::size_t i = 0; i + 1 < l.parts.size(); i += 2)
    text += write(l.parts[i + 1]) + " & " + write(l.parts[i]) + " \\\\ ";
  return text + write(l.parts.back()) + " & \\text{otherwise} \\end{cases}";
}

std::string write_unsigned(const Layout& l) {
  switch (l.shape) {
    case Shape::Number: return l.text;
    case Shape::Symbol: return symbol_to_latex(l.symbol);
    case Shape::Pi: return "\\pi";
    case Shape::Sum: return write_sum(l);
    case Shape::Product: return write_product(l);
    case Shape::Quotient: return "\\frac" + braces(write(l.parts[0])) + braces(write(l.parts[1]));
    case Shape::Power: return write_base(l.parts[0]) + "^" + braces(write_exponent(l.parts[1]));
    case Shape::Root: return "\\sqrt" + braces(write(l.parts[0]));
    case Shape::Apply: return write_apply(l);
    case Shape::Derivative: return "\\frac{\\mathrm{d}}{\\mathrm{d}" + write_name(l.text, 0) + "}" + bracketed(write(l.parts[0]));
    case Shape::Comparison: return joined(l.parts, l.function == Kind::Less ? " < " : " \\le ");
    case Shape::Logic: return joined(l.parts, l.function == Kind::And ? " \\wedge " : " \\vee ");
    case Shape::Cases: return write_cases(l);
  }
  return {};
}

std::string write(const Layout& l) { return (l.negative ? "-" : "") + write_unsigned(l); }

}  // namespace
}  // namespace print

std::string to_latex(Expr e, const ReadingOrder& order) { return print::write(print::lay_out(e, order)); }

std::string to_latex(const ReadableForm& form, const ReadingOrder& order) {
  return to_latex(form.value, print::row_order(order, form));
}

std::string symbol_to_latex(Expr symbol) {
  using namespace print;
  if (symbol.role() == Role::Constant) {
    const QuantityName quantity = split_quantity(symbol.name());
    return quantity.unit.empty() ? quantity.number : quantity.number + "\\,\\mathrm" + braces(escaped(quantity.unit));
  }
  const ShownSymbol shown = shown_symbol(symbol);
  const std::size_t cut = shown.name.find('_');
  if (!is_integral(symbol.name()) || cut == std::string::npos) return write_name(shown.name, shown.dots, shown.primes);
  // p_{\theta_1}: what stands below a momentum is the name of its coordinate.
  const std::string below = "_" + braces(write_name(shown.name.substr(cut + 1), 0)), head = shown.name.substr(0, cut);
  if (shown.primes) return write_name(head, 0) + below + std::string(static_cast<std::size_t>(shown.dots), '\'');
  return write_name(head, shown.dots) + below;
}

}  // namespace maupertuis
