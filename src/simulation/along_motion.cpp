#include <maupertuis/along_motion.hpp>

#include <maupertuis/degenerate.hpp>
#include <maupertuis/simulation.hpp>
#include <maupertuis/switches.hpp>
#include <maupertuis/transform.hpp>

#include "linear_algebra/dense.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace maupertuis {
namespace {

constexpr int far_centers = 2;
constexpr double part_of_size = 0.3;  // of what starts at 0: where points are looked for

/// What the base units are worth in a model: such that its numbers are of order one in these units, as nearly as they
/// can be (least squares of the logarithms); 1 where none knows a unit. A pendulum of 1 nm has lengths of 1 nm, and
/// times of √(l/g).
class NaturalUnits {
 public:
  explicit NaturalUnits(const MechanicalSystem& system, const MotionState* start) {
    for (const Parameter& p : system.parameters) add(p.dimension, p.si_value);
    for (std::size_t i = 0; start && i < system.coordinates.size(); ++i) {
      const Dimension& d = system.coordinates[i].dimension;
      if (std::abs(start->q[i]) > noise) add(d, start->q[i]);
      if (std::abs(start->v[i]) > noise) add(d / dimensions::time(), start->v[i]);
    }
    solve();
  }

  double of(const Dimension& dimension) const { return std::exp(exponents(dimension).dot(logarithms_)); }

 private:
  static constexpr int bases = Dimension::Angle;  // an angle is of order one
  static constexpr double noise = 1e-12;          // of starts that were moved onto the constraints
  using Row = Eigen::VectorXd;

  static Row exponents(const Dimension& dimension) {
    Row row = Row::Zero(bases);
    for (int b = 0; b < bases; ++b) {
      const Dimension::Exponent e = dimension.exponents[static_cast<std::size_t>(b)];
      row[b] = static_cast<double>(e.numerator) / e.denominator;
    }
    return row;
  }
  void add(const Dimension& dimension, double value) {
    if (value == 0 || !std::isfinite(value) || exponents(dimension).isZero()) return;
    rows_.push_back(exponents(dimension));
    values_.push_back(std::log(std::abs(value)));
  }
  /// The shortest of the best: what is not determined stays 1 in SI.
  void solve() {
    logarithms_ = Row::Zero(bases);
    if (rows_.empty()) return;
    Eigen::MatrixXd matrix(static_cast<Eigen::Index>(rows_.size()), bases);
    for (std::size_t i = 0; i < rows_.size(); ++i) matrix.row(static_cast<Eigen::Index>(i)) = rows_[i].transpose();
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver(matrix);
    logarithms_ = solver.solve(Row(Eigen::Map<const Row>(values_.data(), matrix.rows())));
  }

  std::vector<Row> rows_;
  std::vector<double> values_;
  Row logarithms_;
};

/// Coordinates away from the center by up to one and a half of their sizes, other ones at each turn.
Bindings far_center(Bindings center, const MechanicalSystem& system, int turn) {
  constexpr double golden = 0.6180339887498949, another = 0.2763932022500211;
  double place = 0.31 + another * turn;
  for (const Coordinate& c : system.coordinates)
    for (const Expr& symbol : {c.q, c.velocity}) {
      place = std::fmod(place + golden, 1.0);
      center[symbol] += (3 * place - 1.5) * std::abs(center.at(symbol));
    }
  return center;
}

/// What the terms of a sum amount to; 1 where that has no value.
double amount_of_terms(Expr g, const Bindings& at) {
  std::vector<Expr> terms{g};
  if (g.is(Kind::Sum)) {
    terms.clear();
    for (std::size_t i = 0; i < g.size(); ++i) terms.push_back(g[i]);
  }
  double sum = 0;
  for (const double x : evaluate(terms, at)) sum += std::abs(x);
  return sum > 0 && std::isfinite(sum) ? sum : 1;
}

/// Unknowns in powers of ten near their sizes, so that what is 0 to rounding is told from what is small: 1e-15 m of a
/// pendulum of 1 nm, and a multiplier of 5e-16 kg/s² of one of 1e12 m. That of a multiplier follows from the other
/// terms of its equations.
class OwnUnits {
 public:
  OwnUnits(const ExprVector& relations, const ExprVector& unknowns, const Bindings& center) {
    for (const Expr& u : unknowns) {
      const double value = std::abs(center.at(u));
      const double size = value != 0                     ? value
                          : u.role() == Role::Multiplier ? size_of_multiplier(u, relations, center)
                                                         : 1;
      const long power = std::lround(std::log10(size));
      if (power == 0 || std::abs(power) > 200) continue;
      units_.emplace(u, std::pow(10.0, static_cast<double>(power)));
      in_units_.emplace(u, *Rational::parse(fmt::format("1e{}", power)) * u);
    }
  }

  ExprVector of(std::span<const Expr> formulas) const { return substitute(formulas, in_units_); }
  Bindings of(Bindings center) const {
    for (const auto& [symbol, unit] : units_) center[symbol] /= unit;
    return center;
  }
  ZeroTest in_si(ZeroTest test) const {
    for (auto& [symbol, value] : test.witness)
      if (const auto unit = units_.find(symbol); unit != units_.end()) value *= unit->second;
    return test;
  }

 private:
  static double size_of_multiplier(Expr multiplier, const ExprVector& relations, const Bindings& center) {
    double products = 0, squares = 0;
    for (const Expr& r : relations) {
      const double slope = std::abs(evaluate(differentiate(r, multiplier), center));
      if (slope == 0) continue;
      products += slope * amount_of_terms(r, center);
      squares += slope * slope;
    }
    const double size = products / squares;
    return std::isfinite(size) && size > 0 ? size : 1;
  }

  Bindings units_;
  ExprMap in_units_;
};

/// Tests of one formula in several parts of the constraint manifold: what does not vanish in one decides, and where no
/// point is found nothing is said.
class OnConstraints {
 public:
  using Test = std::function<ZeroTest(Expr, const ExprVector& relations, const ExprVector& unknowns, const Bindings&)>;
  OnConstraints(Expr formula, const ExprVector& relations, const ExprVector& unknowns, Test test_on)
      : formula_(formula), relations_(relations), unknowns_(unknowns), test_on_(std::move(test_on)) {}

  void near(const Bindings& center) { take(relations_, unknowns_, center); }

  /// On both sides of a switch, where the constraints let it pass: at states where g has a small value, of several
  /// sizes, so that a narrow branch is met as well.
  void beside(Expr g, Bindings center, Context& context) {
    const Expr level = context.symbol("level of a switch", Role::Constant);
    ExprVector relations = relations_, unknowns = unknowns_;
    relations.push_back(g - level);
    if (!differentiate(g, context.time()).is_zero()) unknowns.push_back(context.time());
    const double size = amount_of_terms(g, center);
    for (const double part : {0.1, -0.1, 1e-3, -1e-3, 1e-6, -1e-6}) {
      center[level] = part * size;
      take(relations, unknowns, center);
    }
  }

  const ZeroTest& verdict() const { return all_; }

 private:
  void take(const ExprVector& relations, const ExprVector& unknowns, const Bindings& center) {
    if (all_.verdict == Verdict::Nonzero) return;
    ZeroTest here = test_on_(formula_, relations, unknowns, center);
    if (here.verdict == Verdict::Undecided && all_.verdict == Verdict::Zero) return;
    if (here.verdict == Verdict::Zero && all_.verdict == Verdict::Zero) here.points += all_.points;
    all_ = std::move(here);
  }

  Expr formula_;
  const ExprVector &relations_, &unknowns_;
  Test test_on_;
  ZeroTest all_;
};

}  // namespace

std::string ground_of(const ZeroTest& test, bool constrained) {
  if (test.points == 0 && test.error_bound == 0)
    return "proved term by term: the difference of the two sides is 0 as it is written";
  if (constrained && test.error_bound == 1)
    return fmt::format("vanishes to 60 digits at {} points of the constraints", test.points);
  if (test.error_bound < 1)
    return fmt::format("proved{}{} at {} random points, error bound {:.1e}", test.reason.empty() ? "" : " ",
                       test.reason, test.points, test.error_bound);
  return test.reason.empty() ? fmt::format("vanishes at {} random points", test.points) : test.reason;
}

std::string asked_column(std::size_t index) { return fmt::format("asked({})", index); }

AlongMotion::AlongMotion(const EquationsOfMotion& equations) : AlongMotion(equations, equations.balance()) {}

AlongMotion::AlongMotion(const EquationsOfMotion& equations, const ExprVector& residual)
    : equations_(equations), residual_(residual) {}

/// q̈(q, q̇, t) of every coordinate; null with constraints, and where M is singular.
const ExprMap* AlongMotion::accelerations() const {
  if (!std::exchange(looked_for_accelerations_, true) && !constrained()) {
    const MechanicalSystem& system = *equations_.system;
    if (const auto solved = maupertuis::accelerations(in_terms_of_motion(system, residual_), system)) {
      accelerations_.emplace();
      for (std::size_t i = 0; i < solved->size(); ++i)
        accelerations_->emplace(system.coordinates[i].acceleration, (*solved)[i]);
    }
  }
  return accelerations_ ? &*accelerations_ : nullptr;
}

/// Lets, inputs and reactions put in, d/dt carried out.
Expr AlongMotion::in_motion(Expr e) const {
  e = with_reactions(equations_, {&e, 1}).front();
  return expand_time_derivatives(in_terms_of_motion(*equations_.system, {&e, 1}).front());
}

Expr AlongMotion::put_in(Expr e) const {
  const Expr plain = in_motion(e);
  const std::vector<Expr> symbols = symbols_of({&plain, 1});
  const bool accelerates = std::any_of(symbols.begin(), symbols.end(),
                                       [](const Expr& s) { return s.role() == Role::Coordinate && s.order() >= 2; });
  const ExprMap* const known = accelerates ? accelerations() : nullptr;
  return known ? substitute(plain, *known) : plain;
}

ZeroTest AlongMotion::vanishes(Expr e) const {
  const Expr plain = put_in(e);
  const ZeroTest test = as_formula(plain);
  if (test.verdict == Verdict::Zero) return test;
  // Numbers with units are symbols of their own: 3 [m] + 2 [m] is 5 [m] by their values alone.
  const Expr valued = with_constants_as_numbers(*equations_.system, {&plain, 1}).front();
  if (valued == plain) return test;
  const ZeroTest by_values = as_formula(valued);
  return by_values.verdict == Verdict::Zero ? by_values : test;
}

struct AlongMotion::Manifold {
  ExprVector relations, unknowns;
  Bindings center;
  ZeroTestWhere test;
};

/// A search for integrals tests hundreds of formulas on the same relations: their points are found once.
AlongMotion::Manifold& AlongMotion::manifold(const ExprVector& relations, const ExprVector& unknowns,
                                             const Bindings& center) const {
  constexpr std::size_t most = 16;
  for (const auto& known : manifolds_)
    if (known->relations == relations && known->unknowns == unknowns && known->center == center) return *known;
  if (manifolds_.size() == most) manifolds_.erase(manifolds_.begin());
  manifolds_.push_back(
      std::make_shared<Manifold>(Manifold{relations, unknowns, center, ZeroTestWhere(relations, unknowns, center)}));
  return *manifolds_.back();
}

ZeroTest AlongMotion::as_formula(Expr plain) const {
  if (!constrained() || plain.is_zero()) return vanish_for_given_signs(*equations_.system, {&plain, 1});
  const Where where = relations_for(plain);
  const OwnUnits units(where.relations, where.unknowns, where.center);
  const ExprVector relations = units.of(where.relations), formula = units.of({&plain, 1});
  const Bindings center = units.of(where.center);
  OnConstraints test(formula.front(), relations, where.unknowns,
                     [&](Expr e, const ExprVector& on, const ExprVector& by, const Bindings& near) {
                       return manifold(on, by, near).test({&e, 1});
                     });
  test.near(center);
  for (int turn = 0; turn < far_centers; ++turn) test.near(far_center(center, *equations_.system, turn));
  ExprVector functions = relations;
  functions.push_back(formula.front());
  for (const Expr& g : switches_of(functions)) test.beside(g, center, *equations_.system->context);
  return units.in_si(test.verdict());
}

ZeroTest AlongMotion::vanishes_on(Expr e, std::span<const Expr> level) const {
  const Expr plain = put_in(e);
  if (plain.is_zero()) return zero_test(plain);
  Where where = relations_for(plain);
  for (const Expr& x : level) where.relations.push_back(put_in(x));
  ZeroTestOptions options;
  options.hold_parameters = true;  // a level of numbers belongs to the values of the model
  const ZeroTest test = zero_test_where({&plain, 1}, where.relations, where.unknowns, where.center, options);
  if (test.verdict != Verdict::Undecided) return test;
  // r² φ' = 0: from the start Newton's method may run towards r = 0; from rest it need not.
  for (const Coordinate& c : equations_.system->coordinates) where.center[c.velocity] = 0.0;
  return zero_test_where({&plain, 1}, where.relations, where.unknowns, where.center, options);
}

Expr AlongMotion::rate(Expr integral) const {
  return put_in(total_time_derivative(put_in(integral)));  // d/dt of q̈ is that of its formula
}

ZeroTest AlongMotion::is_constant(Expr integral) const {
  if (const auto with_energy = is_constant_with_energy(integral)) return *with_energy;
  return vanishes(rate(integral));
}

/// The power P = Σ q̇ᵢ Rᵢ vanishes along the motion. Where W = dI/dt, for any q̈, is a multiple of it, W ∂P/∂q̈ₖ is
/// P ∂W/∂q̈ₖ identically, and W vanishes with P, since ∂P/∂q̈ₖ does not. Nothing where this says nothing.
std::optional<ZeroTest> AlongMotion::is_constant_with_energy(Expr integral) const {
  const MechanicalSystem& system = *equations_.system;
  if (constrained() || system.coordinates.empty()) return std::nullopt;
  ExprVector parts;
  for (std::size_t i = 0; i < system.coordinates.size(); ++i)
    parts.push_back(system.coordinates[i].velocity * in_motion(residual_[i]));
  const Expr power = system.context->sum(parts),
             rate = expand_time_derivatives(total_time_derivative(in_motion(integral)));
  const Expr acceleration = system.coordinates.front().acceleration;
  const Expr of_power = differentiate(power, acceleration), of_rate = differentiate(rate, acceleration);
  if (of_rate.is_zero()) return std::nullopt;
  const ZeroTest test = zero_test(rate * of_power - power * of_rate);
  if (test.verdict != Verdict::Zero || zero_test(of_power).verdict != Verdict::Nonzero) return std::nullopt;
  return test;
}

AcrossSwitches AlongMotion::across(Expr integral) const {
  const Expr plain = put_in(integral);
  return across_switches(*equations_.system, plain, equations_.order, [&](Expr g) { return rate(g); });
}

/// φ, dφ/dt or ψ, A q̈ − b, and R − Aᵀλ: what the motion satisfies at each point.
std::vector<Expr> AlongMotion::relations() const {
  if (equations_.degenerate) return relations_of_motion(equations_, *equations_.degenerate);
  const MechanicalSystem& system = *equations_.system;
  std::vector<Expr> out;
  for (const Constraint& c : system.constraints)
    if (c.level == Constraint::Level::Position) out.push_back(c.value);
  for (const auto* list : {&equations_.constraint_rates, &equations_.constraint_accelerations, &residual_})
    out.insert(out.end(), list->begin(), list->end());
  return in_terms_of_motion(system, expand_time_derivatives(out));
}

/// Of e, which may hold q⃛: then the derivatives of the equations too, with q⃛ and dλ/dt as further unknowns.
AlongMotion::Where AlongMotion::relations_for(Expr e) const {
  Where out;
  const std::vector<Coordinate>& coordinates = equations_.system->coordinates;
  out.center = center();
  for (const Coordinate& c : coordinates) out.unknowns.insert(out.unknowns.end(), {c.q, c.velocity});
  if (!constrained()) return out;
  out.relations = relations();
  for (const Coordinate& c : coordinates) out.unknowns.push_back(c.acceleration);
  out.unknowns.insert(out.unknowns.end(), equations_.multipliers.begin(), equations_.multipliers.end());
  const auto is_third = [](const Expr& s) { return s.role() == Role::Coordinate && s.order() == 3; };
  const std::vector<Expr> symbols = symbols_of({&e, 1});
  if (std::none_of(symbols.begin(), symbols.end(), is_third)) return out;

  ExprVector further;
  for (const Coordinate& c : coordinates) further.push_back(total_time_derivative(c.acceleration));
  for (const Expr& multiplier : equations_.multipliers)
    further.push_back(equations_.system->context->symbol("d/dt " + multiplier.name(), Role::Auxiliary));
  const std::size_t known = out.relations.size();
  for (std::size_t k = 0; k < known; ++k) {
    const ExprVector slopes = gradient(out.relations[k], equations_.multipliers);
    ExprVector terms{total_time_derivative(out.relations[k])};  // with λ held
    for (std::size_t i = 0; i < slopes.size(); ++i) terms.push_back(slopes[i] * further[coordinates.size() + i]);
    const Expr rate = equations_.system->context->sum(terms);
    const std::vector<Expr> in_rate = symbols_of({&rate, 1});
    if (std::any_of(in_rate.begin(), in_rate.end(),
                    [&](const Expr& s) { return std::find(further.begin(), further.end(), s) != further.end(); }))
      out.relations.push_back(rate);
  }
  for (const Expr& s : further) out.center[s] = 0.0;
  out.unknowns.insert(out.unknowns.end(), further.begin(), further.end());
  return out;
}

/// What starts at 0 has a part of its size instead: where a term vanishes there, as x (x/l)⁶, points beside it see it.
Bindings AlongMotion::center() const {
  const MechanicalSystem& system = *equations_.system;
  const NaturalUnits units(system, start_ ? &*start_ : nullptr);
  Bindings out = parameter_bindings(system);
  const auto set = [&](Expr symbol, double value, const Dimension& dimension) {
    const double size = part_of_size * units.of(dimension);
    out[symbol] = std::abs(value) > 1e-9 * size ? value : size;
  };
  for (std::size_t i = 0; i < system.coordinates.size(); ++i) {
    const Coordinate& c = system.coordinates[i];
    const Dimension rate = c.dimension / dimensions::time();
    set(c.q, start_ ? start_->q[i] : 0, c.dimension);
    set(c.velocity, start_ ? start_->v[i] : 0, rate);
    set(c.acceleration, 0, rate / dimensions::time());
  }
  for (const Expr& multiplier : equations_.multipliers) out[multiplier] = 0.0;
  if (start_) out[system.context->time()] = start_->t;
  return out;
}

}  // namespace maupertuis
