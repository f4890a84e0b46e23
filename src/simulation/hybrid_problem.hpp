#pragma once
#include "simulation/mode_library.hpp"

#include <maupertuis/integrator.hpp>

#include <memory>
#include <string>
#include <vector>

/// The parts of HybridMotion (README.md says who asks whom).
namespace maupertuis::hybrid {

using Outlook = TaylorStepper::Outlook;

/// What is moved: the same for the whole run.
struct Problem {
  Problem(std::shared_ptr<ModeLibrary> programs, std::vector<double> values, const TaylorOptions& steps);

  std::shared_ptr<ModeLibrary> library;
  const Model& model;
  const EquationsOfMotion& equations;
  const MechanicalSystem& system;  // with reactions in normal forces put in
  std::vector<double> parameters;  // [p]
  TaylorOptions options;
  bool in_space = false;             // a contact has friction in space
  std::vector<bool> keeps_friction;  // [contacts] its coefficients stay what they are, whatever moves
  /// A companion, whose difference tells the error, meets roots that rounding hides later by what it may hide of them:
  /// the roots of conditions that end a rest or a contact so slowly are found at the same place by all.
  bool meets_late = false;

  /// Whether a contact has friction: with a coefficient that is 0 throughout it is smooth, and holds no rest.
  bool rubs(std::size_t contact, const ContactValues& values) const;
  /// Of a contact, or of the coordinate of a friction.
  std::string label_of(std::size_t place) const;
  std::vector<std::string> labels_of(std::vector<std::size_t> places) const;  // in the order of the text
  bool interrupted() const;
};

}  // namespace maupertuis::hybrid
