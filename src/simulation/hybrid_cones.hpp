#pragma once
#include "simulation/contact/cone_forces.hpp"
#include "simulation/hybrid_choices.hpp"

#include <optional>
#include <span>
#include <vector>

namespace maupertuis::hybrid {

/// A coefficient of friction for contacts that never slide, where their forces are sought.
inline constexpr double held_fast = 1e3;

/// A contact that touches and does not open.
struct Pressed {
  std::size_t contact;
  std::optional<SparseRow> sliding;  // what a unit of its normal force does with its friction, where it slides
};

/// Contacts that touch and do not open, as one problem over their cones, and frictions that hold along coordinates.
struct Cones {
  std::vector<std::size_t> contacts;
  std::vector<std::size_t> first;       // [contacts] of its rows
  std::vector<bool> slides;             // [contacts]
  std::vector<SparseRow> rows, forces;  // ∂g/∂q, ∂v_t/∂q̇ of those at rest; what a unit of each force does
  std::vector<SparseRow> held;          // ∂v_t/∂q̇ of frictions of coordinates that hold without a limit
  Eigen::MatrixXd response;             // of q̈ to the forces
  ConeProblem problem;
};

/// What forces of which `response` [n × columns] is made do along rows [rows × columns].
Eigen::MatrixXd along_rows(const std::vector<SparseRow>& rows, const Eigen::MatrixXd& response);

/// The cones of the contacts that press at a place.
class ContactCones {
 public:
  ContactCones(const Problem& problem, const State& here, const UsualSizes& sizes, const SpaceSlips& slips,
               const Choices& choices)
      : problem_(problem), here_(here), sizes_(sizes), slips_(slips), choices_(choices) {}

  /// Contacts that touch and do not open, with the friction that they have here.
  std::vector<Pressed> pressed_of(const std::vector<std::size_t>& touching, const ContactValues& values) const;
  /// Closed contacts of a mode.
  std::vector<Pressed> pressed_in(const ContactMode& mode, const ContactValues& values) const;
  Cones of(const std::vector<Pressed>& pressed, const ContactValues& values,
           std::span<const double> accelerations) const;
  /// `holding`: frictions of coordinates whose forces are sought too. Those that hold in the mode `base`, the one with
  /// the given accelerations, are among what holds.
  Cones of(const std::vector<Pressed>& pressed, const std::vector<std::size_t>& holding, const ContactMode& base,
           const ContactValues& values, std::span<const double> accelerations) const;

 private:
  const Problem& problem_;
  const State& here_;
  const UsualSizes& sizes_;
  const SpaceSlips& slips_;
  const Choices& choices_;
};

}  // namespace maupertuis::hybrid
