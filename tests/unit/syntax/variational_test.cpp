#include "support.hpp"

#include <doctest/doctest.h>

using namespace maupertuis;
using namespace maupertuis::syntax;
using maupertuis::syntax::test::Parsed;
using maupertuis::syntax::test::shape;

// The statements of variational problems: independent, path, constraint integral, and what is expected of paths.

namespace variational_test {
namespace {

template <class Body>
Body only(const std::string& text, const std::string& declarations = "") {
  Parsed parsed(declarations + text + "\n");
  REQUIRE_MESSAGE(parsed.fine(), parsed.messages());
  REQUIRE(std::holds_alternative<Body>(parsed.tree.statements.back().body));
  return std::get<Body>(parsed.tree.statements.back().body);
}

std::string codes(const std::string& text) { return Parsed(text + "\n").codes(); }

std::string formatted(const std::string& text) {
  Parsed parsed(text);
  REQUIRE_MESSAGE(parsed.fine(), parsed.messages());
  return format(parsed.tree, parsed.source);
}

std::vector<std::string> shapes(const std::vector<ExpressionPtr>& values) {
  std::vector<std::string> out;
  for (const ExpressionPtr& value : values) out.push_back(value ? shape(*value) : "free");
  return out;
}

using Shapes = std::vector<std::string>;

}  // namespace

TEST_CASE("independent: a name, and the kinds of coordinates") {
  CHECK(only<IndependentStatement>("independent x").name.text == "x");
  CHECK(only<IndependentStatement>("independent x").kind.text.empty());
  CHECK(only<IndependentStatement>("independent phi : angle").name.text == "φ");
  CHECK(only<IndependentStatement>("independent phi : angle").kind.text == "angle");
  CHECK(only<IndependentStatement>("independent s : [m^2/s]").unit->factors.size() == 2);
  CHECK(only<IndependentStatement>("independent t").name.text == "t");
  CHECK(codes("independent") == "E0111");
  CHECK(codes("independent x : lenght") == "E0129");
  CHECK(Parsed("independent x : lenght\n").diagnostics.items()[0].help == "Did you mean `length`?");
  CHECK(codes("independent sin") == "E0112");
  CHECK(codes("independent x, y") == "E0111");
}

TEST_CASE("t is a name like any other where another variable stands in its place") {
  CHECK(codes("coord t : length") == "E0112");
  CHECK(codes("independent s\ncoord t : length") == "");
  CHECK(codes("independent t\ncoord t : length") == "E0112");
  Parsed applied("independent s\ncoord y : length\nlet a = y(s)\n");
  CHECK(applied.codes() == "E0121");
  CHECK(applied.diagnostics.items()[0].message == "`y(s)` would be y times s");
  CHECK(codes("independent s\ncoord y : length, t : length\nlet a = y(t)") == "");
}

TEST_CASE("path: one value a coordinate, free where none is asked for") {
  const auto path = only<PathStatement>("path from (0, 1) at 0 to (2, free) at 1");
  CHECK(shapes(path.from.configuration) == Shapes{"0", "1"});
  CHECK(shapes(path.to.configuration) == Shapes{"2", "free"});
  CHECK(shape(*path.from.at) == "0");
  CHECK(shape(*path.to.at) == "1");
  const auto one = only<PathStatement>("path from 0 at 0 s to -l/2 at T0");
  CHECK(shapes(one.to.configuration) == Shapes{"(neg (/ l 2))"});
  CHECK(shapes(only<PathStatement>("path from (0) at 0 to (a + b)/2 at 1").to.configuration) ==
        Shapes{"(/ (+ a b) 2)"});
  CHECK(shapes(only<PathStatement>("path from (0) at 0 to (a + b) at 1").to.configuration) == Shapes{"(+ a b)"});
  const auto units = only<PathStatement>("path from (60 deg, -0.1 m) at 0 s to (1, free) rad at 2 s");
  CHECK(shapes(units.from.configuration) == Shapes{"[60 deg:1]", "(neg [0.1 m:1])"});
  CHECK(shapes(units.to.configuration) == Shapes{"[1 rad:1]", "free"});
  CHECK(shapes(only<PathStatement>("path from (1, 2, 3, 4, 5) at 0 to (free, free, 3, 4, 5) at 1").to.configuration)
            .size() == 5);
}

TEST_CASE("path: what is missing is said") {
  CHECK(codes("path (0, 1) at 0 to (2, 3) at 1") == "E0111");
  CHECK(codes("path from (0, 1) at 0") == "E0127");
  CHECK(codes("path from (0, 1) to (2, 3) at 1") == "E0111");
  CHECK(codes("path from (0, 1) at 0 to (2, 3)") == "E0127");
  CHECK(codes("path from (0, 1 at 0 to (2, 3) at 1") == "E0106");
  CHECK(codes("path from (0 m, 1) m at 0 to (2, 3) at 1") == "E0111");
}

TEST_CASE("a name `free` of the model is that name") {
  const auto path = only<PathStatement>("path from (0, 1) at 0 to (2, free) at 1", "param free = 3\n");
  CHECK(shapes(path.to.configuration) == Shapes{"2", "free"});
  CHECK(path.to.configuration[1] != nullptr);
}

TEST_CASE("constraint integral") {
  const auto held = only<ConstraintStatement>("constraint integral sqrt(1 + y'^2) = 2 m name length1");
  CHECK(held.integral);
  CHECK(held.name->text == "length1");
  CHECK(!only<ConstraintStatement>("constraint integral = 3", "coord integral : number\n").integral);
  CHECK(!only<ConstraintStatement>("constraint x = 3").integral);
}

namespace {

template <class Kind>
Kind expected(const std::string& line, const std::string& names = "") {
  const auto statement = names.empty() ? only<ExpectStatement>(line) : only<ExpectStatement>(line, names);
  INFO(line);
  REQUIRE(std::holds_alternative<Kind>(statement.kind));
  return std::get<Kind>(statement.kind);
}

}  // namespace

TEST_CASE("expectations of paths") {
  using namespace expectation;
  CHECK(expected<Action>("expect action = -0.37 ± 1e-9").path == 0);
  const auto given = expected<ActionAlong>("expect action of (4 t + 7, 3 t) from 0 s to 10 s = 435 J s rel 1e-9");
  CHECK(shapes(given.q) == Shapes{"(+ (_ 4 t) 7)", "(_ 3 t)"});
  CHECK(given.from);
  CHECK(given.to);
  CHECK(given.expected.tolerance.relative);
  CHECK(!expected<ActionAlong>("expect action of (t) = 1/2 ± 1e-9").from);
  CHECK(expected<MorseIndex>("expect index = 1").path == 0);
  CHECK(shape(*expected<PathAt>("expect path x' at 0.5 s = 0.2 m/s ± 1e-9").subject) == "x'");
  expected<PathAt>("expect path (x + y)^2 at 1 = 2 ± 1e-9");
  CHECK(codes("expect action = 3") == "E0127");
  CHECK(codes("expect path x = 3 ± 1") == "E0111");
  CHECK(codes("expect action of 4 t = 3 ± 1") == "E0111");
}

TEST_CASE("action, index and path stay usable as names") {
  using expectation::ValueAt;
  const std::string names = "coord action, index, path : number\n";
  CHECK_FALSE(expected<ValueAt>("expect action = 3 ± 1", names).time);
  CHECK_FALSE(expected<ValueAt>("expect index = 1", names).time);
  CHECK(expected<ValueAt>("expect path x at 1 = 3 ± 1", names + "param x = 2\n").time);
  CHECK(expected<ValueAt>("expect path at 1 = 3 ± 1", names).time);
  CHECK(expected<ValueAt>("expect action at 2 s = 3 ± 1").time);
}

TEST_CASE("variational statements keep their text and their tree when formatted") {
  const char* const texts[] = {
      "independent x : length",
      "independent s",
      "path from (0, -1) at -2 s to (2 m, free) at l/2",
      "path from -1 at 0 to free at 1",
      "path from (0, 1) m at 0 to (-2, 3) m at 1",
      "constraint integral -y sqrt(1 + y'^2) = 2 m name total",
      "expect action = -0.37 ± 1e-9",
      "expect action of (-4 t + 7, 3 t) from 0 s to 10 s = 435 J s rel 1e-9",
      "expect index = 1",
      "expect path x' at 0.5 s = -0.2 m/s ± 1e-9",
  };
  for (const char* text : texts) {
    CAPTURE(text);
    CHECK(formatted(std::string(text) + "\n") == std::string(text) + "\n");
    Parsed before(std::string(text) + "\n"), after(formatted(std::string(text) + "\n"));
    CHECK(dump(before.tree) == dump(after.tree));
  }
  CHECK(formatted("path  from(0,-1)at 0 to( 2,free )at 1\n") == "path from (0, -1) at 0 to (2, free) at 1\n");
}

TEST_CASE("golden: the tree of variational statements") {
  Parsed parsed(
      "independent x : [m]\npath from (0, 1 m) at 0 to free at 2 m\nconstraint integral y = 1 name area\n"
      "expect action of (x) from 0 to 1 m = 2 ± 1\nexpect path y at 1 m = 2 ± 1\n");
  REQUIRE_MESSAGE(parsed.fine(), parsed.messages());
  CHECK(dump(parsed.tree) ==
        "independent x\n  kind unit m\n"
        "path\n  from:\n    number 0\n  from:\n    quantity m\n      number 1\n  at:\n    number 0\n  to free\n  at:\n "
        "   quantity m\n      number 2\n"
        "integral constraint area\n  left:\n    name y\n  right:\n    number 1\n"
        "expect action\n  along:\n    name x\n  from:\n    number 0\n  to:\n    quantity m\n      number 1\n  value:\n "
        "   number 2\n  tolerance:\n    number 1\n"
        "expect path at\n  subject:\n    name y\n  time:\n    quantity m\n      number 1\n  value:\n    number 2\n  "
        "tolerance:\n    number 1\n");
}

}  // namespace variational_test
