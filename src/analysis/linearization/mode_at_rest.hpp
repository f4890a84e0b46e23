#pragma once
#include "analysis/linearization/shared_forces.hpp"

#include <maupertuis/evaluate.hpp>
#include <maupertuis/resting_modes.hpp>

#include <memory>
#include <optional>
#include <vector>

namespace maupertuis {

/// A mode at rest as equations and numbers: which contacts touch at a point, and which forces keep it at rest.
class ModeAtRest {
 public:
  ModeAtRest(const MechanicalSystem& system, ContactMode mode);

  const ContactMode& mode() const { return mode_; }
  const std::shared_ptr<const EquationsOfMotion>& equations() const { return equations_; }
  const PointEquations& points() const { return *points_; }

  /// How much a contact that is closed presses at least: more than rounding of the largest force; not less than 0; that
  /// rounding of it may pull.
  enum class Presses { MoreThanRounding, NotLessThanZero, AtMostPullsByRounding };

  /// Closed contacts, and open ones whose gap is 0 to rounding; nothing where a gap is negative.
  std::optional<std::vector<bool>> touching(const OperatingPoint& point) const;
  /// Whether every open contact has a gap, however small.
  bool has_gaps(const OperatingPoint& point) const;
  /// The point with forces under which closed contacts press and friction keeps its limits; nothing where there are
  /// none. Those of the point where these do; where the balance does not determine them others, the shortest that do.
  std::optional<OperatingPoint> with_forces(const OperatingPoint& point, Presses least) const;
  /// Whether the balance leaves open how contacts and friction share the forces at a point.
  bool leaves_forces_open(const OperatingPoint& point) const;
  /// Whether no open contact comes nearer or goes farther along this translation.
  bool is_free_along(const Translation& translation) const;
  /// What static friction does at a point with its forces.
  std::vector<StaticHold> holds(const OperatingPoint& point) const;

 private:
  Bindings at(const OperatingPoint& point) const;
  double value(Expr e, const Bindings& b) const;
  double gap_rounding(const Contact& contact, const Bindings& b) const;
  double balanced(const Contact& contact, const Bindings& b) const;
  SharedForces shared_forces(const OperatingPoint& point) const;
  bool press(const OperatingPoint& point, Presses least) const;
  bool friction_holds(const OperatingPoint& point) const;
  double force_of(const Friction& friction, const Bindings& b) const;
  double size(Expr e, const Bindings& b) const;
  Dimension dimension_of_friction(std::size_t i) const;

  const MechanicalSystem& system_;
  ContactMode mode_;
  std::shared_ptr<const EquationsOfMotion> equations_;
  std::optional<PointEquations> points_;
};

}  // namespace maupertuis
