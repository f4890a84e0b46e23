#include <maupertuis/coupled_fields.hpp>
#include <maupertuis/evaluate.hpp>
#include <maupertuis/field_run.hpp>
#include <maupertuis/field_verification.hpp>

#include "fields/on_shell.hpp"
#include "fields/polynomial_division.hpp"
#include "fields/rest_claims.hpp"
#include "fields/resting_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

/// expect and claim of fields.
namespace maupertuis {
namespace {

namespace fe = field_expectation;

void say(ExpectationResult& result, const ZeroTest& test, const char* proved, const char* failed) {
  result.passed = test.verdict == Verdict::Zero;
  result.message = test.verdict == Verdict::Zero      ? proved
                   : test.verdict == Verdict::Nonzero ? failed
                                                      : "It could not be decided: " + test.reason;
}

/// By impacts, friction and contacts that move.
double energy_exchanged(const FieldRunResult& run) {
  if (!run.books) return 0;
  return std::abs(run.books->impacts) + std::abs(run.books->friction) + std::abs(run.books->moving) +
         std::abs(run.books->events);
}

constexpr const char* nothing_moves_here =
    "No derivative by the time stands in the equations: nothing moves. A value without a time, or `expect equilibrium "
    "at …`, is that of the rest.";

class FieldVerifier {
 public:
  FieldVerifier(const Model& model, const FieldEquations& equations, const SimulationOptions& options,
                Diagnostics& diagnostics)
      : model_(model),
        equations_(equations),
        s_(equations.system()),
        shell_(equations),
        options_(options),
        diagnostics_(diagnostics) {}

  Verification carry_out(const SourceText& source) {
    Verification out;
    for (const Expectation& e : model_.experiment.expectations) {
      add(out, source, e.span, e.text, e.claim);
      line_ = out.results.size() - 1;
      std::visit([&](const auto& kind) { decide(kind, out.results.back()); }, e.kind);
    }
    for (const FieldExpectationLine& e : equations_.model->expectations) {
      add(out, source, e.span, e.text, false);
      line_ = out.results.size() - 1;
      std::visit([&](const auto& kind) { decide(kind, out.results.back()); }, e.kind);
    }
    carry_out_run(out);
    judge_rests(equations_, at_rest_, out);
    std::stable_sort(out.results.begin(), out.results.end(),
                     [](const auto& a, const auto& b) { return a.line < b.line; });
    return out;
  }

 private:
  static void add(Verification& out, const SourceText& source, Span span, const std::string& text, bool claim) {
    ExpectationResult result;
    result.line = source.locate(span.begin).line;
    result.text = text;
    result.claim = claim;
    out.results.push_back(std::move(result));
  }

  std::string text_of(Expr e) const {
    return to_plain(field_layout(s_, lay_out(readable(e, equations_.order), equations_.order)));
  }

  template <class Kind>
  void decide(const Kind&, ExpectationResult& result) {
    result.message = "Not supported yet for fields.";
  }
  void decide(const expectation::Frequencies& e, ExpectationResult& result) {
    result.message =
        fmt::format("Frequencies of a model with fields are those of a field: write `expect frequencies of {} : …`{}.",
                    s_.fields[equations_.varied.front()].name,
                    e.squared ? ", the frequencies themselves and not their squares" : "");
  }
  void decide(const expectation::Error& e, ExpectationResult& result) {
    result.expected = "error " + e.code;
    result.actual = "no error";
    result.message = "The model has no mistake that gives this error.";
  }
  void decide(const expectation::Equation& e, ExpectationResult& result) {
    if (const auto row = row_of_bodies(equations_, e.left - e.right)) {
      result.passed = *row;
      result.message = *row ? "It is a condition or an equation of the coordinates of this model."
                            : "It is none of the conditions and equations of the coordinates, up to a factor.";
      return;
    }
    if (!shell_.complete()) {
      result.message = "An equation cannot be solved for a derivative of its own.";
      return;
    }
    const auto rest = shell_.reduced(expand_time_derivatives(e.left - e.right));
    if (!rest) {
      result.message = "It could not be decided: derivatives come up without end.";
      return;
    }
    say(result, zero_test(*rest), "It follows from the field equations.",
        "It does not follow from the field equations.");
    if (result.passed) return;
    result.expected = "0";
    result.actual = text_of(*rest);
  }

  /// Whether `c` is a natural condition up to a factor that no field stands in.
  bool is_multiple(Expr c, Expr natural) const {
    c = s_.expanded(expand_time_derivatives(c)), natural = s_.expanded(natural);
    for (const Expr& jet : s_.jets_in(natural)) {
      const Expr slope = differentiate(natural, jet), other = differentiate(c, jet);
      if (slope.is_zero() || zero_test(other).verdict == Verdict::Zero) continue;
      if (!s_.jets_in(readable(other / slope, equations_.order).value).empty()) continue;
      if (zero_test(c * slope - natural * other).verdict == Verdict::Zero) return true;
    }
    return false;
  }
  void decide(const fe::Natural& e, ExpectationResult& result) {
    const std::vector<NaturalAtEnds> natural = natural_at_ends(equations_);
    for (const Expr& c : e.conditions) {
      const bool found =
          std::any_of(natural.begin(), natural.end(), [&](const NaturalAtEnds& n) { return is_multiple(c, n.value); });
      if (found) continue;
      result.actual = text_of(c) + " = 0 is none of";
      for (const NaturalAtEnds& n : natural)
        result.expected += (result.expected.empty() ? "" : "; ") + text_of(n.value) + " = 0";
      result.message = "The natural conditions are those that the variation leaves at a free end.";
      return;
    }
    result.passed = true;
    result.message = "The variation leaves these conditions at a free end.";
  }

  // ------------------------------------------------------------------------------------------------------ the run

  double number_of(Expr e) const {
    if (!e) return 0;
    Bindings values;
    for (const Parameter& p : equations_.model->parameters) values[p.symbol] = p.si_value;
    return evaluate(s_.expanded(e), values);
  }
  /// Where nothing moves, a value without a time is that of the rest.
  void ask(const FieldQuestion& question, Expr time, const expectation::Number& expected, ExpectationResult& result) {
    if (!rests_) {
      questions_.push_back({s_.expanded(question.value), question.total, number_of(time)});
      asked_.push_back({line_, expected});
    } else if (time) {
      result.actual = "no value";
      result.message = nothing_moves_here;
    } else {
      at_rest_.push_back({line_, {question}, {{"", given(expected)}}, ""});
    }
  }
  void decide(const expectation::ValueAt& e, ExpectationResult& r) { ask({e.subject}, e.time, e.expected, r); }
  void decide(const fe::Total& e, ExpectationResult& r) {
    if (e.at_equilibrium)
      at_rest_.push_back({line_, {{e.density, true}}, {{"", given(e.expected)}}, ""});
    else
      ask({e.density, true}, e.time, e.expected, r);
  }
  void decide(const fe::Equilibrium& e, ExpectationResult&) {
    AskedRest asked{line_, {}, {}, e.word};
    for (const fe::Equilibrium::Place& place : e.places) {
      asked.questions.push_back({place.subject});
      asked.expected.push_back({place.name, given(place.expected)});
    }
    at_rest_.push_back(std::move(asked));
  }
  GivenValue given(const expectation::Number& e) const {
    const double expected = number_of(e.value);
    return {expected, allowed(e.tolerance, expected), e.unit};
  }
  void decide(const expectation::EnergyConserved& e, ExpectationResult&) { energy_.push_back({line_, e.tolerance}); }
  void decide(const expectation::Event& e, ExpectationResult&) { moments_.push_back({line_, &e}); }
  void decide(const expectation::EventCount& e, ExpectationResult&) { counts_.push_back({line_, &e}); }

  void decide(const fe::Frequencies& e, ExpectationResult& r) {
    const FieldModes modes = field_modes(equations_, e.values.size(), diagnostics_);
    const std::vector<double>& found = modes.frequencies;
    r.passed = found.size() == e.values.size();
    const std::string unit = e.unit.name.empty() ? " rad/s" : " " + e.unit.name;
    for (std::size_t i = 0; i < found.size(); ++i) {
      const double expected = number_of(e.values[i]);
      const bool close = std::abs(found[i] - expected) <= allowed(e.tolerance, expected);
      if (!close && r.passed)
        r.message = fmt::format("Frequency {} is off by {:.3g}{}; it is known to ± {:.1g}.", i + 1,
                                (found[i] - expected) / e.unit.factor, unit, modes.errors[i] / e.unit.factor);
      else if (close && r.message.empty() && modes.errors[i] > allowed(e.tolerance, expected))
        r.message = fmt::format(
            "Frequency {} is known to ± {:.1g}{} alone, so that the tolerance asks for more digits "
            "than there are.",
            i + 1, modes.errors[i] / e.unit.factor, unit);
      r.passed = r.passed && close;
      r.actual += fmt::format("{}{:.14g}", i ? ", " : "", found[i] / e.unit.factor);
      r.expected += fmt::format("{}{:.14g}", i ? ", " : "", expected / e.unit.factor);
    }
    r.actual += unit, r.expected += unit;
  }

  double allowed(const expectation::Tolerance& t, double size) const {
    if (!t.size) return 1e-9 * std::abs(size);
    return number_of(t.size) * (t.relative ? std::abs(size) : 1);
  }
  void say_of_run(Verification& out, const std::string& message) const {
    for (const auto& [line, expected] : asked_) out.results[line].message = message;
    for (const auto& [line, tolerance] : energy_) out.results[line].message = message;
    for (const auto& [line, moment] : moments_) out.results[line].message = message;
    for (const auto& [line, count] : counts_) out.results[line].message = message;
  }
  void carry_out_run(Verification& out) {
    if (questions_.empty() && energy_.empty() && moments_.empty() && counts_.empty()) return;
    if (rests_) return say_of_run(out, nothing_moves_here);
    FieldRunOptions options;
    options.interrupt = options_.interrupt;
    if (model_.experiment.start_time) options.begin = number_of(model_.experiment.start_time);
    options.duration = options_.duration ? *options_.duration : number_of(model_.experiment.duration);
    if (model_.experiment.output_every) options.every = number_of(model_.experiment.output_every);
    for (const FieldQuestion& q : questions_) options.duration = std::max(options.duration, q.time - options.begin);
    const auto run = runs_as_one_system(equations_) ? run_coupled(model_, equations_, questions_, options, diagnostics_)
                                                    : run_fields(equations_, questions_, options, diagnostics_);
    if (!run || !run->trouble.empty()) {
      return say_of_run(out,
                        run ? fmt::format("The run ended early: {}.", run->trouble) : "The run did not come to it.");
    }
    for (const auto& [line, moment] : moments_) judge_moment(out.results[line], *moment, run->happenings);
    for (const auto& [line, count] : counts_) judge_count(out.results[line], *count, run->happenings);
    for (std::size_t i = 0; i < asked_.size(); ++i) {
      ExpectationResult& r = out.results[asked_[i].line];
      judge(r, asked_[i].expected, run->answers[i]);
      if (questions_[i].time >= options.begin) continue;
      r.passed = false, r.actual = "no value";
      r.message = "The moment lies before the start, and fields run forwards from there.";
    }
    for (const auto& [line, tolerance] : energy_) {
      ExpectationResult& r = out.results[line];
      const double limit = tolerance.size ? number_of(tolerance.size) : 1e-12;
      r.actual =
          run->energy_drift < 0 ? "forces act: the energy is not conserved" : fmt::format("{:.3g}", run->energy_drift);
      r.expected = fmt::format("at most {:.3g} of its terms", limit);
      r.passed = run->energy_drift >= 0 && run->energy_drift <= limit;
      const double exchanged = energy_exchanged(*run);
      if (!r.passed || exchanged <= limit * std::max(std::abs(run->energy), exchanged)) continue;
      r.passed = false;
      r.message = fmt::format("Impacts, friction and contacts that move exchange {:.3g}{} along the run.", exchanged,
                              model_.system.dimensionless ? "" : " J");
    }
  }
  void judge(ExpectationResult& r, const expectation::Number& e, const FieldRunResult::Value& value) const {
    judge_field_value(r, given(e), value, "mesh and steps");
  }

  void judge_moment(ExpectationResult& r, const expectation::Event& e, const std::vector<Happening>& all) const {
    const auto found = happenings_named(all, e.name, e.change);
    if (found.size() >= static_cast<std::size_t>(e.occurrence)) {
      const Happening& h = *found[static_cast<std::size_t>(e.occurrence) - 1];
      return judge(r, e.time, {h.t, h.error});
    }
    r.actual = fmt::format("{} times", found.size());
    r.expected = fmt::format("at least {}", e.occurrence);
    r.message = fmt::format("`{}` happens {} times along the run.", happening_called(e.name, e.change), found.size());
  }
  void judge_count(ExpectationResult& r, const expectation::EventCount& e, const std::vector<Happening>& all) const {
    const double found = static_cast<double>(happenings_named(all, e.name, e.change).size());
    const double expected = number_of(e.number);
    r.actual = fmt::format("{:g}", found), r.expected = fmt::format("{:g}", expected);
    r.passed = found == expected;
    r.message = fmt::format("`{}` happens {:g} times along the run.", happening_called(e.name, e.change), found);
    const bool known = std::all_of(all.begin(), all.end(), [](const Happening& h) { return std::isfinite(h.error); });
    if (known) return;
    r.passed = false;
    r.message = fmt::format("`{}` happens {:g} times on this mesh; on half its cells the run takes another course.",
                            happening_called(e.name, e.change), found);
  }

  // ---------------------------------------------------------------------------------------------------- solutions

  Expr inserted(Expr residual, const fe::Solution& e) const {
    ExprMap map;
    for (const Expr& symbol : s_.jets_in(residual)) {
      const FieldJet jet = *s_.jet_of(symbol);
      const auto at = std::find(e.fields.begin(), e.fields.end(), jet.field);
      Expr value = at == e.fields.end() ? s_.fields[jet.field].formula
                                        : e.values[static_cast<std::size_t>(at - e.fields.begin())];
      if (!value) continue;
      for (std::size_t x = 0; x < s_.space.size(); ++x)
        for (int k = 0; k < jet.space[x]; ++k) value = differentiate(value, s_.space[x].symbol);
      for (int k = 0; k < jet.time; ++k) value = differentiate(value, s_.context->time());
      map[symbol] = value;
    }
    return s_.expanded(substitute(s_.expanded(residual), map));
  }
  static constexpr int looks = 600;
  /// The largest residual at random places and times of the model's run (of half a second to one and a half where it
  /// has none), as a part of the largest of its terms; −1: nowhere defined.
  double largest_residual(const fe::Solution& e) const {
    std::vector<std::vector<Expr>> residuals;  // term by term
    for (const Expr& written : equations_.residuals) {
      const Expr flat = expand(s_.expanded(written));
      const Expr r = flat ? flat : s_.expanded(written);
      residuals.emplace_back();
      for (std::size_t i = 0; r.is(Kind::Sum) && i < r.size(); ++i) residuals.back().push_back(inserted(r[i], e));
      if (residuals.back().empty()) residuals.back().push_back(inserted(r, e));
    }
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> unit(0, 1);
    Bindings values;
    for (const Parameter& p : equations_.model->parameters) values[p.symbol] = p.si_value;
    const Experiment& run = model_.experiment;
    const double begin = run.start_time ? number_of(run.start_time) : 0;
    const double duration = options_.duration ? *options_.duration : run.duration ? number_of(run.duration) : 0;
    double worst = -1;
    for (int point = 0; point < looks; ++point) {
      values[s_.context->time()] =
          duration > 0 && point % 2 == 0 ? begin + duration * unit(random) : 0.5 + unit(random);
      for (const SpaceVariable& x : s_.space)
        values[x.symbol] =
            x.from ? evaluate(s_.expanded(x.from), values) +
                         (evaluate(s_.expanded(x.to), values) - evaluate(s_.expanded(x.from), values)) * unit(random)
                   : 2 * unit(random) - 1;
      for (const std::vector<Expr>& terms : residuals) {
        double size = 1e-300, value = 0;
        for (const Expr& term : terms) {
          const double one = evaluate(term, values);
          value += one;
          size = std::max(size, std::abs(one));
        }
        if (std::isfinite(value)) worst = std::max(worst, std::abs(value) / size);
      }
    }
    return worst;
  }
  /// With the parameters' exact values.
  std::vector<Expr> at_values_of_the_model(const std::vector<Expr>& residuals) const {
    ExprMap values;
    for (const Parameter& p : equations_.model->parameters) values.emplace(p.symbol, p.value);
    return substitute(residuals, values);
  }
  void decide_at_values(const ZeroTest& test, ExpectationResult& result) const {
    result.passed = test.verdict == Verdict::Zero;
    result.message = result.passed ? "It solves the field equations at the values of the model."
                                   : "It does not solve the field equations.";
    if (result.passed) return;
    result.expected = "residual 0";
    result.actual = test.witness.empty()
                        ? "another function"
                        : fmt::format("{:.2g} at {} (SI)", test.witness_value, place_text(test.witness));
  }
  /// t and the places of a point, as x = 1.2, t = 3.4.
  std::string place_text(const Bindings& point) const {
    std::string out;
    const auto add = [&](Expr symbol) {
      const auto found = point.find(symbol);
      if (found == point.end()) return;
      out += fmt::format("{}{} = {:.3g}", out.empty() ? "" : ", ", symbol.name(), found->second);
    };
    for (const SpaceVariable& x : s_.space) add(x.symbol);
    add(s_.context->time());
    return out;
  }
  void decide(const fe::Solution& e, ExpectationResult& result) {
    std::vector<Expr> residuals;
    for (const Expr& r : equations_.residuals) residuals.push_back(inserted(r, e));
    const ZeroTest test = zero_test(residuals);
    if (test.verdict == Verdict::Zero) {
      result.passed = true;
      result.message = "It solves the field equations identically.";
      return;
    }
    if (const ZeroTest here = zero_test(at_values_of_the_model(residuals)); here.verdict != Verdict::Undecided)
      return decide_at_values(here, result);
    const double worst = largest_residual(e);
    result.expected = "residual below 1e-11 of its terms";
    result.actual = worst < 0 ? "nothing" : fmt::format("{:.2g} of the largest term", worst);
    result.passed = worst >= 0 && worst < 1e-11;
    result.message =
        result.passed
            ? fmt::format("Inserted at {} random places it leaves at most {:.1g} of its terms; no identity is proved.",
                          looks, worst)
            : "It does not solve the field equations.";
  }

  void decide(const fe::Current& e, ExpectationResult& result) {
    std::string trouble;
    result.passed = is_current(equations_, e.density, e.fluxes, trouble);
    result.message = trouble;
  }

  void decide(const fe::Dispersion& e, ExpectationResult& result) {
    std::string trouble;
    const auto relation = dispersion(equations_, trouble);
    if (!relation) {
      result.message = trouble;
      return;
    }
    const Expr omega = equations_.model->omega;
    const PowerOf left = split_power(e.left);
    const Expr roots[] = {e.right};
    const std::vector<Expr> below = symbols_of(roots);
    if (left.base != omega || left.exponent == Rational(0) ||
        std::find(below.begin(), below.end(), omega) != below.end())
      return decide_implicit(s_.expanded(e.left - e.right), *relation, result);
    const Expr root = pow(e.right, Rational(1) / left.exponent);
    std::vector<Expr> parts;
    for (const Expr& part : {relation->re, relation->im})
      parts.push_back(s_.expanded(substitute(part, {{omega, root}})));
    say(result, zero_test(parts), "Waves of the linearized equations obey it.",
        "Waves of the linearized equations do not obey it.");
    if (!result.passed)
      result.actual = to_plain(lay_out(readable(relation->re, equations_.order), equations_.order)) + " = 0";
    if (!result.passed)
      result.expected = to_plain(lay_out(readable(e.left - e.right, equations_.order), equations_.order)) + " = 0";
  }

  /// A relation that is not solved for ω: each of its roots ω is one of the equations.
  void decide_implicit(Expr written, const ComplexExpr& relation, ExpectationResult& result) {
    const Expr whole = s_.expanded(relation.re.is_zero() ? relation.im : relation.re);
    const bool complex = !relation.re.is_zero() && !relation.im.is_zero();
    const auto rest = complex ? std::nullopt : remainder_of_division(whole, written, equations_.model->omega);
    if (!rest) {
      result.message = complex ? "Waves decay or grow: the relation is complex, and is compared solved for ω alone."
                               : "A relation that is not solved for ω is a polynomial in it, and holds it.";
      return;
    }
    say(result, zero_test(*rest), "Waves of the linearized equations obey it.",
        "Waves of the linearized equations do not obey it.");
    if (result.passed) return;
    result.actual = to_plain(lay_out(readable(whole, equations_.order), equations_.order)) + " = 0";
    result.expected = to_plain(lay_out(readable(written, equations_.order), equations_.order)) + " = 0";
  }

  const Model& model_;
  const FieldEquations& equations_;
  const FieldSystem& s_;
  OnShell shell_;
  const SimulationOptions& options_;
  Diagnostics& diagnostics_;
  struct Asked {
    std::size_t line = 0;
    expectation::Number expected;
  };
  struct AskedEnergy {
    std::size_t line = 0;
    expectation::Tolerance tolerance;
  };
  std::size_t line_ = 0;
  std::vector<FieldQuestion> questions_;
  std::vector<Asked> asked_;
  std::vector<AskedEnergy> energy_;
  std::vector<AskedRest> at_rest_;
  const bool rests_ = nothing_moves(equations_);
  std::vector<std::pair<std::size_t, const expectation::Event*>> moments_;  // line of each
  std::vector<std::pair<std::size_t, const expectation::EventCount*>> counts_;
};

}  // namespace

Verification verify_fields(const Model& model, const FieldEquations& equations, const SourceText& source,
                           const SimulationOptions& options, Diagnostics& diagnostics) {
  return FieldVerifier(model, equations, options, diagnostics).carry_out(source);
}

bool is_current(const FieldEquations& equations, Expr density, const std::vector<Expr>& fluxes, std::string& trouble) {
  const FieldSystem& s = equations.system();
  std::vector<Expr> parts{s.total_derivative(s.expanded(density), s.space.size())};
  for (std::size_t x = 0; x < fluxes.size(); ++x) parts.push_back(s.total_derivative(s.expanded(fluxes[x]), x));
  const Expr divergence = s.context->sum(parts);
  const OnShell shell(equations);
  const auto rest = shell.complete() ? shell.reduced(divergence) : std::nullopt;
  if (!rest) {
    trouble = "It could not be decided: the equations cannot be solved for derivatives of their own.";
    return false;
  }
  const ZeroTest test = zero_test(*rest);
  if (test.verdict != Verdict::Zero) {
    trouble = test.verdict == Verdict::Nonzero ? "Its divergence does not vanish on solutions."
                                               : "It could not be decided: " + test.reason;
    return false;
  }
  trouble = "Its divergence vanishes on all solutions.";
  // ∂·j = Q·E with Q of the coefficients of the derivatives that the equations are solved for.
  Expr difference = divergence;
  std::string q;
  for (std::size_t a = 0; a < equations.varied.size(); ++a) {
    const Expr factor = differentiate(divergence, shell.leading(a)) / shell.coefficient(a);
    difference = difference - factor * s.expanded(equations.residuals[a]);
    q += (a ? ", " : "") + to_plain(field_layout(s, lay_out(readable(-factor, equations.order), equations.order)));
  }
  const bool forces = s.dissipation ||
                      std::any_of(s.forces.begin(), s.forces.end(), [](const Expr& f) { return static_cast<bool>(f); });
  if (!forces && zero_test(difference).verdict == Verdict::Zero) trouble = "∂_μ j^μ = Q·E identically, Q = " + q + ".";
  return true;
}

}  // namespace maupertuis
