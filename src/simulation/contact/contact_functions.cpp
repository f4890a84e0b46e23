#include "simulation/contact/contact_functions.hpp"

#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/contact_mode.hpp>
#include <maupertuis/transform.hpp>

#include <cmath>

namespace maupertuis {
namespace {

using Eigen::Index;

/// Σ |terms|
Expr size_of_terms(Expr e) {
  ExprVector sizes;
  if (e.is(Kind::Sum))
    for (std::size_t i = 0; i < e.size(); ++i) sizes.push_back(apply(Kind::Abs, e[i]));
  else
    sizes.push_back(apply(Kind::Abs, e));
  return e.context().sum(sizes);
}

class Lowering {
 public:
  explicit Lowering(const MechanicalSystem& system) : system_(system) {
    for (const Coordinate& c : system.coordinates) inputs_.push_back(c.q);
    for (const Coordinate& c : system.coordinates) inputs_.push_back(c.velocity);
    inputs_.push_back(system.context->time());
    for (const Parameter& p : system.parameters) parameters_.push_back(p.symbol);
  }
  FunctionSource source(const ExprVector& outputs) const {
    return {inputs_, parameters_, expand_time_derivatives(in_terms_of_motion(system_, outputs))};
  }

 private:
  const MechanicalSystem& system_;
  ExprVector inputs_, parameters_;
};

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
  return out;
}

/// [Σ|terms of g|, ∂g/∂t, e] of each contact, then [μ, μ_s] of each friction.
ExprVector rates_of(const MechanicalSystem& s) {
  ExprVector out;
  for (const Contact& c : s.contacts) {
    out.push_back(size_of_terms(c.gap));
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

/// M by rows, then A by rows.
ExprVector matrices_of(const EquationsOfMotion& equations) {
  ExprVector out = mass_matrix(equations).entries;
  const ExprMatrix a = constraint_matrix(equations);
  out.insert(out.end(), a.entries.begin(), a.entries.end());
  return out;
}

std::vector<SparseRow> rows_of(const DifferentiableKernel& kernel, const std::vector<double>& out, std::size_t first) {
  std::vector<SparseRow> rows(kernel.size());
  for (std::size_t k = 0; k < kernel.entries.size(); ++k)
    rows[kernel.entries[k].row].emplace_back(kernel.entries[k].column - first, out[kernel.size() + k]);
  return rows;
}

}  // namespace

double dot(const SparseRow& row, const Eigen::VectorXd& x) {
  double sum = 0;
  for (const auto& [i, value] : row) sum += value * x(static_cast<Index>(i));
  return sum;
}

ContactFunctions::ContactFunctions(const EquationsOfMotion& equations, std::span<const double> parameters)
    : n_(equations.system->coordinates.size()),
      m_(equations.system->constraints.size()),
      contacts_(equations.system->contacts.size()),
      frictions_(contacts_ + equations.system->frictions.size()),
      gaps_(build_differentiable(Lowering(*equations.system).source(gaps_of(*equations.system)), 0, n_)),
      slips_(build_differentiable(Lowering(*equations.system).source(slips_of(*equations.system)), n_, 2 * n_)),
      rates_(build_function(Lowering(*equations.system).source(rates_of(*equations.system)))),
      matrices_(build_function(Lowering(*equations.system).source(matrices_of(equations)))),
      gaps_work_(gaps_.values_and_entries),
      slips_work_(slips_.values_and_entries),
      rates_work_(rates_),
      matrices_work_(matrices_),
      gaps_out_(gaps_.values_and_entries.outputs()),
      slips_out_(slips_.values_and_entries.outputs()),
      rates_out_(rates_.outputs()),
      matrices_out_(matrices_.outputs()) {
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
  evaluate(gaps_work_, gaps_out_, t, q, v);
  evaluate(slips_work_, slips_out_, t, q, v);
  evaluate(rates_work_, rates_out_, t, q, v);
  ContactValues& out = values_;
  out.gap.assign(gaps_out_.begin(), gaps_out_.begin() + static_cast<std::ptrdiff_t>(contacts_));
  out.slip.assign(slips_out_.begin(), slips_out_.begin() + static_cast<std::ptrdiff_t>(frictions_));
  out.normal = rows_of(gaps_, gaps_out_, 0);
  out.tangent = rows_of(slips_, slips_out_, n_);
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
    out.slip_scale.push_back(scale + std::abs(rest));
    out.kinetic.push_back(rates_out_[3 * contacts_ + 2 * i]);
    out.fixed.push_back(rates_out_[3 * contacts_ + 2 * i + 1]);
  }
  return out;
}

Eigen::MatrixXd ContactFunctions::response(double t, std::span<const double> q, std::span<const double> v,
                                           std::span<const SparseRow> rows) {
  evaluate(matrices_work_, matrices_out_, t, q, v);
  const auto n = static_cast<Index>(n_), m = static_cast<Index>(m_);
  Eigen::MatrixXd bordered = Eigen::MatrixXd::Zero(n + m, n + m);
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j) bordered(i, j) = matrices_out_[static_cast<std::size_t>(i * n + j)];
  for (Index k = 0; k < m; ++k)
    for (Index j = 0; j < n; ++j)
      bordered(n + k, j) = bordered(j, n + k) = matrices_out_[static_cast<std::size_t>((n + k) * n + j)];
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(n + m, static_cast<Index>(rows.size()));
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (const auto& [i, value] : rows[r]) right(static_cast<Index>(i), static_cast<Index>(r)) = value;
  const Eigen::FullPivLU<Eigen::MatrixXd> lu(bordered);
  return lu.solve(right).topRows(n);
}

}  // namespace maupertuis
