#pragma once
#include "integrator/extended/mode_choice_code.hpp"
#include "integrator/extended/motion.hpp"
#include "integrator/extended/start.hpp"

namespace maupertuis::extended {

/// The numbers of a problem, in the order of ExtendedProblem::numbers.
template <class T>
struct Numbers {
  explicit Numbers(const ExtendedProblem& problem) {
    Workspace<T> work(problem.numbers, 1);
    const KernelStatus status = work.evaluate(T(0), {}, {});
    finite = status == KernelStatus::Ok;
    std::size_t next = 0;
    const auto take = [&](std::size_t count) {
      std::vector<T> out;
      for (std::size_t i = 0; i < count; ++i) {
        out.push_back(finite ? work.observable(next) : T(0));
        finite = finite && is_finite(out.back());
        ++next;
      }
      return out;
    };
    const std::size_t n = problem.kernel.freedoms();
    parameters = take(problem.kernel.parameters());
    begin = take(1)[0], end = take(1)[0], every = take(1)[0];
    q = take(n), v = take(n);
    times = take(problem.times);
  }
  bool finite = true;
  T begin, end, every;
  std::vector<T> parameters, q, v, times;
};

template <class T>
class Motion {
 public:
  Motion(const ExtendedProblem& problem, const ExtendedOptions& options)
      : problem_(problem),
        options_(options),
        numbers_(problem),
        modes_(problem, options, numbers_.parameters,
               options.log2_tolerance != 0 ? options.log2_tolerance : log2_size(epsilon<T>()), out_) {}

  ExtendedMotion carry_out() {
    out_.order = stepper().order();
    out_.at.resize(problem_.times);
    if (!numbers_.finite) {
      out_.ending = StepEnding::Overflow;
      out_.reason = "A parameter or a start value is infinite or undefined.";
      return std::move(out_);
    }
    begin();
    while (stepper().time() != numbers_.end && advance()) record_covered();
    record_covered();
    if (out_.ending == StepEnding::None && !out_.met && numbers_.end != numbers_.begin)
      modes_.tell_at_end(numbers_.begin);
    out_.final = stepper().sample(stepper().time());
    if (problem_.rows > 0 && (out_.rows.empty() || out_.rows.back().t != out_.final.t)) out_.rows.push_back(out_.final);
    out_.steps = modes_.steps();
    out_.switches = modes_.switches();
    return std::move(out_);
  }

 private:
  void begin() {
    if (problem_.kernel.constraints() > 0 || !problem_.conditions.empty() || problem_.relations > 0) {
      Workspace<T> work(problem_.kernel, 1);
      work.set_parameters(numbers_.parameters);
      Start<T>(work, problem_).improve(numbers_.begin, numbers_.q, numbers_.v);
    }
    modes_.start(numbers_.begin, numbers_.q, numbers_.v, numbers_.end);
    record_covered();
  }

  bool advance() {
    if (out_.ending != StepEnding::None) return false;
    const std::size_t switches = modes_.switches();
    const auto outcome = stepper().step(modes_.end_of_mode());
    out_.ending = outcome.ending;
    out_.reason = outcome.reason;
    if (outcome.ending == StepEnding::None) {
      modes_.note_step();
      meet(outcome.events, modes_.switches() != switches);
    }
    if (options_.progress && modes_.steps() % 16 == 0)
      options_.progress(static_cast<double>((stepper().time() - numbers_.begin) / (numbers_.end - numbers_.begin)));
    return out_.ending == StepEnding::None && !out_.met;
  }

  /// Events are told; what changes the state or the mode is carried out. A force that jumps may let go, though none of
  /// its conditions has a root.
  void meet(const std::vector<typename Stepper<T>::Root>& roots, bool switched) {
    using What = ExtendedWatch::What;
    const bool forwards = numbers_.begin <= numbers_.end;
    const bool slips_go_on = modes_.slips_go_on();
    if (roots.empty() && !switched && !slips_go_on) return;
    record_covered();
    typename Modes<T>::Met met;
    met.forces_jump = switched && modes_.has_forces();
    met.slips_go_on = slips_go_on;
    for (const auto& root : roots) {
      const ExtendedWatch& watch = modes_.watches()[root.event];
      if (watch.what == What::Until)
        out_.met = true;
      else if (watch.what == What::Event)
        meet_event(root, watch, root.direction * (forwards ? 1 : -1), met);
      else if (watch.what == What::Gap && root.direction < 0)
        met.hit.push_back(watch.index);
      else if (watch.what != What::Gap && (root.direction < 0 || (root.direction == 0 && watch.what == What::Slip)))
        met.left.push_back(watch);
    }
    if (met.nothing() || out_.met || out_.ending != StepEnding::None) return;
    const bool changes_mode = !met.hit.empty() || !met.left.empty();
    if (forwards || (!changes_mode && met.sets.empty())) return modes_.settle(met);
    out_.ending = StepEnding::Paradox;
    out_.reason = changes_mode ? through_modes::met_backwards : through_modes::set_backwards;
  }

  void meet_event(const typename Stepper<T>::Root& root, const ExtendedWatch& watch, int direction,
                  typename Modes<T>::Met& met) {
    if (modes_.stays_at_zero(watch, root)) return;
    const std::size_t index = watch.index;
    const ExtendedEvent& event = problem_.events[index];
    met.zeros.push_back({index, root.order});
    if (event.direction != 0 && direction != event.direction) return;
    modes_.add({ExtendedRoot::Kind::Event, index, stepper().sample(stepper().time()), {}, {}}, stepper().time());
    out_.met = out_.met || event.action == ExtendedEvent::Action::Stop;
    if (event.action == ExtendedEvent::Action::Set) met.sets.push_back(index), met.ways.push_back(direction);
  }

  Stepper<T>& stepper() { return modes_.stepper(); }

  void record_covered() {
    for (; next_row_ < problem_.rows; ++next_row_) {
      const T step = numbers_.every * T(next_row_);
      const T t = numbers_.end < numbers_.begin ? T(numbers_.begin - step) : T(numbers_.begin + step);
      if (!stepper().covers(t)) break;
      out_.rows.push_back(stepper().sample(t));
    }
    for (; next_time_ < problem_.times && stepper().covers(numbers_.times[next_time_]); ++next_time_)
      out_.at[next_time_] = stepper().sample(numbers_.times[next_time_]);
  }

  const ExtendedProblem& problem_;
  const ExtendedOptions& options_;
  Numbers<T> numbers_;
  ExtendedMotion out_;
  Modes<T> modes_;
  std::size_t next_row_ = 0, next_time_ = 0;
};

template <class T>
ExtendedMotion run_motion(const ExtendedProblem& problem, const ExtendedOptions& options) {
  return Motion<T>(problem, options).carry_out();
}

}  // namespace maupertuis::extended
