#include "equations/degenerate/lagrange_problem.hpp"
#include "equations/row_reduction.hpp"

#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/degenerate.hpp>
#include <maupertuis/linear_system.hpp>
#include <maupertuis/transform.hpp>

#include <algorithm>

namespace maupertuis {
namespace {

/// (q̈, λ) = Σ_f (free)_f direction_f + particular.
struct Accelerations {
  ExprVector particular;               // [n + m]; free ones 0
  std::vector<std::size_t> free;       // of the unknowns
  std::vector<ExprVector> directions;  // [free][n + m]
};

/// The start on all that a motion fulfils; what is written moves only if there is no other way. Nothing where the rank
/// of the equations is less there than around it.
std::optional<Bindings> settled(const EquationsOfMotion& equations, const DegenerateAnalysis& analysis,
                                const Bindings& start) {
  MotionState state;
  std::vector<bool> fixed_q, fixed_v;
  for (const Coordinate& c : equations.system->coordinates) {
    state.q.push_back(start.at(c.q)), fixed_q.push_back(start.at(c.q) != 0);
    state.v.push_back(start.at(c.velocity)), fixed_v.push_back(start.at(c.velocity) != 0);
  }
  state.t = start.at(equations.system->context->time());
  if (StateRelations(equations, analysis).settle(state, fixed_q, fixed_v) != Settled::Near) return std::nullopt;
  Bindings out = start;
  for (std::size_t i = 0; i < state.q.size(); ++i) {
    out[equations.system->coordinates[i].q] = state.q[i];
    out[equations.system->coordinates[i].velocity] = state.v[i];
  }
  const std::size_t rank = independent_conditions(analysis.chain.on_manifold, {out}).size();
  return rank == analysis.chain.rank ? std::optional(out) : std::nullopt;
}

/// Unknowns that may be any function of time; where the others would not be determined at the start, other ones.
std::vector<std::size_t> open_at_start(const DegenerateAnalysis& analysis) {
  const auto& all = analysis.chain.on_manifold;
  std::vector<std::size_t> open = open_unknowns(all, analysis.chain.where->points());
  if (!analysis.start || open.empty()) return open;
  std::vector<LinearCondition> bound = all;
  for (LinearCondition& row : bound)
    for (const std::size_t j : open) row.coefficients[j] = row.rest.context().number(0);
  if (independent_conditions(bound, {*analysis.start}).size() == analysis.chain.rank) return open;
  std::vector<std::size_t> other = most_open_unknowns(all, open.size(), *analysis.start);
  return other.size() == open.size() ? other : open;
}

class Orbits {
 public:
  Orbits(const ConstraintProblem& problem, const DegenerateAnalysis& analysis, std::size_t coordinates)
      : problem_(problem),
        analysis_(analysis),
        n_(coordinates),
        context_(problem.states.front().context()),
        solved_(accelerations()) {}

  /// The smallest set of directions that holds those of the free accelerations and is closed under brackets with the
  /// motion and among itself.
  std::vector<StateDirection> directions() {
    if (!solved_) return {};
    const auto n = static_cast<std::ptrdiff_t>(n_);
    ExprVector motion(problem_.states.begin() + n, problem_.states.end());
    motion.insert(motion.end(), solved_->particular.begin(), solved_->particular.begin() + n);
    for (std::size_t k = 0; k < solved_->free.size(); ++k) {
      if (solved_->free[k] >= n_) continue;  // a multiplier: redundant constraints leave the motion as it is
      const ExprVector& d = solved_->directions[k];
      StateDirection of_velocities(n_, context_.number(0));
      of_velocities.insert(of_velocities.end(), d.begin(), d.begin() + n);
      add(std::move(of_velocities));
    }
    for (std::size_t k = 0; k < found_.size() && found_.size() < 2 * n_; ++k) {
      add(bracket(motion, found_[k], true));
      for (std::size_t j = 0; j < k; ++j) add(bracket(found_[j], found_[k], false));
    }
    return found_;
  }

  /// The unknowns by their names, as functions of the state and of the free ones among them.
  ExprMap motion(const ExprVector& unknowns) const {
    ExprMap out;
    for (std::size_t i = 0; solved_ && i < unknowns.size(); ++i) {
      ExprVector terms{solved_->particular[i]};
      for (std::size_t k = 0; k < solved_->free.size(); ++k)
        terms.push_back(solved_->directions[k][i] * unknowns[solved_->free[k]]);
      out.emplace(unknowns[i], context_.sum(terms));
    }
    return out;
  }

 private:
  std::optional<Accelerations> accelerations() const {
    const auto& all = analysis_.chain.on_manifold;
    const auto& points = analysis_.chain.where->points();
    const std::vector<std::size_t> rows = independent_conditions(all, points), open = open_at_start(analysis_);
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
      return solved ? std::optional(out) : std::nullopt;
    };
    Accelerations out;
    const auto particular = solve(std::nullopt);
    if (!particular) return std::nullopt;
    out.particular = *particular;
    for (const std::size_t f : open) {
      const auto direction = solve(f);
      if (!direction) return std::nullopt;
      out.free.push_back(f);
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
    const PointsWhere& where = *analysis_.chain.where;
    if (independent_conditions(with_zeros_of(where, std::move(rows)), where.points()).size() == found_.size() + 1)
      found_.push_back(std::move(direction));
  }

  const ConstraintProblem& problem_;
  const DegenerateAnalysis& analysis_;
  std::size_t n_;
  Context& context_;
  std::optional<Accelerations> solved_;
  std::vector<StateDirection> found_;
};

}  // namespace

bool DegenerateAnalysis::is_determined(Expr e) const {
  if (orbits.empty()) return true;
  const Expr of_motion = substitute(expand_time_derivatives(e), motion);
  for (const Expr& s : symbols_of({&of_motion, 1})) {
    const bool is_unknown = s.role() == Role::Multiplier || (s.role() == Role::Coordinate && s.order() > 1);
    if (is_unknown && chain.where->vanishes(differentiate(of_motion, s)) != Verdict::Zero) return false;
  }
  const ExprVector slopes = gradient(of_motion, states);
  for (const StateDirection& direction : orbits) {
    ExprVector terms;
    for (std::size_t i = 0; i < states.size(); ++i) terms.push_back(slopes[i] * direction[i]);
    if (chain.where->vanishes(e.context().sum(terms)) != Verdict::Zero) return false;
  }
  return true;
}

DegenerateAnalysis analyse_degenerate(const EquationsOfMotion& equations, const Bindings& center, bool with_gauges,
                                      bool hold_parameters, const Bindings* start) {
  const std::size_t n = equations.system->coordinates.size();
  if (with_gauges && !equations.system->gauges.empty()) {
    DegenerateAnalysis open = analyse_degenerate(equations, center, false, hold_parameters, start);
    if (open.closed() && open.free.empty()) {  // nothing to choose: what the gauges say need not be followed
      open.gauges = equations.system->gauges.size();
      return open;
    }
  }
  ConstraintProblem problem = lagrange_problem(equations, with_gauges);
  problem.center = center;
  if (start) problem.start = *start;
  problem.hold_parameters = hold_parameters;
  DegenerateAnalysis out;
  out.states = problem.states;
  out.gauges = with_gauges ? equations.system->gauges.size() : 0;
  out.chain = constraint_algorithm(problem);
  if (!out.closed()) return out;
  if (start) out.start = settled(equations, out, *start);
  for (const std::size_t j : open_at_start(out))
    if (j < n) out.free.push_back(j);
  if (!out.free.empty()) {
    Orbits orbits(problem, out, n);
    out.orbits = orbits.directions();
    ExprVector unknowns;
    for (const Coordinate& c : equations.system->coordinates) unknowns.push_back(c.acceleration);
    unknowns.insert(unknowns.end(), equations.multipliers.begin(), equations.multipliers.end());
    out.motion = orbits.motion(unknowns);
  }
  out.motions = out.chain.manifold_dimension - out.orbits.size();
  return out;
}

}  // namespace maupertuis
