#include "analysis/linearization/modes_in_digits.hpp"

#include "analysis/linearization/point_equations.hpp"

#include <maupertuis/switches.hpp>
#include <maupertuis/transform.hpp>

namespace maupertuis {

std::optional<std::vector<PreciseMode>> modes_in_digits(const PointEquations& equations, const Equilibrium& rest) {
  constexpr std::size_t most_coordinates = 12;  // the time goes with the third power, the formulas with the second
  const PointEquations::Impl& e = equations.impl();
  if (!rest.at_rest || !e.is_autonomous() || e.m > 0 || e.n > most_coordinates || rest.point.turning.rows > 0)
    return std::nullopt;
  if (!switches_of(e.balance_rows).empty()) return std::nullopt;
  RowsOfMotion motion;
  for (const Expr& row : substitute(e.balance_rows, exact_parameters(e))) motion.rows.push_back(row);
  for (const Coordinate& c : e.system->coordinates) {
    motion.q.push_back(c.q);
    motion.v.push_back(c.velocity);
    motion.a.push_back(c.acceleration);
  }
  return precise_modes(motion, values_at(e, rest.point),
                       typical_sizes(*e.system, {rest.point.t, rest.point.q, rest.point.v}));
}

}  // namespace maupertuis
