#include <maupertuis/invariants.hpp>
#include <maupertuis/print.hpp>
#include <maupertuis/verification.hpp>

#include <maupertuis/along_motion.hpp>
#include "verification/action_claims.hpp"
#include "verification/claims.hpp"
#include "verification/constraint_claims.hpp"
#include "verification/extended_claims.hpp"
#include "verification/mode_claims.hpp"
#include "verification/orbit_claims.hpp"
#include "verification/phase_space_claims.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace maupertuis {
namespace {

using Kind = syntax::ExpectStatement::Kind;

/// Values of the expectations that need a run, gathered so that each direction of time is run once.
struct Request {
  std::size_t expectation;
  double time;
  bool scan;   // wanted all along the run, not at one time
};

class Verifier {
 public:
  Verifier(const Model& model, const EquationsOfMotion& equations, const SourceText& source,
           const SimulationOptions& options, Diagnostics& diagnostics)
      : model_(model), equations_(equations), source_(source), options_(options), diagnostics_(diagnostics),
        bindings_(parameter_bindings(model.system)) {}

  Verification carry_out() {
    for (const Expectation& e : model_.experiment.expectations) {
      results_.push_back(blank(e));
      decide(e, results_.back());
    }
    find_end();
    run_requests();
    Verification verification;
    verification.results = std::move(results_);
    return verification;
  }

 private:
  ExpectationResult blank(const Expectation& e) const {
    ExpectationResult result;
    result.line = source_.locate(e.span.begin).line;
    result.text = e.text;
    result.claim = e.claim;
    return result;
  }

  const AlongMotion& along() {
    if (along_) return *along_;
    along_.emplace(equations_);
    Diagnostics told_by_the_run;
    if (const auto start = consistent_start(model_, equations_, told_by_the_run)) along_->set_start(start->state);
    return *along_;
  }

  /// Near the start, if there is one; why there is none is for the run to say.
  const ConstraintAnalysis& constraints() {
    if (!constraints_) {
      Diagnostics unheard;
      const auto start = consistent_start(model_, equations_, unheard);
      constraints_ = analyse_constraints(equations_, start ? &start->state : nullptr);
    }
    return *constraints_;
  }

  double number(Expr e, double otherwise = 0) const {
    if (!e) return otherwise;
    return evaluate(in_terms_of_motion(model_.system, {&e, 1}).front(), bindings_);
  }

  void decide(const Expectation& e, ExpectationResult& result) {
    const std::size_t index = results_.size() - 1;
    switch (e.kind) {
      case Kind::ValueAt:
        if (e.at_until) end_lines_.push_back(index);
        else requests_.push_back({index, number(e.time), false});
        return;
      case Kind::UntilAt: end_lines_.push_back(index); return;
      case Kind::Value: requests_.push_back({index, number(model_.experiment.start_time), false}); return;
      case Kind::EnergyConserved: energy_ = true; energy_lines_.push_back(index); return;
      case Kind::Conserved:
        if (e.tolerance) requests_.push_back({index, 0, true});
        else decide_conserved(e, result);
        return;
      case Kind::NotConserved: decide_not_conserved(e, result); return;
      case Kind::Equation:
        if (e.word.empty()) decide_equation(e, result);
        else decide_phase_space(e, equations_, result);
        return;
      case Kind::Freedoms: decide_freedoms(number(e.value), constraints(), result); return;
      case Kind::ConstraintClass: decide_class(e, model_.system, constraints(), result); return;
      case Kind::Error:
        result.expected = "error " + e.name;
        result.actual = "no error";
        result.message = "The model has no mistake that gives this error.";
        return;
      case Kind::Integral: decide_integral(e, result); return;
      case Kind::Frequencies: case Kind::Equilibrium: case Kind::Eigenvalues: case Kind::Matrix: case Kind::Stable:
        if (!mode_claims_) mode_claims_.emplace(model_, equations_);
        mode_claims_->decide(e, result);
        return;
      case Kind::Multipliers: case Kind::Trace: case Kind::Period:
        if (!orbit_claims_) orbit_claims_.emplace(model_, equations_, options_.interrupt);
        orbit_claims_->decide(e, result);
        return;
      case Kind::Action: case Kind::MorseIndex: case Kind::PathAt:
        if (!action_claims_) action_claims_.emplace(model_, equations_, options_.interrupt);
        action_claims_->decide(e, result);
        return;
      case Kind::EventAt:
        result.message = "Not supported yet: this kind of expectation waits for a later version.";
        return;
    }
  }

  std::string ground(const ZeroTest& test) const { return ground_of(test, equations_.system->constrained()); }

  bool needs_solvable(ExpectationResult& result) {
    if (along().solvable()) return true;
    result.message = "The mass matrix is singular: the equations do not determine the accelerations.";
    return false;
  }

  void decide_conserved(const Expectation& e, ExpectationResult& result) {
    if (!needs_solvable(result)) return;
    if (!e.where.empty()) return decide_conserved_on_level(e, result);
    const ZeroTest test = along().vanishes(along().rate(with_momenta(e.subject, equations_)));
    result.expected = "d/dt = 0 along the motion";
    if (test.verdict == Verdict::Zero)
      if (const AcrossSwitches sides = along().across(with_momenta(e.subject, equations_)); sides.switches > 0 || sides.jump)
        return judge_sides(test, sides, result);
    result.passed = test.verdict == Verdict::Zero;
    result.actual = result.passed ? result.expected : "d/dt is not 0";
    result.message = result.passed ? ground(test) : failed_identity(test, "Its time derivative along the motion", e.subject);
  }

  /// A constant on each side of a switch is one constant only if it goes on there.
  void judge_sides(const ZeroTest& test, const AcrossSwitches& sides, ExpectationResult& result) const {
    result.passed = !sides.jump;
    result.actual = result.passed ? result.expected : "d/dt = 0 on each side of a switch alone";
    result.message = result.passed ? fmt::format("{} on each side of its switches; at {} points of them it does not jump",
                                                 ground(test), sides.points)
                                   : jump_text(*sides.jump);
  }

  static std::string jump_text(const JumpAcross& jump) {
    return fmt::format("It is constant on each side of a switch and jumps by {:.6g} (SI units){}: it is not conserved across.",
                       std::abs(jump.jump), jump.place.empty() ? "" : " where " + jump.place);
  }

  /// dF/dt = 0 at all states on the level; and the motion stays there, else nothing would follow for it.
  void decide_conserved_on_level(const Expectation& e, ExpectationResult& result) {
    result.expected = "d/dt = 0 along the motions on the level";
    std::vector<Expr> level;
    for (const Expr& x : e.where) level.push_back(with_momenta(x, equations_));
    for (const Expr& x : level) {
      const ZeroTest stays = along().vanishes_on(along().rate(x), level);
      if (stays.verdict == Verdict::Zero) continue;
      result.actual = stays.verdict == Verdict::Nonzero ? "the motion leaves the level" : "undecided";
      result.message = stays.verdict == Verdict::Nonzero ? "A quantity that is given for the level changes along the motion." : stays.reason;
      return;
    }
    const ZeroTest test = along().vanishes_on(along().rate(with_momenta(e.subject, equations_)), level);
    result.passed = test.verdict == Verdict::Zero;
    result.actual = result.passed ? result.expected : test.verdict == Verdict::Nonzero ? "d/dt is not 0 on the level" : "undecided";
    result.message = result.passed ? fmt::format("vanishes to 60 digits at {} points of the level", test.points)
                     : test.verdict == Verdict::Nonzero
                         ? fmt::format("At a state on the level its time derivative is {:.6g}.", test.witness_value)
                         : test.reason;
    if (!result.passed) return;
    const AcrossSwitches sides = along().across(with_momenta(e.subject, equations_));
    if (!sides.jump) return;
    result.passed = false;
    result.actual = "d/dt = 0 on each side of a switch alone";
    result.message = jump_text(*sides.jump);
  }

  void decide_not_conserved(const Expectation& e, ExpectationResult& result) {
    if (!needs_solvable(result)) return;
    const ZeroTest test = along().vanishes(along().rate(with_momenta(e.subject, equations_)));
    result.expected = "d/dt is not 0 along the motion";
    result.passed = test.verdict == Verdict::Nonzero;
    if (test.verdict == Verdict::Zero)
      if (const AcrossSwitches sides = along().across(with_momenta(e.subject, equations_)); sides.jump) {
        result.passed = true;
        result.actual = "it jumps at a switch";
        result.message = jump_text(*sides.jump);
        return;
      }
    result.actual = result.passed ? result.expected : test.verdict == Verdict::Zero ? "d/dt = 0: it is conserved" : "undecided";
    result.message = result.passed ? "a state was found at which it changes" : test.verdict == Verdict::Zero ? ground(test) : test.reason;
  }

  /// The search of `maup invariants`, of the degree that the expectation has in the velocities; one for each degree.
  const std::optional<Invariants>& invariants(int degree) {
    const auto [it, is_new] = invariants_.try_emplace(degree);
    if (is_new) {
      InvariantsOptions options;
      options.velocity_degree = degree;
      options.drift = options.relations = options.completeness = false;
      it->second = find_invariants(model_, equations_, options, diagnostics_);
    }
    return it->second;
  }

  void decide_integral(const Expectation& e, ExpectationResult& result) {
    result.expected = "found by maup invariants, up to functions of the others";
    const Expr integral = along().put_in(e.subject);
    const int degree = std::clamp(velocity_degree(integral, *equations_.system).value_or(2), 2, 4);
    const auto& found = invariants(degree);
    if (!found) {
      const std::string why = diagnostics_.empty() ? "" : diagnostics_.items().back().message;
      result.message = fmt::format("The search did not run{}{}.", why.empty() ? "" : ": ", why);
      return;
    }
    result.passed = is_function_of(integral, *found, equations_);
    result.actual = result.passed ? result.expected : "not found";
    if (const AcrossSwitches sides = along().across(integral); sides.jump) {
      result.passed = false;
      result.actual = "constant on each side of a switch alone";
      result.message = jump_text(*sides.jump);
      return;
    }
    result.message = result.passed ? fmt::format("a function of the {} integrals of degree up to {} in the velocities, by the rank of gradients",
                                                 found->integrals.size(), degree)
                                   : fmt::format("It is no function of the {} integrals of degree up to {} in the velocities that were found.",
                                                 found->integrals.size(), degree);
  }

  void decide_equation(const Expectation& e, ExpectationResult& result) {
    if (!needs_solvable(result)) return;
    const Expr difference = with_momenta(e.subject - e.subject_right, equations_);
    const ZeroTest test = along().vanishes(difference);
    result.expected = "follows from the derived equations";
    result.passed = test.verdict == Verdict::Zero;
    if (result.passed) {
      result.actual = result.expected;
      result.message = ground(test);
      return;
    }
    result.actual = test.verdict == Verdict::Undecided ? "undecided" : "does not follow";
    result.message = failed_identity(test, "Along the motion, left side − right side", difference);
    if (test.verdict != Verdict::Nonzero) return;
    const auto resemblance = resembled_equation(difference, equations_);
    if (resemblance) result.message = resemblance->text;
    result.pitfall = diagnose_claim(difference, equations_, resemblance ? &*resemblance : nullptr);
    if (resemblance && result.pitfall.empty()) result.message += " No known mistake has this signature.";
  }

  /// Names the difference where it is short enough to be read.
  std::string failed_identity(const ZeroTest& test, const std::string& what, Expr e) {
    if (test.verdict == Verdict::Undecided) return "Undecided: " + test.reason;
    const bool is_rate = what.front() == 'I';
    const ReadableForm form = readable(is_rate ? along().rate(e) : along().put_in(e), equations_.order);
    const std::string text = to_plain(form.value, equations_.order);
    constexpr std::size_t longest = 300;
    if (form.intermediates.empty() && text.size() <= longest) return fmt::format("{} is {}, not 0.", what, text);
    return fmt::format("{} is not 0: at {} it is {:.6g}.", what, state_text(test.witness), test.witness_value);
  }

  /// "x = 0.3, x' = -1.2 (SI)" of a sample.
  std::string state_text(const Bindings& sample) const {
    std::string out;
    for (const Coordinate& c : equations_.system->coordinates)
      for (const Expr& symbol : {c.q, c.velocity})
        if (const auto found = sample.find(symbol); found != sample.end())
          out += fmt::format("{}{}{} = {:.6g}", out.empty() ? "" : ", ", c.name, symbol == c.q ? "" : "'", found->second);
    return out.empty() ? "a sample state" : out + " (SI)";
  }

  // ------------------------------------------------------------------------------------------------ runs

  /// When the condition of `run until` is met: by the model's own run.
  void find_end() {
    if (end_lines_.empty()) return;
    Diagnostics unheard;   // a run that cannot start says so once
    const auto run = simulate(model_, equations_, options_, requests_.empty() && !energy_ ? diagnostics_ : unheard);
    for (const std::size_t index : end_lines_) {
      const Expectation& e = model_.experiment.expectations[index];
      if (!run) results_[index].message = "The run could not start.";
      else if (run->ending != Ending::UntilReached) results_[index].message = "The run ended before: " + run->reason + ".";
      else if (e.kind == Kind::UntilAt) judge_value({index, 0, false}, run->final.t, run->final.errors ? run->final.errors->t : 0.0, results_[index]);
      else requests_.push_back({index, run->final.t, false});
    }
  }

  /// Those that the model wants in more digits than double has; the others are left.
  void run_extended_requests(double begin) {
    const ExtendedClaims claims(model_, equations_, options_.interrupt);
    std::vector<std::size_t> ahead, behind;
    const auto taken = [&](const Request& r) {
      if (r.scan || !claims.takes(model_.experiment.expectations[r.expectation])) return false;
      (r.time >= begin ? ahead : behind).push_back(r.expectation);
      return true;
    };
    requests_.erase(std::remove_if(requests_.begin(), requests_.end(), taken), requests_.end());
    for (const auto* which : {&ahead, &behind})
      if (!which->empty()) claims.decide(*which, results_, diagnostics_);
  }

  void run_requests() {
    const double begin = number(model_.experiment.start_time);
    run_extended_requests(begin);
    if (requests_.empty() && !energy_) return;
    run_direction([&](const Request& r) { return r.scan || r.time >= begin; }, true);
    run_direction([&](const Request& r) { return !r.scan && r.time < begin; }, false);
  }

  template <class Chosen>
  void run_direction(Chosen chosen, bool forwards) {
    std::vector<Request> wanted;
    std::copy_if(requests_.begin(), requests_.end(), std::back_inserter(wanted), chosen);
    const bool whole_run = forwards && (energy_ || std::any_of(wanted.begin(), wanted.end(), [](const Request& r) { return r.scan; }));
    if (wanted.empty() && !whole_run) return;

    SimulationOptions options = options_;
    if (!whole_run) options.duration = 0.0;      // as far as the times asked for
    Probe probe;
    for (const Request& r : wanted)
      probe.expressions.push_back(with_momenta(model_.experiment.expectations[r.expectation].subject, equations_));
    options.at = times_of(wanted, whole_run);
    const auto run = simulate(model_, equations_, options, diagnostics_, &probe);
    for (std::size_t i = 0; i < wanted.size(); ++i) judge(wanted[i], i, options.at, run, probe);
    if (forwards) judge_energy(run);
  }

  /// The times asked for; and 200 along the run where a quantity is watched all along it.
  std::vector<double> times_of(const std::vector<Request>& wanted, bool whole_run) const {
    std::vector<double> times;
    bool scan = false;
    for (const Request& r : wanted) {
      scan |= r.scan;
      if (!r.scan) times.push_back(r.time);
    }
    if (!scan || !whole_run) return times;
    const double begin = number(model_.experiment.start_time);
    const double length = options_.duration ? *options_.duration : number(model_.experiment.duration, number(model_.experiment.within));
    constexpr int samples = 200;
    for (int k = 0; k <= samples; ++k) times.push_back(begin + length * k / samples);
    return times;
  }

  void judge(const Request& request, std::size_t column, const std::vector<double>& times,
             const std::optional<SimulationResult>& run, const Probe& probe) {
    ExpectationResult& result = results_[request.expectation];
    if (!run) {
      result.message = "The run could not start.";
      return;
    }
    if (request.scan) return judge_along_run(request, column, *run, probe);
    for (std::size_t k = 0; k < times.size(); ++k) {
      if (times[k] != request.time) continue;
      if (probe.values[k].empty()) result.message = "The run ended before: " + run->reason + ".";
      else judge_value(request, probe.values[k][column], probe.errors.empty() ? 0 : probe.errors[k][column], result);
      return;
    }
  }

  /// The tolerance is absolute or relative to |expected|. Without one the digits as written count. `uncertainty`: by how much `actual` may be off; 0 where
  /// nobody asked.
  void judge_value(const Request& request, double actual, double uncertainty, ExpectationResult& result) {
    const Expectation& e = model_.experiment.expectations[request.expectation];
    const double expected = number(e.value);
    const double tolerance = !e.tolerance ? 1e-9 * std::abs(expected) : number(e.tolerance) * (e.relative ? std::abs(expected) : 1.0);
    const std::string unit = e.display_unit.empty() ? "" : " " + e.display_unit;
    result.actual = fmt::format("{:.17g}{}", actual / e.display_factor, unit);
    result.expected = fmt::format("{:.17g}{}", expected / e.display_factor, unit);
    result.tolerance = e.relative ? fmt::format("rel {:g}", number(e.tolerance)) : fmt::format("± {:g}{}", tolerance / e.display_factor, unit);
    const ValueVerdict verdict = value_verdict(actual, expected, tolerance, uncertainty);
    result.passed = verdict.passed;
    result.beyond_digits = verdict.beyond_digits;
    result.message = fmt::format("off by {:.2g}{}", std::abs(actual - expected) / e.display_factor, unit);
    if (uncertainty > 0)
      result.uncertainty = std::isinf(uncertainty) ? "no digit is certain" : fmt::format("± {:.2g}{}", uncertainty / std::abs(e.display_factor), unit);
    if (verdict.beyond_digits) result.message += "; " + beyond_digits(verdict, result.uncertainty);
  }

  static std::string beyond_digits(const ValueVerdict& verdict, const std::string& uncertainty) {
    const std::string known = uncertainty == "no digit is certain" ? "of what came out no digit is certain" : "what came out is known to " + uncertainty + " alone";
    if (verdict.passed) return known + ", so that the tolerance asks for more digits than there are";
    return known + (verdict.may_hold ? ", so that this run does not tell whether it holds" : ", and still it does not hold");
  }

  void judge_along_run(const Request& request, std::size_t column, const SimulationResult& run, const Probe& probe) {
    ExpectationResult& result = results_[request.expectation];
    const Expectation& e = model_.experiment.expectations[request.expectation];
    double low = std::numeric_limits<double>::infinity(), high = -low, largest = 0;
    for (const auto& row : probe.values) {
      if (row.empty()) {
        result.message = "The run ended before: " + run.reason + ".";
        return;
      }
      low = std::min(low, row[column]);
      high = std::max(high, row[column]);
      largest = std::max(largest, std::abs(row[column]));
    }
    const double drift = largest > 0 ? (high - low) / largest : 0;
    report_drift(result, drift, number(e.tolerance));
  }

  static void report_drift(ExpectationResult& result, double drift, double tolerance) {
    result.expected = "constant along the run";
    result.actual = fmt::format("drift {:.3g}", drift);
    result.tolerance = fmt::format("rel {:g}", tolerance);
    result.passed = drift <= tolerance;
    if (!result.passed) result.message = "It changes more than the tolerance along the run.";
  }

  void judge_energy(const std::optional<SimulationResult>& run) {
    for (const std::size_t index : energy_lines_) {
      ExpectationResult& result = results_[index];
      const Expectation& e = model_.experiment.expectations[index];
      if (!run) {
        result.message = "The run could not start.";
      } else if (!conserved_quantities(equations_).energy_conserved) {
        result.expected = "constant along the run";
        result.actual = "not conserved";
        const auto jump = across_switches(model_.system, equations_.energy_function, equations_.order).jump;
        result.message = !jump ? "Forces, friction or an explicit time in L change the energy of this system."
                               : fmt::format("The energy jumps where {}: what is switched there does work at once.", jump->place);
      } else if (!run->ok()) {
        result.message = "The run ended before: " + run->reason + ".";
      } else {
        report_drift(result, run->statistics.energy_drift, e.tolerance ? number(e.tolerance) : 1e-12);
      }
    }
  }

  const Model& model_;
  const EquationsOfMotion& equations_;
  const SourceText& source_;
  const SimulationOptions& options_;
  Diagnostics& diagnostics_;
  Bindings bindings_;
  std::optional<AlongMotion> along_;
  std::optional<ConstraintAnalysis> constraints_;
  std::optional<ModeClaims> mode_claims_;
  std::optional<ActionClaims> action_claims_;
  std::optional<OrbitClaims> orbit_claims_;
  std::vector<ExpectationResult> results_;
  std::vector<Request> requests_;
  std::vector<std::size_t> energy_lines_;
  std::vector<std::size_t> end_lines_;   // about the end of `run until`
  bool energy_ = false;
  std::map<int, std::optional<Invariants>> invariants_;   // by degree in the velocities
};

}  // namespace

ValueVerdict value_verdict(double actual, double expected, double tolerance, double error) {
  constexpr double most_pessimistic = 100, last_bits = 4 * std::numeric_limits<double>::epsilon();
  const double off = std::abs(actual - expected);
  ValueVerdict out;
  out.beyond_digits = error > tolerance && error > last_bits * std::abs(actual);
  out.passed = off <= tolerance && (!out.beyond_digits || error <= most_pessimistic * tolerance);
  out.may_hold = !out.passed && off <= tolerance + error;
  return out;
}

std::size_t Verification::passed() const {
  return static_cast<std::size_t>(std::count_if(results.begin(), results.end(), [](const auto& r) { return r.passed; }));
}

Verification verify(const Model& model, const EquationsOfMotion& equations, const SourceText& source,
                    const SimulationOptions& options, Diagnostics& diagnostics) {
  return Verifier(model, equations, source, options, diagnostics).carry_out();
}

}  // namespace maupertuis
