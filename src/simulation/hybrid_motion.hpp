#pragma once
#include "simulation/contact/impact.hpp"
#include "simulation/hybrid_journal.hpp"
#include "simulation/hybrid_modes.hpp"
#include "simulation/hybrid_space.hpp"
#include "simulation/method.hpp"
#include "simulation/mode_library.hpp"

#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/contact_mode.hpp>
#include <maupertuis/integrator.hpp>
#include <maupertuis/motion_through_modes.hpp>
#include <maupertuis/simulation.hpp>

#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace maupertuis {

class ImpactDerivative;

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
  ~HybridMotion() override;

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
  bool will_jump() const;
  /// Why there is no motion from the start; empty where there is one.
  std::string trouble() const { return failed_ ? failed_->reason : std::string(); }

  /// For neighbours (motion_through_modes.hpp): from here on each instant is kept.
  void keep_instants();
  const ModeInstant* instant() const { return instant_ ? &*instant_ : nullptr; }
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
  using Watch = ModeWatch;
  using Met = hybrid::Met;
  using ModeMotion = hybrid::ModeMotion;
  using Outlook = hybrid::Outlook;
  struct Settled;

  void leave_mode();
  Sample adjusted(Sample sample) const;
  double covered(double t) const;

  // What happens at an instant.
  void classify(Step& step);
  void tell_events_at_start(double bound);
  void record_event(const std::string& name, double t, double hidden = 0);
  double hidden_by_rounding(double bound);
  double hides_gap(std::size_t contact, double length);
  void meet_together(double bound);
  Step wait(double bound);
  std::optional<Step> settle(double bound);
  bool carry_out_sets(std::string& reason);
  void meet_event(const ModelEvent& event, const EventRoot& root, Met& pending);
  std::optional<Step> meet_unseen(double bound);
  std::vector<std::size_t> touching(const ContactValues& values) const;
  bool keeps_sticking(const std::vector<std::size_t>& touching, std::string& reason);
  bool is_lost_in_rounding(const std::vector<std::size_t>& touching, const ContactValues& values) const;
  bool hit(std::vector<std::size_t>& touching, std::string& reason);
  void end_series(const std::vector<std::size_t>& touching);
  static ImpactResult last_impact(const ImpactProblem& problem, const Eigen::VectorXd& v);
  ImpactProblem impact_problem(const std::vector<std::size_t>& touching, const ContactValues& values);
  void note_order(const ImpactProblem& problem, const ImpactResult& first, const Eigen::VectorXd& v);
  /// What impulses take, and what contacts that move give by them.
  void book_energy(const ImpactResult& result);
  void record_impulses(const ImpactResult& result);
  void note_bounce(std::size_t contact, double speed, double restitution);
  std::optional<double> accumulation(std::size_t contact, double speed);
  std::optional<double> accumulation_among(std::vector<std::size_t>& touching, const ContactValues& values);
  bool slips_may_stop_before(double end, const std::vector<std::size_t>& touching, const ContactValues& values) const;

  // The mode after it.
  bool choose(std::vector<std::size_t>& touch, double bound, std::string& reason);
  bool choose_slips(const hybrid::Instant& at, bool all_give_way, std::string& reason);
  void go_on_in(const hybrid::Found& found);
  // Friction in space.
  void close_lowest_flights(const std::vector<std::size_t>& touching, double bound);
  void note_limits(const ContactValues& values);
  void note_holding_forces(const Sample& sample);
  void note_rest_that_begins();
  std::optional<std::size_t> violated(double step);
  // What neighbours need.
  void note_before(double bound);
  void note_impact(const ImpactProblem& problem, const ImpactResult& result, const Eigen::VectorXd& v,
                   bool ends_bounces);
  void note_after(double bound);
  void add_set_jump();
  void add_impact_jumps();
  void add_impulses_in_order(const ImpactResult& ordered);
  void add_impulses_at_once();
  void add_change_of_forces();
  bool changes_in_space() const;
  std::string at_once_sentence() const;
  std::string touch_sentence(std::size_t contact, double t) const;
  Expr function_of(const Watch& watch, bool second) const;

  Step ended(StepEnding ending, std::string reason) const;
  Step stopped(StepEnding ending, std::string reason);
  Step stopped_here() const;
  void take_state();
  bool pulls() const;
  bool goes_on(double bound);
  bool hits_at_start() const;
  void note_step();

  hybrid::Problem problem_;
  hybrid::State here_;
  hybrid::UsualSizes sizes_;
  hybrid::Journal journal_;
  hybrid::StateFunctions functions_;
  hybrid::Carried carried_;
  hybrid::SpaceSlips slips_;
  hybrid::ModeMotions motions_;
  hybrid::Choices choices_;
  hybrid::ContactCones cones_;
  hybrid::SpaceFriction space_;
  hybrid::Events events_;
  hybrid::UndeterminedForces undetermined_;
  hybrid::JointForces forces_;
  hybrid::ModeTrials trials_;
  hybrid::ModeChoice choice_;
  std::unique_ptr<Met> pending_;
  std::optional<Step> failed_;  // the start allows no motion

  double longest_step_ = 0;
  bool forwards_ = true, started_ = false;
  double late_by_ = 0;                        // until the pending instant is settled
  mutable std::optional<Sample> step_start_;  // of the last step, where it was asked for
  std::size_t same_time_ = 0;
  struct Bounces {
    std::vector<std::pair<double, double>> last;  // (t, speed) of the last impacts
    double fastest = 0;                           // impact of the series that goes on, not rounding of other speeds
    double before = 0;                            // the speed of the impact before
  };
  std::vector<Bounces> bounces_;    // [contacts]
  std::vector<std::size_t> cycle_;  // contacts that bounce together towards an end of their bounces
  std::optional<hybrid::EndOfBounces> end_of_bounces_;
  std::shared_ptr<ImpactDerivative> derivative_;  // where instants are kept
  std::shared_ptr<Settled> settled_;              // the instant that is being settled
  std::optional<ModeInstant> instant_;            // the one at the beginning of the last step
};

}  // namespace maupertuis
