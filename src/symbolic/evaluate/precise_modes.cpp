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

/// R, then its derivatives by q, q̇, q̈, by rows; evaluated at any q.
class RowsInDigits {
 public:
  RowsInDigits(const RowsOfMotion& motion, const Bindings& at)
      : motion_(motion), at_(at), n_(motion.q.size()), tape_(with_slopes(motion)) {
    for (const Expr& q : motion.q) q_.push_back(Real100(at.at(q)));
  }

  /// Newton's steps until they end; what the rows leave open stays as it is.
  bool settles(std::span<const double> sizes) {
    constexpr int most_turns = 12;
    for (int t = 0; t < most_turns; ++t) {
      if (!evaluate()) return false;
      PreciseMatrix system = derivatives(1, 1);
      for (std::size_t i = 0; i < n_; ++i) system.at(i, n_) = -value(i, 0);
      const std::vector<Complex100> step = evaluation::Reduction(std::move(system), n_).solution(0);
      bool ends = true;
      for (std::size_t i = 0; i < n_; ++i) {
        q_[i] += step[i].real();
        ends = ends && size_of(step[i]) <= no_part * Real100(sizes[i]);
      }
      if (ends) return evaluate();
    }
    return false;
  }

  /// ∂R/∂q, ∂R/∂q̇, ∂R/∂q̈ for block 1, 2, 3, with more columns behind.
  PreciseMatrix derivatives(std::size_t block, std::size_t more = 0) const {
    PreciseMatrix out(n_, n_ + more);
    for (std::size_t i = 0; i < n_; ++i)
      for (std::size_t j = 0; j < n_; ++j) out.at(i, j) = value(i, 1 + (block - 1) * n_ + j);
    return out;
  }

 private:
  static std::vector<Expr> with_slopes(const RowsOfMotion& motion) {
    std::vector<Expr> out;
    for (const Expr& row : motion.rows) {
      out.push_back(row);
      for (const auto* by : {&motion.q, &motion.v, &motion.a})
        for (const Expr& slope : gradient(row, *by)) out.push_back(slope);
    }
    return out;
  }

  bool evaluate() {
    evaluation::RealNumbers<Real100> numbers([&](Expr s) {
      const auto k = std::find(motion_.q.begin(), motion_.q.end(), s);
      return k != motion_.q.end() ? q_[static_cast<std::size_t>(k - motion_.q.begin())] : Real100(at_.at(s));
    });
    evaluation::run(tape_, numbers, nodes_);
    return std::all_of(tape_.roots().begin(), tape_.roots().end(),
                       [&](evaluation::Position root) { return isfinite(nodes_[root]); });
  }

  Real100 value(std::size_t row, std::size_t entry) const { return nodes_[tape_.roots()[row * (1 + 3 * n_) + entry]]; }

  const RowsOfMotion& motion_;
  const Bindings& at_;
  std::size_t n_;
  evaluation::Tape tape_;
  std::vector<Real100> q_, nodes_;
};

/// x = (ξ, ξ̇/s) in units of time of 1/s.
std::optional<PreciseMatrix> state_matrix(const PreciseMatrix& k, const PreciseMatrix& c, const PreciseMatrix& m) {
  const std::size_t n = k.rows;
  PreciseMatrix all(n, 3 * n), out(2 * n, 2 * n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j)
      all.at(i, j) = m.at(i, j), all.at(i, n + j) = k.at(i, j), all.at(i, 2 * n + j) = c.at(i, j);
  const evaluation::Reduction by_mass(std::move(all), n);
  if (by_mass.rank() < n) return std::nullopt;
  for (std::size_t j = 0; j < 2 * n; ++j) {
    const std::vector<Complex100> column = by_mass.solution(j);
    for (std::size_t i = 0; i < n; ++i) out.at(n + i, j) = -column[i];
  }
  for (std::size_t i = 0; i < n; ++i) out.at(i, n + i) = 1;
  return out;
}

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

std::vector<std::complex<double>> rounded_shape(const std::vector<Complex100>& x) {
  Real100 largest = 0;
  for (const Complex100& part : x) largest = std::max(largest, size_of(part));
  std::vector<std::complex<double>> out;
  for (const Complex100& part : x)
    out.emplace_back(static_cast<double>(part.real() / largest), static_cast<double>(part.imag() / largest));
  return out;
}

}  // namespace

std::optional<std::vector<PreciseMode>> precise_modes(const RowsOfMotion& motion, const Bindings& at,
                                                      std::span<const double> sizes) {
  const std::size_t n = motion.q.size();
  RowsInDigits rows(motion, at);
  if (!rows.settles(sizes)) return std::nullopt;
  const PreciseMatrix k = rows.derivatives(1), c = rows.derivatives(2), m = rows.derivatives(3);
  const auto matrix = state_matrix(k, c, m);
  const auto values = matrix ? evaluation::eigenvalues(*matrix) : std::nullopt;
  if (!values) return std::nullopt;
  Real100 largest = 0;
  for (const Complex100& z : *values) largest = std::max(largest, size_of(z));
  // Where ∂R/∂q is regular no eigenvalue is zero, and each has its digits, however small it is beside the largest. Else
  // a chain of zeros of four is known to 25 digits alone.
  const bool has_zeros = evaluation::Reduction(k, n).rank() < n;
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
    Pencil here = pencil(z, m, c, k);
    for (const auto& x : evaluation::Reduction(std::move(here.sums), n, std::move(here.sizes), one_value).kernel())
      mode.shapes.push_back(rounded_shape(x));
    if (mode.shapes.empty()) return std::nullopt;
    out.push_back(std::move(mode));
  }
  return out;
}

}  // namespace maupertuis
