#include "analysis/linearization/dense.hpp"
#include "analysis/linearization/measured.hpp"
#include "analysis/linearization/modes_in_digits.hpp"
#include "analysis/linearization/turning_frame.hpp"
#include "linear_algebra/products.hpp"

#include <maupertuis/arguments.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

/// The equations to first order, in three steps: which coordinates and which velocities are independent; ξ and ξ̇ of all
/// from theirs; ξ̈ and δλ from the bordered system. Everything is linear and holds at any point of a motion:
///
///     φ_q ξ = 0,   r_v ξ̇ + r_q ξ = 0,   [M  −Aᵀ] [ξ̈ ]   [−R_v ξ̇ − R_q ξ + B w]
///                                       [A   0 ] [δλ] = [−α_v ξ̇ − α_q ξ      ]
///
/// with r = (dφ/dt, ψ), α = A q̈ − b, and B w short for B w + B₁ ẇ + B₂ ẅ =
/// −∂R/∂(u, u', u'') (w, ẇ, ẅ): three columns an input. About a motion that turns all rows are seen in the frame that
/// turns along (turning_frame.hpp); its Ξ is a symmetry, so that they are the same at all times up to exp(−Ξᵀ t) in
/// front.
namespace maupertuis {
namespace {

constexpr double rank_threshold = 1e-10;

/// Dependent ones first found by the largest pivots, columns scaled; the rest is independent.
struct Split {
  std::vector<std::size_t> dependent, independent;
};

Split split_columns(const Matrix& rows, const Vector& sizes) {
  Matrix scaled = rows * sizes.asDiagonal();
  for (Index i = 0; i < scaled.rows(); ++i)
    if (const double norm = scaled.row(i).norm(); norm > 0) scaled.row(i) /= norm;
  Split out;
  std::vector<bool> taken(static_cast<std::size_t>(rows.cols()), false);
  for (const std::size_t i : pivot_columns(scaled, rank_threshold)) taken[i] = true;
  for (std::size_t i = 0; i < taken.size(); ++i) (taken[i] ? out.dependent : out.independent).push_back(i);
  return out;
}

Matrix columns_of(const Matrix& m, const std::vector<std::size_t>& chosen) {
  Matrix out(m.rows(), static_cast<Index>(chosen.size()));
  for (std::size_t j = 0; j < chosen.size(); ++j) out.col(static_cast<Index>(j)) = m.col(static_cast<Index>(chosen[j]));
  return out;
}

Matrix rows_of(const Matrix& m, const std::vector<std::size_t>& chosen) {
  return columns_of(m.transpose(), chosen).transpose();
}

/// x with rows x = right, where the independent x are the unit vectors (for right's own columns: zero).
Matrix spread(const Matrix& rows, const Split& split, const Matrix& right) {
  Matrix out = Matrix::Zero(rows.cols(), right.cols());
  if (split.dependent.empty()) return out;
  const Matrix part = least_squares(columns_of(rows, split.dependent), right, rank_threshold).x;
  for (std::size_t k = 0; k < split.dependent.size(); ++k)
    out.row(static_cast<Index>(split.dependent[k])) = part.row(static_cast<Index>(k));
  return out;
}

Matrix null_basis(const Matrix& rows, const Split& split) {
  Matrix out = spread(rows, split, -columns_of(rows, split.independent));
  for (std::size_t k = 0; k < split.independent.size(); ++k)
    out(static_cast<Index>(split.independent[k]), static_cast<Index>(k)) = 1;
  return out;
}

/// The bordered system of [ξ̈; δλ] for several right sides; redundant constraints leave δλ at its least.
struct BorderedSolution {
  Matrix x;  // [(n + m) × …]
  bool singular = false;
  std::size_t culprit = 0;
};

Matrix bordered(const Matrix& mass, const Matrix& by_multipliers, const Matrix& a) {
  const Index n = mass.rows(), m = a.rows();
  Matrix all = Matrix::Zero(n + m, n + m);
  all.topLeftCorner(n, n) = mass;
  all.topRightCorner(n, m) = by_multipliers;
  all.bottomLeftCorner(m, n) = a;
  return all;
}

BorderedSolution solve_bordered(const Matrix& mass, const Matrix& by_multipliers, const Matrix& a,
                                const Matrix& right) {
  const Index n = mass.rows();
  const Matrix all = bordered(mass, by_multipliers, a);
  BorderedSolution out;
  mass.cwiseAbs().rowwise().sum().minCoeff(&out.culprit);
  out.singular = !all.allFinite() || !right.allFinite();
  if (out.singular) return out;
  const Equilibration by(all);
  const LeastSquares solved = least_squares(by.of(all), by.rows.asDiagonal() * right, 1e-13);
  // The kernel may hold multipliers of redundant constraints, and nothing else.
  const Equilibration rows(a);
  const auto independent = static_cast<Index>(pivot_columns(rows.of(a), rank_threshold).size());
  out.singular = solved.rank < n + independent;
  out.x = by.columns.asDiagonal() * solved.x;
  return out;
}

/// A part that rounding alone has left is none.
Matrix cleaned(Matrix part, const Matrix& whole) {
  constexpr double rounding = 1e-14;
  if (part.size() > 0 && part.lpNorm<Eigen::Infinity>() <= rounding * whole.lpNorm<Eigen::Infinity>()) part.setZero();
  return part;
}
Matrix clean_symmetric_part(const Matrix& m) { return cleaned(symmetric_part(m), m); }
Matrix skew_part(const Matrix& m) { return cleaned((m - m.transpose()) / 2, m); }

/// Whether rounding of the coordinates alone makes another matrix of it: at θ = π the number sin²θ is 1.5e-32, and
/// stands for 0. Solutions for the change tell it, whatever the sizes of rows and columns are.
bool is_made_by_rounding(PointEquations::Impl& e, const OperatingPoint& point, const Matrix& turning,
                         const Matrix& matrix) {
  constexpr double few_roundings = 8 * 2.220446049250313e-16, part = 1e-3;
  const Equilibration by(matrix);
  for (const double side : {few_roundings, -few_roundings}) {
    OperatingPoint beside = point;
    for (std::size_t i = 0; i < e.n; ++i) beside.q[i] *= 1 + (i % 2 == 0 ? side : -side);
    const RowsAtPoint balance = in_frame(e.at(e.balance, beside), turning);
    const RowsAtPoint accelerations = in_frame(e.at(e.accelerations, beside), turning);
    const Matrix change = bordered(balance.by_a, balance.by_multipliers, accelerations.by_a) - matrix;
    if (!change.allFinite()) continue;
    const Matrix relative = least_squares(by.of(matrix), by.of(change), 1e-13).x;
    if (relative.size() > 0 && relative.lpNorm<Eigen::Infinity>() > part) return true;
  }
  return false;
}

/// All pieces at one point.
struct Pieces {
  RowsAtPoint balance, positions, rates, accelerations;
  std::optional<SizesInFrame> cancelling;  // of the balance, in a turning frame
  Matrix velocity_rows() const { return rates.by_v; }
};

/// Nᵀ M N and so on. Only where the independent directions do not turn along the motion: at rest and in steady motions.
void second_order_form(Linearization& out, const Pieces& p, const Matrix& directions, const Vector& typical) {
  const auto project = [&](const Matrix& m) { return quadratic_form(directions, m); };
  const Matrix mass = project(p.balance.by_a);
  Matrix velocity = project(p.balance.by_v), position = project(p.balance.by_q);
  if (p.cancelling) {
    const Matrix by = directions.cwiseAbs();
    const Vector of_independent = rows_of(typical, out.independent);
    clear_rounding(velocity, quadratic_form(by, p.cancelling->by_v), of_independent);
    clear_rounding(position, quadratic_form(by, p.cancelling->by_q), of_independent);
  }
  out.mass = to_real(clean_symmetric_part(mass));
  out.damping = to_real(clean_symmetric_part(velocity));
  out.gyroscopic = to_real(skew_part(velocity));
  out.stiffness = to_real(clean_symmetric_part(position));
  out.circulatory = to_real(skew_part(position));
  const Matrix input = -directions.transpose() * p.balance.by_inputs;
  std::tie(out.input, out.input_rate, out.input_acceleration) = thirds(input);
}

bool vanishes(const Matrix& part, const Matrix& beside) {
  return part.size() == 0 ||
         part.lpNorm<Eigen::Infinity>() <= 1e-12 * (beside.size() == 0 ? 0 : beside.lpNorm<Eigen::Infinity>());
}

/// ∂ρ of the relations that motions keep, by the states; what cancels up to rounding is none.
Matrix relations_by_states(const RowsAtPoint& relations, const Matrix& states) {
  constexpr double rounding = 1e-12;
  Matrix by(relations.value.size(), states.rows());
  by << relations.by_q, relations.by_v;
  Matrix out = product(by, states);
  const Matrix sizes = product(by.cwiseAbs(), states.cwiseAbs());
  for (Index i = 0; i < out.rows(); ++i)
    for (Index j = 0; j < out.cols(); ++j)
      if (std::abs(out(i, j)) <= rounding * sizes(i, j)) out(i, j) = 0;
  return out;
}

/// No motion leaves ∂ρ x = 0: the states that are independent there, and the others by them.
void keep_to(const Matrix& relations, const Vector& sizes, Linearization& out) {
  const Split split = split_columns(relations, sizes);
  if (split.dependent.empty()) return;
  const Matrix all = null_basis(relations, split);
  std::vector<std::size_t> positions, velocities;
  const std::size_t f = out.independent.size();
  for (const std::size_t i : split.independent)
    if (i < f)
      positions.push_back(out.independent[i]);
    else
      velocities.push_back(out.independent_velocities[i - f]);
  const auto at_positions = static_cast<Index>(f), left = static_cast<Index>(positions.size());
  out.positions = to_real(product(to_eigen(out.positions), Matrix(all.topLeftCorner(at_positions, left))));
  out.a = to_real(product(rows_of(to_eigen(out.a), split.independent), all));
  out.b = to_real(rows_of(to_eigen(out.b), split.independent));
  out.c = to_real(product(to_eigen(out.c), all));
  out.measured.c = to_real(product(to_eigen(out.measured.c), all));
  out.independent = std::move(positions), out.independent_velocities = std::move(velocities);
}

}  // namespace

namespace {

/// −(what the rows of forces and of accelerations of constraints change by) of ξ, ξ̇ and inputs [n + m × f + g + k]: the
/// right sides of accelerations and multipliers.
Matrix moved_sides(const Pieces& p, const Matrix& xi, const Matrix& rate_w, const Matrix& rate_q) {
  const Index n = xi.rows(), m = p.accelerations.by_q.rows(), f = xi.cols(), g = rate_w.cols(),
              k = p.balance.by_inputs.cols();
  Matrix out = Matrix::Zero(n + m, f + g + k);
  out.topLeftCorner(n, f) = negated_product(p.balance.by_q, xi) - product(p.balance.by_v, rate_q);
  out.block(0, f, n, g) = negated_product(p.balance.by_v, rate_w);
  out.topRightCorner(n, k) = -p.balance.by_inputs;
  out.bottomLeftCorner(m, f) = negated_product(p.accelerations.by_q, xi) - product(p.accelerations.by_v, rate_q);
  out.block(n, f, m, g) = negated_product(p.accelerations.by_v, rate_w);
  return out;
}

void check_operating_point(const OperatingPoint& point, std::size_t n, std::size_t m, std::size_t k) {
  check_argument(point.q.size() == n && point.v.size() == n && point.a.size() == n,
                 "linearize: q, v or a of the point has another length than the system has coordinates");
  check_argument(point.multipliers.size() == m,
                 "linearize: `multipliers` of the point has another length than the system has constraints");
  check_argument(point.inputs.size() == k,
                 "linearize: `inputs` of the point has another length than the system has inputs");
  check_argument(point.input_rates.empty() || point.input_rates.size() == 2 * k,
                 "linearize: `input_rates` of the point holds neither nothing nor two rates an input");
  check_argument(point.turning.rows == point.turning.columns && (point.turning.rows == 0 || point.turning.rows == n),
                 "linearize: `turning` of the point is neither empty nor n by n");
}

}  // namespace

LinearizationResult linearize(const PointEquations& equations, const OperatingPoint& point) {
  PointEquations::Impl& e = equations.impl();
  check_operating_point(point, e.n, e.m, e.k);
  const Matrix turning = to_eigen(point.turning);
  const auto rows_at = [&](PointEquations::Impl::Rows& rows) { return in_frame(e.at(rows, point), turning); };
  RowsAtPoint balance = e.at(e.balance, point);
  restore_entries(equations, point, balance);
  Pieces p{in_frame(balance, turning), rows_at(e.positions), rows_at(e.rates), rows_at(e.accelerations), {}};
  if (turning.size() > 0) p.cancelling = sizes_in_frame(balance, turning);
  LinearizationResult result;
  Linearization& out = result.linearization;
  out.point = point;
  const Vector sizes = to_eigen(typical_sizes(*e.system, {}));
  const Split at_positions = split_columns(p.positions.by_q, sizes);
  const Split at_velocities = split_columns(p.rates.by_v, sizes);
  out.independent = at_positions.independent;
  out.independent_velocities = at_velocities.independent;

  const Matrix xi = null_basis(p.positions.by_q, at_positions);   // ξ by positions [n × f]
  const Matrix rate_w = null_basis(p.rates.by_v, at_velocities);  // ξ̇ by velocities [n × g]
  const Matrix rate_q =
      spread(p.rates.by_v, at_velocities, negated_product(p.rates.by_q, xi));  // ξ̇ by positions [n × f]
  const auto n = static_cast<Index>(e.n), k = static_cast<Index>(3 * e.k);
  const Index f = xi.cols(), g = rate_w.cols();

  const Matrix right = moved_sides(p, xi, rate_w, rate_q);
  const BorderedSolution solved = solve_bordered(p.balance.by_a, p.balance.by_multipliers, p.accelerations.by_a, right);
  if (solved.singular ||
      is_made_by_rounding(e, point, turning,
                          bordered(p.balance.by_a, p.balance.by_multipliers, p.accelerations.by_a))) {
    result.singular = true;
    result.singular_coordinate = solved.culprit;
    return result;
  }
  const Matrix acceleration = solved.x.topRows(n);

  Matrix a = Matrix::Zero(f + g, f + g), b = Matrix::Zero(f + g, k), c = Matrix::Zero(2 * n, f + g);
  a.topLeftCorner(f, f) = rows_of(rate_q, out.independent);
  a.topRightCorner(f, g) = rows_of(rate_w, out.independent);
  a.bottomRows(g) = rows_of(acceleration.leftCols(f + g), out.independent_velocities);
  b.bottomRows(g) = rows_of(acceleration.rightCols(k), out.independent_velocities);
  c.topLeftCorner(n, f) = xi;
  c.bottomLeftCorner(n, f) = rate_q;
  c.bottomRightCorner(n, g) = rate_w;
  if (turning.size() > 0) clear_rounding_of_states(a, out, sizes);
  out.positions = to_real(xi);
  out.a = to_real(a);
  std::tie(out.b, out.b_rate, out.b_acceleration) = thirds(b);
  out.c = to_real(c);
  out.d = to_real(Matrix::Zero(2 * n, static_cast<Index>(e.k)));
  Matrix motion = Matrix::Zero(2 * n, f + g + k);
  motion.leftCols(f + g) = c;
  Matrix answer = solved.x;
  out_of_frame(turning, motion, answer);
  out.measured = measured_outputs(e, point, {motion, answer, f + g});

  const bool uniform =
      turning.size() > 0 || std::all_of(point.a.begin(), point.a.end(), [](double x) { return x == 0; });
  if (uniform && e.relations.kernel.size() > 0) {
    Vector of_states(f + g);
    of_states << rows_of(sizes, out.independent), rows_of(sizes, out.independent_velocities);
    keep_to(relations_by_states(rows_at(e.relations), c), of_states, out);
  }
  const bool whole = to_eigen(out.a).rows() == f + g;
  if (whole && (e.m == 0 || (e.holonomic == e.m && uniform && vanishes(rate_q, rate_w))))
    second_order_form(out, p, xi, sizes);
  return result;
}

std::optional<OperatingPoint> operating_point(const PointEquations& equations, const MotionState& state) {
  PointEquations::Impl& e = equations.impl();
  check_argument(state.q.size() == e.n && state.v.size() == e.n,
                 "operating_point: q or v of the state has another length than the system has coordinates");
  OperatingPoint point{
      state.t, state.q, state.v, std::vector<double>(e.n), std::vector<double>(e.m), equations.inputs_at(state.t)};
  const std::vector<double> inputs = e.inputs_and_rates_at(state.t);
  point.input_rates.assign(inputs.begin() + static_cast<std::ptrdiff_t>(e.k), inputs.end());
  const RowsAtPoint balance = e.at(e.balance, point), rows = e.at(e.accelerations, point);
  Matrix right(static_cast<Index>(e.n + e.m), 1);
  right.topRows(static_cast<Index>(e.n)) = -balance.value;
  right.bottomRows(static_cast<Index>(e.m)) = -rows.value;
  const BorderedSolution bordered = solve_bordered(balance.by_a, balance.by_multipliers, rows.by_a, right);
  if (bordered.singular || !bordered.x.allFinite()) return std::nullopt;
  for (std::size_t i = 0; i < e.n; ++i) point.a[i] = bordered.x(static_cast<Index>(i), 0);
  for (std::size_t i = 0; i < e.m; ++i) point.multipliers[i] = bordered.x(static_cast<Index>(e.n + i), 0);
  return point;
}

}  // namespace maupertuis
