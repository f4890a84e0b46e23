#include <maupertuis/degenerate.hpp>
#include <maupertuis/print.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace maupertuis {
namespace {

constexpr std::size_t longest_line = 100;
constexpr std::size_t most_parameters = 8;  // that are moved one by one to see which of them has a special value

std::string joined(const std::vector<std::string>& parts, const char* last = " and ") {
  std::string out;
  for (std::size_t i = 0; i < parts.size(); ++i) out += (i == 0 ? "" : i + 1 == parts.size() ? last : ", ") + parts[i];
  return out;
}

std::string count(std::size_t number, const char* what) {
  return fmt::format("{} {}{}", number, what, number == 1 ? "" : "s");
}

class Messages {
 public:
  Messages(const Model& model, const EquationsOfMotion& equations, const DegenerateAnalysis& analysis,
           Diagnostics& diagnostics)
      : model_(model),
        equations_(equations),
        analysis_(analysis),
        diagnostics_(diagnostics),
        start_(written_start(model)) {}

  bool tell() {
    using Outcome = ConstraintChain::Outcome;
    if (!gauges()) return false;
    if (analysis_.chain.outcome == Outcome::Contradiction) return contradiction();
    if (analysis_.chain.outcome == Outcome::Unreached) return unreached();
    if (analysis_.chain.outcome == Outcome::Varies) return varies();
    if (analysis_.free.empty())
      degenerate();
    else
      free_functions();
    branches();
    special_values();
    return true;
  }

 private:
  const MechanicalSystem& system() const { return model_.system; }

  Span place() const {
    if (system().lagrangian_given) return system().lagrangian_given->span;
    for (std::size_t i = 0; i < system().coordinates.size(); ++i)
      if (has_no_inertia(i)) return system().coordinates[i].span;
    return system().kinetic.empty() ? system().coordinates.front().span : system().kinetic.front().span;
  }

  bool has_no_inertia(std::size_t i) const {
    const Expr momentum = equations_.momenta[i];
    for (const Coordinate& c : system().coordinates)
      if (!differentiate(momentum, c.velocity).is_zero()) return false;
    return true;
  }

  std::string line(const FoundConstraint& c) const {
    const std::string text = to_plain(c.value, equations_.order);
    return text.size() <= longest_line ? text + " = 0" : std::string("a long condition");
  }

  bool contradiction() {
    const FoundConstraint& last = analysis_.chain.constraints.back();
    const std::string from =
        last.generation == 1 ? std::string("a combination of Lagrange's equations without accelerations")
                             : fmt::format("the derivatives of the constraints of generation {}", last.generation - 1);
    diagnostics_.error("E0623", place(), fmt::format("no motion obeys this Lagrangian: {}", line(last)),
                       fmt::format("That follows from {}, whatever the state is.", from),
                       "Check L for a missing kinetic energy or a potential without equilibrium.");
    return false;
  }

  bool start_fulfils_all() const {
    MotionState state;
    for (const Coordinate& c : system().coordinates)
      state.q.push_back(start_.at(c.q)), state.v.push_back(start_.at(c.velocity));
    state.t = start_.at(system().context->time());
    return !analysis_.chain.constraints.empty() && StateRelations(equations_, analysis_).hold(state);
  }

  bool not_regular(const std::vector<std::string>& lines) {
    diagnostics_.error(
        "E0635", place(), "the start fulfils " + joined(lines) + ", which are not regular there",
        "Their gradients vanish or depend on each other at it, as that of x² = 0 does at x = 0: no state "
        "beside it was found by which ranks could be told.",
        "Write the term of L so that its derivative has a simple zero, x in the place of x²; or start "
        "on one branch, away from the others.");
    return false;
  }

  bool unreached() {
    const std::vector<std::string> lines = constraint_lines(analysis_, equations_.order, false);
    if (start_fulfils_all()) return not_regular(lines);
    diagnostics_.error("E0624", place(),
                       lines.empty() ? std::string("no state near the start lies where this Lagrangian is defined")
                                     : "no state near the start fulfils " + joined(lines),
                       "A degenerate Lagrangian asks this of every state of a motion.",
                       "Give a start near a state that fulfils it.");
    return false;
  }

  bool varies() {
    if (analysis_.chain.varying.is_number()) return lost_in_rounding();
    const std::string text = to_plain(analysis_.chain.varying, equations_.order);
    diagnostics_.error(
        "E0633", place(), "this Lagrangian is degenerate in one region and of another class elsewhere",
        fmt::format("{} is 0, or next to nothing, near the start and something else beyond. There the equations hold "
                    "another acceleration, and the constraints of the one region are wrong in the other.",
                    text.size() <= longest_line ? text : std::string("A coefficient of an acceleration")),
        "Let an inertia act everywhere, or leave it out.");
    return false;
  }

  /// A row with a number in it that is next to nothing beside the others.
  bool lost_in_rounding() {
    diagnostics_.error(
        "E0633", place(), "the constraints of this degenerate Lagrangian cannot be told from rounding",
        "Coefficients of its higher constraints differ by more than 10¹²: in numbers it is not seen which "
        "of them vanish.",
        "Where a coordinate is a multiplier, as z in z (y - x), write `constraint y = x` in its place.");
    return false;
  }

  /// False where a gauge excludes motions.
  bool gauges() {
    if (analysis_.gauges == 0) return true;
    Bindings center = generic_state(model_);
    const DegenerateAnalysis open = analyse_degenerate(equations_, center, false, true, &start_);
    const Gauge& first = system().gauges.front();
    if (open.closed() && open.free.empty()) {
      diagnostics_.error("E0625", first.span, "there is nothing for a gauge to fix",
                         "The equations determine every acceleration.",
                         "Leave it out; `constraint` holds a relation with a force.");
      return false;
    }
    if (!open.closed()) return true;
    for (const Gauge& gauge : system().gauges)
      if (open.is_determined(gauge.value)) return fixes_too_much(gauge);
    if (analysis_.closed() && analysis_.motions >= open.motions) return true;
    return one_by_one(open);
  }

  /// The first gauge that, beside those above it, excludes motions. True where none does.
  bool one_by_one(const DegenerateAnalysis& open) {
    const auto& all = system().gauges;
    std::vector<std::size_t> before;
    for (std::size_t k = 0; k < all.size(); ++k) {
      std::vector<std::size_t> with_it = before;
      with_it.push_back(k);
      if (excludes_motions(with_it, open)) {
        if (before.empty()) return excludes_motions_by_itself(all[k]);
        // One of them may be enough for the clash.
        for (const std::size_t j : before)
          if (excludes_motions({j, k}, open)) return one_too_many({j}, k);
        return one_too_many(before, k);
      }
      before = std::move(with_it);
    }
    return true;
  }

  DegenerateAnalysis with_gauges(const std::vector<std::size_t>& chosen) const {
    auto fewer = std::make_shared<MechanicalSystem>(*equations_.system);
    fewer->gauges.clear();
    for (const std::size_t k : chosen) fewer->gauges.push_back(system().gauges[k]);
    EquationsOfMotion equations = equations_;
    equations.system = std::move(fewer);
    return analyse_degenerate(equations, generic_state(model_), true, true, &start_);
  }

  bool excludes_motions(const std::vector<std::size_t>& gauges, const DegenerateAnalysis& open) const {
    using Outcome = ConstraintChain::Outcome;
    const DegenerateAnalysis found = with_gauges(gauges);
    if (found.closed()) return found.motions < open.motions;
    return found.chain.outcome == Outcome::Contradiction || found.chain.outcome == Outcome::Unreached;
  }

  /// A gauge of its own that no state near the start fulfils is told as such a relation.
  bool excludes_motions_by_itself(const Gauge& gauge) {
    return analysis_.chain.outcome == ConstraintChain::Outcome::Unreached || fixes_too_much(gauge);
  }

  bool one_too_many(const std::vector<std::size_t>& before, std::size_t k) {
    std::vector<std::string> texts;
    for (const std::size_t j : before) texts.push_back("`" + system().gauges[j].text + "`");
    diagnostics_.error("E0626", system().gauges[k].span,
                       fmt::format("this gauge is one too many beside {}", joined(texts)),
                       fmt::format("{} what is free of this already; both together exclude motions, or have none.",
                                   texts.size() == 1 ? texts.front() + " chooses" : "They choose"),
                       "Leave one of them out; where more functions are free, choose another one of them.");
    return false;
  }

  bool fixes_too_much(const Gauge& gauge) {
    diagnostics_.error("E0626", gauge.span, "this gauge excludes motions",
                       "It says something about a quantity that does not depend on the free functions.",
                       "Ask for something that the free functions can bring about.");
    return false;
  }

  /// "Every state of a motion has z = 0; 2 numbers single out a motion."
  std::string asked_of_states() const {
    const std::vector<std::string> lines = constraint_lines(analysis_, equations_.order, false);
    std::string asked = lines.empty()       ? std::string("Nothing is asked of the state")
                        : lines.size() <= 3 ? "Every state of a motion has " + joined(lines)
                                            : "Every state of a motion fulfils " + count(lines.size(), "constraint");
    if (analysis_.motions == 0)
      return asked + (analysis_.free.empty() ? "; that leaves one motion." : "; motions differ by what is free alone.");
    asked += fmt::format("; {} single{} out a motion.", count(analysis_.motions, "number"),
                         analysis_.motions == 1 ? "s" : "");
    return asked;
  }

  /// "the Lagrangian holds q''": its order, and what a run carries for it.
  void higher() {
    const auto& all = system().coordinates;
    std::vector<std::string> names, rates;
    for (const HigherDerivative& h : system().higher) {
      names.push_back(fmt::format("{}''", all[h.coordinate].name));
      rates.push_back(
          fmt::format("{} = {}' and its momentum {}", all[h.rate].name, all[h.coordinate].name, all[h.momentum].name));
    }
    diagnostics_.note(
        "N0632", place(), "the Lagrangian holds " + joined(names),
        fmt::format("{} of order {}: {} single{} out a motion.",
                    all.size() == 3 ? "The equation of motion is" : "The equations of motion are together",
                    analysis_.motions, count(analysis_.motions, "number"), analysis_.motions == 1 ? "s" : ""),
        fmt::format("A run carries {}.", joined(rates)));
  }

  void degenerate() {
    if (!system().higher.empty()) return higher();
    std::vector<std::string> massless;
    for (std::size_t i = 0; i < system().coordinates.size(); ++i)
      if (has_no_inertia(i)) massless.push_back("`" + system().coordinates[i].name + "`");
    const std::string asked = asked_of_states();
    if (system().lagrangian_given || massless.empty()) {
      diagnostics_.note("N0620", place(), "the Lagrangian is degenerate", asked, "");
      return;
    }
    diagnostics_.warning("W0621", place(),
                         fmt::format("the coordinate{} {} {} no kinetic energy", massless.size() == 1 ? "" : "s",
                                     joined(massless), massless.size() == 1 ? "has" : "have"),
                         asked, "If a mass was forgotten, give it; else this is as it should be.");
  }

  /// N0634: what is told and run is so on one branch.
  void branches() {
    for (const BranchChoice& b : analysis_.chain.branches) {
      const std::string kept = to_plain(b.kept, equations_.order) + " = 0";
      diagnostics_.note(
          "N0634", place(),
          fmt::format("{} = 0 has several branches, and this is {}", to_plain(b.product, equations_.order), kept),
          b.start_meets ? "The start lies where branches meet: motions may go on along another one, which is not told."
          : b.at_start  ? "The start lies on it. On the others a motion obeys other equations, which are not told."
                        : "It is the one that was found next to the start. On the others a motion obeys other "
                          "equations, which are not told.",
          "A start on another branch is a question about that branch.");
    }
  }

  void free_functions() {
    if (analysis_.free.empty()) return;
    std::vector<std::string> names;
    for (const std::size_t i : analysis_.free) names.push_back(system().coordinates[i].name + "(t)");
    const bool chosen = analysis_.gauges > 0;
    diagnostics_.warning(
        chosen ? "W0627" : "W0622", chosen ? system().gauges.front().span : place(),
        fmt::format("{} free: {} may be any function{}",
                    analysis_.free.size() == 1 ? "one function of time is"
                                               : count(analysis_.free.size(), "function") + " of time are",
                    joined(names), names.size() == 1 ? "" : "s"),
        asked_of_states() + " No equation gives the accelerations of what is free: what depends on it has no value.",
        "`gauge EXPR = EXPR` makes a choice; without one a run shows what does not depend on it.");
  }

  /// Whether the class is that of general values of the parameters, and if not, which of them is special.
  void special_values() {
    const Bindings center = generic_state(model_);
    const DegenerateAnalysis general = analyse_degenerate(equations_, center, analysis_.gauges > 0, false, &start_);
    if (!general.closed() || same_class(general)) return;
    std::vector<std::string> special;
    for (const Parameter& p : system().parameters) {
      if (!p.used || p.si_value == 0 || system().parameters.size() > most_parameters) continue;
      Bindings moved = center;
      moved[p.symbol] *= 1.0078125;
      const DegenerateAnalysis other = analyse_degenerate(equations_, moved, analysis_.gauges > 0, true, &start_);
      if (other.closed() && !same_class(other)) special.push_back(fmt::format("{} = {:g}", p.name, p.si_value));
    }
    diagnostics_.note("N0628", place(),
                      special.empty()
                          ? std::string("the parameters have special values")
                          : joined(special) + (special.size() == 1 ? " is a special value" : " are special values"),
                      fmt::format("For values nearby {} single{} out a motion, and {} free.",
                                  count(general.motions, "number"), general.motions == 1 ? "s" : "",
                                  general.free.empty()       ? "no function of time is"
                                  : general.free.size() == 1 ? "one function of time is"
                                                             : count(general.free.size(), "function") + " of time are"),
                      "");
  }

  bool same_class(const DegenerateAnalysis& other) const {
    return other.free.size() == analysis_.free.size() && other.motions == analysis_.motions;
  }

  const Model& model_;
  const EquationsOfMotion& equations_;
  const DegenerateAnalysis& analysis_;
  Diagnostics& diagnostics_;
  Bindings start_;
};

}  // namespace

std::vector<std::string> constraint_lines(const DegenerateAnalysis& analysis, const ReadingOrder& order,
                                          bool with_derivatives) {
  std::vector<std::string> out;
  for (const FoundConstraint& c : analysis.chain.constraints) {
    if (c.follows && !with_derivatives) continue;
    const std::string text = to_plain(c.value, order);
    out.push_back(text.size() <= longest_line ? text + " = 0" : std::string("a long condition"));
  }
  return out;
}

bool report_degenerate(const Model& model, const EquationsOfMotion& equations, const DegenerateAnalysis& analysis,
                       Diagnostics& diagnostics) {
  return Messages(model, equations, analysis, diagnostics).tell();
}

}  // namespace maupertuis
