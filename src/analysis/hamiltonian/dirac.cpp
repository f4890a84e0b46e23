#include "analysis/hamiltonian/dirac_problem.hpp"
#include "analysis/hamiltonian/readable_choice.hpp"

#include <maupertuis/dirac.hpp>
#include <maupertuis/linear_system.hpp>
#include <maupertuis/transform.hpp>

#include <algorithm>

namespace maupertuis {

using namespace phase_space;

namespace phase_space {

namespace {

/// Forces, dissipation and constraints on velocities have no place in H.
bool has_only_h(const EquationsOfMotion& equations) {
  const auto vanish = [](const ExprVector& list) {
    return std::all_of(list.begin(), list.end(), [](Expr e) { return expand_time_derivatives(e).is_zero(); });
  };
  const auto& constraints = equations.system->constraints;
  return vanish(equations.generalized_forces) && vanish(equations.dissipative_terms) &&
         std::all_of(constraints.begin(), constraints.end(),
                     [](const Constraint& c) { return c.level == Constraint::Level::Position; });
}

}  // namespace

PhaseSpaceAlgebra::PhaseSpaceAlgebra(const Hamiltonian& h, const EquationsOfMotion& equations)
    : momenta(h.momenta), order(h.order) {
  for (const Coordinate& c : h.system->coordinates) positions.push_back(c.q);
  states = positions;
  states.insert(states.end(), momenta.begin(), momenta.end());
  if (!h.value || !has_only_h(equations)) return;
  const MotionTerms in_motion(*equations.system);
  energy = in_motion(with_definitions(*h.system, {&h.value, 1}).front());
  for (const LegendreBlock& block : h.legendre.blocks)
    for (const Expr& c : with_definitions(*h.system, block.primary_constraints)) primary.push_back(in_motion(c));
  for (const Constraint& c : equations.system->constraints) of_model.push_back(in_motion(c.value));
}

Expr PhaseSpaceAlgebra::bracket(Expr a, Expr b) const { return bracket_of(a, b, positions, momenta); }

/// dφ/dt = {φ, H} + ∂φ/∂t + Σ u_b {φ, φ_b} − Σ λ_k {φ, φ_k}, the signs of the unknowns being free.
LinearCondition PhaseSpaceAlgebra::rate(Expr constraint) const {
  LinearCondition row;
  row.rest = bracket(constraint, energy) + differentiate(constraint, constraint.context().time());
  for (const ExprVector* list : {&primary, &of_model})
    for (const Expr& generator : *list) row.coefficients.push_back(bracket(constraint, generator));
  row.is_derivative = true;
  return row;
}

ConstraintProblem PhaseSpaceAlgebra::problem(const Bindings& center, const Bindings& start,
                                             const ExprVector& momentum_values) const {
  ConstraintProblem out;
  out.states = states;
  out.order = order;
  const auto with_momenta = [&](Bindings state) {
    const std::vector<double> p = evaluate(momentum_values, state);
    for (std::size_t i = 0; i < momenta.size(); ++i) state[momenta[i]] = p[i];
    return state;
  };
  out.center = with_momenta(center);
  out.start = with_momenta(start);
  for (const ExprVector* list : {&primary, &of_model})
    for (const Expr& c : *list) {
      out.relations.push_back(c);
      out.conditions.push_back(rate(c));
    }
  out.derivative = [this](Expr constraint) { return rate(constraint); };
  return out;
}

}  // namespace phase_space

namespace {

/// Classes: the rank of the brackets of all constraints with each other.
class Classes {
 public:
  ExprVector primaries_of_first_class;  // where chains of generators begin

  Classes(const PhaseSpaceAlgebra& algebra, DiracAnalysis& out, const PointsWhere& where)
      : algebra_(algebra), out_(out), where_(where) {}

  void find() {
    const std::size_t count = out_.constraints.size();
    std::vector<LinearCondition> rows(count);
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t j = 0; j < count; ++j) rows[i].coefficients.push_back(between(i, j));
    rows = with_zeros_of(where_, std::move(rows));
    out_.second_class_set = count == 0 ? std::vector<std::size_t>{} : independent_conditions(rows, where_.points());
    out_.second_class = out_.second_class_set.size();
    out_.first_class = count - out_.second_class;
    // Combinations of primary constraints alone that are of the first class leave their multipliers free.
    std::size_t primaries = 0;
    while (primaries < count && out_.constraints[primaries].generation == 0) ++primaries;
    const std::vector<LinearCondition> of_primary(rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(primaries));
    out_.primary_first_class =
        primaries == 0 ? 0 : primaries - independent_conditions(of_primary, where_.points()).size();
    const std::vector<std::size_t>& set = out_.second_class_set;
    out_.brackets = {set.size(), set.size(), {}};
    for (const std::size_t i : set)
      for (const std::size_t j : set) out_.brackets.entries.push_back(rows[i].coefficients[j]);
    for (std::size_t i = 0; i < count; ++i)
      if (std::find(set.begin(), set.end(), i) == set.end()) of_first_class(i);
  }

 private:
  Expr between(std::size_t i, std::size_t j) const {
    return algebra_.bracket(out_.constraints[i].value, out_.constraints[j].value);
  }

  /// χ_i − {χ_i, χ_a} C⁻¹_ab χ_b over the second-class set.
  void of_first_class(std::size_t i) {
    const Expr own = out_.constraints[i].value;
    ExprVector terms{own};
    bool primary = out_.constraints[i].generation == 0;
    if (!out_.second_class_set.empty()) {
      ExprVector right;
      for (const std::size_t b : out_.second_class_set) right.push_back(-between(i, b));
      // C is antisymmetric: {χ_i, χ_a} C⁻¹_ab = y_b with C y = −{χ_i, χ}.
      const auto weights = solve_linear(augmented(out_.brackets, right));
      for (std::size_t b = 0; weights && b < weights->size(); ++b) {
        const PhaseConstraint& other = out_.constraints[out_.second_class_set[b]];
        terms.push_back(-((*weights)[b] * other.value));
        primary = primary && (other.generation == 0 || may_vanish((*weights)[b]));
      }
    }
    const Expr combination = tidy(own.context().sum(terms), algebra_.order);
    out_.first_class_functions.push_back(
        split_coefficient(combination).coefficient.sign() < 0 ? tidy(-combination, algebra_.order) : combination);
    if (primary) primaries_of_first_class.push_back(combination);
  }

  const PhaseSpaceAlgebra& algebra_;
  DiracAnalysis& out_;
  const PointsWhere& where_;
};

/// Castellani's chains: G_K a primary constraint of the first class, G_{k−1} = −{G_k, H}, until that vanishes.
class Generators {
 public:
  Generators(const PhaseSpaceAlgebra& algebra, const Hamiltonian& h, const EquationsOfMotion& equations)
      : algebra_(algebra), h_(h), equations_(equations) {}

  std::optional<GaugeGenerator> from(Expr primary, std::size_t longest) const {
    ExprVector chain{primary};
    for (std::size_t k = 0; k <= longest; ++k) {
      const Expr next = -algebra_.bracket(chain.back(), algebra_.energy);
      if (vanishes_identically(next)) return proved(chain);
      chain.push_back(tidy(next, algebra_.order));
      if (const auto found = proved(chain)) return found;
    }
    return std::nullopt;
  }

 private:
  /// `chain` from the highest derivative of ε down.
  std::optional<GaugeGenerator> proved(const ExprVector& chain) const {
    GaugeGenerator out;
    out.parts.assign(chain.rbegin(), chain.rend());
    for (const Expr& p : algebra_.momenta) {
      out.changes.emplace_back();
      for (const Expr& part : out.parts) out.changes.back().push_back(tidy(differentiate(part, p), algebra_.order));
    }
    return obeys_noether(out) ? std::optional(out) : std::nullopt;
  }

  /// Σ_i Σ_k (−1)^k dᵏ/dtᵏ (changes_ik R_i) = 0 identically, with p = ∂L/∂q̇ in them: δL is a total derivative, so that
  /// solutions go over into solutions. Independent of everything that was done in phase space.
  bool obeys_noether(const GaugeGenerator& g) const {
    ExprMap values;
    const MotionTerms in_motion(*equations_.system);
    for (std::size_t i = 0; i < algebra_.momenta.size(); ++i)
      values.emplace(algebra_.momenta[i], in_motion(equations_.momenta[i]));
    const ExprVector rows = expand_time_derivatives(in_motion(equations_.residual));
    ExprVector terms;
    bool moves = false;
    for (std::size_t i = 0; i < rows.size(); ++i)
      for (std::size_t k = 0; k < g.parts.size(); ++k) {
        const Expr change = substitute(g.changes[i][k], values);
        moves |= !change.is_zero();
        Expr term = change * rows[i];
        for (std::size_t j = 0; j < k; ++j) term = -total_time_derivative(term);
        terms.push_back(term);
      }
    return moves && zero_test(h_.value.context().sum(terms)).verdict == Verdict::Zero;
  }

  const PhaseSpaceAlgebra& algebra_;
  const Hamiltonian& h_;
  const EquationsOfMotion& equations_;
};

}  // namespace

std::optional<DiracAnalysis> dirac_analysis(const Hamiltonian& h, const EquationsOfMotion& equations,
                                            const Bindings& center, const Bindings& start) {
  const PhaseSpaceAlgebra algebra(h, equations);
  if (!algebra.energy || algebra.primary.empty()) return std::nullopt;
  const ExprVector momenta = MotionTerms(*equations.system)(equations.momenta);
  const ConstraintProblem problem = algebra.problem(center, start, momenta);
  const ConstraintChain chain = constraint_algorithm(problem);
  DiracAnalysis out;
  out.outcome = chain.outcome;
  out.branches = chain.branches;
  for (const Expr& c : algebra.primary) out.constraints.push_back({c, 0});
  for (const Expr& c : algebra.of_model) out.constraints.push_back({c, 1});
  for (const FoundConstraint& c : chain.constraints) out.constraints.push_back({c.value, c.generation});
  if (out.outcome != ConstraintChain::Outcome::Closed) return out;
  Classes classes(algebra, out, *chain.where);
  classes.find();
  out.physical_dimension = 2 * algebra.positions.size() - 2 * out.first_class - out.second_class;
  const Generators generators(algebra, h, equations);
  if (!equations.system->constrained())
    for (const Expr& primary : classes.primaries_of_first_class)
      if (auto g = generators.from(primary, out.constraints.size())) out.generators.push_back(std::move(*g));
  return out;
}

std::optional<ReadableForm> dirac_bracket(Expr a, Expr b, const Hamiltonian& h, const DiracAnalysis& analysis) {
  const Expr both[] = {in_phase_space(a, h), in_phase_space(b, h)};
  if (!both[0] || !both[1]) return std::nullopt;
  PhaseSpaceAlgebra algebra(h);
  ExprVector left, right;
  for (const std::size_t k : analysis.second_class_set) {
    left.push_back(algebra.bracket(both[0], analysis.constraints[k].value));
    right.push_back(algebra.bracket(analysis.constraints[k].value, both[1]));
  }
  ExprVector terms{algebra.bracket(both[0], both[1])};
  if (!left.empty()) {
    const auto weights = solve_linear(augmented(analysis.brackets, right));
    if (!weights) return std::nullopt;
    for (std::size_t k = 0; k < left.size(); ++k) terms.push_back(-(left[k] * (*weights)[k]));
  }
  return shown_bracket(h.system->context->sum(terms), h.order);
}

bool same_constraints(const std::vector<std::vector<Expr>>& generations, const DiracAnalysis& analysis,
                      const Hamiltonian& h, const Bindings& center) {
  const PhaseSpaceAlgebra algebra(h);
  Bindings near = center;
  for (const Expr& p : algebra.momenta)
    if (near.find(p) == near.end()) near[p] = 0.7;
  ExprVector given, found;
  for (std::size_t g = 0; g < generations.size(); ++g) {
    for (const Expr& e : generations[g]) given.push_back(with_definitions(*h.system, {&e, 1}).front());
    for (const PhaseConstraint& c : analysis.constraints)
      if (c.generation == static_cast<int>(g)) found.push_back(c.value);
    if (given.size() != found.size()) return false;
    ZeroTestOptions options;
    options.hold_parameters = true;
    if (zero_test_where(given, found, algebra.states, near, options).verdict != Verdict::Zero ||
        zero_test_where(found, given, algebra.states, near, options).verdict != Verdict::Zero)
      return false;
  }
  return found.size() == analysis.constraints.size();
}

}  // namespace maupertuis
