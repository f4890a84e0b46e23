#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "support.hpp"

#include <random>

using namespace maupertuis::syntax;
using namespace maupertuis::syntax::test;

namespace {

using Kind = Expression::Kind;
using Random = std::mt19937;

int below(Random& random, int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); }

template <typename T, std::size_t N>
T pick(Random& random, const T (&choices)[N]) {
  return choices[random() % N];
}

ExpressionPtr make(Kind kind, std::vector<ExpressionPtr> arguments, std::string text = {}) {
  auto e = std::make_shared<Expression>();
  e->kind = kind;
  e->text = std::move(text);
  e->arguments = std::move(arguments);
  return e;
}

ExpressionPtr random_name(Random& random) {
  auto e = std::make_shared<Expression>(*make(Kind::Name, {}, pick(random, {"x", "θ1", "m", "l_rod", "T", "Ω", "e2"})));
  e->primes = below(random, 3);
  return e;
}

ExpressionPtr random_tree(Random& random, int size);

ExpressionPtr random_condition(Random& random, int size) {
  auto e = std::make_shared<Expression>();
  e->kind = Kind::Binary;
  const bool joined = size > 2 && below(random, 2) == 0;
  e->op = joined ? pick(random, {Operator::And, Operator::Or})
                 : pick(random, {Operator::Less, Operator::LessEqual, Operator::Greater, Operator::GreaterEqual});
  for (int i = 0; i < 2; ++i)
    e->arguments.push_back(joined ? random_condition(random, size / 2) : random_tree(random, size / 2));
  return e;
}

ExpressionPtr random_binary(Random& random, int size) {
  auto e = std::make_shared<Expression>();
  e->kind = Kind::Binary;
  e->op = pick(random, {Operator::Add, Operator::Subtract, Operator::Multiply, Operator::Juxtapose, Operator::Juxtapose,
                        Operator::Divide, Operator::Dot, Operator::Cross, Operator::Power});
  e->arguments = {random_tree(random, size / 2), random_tree(random, size - size / 2)};
  return e;
}

ExpressionPtr random_tree(Random& random, int size) {
  if (size <= 1) {
    if (below(random, 3) == 0) return make(Kind::Number, {}, pick(random, {"1", "2", "0.5", "12", "1e-3", "6.67e11"}));
    return random_name(random);
  }
  const auto part = [&] { return random_tree(random, size / 2); };
  switch (below(random, 12)) {
    case 0: {
      auto e = std::make_shared<Expression>(*make(Kind::Unary, {part()}));
      e->op = Operator::Negate;
      return e;
    }
    case 1:
      return make(Kind::Call, {part()}, pick(random, {"sin", "sqrt", "exp", "cosh", "abs"}));
    case 2: {
      auto e =
          std::make_shared<Expression>(*make(Kind::Call, {random_name(random)}, pick(random, {"sin", "cos", "sech"})));
      e->bare = true;
      return e;
    }
    case 3:
      return make(Kind::Vector, {part(), part()});
    case 4: {
      auto e = std::make_shared<Expression>(*make(Kind::Member, {make(Kind::Name, {}, "P")}, pick(random, {"x", "ω"})));
      e->primes = below(random, 2);
      return e;
    }
    case 5: {
      auto e = std::make_shared<Expression>(*make(Kind::TimeDerivative, {random_binary(random, size / 2)}));
      e->primes = 1 + below(random, 2);
      return e;
    }
    case 6:
      return make(Kind::Piecewise, {random_condition(random, size / 2), part(), part()}, "piecewise");
    case 7: {
      auto e = std::make_shared<Expression>(*make(Kind::Quantity, {make(Kind::Number, {}, "3")}));
      e->unit = UnitExpression{{{"kg", 1, 1, {}}, {"s", -2, 1, {}}, {"m", 1, 2, {}}}, {}};
      e->unit_bracketed = true;
      return e;
    }
    default:
      return random_binary(random, size);
  }
}

constexpr const char* kDeclarations = "param x = 1, θ1 = 1, m = 1, l_rod = 1, Ω = 1, e2 = 1\npoint P at (0, 0)\n";

// A text from pieces of the language, in an order that mostly makes no sense.
std::string random_soup(Random& random, int size) {
  static const char* const pieces[] = {"param ",
                                       "coord ",
                                       "let ",
                                       "point ",
                                       "T = ",
                                       "expect ",
                                       "start ",
                                       "draw ",
                                       "run ",
                                       "constraint ",
                                       "\n",
                                       "\n    ",
                                       "  ",
                                       "#c\n",
                                       "x",
                                       "θ̇₁",
                                       "m",
                                       "1",
                                       "2.5e3",
                                       "½",
                                       "²",
                                       "√",
                                       "(",
                                       ")",
                                       "[",
                                       "]",
                                       ",",
                                       ":",
                                       "=",
                                       "+",
                                       "-",
                                       "−",
                                       "*",
                                       "/",
                                       "^",
                                       "'",
                                       ".",
                                       "..",
                                       "±",
                                       "<",
                                       ">=",
                                       "·",
                                       "sin ",
                                       "cos",
                                       "sqrt(",
                                       "dot(",
                                       "piecewise(",
                                       "else",
                                       "and",
                                       "kg",
                                       "m/s",
                                       "at ",
                                       "mass ",
                                       "rel ",
                                       "until ",
                                       "name ",
                                       "\"t\"",
                                       "θ",
                                       "°",
                                       "system s",
                                       "body B inertia diag(",
                                       "field u(",
                                       "event e when ",
                                       "@",
                                       "\t",
                                       "not conserved",
                                       "reaction "};
  std::string text;
  for (int i = 0; i < size; ++i) text += pick(random, pieces);
  return text;
}

// Formatting keeps the tree and the comments, and is idempotent.
void check_formatting(const std::string& text) {
  Parsed before(text);
  if (before.diagnostics.has_errors()) return;
  const std::string once = format(before.tree, before.source);
  Parsed after(once);
  RC_ASSERT(!after.diagnostics.has_errors());
  RC_ASSERT(dump(after.tree) == dump(before.tree));
  RC_ASSERT(after.tree.comments.size() == before.tree.comments.size());
  RC_ASSERT(format(after.tree, after.source) == once);
}

}  // namespace

TEST_CASE("an expression that is written out is read back") {
  CHECK(rc::check([](std::uint32_t seed) {
    Random random(seed);
    const int size = *rc::gen::inRange(1, 60);
    const ExpressionPtr tree = random_tree(random, size);
    const std::string text = to_string(*tree);
    Parsed parsed(std::string(kDeclarations) + "let result = " + text + "\n");
    RC_LOG() << text << "\n" << parsed.messages();
    RC_ASSERT(!parsed.diagnostics.has_errors());
    const auto& read = *std::get<LetStatement>(parsed.tree.statements.back().body).items.at(0).value;
    RC_ASSERT(shape(read) == shape(*tree));
    RC_ASSERT(to_string(read) == text);
  }));
}

TEST_CASE("random models keep their tree when formatted") {
  CHECK(rc::check([](std::uint32_t seed) {
    Random random(seed);
    const int statements = *rc::gen::inRange(1, 12);
    std::string text = kDeclarations;
    for (int i = 0; i < statements; ++i) {
      const std::string e = to_string(*random_tree(random, 1 + below(random, 60)));
      const std::string f = to_string(*random_tree(random, 1 + below(random, 20)));
      const char* const forms[] = {"let a = {}, b = {}",
                                   "T += {}",
                                   "point Q mass {} at {}",
                                   "force x = {}",
                                   "expect equation {} = {}",
                                   "claim {} = {}",
                                   "constraint {} = {} name c",
                                   "event h when {} = {} : stop",
                                   "start x = {}, θ1' = {}",
                                   "run until {} = {} within 3 s",
                                   "contact {} >= {} restitution 0"};
      std::string form = pick(random, forms);
      for (const std::string& part : {e, f}) {
        const std::size_t at = form.find("{}");
        if (at != std::string::npos) form.replace(at, 2, part);
      }
      text += form;
      text += pick(random, {"\n", "\n\n", "  # comment\n", "\n# comment\n", "\n\n\n# comment\n\n"});
    }
    RC_LOG() << text << "\n" << Parsed(text).messages();
    RC_ASSERT(!Parsed(text).diagnostics.has_errors());
    check_formatting(text);
  }));
}

TEST_CASE("any text is read without harm, and what is read can be formatted") {
  CHECK(rc::check([](std::uint32_t seed) {
    Random random(seed);
    const std::string text = random_soup(random, *rc::gen::inRange(0, 40));
    RC_LOG() << text << "\n" << Parsed(text).messages();
    check_formatting(text);
  }));
}
