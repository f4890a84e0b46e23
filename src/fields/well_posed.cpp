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

/// Values of parameters and of the space variables at places of the domain, which are none of its ends; at 1 along a
/// variable without ends.
std::vector<Bindings> places_of(const FieldEquations& equations) {
  const FieldSystem& s = equations.system();
  Bindings parameters;
  for (const Parameter& p : equations.model->parameters) parameters[p.symbol] = p.si_value;
  constexpr double parts[] = {0.04, 0.23, 0.47, 0.71, 0.96};
  std::vector<Bindings> out{parameters};
  for (const SpaceVariable& x : s.space) {
    std::vector<Bindings> with_x;
    for (const Bindings& place : out) {
      with_x.push_back(place);
      if (!x.from) {
        with_x.back()[x.symbol] = 1;
        continue;
      }
      const double from = evaluate(s.expanded(x.from), parameters), to = evaluate(s.expanded(x.to), parameters);
      with_x.pop_back();
      for (const double part : parts) with_x.push_back(place), with_x.back()[x.symbol] = from + part * (to - from);
    }
    out = std::move(with_x);
  }
  return out;
}

/// The equations with the coefficients that they have at a place, about φ = 0 or the `jets` that are known. Nothing
/// where one has no value there, or a higher derivative in time than the second stands there.
std::optional<std::vector<Term>> linearized(const FieldEquations& equations, const Bindings& place,
                                            const Bindings& known_jets = {}) {
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
      for (const Expr& symbol : symbols_of({&slopes[n], 1})) {
        const auto known = place.find(symbol);
        const auto jet_value = known_jets.find(symbol);
        values[symbol] = known != place.end()                              ? known->second
                         : jet_value != known_jets.end()                   ? jet_value->second
                         : s.jet_of(symbol) || symbol.role() == Role::Time ? 0
                                                                           : 1;
      }
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

struct Growth {
  double rate = 0;   // the largest Re σ
  double speed = 0;  // the largest |σ|
};

/// Of waves; 0 where nothing is decided: some fields are of second order in time, others not.
Growth growth(const std::vector<Term>& terms, std::size_t fields, const Direction& direction, double k) {
  const Pencil pencil(terms, fields, direction, k);
  const auto& [a0, a1, a2] = pencil.a;
  const Eigen::Index n = a0.rows();
  Eigen::MatrixXd motion;
  double unit = 1;  // of σ, so that all entries are of one size
  if (Pencil::size(a2) == 0) {
    const auto m = solved(a1, a0);
    if (!m) return {};
    motion = -*m;
    unit = std::max(Pencil::size(motion), 1e-300);
    motion /= unit;
  } else {
    const auto stiffness = solved(a2, a0), damping = solved(a2, a1);
    if (!stiffness || !damping) return {};
    unit = std::max({std::sqrt(Pencil::size(*stiffness)), Pencil::size(*damping), 1e-300});
    motion = Eigen::MatrixXd::Zero(2 * n, 2 * n);
    motion.topRightCorner(n, n).setIdentity();
    motion.bottomLeftCorner(n, n) = -*stiffness / (unit * unit);
    motion.bottomRightCorner(n, n) = -*damping / unit;
  }
  Eigen::EigenSolver<Eigen::MatrixXd> solver;
  solver.compute(motion, false);
  if (solver.info() != Eigen::Success) return {};
  Growth out;
  for (Eigen::Index i = 0; i < motion.rows(); ++i) {
    out.rate = std::max(out.rate, solver.eigenvalues()(i).real());
    out.speed = std::max(out.speed, std::abs(solver.eigenvalues()(i)));
  }
  constexpr double rounding = 1e-6;  // of double roots, which rounding splits by its root
  return {out.rate > rounding ? out.rate * unit : 0, out.speed * unit};
}

/// Along each space variable, then the diagonal of all.
std::vector<Direction> directions(std::size_t count) {
  std::vector<Direction> out;
  for (std::size_t x = 0; x < count; ++x) out.emplace_back(count, 0.0), out.back()[x] = 1;
  if (count > 1) out.emplace_back(count, 1 / std::sqrt(static_cast<double>(count)));
  return out;
}

bool changes_in_space(const FieldEquations& equations) {
  const FieldSystem& s = equations.system();
  for (const Expr& r : equations.residuals)
    for (const Expr& symbol : symbols_of({&r, 1}))
      for (const SpaceVariable& x : s.space)
        if (symbol == x.symbol) return true;
  return false;
}

/// What a wave number is measured by: the reciprocal of the longest side of the domain; 1 where none has ends.
double wave_unit(const FieldEquations& equations) {
  const FieldSystem& s = equations.system();
  Bindings parameters;
  for (const Parameter& p : equations.model->parameters) parameters[p.symbol] = p.si_value;
  double longest = 0;
  for (const SpaceVariable& x : s.space)
    if (x.from)
      longest = std::max(longest,
                         std::abs(evaluate(s.expanded(x.to), parameters) - evaluate(s.expanded(x.from), parameters)));
  return longest > 0 && std::isfinite(longest) ? 1 / longest : 1;
}

constexpr double few_waves = 1e4, many_waves = 1e6;  // over the domain, in radians

struct IllPosed {
  std::size_t direction = 0;
  double few = 0, many = 0;  // rates of growth
  bool fed = false;          // by the dissipation density, not by the stiffness
};

/// Whether short waves grow the faster the shorter they are, and not behind `part` of their frequency.
std::optional<IllPosed> ill_posed(const FieldEquations& equations, const std::vector<Term>& terms, double part) {
  const std::vector<Direction> all = directions(equations.system().space.size());
  const double unit = wave_unit(equations);
  for (std::size_t d = 0; d < all.size(); ++d) {
    const Growth few = growth(terms, equations.varied.size(), all[d], few_waves * unit),
                 many = growth(terms, equations.varied.size(), all[d], many_waves * unit);
    if (!(many.rate > 8 * few.rate) || !(many.rate > part * many.speed)) continue;
    IllPosed out{d, few.rate, many.rate, false};
    std::vector<Term> without;
    for (const Term& t : terms)
      if (t.jet.time != 1) without.push_back(t);
    out.fed = equations.system().dissipation && without.size() < terms.size() && !ill_posed(equations, without, part);
    return out;
  }
  return std::nullopt;
}

void refuse_growing_waves(const FieldEquations& equations, Diagnostics& diagnostics, const Bindings& place,
                          const IllPosed& found, bool at_start) {
  const std::size_t direction = found.direction;
  const FieldSystem& s = equations.system();
  std::string trouble, relation, where;
  if (const auto w = dispersion(equations, trouble); w && w->im.is_zero())
    relation = fmt::format(" Its dispersion relation is {} = 0.",
                           to_plain(lay_out(readable(w->re, equations.order), equations.order)));
  if (at_start) relation.clear();  // which is about φ = 0
  if (at_start || changes_in_space(equations))
    for (const SpaceVariable& x : s.space)
      where += fmt::format("{}{} = {:.4g}", where.empty() ? " at " : ", ", x.name, place.at(x.symbol));
  const std::string along = s.space.size() == 1           ? ""
                            : direction == s.space.size() ? " along the diagonal"
                                                          : " along " + s.space[direction].name;
  diagnostics.error(
      "E0641", s.density_span,
      fmt::format("the field equation{} ill-posed: short waves grow without bound",
                  equations.varied.size() == 1 ? " is" : "s are"),
      fmt::format("A wave{}{} of wave number {:.3g} grows at the rate {:.3g}, one of {:.3g} at {:.3g}: the "
                  "shorter, the faster ({}).{}",
                  along, (at_start ? " about the start" : "") + where, many_waves * wave_unit(equations), found.many,
                  few_waves * wave_unit(equations), found.few,
                  found.fed ? "the dissipation density is negative for them, and feeds them" : "elliptic in time",
                  relation),
      found.fed ? "A dissipation density is positive: what it takes is 2 𝒟 for a quadratic one."
                : "The parts of u' and of u_x have opposite signs in the density of a wave.");
}

/// What the start says of the jets in the equations at a place.
Bindings start_jets(const FieldEquations& equations, const Bindings& place) {
  const FieldSystem& s = equations.system();
  Bindings out;
  for (const Expr& residual : equations.residuals)
    for (const Expr& symbol : s.jets_in(s.expanded(residual))) {
      const FieldJet jet = *s.jet_of(symbol);
      for (const FieldStart& start : equations.model->start) {
        if (start.field != jet.field || start.order != jet.time) continue;
        Expr value = s.expanded(start.value);
        for (std::size_t x = 0; x < s.space.size(); ++x)
          for (int k = 0; k < jet.space[x]; ++k) value = differentiate(value, s.space[x].symbol);
        out[symbol] = evaluate(value, place);
      }
    }
  return out;
}

}  // namespace

void refuse_ill_posed(const FieldEquations& equations, Diagnostics& diagnostics) {
  constexpr std::size_t most_fields = 12;
  if (equations.varied.size() > most_fields) return;
  // Coefficients of places are held while the wave is looked at, so that their slopes let waves grow which do not, by a
  // rate that falls behind their frequency; elliptic ones do not fall behind.
  const double part = changes_in_space(equations) ? 1e-3 : 0;
  for (const Bindings& place : places_of(equations)) {
    const auto terms = linearized(equations, place);
    if (!terms) continue;
    if (const auto found = ill_posed(equations, *terms, part))
      return refuse_growing_waves(equations, diagnostics, place, *found, false);
  }
}

bool refuse_ill_posed_start(const FieldEquations& equations, Diagnostics& diagnostics) {
  const FieldSystem& s = equations.system();
  constexpr std::size_t most_fields = 12;
  if (equations.varied.size() > most_fields || !s.space.front().from) return false;
  constexpr double part = 1e-2;  // as above; two roots that are nearly one are split by 1e-3 of the frequency
  for (const Bindings& place : places_of(equations)) {
    const auto terms = linearized(equations, place, start_jets(equations, place));
    if (!terms) continue;
    const auto found = ill_posed(equations, *terms, part);
    if (!found) continue;
    refuse_growing_waves(equations, diagnostics, place, *found, true);
    return true;
  }
  return false;
}

}  // namespace maupertuis
