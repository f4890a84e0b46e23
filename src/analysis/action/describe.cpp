#include "analysis/action/fields.hpp"
#include "analysis/action/inertia.hpp"
#include "analysis/action/kinks.hpp"
#include "analysis/action/problem.hpp"

#include <maupertuis/degenerate.hpp>
#include <maupertuis/switch_text.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace maupertuis::action {
namespace {

/// p and h_E at an end of the path, of L + Σ λ G.
void momentum_at(Functional& functional, const Trial& trial, const MotionState& s, std::vector<double>& p,
                 std::optional<double>& energy) {
  Density density;
  functional.evaluate(s.t, s.q.data(), s.v.data(), trial.multipliers, 1, density);
  const Index n = functional.freedoms();
  if (!density.finite) {
    p.assign(static_cast<std::size_t>(n), std::numeric_limits<double>::quiet_NaN());
    return;
  }
  p.assign(density.gradient.data() + n, density.gradient.data() + 2 * n);
  energy = density.gradient.tail(n).dot(Eigen::Map<const Vector>(s.v.data(), n)) - density.lagrangian -
           trial.multipliers.dot(density.integrals);
}

/// The count of Jacobi fields against that of the discretized second variation. Where the end itself is conjugate, what
/// one of them sees inside the other may see at the end.
void combine(const Inertia& inertia, const FieldStudy& fields, bool only_fixed, SecondVariation& out) {
  out.by_inertia = inertia.negative;
  out.nullity = inertia.nullity;
  out.nearest = inertia.nearest;
  if (!fields.reason.empty()) {
    out.reason = "The count by Jacobi fields could not be done: " + fields.reason;
    return;
  }
  out.conjugate = fields.inside;
  out.concavity = fields.concavity;
  if (!only_fixed && !fields.concavity) {
    out.reason = "The end is conjugate to the start, so that Jacobi fields do not tell what its freedom adds.";
    return;
  }
  out.by_fields = fields.count() + fields.concavity.value_or(0);
  if (*out.by_fields == *out.by_inertia)
    out.index = out.by_inertia;
  else
    out.reason = fmt::format("The two counts of the index disagree: {} by inertia, {} by Jacobi fields.",
                             *out.by_inertia, *out.by_fields);
}

std::string no_index_without_convexity(const Problem& problem) {
  const bool higher = problem.functional.orders().higher();
  if (problem.equations.degenerate && !higher)
    return "L is degenerate: M = ∂²L/∂q'∂q' is singular along the path, and there is no Morse index.";
  return fmt::format(
      "M = {} is not positive definite along the path: neighbours that oscillate fast lower the action without end, "
      "and there is no Morse index.",
      higher ? "∂²L/∂q''∂q''" : "∂²L/∂q'∂q'");
}

/// Elements that follow the path may be too long for its neighbours: a rest is followed by a few, and neighbours swing
/// about it many times. The count on ever finer ones, where it only grows (Ritz), until it stays.
Inertia inertia_of_finer(Functional& functional, const Trial& coarse, const FixedEnds& fixed, const Vector& least,
                         Inertia found) {
  constexpr Index most_elements = 800;
  Trial trial = coarse;
  while (2 * trial.mesh.elements() <= most_elements) {
    trial = halved(trial, std::vector<bool>(static_cast<std::size_t>(trial.mesh.elements()), true));
    const Inertia finer = inertia_of(functional, trial, fixed, least);
    const bool stays = finer.negative == found.negative && finer.nullity == found.nullity;
    found = finer;
    if (stays) break;
  }
  return found;
}

void fill_second(Problem& problem, const Refined& refined, const FixedEnds& fixed, const Vector& least,
                 const SingularEnds& singular, const ActionOptions& options, StationaryPath& out) {
  const Trial& trial = refined.coarse;
  const bool can_be_carried =
      problem.functional.integrals() == 0 && !singular.any() && !has_free_functions(problem.equations);
  const auto carry_alone = [&] {
    if (can_be_carried)
      out.check =
          carried_along(problem.equations, problem.equations.lagrangian_expanded, trial, least, options.interrupt);
  };
  if (!convex_along(problem.functional, trial)) {
    out.second.reason = no_index_without_convexity(problem);
    return carry_alone();
  }
  const Inertia inertia = inertia_of(problem.functional, trial, fixed, least);
  const auto weighted = weighted_equations(problem.equations, trial.multipliers);
  FieldStudy fields;
  if (weighted)
    fields = jacobi_fields(problem.functional, *weighted, problem.equations.lagrangian_expanded, trial, refined.states,
                           fixed, singular.start, singular.end, least, options.interrupt);
  else
    fields.reason = fields.check.reason = "The equations of L + λ G could not be made.";
  const bool only_fixed = all_fixed(problem.functional, trial, fixed);
  combine(inertia, fields, only_fixed, out.second);
  if (out.second.by_fields && !out.second.index) {
    out.second = {};
    combine(inertia_of_finer(problem.functional, trial, fixed, least, inertia), fields, only_fixed, out.second);
  }
  out.check = fields.check;
  if (!out.check.done) carry_alone();  // neighbours may be lost where the motion itself is not
}

std::string no_index_at(const KinkPassed& kink, const Problem& problem) {
  const std::string where = switch_text(kink.difference, problem.equations.order);
  return fmt::format(
      "The path passes a kink of L{} near {}, where the second variation has a part that the counts do not know: "
      "there is no index.",
      where.empty() ? "" : ", " + where + ",", place(kink.t, problem.model.system));
}

/// What S may differ by for nothing: rounding of its terms, of a path at rest of those of one that crosses its size in
/// its time; and p·δq at the ends of the stretches, where the motion misses the path.
double harmless_difference(const StationaryPath& p, Functional& functional, const Trial& trial, const Vector& least) {
  constexpr double usual = 1e-9;  // of the terms
  const Vector size = even_scale(trial, least).col(0), v = size / std::abs(trial.mesh.whole);
  const MotionState first = p.path.at(p.path.start);
  const double crossing =
      functional.sensitivity(first.t, first.q.data(), v.data(), trial.multipliers).terms * std::abs(trial.mesh.whole);
  double by_misses = 0;
  for (const std::vector<double>* momenta : {&p.start_momentum, &p.end_momentum})
    for (std::size_t i = 0; i < momenta->size(); ++i)
      if (std::isfinite((*momenta)[i]))
        by_misses += std::abs((*momenta)[i]) * size[static_cast<Index>(i)] * p.check.missed * p.check.stretches;
  return usual * std::max(size_of_action(functional, trial), std::isfinite(crossing) ? crossing : 0) + by_misses;
}

/// W1203 where the motion from the path's own states does something else than the path: the polynomials of its elements
/// do not see what is narrower than they are. S is then not better known than by the two.
void compare_with_motion(StationaryPath& p, double harmless, Diagnostics& diagnostics) {
  constexpr double usual = 1e-9, beyond = 1e4;  // of the size; of the errors of the path and of S
  const MotionCheck& c = p.check;
  if (!c.done || c.from != p.path.start || c.to != p.path.end) return;
  const double off = std::abs(c.action - p.action);
  const bool elsewhere = c.missed > usual && c.missed > beyond * p.path_error;
  const bool other_action = off > harmless && off > beyond * p.action_error;
  if (!elsewhere && !other_action) return;
  p.action_error = std::max(p.action_error, off);
  p.path_error = std::max(p.path_error, c.missed);
  if (elsewhere) p.second = {}, p.second.reason = "The motion from the path's own states leaves it.";
  diagnostics.warning(
      "W1203", {},
      fmt::format("the motion from its own states is off this path by {:.1g} of its size, and its S by {:.1g}",
                  c.missed, off),
      "The motion is followed by steps that pass over nothing; the path is polynomials between points. Something "
      "narrower than the distance of these points acts on it, or it is as sensitive as that.",
      "Trust S and the path no further than that; a path that passes the narrow place in two parts, or a larger width, "
      "shows it.");
}

}  // namespace

StationaryPath describe(Problem& problem, const Refined& refined, const ActionEnds& ends, const SingularEnds& singular,
                        const ActionOptions& options, Diagnostics& diagnostics) {
  StationaryPath out;
  const Trial& fine = refined.fine;
  out.path = to_path(fine);
  out.action = refined.action;
  out.action_error = refined.action_error;
  out.path_error = refined.path_error;
  out.residual = refined.correction;
  out.multipliers.assign(fine.multipliers.data(), fine.multipliers.data() + fine.multipliers.size());
  out.turns.assign(static_cast<std::size_t>(problem.n()), 0);
  const MotionState first = out.path.at(out.path.start), last = out.path.at(out.path.end);
  out.start_velocity = first.v;
  momentum_at(problem.functional, fine, first, out.start_momentum, out.start_energy);
  momentum_at(problem.functional, fine, last, out.end_momentum, out.end_energy);
  const FixedEnds fixed = fixed_of(ends);
  const Vector least = problem.least(&ends);
  if (const auto kink = kink_passed(out.path, problem.kinks, problem.model.system)) {
    out.second.reason = out.check.reason = no_index_at(*kink, problem);
    return out;
  }
  fill_second(problem, refined, fixed, least, singular, options, out);
  const bool disagree = out.second.by_inertia && out.second.by_fields && !out.second.index;
  if (disagree && out.check.done && out.check.missed > largest_miss)
    out.second.reason += fmt::format(
        " The motion, carried from stretch to stretch, misses the path by {:.1g} of its size: it is too sensitive "
        "here for either count.",
        out.check.missed);
  else if (disagree)
    diagnostics.warning("W1201", {}, "the two counts of a Morse index disagree", out.second.reason,
                        "No index is given for this path. Please report the model.");
  if (options.variations) out.second.variations = test_variations(problem, refined.coarse, fixed, least);
  if (!(out.check.missed > largest_miss))  // else it is left out
    compare_with_motion(out, harmless_difference(out, problem.functional, fine, least), diagnostics);
  return out;
}

}  // namespace maupertuis::action
