#include <maupertuis/constraint_manifold.hpp>

#include <eigen3/Eigen/Cholesky>
#include <eigen3/Eigen/QR>
#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using Index = Eigen::Index;

constexpr double rounding = 1e-16;   // below it there is nothing to gain
constexpr double reached = 1e-11;    // good enough where rounding does not let it come closer
constexpr int most_turns = 60;

std::vector<Expr> terms_of(Expr e) {
  if (!e.is(Kind::Sum)) return {e};
  std::vector<Expr> terms;
  for (std::size_t i = 0; i < e.size(); ++i)
    for (const Expr& inner : terms_of(e[i])) terms.push_back(inner);
  return terms;
}

/// Functions f_i with the terms that they are sums of: values and relative sizes at once.
struct Functions {
  std::vector<Expr> terms;            // of all functions, one after the other
  std::vector<std::size_t> first;     // [count + 1]

  void add(Expr e) {
    if (first.empty()) first.push_back(0);
    for (const Expr& term : terms_of(e)) terms.push_back(term);
    first.push_back(terms.size());
  }
  std::size_t count() const { return first.empty() ? 0 : first.size() - 1; }
};

struct Sizes {
  Vector value, scale;
  double relative(Index i) const { return value[i] == 0 ? 0.0 : std::abs(value[i]) / scale[i]; }
};

}  // namespace

struct ConstraintManifold::Impl {
  Impl(const EquationsOfMotion& equations, const std::vector<Expr>& further);

  Bindings bind(const MotionState& state) const;
  Sizes sizes(const Functions& functions, const MotionState& state) const;
  Sizes sizes(bool positions, const MotionState& state, const Matrix& rows) const;
  Matrix matrix(const std::vector<Expr>& entries, const MotionState& state) const;
  Matrix metric(const MotionState& state) const;
  bool move(MotionState& state, bool positions, const std::vector<bool>& fixed, const std::vector<bool>& active) const;

  std::size_t n, m;
  Bindings parameters;
  Expr time;
  std::vector<Expr> q, v;
  std::vector<bool> on_positions;     // [m]
  Functions values, rates;            // [m], [m + further]
  std::vector<Expr> a, mass;          // [(m + further) × n], [n × n]
};

ConstraintManifold::Impl::Impl(const EquationsOfMotion& equations, const std::vector<Expr>& further)
    : n(equations.system->coordinates.size()), m(equations.system->constraints.size()),
      parameters(parameter_bindings(*equations.system)), time(equations.system->context->time()) {
  const MechanicalSystem& system = *equations.system;
  for (const Coordinate& c : system.coordinates) q.push_back(c.q), v.push_back(c.velocity);
  const auto plain = [&](Expr e) { return in_terms_of_motion(system, expand_time_derivatives({&e, 1})).front(); };
  const auto add_row = [&](Expr f, const std::vector<Expr>& by) {
    for (const Expr& entry : gradient(f, by)) a.push_back(entry);
  };
  for (std::size_t i = 0; i < m; ++i) {
    on_positions.push_back(system.constraints[i].level == Constraint::Level::Position);
    values.add(plain(system.constraints[i].value));
    rates.add(plain(equations.constraint_rates[i]));
    add_row(plain(system.constraints[i].value), on_positions.back() ? q : v);
  }
  for (const Expr& f : further) {
    rates.add(plain(f));
    add_row(plain(f), v);
  }
  mass = in_terms_of_motion(system, mass_matrix(equations).entries);
}

Bindings ConstraintManifold::Impl::bind(const MotionState& state) const {
  Bindings out = parameters;
  out[time] = state.t;
  for (std::size_t i = 0; i < n; ++i) out[q[i]] = state.q[i], out[v[i]] = state.v[i];
  return out;
}

Sizes ConstraintManifold::Impl::sizes(const Functions& functions, const MotionState& state) const {
  const std::vector<double> terms = evaluate(functions.terms, bind(state));
  Sizes out{Vector::Zero(static_cast<Index>(functions.count())), Vector::Zero(static_cast<Index>(functions.count()))};
  for (std::size_t i = 0; i < functions.count(); ++i)
    for (std::size_t k = functions.first[i]; k < functions.first[i + 1]; ++k) {
      out.value[static_cast<Index>(i)] += terms[k];
      out.scale[static_cast<Index>(i)] += std::abs(terms[k]);
    }
  return out;
}

/// Terms hide in products of sums: what the unknowns themselves contribute counts as well.
Sizes ConstraintManifold::Impl::sizes(bool positions, const MotionState& state, const Matrix& rows) const {
  Sizes out = sizes(positions ? values : rates, state);
  const std::vector<double>& x = positions ? state.q : state.v;
  for (Index i = 0; i < out.scale.size(); ++i)
    for (std::size_t j = 0; j < n; ++j)
      if (const double size = std::abs(rows(i, static_cast<Index>(j)) * x[j]); std::isfinite(size)) out.scale[i] += size;
  return out;
}

Matrix ConstraintManifold::Impl::matrix(const std::vector<Expr>& entries, const MotionState& state) const {
  const std::vector<double> numbers = evaluate(entries, bind(state));
  using ByRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return Eigen::Map<const ByRows>(numbers.data(), static_cast<Index>(n == 0 ? 0 : numbers.size() / n), static_cast<Index>(n));
}

/// M, or where it is not positive definite the scaled Euclidean metric: its diagonal, 1 where that is not positive.
Matrix ConstraintManifold::Impl::metric(const MotionState& state) const {
  Matrix g = matrix(mass, state);
  const Eigen::LLT<Matrix> cholesky(g);
  const bool definite = cholesky.info() == Eigen::Success && g.allFinite() &&
                        cholesky.matrixLLT().diagonal().cwiseAbs().minCoeff() >
                            1e-7 * cholesky.matrixLLT().diagonal().cwiseAbs().maxCoeff();
  if (definite) return g;
  Matrix diagonal = Matrix::Identity(g.rows(), g.cols());
  for (Index i = 0; i < g.rows(); ++i)
    if (std::isfinite(g(i, i)) && g(i, i) > 0) diagonal(i, i) = g(i, i);
  return diagonal;
}

namespace {

/// The smallest δ in the metric g with a δ = −error, in the least squares sense where there is none; over the free columns.
Vector least_step(const Matrix& a, const Vector& error, const Matrix& g, const std::vector<Index>& free) {
  const Index count = static_cast<Index>(free.size());
  Matrix columns(a.rows(), count), metric(count, count);
  for (Index j = 0; j < count; ++j) {
    columns.col(j) = a.col(free[static_cast<std::size_t>(j)]);
    for (Index i = 0; i < count; ++i) metric(i, j) = g(free[static_cast<std::size_t>(i)], free[static_cast<std::size_t>(j)]);
  }
  const Eigen::LLT<Matrix> cholesky(metric);
  const Matrix scaled = cholesky.matrixL().solve(columns.transpose()).transpose();  // A L⁻ᵀ
  Eigen::CompleteOrthogonalDecomposition<Matrix> solver(scaled);
  solver.setThreshold(1e-11);
  const Vector y = solver.solve(-error);
  const Vector part = cholesky.matrixU().solve(y);
  Vector out = Vector::Zero(a.cols());
  for (Index j = 0; j < count; ++j) out[free[static_cast<std::size_t>(j)]] = part[j];
  return out;
}

/// The rows that count, each divided by its length, so that units do not decide which one weighs more.
struct Rows {
  Matrix a;
  Vector error, weight;
};

Vector chosen_values(const Sizes& f, const std::vector<std::size_t>& chosen) {
  Vector out(static_cast<Index>(chosen.size()));
  for (std::size_t k = 0; k < chosen.size(); ++k) out[static_cast<Index>(k)] = f.value[static_cast<Index>(chosen[k])];
  return out;
}

double largest_relative(const Sizes& f, const std::vector<std::size_t>& chosen) {
  double largest = 0;
  for (const std::size_t i : chosen) {
    const auto k = static_cast<Index>(i);
    largest = std::max(largest, std::isfinite(f.value[k]) ? f.relative(k) : HUGE_VAL);
  }
  return largest;
}

/// What is left of f_i is below the rounding of the unknowns x together, in the metric: their sizes may hide from f_i, as a
/// spin of 200 rad/s about one axis does from the rate 0 about another.
bool below_rounding(const Sizes& f, const std::vector<std::size_t>& chosen, const Matrix& a, const Matrix& metric, const std::vector<double>& x) {
  const Vector lengths = metric.diagonal().cwiseAbs().cwiseSqrt();
  const double size = lengths.cwiseProduct(Eigen::Map<const Vector>(x.data(), lengths.size())).norm();
  for (const std::size_t i : chosen) {
    const auto k = static_cast<Index>(i);
    const double row = a.row(k).transpose().cwiseQuotient(lengths).norm();
    if (!(std::abs(f.value[k]) <= std::max(reached * f.scale[k], rounding * row * size))) return false;
  }
  return true;
}

Rows weighted(const Matrix& a, const Sizes& f, const std::vector<std::size_t>& chosen) {
  const auto count = static_cast<Index>(chosen.size());
  Rows out{Matrix(count, a.cols()), chosen_values(f, chosen), Vector::Ones(count)};
  for (Index k = 0; k < count; ++k) {
    const auto row = a.row(static_cast<Index>(chosen[static_cast<std::size_t>(k)]));
    if (const double norm = row.norm(); norm > 0) out.weight[k] = 1 / norm;
    out.a.row(k) = out.weight[k] * row;
    out.error[k] *= out.weight[k];
  }
  return out;
}

}  // namespace

bool ConstraintManifold::Impl::move(MotionState& state, bool positions, const std::vector<bool>& fixed,
                                    const std::vector<bool>& active) const {
  const Functions& functions = positions ? values : rates;
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < functions.count(); ++i)
    if ((i >= m || active.empty() || active[i]) && (!positions || on_positions[i])) chosen.push_back(i);
  std::vector<Index> free;
  for (std::size_t i = 0; i < n; ++i)
    if (!fixed[i]) free.push_back(static_cast<Index>(i));

  std::vector<double>& x = positions ? state.q : state.v;
  Matrix all = matrix(a, state);
  Sizes f = sizes(positions, state, all);
  double error = largest_relative(f, chosen);
  for (int turn = 0; turn < most_turns && error > rounding && !free.empty(); ++turn) {
    if (!all.allFinite() || !f.value.allFinite()) return false;
    const Rows rows = weighted(all, f, chosen);
    const Vector step = least_step(rows.a, rows.error, metric(state), free);
    const std::vector<double> before = x;
    bool closer = false;
    for (double damping = 1; !closer && damping > 1e-9; damping /= 2) {
      for (std::size_t i = 0; i < n; ++i) x[i] = before[i] + damping * step[static_cast<Index>(i)];
      f = sizes(functions, state);
      closer = chosen_values(f, chosen).cwiseProduct(rows.weight).norm() < rows.error.norm();
    }
    if (!closer) {
      x = before;
      break;
    }
    all = matrix(a, state);
    f = sizes(positions, state, all);
    error = largest_relative(f, chosen);
  }
  return error <= reached || below_rounding(f, chosen, all, metric(state), x);
}

ConstraintManifold::ConstraintManifold(const EquationsOfMotion& equations, std::vector<Expr> rates)
    : impl_(std::make_unique<Impl>(equations, rates)) {}
ConstraintManifold::~ConstraintManifold() = default;
ConstraintManifold::ConstraintManifold(ConstraintManifold&&) noexcept = default;

namespace {

std::vector<double> by_rows(const Matrix& m, std::size_t rows) {
  std::vector<double> out;
  for (Index i = 0; i < static_cast<Index>(rows); ++i)
    for (Index j = 0; j < m.cols(); ++j) out.push_back(m(i, j));
  return out;
}

std::vector<double> list(const Vector& x, std::size_t count) { return {x.data(), x.data() + count}; }

std::vector<double> relative(const Sizes& f) {
  std::vector<double> out;
  for (Index i = 0; i < f.value.size(); ++i) out.push_back(f.relative(i));
  return out;
}

}  // namespace

std::size_t ConstraintManifold::constraints() const { return impl_->m; }
std::vector<double> ConstraintManifold::matrix(const MotionState& state) const {
  return by_rows(impl_->matrix(impl_->a, state), impl_->m);
}
std::vector<double> ConstraintManifold::mass(const MotionState& state) const {
  return by_rows(impl_->matrix(impl_->mass, state), impl_->n);
}
std::vector<double> ConstraintManifold::values(const MotionState& state) const {
  return list(impl_->sizes(impl_->values, state).value, impl_->m);
}
std::vector<double> ConstraintManifold::rates(const MotionState& state) const {
  return list(impl_->sizes(impl_->rates, state).value, impl_->m);
}
std::vector<double> ConstraintManifold::relative_values(const MotionState& state) const {
  std::vector<double> out = relative(impl_->sizes(true, state, impl_->matrix(impl_->a, state)));
  for (std::size_t i = 0; i < out.size(); ++i)
    if (!impl_->on_positions[i]) out[i] = 0;
  return out;
}
std::vector<double> ConstraintManifold::relative_rates(const MotionState& state) const {
  return relative(impl_->sizes(false, state, impl_->matrix(impl_->a, state)));
}
bool ConstraintManifold::move_positions(MotionState& state, const std::vector<bool>& fixed, const std::vector<bool>& active) const {
  return impl_->move(state, true, fixed, active);
}
bool ConstraintManifold::move_velocities(MotionState& state, const std::vector<bool>& fixed, const std::vector<bool>& active) const {
  return impl_->move(state, false, fixed, active);
}

std::vector<std::size_t> ConstraintManifold::smallest_clash(const MotionState& from) const {
  const std::vector<bool> nothing(impl_->n, false);
  std::vector<bool> active(impl_->m, true);
  const auto possible = [&](bool velocities) {
    MotionState trial = from;
    return move_positions(trial, nothing, active) && (!velocities || move_velocities(trial, nothing, active));
  };
  const bool velocities_clash = possible(false);
  for (std::size_t i = 0; i < active.size(); ++i) {
    active[i] = false;
    if (possible(velocities_clash)) active[i] = true;
  }
  std::vector<std::size_t> clash;
  for (std::size_t i = 0; i < active.size(); ++i)
    if (active[i]) clash.push_back(i);
  return clash;
}

}  // namespace maupertuis
