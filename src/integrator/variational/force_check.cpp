#include "integrator/variational/force_check.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis::variational {
namespace {

constexpr double of_variation = 0.25;  // more of it than smooth forces leave to the nodes
constexpr double of_switched = 1.5;    // more of it than one switch leaves to them
constexpr double of_spread = 4;        // variation within a step, in terms of that between its nodes and ends
constexpr double of_momentum = 1e-9,
                 at_rest = 1e-20;  // changes of momentum that do not count; the latter of a velocity

/// Of the mean of |f|: what s nodes may miss of a smooth force in a coarse step.
double accuracy_of(std::size_t s) { return 0.5 * std::pow(10.0, -static_cast<double>(s)); }

}  // namespace

ForceCheck::ForceCheck(const VariationalFunctions& functions, std::span<const double> parameters)
    : search_(functions.forces.values, parameters),
      n_(functions.motion.freedoms),
      inputs_(functions.motion.inputs()),
      path_(StepSearch::path_points * inputs_),
      inertia_(n_),
      momentum_(n_),
      by_nodes_(n_),
      spread_(n_) {}

void ForceCheck::start(std::span<const double> inertia) {
  inertia_.assign(inertia.begin(), inertia.end());
  std::fill(momentum_.begin(), momentum_.end(), 0.0);
}

/// q and v of the step's polynomials, λ of the first node.
void ForceCheck::follow(StageSolver& solver, double t, double h) {
  const auto first = solver.node_point(0);
  const auto& x = StepSearch::path_nodes();
  for (std::size_t j = 0; j < x.size(); ++j) {
    const double part = 0.5 * (1 + x[j]);
    double* const out = &path_[j * inputs_];
    std::copy(first.begin(), first.end(), out);
    for (std::size_t i = 0; i < n_; ++i)
      out[i] = solver.position_at(part, i), out[n_ + i] = solver.velocity_at(part, i);
    out[inputs_ - 1] = t + part * h;
  }
  search_.set_path(path_);
}

void ForceCheck::look_at_nodes(const Tableau& tableau) {
  std::vector<double> positions{-1, 1}, values;
  for (std::size_t j = 0; j < tableau.stages; ++j) positions.push_back(2 * static_cast<double>(tableau.c[j]) - 1);
  for (const double x : positions) {
    const auto found = search_.values_at(x);
    values.insert(values.end(), found.begin(), found.end());
  }
  for (std::size_t i = 0; i < n_; ++i) {
    by_nodes_[i] = spread_[i] = 0;
    for (std::size_t j = 0; j < tableau.stages; ++j)
      by_nodes_[i] += static_cast<double>(tableau.b[j]) * values[(j + 2) * n_ + i];
    for (std::size_t k = 0; k < positions.size(); ++k)
      spread_[i] = std::max(spread_[i], std::abs(values[k * n_ + i] - by_nodes_[i]));
  }
}

Sight ForceCheck::look(StageSolver& solver, double t, double h, std::span<const double> p) {
  for (std::size_t i = 0; i < n_; ++i) momentum_[i] = std::max(momentum_[i], std::abs(p[i]));
  follow(solver, t, h);
  look_at_nodes(solver.tableau());
  const double accuracy = accuracy_of(solver.tableau().stages);
  const auto least = [&](std::size_t i) {
    return std::max(of_momentum * momentum_[i], at_rest * inertia_[i]) / std::abs(h);
  };
  const auto small = [&](std::span<const double> tails) {
    for (std::size_t i = 0; i < n_; ++i)
      if (!(tails[i] <= 0.1 * std::max(accuracy * (std::abs(by_nodes_[i]) + spread_[i]), least(i)))) return false;
    return true;
  };
  bool has_switch = false;
  weights_.clear(), values_.clear();
  const auto visit = [&](double, double weight, std::span<const double> forces, bool switched) {
    has_switch |= switched;
    weights_.push_back(0.5 * weight);
    values_.insert(values_.end(), forces.begin(), forces.end());
    return true;
  };
  const StepSearch::Outcome outcome = search_.visit(small, visit);
  if (outcome == StepSearch::Outcome::NotFinite) return Sight::NonFinite;
  if (outcome != StepSearch::Outcome::Seen) return Sight::NotAll;
  for (std::size_t i = 0; i < n_; ++i)
    if (!is_seen(i, least(i), has_switch, accuracy)) return Sight::NotAll;
  return Sight::All;
}

ForceCheck::Means ForceCheck::means(std::size_t i) const {
  Means out;
  for (std::size_t k = 0; k < weights_.size(); ++k) {
    out.force += weights_[k] * values_[k * n_ + i];
    out.size += weights_[k] * std::abs(values_[k * n_ + i]);
  }
  for (std::size_t k = 0; k < weights_.size(); ++k)
    out.variation += weights_[k] * std::abs(values_[k * n_ + i] - out.force);
  return out;
}

bool ForceCheck::is_seen(std::size_t i, double least, bool switched, double accuracy) const {
  const Means mean = means(i);
  const double harmless = std::max(accuracy * mean.size, least);
  if (!(mean.variation <= std::max(of_spread * spread_[i], harmless))) return false;
  return std::abs(mean.force - by_nodes_[i]) <=
         std::max((switched ? of_switched : of_variation) * mean.variation, harmless);
}

}  // namespace maupertuis::variational
