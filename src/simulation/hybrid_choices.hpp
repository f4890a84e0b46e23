#pragma once
#include "simulation/hybrid_met.hpp"
#include "simulation/hybrid_problem.hpp"
#include "simulation/hybrid_sizes.hpp"
#include "simulation/hybrid_slips.hpp"

#include <cstdint>
#include <vector>

namespace maupertuis::hybrid {

/// What a contact or a friction may do next, the likeliest first.
struct Choice {
  struct Option {
    bool closed = false;
    FrictionState state = FrictionState::None;
    std::int8_t normal_sign = 1;
  };
  std::size_t contact = 0;  // or contacts + friction of a coordinate
  std::vector<Option> options;
};

/// What contacts and frictions may do next at an instant.
class Choices {
 public:
  Choices(const Problem& problem, const UsualSizes& sizes, const SpaceSlips& slips)
      : problem_(problem), sizes_(sizes), slips_(slips) {}

  /// Of contacts that touch and do not open, then of all frictions of coordinates.
  std::vector<Choice> at(const std::vector<std::size_t>& touching, const ContactValues& values, const Met& met) const;
  /// Of a contact that touches and does not open.
  Choice of_contact(std::size_t contact, const ContactValues& values, const Met& met) const;
  std::vector<Choice> of_coordinates(const ContactValues& values) const;

  ContactMode mode_of(const std::vector<Choice>& list, const std::vector<std::size_t>& taken) const;
  /// Friction of coordinates as is likeliest.
  ContactMode mode_without_contacts(const std::vector<Choice>& list) const;
  ContactMode mode_without_contacts(const ContactValues& values) const {
    return mode_without_contacts(of_coordinates(values));
  }

 private:
  const Problem& problem_;
  const UsualSizes& sizes_;
  const SpaceSlips& slips_;
};

}  // namespace maupertuis::hybrid
