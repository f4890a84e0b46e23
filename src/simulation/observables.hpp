#pragma once
#include <maupertuis/simulation.hpp>
#include <maupertuis/step.hpp>

#include <string>
#include <vector>

namespace maupertuis {

/// What a run evaluates besides the motion, in this order: the terms of h_E, the positions of the points, the reactions
/// of named constraints and releases (λ of constraints without a name), formulas that were asked beside the model, the
/// probes.
struct Observables {
  struct Named {
    std::string name;
    Dimension dimension;
  };
  /// An observable that holds the multiplier of a constraint.
  struct Dependence {
    std::size_t observable, constraint;
  };

  std::vector<Expr> expressions;
  std::size_t energy_terms = 0, points = 0, probes = 0;
  std::vector<bool> of_places;  // [energy_terms] it knows no velocity
  std::vector<Named> reactions, asked;
  std::vector<Dependence> dependences;
};

/// `asked`: formulas that are to be columns of the rows. One whose forces the equations do not hold is left out.
Observables collect_observables(const EquationsOfMotion& equations, const Probe* probe,
                                std::span<const AskedFormula> asked = {});

/// A row of a trajectory after t, at the end of `values`: q, q', the points, the reactions, what was asked, the energy.
void append_row(std::vector<double>& values, const Sample& sample, const Observables& observables);

/// What depends on a multiplier that the equations do not determine is no number.
void leave_out_undetermined(Sample& sample, const Observables& observables);

/// The columns of a trajectory after t: q, q', the points, the reactions (also on their own), what was asked, the
/// energy.
void name_trajectory_columns(const MechanicalSystem& system, const Observables& observables,
                             std::vector<Trajectory::Column>& columns, std::vector<Trajectory::Column>& reactions);

}  // namespace maupertuis
