#include "simulation/state_quantities.hpp"

#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/transform.hpp>

#include <cmath>

namespace maupertuis {

StateQuantities::StateQuantities(const MechanicalSystem& system, const ExprVector& quantities)
    : system_(system), count_(quantities.size()), bindings_(parameter_bindings(system)) {
  for (const Coordinate& c : system.coordinates) symbols_.push_back(c.q);
  for (const Coordinate& c : system.coordinates) symbols_.push_back(c.velocity);
  const ExprVector plain = expand_time_derivatives(in_terms_of_motion(system, quantities));
  close_.emplace(plain);
  for (const Expr& quantity : plain)
    for (const Expr& slope : gradient(quantity, symbols_)) slopes_.push_back(slope);
}

std::vector<double> StateQuantities::at(double t, const double* state, const double* errors, Digits digits) {
  bindings_[system_.context->time()] = t;
  for (std::size_t i = 0; i < symbols_.size(); ++i) bindings_[symbols_[i]] = state[i];
  const auto value_of = [&](Expr symbol) { return bindings_.at(symbol); };
  const CloseEvaluation::Values found = digits == Digits::All ? (*close_)(value_of) : close_->in_double(value_of);
  std::vector<double> out = found.values;
  const std::vector<double> slopes = errors ? evaluate(slopes_, bindings_) : std::vector<double>();
  for (std::size_t k = 0; errors && k < count_; ++k) {
    double error = std::isfinite(found.errors[k]) ? found.errors[k] : 0;
    for (std::size_t i = 0; i < symbols_.size(); ++i)
      if (const double slope = slopes[k * symbols_.size() + i]; slope != 0) error += std::abs(slope) * errors[i];
    out.push_back(error);
  }
  return out;
}

void StateQuantities::put_into(State& state) {
  if (state.q.empty()) return;
  const auto together = [](std::vector<double> q, const std::vector<double>& v) {
    q.insert(q.end(), v.begin(), v.end());
    return q;
  };
  const std::vector<double> numbers = together(state.q, state.v);
  const std::vector<double> errors = state.errors ? together(state.errors->q, state.errors->v) : std::vector<double>();
  const std::vector<double> found = at(state.t, numbers.data(), errors.empty() ? nullptr : errors.data(), Digits::All);
  const auto end_of_values = found.begin() + static_cast<std::ptrdiff_t>(count_);
  state.quantities.insert(state.quantities.end(), found.begin(), end_of_values);
  if (state.errors) state.errors->quantities.insert(state.errors->quantities.end(), end_of_values, found.end());
}

void StateQuantities::put_into(SimulationResult& result) {
  for (State* state : {&result.start, &result.final}) put_into(*state);
  for (State& state : result.at) put_into(state);
}

void StateQuantities::put_into(Trajectory& rows, const std::vector<Trajectory::Column>& columns,
                               const Trajectory& all) {
  const std::size_t width = rows.columns.size();
  std::vector<double> values, errors;
  for (std::size_t row = 0; row < rows.rows(); ++row) {
    const std::size_t begin = row * all.columns.size();
    const std::vector<double> found =
        at(rows.times[row], &all.values[begin], all.errors.empty() ? nullptr : &all.errors[begin], Digits::OfDouble);
    const auto copy = [&](std::vector<double>& to, const std::vector<double>& from, std::size_t first) {
      const auto start = from.begin() + static_cast<std::ptrdiff_t>(row * width);
      to.insert(to.end(), start, start + static_cast<std::ptrdiff_t>(width));
      const auto more = found.begin() + static_cast<std::ptrdiff_t>(first);
      to.insert(to.end(), more, more + static_cast<std::ptrdiff_t>(count_));
    };
    copy(values, rows.values, 0);
    if (!all.errors.empty()) copy(errors, rows.errors, count_);
  }
  rows.values = std::move(values);
  rows.errors = std::move(errors);
  rows.columns.insert(rows.columns.end(), columns.begin(), columns.end());
}

void add_rates(SimulationResult& result, const MechanicalSystem& system) {
  if (system.rates.empty()) return;
  ExprVector wanted;
  for (const Rate& rate : system.rates) {
    wanted.push_back(rate.value);
    result.quantities.push_back({rate.name, system.dimensionless ? std::string() : to_string(rate.dimension)});
  }
  StateQuantities(system, wanted).put_into(result);
}

}  // namespace maupertuis
