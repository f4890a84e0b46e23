#pragma once
#include <maupertuis/transform.hpp>

#include <string>
#include <vector>

/// How a formula stands on the page, before any notation is chosen.
///
/// Plain text, LaTeX and MathML agree on what is a fraction, a root, a sign or a square of a sine, in which order terms
/// and factors stand, and where a long line breaks. That is decided once, here; the three writers only spell it out.
/// The left sides of derivations and of reports (∂L/∂θ', v_A², M₁₂) are layouts as well.
namespace maupertuis {

enum class Shape : std::uint8_t {
  Empty,
  // what expressions are laid out in
  Number,  // text: "2", "9.81"
  Symbol,  // symbol; text: the name that it is shown with where that is another (q_w for ball.qw)
  Pi,
  Sum,         // parts, each with a sign
  Product,     // parts
  Quotient,    // parts: numerator, denominator
  Power,       // parts: base, exponent
  Root,        // parts: radicand
  Apply,       // function, parts: arguments; exponent (2 of sin²) in text, may be empty
  Derivative,  // d/dt of parts[0]; text: the independent variable
  Comparison,  // function: Less, LessEqual
  Logic,       // function: And, Or
  Cases,       // parts: condition, value, …, else value
  // what stands beside them
  Name,      // text: a name that is no symbol, typeset by the same rule (T, h_E, v_A); dots
  Bold,      // text: the letter of a matrix or vector; dots
  Words,     // text: upright
  Indexed,   // parts: base, what stands below it, separated by commas
  Partial,   // ∂parts[0]/∂parts[1]
  Rate,      // d parts[0]/d parts[1]; the operator d/dt alone where parts[0] is empty
  Braces,    // {parts[0], parts[1]}
  Matrix,    // parts, row by row, `columns` in each
  Labelled,  // parts[0]; text: how plain text spells it, where that is not what the parts say
  // pieces of a line that was broken
  Row,    // parts, one after the other
  Sign,   // text: "+", "-", "=", "/"; negative: a sign without a left side
  Open,   // a bracket, after the name of `function` with its exponent in text where it belongs to one; tall
  Close,  // parts[0]: the exponent behind it, if any; tall
};

struct Layout {
  Shape shape = Shape::Empty;
  std::string text;
  Expr symbol;
  Kind function = Kind::Number;
  std::vector<Layout> parts;
  std::vector<bool> minus;  // of a Sum's parts
  bool negative = false;    // a minus sign stands in front; only at the top of an expression or an argument
  bool tall = false;        // of a bracket: fractions or roots stand behind it
  int dots = 0;             // of a Name or Bold: derivatives by t
  bool primes = false;      // of a Name: y' in the place of ẏ, as the independent variable is not t
  std::size_t columns = 0;  // of a Matrix

  bool empty() const { return shape == Shape::Empty; }
};

/// Lays out `e`: terms and factors in reading order, signs in front, negative powers below a fraction bar.
Layout lay_out(Expr e, const ReadingOrder& order);
/// The left side of an equation, with the terms of its own coordinate first.
Layout lay_out(const ReadableForm& form, const ReadingOrder& order);

namespace layouts {
Layout number(std::string text);
Layout symbol(Expr symbol);
Layout name(std::string text, int dots = 0, bool primes = false);
Layout bold(std::string text, int dots = 0);
Layout words(std::string text);
Layout indexed(Layout base, std::vector<Layout> below);
Layout power(Layout base, Layout exponent);
Layout product(std::vector<Layout> factors);
Layout sum(std::vector<Layout> terms);
Layout partial(Layout of, Layout by);
/// d of/d by; the operator d/d by in front of `of` where `in_front`.
Layout rate(Layout of, Layout by, bool in_front = false);
Layout braces(Layout a, Layout b);
Layout matrix(std::vector<Layout> entries, std::size_t columns);
/// `typeset` in LaTeX and MathML, `plain` in plain text.
Layout labelled(std::string plain, Layout typeset);
}  // namespace layouts

/// As in the model language, so that it can be read back: `m2 l1 l2 cos(θ1 - θ2) θ2'' + m g l sin θ`.
std::string to_plain(const Layout& layout);
/// LaTeX of math mode, without dollars, of amsmath: `m_2\, l_1\, l_2 \cos(\theta_1 - \theta_2)\, \ddot{\theta}_2`.
std::string to_latex(const Layout& layout);
/// Presentation MathML: the children of a <math> element.
std::string to_mathml(const Layout& layout);

/// Estimated width in em of the text's size, rather too large than too small.
double width(const Layout& layout);

/// A formula, or the two sides of an equation, in pieces between which a line may break: before the signs of sums, and
/// of sums in brackets that are wider than `line` em. `= 0` stays with the last term. Empty sides are left out.
std::vector<Layout> pieces(const Layout& left, const Layout& right, double line);
/// The pieces put together to lines of at most `first` and then `further` em, where they fit.
std::vector<Layout> broken_lines(const Layout& left, const Layout& right, double first, double further);

}  // namespace maupertuis
