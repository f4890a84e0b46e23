#include "simulation/close_observables.hpp"

#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/motion_kernel.hpp>
#include <maupertuis/transform.hpp>

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

struct Kept {
  std::vector<std::size_t> which;
  ExprVector formulas;
};

Kept keep_known(const EquationsOfMotion& equations, std::span<const Expr> formulas, const ExprVector& symbols) {
  const ExprVector plain = expand_time_derivatives(in_terms_of_motion(*equations.system, formulas));
  Kept out;
  for (std::size_t i = 0; i < plain.size(); ++i) {
    const std::vector<Expr> asked = symbols_of({&plain[i], 1});
    const bool is_known = std::all_of(asked.begin(), asked.end(), [&](const Expr& s) {
      return std::find(symbols.begin(), symbols.end(), s) != symbols.end();
    });
    if (plain[i].is_symbol() || !is_known) continue;
    out.which.push_back(i);
    out.formulas.push_back(plain[i]);
  }
  return out;
}

/// t, q, q̇, the parameters.
ExprVector symbols_of_rows(const EquationsOfMotion& equations) {
  const MechanicalSystem& system = *equations.system;
  ExprVector out{system.context->time()};
  for (const Coordinate& c : system.coordinates) out.push_back(c.q);
  for (const Coordinate& c : system.coordinates) out.push_back(c.velocity);
  for (const Parameter& p : system.parameters) out.push_back(p.symbol);
  return out;
}

/// The same, then q̈ and λ.
ExprVector symbols_of_states(const EquationsOfMotion& equations) {
  ExprVector out = symbols_of_rows(equations);
  for (const Coordinate& c : equations.system->coordinates) out.push_back(c.acceleration);
  out.insert(out.end(), equations.multipliers.begin(), equations.multipliers.end());
  return out;
}

/// Points, forces, formulas asked for, the energy.
ExprVector columns_of_rows(const EquationsOfMotion& equations, const Observables& observables) {
  const auto energies = observables.expressions.begin() + static_cast<std::ptrdiff_t>(observables.energy_terms);
  ExprVector out(energies, observables.expressions.end() - static_cast<std::ptrdiff_t>(observables.probes));
  out.push_back(equations.system->context->sum(ExprVector(observables.expressions.begin(), energies)));
  return out;
}

std::span<const Expr> told_of_states(const Observables& observables) {
  return std::span(observables.expressions).subspan(observables.energy_terms + observables.points);
}

}  // namespace

KnownFormulas::KnownFormulas(const EquationsOfMotion& equations, std::span<const Expr> formulas,
                             const ExprVector& symbols)
    : evaluation_({}) {
  for (const Expr& symbol : symbols) places_.emplace(symbol, places_.size());
  Kept kept = keep_known(equations, formulas, symbols);
  which_ = std::move(kept.which);
  evaluation_ = CloseEvaluation(kept.formulas);
}

CloseObservables::CloseObservables(const EquationsOfMotion& equations, const Observables& observables)
    : freedoms_(equations.system->coordinates.size()),
      multipliers_(equations.multipliers.size()),
      parameters_(equations.system->parameters.size()),
      first_(observables.energy_terms + observables.points),
      count_(observables.expressions.size()),
      formulas_(equations, told_of_states(observables), symbols_of_states(equations)) {}

std::vector<double> CloseObservables::put_into(Sample& sample, std::span<const double> parameters) const {
  std::vector<double> errors(count_, 0);
  if (formulas_.which().empty() || sample.observables.size() != count_ || sample.a.size() != freedoms_ ||
      sample.multipliers.size() != multipliers_)
    return errors;
  std::vector<double> numbers{sample.t};
  const auto add = [&](std::span<const double> part) { numbers.insert(numbers.end(), part.begin(), part.end()); };
  add(sample.q), add(sample.v), add(parameters.first(parameters_)), add(sample.a), add(sample.multipliers);
  const CloseEvaluation::Values found = formulas_.closely(numbers);
  for (std::size_t k = 0; k < found.values.size(); ++k) {
    double& value = sample.observables[first_ + formulas_.which()[k]];
    if (!std::isfinite(found.values[k]) || !std::isfinite(value)) continue;
    value = found.values[k];
    errors[first_ + formulas_.which()[k]] = found.errors[k];
  }
  return errors;
}

RoundingOfRows::RoundingOfRows(const EquationsOfMotion& equations, const Observables& observables)
    : freedoms_(equations.system->coordinates.size()),
      count_(observables.points + observables.reactions.size() + observables.asked.size() + 1),
      parameters_(parameter_values(*equations.system)),
      formulas_(equations, columns_of_rows(equations, observables), symbols_of_rows(equations)) {}

std::vector<double> RoundingOfRows::errors(double t, std::span<const double> row) const {
  std::vector<double> out(count_, 0), numbers{t};
  numbers.insert(numbers.end(), row.begin(), row.begin() + static_cast<std::ptrdiff_t>(2 * freedoms_));
  numbers.insert(numbers.end(), parameters_.begin(), parameters_.end());
  const CloseEvaluation::Values found = formulas_.in_double(numbers);
  for (std::size_t k = 0; k < found.errors.size(); ++k)
    if (std::isfinite(found.errors[k])) out[formulas_.which()[k]] = found.errors[k];
  return out;
}

}  // namespace maupertuis
