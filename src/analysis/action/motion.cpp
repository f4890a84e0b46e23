#include "analysis/action/problem.hpp"

#include <maupertuis/degenerate.hpp>
#include <maupertuis/integrator.hpp>
#include <maupertuis/motion_kernel.hpp>
#include <maupertuis/orbits.hpp>
#include <maupertuis/simulation.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

/// Motions as paths: each is stationary between the ends that it reaches.
namespace maupertuis {
namespace {

using namespace action;

constexpr int rows_of_motion = 400;
constexpr Index fewest_elements_of_motion = 6;
constexpr int other_order = 24;  // of Taylor's polynomials, beside the usual 20: errors of a motion are not the same
constexpr std::size_t looked_ahead = 4;  // times the steps of a path: beyond that their number is estimated
constexpr std::size_t most_unknowns_of_motion = 4000;  // of the second variation: steps times coordinates
constexpr double shortest_element = 1e-12;             // of the whole: a shorter step belongs to the next one

std::optional<double> length_of_run(const Problem& problem, Diagnostics& diagnostics) {
  const Experiment& experiment = problem.model.experiment;
  const Expr written = experiment.duration ? experiment.duration : experiment.within;
  const double length = written ? problem.number(written) : 0;
  if (written && length > 0 && std::isfinite(length)) return length;
  diagnostics.error("E1207", {}, "there is no path: neither ends nor a run",
                    "The action belongs to a path: between two configurations, along formulas, or along a motion of a "
                    "certain length.",
                    "Write `path from (…) at 0 to (…) at 1` or `run 10 s` into the model, or give --ends or --path.");
  return std::nullopt;
}

/// A motion on a mesh with an element for each of its steps: these follow how fast it turns.
struct Followed {
  Trial trial;
  std::vector<MotionState> states;  // at the breaks of the mesh
  double unsure = 0;                // of S: by what elements half as long, and another integration, differ
};

/// Carries a motion, and its values to any places on the way.
class Follower {
 public:
  Follower(Problem& problem, const MotionState& start, double duration, const TaylorOptions& options)
      : problem_(problem),
        start_(start),
        end_(start.t + duration),
        motion_(motion_kernel(solvable_equations(problem.equations))),
        stepper_(motion_.kernel, motion_.parameters, options) {}

  /// Where steps end, first the start; nothing where the motion ends before, as `last` says then. No further than
  /// `most` steps: then the last one does not come to the end, and `taken` says how many it would be.
  std::optional<std::vector<double>> steps(Step& last, std::size_t most, double& taken) {
    std::vector<double> out{start_.t};
    std::size_t count = 0;
    for (stepper_.start(start_.t, start_.q, start_.v); stepper_.time() != end_;) {
      last = stepper_.step(end_);
      if (last.ending != StepEnding::None) return std::nullopt;
      taken = static_cast<double>(++count);
      if (count >= most && stepper_.time() != end_) {
        taken *= (end_ - start_.t) / (stepper_.time() - start_.t);
        return out;
      }
      if (stepper_.time() - out.back() > shortest_element * (end_ - start_.t)) out.push_back(stepper_.time());
    }
    out.back() = end_;
    return out;
  }

  /// The same motion on a mesh.
  Followed on(const Mesh& mesh) {
    const Index n = problem_.n();
    Followed out{
        {mesh, Matrix(n, mesh.nodes()), Vector::Zero(problem_.functional.integrals()), Vector::Zero(n)}, {}, 0};
    std::vector<double> q(start_.q), v(start_.v);
    const auto put = [&](Index node) {
      out.trial.q.col(node) = Eigen::Map<const Vector>(q.data(), n);
      if (node % mesh.rule->degree == 0) out.states.push_back({mesh.time(node), q, v});
    };
    put(0);
    Index k = 1;
    for (stepper_.start(start_.t, start_.q, start_.v); stepper_.time() != end_;) {
      if (stepper_.step(end_).ending != StepEnding::None) break;
      for (; k + 1 < mesh.nodes() && stepper_.covers(mesh.time(k)); ++k) {
        stepper_.state(mesh.time(k), q, v);
        put(k);
      }
    }
    q.assign(stepper_.q().begin(), stepper_.q().end());
    v.assign(stepper_.v().begin(), stepper_.v().end());
    put(mesh.nodes() - 1);
    return out;
  }

 private:
  Problem& problem_;
  const MotionState& start_;
  double end_;
  MotionKernel motion_;
  TaylorStepper stepper_;
};

/// Elements between the steps, each cut into so many that a mesh has at least six, but at least `parts`.
Mesh mesh_between(const Problem& problem, const std::vector<double>& steps, Index parts) {
  const auto count = static_cast<Index>(steps.size()) - 1;
  parts = std::max(parts, (fewest_elements_of_motion + count - 1) / count);
  const double begin = steps.front(), whole = steps.back() - begin;
  Mesh out{problem.rule, begin, whole, Pace::Even, false, {}, {}};
  for (std::size_t e = 0; e + 1 < steps.size(); ++e)
    for (Index part = 0; part < parts; ++part)
      out.begins.push_back(
          (steps[e] - begin + (steps[e + 1] - steps[e]) * static_cast<double>(part) / static_cast<double>(parts)) /
          whole);
  for (std::size_t e = 0; e < out.begins.size(); ++e)
    out.lengths.push_back((e + 1 < out.begins.size() ? out.begins[e + 1] : 1.0) - out.begins[e]);
  return out;
}

MotionState one_rounding_aside(MotionState state) {
  for (double& x : state.q) x *= 1 + 2 * rounding_unit;
  for (double& x : state.v) x *= 1 - 2 * rounding_unit;
  return state;
}

std::optional<Followed> follow(Problem& problem, const MotionState& start, double duration,
                               const ActionOptions& options, Diagnostics& diagnostics) {
  Follower follower(problem, start, duration, {.interrupt = options.interrupt});
  Step last;
  const std::size_t most = most_unknowns_of_motion / static_cast<std::size_t>(problem.n());
  double taken = 0;
  const auto steps = follower.steps(last, looked_ahead * most, taken);
  if (interrupted(options, diagnostics)) return std::nullopt;
  if (!steps) {
    diagnostics.error("E1208", {}, fmt::format("the motion ends at {}", place(last.begin, problem.model.system)),
                      last.reason, "Choose another start, or a shorter run.");
    return std::nullopt;
  }
  if (steps->size() > most || steps->back() != start.t + duration) {
    diagnostics.error("E1211", {},
                      fmt::format("the motion takes {:.3g} steps, more than the {} of a path", taken, most),
                      "A path has elements as short as the steps of the motion, so that they follow its fastest turns.",
                      "Take a shorter run: S of motions that follow one another adds up.");
    return std::nullopt;
  }
  Followed out = follower.on(mesh_between(problem, *steps, 1));
  const auto action = [&](const Trial& trial) { return assemble(problem.functional, trial, 0).action; };
  const double here = action(out.trial), finer = action(follower.on(mesh_between(problem, *steps, 2)).trial);
  const MotionState aside = one_rounding_aside(start);
  Follower other(problem, aside, duration, {.order = other_order, .interrupt = options.interrupt});
  out.unsure = std::abs(here - finer) + std::abs(here - action(other.on(out.trial.mesh).trial));
  if (interrupted(options, diagnostics)) return std::nullopt;
  return out;
}

/// Where q'' stands in L, p is no part of an end.
ActionEnds ends_of_trial(const Trial& trial, const OrderOfCoordinates& orders) {
  ActionEnds out;
  for (Index i = 0; i < trial.q.rows(); ++i) {
    out.from.emplace_back(trial.q(i, 0));
    out.to.emplace_back(trial.q(i, trial.q.cols() - 1));
  }
  for (const Index p : orders.momenta) out.from[static_cast<std::size_t>(p)] = out.to[static_cast<std::size_t>(p)] = {};
  out.start = trial.mesh.start;
  out.end = trial.mesh.t(1);
  return out;
}

/// A motion is stationary as it is: the mesh is not moved.
std::optional<Refined> as_refined(Problem& problem, const Followed& motion, Diagnostics& diagnostics) {
  Refined out;
  out.coarse = out.fine = motion.trial;
  out.states = motion.states;
  const Assembly a = assemble(problem.functional, motion.trial, 0);
  if (!a.finite) {
    diagnose_infinite_lagrangian("motion", diagnostics);
    return std::nullopt;
  }
  out.action = a.action;
  out.action_error = motion.unsure + rounding_of_action(problem.functional, motion.trial);
  return out;
}

Trajectory rows_of(Problem& problem, const Trial& trial) {
  const MechanicalSystem& system = problem.model.system;
  Trajectory out;
  out.independent = {system.independent, system.independent_unit()};
  const auto unit = [&](const Dimension& d) {
    const std::string text = system.dimensionless ? "" : to_string(d);
    return text == "1" ? std::string() : text;
  };
  for (const Coordinate& c : system.coordinates) out.columns.push_back({c.name, unit(c.dimension)});
  const Dimension action = system.lagrangian_dimension * system.independent_dimension;
  const bool of_mechanics = !system.dimensionless && action.same_as(dimensions::energy() * dimensions::time());
  out.columns.push_back({"S", of_mechanics ? "J s" : unit(action)});
  double so_far = 0;
  const Index p = trial.mesh.rule->degree;
  for (Index e = 0; e < trial.mesh.elements(); ++e) {
    const auto row = [&](Index node) {
      out.times.push_back(trial.mesh.time(node));
      for (Index i = 0; i < trial.q.rows(); ++i) out.values.push_back(trial.q(i, node));
      out.values.push_back(so_far);
    };
    if (e == 0) row(0);
    Trial piece = trial;
    piece.mesh.begins = {trial.mesh.begins[static_cast<std::size_t>(e)]};
    piece.mesh.lengths = {trial.mesh.lengths[static_cast<std::size_t>(e)]};
    piece.q = trial.element(e);
    so_far += assemble(problem.functional, piece, 0).action;
    row((e + 1) * p);
  }
  return out;
}

}  // namespace

std::optional<MotionAction> action_of_motion(const Model& model, const EquationsOfMotion& equations,
                                             const ActionOptions& options, Diagnostics& diagnostics) {
  if (!has_action(equations, diagnostics)) return std::nullopt;
  if (refuse_free_functions(equations, "actions along it", diagnostics)) return std::nullopt;
  Problem problem(model, equations);
  const auto length = length_of_run(problem, diagnostics);
  if (!length) return std::nullopt;
  const auto start = consistent_start(model, equations, diagnostics);
  if (!start) return std::nullopt;
  const auto followed = follow(problem, start->state, *length, options, diagnostics);
  if (!followed) return std::nullopt;
  const auto refined = as_refined(problem, *followed, diagnostics);
  if (!refined) return std::nullopt;
  MotionAction out;
  out.path = describe(problem, *refined, ends_of_trial(followed->trial, problem.functional.orders()), {}, options,
                      diagnostics);
  if (interrupted(options, diagnostics)) return std::nullopt;
  out.path.found_from = "the model's start";
  out.path.start_velocity = start->state.v;
  out.rows = rows_of(problem, followed->trial);
  return out;
}

std::optional<PeriodicAction> action_of_orbit(const Model& model, const EquationsOfMotion& equations,
                                              std::optional<double> period, const ActionOptions& options,
                                              Diagnostics& diagnostics) {
  if (!has_action(equations, diagnostics)) return std::nullopt;
  const auto found = floquet(model, equations, {period, options.interrupt}, diagnostics);
  if (!found) return std::nullopt;
  Problem problem(model, equations);
  // A turning point is conjugate to itself after a period: the path begins elsewhere on the orbit.
  MotionState start = found->motion.start;
  constexpr double aside = 0.1373;
  if (!found->motion.driven) {
    const auto on_the_way = follow(problem, start, aside * found->motion.period, options, diagnostics);
    if (!on_the_way) return std::nullopt;
    start = {start.t, on_the_way->states.back().q, on_the_way->states.back().v};
  }
  auto followed = follow(problem, start, found->motion.period, options, diagnostics);
  if (!followed) return std::nullopt;
  Trial& trial = followed->trial;
  trial.mesh.closed = true;
  trial.advance = Vector::Zero(problem.n());
  for (Index i = 0; i < problem.n(); ++i)
    trial.advance[i] = found->motion.turns[static_cast<std::size_t>(i)] * 6.283185307179586476925;
  trial.q.conservativeResize(Eigen::NoChange, trial.mesh.nodes());
  ActionEnds ends = ends_of_trial(trial, problem.functional.orders());
  ends.closed = true;
  const auto refined = as_refined(problem, *followed, diagnostics);
  if (!refined) return std::nullopt;
  PeriodicAction out;
  out.path = describe(problem, *refined, ends, {}, options, diagnostics);
  if (interrupted(options, diagnostics)) return std::nullopt;
  out.path.found_from = "the periodic motion next to the model's start";
  out.path.start_velocity = start.v;
  out.period = found->motion.period;
  const double energy = out.path.start_energy.value_or(0);
  out.abbreviated = out.path.action + energy * out.period;
  // ∂S/∂T = −h_E: what the period is unsure by.
  out.path.action_error += std::abs(energy) * out.period * (found->motion.closure + 4 * rounding_unit);
  return out;
}

Trajectory path_rows(const std::vector<const ActionPath*>& paths, const MechanicalSystem& system) {
  Trajectory out;
  out.independent = {system.independent, system.independent_unit()};
  const auto unit = [&](const Dimension& d) {
    const std::string text = system.dimensionless ? "" : to_string(d);
    return text == "1" ? std::string() : text;
  };
  if (paths.size() > 1) out.columns.push_back({"path", ""});
  for (const Coordinate& c : system.coordinates) out.columns.push_back({c.name, unit(c.dimension)});
  for (const Coordinate& c : system.coordinates)
    out.columns.push_back({c.name + "'", unit(c.dimension / system.independent_dimension)});
  for (std::size_t p = 0; p < paths.size(); ++p)
    for (int k = 0; k <= rows_of_motion; ++k) {
      const double t = k == rows_of_motion ? paths[p]->end
                                           : paths[p]->start + (paths[p]->end - paths[p]->start) * k / rows_of_motion;
      const MotionState s = paths[p]->at(t);
      out.times.push_back(t);
      if (paths.size() > 1) out.values.push_back(static_cast<double>(p + 1));
      out.values.insert(out.values.end(), s.q.begin(), s.q.end());
      out.values.insert(out.values.end(), s.v.begin(), s.v.end());
    }
  return out;
}

}  // namespace maupertuis
