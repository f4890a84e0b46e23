#include <maupertuis/print.hpp>

#include "symbolic/expression/kind_table.hpp"
#include "symbolic/print/layout.hpp"
#include "symbolic/print/symbol_name.hpp"

/// LaTeX of math mode; needs amsmath (\dfrac is not used; cases, pmatrix, \dddot and \operatorname are).
namespace maupertuis {
namespace print {
namespace {

std::string braces(const std::string& text) { return "{" + text + "}"; }

/// Letters as they are, whatever LaTeX would take for a command made harmless.
std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (std::string_view("#$%&_{}").find(c) != std::string_view::npos) result += '\\';
    if (c == '\\' || c == '^' || c == '~')
      result += "\\char" + std::to_string(static_cast<int>(c)) + " ";
    else
      result += c;
  }
  return result;
}

/// kg m^2/s: factors apart, exponents raised.
std::string write_unit(std::string_view unit) {
  std::string result;
  for (std::size_t i = 0; i < unit.size(); ++i) {
    if (unit[i] == ' ' || unit[i] == '*') {
      result += "\\,";
    } else if (unit[i] == '^') {
      const std::size_t end = std::min(unit.find_first_not_of("-0123456789", i + 1), unit.size());
      result += "^" + braces(std::string(unit.substr(i + 1, end - i - 1)));
      i = end - 1;
    } else {
      result += escaped(unit.substr(i, 1));
    }
  }
  return "\\mathrm" + braces(result);
}

// ---------------------------------------------------------------------------------------------------------- names

/// One letter, Greek or not, with a tilde above it if it has one.
std::string write_letter(std::string_view letter) {
  constexpr std::string_view tilde = "\u0303";
  if (letter.size() > tilde.size() && letter.substr(letter.size() - tilde.size()) == tilde)
    return "\\tilde" + braces(write_letter(letter.substr(0, letter.size() - tilde.size())));
  const std::string_view greek = latex_greek(letter);
  if (!greek.empty()) return std::string(greek);
  return letter.size() == 1 ? escaped(letter) : "\\text" + braces(std::string(letter));
}

/// Upright; Greek letters in it, and those that mathematics has no upright form of, by themselves.
std::string write_word(std::string_view word) {
  std::string text, plain;
  const auto end_plain = [&] {
    if (!plain.empty()) text += "\\mathrm" + braces(plain);
    plain.clear();
  };
  for (const std::string_view letter : letters_of(word)) {
    if (letter.size() == 1)
      plain += escaped(letter);
    else
      end_plain(), text += braces(write_letter(letter));  // \theta before a letter
  }
  end_plain();
  return text;
}

std::string write_index(const std::string& part);

/// Comma between what stands below, and braces where it is more than one character.
std::string write_below(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : ",") + write_index(part);
  return "_" + (text.size() == 1 ? text : braces(text));
}

std::string write_index(const std::string& part) {
  if (is_digits(part)) return part;
  if (part == "max" || part == "min") return "\\" + part;
  const SymbolName name = split_name(part);
  if (letter_count(part) == 1) return write_letter(part);
  if (letter_count(name.body) != 1 || name.below.size() != 1 || !is_digits(name.below[0])) return write_word(part);
  return write_letter(name.body) + write_below(name.below);
}

std::string write_body(const std::string& body) {
  return letter_count(body) == 1 ? write_letter(body) : write_word(body);
}

std::string dotted(const std::string& body, int order) {
  switch (order) {
    case 0:
      return body;
    case 1:
      return "\\dot" + braces(body);
    case 2:
      return "\\ddot" + braces(body);
    case 3:
      return "\\dddot" + braces(body);
    default:
      return body + "^" + braces("(" + std::to_string(order) + ")");
  }
}

std::string write_name(const std::string& text, int dots, bool primes = false) {
  const SymbolName name = split_name(text);
  const std::string body = dotted(write_body(name.body), primes ? 0 : dots);
  const std::string marks =
      primes ? std::string(static_cast<std::size_t>(dots), '\'') : std::string();  // after what stands below
  return name.below.empty() ? body + marks : body + write_below(name.below) + marks;
}

std::string write_symbol(Expr symbol, const std::string& within_body) {
  if (symbol.role() == Role::Constant) {
    const QuantityName quantity = split_quantity(symbol.name());
    return quantity.unit.empty() ? quantity.number : quantity.number + "\\," + write_unit(quantity.unit);
  }
  const ShownSymbol shown = shown_symbol(symbol, within_body);
  const std::size_t cut = shown.name.find('_');
  if (!is_integral(symbol.name()) || cut == std::string::npos) return write_name(shown.name, shown.dots, shown.primes);
  // p_{\theta_1}: what stands below a momentum is the name of its coordinate.
  const std::string below = "_" + braces(write_name(shown.name.substr(cut + 1), 0)), head = shown.name.substr(0, cut);
  if (shown.primes) return write_name(head, 0) + below + std::string(static_cast<std::size_t>(shown.dots), '\'');
  return write_name(head, shown.dots) + below;
}

// ------------------------------------------------------------------------------------------------------- formulas

std::string write(const Layout& l);

std::string bracketed(const std::string& text, bool tall) {
  return tall ? "\\left(" + text + "\\right)" : "(" + text + ")";
}
std::string bracketed(const Layout& l) { return bracketed(write(l), is_tall(l)); }

std::string write_part(const std::vector<Layout>& parts, std::size_t i) {
  return needs_brackets(parts, i) ? bracketed(parts[i]) : write(parts[i]);
}

std::string write_base(const Layout& l) { return is_simple_base(l) ? write(l) : bracketed(l); }

/// Fractions in an exponent stand on one line: x^{3/2}, x^{b/(c x)}.
std::string write_exponent(const Layout& l) {
  if (l.shape != Shape::Quotient) return write(l);
  const auto side = [](const Layout& part, bool brackets) { return brackets ? bracketed(part) : write(part); };
  return (l.negative ? "-" : "") + side(l.parts[0], needs_brackets_above_slash(l.parts[0])) + "/" +
         side(l.parts[1], needs_brackets_below_slash(l.parts[1]));
}

std::string joined(const std::vector<Layout>& parts, const char* separator) {
  std::string text;
  for (std::size_t i = 0; i < parts.size(); ++i) text += (i ? separator : "") + write(parts[i]);
  return text;
}

std::string write_sum(const Layout& l) {
  std::string text;
  for (std::size_t i = 0; i < l.parts.size(); ++i) {
    if (i == 0)
      text += l.minus[i] ? "-" : "";
    else
      text += l.minus[i] ? " - " : " + ";
    text += write_part(l.parts, i);
  }
  return text;
}

/// TeX sets a thin space of its own beside fractions and large brackets, and before the names of functions.
bool is_fraction_or_large_bracket(const std::vector<Layout>& parts, std::size_t i) {
  const Layout& l = parts[i];
  if (needs_brackets(parts, i)) return is_tall(l);
  if (l.shape == Shape::Power) return !is_simple_base(l.parts[0]) && is_tall(l.parts[0]);
  return l.shape == Shape::Quotient || l.shape == Shape::Cases || (l.shape == Shape::Apply && l.function == Kind::Abs);
}
bool begins_with_function(const Layout& l) { return !l.negative && l.shape == Shape::Apply && l.function != Kind::Abs; }
bool ends_with_large_bracket(const Layout& l) { return l.shape == Shape::Apply && !has_bare_argument(l) && is_tall(l); }

/// A thin space between all factors; a dot before a number.
std::string write_product(const Layout& l) {
  std::string text;
  for (std::size_t i = 0; i < l.parts.size(); ++i) {
    const bool spaced =
        i > 0 && (is_fraction_or_large_bracket(l.parts, i) || begins_with_function(l.parts[i]) ||
                  is_fraction_or_large_bracket(l.parts, i - 1) || ends_with_large_bracket(l.parts[i - 1]));
    if (i > 0) text += starts_with_number(l.parts[i]) ? " \\cdot " : spaced ? " " : "\\, ";
    text += write_part(l.parts, i);
  }
  return text;
}

std::string function_head(const Layout& l) {
  std::string text(kind_info(l.function).latex);
  if (!l.text.empty()) text += "^" + braces(l.text);
  return text;
}

std::string write_apply(const Layout& l) {
  if (l.function == Kind::Abs) return "\\left|" + write(l.parts[0]) + "\\right|";
  if (has_bare_argument(l)) return function_head(l) + " " + write(l.parts[0]);
  bool tall = false;
  for (const Layout& part : l.parts) tall = tall || is_tall(part);
  return function_head(l) + bracketed(joined(l.parts, ", "), tall);
}

std::string write_logic(const Layout& l) {
  std::string text;
  for (const Layout& part : l.parts) {
    if (!text.empty()) text += l.function == Kind::And ? " \\wedge " : " \\vee ";
    text += part.shape == Shape::Logic && part.function != l.function ? bracketed(part) : write(part);
  }
  return text;
}

std::string write_cases(const Layout& l) {
  std::string text = "\\begin{cases} ";
  for (std::size_t i = 0; i + 1 < l.parts.size(); i += 2)
    text += write(l.parts[i + 1]) + " & " + write(l.parts[i]) + " \\\\ ";
  return text + write(l.parts.back()) + " & \\text{otherwise} \\end{cases}";
}

// ------------------------------------------------------------------------------------------ beside expressions

std::string write_bold(const Layout& l) {
  const std::string letter = write_letter(l.text);
  return dotted(letter[0] == '\\' ? "\\boldsymbol" + braces(letter) : "\\mathbf" + braces(letter), l.dots);
}

std::string write_indexed(const Layout& l) {
  const std::vector<Layout> below(l.parts.begin() + 1, l.parts.end());
  const bool simple = is_simple_base(l.parts[0]);
  const std::string base = simple ? write(l.parts[0]) : bracketed(l.parts[0]);
  const std::size_t cut = simple ? base.find('_') : std::string::npos;  // ψ_r has an index already: ψ_{r,t}
  if (cut == std::string::npos || (cut > 0 && base[cut - 1] == '\\')) return base + "_" + braces(joined(below, ","));
  std::string first = base.substr(cut + 1);
  if (first.size() > 1 && first.front() == '{' && first.back() == '}') first = first.substr(1, first.size() - 2);
  return base.substr(0, cut) + "_" + braces(first + "," + joined(below, ","));
}

/// ∂a/∂b; of several variables, those that follow each other alike: ∂³u/∂t∂x².
std::string write_partial(const Layout& l) {
  const std::size_t order = l.parts.size() - 1;
  std::string below;
  for (std::size_t i = 1; i <= order;) {
    const std::string by = write(l.parts[i]);
    std::size_t times = 1;
    while (i + times <= order && write(l.parts[i + times]) == by) ++times;
    below +=
        (below.empty() ? "\\partial " : "\\, \\partial ") + by + (times > 1 ? "^{" + std::to_string(times) + "}" : "");
    i += times;
  }
  const std::string power = order > 1 ? "^{" + std::to_string(order) + "} " : " ";
  return "\\frac{\\partial" + power + write(l.parts[0]) + "}{" + below + "}";
}

std::string write_rate(const Layout& l) {
  const std::string d = "\\mathrm{d}";
  return "\\frac" + braces(l.parts[0].empty() ? d : d + " " + write(l.parts[0])) + braces(d + " " + write(l.parts[1]));
}

std::string write_matrix(const Layout& l) {
  std::string text = "\\begin{pmatrix} ";
  for (std::size_t i = 0; i < l.parts.size(); ++i)
    text += (i % l.columns ? " & " : i ? " \\\\ " : "") + write(l.parts[i]);
  return text + " \\end{pmatrix}";
}

/// A line begins with {}, so that a sign after it is one of a sum; nothing is added before what follows a bracket.
std::string write_row(const Layout& l) {
  std::string text;
  for (std::size_t i = 0; i < l.parts.size(); ++i) {
    const Layout& part = l.parts[i];
    const bool sign = part.shape == Shape::Sign && !part.negative && part.text != "/";
    const bool glued = text.empty() || std::string_view(" (-/|").find(text.back()) != std::string_view::npos;
    if (sign)
      text += (text.empty() ? "{} " : " ") + write(part) + " ";
    else
      text += (glued || part.shape == Shape::Close || part.shape == Shape::Sign ? "" : "\\, ") + write(part);
  }
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

std::string write_open(const Layout& l) {
  const char* size = l.tall ? "\\Bigl" : "\\bigl";
  if (l.function == Kind::Abs) return std::string(size) + "|";
  return (l.function == Kind::Number ? std::string() : function_head(l)) + size + "(";
}

std::string write_close(const Layout& l) {
  const std::string bracket = std::string(l.tall ? "\\Bigr" : "\\bigr") + (l.function == Kind::Abs ? "|" : ")");
  return l.parts.empty() ? bracket : bracket + "^" + braces(write_exponent(l.parts[0]));
}

std::string write_unsigned(const Layout& l) {
  switch (l.shape) {
    case Shape::Empty:
      return {};
    case Shape::Number:
      return l.text;
    case Shape::Symbol:
      return write_symbol(l.symbol, l.text);
    case Shape::Pi:
      return "\\pi";
    case Shape::Sum:
      return write_sum(l);
    case Shape::Product:
      return write_product(l);
    case Shape::Quotient:
      return "\\frac" + braces(write(l.parts[0])) + braces(write(l.parts[1]));
    case Shape::Power:
      return write_base(l.parts[0]) + "^" + braces(write_exponent(l.parts[1]));
    case Shape::Root:
      return "\\sqrt" + braces(write(l.parts[0]));
    case Shape::Apply:
      return write_apply(l);
    case Shape::Derivative:
      return "\\frac{\\mathrm{d}}{\\mathrm{d} " + write_name(l.text, 0) + "}" + bracketed(l.parts[0]);
    case Shape::Comparison:
      return joined(l.parts, l.function == Kind::Less ? " < " : " \\le ");
    case Shape::Logic:
      return write_logic(l);
    case Shape::Cases:
      return write_cases(l);
    case Shape::Name:
      return write_name(l.text, l.dots, l.primes);
    case Shape::Bold:
      return write_bold(l);
    case Shape::Words:
      return "\\text" + braces(escaped(l.text));
    case Shape::Indexed:
      return write_indexed(l);
    case Shape::Partial:
      return write_partial(l);
    case Shape::Rate:
      return write_rate(l);
    case Shape::Braces:
      return "\\{" + joined(l.parts, ", ") + "\\}";
    case Shape::Matrix:
      return write_matrix(l);
    case Shape::Labelled:
      return write(l.parts[0]);
    case Shape::Row:
      return write_row(l);
    case Shape::Sign:
      return l.text == "⋅" ? "\\cdot" : l.text;
    case Shape::Open:
      return write_open(l);
    case Shape::Close:
      return write_close(l);
  }
  return {};
}

std::string write(const Layout& l) { return (l.negative && l.shape != Shape::Sign ? "-" : "") + write_unsigned(l); }

}  // namespace
}  // namespace print

std::string to_latex(const Layout& layout) { return print::write(layout); }

std::string to_latex(Expr e, const ReadingOrder& order) { return to_latex(lay_out(e, order)); }

std::string to_latex(const ReadableForm& form, const ReadingOrder& order) { return to_latex(lay_out(form, order)); }

std::string symbol_to_latex(Expr symbol) { return print::write_symbol(symbol, {}); }

}  // namespace maupertuis
