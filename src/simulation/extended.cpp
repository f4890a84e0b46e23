#include <maupertuis/degenerate.hpp>
#include <maupertuis/expression_lock.hpp>
#include "simulation/ending.hpp"
#include "simulation/extended_problem.hpp"
#include "simulation/mode_remarks.hpp"
#include "simulation/sets_together.hpp"
#include "simulation/stopwatch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

/// A run in many digits: the exact plan, the run, a companion of other order and other last bits, the check run with a
/// wider mantissa, and what all agree on.
namespace maupertuis {
namespace {

struct Level {
  Mantissa mantissa, check;
  int digits;
  double log2_tolerance;

  int bits() const { return bits_of(compiled_mantissa(mantissa)); }
  int check_bits() const { return bits_of(compiled_mantissa(check)); }
};

Level level_of(Precision precision) {
  if (precision == Precision::Quad) return {Mantissa::Bits113, Mantissa::Bits192, 33, log2_rounding(Mantissa::Bits113)};
  return {Mantissa::Bits384, Mantissa::Bits448, 100, -105 * std::log2(10.0)};
}

bool has_method(const Model& model, const ExtendedSimulationOptions& options, Diagnostics& diagnostics) {
  const StepMethod method = options.method.value_or(model.experiment.method.value_or(MethodChoice{}).method);
  if (method == StepMethod::Automatic || method == StepMethod::Taylor) return true;
  diagnostics.error(
      "E0725", std::nullopt,
      fmt::format("the {} method calculates in double alone", method == StepMethod::Stiff ? "stiff" : "variational"),
      "Its order is bounded, so that a hundred digits would cost more steps than anyone can wait for.",
      "Take --method taylor, or leave it out.");
  return false;
}

Happening::Kind kind_of(ExtendedRoot::Kind kind) {
  switch (kind) {
    case ExtendedRoot::Kind::Impact:
      return Happening::Kind::Impact;
    case ExtendedRoot::Kind::Made:
      return Happening::Kind::Made;
    case ExtendedRoot::Kind::Lost:
      return Happening::Kind::Lost;
    case ExtendedRoot::Kind::Stick:
      return Happening::Kind::Stick;
    case ExtendedRoot::Kind::Slip:
      return Happening::Kind::Slip;
    case ExtendedRoot::Kind::Event:
      break;
  }
  return Happening::Kind::Event;
}

class ExtendedRun {
 public:
  ExtendedRun(const Model& model, const EquationsOfMotion& equations, const ExtendedSimulationOptions& options,
              ExtendedPlan plan, const Observables& observables)
      : model_(model),
        system_(*equations.system),
        options_(options),
        plan_(std::move(plan)),
        observables_(observables),
        level_(level_of(options.precision)) {
    settings_.log2_tolerance = options.tolerance > 0 ? std::log2(options.tolerance) : level_.log2_tolerance;
    settings_.log2_tolerance = std::max(settings_.log2_tolerance, log2_rounding(level_.mantissa));
    const MethodChoice choice = model.experiment.method.value_or(MethodChoice{});
    settings_.order = options.order == 0 && choice.method == StepMethod::Taylor ? choice.order : options.order;
    settings_.maximum_steps = options.maximum_steps;
    settings_.interrupt = options.interrupt;
  }

  ExtendedResult carry_out() {
    name_columns();
    auto begin = Clock::now();
    if (options_.progress) settings_.progress = [this](double fraction) { options_.progress(0.28 * fraction); };
    const ExtendedMotion rough = run_extended(plan_.problem, level_.mantissa, settings_);
    out_.statistics = {
        rough.steps, 0, rough.switches, rough.order, 0, level_.bits(), level_.check_bits(), seconds_since(begin), 0, 0,
        0,           0};
    tell_ending(rough);
    out_.at.resize(options_.at.size());
    for (std::size_t i = 0; i < out_.at.size(); ++i)  // also where it is not reached
      out_.at[i].t.text = fmt::format("{}", options_.at[i].to_double());
    if (out_.ending == Ending::Interrupted) keep_without_digits(rough);
    if (out_.ending == Ending::Interrupted || !rough.final.reached) return std::move(out_);
    end_with(rough);
    begin = Clock::now();
    const ExtendedMotion companion = companion_run(rough);
    out_.statistics.companion_steps = companion.steps;
    out_.statistics.companion_order = companion.order;
    out_.statistics.companion_seconds = seconds_since(begin);
    begin = Clock::now();
    const ExtendedMotion fine = check_run(rough);
    out_.statistics.check_steps = fine.steps;
    out_.statistics.check_order = fine.order;
    out_.statistics.check_seconds = seconds_since(begin);
    compare(rough, companion, fine);
    return std::move(out_);
  }

  /// The contact at which the motion cannot go on, if it is one.
  std::optional<Span> ended_by() const { return ended_by_; }

 private:
  /// States that were asked for and reached: how many of their digits are right is not known.
  void keep_without_digits(const ExtendedMotion& rough) {
    for (std::size_t i = 0; i < rough.at.size(); ++i)
      if (rough.at[i].reached) out_.at[plan_.order_of_times[i]] = as_it_is(rough.at[i]);
  }

  ExtendedState as_it_is(const ExtendedSample& s) const {
    constexpr int shown = 17;
    const auto open = [](AgreedNumber& x) { x.digits = 0; };
    ExtendedState out = agreed({s, s, s}, shown);
    out.compared = false;
    for (std::vector<AgreedNumber>* values : {&out.q, &out.v, &out.points, &out.reactions})
      std::for_each(values->begin(), values->end(), open);
    open(out.energy);
    return out;
  }

  /// Where the first run could not go on, the others end at the same time.
  void end_with(const ExtendedMotion& rough) {
    if (rough.ending == StepEnding::None) return;
    plan_.numbers[plan_.end_index] = system_.context->number(*Rational::parse(rough.final.t));
    plan_.problem.numbers = kernel_of_numbers(plan_.numbers);
  }

  /// Parameters and start values that have no end in binary, one unit of the last place of the run up or down.
  std::vector<Expr> nudged_numbers() const {
    std::vector<Expr> out = plan_.numbers;
    std::mt19937_64 random(1744);
    const std::size_t n = system_.coordinates.size(), p = plan_.problem.kernel.parameters();
    const Expr one = system_.context->number(1), unit = pow(system_.context->number(2), Rational(1 - level_.bits()));
    const auto nudge = [&](Expr& number) {
      const Rational* const exact = number.number_or_null();
      if (exact && *exact == Rational::from_double(exact->to_double())) return;
      number = number * ((random() >> 63) != 0 ? one + unit : one - unit);
    };
    for (std::size_t i = 0; i < p; ++i) nudge(out[i]);
    for (std::size_t i = plan_.end_index + 2; i < plan_.end_index + 2 + 2 * n; ++i) nudge(out[i]);
    return out;
  }

  ExtendedMotion companion_run(const ExtendedMotion& rough) {
    ExtendedProblem problem = plan_.problem;
    problem.numbers = kernel_of_numbers(nudged_numbers());
    ExtendedOptions settings = settings_;
    settings.log2_tolerance = std::max(settings.log2_tolerance - 2 * std::log2(10.0), log2_rounding(level_.mantissa));
    settings.order = rough.order + 3;
    settings.maximum_steps = 2 * rough.steps + 1000;
    if (options_.progress) settings.progress = [this](double fraction) { options_.progress(0.28 + 0.28 * fraction); };
    return run_extended(problem, level_.mantissa, settings);
  }

  ExtendedMotion check_run(const ExtendedMotion& rough) {
    const ExtendedProblem& problem = plan_.problem;
    ExtendedOptions settings = settings_;
    settings.log2_tolerance = std::max(settings.log2_tolerance - 4 * std::log2(10.0), log2_rounding(level_.check));
    if (settings.order > 0) settings.order += 4;
    settings.maximum_steps = 2 * rough.steps + 1000;
    if (options_.progress) settings.progress = [this](double fraction) { options_.progress(0.56 + 0.44 * fraction); };
    return run_extended(problem, level_.check, settings);
  }

  bool is_stop(const ExtendedRoot& root) const {
    return root.kind == ExtendedRoot::Kind::Event &&
           plan_.problem.events[root.index].action == ExtendedEvent::Action::Stop;
  }
  /// Of the contact, the coordinate with friction, the event.
  std::string name_of(const ExtendedRoot& root) const {
    if (root.kind == ExtendedRoot::Kind::Event) return model_.experiment.events[root.index].name;
    const std::size_t contacts = system_.contacts.size();
    return root.index < contacts ? system_.contact_label(root.index) : system_.frictions[root.index - contacts].name;
  }

  std::string reason_of(const ExtendedMotion& motion) const {
    if (!motion.trouble) return motion.reason;
    return fmt::format("Contact {}: {}", system_.contact_label(*motion.trouble), motion.reason);
  }
  static double end_of(const ExtendedMotion& motion) {
    return motion.final.t.empty() ? 0 : Rational::parse(motion.final.t)->to_double();
  }

  void tell_ending(const ExtendedMotion& motion) {
    out_.ending = ending_of(motion.ending);
    out_.reason = reason_of(motion);
    if (motion.trouble) ended_by_ = system_.contacts[*motion.trouble].span;
    out_.reached = end_of(motion);
    if (motion.ending != StepEnding::None) return;
    const auto stop =
        std::find_if(motion.roots.begin(), motion.roots.end(), [&](const ExtendedRoot& r) { return is_stop(r); });
    if (motion.met && stop != motion.roots.end()) {
      out_.ending = Ending::Stopped;
      out_.reason = fmt::format("the event `{}` stopped the run", name_of(*stop));
      return;
    }
    if (!plan_.problem.until) return;
    out_.ending = motion.met ? Ending::UntilReached : Ending::UntilNotReached;
    out_.reason = motion.met ? "the condition of `run until` was met"
                             : "the condition of `run until` was not met within the time given";
  }

  void compare(const ExtendedMotion& rough, const ExtendedMotion& companion, const ExtendedMotion& fine) {
    tell_other_ending(rough, companion, "the companion of another order that tells the digits");
    tell_other_ending(rough, fine, fmt::format("the check in {} bits that tells the digits", level_.check_bits()));
    if (out_.ending == Ending::Interrupted) keep_without_digits(rough);
    for (std::size_t i = 0; i < rough.at.size(); ++i)
      if (const ExtendedState told = agreed({rough.at[i], companion.at[i], fine.at[i]}); told.reached)
        out_.at[plan_.order_of_times[i]] = told;
    if (out_.ending == Ending::Interrupted) return;
    const ExtendedState final = agreed({rough.final, companion.final, fine.final});
    const bool together = out_.ok() || final.t.digits >= digits_of_one_end;
    if (together) out_.final = final;
    add_happenings(rough, companion, fine);
    add_remarks(rough);
    const std::size_t count =
        std::min({rows_of(rough, together), rows_of(companion, together), rows_of(fine, together)});
    for (std::size_t i = 0; i < count; ++i)
      out_.rows.push_back(agreed({rough.rows[i], companion.rows[i], fine.rows[i]}));
  }

  /// Where runs that could not go on came to the same end: in a collision each stops a few roundings before it.
  static constexpr int digits_of_one_end = 6;

  /// The last row is the end of a run, which has no counterpart where the others end elsewhere.
  static std::size_t rows_of(const ExtendedMotion& motion, bool together) {
    const std::size_t count = motion.rows.size();
    return together || motion.ending == StepEnding::None || count <= 1 ? count : count - 1;
  }

  /// Digits are those on which all runs agree: one that ends elsewhere ends them all, with its reason.
  void tell_other_ending(const ExtendedMotion& rough, const ExtendedMotion& other, const std::string& name) {
    if (std::abs(end_of(other) - plan_.begin) < std::abs(out_.reached - plan_.begin)) out_.reached = end_of(other);
    const bool is_told = !out_.ok() && out_.ending != Ending::UntilNotReached;
    if (other.ending == StepEnding::Interrupted) {
      out_.ending = Ending::Interrupted, out_.reason = other.reason;
    } else if (is_told) {
      return;
    } else if (other.ending != StepEnding::None) {
      out_.ending = ending_of(other.ending);
      out_.reason = fmt::format("{} ended: {}", name, reason_of(other));
    } else if (rough.met != other.met) {
      out_.ending = Ending::NoConvergence;
      out_.reason = fmt::format("what ends it was met by {}: it is too near to being missed to be told",
                                rough.met ? "the run, and not by " + name : name + ", and not by the run");
    }
  }

  using Roots = std::array<const ExtendedRoot*, 3>;  // of the run, its companion, its check

  /// A slip that comes to 0 and goes on at once stops in one run and not in the others: it is no change of the motion.
  static std::vector<ExtendedRoot> without_stops_of_no_time(const std::vector<ExtendedRoot>& roots) {
    constexpr double one_instant = 1e-12;
    const auto time = [](const ExtendedRoot& root) { return Rational::parse(root.state.t)->to_double(); };
    std::vector<ExtendedRoot> out;
    for (const ExtendedRoot& root : roots) {
      const bool goes_on = !out.empty() && root.kind == ExtendedRoot::Kind::Slip && root.index == out.back().index &&
                           out.back().kind == ExtendedRoot::Kind::Stick &&
                           std::abs(time(root) - time(out.back())) <= one_instant * std::abs(time(root));
      if (goes_on)
        out.pop_back();
      else
        out.push_back(root);
    }
    return out;
  }

  /// As far as all meet the same in the same order. Bounces without end are cut off at heights that depend on the
  /// digits: from the first that one of them leaves out to the end of the bounces, whose time all extrapolate.
  void add_happenings(const ExtendedMotion& rough, const ExtendedMotion& companion, const ExtendedMotion& fine) {
    const std::array<std::vector<ExtendedRoot>, 3> kept{without_stops_of_no_time(rough.roots),
                                                        without_stops_of_no_time(companion.roots),
                                                        without_stops_of_no_time(fine.roots)};
    const std::array<const std::vector<ExtendedRoot>*, 3> lists{&kept[0], &kept[1], &kept[2]};
    std::array<std::size_t, 3> next{0, 0, 0};
    const auto same = [&](const Roots& roots) {
      return std::all_of(roots.begin(), roots.end(), [&](const ExtendedRoot* r) {
        return r->kind == roots[0]->kind && r->index == roots[0]->index;
      });
    };
    for (;;) {
      Roots roots{};
      for (std::size_t k = 0; k < 3; ++k)
        if (next[k] < lists[k]->size()) roots[k] = &(*lists[k])[next[k]];
      if (std::find(roots.begin(), roots.end(), nullptr) != roots.end()) return note_left_out(roots);
      bool ends = false;
      for (std::size_t k = 0; k < 3; ++k) ends = ends || ends_bounces(*lists[k], next[k]);
      if (ends) {
        for (std::size_t k = 0; k < 3; ++k)
          while (next[k] < lists[k]->size() && is_impact_on((*lists[k])[next[k]], roots[0]->index)) ++next[k];
        continue;
      }
      if (!same(roots)) return note_left_out(roots);
      add_happening(roots);
      for (std::size_t& k : next) ++k;
    }
  }

  /// What one of the runs meets next, and not all; where all have come to their ends there is nothing.
  void note_left_out(const Roots& next) {
    const auto first = std::find_if(next.begin(), next.end(), [](const ExtendedRoot* r) { return r != nullptr; });
    if (first == next.end()) return;
    out_.remarks.push_back(fmt::format(
        "From t = {:.9g} on what happens is not told: the runs that tell the digits do not all meet {} ({}) "
        "next.",
        Rational::parse((*first)->state.t)->to_double(), name_of(**first), word_of(kind_of((*first)->kind))));
  }

  std::string friction_label(std::size_t i) const {
    const std::size_t contacts = system_.contacts.size();
    return i < contacts ? system_.contact_label(i) : system_.frictions[i - contacts].name;
  }

  /// Events at one instant that set the same; forces and choices that the motion does not determine.
  void add_remarks(const ExtendedMotion& rough) {
    if (!rough.undetermined.empty()) out_.remarks.push_back(undetermined_sentence(rough.undetermined));
    if (rough.choice)
      out_.remarks.push_back(choice_sentence(friction_label(rough.choice->held), friction_label(rough.choice->slides),
                                             Rational::parse(rough.choice->t)->to_double()));
    add_sets_together(rough);
  }

  std::string undetermined_sentence(const std::vector<std::size_t>& contacts) const {
    std::vector<std::string> labels;
    for (const std::size_t c : contacts) labels.push_back(system_.contact_label(c));
    return undetermined_contacts_sentence(labels, true);
  }

  void add_sets_together(const ExtendedMotion& rough) {
    std::vector<const ModelEvent*> at_once;
    for (std::size_t i = 0; i < rough.roots.size(); ++i) {
      const ExtendedRoot& root = rough.roots[i];
      if (root.kind != ExtendedRoot::Kind::Event) continue;
      if (i > 0 && rough.roots[i - 1].state.t != root.state.t) at_once.clear();
      at_once.push_back(&model_.experiment.events[root.index]);
      const double t = Rational::parse(root.state.t)->to_double();
      const std::string told = t == plan_.begin ? std::string() : set_more_than_once(system_, at_once, t);
      if (!told.empty()) return out_.remarks.push_back(told);  // once is enough
    }
  }

  static bool is_impact_on(const ExtendedRoot& root, std::size_t contact) {
    return root.kind == ExtendedRoot::Kind::Impact && root.index == contact;
  }
  /// Whether it is the last impact on a contact that stays closed from then on.
  static bool ends_bounces(const std::vector<ExtendedRoot>& roots, std::size_t i) {
    return i + 1 < roots.size() && roots[i].kind == ExtendedRoot::Kind::Impact &&
           roots[i + 1].kind == ExtendedRoot::Kind::Made && roots[i + 1].index == roots[i].index &&
           roots[i].state.t != roots[i + 1].state.t;
  }

  void add_happening(const Roots& roots) {
    const std::size_t n = system_.coordinates.size();
    const Samples s{roots[0]->state, roots[1]->state, roots[2]->state};
    const auto number = [&](const std::string ExtendedRoot::*value) {
      return agreed(roots[0]->*value, roots[1]->*value, roots[2]->*value);
    };
    ExtendedHappening h{kind_of(roots[0]->kind),
                        name_of(*roots[0]),
                        agreed(s.rough.t, s.companion.t, s.fine.t),
                        agreed(s, &ExtendedSample::q, 0, n),
                        agreed(s, &ExtendedSample::v, 0, n),
                        {},
                        {}};
    if (h.kind == Happening::Kind::Impact)
      h.impulse = number(&ExtendedRoot::impulse), h.speed = number(&ExtendedRoot::speed);
    out_.happenings.push_back(std::move(h));
  }

  /// One state, three times.
  struct Samples {
    const ExtendedSample &rough, &companion, &fine;
  };

  /// The digits of `fine` that neither of the others contradicts.
  AgreedNumber agreed(const std::string& rough, const std::string& companion, const std::string& fine,
                      std::optional<int> most = {}) const {
    if (rough.empty() || fine.empty()) return {};
    if (companion.empty()) return {"0", 0, "more than can be told: one of them has no value here"};
    const AgreedNumber first = agreed_number(rough, fine, most.value_or(level_.digits)),
                       second = agreed_number(companion, fine, most.value_or(level_.digits));
    return first.digits <= second.digits ? first : second;
  }

  std::vector<AgreedNumber> agreed(const Samples& s, const std::vector<std::string> ExtendedSample::*values,
                                   std::size_t first, std::size_t count, std::optional<int> most = {}) const {
    std::vector<AgreedNumber> out;
    for (std::size_t i = first; i < first + count; ++i)
      out.push_back(agreed((s.rough.*values)[i], (s.companion.*values)[i], (s.fine.*values)[i], most));
    return out;
  }

  /// `most`: digits; of the precision without it.
  ExtendedState agreed(const Samples& s, std::optional<int> most = {}) const {
    ExtendedState out;
    if (!s.rough.reached || !s.companion.reached || !s.fine.reached) return out;
    const std::size_t n = s.rough.q.size();
    out.reached = out.compared = true;
    out.t = agreed(s.rough.t, s.companion.t, s.fine.t);
    out.q = agreed(s, &ExtendedSample::q, 0, n, most);
    out.v = agreed(s, &ExtendedSample::v, 0, n, most);
    out.energy = agreed(s, &ExtendedSample::observables, 0, 1, most).front();
    out.points = agreed(s, &ExtendedSample::observables, 1, plan_.points, most);
    out.reactions = agreed(s, &ExtendedSample::observables, 1 + plan_.points, plan_.reactions, most);
    for (const Observables::Dependence& d : observables_.dependences)
      if (s.rough.multipliers[d.constraint].empty())
        out.reactions[d.observable - observables_.energy_terms - plan_.points] = {};
    return out;
  }

  void name_columns() {
    Trajectory names;
    name_trajectory_columns(model_.system, observables_, names.columns, out_.reactions);
    out_.independent = {model_.system.independent, model_.system.independent_unit()};
    out_.columns = names.columns;
  }

  const Model& model_;
  const MechanicalSystem& system_;
  const ExtendedSimulationOptions& options_;
  ExtendedPlan plan_;
  const Observables& observables_;
  Level level_;
  ExtendedOptions settings_;
  ExtendedResult out_;
  std::optional<Span> ended_by_;
};

SimulationOptions in_double(const ExtendedSimulationOptions& options) {
  SimulationOptions out;
  if (options.duration) out.duration = options.duration->to_double();
  for (const Rational& t : options.at) out.at.push_back(t.to_double());
  if (options.output_every) out.output_every = options.output_every->to_double();
  return out;
}

}  // namespace

std::optional<ExtendedResult> simulate_extended(const Model& model, const EquationsOfMotion& equations,
                                                const ExtendedSimulationOptions& options, Diagnostics& diagnostics) {
  const ExpressionLock lock(*equations.system->context);
  if (refuse_free_functions(equations, "many digits", diagnostics)) return std::nullopt;
  if (equations.determined)
    return simulate_extended(with_determined_system(model, equations), *equations.determined, options, diagnostics);
  if (!has_method(model, options, diagnostics) || !goes_in_many_digits(model, equations, diagnostics))
    return std::nullopt;
  const SimulationOptions rough = in_double(options);
  const auto plan = plan_run(model, equations, rough, diagnostics);
  if (!plan || !requests_lie_ahead(model.system, *plan, rough, diagnostics)) return std::nullopt;
  const Observables observables = collect_observables(equations, nullptr);
  ExtendedRun run(model, equations, options, plan_extended(model, equations, options, *plan, observables), observables);
  ExtendedResult result = run.carry_out();
  if (goes_through_modes(model)) tell_ending(result.ending, result.reason, run.ended_by(), diagnostics);
  return result;
}

namespace {

std::string quoted(const std::string& name) {
  if (name.find_first_of(",\"") == std::string::npos) return name;
  std::string out = "\"";
  for (const char c : name) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + "\"";
}

}  // namespace

std::string to_csv(const ExtendedResult& result) {
  const auto heading = [](const Trajectory::Column& c) {
    return quoted(c.unit.empty() ? c.name : c.name + " [" + c.unit + "]");
  };
  std::string out = heading(result.independent);
  for (const Trajectory::Column& c : result.columns) out += "," + heading(c);
  out += "\r\n";
  for (const ExtendedState& row : result.rows) {
    out += row.t.text;
    for (const auto* part : {&row.q, &row.v, &row.points, &row.reactions})
      for (const AgreedNumber& x : *part) out += "," + (x.digits > 0 ? x.text : std::string());
    out += "," + (row.energy.digits > 0 ? row.energy.text : std::string()) + "\r\n";
  }
  return out;
}

}  // namespace maupertuis
