#include "analysis/linearization/branch_walk.hpp"

#include "linear_algebra/dense.hpp"

#include <maupertuis/precise_roots.hpp>
#include <maupertuis/switches.hpp>
#include <maupertuis/transform.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

/// The rests are a curve F(z) = 0 of z = (q, λ, τ, p): balance, constraints, and no way along the translations, whose
/// forces τ vanish. With the tangent t, J t = 0, as a further row the matrix stays regular where the curve turns back,
/// though ∂F/∂q is singular there; where another branch crosses, its determinant changes sign.
namespace maupertuis {
namespace {

constexpr double longest = 0.05, first_step = 1e-3, shortest = 1e-9;  // of a step, in typical sizes
constexpr int most_steps = 5000, most_corrections = 10, most_halvings = 80;
constexpr double straight = 0.9;      // cosine of the turn in one step
constexpr double converged = 1e-13;   // of a correction: the next one is rounding
constexpr double at_rounding = 1e-9;  // of one that does not shrink any more
constexpr double rough = 1e-5;        // of one that rounding of the forces does not let shrink: 100 digits do
constexpr double level = 1e-4;        // of the tangent's part along the parameter: else the curve has a corner there
constexpr double on_value = 1e-9;     // of the way between two values: a fold so near to one of them is at it
constexpr double one_crossing = 1e-9, near_crossing = 1e-5;  // of a step: where two branches have one point
constexpr double apart = 1e-5;  // of the way between two values of the parameter, for the derivative by it

struct OnCurve {
  Vector z, tangent;
  bool regular_side = false;  // the sign of the determinant
};

class RestCurve {
 public:
  RestCurve(PointEquations::Impl& equations, const BranchStretch& end)
      : e_(equations),
        end_(end),
        n_(static_cast<Index>(equations.n)),
        m_(static_cast<Index>(equations.m)),
        pins_(static_cast<Index>(end.translations.size())),
        size_(n_ + m_ + pins_ + 1) {}

  BranchWalk walk() {
    auto here = begin();
    BranchWalk out;
    double step = first_step;
    for (int k = 0; here && k < most_steps && step > shortest; ++k) {
      const auto next = ahead(*here, step);
      if (!next || !goes_on(*here, *next, step) || (crosses(*here, *next) && is_jump(*here, *next, step)) ||
          hides_turns(*here, *next, step)) {
        step /= 2;
        continue;
      }
      if (turns(*here, *next)) {
        const auto fold = crosses(*here, *next) ? std::nullopt : located(*here, *next, step);
        if (!fold) return out;
        if (!out.folds.empty()) out.arms.push_back(rest_at(here->z));
        out.folds.push_back(*fold);
      }
      const double way = parameter_of(*next);
      if (way > 1 + on_value || way < -on_value) {
        const auto there = at_value(*here, *next, step, way > 0 ? 1 : 0);
        if (there) out.last = *there, out.end = way > 0 ? BranchWalk::End::Arrived : BranchWalk::End::Returned;
        return out;
      }
      here = next;
      step = std::min(2 * step, longest);
    }
    return out;
  }

 private:
  double parameter_of(const OnCurve& x) const { return x.z[size_ - 1]; }
  RestAt rest_at(const Vector& z) const { return {value_of(z), rest_of(z)}; }

  static bool crosses(const OnCurve& from, const OnCurve& next) { return from.regular_side != next.regular_side; }
  bool turns(const OnCurve& from, const OnCurve& next) const {
    return (from.tangent[size_ - 1] > 0) != (next.tangent[size_ - 1] > 0);
  }
  bool goes_on(const OnCurve& from, const OnCurve& next, double step) const {
    return next.tangent.dot(weighed(from.tangent)) >= straight && weighed(next.z - from.z).norm() * straight <= step;
  }

  /// Whether the curve turns back and on again within the step: its part along the parameter, small at both ends, has a
  /// minimum between them that is not known to be positive. Of a cusp, where it is 0, nothing is known at last.
  bool hides_turns(const OnCurve& from, const OnCurve& next, double step) {
    constexpr double steep = 0.2, shortest_looked_at = 1e-6, certain = 0.5;
    const Index p = size_ - 1;
    const double ends[] = {std::abs(from.tangent[p]), std::abs(next.tangent[p])};
    if (turns(from, next) || std::min(ends[0], ends[1]) > steep || step < shortest_looked_at) return false;
    const auto middle = ahead(from, step / 2);
    if (!middle || turns(from, *middle)) return true;
    const double between = std::abs(middle->tangent[p]), bend = ends[0] + ends[1] - 2 * between,
                 slope = (ends[1] - ends[0]) / 2;
    if (!(bend > std::abs(slope))) return false;  // the least one is at an end
    return between - slope * slope / (2 * bend) < certain * std::min({ends[0], ends[1], between});
  }

  /// Where the determinant has another sign, another branch crosses, or the step has gone over to one that passes
  /// nearby: then a place between, from which both sides are as near as the steps to it, is not there.
  bool is_jump(const OnCurve& from, const OnCurve& next, double step) {
    Vector low = from.z, high = next.z;
    double below = 0, above = step;
    while (above - below > one_crossing) {
      std::optional<OnCurve> middle;
      for (const double part : {0.5, 0.4}) {  // the very place is singular
        if (middle) break;
        middle = ahead(from, below + part * (above - below));
      }
      if (!middle && above - below > near_crossing) return true;
      if (!middle) break;
      const double way = weighed(from.tangent).dot(middle->z - from.z);
      if (crosses(from, *middle))
        above = way, high = middle->z;
      else
        below = way, low = middle->z;
    }
    constexpr double oblique = 4;
    return weighed(high - low).norm() > oblique * (above - below) + one_crossing;
  }

  /// The rest at the end of the stretch, or at its beginning, that lies between two places: by secants (Illinois).
  std::optional<RestAt> at_value(const OnCurve& from, const OnCurve& next, double step, double value) {
    double low = 0, high = step, off_low = parameter_of(from) - value, off_high = parameter_of(next) - value;
    Vector z = next.z;
    for (int k = 0; k < most_halvings && std::abs(z[size_ - 1] - value) > converged; ++k) {
      const bool halves = k % 8 == 7 || off_high == off_low;
      const double at = halves ? (low + high) / 2 : high - off_high * (high - low) / (off_high - off_low);
      const auto middle = ahead(from, at);
      if (!middle) return std::nullopt;
      z = middle->z;
      const double off = parameter_of(*middle) - value;
      if ((off > 0) == (off_high > 0))
        high = at, off_high = off, off_low /= 2;
      else
        low = high, off_low = off_high, high = at, off_high = off;
    }
    z[size_ - 1] = value;
    return rest_at(z);
  }

  /// The parameter runs from 0 to 1 on the way.
  std::optional<OnCurve> begin() {
    Vector z = Vector::Zero(size_);
    for (Index i = 0; i < n_; ++i) z[i] = end_.rest.q[static_cast<std::size_t>(i)] / size_of(i);
    for (Index i = 0; i < m_; ++i) z[n_ + i] = end_.rest.multipliers[static_cast<std::size_t>(i)];
    return with_tangent(z, Vector::Unit(size_, size_ - 1));
  }

  double size_of(Index i) const { return end_.sizes[static_cast<std::size_t>(i)]; }
  /// The values at the ends exactly.
  double value_of(const Vector& z) const {
    const double part = z[size_ - 1];
    return part == 1 ? end_.beyond : end_.value + part * (end_.beyond - end_.value);
  }

  OperatingPoint rest_of(const Vector& z) const {
    OperatingPoint out = end_.rest;
    for (Index i = 0; i < n_; ++i) out.q[static_cast<std::size_t>(i)] = z[i] * size_of(i);
    for (Index i = 0; i < m_; ++i) out.multipliers[static_cast<std::size_t>(i)] = z[n_ + i];
    return out;
  }

  void set_parameter(double value) {
    e_.parameters[end_.parameter] = value;
    for (PointEquations::Impl::Rows* rows : {&e_.resting, &e_.positions}) {
      rows->values.set_parameters(e_.parameters);
      rows->entries.set_parameters(e_.parameters);
    }
  }

  /// F at a place, in units of nothing in particular.
  Vector forces(const Vector& z) {
    set_parameter(value_of(z));
    const OperatingPoint at = rest_of(z);
    Vector out = Vector::Zero(size_ - 1);
    out.head(n_) = e_.value(e_.resting, at);
    out.segment(n_, m_) = e_.value(e_.positions, at);
    for (Index k = 0; k < pins_; ++k) {
      const Vector d = direction(k);
      out.head(n_) += z[n_ + m_ + k] * d;
      for (Index i = 0; i < n_; ++i)
        out[n_ + m_ + k] += d[i] * (z[i] - end_.rest.q[static_cast<std::size_t>(i)] / size_of(i));
    }
    return out;
  }

  Vector direction(Index k) const { return to_eigen(end_.translations[static_cast<std::size_t>(k)].direction); }

  Matrix jacobian(const Vector& z) {
    Matrix out = Matrix::Zero(size_ - 1, size_);
    const Vector step = apart * Vector::Unit(size_, size_ - 1);
    out.rightCols(1) = (forces(z + step) - forces(z - step)) / (2 * apart);
    set_parameter(value_of(z));
    const OperatingPoint at = rest_of(z);
    const RowsAtPoint balance = e_.at(e_.resting, at), positions = e_.at(e_.positions, at);
    for (Index i = 0; i < n_; ++i) {
      out.block(0, i, n_, 1) = size_of(i) * balance.by_q.col(i);
      out.block(n_, i, m_, 1) = size_of(i) * positions.by_q.col(i);
    }
    out.block(0, n_, n_, m_) = balance.by_multipliers;
    for (Index k = 0; k < pins_; ++k) {
      out.block(0, n_ + m_ + k, n_, 1) = direction(k);
      out.block(n_ + m_ + k, 0, 1, n_) = direction(k).transpose();
    }
    return out;
  }

  /// Multipliers have no size of their own: how far two places are apart is a matter of q and p.
  Vector weighed(Vector z) const {
    z.segment(n_, size_ - 1 - n_).setZero();
    return z;
  }

  /// Rows of one size, the last of them across the curve.
  struct Bordered {
    Eigen::PartialPivLU<Matrix> lu;
    Vector rows;
  };
  std::optional<Bordered> bordered(const Vector& z, const Vector& across) {
    Matrix all(size_, size_);
    all << jacobian(z), across.transpose();
    if (!all.allFinite()) return std::nullopt;
    const Vector largest = all.cwiseAbs().rowwise().maxCoeff();
    const Vector rows = (largest.array() > 0).select(largest.cwiseInverse(), 1.0);
    return Bordered{Eigen::PartialPivLU<Matrix>(Matrix(rows.asDiagonal() * all)), rows};
  }

  static bool is_positive(const Bordered& b) {
    const Vector pivots = b.lu.matrixLU().diagonal();
    return ((pivots.array() < 0).count() % 2 == 0) == (b.lu.permutationP().determinant() > 0);
  }

  std::optional<OnCurve> with_tangent(const Vector& z, const Vector& across) {
    const auto b = bordered(z, across);
    if (!b) return std::nullopt;
    Vector t = b->lu.solve(Vector(b->rows[size_ - 1] * Vector::Unit(size_, size_ - 1)));
    t /= weighed(t).norm();
    if (!t.allFinite()) return std::nullopt;
    const auto own = bordered(z, weighed(t));
    return own ? std::optional(OnCurve{z, t, is_positive(*own)}) : std::nullopt;
  }

  /// The place of the curve so far along the tangent.
  std::optional<OnCurve> ahead(const OnCurve& from, double step) {
    const Vector across = weighed(from.tangent);
    Vector z = from.z + step * from.tangent;
    double before = HUGE_VAL;
    for (int k = 0; k < most_corrections; ++k) {
      const auto b = bordered(z, across);
      if (!b) return std::nullopt;
      Vector off(size_);
      off << forces(z), across.dot(z - from.z) - step;
      const Vector move = b->lu.solve(Vector(b->rows.cwiseProduct(off)));
      const double length = weighed(move).norm();
      if (!(length < before || length < at_rounding))
        return before < rough && in_digits(z, from.tangent) ? with_tangent(z, across) : std::nullopt;
      z -= move;
      if (length < converged || (length < at_rounding && length > before / 4)) return with_tangent(z, across);
      before = length;
    }
    return std::nullopt;
  }

  /// The tangent's part along the parameter has another sign a step ahead.
  std::optional<RestAt> located(const OnCurve& from, const OnCurve& next, double step) {
    double low = 0, high = step;
    OnCurve at = next;
    for (int k = 0; k < most_halvings && high - low > 1e-16 * step; ++k) {
      const auto middle = ahead(from, (low + high) / 2);
      if (!middle) return std::nullopt;
      at = *middle;
      (turns(from, at) ? high : low) = (low + high) / 2;
    }
    if (std::abs(at.tangent[size_ - 1]) > level) return std::nullopt;
    for (Index i = 0; i < n_; ++i)
      if (std::abs(at.z[i]) < converged) at.z[i] = 0;
    RestAt out = fold_in_digits(at).value_or(rest_at(at.z));
    for (const double value : {end_.value, end_.beyond})
      if (std::abs(out.value - value) <= on_value * std::abs(end_.beyond - end_.value)) out.value = value;
    return out;
  }

  // ----------------------------------------------------------------------------------------------------- in 100 digits

  /// Some of q, λ and the parameter, with what a root is measured by.
  struct Unknowns {
    std::vector<Expr> symbols;
    std::vector<double> sizes;
    std::vector<Index> places;  // in z
  };
  Unknowns unknowns_but(Index held) const {
    Unknowns out;
    const auto add = [&](Index place, Expr symbol, double size) {
      if (place == held) return;
      out.symbols.push_back(symbol);
      out.sizes.push_back(size);
      out.places.push_back(place);
    };
    const MechanicalSystem& system = *e_.system;
    for (Index i = 0; i < n_; ++i) add(i, system.coordinates[static_cast<std::size_t>(i)].q, size_of(i));
    for (Index i = 0; i < m_; ++i) add(n_ + i, system.constraints[static_cast<std::size_t>(i)].multiplier, 0);
    add(size_ - 1, system.parameters[end_.parameter].symbol, std::abs(end_.beyond - end_.value));
    return out;
  }
  void take(const Unknowns& unknowns, const std::vector<double>& root, Vector& z) const {
    for (std::size_t k = 0; k < unknowns.places.size(); ++k) {
      const Index i = unknowns.places[k];
      z[i] = i < n_           ? root[k] / size_of(i)
             : i == size_ - 1 ? (root[k] - end_.value) / (end_.beyond - end_.value)
                              : root[k];
    }
  }

  /// Beside a stiff link rounding of its force moves the others: the place on the curve with the same value of what the
  /// tangent has most of.
  bool in_digits(Vector& z, const Vector& tangent) {
    Index held = 0;
    weighed(tangent).cwiseAbs().maxCoeff(&held);
    set_parameter(value_of(z));
    const Unknowns unknowns = unknowns_but(held);
    auto roots = roots_.find(held);
    if (roots == roots_.end())
      roots = roots_.emplace(held, std::make_unique<PreciseRoots>(resting_rows(), unknowns.symbols)).first;
    const auto root = roots->second->near(values_at(e_, rest_of(z)), unknowns.sizes, 1e2 * rough);
    if (root) take(unknowns, *root, z);
    return root.has_value();
  }

  /// F(q, λ, p) = 0 and ∂F/∂(q, λ) w = 0 with t·w = 1 is regular at a fold (Moore and Spence 1980). Velocities and
  /// accelerations, which no row of rests holds, stand for w.
  std::optional<RestAt> fold_in_digits(const OnCurve& at) {
    constexpr double nearby = 1e-4;
    set_parameter(value_of(at.z));
    const ExprVector rows = resting_rows();
    if (m_ > n_ || !switches_of(rows).empty()) return std::nullopt;
    const Unknowns unknowns = unknowns_but(size_);
    ExprVector symbols = unknowns.symbols;
    std::vector<double> sizes = unknowns.sizes;
    const ExprVector way = symbols_of_way();
    symbols.insert(symbols.end(), way.begin(), way.end());
    sizes.resize(symbols.size(), 0);
    Bindings from = values_at(e_, rest_of(at.z));
    const double length = at.tangent.head(n_).squaredNorm();
    for (Index i = 0; i < n_ + m_; ++i)
      from[way[static_cast<std::size_t>(i)]] = at.tangent[i] * (i < n_ ? size_of(i) : 1) / length;
    const auto root =
        PreciseRoots(with_way(rows, unknowns.symbols, way, at.tangent), symbols).near(from, sizes, nearby);
    if (!root) return std::nullopt;
    Vector z = at.z;
    take(unknowns, *root, z);
    return rest_at(z);
  }
  ExprVector symbols_of_way() const {
    const std::vector<Coordinate>& all = e_.system->coordinates;
    ExprVector out;
    for (Index i = 0; i < n_; ++i) out.push_back(all[static_cast<std::size_t>(i)].velocity);
    for (Index i = 0; i < m_; ++i) out.push_back(all[static_cast<std::size_t>(i)].acceleration);
    return out;
  }
  /// The rows, their change along w, and t·w − 1.
  ExprVector with_way(const ExprVector& rows, const ExprVector& unknowns, const ExprVector& way,
                      const Vector& tangent) const {
    Context& context = *e_.system->context;
    ExprVector out = rows;
    for (const Expr& row : rows) {
      Expr change = context.number(0);
      for (std::size_t j = 0; j < way.size(); ++j) change = change + differentiate(row, unknowns[j]) * way[j];
      out.push_back(change);
    }
    Expr along = context.number(-1);
    for (Index i = 0; i < n_; ++i)
      along = along + way[static_cast<std::size_t>(i)] * Rational::from_double(tangent[i] / size_of(i));
    out.push_back(along);
    return out;
  }

  /// Balance and positions where nothing moves, the other parameters as exact numbers.
  ExprVector resting_rows() const {
    ExprMap held = exact_parameters(e_);
    held.erase(e_.system->parameters[end_.parameter].symbol);
    for (const Coordinate& c : e_.system->coordinates)
      for (const Expr& rate : {c.velocity, c.acceleration}) held.emplace(rate, e_.system->context->number(0));
    ExprVector rows = e_.balance_rows;
    rows.insert(rows.end(), e_.kept_rows.begin(), e_.kept_rows.begin() + static_cast<std::ptrdiff_t>(e_.holonomic));
    return substitute(rows, held);
  }

  PointEquations::Impl& e_;
  const BranchStretch& end_;
  Index n_, m_, pins_, size_;
  std::map<Index, std::unique_ptr<PreciseRoots>> roots_;  // by what is held
};

}  // namespace

BranchWalk walk_along(PointEquations::Impl& equations, const BranchStretch& stretch) {
  const bool is_plain = equations.holonomic == equations.m && equations.relations.kernel.size() == 0;
  return is_plain ? RestCurve(equations, stretch).walk() : BranchWalk();
}

}  // namespace maupertuis
