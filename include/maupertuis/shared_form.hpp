#pragma once
#include <maupertuis/transform.hpp>

#include <span>
#include <vector>

namespace maupertuis {

/// Rows that share large parts, every part with a name.
struct SharedForm {
  std::vector<Expr> rows;
  std::vector<Intermediate> intermediates;  // in order of use; those that were known before are not among them
};

/// Writes rows in which everything is coupled with everything, so that multiplied out they would have as many terms
/// each as there are coordinates: what stands in several places gets a name, once, and nothing is multiplied out. Of a
/// chain of pendulums the names are the velocities and accelerations of its points and the forces that run along it.
/// The length is proportional to the nodes below the rows. `known`: names that are given already.
SharedForm shared_form(std::span<const Expr> rows, const ReadingOrder& order, std::span<const Intermediate> known = {});

}  // namespace maupertuis
