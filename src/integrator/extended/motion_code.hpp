#pragma once
#include "integrator/extended/impact_code.hpp"
#include "integrator/extended/motion.hpp"
#include "integrator/extended/start.hpp"
#include "integrator/extended/stepper_code.hpp"

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
        stepper_(problem.kernel, numbers_.parameters, options,
                 options.log2_tolerance != 0 ? options.log2_tolerance : log2_size(epsilon<T>())) {}

  ExtendedMotion carry_out() {
    out_.order = stepper_.order();
    out_.at.resize(problem_.times);
    if (!numbers_.finite) {
      out_.ending = StepEnding::Overflow;
      out_.reason = "A parameter or a start value is infinite or undefined.";
      return std::move(out_);
    }
    begin();
    while (stepper_.time() != numbers_.end && advance()) record_covered();
    record_covered();
    out_.final = stepper_.sample(stepper_.time());
    if (problem_.rows > 0 && (out_.rows.empty() || out_.rows.back().t != out_.final.t)) out_.rows.push_back(out_.final);
    out_.steps = stepper_.steps();
    out_.switches = stepper_.switches();
    return std::move(out_);
  }

 private:
  void begin() {
    if (problem_.kernel.constraints() > 0 || problem_.rates > 0) {
      Workspace<T> work(problem_.kernel, 1);
      work.set_parameters(numbers_.parameters);
      Start<T>(work, problem_).improve(numbers_.begin, numbers_.q, numbers_.v);
    }
    stepper_.start(numbers_.begin, numbers_.q, numbers_.v);
    std::size_t contacts = 0;
    for (const ExtendedEvent& e : problem_.events) {
      contact_.push_back(e.action == ExtendedEvent::Action::Hit ? contacts++ : no_contact);
      if (contact_.back() != no_contact) event_.push_back(contact_.size() - 1);
    }
    fastest_.assign(contacts, T(0));
    record_covered();
    if (contacts > 0) settle(touching_at_start());
  }

  /// Contacts with g = 0 at the start.
  std::vector<std::size_t> touching_at_start() {
    std::vector<std::size_t> out;
    const Workspace<T>* const here = stepper_.here();
    for (std::size_t c = 0; here && c < event_.size(); ++c) {
      const std::size_t event = event_[c] + problem_.until;
      if (abs(here->event(event, 0)) <= 64 * epsilon<T>() * here->event_scale(event)) out.push_back(c);
    }
    return out;
  }

  bool advance() {
    if (out_.ending != StepEnding::None) return false;
    const auto outcome = stepper_.step(numbers_.end);
    out_.ending = outcome.ending;
    out_.reason = outcome.reason;
    if (outcome.ending == StepEnding::None && !outcome.events.empty()) meet(outcome.events);
    if (options_.progress && stepper_.steps() % 16 == 0)
      options_.progress(static_cast<double>((stepper_.time() - numbers_.begin) / (numbers_.end - numbers_.begin)));
    return out_.ending == StepEnding::None && !out_.met;
  }

  void meet(const std::vector<typename Stepper<T>::Root>& roots) {
    const bool forwards = numbers_.begin <= numbers_.end;
    record_covered();
    std::vector<std::size_t> hit;
    for (const auto& root : roots) {
      if (root.event < problem_.until) {
        out_.met = true;
        continue;
      }
      const std::size_t i = root.event - problem_.until;
      const ExtendedEvent& event = problem_.events[i];
      if (event.action == ExtendedEvent::Action::Hit) {
        if (root.direction < 0) hit.push_back(contact_[i]);
        continue;
      }
      if (event.direction != 0 && root.direction != (forwards ? event.direction : -event.direction)) continue;
      out_.roots.push_back({i, stepper_.sample(stepper_.time()), {}, {}});
      out_.met = out_.met || event.action == ExtendedEvent::Action::Stop;
    }
    if (hit.empty() || out_.met) return;
    if (forwards)
      settle(hit);
    else
      stop(StepEnding::Paradox, hit.front(),
           "backwards in time the motion meets an impact, and what was before it does not follow from what is after "
           "it.");
  }

  void stop(StepEnding ending, std::size_t contact, std::string reason) {
    out_.ending = ending;
    out_.trouble = event_[contact];
    out_.reason = std::move(reason);
  }

  /// Impulses of the contacts that touch and close. The motion goes on only where all of them open then.
  void settle(const std::vector<std::size_t>& touching) {
    if (touching.empty()) return;
    constexpr int roundings = 64;
    const Workspace<T>* const here = stepper_.here();
    if (!here) return;  // the next step says why
    const Impact<T> impact(problem_, *here, touching);
    std::vector<T> v(stepper_.v().begin(), stepper_.v().end()), rest;
    for (std::size_t k = 0; k < touching.size(); ++k) {
      T& fastest = fastest_[touching[k]];
      fastest = std::max(fastest, impact.scale(k, v));
      rest.push_back(roundings * epsilon<T>() * fastest);
    }
    const ExtendedSample before = stepper_.sample(stepper_.time());
    const auto blows = impact.carry_out(v, rest);
    if (!blows) return stop(StepEnding::Unending, touching.front(), "impacts follow each other without an end.");
    for (const auto& blow : *blows)
      out_.roots.push_back({event_[blow.contact], before, text_of(blow.impulse), text_of(blow.speed)});
    for (std::size_t k = 0; k < touching.size(); ++k)
      if (!(impact.rate(k, v) > rest[k]))
        return stop(StepEnding::Unending, touching[k],
                    "it stays closed from here on, which is not carried through in many digits.");
    stepper_.set_velocities(v);
    const bool is_short = abs(stepper_.time() - last_impact_) <= roundings * epsilon<T>() * abs(stepper_.time());
    short_flights_ = is_short ? short_flights_ + 1 : 0;
    last_impact_ = stepper_.time();
    if (short_flights_ > 3)
      stop(StepEnding::Unending, touching.front(),
           "the flights between impacts have become too short to be told apart in so many digits.");
  }

  void record_covered() {
    for (; next_row_ < problem_.rows; ++next_row_) {
      const T step = numbers_.every * T(next_row_);
      const T t = numbers_.end < numbers_.begin ? T(numbers_.begin - step) : T(numbers_.begin + step);
      if (!stepper_.covers(t)) break;
      out_.rows.push_back(stepper_.sample(t));
    }
    for (; next_time_ < problem_.times && stepper_.covers(numbers_.times[next_time_]); ++next_time_)
      out_.at[next_time_] = stepper_.sample(numbers_.times[next_time_]);
  }

  const ExtendedProblem& problem_;
  const ExtendedOptions& options_;
  Numbers<T> numbers_;
  Stepper<T> stepper_;
  ExtendedMotion out_;
  std::size_t next_row_ = 0, next_time_ = 0;
  static constexpr std::size_t no_contact = ~std::size_t{0};
  std::vector<std::size_t> contact_, event_;  // [events] its contact; [contacts] its event
  std::vector<T> fastest_;                    // [contacts] terms of ġ so far: what is much smaller is rounding
  T last_impact_ = T(0);
  int short_flights_ = 0;
};

template <class T>
ExtendedMotion run_motion(const ExtendedProblem& problem, const ExtendedOptions& options) {
  return Motion<T>(problem, options).carry_out();
}

}  // namespace maupertuis::extended
