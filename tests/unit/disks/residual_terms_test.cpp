// Rows as sums of terms, each bounded on the disk that suits it.
#include "followed.hpp"
#include "disks/many_disks.hpp"
#include "machine_code/processor.hpp"

#include <doctest/doctest.h>

#include <algorithm>

using namespace maupertuis;
using namespace maupertuis::test;

namespace {

constexpr std::size_t many = Disks::many;

/// Of 5 sin x − 2 sin y + x'' and y'' + sin x with given tails of sin x and sin y; accelerations have none.
struct Rows {
  struct Given final : ManyDisks::Values {
    std::vector<Slot> sines;
    ManyDisks::Tails of_x{}, of_y{};
    std::size_t passes() const override { return 1; }
    void evaluate(const SlotCoefficients&, const ManyDisks::Radii&, std::size_t,
                  std::span<const ResidualTerms::Term> terms, ManyDisks::Tails* tails) override {
      for (std::size_t t = 0; t < terms.size(); ++t) {
        const bool is_value = terms[t].b == no_slot && terms[t].shift == 0;
        tails[t] = is_value && terms[t].a == sines[0]   ? of_x
                   : is_value && terms[t].a == sines[1] ? of_y
                                                        : ManyDisks::Tails{};
      }
    }
  };

  Followed f;
  Given* given = nullptr;
  std::unique_ptr<ManyDisks> disks;

  Rows() {
    f.follow(f.x, sin(f.x) * Rational(5) - sin(f.y) * Rational(2), sin(f.x));
    const Program& program = f.kernel->program();
    auto values = std::make_unique<Given>();
    values->sines.resize(2);
    for (const Instruction& i : program.instructions)
      if (i.op == Op::SinCos) values->sines[i.a == 0 ? 0 : 1] = i.out;
    given = values.get();
    disks = std::make_unique<ManyDisks>(program, std::move(values));
    disks->set_constants(f.constants.data());
  }
  /// Two disks; the others say nothing.
  void bound(double r0, double x0, double y0, double r1, double x1, double y1) {
    ManyDisks::Radii radii{r0, r1};
    std::fill(radii.begin() + 2, radii.end(), r1);
    given->of_x.fill(infinity), given->of_y.fill(infinity);
    given->of_x[0] = x0, given->of_y[0] = y0, given->of_x[1] = x1, given->of_y[1] = y1;
    disks->begin({nullptr, 0, order}, radii);
    CHECK(disks->ask_more());
    CHECK_FALSE(disks->ask_more());
  }
};

double weight(double h, double radius) { return std::pow(h / radius, order) / (1 - h / radius); }

}  // namespace

TEST_CASE("each term of a row is bounded on the disk that bounds it best, with its coefficient") {
  Rows a;
  REQUIRE(a.disks->rows().rows() == 2);
  a.bound(4, 1, infinity, 3, infinity, infinity);
  a.disks->find_left_out(1);
  CHECK(a.disks->left_out(0) == infinity);
  CHECK(a.disks->left_out(1) == doctest::Approx(weight(1, 4)).epsilon(1e-12));
  a.bound(4, 1, infinity, 3, 7, 11);
  a.disks->find_left_out(1);
  CHECK(a.disks->left_out(0) == doctest::Approx(5 * weight(1, 4) + 2 * 11 * weight(1, 3)).epsilon(1e-12));
  a.disks->find_left_out(1.5 * (1 + 1e-15));  // half of the second radius, up to rounding
  CHECK(a.disks->left_out(0) < infinity);
  a.disks->find_left_out(1.6);  // more than half of the second radius
  CHECK(a.disks->left_out(0) == infinity);
  CHECK(a.disks->left_out(1) < infinity);
  // A disk without anything on it, that ends before the step does, says nothing.
  a.bound(1.5, 0, 0, 1.5, 0, 0);
  a.disks->find_left_out(1);
  CHECK(a.disks->left_out(0) == infinity);
  a.bound(4, 0, 0, 3, infinity, infinity);
  a.disks->find_left_out(1);
  CHECK(a.disks->left_out(0) == 0);
}

TEST_CASE("a term that several rows have is bounded once") {
  Rows a;
  std::vector<ResidualTerms::Term> terms = a.disks->rows().terms();
  for (std::size_t i = 0; i < terms.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) CHECK_FALSE(terms[i] == terms[j]);
}

TEST_CASE("bounds that are no numbers bound nothing, on whichever disk") {
  for (std::size_t at = 0; at < many; ++at) {
    Rows a;
    ManyDisks::Radii radii;
    radii.fill(4);
    a.given->of_x.fill(std::numeric_limits<double>::quiet_NaN());
    a.given->of_y.fill(1);
    a.disks->begin({nullptr, 0, order}, radii);
    a.disks->ask_more();
    a.disks->find_left_out(1);
    CHECK(a.disks->left_out(0) == infinity);
    a.given->of_x[at] = 3;
    a.disks->begin({nullptr, 0, order}, radii);
    a.disks->ask_more();
    a.disks->find_left_out(1);
    CHECK(a.disks->left_out(0) == doctest::Approx((5 * 3 + 2) * weight(1, 4)).epsilon(1e-12));
  }
}

namespace {

/// Of a term by one disk alone: exactly where it is a value or a derivative of one; of a product the least and the most
/// that its factors leave.
struct Expected {
  double least, most;
};

Expected by_one_disk(Disks& one, const ResidualTerms::Term& term, const SlotCoefficients& rows, double radius) {
  const std::span<const int> degrees = one.degrees();
  const auto size = [&](Slot slot) { return std::abs(rows.rows[slot]); };
  if (term.b != no_slot) {
    const double a = one.reach(term.a), b = one.reach(term.b);
    const double most = size(term.a) * b + size(term.b) * a + a * b;
    const bool is_polynomial = degrees[term.a] + degrees[term.b] < order;
    return {is_polynomial || !(most < infinity) ? 0 : 1e-3 * most, most * (1 + 1e-12)};
  }
  const double tail = one.tail(term.a) * std::pow(2 * (order + 3) / radius, term.shift);
  return {tail * (1 - 1e-12), tail * (1 + 1e-12)};
}

void compare_with_one_disk(Followed& f) {
  const Program& program = f.kernel->program();
  DiskPlan plan(program, {});
  plan.set_constants(f.constants.data());
  const ResidualTerms terms(program);
  const ManyDisks::Radii radii{1.1, 0.9, 0.7, 0.5, 0.35, 0.2, 0.1, 0.02};
  const SlotCoefficients rows{f.retrace->row(0), f.retrace->stride(), order};
  Disks one(program);
  one.set_constants(f.constants.data());
  for (auto make : {baseline_disks, avx2_disks, avx512_disks}) {
    if (make == avx2_disks && vector_instructions() < VectorInstructions::Avx2) continue;
    if (make == avx512_disks && vector_instructions() < VectorInstructions::Avx512) continue;
    const auto values = make(plan);
    if (!values) continue;
    std::vector<ManyDisks::Tails> tails(terms.terms().size());
    for (std::size_t pass = 0; pass < values->passes(); ++pass)
      values->evaluate(rows, radii, pass, terms.terms(), tails.data());
    for (std::size_t disk = 0; disk < many; ++disk) {
      one.begin(rows);
      if (one.needs_larger_disk()) one.evaluate(1.4142135623730951 * radii[disk], Disks::Depth::Derivatives);
      one.evaluate(radii[disk], Disks::Depth::Rules);
      for (std::size_t t = 0; t < tails.size(); ++t) {
        if (terms.terms()[t].a < program.unknowns && terms.terms()[t].b == no_slot) continue;  // polynomials
        const Expected expected = by_one_disk(one, terms.terms()[t], rows, radii[disk]);
        CHECK(tails[t][disk] >= expected.least);
        CHECK(tails[t][disk] <= expected.most);
      }
    }
  }
}

}  // namespace

TEST_CASE("many disks at once say what each says alone, whatever the width of the registers") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> part(-0.3, 0.3);
  const auto begin = [&](Followed& f, double x0) {
    f.c[0][0] = x0, f.c[1][0] = 0.7, f.t0 = 1.3;
    for (std::size_t i = 0; i < 2; ++i)
      for (std::size_t k = 1; k < 6; ++k) f.c[i][k] = part(random);
  };
  for (const Case& a : cases()) {
    CAPTURE(std::string(a.name));
    Followed f;
    begin(f, a.x0);
    f.follow(a.expression(f));
    compare_with_one_disk(f);
  }
  Followed derivatives;
  begin(derivatives, 0.6);
  Context& context = derivatives.context;
  const Expr once = context.time_derivative(sin(derivatives.x * Rational(3)));
  derivatives.follow(once, once * cos(derivatives.y),
                     context.time_derivative(context.time_derivative(cos(derivatives.y))));
  compare_with_one_disk(derivatives);
  Followed product;
  begin(product, 0.6);
  product.follow(product.x, sin(product.x) * cos(product.y) * Rational(3),
                 sin(product.x) * apply(Kind::Exp, product.y));
  compare_with_one_disk(product);
}

TEST_CASE("terms that differ in one factor are not one") {
  Followed f;
  const Expr a = sin(f.x), b = cos(f.y), c = apply(Kind::Exp, f.y);
  f.follow(f.x, a * b * Rational(3), a * c + b * c + a * b);
  const ResidualTerms terms(f.kernel->program());
  CHECK(std::count_if(terms.terms().begin(), terms.terms().end(),
                      [](const ResidualTerms::Term& term) { return term.b != no_slot; }) == 3);
}

TEST_CASE("disks that were not asked say nothing, and those asked last in the step before are the first") {
  Followed f;
  f.follow(f.x, sin(f.x), f.context.number(0));
  struct InTwoPasses final : ManyDisks::Values {
    std::vector<std::size_t> asked;
    std::size_t passes() const override { return 2; }
    void evaluate(const SlotCoefficients&, const ManyDisks::Radii&, std::size_t pass,
                  std::span<const ResidualTerms::Term> terms, ManyDisks::Tails* tails) override {
      asked.push_back(pass);
      for (std::size_t t = 0; t < terms.size(); ++t)
        for (std::size_t disk = pass; disk < many; disk += 2) tails[t][disk] = terms[t].a < 2 ? 0 : pass == 0 ? 5 : 3;
    }
  };
  auto values = std::make_unique<InTwoPasses>();
  std::vector<std::size_t>& asked = values->asked;
  ManyDisks disks(f.kernel->program(), std::move(values));
  disks.set_constants(f.constants.data());
  ManyDisks::Radii radii;
  radii.fill(4);
  disks.begin({nullptr, 0, order}, radii);
  disks.find_left_out(1);
  CHECK(disks.left_out(0) == infinity);
  REQUIRE(disks.ask_more());
  disks.find_left_out(1);
  CHECK(disks.left_out(0) == doctest::Approx(5 * weight(1, 4)).epsilon(1e-12));
  REQUIRE(disks.ask_more());
  disks.find_left_out(1);
  CHECK(disks.left_out(0) == doctest::Approx(3 * weight(1, 4)).epsilon(1e-12));
  CHECK_FALSE(disks.ask_more());
  disks.begin({nullptr, 0, order}, radii);
  REQUIRE(disks.ask_more());
  disks.begin({nullptr, 0, order}, radii);
  REQUIRE(disks.ask_more());
  CHECK(asked == std::vector<std::size_t>{0, 1, 1, 1});
}
