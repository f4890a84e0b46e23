#include "analysis/linearization/dense.hpp"
#include "analysis/linearization/point_equations.hpp"
#include "linear_algebra/products.hpp"

#include <maupertuis/quaternion_coordinates.hpp>

#include <algorithm>
#include <cmath>

/// Steady motions along rotations. A rotation q → exp(ε Ξ) q is a symmetry where
///
///     R_q Ξ q + R_v Ξ v + R_a Ξ a + Ξᵀ R = 0,   φ_q Ξ q = 0,   ψ_q Ξ q + ψ_v Ξ v = 0
///
/// at random points. Of each quaternion three turn about axes of space, p ∘ q / 2, and three about axes of the body,
/// q ∘ p / 2; of each pair of lengths one turns their plane. Where these are none, angles go along with what turns,
/// Ξ q + d with d along angles: a blade or a disk that rolls in a circle. What is sought is one of their combinations,
/// with translations, as Marsden's relative equilibria (Lectures on Mechanics, 1992, ch. 4): q(t) = exp(Ξ t) q₀.
namespace maupertuis {
namespace {

constexpr int samples = 3, attempts = 40, turns_of_newton = 40;
constexpr double small = 1e-9, settled = 1e-13, rank_of_rates = 1e-9;

/// q → Ξ q + d.
struct Generator {
  Matrix turning;
  Vector shift;

  explicit Generator(Matrix xi) : turning(std::move(xi)), shift(Vector::Zero(turning.rows())) {}
  Generator(Matrix xi, Vector d) : turning(std::move(xi)), shift(std::move(d)) {}
  Vector at(const Vector& q) const { return turning * q + shift; }
};

struct Generators {
  std::vector<Generator> in_space, in_body, of_angles;
};

/// p ∘ q / 2 for p = e_axis, and q ∘ p / 2 for side −1: (w, v) → (−p·v, w p + side p × v) / 2.
Matrix half_turn(std::size_t n, const std::array<std::size_t, 4>& q, std::size_t axis, double side) {
  Matrix out = Matrix::Zero(static_cast<Index>(n), static_cast<Index>(n));
  const auto entry = [&](std::size_t to, std::size_t from, double value) {
    out(static_cast<Index>(q[to]), static_cast<Index>(q[from])) = value / 2;
  };
  const std::size_t x = 1 + axis, y = 1 + (axis + 1) % 3, z = 1 + (axis + 2) % 3;
  entry(0, x, -1);
  entry(x, 0, 1);
  entry(z, y, side);
  entry(y, z, -side);
  return out;
}

Generators candidates(const MechanicalSystem& system) {
  const std::size_t n = system.coordinates.size();
  Generators out;
  std::vector<bool> taken(n, false);
  for (const std::array<std::size_t, 4>& q : quaternion_coordinates(system)) {
    for (const std::size_t i : q) taken[i] = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      out.in_space.emplace_back(half_turn(n, q, axis, 1));
      out.in_body.emplace_back(half_turn(n, q, axis, -1));
    }
  }
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j) {
      const Coordinate &a = system.coordinates[i], &b = system.coordinates[j];
      if (taken[i] || taken[j] || a.kind == "angle" || b.kind == "angle" || !a.dimension.same_as(b.dimension)) continue;
      Matrix plane = Matrix::Zero(static_cast<Index>(n), static_cast<Index>(n));
      plane(static_cast<Index>(j), static_cast<Index>(i)) = 1;
      plane(static_cast<Index>(i), static_cast<Index>(j)) = -1;
      out.in_space.emplace_back(plane);
    }
  for (std::size_t i = 0; i < n; ++i)
    if (!taken[i] && system.coordinates[i].dimension.same_as(Dimension{}))  // an angle, or a number that may be one
      out.of_angles.emplace_back(Matrix::Zero(static_cast<Index>(n), static_cast<Index>(n)),
                                 Vector::Unit(static_cast<Index>(n), static_cast<Index>(i)));
  return out;
}

/// Whether each row of the equations has to be the same in every turned place, or their span alone: constraints that
/// turn into each other, as the two of a disk that rolls, with their multipliers.
enum class Rows { Alone, OfOneSpan };

/// v that the constraints of velocities allow, next to that of the point.
void keep_velocities(PointEquations::Impl& e, OperatingPoint& point) {
  const RowsAtPoint at = e.at(e.velocities, point);
  if (at.value.size() == 0 || !at.value.allFinite() || !at.by_v.allFinite()) return;
  const Vector sizes = to_eigen(typical_sizes(*e.system, {}));
  const Matrix by = at.by_v * sizes.asDiagonal();
  point.v = to_list(to_eigen(point.v) - Vector(sizes.asDiagonal() * least_squares(by, at.value, rank_of_rates).x));
}

/// Combinations of rows of the balance, as works by typical sizes, in which no multiplier stands.
Matrix beside_constraints(const PointEquations::Impl& e, const Matrix& by_multipliers) {
  const Vector sizes = to_eigen(typical_sizes(*e.system, {}));
  Matrix works = sizes.asDiagonal() * by_multipliers;
  for (Index j = 0; j < works.cols(); ++j)
    if (const double size = works.col(j).norm(); size > 0) works.col(j) /= size;
  const KernelFirst split = kernel_first(works.transpose(), small);
  return sizes.asDiagonal() * split.basis.leftCols(split.kernel);
}

/// What each candidate leaves of the three conditions at one random point, rows by their sizes; no rows where one has
/// no value there.
Matrix defects(PointEquations::Impl& e, const std::vector<Generator>& generators, std::uint64_t seed, Rows rows_are) {
  OperatingPoint point = random_point(e, seed);
  if (rows_are == Rows::OfOneSpan) keep_velocities(e, point);
  const Vector q = to_eigen(point.q), v = to_eigen(point.v), a = to_eigen(point.a);
  std::vector<Vector> rows;
  for (auto* family : {&e.balance, &e.positions, &e.velocities}) {
    const RowsAtPoint at = e.at(*family, point);
    Matrix part(at.value.size(), static_cast<Index>(generators.size()));
    Vector size = at.by_q.cwiseAbs() * q.cwiseAbs() + at.by_v.cwiseAbs() * v.cwiseAbs() +
                  at.by_a.cwiseAbs() * a.cwiseAbs() + at.value.cwiseAbs();
    for (std::size_t k = 0; k < generators.size(); ++k) {
      const Matrix& g = generators[k].turning;
      part.col(static_cast<Index>(k)) =
          at.by_q * generators[k].at(q) + at.by_v * Vector(g * v) + at.by_a * Vector(g * a);
      if (family == &e.balance) part.col(static_cast<Index>(k)) += g.transpose() * at.value;
    }
    if (family == &e.balance && rows_are == Rows::OfOneSpan && e.m > 0) {
      const Matrix along = beside_constraints(e, at.by_multipliers);
      part = along.transpose() * part, size = along.cwiseAbs().transpose() * size;
    }
    if (!part.allFinite()) return Matrix(0, part.cols());
    for (Index i = 0; i < part.rows(); ++i)
      if (size[i] > 0) rows.push_back(part.row(i).transpose() / size[i]);
  }
  Matrix out(static_cast<Index>(rows.size()), static_cast<Index>(generators.size()));
  for (std::size_t i = 0; i < rows.size(); ++i) out.row(static_cast<Index>(i)) = rows[i].transpose();
  return out;
}

/// A basis of the combinations that are symmetries.
std::vector<Generator> symmetries(PointEquations::Impl& e, const std::vector<Generator>& generators, Rows rows_are) {
  if (generators.empty()) return {};
  Matrix all(0, static_cast<Index>(generators.size()));
  int good = 0;
  for (int attempt = 0; attempt < attempts && good < samples; ++attempt) {
    const Matrix more = defects(e, generators, 3301 + static_cast<std::uint64_t>(attempt), rows_are);
    if (more.rows() == 0) continue;
    ++good;
    const Index before = all.rows();
    all.conservativeResize(before + more.rows(), Eigen::NoChange);
    all.bottomRows(more.rows()) = more;
  }
  if (good < samples) return {};
  const KernelFirst split = kernel_first(all, small);
  std::vector<Generator> out;
  for (Index k = 0; k < split.kernel; ++k) {
    const Index n = generators.front().shift.size();
    Generator sum(Matrix::Zero(n, n));
    for (std::size_t g = 0; g < generators.size(); ++g) {
      sum.turning += split.basis(static_cast<Index>(g), k) * generators[g].turning;
      sum.shift += split.basis(static_cast<Index>(g), k) * generators[g].shift;
    }
    out.push_back(std::move(sum));
  }
  return out;
}

/// R(q, v, a, λ) = 0, φ = 0, ψ = 0 with v = Ξ q + d, a = Ξ v, in the unknowns (q, rates of rotations and translations,
/// λ).
class TurningState {
 public:
  TurningState(PointEquations::Impl& e, std::vector<Generator> rotations, std::vector<Vector> translations)
      : e_(e),
        rotations_(std::move(rotations)),
        translations_(std::move(translations)),
        sizes_(to_eigen(typical_sizes(*e.system, {}))) {}

  /// The rates whose motion has the velocity v at q; nothing where none does.
  std::optional<Vector> rates(const Vector& q, const Vector& v) const {
    const Matrix by = directions(q);
    if (by.cols() == 0) return std::nullopt;
    const Matrix scaled = sizes_.cwiseInverse().asDiagonal() * by;
    const Vector wanted = v.cwiseQuotient(sizes_);
    const Vector c = least_squares(scaled, wanted, rank_of_rates).x;
    constexpr double given = 1e-4;  // a value that was given is rounded by no more
    if (!((scaled * c - wanted).norm() <= given * wanted.norm())) return std::nullopt;
    return c;
  }

  std::optional<Equilibrium> solve(const OperatingPoint& from, Vector rates) const {
    Unknowns z{to_eigen(from.q), std::move(rates), Vector::Zero(static_cast<Index>(e_.m))};
    fit_multipliers(from, z);
    for (int turn = 0; turn < turns_of_newton; ++turn) {
      const double residual = left_over(from, z);
      if (residual < settled) return answer(from, z, residual);
      const System s = system_at(from, z);
      if (!s.f.allFinite() || !s.j.allFinite()) return std::nullopt;
      const Vector move = least_move(s);
      const Index n = z.q.size(), c = z.rates.size();
      z.q += move.head(n);
      z.rates += move.segment(n, c);
      z.multipliers += move.tail(z.multipliers.size());
    }
    return std::nullopt;
  }

 private:
  struct Unknowns {
    Vector q, rates, multipliers;
  };
  struct System {
    Vector f;
    Matrix j;
  };

  Matrix directions(const Vector& q) const {
    Matrix out(q.size(), static_cast<Index>(rotations_.size() + translations_.size()));
    Index k = 0;
    for (const Generator& g : rotations_) out.col(k++) = g.at(q);
    for (const Vector& d : translations_) out.col(k++) = d;
    return out;
  }
  Matrix turning(const Vector& rates) const {
    Matrix out = Matrix::Zero(sizes_.size(), sizes_.size());
    for (std::size_t k = 0; k < rotations_.size(); ++k) out += rates[static_cast<Index>(k)] * rotations_[k].turning;
    constexpr double rounding = 4e-16;  // what combinations of rotations leave where none of them turns
    const double largest = out.size() > 0 ? out.lpNorm<Eigen::Infinity>() : 0;
    for (Index i = 0; i < out.size(); ++i)
      if (std::abs(out.data()[i]) <= rounding * largest) out.data()[i] = 0;
    return out;
  }
  OperatingPoint point_of(const OperatingPoint& from, const Unknowns& z) const {
    OperatingPoint out = from;
    const Matrix xi = turning(z.rates);
    const Vector v = directions(z.q) * z.rates;
    out.q = to_list(z.q);
    out.v = to_list(v);
    out.a = to_list(xi * v);
    out.multipliers = to_list(z.multipliers);
    out.turning = to_real(xi);
    return out;
  }

  System system_at(const OperatingPoint& from, const Unknowns& z) const {
    const OperatingPoint point = point_of(from, z);
    const Matrix xi = turning(z.rates), by_rates = directions(z.q);
    const Vector v = to_eigen(point.v);
    Matrix a_by_rates = product(xi, by_rates);
    for (std::size_t k = 0; k < rotations_.size(); ++k)
      a_by_rates.col(static_cast<Index>(k)) += rotations_[k].turning * v;
    const Matrix a_by_q = product(xi, xi);
    System out;
    for (auto* family : {&e_.balance, &e_.positions, &e_.velocities}) {
      const RowsAtPoint at = e_.at(*family, point);
      const Index before = out.f.size(), rows = at.value.size();
      out.f.conservativeResize(before + rows);
      out.f.tail(rows) = at.value;
      out.j.conservativeResize(before + rows, z.q.size() + z.rates.size() + z.multipliers.size());
      out.j.bottomRows(rows) << at.by_q + product(at.by_v, xi) + product(at.by_a, a_by_q),
          product(at.by_v, by_rates) + product(at.by_a, a_by_rates), at.by_multipliers;
    }
    return out;
  }

  void fit_multipliers(const OperatingPoint& from, Unknowns& z) const {
    const RowsAtPoint balance = e_.at(e_.balance, point_of(from, z));
    if (e_.m == 0 || !balance.value.allFinite() || !balance.by_multipliers.allFinite()) return;
    const Vector fit = least_squares(balance.by_multipliers, -balance.value, rank_of_rates).x;
    if (fit.allFinite()) z.multipliers = fit;
  }

  /// The shortest Gauss-Newton step. Entries that are rounding of the others stay out: equilibration would make them
  /// like any other.
  static Vector least_move(System s) {
    constexpr double rounding = 1e-14;
    for (Index j = 0; j < s.j.cols(); ++j) {
      const double largest = s.j.col(j).lpNorm<Eigen::Infinity>();
      for (Index i = 0; i < s.j.rows(); ++i)
        if (std::abs(s.j(i, j)) <= rounding * largest) s.j(i, j) = 0;
    }
    const Equilibration by(s.j);
    const Vector right = -(by.rows.asDiagonal() * s.f);
    return by.columns.asDiagonal() * least_squares(by.of(s.j), right, rank_of_rates).x;
  }

  /// The largest row by what its parts are. Forces times typical sizes are works, and rounding of the largest work is
  /// none of the others.
  double left_over(const OperatingPoint& from, const Unknowns& z) const {
    const OperatingPoint point = point_of(from, z);
    const auto magnitude = [](const Matrix& by, const std::vector<double>& x) {
      return Vector(by.cwiseAbs() * to_eigen(x).cwiseAbs());
    };
    const double fastest = to_eigen(point.v).cwiseQuotient(sizes_).lpNorm<Eigen::Infinity>();
    double out = 0;
    for (auto* family : {&e_.balance, &e_.positions, &e_.velocities}) {
      const RowsAtPoint at = e_.at(*family, point);
      Vector value = at.value, size = magnitude(at.by_q, point.q) + magnitude(at.by_v, point.v) +
                                      magnitude(at.by_a, point.a) + magnitude(at.by_multipliers, point.multipliers);
      if (family == &e_.balance && size.size() > 0) {
        value = value.cwiseProduct(sizes_);
        size.setConstant(size.cwiseProduct(sizes_).maxCoeff());
      } else {  // rows that vanish beside what typical velocities would do
        size += fastest * (at.by_v.cwiseAbs() * sizes_);
      }
      for (Index i = 0; i < value.size(); ++i)
        if (value[i] != 0) out = std::max(out, size[i] > 0 ? std::abs(value[i]) / size[i] : HUGE_VAL);
    }
    return out;
  }

  Equilibrium answer(const OperatingPoint& from, const Unknowns& z, double residual) const {
    Equilibrium out{point_of(from, z), false, residual, 0, {}, false, {}};
    constexpr double rounding = 1e-15;  // beside the fastest, by typical sizes
    const double fastest = to_eigen(out.point.v).cwiseQuotient(sizes_).lpNorm<Eigen::Infinity>();
    for (std::size_t i = 0; i < out.point.v.size(); ++i)
      if (std::abs(out.point.v[i]) <= rounding * fastest * sizes_[static_cast<Index>(i)]) out.point.v[i] = 0;
    Generator motion(turning(z.rates));
    for (std::size_t k = 0; k < rotations_.size(); ++k)
      motion.shift += z.rates[static_cast<Index>(k)] * rotations_[k].shift;
    const bool with_angles = motion.shift.squaredNorm() > 0;
    for (std::size_t k = 0; with_angles && k < translations_.size(); ++k)
      motion.shift += z.rates[static_cast<Index>(rotations_.size() + k)] * translations_[k];
    out.ways = ways(motion, z.q);
    return out;
  }

  /// Independent directions Ξ_k q + d_k of the rotations that commute with the motion, that itself first.
  std::vector<Translation> ways(const Generator& motion, const Vector& q) const {
    const Matrix& xi = motion.turning;
    Matrix brackets(xi.size() + q.size(), static_cast<Index>(rotations_.size()));
    for (std::size_t k = 0; k < rotations_.size(); ++k) {
      const Generator& g = rotations_[k];
      const Matrix bracket = product(xi, g.turning) - product(g.turning, xi);
      brackets.col(static_cast<Index>(k)) << Eigen::Map<const Vector>(bracket.data(), bracket.size()),
          Vector(xi * g.shift - g.turning * motion.shift);
    }
    const KernelFirst split = kernel_first(brackets, small * xi.norm());
    Matrix moved(q.size(), split.kernel + 1);
    moved.col(0) = motion.at(q);
    moved.rightCols(split.kernel) = directions(q).leftCols(brackets.cols()) * split.basis.leftCols(split.kernel);
    std::vector<Translation> out;
    Matrix kept(q.size(), 0);  // by typical sizes
    for (Index k = 0; k < moved.cols(); ++k) {
      const Vector by = moved.col(k).cwiseQuotient(sizes_);
      const Vector rest = by - kept * least_squares(kept, by, rank_of_rates).x;
      if (!(rest.norm() > rank_of_rates * std::max(by.norm(), xi.norm() * rank_of_rates))) continue;
      kept.conservativeResize(Eigen::NoChange, kept.cols() + 1);
      kept.rightCols(1) = by;
      Index pivot = 0;
      by.cwiseAbs().maxCoeff(&pivot);
      out.push_back({to_list(moved.col(k)), static_cast<std::size_t>(pivot), true});
    }
    return out;
  }

  PointEquations::Impl& e_;
  std::vector<Generator> rotations_;
  std::vector<Vector> translations_;
  Vector sizes_;
};

}  // namespace

std::optional<Equilibrium> steady_rotation_near(const PointEquations& equations, const MotionState& start) {
  PointEquations::Impl& e = equations.impl();
  const Generators generators = candidates(equations.system());
  std::vector<Generator> all = generators.in_space, with_angles = generators.in_space;
  all.insert(all.end(), generators.in_body.begin(), generators.in_body.end());
  with_angles.insert(with_angles.end(), generators.of_angles.begin(), generators.of_angles.end());
  std::vector<Vector> translations;
  for (const Translation& t : equations.translations()) translations.push_back(to_eigen(t.direction));
  OperatingPoint from{
      start.t, start.q, start.v, std::vector<double>(e.n), std::vector<double>(e.m), equations.inputs_at(start.t)};
  // A body that turns about an axis of space is seen from itself; only where that is no symmetry, or not enough, about
  // axes of its own as well, and only then with angles. Rotations alone first: of a particle that circles, a part of
  // the velocity could as well be a translation's.
  for (const std::vector<Generator>* chosen :
       std::initializer_list<const std::vector<Generator>*>{&generators.in_space, &all, &with_angles}) {
    const std::vector<Generator> rotations =
        symmetries(e, *chosen, chosen == &with_angles ? Rows::OfOneSpan : Rows::Alone);
    for (const bool shifted : {false, true}) {
      if (rotations.empty() || (shifted && translations.empty())) continue;
      const TurningState state(e, rotations, shifted ? translations : std::vector<Vector>{});
      const std::optional<Vector> rates = state.rates(to_eigen(start.q), to_eigen(start.v));
      if (!rates) continue;
      if (auto motion = state.solve(from, *rates)) return motion;
    }
  }
  return std::nullopt;
}

}  // namespace maupertuis
