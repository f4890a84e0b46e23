#include "fields/small_motions.hpp"

#include <maupertuis/evaluate.hpp>

#include "linear_algebra/products.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

namespace maupertuis {

bool refuse_modes_of(const FieldEquations& equations, Diagnostics& diagnostics, const std::string& why) {
  diagnostics.error(
      "E0644", equations.system().density_span, "this field has no modes to be computed", why,
      "Modes are those of one or two space variables with a domain, about a rest, with coefficients that do "
      "not change in time.");
  return false;
}

Expr density_of(const FieldEquations& equations) {
  const FieldSystem& s = equations.system();
  Expr out = s.expanded(s.density);
  ExprMap given;
  for (const Expr& symbol : s.jets_in(out)) {
    const FieldJet jet = *s.jet_of(symbol);
    if (!s.fields[jet.field].given) continue;
    Expr value = s.fields[jet.field].formula;
    if (!value) return {};
    for (std::size_t x = 0; x < s.space.size(); ++x)
      for (int k = 0; k < jet.space[x]; ++k) value = differentiate(value, s.space[x].symbol);
    for (int k = 0; k < jet.time; ++k) value = differentiate(value, s.context->time());
    given[symbol] = value;
  }
  return s.expanded(substitute(out, given));
}

bool entries_of(const FieldEquations& equations, DensityEntries& out, Diagnostics& diagnostics) {
  const FieldSystem& s = equations.system();
  const Expr density = density_of(equations);
  if (!density) return refuse_modes_of(equations, diagnostics, "A given field has no formula.");
  ExprMap rest;
  for (const Expr& jet : s.jets_in(density)) rest[jet] = s.context->number(0);
  const auto place = [&](std::size_t field) {
    return static_cast<std::size_t>(std::find(equations.varied.begin(), equations.varied.end(), field) -
                                    equations.varied.begin());
  };
  for (const Expr& one : s.jets_in(density))
    for (const Expr& two : s.jets_in(density)) {
      const FieldJet a = *s.jet_of(one), b = *s.jet_of(two);
      const Expr second = differentiate(differentiate(density, one), two);
      if (!s.jets_in(second).empty()) out.linear = false;
      const Expr value = substitute(second, rest);
      if (value.is_zero()) continue;
      if (s.context->depends_on_time(value.id()))
        return refuse_modes_of(equations, diagnostics, "Its coefficients change in time.");
      DensityEntry entry{place(a.field), place(b.field), a.space[0], b.space[0], a.time, b.time, value};
      if (s.space.size() > 1) entry.ya = a.space[1], entry.yb = b.space[1];
      out.list.push_back(entry);
    }
  return true;
}

bool has_modes_at_rest(const FieldEquations& equations, bool linear, Diagnostics& diagnostics) {
  const FieldSystem& s = equations.system();
  if (linear) return true;
  ExprMap rest;
  for (const Expr& r : equations.residuals)
    for (const Expr& jet : s.jets_in(r)) rest[jet] = s.context->number(0);
  for (const Expr& r : equations.residuals) {
    const Expr at_rest = s.expanded(substitute(r, rest));
    if (zero_test(at_rest).verdict != Verdict::Zero)
      return refuse_modes_of(equations, diagnostics, "φ = 0 is no rest of it.");
  }
  for (const BoundaryCondition& b : s.boundary)
    if (!s.expanded(b.value).is_zero())
      return refuse_modes_of(equations, diagnostics, "Its ends are held away from φ = 0.");
  return true;
}

std::string no_small_motions(const SmallMotions& motions) {
  if (!motions.mass.allFinite() || !motions.stiffness.allFinite() || !motions.gyroscopic.allFinite())
    return "A coefficient of its density is infinite, or has no value, somewhere in the domain.";
  if (!(motions.mass.trace() > 0)) return "No velocity has a positive kinetic energy.";
  if (motions.gyroscopic.size() > 0 && motions.gyroscopic.cwiseAbs().maxCoeff() > 0)
    return "Forces act sideways on velocities, and not every displacement costs energy.";
  return "Its kinetic energy is not positive, or its potential energy falls without bound.";
}

namespace {

/// σ such that K + σ M is positive definite, σ > 0: of a rest that is unstable not the first one.
std::optional<Eigen::LLT<Eigen::MatrixXd>> factor_with_shift(const Eigen::MatrixXd& k, const Eigen::MatrixXd& m,
                                                             double& shift) {
  constexpr int tries = 12;
  for (int i = 0; i < tries && std::isfinite(shift); ++i, shift *= 8) {
    Eigen::LLT<Eigen::MatrixXd> factor(symmetric_part(k + shift * m));
    if (factor.info() == Eigen::Success) return factor;
  }
  return std::nullopt;
}

}  // namespace

bool solve_conservative(const SmallMotions& motions, std::size_t count, std::vector<double>& out,
                        std::vector<Eigen::VectorXd>& shapes) {
  const Eigen::MatrixXd &kk = motions.stiffness, &mm = motions.mass;
  if (!kk.allFinite() || !mm.allFinite() || !(mm.trace() > 0)) return false;
  double shift = std::abs(kk.trace()) / static_cast<double>(kk.rows());
  if (!(shift > 0)) shift = 1;            // a rest at which nothing costs energy
  for (int pass = 0; pass < 2; ++pass) {  // the second with σ of the size of what is looked for
    const auto factor = factor_with_shift(kk, mm, shift);
    if (!factor) return false;
    const Eigen::MatrixXd inverse = factor->matrixL().solve(Eigen::MatrixXd::Identity(mm.rows(), mm.cols()));
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
    solver.compute(symmetric_part(product_transposed(product(inverse, mm), inverse)), Eigen::ComputeEigenvectors);
    const Eigen::VectorXd& mu = solver.eigenvalues();  // ascending
    out.clear(), shapes.clear();
    const Eigen::MatrixXd vectors = product(motions.from_free, transposed_product(inverse, solver.eigenvectors()));
    for (Eigen::Index i = mu.size(); i-- > 0 && out.size() < count;) {
      const double square = 1 / mu(i) - shift, rounding = 1e-12 / mu(i);
      out.push_back(square > rounding ? std::sqrt(square) : std::abs(square) <= rounding ? 0 : -std::sqrt(-square));
      shapes.push_back(vectors.col(i));
    }
    if (!out.empty() && out.back() > 0) shift = out.back() * out.back();
  }
  return true;
}

/// With N² = M̂ the Hermitian matrix ((−iĜ, N), (N, 0)) has
/// the eigenvalues μ. As a real symmetric matrix of twice the size it has each of them twice.
bool solve_gyroscopic(const SmallMotions& motions, std::size_t count, std::vector<double>& out) {
  if (!motions.stiffness.allFinite() || !motions.mass.allFinite() || !(motions.mass.trace() > 0)) return false;
  const Eigen::LLT<Eigen::MatrixXd> factor(motions.stiffness);
  // Where a displacement costs nothing its pivot is rounding, of either sign.
  constexpr double rounding = 1e-13;
  const Eigen::ArrayXd pivots = factor.matrixLLT().diagonal().array().square();
  if (factor.info() != Eigen::Success ||
      pivots.minCoeff() < rounding * static_cast<double>(pivots.size()) * pivots.maxCoeff())
    return false;
  const Eigen::Index n = motions.mass.rows();
  const Eigen::MatrixXd inverse = factor.matrixL().solve(Eigen::MatrixXd::Identity(n, n));
  const Eigen::MatrixXd m = symmetric_part(product_transposed(product(inverse, motions.mass), inverse));
  const Eigen::MatrixXd g = product_transposed(product(inverse, motions.gyroscopic), inverse);
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> of_mass;
  of_mass.compute(m, Eigen::ComputeEigenvectors);
  Eigen::MatrixXd scaled = of_mass.eigenvectors();
  for (Eigen::Index j = 0; j < n; ++j) scaled.col(j) *= std::sqrt(std::max(of_mass.eigenvalues()(j), 0.0));
  const Eigen::MatrixXd root = product_transposed(scaled, of_mass.eigenvectors());
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(4 * n, 4 * n);
  // H = S + i A with S = ((0, N), (N, 0)), A = ((−Ĝ, 0), (0, 0)): ((S, −A), (A, S))
  for (const Eigen::Index at : {Eigen::Index{0}, 2 * n}) {
    whole.block(at, at + n, n, n) = root;
    whole.block(at + n, at, n, n) = root;
  }
  whole.block(0, 2 * n, n, n) = g;
  whole.block(2 * n, 0, n, n) = -g;
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.compute(symmetric_part(whole), Eigen::EigenvaluesOnly);
  out.clear();
  for (Eigen::Index i = 4 * n - 1; i > 0 && out.size() < count; i -= 2)
    if (solver.eigenvalues()(i) > 0) out.push_back(1 / solver.eigenvalues()(i));
  return true;
}

}  // namespace maupertuis
