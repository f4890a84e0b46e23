#include <maupertuis/kinds.hpp>
#include <maupertuis/print.hpp>

#include "symbolic/print/layout.hpp"
#include "symbolic/print/symbol_name.hpp"

/// Plain text in the model language: what is printed can be pasted back into a model.
namespace maupertuis {
namespace print {
namespace {

enum Level { SumLevel, ProductLevel, PowerLevel, AtomLevel };

Level level(const Layout& l) {
  switch (l.shape) {
    case Shape::Sum:
    case Shape::Comparison:
    case Shape::Logic:
      return SumLevel;
    case Shape::Product:
    case Shape::Quotient:
      return ProductLevel;
    case Shape::Power:
      return PowerLevel;
    case Shape::Apply:
      return l.text.empty() ? AtomLevel : PowerLevel;
    case Shape::Row:
      return SumLevel;
    case Shape::Symbol:  // 2 [m]
      return l.symbol.role() == Role::Constant ? PowerLevel : AtomLevel;
    case Shape::Labelled:
    case Shape::Number:
    case Shape::Pi:
    case Shape::Root:
    case Shape::Derivative:
    case Shape::Cases:
    case Shape::Empty:
    case Shape::Name:
    case Shape::Bold:
    case Shape::Words:
    case Shape::Indexed:
    case Shape::Partial:
    case Shape::Rate:
    case Shape::Braces:
    case Shape::Matrix:
    case Shape::Sign:
    case Shape::Open:
    case Shape::Close:
      break;
  }
  return AtomLevel;
}

std::string write(const Layout& l);

std::string write_at(const Layout& l, Level least) {
  std::string text = write(l);
  return level(l) < least || l.negative ? "(" + text + ")" : text;
}

std::string join(const std::vector<Layout>& parts, const char* separator) {
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
    text += write_at(l.parts[i], ProductLevel);
  }
  return text;
}

/// Factors side by side. A fraction of numbers leads: 1/2 m; anything else with a slash gets brackets, and so does a
/// number that is not the first.
std::string write_product(const Layout& l) {
  std::string text;
  for (std::size_t i = 0; i < l.parts.size(); ++i) {
    const Layout& part = l.parts[i];
    const bool leading_fraction = i == 0 && part.shape == Shape::Quotient && part.parts[0].shape == Shape::Number;
    if (i) text += ' ';
    if (i > 0 && starts_with_number(part))
      text += "(" + write(part) + ")";
    else
      text += leading_fraction ? write(part) : write_at(part, PowerLevel);
  }
  return text;
}

std::string write_quotient(const Layout& l) {
  return write_at(l.parts[0], ProductLevel) + "/" + write_at(l.parts[1], PowerLevel);
}

std::string write_apply(const Layout& l) {
  std::string text(name_of(l.function));
  if (!l.text.empty()) text += "^" + l.text;
  const Layout& first = l.parts.front();
  const bool bare = is_circular(l.function) && !first.negative &&
                    (first.shape == Shape::Pi || (first.shape == Shape::Symbol && first.symbol.order() == 0 &&
                                                  first.symbol.role() != Role::Constant));
  return bare ? text + " " + write(first) : text + "(" + join(l.parts, ", ") + ")";
}

std::string write_cases(const Layout& l) {
  std::string text = "piecewise(";
  for (std::size_t i = 0; i + 1 < l.parts.size(); i += 2)
    text += write(l.parts[i]) + " : " + write(l.parts[i + 1]) + ", ";
  return text + "else : " + write(l.parts.back()) + ")";
}

std::string write_logic(const Layout& l) {
  std::string text;
  for (const Layout& part : l.parts) {
    if (!text.empty()) text += l.function == Kind::And ? " and " : " or ";
    const bool brackets = part.shape == Shape::Logic && part.function != l.function;
    text += brackets ? "(" + write(part) + ")" : write(part);
  }
  return text;
}

std::string write_rate(const Layout& l) {
  return l.parts[0].empty() ? "d/d" + write(l.parts[1]) : "d" + write(l.parts[0]) + "/d" + write(l.parts[1]);
}

std::string write_matrix(const Layout& l) {
  std::string text = "(";
  for (std::size_t i = 0; i < l.parts.size(); ++i)
    text += (i % l.columns ? ", " : i ? "), (" : "(") + write(l.parts[i]);
  return text + "))";
}

std::string write_row(const Layout& l) {
  std::string text;
  for (const Layout& part : l.parts) {
    const bool glued = text.empty() || text.back() == '(' || part.shape == Shape::Close;
    text += (glued ? "" : " ") + write(part);
  }
  return text;
}

std::string name_with_dots(const Layout& l) { return l.text + std::string(static_cast<std::size_t>(l.dots), '\''); }

std::string write_unsigned(const Layout& l) {
  switch (l.shape) {
    case Shape::Number:
      return l.text;
    case Shape::Symbol:
      return symbol_to_plain(l.symbol);
    case Shape::Pi:
      return "pi";
    case Shape::Sum:
      return write_sum(l);
    case Shape::Product:
      return write_product(l);
    case Shape::Quotient:
      return write_quotient(l);
    case Shape::Power:
      return write_at(l.parts[0], AtomLevel) + "^" + write_at(l.parts[1], AtomLevel);
    case Shape::Root:
      return "sqrt(" + write(l.parts[0]) + ")";
    case Shape::Apply:
      return write_apply(l);
    case Shape::Derivative:
      return "dot(" + write(l.parts[0]) + ")";
    case Shape::Comparison:
      return join(l.parts, l.function == Kind::Less ? " < " : " <= ");
    case Shape::Logic:
      return write_logic(l);
    case Shape::Cases:
      return write_cases(l);
    case Shape::Empty:
      return {};
    case Shape::Name:
    case Shape::Bold:
      return name_with_dots(l);
    case Shape::Words:
      return l.text;
    case Shape::Indexed: {
      const std::vector<Layout> below(l.parts.begin() + 1, l.parts.end());
      return write(l.parts[0]) + "[" + join(below, ", ") + "]";
    }
    case Shape::Partial:
      return "∂" + write(l.parts[0]) + "/∂" + write(l.parts[1]);
    case Shape::Rate:
      return write_rate(l);
    case Shape::Braces:
      return "{" + join(l.parts, ", ") + "}";
    case Shape::Matrix:
      return write_matrix(l);
    case Shape::Labelled:
      return l.text;
    case Shape::Row:
      return write_row(l);
    case Shape::Sign:
      return l.text == "⋅" ? "*" : l.text;
    case Shape::Open:
      return (l.function == Kind::Number ? std::string() : std::string(name_of(l.function))) + "(";
    case Shape::Close:
      return ")" + (l.parts.empty() ? std::string() : "^" + write_at(l.parts[0], AtomLevel));
  }
  return {};
}

std::string write(const Layout& l) { return (l.negative ? "-" : "") + write_unsigned(l); }

}  // namespace
}  // namespace print

std::string to_plain(const Layout& layout) { return print::write(layout); }

std::string to_plain(Expr e, const ReadingOrder& order) { return to_plain(lay_out(e, order)); }

std::string to_plain(const ReadableForm& form, const ReadingOrder& order) { return to_plain(lay_out(form, order)); }

std::string symbol_to_plain(Expr symbol) {
  if (symbol.role() == Role::Constant) {  // as the language reads it in a formula: 3 [J]
    const print::QuantityName quantity = print::split_quantity(symbol.name());
    return quantity.unit.empty() ? quantity.number : quantity.number + " [" + quantity.unit + "]";
  }
  const print::ShownSymbol shown = print::shown_symbol(symbol);
  return shown.name + std::string(static_cast<std::size_t>(shown.dots), '\'');
}

}  // namespace maupertuis
