#include "analysis/invariants/field_linear_algebra.hpp"

#include <doctest/doctest.h>

using namespace maupertuis;
using namespace maupertuis::invariants;

namespace {

const PrimeField field(2305843009213693951ull);  // 2^61 − 1

FieldMatrix matrix(std::size_t rows, std::size_t columns, std::initializer_list<int> entries) {
  FieldMatrix m(rows, columns);
  std::size_t k = 0;
  for (const int e : entries) m.entries[k++] = field.from(Rational(e));
  return m;
}

}  // namespace

TEST_CASE("a column that depends on those before it has one circuit") {
  // c2 = 2 c0 − c1; c3 is new
  const auto vectors = null_vectors(matrix(3, 4, {1, 0, 2, 1, 0, 1, -1, 1, 1, 1, 1, 0}), field);
  REQUIRE(vectors.size() == 1);
  CHECK(vectors[0].columns == std::vector<std::size_t>{0, 1, 2});
  CHECK(vectors[0].entries == std::vector<Value>{field.from(Rational(-2)), field.one(), field.one()});
}

TEST_CASE("columns of zeros stand alone") {
  const auto vectors = null_vectors(matrix(2, 2, {0, 1, 0, 3}), field);
  REQUIRE(vectors.size() == 1);
  CHECK(vectors[0].columns == std::vector<std::size_t>{0});
}

TEST_CASE("solutions, and systems without one") {
  const auto x = solve(matrix(2, 3, {2, 1, 5, 1, 3, 10}), field);
  REQUIRE(x);
  CHECK(*x == std::vector<Value>{field.from(Rational(1)), field.from(Rational(3))});
  CHECK_FALSE(solve(matrix(2, 3, {1, 1, 1, 2, 2, 3}), field));
}

TEST_CASE("fractions come back from their residues") {
  for (const Rational& r : {Rational(0), Rational(-7, 3), Rational(1, 1000000007), Rational(123456789, 1000)})
    CHECK(rational_of(field.from(r), field) == r);
}
