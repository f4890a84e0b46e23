#include "analysis/action/shots.hpp"

#include "analysis/action/kinks.hpp"

#include <maupertuis/integrator.hpp>
#include <maupertuis/motion_kernel.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace maupertuis::action {
namespace {

constexpr int even_shots = 401;
constexpr std::size_t most_shots = 3000;
constexpr double coarse =
    0.25;  // of the typical size: neighbouring shots that arrive further apart have one between them
constexpr double far =
    4;  // of their distance: neighbours that arrive on one side and further off have none between them
constexpr int most_halvings = 12;
constexpr double escaped =
    1e4;  // of the way between the ends: a motion that far away does not come back before it ends
constexpr double near_zero_of_root = 1e-10;

struct Shot {
  double speed = 0;
  std::optional<double> arrival;  // q(end) − wanted, ±∞ where it escapes; nothing: the motion ends before
};

class Shooter {
 public:
  Shooter(Problem& problem, const ActionEnds& ends, const StopFlag* interrupt)
      : problem_(problem),
        ends_(ends),
        from_(*ends.from[0]),
        to_(*ends.to[0]),
        kernel_(build_kernel(motion_source(problem.equations))),
        stepper_(kernel_, parameter_values(*problem.equations.system),
                 {.maximum_steps = 20'000, .interrupt = interrupt}) {}

  Shots run() {
    out_.fastest = fastest();
    Shot before = shoot(-out_.fastest);
    for (int k = 1; k < even_shots; ++k) {
      const Shot here = shoot(out_.fastest * (2.0 * k / (even_shots - 1) - 1));
      between(before, here, most_halvings);
      before = here;
    }
    return std::move(out_);
  }

 private:
  /// Twice what the way asks for, and four times that of a swing of the typical size at the fastest frequency.
  double fastest() const {
    Trial line{even_mesh(problem_.rule, ends_.start, ends_.end, 1, false), {}, Vector::Zero(0), Vector::Zero(1)};
    line.q.resize(1, line.mesh.nodes());
    for (Index k = 0; k < line.q.cols(); ++k)
      line.q(0, k) = from_ + (to_ - from_) * (line.mesh.time(k) - ends_.start) / (ends_.end - ends_.start);
    const double frequency = static_cast<double>(problem_.first_elements(line)) * 3.14159 / (ends_.end - ends_.start);
    return 2 * std::abs(to_ - from_) / (ends_.end - ends_.start) + 4 * frequency * problem_.typical[0];
  }

  Shot shoot(double speed) {
    ++out_.count;
    stepper_.start(ends_.start, {&from_, 1}, {&speed, 1});
    bool arrived = true;
    while (arrived && stepper_.time() != ends_.end) arrived = stepper_.step(ends_.end).ending == StepEnding::None;
    const double arrival = stepper_.q()[0] - to_;
    // A motion that ends on the way and is far off by then has escaped to that side.
    if (!arrived && is_far_off(arrival)) return {speed, std::copysign(HUGE_VAL, arrival)};
    if (!arrived) return {speed, std::nullopt};
    return {speed, std::isfinite(arrival) ? std::optional(arrival) : std::nullopt};
  }

  bool is_far_off(double arrival) const { return std::abs(arrival) > escaped * problem_.least(&ends_)[0]; }

  /// Beside a motion that ended on the way, one that came as far within the time: there rounding tells the two apart.
  bool both_escaped(const Shot& a, const Shot& b) const {
    return (std::isinf(*a.arrival) || std::isinf(*b.arrival)) && is_far_off(*a.arrival) && is_far_off(*b.arrival);
  }

  void between(const Shot& a, const Shot& b, int halvings) {
    if (!a.arrival || !b.arrival) return;
    const bool crosses = (*a.arrival < 0) != (*b.arrival < 0);
    const double apart = std::abs(*a.arrival - *b.arrival);
    const bool passed_by =
        !crosses && (std::min(std::abs(*a.arrival), std::abs(*b.arrival)) > far * apart || both_escaped(a, b));
    if (halvings > 0 && out_.count < most_shots && !passed_by && apart > coarse * problem_.typical[0]) {
      const Shot middle = shoot((a.speed + b.speed) / 2);
      between(a, middle, halvings - 1);
      return between(middle, b, halvings - 1);
    }
    if (crosses) keep(a, b);
  }

  void keep(Shot a, Shot b) {
    // Kinks have their places in the mesh from the shot alone: Newton's method does not move them.
    const double enough = problem_.kinks.empty() ? near_zero_of_root * out_.fastest : 0;
    for (int turn = 0; turn < 60 && std::abs(b.speed - a.speed) > enough; ++turn) {
      const Shot middle = shoot((a.speed + b.speed) / 2);
      if (!middle.arrival) return;
      ((*middle.arrival < 0) == (*a.arrival < 0) ? a : b) = middle;
    }
    out_.arrivals.push_back(path_of((a.speed + b.speed) / 2));
  }

  /// The motion itself at the nodes of a mesh with about an element a step, whose breaks include the kinks passed.
  Trial path_of(double speed) {
    Trial out{mesh_along(speed), {}, Vector::Zero(0), Vector::Zero(1)};
    out.q = Matrix::Constant(1, out.mesh.nodes(), from_);
    stepper_.start(ends_.start, {&from_, 1}, {&speed, 1});
    Index k = 1;
    while (stepper_.time() != ends_.end && stepper_.step(ends_.end).ending == StepEnding::None)
      for (double q = 0, v = 0; k < out.q.cols() && stepper_.covers(out.mesh.time(k)); ++k) {
        stepper_.state(out.mesh.time(k), {&q, 1}, {&v, 1});
        out.q(0, k) = q;
      }
    for (; k < out.q.cols(); ++k) out.q(0, k) = to_;
    out.q(0, out.q.cols() - 1) = to_;
    return out;
  }

  Mesh mesh_along(double speed) {
    stepper_.start(ends_.start, {&from_, 1}, {&speed, 1});
    std::size_t steps = 0;
    std::vector<double> passed;  // steps end where the motion passes a kink
    std::vector<bool> before;
    for (double t = ends_.start; t != ends_.end && stepper_.step(ends_.end).ending == StepEnding::None; ++steps) {
      const std::vector<bool> sides = sides_of_kinks(t + (stepper_.time() - t) / 2);
      if (steps > 0 && sides != before) passed.push_back(t);
      before = sides;
      t = stepper_.time();
    }
    const Index elements = std::clamp<Index>(static_cast<Index>(steps), 4, 80);
    return mesh_with_breaks(problem_.rule, ends_.start, ends_.end, elements, passed);
  }

  /// On which side of each kink the motion is, at a time within the last step.
  std::vector<bool> sides_of_kinks(double t) {
    if (problem_.kinks.empty()) return {};
    double q = 0, v = 0;
    stepper_.state(t, {&q, 1}, {&v, 1});
    std::vector<bool> out;
    for (const double g : kink_values(problem_.kinks, {t, {q}, {v}}, *problem_.equations.system)) out.push_back(g > 0);
    return out;
  }

  Problem& problem_;
  const ActionEnds& ends_;
  double from_, to_;
  Kernel kernel_;
  TaylorStepper stepper_;
  Shots out_;
};

}  // namespace

Shots shoot_all(Problem& problem, const ActionEnds& ends, const StopFlag* interrupt) {
  return Shooter(problem, ends, interrupt).run();
}

}  // namespace maupertuis::action
