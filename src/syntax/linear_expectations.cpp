#include "syntax/statement_parser.hpp"

/// What is expected of the neighbours of a point or of a periodic motion: eigenvalues, matrices, stability, the return
/// map.
namespace maupertuis::syntax {

// [at θ = 0, φ' = 2 rad/s]
expectation::Point StatementParser::expected_point() {
  expectation::Point point;
  if (!accept("at")) return point;
  do point.push_back(assignment());
  while (accept(","));
  return point;
}

// -5.6 1/s, (-0.2, 1.3) 1/s, 0 rel 1e-9: a bracket is a real and an imaginary part
expectation::Spectrum StatementParser::expected_spectrum() {
  expectation::Spectrum spectrum;
  expect(":", "what comes before");
  do {
    const Token& first = peek();
    std::vector<ExpressionPtr> parts;
    if (opens_components())
      parts = components();
    else
      parts.push_back(quantity());
    if (parts.size() > 2 || !parts.front() || !parts.back())
      fail("E0111", cover(first.span, previous().span), "expected a real and an imaginary part in this bracket",
           "A complex number is written (a, b); it stands for the pair a ± i b.", "Write for example (-0.1, 1.2) 1/s.");
    spectrum.real.push_back(parts.front());
    spectrum.imaginary.push_back(parts.size() == 2 ? parts.back() : nullptr);
  } while (accept(","));
  spectrum.tolerance = tolerance(true);
  return spectrum;
}

// eigenvalues at θ = 0 : -0.1 1/s, (-0.2, 1.3) 1/s rel 1e-9
expectation::Kind StatementParser::expect_eigenvalues() {
  next();
  expectation::Eigenvalues eigenvalues;
  eigenvalues.at = expected_point();
  eigenvalues.expected = expected_spectrum();
  return eigenvalues;
}

// multipliers :, trace =, period =, each perhaps `over` a time that is a period, or nearly one
bool StatementParser::opens_return_map() const {
  if (peek().is("multipliers")) return peek(1).is("over") || peek(1).is(":");
  return (peek().is("trace") || peek().is("period")) && (peek(1).is("over") || peek(1).is("="));
}

expectation::Kind StatementParser::expect_return_map() {
  const Token& word = next();
  const ExpressionPtr over = accept("over") ? quantity() : nullptr;
  if (word.is("multipliers")) return expectation::Multipliers{over, expected_spectrum()};
  expect("=", "what is expected");
  if (word.is("trace")) return expectation::Trace{over, expected_number()};
  return expectation::Period{over, expected_number()};
}

// A letter, and a colon outside brackets: `M at 3 s = 2 kg ± 1e-9` is about a quantity M.
bool StatementParser::opens_matrix() const {
  constexpr std::string_view letters = "MABCGKN";
  const Token& letter = peek();
  if (letter.text.size() != 1 || letters.find(letter.text) == std::string_view::npos) return false;
  if (!(peek(1).is("at") || peek(1).is("in") || peek(1).is(":"))) return false;
  int depth = 0;
  for (std::size_t i = 1; index_ + i < end_; ++i) {
    depth += peek(i).is("(") ? 1 : peek(i).is(")") ? -1 : 0;
    if (depth == 0 && peek(i).is(":")) return true;
  }
  return false;
}

// x', or (x, x', θ, θ')
std::vector<ExpressionPtr> StatementParser::matrix_variables() {
  std::vector<ExpressionPtr> out;
  const bool bracket = accept("(");
  do out.push_back(variable());
  while (bracket && accept(","));
  if (bracket && !accept(")")) fail_expected("`,` or `)`");
  return out;
}

// (2, 1) of a matrix; its length is that of the rows above
void StatementParser::matrix_row(expectation::Matrix& matrix) {
  const Token& first = peek();
  if (!accept("(")) fail_expected("`(` and a row of the matrix", "Write its rows in brackets: ((1, 2), (3, 4)).");
  std::size_t width = 0;
  do matrix.entries.push_back(quantity()), ++width;
  while (accept(","));
  if (!accept(")")) fail_expected("`,` or `)`");
  if (matrix.width == 0) matrix.width = width;
  if (width != matrix.width)
    fail("E0111", cover(first.span, previous().span), "expected as many entries as in the row above",
         "The rows of a matrix are of one length.");
}

// M at q1 = 0, q2 = 1 : ((2, 1), (1, 1)) kg m^2 rel 1e-9,   A in (x, x') at x = 0 : …,   B in x' by u : 1.8 1/kg ± 1e-4
expectation::Kind StatementParser::expect_matrix() {
  expectation::Matrix matrix;
  const Token& letter = next();
  matrix.letter = {std::string(letter.text), letter.span};
  if (accept("in")) matrix.rows = matrix_variables();
  if (accept("by")) matrix.columns = matrix_variables();
  matrix.at = expected_point();
  expect(":", "the configuration");
  if (peek().is("(")) {
    const bool rows = peek(1).is("(") && accept("(");
    do matrix_row(matrix);
    while (rows && accept(","));
    if (rows && !accept(")")) fail_expected("`,` or `)`");
    matrix.entries = with_unit_after(std::move(matrix.entries));
  } else {
    matrix.width = 1;
    matrix.entries = {quantity()};
  }
  matrix.tolerance = tolerance(true);
  return matrix;
}

// stable for Ω < 5.72 rad/s ± 1e-2 at θ = 0
expectation::Kind StatementParser::expect_stable() {
  expectation::Stable stable;
  stable.word = used_name("stable or unstable");
  next();
  stable.parameter = variable();
  stable.above = peek().is(">");
  if (!accept("<") && !accept(">"))
    fail_expected("`<` or `>` and the critical value", "Write for example expect stable for Ω < 5.7 rad/s ± 1e-2.");
  stable.critical = expected_number();
  stable.at = expected_point();
  return stable;
}

}  // namespace maupertuis::syntax
