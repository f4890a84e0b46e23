#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/jacobian.hpp>
#include <maupertuis/repeated_evaluation.hpp>
#include <maupertuis/require.hpp>

#include "equations/sparse_step.hpp"
#include "linear_algebra/dense.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using Index = Eigen::Index;

constexpr double settled = 1e-16;  // below it there is nothing to gain
constexpr double reached = 1e-11;  // good enough where rounding does not let it come closer
constexpr int most_turns = 60;
constexpr int turns_to_halve = 5;  // the error, of a large system

std::vector<Expr> terms_of(Expr e) {
  if (!e.is(Kind::Sum)) return {e};
  std::vector<Expr> terms;
  for (std::size_t i = 0; i < e.size(); ++i)
    for (const Expr& inner : terms_of(e[i])) terms.push_back(inner);
  return terms;
}

/// Functions f_i with the terms that they are sums of: values and relative sizes at once.
struct Functions {
  std::vector<Expr> terms;         // of all functions, one after the other
  std::vector<std::size_t> first;  // [count + 1]

  void add(Expr e) {
    if (first.empty()) first.push_back(0);
    for (const Expr& term : terms_of(e)) terms.push_back(term);
    first.push_back(terms.size());
  }
  std::size_t count() const { return first.empty() ? 0 : first.size() - 1; }
  std::optional<RepeatedEvaluation> evaluation;  // of the terms, once all are there
};

/// A matrix by the entries that are not 0 as formulas.
struct Entries {
  std::vector<std::size_t> rows, columns;
  std::vector<Expr> values;

  void add(std::size_t row, std::size_t column, Expr value) {
    rows.push_back(row), columns.push_back(column), values.push_back(value);
  }
  std::optional<RepeatedEvaluation> evaluation;  // of the values, once all are there
};

/// Beyond this number of entries the matrices of a step are kept sparse.
constexpr std::size_t largest_dense_rates = 64 * 128;
/// Of M, that a metric is worth.
constexpr std::size_t most_of_metric = 200000;

struct Sizes {
  Vector value, scale;
  double relative(Index i) const { return value[i] == 0 ? 0.0 : std::abs(value[i]) / scale[i]; }
};

}  // namespace

struct ConstraintManifold::Impl {
  Impl(const EquationsOfMotion& equations, const std::vector<Expr>& further);

  std::vector<double> evaluate_at(const MotionState& state, const RepeatedEvaluation& evaluation) const;
  Sizes sizes(const Functions& functions, const MotionState& state) const;
  Sizes sizes(bool positions, const MotionState& state, const std::vector<MatrixEntry>& rows) const;
  std::vector<MatrixEntry> numbers(const Entries& entries, const MotionState& state) const;
  std::vector<MatrixEntry> mass_numbers(const MotionState& state) const;
  Matrix dense(const std::vector<MatrixEntry>& entries, std::size_t rows) const;
  Matrix metric(const MotionState& state) const;
  Vector least_step(const std::vector<MatrixEntry>& a, const Sizes& f, const std::vector<std::size_t>& chosen,
                    const MotionState& state, const std::vector<Index>& free, Vector& weight) const;
  bool is_sparse() const { return (rates.count() + m) * n > largest_dense_rates; }
  bool move(MotionState& state, bool positions, const std::vector<bool>& fixed, const std::vector<bool>& active) const;

  std::size_t n, m;
  MotionTerms in_terms;
  Bindings parameters;
  Expr time;
  std::unordered_map<Expr, std::size_t, ExprHash> places;  // of q, and n later of q̇
  std::vector<Expr> momenta;                               // [n]
  std::vector<Expr> q, v;
  std::vector<bool> on_positions;  // [m]
  Functions values, rates;         // [m], [m + further]
  Entries a, mass;                 // [(m + further) × n], [n × n]
  bool has_metric = true;          // false: M has too many entries, and `mass` its diagonal alone
};

ConstraintManifold::Impl::Impl(const EquationsOfMotion& equations, const std::vector<Expr>& further)
    : n(equations.system->coordinates.size()),
      m(equations.system->constraints.size()),
      in_terms(*equations.system),
      parameters(parameter_bindings(*equations.system)),
      time(equations.system->context->time()),
      momenta(equations.momenta) {
  const MechanicalSystem& system = *equations.system;
  for (const Coordinate& c : system.coordinates) q.push_back(c.q), v.push_back(c.velocity);
  const SparseGradient by_q(q), by_v(v);
  const auto plain = [&](Expr e) { return in_terms(expand_time_derivatives({&e, 1})).front(); };
  std::size_t row = 0;
  const auto add_row = [&](Expr f, const SparseGradient& gradient) {
    for (const auto& [column, value] : gradient(f)) a.add(row, column, value);
    ++row;
  };
  for (std::size_t i = 0; i < m; ++i) {
    on_positions.push_back(system.constraints[i].level == Constraint::Level::Position);
    values.add(plain(system.constraints[i].value));
    rates.add(plain(equations.constraint_rates[i]));
    add_row(plain(system.constraints[i].value), on_positions.back() ? by_q : by_v);
  }
  for (const Expr& f : further) {
    rates.add(plain(f));
    add_row(plain(f), by_v);
  }
  const auto entries = sparse_jacobian(equations.momenta, v, is_sparse() ? most_of_metric : n * n);
  has_metric = entries.has_value();
  if (entries)
    for (const DerivativeEntry& e : *entries) mass.add(e.row, e.column, e.value);
  else
    for (std::size_t i = 0; i < n; ++i) mass.add(i, i, differentiate(equations.momenta[i], v[i]));
  mass.values = in_terms(mass.values);
  for (std::size_t i = 0; i < n; ++i) places.emplace(q[i], i), places.emplace(v[i], n + i);
  for (Functions* f : {&values, &rates}) f->evaluation.emplace(f->terms);
  for (Entries* e : {&a, &mass}) e->evaluation.emplace(e->values);
}

std::vector<double> ConstraintManifold::Impl::evaluate_at(const MotionState& state,
                                                          const RepeatedEvaluation& evaluation) const {
  return evaluation([&](Expr symbol) {
    if (symbol == time) return state.t;
    if (const auto place = places.find(symbol); place != places.end())
      return place->second < n ? state.q[place->second] : state.v[place->second - n];
    const auto parameter = parameters.find(symbol);
    MAUP_REQUIRE(parameter != parameters.end() && "every symbol must be bound");
    return parameter->second;
  });
}

Sizes ConstraintManifold::Impl::sizes(const Functions& functions, const MotionState& state) const {
  const std::vector<double> terms = evaluate_at(state, *functions.evaluation);
  Sizes out{Vector::Zero(static_cast<Index>(functions.count())), Vector::Zero(static_cast<Index>(functions.count()))};
  for (std::size_t i = 0; i < functions.count(); ++i)
    for (std::size_t k = functions.first[i]; k < functions.first[i + 1]; ++k) {
      out.value[static_cast<Index>(i)] += terms[k];
      out.scale[static_cast<Index>(i)] += std::abs(terms[k]);
    }
  return out;
}

/// Terms hide in products of sums: what the unknowns themselves contribute counts as well.
Sizes ConstraintManifold::Impl::sizes(bool positions, const MotionState& state,
                                      const std::vector<MatrixEntry>& rows) const {
  Sizes out = sizes(positions ? values : rates, state);
  const std::vector<double>& x = positions ? state.q : state.v;
  for (const MatrixEntry& e : rows)
    if (const double size = std::abs(e.value * x[e.column]);
        std::isfinite(size) && static_cast<Index>(e.row) < out.scale.size())
      out.scale[static_cast<Index>(e.row)] += size;
  return out;
}

std::vector<MatrixEntry> ConstraintManifold::Impl::numbers(const Entries& entries, const MotionState& state) const {
  const std::vector<double> values_here = evaluate_at(state, *entries.evaluation);
  std::vector<MatrixEntry> out;
  out.reserve(values_here.size());
  for (std::size_t k = 0; k < values_here.size(); ++k)
    out.push_back({entries.rows[k], entries.columns[k], values_here[k]});
  return out;
}

Matrix ConstraintManifold::Impl::dense(const std::vector<MatrixEntry>& entries, std::size_t rows) const {
  Matrix out = Matrix::Zero(static_cast<Index>(rows), static_cast<Index>(n));
  for (const MatrixEntry& e : entries) out(static_cast<Index>(e.row), static_cast<Index>(e.column)) = e.value;
  return out;
}

/// M, or where it is not positive definite the scaled Euclidean metric: its diagonal, 1 where that is not positive.
Matrix ConstraintManifold::Impl::metric(const MotionState& state) const {
  Matrix g = dense(numbers(mass, state), n);
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

/// The smallest δ in the metric g with a δ = −error, in the least squares sense where there is none; over the free
/// columns.
Vector least_step(const Matrix& a, const Vector& error, const Matrix& g, const std::vector<Index>& free) {
  const Index count = static_cast<Index>(free.size());
  Matrix columns(a.rows(), count), metric(count, count);
  for (Index j = 0; j < count; ++j) {
    columns.col(j) = a.col(free[static_cast<std::size_t>(j)]);
    for (Index i = 0; i < count; ++i)
      metric(i, j) = g(free[static_cast<std::size_t>(i)], free[static_cast<std::size_t>(j)]);
  }
  const Eigen::LLT<Matrix> cholesky(metric);
  const Matrix scaled = cholesky.matrixL().solve(columns.transpose()).transpose();  // A L⁻ᵀ
  Eigen::CompleteOrthogonalDecomposition<Matrix> solver(scaled);
  solver.setThreshold(1e-11);
  const Vector y = solver.solve(Vector(-error));
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

/// What is left of f_i is below the rounding of the unknowns x together, in the metric: their sizes may hide from f_i,
/// as a spin of 200 rad/s about one axis does from the rate 0 about another.
bool below_rounding(const Sizes& f, const std::vector<std::size_t>& chosen, const std::vector<MatrixEntry>& a,
                    const Vector& metric_diagonal, const std::vector<double>& x) {
  const Vector lengths = metric_diagonal.cwiseAbs().cwiseSqrt();
  const double size = lengths.cwiseProduct(Eigen::Map<const Vector>(x.data(), lengths.size())).norm();
  Vector rows = Vector::Zero(f.value.size());
  for (const MatrixEntry& e : a)
    if (static_cast<Index>(e.row) < rows.size())
      rows[static_cast<Index>(e.row)] += std::pow(e.value / lengths[static_cast<Index>(e.column)], 2);
  for (const std::size_t i : chosen) {
    const auto k = static_cast<Index>(i);
    if (!(std::abs(f.value[k]) <= std::max(reached * f.scale[k], settled * std::sqrt(rows[k]) * size))) return false;
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

bool all_finite(const std::vector<MatrixEntry>& entries) {
  return std::all_of(entries.begin(), entries.end(), [](const MatrixEntry& e) { return std::isfinite(e.value); });
}

}  // namespace

std::vector<MatrixEntry> ConstraintManifold::Impl::mass_numbers(const MotionState& state) const {
  if (has_metric) return numbers(mass, state);
  return {};
}

/// `weight`: by what each chosen row is multiplied so that its length is 1.
Vector ConstraintManifold::Impl::least_step(const std::vector<MatrixEntry>& all, const Sizes& f,
                                            const std::vector<std::size_t>& chosen, const MotionState& state,
                                            const std::vector<Index>& free, Vector& weight) const {
  if (!is_sparse()) {
    const Rows rows = weighted(dense(all, rates.count()), f, chosen);
    weight = rows.weight;
    return maupertuis::least_step(rows.a, rows.error, metric(state), free);
  }
  SparseStep step(n, free);
  weight = step.set_rows(all, chosen);
  step.set_metric(mass_numbers(state));
  return step.solve(chosen_values(f, chosen).cwiseProduct(weight));
}

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
  std::vector<MatrixEntry> all = numbers(a, state);
  Sizes f = sizes(positions, state, all);
  double error = largest_relative(f, chosen);
  double checkpoint = HUGE_VAL;
  for (int turn = 0; turn < most_turns && error > settled && !free.empty(); ++turn) {
    if (!all_finite(all) || !f.value.allFinite()) return false;
    Vector weight;
    const Vector step = least_step(all, f, chosen, state, free, weight);
    const double error_before = chosen_values(f, chosen).cwiseProduct(weight).norm();
    const std::vector<double> before = x;
    bool closer = false;
    // With thousands of rows a turn costs: what creeps, or is met to rounding, is not gone on with.
    if (is_sparse() && turn % turns_to_halve == 0) {
      if (error_before > checkpoint / 2) break;
      checkpoint = error_before;
    }
    const double smallest_damping = !is_sparse() ? 1e-9 : error <= reached ? 0.2 : 1e-3;
    for (double damping = 1; !closer && damping > smallest_damping; damping /= 2) {
      for (std::size_t i = 0; i < n; ++i) x[i] = before[i] + damping * step[static_cast<Index>(i)];
      f = sizes(functions, state);
      closer = chosen_values(f, chosen).cwiseProduct(weight).norm() < error_before;
    }
    if (!closer) {
      x = before;
      break;
    }
    all = numbers(a, state);
    f = sizes(positions, state, all);
    error = largest_relative(f, chosen);
  }
  if (error <= reached) return true;
  const Vector diagonal = is_sparse() ? positive_diagonal(mass_numbers(state), n) : Vector(metric(state).diagonal());
  return below_rounding(f, chosen, all, diagonal, x);
}

ConstraintManifold::ConstraintManifold(const EquationsOfMotion& equations, std::vector<Expr> rates)
    : impl_(std::make_unique<Impl>(equations, rates)) {}
ConstraintManifold::~ConstraintManifold() = default;
ConstraintManifold::ConstraintManifold(ConstraintManifold&&) noexcept = default;

namespace {

std::vector<double> by_rows(const std::vector<MatrixEntry>& entries, std::size_t rows, std::size_t columns) {
  std::vector<double> out(rows * columns, 0);
  for (const MatrixEntry& e : entries)
    if (e.row < rows) out[e.row * columns + e.column] = e.value;
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
  return by_rows(impl_->numbers(impl_->a, state), impl_->m, impl_->n);
}
std::vector<double> ConstraintManifold::mass(const MotionState& state) const {
  if (impl_->has_metric) return by_rows(impl_->numbers(impl_->mass, state), impl_->n, impl_->n);
  Entries all;
  for (const DerivativeEntry& e : jacobian(impl_->momenta, impl_->v)) all.add(e.row, e.column, e.value);
  all.values = impl_->in_terms(all.values);
  all.evaluation.emplace(all.values);
  return by_rows(impl_->numbers(all, state), impl_->n, impl_->n);
}
std::vector<MatrixEntry> ConstraintManifold::matrix_entries(const MotionState& state) const {
  std::vector<MatrixEntry> out = impl_->numbers(impl_->a, state);
  std::erase_if(out, [&](const MatrixEntry& e) { return e.row >= impl_->m; });
  return out;
}
std::vector<double> ConstraintManifold::mass_diagonal(const MotionState& state) const {
  std::vector<double> out(impl_->n, 0);
  for (const MatrixEntry& e : impl_->numbers(impl_->mass, state))
    if (e.row == e.column) out[e.row] = e.value;
  return out;
}
std::vector<double> ConstraintManifold::values(const MotionState& state) const {
  return list(impl_->sizes(impl_->values, state).value, impl_->m);
}
std::vector<double> ConstraintManifold::rates(const MotionState& state) const {
  return list(impl_->sizes(impl_->rates, state).value, impl_->m);
}
std::vector<double> ConstraintManifold::relative_values(const MotionState& state) const {
  std::vector<double> out = relative(impl_->sizes(true, state, impl_->numbers(impl_->a, state)));
  for (std::size_t i = 0; i < out.size(); ++i)
    if (!impl_->on_positions[i]) out[i] = 0;
  return out;
}
std::vector<double> ConstraintManifold::relative_rates(const MotionState& state) const {
  return relative(impl_->sizes(false, state, impl_->numbers(impl_->a, state)));
}
bool ConstraintManifold::move_positions(MotionState& state, const std::vector<bool>& fixed,
                                        const std::vector<bool>& active) const {
  return impl_->move(state, true, fixed, active);
}
bool ConstraintManifold::move_velocities(MotionState& state, const std::vector<bool>& fixed,
                                         const std::vector<bool>& active) const {
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
