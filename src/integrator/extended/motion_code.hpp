#pragma once
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
    record_covered();
  }

  bool advance() {
    const auto outcome = stepper_.step(numbers_.end);
    out_.ending = outcome.ending;
    out_.reason = outcome.reason;
    out_.met = outcome.event && problem_.until;
    if (options_.progress && stepper_.steps() % 16 == 0)
      options_.progress(static_cast<double>((stepper_.time() - numbers_.begin) / (numbers_.end - numbers_.begin)));
    return outcome.ending == StepEnding::None && !out_.met;
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
};

template <class T>
ExtendedMotion run_motion(const ExtendedProblem& problem, const ExtendedOptions& options) {
  return Motion<T>(problem, options).carry_out();
}

}  // namespace maupertuis::extended
