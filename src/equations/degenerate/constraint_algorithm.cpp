#include <maupertuis/constraint_algorithm.hpp>
#include <maupertuis/linear_system.hpp>
#include <maupertuis/switches.hpp>
#include <maupertuis/transform.hpp>

#include "equations/degenerate/real_part.hpp"
#include "equations/row_reduction.hpp"
#include "linear_algebra/dense.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using Index = Eigen::Index;

constexpr int most_generations = 40;
constexpr double small = 1e-9;  // of a coefficient, beside the largest

/// The coefficients at a point, each row divided by its largest; rows that vanish there, as far as rounding lets one
/// see, are 0.
Matrix coefficients_at(const std::vector<LinearCondition>& conditions, const Bindings& point) {
  const std::size_t columns = conditions.front().coefficients.size();
  ExprVector entries;
  for (const LinearCondition& c : conditions)
    entries.insert(entries.end(), c.coefficients.begin(), c.coefficients.end());
  const std::vector<double> values = evaluate(entries, point);
  Matrix m(static_cast<Index>(conditions.size()), static_cast<Index>(columns));
  for (Index i = 0; i < m.rows(); ++i)
    for (Index j = 0; j < m.cols(); ++j)
      m(i, j) = values[static_cast<std::size_t>(i) * columns + static_cast<std::size_t>(j)];
  return m;
}

/// Rows scaled by their own sizes; what is below rounding of the whole counts as 0.
Matrix scaled_rows(Matrix m) {
  const double largest = m.size() ? m.cwiseAbs().maxCoeff() : 0;
  for (Index i = 0; i < m.rows(); ++i) {
    const double size = m.row(i).cwiseAbs().maxCoeff();
    if (size > 1e-12 * largest)
      m.row(i) /= size;
    else
      m.row(i).setZero();
  }
  return m;
}

class Algorithm {
 public:
  explicit Algorithm(const ConstraintProblem& problem) : problem_(problem), relations_(problem.relations) {
    out_.conditions = problem.conditions;
  }

  ConstraintChain run() {
    find_points();
    for (int generation = 1; generation <= most_generations; ++generation) {
      if (out_.outcome != ConstraintChain::Outcome::Closed) return std::move(out_);
      if (!next(generation)) break;
    }
    finish();
    return std::move(out_);
  }

 private:
  /// One generation: the conditions on states that the rows leave. False where there is no new one.
  bool next(int generation) {
    const std::size_t before = out_.constraints.size();
    const std::vector<std::size_t> chosen = independent_conditions(out_.conditions, points_->points());
    std::vector<std::pair<Expr, bool>> left;
    for (std::size_t r = 0; r < out_.conditions.size(); ++r)
      if (std::find(chosen.begin(), chosen.end(), r) == chosen.end()) left.push_back(remainder(r, chosen));
    if (out_.outcome != ConstraintChain::Outcome::Closed) return true;
    for (const auto& [value, follows] : left) {
      if (value.is_zero()) continue;
      if (points_->vanishes(value) != Verdict::Nonzero) {
        if (!vanishes_everywhere(value)) return true;
        continue;
      }
      for (const Expr& part : real_parts(value, problem_.order, problem_.states)) add(part, generation, follows);
      if (out_.outcome != ConstraintChain::Outcome::Closed) return true;
    }
    for (std::size_t k = before; k < out_.constraints.size(); ++k)
      out_.conditions.push_back(problem_.derivative(out_.constraints[k].value));
    return out_.constraints.size() > before;
  }

  void add(Expr value, int generation, bool follows) {
    if (points_->vanishes(value) == Verdict::Zero) return;  // another one of this generation says it
    out_.constraints.push_back({value, generation, follows});
    if (!has_state(value)) {
      out_.outcome = ConstraintChain::Outcome::Contradiction;
      return;
    }
    relations_.push_back(value);
    find_points();
    keep_what_vanishes();
  }

  /// Of a product the factors that vanish at the states near the start: r²(θ' − z) = 0 means θ' = z where r is not 0.
  void keep_what_vanishes() {
    const Expr product = relations_.back();
    if (!product.is(Kind::Product) || points_->points().empty()) return;
    Expr kept = product.context().number(1);
    for (std::size_t i = 0; i < product.size(); ++i)
      if (points_->vanishes(product[i]) != Verdict::Nonzero) kept = kept * product[i];
    if (kept == product || kept.is_one()) return;
    relations_.back() = kept;
    out_.constraints.back().value = kept;
    find_points();
  }

  bool has_state(Expr value) const {
    for (const Expr& s : symbols_of({&value, 1}))
      if (std::find(problem_.states.begin(), problem_.states.end(), s) != problem_.states.end()) return true;
    return false;
  }

  /// Row r as a combination of the chosen ones: what is left of its right side, and whether r has no unknown at all.
  std::pair<Expr, bool> remainder(std::size_t r, const std::vector<std::size_t>& chosen) {
    const LinearCondition& row = out_.conditions[r];
    const std::vector<std::size_t> part = taking_part(r, chosen);
    if (part.empty()) {
      for (const Expr& coefficient : row.coefficients)
        if (!vanishes_everywhere(coefficient)) break;
      return {row.rest, row.is_derivative};
    }
    const std::vector<std::size_t> columns = pivots(part);
    if (columns.size() < part.size()) {  // independent at different points alone
      const ExprVector& entries = out_.conditions[part.front()].coefficients;
      out_.outcome = ConstraintChain::Outcome::Varies;
      out_.varying = *std::find_if(entries.begin(), entries.end(), [](const Expr& e) { return !e.is_zero(); });
      return {row.rest, false};
    }
    Context& context = row.rest.context();
    ExprMatrix system{part.size(), part.size() + 1, {}};  // Σ_k c_k B_kj = r_j
    for (const std::size_t j : columns) {
      for (const std::size_t k : part) system.entries.push_back(out_.conditions[k].coefficients[j]);
      system.entries.push_back(row.coefficients[j]);
    }
    const auto weights = solve_linear(system);
    if (!weights) throw std::logic_error("rows that are independent at points have no solution; please report");
    const auto less_combination = [&](const std::function<Expr(const LinearCondition&)>& entry) {
      ExprVector terms{entry(row)};
      for (std::size_t k = 0; k < part.size(); ++k) terms.push_back(-((*weights)[k] * entry(out_.conditions[part[k]])));
      return context.sum(terms);
    };
    for (std::size_t j = 0; j < row.coefficients.size(); ++j) {
      if (std::find(columns.begin(), columns.end(), j) != columns.end()) continue;
      if (!vanishes_everywhere(less_combination([j](const LinearCondition& c) { return c.coefficients[j]; }))) break;
    }
    return {less_combination([](const LinearCondition& c) { return c.rest; }), false};
  }

  /// What is 0 at the states near the start must be so wherever a motion may go: identically, or on the constraints by
  /// more than 60 digits, with the formulas of both sides of each of its switches. max(x − 3, 0)² is 0 at x = 1, and an
  /// inertia beyond 3. Else the outcome is Varies.
  bool vanishes_everywhere(Expr e) {
    if (vanishes_identically(e)) return true;
    bool everywhere = points_->vanishes(e) == Verdict::Zero;
    for (const Expr& g : switches_of({&e, 1}))
      for (const bool above : {true, false}) everywhere = everywhere && vanishes_on_side(e, g, above);
    if (everywhere) return true;
    out_.outcome = ConstraintChain::Outcome::Varies;
    out_.varying = e;
    return false;
  }

  /// With the formulas that are in force where g has this sign, in the constraints as well.
  bool vanishes_on_side(Expr e, Expr g, bool above) const {
    ExprVector all = relations_;
    all.push_back(e);
    all = on_side(all, g, above);
    const Expr there = all.back();
    all.pop_back();
    if (there.is_zero()) return true;
    ZeroTestOptions options;
    options.hold_parameters = problem_.hold_parameters;
    const PointsWhere points(all, problem_.states, problem_.center, options);
    return points.vanishes(there) == Verdict::Zero;
  }

  /// The chosen rows of which r is a combination, at any of the points.
  std::vector<std::size_t> taking_part(std::size_t r, const std::vector<std::size_t>& chosen) const {
    std::vector<bool> takes(chosen.size(), false);
    for (const Bindings& point : points_->points()) {
      const Matrix m = scaled_rows(coefficients_at(out_.conditions, point));
      if (chosen.empty() || m.row(static_cast<Index>(r)).isZero()) continue;
      Matrix basis(m.cols(), static_cast<Index>(chosen.size()));
      for (std::size_t k = 0; k < chosen.size(); ++k)
        basis.col(static_cast<Index>(k)) = m.row(static_cast<Index>(chosen[k])).transpose();
      const Vector weights = least_squares(basis, m.row(static_cast<Index>(r)).transpose());
      for (std::size_t k = 0; k < chosen.size(); ++k)
        if (std::abs(weights[static_cast<Index>(k)]) > small) takes[k] = true;
    }
    std::vector<std::size_t> out;
    for (std::size_t k = 0; k < chosen.size(); ++k)
      if (takes[k]) out.push_back(chosen[k]);
    return out;
  }

  /// As many columns as rows in which these are regular at one of the points; fewer where they are so at none.
  std::vector<std::size_t> pivots(const std::vector<std::size_t>& rows) const {
    std::vector<std::size_t> out;
    for (const Bindings& point : points_->points()) {
      const Matrix all = scaled_rows(coefficients_at(out_.conditions, point));
      Matrix m(all.cols(), static_cast<Index>(rows.size()));
      for (std::size_t k = 0; k < rows.size(); ++k)
        m.col(static_cast<Index>(k)) = all.row(static_cast<Index>(rows[k])).transpose();
      std::vector<std::size_t> here = independent_rows(m);
      if (here.size() > out.size()) out = std::move(here);
      if (out.size() == rows.size()) break;
    }
    return out;
  }

  /// States where the conditions have values: beyond the speed of light √(1 − v²) has none.
  void find_points() {
    ZeroTestOptions options;
    options.hold_parameters = problem_.hold_parameters;
    ExprVector given;
    for (const LinearCondition& c : problem_.conditions) {
      given.push_back(c.rest);
      given.insert(given.end(), c.coefficients.begin(), c.coefficients.end());
    }
    points_ = std::make_shared<const PointsWhere>(relations_, problem_.states, problem_.center, options, given);
    if (points_->points().empty()) out_.outcome = ConstraintChain::Outcome::Unreached;
  }

  void finish() {
    out_.where = points_;
    std::vector<LinearCondition> gradients;
    for (const Expr& relation : relations_) gradients.push_back({gradient(relation, problem_.states), relation});
    const std::size_t bound = gradients.empty() ? 0 : independent_conditions(gradients, points_->points()).size();
    out_.manifold_dimension = problem_.states.size() - bound;
    out_.rank = independent_conditions(out_.conditions, points_->points()).size();
  }

  const ConstraintProblem& problem_;
  ExprVector relations_;
  std::shared_ptr<const PointsWhere> points_;
  ConstraintChain out_;
};

}  // namespace

std::vector<std::size_t> independent_conditions(const std::vector<LinearCondition>& conditions,
                                                const std::vector<Bindings>& points) {
  std::vector<std::size_t> most;
  for (const Bindings& point : points) {
    const std::vector<std::size_t> here = independent_rows(scaled_rows(coefficients_at(conditions, point)));
    if (here.size() > most.size()) most = here;
  }
  return most;
}

std::vector<std::size_t> open_unknowns(const std::vector<LinearCondition>& conditions,
                                       const std::vector<Bindings>& points) {
  const Matrix m = scaled_rows(coefficients_at(conditions, points.front()));
  std::vector<std::size_t> open;
  const std::vector<std::size_t> bound = independent_rows(m.transpose());
  for (std::size_t j = 0; j < static_cast<std::size_t>(m.cols()); ++j)
    if (std::find(bound.begin(), bound.end(), j) == bound.end()) open.push_back(j);
  return open;
}

std::vector<std::size_t> independent_by_size(const std::vector<LinearCondition>& conditions, std::size_t fixed,
                                             const Bindings& point) {
  Matrix left = coefficients_at(conditions, point);
  const double whole = left.size() ? left.cwiseAbs().maxCoeff() : 0;
  std::vector<std::size_t> chosen;
  const auto choose = [&](Index row) {
    const Vector direction = left.row(row).normalized().transpose();
    chosen.push_back(static_cast<std::size_t>(row));
    left -= (left * direction) * direction.transpose();
  };
  for (Index row = 0; row < static_cast<Index>(fixed); ++row)
    if (left.row(row).norm() > small * whole) choose(row);
  for (Index row = 0; left.rows() > 0;) {
    if (!(left.rowwise().norm().maxCoeff(&row) > small * whole)) break;
    choose(row);
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

std::vector<std::size_t> most_open_unknowns(const std::vector<LinearCondition>& conditions, std::size_t count,
                                            const Bindings& point) {
  const Matrix m = scaled_rows(coefficients_at(conditions, point));
  // Directions that no row sees, from the projector on them: its largest columns lie most in the open.
  Eigen::CompleteOrthogonalDecomposition<Matrix> rows(m);
  rows.setThreshold(small);
  Matrix open = Matrix::Identity(m.cols(), m.cols()) - rows.pseudoInverse() * m;
  std::vector<std::size_t> out;
  for (Index column = 0; out.size() < count; ++column) {
    if (!(open.colwise().norm().maxCoeff(&column) > small)) break;
    out.push_back(static_cast<std::size_t>(column));
    const Vector direction = open.col(column).normalized();
    open -= direction * (direction.transpose() * open);
  }
  std::sort(out.begin(), out.end());
  return out;
}

ConstraintChain constraint_algorithm(const ConstraintProblem& problem) { return Algorithm(problem).run(); }

}  // namespace maupertuis
