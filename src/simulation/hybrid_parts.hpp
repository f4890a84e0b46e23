#pragma once
#include "simulation/contact/cone_forces.hpp"
#include "simulation/hybrid_motion.hpp"

#include <maupertuis/integrator.hpp>

#include <limits>

/// What the parts of HybridMotion share.
namespace maupertuis {

/// To which what an event sets keeps constraints and contacts.
inline constexpr double digits_of_sets = 1e-9;

/// A coefficient of friction for contacts that never slide, where their forces are sought.
inline constexpr double held_fast = 1e3;

/// What is said where rigid contact has no motion, or several.
inline constexpr const char* beyond_painleve =
    "Textbooks go on by an impact without collision, an impulse of the contact that is not hit; none is made here: a "
    "stiff spring in place of the rigid contact says what happens, as `force on P = (-μ N P.x'/sqrt(P.x'^2 + v0^2), "
    "N)` "
    "with N = k max(-P.y, 0) on a floor.";

/// A row with its zeros.
std::vector<double> whole_row(const SparseRow& row, std::size_t n);

/// Whether one of these events sets a coordinate.
bool sets_positions(const std::vector<const ModelEvent*>& events);

/// Modes that are tried at an instant.
inline constexpr std::size_t most_choices = 1024;

/// a + factor b
SparseRow sum_of(const SparseRow& a, const SparseRow& b, double factor);

/// Of the terms of g̈: what a located instant leaves of a force that falls through 0.
inline constexpr double located_force = 1e-9;

/// What the motion in a mode is given besides the parameters of the model (ModeDetails).
struct HybridMotion::Given {
  bool is_preload = false;
  std::vector<bool> begins;                                // [contacts] or empty
  std::vector<double> values;                              // of its parameters
  double end = std::numeric_limits<double>::infinity();    // until when directions of slips that begin hold
  double preload(std::size_t constraint, double t) const;  // 0 where none is given
  friend bool operator==(const Given&, const Given&) = default;
};

struct HybridMotion::ModeMotion {
  ContactMode mode;
  std::shared_ptr<const ModeProgram> program;
  const std::vector<Watch>& watches() const { return program->watches; }
  Given given;
  std::vector<double> stops;  // [contacts] as in ModeDetails; empty without friction in space
  std::unique_ptr<TaylorStepper> stepper;
  std::size_t asked_for = 0;  // the last time, in turns of asking
};

/// What a step has met, to be settled before the next one.
struct HybridMotion::Pending {
  std::vector<std::size_t> hit;  // contacts whose gap came to 0
  std::vector<Watch> left;       // conditions of the mode that end here
  std::vector<const ModelEvent*> sets;
  std::vector<int> ways;             // [sets] in which their functions come to 0 along the run: 1 rising, −1 falling
  std::vector<std::size_t> at_zero;  // events on positions that are met here: their functions go on from 0
  double hidden = 0;                 // for how long rounding hides the roots of gaps that are met
  double hidden_sets = 0;            // … and those of events that set the state
  bool begins = false;
};

/// What a contact or a friction may do next, the likeliest first.
struct HybridOption {
  bool closed = false;
  FrictionState state = FrictionState::None;
  std::int8_t normal_sign = 1;
};

struct HybridMotion::Choice {
  std::size_t contact = 0;  // or contacts + friction of a coordinate
  std::vector<HybridOption> options;
};

/// Contacts that touch and do not open, as one problem over their cones, and frictions that hold along coordinates.
struct HybridMotion::Cones {
  std::vector<std::size_t> contacts;
  std::vector<std::size_t> first;       // [contacts] of its rows
  std::vector<bool> slides;             // [contacts]
  std::vector<SparseRow> rows, forces;  // ∂g/∂q, ∂v_t/∂q̇ of those at rest; what a unit of each force does
  std::vector<SparseRow> held;          // ∂v_t/∂q̇ of frictions of coordinates that hold without a limit
  Eigen::MatrixXd response;             // of q̈ to the forces
  ConeProblem problem;
};

/// A mode that fits.
struct HybridMotion::Found {
  ContactMode mode;
  std::vector<double> accelerations;
  Given given;
};

}  // namespace maupertuis
