#include <maupertuis/evaluate.hpp>
#include <maupertuis/symbolic_linearization.hpp>
#include <maupertuis/transform.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

/// From what is known of the coordinates to what follows: plain values, then linear equations, then cos θ beside a
/// factor sin θ.
namespace maupertuis {
namespace {

constexpr std::size_t most_coordinates = 4, most_nodes = 2000;
constexpr double digits = 1e-9;

class Formulas {
 public:
  Formulas(const EquationsOfMotion& equations, const Linearization& numbers,
           const std::vector<Translation>& translations)
      : equations_(equations.shown()),
        system_(*equations_.system),
        context_(*system_.context),
        numbers_(numbers),
        translations_(translations),
        bindings_(parameter_bindings(system_)) {
    for (const Definition& d : system_.definitions)
      if (d.symbol) bindings_[d.symbol] = evaluate(d.value, parameter_bindings(system_));
    for (std::size_t i = 0; i < system_.inputs.size(); ++i)
      bindings_[system_.inputs[i].symbol] = numbers.point.inputs[i];
  }

  std::optional<SymbolicLinearization> find() {
    if (system_.constrained() || system_.coordinates.size() > most_coordinates || !at_rest()) return std::nullopt;
    residual_ = expand_time_derivatives(equations_.balance());
    if (topological_order(residual_).size() > most_nodes) return std::nullopt;
    if (!solved(true) && !solved(false)) return std::nullopt;
    SymbolicLinearization out = matrices();
    if (!agrees(out)) return std::nullopt;
    return out;
  }

 private:
  /// An angle that is a part of π for these values of the parameters need not be one for all: then the equations
  /// decide.
  bool solved(bool parts_of_pi) {
    known_.clear();
    shown_.clear();
    recognise(parts_of_pi);
    solve_linear();
    solve_cosines();
    return all_known() && forces_vanish();
  }

  bool at_rest() const {
    const auto zero = [](double x) { return x == 0; };
    return std::all_of(numbers_.point.v.begin(), numbers_.point.v.end(), zero) &&
           std::all_of(numbers_.point.a.begin(), numbers_.point.a.end(), zero);
  }

  /// u, u' or u'' of all inputs.
  ExprVector inputs(int rate) const {
    ExprVector out;
    for (const Input& u : system_.inputs) out.push_back(u.symbol);
    for (; rate > 0; --rate)
      for (Expr& u : out) u = context_.time_derivative(u);
    return out;
  }

  ExprVector at_rest(const ExprVector& expressions) const {
    ExprMap rest;
    for (const Coordinate& c : system_.coordinates) {
      rest.emplace(c.velocity, context_.number(0));
      rest.emplace(c.acceleration, context_.number(0));
    }
    for (const int rate : {1, 2})  // inputs are held
      for (const Expr& u : inputs(rate)) rest.emplace(u, context_.number(0));
    rest.emplace(context_.time(), context_.number(0));  // t drops out: the equations are autonomous
    for (const Input& u : system_.inputs)
      if (!context_.depends_on_time(u.formula.id())) rest.emplace(u.symbol, u.formula);
    ExprVector out = substitute(substitute(expressions, rest), known_);
    for (Expr& e : out) e = with_known_signs(e);
    return out;
  }

  /// |p| of parameters alone is p or −p: the length of a spring at rest, √(d²) = |d|.
  Expr with_known_signs(Expr e) const {
    ExprMap signs;
    for (const Expr& node : topological_order({&e, 1})) {
      if (!node.is(Kind::Abs)) continue;
      const auto symbols = symbols_of({&node, 1});
      if (!std::all_of(symbols.begin(), symbols.end(), [&](Expr s) { return bindings_.count(s) > 0; })) continue;
      signs.emplace(node, number(node[0]) < 0 ? -node[0] : node[0]);
    }
    return signs.empty() ? e : substitute(e, signs);
  }

  double number(Expr e) const { return evaluate(e, bindings_); }
  bool is_known(std::size_t i) const { return done_[i]; }
  bool all_known() const {
    return std::all_of(done_.begin(), done_.end(), [](bool b) { return b; });
  }

  /// 0, parts of π, and coordinates along translations, of which nothing depends.
  void recognise(bool parts_of_pi) {
    done_.assign(system_.coordinates.size(), false);
    for (std::size_t i = 0; i < done_.size(); ++i) {
      const Coordinate& c = system_.coordinates[i];
      const double value = numbers_.point.q[i], part = 12 * value / std::numbers::pi;
      const bool moved =
          std::any_of(translations_.begin(), translations_.end(), [&](const Translation& t) { return t.pivot == i; });
      if (moved || value == 0)
        put(i, context_.number(0));
      else if (parts_of_pi && c.kind == "angle" && std::abs(part - std::round(part)) < digits)
        put(i, context_.pi() * Rational(static_cast<long>(std::lround(part)), 12));
    }
  }

  void put(std::size_t i, Expr value) {
    known_.emplace(system_.coordinates[i].q, value);
    done_[i] = true;
  }

  /// One coordinate after the other in an equation that is linear in it and free of other unknowns.
  void solve_linear() {
    for (bool again = true; again;) {
      again = false;
      const ExprVector forces = at_rest(residual_);
      for (std::size_t i = 0; i < done_.size() && !again; ++i)
        for (std::size_t row = 0; row < forces.size() && !done_[i]; ++row) again = solve_row(i, forces[row]) || again;
    }
  }

  bool only_unknown(Expr force, std::size_t i) const {
    bool stands = false;
    for (const Expr& s : symbols_of({&force, 1}))
      for (std::size_t j = 0; j < done_.size(); ++j)
        if (s == system_.coordinates[j].q) {
          if (j != i) return false;
          stands = true;
        }
    return stands;
  }

  bool solve_row(std::size_t i, Expr force) {
    if (!only_unknown(force, i)) return false;
    const Expr q = system_.coordinates[i].q, slope = differentiate(force, q);
    if (zero_test(differentiate(slope, q)).verdict != Verdict::Zero || zero_test(slope).verdict != Verdict::Nonzero)
      return false;
    const ExprMap origin{{q, context_.number(0)}};
    const Expr value = -substitute(force, origin) / substitute(slope, origin);
    if (!(std::abs(number(value) - numbers_.point.q[i]) <= digits * std::max(std::abs(numbers_.point.q[i]), 1e-300)))
      return false;
    put(i, value);
    shown_.emplace_back(q, readable(value, equations_.order));
    return true;
  }

  /// force = sin θ (a cos θ + b): cos θ = −b/a, and sin θ has the sign of the number.
  void solve_cosines() {
    for (std::size_t i = 0; i < done_.size(); ++i) {
      if (done_[i] || system_.coordinates[i].kind != "angle") continue;
      for (const Expr& force : at_rest(residual_))
        if (!done_[i] && only_unknown(force, i)) solve_cosine(i, force);
    }
  }

  void solve_cosine(std::size_t i, Expr force) {
    const Expr θ = system_.coordinates[i].q;
    const Expr s = context_.symbol("sine of " + system_.coordinates[i].name, Role::Auxiliary),
               c = context_.symbol("cosine of " + system_.coordinates[i].name, Role::Auxiliary);
    const Expr plain = substitute(force, {{sin(θ), s}, {cos(θ), c}});
    for (const Expr& symbol : symbols_of({&plain, 1}))
      if (symbol == θ) return;  // θ stands elsewhere, as in sin 2θ
    const Expr zero = context_.number(0);
    const Expr factor = differentiate(plain, s), slope = differentiate(factor, c);
    const ExprVector must_vanish{substitute(plain, {{s, zero}}), differentiate(factor, s), differentiate(slope, c)};
    if (zero_test(must_vanish).verdict != Verdict::Zero || zero_test(slope).verdict != Verdict::Nonzero) return;
    const Expr cosine = readable(-substitute(factor, {{c, zero}}) / slope, equations_.order).value;
    const double value = number(cosine), θ0 = numbers_.point.q[i];
    if (!(std::abs(value - std::cos(θ0)) < digits)) return;
    const Expr sine = sqrt(context_.number(1) - pow(cosine, Rational(2)));
    known_.emplace(cos(θ), cosine);
    known_.emplace(sin(θ), std::sin(θ0) < 0 ? -sine : sine);
    shown_.emplace_back(cos(θ), ReadableForm{cosine, {}, {}});
    done_[i] = true;
  }

  bool forces_vanish() const {
    const ExprVector forces = at_rest(residual_);
    const Verdict verdict = zero_test(forces).verdict;
    return verdict == Verdict::Zero || (verdict == Verdict::Undecided && all_small(forces));
  }
  /// Roots of sums are beyond the zero test over primes: then the numbers speak.
  bool all_small(const ExprVector& forces) const {
    for (const Expr& f : forces)
      for (const Expr& s : symbols_of({&f, 1}))
        if (!bindings_.count(s)) return false;
    return std::all_of(forces.begin(), forces.end(), [&](Expr f) { return std::abs(number(f)) <= 1e-12 * size_of(f); });
  }
  double size_of(Expr e) const {
    if (!e.is(Kind::Sum)) return std::abs(number(e));
    double out = 0;
    for (std::size_t k = 0; k < e.size(); ++k) out += std::abs(number(e[k]));
    return out;
  }

  // ---------------------------------------------------------------------------------------------------------- matrices

  SymbolicLinearization matrices() const {
    ExprVector q, v, a;
    for (const Coordinate& c : system_.coordinates)
      q.push_back(c.q), v.push_back(c.velocity), a.push_back(c.acceleration);
    SymbolicLinearization out{shown_,
                              derivative(a, 1),
                              derivative(v, 1),
                              derivative(q, 1),
                              derivative(inputs(0), -1),
                              derivative(inputs(1), -1),
                              derivative(inputs(2), -1),
                              {}};
    if (q.size() == 1 && out.damping.at(0, 0).is_zero())
      out.square = readable(out.stiffness.at(0, 0) / out.mass.at(0, 0), equations_.order).value;
    return out;
  }

  ExprMatrix derivative(const ExprVector& by, int sign) const {
    ExprMatrix out{residual_.size(), by.size(), {}};
    for (const Expr& row : residual_)
      for (const Expr& entry : at_rest(gradient(row, by)))
        out.entries.push_back(readable(sign < 0 ? -entry : entry, equations_.order).value);
    return out;
  }

  bool agrees(const SymbolicLinearization& out) const {
    const auto same = [&](const ExprMatrix& formulas, const RealMatrix& x, const RealMatrix& y) {
      // Where coordinates have no inertia the numbers are those of fewer unknowns.
      if (x.entries.size() != formulas.entries.size() || (y.rows && y.entries.size() != x.entries.size())) return false;
      double size = 0, error = 0;
      for (std::size_t k = 0; k < formulas.entries.size(); ++k) {
        const double exact = x.entries[k] + (y.rows ? y.entries[k] : 0.0), value = number(formulas.entries[k]);
        size = std::max(size, std::abs(exact));
        error = std::max(error, std::isfinite(value) ? std::abs(value - exact) : HUGE_VAL);
      }
      return error <= digits * size || error == 0;
    };
    for (const ExprMatrix* m :
         {&out.mass, &out.damping, &out.stiffness, &out.input, &out.input_rate, &out.input_acceleration})
      for (const Expr& e : m->entries)
        for (const Expr& s : symbols_of({&e, 1}))
          if (!bindings_.count(s)) return false;
    return same(out.mass, numbers_.mass, {}) && same(out.damping, numbers_.damping, numbers_.gyroscopic) &&
           same(out.stiffness, numbers_.stiffness, numbers_.circulatory) && same(out.input, numbers_.input, {}) &&
           same(out.input_rate, numbers_.input_rate, {}) &&
           same(out.input_acceleration, numbers_.input_acceleration, {});
  }

  const EquationsOfMotion& equations_;
  const MechanicalSystem& system_;
  Context& context_;
  const Linearization& numbers_;
  const std::vector<Translation>& translations_;
  Bindings bindings_;
  ExprVector residual_;
  ExprMap known_;
  std::vector<bool> done_;
  std::vector<std::pair<Expr, ReadableForm>> shown_;
};

}  // namespace

std::optional<SymbolicLinearization> symbolic_linearization(const EquationsOfMotion& equations,
                                                            const Linearization& numbers,
                                                            const std::vector<Translation>& translations) {
  if (!numbers.second_order()) return std::nullopt;
  return Formulas(equations, numbers, translations).find();
}

}  // namespace maupertuis
