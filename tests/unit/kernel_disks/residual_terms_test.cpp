// Rows as sums of terms, each bounded on the disk that suits it.
#include "followed.hpp"
#include "kernel/disks/many_disks.hpp"
#include "kernel/program/processor.hpp"

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

TEST_CASE("many disks at once say what each says alone, whatever the width of the registers") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> part(-0.3, 0.3);
  for (const Case& a : cases()) {
    CAPTURE(std::string(a.name));
    Followed f;
    f.c[0][0] = a.x0, f.c[1][0] = 0.7, f.t0 = 1.3;
    for (std::size_t i = 0; i < 2; ++i)
      for (std::size_t k = 1; k < 6; ++k) f.c[i][k] = part(random);
    f.follow(a.expression(f));
    const DiskPlan plan = [&] {
      DiskPlan made(f.kernel->program(), {});
      made.set_constants(f.constants.data());
      return made;
    }();
    const ManyDisks::Radii radii{1.1, 0.9, 0.7, 0.5, 0.35, 0.2, 0.1, 0.02};
    const SlotCoefficients rows{f.retrace->row(0), f.retrace->stride(), order};
    const ResidualTerms terms(f.kernel->program());
    for (auto make : {baseline_disks, avx2_disks, avx512_disks}) {
      if (make == avx2_disks && vector_instructions() < VectorInstructions::Avx2) continue;
      if (make == avx512_disks && vector_instructions() < VectorInstructions::Avx512) continue;
      const auto values = make(plan);
      if (!values) continue;
      std::vector<ManyDisks::Tails> tails(terms.terms().size());
      for (std::size_t pass = 0; pass < values->passes(); ++pass)
        values->evaluate(rows, radii, pass, terms.terms(), tails.data());
      for (std::size_t t = 0; t < tails.size(); ++t) {
        const ResidualTerms::Term& term = terms.terms()[t];
        if (term.b != no_slot || term.shift != 0) continue;
        Disks one(f.kernel->program());
        one.set_constants(f.constants.data());
        one.begin(rows);
        for (std::size_t disk = 0; disk < many; ++disk) {
          one.evaluate(radii[disk], Disks::Depth::Rules);
          CHECK(tails[t][disk] == one.tail(term.a));
        }
      }
    }
  }
}
