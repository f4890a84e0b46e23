#include "verification/degenerate_claims.hpp"

#include "verification/judge.hpp"

#include <maupertuis/dirac.hpp>
#include <maupertuis/print.hpp>

#include <fmt/format.h>

namespace maupertuis {
namespace {

/// The phase space of a singular Legendre transform; `analysis` empty, and the result said, where there is none.
struct PhaseSpaceOf {
  Hamiltonian h;
  Bindings center;
  std::optional<DiracAnalysis> analysis;

  PhaseSpaceOf(const Model& model, const EquationsOfMotion& equations, ExpectationResult& result)
      : h(hamiltonian(equations)), center(generic_state(model)) {
    analysis = dirac_analysis(h, equations, center, start_on_constraints(model, equations));
    if (analysis && analysis->outcome != ConstraintChain::Outcome::Closed) analysis.reset();
    if (analysis) return;
    result.actual = "no constraints of phase space";
    result.message =
        "They belong to a singular Legendre transform without forces, dissipation and velocity constraints.";
  }
};

std::string lines_of(const DiracAnalysis& analysis, const ReadingOrder& order) {
  std::string out;
  int generation = 0;
  for (const PhaseConstraint& c : analysis.constraints) {
    if (!out.empty()) out += c.generation > generation ? " ; " : ", ";
    generation = c.generation;
    out += to_plain(c.value, order);
  }
  return out;
}

std::optional<std::size_t> count_of(const expectation::ClassCount& e, const Model& model,
                                    const EquationsOfMotion& equations, ExpectationResult& result) {
  using What = expectation::ClassCount::What;
  if (e.what == What::Motions || e.what == What::FreeFunctions) {
    const std::size_t regular = 2 * model.system.coordinates.size();
    if (!equations.degenerate && !model.system.constrained()) return e.what == What::Motions ? regular : 0;
    const DegenerateAnalysis found =
        equations.degenerate ? *equations.degenerate : analyse_degenerate(equations, generic_state(model), true);
    if (!found.closed()) return std::nullopt;
    return e.what == What::Motions ? found.motions : found.free.size();
  }
  const PhaseSpaceOf space(model, equations, result);
  if (!space.analysis) return std::nullopt;
  if (e.what == What::FirstClass) return space.analysis->first_class;
  if (e.what == What::SecondClass) return space.analysis->second_class;
  if (space.analysis->physical_dimension % 2 == 0) return space.analysis->physical_dimension / 2;
  result.actual = fmt::format("{}/2", space.analysis->physical_dimension);
  return std::nullopt;
}

}  // namespace

void decide_degenerate(const expectation::ClassCount& e, const Model& model, const EquationsOfMotion& equations,
                       ExpectationResult& result) {
  const double expected = number_of(model.system, e.number);
  result.expected = fmt::format("{:g}", expected);
  const std::optional<std::size_t> found = count_of(e, model, equations, result);
  if (!found) {
    if (result.actual.empty()) result.actual = "not known";
    return;
  }
  result.actual = std::to_string(*found);
  result.passed = expected == static_cast<double>(*found);
}

void decide_degenerate(const expectation::PhaseConstraints& e, const Model& model, const EquationsOfMotion& equations,
                       ExpectationResult& result) {
  result.expected = "these constraints, up to invertible combinations";
  const PhaseSpaceOf space(model, equations, result);
  if (!space.analysis) return;
  std::vector<std::vector<Expr>> generations = e.generations;
  for (std::vector<Expr>& generation : generations)
    for (Expr& function : generation) function = in_phase_space(function, space.h);
  for (const std::vector<Expr>& generation : generations)
    for (const Expr& function : generation)
      if (!function) {
        result.message = "A velocity stands in them that does not follow from the momenta.";
        return;
      }
  result.passed = same_constraints(generations, *space.analysis, space.h, space.center);
  result.actual = result.passed ? result.expected : lines_of(*space.analysis, space.h.order);
  if (result.passed) result.message = "They vanish together at random points, to 60 digits.";
}

void decide_degenerate(const expectation::Bracket& e, const Model& model, const EquationsOfMotion& equations,
                       ExpectationResult& result) {
  result.expected = "dirac bracket as written";
  const PhaseSpaceOf space(model, equations, result);
  if (!space.analysis) return;
  const auto found = dirac_bracket(e.a, e.b, space.h, *space.analysis);
  const Expr right = found ? in_phase_space(e.value, space.h) : Expr();
  if (!right) {
    result.actual = "not defined";
    result.message = "A velocity stands in it that does not follow from the momenta, or an acceleration.";
    return;
  }
  const Expr difference = with_definitions(*space.h.system, std::vector<Expr>{found->value - right}).front();
  // Equal on the constraints is enough: that is where the bracket means something.
  ExprVector relations, states = space.h.momenta;
  for (const PhaseConstraint& c : space.analysis->constraints) relations.push_back(c.value);
  for (const Coordinate& c : space.h.system->coordinates) states.push_back(c.q);
  Bindings near = space.center;
  for (const Expr& p : space.h.momenta) near[p] = 0.7;
  result.passed = zero_test_where({&difference, 1}, relations, states, near).verdict == Verdict::Zero;
  result.actual = result.passed ? result.expected : to_plain(*found, space.h.order);
}

}  // namespace maupertuis
