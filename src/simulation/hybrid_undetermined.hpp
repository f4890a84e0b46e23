#pragma once
#include "simulation/hybrid_cones.hpp"
#include "simulation/hybrid_found.hpp"
#include "simulation/hybrid_motions.hpp"

#include <optional>
#include <string>
#include <vector>

namespace maupertuis::hybrid {

/// Contacts that hold each other where they rest (a ladder between rough walls, three rough feet), and frictions of
/// coordinates that constraints tie together (two blocks on a rod), have forces that the equations do not determine:
/// which they are, and some that keep the limits of friction.
class UndeterminedForces {
 public:
  UndeterminedForces(const Problem& problem, State& here, UsualSizes& sizes, ModeMotions& motions,
                     const ContactCones& cones, const Choices& choices)
      : problem_(problem), here_(here), sizes_(sizes), motions_(motions), cones_(cones), choices_(choices) {}

  /// Whether the others that are closed or stick leave a contact no slip.
  bool is_held(std::size_t contact, const ContactMode& mode, const ContactValues& values) const;
  /// Contacts and frictions whose forces at rest are sought, at most.
  std::size_t most_that_hold() const;
  /// The time over which forces are found that hold the rest in this mode, its end to rounding where it comes before
  /// the end of what is looked at; nothing where forces are determined, or none hold it.
  std::optional<double> rest_ahead(const ContactMode& mode, double bound);
  /// Forces that hold the rest now, and such as hold it `ahead`, with that power of time between them. Limits of
  /// friction are convex: where the forces of the system go with it too, their limits are kept all the way.
  std::optional<Given> preload_through(const ContactMode& mode, double ahead, int power, double bound);
  /// One sentence where there are more contacts and frictions than the motion needs: their forces are not unique, and
  /// what friction makes of them is not either. Else empty.
  std::string sentence(const std::vector<Choice>& list, const ContactMode& mode, const ContactValues& values) const;

 private:
  bool may_be_given(std::size_t friction) const;
  std::size_t number_that_hold(const ContactMode& mode) const;
  ContactMode mode_without_holding(const ContactMode& mode, std::vector<std::size_t>& holding) const;
  bool has_dependent_rows(const ContactMode& mode, const ContactValues& values) const;
  std::optional<std::vector<double>> forces_at_rest(const ContactMode& mode, const ContactValues& values, double bound);
  std::vector<double> ordered_forces(const ContactMode& mode, const Cones& cones, const Eigen::VectorXd& found,
                                     std::vector<double> of_constraints) const;
  std::optional<std::vector<double>> forces_later(const ContactMode& mode, double later, double bound);
  double longest_rest(const ContactMode& mode, double length, double bound);

  const Problem& problem_;
  State& here_;
  UsualSizes& sizes_;
  ModeMotions& motions_;
  const ContactCones& cones_;
  const Choices& choices_;
};

}  // namespace maupertuis::hybrid
