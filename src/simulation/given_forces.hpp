#pragma once
#include "simulation/mode_library.hpp"

#include <maupertuis/contact_mode.hpp>
#include <maupertuis/transform.hpp>

namespace maupertuis {

/// A mode whose contacts have forces that are given, by parameters that it adds to those of the model (ModeDetails).
class GivenForces {
 public:
  /// `own`: the system with its contacts, in the context of the mode; it stays, and gets the parameters.
  GivenForces(MechanicalSystem& own, const ContactMode& mode)
      : own_(own), in_mode_(system_in_mode(own, mode)), work_(own.coordinates.size(), own.context->number(0)) {}

  /// Along each closed contact, each friction that sticks and each constraint of the system a given force besides its
  /// multiplier, a polynomial of the time since a parameter (hybrid::Given).
  void preload(const ContactMode& mode);
  /// Friction of contact i with a direction that is a polynomial of time, of that degree. `rubbed`: what it takes.
  void direct(std::size_t i, int degree, ExprVector& rubbed);

  /// The system that moves.
  MechanicalSystem system();
  /// Of multipliers, the forces that they are part of, or that stand in their place.
  const ExprMap& all() const { return all_; }

 private:
  Expr parameter();
  Expr polynomial(int degree, Expr since);
  template <class Lever>
  void add(Expr force, Lever&& lever);
  void with_given_multipliers();

  MechanicalSystem& own_;
  MechanicalSystem in_mode_;
  ExprVector work_;  // [n] generalized forces
  ExprMap all_;
  std::size_t count_ = 0;
};

}  // namespace maupertuis
