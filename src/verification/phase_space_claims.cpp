#include "verification/phase_space_claims.hpp"

#include <maupertuis/along_motion.hpp>
#include <maupertuis/integral_symbol.hpp>
#include <maupertuis/print.hpp>

#include <fmt/format.h>

namespace maupertuis {
namespace {

bool has_velocity(Expr e) {
  for (const Expr& s : symbols_of({&e, 1}))
    if (s.role() == Role::Coordinate && s.order() == 1 && !is_integral(s.name())) return true;
  return false;
}

/// H as it is printed where the velocities do not follow from the momenta, or were not written out: with velocities in
/// it, or with momenta that obey primary constraints. Where p = ∂L/∂q' it is the energy function.
Expr difference_from_energy(Expr right, const EquationsOfMotion& equations) {
  return with_momenta(right, equations) - equations.energy_function;
}

/// Two sides of an identity in phase space.
struct Sides {
  std::string what;    // "hamiltonian"
  Expr left;           // what the system has; an empty handle where it has none
  std::string reason;  // why it has none
  Expr difference;     // left − right
  Expr shown;          // what is printed as the left side
};

void judge_sides(const Sides& sides, const Hamiltonian& h, ExpectationResult& result) {
  result.expected = fmt::format("{} as written", sides.what);
  if (!sides.left) {
    result.actual = "not defined";
    result.message = "There is no such function: " + sides.reason + ".";
    return;
  }
  const ZeroTest test = vanish_for_given_signs(*h.system, with_definitions(*h.system, {&sides.difference, 1}));
  result.passed = test.verdict == Verdict::Zero;
  result.actual = result.passed ? result.expected : test.verdict == Verdict::Nonzero ? "another function" : "undecided";
  if (result.passed) {
    result.message = ground_of(test, false);
    return;
  }
  const ReadableForm form = readable(sides.shown, h.order);
  const std::string text = to_plain(form, h.order);
  constexpr std::size_t longest = 300;
  result.message = test.verdict == Verdict::Undecided ? "Undecided: " + test.reason
                   : form.intermediates.empty() && text.size() <= longest
                       ? fmt::format("The {} is {}.", sides.what, text)
                       : fmt::format("The {} differs: `maup hamiltonian` shows it.", sides.what);
}

}  // namespace

void decide_phase_space(const expectation::Hamiltonian& e, const EquationsOfMotion& equations,
                        ExpectationResult& result) {
  const Hamiltonian h = hamiltonian(equations);
  const Expr left = h.value ? h.value : equations.energy_function;
  const bool by_energy = !h.regular() || has_velocity(e.value);
  const Expr difference = by_energy ? difference_from_energy(e.value, equations) : left - e.value;
  const Expr shown = by_energy && h.legendre.readable.value ? h.legendre.readable.value : left;
  judge_sides({"hamiltonian", left, "it was not written out", difference, shown}, h, result);
}

void decide_phase_space(const expectation::Routhian& e, const EquationsOfMotion& equations, ExpectationResult& result) {
  const Hamiltonian h = hamiltonian(equations);
  const auto found = routhian(equations, h, &e.coordinates);
  const Expr left = found ? found->value : Expr();
  judge_sides({"routhian", left, "the momenta of these coordinates do not determine their velocities",
               left ? left - e.value : Expr(), left},
              h, result);
}

void decide_phase_space(const expectation::Bracket& e, const EquationsOfMotion& equations, ExpectationResult& result) {
  const Hamiltonian h = hamiltonian(equations);
  const auto found = poisson_bracket(e.a, e.b, h);
  const Expr left = found ? found->value : Expr(), right = left ? in_phase_space(e.value, h) : Expr();
  judge_sides({"bracket", left, "a velocity stands in it that does not follow from the momenta, or an acceleration",
               left ? left - right : Expr(), left},
              h, result);
}

Expr with_momenta(Expr e, const EquationsOfMotion& equations) {
  ExprMap values;
  for (std::size_t i = 0; i < equations.momenta.size(); ++i)
    values.emplace(momentum_symbol(*equations.system, i), equations.momenta[i]);
  return substitute(e, values);
}

}  // namespace maupertuis
