#include "verification/constraint_claims.hpp"

#include <fmt/format.h>

namespace maupertuis {

void decide_freedoms(double expected, const ConstraintAnalysis& found, ExpectationResult& result) {
  result.expected = fmt::format("{:g}", expected);
  if (!found.clashing.empty()) {
    result.message = "The constraints exclude each other.";
    return;
  }
  result.actual = std::to_string(found.configuration_freedoms);
  result.passed = expected == static_cast<double>(found.configuration_freedoms);
  if (result.passed) return;
  result.message = "The number of freedoms is the number of independent coordinates.";
  if (found.instantaneous_freedoms != found.configuration_freedoms)
    result.message += fmt::format(" Those of the velocities at an instant are {}.", found.instantaneous_freedoms);
}

void decide_class(const expectation::ConstraintClass& e, const MechanicalSystem& system,
                  const ConstraintAnalysis& found, ExpectationResult& result) {
  result.expected = e.word;
  const Constraint* constraint = system.find_constraint(e.constraint);
  if (!constraint || !found.clashing.empty()) {
    result.message = constraint ? "The constraints exclude each other." : "There is no such constraint.";
    return;
  }
  const ConstraintReport& report = found.constraints[static_cast<std::size_t>(constraint - system.constraints.data())];
  const ConstraintClass is = report.constraint_class;
  if (e.word == "scleronomic" || e.word == "rheonomic") {
    result.actual = report.scleronomic ? "scleronomic" : "rheonomic";
    result.passed = result.actual == e.word;
    return;
  }
  result.actual = words(is);
  result.passed = e.word == word(is) || (e.word == "holonomic" && is == ConstraintClass::Integrable);
  if (is == ConstraintClass::Nonlinear)
    result.message = "Constraints that are not linear in the velocities are not classified.";
  else if (!result.passed && is == ConstraintClass::Holonomic)
    result.message = "It relates the coordinates themselves.";
  else if (!result.passed && is == ConstraintClass::Integrable)
    result.message = "Frobenius: it keeps the coordinates on a surface.";
  else if (!result.passed)
    result.message =
        "Frobenius: moving to and fro with the velocities that the constraints allow breaks every F(q, t) = const that "
        "it could mean.";
}

}  // namespace maupertuis
