#include <maupertuis/evaluate.hpp>
#include <maupertuis/repeated_evaluation.hpp>
#include <maupertuis/transform.hpp>

#include "linear_algebra/dense.hpp"
#include "symbolic/evaluate/real100.hpp"
#include "symbolic/evaluate/real_numbers.hpp"

#include <algorithm>
#include <random>
#include <type_traits>

/// Identities on a manifold. No exact arithmetic reaches its points, so that these are found to double precision by
/// Newton's method and then to 100 digits by the same method with the Jacobian held: each turn adds some fifteen
/// digits. What counts as 0 is measured by the sizes of the terms, and by what a change of the unknowns by their own
/// size would make: the relation ψ'' = 0 has one term, which is never small beside itself.
namespace maupertuis {
namespace {

using evaluation::Real100;
using evaluation::Tape;
using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using Index = Eigen::Index;
using Precise = std::unordered_map<Expr, Real100, ExprHash>;

constexpr double on_relations = 1e-9;  // relative: from here the refinement takes over
constexpr double independent = 1e-5;   // of the largest pivot
constexpr int newton_turns = 60, refining_turns = 12, attempts_per_point = 12;
const Real100 refined("1e-75"), vanishing("1e-60");

std::vector<Expr> terms_of(Expr e) {
  if (!e.is(Kind::Sum)) return {e};
  std::vector<Expr> terms;
  for (std::size_t i = 0; i < e.size(); ++i)
    for (const Expr& term : terms_of(e[i])) terms.push_back(term);
  return terms;
}

/// The highest derivative of a coordinate in it; a multiplier goes with accelerations.
int level_of(std::span<const Expr> expression) {
  int level = 0;
  for (const Expr& symbol : symbols_of(expression)) {
    if (symbol.role() == Role::Coordinate) level = std::max(level, symbol.order());
    if (symbol.role() == Role::Multiplier) level = 2;
  }
  return std::min(level, 2);
}

/// Sums of terms, evaluated with their sizes.
class Sums {
 public:
  explicit Sums(std::span<const Expr> sums) {
    for (const Expr& e : sums) {
      for (const Expr& term : terms_of(e)) terms_.push_back(term);
      end_.push_back(terms_.size());
    }
    tape_ = std::make_unique<Tape>(terms_);
  }

  template <class Real, class Lookup>
  void evaluate(Lookup lookup, std::vector<Real>& value, std::vector<Real>& size) const {
    using std::abs;
    evaluation::RealNumbers<Real> numbers(lookup);
    std::vector<Real> nodes;
    evaluation::run(*tape_, numbers, nodes);
    value.assign(end_.size(), Real(0));
    size.assign(end_.size(), Real(0));
    std::size_t k = 0;
    for (std::size_t i = 0; i < end_.size(); ++i)
      for (; k < end_[i]; ++k) {
        const Real& term = nodes[tape_->roots()[k]];
        value[i] += term;
        size[i] += abs(term);
      }
  }

 private:
  std::vector<Expr> terms_;
  std::vector<std::size_t> end_;
  std::unique_ptr<Tape> tape_;
};

/// A point that was drawn on the relations; nothing where Newton's method led to none.
struct Drawn {
  std::optional<Precise> point;
  Bindings rounded;
  Index rank = 0;  // of the relations there
};

class OnRelations {
 public:
  OnRelations(std::span<const Expr> relations, std::span<const Expr> unknowns, const Bindings& center,
              const ZeroTestOptions& options)
      : relations_(relations),
        unknowns_(unknowns.begin(), unknowns.end()),
        center_(center),
        options_(options),
        random_(options.seed),
        jacobian_(rows_of(relations)) {
    for (const Expr& relation : relations) relation_levels_.push_back(level_of({&relation, 1}));
    for (const Expr& unknown : unknowns_) unknown_levels_.push_back(level_of({&unknown, 1}));
    rows_ = static_cast<Index>(relations.size());
    reach_.resize(static_cast<Index>(unknowns_.size()));
    for (std::size_t i = 0; i < unknowns_.size(); ++i)
      reach_[static_cast<Index>(i)] = own_size(center.at(unknowns_[i]));
  }

  /// The gradients of the functions by the unknowns, one after the other.
  std::vector<Expr> rows_of(std::span<const Expr> functions) const {
    std::vector<Expr> rows;
    for (const Expr& f : functions)
      for (const Expr& entry : gradient(f, unknowns_)) rows.push_back(entry);
    return rows;
  }

  /// How much each function changes when the unknowns change by their own size; `rows` of the functions' gradients.
  Vector changes(const RepeatedEvaluation& rows, const Bindings& at) const {
    return matrix(rows, at).cwiseAbs() * reach_;
  }

  const ZeroTestOptions& options() const { return options_; }

  /// The same of each attempt however often it is asked for.
  const Drawn& drawn(std::size_t attempt) {
    while (drawn_.size() <= attempt) {
      Drawn next{point(), {}, 0};
      if (next.point) {
        for (const auto& [symbol, x] : *next.point) next.rounded.emplace(symbol, static_cast<double>(x));
        next.rank = rank(next.rounded);
      }
      drawn_.push_back(std::move(next));
    }
    return drawn_[attempt];
  }

 private:
  /// The number of relations that are independent there, by the unknowns of the highest level, of their own sizes.
  Index rank(const Bindings& at) const {
    if (rows_ == 0 || unknown_levels_.empty()) return 0;
    const int highest = *std::max_element(unknown_levels_.begin(), unknown_levels_.end());
    const Vector determined = chosen(unknown_levels_, [highest](int level) { return level == highest; });
    const Matrix j = jacobian(at) * reach_.cwiseProduct(determined).asDiagonal();
    if (!j.allFinite()) return 0;
    Eigen::ColPivHouseholderQR<Matrix> solver(row_weights(j).asDiagonal() * j);
    solver.setThreshold(independent);
    return solver.rank();
  }

  /// A point on the relations to 100 digits, or nothing.
  std::optional<Precise> point() {
    Bindings at = center_;
    for (auto& [symbol, value] : at) {
      const double by = spread(symbol, value) * uniform(random_);
      if (!options_.hold_parameters || is_variable(symbol)) value += by;
    }
    if (!approach(at)) return std::nullopt;
    return refine(at);
  }

  static double uniform(std::mt19937_64& random) { return 2 * std::generate_canonical<double, 53>(random) - 1; }
  bool is_variable(Expr symbol) const {
    return symbol.role() == Role::Time || std::find(unknowns_.begin(), unknowns_.end(), symbol) != unknowns_.end();
  }
  double spread(Expr symbol, double value) const {
    if (symbol.role() == Role::Time) return 1;
    return is_variable(symbol) ? 0.3 * own_size(value) : 0.01 * std::abs(value);
  }
  static double own_size(double value) { return std::abs(value) > 1e-12 ? std::abs(value) : 1; }

  Matrix matrix(const RepeatedEvaluation& rows, const Bindings& at) const {
    const std::vector<double> numbers = rows([&](Expr s) { return at.at(s); });
    using ByRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const auto columns = static_cast<Index>(unknowns_.size());
    return Eigen::Map<const ByRows>(numbers.data(), static_cast<Index>(numbers.size()) / columns, columns);
  }
  Matrix jacobian(const Bindings& at) const { return matrix(jacobian_, at); }

  /// Positions first, then velocities by those, then accelerations and multipliers: all at once would be drawn to where
  /// coordinates fail (Euler angles at θ = 0), since there an equation of motion holds whatever the accelerations are.
  bool approach(Bindings& at) const {
    for (int level = 0; level <= 2; ++level) {
      Bindings nearer = at;
      const auto here = [level](int of) { return of == level; };
      if (newton(nearer, chosen(relation_levels_, here), chosen(unknown_levels_, here))) at = std::move(nearer);
    }
    const auto all = [](int) { return true; };
    return newton(at, chosen(relation_levels_, all), chosen(unknown_levels_, all));
  }

  template <class Choose>
  static Vector chosen(const std::vector<int>& levels, Choose choose) {
    Vector out(static_cast<Index>(levels.size()));
    for (std::size_t i = 0; i < levels.size(); ++i) out[static_cast<Index>(i)] = choose(levels[i]) ? 1 : 0;
    return out;
  }

  /// On the relations and with the unknowns that are marked by 1.
  bool newton(Bindings& at, const Vector& marked, const Vector& moving) const {
    std::vector<double> value, size;
    const Vector change = changes(jacobian_, at);
    if (!change.allFinite()) return false;
    const auto measure = [&] {
      relations_.evaluate<double>([&](Expr s) { return at.at(s); }, value, size);
      double worst = 0;
      for (std::size_t i = 0; i < value.size(); ++i) {
        value[i] *= marked[static_cast<Index>(i)];
        worst = std::max(worst, !std::isfinite(value[i]) ? HUGE_VAL
                                : value[i] == 0          ? 0
                                                : std::abs(value[i]) / (size[i] + change[static_cast<Index>(i)]));
      }
      return worst;
    };
    const auto norm = [&](const Vector& weight) {
      return weight.cwiseProduct(Eigen::Map<const Vector>(value.data(), rows_)).norm();
    };
    double error = measure();
    for (int turn = 0; turn < newton_turns && error > on_relations; ++turn) {
      const Matrix j = marked.asDiagonal() * jacobian(at) * moving.asDiagonal();
      if (!j.allFinite() || !std::isfinite(error)) return false;
      const Vector weight = row_weights(j);
      const Vector step = solve(j, Eigen::Map<const Vector>(value.data(), rows_));
      const Bindings before = at;
      const double merit = norm(weight);
      bool closer = false;
      for (double damping = 1; !closer && damping > 1e-6; damping /= 2) {
        for (std::size_t i = 0; i < unknowns_.size(); ++i)
          at[unknowns_[i]] = before.at(unknowns_[i]) - damping * step[static_cast<Index>(i)];
        error = measure();
        closer = norm(weight) < merit;
      }
      if (!closer) return error < 1e-6;  // rounding: the refinement decides
    }
    return error <= 1e-6;
  }

  static Vector row_weights(const Matrix& j) {
    Vector weight = j.rowwise().norm();
    for (Index i = 0; i < weight.size(); ++i) weight[i] = weight[i] > 0 ? 1 / weight[i] : 1;
    return weight;
  }

  static Vector solve(const Matrix& j, const Vector& r) {
    const Vector weight = row_weights(j);
    Eigen::CompleteOrthogonalDecomposition<Matrix> solver(weight.asDiagonal() * j);
    solver.setThreshold(1e-10);
    return solver.solve(Vector(weight.cwiseProduct(r)));
  }

  std::optional<Precise> refine(const Bindings& at) const {
    Precise point;
    for (const auto& [symbol, value] : at) point.emplace(symbol, Real100(value));
    const Matrix j = jacobian(at);
    if (!j.allFinite()) return std::nullopt;
    const Vector weight = row_weights(j);
    Eigen::CompleteOrthogonalDecomposition<Matrix> solver(weight.asDiagonal() * j);
    solver.setThreshold(1e-10);
    const Vector change = j.cwiseAbs() * reach_;
    std::vector<Real100> value, size;
    for (int turn = 0; turn < refining_turns; ++turn) {
      relations_.evaluate<Real100>([&](Expr s) { return point.at(s); }, value, size);
      Real100 largest = 0, worst = 0;
      for (std::size_t i = 0; i < value.size(); ++i) {
        if (!isfinite(value[i])) return std::nullopt;
        largest = std::max(largest, Real100(abs(value[i])));
        if (value[i] != 0)
          worst = std::max(worst, Real100(abs(value[i]) / (size[i] + Real100(change[static_cast<Index>(i)]))));
      }
      if (worst < refined) return point;
      Vector scaled(rows_);
      for (Index i = 0; i < rows_; ++i)
        scaled[i] = weight[i] * static_cast<double>(Real100(value[static_cast<std::size_t>(i)] / largest));
      const Vector step = solver.solve(scaled);
      for (std::size_t i = 0; i < unknowns_.size(); ++i)
        point[unknowns_[i]] -= largest * Real100(step[static_cast<Index>(i)]);
    }
    return std::nullopt;
  }

  Sums relations_;
  std::vector<Expr> unknowns_;
  Bindings center_;
  ZeroTestOptions options_;
  std::mt19937_64 random_;
  RepeatedEvaluation jacobian_;
  std::vector<Drawn> drawn_;
  std::vector<int> relation_levels_, unknown_levels_;
  Index rows_ = 0;
  Vector reach_;
};

}  // namespace

namespace {

/// A point on the relations, and whether the differences vanish there.
struct Judged {
  Bindings point;
  std::optional<double> difference;  // the first that does not vanish
};

/// What is 0 is measured by its terms and by what the unknowns' own sizes change in it. Nothing where a value is not
/// finite.
std::optional<Judged> judge(const Drawn& drawn, const Sums& sums, const RepeatedEvaluation& rows,
                            const OnRelations& manifold) {
  std::vector<Real100> value, size;
  sums.evaluate<Real100>([&](Expr s) { return drawn.point->at(s); }, value, size);
  if (!std::all_of(value.begin(), value.end(), [](const Real100& v) { return isfinite(v); })) return std::nullopt;
  Judged out{drawn.rounded, std::nullopt};
  const Vector change = manifold.changes(rows, out.point);
  if (!change.allFinite()) return std::nullopt;
  for (std::size_t i = 0; i < value.size() && !out.difference; ++i)
    if (!(abs(value[i]) <= vanishing * (size[i] + Real100(change[static_cast<Index>(i)]))))
      out.difference = static_cast<double>(value[i]);
  return out;
}

/// Points where the rank of the relations is as large as it gets: where coordinates fail (Euler angles at θ = 0) the
/// relations hold for accelerations that no motion has. `judge` gives nothing for a point that does not count.
template <class Judge>
auto regular_points(OnRelations& manifold, Judge judge) {
  Index rank = 0;
  std::vector<typename std::invoke_result_t<Judge, const Drawn&>::value_type> regular;
  const auto wanted = static_cast<std::size_t>(manifold.options().points);
  for (std::size_t attempt = 0; attempt < wanted * attempts_per_point && regular.size() < wanted; ++attempt) {
    const Drawn& drawn = manifold.drawn(attempt);
    if (!drawn.point || drawn.rank < rank) continue;
    auto judged = judge(drawn);
    if (!judged) continue;
    if (drawn.rank > rank) regular.clear();
    rank = drawn.rank;
    regular.push_back(std::move(*judged));
  }
  return regular;
}

}  // namespace

struct ZeroTestWhere::Impl {
  OnRelations manifold;
};

ZeroTestWhere::ZeroTestWhere(std::span<const Expr> relations, std::span<const Expr> unknowns, const Bindings& center,
                             const ZeroTestOptions& options)
    : impl_(new Impl{OnRelations(relations, unknowns, center, options)}) {}
ZeroTestWhere::~ZeroTestWhere() = default;
ZeroTestWhere::ZeroTestWhere(ZeroTestWhere&&) noexcept = default;
ZeroTestWhere& ZeroTestWhere::operator=(ZeroTestWhere&&) noexcept = default;

ZeroTest ZeroTestWhere::operator()(std::span<const Expr> differences) {
  OnRelations& manifold = impl_->manifold;
  const Sums sums(differences);
  const RepeatedEvaluation rows(manifold.rows_of(differences));
  const std::vector<Judged> regular =
      regular_points(manifold, [&](const Drawn& drawn) { return judge(drawn, sums, rows, manifold); });
  ZeroTest test;
  test.points = static_cast<int>(regular.size());
  for (const Judged& judged : regular) {
    if (!judged.difference) continue;
    test.verdict = Verdict::Nonzero;
    test.error_bound = 0;
    test.witness_value = *judged.difference;
    test.witness = judged.point;
    return test;
  }
  if (regular.size() == static_cast<std::size_t>(manifold.options().points))
    test.verdict = Verdict::Zero;
  else
    test.reason = "no point was found at which the constraints hold";
  return test;
}

ZeroTest zero_test_where(std::span<const Expr> differences, std::span<const Expr> relations,
                         std::span<const Expr> unknowns, const Bindings& center, const ZeroTestOptions& options) {
  return ZeroTestWhere(relations, unknowns, center, options)(differences);
}

// --------------------------------------------------------------------------------------------------------- the points

struct PointsWhere::Impl {
  OnRelations manifold;
  std::vector<Drawn> points;
  std::vector<Bindings> rounded;
};

PointsWhere::PointsWhere(std::span<const Expr> relations, std::span<const Expr> unknowns, const Bindings& center,
                         const ZeroTestOptions& options, std::span<const Expr> defined)
    : impl_(new Impl{OnRelations(relations, unknowns, center, options), {}, {}}) {
  const RepeatedEvaluation formulas(defined);
  impl_->points = regular_points(impl_->manifold, [&](const Drawn& drawn) -> std::optional<Drawn> {
    const std::vector<double> values = formulas([&](Expr s) { return drawn.rounded.at(s); });
    if (!std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); })) return std::nullopt;
    return drawn;
  });
  for (const Drawn& p : impl_->points) impl_->rounded.push_back(p.rounded);
}
PointsWhere::~PointsWhere() = default;
PointsWhere::PointsWhere(PointsWhere&&) noexcept = default;

const std::vector<Bindings>& PointsWhere::points() const { return impl_->rounded; }

Verdict PointsWhere::vanishes(Expr e) const {
  const Sums sums({&e, 1});
  const RepeatedEvaluation rows(impl_->manifold.rows_of({&e, 1}));
  bool judged_any = false;
  for (const Drawn& p : impl_->points) {
    const std::optional<Judged> judged = judge(p, sums, rows, impl_->manifold);
    if (!judged) continue;
    if (judged->difference) return Verdict::Nonzero;
    judged_any = true;
  }
  return judged_any ? Verdict::Zero : Verdict::Undecided;
}

}  // namespace maupertuis
