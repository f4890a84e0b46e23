#include "fields/small_motions.hpp"

#include <maupertuis/evaluate.hpp>
#include <maupertuis/kinds.hpp>

#include "fields/given_fields.hpp"
#include "linear_algebra/products.hpp"
#include "linear_algebra/quadrature.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
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

namespace {

/// An empty handle where a given field has no formula.
Expr known(const FieldEquations& equations, Expr e) {
  const FieldSystem& s = equations.system();
  const Expr out = with_given_fields(s, e);
  const std::vector<Expr> jets = s.jets_in(out);
  const bool all =
      std::none_of(jets.begin(), jets.end(), [&](Expr jet) { return s.fields[s.jet_of(jet)->field].given; });
  return all ? out : Expr{};
}

}  // namespace

bool changes_in_time(const FieldSystem& s, Expr e) {
  ExprMap still;
  for (const Expr& jet : s.jets_in(e)) still.emplace(jet, s.context->number(Rational(618034, 1000000)));
  return s.context->depends_on_time(substitute(e, still).id());
}

Expr density_of(const FieldEquations& equations) { return known(equations, equations.system().density); }

namespace {

/// −∂f_a/∂φ_b of force densities is a part of the stiffness where it is symmetric.
bool add_forces(const FieldEquations& equations, DensityEntries& out, Diagnostics& diagnostics) {
  const FieldSystem& s = equations.system();
  const std::size_t n = equations.varied.size();
  std::vector<Expr> slopes(n * n, s.context->number(0));
  for (std::size_t a = 0; a < n; ++a) {
    const Expr force = s.forces[equations.varied[a]];
    if (!force) continue;
    const Expr f = known(equations, force);
    if (!f) return refuse_modes_of(equations, diagnostics, "A given field has no formula.");
    const ExprMap rest = out.rest.values(equations, f);
    for (const Expr& one : s.jets_in(f)) {
      const FieldJet jet = *s.jet_of(one);
      if (jet.time > 0)
        return refuse_modes_of(equations, diagnostics,
                               "A force density changes with a velocity: motions are damped or driven.");
      if (jet.order() > 0)
        return refuse_modes_of(equations, diagnostics, "A force density changes with a slope: it has no potential.");
      const Expr slope = differentiate(f, one), value = substitute(slope, rest);
      if (!s.jets_in(slope).empty()) out.linear = false;
      if (changes_in_time(s, value)) return refuse_modes_of(equations, diagnostics, "Its coefficients change in time.");
      for (std::size_t b = 0; b < n; ++b)
        if (equations.varied[b] == jet.field) slopes[a * n + b] = value;
    }
  }
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = 0; b < n; ++b) {
      if (zero_test(slopes[a * n + b] - slopes[b * n + a]).verdict != Verdict::Zero)
        return refuse_modes_of(equations, diagnostics, "Its force densities have no potential.");
      if (!slopes[a * n + b].is_zero()) out.list.push_back({a, b, 0, 0, 0, 0, slopes[a * n + b]});
    }
  return true;
}

}  // namespace

bool DensityEntries::have_inertia() const {
  return std::any_of(list.begin(), list.end(), [](const DensityEntry& e) { return e.ta + e.tb > 0; });
}

bool entries_of(const FieldEquations& equations, DensityEntries& out, Diagnostics& diagnostics,
                std::shared_ptr<const RestingFields> computed) {
  const FieldSystem& s = equations.system();
  const Expr density = density_of(equations);
  if (!density) return refuse_modes_of(equations, diagnostics, "A given field has no formula.");
  out = {};
  if (computed)
    out.rest.fields.assign(equations.varied.size(), s.context->number(0)), out.rest.computed = std::move(computed);
  else
    out.rest = rest_of(equations);
  const ExprMap rest = out.rest.values(equations, density);
  for (const Expr& one : s.jets_in(density))
    for (const Expr& two : s.jets_in(density)) {
      const FieldJet a = *s.jet_of(one), b = *s.jet_of(two);
      const Expr second = differentiate(differentiate(density, one), two);
      if (!s.jets_in(second).empty()) out.linear = false;
      const Expr value = substitute(second, rest);
      if (value.is_zero()) continue;
      if (changes_in_time(s, value)) return refuse_modes_of(equations, diagnostics, "Its coefficients change in time.");
      DensityEntry entry{equations.varied_index(a.field),
                         equations.varied_index(b.field),
                         a.space[0],
                         b.space[0],
                         a.time,
                         b.time,
                         value};
      if (s.space.size() > 1) entry.ya = a.space[1], entry.yb = b.space[1];
      out.list.push_back(entry);
    }
  return add_forces(equations, out, diagnostics);
}

bool entries_at_rest(const FieldEquations& equations, DensityEntries& out, std::optional<ComputedRest>& computed,
                     Diagnostics& diagnostics) {
  if (!entries_of(equations, out, diagnostics)) return false;
  const bool rests = is_rest(equations, out.rest);
  if (rests && !equations.bodies && (out.linear || out.have_inertia())) return true;
  std::string why;
  computed = rest_in_numbers(equations, why);
  if (computed && rests && out.have_inertia() && vanishes(equations, computed->values)) {
    computed.reset();
    return true;
  }
  if (computed) return entries_of(equations, out, diagnostics, computed->finest);
  // Frequencies of linear fields are the same about every rest.
  if (out.linear && (rests || out.have_inertia())) return true;
  if (rests && !equations.bodies) return true;
  return refuse_modes_of(equations, diagnostics, why);
}

void add_errors_of_rest(const FieldEquations& equations, const ComputedRest& computed, FieldModes& modes,
                        const std::function<FieldModes(const DensityEntries&)>& of) {
  if (modes.frequencies.empty()) return;
  Diagnostics unheard;
  DensityEntries entries;
  if (!entries_of(equations, entries, unheard, computed.before) || entries.linear) return;
  const FieldModes other = of(entries);
  for (std::size_t i = 0; i < modes.errors.size() && i < other.frequencies.size(); ++i)
    modes.errors[i] += std::abs(modes.frequencies[i] - other.frequencies[i]);
}

std::string no_small_motions(const SmallMotions& motions) {
  if (!motions.mass.allFinite() || !motions.stiffness.allFinite() || !motions.gyroscopic.allFinite())
    return "A coefficient of its density is infinite, or has no value, somewhere in the domain.";
  const bool first_order = motions.mass.cwiseAbs().maxCoeff() == 0 && motions.gyroscopic.size() > 0 &&
                           motions.gyroscopic.cwiseAbs().maxCoeff() > 0;
  if (first_order) return "Of first order in time it has frequencies where every displacement costs energy.";
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
    // What has no mass follows the rest at once: its μ is 0 but for rounding.
    constexpr double massless = 1e-9;
    for (Eigen::Index i = mu.size(); i-- > 0 && out.size() < count && mu(i) > massless * mu.tail(1)(0);) {
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
  if (!motions.stiffness.allFinite() || !motions.mass.allFinite()) return false;
  // Of the first order in time: no mass at all, G ċ + K c = 0, as waves of quantum mechanics.
  if (!(motions.mass.trace() > 0) && motions.mass.cwiseAbs().maxCoeff() > 0) return false;
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

namespace {

/// What is left where two sizes agree. The eigenvalues μ = 1/(λ + σ) of n rows, with λ = ω² and σ the largest λ looked
/// for, are rounded to n units in the last place of the largest μ; δλ = (λ + σ)² δμ. Four times that: so much is seen
/// beside closed forms.
double rounding_of(const std::vector<double>& frequencies, std::size_t i, Eigen::Index n) {
  const auto square = [&](std::size_t k) { return frequencies[k] * frequencies[k]; };
  const double lambda = square(i), sigma = square(frequencies.size() - 1), lowest = square(0);
  if (!(lambda > 0)) return 0;  // a mode without frequency is told as such
  const double unit = static_cast<double>(n) * std::numeric_limits<double>::epsilon();
  const double sum = lambda + sigma;
  return 4 * unit * sum * sum / (lowest + sigma) / (2 * std::sqrt(lambda));
}

}  // namespace

bool FrequencyErrors::settle(const std::vector<double>& frequencies, std::size_t counted, Eigen::Index rows) {
  constexpr double close = 1e-11;
  double off = 0, largest = 0;
  changes_.clear(), rounding_.clear();
  for (std::size_t i = 0; i < frequencies.size(); ++i) {
    changes_.push_back(i < before_.size() ? std::abs(frequencies[i] - before_[i])
                                          : std::numeric_limits<double>::infinity());
    rounding_.push_back(rounding_of(frequencies, i, rows));
    if (i < counted) off = std::max(off, changes_[i]), largest = std::max(largest, std::abs(frequencies[i]));
  }
  // Where coefficients jump within the domain convergence is slow, and the last change is less than what is left: that
  // of a geometric series beyond its last term.
  constexpr double slowest = 0.8, caution = 2;
  const double ratio = off_before_ > 0 && std::isfinite(off_before_) ? std::min(slowest, off / off_before_) : 0;
  off_before_ = off, missing_ = std::max(1.0, caution * ratio / (1 - ratio));
  before_ = frequencies;
  return off <= close * largest;
}

std::vector<double> FrequencyErrors::errors() const {
  std::vector<double> out;
  for (std::size_t i = 0; i < changes_.size(); ++i) out.push_back(missing_ * (changes_[i] + rounding_[i]));
  return out;
}

double unseen_along(const std::function<double(double)>& f, double from, double length,
                    const std::vector<std::pair<double, double>>& points) {
  constexpr int places = 4000;
  double by_points = 0, by_places = 0, size = 0;
  for (const auto& [place, weight] : points) by_points += weight / length * f(place);
  for (int i = 0; i < places; ++i) {
    const double v = f(from + length * (i + 0.5) / places);
    by_places += v / places, size += std::abs(v) / places;
  }
  return size > 0 ? std::abs(by_points - by_places) / size : 0;
}

double unfollowed_along(const std::function<double(double)>& f, const std::vector<double>& borders, int degree,
                        bool beside_itself) {
  constexpr int places = 400;  // of an element
  const Lobatto rule(degree);
  const double length = borders.back() - borders.front();
  double off = 0, size = 0, ratio = 0;
  for (std::size_t e = 0; e + 1 < borders.size(); ++e) {
    const double width = borders[e + 1] - borders[e];
    const auto value = [&](double xi) {  // inside: at a border it may jump
      return f(borders[e] + width * std::clamp((1 + xi) / 2, 1e-13, 1 - 1e-13));
    };
    std::vector<double> nodes, factor, slope;
    for (const double xi : rule.x) nodes.push_back(value(xi));
    for (int i = 0; i < places; ++i) {
      const double xi = 2 * (i + 0.5) / places - 1, v = value(xi);
      rule.at(xi, factor, slope);
      const double polynomial = std::inner_product(nodes.begin(), nodes.end(), factor.begin(), 0.0);
      const double part = width / length / places, distance = std::abs(v - polynomial);
      off += part * distance, size += part * std::abs(v);
      ratio += part * std::min(1.0, distance / std::max(std::abs(v), 1e-300));
    }
  }
  return beside_itself ? ratio : size > 0 ? off / size : 0;
}

bool add_unseen(const FieldEquations& equations, const UnseenParts& unseen, FieldModes& modes,
                Diagnostics& diagnostics) {
  constexpr double much = 0.03, much_unfollowed = 0.25, places = 1e-6;  // the last: of the sum over places itself
  std::string why;
  if (!(unseen.between < much))
    why = fmt::format("Between their points lie {:.2g} % of it, and no value could be trusted.", 100 * unseen.between);
  else if (!(unseen.unfollowed < much_unfollowed))
    why =
        fmt::format("Polynomials of their degree are off by {:.2g} % of it in the mean, and no value could be trusted.",
                    100 * unseen.unfollowed);
  if (!why.empty()) {
    diagnostics.error("E0647", equations.system().density_span,
                      "the polynomials of the modes pass by what a coefficient has somewhere", why,
                      "Make it wider, or `maup simulate` the motion with more `cells`.");
    return false;
  }
  const double part =
      (unseen.between > places ? 4 * unseen.between : 0) + (unseen.unfollowed > places ? unseen.unfollowed : 0);
  for (std::size_t i = 0; i < modes.errors.size(); ++i) modes.errors[i] += part * std::abs(modes.frequencies[i]);
  return true;
}

bool sees_what_acts(const FieldEquations& equations, const Borders& elements, const std::vector<int>& points,
                    Diagnostics& diagnostics) {
  // Beside a jump no polynomial follows; what that does to frequencies is in their errors, by meshes of several widths.
  const Expr density = equations.system().density;
  const std::vector<Expr> nodes = topological_order({&density, 1});
  if (std::any_of(nodes.begin(), nodes.end(), [](const Expr& e) { return has_switch(e.kind()); })) return true;
  constexpr int highest = 20;  // of polynomials through nodes: longer elements are looked at in parts
  const int order = std::min(highest, *std::min_element(points.begin(), points.end()));
  Borders parts;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const std::vector<double>& borders = elements[i];
    const int count = std::max(points[i] / order, 1);
    parts.push_back({borders.front()});
    for (std::size_t e = 0; e + 1 < borders.size(); ++e) {
      for (int k = 1; k < count; ++k) parts[i].push_back(borders[e] + (borders[e + 1] - borders[e]) * k / count);
      parts[i].push_back(borders[e + 1]);
    }
  }
  const auto passed = passed_by(equations, parts, order);
  if (passed)
    diagnostics.error("E0647", equations.system().density_span, "the polynomials of the modes pass by what " + *passed,
                      "It lies between the points at which coefficients are taken, and no value could be trusted.",
                      "Make it wider, or `maup simulate` the motion with more `cells`.");
  return !passed;
}

}  // namespace maupertuis
