#include "analysis/invariants/field_linear_algebra.hpp"

#include <doctest/doctest.h>

#include <algorithm>

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

TEST_CASE("unknowns that must be determined") {
  const FieldMatrix m = matrix(2, 4, {1, 0, 2, 5, 0, 1, 1, 3});  // the third is free
  CHECK(solve(m, field, 2));
  CHECK_FALSE(solve(m, field, 3));
  CHECK_FALSE(solve(matrix(2, 4, {1, 2, 0, 5, 0, 0, 1, 3}), field, 2));
}

TEST_CASE("rank and null space of a large matrix of known rank, for primes up to 62 bits") {
  for (const std::uint64_t prime : {2305843009213693951ull, 4611686018427387847ull}) {  // 2^61 − 1, 2^62 − 57
    const PrimeField f(prime);
    const std::size_t rows = 40, columns = 33, rank = 21;
    std::uint64_t state = 5;
    const auto draw = [&] { return f.from_residue((state = evaluation::mix(state)) % prime); };
    FieldMatrix m(rows, columns), left(rows, rank), right(rank, columns);
    for (Value& v : left.entries) v = draw();
    for (Value& v : right.entries) v = draw();
    for (std::size_t i = 0; i < rows; ++i)
      for (std::size_t j = 0; j < columns; ++j)
        for (std::size_t k = 0; k < rank; ++k)
          m.at(i, j) = f.add(m.at(i, j), f.multiply(left.at(i, k), right.at(k, j)));
    FieldMatrix reduced = m;
    CHECK(echelon(reduced, f).size() == rank);
    for (std::size_t i = 0; i < rows; ++i)
      for (std::size_t j = 0; j < std::min(i, columns); ++j) CHECK(reduced.at(i, j) == 0);
    const auto vectors = null_vectors(m, f);
    CHECK(vectors.size() == columns - rank);
    for (const NullVector& v : vectors)
      for (std::size_t i = 0; i < rows; ++i) {
        Value sum = 0;
        for (std::size_t k = 0; k < v.columns.size(); ++k)
          sum = f.add(sum, f.multiply(v.entries[k], m.at(i, v.columns[k])));
        CHECK(sum == 0);
      }
  }
}

TEST_CASE("fractions come back from their residues") {
  for (const Rational& r : {Rational(0), Rational(-7, 3), Rational(1, 1000000007), Rational(123456789, 1000)})
    CHECK(rational_of(field.from(r), field) == r);
}
