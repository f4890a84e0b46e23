#include "analysis/linearization/linear_motion.hpp"

#include "analysis/linearization/dense.hpp"

#include <maupertuis/evaluate.hpp>
#include <maupertuis/switches.hpp>
#include <maupertuis/transform.hpp>

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

using ComplexShapes = Eigen::MatrixXcd;

/// Whether the first derivatives by the unknowns depend on none of them.
bool is_linear_in(Expr row, const ExprVector& unknowns) {
  ExprVector second;
  for (const Expr& slope : gradient(row, unknowns))
    for (const Expr& s : symbols_of({&slope, 1}))
      if (std::find(unknowns.begin(), unknowns.end(), s) != unknowns.end()) second.push_back(differentiate(slope, s));
  return second.empty() || zero_test(second).verdict == Verdict::Zero;
}

/// Of modes that are one within their errors the independent parts of their shapes.
ComplexShapes shapes_of(const std::vector<Mode>& modes, const std::vector<std::size_t>& chosen,
                        const std::vector<std::size_t>& independent) {
  ComplexShapes out(static_cast<Index>(independent.size()), static_cast<Index>(chosen.size()));
  for (std::size_t j = 0; j < chosen.size(); ++j)
    for (std::size_t i = 0; i < independent.size(); ++i)
      out(static_cast<Index>(i), static_cast<Index>(j)) = modes[chosen[j]].shape[independent[i]];
  return out;
}

/// A Hermitian form, as a real one of real and imaginary parts.
bool is_definite(const ComplexShapes& form) {
  constexpr double clearly = 1e-6;
  Matrix parts(2 * form.rows(), 2 * form.rows());
  parts << form.real(), -form.imag(), form.imag(), form.real();
  const Vector values = symmetric_eigen(parts).values;
  const double largest = values.cwiseAbs().maxCoeff();
  return values.minCoeff() > clearly * largest || values.maxCoeff() < -clearly * largest;
}

/// K symmetric and C skew, exactly: what is rounding beside the other entries may feed the motion all the same.
bool feeds_nothing(const PointEquations::Impl& e) {
  ExprVector q, v, must_vanish;
  for (const Coordinate& c : e.system->coordinates) q.push_back(c.q), v.push_back(c.velocity);
  std::vector<std::vector<Expr>> stiffness, damping;
  for (const Expr& row : e.balance_rows) stiffness.push_back(gradient(row, q)), damping.push_back(gradient(row, v));
  for (std::size_t i = 0; i < q.size(); ++i)
    for (std::size_t j = 0; j <= i; ++j)
      for (const Expr& x : {stiffness[i][j] - stiffness[j][i], damping[i][j] + damping[j][i]})
        if (!x.is_zero()) must_vanish.push_back(x);
  return must_vanish.empty() || zero_test(substitute(must_vanish, exact_parameters(e))).verdict == Verdict::Zero;
}

}  // namespace

bool is_linear(const PointEquations::Impl& e) {
  ExprVector rows = e.balance_rows, unknowns;
  for (const Constraint& c : e.system->constraints) {
    rows.push_back(expand_time_derivatives({&c.value, 1}).front());
    unknowns.push_back(c.multiplier);
  }
  if (!switches_of(rows).empty()) return false;  // |x| has constant derivatives on both sides
  for (const Coordinate& c : e.system->coordinates) unknowns.insert(unknowns.end(), {c.q, c.velocity, c.acceleration});
  return std::all_of(rows.begin(), rows.end(), [&](Expr row) { return is_linear_in(row, unknowns); });
}

bool oscillates_for_certain(const PointEquations::Impl& e, const Linearization& l, const std::vector<Mode>& modes) {
  if (!l.second_order() || l.independent.empty()) return false;
  const Matrix m = to_eigen(l.mass), g = to_eigen(l.gyroscopic);
  constexpr double rounding = 1e-14;
  if (to_eigen(l.damping).norm() > rounding * g.norm()) return false;
  if (to_eigen(l.circulatory).norm() > rounding * to_eigen(l.stiffness).norm()) return false;
  if (e.m > 0 ? !e.has_energy : !feeds_nothing(e)) return false;
  for (const Mode& mode : modes) {
    if (mode.kind == Mode::Kind::Zero) continue;
    if (mode.chain > 1) return false;
    if (mode.kind != Mode::Kind::Oscillation || std::abs(mode.eigenvalue.real()) > 4 * mode.error) return false;
    if (std::abs(mode.eigenvalue) <= 4 * mode.error) return false;  // may vanish: two that meet there are a chain
    std::vector<std::size_t> same;
    for (std::size_t k = 0; k < modes.size(); ++k)
      if (modes[k].kind == Mode::Kind::Oscillation &&
          std::abs(modes[k].eigenvalue - mode.eigenvalue) <= 4 * (modes[k].error + mode.error))
        same.push_back(k);
    if (same.size() == 1) continue;
    const ComplexShapes shapes = shapes_of(modes, same, l.independent);
    const ComplexShapes energy = 2 * mode.frequency() * m.cast<std::complex<double>>() -
                                 std::complex<double>(0, 1) * g.cast<std::complex<double>>();
    if (!is_definite(shapes.adjoint() * energy * shapes)) return false;
  }
  return true;
}

}  // namespace maupertuis
