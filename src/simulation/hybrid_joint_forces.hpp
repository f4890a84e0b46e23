#pragma once
#include "simulation/contact/contact_forces.hpp"
#include "simulation/hybrid_choices.hpp"
#include "simulation/hybrid_motions.hpp"

#include <optional>
#include <vector>

namespace maupertuis::hybrid {

/// Which of the modes that are possible the forces of all contacts together point to.
class JointForces {
 public:
  JointForces(const Problem& problem, const State& here, ModeMotions& motions, const Choices& choices)
      : problem_(problem), here_(here), motions_(motions), choices_(choices) {}

  /// The contacts of the list as they would move without their forces; nothing where that motion does not exist.
  std::optional<ContactForceProblem> problem_of(const std::vector<Choice>& list, const ContactValues& values,
                                                double bound);
  /// Puts what agrees with the forces first. Whether static friction leaves a choice: where several contacts begin to
  /// slide at once, and one of some can be held.
  bool order(std::vector<Choice>& list, const ContactValues& values, double bound);

 private:
  const Problem& problem_;
  const State& here_;
  ModeMotions& motions_;
  const Choices& choices_;
};

}  // namespace maupertuis::hybrid
