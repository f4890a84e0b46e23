#include <maupertuis/equations_of_motion.hpp>

#include <algorithm>

namespace maupertuis {
namespace {

bool is(const Dimension& dimension, const Dimension& other) { return dimension.same_as(other); }

/// Physicists write m g l, m l^2, k x^2, c x', m R Ω^2: what carries a mass first, then accelerations, then lengths
/// and numbers, then rates.
int rank_of(const std::string& name, const Dimension& d, bool dimensionless) {
  if (dimensionless) return name == "m" || name == "M" ? 0 : name == "g" ? 1 : 2;
  if (d.exponents[Dimension::Mass].numerator != 0) return 0;
  if (is(d, dimensions::acceleration())) return 1;
  const bool has_time = d.exponents[Dimension::Time].numerator != 0;
  const bool has_length = d.exponents[Dimension::Length].numerator != 0;
  return has_time && !has_length ? 3 : 2;
}

}  // namespace

ReadingOrder reading_order(const MechanicalSystem& system) {
  struct Named {
    Expr symbol;
    int rank;
  };
  std::vector<Named> named;
  for (const Parameter& p : system.parameters)
    named.push_back({p.symbol, rank_of(p.name, p.dimension, system.dimensionless)});
  for (const Definition& d : system.definitions)
    if (d.symbol) named.push_back({d.symbol, rank_of(d.name, d.dimension, system.dimensionless)});
  std::stable_sort(named.begin(), named.end(), [](const Named& a, const Named& b) { return a.rank < b.rank; });
  ReadingOrder order;
  for (const Named& n : named) order.parameters.push_back(n.symbol);
  for (const Coordinate& c : system.coordinates) order.coordinates.push_back(c.q);
  return order;
}

}  // namespace maupertuis
