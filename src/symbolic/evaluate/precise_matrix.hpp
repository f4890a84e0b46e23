#pragma once
#include "symbolic/evaluate/real100.hpp"

#include <complex>
#include <optional>
#include <vector>

namespace maupertuis::evaluation {

using Complex100 = std::complex<Real100>;

inline Real100 size_of(const Complex100& z) { return sqrt(Real100(z.real() * z.real() + z.imag() * z.imag())); }

/// Complex numbers of 100 digits, by rows.
struct PreciseMatrix {
  std::size_t rows = 0, columns = 0;
  std::vector<Complex100> entries;
  PreciseMatrix(std::size_t r, std::size_t c) : rows(r), columns(c), entries(r * c) {}
  Complex100& at(std::size_t i, std::size_t j) { return entries[i * columns + j]; }
  const Complex100& at(std::size_t i, std::size_t j) const { return entries[i * columns + j]; }
};

/// Gauss and Jordan with the largest pivots among the first `unknowns` columns, of rows and columns of size 1: what is
/// not above `least` is no pivot.
class Reduction {
 public:
  Reduction(PreciseMatrix matrix, std::size_t unknowns);
  /// `sizes`: of the terms whose sums the entries are, with which rows and columns are made of size 1: entries that
  /// cancel make no row small.
  Reduction(PreciseMatrix matrix, std::size_t unknowns, PreciseMatrix sizes, const Real100& least);
  std::size_t rank() const { return pivots_.size(); }
  /// x with A x = column k of what stands behind A; 0 where no pivot is.
  std::vector<Complex100> solution(std::size_t k) const;
  /// Independent x with A x = 0, as many as pivots are missing.
  std::vector<std::vector<Complex100>> kernel() const;

 private:
  void equilibrate(PreciseMatrix sizes);
  void eliminate(std::size_t row, std::size_t column);

  PreciseMatrix a_;
  std::size_t unknowns_;
  std::vector<Real100> column_sizes_;
  std::vector<std::pair<std::size_t, std::size_t>> pivots_;  // row, column
};

/// All eigenvalues of a square matrix, by the QR algorithm; nothing where it does not converge.
std::optional<std::vector<Complex100>> eigenvalues(PreciseMatrix a);

}  // namespace maupertuis::evaluation
