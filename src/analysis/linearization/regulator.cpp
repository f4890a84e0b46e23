#include "analysis/linearization/dense.hpp"
#include "analysis/linearization/ordered_schur.hpp"
#include "linear_algebra/products.hpp"

#include <maupertuis/arguments.hpp>
#include <maupertuis/regulator.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

using Complex = std::complex<double>;

constexpr double unreached = 1e-10;  // of pivots: a mode that the inputs do not move
constexpr double promised = 1e-9;    // of the residual of the Riccati equation

bool symmetric(const Matrix& m) { return (m - m.transpose()).norm() <= 1e-12 * m.norm(); }
Vector spectrum(const Matrix& m) { return symmetric_eigen(m).values; }

std::string eigenvalue_text(Complex z) {
  return z.imag() == 0 ? fmt::format("{:.4g} /s", z.real())
                       : fmt::format("{:.4g} ± {:.4g} i rad/s", z.real(), std::abs(z.imag()));
}

bool check_weights(const Matrix& q, const Matrix& r, Index states, Index inputs, Diagnostics& diagnostics) {
  const auto refuse = [&](const std::string& what, const std::string& why) {
    diagnostics.error(
        "E1311", std::nullopt, what, why,
        fmt::format("There are {} states and {} inputs; a list of numbers is a diagonal.", states, inputs));
    return false;
  };
  if (q.rows() != states || q.cols() != states)
    return refuse(fmt::format("Q is {} × {}, not {} × {}", q.rows(), q.cols(), states, states),
                  "It weighs the states.");
  if (r.rows() != inputs || r.cols() != inputs)
    return refuse(fmt::format("R is {} × {}, not {} × {}", r.rows(), r.cols(), inputs, inputs),
                  "It weighs the inputs.");
  if (!symmetric(q) || spectrum(q).minCoeff() < -1e-12 * q.norm())
    return refuse("Q is not symmetric and nonnegative", "A negative weight would reward errors.");
  if (!symmetric(r) || !(spectrum(r).minCoeff() > 0))
    return refuse("R is not symmetric and positive", "An input without a price would be unbounded.");
  return true;
}

/// Whether [A − z, B] has full rank (Popov, Belevitch and Hautus), as a real matrix of twice the size.
bool reaches(const Matrix& a, const Matrix& b, Complex z) {
  const Index n = a.rows(), k = b.cols();
  const Matrix shifted = a - z.real() * Matrix::Identity(n, n), turned = z.imag() * Matrix::Identity(n, n);
  Matrix m = Matrix::Zero(2 * n, 2 * (n + k));
  m.block(0, 0, n, n) = m.block(n, n, n, n) = shifted;
  m.block(0, n, n, n) = turned;
  m.block(n, 0, n, n) = -turned;
  m.block(0, 2 * n, n, k) = m.block(n, 2 * n + k, n, k) = b;
  return pivot_columns(Equilibration(m).of(m), unreached).size() == static_cast<std::size_t>(2 * n);
}

bool check_reach(const Matrix& a, const Matrix& b, const Matrix& q, Diagnostics& diagnostics) {
  const Eigen::VectorXcd values = general_eigen(a).values;
  const double margin = 1e-9 * a.norm();
  for (const Complex& z : values) {
    if (z.real() < -margin) continue;
    if (!reaches(a, b, z)) {
      diagnostics.error("E1312", std::nullopt,
                        fmt::format("the inputs do not reach the mode with the eigenvalue {}", eigenvalue_text(z)),
                        "It does not decay by itself, and no feedback can make it: the system is not stabilizable.",
                        "Give the system an input that acts on this motion, or take away the coordinate.");
      return false;
    }
    if (std::abs(z.real()) <= margin && !reaches(a.transpose(), q, z)) {
      diagnostics.error("E1313", std::nullopt,
                        fmt::format("Q does not see the mode with the eigenvalue {}", eigenvalue_text(z)),
                        "It costs nothing and does not decay, so that the best regulator leaves it as it is: the "
                        "closed loop is not stable.",
                        "Give its coordinates or velocities a weight.");
      return false;
    }
  }
  return true;
}

/// That there are inputs, free from instant to instant, and LAPACK to regulate them with.
bool check_inputs(const Linearization& l, Diagnostics& diagnostics) {
  if (l.b.columns == 0) {
    diagnostics.error("E1310", std::nullopt, "the model has no inputs to regulate with",
                      "A regulator moves inputs, u = u₀ − F x.",
                      "Declare one: `input u : [N] = 0`, and use it in a force.");
    return false;
  }
  const auto acts = [](const RealMatrix& m) {
    return std::any_of(m.entries.begin(), m.entries.end(), [](double x) { return x != 0; });
  };
  if (acts(l.b_rate) || acts(l.b_acceleration)) {
    diagnostics.error(
        "E1316", std::nullopt, "an input acts by its rate, and is no free choice from instant to instant",
        "The system moves by ẋ = A x + B u + B₁ u' + B₂ u'': where u jumps, so do velocities or positions.",
        "Make the input a coordinate that a force moves: the force is the input then.");
    return false;
  }
  if (!has_lapack()) {
    diagnostics.error("E1315", std::nullopt, "this build has no LAPACK, which the regulator needs", "",
                      "`maup doctor` tells what this installation can do.");
    return false;
  }
  return true;
}

/// Units of the states in which A and Q are of like size, by the diagonal of what they drive: D⁻¹ A D, D Q D.
Vector units_of_states(const Matrix& a, const Matrix& q) {
  Vector d = Vector::Ones(a.rows());
  for (Index i = 0; i < d.size(); ++i)
    if (const double weight = q(i, i); weight > 0) d[i] = std::ldexp(1, -std::ilogb(std::sqrt(weight)));
  return d;
}

}  // namespace

bool has_lapack() {
#ifdef MAUPERTUIS_LAPACK
  return true;
#else
  return false;
#endif
}

std::optional<Regulator> linear_quadratic_regulator(const Linearization& l, const RealMatrix& weights,
                                                    const RealMatrix& prices, Diagnostics& diagnostics) {
  const auto fits = [](const RealMatrix& m) { return m.entries.size() == m.rows * m.columns; };
  check_argument(fits(weights), "linear_quadratic_regulator: `weights` has another number of entries than it says");
  check_argument(fits(prices), "linear_quadratic_regulator: `prices` has another number of entries than it says");
  const Matrix q = to_eigen(weights), r = to_eigen(prices);
  Matrix a = to_eigen(l.a), b = to_eigen(l.b);
  if (!check_inputs(l, diagnostics)) return std::nullopt;
  if (!check_weights(q, r, a.rows(), b.cols(), diagnostics) || !check_reach(a, b, q, diagnostics)) return std::nullopt;

  const Index s = a.rows();
  const Vector units = units_of_states(a, q);
  const Matrix an = units.cwiseInverse().asDiagonal() * a * units.asDiagonal(),
               bn = units.cwiseInverse().asDiagonal() * b, qn = units.asDiagonal() * q * units.asDiagonal();
  const Cholesky price = *cholesky(r);  // positive: checked
  const Matrix inverse_r = transposed_product(price.inverse, price.inverse);
  const Matrix g = product_transposed(product(bn, inverse_r), bn);
  Matrix hamiltonian(2 * s, 2 * s);
  hamiltonian.topLeftCorner(s, s) = an;
  hamiltonian.topRightCorner(s, s) = -g;
  hamiltonian.bottomLeftCorner(s, s) = -qn;
  hamiltonian.bottomRightCorner(s, s) = -an.transpose();
  const auto refuse = [&](const std::string& why) {
    diagnostics.error("E1314", std::nullopt, "the Riccati equation was not solved", why,
                      "Try weights of more even size.");
    return std::nullopt;
  };
  const std::optional<Matrix> basis = stable_subspace(hamiltonian);
  if (!basis) return refuse("The stable eigenvalues of the Hamiltonian matrix do not stand apart from the others.");
  const Matrix solved =
      least_squares(basis->topRows(s).transpose(), basis->bottomRows(s).transpose(), 1e-15).x.transpose();
  const Matrix p = symmetric_part(solved);
  const Matrix raised = transposed_product(an, p);
  const Matrix terms[] = {raised + product(p, an), product(product(p, g), p), qn};
  Regulator out;
  out.residual = (terms[0] - terms[1] + terms[2]).norm() / (2 * raised.norm() + terms[1].norm() + terms[2].norm());
  if (!(out.residual <= promised)) return refuse(fmt::format("Its relative residual is {:.1e}.", out.residual));
  const Matrix cost = units.cwiseInverse().asDiagonal() * p * units.cwiseInverse().asDiagonal();
  const Matrix gain = product(product_transposed(inverse_r, b), cost);
  const Eigen::VectorXcd poles = general_eigen(a - product(b, gain)).values;
  out.poles.assign(poles.data(), poles.data() + poles.size());
  std::sort(out.poles.begin(), out.poles.end(), [](const Complex& x, const Complex& y) {
    return x.real() != y.real() ? x.real() < y.real() : x.imag() < y.imag();
  });
  if (!(out.poles.back().real() < 0)) return refuse("The closed loop is not stable.");
  out.cost = to_real(cost);
  out.gain = to_real(gain);
  return out;
}

}  // namespace maupertuis
