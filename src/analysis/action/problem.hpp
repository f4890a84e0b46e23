#pragma once
#include "analysis/action/refine.hpp"

#include <maupertuis/action.hpp>
#include <maupertuis/diagnostic.hpp>

#include <atomic>
#include <string>

/// What every question about the action begins with.
namespace maupertuis::action {

/// Whether the study is to end at once: then E1210.
bool interrupted(const ActionOptions& options, Diagnostics& diagnostics);

/// E1206: L is infinite or no number on the `curve`, "path" or "motion".
void diagnose_infinite_lagrangian(std::string_view curve, Diagnostics& diagnostics);

/// False with E1201: forces that no Lagrangian gives, constraints between velocities.
bool has_action(const EquationsOfMotion& equations, Diagnostics& diagnostics);

/// One action with its ends, in numbers.
struct Problem {
  Problem(const Model& model, const EquationsOfMotion& equations);

  const Model& model;
  const EquationsOfMotion& equations;
  Functional functional;
  std::shared_ptr<const Rule> rule;
  std::vector<Expr> kinks;  // of L: what no count of the index knows
  Vector typical;           // [n] how large coordinates are, before a path is known

  Index n() const { return functional.freedoms(); }
  double number(Expr e) const;
  /// Below these sizes nothing is resolved: a thousandth of the typical ones, or the way between the ends.
  Vector least(const ActionEnds* ends) const;
  /// How many elements a path of this duration needs at first, by the largest frequency along it.
  Index first_elements(const Trial& trial) const;
  SingularEnds singular_ends(const ActionEnds& ends);
};

FixedEnds fixed_of(const ActionEnds& ends);
std::string with_unit(double value, const std::string& unit);
/// "s", or the unit of another independent variable; empty for bare numbers.
std::string unit_of_independent(const MechanicalSystem& system);
/// E1203 where a path does not run from an earlier end to a later one, at a finite distance; false then.
bool check_order(double start, double end, const MechanicalSystem& system, std::optional<Span> span,
                 Diagnostics& diagnostics);
/// "t = 2 s"
std::string place(double t, const MechanicalSystem& system);

/// Moves every node onto φ = 0; false where that does not work.
bool move_onto_constraints(Functional& functional, Trial& trial, const FixedEnds& fixed, const Matrix& scale);

/// Of the size of a path: where motions from its states miss it by more, Jacobi fields along it are those of some other
/// motion, and a path that was searched is none.
constexpr double largest_miss = 1e-3;

/// All that is said of one stationary path. `refined.coarse` is what the second variation is taken on.
StationaryPath describe(Problem& problem, const Refined& refined, const ActionEnds& ends, const SingularEnds& singular,
                        const ActionOptions& options, Diagnostics& diagnostics);
/// S on neighbours of a path; ends that are fixed stay.
std::vector<TestVariation> test_variations(Problem& problem, const Trial& trial, const FixedEnds& fixed,
                                           const Vector& least);

}  // namespace maupertuis::action
