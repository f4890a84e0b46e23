#include <maupertuis/precise_roots.hpp>
#include <maupertuis/transform.hpp>

#include "symbolic/evaluate/real100.hpp"
#include "symbolic/evaluate/real_numbers.hpp"

#include <algorithm>
#include <type_traits>

namespace maupertuis {
namespace {

using evaluation::Real100;
using Reals = std::vector<Real100>;
using PreciseValue = evaluation::Interval<Real100>;

constexpr int most_newton_turns = 500;
constexpr double least_factor = 0.4, geometric = 0.97, left_of_series = 1e-30, least_of_series = 1e-12;
const Real100 no_step("1e-60"), soft_pivot("1e-7"), no_pivot("1e-80"), no_residual("1e-70");
const Real100 underflow("1e-900");  // intervals are never narrower than 1e-1000: what they hold then is no rounding

/// A linear system of numbers with 100 digits, by rows: J, then f.
struct PreciseSystem {
  std::size_t rows = 0, columns = 0;
  Reals entries;  // [rows × (columns + 1)]
  Real100& at(std::size_t i, std::size_t j) { return entries[i * (columns + 1) + j]; }
  Real100& right(std::size_t i) { return at(i, columns); }
};

Real100 largest_of_row(PreciseSystem& s, std::size_t i) {
  Real100 out = 0;
  for (std::size_t j = 0; j < s.columns; ++j) out = std::max(out, Real100(abs(s.at(i, j))));
  return out;
}

void divide_rows_by_sizes(PreciseSystem& s) {
  for (std::size_t i = 0; i < s.rows; ++i) {
    const Real100 size = largest_of_row(s, i);
    for (std::size_t j = 0; size > 0 && j <= s.columns; ++j) s.at(i, j) /= size;
  }
}

void subtract_row(PreciseSystem& s, std::size_t pivot_row, std::size_t pivot, std::size_t i) {
  if (s.at(i, pivot) == 0) return;
  const Real100 part = s.at(i, pivot) / s.at(pivot_row, pivot);
  for (std::size_t j = 0; j <= s.columns; ++j) s.at(i, j) -= part * s.at(pivot_row, j);
  s.at(i, pivot) = 0;
}

/// Gauss and Jordan with the largest pivots, of rows of size 1.
struct Eliminated {
  Reals x;               // of J x = −f; 0 where no pivot is left
  Real100 residual = 0;  // the largest of f in rows without one
};
Eliminated eliminated(PreciseSystem s, const Real100& least_pivot) {
  std::vector<bool> taken_rows(s.rows), taken(s.columns);
  std::vector<std::pair<std::size_t, std::size_t>> pivots;
  while (pivots.size() < std::min(s.rows, s.columns)) {
    Real100 largest = least_pivot;
    std::optional<std::pair<std::size_t, std::size_t>> next;
    for (std::size_t i = 0; i < s.rows; ++i)
      for (std::size_t j = 0; !taken_rows[i] && j < s.columns; ++j)
        if (!taken[j] && abs(s.at(i, j)) > largest) largest = abs(s.at(i, j)), next = std::pair(i, j);
    if (!next) break;
    const auto [row, column] = *next;
    taken_rows[row] = taken[column] = true;
    pivots.push_back(*next);
    for (std::size_t i = 0; i < s.rows; ++i)
      if (i != row) subtract_row(s, row, column, i);
  }
  Eliminated out{Reals(s.columns, Real100(0)), 0};
  for (const auto& [row, column] : pivots) out.x[column] = -s.right(row) / s.at(row, column);
  for (std::size_t i = 0; i < s.rows; ++i)
    if (!taken_rows[i]) out.residual = std::max(out.residual, Real100(abs(s.right(i))));
  return out;
}

/// What is left of the way in units of the step, where steps shrink by one factor, 1 − 1/m at a root of order m; 0:
/// they do not. Steps that shrink faster and faster are no series: they may come to a place where roots part, or
/// vanish.
double rest_of_series(double step, double before, double before_that) {
  if (!(step < before && before < before_that)) return 0;
  const double factor = step / before;
  const bool is_one = factor > least_factor && factor < geometric && std::abs(factor - before / before_that) < 0.01;
  return is_one ? factor / (1 - factor) : 0;
}

}  // namespace

struct PreciseRoots::Impl {
  std::vector<Expr> unknowns;
  evaluation::Tape tape;      // of the functions, then of their derivatives by rows
  std::vector<bool> depends;  // [functions] on any of the unknowns

  static std::vector<Expr> with_slopes(std::span<const Expr> functions, const std::vector<Expr>& unknowns) {
    std::vector<Expr> out(functions.begin(), functions.end());
    for (const Expr& f : functions)
      for (const Expr& slope : gradient(f, unknowns)) out.push_back(slope);
    return out;
  }
  Impl(std::span<const Expr> functions, std::span<const Expr> by)
      : unknowns(by.begin(), by.end()), tape(with_slopes(functions, unknowns)) {
    for (const Expr& f : functions) {
      const std::vector<Expr> slopes = gradient(f, unknowns);
      depends.push_back(std::any_of(slopes.begin(), slopes.end(), [](const Expr& e) { return !e.is_zero(); }));
    }
  }

  Reals unknowns_at(const Bindings& start) const {
    Reals out;
    for (const Expr& x : unknowns) out.push_back(Real100(start.at(x)));
    return out;
  }

  template <class Number>
  std::vector<Number> nodes_at(const Bindings& others, const Reals& at) const {
    std::vector<Number> nodes;
    evaluation::RealNumbers<Number> numbers([&](Expr s) {
      const auto k = std::find(unknowns.begin(), unknowns.end(), s);
      const Real100 x =
          k != unknowns.end() ? at[static_cast<std::size_t>(k - unknowns.begin())] : Real100(others.at(s));
      if constexpr (std::is_same_v<Number, Real100>)
        return x;
      else
        return Number{x, x};
    });
    evaluation::run(tape, numbers, nodes);
    return nodes;
  }

  /// [functions and derivatives] which of them are rounding alone, by interval arithmetic: cos²θ + sin²θ − 1.
  std::vector<bool> rounding_at(const Bindings& others, const Reals& at) const {
    const auto nodes = nodes_at<PreciseValue>(others, at);
    std::vector<bool> out;
    for (const evaluation::Position root : tape.roots())
      out.push_back(nodes[root].contains_zero() && nodes[root].high - nodes[root].low > underflow);
    return out;
  }

  /// Columns by the sizes; nothing where a value is none.
  std::optional<PreciseSystem> system_at(const Bindings& others, const Reals& at, const Reals& sizes,
                                         const std::vector<bool>& is_rounding) const {
    const auto nodes = nodes_at<Real100>(others, at);
    const auto value = [&](std::size_t k) { return is_rounding[k] ? Real100(0) : nodes[tape.roots()[k]]; };
    PreciseSystem out;
    out.columns = unknowns.size(), out.rows = tape.roots().size() / (out.columns + 1);
    out.entries.resize(tape.roots().size());
    for (std::size_t i = 0; i < out.rows; ++i) {
      out.right(i) = nodes[tape.roots()[i]];
      for (std::size_t j = 0; j < out.columns; ++j) out.at(i, j) = sizes[j] * value(out.rows + i * out.columns + j);
    }
    const bool finite =
        std::all_of(out.entries.begin(), out.entries.end(), [](const Real100& x) { return isfinite(x); });
    return finite ? std::optional(std::move(out)) : std::nullopt;
  }
};

PreciseRoots::PreciseRoots(std::span<const Expr> functions, std::span<const Expr> unknowns)
    : impl_(std::make_unique<Impl>(functions, unknowns)) {}
PreciseRoots::~PreciseRoots() = default;

/// Newton's method with pivots from `least_pivot` on.
class PreciseRoots::Way {
 public:
  Way(const Impl& functions, const Bindings& start, std::span<const double> sizes, const std::vector<bool>& is_rounding,
      const Real100& least_pivot)
      : functions_(functions),
        start_(start),
        sizes_(sizes.begin(), sizes.end()),
        least_pivot_(least_pivot),
        at_(functions.unknowns_at(start)),
        is_rounding_(is_rounding) {
    for (std::size_t j = 0; j < at_.size(); ++j)
      by_.push_back(sizes_[j] > 0 ? Real100(sizes_[j]) : std::max(Real100(1), Real100(abs(at_[j]))));
    from_ = at_;
  }

  bool arrives(double farthest) {
    double before = HUGE_VAL, before_that = HUGE_VAL;
    for (int turn = 0; turn < most_newton_turns; ++turn) {
      const auto next = move();
      if (!next || farthest_part(from_) > farthest) return false;
      const double now = largest_of_parts(next->x), rest = rest_of_series(now, before, before_that);
      for (std::size_t j = 0; rest > 0 && j < at_.size(); ++j) at_[j] += by_[j] * next->x[j] * Real100(rest);
      if (Real100(now) < no_step || (rest > 0 && rest * now < left_of_series)) return true;
      if (rest > 0 && rest * now < least_of_series && all_are_rounding()) return true;
      before_that = rest > 0 ? HUGE_VAL : before;
      before = rest > 0 ? HUGE_VAL : now;
    }
    return false;
  }
  bool leaves_no_residual() {
    const auto next = move();
    return next && next->residual < no_residual;
  }
  /// (x − 1)² + 10⁻³⁰ at 1: no step leads on, and it is no root. A function of none of the unknowns is not looked at.
  bool leaves_no_values_on_summits() const {
    const std::vector<bool> rounding = functions_.rounding_at(start_, at_);
    auto system = functions_.system_at(start_, at_, by_, rounding);
    for (std::size_t i = 0; system && i < system->rows; ++i)
      if (largest_of_row(*system, i) == 0 && functions_.depends[i] && !rounding[i] && system->right(i) != 0)
        return false;
    return system.has_value();
  }
  std::vector<double> place() const {
    std::vector<double> out;
    for (const Real100& x : at_) out.push_back(static_cast<double>(x));
    return out;
  }

 private:
  std::optional<Eliminated> move() {
    auto system = functions_.system_at(start_, at_, by_, is_rounding_);
    if (!system) return std::nullopt;
    divide_rows_by_sizes(*system);
    Eliminated out = eliminated(std::move(*system), least_pivot_);
    for (std::size_t j = 0; j < at_.size(); ++j) at_[j] += by_[j] * out.x[j];
    return out;
  }
  /// No function can be told from 0: of (x − a)¹², multiplied out, as soon as x − a is below 10⁻⁸.
  bool all_are_rounding() const {
    const std::vector<bool> rounding = functions_.rounding_at(start_, at_);
    const std::size_t count = rounding.size() / (at_.size() + 1);
    return std::all_of(rounding.begin(), rounding.begin() + static_cast<std::ptrdiff_t>(count),
                       [](bool is_rounding) { return is_rounding; });
  }
  double largest_of_parts(const Reals& moves) const {
    Real100 out = 0;
    for (std::size_t j = 0; j < moves.size(); ++j)
      if (sizes_[j] > 0) out = std::max(out, Real100(abs(moves[j])));
    return static_cast<double>(out);
  }
  double farthest_part(const Reals& from) const {
    Reals way;
    for (std::size_t j = 0; j < at_.size(); ++j) way.push_back((at_[j] - from[j]) / by_[j]);
    return largest_of_parts(way);
  }

  const Impl& functions_;
  const Bindings& start_;
  std::vector<double> sizes_;
  Real100 least_pivot_;
  Reals at_, from_, by_;
  const std::vector<bool>& is_rounding_;  // at the start
};

std::optional<std::vector<double>> PreciseRoots::near(const Bindings& start, std::span<const double> sizes,
                                                      double farthest) const {
  // A curve of roots first: what is soft stays as it is, and the other functions have to vanish with these. Beside such
  // a curve soft pivots are rounding of squares, and would lead anywhere.
  const std::vector<bool> is_rounding = impl_->rounding_at(start, impl_->unknowns_at(start));
  Way across(*impl_, start, sizes, is_rounding, soft_pivot);
  if (across.arrives(farthest) && across.leaves_no_residual()) return across.place();
  Way whole(*impl_, start, sizes, is_rounding, no_pivot);
  return whole.arrives(farthest) && whole.leaves_no_values_on_summits() ? std::optional(whole.place()) : std::nullopt;
}

}  // namespace maupertuis
