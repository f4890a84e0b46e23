#include "fields/coupled_mesh_run.hpp"

#include <maupertuis/evaluate.hpp>

#include "fields/outlook.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace maupertuis {
namespace {

/// Where values are looked at beside their places, in widths of the first mesh's cells: where waves have breaks, two
/// meshes agree by chance at single places.
constexpr double beside_places[] = {-0.9, -0.6, -0.3, 0.3, 0.6, 0.9};

/// Adds what a question asks for, and the same beside its place where there is a width; false where it cannot be.
bool add_probes(const SemiDiscrete& mesh, const FieldQuestion& question, double width, Probe& probe,
                Diagnostics& diagnostics) {
  const auto add = [&](double shift) {
    const Expr value = mesh.discretised(question, diagnostics, shift);
    if (value) probe.expressions.push_back(expand_time_derivatives(value));
    return static_cast<bool>(value);
  };
  if (!add(0)) return false;
  for (const double part : beside_places)
    if (width > 0 && !question.total && !add(part * width)) return false;
  return true;
}

/// Moments at which a mass is looked at beside its own: in parts of the time since the beginning.
constexpr double before_moments[] = {1.0 / 64, 2.0 / 64, 3.0 / 64, 5.0 / 64, 8.0 / 64, 13.0 / 64};

/// The moment of a question, and those before it where it is about masses alone.
std::vector<double> moments_of(const SemiDiscrete& mesh, const FieldQuestion& question) {
  std::vector<double> out{question.time};
  if (mesh.model().system.has_modes() || !mesh.stands_on_masses(question)) return out;
  for (const double part : before_moments) out.push_back(question.time - part * (question.time - mesh.begin()));
  return out;
}

std::vector<double> times_of(const SemiDiscrete& mesh, const std::vector<FieldQuestion>& questions) {
  std::vector<double> out;
  for (const FieldQuestion& q : questions)
    for (const double t : moments_of(mesh, q))
      if (std::find(out.begin(), out.end(), t) == out.end()) out.push_back(t);
  return out;
}

/// What the probes say of a question: its answer, and the same beside it, at other places or at other moments.
void read_probes(const Probe& probe, const std::vector<double>& times, const std::vector<double>& moments,
                 std::size_t first, std::size_t end, double& answer, std::vector<double>& near) {
  for (std::size_t k = 0; k < times.size() && k < probe.values.size(); ++k) {
    const auto moment = std::find(moments.begin(), moments.end(), times[k]);
    if (moment == moments.end() || end > probe.values[k].size()) continue;
    const auto values = probe.values[k].begin();
    if (moment != moments.begin()) {
      near.push_back(values[static_cast<std::ptrdiff_t>(first)]);
      continue;
    }
    answer = values[static_cast<std::ptrdiff_t>(first)];
    if (moments.size() == 1)
      near.assign(values + static_cast<std::ptrdiff_t>(first + 1), values + static_cast<std::ptrdiff_t>(end));
  }
}

/// h_E of a state.
double energy_at(const EquationsOfMotion& equations, const State& state) {
  const MechanicalSystem& system = *equations.system;
  Bindings at{{system.context->time(), state.t}};
  for (const Parameter& p : system.parameters) at[p.symbol] = p.si_value;
  for (std::size_t i = 0; i < system.coordinates.size() && i < state.q.size(); ++i)
    at[system.coordinates[i].q] = state.q[i], at[system.coordinates[i].velocity] = state.v[i];
  for (const Input& input : system.inputs)
    if (input.formula) at[input.symbol] = evaluate(input.formula, at);
  const Expr h[] = {expand_time_derivatives(equations.energy_function)};
  return RepeatedEvaluation(h)([&](Expr symbol) {
           const auto value = at.find(symbol);
           return value == at.end() ? std::nan("") : value->second;
         })
      .front();
}

}  // namespace

std::optional<CoupledRun> run_once(const SemiDiscrete& mesh, const std::vector<FieldQuestion>& questions, double width,
                                   const FieldRunOptions& options, Diagnostics& diagnostics) {
  const auto system = std::make_shared<const MechanicalSystem>(mesh.model().system);
  const auto equations = euler_lagrange(system, diagnostics);
  if (!equations) return std::nullopt;
  SimulationOptions settings;
  settings.at = times_of(mesh, questions);
  if (settings.at.empty()) settings.at.push_back(options.begin + options.duration);
  if (options.duration > 0) settings.duration = options.duration;
  if (options.every > 0) settings.output_every = options.every;
  settings.errors = ErrorEstimates::None;
  Outlook outlook(options);
  std::size_t steps = 0;
  settings.progress = [&](double share) {
    constexpr std::size_t between = 1024;  // steps from one call to the next
    outlook.after_steps(steps += between, share);
    if (options.progress) options.progress(share);
  };
  Probe probe;
  std::vector<std::size_t> of_question{0};  // the first probe of each
  for (const FieldQuestion& q : questions) {
    if (!add_probes(mesh, q, width, probe, diagnostics)) return std::nullopt;
    of_question.push_back(probe.expressions.size());
  }
  auto result = simulate(mesh.model(), *equations, settings, diagnostics, &probe);
  if (!result) return std::nullopt;
  CoupledRun out{std::move(*result), {}, {}, 0};
  out.answers.assign(questions.size(), std::nan("")), out.near.resize(questions.size());
  for (std::size_t i = 0; i < questions.size(); ++i)
    read_probes(probe, settings.at, moments_of(mesh, questions[i]), of_question[i], of_question[i + 1], out.answers[i],
                out.near[i]);
  out.energy = energy_at(*equations, out.result.final);
  return out;
}

}  // namespace maupertuis
