#pragma once
#include "simulation/hybrid_change.hpp"
#include "simulation/method.hpp"

#include <maupertuis/simulation.hpp>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace maupertuis {

/// A motion with contacts, friction and events: Taylor's steps in one mode after the other, impacts between them
/// (docs/theory/contacts.md). Its steps end where something happens; the next one begins in the mode after it.
///
///     mode "floor" ──── λ = 0 ──── mode "" ──── g = 0, ġ < 0: impact ──── mode "" or "floor" ────
///
/// Integrals of its samples: the work on h_E, that of impacts included; what friction took; what D took; what surfaces
/// that move gave, without impacts.
class HybridMotion final : public Method {
 public:
  /// `parameters` [p].
  HybridMotion(std::shared_ptr<ModeLibrary> library, std::vector<double> parameters, const TaylorOptions& options);

  int order() const override;
  void start(double t, std::span<const double> q, std::span<const double> v) override;
  Step step(double bound) override;
  double time() const override;
  bool covers(double t) const override;
  Sample sample(double t) const override;
  void state(double t, std::span<double> q, std::span<double> v) const override;
  const Sample& step_start() const override;
  std::size_t steps() const override;
  std::size_t rejected() const override;
  std::size_t switches() const override;
  double constraint_residual() const override;
  BackendUse backend() const override;

  /// What the end of the run leaves unsettled is told.
  void finish();
  const HybridRecord& record() const { return journal_.record(); }
  /// Once the motion has ended: a million of them are not copied.
  std::vector<Happening> take_happenings() { return journal_.take_happenings(); }
  const std::shared_ptr<ModeLibrary>& library() const { return problem_.library; }
  /// Whether the next step begins with an impact, or with what an event sets: the state is another one then.
  bool will_jump() const { return met_ && met_->changes_state(); }
  /// Why there is no motion from the start; empty where there is one.
  std::string trouble() const { return failed_ ? failed_->reason : std::string(); }

  /// For neighbours (motion_through_modes.hpp): from here on each instant is kept.
  void keep_instants();
  const ModeInstant* instant() const { return neighbours_.instant(); }
  const ContactMode& mode() const { return motions_.now().mode; }
  bool begins_to_slide() const { return !motions_.now().given.begins.empty(); }  // in space, at its beginning
  /// In the context of the model; they stay as long as this.
  const EquationsOfMotion& equations_in(const ContactMode& mode) { return motions_.equations_in(mode); }
  /// [n] The largest that q'' of the dimension of each coordinate has been, or that forces which balance would make it.
  std::vector<double> largest_accelerations() const { return sizes_.accelerations(); }
  /// What rounding of forces that balance makes of the energy in a step; 0 where it is not known.
  double rounding_of_energy();
  /// A companion, whose difference tells the error, meets roots that rounding hides later by what it may hide of them:
  /// the roots of conditions that end a rest or a contact so slowly are found at the same place by all.
  void meet_hidden_roots_late() { problem_.meets_late = true; }
  /// Sizes that q and q' have elsewhere in the motion [n]: of later starts, what is much smaller is rounding.
  void set_usual_sizes(std::span<const double> q, std::span<const double> v) { sizes_.set_elsewhere(q, v); }

 private:
  Sample with_carried(Sample sample) const;

  // A step.
  std::optional<Step> refused_backwards(double bound);
  Step wait(double bound);
  Step step_in_mode(double bound);
  Step end_step(Step step, double bound);
  void classify(Step& step, double bound);
  void end_condition(const ModeWatch& watch, double length, hybrid::Met& met) const;
  void take_state();
  void note_step();
  void note_holding_forces(const Sample& sample);

  // What it has met.
  std::optional<Step> settle(double bound);
  std::optional<std::string> too_many_at_once();

  Step ended(StepEnding ending, std::string reason) const;
  Step stopped(StepEnding ending, std::string reason);
  Step went_through(std::size_t contact);
  std::optional<Step> came_to_paradox();

  hybrid::Problem problem_;
  hybrid::State here_;
  hybrid::UsualSizes sizes_;
  hybrid::Journal journal_;
  hybrid::StateFunctions functions_;
  hybrid::Carried carried_;
  hybrid::SpaceSlips slips_;
  hybrid::ModeMotions motions_;
  hybrid::Events events_;
  hybrid::Neighbours neighbours_;
  hybrid::ModeChange change_;
  std::unique_ptr<hybrid::Met> met_;  // of the last step, to be settled
  std::optional<Step> failed_;        // the start allows no motion
  bool forwards_ = true;
  double longest_step_ = 0;
  double late_by_ = 0;                        // until what was met is settled
  std::size_t same_time_ = 0;                 // changes so far at this instant
  mutable std::optional<Sample> step_start_;  // of the last step, where it was asked for
};

}  // namespace maupertuis
