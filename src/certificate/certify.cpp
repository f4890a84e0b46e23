#include <maupertuis/certificate.hpp>
#include <maupertuis/expression_lock.hpp>

#include "certificate/forms_agree.hpp"
#include "certificate/route_results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace maupertuis {
namespace {

using namespace certification;

constexpr std::size_t largest_checked_matrix = 6;  // beyond it M and h are compared on `full` alone: O(n²) of them
constexpr int real_points = 4;

struct RouteText {
  const char* name;
  const char* statement;
};
constexpr std::array<RouteText, RouteCount> texts{{
    {"jet_residual", "the equations follow from the action principle along random paths"},
    {"dalembert", "the particles and bodies obey d'Alembert's principle"},
    {"power_balance", "the energy function changes by the power of the forces (blind to gyroscopic terms)"},
    {"constraint_rows",
     "the forces of constraint do the virtual work λ δφ, and A q'' − b is the second derivative of φ along random "
     "paths"},
}};

/// The verdict over the primes, and over the reals where those leave it open.
CertificateCheck check_of(Route route, const RoutesResult& primes, const RoutesResult* reals) {
  CertificateCheck check;
  check.name = texts[route].name;
  check.statement = texts[route].statement;
  const RouteResult& exact = primes.routes[route];
  check.row = exact.row;
  if (exact.is_doubtful) {
    check.reason = "on one side of a switch the two formulas differ, and no point on that side was found";
    return check;
  }
  if (primes.complete && !exact.fails && exact.points > 0) {
    check.verdict = Verdict::Zero;
    check.points = exact.points;
    check.error_bound = primes.error_bound;
    return check;
  }
  if (!reals) {
    check.reason = "it was compared at no point";
    return check;
  }
  const RouteResult& digits = reals->routes[route];
  if (digits.fails) {
    check.verdict = Verdict::Nonzero;
    check.reason = fmt::format("the two sides differ by {:.6g} at a random point", digits.difference);
  } else if (reals->complete && digits.points > 0) {
    check.verdict = Verdict::Zero;
    check.points = digits.points;
    check.statement += fmt::format(", to 60 digits at {} points, not proved", digits.points);
  } else {
    check.reason = "no point was found at which every root, logarithm and denominator is defined";
  }
  return check;
}

void leave_out(CertificateCheck& check, std::string statement) {
  check = {check.name, std::move(statement), Verdict::Undecided, false, 0, 1, {}, 0};
}

void explain_dalembert(CertificateCheck& check, const Questions& questions) {
  const MechanicalSystem& system = questions.system;
  if (questions.stretching)
    return leave_out(check,
                     fmt::format("d'Alembert's principle does not apply: nothing keeps the quaternion of {} at norm 1",
                                 questions.stretching->name));
  if (!questions.has_matter)
    return leave_out(check, system.lagrangian_given
                                ? "d'Alembert's principle does not apply: L is given whole"
                                : "d'Alembert's principle does not apply: no particle or body has mass");
  const auto given = [](const EnergyTerm& term) { return term.origin == "T"; };
  if (std::any_of(system.kinetic.begin(), system.kinetic.end(), given))
    check.statement += "; the part of T that is given enters as it stands";
}

}  // namespace

bool Certificate::passed() const {
  for (const CertificateCheck& check : checks)
    if (check.applies && check.verdict != Verdict::Zero) return false;
  return true;
}

Certificate certify(const EquationsOfMotion& equations, const Derivation* readable, const CertifyOptions& options) {
  const ExpressionLock lock(*equations.system->context);
  Certificate certificate;
  if (readable) certificate.checks.push_back(forms_agree(equations, *readable, options.seed));

  const bool with_matrix = options.full || equations.residual.size() <= largest_checked_matrix;
  Questions questions(equations, with_matrix);
  RoutesResult primes = compare_over_primes(questions, options.seed);
  if (primes.routes[Dalembert].fails && (questions.stretching = questions.body_without_rotation())) {
    questions.has_matter = false;
    primes = compare_over_primes(questions, options.seed);
  }
  bool open = !primes.complete;
  for (const RouteResult& r : primes.routes) open |= r.fails;
  std::optional<RoutesResult> reals;
  if (open) reals = primes.is_real ? primes : compare_over_reals(questions, options.seed, real_points);

  for (const Route route : {Action, Dalembert, Power, ConstraintRows}) {
    if (route == ConstraintRows && !equations.system->constrained()) continue;
    CertificateCheck check = check_of(route, primes, reals ? &*reals : nullptr);
    if (route == Dalembert) explain_dalembert(check, questions);
    certificate.checks.push_back(std::move(check));
  }
  if (options.full) certificate.checks.push_back(gauge_invariance(equations, options.seed));
  return certificate;
}

}  // namespace maupertuis
