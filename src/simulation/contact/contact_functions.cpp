#include "simulation/contact/contact_functions.hpp"

#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/contact_mode.hpp>
#include <maupertuis/system_expressions.hpp>
#include <maupertuis/transform.hpp>

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

using Eigen::Index;

ExprVector gaps_of(const MechanicalSystem& s) {
  ExprVector out;
  for (const Contact& c : s.contacts) out.push_back(c.gap);
  return out;
}

ExprVector slips_of(const MechanicalSystem& s) {
  ExprVector out;
  for (std::size_t i = 0; i < s.contacts.size() + s.frictions.size(); ++i) {
    const Friction& f = friction_of(s, i);
    out.push_back(f.present() ? f.slip[0] : s.context->number(0));
  }
  for (const Contact& c : s.contacts) out.push_back(c.friction.in_space() ? c.friction.slip[1] : s.context->number(0));
  return out;
}

/// [Σ|terms of g|, ∂g/∂t, e] of each contact, then [μ, μ_s] of each friction.
ExprVector rates_of(const MechanicalSystem& s) {
  ExprVector out;
  for (const Contact& c : s.contacts) {
    out.push_back(size_of_nested_terms(c.gap));
    out.push_back(differentiate(c.gap, s.context->time()));
    out.push_back(c.restitution);
  }
  for (std::size_t i = 0; i < s.contacts.size() + s.frictions.size(); ++i) {
    const Friction& f = friction_of(s, i);
    out.push_back(f.present() ? f.kinetic : s.context->number(0));
    out.push_back(f.present() ? f.static_ : s.context->number(0));
  }
  return out;
}

/// d²g/dt² and dv_t/dt without their terms in q̈.
ExprVector drifts_of(const MechanicalSystem& s) {
  ExprVector out;
  for (const Contact& c : s.contacts) out.push_back(total_time_derivative(total_time_derivative(c.gap)));
  for (Expr slip : slips_of(s)) out.push_back(total_time_derivative(slip));
  ExprMap no_accelerations;
  for (const Coordinate& c : s.coordinates) no_accelerations[c.acceleration] = s.context->number(0);
  return substitute(out, no_accelerations);
}

/// M by rows, then A by rows.
ExprVector matrices_of(const EquationsOfMotion& equations) {
  ExprVector out = mass_matrix(equations).entries;
  const ExprMatrix a = constraint_matrix(equations);
  out.insert(out.end(), a.entries.begin(), a.entries.end());
  return out;
}

/// Derivatives of the functions from `begin` on, one a row; what rows hold already makes room for them.
void set_rows(const DifferentiableKernel& kernel, const std::vector<double>& out, std::size_t first, std::size_t begin,
              std::size_t count, std::vector<SparseRow>& rows) {
  rows.resize(count);
  for (SparseRow& row : rows) row.clear();
  for (std::size_t k = 0; k < kernel.entries.size(); ++k)
    if (const std::size_t row = kernel.entries[k].row; row >= begin && row < begin + count)
      rows[row - begin].emplace_back(kernel.entries[k].column - first, out[kernel.size() + k]);
}

}  // namespace

Expr size_of_nested_terms(Expr e) {
  if (!e.is(Kind::Sum) && !e.is(Kind::Product)) return apply(Kind::Abs, e);
  ExprVector sizes;
  for (std::size_t i = 0; i < e.size(); ++i) sizes.push_back(size_of_nested_terms(e[i]));
  return e.is(Kind::Sum) ? e.context().sum(sizes) : e.context().product(sizes);
}

FunctionSource function_of_motion(const MechanicalSystem& system, const ExprVector& outputs) {
  FunctionSource source;
  for (const Coordinate& c : system.coordinates) source.inputs.push_back(c.q);
  for (const Coordinate& c : system.coordinates) source.inputs.push_back(c.velocity);
  source.inputs.push_back(system.context->time());
  for (const Parameter& p : system.parameters) source.parameters.push_back(p.symbol);
  source.outputs = expand_time_derivatives(in_terms_of_motion(system, outputs));
  return source;
}

bool is_of_positions(Expr function) {
  const ExprVector symbols = symbols_of({&function, 1});
  return std::none_of(symbols.begin(), symbols.end(), [](const Expr& s) {
    return s.role() == Role::Multiplier || (s.role() == Role::Coordinate && s.order() > 0);
  });
}

std::optional<std::vector<StateRead>> state_read_by(Expr function, const MechanicalSystem& system) {
  std::vector<StateRead> reads;
  for (const Expr& s : symbols_of({&function, 1})) {
    if (s.role() == Role::Multiplier) return std::nullopt;
    if (s.role() != Role::Coordinate) continue;
    const auto has = [&](const Coordinate& c) { return c.q == s || c.velocity == s; };
    const auto c = std::find_if(system.coordinates.begin(), system.coordinates.end(), has);
    if (c == system.coordinates.end()) return std::nullopt;  // an acceleration
    reads.push_back({static_cast<std::size_t>(c - system.coordinates.begin()), s.order()});
  }
  return reads;
}

bool is_of_parameters(Expr value) {
  const ExprVector symbols = symbols_of({&value, 1});
  return std::all_of(symbols.begin(), symbols.end(),
                     [](const Expr& s) { return s.role() == Role::Parameter || s.role() == Role::Constant; });
}

double dot(const SparseRow& row, const Eigen::VectorXd& x) {
  double sum = 0;
  for (const auto& [i, value] : row) sum += value * x(static_cast<Index>(i));
  return sum;
}

ContactPrograms::ContactPrograms(const EquationsOfMotion& equations)
    : coordinates(equations.system->coordinates.size()),
      constraints(equations.system->constraints.size()),
      contacts(equations.system->contacts.size()),
      frictions(contacts + equations.system->frictions.size()),
      gaps(build_differentiable(function_of_motion(*equations.system, gaps_of(*equations.system)), 0, coordinates)),
      slips(build_differentiable(function_of_motion(*equations.system, slips_of(*equations.system)), coordinates,
                                 2 * coordinates)),
      rates(build_function(function_of_motion(*equations.system, rates_of(*equations.system)))),
      matrices(build_function(function_of_motion(*equations.system, matrices_of(equations)))),
      system_(equations.system) {}

/// In a context of its own: another thread may read the given one.
const FunctionKernel& ContactPrograms::drifts() const {
  const std::lock_guard lock(guard_);
  if (!drifts_) {
    const MechanicalSystem own = in_own_context(*system_, {});
    drifts_ = build_function(function_of_motion(own, drifts_of(own)));
  }
  return *drifts_;
}

ContactFunctions::ContactFunctions(std::shared_ptr<const ContactPrograms> programs, std::span<const double> parameters)
    : programs_(std::move(programs)),
      parameters_(parameters.begin(), parameters.end()),
      n_(programs_->coordinates),
      m_(programs_->constraints),
      contacts_(programs_->contacts),
      frictions_(programs_->frictions),
      gaps_work_(programs_->gaps.values_and_entries),
      slips_work_(programs_->slips.values_and_entries),
      rates_work_(programs_->rates),
      matrices_work_(programs_->matrices),
      gaps_out_(programs_->gaps.values_and_entries.outputs()),
      slips_out_(programs_->slips.values_and_entries.outputs()),
      rates_out_(programs_->rates.outputs()),
      matrices_out_(programs_->matrices.outputs()) {
  for (FunctionWorkspace* work : {&gaps_work_, &slips_work_, &rates_work_, &matrices_work_})
    work->set_parameters(parameters);
}

void ContactFunctions::evaluate(FunctionWorkspace& work, std::vector<double>& out, double t, std::span<const double> q,
                                std::span<const double> v) {
  point_.assign(q.begin(), q.end());
  point_.insert(point_.end(), v.begin(), v.end());
  point_.push_back(t);
  work.evaluate(point_, out);
}

const ContactValues& ContactFunctions::at(double t, std::span<const double> q, std::span<const double> v) {
  if (t == t_ && std::equal(q.begin(), q.end(), q_.begin(), q_.end()) &&
      std::equal(v.begin(), v.end(), v_.begin(), v_.end()))
    return values_;
  const bool is_same_place = t == t_ && std::equal(q.begin(), q.end(), q_.begin(), q_.end());
  t_ = t;
  q_.assign(q.begin(), q.end());
  v_.assign(v.begin(), v.end());
  if (!is_same_place) evaluate(gaps_work_, gaps_out_, t, q, v);  // no velocities stand in gaps
  evaluate(slips_work_, slips_out_, t, q, v);
  evaluate(rates_work_, rates_out_, t, q, v);
  ContactValues& out = values_;
  out.t = t;
  out.gap.assign(gaps_out_.begin(), gaps_out_.begin() + static_cast<std::ptrdiff_t>(contacts_));
  out.slip.assign(slips_out_.begin(), slips_out_.begin() + static_cast<std::ptrdiff_t>(frictions_));
  set_rows(programs_->gaps, gaps_out_, 0, 0, contacts_, out.normal);
  set_rows(programs_->slips, slips_out_, n_, 0, frictions_, out.tangent);
  set_rows(programs_->slips, slips_out_, n_, frictions_, contacts_, out.second_tangent);
  const auto second = static_cast<std::ptrdiff_t>(frictions_);
  out.second_slip.assign(slips_out_.begin() + second,
                         slips_out_.begin() + second + static_cast<std::ptrdiff_t>(contacts_));
  for (auto* list : {&out.gap_scale, &out.rate, &out.drive, &out.rate_scale, &out.restitution}) list->clear();
  for (auto* list : {&out.slip_scale, &out.kinetic, &out.fixed}) list->clear();
  for (std::size_t c = 0; c < contacts_; ++c) {
    const double drive = rates_out_[3 * c + 1];
    double rate = drive, scale = std::abs(drive);
    for (const auto& [i, g] : out.normal[c]) rate += g * v[i], scale += std::abs(g * v[i]);
    out.gap_scale.push_back(rates_out_[3 * c]);
    out.drive.push_back(drive);
    out.restitution.push_back(rates_out_[3 * c + 2]);
    out.rate.push_back(rate);
    out.rate_scale.push_back(scale);
  }
  for (std::size_t i = 0; i < frictions_; ++i) {
    double rest = out.slip[i], scale = 0;
    for (const auto& [k, t_k] : out.tangent[i]) rest -= t_k * v[k], scale += std::abs(t_k * v[k]);
    scale += std::abs(rest);
    if (i < contacts_ && !out.second_tangent[i].empty()) {
      double second_rest = out.second_slip[i];
      for (const auto& [k, t_k] : out.second_tangent[i]) second_rest -= t_k * v[k], scale += std::abs(t_k * v[k]);
      scale += std::abs(second_rest);
    }
    out.slip_scale.push_back(scale);
    out.kinetic.push_back(rates_out_[3 * contacts_ + 2 * i]);
    out.fixed.push_back(rates_out_[3 * contacts_ + 2 * i + 1]);
  }
  return out;
}

namespace {

/// Which unknowns hang together by entries that are not zero: a number for each.
std::vector<std::size_t> parts_of(const Eigen::MatrixXd& matrix) {
  std::vector<std::size_t> part(static_cast<std::size_t>(matrix.rows()));
  for (std::size_t i = 0; i < part.size(); ++i) part[i] = i;
  const auto root = [&](std::size_t i) {
    while (part[i] != i) i = part[i] = part[part[i]];
    return i;
  };
  for (std::size_t j = 0; j < part.size(); ++j)
    for (std::size_t i = 0; i < part.size(); ++i)
      if (i != j && matrix(at(i), at(j)) != 0) part[root(i)] = root(j);
  for (std::size_t i = 0; i < part.size(); ++i) part[i] = root(i);
  return part;
}

/// Units in which the diagonal of M is about 1, and then each row of A: atoms are no rounding beside the directions in
/// which they are held. Powers of 2: nothing is rounded.
Eigen::VectorXd scales_by_mass(const Eigen::MatrixXd& bordered) {
  const auto unit_of = [](double size) { return size > 0 ? std::ldexp(1.0, -std::ilogb(size)) : 0.0; };
  Eigen::VectorXd out(bordered.rows());
  for (Index i = 0; i < out.size(); ++i) {
    const double mass = std::abs(bordered(i, i));
    out(i) = mass > 0 ? std::ldexp(1.0, -std::ilogb(mass) / 2) : 0.0;
  }
  for (int turn = 0; turn < 2; ++turn) {  // rows of A, then coordinates without inertia by these
    const Eigen::VectorXd known = out;
    for (Index i = 0; i < out.size(); ++i)
      if (known(i) == 0) out(i) = unit_of(bordered.row(i).transpose().cwiseAbs().cwiseProduct(known).maxCoeff());
  }
  return out.unaryExpr([](double x) { return x > 0 ? x : 1.0; });
}

/// matrix x = right, each part of the system that the right sides touch by itself: many bodies hang together in few.
Eigen::MatrixXd solve_by_parts(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(right.rows(), right.cols());
  const std::vector<std::size_t> part = parts_of(matrix);
  for (std::size_t number = 0; number < part.size(); ++number) {
    std::vector<Index> in;
    bool touched = false;
    for (std::size_t i = 0; i < part.size(); ++i)
      if (part[i] == number) in.push_back(at(i)), touched = touched || (right.row(at(i)).array() != 0).any();
    if (!touched) continue;
    if (in.size() == 1) {
      const double alone = matrix(in[0], in[0]);
      if (alone != 0) out.row(in[0]) = right.row(in[0]) / alone;
      continue;
    }
    const Eigen::MatrixXd given = matrix(in, in);
    const Eigen::VectorXd scale = scales_by_mass(given);
    const Eigen::FullPivLU<Eigen::MatrixXd> lu(scale.asDiagonal() * given * scale.asDiagonal());
    out(in, Eigen::all) = scale.asDiagonal() * lu.solve(Eigen::MatrixXd(scale.asDiagonal() * right(in, Eigen::all)));
  }
  return out;
}

}  // namespace

Eigen::MatrixXd ContactFunctions::response(double t, std::span<const double> q, std::span<const double> v,
                                           std::span<const SparseRow> rows, std::span<const SparseRow> held) {
  if (std::all_of(rows.begin(), rows.end(), [](const SparseRow& row) { return row.empty(); }))
    return Eigen::MatrixXd::Zero(static_cast<Index>(n_), static_cast<Index>(rows.size()));
  evaluate(matrices_work_, matrices_out_, t, q, v);
  const auto n = static_cast<Index>(n_), own = static_cast<Index>(m_), m = own + static_cast<Index>(held.size());
  Eigen::MatrixXd bordered = Eigen::MatrixXd::Zero(n + m, n + m);
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j) bordered(i, j) = matrices_out_[static_cast<std::size_t>(i * n + j)];
  for (Index k = 0; k < own; ++k)
    for (Index j = 0; j < n; ++j)
      bordered(n + k, j) = bordered(j, n + k) = matrices_out_[static_cast<std::size_t>((n + k) * n + j)];
  for (Index k = 0; k < m - own; ++k)
    for (const auto& [j, value] : held[static_cast<std::size_t>(k)])
      bordered(n + own + k, static_cast<Index>(j)) = bordered(static_cast<Index>(j), n + own + k) = value;
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(n + m, static_cast<Index>(rows.size()));
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (const auto& [i, value] : rows[r]) right(static_cast<Index>(i), static_cast<Index>(r)) = value;
  return solve_by_parts(bordered, right).topRows(n);
}

std::vector<SparseRow> ContactFunctions::constraint_rows(double t, std::span<const double> q,
                                                         std::span<const double> v) {
  if (m_ == 0) return {};
  evaluate(matrices_work_, matrices_out_, t, q, v);
  std::vector<SparseRow> out(m_);
  for (std::size_t k = 0; k < m_; ++k)
    for (std::size_t j = 0; j < n_; ++j)
      if (const double x = matrices_out_[(n_ + k) * n_ + j]; x != 0) out[k].emplace_back(j, x);
  return out;
}

Eigen::VectorXd ContactFunctions::multipliers(double t, std::span<const double> q, std::span<const double> v,
                                              const Eigen::VectorXd& change, const Eigen::VectorXd& force,
                                              std::span<const SparseRow> held) {
  if (m_ + held.size() == 0) return {};
  std::vector<SparseRow> rows = constraint_rows(t, q, v);
  rows.insert(rows.end(), held.begin(), held.end());
  evaluate(matrices_work_, matrices_out_, t, q, v);
  const auto n = static_cast<Index>(n_);
  Eigen::MatrixXd levers = Eigen::MatrixXd::Zero(n, static_cast<Index>(rows.size()));
  for (std::size_t k = 0; k < rows.size(); ++k)
    for (const auto& [j, x] : rows[k]) levers(static_cast<Index>(j), static_cast<Index>(k)) = x;
  const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> mass(
      matrices_out_.data(), n, n);
  return Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(levers).solve(Eigen::VectorXd(mass * change - force));
}

std::span<const double> ContactFunctions::drifts(double t, std::span<const double> q, std::span<const double> v) {
  if (!drifts_work_) {
    drifts_work_.emplace(programs_->drifts());
    drifts_work_->set_parameters(parameters_);
    drifts_out_.resize(programs_->drifts().outputs());
  }
  evaluate(*drifts_work_, drifts_out_, t, q, v);
  return drifts_out_;
}

double product(const SparseRow& row, std::span<const double> x) {
  double sum = 0;
  for (const auto& [k, value] : row) sum += value * x[k];
  return sum;
}

std::vector<double> whole_row(const SparseRow& row, std::size_t n) {
  std::vector<double> out(n, 0);
  for (const auto& [k, x] : row) out[k] = x;
  return out;
}

SparseRow sum_of(const SparseRow& a, const SparseRow& b, double factor) {
  SparseRow out = a;
  for (const auto& [k, x] : b) {
    const auto same = std::find_if(out.begin(), out.end(), [&, k = k](const auto& e) { return e.first == k; });
    if (same == out.end())
      out.emplace_back(k, factor * x);
    else
      same->second += factor * x;
  }
  return out;
}

double slip_speed(std::size_t contact, const ContactValues& values) {
  return contact < values.second_slip.size() ? std::hypot(values.slip[contact], values.second_slip[contact])
                                             : std::abs(values.slip[contact]);
}

}  // namespace maupertuis
