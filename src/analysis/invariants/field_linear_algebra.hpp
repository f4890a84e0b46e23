#pragma once
#include <maupertuis/interrupt.hpp>
#include <maupertuis/rational.hpp>

#include "symbolic/evaluate/prime_field.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace maupertuis::invariants {

using evaluation::PrimeField;
using Value = PrimeField::Value;

/// Rows of residues.
struct FieldMatrix {
  std::size_t rows = 0, columns = 0;
  std::vector<Value> entries;  // [rows × columns]
  FieldMatrix() = default;
  FieldMatrix(std::size_t r, std::size_t c) : rows(r), columns(c), entries(r * c) {}
  Value& at(std::size_t i, std::size_t j) { return entries[i * columns + j]; }
  Value at(std::size_t i, std::size_t j) const { return entries[i * columns + j]; }
};

/// Row echelon form with unit pivots, in place; the columns of the pivots, ascending. Columns are taken from the left,
/// so that a column without a pivot depends on those before it. Cost rows · columns · rank / 2; throws Interrupted.
std::vector<std::size_t> echelon(FieldMatrix& m, const PrimeField& field, const Interrupt& interrupt = {});

/// A vector of the null space of a matrix: entries that are not zero, columns ascending, the last of them 1.
struct NullVector {
  std::vector<std::size_t> columns;
  std::vector<Value> entries;
};
/// For each column without a pivot the one combination of it and pivot columns before it that vanishes. These
/// circuits have the smallest supports: restricted to its columns, the null space of each has dimension 1.
std::vector<NullVector> null_vectors(FieldMatrix m, const PrimeField& field, const Interrupt& interrupt = {});

/// Some x with N x = c, for the augmented matrix [N | c]; nothing where there is none, or where one of the first
/// `determined` unknowns is free. Free unknowns are 0.
std::optional<std::vector<Value>> solve(FieldMatrix augmented, const PrimeField& field, std::size_t determined = 0);

/// The fraction a/b with |a| b < 2^44 of this residue (Wang 1981), or nothing: most residues have none.
std::optional<Rational> rational_of(Value value, const PrimeField& field);

}  // namespace maupertuis::invariants
