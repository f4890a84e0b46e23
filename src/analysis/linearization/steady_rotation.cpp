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
/// q ∘ p / 2; of each pair of lengths one turns their plane. What is sought is one of their combinations, with
/// translations, as Marsden's relative equilibria (Lectures on Mechanics, 1992, ch. 4): q(t) = exp(Ξ t) q₀.
namespace maupertuis {
namespace {

constexpr int samples = 3, attempts = 40, turns_of_newton = 40;
constexpr double small = 1e-9, settled = 1e-13, rank_of_rates = 1e-9;

struct Generators {
  std::vector<Matrix> in_space, in_body;
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
      out.in_space.push_back(half_turn(n, q, axis, 1));
      out.in_body.push_back(half_turn(n, q, axis, -1));
    }
  }
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j) {
      const Coordinate &a = system.coordinates[i], &b = system.coordinates[j];
      if (taken[i] || taken[j] || a.kind == "angle" || b.kind == "angle" || !a.dimension.same_as(b.dimension)) continue;
      Matrix plane = Matrix::Zero(static_cast<Index>(n), static_cast<Index>(n));
      plane(static_cast<Index>(j), static_cast<Index>(i)) = 1;
      plane(static_cast<Index>(i), static_cast<Index>(j)) = -1;
      out.in_space.push_back(plane);
    }
  return out;
}

/// What each candidate leaves of the three conditions at one random point, rows by their sizes; no rows where one has
/// no value there.
Matrix defects(PointEquations::Impl& e, const std::vector<Matrix>& generators, std::uint64_t seed) {
  const OperatingPoint point = random_point(e, seed);
  const Vector q = to_eigen(point.q), v = to_eigen(point.v), a = to_eigen(point.a);
  std::vector<Vector> rows;
  for (auto* family : {&e.balance, &e.positions, &e.velocities}) {
    const RowsAtPoint at = e.at(*family, point);
    Matrix part(at.value.size(), static_cast<Index>(generators.size()));
    Vector size = at.by_q.cwiseAbs() * q.cwiseAbs() + at.by_v.cwiseAbs() * v.cwiseAbs() +
                  at.by_a.cwiseAbs() * a.cwiseAbs() + at.value.cwiseAbs();
    for (std::size_t k = 0; k < generators.size(); ++k) {
      const Matrix& g = generators[k];
      part.col(static_cast<Index>(k)) = at.by_q * Vector(g * q) + at.by_v * Vector(g * v) + at.by_a * Vector(g * a);
      if (family == &e.balance) part.col(static_cast<Index>(k)) += g.transpose() * at.value;
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
std::vector<Matrix> symmetries(PointEquations::Impl& e, const std::vector<Matrix>& generators) {
  if (generators.empty()) return {};
  Matrix all(0, static_cast<Index>(generators.size()));
  int good = 0;
  for (int attempt = 0; attempt < attempts && good < samples; ++attempt) {
    const Matrix more = defects(e, generators, 3301 + static_cast<std::uint64_t>(attempt));
    if (more.rows() == 0) continue;
    ++good;
    const Index before = all.rows();
    all.conservativeResize(before + more.rows(), Eigen::NoChange);
    all.bottomRows(more.rows()) = more;
  }
  if (good < samples) return {};
  const KernelFirst split = kernel_first(all, small);
  std::vector<Matrix> out;
  for (Index k = 0; k < split.kernel; ++k) {
    Matrix sum = Matrix::Zero(generators.front().rows(), generators.front().cols());
    for (std::size_t g = 0; g < generators.size(); ++g) sum += split.basis(static_cast<Index>(g), k) * generators[g];
    out.push_back(sum);
  }
  return out;
}

/// R(q, v, a, λ) = 0, φ = 0, ψ = 0 with v = Ξ q + d, a = Ξ v, in the unknowns (q, rates of rotations and translations,
/// λ).
class TurningState {
 public:
  TurningState(PointEquations::Impl& e, std::vector<Matrix> rotations, std::vector<Vector> translations)
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
    for (const Matrix& g : rotations_) out.col(k++) = g * q;
    for (const Vector& d : translations_) out.col(k++) = d;
    return out;
  }
  Matrix turning(const Vector& rates) const {
    Matrix out = Matrix::Zero(sizes_.size(), sizes_.size());
    for (std::size_t k = 0; k < rotations_.size(); ++k) out += rates[static_cast<Index>(k)] * rotations_[k];
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
    for (std::size_t k = 0; k < rotations_.size(); ++k) a_by_rates.col(static_cast<Index>(k)) += rotations_[k] * v;
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
    const Matrix xi = turning(z.rates);
    out.ways = ways(xi, z.q);
    return out;
  }

  /// Independent directions Ξ_k q of the rotations that commute with Ξ, the motion itself first.
  std::vector<Translation> ways(const Matrix& xi, const Vector& q) const {
    Matrix brackets(xi.size(), static_cast<Index>(rotations_.size()));
    for (std::size_t k = 0; k < rotations_.size(); ++k) {
      const Matrix bracket = product(xi, rotations_[k]) - product(rotations_[k], xi);
      brackets.col(static_cast<Index>(k)) = Eigen::Map<const Vector>(bracket.data(), bracket.size());
    }
    const KernelFirst split = kernel_first(brackets, small * xi.norm());
    Matrix moved(q.size(), split.kernel + 1);
    moved.col(0) = xi * q;
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
  std::vector<Matrix> rotations_;
  std::vector<Vector> translations_;
  Vector sizes_;
};

}  // namespace

std::optional<Equilibrium> steady_rotation_near(const PointEquations& equations, const MotionState& start) {
  PointEquations::Impl& e = equations.impl();
  const Generators generators = candidates(equations.system());
  std::vector<Matrix> all = generators.in_space;
  all.insert(all.end(), generators.in_body.begin(), generators.in_body.end());
  std::vector<Vector> translations;
  for (const Translation& t : equations.translations()) translations.push_back(to_eigen(t.direction));
  OperatingPoint from{
      start.t, start.q, start.v, std::vector<double>(e.n), std::vector<double>(e.m), equations.inputs_at(start.t)};
  // A body that turns about an axis of space is seen from itself; only where that is no symmetry, or not enough, about
  // axes of its own as well. Rotations alone first: of a particle that circles, a part of the velocity could as well be
  // a translation's.
  for (const std::vector<Matrix>* chosen :
       std::initializer_list<const std::vector<Matrix>*>{&generators.in_space, &all}) {
    const std::vector<Matrix> rotations = symmetries(e, *chosen);
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
