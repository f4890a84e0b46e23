#pragma once
#include "analysis/linearization/branch_follower.hpp"

#include <optional>

/// What a sweep does with the branches that its values have given (`parameter_locus`).
namespace maupertuis {

/// The value of the sweep before or after that of a point; nothing beyond its ends, and of points between.
std::optional<double> value_next_to(const Locus& locus, double value, bool before);
/// The branch that has a point there.
std::optional<std::size_t> branch_at(const BranchFollower& follow, const Locus& locus, double value,
                                     const Equilibrium& x);
/// A search can miss a branch at some values, one that begins far from the start for instance: from where it was met it
/// is followed to the values before (`front`), or after.
void extend_branch(BranchFollower& follow, Locus& locus, std::size_t branch, bool front);

/// Folds of branches of rests, and the arms beyond them (`locus_folds.cpp`).
void find_folds(BranchFollower& follow, Locus& locus);

/// Windows narrower than the step (`locus_windows.cpp`): a point within each is added to its branch.
void look_between(BranchFollower& follow, Locus& locus);

/// Where verdicts change, and branches that begin there (`locus_changes.cpp`).
void find_changes(BranchFollower& follow, Locus& locus);

}  // namespace maupertuis
