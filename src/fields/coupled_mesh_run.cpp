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

std::vector<double> times_of(const std::vector<FieldQuestion>& questions) {
  std::vector<double> out;
  for (const FieldQuestion& q : questions)
    if (std::find(out.begin(), out.end(), q.time) == out.end()) out.push_back(q.time);
  return out;
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
  settings.at = times_of(questions);
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
    for (std::size_t k = 0; k < settings.at.size() && k < probe.values.size(); ++k)
      if (settings.at[k] == questions[i].time && of_question[i + 1] <= probe.values[k].size()) {
        const auto values = probe.values[k].begin();
        out.answers[i] = values[static_cast<std::ptrdiff_t>(of_question[i])];
        out.near[i].assign(values + static_cast<std::ptrdiff_t>(of_question[i] + 1),
                           values + static_cast<std::ptrdiff_t>(of_question[i + 1]));
      }
  out.energy = energy_at(*equations, out.result.final);
  return out;
}

}  // namespace maupertuis
