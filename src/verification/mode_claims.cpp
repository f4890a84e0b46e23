#include "verification/mode_claims.hpp"

#include "verification/critical_claims.hpp"
#include "verification/judge.hpp"
#include "verification/matrix_claims.hpp"

#include <maupertuis/orbits.hpp>
#include <maupertuis/resting_modes.hpp>
#include <maupertuis/simulation.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace maupertuis {
namespace {

/// One for each mode of oscillation, and 0 for each pair of vanishing eigenvalues; ascending. Squared: ω², negative for
/// modes that grow and decay instead.
struct Frequency {
  double value = 0, error = 0;
};

std::vector<Frequency> frequencies(const ModalAnalysis& analysis, bool squared) {
  std::vector<Frequency> out;
  std::size_t zeros = 0;
  Frequency zero;
  for (const Mode& m : analysis.modes) {
    const double w = m.kind == Mode::Kind::Growth ? m.eigenvalue.real() : m.frequency();
    if (m.kind == Mode::Kind::Zero) zeros += m.zeros, zero.error = std::max(zero.error, m.error);
    const double error = squared ? (2 * std::abs(w) + m.error) * m.error : m.error;
    if (m.kind == Mode::Kind::Oscillation) out.insert(out.end(), m.chain, {squared ? w * w : w, error});
    if (m.kind == Mode::Kind::Growth && squared) out.insert(out.end(), m.chain, {-w * w, error});
  }
  if (squared) zero.error *= zero.error;
  out.insert(out.end(), (zeros + 1) / 2, zero);
  std::sort(out.begin(), out.end(), [](const Frequency& a, const Frequency& b) { return a.value < b.value; });
  return out;
}

std::string list_text(const std::vector<double>& values, const expectation::Frequencies& e) {
  std::string out;
  for (const double v : values) out += fmt::format("{}{:.17g}", out.empty() ? "" : ", ", v / e.unit.factor);
  const std::string unit = !e.unit.name.empty() ? e.unit.name : e.squared ? "rad^2/s^2" : "rad/s";
  return out.empty() ? "none" : out + " " + unit;
}

}  // namespace

namespace {

/// Of the motion while all contacts are open and nothing rubs: rests in other modes have studies of their own.
EquationsOfMotion without_contacts(EquationsOfMotion equations) {
  auto system = std::make_shared<MechanicalSystem>(*equations.system);
  system->contacts.clear();
  system->frictions.clear();
  equations.system = std::move(system);
  return equations;
}

}  // namespace

ModeClaims::ModeClaims(const Model& model, const EquationsOfMotion& equations)
    : model_(model),
      derived_(equations),
      equations_(without_contacts(equations), rates_as_outputs(model.system)),
      plain_(model.system) {
  for (Friction& f : plain_.frictions)
    if (f.normal) f.normal = with_reactions(equations, {&f.normal, 1}).front();
  Diagnostics unheard;  // why there is no start is for a run to say
  if (const auto start = consistent_start(model, equations, unheard))
    start_ = start->state;
  else
    start_ = {0, std::vector<double>(model.system.coordinates.size()),
              std::vector<double>(model.system.coordinates.size())};
}

void ModeClaims::decide_at(const MotionState& begin, const std::vector<StartValue>& at, const char* what,
                           const Judge& judge, ExpectationResult& result) {
  Diagnostics told;
  std::optional<ModalStudy> study;
  std::string mode;  // of contacts
  if (model_.system.has_modes()) {
    if (auto rest = resting_mode_at(plain_, begin, at, told)) {
      study = std::move(rest->study);
      mode = rest->text;
    }
  } else {
    study = modal_study_at(equations_, begin, at, told);
  }
  if (!study) {
    result.expected = what;
    result.actual = "none";
    for (const Diagnostic& d : told.items()) result.message = d.message + ". " + d.reason;
    return;
  }
  if (mode.empty()) settle_driven(*study, equations_, model_, derived_, nullptr);
  // On a kink each side is judged for itself, and all have to agree.
  for (const ModalEntry& entry : study->entries) {
    judge(entry, result);
    if (!mode.empty()) result.message += fmt::format("; mode \"{}\"", mode);
    if (!entry.side.empty()) result.message = fmt::format("On the side {} of a kink: {}", entry.side, result.message);
    if (!result.passed) return;
  }
  if (study->kinks.empty()) return;
  result.passed = false;
  const Kink& kink = study->kinks.front();
  result.message =
      kink.switches > 0 ? fmt::format("{} formulas switch at the point: more sides than are looked at.", kink.switches)
      : kink.steep
          ? "The stiffness grows without bound near the point: there is no linearization."
          : fmt::format("On the side {} of a kink forces are left over: there is no linearization.", kink.side);
}

void ModeClaims::decide_linear(const std::vector<StartValue>& at, const char* what, const Judge& judge,
                               ExpectationResult& result) {
  decide_at(
      start_, at, "an equilibrium or a steady motion",
      [&](const ModalEntry& entry, ExpectationResult& of_entry) {
        if (equations_.autonomous()) return judge(entry, of_entry);
        of_entry.expected = what;
        of_entry.actual = "none";
        of_entry.message =
            fmt::format("The coefficients change with the time, and those frozen at an instant mean nothing; {}.",
                        entry.analysis.stability.reason);
      },
      result);
}

void ModeClaims::decide(const expectation::Frequencies& e, ExpectationResult& result) {
  decide_linear(
      e.at, "frequencies",
      [&](const ModalEntry& entry, ExpectationResult& r) { judge_frequencies(e, entry.analysis, r); }, result);
}

void ModeClaims::decide(const expectation::Eigenvalues& e, ExpectationResult& result) {
  decide_linear(
      e.at, "a linearization",
      [&](const ModalEntry& entry, ExpectationResult& r) {
        judge_spectrum(e.expected, model_.system, entry.analysis.eigenvalues, r);
      },
      result);
}

void ModeClaims::decide(const expectation::Matrix& e, ExpectationResult& result) {
  if (e.letter == 'M') return decide_mass_matrix(e, derived_, start_, result);
  decide_linear(
      e.at, "a linearization",
      [&](const ModalEntry& entry, ExpectationResult& r) {
        decide_linearization(e, model_.system, entry.linearization, r);
      },
      result);
}

/// Values with a tolerance are where the search begins; the others are kept.
void ModeClaims::decide(const expectation::Equilibrium& e, ExpectationResult& result) {
  MotionState begin = start_;
  std::vector<StartValue> kept;
  for (const expectation::Place& place : e.at) {
    if (!place.tolerance)
      kept.push_back(place.value);
    else
      begin.q[place.value.coordinate] = number(model_, place.value.value);
  }
  decide_at(
      begin, kept, "an equilibrium",
      [&](const ModalEntry& entry, ExpectationResult& r) { judge_stability(e, entry, r); }, result);
}

void ModeClaims::decide(const expectation::Stable& e, ExpectationResult& result) {
  decide_critical(e, equations_, start_, result, model_.experiment);
}

/// Whether it lies where it should; what has no tolerance was found to within its rounding.
bool ModeClaims::judge_place(const expectation::Equilibrium& e, const ModalEntry& entry,
                             ExpectationResult& result) const {
  for (const expectation::Place& place : e.at) {
    if (!place.tolerance) continue;
    const std::size_t i = place.value.coordinate;
    judge_number({place.value.value, *place.tolerance, place.unit}, model_.system, entry.equilibrium.point.q[i],
                 result);
    const std::string& name = model_.system.coordinates[i].name;
    result.actual = name + " = " + result.actual;
    result.expected = name + " = " + result.expected;
    if (!result.passed) return false;
  }
  return true;
}

void ModeClaims::judge_frequencies(const expectation::Frequencies& e, const ModalAnalysis& analysis,
                                   ExpectationResult& result) const {
  std::vector<double> expected;
  for (const Expr& v : e.values) expected.push_back(number(model_, v));
  if (!expected_exists(expected, result)) return;
  std::sort(expected.begin(), expected.end());
  const std::vector<Frequency> actual = frequencies(analysis, e.squared);
  std::vector<double> values;
  for (const Frequency& f : actual) values.push_back(f.value);
  const double tolerance = number(model_, e.tolerance.size);
  result.actual = list_text(values, e);
  result.expected = list_text(expected, e);
  result.tolerance =
      e.tolerance.relative ? fmt::format("rel {:g}", tolerance) : fmt::format("± {:g}", tolerance / e.unit.factor);
  if (e.squared && !analysis.symmetric) {
    result.message = "Squares are the eigenvalues of M ξ'' + K ξ = 0; here forces depend on velocities.";
    return;
  }
  if (actual.size() != expected.size()) {
    result.message = fmt::format("{} {} expected, there {} {}.", expected.size(),
                                 expected.size() == 1 ? "frequency is" : "frequencies are",
                                 actual.size() == 1 ? "is" : "are", actual.size());
    return;
  }
  double worst = 0;
  constexpr double least_certain = 100;  // tolerances, as of a value
  for (std::size_t i = 0; i < actual.size(); ++i) {
    const double allowed = e.tolerance.relative ? tolerance * std::abs(expected[i]) : tolerance,
                 error = std::abs(actual[i].value - expected[i]);
    // A frequency of 0 has no part of itself: it is told from 0 beside the largest. Where velocities have forces the
    // bound of a chain of zeros, as of cyclic coordinates in a steady motion, is far too large.
    const bool is_zero = expected[i] == 0;
    const double scale = is_zero && e.tolerance.relative ? tolerance * std::abs(expected.back()) : allowed;
    if (actual[i].error > (is_zero ? 1 : least_certain) * scale && (!is_zero || analysis.symmetric)) {
      result.message = fmt::format(
          "The frequency {:.6g} is known to ± {:.1e}{} only: beside others that are so much higher rounding "
          "hides the rest.",
          actual[i].value / e.unit.factor,
          actual[i].value == 0 ? actual[i].error / e.unit.factor : actual[i].error / std::abs(actual[i].value),
          actual[i].value == 0 ? "" : " of it");
      return;
    }
    worst = std::max(worst, error <= allowed ? error / std::max(allowed, 1e-300) : HUGE_VAL);
  }
  result.passed = worst <= 1;
  result.message = result.passed ? fmt::format("residual of the eigenvalue problem {:.1e}", analysis.residual)
                                 : "A frequency is off by more than the tolerance.";
  const double turn = 2 * std::acos(-1.0);
  const auto in_turns = [&](std::size_t i) {
    return expected[i] != 0 && std::abs(actual[i].value / (turn * expected[i]) - 1) < 1e-3;
  };
  bool all_in_turns = !result.passed && !e.squared && !actual.empty();
  for (std::size_t i = 0; i < actual.size(); ++i) all_in_turns = all_in_turns && in_turns(i);
  if (all_in_turns)
    result.message += " What is expected is f = ω/(2π), in turns a second: as a number of Hz, else times 2π.";
}

void ModeClaims::judge_stability(const expectation::Equilibrium& e, const ModalEntry& entry,
                                 ExpectationResult& result) const {
  if (!judge_place(e, entry, result)) return;
  const Stability verdict = entry.analysis.stability.verdict;
  const std::string_view word = verdict == Stability::Unstable    ? "unstable"
                                : verdict == Stability::Undecided ? "undecided"
                                                                  : "stable";
  if (result.actual.empty()) {
    result.actual = entry.equilibrium.at_rest ? "an equilibrium" : "a steady motion";
    result.expected = "an equilibrium";
  }
  if (!e.word.empty()) {
    result.expected = e.word;
    result.actual = word;
    result.tolerance.clear();
  }
  result.passed = e.word.empty() || e.word == word;
  result.message = fmt::format("residual {:.1e}; {}", entry.equilibrium.residual, entry.analysis.stability.reason);
}

}  // namespace maupertuis
