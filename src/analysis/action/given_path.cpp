#include "analysis/action/problem.hpp"
#include "linear_algebra/dense.hpp"

#include <maupertuis/function_kernel.hpp>
#include <maupertuis/motion_kernel.hpp>
#include <maupertuis/transform.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

/// S along formulas q(t): Gauss's rule on pieces that are halved until the halves say the same; next to an end where L
/// is infinite they are halved on and on.
namespace maupertuis {
namespace {

using namespace action;

constexpr int deepest = 200;
constexpr double piece_error = 1e-15;  // of Σ |L| over the whole path
constexpr int looks = 401;             // places at which the equations are looked at
constexpr double stationary_residual = 1e-9;

/// q, q', q'' of the path as functions of t, and the sizes of the terms of q and q'.
class Formulas {
 public:
  Formulas(const MechanicalSystem& system, std::span<const Expr> path) : n_(static_cast<Index>(path.size())) {
    FunctionSource source;
    source.inputs = {system.context->time()};
    for (const Parameter& p : system.parameters) source.parameters.push_back(p.symbol);
    ExprVector values = expand_time_derivatives(in_terms_of_motion(system, path));
    for (int order = 0; order < 3; ++order) {
      source.outputs.insert(source.outputs.end(), values.begin(), values.end());
      for (Expr& e : values) e = total_time_derivative(e);
    }
    for (std::size_t i = 0; i < 2 * path.size(); ++i) source.outputs.push_back(size_of_terms(source.outputs[i]));
    kernel_ = build_function(source);
    work_.emplace(kernel_);
    work_->set_parameters(parameter_values(system));
    out_.resize(source.outputs.size());
  }

  /// Afterwards q(), v(), a().
  void at(double t) { work_->evaluate({&t, 1}, out_); }
  const double* q() const { return out_.data(); }
  const double* v() const { return out_.data() + n_; }
  const double* a() const { return out_.data() + 2 * n_; }
  const double* q_terms() const { return out_.data() + 3 * n_; }
  const double* v_terms() const { return out_.data() + 4 * n_; }

 private:
  Index n_;
  FunctionKernel kernel_;
  std::optional<FunctionWorkspace> work_;
  std::vector<double> out_;
};

struct Sums {
  bool finite = true;
  Vector values;  // ∫ L, then each ∫ G
  double size = 0;
};

class Integrator {
 public:
  Integrator(Problem& problem, Formulas& formulas)
      : problem_(problem), formulas_(formulas), none_(Vector::Zero(problem.functional.integrals())) {}

  Sums over(double from, double to) {
    const Rule& rule = *problem_.rule;
    Sums out{true, Vector::Zero(1 + none_.size()), 0};
    ExactSum action;
    for (Index g = 0; g < rule.points.size() && out.finite; ++g) {
      const double t = from + (to - from) * (1 + rule.points[g]) / 2, w = (to - from) / 2 * rule.weights[g];
      formulas_.at(t);
      problem_.functional.evaluate(t, formulas_.q(), formulas_.v(), none_, 0, density_);
      out.finite = density_.finite;
      action.add(w * density_.lagrangian);
      out.values.tail(none_.size()) += w * density_.integrals;
      out.size += std::abs(w * density_.lagrangian);
    }
    out.values[0] = action.value();
    return out;
  }

  /// A bound on the rounding in ∫ L over a piece: that of t, of q and q' from their formulas, of the terms of L, of the
  /// weights.
  double rounding(double from, double to) {
    const Rule& rule = *problem_.rule;
    double sum = 0;
    for (Index g = 0; g < rule.points.size(); ++g) {
      const double t = from + (to - from) * (1 + rule.points[g]) / 2, latest = std::abs(from) + std::abs(to);
      formulas_.at(t);
      const Sensitivity by = problem_.functional.sensitivity(t, formulas_.q(), formulas_.v(), none_);
      double here = by.terms + by.by_time * latest;
      for (Index i = 0; i < problem_.n(); ++i)
        here += by.by_q[i] * (formulas_.q_terms()[i] + std::abs(formulas_.v()[i]) * latest) +
                by.by_v[i] * (formulas_.v_terms()[i] + std::abs(formulas_.a()[i]) * latest);
      sum += (to - from) / 2 * rule.weights[g] * here;
    }
    return rounding_unit * sum;
  }

  /// Adds to `total`; what the halves of the last pieces disagree by adds to `error`.
  bool add(double from, double to, const Sums& whole, double size, int depth, Vector& total, double& error) {
    const double middle = from + (to - from) / 2;
    const Sums left = over(from, middle), right = over(middle, to);
    if (!left.finite || !right.finite) return false;
    const double difference = std::abs(left.values[0] + right.values[0] - whole.values[0]);
    if (depth == 0 || difference <= piece_error * size || middle == from || middle == to) {
      action_.add(left.values[0]);
      action_.add(right.values[0]);
      total += left.values + right.values;
      total[0] = action_.value();
      error += difference + rounding(from, middle) + rounding(middle, to);
      return true;
    }
    return add(from, middle, left, size, depth - 1, total, error) &&
           add(middle, to, right, size, depth - 1, total, error);
  }

 private:
  Problem& problem_;
  Formulas& formulas_;
  Vector none_;
  Density density_;
  ExactSum action_;
};

/// d/dt ∂L/∂q' − ∂L/∂q in numbers, of L and of each G, with the sizes of the terms.
class Residual {
 public:
  Residual(const Problem& problem) : n_(problem.n()), k_(problem.functional.integrals()) {
    const MechanicalSystem& system = *problem.equations.system;
    ExprVector q, rows;
    for (const Coordinate& c : system.coordinates) q.push_back(c.q);
    const auto add = [&](Expr density) {
      for (const Expr& e : expand_time_derivatives(in_terms_of_motion(system, variational_residual(density, q))))
        rows.push_back(e);
    };
    add(problem.equations.lagrangian_expanded);
    for (const IntegralConstraint& c : system.integral_constraints) add(c.integrand);
    FunctionSource source;
    for (const Coordinate& c : system.coordinates) source.inputs.push_back(c.q);
    for (const Coordinate& c : system.coordinates) source.inputs.push_back(c.velocity);
    for (const Coordinate& c : system.coordinates) source.inputs.push_back(c.acceleration);
    source.inputs.push_back(system.context->time());
    for (const Parameter& p : system.parameters) source.parameters.push_back(p.symbol);
    for (const Expr& row : rows) {
      first_.push_back(source.outputs.size());
      const std::size_t terms = row.is(Kind::Sum) ? row.size() : 1;
      for (std::size_t i = 0; i < terms; ++i) source.outputs.push_back(row.is(Kind::Sum) ? row[i] : row);
    }
    first_.push_back(source.outputs.size());
    kernel_ = build_function(source);
    work_.emplace(kernel_);
    work_->set_parameters(parameter_values(system));
    out_.resize(source.outputs.size());
  }

  /// rows [n × 1 + k], sizes [n × 1 + k]
  void at(double t, const Formulas& f, Matrix& rows, Matrix& sizes) {
    std::vector<double> in(f.q(), f.q() + 3 * n_);
    in.push_back(t);
    work_->evaluate(in, out_);
    rows = sizes = Matrix::Zero(n_, 1 + k_);
    for (Index r = 0; r < rows.size(); ++r)
      for (std::size_t i = first_[static_cast<std::size_t>(r)]; i < first_[static_cast<std::size_t>(r) + 1]; ++i) {
        rows.data()[r] += out_[i];
        sizes.data()[r] += std::abs(out_[i]);
      }
  }

 private:
  Index n_, k_;
  std::vector<std::size_t> first_;
  FunctionKernel kernel_;
  std::optional<FunctionWorkspace> work_;
  std::vector<double> out_;
};

/// λ of the integral constraints that balances the equations best along the path.
Vector best_multipliers(const std::vector<Matrix>& rows, Index k) {
  if (k == 0) return Vector::Zero(0);
  const Index n = rows.front().rows();
  Matrix left(n * static_cast<Index>(rows.size()), k);
  Vector right(left.rows());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    left.middleRows(static_cast<Index>(i) * n, n) = rows[i].rightCols(k);
    right.segment(static_cast<Index>(i) * n, n) = -rows[i].col(0);
  }
  return left.colPivHouseholderQr().solve(right);
}

void look_at_equations(Problem& problem, Formulas& formulas, GivenPath& out) {
  Residual residual(problem);
  std::vector<Matrix> rows, sizes;
  std::vector<double> times;
  const Index n = problem.n(), k = problem.functional.integrals();
  double largest_size = 0;
  for (int i = 0; i < looks; ++i) {
    const double t = out.start + (out.end - out.start) * (i + 0.5) / looks;
    formulas.at(t);
    Matrix row, size, constraint_rows;
    Vector values;
    residual.at(t, formulas, row, size);
    if (!row.allFinite()) continue;
    problem.functional.constraints_at(t, Eigen::Map<const Vector>(formulas.q(), n), values, constraint_rows);
    const Matrix z = null_basis(constraint_rows, n);
    rows.push_back(z * (z.transpose() * row));
    sizes.push_back(size);
    times.push_back(t);
  }
  if (rows.empty()) return;
  const Vector lambda = best_multipliers(rows, k);
  for (const Matrix& s : sizes)
    largest_size = std::max(largest_size, (s.col(0) + s.rightCols(k) * lambda.cwiseAbs()).maxCoeff());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Vector left = rows[i].col(0) + rows[i].rightCols(k) * lambda;
    Index row = 0;
    const double here = left.cwiseAbs().maxCoeff(&row) / std::max(largest_size, 1e-300);
    if (i > 0 && here <= out.residual) continue;
    out.residual = here;
    out.residual_at = times[i];
    out.residual_row = static_cast<std::size_t>(row);
  }
  if (largest_size == 0) out.residual = 0;
  out.stationary = out.residual <= stationary_residual;
}

/// The path on a mesh: to be drawn, and for its neighbours.
Trial trial_of(const Problem& problem, Formulas& formulas, double start, double end) {
  constexpr Index elements = 24;
  Trial out{even_mesh(problem.rule, start, end, elements),
            {},
            Vector::Zero(problem.functional.integrals()),
            Vector::Zero(problem.n())};
  out.q.resize(problem.n(), out.mesh.nodes());
  for (Index k = 0; k < out.mesh.nodes(); ++k) {
    formulas.at(out.mesh.time(k));
    out.q.col(k) = Eigen::Map<const Vector>(formulas.q(), problem.n());
  }
  return out;
}

bool meets_ends(const Problem& problem, Formulas& formulas, double start, double end, const ActionEnds& ends,
                Diagnostics& diagnostics) {
  const MechanicalSystem& system = problem.model.system;
  const auto span = problem.model.experiment.path ? std::optional(problem.model.experiment.path->span) : std::nullopt;
  const auto refuse = [&](const std::string& what, double given, double wanted) {
    diagnostics.error(
        "E1205", span,
        fmt::format("the path misses its {}: {:.9g} instead of {:.9g}, by {:.3g}", what, given, wanted, given - wanted),
        "Paths are compared between the same ends; one that begins or ends elsewhere is no neighbour of the others.",
        "Change the formula, or the ends (`path from …`, --ends).");
    return false;
  };
  const double whole = std::abs(ends.end - ends.start);
  if (std::abs(start - ends.start) > 1e-9 * whole) return refuse("start of " + system.independent, start, ends.start);
  if (std::abs(end - ends.end) > 1e-9 * whole) return refuse("end of " + system.independent, end, ends.end);
  for (const bool first : {true, false}) {
    formulas.at(first ? start : end);
    const auto& wanted = first ? ends.from : ends.to;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      if (!wanted[i]) continue;
      const double size = std::max(std::abs(*wanted[i]), problem.typical[static_cast<Index>(i)]);
      if (!(std::abs(formulas.q()[i] - *wanted[i]) <= 1e-9 * size))
        return refuse(fmt::format("{} in {}", first ? "beginning" : "end", system.coordinates[i].name), formulas.q()[i],
                      *wanted[i]);
    }
  }
  return true;
}

bool keeps_constraints(Problem& problem, Formulas& formulas, double start, double end, Diagnostics& diagnostics) {
  if (problem.functional.constraints() == 0) return true;
  const ConstraintManifold manifold(problem.equations);
  for (int k = 0; k <= 32; ++k) {
    const double t = start + (end - start) * k / 32;
    formulas.at(t);
    MotionState s{
        t, {formulas.q(), formulas.q() + problem.n()}, std::vector<double>(static_cast<std::size_t>(problem.n()))};
    const auto off = manifold.relative_values(s);
    for (std::size_t i = 0; i < off.size(); ++i) {
      if (off[i] < 1e-9) continue;
      diagnostics.error("E1202", {},
                        fmt::format("the path leaves {} at {}, by {:.2g} times the size of its terms",
                                    problem.model.system.constraint_label(i), place(t, problem.model.system), off[i]),
                        "Every point of a path has to satisfy the constraints.", "Give a path that keeps to them.");
      return false;
    }
  }
  return true;
}

}  // namespace

std::optional<GivenPath> action_of_path(const Model& model, const EquationsOfMotion& equations,
                                        std::span<const Expr> path, double start, double end,
                                        const std::optional<ActionEnds>& ends, const ActionOptions& options,
                                        Diagnostics& diagnostics) {
  if (!has_action(equations, diagnostics)) return std::nullopt;
  Problem problem(model, equations);
  if (!check_order(start, end, model.system, {}, diagnostics)) return std::nullopt;
  Formulas formulas(model.system, path);
  if (ends && !meets_ends(problem, formulas, start, end, *ends, diagnostics)) return std::nullopt;
  if (!keeps_constraints(problem, formulas, start, end, diagnostics)) return std::nullopt;
  GivenPath out;
  out.start = start;
  out.end = end;
  Integrator integrator(problem, formulas);
  const Sums whole = integrator.over(start, end);
  Vector total = Vector::Zero(1 + problem.functional.integrals());
  if (!whole.finite || !integrator.add(start, end, whole, whole.size, deepest, total, out.action_error)) {
    diagnose_infinite_lagrangian("path", diagnostics);
    return std::nullopt;
  }
  out.action = total[0];
  out.integrals.assign(total.data() + 1, total.data() + total.size());
  look_at_equations(problem, formulas, out);
  if (interrupted(options, diagnostics)) return std::nullopt;
  const Trial trial = trial_of(problem, formulas, start, end);
  out.path = to_path(trial);
  const auto n = static_cast<std::size_t>(problem.n());
  if (options.variations)
    out.variations = test_variations(problem, trial, {std::vector<bool>(n, true), std::vector<bool>(n, true)},
                                     problem.least(nullptr));
  return out;
}

}  // namespace maupertuis
