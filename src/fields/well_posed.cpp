#include "fields/well_posed.hpp"

#include <maupertuis/evaluate.hpp>

#include "linear_algebra/dense.hpp"
#include "linear_algebra/products.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>

namespace maupertuis {
namespace {

using Complex = std::complex<double>;
using Direction = std::vector<double>;  // [space variables] of the wave vector

/// One term of the linearized equations: c · derivative of a field, at the values of the model.
struct Term {
  std::size_t row = 0, column = 0;
  FieldJet jet;
  double c = 0;
};

/// Nothing where a coefficient has no value about φ = 0, or a higher derivative in time than the second stands there.
std::optional<std::vector<Term>> linearized(const FieldEquations& equations) {
  const FieldSystem& s = equations.system();
  std::vector<Term> out;
  for (std::size_t row = 0; row < equations.varied.size(); ++row) {
    const Expr residual = s.expanded(equations.residuals[row]);
    const std::vector<Expr> jets = s.jets_in(residual);
    const std::vector<Expr> slopes = gradient(residual, jets);
    for (std::size_t n = 0; n < jets.size(); ++n) {
      const FieldJet jet = *s.jet_of(jets[n]);
      if (s.fields[jet.field].given) continue;
      if (jet.time > 2) return std::nullopt;
      Bindings values;
      for (const Expr& symbol : symbols_of({&slopes[n], 1}))
        values[symbol] = s.jet_of(symbol) || symbol.role() == Role::Time ? 0 : 1;
      for (const Parameter& p : equations.model->parameters) values[p.symbol] = p.si_value;
      const double c = evaluate(slopes[n], values);
      if (!std::isfinite(c)) return std::nullopt;
      std::size_t column = 0;
      while (equations.varied[column] != jet.field) ++column;
      out.push_back({row, column, jet, c});
    }
  }
  return out;
}

/// (A₂ σ² + A₁ σ + A₀) φ = 0 for φ exp(i k·x + σ t), each as [[Re, −Im], [Im, Re]], which has the same growth rates.
struct Pencil {
  Eigen::MatrixXd a[3];
  Pencil(const std::vector<Term>& terms, std::size_t fields, const Direction& direction, double k) {
    const auto n = static_cast<Eigen::Index>(fields);
    for (Eigen::MatrixXd& m : a) m = Eigen::MatrixXd::Zero(2 * n, 2 * n);
    for (const Term& t : terms) {
      Complex value = t.c;
      for (std::size_t x = 0; x < direction.size(); ++x)
        for (int j = 0; j < t.jet.space[x]; ++j) value *= Complex(0, k * direction[x]);
      const auto i = static_cast<Eigen::Index>(t.row), j = static_cast<Eigen::Index>(t.column);
      Eigen::MatrixXd& m = a[t.jet.time];
      m(i, j) += value.real(), m(n + i, n + j) += value.real();
      m(i, n + j) -= value.imag(), m(n + i, j) += value.imag();
    }
  }
  static double size(const Eigen::MatrixXd& m) { return m.cwiseAbs().maxCoeff(); }
};

/// B⁻¹ C; nothing where B is singular.
std::optional<Eigen::MatrixXd> solved(const Eigen::MatrixXd& b, const Eigen::MatrixXd& c) {
  Eigen::FullPivLU<Eigen::MatrixXd> lu;
  lu.setThreshold(1e-12);
  lu.compute(b);
  if (!lu.isInvertible()) return std::nullopt;
  return Eigen::MatrixXd(lu.solve(c));
}

/// The largest growth rate of waves; 0 where nothing is decided: some fields are of second order in time, others not.
double growth(const std::vector<Term>& terms, std::size_t fields, const Direction& direction, double k) {
  const Pencil pencil(terms, fields, direction, k);
  const auto& [a0, a1, a2] = pencil.a;
  const Eigen::Index n = a0.rows();
  Eigen::MatrixXd motion;
  double unit = 1;  // of σ, so that all entries are of one size
  if (Pencil::size(a2) == 0) {
    const auto m = solved(a1, a0);
    if (!m) return 0;
    motion = -*m;
    unit = std::max(Pencil::size(motion), 1e-300);
    motion /= unit;
  } else {
    const auto stiffness = solved(a2, a0), damping = solved(a2, a1);
    if (!stiffness || !damping) return 0;
    unit = std::max({std::sqrt(Pencil::size(*stiffness)), Pencil::size(*damping), 1e-300});
    motion = Eigen::MatrixXd::Zero(2 * n, 2 * n);
    motion.topRightCorner(n, n).setIdentity();
    motion.bottomLeftCorner(n, n) = -*stiffness / (unit * unit);
    motion.bottomRightCorner(n, n) = -*damping / unit;
  }
  Eigen::EigenSolver<Eigen::MatrixXd> solver;
  solver.compute(motion, false);
  if (solver.info() != Eigen::Success) return 0;
  double largest = 0;
  for (Eigen::Index i = 0; i < motion.rows(); ++i) largest = std::max(largest, solver.eigenvalues()(i).real());
  constexpr double rounding = 1e-6;  // of double roots, which rounding splits by its root
  return largest > rounding ? largest * unit : 0;
}

/// Along each space variable, then the diagonal of all.
std::vector<Direction> directions(std::size_t count) {
  std::vector<Direction> out;
  for (std::size_t x = 0; x < count; ++x) out.emplace_back(count, 0.0), out.back()[x] = 1;
  if (count > 1) out.emplace_back(count, 1 / std::sqrt(static_cast<double>(count)));
  return out;
}

}  // namespace

void refuse_ill_posed(const FieldEquations& equations, Diagnostics& diagnostics) {
  const FieldSystem& s = equations.system();
  constexpr std::size_t most_fields = 12;
  if (equations.varied.size() > most_fields) return;
  const auto terms = linearized(equations);
  if (!terms) return;
  const std::vector<Direction> all = directions(s.space.size());
  for (std::size_t d = 0; d < all.size(); ++d) {
    const double few = growth(*terms, equations.varied.size(), all[d], 1e4),
                 many = growth(*terms, equations.varied.size(), all[d], 1e6);
    if (!(many > 8 * few) || !(many > 1e3)) continue;
    std::string trouble, relation;
    if (const auto w = dispersion(equations, trouble); w && w->im.is_zero())
      relation = fmt::format(" Its dispersion relation is {} = 0.",
                             to_plain(lay_out(readable(w->re, equations.order), equations.order)));
    const std::string along = s.space.size() == 1   ? ""
                              : d == s.space.size() ? " along the diagonal"
                                                    : " along " + s.space[d].name;
    diagnostics.error(
        "E0641", s.density_span,
        fmt::format("the field equation{} ill-posed: short waves grow without bound",
                    equations.varied.size() == 1 ? " is" : "s are"),
        fmt::format("A wave{} of wave number 1e6 grows at the rate {:.3g}, one of 1e4 at {:.3g}: the shorter, "
                    "the faster (elliptic in time).{}",
                    along, many, few, relation),
        "The parts of u' and of u_x have opposite signs in the density of a wave.");
    return;
  }
}

}  // namespace maupertuis
