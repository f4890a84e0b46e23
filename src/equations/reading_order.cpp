#include <maupertuis/equations_of_motion.hpp>

#include <algorithm>

namespace maupertuis {
namespace {

bool is(const Dimension& dimension, const Dimension& other) { return dimension.same_as(other); }

/// Physicists write m g l, m l^2, k x^2, c x', m R Ω^2: what carries a mass first, then accelerations, then lengths
/// and numbers, then rates.
int rank_of(const Parameter& parameter, bool dimensionless) {
  if (dimensionless) return parameter.name == "m" || parameter.name == "M" ? 0 : parameter.name == "g" ? 1 : 2;
  const Dimension& d = parameter.dimension;
  if (d.exponents[Dimension::Mass].numerator != 0) return 0;
  if (is(d, dimensions::acceleration())) return 1;
  const bool has_time = d.exponents[Dimension::Time].numerator != 0;
  const bool has_length = d.exponents[Dimension::Length].numerator != 0;
  return has_time && !has_length ? 3 : 2;
}

}  // namespace

ReadingOrder reading_order(const MechanicalSystem& system) {
  std::vector<const Parameter*> parameters;
  for (const Parameter& p : system.parameters) parameters.push_back(&p);
  std::stable_sort(parameters.begin(), parameters.end(), [&](const Parameter* a, const Parameter* b) {
    return rank_of(*a, system.dimensionless) < rank_of(*b, system.dimensionless);
  });
  ReadingOrder order;
  for (const Parameter* p : parameters) order.parameters.push_back(p->symbol);
  for (const Definition& d : system.definitions)
    if (d.symbol) order.parameters.push_back(d.symbol);
  for (const Coordinate& c : system.coordinates) order.coordinates.push_back(c.q);
  return order;
}

}  // namespace maupertuis
