#include "analysis/linearization/dense.hpp"
#include "analysis/linearization/matrices.hpp"

#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/linearization.hpp>
#include <maupertuis/transform.hpp>

#include <algorithm>

/// The state in rates is z = (independent positions, σ). To first order z = S x and ż = P x with the rows of σ and of
/// dσ/dt as measured outputs, so that A = P S⁻¹ holds at any point of a motion, whatever S changes there. In a frame
/// that turns along x is that of the frame; rates that do not turn with it have no constant coefficients, and no rows.
namespace maupertuis {

ExprVector rates_as_outputs(const MechanicalSystem& system) {
  ExprVector values;
  for (const Rate& rate : system.rates) values.push_back(rate.value);
  ExprVector out = expand_time_derivatives(in_terms_of_motion(system, values));
  for (std::size_t i = 0; i < values.size(); ++i) out.push_back(total_time_derivative(out[i]));
  return out;
}

std::optional<LinearizationInRates> in_rates(const Linearization& l, std::size_t first, std::size_t rates) {
  const auto f = static_cast<Index>(l.independent.size()), g = static_cast<Index>(l.independent_velocities.size());
  const auto r = static_cast<Index>(rates), at = static_cast<Index>(first);
  const Matrix a = to_eigen(l.a), c = to_eigen(l.measured.c);
  if (rates == 0 || r != g || a.rows() != f + g || c.rows() < at + 2 * r) return std::nullopt;
  Matrix states = Matrix::Identity(f + g, f + g), changes = a;
  states.bottomRows(g) = c.middleRows(at, r);
  changes.bottomRows(g) = c.middleRows(at + r, r);
  if (!states.allFinite() || !changes.allFinite()) return std::nullopt;
  const LeastSquares solved = least_squares(states.transpose(), changes.transpose(), 1e-12);
  if (solved.rank < f + g) return std::nullopt;
  LinearizationInRates out;
  out.positions = l.independent;
  constexpr double rounding = 1e-14;
  const double largest = solved.x.size() > 0 ? solved.x.lpNorm<Eigen::Infinity>() : 0;
  out.a = to_real(solved.x.transpose());
  for (double& x : out.a.entries)
    if (std::abs(x) <= rounding * largest) x = 0;
  out.of_states = to_real(states.bottomRows(g));
  const auto input = [&](const RealMatrix& of_x, const RealMatrix& measured) {
    Matrix b = to_eigen(of_x);
    if (b.cols() > 0) b.bottomRows(g) = to_eigen(measured).middleRows(at + r, r);
    return to_real(b);
  };
  out.b = input(l.b, l.measured.d);
  out.b_rate = input(l.b_rate, l.measured.d_rate);
  out.b_acceleration = input(l.b_acceleration, l.measured.d_acceleration);
  return out;
}

void keep_first_outputs(Linearization& l, std::size_t count) {
  l.measured.values.resize(std::min(count, l.measured.values.size()));
  for (RealMatrix* m : {&l.measured.c, &l.measured.d, &l.measured.d_rate, &l.measured.d_acceleration}) {
    if (m->rows <= count) continue;
    m->rows = count;
    m->entries.resize(count * m->columns);
  }
}

}  // namespace maupertuis
