#include "evaluate_line.hpp"

#include <doctest/doctest.h>

using namespace maupertuis::straight;

namespace {

Value stored_alone(Builder& to, Value v, StraightLine& line) {
  to.store(v, 1, 0);
  line = to.finish(2, 1, 0);
  return line.stores[0].value;
}

}  // namespace

TEST_CASE("zeros, ones and signs are folded") {
  Builder to;
  const Value x = to.given(0, 0), y = to.given(0, 1), zero = to.literal(0), one = to.literal(1);
  CHECK(to.given(0, 0) == x);
  CHECK(to.sum({{1, x, one}, {3, y, zero}}) == x);
  CHECK(to.is_zero(to.sum({{1, zero, y}})));
  CHECK(to.literal_of(to.sum({{2, to.literal(3)}, {1}})) == 7);
  CHECK(to.reciprocal(y) == to.reciprocal(y));
  CHECK(to.reciprocal(to.literal(-1)) == to.literal(-1));
  StraightLine line;
  const Value minus = stored_alone(to, to.sum({{1, x}, {-1, y}}, to.literal(-1)), line);  // −(x − y)
  REQUIRE(line.nodes[minus].what == Node::Sum);
  CHECK(line.nodes[minus].a == none);
  CHECK(evaluate(line, {{5, 3}, {0}}).arrays[1][0] == -2);
}

TEST_CASE(
    "values of several widths: what is gathered in order is the value itself, and a number where all lanes are the "
    "same") {
  Builder to;
  const Value a = to.wide_given(0, 0, 4), b = to.wide_given(0, 4, 2), x = to.given(0, 6);
  CHECK(to.wide_given(0, 0, 4) == a);
  CHECK(to.wide_given(0, 0, 2) != a);
  const auto lanes = [&](Value v, const std::vector<std::uint32_t>& which) {
    std::vector<Value> out;
    for (const std::uint32_t i : which) out.push_back(to.lane(v, i));
    return out;
  };
  CHECK(to.gather(lanes(a, {0, 1, 2, 3})) == a);
  CHECK(to.gather(lanes(a, {0, 1})) != b);
  CHECK(to.width(to.gather(lanes(a, {0, 1}))) == 2);
  CHECK(to.gather(lanes(a, {1, 1, 1, 1})) == to.lane(a, 1));
  CHECK(to.gather({x, x}) == x);
  CHECK(to.lane(x, 1) == x);
  const Value mixed = to.gather({to.lane(b, 1), x});
  CHECK(to.gather({to.lane(b, 1), x}) == mixed);
  CHECK(to.lane(mixed, 1) == x);
  CHECK(to.width(to.sum({{1, x, b}, {2, b}})) == 2);
  CHECK(to.width(to.sum({{1, x}}, none, a)) == 4);
  CHECK(to.width(to.root(b)) == 2);
  CHECK(to.width(to.sum({{1, x, x}})) == 1);
}

TEST_CASE(
    "what nothing needs is not there; what is needed stands before its use, from the anchor on in the order of "
    "writing") {
  Builder to;
  const Value x = to.given(0, 0), a = to.product(2, x), unused = to.product(3, x, x);
  CHECK(unused != a);
  const Value anchor = to.next();
  const Value first = to.sum({{1, x, x}, {1}}), second = to.sum({{1, first}, {1, a}});
  to.store(second, 1, 0);
  const StraightLine line = to.finish(2, 1, anchor);
  REQUIRE(line.nodes.size() == 4);  // x, x² + 1, 2 x, their sum
  CHECK(line.terms[line.nodes[1].last - 1].b != none);
  CHECK(evaluate(line, {{3}, {0}}).arrays[1][0] == 16);
  for (Value v = 0; v < line.nodes.size(); ++v)
    for (std::uint32_t i = line.nodes[v].first; i < line.nodes[v].last; ++i)
      for (const Value operand : {line.terms[i].a, line.terms[i].b}) CHECK((operand == none || operand < v));
}

TEST_CASE("in the order of urgency: what the end waits for longest is first") {
  Builder to;
  const Value x = to.given(0, 0), y = to.given(0, 1);
  const Value late = to.sum({{1, y, y}}), early = to.reciprocal(to.sum({{1, x, x}, {1}}));
  to.store(to.sum({{1, early, x}, {1, late}}), 1, 0);
  for (const std::size_t most_sorted : {std::size_t{0}, std::size_t{100}}) {
    Builder copy = to;
    const StraightLine line = copy.finish(2, 1, 0, most_sorted);
    CHECK(evaluate(line, {{2, 3}, {0}}).arrays[1][0] == doctest::Approx(9.4));
    const auto place_of = [&](auto&& is) {
      return std::find_if(line.nodes.begin(), line.nodes.end(), is) - line.nodes.begin();
    };
    const auto quotient = place_of([](const Node& node) { return node.what == Node::Sum && node.b != none; });
    const auto square = place_of(
        [&](const Node& node) { return node.what == Node::Sum && node.b == none && node.last - node.first == 1; });
    CHECK((quotient < square) == (most_sorted > 0));
  }
}
