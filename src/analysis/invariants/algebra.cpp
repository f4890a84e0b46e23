#include "analysis/invariants/algebra.hpp"

#include "analysis/invariants/linear_fit.hpp"
#include "analysis/invariants/search.hpp"
#include "analysis/invariants/symmetry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace maupertuis::invariants {

std::vector<bool> independent_functions_of_state(const MotionRows& rows, const EquationsOfMotion& equations,
                                                 const std::vector<Expr>& functions, std::uint64_t seed) {
  const MechanicalSystem& system = *rows.system;
  ExprVector state;
  for (const Coordinate& c : system.coordinates) state.push_back(c.q);
  for (const Coordinate& c : system.coordinates) state.push_back(c.velocity);
  // What is constant on every leaf counts first: positions, and velocities where they are constrained.
  std::vector<Expr> all;
  for (const Constraint& c : system.constraints)
    if (c.level == Constraint::Level::Position) all.push_back(c.value);
  all.insert(all.end(), equations.constraint_rates.begin(), equations.constraint_rates.end());
  const std::size_t given = rows.conservative ? 0 : all.size();
  if (rows.conservative) all.clear();
  all.insert(all.end(), functions.begin(), functions.end());
  all = in_state_variables(system, all);
  std::vector<Expr> entries;
  for (const Expr& f : all) {
    const auto slopes = gradient(f, state);
    entries.insert(entries.end(), slopes.begin(), slopes.end());
  }
  MotionSampler sampler(rows, entries, false, seed);
  const auto roots = sampler.usable_parameters();
  const auto sample = roots ? sampler.draw(*roots) : std::nullopt;
  std::vector<bool> out(functions.size(), true);
  if (!sample) return out;
  FieldMatrix columns(state.size(), all.size());  // a function a column: its pivot says that it is new
  for (std::size_t f = 0; f < all.size(); ++f)
    for (std::size_t i = 0; i < state.size(); ++i) columns.at(i, f) = sample->values[f * state.size() + i];
  const auto pivots = echelon(columns, sampler.field());
  for (std::size_t f = 0; f < functions.size(); ++f)
    out[f] = std::binary_search(pivots.begin(), pivots.end(), given + f);
  return out;
}

PoissonAlgebra::PoissonAlgebra(const MotionRows& rows, const EquationsOfMotion& equations) : rows_(rows) {
  const MechanicalSystem& system = *rows.system;
  for (const Coordinate& c : system.coordinates) q_.push_back(c.q);
  momentum_by_position_ = {q_.size(), q_.size(), {}};
  for (const Expr& p : in_state_variables(system, equations.momenta))
    for (const Expr& slope : gradient(p, q_)) momentum_by_position_.entries.push_back(slope);
}

/// With p = p(q, q̇): ∂F/∂p = M⁻¹ ∂F/∂q̇, and ∂F/∂q at fixed p is ∂F/∂q − (∂p/∂q)ᵀ ∂F/∂p.
PoissonAlgebra::Slopes PoissonAlgebra::slopes(Expr f) const {
  Slopes out{gradient(f, q_), symmetry_of(f, rows_).value_or(ExprVector(q_.size(), f.context().number(0)))};
  for (std::size_t i = 0; i < q_.size(); ++i)
    for (std::size_t j = 0; j < q_.size(); ++j)
      out.by_position[i] = out.by_position[i] - momentum_by_position_.at(j, i) * out.by_momentum[j];
  return out;
}

Expr PoissonAlgebra::bracket(Expr f, Expr g) const {
  const Slopes a = slopes(f), b = slopes(g);
  Expr sum = f.context().number(0);
  for (std::size_t i = 0; i < q_.size(); ++i)
    sum = sum + a.by_position[i] * b.by_momentum[i] - a.by_momentum[i] * b.by_position[i];
  return sum;
}

namespace {

constexpr std::size_t most_integrals = 14;  // beyond it neither brackets nor relations are computed

/// Products of the integrals up to a degree, as monomials of their values.
std::vector<Monomial> products_up_to(Generators& g, const std::vector<Expr>& values, int degree) {
  std::vector<Monomial> generators, out, last{Monomial{}};
  for (const Expr& v : values) generators.push_back(g.add(v));
  for (int d = 1; d <= degree; ++d) {
    std::vector<Monomial> next;
    for (const Monomial& m : last)
      for (const Monomial& x : generators)
        if (m.empty() || m.back().generator <= x[0].generator) next.push_back(product(m, x));
    out.insert(out.end(), next.begin(), next.end());
    last = std::move(next);
  }
  return out;
}

class AlgebraWriter {
 public:
  AlgebraWriter(Invariants& result, const MotionRows& rows, const EquationsOfMotion& equations, std::uint64_t seed)
      : result_(result),
        rows_(rows),
        equations_(equations),
        seed_(seed),
        context_(*rows.system->context),
        poisson_(rows, equations) {
    for (const ConservedFunction& i : result_.integrals) values_.push_back(i.value);
  }

  void carry_out() {
    const bool hamiltonian = !rows_.system->constrained() && result_.integrals.front().kind != IntegralKind::Direct;
    if (hamiltonian && values_.size() <= most_integrals) {
      find_brackets();
      show_what_brackets_lead_to();
    }
    if (values_.size() <= most_integrals) find_relations();
    if (hamiltonian) find_involution();
  }

 private:
  /// A polynomial of the integrals in their symbols: generator k of `g` is value k.
  Expr in_symbols(const std::vector<Combination::Term>& terms) const {
    std::vector<Expr> sum;
    for (const Combination::Term& term : terms) {
      std::vector<Expr> factors{term.coefficient};
      for (const Factor& f : term.monomial) factors.push_back(pow(result_.symbols[f.generator], Rational(f.exponent)));
      sum.push_back(context_.product(factors));
    }
    return context_.sum(sum);
  }

  /// Between those that are shown first: what a reader looks for is not told through the others.
  void find_relations() {
    find_relations_of(result_.shown);
    if (result_.shown < values_.size()) find_relations_of(values_.size());
  }

  void find_relations_of(std::size_t count) {
    const auto end = result_.integrals.begin() + static_cast<std::ptrdiff_t>(count);
    if (std::all_of(result_.integrals.begin(), end, [](const ConservedFunction& i) { return i.independent; })) return;
    const std::vector<Expr> values(values_.begin(), values_.begin() + static_cast<std::ptrdiff_t>(count));
    Generators g(context_);
    for (const int degree : {2, 3}) {
      Basis basis;
      basis.monomials = products_up_to(g, values, degree);
      basis.monomials.insert(basis.monomials.begin(), Monomial{});
      if (basis.monomials.size() > 400) return;
      const SearchResult found = vanishing_combinations(rows_, g, basis, seed_);
      for (const Combination& c : found.found) {
        if (result_.relations.size() + result_.rank >= count) return;
        take_relation(c);
      }
      if (found.too_long > 0) return;
    }
  }

  /// Keeps a relation that does not follow from those before it: by the rank of their gradients by the integrals.
  void take_relation(const Combination& c) {
    const Expr relation = in_symbols(c.terms);
    ExprMap values;
    for (std::size_t i = 0; i < values_.size(); ++i) values.emplace(result_.symbols[i], values_[i]);
    std::vector<std::vector<Expr>> rows = relation_gradients_;
    rows.push_back(substitute(gradient(relation, result_.symbols), values));
    LinearFitRows fit;  // the new gradient as a combination of the others
    fit.unknowns = relation_gradients_.size();
    for (std::size_t i = 0; i < values_.size(); ++i) {
      std::vector<Expr> row;
      for (const auto& g : rows) row.push_back(g[i]);
      fit.rows.push_back(std::move(row));
    }
    if (depends_at_a_point(rows_, fit, seed_) || zero_test(c.value).verdict != Verdict::Zero) return;
    relation_gradients_ = std::move(rows);
    result_.relations.push_back({{relation, {}, {}}});
  }

  void find_brackets() {
    const std::size_t count = values_.size();
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t j = i + 1; j < count; ++j) {
        const Expr value = poisson_.bracket(values_[i], values_[j]);
        if (zero_test(value).verdict == Verdict::Zero) continue;
        result_.brackets.push_back({i, j, closed(value)});
      }
  }

  // ------------------------------------------------------------------------------------------ what the algebra asks
  // for

  bool holds(Expr value, std::size_t integral) const {
    const auto nodes = topological_order({&value, 1});
    return std::find(nodes.begin(), nodes.end(), result_.symbols[integral]) != nodes.end();
  }

  /// Integrals that stand in a bracket of two shown ones are shown too: I5 of {I1, I3} = I5. They change places with
  /// those that stay behind, and numbers follow the places.
  void show_what_brackets_lead_to() {
    std::vector<bool> is_shown(values_.size(), false);
    std::fill(is_shown.begin(), is_shown.begin() + static_cast<std::ptrdiff_t>(result_.shown), true);
    for (bool more = true; more;) {
      more = false;
      for (const PoissonBracket& b : result_.brackets)
        for (std::size_t i = 0; b.value.value && is_shown[b.first] && is_shown[b.second] && i < values_.size(); ++i)
          if (!is_shown[i] && holds(b.value.value, i)) is_shown[i] = more = true;
    }
    std::vector<std::size_t> order(values_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto end = std::stable_partition(order.begin(), order.end(), [&](std::size_t i) { return is_shown[i]; });
    result_.shown = static_cast<std::size_t>(end - order.begin());
    move_to(order);
  }

  /// `order`: [integrals] which one stands at each place from now on. Those that are shown keep their order, so that
  /// only brackets with hidden ones can change the side on which an integral stands.
  void move_to(const std::vector<std::size_t>& order) {
    std::vector<ConservedFunction> moved;
    std::vector<std::size_t> place(order.size());
    ExprMap renamed;
    for (std::size_t k = 0; k < order.size(); ++k) {
      moved.push_back(result_.integrals[order[k]]);
      place[order[k]] = k;
      renamed.emplace(result_.symbols[order[k]], result_.symbols[k]);
    }
    result_.integrals = std::move(moved);
    for (PoissonBracket& b : result_.brackets) {
      b.first = place[b.first], b.second = place[b.second];
      if (b.value.value) b.value.value = substitute(b.value.value, renamed);
      if (b.first < b.second) continue;
      std::swap(b.first, b.second);
      if (b.value.value) b.value.value = -b.value.value;
    }
    std::stable_sort(result_.brackets.begin(), result_.brackets.end(),
                     [](const PoissonBracket& a, const PoissonBracket& b) {
                       return std::pair(a.first, a.second) < std::pair(b.first, b.second);
                     });
    for (std::size_t k = 0; k < order.size(); ++k) values_[k] = result_.integrals[k].value;
  }

  /// A bracket as a combination of 1, the integrals and their products in pairs.
  ReadableForm closed(Expr bracket) const {
    Generators g(context_);
    for (const int degree : {1, 2}) {
      LinearFitRows fit;
      std::vector<Monomial> monomials = products_up_to(g, values_, degree);
      monomials.insert(monomials.begin(), Monomial{});
      std::vector<Expr> row;
      for (const Monomial& m : monomials) row.push_back(g.expression(m));
      fit.unknowns = row.size();
      row.push_back(bracket);
      fit.rows.push_back(std::move(row));
      const auto constants = fit_constants(rows_, fit, seed_);
      if (!constants) continue;
      std::vector<Combination::Term> terms;
      for (std::size_t k = 0; k < monomials.size(); ++k)
        if ((*constants)[k]) terms.push_back({(*constants)[k], monomials[k]});
      return {in_symbols(terms), {}, {}};
    }
    return {};
  }

  // -------------------------------------------------------------------------------------------- complete integrability

  /// n independent functions in involution without explicit time: of the integrals and the squares of triples that
  /// rotate into each other (L² = Lx² + Ly² + Lz²).
  void find_involution() {
    const std::size_t n = rows_.system->coordinates.size();
    std::vector<Expr> functions;
    std::vector<std::string> words;
    for (std::size_t i = 0; i < values_.size(); ++i) {
      if (result_.integrals[i].explicit_time) continue;
      functions.push_back(values_[i]);
      words.push_back(result_.symbols[i].name());
    }
    add_casimirs(functions, words);
    if (functions.size() > 20) return;
    std::vector<std::vector<bool>> commute(functions.size(), std::vector<bool>(functions.size(), true));
    for (std::size_t i = 0; i < functions.size(); ++i)
      for (std::size_t j = i + 1; j < functions.size(); ++j)
        commute[i][j] = commute[j][i] =
            zero_test(poisson_.bracket(functions[i], functions[j])).verdict == Verdict::Zero;
    std::vector<std::size_t> chosen;
    if (!extend(functions, commute, chosen, 0, n)) return;
    result_.completely_integrable = true;
    for (const std::size_t i : chosen) result_.involution.push_back(words[i]);
  }

  void add_casimirs(std::vector<Expr>& functions, std::vector<std::string>& words) const {
    std::vector<std::size_t> rotations;
    for (std::size_t i = 0; i < result_.integrals.size(); ++i)
      if (result_.integrals[i].name.find("angular momentum about") != std::string::npos &&
          !result_.integrals[i].explicit_time)
        rotations.push_back(i);
    if (rotations.size() != 3) return;
    Expr square = context_.number(0);
    std::string word;
    for (const std::size_t i : rotations) {
      square = square + values_[i] * values_[i];
      word += (word.empty() ? "" : " + ") + result_.symbols[i].name() + "²";
    }
    functions.push_back(square);
    words.push_back(word);
  }

  bool extend(const std::vector<Expr>& functions, const std::vector<std::vector<bool>>& commute,
              std::vector<std::size_t>& chosen, std::size_t from, std::size_t wanted) const {
    if (chosen.size() == wanted) return true;
    for (std::size_t i = from; i < functions.size(); ++i) {
      if (!std::all_of(chosen.begin(), chosen.end(), [&](std::size_t k) { return commute[i][k]; })) continue;
      chosen.push_back(i);
      std::vector<Expr> set;
      for (const std::size_t k : chosen) set.push_back(functions[k]);
      if (independent_functions_of_state(rows_, equations_, set, seed_).back() &&
          extend(functions, commute, chosen, i + 1, wanted))
        return true;
      chosen.pop_back();
    }
    return false;
  }

  Invariants& result_;
  const MotionRows& rows_;
  const EquationsOfMotion& equations_;
  std::uint64_t seed_;
  Context& context_;
  PoissonAlgebra poisson_;
  std::vector<std::vector<Expr>> relation_gradients_;  // [relations][integrals]
  std::vector<Expr> values_;
};

}  // namespace

void add_algebra(Invariants& result, const MotionRows& rows, const EquationsOfMotion& equations, std::uint64_t seed) {
  if (!result.integrals.empty()) AlgebraWriter(result, rows, equations, seed).carry_out();
}

}  // namespace maupertuis::invariants
