#pragma once
#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/contact_mode.hpp>
#include <maupertuis/diagnostic.hpp>
#include <maupertuis/integrator.hpp>

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// A motion through contacts, friction and events step by step, for those who follow its neighbours
/// (docs/theory/contacts.md).
namespace maupertuis {

/// A change of the state that neighbours make at other times: it happens where a function h vanishes,
/// X⁺ = J(X⁻, t).
struct InstantJump {
  Expr function;        // h of q, q', q'', t and the multipliers of the mode before it
  double rate = 0;      // dh/dt along the motion just before it
  double touching = 0;  // |rate| up to which h only touches 0
  ContactMode mode;     // in which the motion would go on just after it
  MotionState after;
  std::vector<double> slopes;  // ∂(q⁺, q̇⁺)/∂(q, q̇, t) [2n × (2n + 1)], row by row; empty: the state stays
  std::optional<double> log_volume;  // log of what it multiplies volumes of q and p by; nothing where none is known
};

/// What happened between two steps.
struct ModeInstant {
  ContactMode mode_before, mode_after;
  MotionState before, after;
  std::vector<double> a_before, a_after;  // [n]
  std::vector<InstantJump> jumps;         // in their order; empty: the state stays, and forces may jump
  std::string obstacle;                   // a sentence: why neighbours have no derivative here; empty where they do
};

/// False, with E0729 or E0730, where the program does not carry out impacts: momenta that are not linear in q',
/// surfaces with kinks.
bool can_go_through_modes(const EquationsOfMotion& equations, Diagnostics& diagnostics);

/// Whether contacts, friction or events make its motion jump; events that are only told do not.
bool jumps_on_its_way(const Model& model);

/// One thread at a time. The model and the equations outlive it.
class MotionThroughModes {
 public:
  /// `until`: a function of q, q', q'', λ, t whose roots end steps and are told in Step::event; empty: none. The
  /// observables of samples are the terms of h_E.
  MotionThroughModes(const Model& model, const EquationsOfMotion& equations, Expr until, const TaylorOptions& options);
  ~MotionThroughModes();
  MotionThroughModes(MotionThroughModes&&) noexcept;

  /// From here on each instant is kept with what neighbours need of it.
  void keep_instants();
  void start(double t, std::span<const double> q, std::span<const double> v);
  /// Sizes that q and q' have elsewhere in the motion [n]: of later starts, what is much smaller is rounding.
  void set_usual_sizes(std::span<const double> q, std::span<const double> v);
  /// As TaylorStepper::step; first what was met at the end of the last step is settled.
  Step step(double bound);
  double time() const;
  std::size_t steps() const;
  Sample sample(double t) const;
  void state(double t, std::span<double> q, std::span<double> v) const;
  /// Where it is now. What is met here has not happened yet.
  MotionState state() const;
  /// What was settled as the last step began; null: nothing.
  const ModeInstant* instant() const;
  const ContactMode& mode() const;
  /// Whether a slip in space is at its beginning: its direction is not that of the slip yet.
  bool begins_to_slide() const;
  /// Of the system in a mode; they stay as long as this.
  const EquationsOfMotion& equations_in(const ContactMode& mode);
  /// The event of the model that stopped the run.
  const std::optional<std::string>& stopped_by() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// What an impact on one contact does to velocities.
class SingleImpact {
 public:
  /// `equations`: of the system with its contacts, none of them in force.
  explicit SingleImpact(const EquationsOfMotion& equations);
  ~SingleImpact();

  /// ġ of a contact.
  double rate(std::size_t contact, const MotionState& state);
  /// q̇⁺ [n]. Precondition: g = 0 and ġ < 0 at the state, which keeps the constraints.
  std::vector<double> after(std::size_t contact, const MotionState& state);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace maupertuis
