// Rows as sums of terms, each bounded on the disk that suits it.
#include "kernel/disks/residual_terms.hpp"
#include "followed.hpp"

#include <doctest/doctest.h>

#include <map>

using namespace maupertuis;
using namespace maupertuis::test;

namespace {

/// Of 5 sin x − 2 sin y + x'' with the terms of its rows by name.
struct Rows {
  Followed f;
  std::unique_ptr<ResidualTerms> rows;

  Rows() {
    f.follow(f.x, sin(f.x) * Rational(5) - sin(f.y) * Rational(2));
    rows = std::make_unique<ResidualTerms>(f.kernel->program());
    rows->set_constants(f.constants.data());
    rows->begin();
  }
  /// Tails of sin x and sin y; accelerations have none.
  void add_disk(double radius, double of_x, double of_y) {
    const Program& p = f.kernel->program();
    rows->add_disk(radius, [&](const ResidualTerms::Term& term) {
      for (const Instruction& i : p.instructions)
        if (i.op == Op::SinCos && i.out == term.a && term.shift == 0) return i.a == 0 ? of_x : of_y;
      return 0.0;
    });
  }
};

double weight(double h, double radius) { return std::pow(h / radius, order) / (1 - h / radius); }

}  // namespace

TEST_CASE("each term of a row is bounded on the disk that bounds it best, with its coefficient") {
  Rows a;
  REQUIRE(a.rows->rows() == 2);
  a.add_disk(4, 1, infinity);
  a.rows->find_left_out(1, order);
  CHECK(a.rows->left_out(0) == infinity);
  CHECK(a.rows->left_out(1) == 0);
  a.add_disk(3, 7, 11);
  a.rows->find_left_out(1, order);
  CHECK(a.rows->left_out(0) == doctest::Approx(5 * weight(1, 4) + 2 * 11 * weight(1, 3)).epsilon(1e-12));
  a.rows->find_left_out(1, order, 0b01);  // without the first
  CHECK(a.rows->left_out(0) == doctest::Approx((5 * 7 + 2 * 11) * weight(1, 3)).epsilon(1e-12));
  a.rows->find_left_out(1.5 * (1 + 1e-15), order);  // half of the second radius, up to rounding
  CHECK(a.rows->left_out(0) < infinity);
  a.rows->find_left_out(1.6, order);  // more than half of the second radius
  CHECK(a.rows->left_out(0) == infinity);
  // A disk without anything on it, that ends before the step does, says nothing.
  a.rows->begin();
  a.add_disk(1.5, 0, 0);
  a.rows->find_left_out(1, order);
  CHECK(a.rows->left_out(0) == infinity);
  a.rows->begin();
  a.add_disk(4, 0, 0);
  a.rows->find_left_out(1, order);
  CHECK(a.rows->left_out(0) == 0);
}

TEST_CASE("bounds that are no numbers bound nothing") {
  Rows a;
  a.add_disk(4, std::numeric_limits<double>::quiet_NaN(), 1);
  a.rows->find_left_out(1, order);
  CHECK(a.rows->left_out(0) == infinity);
}
