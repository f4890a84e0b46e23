#pragma once
#include "analysis/tangent/trigger.hpp"

#include <maupertuis/motion_through_modes.hpp>
#include <maupertuis/tangent.hpp>

#include <eigen3/Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

namespace maupertuis {

/// Directions through contacts, friction and events: in each mode by its tangent equations, at each instant by the jump
///
///     X⁺ = DJ X + (f⁺ − DJ f⁻ − ∂J/∂t) (∇h X)/ḣ
///
/// (docs/theory/contacts.md; P. C. Müller, Chaos, Solitons and Fractals 5, 1995).
struct TangentFlow::ThroughModes {
  ThroughModes(const Model& model, const EquationsOfMotion& equations, const TangentOptions& options);

  TangentPoint all_directions(const MotionState& state);
  std::optional<TangentStop> advance(TangentPoint& point, double t);
  std::vector<double> accelerations(const MotionState& state);
  const EquationsOfMotion& equations_at(const MotionState& state);

  void set_usual_sizes(std::span<const double> sizes) {
    sizes_.assign(sizes.begin(), sizes.end());
    motion_.set_usual_sizes(sizes.first(freedoms), sizes.subspan(freedoms));
    for (const auto& m : modes_) m->flow.set_usual_sizes(sizes);
  }

  // Of the last advance: what its jumps do to volumes, nothing where that is not known; the least number of directions
  // that a mode on the way allows.
  std::optional<double> log_volume = 0;
  std::size_t fewest = 0;
  std::size_t freedoms;

 private:
  /// The flow of one mode.
  struct InMode {
    InMode(const ContactMode& mode, const EquationsOfMotion& equations, const TangentOptions& options)
        : mode(mode), equations(equations), flow(equations, options), geometry(equations) {}
    ContactMode mode;
    const EquationsOfMotion& equations;
    TangentFlow flow;
    TangentGeometry geometry;
    std::unordered_map<Expr, tangent::Trigger, ExprHash> triggers;
  };

  void stand_at(const MotionState& state);
  std::optional<TangentStop> parts_at_start(const MotionState& state) const;
  InMode& in(const ContactMode& mode);
  std::optional<TangentStop> carry(TangentPoint& point, const ContactMode& mode, double t);
  std::optional<TangentStop> pass(TangentPoint& point, const ModeInstant& instant);
  std::optional<TangentStop> jump(TangentPoint& point, const InstantJump& jump, InMode& before,
                                  const Eigen::VectorXd& f_before, const Eigen::VectorXd& f_after);
  std::optional<TangentStop> keep_constraints(TangentPoint& point, const ContactMode& mode, double size);

  TangentOptions options_;
  bool rubs_;
  MotionThroughModes motion_;
  std::vector<std::unique_ptr<InMode>> modes_;
  std::optional<MotionState> at_;  // where the motion stands
  bool has_moved_ = false;         // since it was put there
  struct Slip {
    std::size_t friction;
    std::string name;
    Expr speed, terms;  // v_t, and the sum of the sizes of its terms
  };
  const MechanicalSystem& system_;
  std::vector<Slip> slips_;    // of frictions along a line
  std::vector<double> sizes_;  // [2n] of the motion, where they were told
};

}  // namespace maupertuis
