#include "studio/gaps.hpp"

#include <maupertuis/simulation.hpp>
#include <maupertuis/transform.hpp>

#include <algorithm>
#include <cmath>

namespace maupertuis::studio {

Gaps::Gaps(const MechanicalSystem& system)
    : system_(system), count_(system.contacts.size()), parameters_(parameter_bindings(system)) {
  std::vector<Expr> coordinates;
  for (const Coordinate& c : system.coordinates) coordinates.push_back(c.q);
  for (const Contact& contact : system.contacts) {
    const Expr gap = in_terms_of_motion(system, {&contact.gap, 1}).front();
    formulas_.push_back(gap);
    for (const Expr& slope : gradient(gap, coordinates)) formulas_.push_back(slope);
  }
}

std::vector<Gaps::Gap> Gaps::at(const MotionState& state) const {
  Bindings here = parameters_;
  here[system_.context->time()] = state.t;
  for (std::size_t i = 0; i < state.q.size(); ++i) here[system_.coordinates[i].q] = state.q[i];
  const std::vector<double> values = evaluate(formulas_, here);
  std::vector<Gap> out(count_);
  for (std::size_t k = 0, at = 0; k < count_; ++k) {
    out[k].value = values[at++];
    for (std::size_t i = 0; i < state.q.size(); ++i) {
      out[k].slope.push_back(values[at++]);
      out[k].size += std::abs(out[k].slope.back() * state.q[i]);
    }
  }
  return out;
}

bool Gaps::kept(const MotionState& state) const {
  const std::vector<Gap> gaps = at(state);
  return std::all_of(gaps.begin(), gaps.end(), [](const Gap& g) { return g.kept(); });
}

}  // namespace maupertuis::studio
