#include "analysis/orbits/any_motion.hpp"
#include "analysis/orbits/drive.hpp"
#include "analysis/orbits/messages.hpp"
#include "analysis/orbits/section_starts.hpp"
#include "analysis/orbits/survey.hpp"

#include <maupertuis/degenerate.hpp>

#include <maupertuis/integrator.hpp>
#include <maupertuis/transform.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

constexpr double runs_before_giving_up = 1e4;
constexpr double longest_without_a_run = 1e6;  // s

/// What is followed to its zeros. Of an angle a section means its place: sin(θ − c) vanishes there in every turn, and
/// where the cosine is positive it is this place and not the opposite one.
struct SectionFunction {
  Expr value;   // empty: a strobe
  Expr cosine;  // empty: no angle

  std::vector<Expr> parts() const {
    std::vector<Expr> out;
    for (const Expr& part : {value, cosine})
      if (part) out.push_back(part);
    return out;
  }
};

/// Whether the equations see no whole turns of this coordinate.
bool turns_unseen(const Model& model, const EquationsOfMotion& equations, std::size_t coordinate,
                  const StopFlag* interrupt) {
  if (equations.system->coordinates[coordinate].kind != "angle") return false;
  Diagnostics silent;
  const auto start = consistent_start(model, equations, silent);
  if (!start) return false;  // told later
  constexpr double part = 0.01;
  const double length = part * orbits::length_of_run(model, {}, silent).value_or(1);
  const MotionKernel motion = free_motion_kernel(equations);
  const orbits::Survey seen = orbits::survey(model, equations, motion, start->state, length, interrupt);
  return orbits::repeats_in_angle(*equations.system, motion, seen, coordinate);
}

/// θ − c, −θ + c, θ1 + θ2 − c of angles whose turns the equations do not see are places on a circle.
SectionFunction section_function(const Model& model, const EquationsOfMotion& equations,
                                 const SectionOptions& options) {
  const Expr section = options.section;
  if (!section) return {};
  const MechanicalSystem& system = *equations.system;
  const Expr value = in_terms_of_motion(system, {&section, 1}).front();
  ExprMap at_zero;
  for (std::size_t i = 0; i < system.coordinates.size(); ++i) {
    const Expr slope = differentiate(value, system.coordinates[i].q);
    if (slope.is_zero()) continue;
    const bool counts_turns = slope.is_number() && abs(slope.number()) == Rational(1);
    if (!counts_turns || !turns_unseen(model, equations, i, options.interrupt)) return {section, {}};
    at_zero.emplace(system.coordinates[i].q, system.context->number(Rational(0)));
  }
  const bool moves_otherwise = system.context->depends_on_time(substitute(value, at_zero).id());
  if (at_zero.empty() || moves_otherwise) return {section, {}};
  return {sin(value), cos(value)};
}

class SectionRun {
 public:
  SectionRun(const Model& model, const EquationsOfMotion& equations, const SectionOptions& options,
             const SectionFunction& function, Diagnostics& diagnostics)
      : model_(model),
        system_(*equations.system),
        equations_(equations),
        options_(options),
        function_(function),
        diagnostics_(diagnostics),
        motion_(free_motion_kernel(equations, events())),
        stepper_(stepper()) {
    if (options_.section) section_.emplace(system_, function.parts());
  }

  std::optional<SectionResult> carry_out() {
    if (!sound()) return std::nullopt;
    const auto start = consistent_start(model_, equations_, diagnostics_);
    if (!start || !limit()) return std::nullopt;
    out_.energy_conserved = orbits::keeps_energy(model_, equations_);
    auto starts = starts_from(start->state);
    if (!starts) return std::nullopt;
    for (std::size_t k = 0; k < starts->size(); ++k) {
      follow(k, (*starts)[k]);
      if (options_.progress) options_.progress((k + 1.0) / static_cast<double>(starts->size()));
      if (options_.interrupt && options_.interrupt->load()) break;
    }
    return crossed() ? std::optional(std::move(out_)) : std::nullopt;
  }

 private:
  std::vector<Expr> events() const {
    return options_.section ? std::vector<Expr>{function_.value} : std::vector<Expr>{};
  }

  std::unique_ptr<orbits::AnyMotion> stepper() const {
    const TaylorOptions options{.tolerance = options_.tolerance, .interrupt = options_.interrupt};
    if (!jumps_on_its_way(model_))
      return orbits::any_motion(TaylorStepper(motion_.kernel, motion_.parameters, options));
    return orbits::any_motion(MotionThroughModes(model_, equations_, function_.value, options));
  }

  bool sound() {
    if (options_.strobe && !(*options_.strobe > 0 && std::isfinite(*options_.strobe)))
      return orbits::refuse_no_time("the time between two flashes of the strobe", diagnostics_);
    if (!options_.section) return true;
    const Expr value = in_terms_of_motion(system_, {&options_.section, 1}).front();
    if (system_.context->depends_on_time(value.id())) return true;
    diagnostics_.error("E1409", {}, "the section does not depend on the motion",
                       "A section is where a function of the coordinates, velocities or time vanishes.",
                       "Write for example --section \"x = 0 rising\".");
    return false;
  }

  /// How long to wait for all crossings.
  bool limit() {
    if (options_.longest != 0) {
      limit_ = options_.longest;
      return (limit_ > 0 && std::isfinite(limit_)) || orbits::refuse_no_time("the longest time", diagnostics_);
    }
    Diagnostics silent;
    const auto run = orbits::length_of_run(model_, {}, silent);
    limit_ = run ? runs_before_giving_up * *run : longest_without_a_run;
    return true;
  }

  double energy_of(const MotionState& s) const {
    return tangent::PointFunctions(system_, {&equations_.energy_function, 1}).values(s)[0];
  }

  std::optional<std::vector<MotionState>> starts_from(const MotionState& start) {
    out_.across = 0;
    if (options_.starts <= 1 && !options_.energy) {
      if (section_ && system_.coordinates.size() > 1) out_.across = least_fixed(start);
      return std::vector{start};
    }
    if (!section_ || system_.coordinates.size() != 2 || system_.constrained() || !out_.energy_conserved) {
      diagnostics_.error("E1407", {}, "several starts at one energy cannot be had for this system",
                         "They need a section by positions, two coordinates, no constraints, and an energy that is "
                         "conserved: then a point of the section is a motion.",
                         "Take one start, and --start for others.");
      return std::nullopt;
    }
    const auto on_section = first_crossing(start);
    if (!on_section) return std::nullopt;
    const auto plane =
        orbits::spread_starts(equations_, options_, on_section->first, options_.energy.value_or(energy_of(start)),
                              on_section->second, diagnostics_);
    if (!plane) return std::nullopt;
    out_.across = plane->across;
    out_.outline = plane->outline;
    return plane->starts;
  }

  /// The coordinate that the section leaves most free.
  std::size_t least_fixed(const MotionState& s) const {
    const Eigen::MatrixXd slope = tangent::PointFunctions(system_, {&options_.section, 1}).slopes(s);
    std::size_t best = 0;
    for (std::size_t i = 1; i < s.q.size(); ++i)
      if (std::abs(slope(0, static_cast<Eigen::Index>(i))) < std::abs(slope(0, static_cast<Eigen::Index>(best))))
        best = i;
    return best;
  }

  /// A state of the model's own motion on the section, and the sizes of that motion until there.
  std::optional<std::pair<MotionState, std::vector<double>>> first_crossing(const MotionState& start) {
    SectionRun alone(model_, equations_, with_one_crossing(), function_, diagnostics_);
    alone.limit_ = limit_;
    alone.follow(0, start);
    if (!alone.crossed()) return std::nullopt;
    const MotionState at = alone.out_.crossings.front().state;
    const orbits::Survey seen =
        orbits::survey(model_, equations_, motion_, start, std::max(2 * (at.t - start.t), 1e-9), options_.interrupt);
    MotionState from = at;
    from.t = start.t;
    return std::pair(from, seen.sizes);
  }

  const SectionOptions& with_one_crossing() {
    alone_ = options_;
    alone_.crossings = 1;
    alone_.starts = 1;
    alone_.energy.reset();
    alone_.progress = nullptr;
    return alone_;
  }

  bool crossed() {
    if (!out_.crossings.empty()) return true;
    const SectionOrbit& first = out_.orbits.front();
    if (!first.ended.empty()) return orbits::refuse_end(first.reached, first.ended, diagnostics_);
    diagnostics_.error("E1405", {}, fmt::format("the motion never crosses the section in {:.6g} s", limit_),
                       "The function of the section keeps its sign, or passes zero in the other direction alone.",
                       turns_help() + "Choose another section, direction or start; --longest sets how long to wait.");
    return false;
  }

  /// A coordinate that turns may pass the same place in another turn; where it is no angle whose turns the equations do
  /// not see, the section means one of them.
  std::string turns_help() const {
    if (function_.cosine) return {};
    const Eigen::MatrixXd slope = tangent::PointFunctions(system_, {&options_.section, 1}).slopes(out_.orbits[0].start);
    for (std::size_t i = 0; i < system_.coordinates.size(); ++i)
      if (system_.coordinates[i].kind == "angle" && slope(0, static_cast<Eigen::Index>(i)) != 0)
        return fmt::format("For a place in every turn write a function that repeats with it, such as sin({}) = 0. ",
                           system_.coordinates[i].name);
    return {};
  }

  void follow(std::size_t index, const MotionState& start) {
    SectionOrbit orbit;
    orbit.start = start;
    orbit.energy = energy_of(start);
    stepper_->start(start.t, start.q, start.v);
    largest_value_ = 0;
    const std::size_t before = out_.crossings.size();
    if (options_.strobe)
      flash(index, orbit);
    else
      cross(index, orbit);
    orbit.crossings = out_.crossings.size() - before;
    orbit.reached = stepper_->time();
    out_.orbits.push_back(std::move(orbit));
  }

  bool advance(double bound, SectionOrbit& orbit, bool* hit) {
    const Step step = stepper_->step(bound);
    if (step.ending != StepEnding::None) orbit.ended = step.reason;
    if (const auto event = stepper_->stopped_by())
      orbit.ended = fmt::format("The event `{}` of the model stops it.", *event);
    *hit = step.event.has_value();
    if (!orbit.ended.empty()) return false;
    if (section_) middle_ = value_at(0.5 * (step.begin + step.end));
    return true;
  }

  void flash(std::size_t index, SectionOrbit& orbit) {
    bool hit = false;
    for (std::size_t k = 1; k <= options_.crossings; ++k) {
      const double t = orbit.start.t + *options_.strobe * static_cast<double>(k);
      while (stepper_->time() != t)
        if (!advance(t, orbit, &hit)) return;
      record(index, k, orbit);
    }
  }

  void cross(std::size_t index, SectionOrbit& orbit) {
    const double end = orbit.start.t + limit_;
    bool hit = false;
    for (std::size_t k = 1; k <= options_.crossings && stepper_->time() != end;) {
      if (!advance(end, orbit, &hit)) return;
      largest_value_ = std::max(largest_value_, std::abs(middle_));
      const bool rising = middle_ < 0;  // the sign up to the root, which is the first in the step
      const bool wanted =
          options_.direction == SectionDirection::Both || rising == (options_.direction == SectionDirection::Rising);
      if (hit && wanted && !opposite()) record(index, k++, orbit);
    }
  }

  MotionState state_at(double t) const {
    MotionState s{t, std::vector<double>(system_.coordinates.size()), std::vector<double>(system_.coordinates.size())};
    stepper_->state(t, s.q, s.v);
    return s;
  }
  double value_at(double t) const { return section_->values(state_at(t))[0]; }
  bool opposite() const { return function_.cosine && section_->values(state_at(stepper_->time()))[1] < 0; }

  void record(std::size_t index, std::size_t number, SectionOrbit& orbit) {
    const Sample sample = stepper_->sample(stepper_->time());
    out_.crossings.push_back({index, number, {sample.t, sample.q, sample.v}});
    double energy = 0, size = 0;
    for (std::size_t i = 0; i < motion_.energy_terms; ++i)
      energy += sample.observables[i], size += std::abs(sample.observables[i]);
    if (size > 0) orbit.energy_drift = std::max(orbit.energy_drift, std::abs(energy - orbit.energy) / size);
    if (section_ && !options_.strobe && largest_value_ > 0)
      out_.largest_miss =
          std::max(out_.largest_miss, std::abs(section_->values(out_.crossings.back().state)[0]) / largest_value_);
  }

  const Model& model_;
  const MechanicalSystem& system_;
  const EquationsOfMotion& equations_;
  const SectionOptions& options_;
  const SectionFunction& function_;
  Diagnostics& diagnostics_;
  MotionKernel motion_;
  std::unique_ptr<orbits::AnyMotion> stepper_;
  std::optional<tangent::PointFunctions> section_;
  SectionOptions alone_;
  double limit_ = 0, middle_ = 0, largest_value_ = 0;
  SectionResult out_;
};

}  // namespace

std::optional<SectionResult> poincare_section(const Model& model, const EquationsOfMotion& equations,
                                              const SectionOptions& options, Diagnostics& diagnostics) {
  if (refuse_free_functions(equations, "sections", diagnostics)) return std::nullopt;
  if (equations.determined)
    return poincare_section(with_determined_system(model, equations), *equations.determined, options, diagnostics);
  if (jumps_on_its_way(model) && !can_go_through_modes(equations, diagnostics)) return std::nullopt;
  const SectionFunction function = section_function(model, equations, options);
  return SectionRun(model, equations, options, function, diagnostics).carry_out();
}

}  // namespace maupertuis
