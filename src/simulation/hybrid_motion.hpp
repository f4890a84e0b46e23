#pragma once
#include "linear_algebra/accumulation.hpp"
#include "simulation/contact/contact_forces.hpp"
#include "simulation/contact/impact.hpp"
#include "simulation/hybrid_journal.hpp"
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
  using Choice = hybrid::Choice;
  using Cones = hybrid::Cones;
  using Given = hybrid::Given;
  using Met = hybrid::Met;
  using ModeMotion = hybrid::ModeMotion;
  using Outlook = hybrid::Outlook;
  struct Found;
  struct Trial;
  struct Settled;
  enum class Leniency { None, Forces, Gaps };  // what may be violated by rounding

  void leave_mode();
  Sample adjusted(Sample sample) const;
  double covered(double t) const;

  // What happens at an instant.
  void classify(Step& step);
  void tell_events_at_start(double bound);
  void record_event(const std::string& name, double t, double hidden = 0);
  bool is_just_released(std::size_t contact);
  double hidden_by_rounding(double bound);
  double hides_gap(std::size_t contact, double length);
  void meet_together(double bound);
  Step wait(double bound);
  bool presses_again(std::size_t contact, std::span<const double> accelerations, double digits);
  std::optional<Step> settle(double bound);
  bool carry_out_sets(std::string& reason);
  const ModelEvent* turned_unseen(double bound);
  void note_sets(double bound);
  std::string sets_without_end() const;
  void meet_event(const ModelEvent& event, const EventRoot& root, Met& pending);
  std::optional<Step> meet_unseen(double bound);
  std::string too_short_to_tell(const ModelEvent& event) const;
  static bool is_hidden(std::int8_t before, const TaylorStepper::Outlook& outlook, std::size_t watch);
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
  static std::vector<std::pair<Leniency, std::size_t>> attempts_with(std::size_t contacts);
  bool choose_mode(const std::vector<std::size_t>& touching, double bound, std::string& reason);
  void measure_forces(const std::vector<std::size_t>& touching, const ContactValues& values, double bound);
  void order_by_limits(std::vector<Choice>& list, const std::vector<std::size_t>& touching, double bound);
  bool may_hold(const Choice& choice);
  bool gives_way_unforced(const std::vector<Choice>& list, const Found& found, const std::vector<std::size_t>& touching,
                          double bound);
  std::vector<std::pair<std::size_t, std::size_t>> exchangeable(const std::vector<Choice>& list,
                                                                const ContactMode& mode);
  void note_choice(const std::vector<Choice>& list, Found& found, const std::vector<std::size_t>& touching,
                   double bound);
  std::optional<std::vector<std::size_t>> beyond_limits(Found& found, const std::vector<std::size_t>& touching,
                                                        double bound);
  std::optional<Found> search_mode(const std::vector<Choice>& list, const std::vector<std::size_t>& touching,
                                   double bound, std::string& reason);
  std::optional<Found> mode_that_goes_on(const std::vector<std::size_t>& touching, double bound);
  void open_idle(ContactMode& mode) const;
  std::optional<Found> undetermined_rest(const std::vector<Choice>& list, const std::vector<std::size_t>& touching,
                                         double bound);
  bool fits_by_given_forces(Found& found, const std::vector<std::size_t>& touching, double bound);
  bool may_be_given(std::size_t friction) const;
  std::size_t most_that_hold() const;
  std::size_t number_that_hold(const ContactMode& mode) const;
  ContactMode mode_without_holding(const ContactMode& mode, std::vector<std::size_t>& holding) const;
  std::optional<std::vector<double>> forces_at_rest(const ContactMode& mode, const ContactValues& values, double bound);
  std::vector<double> ordered_forces(const ContactMode& mode, const Cones& cones, const Eigen::VectorXd& found,
                                     std::vector<double> of_constraints);
  std::optional<std::vector<double>> forces_later(const ContactMode& mode, double later, double bound);
  double rest_ahead(const ContactMode& mode, double length, double bound);
  std::optional<Given> preload_through(const ContactMode& mode, double ahead, int power, double bound);
  bool is_held(std::size_t contact, const ContactMode& mode, const ContactValues& values);
  bool has_dependent_rows(const ContactMode& mode, const ContactValues& values);
  std::optional<ContactForceProblem> force_problem(const std::vector<Choice>& list, const ContactValues& values,
                                                   double bound);
  // Friction in space.
  void close_lowest_flights(const std::vector<std::size_t>& touching, double bound);
  void order_by_forces(std::vector<Choice>& list, const ContactValues& values, double bound);
  bool fits(Found& found, const std::vector<std::size_t>& touching, double bound, Leniency leniency);
  bool changes_no_force(const ContactMode& mode, const ContactValues& values) const;
  bool accelerations_go_on(std::span<const double> accelerations) const;
  bool begins_slowly(const Watch& slip, const ContactMode& mode, const ContactValues& values) const;
  bool vanishes(const Watch& watch, double size, const ContactValues& values) const;
  void note_limits(const ContactValues& values);
  void note_holding_forces(const Sample& sample);
  void note_rest_that_begins();
  std::optional<std::size_t> violated(double step);
  bool may_be_several(const ContactMode& mode, const ContactValues& values);
  std::optional<std::string> weaker_at_rest(const std::vector<Choice>& list, const ContactValues& values) const;
  std::string why_none_fits(const std::vector<Choice>& list, const std::vector<std::size_t>& touching,
                            const ContactValues& values, bool were_many);
  bool may_be_painleve(const std::vector<Choice>& list, const ContactValues& values);
  void note_indeterminate(const std::vector<Choice>& list, const ContactMode& mode, const ContactValues& values);
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
  std::unique_ptr<Met> pending_;
  std::optional<Step> failed_;  // the start allows no motion

  double longest_step_ = 0;
  bool forwards_ = true, started_ = false;
  double late_by_ = 0;                        // until the pending instant is settled
  mutable std::optional<Sample> step_start_;  // of the last step, where it was asked for
  std::size_t same_time_ = 0;
  bool told_choice_ = false;  // that static friction leaves one
  struct Bounces {
    std::vector<std::pair<double, double>> last;  // (t, speed) of the last impacts
    double fastest = 0;                           // impact of the series that goes on, not rounding of other speeds
    double before = 0;                            // the speed of the impact before
  };
  std::vector<Bounces> bounces_;                       // [contacts]
  std::vector<bool> released_;                         // [contacts] λ is 0 to rounding at this instant, and falls
  std::vector<double> released_at_;                    // [contacts] when that was last; not a number before
  std::vector<std::size_t> cycle_;                     // contacts that bounce together towards an end of their bounces
  Accumulation<double> sets_that_follow_;              // events that set the state
  std::optional<Accumulation<double>::End> sets_end_;  // where these accumulate within the run
  std::vector<bool> of_positions_;                     // [events]
  std::vector<std::int8_t>
      event_sides_;  // [events] of positions: the side on which the motion is; 0: at zero, or not known
  std::optional<hybrid::EndOfBounces> end_of_bounces_;
  std::size_t looks_at_forces_ = 0;   // where friction gave way
  bool finds_no_directions_ = false;  // of slips that begin, in the mode that was tried last
  std::optional<std::size_t> met_;    // a contact that the constraints of the mode that was tried move through zero
  std::string no_motion_;             // why the mode that was tried last has none, if that is so
  std::shared_ptr<ImpactDerivative> derivative_;  // where instants are kept
  std::shared_ptr<Settled> settled_;              // the instant that is being settled
  std::optional<ModeInstant> instant_;            // the one at the beginning of the last step
};

}  // namespace maupertuis
