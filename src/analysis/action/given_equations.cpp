#include "analysis/action/given_equations.hpp"

#include "linear_algebra/dense.hpp"

#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/motion_kernel.hpp>
#include <maupertuis/size_of_terms.hpp>
#include <maupertuis/transform.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace maupertuis::action {
namespace {

constexpr int even_looks = 401;
constexpr double stationary_residual = 1e-9;
constexpr int seen_degree = 11;      // of polynomials on a piece: twelve places tell all of them
constexpr double of_places = 10;     // what interpolation there adds to the best polynomial
constexpr double seen = 1e-10;       // of the sizes: what may stay unseen between the places
constexpr double least_size = 1e-6;  // of the largest terms of the equations: smaller ones are not followed
constexpr double of_an_end = 64;     // gaps that are nearer to an end than so many of their widths are the end's
constexpr double jump = 1e-9;        // of the size of a function: less is rounding

/// q, p, h_E beside the rows of L and of each G.
ExprVector functions_of(const Problem& problem, const PathFunctions& path, const ExprVector& rows) {
  const MechanicalSystem& system = *problem.equations.system;
  ExprVector densities{problem.equations.lagrangian_expanded}, out = rows, energies;
  for (const IntegralConstraint& c : system.integral_constraints) densities.push_back(c.integrand);
  densities = expand_time_derivatives(in_terms_of_motion(system, densities));
  for (const Coordinate& c : system.coordinates) out.push_back(c.q);
  for (const Expr& density : densities) {
    Expr energy = -density;
    for (const Coordinate& c : system.coordinates) {
      out.push_back(differentiate(density, c.velocity));
      energy = energy + c.velocity * out.back();
    }
    energies.push_back(energy);
  }
  out.insert(out.end(), energies.begin(), energies.end());
  return path.on_path(out);
}

/// λ of the integral constraints that balances the equations best along the path.
Vector best_multipliers(const std::vector<Matrix>& rows, Index k) {
  if (k == 0 || rows.empty()) return Vector::Zero(k);
  const Index n = rows.front().rows();
  Matrix left(n * static_cast<Index>(rows.size()), k);
  Vector right(left.rows());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    left.middleRows(static_cast<Index>(i) * n, n) = rows[i].rightCols(k);
    right.segment(static_cast<Index>(i) * n, n) = -rows[i].col(0);
  }
  // The smallest ones: along straight pieces the length of a curve leaves λ open.
  return Eigen::CompleteOrthogonalDecomposition<Matrix>(left).solve(right);
}

}  // namespace

PathFunctions::PathFunctions(const MechanicalSystem& system, std::span<const Expr> path)
    : system_(system), n_(static_cast<Index>(path.size())) {
  FunctionSource source;
  source.inputs = {system.context->time()};
  for (const Parameter& p : system.parameters) source.parameters.push_back(p.symbol);
  ExprVector values = expand_time_derivatives(in_terms_of_motion(system, path));
  for (int order = 0; order < 3; ++order) {
    source.outputs.insert(source.outputs.end(), values.begin(), values.end());
    for (std::size_t i = 0; i < values.size(); ++i) {
      const Coordinate& c = system.coordinates[i];
      path_.emplace(order == 0 ? c.q : order == 1 ? c.velocity : c.acceleration, values[i]);
      values[i] = total_time_derivative(values[i]);
    }
  }
  for (std::size_t i = 0; i < 2 * path.size(); ++i) source.outputs.push_back(size_of_terms(source.outputs[i]));
  kernel_ = build_function(source);
  work_.emplace(kernel_);
  work_->set_parameters(parameter_values(system));
  out_.resize(source.outputs.size());
}

ExprVector PathFunctions::on_path(std::span<const Expr> functions) const {
  const ExprVector plain = expand_time_derivatives(in_terms_of_motion(system_, functions));
  return substitute(plain, path_);
}

Residual::Residual(const Problem& problem) : n_(problem.n()), k_(problem.functional.integrals()) {
  const MechanicalSystem& system = *problem.equations.system;
  ExprVector q;
  for (const Coordinate& c : system.coordinates) q.push_back(c.q);
  const auto add = [&](Expr density) {
    for (const Expr& e : expand_time_derivatives(in_terms_of_motion(system, variational_residual(density, q))))
      rows_.push_back(e);
  };
  add(problem.equations.lagrangian_expanded);
  for (const IntegralConstraint& c : system.integral_constraints) add(c.integrand);
  FunctionSource source;
  for (const Coordinate& c : system.coordinates) source.inputs.push_back(c.q);
  for (const Coordinate& c : system.coordinates) source.inputs.push_back(c.velocity);
  for (const Coordinate& c : system.coordinates) source.inputs.push_back(c.acceleration);
  source.inputs.push_back(system.context->time());
  for (const Parameter& p : system.parameters) source.parameters.push_back(p.symbol);
  for (const Expr& row : rows_) {
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

void Residual::at(double t, const PathFunctions& path, Matrix& rows, Matrix& sizes) {
  in_.assign(path.q(), path.q() + 3 * n_);
  in_.push_back(t);
  work_->evaluate(in_, out_);
  rows = sizes = Matrix::Zero(n_, 1 + k_);
  for (Index r = 0; r < rows.size(); ++r)
    for (std::size_t i = first_[static_cast<std::size_t>(r)]; i < first_[static_cast<std::size_t>(r) + 1]; ++i) {
      rows.data()[r] += out_[i];
      sizes.data()[r] += std::abs(out_[i]);
    }
}

GivenEquations::GivenEquations(Problem& problem, PathFunctions& path, const Piece& whole)
    : problem_(problem),
      path_(path),
      whole_(whole),
      n_(problem.n()),
      k_(problem.functional.integrals()),
      residual_(problem),
      functions_(problem.model.system, functions_of(problem, path, residual_.rows())),
      least_(problem.least(nullptr)) {
  Matrix rows, sizes;
  for (int i = 0; i < even_looks; ++i) {
    const double t = whole.from + whole.width() * (i + 0.5) / even_looks;
    path_.at(t);
    least_ = least_.cwiseMax(Eigen::Map<const Vector>(path_.q(), n_).cwiseAbs());
    residual_.at(t, path_, rows, sizes);
    if (sizes.allFinite()) largest_size_ = std::max(largest_size_, sizes.maxCoeff());
  }
}

bool GivenEquations::is_path(const ActionOptions& options, Diagnostics& diagnostics) {
  const auto rows = static_cast<std::size_t>(n_ * (1 + k_));
  Matrix row, sizes;
  const auto small = [&](const Piece& piece, std::span<const double> left_out) {
    path_.at(piece.middle());
    residual_.at(piece.middle(), path_, row, sizes);
    for (std::size_t r = 0; r < rows; ++r)
      if (!(of_places * left_out[r] <= seen * std::max(sizes.data()[r], least_size * largest_size_))) return false;
    for (std::size_t i = 0; i < static_cast<std::size_t>(n_); ++i)
      if (!(of_places * left_out[rows + i] <= seen * least_[static_cast<Index>(i)])) return false;
    return std::all_of(left_out.begin() + static_cast<std::ptrdiff_t>(rows), left_out.end(),
                       [](double x) { return std::isfinite(x); });
  };
  visit_ = visit(functions_, whole_, seen_degree, small, options.interrupt);
  if (interrupted(options, diagnostics)) return false;
  const MechanicalSystem& system = problem_.model.system;
  for (const Gap& gap : visit_.gaps) {
    const Sides sides = sides_of(gap);
    for (std::size_t i = 0; i < static_cast<std::size_t>(n_); ++i) {
      if (!jumps(sides, rows + i, least_[static_cast<Index>(i)])) continue;
      diagnostics.error("E1213", {},
                        fmt::format("the path jumps at {}: {} from {:.9g} to {:.9g}", place(gap.middle(), system),
                                    system.coordinates[i].name, sides.before[rows + i], sides.after[rows + i]),
                        "A path is continuous: a jump would take an infinite velocity, which no integral of L sees.",
                        "Give formulas whose pieces meet.");
      return false;
    }
  }
  if (!visit_.whole) {
    const bool without_value = std::any_of(visit_.gaps.begin(), visit_.gaps.end(), [&](const Gap& gap) {
      const auto f = functions_.at(gap.middle());
      return !std::all_of(f.begin() + static_cast<std::ptrdiff_t>(rows), f.end(),
                          [](double x) { return std::isfinite(x); });
    });
    if (without_value) return diagnose_infinite_lagrangian("path", diagnostics), false;
    diagnostics.error("E1212", {}, "S of this path is not known: too much happens on it",
                      "The path, or what L makes of it, changes in more places than can be looked at one by one.",
                      "Give a shorter or smoother path; S of paths that follow one another adds up.");
    return false;
  }
  return keeps_constraints(diagnostics);
}

/// Places on all pieces, and even ones.
std::vector<double> GivenEquations::looks() const {
  std::vector<double> out;
  for (const Piece& p : visit_.pieces)
    for (const double x : problem_.rule->points) out.push_back(p.from + p.width() * (1 + x) / 2);
  for (int i = 0; i < even_looks; ++i) out.push_back(whole_.from + whole_.width() * (i + 0.5) / even_looks);
  std::sort(out.begin(), out.end());
  return out;
}

bool GivenEquations::keeps_constraints(Diagnostics& diagnostics) {
  if (problem_.functional.constraints() == 0) return true;
  const ConstraintManifold manifold(problem_.equations);
  std::vector<double> places = looks();
  places.insert(places.begin(), whole_.from);
  places.push_back(whole_.to);
  for (const double t : places) {
    path_.at(t);
    MotionState s{t, {path_.q(), path_.q() + n_}, std::vector<double>(static_cast<std::size_t>(n_))};
    const auto off = manifold.relative_values(s);
    for (std::size_t i = 0; i < off.size(); ++i) {
      if (off[i] < 1e-9) continue;
      diagnostics.error("E1202", {},
                        fmt::format("the path leaves {} at {}, by {:.2g} times the size of its terms",
                                    problem_.model.system.constraint_label(i), place(t, problem_.model.system), off[i]),
                        "Every point of a path has to satisfy the constraints.", "Give a path that keeps to them.");
      return false;
    }
  }
  return true;
}

/// Twice at different distances: a jump stays, a steep slope does not.
GivenEquations::Sides GivenEquations::sides_of(const Gap& gap) {
  constexpr double near = 4, far = 4096;  // roundings
  const double step = std::max(gap.width(), rounding_unit * std::max(std::abs(gap.from), std::abs(gap.to)));
  const auto values = [&](double t) {
    const auto f = functions_.at(std::clamp(t, whole_.from, whole_.to));
    return std::vector<double>(f.begin(), f.end());
  };
  return {values(gap.from - near * step), values(gap.to + near * step), values(gap.from - far * step),
          values(gap.to + far * step)};
}

bool GivenEquations::jumps(const Sides& s, std::size_t f, double size) {
  const double by = std::abs(s.after[f] - s.before[f]);
  return by > jump * size && by > 0.5 * std::abs(s.far_after[f] - s.far_before[f]);
}

/// A vector of the coordinates without what the constraints take up.
Vector GivenEquations::projected(double t, const Vector& vector) {
  if (problem_.functional.constraints() == 0) return vector;
  Vector values;
  Matrix rows;
  path_.at(t);
  problem_.functional.constraints_at(t, Eigen::Map<const Vector>(path_.q(), n_), values, rows);
  const Matrix z = null_basis(rows, n_);
  return z * (z.transpose() * vector);
}

double GivenEquations::momentum(const std::vector<double>& values, Index i, const Vector& lambda) const {
  const Eigen::Map<const Matrix> p(values.data() + n_ * (2 + k_), n_, 1 + k_);
  return p(i, 0) + p.row(i).tail(k_).dot(lambda);
}

double GivenEquations::energy(const std::vector<double>& values, const Vector& lambda) const {
  const Eigen::Map<const Vector> h(values.data() + n_ * (3 + 2 * k_), 1 + k_);
  return h[0] + h.tail(k_).dot(lambda);
}

/// p on the directions that are free, and h_E, before and after each switch of the path.
void GivenEquations::look_for_corners(const Vector& lambda, GivenPath& out) {
  const auto vectors = [&](const Gap& gap, const std::vector<double>& values) {
    Vector p(n_);
    for (Index i = 0; i < n_; ++i) p[i] = momentum(values, i, lambda);
    p = projected(gap.middle(), p);
    std::vector<double> all(p.data(), p.data() + n_);
    all.push_back(energy(values, lambda));
    return all;
  };
  std::vector<double> sizes(static_cast<std::size_t>(n_ + 1));
  for (int i = 0; i < even_looks && !visit_.gaps.empty(); ++i) {
    const double t = whole_.from + whole_.width() * (i + 0.5) / even_looks;
    const auto f = functions_.at(t);
    const std::vector<double> here = vectors({t, t}, {f.begin(), f.end()});
    for (std::size_t j = 0; j < here.size(); ++j)
      if (std::isfinite(here[j])) sizes[j] = std::max(sizes[j], std::abs(here[j]));
  }
  for (const Gap& gap : visit_.gaps) {
    const double to_end = std::min(gap.from - whole_.from, whole_.to - gap.to);
    if (to_end <= of_an_end * gap.width()) continue;
    const Sides at = sides_of(gap);
    const Sides sides{vectors(gap, at.before), vectors(gap, at.after), vectors(gap, at.far_before),
                      vectors(gap, at.far_after)};
    for (std::size_t i = 0; i < sides.before.size(); ++i) {
      const double before = sides.before[i], after = sides.after[i];
      const bool finite = std::isfinite(before) && std::isfinite(after);
      if (finite && !jumps(sides, i, sizes[i])) continue;
      const double t = gap.middle();  // next to 0 a gap is as short as it is near
      out.corner = PathCorner{std::abs(t) < rounding_unit * whole_.width() ? 0 : t, i, before, after};
      return;
    }
  }
}

void GivenEquations::judge(GivenPath& out) {
  struct Look {
    double t;
    Matrix rows, sizes;
  };
  std::vector<Look> all;
  std::vector<Matrix> rows;
  for (const double t : looks()) {
    Look here{t, {}, {}};
    path_.at(t);
    residual_.at(t, path_, here.rows, here.sizes);
    if (!here.rows.allFinite()) continue;
    for (Index c = 0; c < here.rows.cols(); ++c) here.rows.col(c) = projected(t, here.rows.col(c));
    rows.push_back(here.rows);
    all.push_back(std::move(here));
  }
  const Vector lambda = best_multipliers(rows, k_);
  for (const Look& look : all) {
    const Vector left = look.rows.col(0) + look.rows.rightCols(k_) * lambda,
                 sizes = look.sizes.col(0) + look.sizes.rightCols(k_) * lambda.cwiseAbs();
    Index row = 0;
    const double largest = left.cwiseAbs().maxCoeff(&row);
    const double here = largest == 0 ? 0 : largest / std::max(sizes.maxCoeff(), largest_size_);
    if (here < out.residual || (here == out.residual && out.residual > 0)) continue;
    out.residual = here;
    out.residual_at = look.t;
    out.residual_row = static_cast<std::size_t>(row);
  }
  look_for_corners(lambda, out);
  out.stationary = out.residual <= stationary_residual && !out.corner;
}

}  // namespace maupertuis::action
