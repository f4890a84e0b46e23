#include "comparison/motions.hpp"

#include "comparison/pull_back.hpp"

#include <maupertuis/switches.hpp>

#include <algorithm>
#include <random>

namespace maupertuis::comparison {
namespace {

constexpr int states_wanted = 4, attempts = 40;

}  // namespace

Motions::Motions(const Model& model, const EquationsOfMotion& equations) : model_(model), equations_(equations) {
  const MechanicalSystem& system = model.system;
  for (const Constraint& c : system.constraints)
    if (c.level == Constraint::Level::Position) relations_.push_back(c.value);
  const ExprVector balance = equations.balance();
  for (const auto* list : {&equations.constraint_rates, &equations.constraint_accelerations, &balance})
    relations_.insert(relations_.end(), list->begin(), list->end());
  relations_ = with_constants_as_numbers(
      system, expand_time_derivatives(in_terms_of_motion(system, expand_time_derivatives(relations_))));
  if (!system.constrained()) {
    if (const auto solved = maupertuis::accelerations(relations_, system)) {
      accelerations_.emplace();
      for (std::size_t i = 0; i < solved->size(); ++i)
        accelerations_->emplace(system.coordinates[i].acceleration, (*solved)[i]);
    }
  }
  find_states();
}

Bindings Motions::at(const MotionState& state) const {
  Bindings out = parameter_bindings(model_.system);
  for (std::size_t i = 0; i < model_.system.coordinates.size(); ++i) {
    out[model_.system.coordinates[i].q] = state.q[i];
    out[model_.system.coordinates[i].velocity] = state.v[i];
  }
  out[model_.system.context->time()] = state.t;
  return out;
}

void Motions::find_states() {
  Diagnostics told_elsewhere;
  const auto start = consistent_start(model_, equations_, told_elsewhere);
  if (!start) return;
  states_.push_back(start->state);
  const std::size_t n = model_.system.coordinates.size();
  std::mt19937_64 random(0x6d617570);
  const auto uniform = [&] { return 2 * std::generate_canonical<double, 53>(random) - 1; };
  const bool constrained = model_.system.constrained();
  const ConstraintManifold manifold(equations_);
  for (int k = 0; k < attempts && states_.size() < states_wanted; ++k) {
    MotionState state = start->state;
    for (std::size_t i = 0; i < n; ++i) {
      state.q[i] += 0.3 * (std::abs(state.q[i]) > 1e-12 ? std::abs(state.q[i]) : 1) * uniform();
      state.v[i] += 0.3 * (std::abs(state.v[i]) > 1e-12 ? std::abs(state.v[i]) : 1) * uniform();
    }
    state.t += 0.5 * uniform();
    const std::vector<bool> free(n, false);
    if (constrained && (!manifold.move_positions(state, free) || !manifold.move_velocities(state, free))) continue;
    states_.push_back(std::move(state));
  }
}

ZeroTest Motions::vanish(std::span<const Expr> functions) const {
  if (accelerations_) {
    const ZeroTest exact = zero_test(substitute(functions, *accelerations_));
    if (exact.verdict != Verdict::Undecided) return exact;
  }
  return at_points(functions);
}

ZeroTest Motions::vanish_for_given_signs(std::span<const Expr> functions) const {
  if (accelerations_) {
    const ExprVector put_in = substitute(functions, *accelerations_);
    const ZeroTest exact = maupertuis::vanish_for_given_signs(model_.system, put_in);
    if (exact.verdict != Verdict::Undecided) return exact;
  }
  return at_points(functions);
}

ZeroTest Motions::vanish_at_these_values(std::span<const Expr> functions) const {
  if (!accelerations_) return at_points(functions);
  ExprMap values;
  for (const Parameter& p : model_.system.parameters) values.emplace(p.symbol, p.value);
  return zero_test(substitute(substitute(functions, *accelerations_), values));
}

ZeroTest Motions::constraints_vanish(std::span<const Expr> functions) const {
  ZeroTest exact;
  exact.error_bound = 0;
  for (const Expr& f : functions) {
    ZeroTest best = zero_test(f);
    for (const Constraint& c : model_.system.constraints) {
      if (best.verdict == Verdict::Zero) break;
      const Expr own =
          with_constants_as_numbers(model_.system, in_terms_of_motion(model_.system, {&c.value, 1})).front();
      for (const Expr& difference : {f - own, f + own})
        if (best.verdict != Verdict::Zero) best = zero_test(difference);
    }
    if (best.verdict != Verdict::Zero) return vanish(functions);
    if (exact.verdict != Verdict::Zero || best.points < exact.points) exact.points = best.points;
    exact.verdict = Verdict::Zero;
    exact.error_bound += best.error_bound;
  }
  return exact;
}

ZeroTest Motions::at_points(std::span<const Expr> functions) const {
  ZeroTest nothing;
  nothing.reason = "no state was found at which the constraints of the second model hold";
  if (states_.empty()) return nothing;
  Bindings center = at(states_.front());
  ExprVector unknowns = equations_.multipliers;
  for (const Coordinate& c : model_.system.coordinates) {
    unknowns.insert(unknowns.end(), {c.q, c.velocity, c.acceleration});
    center[c.acceleration] = 0;
  }
  for (const Expr& multiplier : equations_.multipliers) center[multiplier] = 0;
  ZeroTest all = zero_test_where(functions, relations_, unknowns, center);
  for (const Bindings& branch : centers(functions, center)) {
    if (all.verdict != Verdict::Zero) break;
    // No point in a branch: the constraints do not reach it.
    const ZeroTest there = zero_test_where(functions, relations_, unknowns, branch);
    if (there.verdict == Verdict::Nonzero) return there;
    if (there.verdict == Verdict::Zero) all.points += there.points;
  }
  return all;
}

std::vector<MotionState> Motions::states_in_branches(std::span<const Expr> functions) const {
  std::vector<MotionState> out;
  if (model_.system.constrained() || states_.empty()) return out;
  const ExprVector moved =
      accelerations_ ? substitute(functions, *accelerations_) : ExprVector(functions.begin(), functions.end());
  for (const Bindings& point : centers(moved, at(states_.front()))) {
    MotionState state{point.at(model_.system.context->time()), {}, {}};
    for (const Coordinate& c : model_.system.coordinates)
      state.q.push_back(point.at(c.q)), state.v.push_back(point.at(c.velocity));
    out.push_back(std::move(state));
  }
  return out;
}

/// Points in the branches of the switches between positions, velocities and time.
std::vector<Bindings> Motions::centers(std::span<const Expr> functions, const Bindings& start) const {
  ExprVector all(functions.begin(), functions.end());
  all.insert(all.end(), relations_.begin(), relations_.end());
  SwitchSearch search;
  search.center = start;
  for (const Coordinate& c : model_.system.coordinates) search.moving.insert(search.moving.end(), {c.q, c.velocity});
  search.moving.push_back(model_.system.context->time());
  ExprVector switches;
  for (const Expr& g : switches_of(all)) {
    const std::vector<Expr> symbols = symbols_of({&g, 1});
    const auto moves = [&](Expr s) {
      return std::find(search.moving.begin(), search.moving.end(), s) != search.moving.end();
    };
    const auto knows = [&](Expr s) { return moves(s) || (start.count(s) != 0 && s.role() != Role::Coordinate); };
    if (std::any_of(symbols.begin(), symbols.end(), moves) && std::all_of(symbols.begin(), symbols.end(), knows))
      switches.push_back(g);
  }
  return points_in_branches(switches, search).points;
}

}  // namespace maupertuis::comparison
