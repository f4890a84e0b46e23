#include "verification/phase_space_claims.hpp"

#include <maupertuis/along_motion.hpp>
#include <maupertuis/integral_symbol.hpp>
#include <maupertuis/print.hpp>

#include <fmt/format.h>

namespace maupertuis {
namespace {

std::vector<std::size_t> coordinates_of(const Expectation& e, const MechanicalSystem& system) {
  std::vector<std::size_t> found;
  for (const Expr& q : e.values)
    for (std::size_t i = 0; i < system.coordinates.size(); ++i)
      if (system.coordinates[i].q == q) found.push_back(i);
  return found;
}

bool has_velocity(Expr e) {
  for (const Expr& s : symbols_of({&e, 1}))
    if (s.role() == Role::Coordinate && s.order() == 1 && !is_integral(s.name())) return true;
  return false;
}

/// H as it is printed where the velocities do not follow from the momenta, or were not written out: with velocities in it, or with momenta that obey
/// primary constraints. Where p = ∂L/∂q' it is the energy function.
Expr difference_from_energy(Expr right, const EquationsOfMotion& equations) { return with_momenta(right, equations) - equations.energy_function; }

/// What the system has in the place of the left side; an empty handle, and the reason, where it has none.
Expr left_side(const Expectation& e, const EquationsOfMotion& equations, const Hamiltonian& h, std::string& reason) {
  if (e.word == "hamiltonian") {
    reason = "it was not written out";
    return h.value ? h.value : equations.energy_function;
  }
  if (e.word == "bracket") {
    const auto found = poisson_bracket(e.subject, e.values.front(), h);
    reason = "a velocity stands in it that does not follow from the momenta, or an acceleration";
    return found ? found->value : Expr();
  }
  const std::vector<std::size_t> replaced = coordinates_of(e, *equations.system);
  const auto found = routhian(equations, h, &replaced);
  reason = "the momenta of these coordinates do not determine their velocities";
  return found ? found->value : Expr();
}

}  // namespace

void decide_phase_space(const Expectation& e, const EquationsOfMotion& equations, ExpectationResult& result) {
  const Hamiltonian h = hamiltonian(equations);
  std::string reason;
  const Expr left = left_side(e, equations, h, reason);
  result.expected = fmt::format("{} as written", e.word);
  if (!left) {
    result.actual = "not defined";
    result.message = "There is no such function: " + reason + ".";
    return;
  }
  const Expr right = e.word == "bracket" ? in_phase_space(e.subject_right, h) : e.subject_right;
  const bool by_energy = e.word == "hamiltonian" && (!h.regular() || has_velocity(right));
  const Expr difference[] = {by_energy ? difference_from_energy(right, equations) : left - right};
  const ZeroTest test = zero_test(with_definitions(*h.system, difference).front());
  result.passed = test.verdict == Verdict::Zero;
  result.actual = result.passed ? result.expected : test.verdict == Verdict::Nonzero ? "another function" : "undecided";
  if (result.passed) {
    result.message = ground_of(test, false);
    return;
  }
  const ReadableForm form = readable(by_energy && h.legendre.readable.value ? h.legendre.readable.value : left, h.order);
  const std::string text = to_plain(form, h.order);
  constexpr std::size_t longest = 300;
  result.message = test.verdict == Verdict::Undecided ? "Undecided: " + test.reason
                   : form.intermediates.empty() && text.size() <= longest
                       ? fmt::format("The {} is {}.", e.word, text)
                       : fmt::format("The {} differs: `maup hamiltonian` shows it.", e.word);
}

Expr with_momenta(Expr e, const EquationsOfMotion& equations) {
  ExprMap values;
  for (std::size_t i = 0; i < equations.momenta.size(); ++i)
    values.emplace(momentum_symbol(*equations.system, i), equations.momenta[i]);
  return substitute(e, values);
}

}  // namespace maupertuis
