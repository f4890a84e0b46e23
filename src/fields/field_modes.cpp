#include <maupertuis/evaluate.hpp>
#include <maupertuis/field_run.hpp>
#include <maupertuis/repeated_evaluation.hpp>

#include "fields/lobatto.hpp"
#include "linear_algebra/dense.hpp"
#include "linear_algebra/products.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

/// Small motions about φ = 0 by Ritz's method with polynomials over the whole domain, integrals of Legendre's, which
/// converge exponentially where the coefficients are smooth. K and M are sums over Gauss-Lobatto points of second
/// derivatives of ℒ at rest; what the ends hold is put in by an orthonormal basis of the polynomials that obey it.
namespace maupertuis {
namespace {

constexpr int degree = 40;

/// The basis functions with two derivatives at x: the lowest polynomials, and integrals of Legendre's polynomials, once
/// where ℒ holds slopes, twice where it holds curvatures. So K is a sum of products of orthonormal functions, and keeps
/// the digits of the lowest modes, which second derivatives of high polynomials would drown.
struct BasisValues {
  std::vector<double> of[3];

  BasisValues(double x, std::size_t depth) {
    std::vector<double> p(degree + 4);
    p[0] = 1, p[1] = x;
    for (std::size_t n = 2; n < p.size(); ++n)
      p[n] = ((2.0 * n - 1) * x * p[n - 1] - (n - 1.0) * p[n - 2]) / static_cast<double>(n);
    // ∫P_n = (P_{n+1} − P_{n−1})/(2n + 1), ∫P_0 = P_1; integrals[d][n] is the d-fold one
    std::vector<std::vector<double>> integrals{p};
    const auto once = [&](const std::vector<double>& next, const std::vector<double>& before, std::size_t n) {
      return n == 0 ? next[1] : (next[n + 1] - before[n - 1]) / (2.0 * n + 1);
    };
    integrals.emplace_back(degree + 3);
    for (std::size_t n = 0; n < degree + 3; ++n) integrals[1][n] = once(p, p, n);
    integrals.emplace_back(degree + 2);
    for (std::size_t n = 0; n < degree + 2; ++n)  // ∬P_0 = ∫P_1
      integrals[2][n] = n == 0 ? integrals[1][1] : (integrals[1][n + 1] - integrals[1][n - 1]) / (2.0 * n + 1);
    for (std::size_t d = 0; d < 3; ++d) {
      of[d].assign(degree + 1, 0);
      for (std::size_t n = 0; n < depth; ++n) of[d][n] = d == 0 ? p[n] : d == 1 && n == 1 ? 1 : 0;
      for (std::size_t n = depth; n <= degree; ++n)
        of[d][n] = d <= depth ? std::sqrt(n - depth + 0.5) * integrals[depth - d][n - depth] : 0;
    }
  }
};

bool refuse_modes_of(const FieldEquations& equations, Diagnostics& diagnostics, const std::string& why) {
  diagnostics.error("E0644", equations.system().density_span, "this field has no modes to be computed", why,
                    "Modes are those of one space variable with a domain, about φ = 0, with coefficients that do not "
                    "change in time.");
  return false;
}

bool has_modes_at_rest(const FieldEquations& equations, Diagnostics& diagnostics) {
  const FieldSystem& s = equations.system();
  if (s.space.size() != 1 || !s.space.front().from)
    return refuse_modes_of(equations, diagnostics, "It has several space variables, or no domain.");
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

/// A second derivative of ℒ at rest, by two jets, as a function of x.
struct Entry {
  std::size_t a = 0, b = 0;
  int da = 0, db = 0;  // derivatives by x
  bool kinetic = false;
  Expr value;
};

bool entries_of(const FieldEquations& equations, std::vector<Entry>& out, Diagnostics& diagnostics) {
  const FieldSystem& s = equations.system();
  const Expr density = s.expanded(s.density);
  ExprMap rest;
  for (const Expr& jet : s.jets_in(density)) rest[jet] = s.context->number(0);
  const auto place = [&](std::size_t field) {
    return static_cast<std::size_t>(std::find(equations.varied.begin(), equations.varied.end(), field) -
                                    equations.varied.begin());
  };
  for (const Expr& one : s.jets_in(density))
    for (const Expr& two : s.jets_in(density)) {
      const FieldJet a = *s.jet_of(one), b = *s.jet_of(two);
      const Expr value = substitute(differentiate(differentiate(density, one), two), rest);
      if (value.is_zero() || s.fields[a.field].given || s.fields[b.field].given) continue;
      if (a.time != b.time)
        return refuse_modes_of(equations, diagnostics, "Its density has gyroscopic terms, velocities times fields.");
      if (s.context->depends_on_time(value.id()))
        return refuse_modes_of(equations, diagnostics, "Its coefficients change in time.");
      out.push_back({place(a.field), place(b.field), a.space[0], b.space[0], a.time == 1, value});
    }
  return true;
}

}  // namespace

std::vector<double> field_frequencies(const FieldEquations& equations, std::size_t count, Diagnostics& diagnostics) {
  std::vector<Entry> entries;
  if (!has_modes_at_rest(equations, diagnostics) || !entries_of(equations, entries, diagnostics)) return {};
  const FieldSystem& s = equations.system();
  Bindings values;
  for (const Parameter& p : equations.model->parameters) values[p.symbol] = p.si_value;
  const double left = evaluate(s.expanded(s.space.front().from), values),
               right = evaluate(s.expanded(s.space.front().to), values);
  const double scale = 2 / (right - left);
  bool bends = false;
  for (const Entry& e : entries) bends = bends || e.da == 2;
  const std::size_t depth = bends ? 2 : 1, n = degree + 1, size = n * equations.varied.size();
  const auto dim = static_cast<Eigen::Index>(size);
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(dim, dim), m = k;
  const Lobatto rule(2 * degree);
  std::vector<Expr> roots;
  for (const Entry& e : entries) roots.push_back(e.value);
  const RepeatedEvaluation at(roots);
  for (std::size_t q = 0; q < rule.x.size(); ++q) {
    const double x = left + (rule.x[q] + 1) / scale;
    const std::vector<double> c =
        at([&](Expr symbol) { return symbol == s.space.front().symbol ? x : values.at(symbol); });
    const BasisValues p(rule.x[q], depth);
    for (std::size_t i = 0; i < entries.size(); ++i) {
      const Entry& e = entries[i];
      const double weight = rule.w[q] / scale * c[i] * std::pow(scale, e.da + e.db);
      Eigen::MatrixXd& to = e.kinetic ? m : k;
      for (std::size_t r = 0; r < n; ++r)
        for (std::size_t j = 0; j < n; ++j)
          to(static_cast<Eigen::Index>(e.a * n + r), static_cast<Eigen::Index>(e.b * n + j)) +=
              (e.kinetic ? weight : -weight) * p.of[e.da][r] * p.of[e.db][j];
    }
  }
  // What the ends hold: rows of a matrix C, C c = 0.
  std::vector<std::vector<double>> held;
  const auto hold = [&](std::size_t a, int derivative, double end, double other) {
    held.emplace_back(size, 0.0);
    const BasisValues here(end, depth), there(-end, depth);
    for (std::size_t r = 0; r < n; ++r)
      held.back()[a * n + r] = here.of[derivative][r] - other * there.of[derivative][r];
  };
  for (std::size_t a = 0; a < equations.varied.size(); ++a) {
    if (s.periodic) hold(a, 0, 1, 1);
    if (s.periodic && bends) hold(a, 1, 1, 1);
    for (const BoundaryCondition& b : s.boundary)
      if (equations.varied[a] == b.jet.field && (b.jet.order() == 0 || bends))
        hold(a, b.jet.order(), b.side == BoundaryCondition::Side::Right ? 1 : -1, 0);
  }
  Eigen::MatrixXd basis = Eigen::MatrixXd::Identity(dim, dim);
  if (!held.empty()) {
    Eigen::MatrixXd c(dim, static_cast<Eigen::Index>(held.size()));
    for (std::size_t j = 0; j < held.size(); ++j) {
      double norm = 0;
      for (const double v : held[j]) norm += v * v;
      for (std::size_t i = 0; i < size; ++i)
        c(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = held[j][i] / std::sqrt(norm);
    }
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(c);
    const Eigen::MatrixXd whole = columns_of_q(qr, dim);
    basis = whole.rightCols(dim - c.cols());
  }
  const Eigen::MatrixXd kk = symmetric_part(quadratic_form(basis, k)), mm = symmetric_part(quadratic_form(basis, m));
  // M c = μ (K + σ M) c, μ = 1/(ω² + σ): the lowest frequencies are the largest μ, which keep their digits.
  double shift = kk.trace() / static_cast<double>(kk.rows());
  std::vector<double> out;
  for (int pass = 0; pass < 2; ++pass) {  // the second with σ of the size of what is looked for
    const Eigen::LLT<Eigen::MatrixXd> factor(symmetric_part(kk + shift * mm));
    if (factor.info() != Eigen::Success || !(shift > 0))
      return refuse_modes_of(equations, diagnostics, "Its energy is not positive."), std::vector<double>{};
    const Eigen::MatrixXd inverse = factor.matrixL().solve(Eigen::MatrixXd::Identity(mm.rows(), mm.cols()));
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
    solver.compute(symmetric_part(product_transposed(product(inverse, mm), inverse)), Eigen::EigenvaluesOnly);
    const Eigen::VectorXd& mu = solver.eigenvalues();  // ascending
    out.clear();
    for (Eigen::Index i = mu.size(); i-- > 0 && out.size() < count;) {
      const double square = 1 / mu(i) - shift, rounding = 1e-12 / mu(i);
      out.push_back(square > rounding ? std::sqrt(square) : std::abs(square) <= rounding ? 0 : -std::sqrt(-square));
    }
    if (!out.empty() && out.back() > 0) shift = out.back() * out.back();
  }
  return out;
}

}  // namespace maupertuis
