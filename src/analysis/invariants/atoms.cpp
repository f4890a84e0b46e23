#include "analysis/invariants/atoms.hpp"

#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/transform.hpp>

#include <algorithm>

namespace maupertuis::invariants {
namespace {

constexpr std::size_t term_budget = 3000;

void add_once(std::vector<Monomial>& list, const Monomial& m) {
  if (!m.empty() && std::find(list.begin(), list.end(), m) == list.end()) list.push_back(m);
}

class Collector {
 public:
  Collector(const EquationsOfMotion& equations, Generators& generators)
      : equations_(equations), system_(*equations.system), generators_(generators) {}

  Atoms collect() {
    for (const Coordinate& c : system_.coordinates) atoms_.coordinates.push_back(generators_.add(c.q));
    take(equations_.lagrangian_expanded, true);
    for (const auto* list : {&equations_.generalized_forces, &equations_.dissipative_terms})
      for (const Expr& e : *list) take(e, false);
    for (const Constraint& c : system_.constraints)
      if (c.level == Constraint::Level::Velocity) take(c.value, false);
    if (system_.constrained()) take_constraint_metric();
    take_inverse_metric();
    take_angles();
    take_linear_part();
    return std::move(atoms_);
  }

 private:
  /// The factors of each term that depend on q or t.
  void take(Expr e, bool of_lagrangian) {
    e = in_terms_of_motion(system_, {&e, 1}).front();
    const Expr expanded = expand(e, term_budget);
    if (!expanded) return take_nodes(e);
    const bool sum = expanded.is(Kind::Sum);
    for (std::size_t i = 0; i < (sum ? expanded.size() : 1); ++i)
      take_term(sum ? expanded[i] : expanded, of_lagrangian);
  }

  void take_term(Expr term, bool of_lagrangian) {
    Monomial position;
    int velocities = 0;
    const bool is_product = term.is(Kind::Product);
    Expr irrational = irrational_factor(term);
    for (std::size_t i = 0; i < (is_product ? term.size() : 1); ++i) {
      const Expr factor = is_product ? term[i] : term;
      if (is_parametric(factor)) continue;
      if (irrational && !factor.is_symbol() && depends_on_coordinates(factor) && !depends_on_velocities(factor)) {
        take_atom(generators_.add(irrational * factor), irrational * factor);
        irrational = Expr();
      }
      if (depends_on_velocities(factor)) {
        const PowerOf power = split_power(factor);
        const auto exponent = power.exponent.as_integer();
        if (power.base.is_symbol() && exponent && *exponent > 0)
          velocities += static_cast<int>(*exponent);
        else
          velocities = 3;
        continue;
      }
      const Monomial m = generators_.add_factors(factor);
      take_atom(m, factor);
      if (depends_on_coordinates(factor)) position = product(position, m);
    }
    if (of_lagrangian && velocities > 2) atoms_.natural = false;
    if (position.size() > 1 || degree(position) > 1) add_once(atoms_.products, position);
    if (of_lagrangian && velocities == 0) add_once(atoms_.potentials, position);
  }

  /// √2 of a term, which has to go with an atom: coefficients are fractions. Empty: none.
  static Expr irrational_factor(Expr term) {
    Expr out;
    for (std::size_t i = 0; term.is(Kind::Product) && i < term.size(); ++i)
      if (term[i].is(Kind::Power) && term[i][0].is_number()) out = out ? out * term[i] : term[i];
    return out;
  }

  void take_atom(Monomial m, Expr factor) {
    for (Factor& f : m) f.exponent = 1;
    if (!depends_on_coordinates(factor)) {
      if (!split_power(factor).base.is_symbol()) add_with_partner(atoms_.time, m);
      return;
    }
    if (m.size() == 1 && generators_.values()[m[0].generator].is_symbol()) return;
    add_with_partner(atoms_.functions, m);
  }

  /// sin x beside cos x: its derivative, and what ∫ cos x of a drive holds.
  void add_with_partner(std::vector<Monomial>& list, const Monomial& m) {
    add_once(list, m);
    const Expr e = generators_.values()[m[0].generator];
    if (e.is(Kind::Sin)) add_once(list, generators_.add(cos(e[0])));
    if (e.is(Kind::Cos)) add_once(list, generators_.add(sin(e[0])));
  }

  /// Of a formula that is too long to be multiplied out: its functions alone.
  void take_nodes(Expr e) {
    for (const Expr& node : topological_order({&e, 1})) {
      const bool root = node.is(Kind::Power) && !split_power(node).exponent.is_integer();
      if (!(node.is(Kind::Sin) || node.is(Kind::Cos) || root) || is_parametric(node) || depends_on_velocities(node))
        continue;
      take_atom(generators_.add_factors(node), node);
    }
  }

  /// √(a·M⁻¹a) of a velocity constraint a·q̇ = 0, where M is diagonal: the length by which reduced momenta are measured.
  void take_constraint_metric() {
    const ExprMatrix m = mass_matrix(equations_), a = constraint_matrix(equations_);
    if (a.rows != 1) return;
    Expr square = system_.context->number(0);
    for (std::size_t i = 0; i < m.rows; ++i) {
      for (std::size_t j = 0; j < m.rows; ++j)
        if (i != j && !m.at(i, j).is_zero()) return;
      if (m.at(i, i).is_zero()) return;
      square = square + a.at(0, i) * a.at(0, i) / m.at(i, i);
    }
    square = expand(in_terms_of_motion(system_, {&square, 1}).front(), term_budget);
    if (!square || is_parametric(square) || depends_on_velocities(square)) return;
    add_once(atoms_.functions, generators_.add(without_content(square)));
    for (const int sign : {1, -1})
      add_once(atoms_.functions, generators_.add(pow(without_content(square), Rational(sign, 2))));
  }

  /// A sum divided by the parametric factor of its first term: (1 + y²)/m → 1 + y².
  static Expr without_content(Expr sum) {
    if (!sum.is(Kind::Sum)) return sum;
    Expr content = sum.context().number(1);
    const Expr first = sum[0];
    for (std::size_t i = 0; first.is(Kind::Product) && i < first.size(); ++i)
      if (is_parametric(first[i])) content = content * first[i];
    if (is_parametric(first)) content = first;
    const Expr divided = expand(sum / content, term_budget);
    return divided ? divided : sum;
  }

  /// 1/r of m r² φ'^2, 1/sin θ and cot θ of sin²θ φ'^2: what M⁻¹ brings into displacements.
  void take_inverse_metric() {
    if (system_.coordinates.size() > 4) return;
    const ExprMatrix m = mass_matrix(equations_);
    for (std::size_t i = 0; i < m.rows; ++i) {
      const Expr entry = in_terms_of_motion(system_, {&m.entries[i * m.columns + i], 1}).front();
      const Expr expanded = expand(expand_time_derivatives(entry), term_budget);
      if (!expanded || expanded.is(Kind::Sum) || depends_on_velocities(expanded)) continue;
      for (const Factor& f : generators_.add_factors(expanded)) {
        const Expr base = generators_.values()[f.generator];
        if (!depends_on_coordinates(base)) continue;
        add_once(atoms_.functions, generators_.add(pow(base, Rational(-1))));
        if (base.is(Kind::Sin)) add_once(atoms_.functions, generators_.add(cos(base[0]) / base));
      }
    }
  }

  /// Directions in polar coordinates: sin φ and cos φ though L has no φ.
  void take_angles() {
    if (system_.coordinates.size() > 4) return;
    const auto& symbols = symbols_of({&equations_.lagrangian_expanded, 1});
    for (const Coordinate& c : system_.coordinates) {
      const bool cyclic = std::find(symbols.begin(), symbols.end(), c.q) == symbols.end();
      const bool may_be_angle =
          c.kind == "angle" || (c.kind == "number" && cyclic && system_.dimensionless && !has_constant_mass());
      if (!may_be_angle) continue;
      add_once(atoms_.functions, generators_.add(sin(c.q)));
      add_once(atoms_.functions, generators_.add(cos(c.q)));
    }
  }

  bool has_constant_mass() const {
    const ExprMatrix m = mass_matrix(equations_);
    return std::all_of(m.entries.begin(), m.entries.end(), [](const Expr& e) { return is_parametric(e); });
  }

  /// q̈ + 2δ q̇ + κ q = …, alone: e^{−δt} and sin ωt, cos ωt with ω² = κ − δ², or e^{±kt} with k² = δ² − κ.
  void take_linear_part() {
    if (system_.constrained() || system_.coordinates.size() > 4) return;
    ExprVector rows = in_terms_of_motion(system_, expand_time_derivatives(equations_.residual));
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const Coordinate& own = system_.coordinates[i];
      std::vector<Expr> others;
      for (const Coordinate& c : system_.coordinates)
        if (c.q != own.q) others.insert(others.end(), {c.q, c.velocity, c.acceleration});
      const auto coefficient = [&](Expr symbol) {
        const Expr d = expand(differentiate(rows[i], symbol), term_budget);
        return d ? d : rows[i];
      };
      const Expr m = coefficient(own.acceleration);
      if (m.is_zero() || m.is(Kind::Sum)) continue;
      const auto ratio = [&](Expr symbol) {
        const Expr r = coefficient(symbol) / m, e = expand(r, term_budget);
        return e ? e : r;
      };
      const Expr damping = ratio(own.velocity), stiffness = ratio(own.q);
      bool alone = is_parametric(damping) && is_parametric(stiffness);
      for (const Expr& other : others) alone = alone && coefficient(other).is_zero();
      if (alone && !(stiffness.is_zero() && damping.is_zero())) add_exponentials(damping, stiffness);
    }
  }

  void add_exponentials(Expr damping, Expr stiffness) {
    const Expr t = system_.context->time(), decay = damping / Rational(2);
    const Expr square = stiffness - decay * decay;
    if (!damping.is_zero()) add_once(atoms_.time, generators_.add(apply(Kind::Exp, -(decay * t))));
    const double value = evaluate(square, parameter_bindings(system_));
    const Expr reduced = expand(square, term_budget);
    if (!reduced || reduced.is_zero() || !(std::abs(value) > 0)) return;
    const Expr rate = rate_of(value > 0 ? reduced : -reduced);
    if (value > 0) {
      add_once(atoms_.time, generators_.add(cos(rate * t)));
      add_once(atoms_.time, generators_.add(sin(rate * t)));
    } else {
      add_once(atoms_.time, generators_.add(apply(Kind::Exp, rate * t)));
      add_once(atoms_.time, generators_.add(apply(Kind::Exp, -(rate * t))));
    }
  }

  /// √square, so that rates in a ratio of whole numbers are multiples of one root: 2 √(k/m) beside √(k/m), not √(4
  /// k/m), whose sine would count as a function of its own.
  Expr rate_of(Expr square) {
    const Rational factor = square.is_number()                                  ? square.number()
                            : square.is(Kind::Product) && square[0].is_number() ? square[0].number()
                                                                                : Rational(1);
    if (const auto root = exact_root(abs(factor), 2)) return sqrt(square / abs(factor)) * *root;
    for (const Expr& earlier : rates_) {
      const Expr ratio = expand(square / (earlier * earlier), term_budget);
      if (!ratio || !ratio.is_number() || ratio.number().sign() < 0) continue;
      if (const auto root = exact_root(ratio.number(), 2)) return earlier * *root;
    }
    return rates_.emplace_back(sqrt(square));
  }

  const EquationsOfMotion& equations_;
  const MechanicalSystem& system_;
  Generators& generators_;
  Atoms atoms_;
  std::vector<Expr> rates_;  // roots of linear equations that hold a root of a number
};

}  // namespace

Atoms collect_atoms(const EquationsOfMotion& equations, Generators& generators) {
  return Collector(equations, generators).collect();
}

std::vector<Monomial> independent_functions(const MotionRows& rows, const Generators& generators,
                                            const std::vector<Monomial>& candidates, std::uint64_t seed) {
  MotionSampler sampler(rows, generators.values(), false, seed);
  const PrimeField& field = sampler.field();
  const auto roots = sampler.usable_parameters();
  if (!roots) return candidates;
  FieldMatrix values(candidates.size() + 8, candidates.size() + 1);
  for (std::size_t row = 0; row < values.rows; ++row) {
    const auto sample = sampler.draw(*roots);
    if (!sample) return candidates;
    values.at(row, 0) = field.one();
    for (std::size_t k = 0; k < candidates.size(); ++k) {
      Value v = field.one();
      for (const Factor& f : candidates[k])
        v = field.multiply(v, field.power(sample->values[f.generator], static_cast<std::uint64_t>(f.exponent)));
      values.at(row, k + 1) = v;
    }
  }
  std::vector<Monomial> out;
  for (const std::size_t pivot : echelon(values, field))
    if (pivot > 0) out.push_back(candidates[pivot - 1]);
  return out;
}

}  // namespace maupertuis::invariants
