#pragma once
#include <maupertuis/print.hpp>

#include <vector>

/// How an expression stands on the page, before any notation is chosen.
///
/// Plain text, LaTeX and MathML agree on what is a fraction, a root, a sign or a square of a sine, and in which order
/// terms and factors stand. That is decided once, here; the three writers only spell it out.
namespace maupertuis::print {

enum class Shape : std::uint8_t {
  Number,      // text: "2", "9.81"
  Symbol,      // symbol
  Pi,
  Sum,         // parts, each with a sign
  Product,     // parts
  Quotient,    // parts: numerator, denominator
  Power,       // parts: base, exponent
  Root,        // parts: radicand; degree in text when it is not 2
  Apply,       // function, parts: arguments; exponent (2 of sin²) in text, may be empty
  Derivative,  // d/dt of parts[0]
  Comparison,  // function: Less, LessEqual
  Logic,       // function: And, Or
  Cases,       // parts: condition, value, …, else value
};

struct Layout {
  Shape shape = Shape::Number;
  std::string text;
  Expr symbol;
  Kind function = Kind::Number;
  std::vector<Layout> parts;
  std::vector<bool> minus;      // of a Sum's parts
  bool negative = false;        // a minus sign stands in front; only at the top of an expression or an argument
};

/// Lays out `e`: terms and factors in reading order, signs in front, negative powers below a fraction bar.
Layout lay_out(Expr e, const ReadingOrder& order);

/// A nonnegative rational as a reader writes it: 1/2, 9.81, 3.
Layout lay_out_number(const Rational& value);

/// True if the text of a factor would begin with a digit: 2^(3/2), 3 [J]. Not to be put right after another number.
bool starts_with_number(const Layout& layout);

/// The order with the coordinate of the form's row in front.
ReadingOrder row_order(const ReadingOrder& order, const ReadableForm& form);

/// True for functions that take a bare argument and a square on the name: sin² θ.
bool is_circular(Kind kind);

}  // namespace maupertuis::print
