#include <maupertuis/constraint_algorithm.hpp>
#include <maupertuis/linear_system.hpp>
#include <maupertuis/switches.hpp>
#include <maupertuis/transform.hpp>

#include "equations/degenerate/branches.hpp"
#include "equations/degenerate/real_part.hpp"
#include "equations/row_reduction.hpp"
#include "linear_algebra/dense.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

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
  explicit Algorithm(const ConstraintProblem& problem) : problem_(problem) { out_.conditions = problem.conditions; }

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
  /// What a row that depends on others leaves, and its zeros.
  struct Left {
    Expr value;
    bool follows = false;
    ExprVector parts;
    bool branches() const { return parts.size() == 1 && parts.front().is(Kind::Product); }
  };

  /// One generation: the conditions on states that the rows leave. False where there is no new one.
  bool next(int generation) {
    std::vector<Left> left = what_rows_leave();
    if (out_.outcome != ConstraintChain::Outcome::Closed) return true;
    // Of u y = 0 and x² + y² = 0 the second says which factor vanishes.
    std::stable_partition(left.begin(), left.end(), [](const Left& l) { return !l.branches(); });
    for (const Left& l : left) {
      if (points_->vanishes(l.value) != Verdict::Nonzero) {
        if (!vanishes_everywhere(l.value)) return true;
        continue;
      }
      // Branches that were taken meanwhile may lie where it does not vanish.
      const ExprVector parts = l.parts.empty() ? zeros_of(l.value, constraint_values()) : l.parts;
      for (const Expr& part : parts) add(part, generation, l.follows);
      if (out_.outcome != ConstraintChain::Outcome::Closed) return true;
    }
    bool any = false;
    for (const FoundConstraint& c : out_.constraints) {
      if (std::find(derived_.begin(), derived_.end(), c.value) != derived_.end()) continue;
      any = true;
      derived_.push_back(c.value);
      out_.conditions.push_back(problem_.derivative(c.value));
    }
    return any;
  }

  std::vector<Left> what_rows_leave() {
    weak_ = with_zeros_of(*points_, out_.conditions);
    const std::vector<std::size_t> chosen = independent_conditions(weak_, points_->points());
    std::vector<Left> left;
    for (std::size_t r = 0; r < weak_.size(); ++r) {
      if (std::find(chosen.begin(), chosen.end(), r) != chosen.end()) continue;
      auto [value, follows] = remainder(r, chosen);
      if (value.is_zero()) continue;
      left.push_back({value, follows, {}});
      if (points_->vanishes(value) == Verdict::Nonzero) left.back().parts = zeros_of(value, constraint_values());
    }
    return left;
  }

  /// As regular equations: of the value as it stands, or with what is known put in where only so it branches.
  ExprVector zeros_of(Expr value, const ExprVector& known) const {
    const ExprVector parts = parts_of(value);
    if (parts.size() > 1 || !parts.front().is(Kind::Sum)) return parts;
    const Expr reduced = expand_time_derivatives(with_known_states(parts.front(), known, problem_.states));
    if (reduced == parts.front() || vanishes_identically(reduced)) return parts;
    const ExprVector other = parts_of(reduced);
    return other.size() > 1 || other.front().is(Kind::Product) ? other : parts;
  }

  const ExprVector& parts_of(Expr value) const {
    const auto [place, is_new] = parts_.try_emplace(value);
    if (is_new) place->second = real_parts(value, problem_.order, problem_.states);
    return place->second;
  }

  ExprVector constraint_values() const {
    ExprVector out;
    for (const FoundConstraint& c : out_.constraints) out.push_back(c.value);
    return out;
  }

  void add(Expr value, int generation, bool follows) {
    if (points_->vanishes(value) == Verdict::Zero) return;  // another one of this generation says it
    out_.constraints.push_back({value, generation, follows});
    if (!has_state(value)) {
      out_.outcome = ConstraintChain::Outcome::Contradiction;
      return;
    }
    find_points();
    take_branches();
  }

  /// Of each product one factor, also where it is a product by what came after it alone.
  void take_branches() {
    for (std::size_t k = 0; k < out_.constraints.size();) {
      k = take_branch(k) ? 0 : k + 1;
      if (out_.outcome == ConstraintChain::Outcome::Contradiction) return;
    }
  }

  /// False where constraint k is regular as it stands.
  bool take_branch(std::size_t k) {
    ExprVector others = constraint_values();
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
    const FoundConstraint whole = out_.constraints[k];
    ExprVector parts = zeros_of(whole.value, others);
    if (parts.size() == 1 && !parts.front().is(Kind::Product)) return false;
    if (parts.size() == 1 && !has_state(parts.front())) {  // 2 t = 0, by what the others say
      out_.constraints.erase(out_.constraints.begin() + static_cast<std::ptrdiff_t>(k));
      out_.constraints.push_back({parts.front(), whole.generation, whole.follows});
      out_.outcome = ConstraintChain::Outcome::Contradiction;
      return false;
    }
    if (parts.size() == 1) parts = zeros_of(branch_of(parts.front()), others);
    const auto place = out_.constraints.begin() + static_cast<std::ptrdiff_t>(k);
    std::vector<FoundConstraint> written;
    for (const Expr& part : parts) written.push_back({part, whole.generation, whole.follows});
    out_.constraints.insert(out_.constraints.erase(place), written.begin(), written.end());
    find_points();
    return true;
  }

  /// The factor that vanishes at the start, else the one that vanishes at the states near it, and rather one that is a
  /// branch: r²(θ' − z) = 0 means θ' = z.
  Expr branch_of(Expr product) {
    const ExprVector factors = vanishing_factors(product, problem_.states);
    ExprVector branches, at_start, branches_at_start;
    for (const Expr& f : factors) {
      const bool is_branch = keeps_rank(f);
      if (is_branch) branches.push_back(f);
      if (!problem_.start || !is_zero_at(f, problem_.states, *problem_.start)) continue;
      at_start.push_back(f);
      if (is_branch) branches_at_start.push_back(f);
    }
    const Expr kept = nearest(!branches_at_start.empty() ? branches_at_start
                              : !at_start.empty()        ? at_start
                              : !branches.empty()        ? branches
                                                         : factors);
    const auto has_other = [&](const ExprVector& list) {
      return std::any_of(list.begin(), list.end(), [&](const Expr& f) { return f != kept; });
    };
    if (has_other(branches)) out_.branches.push_back({product, kept, !at_start.empty(), has_other(branches_at_start)});
    return kept;
  }

  /// Whether the conditions of the problem determine as much where the factor vanishes as elsewhere: at r = 0 of plane
  /// polar coordinates they do not, and that is no branch of the motions.
  bool keeps_rank(Expr factor) const {
    ZeroTestOptions options;
    options.hold_parameters = problem_.hold_parameters;
    const auto rank_on = [&](const ExprVector& relations) -> std::optional<std::size_t> {
      const PointsWhere where(relations, problem_.states, problem_.center, options);
      if (where.points().empty()) return std::nullopt;
      return independent_conditions(with_zeros_of(where, problem_.conditions), where.points()).size();
    };
    const auto there = rank_on({factor});
    return there && *there >= rank_on({}).value_or(0);
  }

  /// The first that vanishes at all states near the start, else at one of them, else at none.
  Expr nearest(const ExprVector& factors) const {
    const auto& points = points_->points();
    for (const Expr& f : factors)
      if (!points.empty() && points_->vanishes(f) != Verdict::Nonzero) return f;
    for (const Expr& f : factors)
      for (const Bindings& point : points)
        if (is_zero_at(f, problem_.states, point)) return f;
    return factors.front();
  }

  bool has_state(Expr value) const {
    for (const Expr& s : symbols_of({&value, 1}))
      if (std::find(problem_.states.begin(), problem_.states.end(), s) != problem_.states.end()) return true;
    return false;
  }

  /// Row r as a combination of the chosen ones: what is left of its right side, and whether r has no unknown at all.
  std::pair<Expr, bool> remainder(std::size_t r, const std::vector<std::size_t>& chosen) {
    const LinearCondition& row = weak_[r];
    const std::vector<std::size_t> part = taking_part(r, chosen);
    if (part.empty()) {
      for (const Expr& coefficient : out_.conditions[r].coefficients)
        if (!vanishes_everywhere(coefficient)) break;
      return {row.rest, row.is_derivative};
    }
    const std::vector<std::size_t> columns = pivots(part);
    if (columns.size() < part.size()) {  // independent at different points alone
      const ExprVector& entries = weak_[part.front()].coefficients;
      out_.outcome = ConstraintChain::Outcome::Varies;
      out_.varying = *std::find_if(entries.begin(), entries.end(), [](const Expr& e) { return !e.is_zero(); });
      return {row.rest, false};
    }
    Context& context = row.rest.context();
    ExprMatrix system{part.size(), part.size() + 1, {}};  // Σ_k c_k B_kj = r_j
    for (const std::size_t j : columns) {
      for (const std::size_t k : part) system.entries.push_back(weak_[k].coefficients[j]);
      system.entries.push_back(row.coefficients[j]);
    }
    const auto weights = solve_linear(system);
    if (!weights) throw std::logic_error("rows that are independent at points have no solution; please report");
    const auto less_combination = [&](const std::function<Expr(const LinearCondition&)>& entry) {
      ExprVector terms{entry(row)};
      for (std::size_t k = 0; k < part.size(); ++k) terms.push_back(-((*weights)[k] * entry(weak_[part[k]])));
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
    ExprVector all = relations();
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
      const Matrix m = scaled_rows(coefficients_at(weak_, point));
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
      const Matrix all = scaled_rows(coefficients_at(weak_, point));
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
    points_ = std::make_shared<const PointsWhere>(relations(), problem_.states, problem_.center, options, given);
    using Outcome = ConstraintChain::Outcome;
    if (points_->points().empty())
      out_.outcome = Outcome::Unreached;
    else if (out_.outcome == Outcome::Unreached)  // a product was, and the branch that was taken is not
      out_.outcome = Outcome::Closed;
  }

  void finish() {
    out_.where = points_;
    std::vector<LinearCondition> gradients;
    for (const Expr& relation : relations()) gradients.push_back({gradient(relation, problem_.states), relation});
    const std::size_t bound = gradients.empty() ? 0 : independent_conditions(gradients, points_->points()).size();
    out_.manifold_dimension = problem_.states.size() - bound;
    out_.on_manifold = with_zeros_of(*points_, out_.conditions);
    out_.rank = independent_conditions(out_.on_manifold, points_->points()).size();
  }

  ExprVector relations() const {
    ExprVector out = problem_.relations;
    for (const FoundConstraint& c : out_.constraints) out.push_back(c.value);
    return out;
  }

  const ConstraintProblem& problem_;
  std::vector<LinearCondition> weak_;  // the conditions, with 0 for what vanishes at the points
  mutable std::unordered_map<Expr, ExprVector, ExprHash> parts_;
  ExprVector derived_;  // constraints whose derivatives are among the conditions
  std::shared_ptr<const PointsWhere> points_;
  ConstraintChain out_;
};

}  // namespace

std::vector<LinearCondition> with_zeros_of(const PointsWhere& where, std::vector<LinearCondition> conditions) {
  std::unordered_map<Expr, bool, ExprHash> known;  // rows and their derivatives share many
  const auto vanishes = [&](Expr e) {
    const auto [place, is_new] = known.emplace(e, false);
    // What a switch holds at 0 on its one side is no zero of the manifold.
    if (is_new) place->second = where.vanishes(e) == Verdict::Zero && switches_of({&e, 1}).empty();
    return place->second;
  };
  for (LinearCondition& c : conditions)
    for (Expr& e : c.coefficients)
      if (!e.is_number() && vanishes(e)) e = e.context().number(0);
  return conditions;
}

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
