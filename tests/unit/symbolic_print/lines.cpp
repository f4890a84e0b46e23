// Where long formulas break. That the pieces say the same as the whole is in read_back.cpp.
#include <maupertuis/layout.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <string>

using namespace maupertuis;
using namespace maupertuis::layouts;

namespace {

/// Ten letters: 5.8 em.
Layout ten() { return name("abcdeghnop"); }

std::string joined(const std::vector<Layout>& lines) {
  std::string text;
  for (const Layout& line : lines) text += (text.empty() ? "" : " | ") + to_plain(line);
  return text;
}

}  // namespace

TEST_CASE("a sum breaks before its signs, and fills the lines") {
  Layout long_sum = sum({name("a"), name("b"), name("c"), name("d")});
  long_sum.minus[1] = true;
  CHECK(joined(pieces(long_sum, {}, 10)) == "a | - b | + c | + d");
  CHECK(joined(broken_lines(long_sum, {}, 4, 4)) == "a - b | + c + d");
  CHECK(joined(broken_lines(long_sum, {}, 40, 40)) == "a - b + c + d");
}

TEST_CASE("= 0 stays with the last term, a long right side begins with its sign") {
  const Layout left = sum({ten(), ten()}), right = sum({ten(), ten()});
  CHECK(joined(pieces(left, number("0"), 10)) == "abcdeghnop | + abcdeghnop = 0");
  CHECK(joined(pieces(left, right, 10)) == "abcdeghnop | + abcdeghnop | = abcdeghnop | + abcdeghnop");
  CHECK(joined(pieces(name("T"), right, 10)) == "T = abcdeghnop | + abcdeghnop");
}

TEST_CASE("what is wider than a line is opened: brackets, fractions, roots, functions, products") {
  const Layout wide = sum({ten(), ten(), ten()});
  Layout quotient;
  quotient.shape = Shape::Quotient;
  quotient.parts = {wide, name("m")};
  CHECK(joined(pieces(product({name("k"), wide}), {}, 12)) == "k (abcdeghnop | + abcdeghnop | + abcdeghnop)");
  CHECK(joined(pieces(quotient, {}, 12)) == "1/m (abcdeghnop | + abcdeghnop | + abcdeghnop)");
  CHECK(joined(pieces(power(wide, number("2")), {}, 12)) == "(abcdeghnop | + abcdeghnop | + abcdeghnop)^2");
  Layout root, sine;
  root.shape = Shape::Root, root.parts = {wide};
  sine.shape = Shape::Apply, sine.function = Kind::Sin, sine.parts = {wide};
  CHECK(joined(pieces(root, {}, 12)) == "(abcdeghnop | + abcdeghnop | + abcdeghnop)^1/2");
  CHECK(joined(pieces(sine, {}, 12)) == "sin(abcdeghnop | + abcdeghnop | + abcdeghnop)");
  CHECK(joined(pieces(product({ten(), ten(), ten()}), {}, 12)) == "abcdeghnop | * abcdeghnop abcdeghnop");
}

TEST_CASE("no line of sums is wider than asked for") {
  std::vector<Layout> terms;
  for (int i = 0; i < 40; ++i)
    terms.push_back(product({ten(), sum({ten(), name("x"), power(sum({ten(), ten()}), number("2"))})}));
  for (const double line : {20.0, 30.0, 48.0})
    for (const Layout& one : broken_lines(sum(terms), number("0"), line, line - 2)) CHECK(width(one) <= line);
}
