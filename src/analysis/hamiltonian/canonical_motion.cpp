#include "analysis/hamiltonian/canonical_kernel.hpp"

#include <maupertuis/function_kernel.hpp>
#include <maupertuis/integrator.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace maupertuis {

using namespace phase_space;

namespace {

std::vector<double> values_of(const MechanicalSystem& system) {
  std::vector<double> values;
  for (const Parameter& p : system.parameters) values.push_back(p.si_value);
  return values;
}

/// ∂L/∂q̇ at points of a run.
class Momenta {
 public:
  Momenta(const Hamiltonian& h) : n_(h.momenta.size()), work_(kernel_of(h)), input_(2 * n_ + 1) {
    work_.set_parameters(values_of(*h.system));
  }

  std::vector<double> at(double t, const double* q, const double* v) {
    std::copy(q, q + n_, input_.begin());
    std::copy(v, v + n_, input_.begin() + static_cast<std::ptrdiff_t>(n_));
    input_.back() = t;
    std::vector<double> p(n_);
    work_.evaluate(input_, p);
    return p;
  }

 private:
  static FunctionKernel kernel_of(const Hamiltonian& h) {
    FunctionSource source;
    for (const Coordinate& c : h.system->coordinates) source.inputs.push_back(c.q);
    for (const Coordinate& c : h.system->coordinates) source.inputs.push_back(c.velocity);
    source.inputs.push_back(h.system->context->time());
    for (const Parameter& p : h.system->parameters) source.parameters.push_back(p.symbol);
    source.outputs = in_terms_of_motion(*h.system, with_definitions(*h.system, h.momentum_values));
    return build_function(source);
  }

  std::size_t n_;
  FunctionWorkspace work_;
  std::vector<double> input_;
};

/// Constraints whose rows of A are no combination of those before them, at the start. In phase space a redundant one
/// would not show as a row that depends on others: the row of d/dt dφ/dt = 0 in (q̇, ṗ) has the derivatives of A in it.
std::vector<std::size_t> independent_constraints(const EquationsOfMotion& equations, const State& start) {
  constexpr double least_part = 1e-9;  // of a row, that is not a combination of others
  if (!equations.system->constrained()) return {};
  const ConstraintManifold manifold(equations);
  const MotionState state{start.t, start.q, start.v};
  const std::vector<double> a = manifold.matrix(state), mass = manifold.mass(state);
  const std::size_t n = start.q.size();
  std::vector<std::vector<double>> orthonormal;
  std::vector<std::size_t> kept;
  for (std::size_t k = 0; k < manifold.constraints(); ++k) {
    std::vector<double> row(n);
    for (std::size_t i = 0; i < n; ++i) row[i] = a[k * n + i] / std::sqrt(mass[i * n + i] > 0 ? mass[i * n + i] : 1);
    const auto norm = [&] { return std::sqrt(std::inner_product(row.begin(), row.end(), row.begin(), 0.0)); };
    const double size = norm();
    for (const auto& known : orthonormal) {
      const double part = std::inner_product(row.begin(), row.end(), known.begin(), 0.0);
      for (std::size_t i = 0; i < n; ++i) row[i] -= part * known[i];
    }
    const double rest = norm();
    if (!(rest > least_part * size)) continue;
    for (double& x : row) x /= rest;
    orthonormal.push_back(std::move(row));
    kept.push_back(k);
  }
  return kept;
}

TaylorOptions taylor_options(const SimulationOptions& options) {
  TaylorOptions out;
  out.tolerance = !options.method || *options.method == StepMethod::Taylor || *options.method == StepMethod::Automatic
                      ? options.tolerance
                      : 0;
  out.maximum_steps = options.maximum_steps;
  out.interrupt = options.interrupt;
  out.backend = options.backend;
  out.cache = options.cache;
  return out;
}

Dimension dimension_of_momentum(const MechanicalSystem& s, const Coordinate& c) {
  return s.lagrangian_dimension * s.independent_dimension / c.dimension;
}

void name_columns(const Hamiltonian& h, Trajectory& trajectory) {
  trajectory.independent = {h.system->independent, h.system->independent_unit()};
  const auto column = [&](const std::string& name, const Dimension& d) {
    const std::string unit = h.system->dimensionless ? "" : to_string(d);
    trajectory.columns.push_back({name, unit == "1" ? "" : unit});
  };
  for (const Coordinate& c : h.system->coordinates) column(c.name, c.dimension);
  for (std::size_t i = 0; i < h.momenta.size(); ++i)
    column(momentum_name(*h.system, i), dimension_of_momentum(*h.system, h.system->coordinates[i]));
  column("H", h.system->lagrangian_dimension);
}

/// The largest difference from the run, each column against the largest value among those of its dimension.
class Differences {
 public:
  explicit Differences(const Hamiltonian& h)
      : h_(h), largest_(2 * h.momenta.size(), 0), size_(largest_), time_(largest_) {}

  void add(double t, const std::vector<double>& canonical, const std::vector<double>& lagrangian) {
    for (std::size_t i = 0; i < largest_.size(); ++i) {
      const double off = std::abs(canonical[i] - lagrangian[i]);
      if (off > largest_[i]) largest_[i] = off, time_[i] = t;
      size_[i] = std::max(size_[i], std::abs(lagrangian[i]));
    }
  }

  /// Terms of this size add up to the momentum, which may vanish.
  void has_terms(std::size_t momentum, double size) {
    double& known = size_[h_.momenta.size() + momentum];
    known = std::max(known, size);
  }

  void report(CanonicalMotion& out) const {
    for (std::size_t i = 0; i < largest_.size(); ++i) {
      double size = 0;
      for (std::size_t j = 0; j < largest_.size(); ++j)
        if (unit(i).same_as(unit(j))) size = std::max(size, size_[j]);
      const double relative = size > 0 ? largest_[i] / size : largest_[i];
      if (relative <= out.difference) continue;
      const std::size_t n = h_.momenta.size();
      out.difference = relative;
      out.difference_name = i < n ? h_.system->coordinates[i].name : momentum_name(*h_.system, i - n);
      out.difference_time = time_[i];
    }
  }

 private:
  Dimension unit(std::size_t i) const {
    const std::size_t n = h_.momenta.size();
    return i < n ? h_.system->coordinates[i].dimension
                 : dimension_of_momentum(*h_.system, h_.system->coordinates[i - n]);
  }

  const Hamiltonian& h_;
  std::vector<double> largest_, size_, time_;
};

bool can_be_integrated(const Hamiltonian& h, Diagnostics& diagnostics) {
  if (h.regular()) return true;
  diagnostics.error("E1102", std::nullopt, "the canonical equations cannot be integrated",
                    h.value ? "The Legendre transform is singular: the momenta do not determine the velocities."
                            : "The velocities could not be written in terms of the momenta.",
                    "`maup simulate` integrates Lagrange's equations, which need no Legendre transform.");
  return false;
}

}  // namespace

std::optional<CanonicalMotion> canonical_motion(const Hamiltonian& h, const EquationsOfMotion& equations,
                                                const SimulationResult& run, const SimulationOptions& options,
                                                Diagnostics& diagnostics) {
  if (!can_be_integrated(h, diagnostics)) return std::nullopt;
  const std::size_t n = h.momenta.size();
  Momenta momenta(h);
  std::vector<double> state = run.start.q;
  const std::vector<double> p = momenta.at(run.start.t, run.start.q.data(), run.start.v.data());
  state.insert(state.end(), p.begin(), p.end());

  TaylorStepper stepper(canonical_kernel(h, equations, independent_constraints(equations, run.start)),
                        values_of(*h.system), taylor_options(options));
  stepper.start(run.start.t, std::vector<double>(2 * n, 0), state);
  CanonicalMotion out;
  out.order = stepper.order();
  name_columns(h, out.trajectory);
  Differences differences(h);
  const auto& times = run.trajectory.times;
  std::size_t next = 0;
  const auto record = [&] {
    for (; next < times.size() && stepper.covers(times[next]); ++next) {
      const Sample sample = stepper.sample(times[next]);
      const double* row = run.trajectory.values.data() + next * run.trajectory.columns.size();
      std::vector<double> reference(row, row + n);
      const std::vector<double> there = momenta.at(times[next], row, row + n);
      reference.insert(reference.end(), there.begin(), there.end());
      differences.add(times[next], sample.v, reference);
      out.trajectory.times.push_back(sample.t);
      out.trajectory.values.insert(out.trajectory.values.end(), sample.v.begin(), sample.v.end());
      out.trajectory.values.push_back(sample.observables.front());
    }
  };
  const std::vector<double> mass = ConstraintManifold(equations).mass({run.start.t, run.start.q, run.start.v});
  const auto note_terms = [&](const double* v) {
    for (std::size_t i = 0; i < n; ++i) {
      double size = 0;
      for (std::size_t j = 0; j < n; ++j) size += std::abs(mass[i * n + j] * v[j]);
      differences.has_terms(i, size);
    }
  };
  for (std::size_t k = 0; k < times.size(); ++k)
    note_terms(run.trajectory.values.data() + k * run.trajectory.columns.size() + n);
  record();
  while (stepper.time() != run.final.t) {
    const Step step = stepper.step(run.final.t);
    record();
    if (step.ending == StepEnding::None) continue;
    out.ending = step.reason;
    break;
  }
  const auto z = stepper.v();
  out.final_q.assign(z.begin(), z.begin() + static_cast<std::ptrdiff_t>(n));
  out.final_p.assign(z.begin() + static_cast<std::ptrdiff_t>(n), z.end());
  out.final_time = stepper.time();
  out.steps = stepper.steps();
  out.trajectory.metadata["system"] = h.system->name;
  out.trajectory.metadata["method"] = fmt::format("canonical equations, Taylor, order {}", out.order);
  differences.report(out);
  return out;
}

}  // namespace maupertuis
