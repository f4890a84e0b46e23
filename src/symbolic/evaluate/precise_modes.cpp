#include <maupertuis/precise_modes.hpp>
#include <maupertuis/transform.hpp>

#include "symbolic/evaluate/precise_matrix.hpp"
#include "symbolic/evaluate/real_numbers.hpp"

#include <algorithm>
#include <limits>

namespace maupertuis {
namespace {

using evaluation::Complex100;
using evaluation::PreciseMatrix;
using evaluation::Real100;
using evaluation::size_of;

const Real100 one_value("1e-22"), no_part("1e-40");  // of an eigenvalue
const Real100 lost("1e-60");                         // of the largest one: what is left of a chain of zeros is more

/// R and φ, then their derivatives by q, q̇, q̈, λ, by rows; evaluated at any q and λ.
class RowsInDigits {
 public:
  RowsInDigits(const RowsOfMotion& motion, const Bindings& at)
      : motion_(motion), at_(at), n_(motion.q.size()), m_(motion.multipliers.size()), tape_(with_slopes(motion)) {
    for (const auto* symbols : {&motion.q, &motion.multipliers})
      for (const Expr& s : *symbols) unknowns_.push_back(s), values_.push_back(Real100(at.at(s)));
  }

  /// Newton's steps until they end; what the rows leave open stays as it is. λ is linear in R: it has no size, and
  /// needs none.
  bool settles(std::span<const double> sizes) {
    constexpr int most_turns = 12;
    for (int t = 0; t < most_turns; ++t) {
      if (!evaluate()) return false;
      const std::vector<Complex100> step = evaluation::Reduction(newton_system(), n_ + m_).solution(0);
      bool ends = true;
      for (std::size_t i = 0; i < n_ + m_; ++i) {
        values_[i] += step[i].real();
        ends = ends && (i >= n_ || size_of(step[i]) <= no_part * Real100(sizes[i]));
      }
      if (ends) return evaluate();
    }
    return false;
  }

  /// ∂R/∂q, ∂R/∂q̇, ∂R/∂q̈ for block 0, 1, 2.
  PreciseMatrix derivatives(std::size_t block) const { return part(0, n_, block * n_, n_); }
  PreciseMatrix by_multipliers() const { return part(0, n_, 3 * n_, m_); }
  PreciseMatrix positions_by_q() const { return part(n_, motion_.positions.size(), 0, n_); }

 private:
  static std::vector<Expr> with_slopes(const RowsOfMotion& motion) {
    std::vector<Expr> out;
    for (const auto* rows : {&motion.rows, &motion.positions})
      for (const Expr& row : *rows) {
        out.push_back(row);
        for (const auto* by : {&motion.q, &motion.v, &motion.a, &motion.multipliers})
          for (const Expr& slope : gradient(row, *by)) out.push_back(slope);
      }
    return out;
  }

  /// (∂R/∂q ∂R/∂λ; ∂φ/∂q 0) with −(R, φ) behind.
  PreciseMatrix newton_system() const {
    const std::size_t rows = n_ + motion_.positions.size();
    PreciseMatrix out(rows, n_ + m_ + 1);
    for (std::size_t i = 0; i < rows; ++i) {
      for (std::size_t j = 0; j < n_; ++j) out.at(i, j) = value(i, 1 + j);
      for (std::size_t j = 0; j < m_; ++j) out.at(i, n_ + j) = value(i, 1 + 3 * n_ + j);
      out.at(i, n_ + m_) = -value(i, 0);
    }
    return out;
  }

  bool evaluate() {
    evaluation::RealNumbers<Real100> numbers([&](Expr s) {
      const auto k = std::find(unknowns_.begin(), unknowns_.end(), s);
      return k != unknowns_.end() ? values_[static_cast<std::size_t>(k - unknowns_.begin())] : Real100(at_.at(s));
    });
    evaluation::run(tape_, numbers, nodes_);
    return std::all_of(tape_.roots().begin(), tape_.roots().end(),
                       [&](evaluation::Position root) { return isfinite(nodes_[root]); });
  }

  PreciseMatrix part(std::size_t row, std::size_t rows, std::size_t column, std::size_t columns) const {
    PreciseMatrix out(rows, columns);
    for (std::size_t i = 0; i < rows; ++i)
      for (std::size_t j = 0; j < columns; ++j) out.at(i, j) = value(row + i, 1 + column + j);
    return out;
  }
  Real100 value(std::size_t row, std::size_t entry) const {
    return nodes_[tape_.roots()[row * (1 + 3 * n_ + m_) + entry]];
  }

  const RowsOfMotion& motion_;
  const Bindings& at_;
  std::size_t n_, m_;
  evaluation::Tape tape_;
  std::vector<Expr> unknowns_;  // q, λ
  std::vector<Real100> values_, nodes_;
};

/// Columns that span what the rows leave.
PreciseMatrix kernel_of(const PreciseMatrix& rows, std::size_t n) {
  std::vector<std::vector<Complex100>> columns;
  if (rows.rows > 0) columns = evaluation::Reduction(rows, n).kernel();
  PreciseMatrix out(n, rows.rows > 0 ? columns.size() : n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < out.columns; ++j)
      out.at(i, j) = rows.rows > 0 ? columns[j][i] : Complex100(i == j ? 1 : 0);
  return out;
}

PreciseMatrix transposed(const PreciseMatrix& a) {
  PreciseMatrix out(a.columns, a.rows);
  for (std::size_t i = 0; i < a.rows; ++i)
    for (std::size_t j = 0; j < a.columns; ++j) out.at(j, i) = a.at(i, j);
  return out;
}

/// A sum and the sum of the sizes of its terms, by which one sees what is left of terms that cancel.
struct SumOfTerms {
  Complex100 sum;
  Real100 size = 0;
  void add(const Complex100& factor, const SumOfTerms& term) {
    if (size_of(factor) == 0 || term.size == 0) return;
    sum += factor * term.sum;
    size += size_of(factor) * term.size;
  }
};

/// Aᵀ X B. What its terms leave where they cancel is 0: a stiff link that does not change its length holds nothing.
PreciseMatrix projected(const PreciseMatrix& a, const PreciseMatrix& x, const PreciseMatrix& b) {
  static const Real100 rounding("1e-80");
  PreciseMatrix out(a.columns, b.columns);
  for (std::size_t j = 0; j < b.columns; ++j) {
    std::vector<SumOfTerms> xb(x.rows);
    for (std::size_t k = 0; k < x.rows; ++k)
      for (std::size_t l = 0; l < x.columns; ++l) xb[k].add(b.at(l, j), {x.at(k, l), size_of(x.at(k, l))});
    for (std::size_t i = 0; i < a.columns; ++i) {
      SumOfTerms entry;
      for (std::size_t k = 0; k < a.rows; ++k) entry.add(a.at(k, i), xb[k]);
      if (size_of(entry.sum) > rounding * entry.size) out.at(i, j) = entry.sum;
    }
  }
  return out;
}

/// M ξ̈ + C ξ̇ + K ξ = 0 on the displacements ξ = P η and the velocities ξ̇ = Q w that constraints leave, η̇ = S w. Where
/// they are of positions alone, P = Q.
struct FreeMotion {
  PreciseMatrix places, velocities;  // P [n × f], Q [n × g]
  PreciseMatrix rates;               // S [f × g]
  PreciseMatrix held;                // Qᵀ K P [g × f]: what holds a displacement
  PreciseMatrix k, c, m;             // Qᵀ (…) Q [g × g]

  explicit FreeMotion(const RowsInDigits& rows, std::size_t n)
      : places(kernel_of(rows.positions_by_q(), n)),
        velocities(kernel_of(transposed(rows.by_multipliers()), n)),
        rates(places.columns, velocities.columns),
        held(projected(velocities, rows.derivatives(0), places)),
        k(projected(velocities, rows.derivatives(0), velocities)),
        c(projected(velocities, rows.derivatives(1), velocities)),
        m(projected(velocities, rows.derivatives(2), velocities)) {
    const std::size_t f = places.columns, g = velocities.columns;
    PreciseMatrix both(n, f + g);  // P S = Q
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < f; ++j) both.at(i, j) = places.at(i, j);
      for (std::size_t j = 0; j < g; ++j) both.at(i, f + j) = velocities.at(i, j);
    }
    const evaluation::Reduction solved(std::move(both), f);
    for (std::size_t j = 0; j < g; ++j) {
      const std::vector<Complex100> column = solved.solution(j);
      for (std::size_t i = 0; i < f; ++i) rates.at(i, j) = column[i];
    }
  }

  /// Of x = (η, w).
  std::optional<PreciseMatrix> state_matrix() const {
    const std::size_t f = places.columns, g = velocities.columns;
    PreciseMatrix all(g, g + f + g), out(f + g, f + g);
    for (std::size_t i = 0; i < g; ++i) {
      for (std::size_t j = 0; j < g; ++j) all.at(i, j) = m.at(i, j), all.at(i, g + f + j) = c.at(i, j);
      for (std::size_t j = 0; j < f; ++j) all.at(i, g + j) = held.at(i, j);
    }
    const evaluation::Reduction by_mass(std::move(all), g);
    if (by_mass.rank() < g) return std::nullopt;
    for (std::size_t j = 0; j < f + g; ++j) {
      const std::vector<Complex100> column = by_mass.solution(j);
      for (std::size_t i = 0; i < g; ++i) out.at(f + i, j) = -column[i];
    }
    for (std::size_t i = 0; i < f; ++i)
      for (std::size_t j = 0; j < g; ++j) out.at(i, f + j) = rates.at(i, j);
    return out;
  }
};

/// Eigenvalues that are one, by their mean, which a Jordan chain does not blur.
struct Cluster {
  Complex100 sum;
  std::size_t count = 0;
  Complex100 mean() const { return sum / Complex100(Real100(count)); }
};
/// `smallest`: sizes below it count as that.
std::vector<Cluster> clusters(const std::vector<Complex100>& values, const Real100& smallest) {
  std::vector<Cluster> out;
  for (const Complex100& z : values) {
    const Real100 same = one_value * std::max(size_of(z), smallest);
    const auto near =
        std::find_if(out.begin(), out.end(), [&](const Cluster& c) { return size_of(c.mean() - z) <= same; });
    Cluster& cluster = near == out.end() ? out.emplace_back() : *near;
    cluster.sum += z;
    ++cluster.count;
  }
  return out;
}

/// z² M + z C + K and the sizes of its terms; a sum whose terms cancel to 50 digits is 0.
struct Pencil {
  PreciseMatrix sums, sizes;
};
Pencil pencil(const Complex100& z, const PreciseMatrix& m, const PreciseMatrix& c, const PreciseMatrix& k) {
  static const Real100 rounding("1e-50");
  Pencil out{PreciseMatrix(k.rows, k.columns), PreciseMatrix(k.rows, k.columns)};
  for (std::size_t i = 0; i < k.entries.size(); ++i) {
    const Complex100 terms[] = {z * z * m.entries[i], z * c.entries[i], k.entries[i]};
    const Complex100 sum = terms[0] + terms[1] + terms[2];
    const Real100 size = size_of(terms[0]) + size_of(terms[1]) + size_of(terms[2]);
    out.sizes.entries[i] = Complex100(size);
    if (size_of(sum) > rounding * size) out.sums.entries[i] = sum;
  }
  return out;
}

/// B y, its largest part 1.
std::vector<std::complex<double>> rounded_shape(const PreciseMatrix& basis, const std::vector<Complex100>& y) {
  std::vector<Complex100> x(basis.rows);
  for (std::size_t i = 0; i < basis.rows; ++i)
    for (std::size_t j = 0; j < basis.columns; ++j) x[i] += basis.at(i, j) * y[j];
  Real100 largest = 0;
  for (const Complex100& part : x) largest = std::max(largest, size_of(part));
  std::vector<std::complex<double>> out;
  for (const Complex100& part : x)
    out.emplace_back(static_cast<double>(part.real() / largest), static_cast<double>(part.imag() / largest));
  return out;
}

/// Independent ones; of 0 the displacements that nothing holds.
std::vector<std::vector<std::complex<double>>> shapes_of(const FreeMotion& free, const Complex100& z) {
  const bool is_zero = size_of(z) == 0;
  const PreciseMatrix none(free.held.rows, free.held.columns);
  Pencil here = is_zero ? pencil(z, none, none, free.held) : pencil(z, free.m, free.c, free.k);
  const PreciseMatrix& basis = is_zero ? free.places : free.velocities;
  std::vector<std::vector<std::complex<double>>> out;
  const evaluation::Reduction reduced(std::move(here.sums), basis.columns, std::move(here.sizes), one_value);
  for (const auto& y : reduced.kernel()) out.push_back(rounded_shape(basis, y));
  return out;
}

}  // namespace

std::optional<std::vector<PreciseMode>> precise_modes(const RowsOfMotion& motion, const Bindings& at,
                                                      std::span<const double> sizes) {
  const std::size_t n = motion.q.size();
  RowsInDigits rows(motion, at);
  if (!rows.settles(sizes)) return std::nullopt;
  const FreeMotion free(rows, n);
  const auto matrix = free.state_matrix();
  const auto values = matrix ? evaluation::eigenvalues(*matrix) : std::nullopt;
  if (!values) return std::nullopt;
  Real100 largest = 0;
  for (const Complex100& z : *values) largest = std::max(largest, size_of(z));
  // Where the stiffness is regular no eigenvalue is zero, and each has its digits, however small it is beside the
  // largest. Else a chain of zeros of four is known to 25 digits alone.
  const bool has_zeros = evaluation::Reduction(free.held, free.held.columns).rank() < free.held.columns;
  const Real100 smallest = has_zeros ? largest : lost * largest;
  std::vector<PreciseMode> out;
  for (const Cluster& cluster : clusters(*values, smallest)) {
    Complex100 z = cluster.mean();
    const bool is_zero = has_zeros && size_of(z) <= one_value * largest;
    const Real100 part = no_part * std::max(size_of(z), smallest);
    if (is_zero || abs(z.real()) <= part) z.real(0);
    if (is_zero || abs(z.imag()) <= part) z.imag(0);
    if (z.imag() < 0) continue;
    PreciseMode mode{{static_cast<double>(z.real()), static_cast<double>(z.imag())}, 0, cluster.count, {}};
    mode.error = is_zero ? static_cast<double>(one_value * largest)
                         : std::numeric_limits<double>::epsilon() * std::abs(mode.eigenvalue);
    mode.shapes = shapes_of(free, is_zero ? Complex100(0) : z);
    if (mode.shapes.empty()) return std::nullopt;
    out.push_back(std::move(mode));
  }
  return out;
}

}  // namespace maupertuis
