#include "certificate/forms_agree.hpp"

#include <maupertuis/require.hpp>

#include <fmt/format.h>

namespace maupertuis::certification {
namespace {

/// Fills in what a zero test of all differences found; where they are not zero, which of the `rows` equations it was.
void judge(CertificateCheck& check, const ExprVector& differences, std::size_t rows, std::uint64_t seed) {
  ZeroTestOptions options;
  options.seed = seed;
  const ZeroTest all = zero_test(differences, options);
  check.verdict = all.verdict;
  check.points = all.points;
  check.error_bound = all.error_bound;
  if (all.verdict == Verdict::Zero) return;
  for (std::size_t row = 0; row < differences.size(); ++row) {
    const ZeroTest one = zero_test(differences[row], options);
    if (one.verdict == Verdict::Zero) continue;
    check.row = row % rows;
    check.reason = one.verdict == Verdict::Nonzero
                       ? fmt::format("they differ by {:.6g} at a real point", one.witness_value)
                       : one.reason;
    return;
  }
  check.reason = all.reason;
}

}  // namespace

CertificateCheck forms_agree(const EquationsOfMotion& equations, const Derivation& readable, std::uint64_t seed) {
  MAUP_REQUIRE(readable.equations.size() == equations.residual.size());
  CertificateCheck check;
  check.name = "forms_agree";
  check.statement = "the printed equations are the computed ones";
  // Intermediates and `let`s stand for their values; a shared value stays shared, nothing is multiplied out.
  ExprMap meaning = equations.system->definition_values();
  for (const Intermediate& i : readable.intermediates) meaning[i.symbol] = substitute(i.value, meaning);
  ExprVector differences;
  for (std::size_t row = 0; row < equations.residual.size(); ++row)
    differences.push_back(readable.equations[row].value - equations.residual[row]);
  for (std::size_t row = 0; row < equations.constraint_forces.size(); ++row)
    differences.push_back(readable.constraint_forces[row].value - equations.constraint_forces[row]);
  if (!meaning.empty()) differences = substitute(differences, meaning);
  judge(check, differences, equations.residual.size(), seed);
  return check;
}

CertificateCheck gauge_invariance(const EquationsOfMotion& equations, std::uint64_t seed) {
  CertificateCheck check;
  check.name = "gauge_invariance";
  check.statement = "adding dG(q, t)/dt to L changes no equation";
  const auto& coordinates = equations.system->coordinates;
  Context& context = *equations.system->context;
  const Expr t = context.time();
  ExprVector q, terms{t};
  for (const Coordinate& c : coordinates) q.push_back(c.q);
  for (std::size_t i = 0; i < q.size(); ++i) {
    const Expr next = q[(i + 1) % q.size()];
    terms.push_back(Rational(static_cast<std::int64_t>(i) + 2) * sin(q[i]) * next * t + pow(q[i], Rational(3)) * next);
  }
  const Expr gauge = total_time_derivative(context.sum(terms));
  const auto changed = variational_residual(equations.lagrangian + gauge, q);
  const auto plain = variational_residual(equations.lagrangian, q);
  ExprVector differences;
  for (std::size_t i = 0; i < q.size(); ++i) differences.push_back(changed[i] - plain[i]);
  judge(check, differences, q.size(), seed);
  return check;
}

}  // namespace maupertuis::certification
