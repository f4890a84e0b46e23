#include "equations/degenerate/lagrange_problem.hpp"
#include "equations/row_reduction.hpp"

#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/degenerate.hpp>
#include <maupertuis/linear_system.hpp>
#include <maupertuis/transform.hpp>

#include <algorithm>

namespace maupertuis {
namespace {

/// (q̈, λ) = Σ_f (free)_f direction_f + particular, of which the first n components are kept.
struct Accelerations {
  ExprVector particular;               // [n]; free ones 0
  std::vector<ExprVector> directions;  // [free][n]
};

class Orbits {
 public:
  Orbits(const ConstraintProblem& problem, const DegenerateAnalysis& analysis, std::size_t coordinates)
      : problem_(problem), analysis_(analysis), n_(coordinates), context_(problem.states.front().context()) {}

  /// The smallest set of directions that holds those of the free accelerations and is closed under brackets with the
  /// motion and among itself.
  std::vector<StateDirection> directions() {
    const std::optional<Accelerations> solved = accelerations();
    if (!solved) return {};
    ExprVector motion(problem_.states.begin() + static_cast<std::ptrdiff_t>(n_), problem_.states.end());
    motion.insert(motion.end(), solved->particular.begin(), solved->particular.end());
    for (const ExprVector& d : solved->directions) {
      StateDirection of_velocities(n_, context_.number(0));
      of_velocities.insert(of_velocities.end(), d.begin(), d.end());
      add(std::move(of_velocities));
    }
    for (std::size_t k = 0; k < found_.size() && found_.size() < 2 * n_; ++k) {
      add(bracket(motion, found_[k], true));
      for (std::size_t j = 0; j < k; ++j) add(bracket(found_[j], found_[k], false));
    }
    return found_;
  }

 private:
  std::optional<Accelerations> accelerations() const {
    const auto& all = analysis_.chain.conditions;
    const auto& points = analysis_.chain.where->points();
    const std::vector<std::size_t> rows = independent_conditions(all, points), open = open_unknowns(all, points);
    std::vector<std::size_t> bound;
    const std::size_t unknowns = all.front().coefficients.size();
    for (std::size_t j = 0; j < unknowns; ++j)
      if (std::find(open.begin(), open.end(), j) == open.end()) bound.push_back(j);
    if (bound.size() != rows.size()) return std::nullopt;
    const auto solve = [&](const std::optional<std::size_t> of) {
      ExprMatrix system{rows.size(), rows.size() + 1, {}};
      for (const std::size_t r : rows) {
        for (const std::size_t j : bound) system.entries.push_back(all[r].coefficients[j]);
        system.entries.push_back(of ? -all[r].coefficients[*of] : -all[r].rest);
      }
      ExprVector out(unknowns, context_.number(0));
      if (of) out[*of] = context_.number(1);
      const auto solved = rows.empty() ? std::optional(ExprVector{}) : solve_linear(system);
      for (std::size_t j = 0; solved && j < bound.size(); ++j) out[bound[j]] = (*solved)[j];
      out.resize(n_);
      return solved ? std::optional(out) : std::nullopt;
    };
    Accelerations out;
    const auto particular = solve(std::nullopt);
    if (!particular) return std::nullopt;
    out.particular = *particular;
    for (const std::size_t f : open) {
      if (f >= n_) continue;  // a multiplier: redundant constraints leave the motion as it is
      const auto direction = solve(f);
      if (!direction) return std::nullopt;
      out.directions.push_back(*direction);
    }
    return out;
  }

  /// [a, b]^i = a(b^i) − b(a^i); a may be the motion, along which the time goes on.
  StateDirection bracket(const StateDirection& a, const StateDirection& b, bool in_time) const {
    StateDirection out;
    for (std::size_t i = 0; i < b.size(); ++i) {
      ExprVector terms;
      const ExprVector of_b = gradient(b[i], problem_.states), of_a = gradient(a[i], problem_.states);
      for (std::size_t j = 0; j < b.size(); ++j) {
        terms.push_back(a[j] * of_b[j]);
        terms.push_back(-(b[j] * of_a[j]));
      }
      if (in_time) terms.push_back(differentiate(b[i], context_.time()));
      out.push_back(context_.sum(terms));
    }
    return out;
  }

  void add(StateDirection direction) {
    std::vector<LinearCondition> rows;
    for (const StateDirection& known : found_) rows.push_back({known, context_.number(0)});
    rows.push_back({direction, context_.number(0)});
    if (independent_conditions(rows, analysis_.chain.where->points()).size() == rows.size())
      found_.push_back(std::move(direction));
  }

  const ConstraintProblem& problem_;
  const DegenerateAnalysis& analysis_;
  std::size_t n_;
  Context& context_;
  std::vector<StateDirection> found_;
};

}  // namespace

bool DegenerateAnalysis::is_determined(Expr e) const {
  if (orbits.empty()) return true;
  const ExprVector slopes = gradient(expand_time_derivatives(e), states);
  for (const StateDirection& direction : orbits) {
    ExprVector terms;
    for (std::size_t i = 0; i < states.size(); ++i) terms.push_back(slopes[i] * direction[i]);
    if (chain.where->vanishes(e.context().sum(terms)) != Verdict::Zero) return false;
  }
  return true;
}

DegenerateAnalysis analyse_degenerate(const EquationsOfMotion& equations, const Bindings& center, bool with_gauges,
                                      bool hold_parameters) {
  const std::size_t n = equations.system->coordinates.size();
  ConstraintProblem problem = lagrange_problem(equations, with_gauges);
  problem.center = center;
  problem.hold_parameters = hold_parameters;
  DegenerateAnalysis out;
  out.states = problem.states;
  out.gauges = with_gauges ? equations.system->gauges.size() : 0;
  out.chain = constraint_algorithm(problem);
  if (!out.closed()) return out;
  for (const std::size_t j : open_unknowns(out.chain.conditions, out.chain.where->points()))
    if (j < n) out.free.push_back(j);
  if (!out.free.empty()) out.orbits = Orbits(problem, out, n).directions();
  out.motions = out.chain.manifold_dimension - out.orbits.size();
  return out;
}

}  // namespace maupertuis
