#include "analysis/action/problem.hpp"

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

/// The motion at the nodes of a mesh with an element for each of its steps.
std::optional<Trial> follow(Problem& problem, const MotionState& start, double duration, const ActionOptions& options,
                            Diagnostics& diagnostics) {
  const MotionKernel motion = motion_kernel(problem.equations);
  TaylorStepper stepper(motion.kernel, motion.parameters, {.interrupt = options.interrupt});
  const double end = start.t + duration;
  std::size_t steps = 0;
  for (stepper.start(start.t, start.q, start.v); stepper.time() != end; ++steps)
    if (const Step step = stepper.step(end); step.ending != StepEnding::None) {
      if (interrupted(options, diagnostics)) return std::nullopt;
      diagnostics.error("E1208", {}, fmt::format("the motion ends at {}", place(step.begin, problem.model.system)),
                        step.reason, "Choose another start, or a shorter run.");
      return std::nullopt;
    }
  Trial out{even_mesh(problem.rule, start.t, end, std::clamp<Index>(static_cast<Index>(2 * steps), 6, 400)),
            {},
            Vector::Zero(problem.functional.integrals()),
            Vector::Zero(problem.n())};
  out.q.resize(problem.n(), out.mesh.nodes());
  std::vector<double> q(start.q), v(start.v);
  out.q.col(0) = Eigen::Map<const Vector>(q.data(), problem.n());
  stepper.start(start.t, start.q, start.v);
  for (Index k = 1; stepper.time() != end;) {
    if (stepper.step(end).ending != StepEnding::None && interrupted(options, diagnostics)) return std::nullopt;
    for (; k < out.q.cols() && stepper.covers(out.mesh.time(k)); ++k) {
      stepper.state(out.mesh.time(k), q, v);
      out.q.col(k) = Eigen::Map<const Vector>(q.data(), problem.n());
    }
  }
  out.q.col(out.q.cols() - 1) = Eigen::Map<const Vector>(stepper.q().data(), problem.n());
  return out;
}

ActionEnds ends_of_trial(const Trial& trial) {
  ActionEnds out;
  for (Index i = 0; i < trial.q.rows(); ++i) {
    out.from.emplace_back(trial.q(i, 0));
    out.to.emplace_back(trial.q(i, trial.q.cols() - 1));
  }
  out.start = trial.mesh.start;
  out.end = trial.mesh.t(1);
  return out;
}

/// A motion is stationary as it is: the mesh is not moved, only compared with its halves.
std::optional<Refined> as_refined(Problem& problem, const Trial& trial, Diagnostics& diagnostics) {
  Refined out;
  out.coarse = trial;
  out.fine = trial;
  const Assembly a = assemble(problem.functional, trial, 0);
  const Trial halves = halved(trial, std::vector<bool>(static_cast<std::size_t>(trial.mesh.elements()), true));
  const Assembly finer = assemble(problem.functional, halves, 0);
  if (!a.finite || !finer.finite) {
    diagnose_infinite_lagrangian("motion", diagnostics);
    return std::nullopt;
  }
  out.action = finer.action;
  out.action_error = std::abs(out.action - a.action) + rounding_of_action(problem.functional, halves);
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
  Problem problem(model, equations);
  const auto length = length_of_run(problem, diagnostics);
  if (!length) return std::nullopt;
  const auto start = consistent_start(model, equations, diagnostics);
  if (!start) return std::nullopt;
  const auto trial = follow(problem, start->state, *length, options, diagnostics);
  if (!trial) return std::nullopt;
  const auto refined = as_refined(problem, *trial, diagnostics);
  if (!refined) return std::nullopt;
  MotionAction out;
  out.path = describe(problem, *refined, ends_of_trial(*trial), {}, options, diagnostics);
  if (interrupted(options, diagnostics)) return std::nullopt;
  out.path.found_from = "the model's start";
  out.rows = rows_of(problem, *trial);
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
    const MotionState there = to_path(*on_the_way).at(on_the_way->mesh.t(1));
    start = {start.t, there.q, there.v};
  }
  auto trial = follow(problem, start, found->motion.period, options, diagnostics);
  if (!trial) return std::nullopt;
  trial->mesh.closed = true;
  trial->advance = Vector::Zero(problem.n());
  for (Index i = 0; i < problem.n(); ++i)
    trial->advance[i] = found->motion.turns[static_cast<std::size_t>(i)] * 6.283185307179586476925;
  trial->q.conservativeResize(Eigen::NoChange, trial->mesh.nodes());
  ActionEnds ends = ends_of_trial(*trial);
  ends.closed = true;
  const auto refined = as_refined(problem, *trial, diagnostics);
  if (!refined) return std::nullopt;
  PeriodicAction out;
  out.path = describe(problem, *refined, ends, {}, options, diagnostics);
  if (interrupted(options, diagnostics)) return std::nullopt;
  out.path.found_from = "the periodic motion next to the model's start";
  out.period = found->motion.period;
  const double energy = out.path.start_energy.value_or(0);
  out.abbreviated = out.path.action + energy * out.period;
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
