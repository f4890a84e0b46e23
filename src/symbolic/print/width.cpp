#include "symbolic/expression/kind_table.hpp"
#include "symbolic/print/layout.hpp"
#include "symbolic/print/symbol_name.hpp"

#include <algorithm>
#include <string_view>

/// How wide a formula is, in em: of Computer Modern, which is wider than what browsers take. Estimated from the layout
/// alone, rather too large than too small, as lines that are broken by it must fit.
namespace maupertuis {
namespace print {
namespace {

constexpr double digit = 0.5, thin_space = 0.17, plus = 1.23, equals = 1.34, comma = 0.45, index_size = 0.72;
constexpr double bracket = 0.4, large_bracket = 0.8, bar_overhang = 0.25, root_sign = 0.95, brace = 0.9,
                 column_gap = 1.0;

double letter_width(std::string_view letter) {
  if (letter.size() > 1) return 0.66;
  const char c = letter.front();
  if (c >= 'A' && c <= 'Z') return c == 'M' || c == 'W' ? 1.05 : 0.82;
  return std::string_view("ijltfr.,'").find(c) != std::string_view::npos ? 0.45 : c == 'm' || c == 'w' ? 0.88 : 0.58;
}

double word_width(std::string_view word) {
  double sum = 0;
  for (const std::string_view letter : letters_of(word)) sum += letter == "_" ? 0.5 : letter_width(letter);
  return sum;
}

double name_width(std::string_view text) {
  const SymbolName name = split_name(text);
  double below = 0;
  for (const std::string& part : name.below)
    below += (below > 0 ? comma * index_size : 0) +
             index_size * (is_digits(part) ? digit * static_cast<double>(part.size()) : word_width(part));
  return word_width(name.body) + below;
}

double symbol_width(const Layout& l) {
  if (l.symbol.role() == Role::Constant) return word_width(l.symbol.name());
  const ShownSymbol shown = shown_symbol(l.symbol, l.text);
  return name_width(shown.name) + (shown.primes ? 0.3 * shown.dots : 0.0);
}

double sum_of_widths(const std::vector<Layout>& parts, double between) {
  double sum = 0;
  for (const Layout& part : parts) sum += (sum > 0 ? between : 0) + width(part);
  return sum;
}

double brackets_around(const Layout& l) { return 2 * (is_tall(l) ? large_bracket : bracket); }

double row_of_parts(const std::vector<Layout>& parts, double between) {
  double sum = sum_of_widths(parts, between);
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (needs_brackets(parts, i)) sum += brackets_around(parts[i]);
  return sum;
}

double function_width(const Layout& l) {
  return word_width(kind_info(l.function).mathml) +
         (l.text.empty() ? 0.0 : index_size * digit * static_cast<double>(l.text.size())) + thin_space;
}

double exponent_width(const Layout& l) {
  if (l.shape != Shape::Quotient) return index_size * width(l);
  return index_size * (width(l.parts[0]) + width(l.parts[1]) + digit + 4 * bracket);
}

double cases_width(const Layout& l) {
  double values = width(l.parts.back()), conditions = word_width("otherwise");
  for (std::size_t i = 0; i + 1 < l.parts.size(); i += 2) {
    conditions = std::max(conditions, width(l.parts[i]));
    values = std::max(values, width(l.parts[i + 1]));
  }
  return brace + values + column_gap + conditions;
}

double matrix_width(const Layout& l) {
  std::vector<double> columns(l.columns, 0.0);
  for (std::size_t i = 0; i < l.parts.size(); ++i)
    columns[i % l.columns] = std::max(columns[i % l.columns], width(l.parts[i]));
  double sum = 2 * brace;
  for (const double column : columns) sum += column + column_gap;
  return sum;
}

double unsigned_width(const Layout& l) {
  switch (l.shape) {
    case Shape::Empty:
      return 0;
    case Shape::Number:
      return digit * static_cast<double>(l.text.size());
    case Shape::Symbol:
      return symbol_width(l);
    case Shape::Pi:
      return 0.6;
    case Shape::Sum:
      return row_of_parts(l.parts, plus) + (l.minus.front() ? 0.8 : 0.0);
    case Shape::Product:
      return row_of_parts(l.parts, thin_space);
    case Shape::Quotient:
      return bar_overhang + std::max(width(l.parts[0]), width(l.parts[1]));
    case Shape::Power:
      return width(l.parts[0]) + (is_simple_base(l.parts[0]) ? 0.0 : brackets_around(l.parts[0])) +
             exponent_width(l.parts[1]);
    case Shape::Root:
      return root_sign + width(l.parts[0]);
    case Shape::Apply:
      return function_width(l) + sum_of_widths(l.parts, comma) + (has_bare_argument(l) ? 0.0 : brackets_around(l));
    case Shape::Derivative:
      return 1.3 + width(l.parts[0]) + brackets_around(l.parts[0]);
    case Shape::Comparison:
      return sum_of_widths(l.parts, equals);
    case Shape::Logic:
      return sum_of_widths(l.parts, plus) + 2 * bracket * static_cast<double>(l.parts.size());
    case Shape::Cases:
      return cases_width(l);
    case Shape::Name:
      return name_width(l.text) + 0.3 * (l.primes ? l.dots : 0);
    case Shape::Bold:
      return 1.0;
    case Shape::Words:
      return word_width(l.text);
    case Shape::Indexed:
      return width(l.parts[0]) + index_size * (sum_of_widths(l.parts, comma) - width(l.parts[0])) + 2 * bracket;
    case Shape::Partial: {
      double below = 0;
      for (std::size_t i = 1; i < l.parts.size(); ++i) below += 0.6 + width(l.parts[i]);
      return bar_overhang + std::max(0.6 + width(l.parts[0]), below);
    }
    case Shape::Rate:
      return bar_overhang + 0.6 + std::max(width(l.parts[0]), width(l.parts[1]));
    case Shape::Braces:
      return 1 + sum_of_widths(l.parts, comma);
    case Shape::Matrix:
      return matrix_width(l);
    case Shape::Labelled:
      return width(l.parts[0]);
    case Shape::Row:
      return sum_of_widths(l.parts, thin_space);
    case Shape::Sign:
      return l.text == "=" ? equals : l.text == "/" ? digit : plus;
    case Shape::Open:
      return (l.tall ? large_bracket : bracket + 0.1) + (is_function(l.function) ? function_width(l) : 0.0);
    case Shape::Close:
      return (l.tall ? large_bracket : bracket + 0.1) + (l.parts.empty() ? 0.0 : exponent_width(l.parts[0]));
  }
  return 0;
}

}  // namespace
}  // namespace print

double width(const Layout& layout) {
  const bool sign = layout.negative && layout.shape != Shape::Sign;
  return print::unsigned_width(layout) + (sign ? 0.8 : 0.0);
}

}  // namespace maupertuis
