#pragma once
#include "integrator/extended/constraint_error.hpp"
#include "integrator/extended/step_size.hpp"
#include "integrator/taylor/end_check.hpp"
#include "integrator/taylor/met_roots.hpp"
#include "integrator/taylor/safe_length.hpp"

#include <maupertuis/extended.hpp>

#include <optional>
#include <utility>

namespace maupertuis::extended {

/// TaylorStepper over T (docs/design/taylor_step.md): expand, project onto the constraints, decide the sides of switch
/// functions that begin at a zero, choose a length, shorten it to the first crossing, advance, and look whether the
/// equations hold at the end.
template <class T>
class Stepper {
 public:
  Stepper(const Kernel& kernel, std::span<const T> parameters, const ExtendedOptions& options, double log2_tolerance);

  int order() const { return control_.order; }
  void start(const T& t, std::vector<T> q, std::vector<T> v);
  /// After start(): the motion has come from an earlier time with these accelerations, so that it covers that too.
  void come_from(const T& t, const std::vector<T>& q, const std::vector<T>& v, const std::vector<T>& accelerations);
  /// [n] each: what rounding of q, q̇ and q̈ is measured by beside what they are here.
  void set_usual_sizes(std::vector<T> q, std::vector<T> v, std::vector<T> a);
  /// An event at the end of the step: 1 rising, −1 falling, 0 where it comes to zero and goes back.
  struct Root {
    std::size_t event;
    int direction;
    std::uint8_t order;  // of the zero, as far as rounding tells it
  };
  struct Outcome {
    StepEnding ending = StepEnding::None;
    std::string reason;
    std::vector<Root> events{};
  };
  /// One step towards `bound`, at most up to it; time() == bound exactly when it is reached.
  Outcome step(const T& bound);

  /// After start(): an event function that vanishes here, to rounding; order: of the zero, where it is known.
  void put_at_zero(std::size_t event, std::uint8_t order = 1) { event_state_[event] = {0, true, order}; }
  /// What is seen of the motion at its start, before a step is made.
  struct Outlook {
    StepEnding ending = StepEnding::None;  // None: there is a motion
    std::string reason;
    std::vector<std::int8_t> sides;             // [events] of zero, just after; 0 where rounding hides it
    std::vector<T> values, slopes;              // [events]
    std::vector<T> reach;                       // [events] the largest that they can become over what is judged
    std::vector<T> accelerations, multipliers;  // [n], [constraints]
  };
  Outlook outlook(const T& bound);
  std::span<const T> q() const { return q_; }
  std::span<const T> v() const { return v_; }
  const T& time() const { return t_; }
  T length() const { return t_ - begin_; }  // of the last step
  std::size_t steps() const { return steps_; }
  std::size_t switches() const { return switches_; }
  std::size_t rejected() const { return rejected_; }
  bool covers(const T& t) const { return std::min(begin_, t_) <= t && t <= std::max(begin_, t_); }
  /// Precondition: covers(t).
  ExtendedSample sample(const T& t);

 private:
  using Polynomial = taylor::ScaledPolynomialOf<T>;
  using Crossing = taylor::MetRoots<T>;

  std::optional<Outcome> expand(const T& bound);
  std::optional<Outcome> project();
  T constraint_error() const;
  Outcome failure(KernelStatus status);
  void set_sides(Workspace<T>& work) const;
  void choose_first_sides();
  T judged_length(const T& bound) const;
  std::optional<Outcome> decide_sides(const T& bound);
  std::optional<Outcome> without_value();
  bool has_value(std::size_t switch_function) const {
    const T here = work_.switch_function(switch_function, 0);
    return here == here;
  }
  bool watches() const { return !switch_state_.empty() || !event_state_.empty(); }
  Crossing first_crossing(const T& h);
  void leave(const Crossing& crossing);
  double safe_length(double log2_wanted, double log2_left);
  void take_rough_constants();
  std::optional<Outcome> advance(const T& bound, const T& h, bool reaches);
  bool equations_hold(const T& tau);
  void keep_polynomial();
  void state_after(const T& tau, std::vector<T>& q, std::vector<T>& v) const;

  Kernel kernel_;
  ExtendedOptions options_;
  double log2_tolerance_;
  StepControl control_;
  Workspace<T> work_, probe_;
  std::size_t n_;
  T t_, begin_;
  std::vector<T> q_, v_, q_begin_, v_begin_;
  UsualSizes<T> usual_;
  std::vector<T> polynomial_;                                 // [order + 2][n] of the last step
  double length_ = std::numeric_limits<double>::quiet_NaN();  // log₂ of the last length that the control chose
  double restraint_ = 0;                                      // log₂ of what the lengths are multiplied by
  bool first_ = true;
  std::size_t steps_ = 0, switches_ = 0;
  std::size_t rejected_ = 0;  // steps that were taken back
  std::vector<taylor::Watched> switch_state_, event_state_;
  taylor::SafeLength safe_;
  ScaledRows<T> rows_;
  std::vector<double> rough_constants_;
  std::vector<double> rates_;  // [n] largest |q̇| and h |q̈| so far
  taylor::Kinks<T> kinks_;
  std::optional<taylor::RootSearchOf<T>> roots_;
  int stuck_ = 0;  // crossings in a row that did not move time
};

}  // namespace maupertuis::extended
