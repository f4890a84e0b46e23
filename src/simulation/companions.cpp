#include "simulation/companions.hpp"
#include "simulation/ending.hpp"

#include "simulation/hybrid_motion.hpp"
#include "simulation/lost_digits.hpp"
#include "simulation/methods.hpp"

#include <maupertuis/ensemble.hpp>
#include <maupertuis/integrator.hpp>
#include <maupertuis/motion_kernel.hpp>
#include <maupertuis/switches.hpp>
#include <maupertuis/transform.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <numeric>

namespace maupertuis {
namespace {

constexpr std::uint64_t seed =
    1744;  // the year of the principle; with the number of a companion: equal runs have equal companions
constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

/// Adds its differences up, so that long trajectories are held once. Where the run itself has no number there is no
/// difference.
void take_in(Companions& to, CompanionRun run, const CompanionPlan& plan) {
  const std::size_t columns = plan.columns();
  to.squares.resize(plan.grid.size() * columns);
  for (std::size_t g = 0; g < plan.grid.size(); ++g)
    for (std::size_t c = 0; c < columns; ++c) {
      const double value = plan.value(g, c), off = run.rows[g * columns + c] - value;
      if (std::isfinite(value))
        to.squares[g * columns + c] += std::isfinite(off) ? off * off : std::numeric_limits<double>::infinity();
    }
  run.rows = {};
  to.runs.push_back(std::move(run));
}

/// Of two runs, where both have values.
std::vector<double> differences(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> out(a.size());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = std::abs(a[i] - b[i]);
  return out;
}

/// Times with so few binary digits are meant as they are: 3 s, 0.25 s.
bool is_short(double t) {
  constexpr int bits = 40;
  int exponent = 0;
  const double whole = std::ldexp(std::frexp(t, &exponent), bits);
  return whole == std::nearbyint(whole);
}

/// Indices of the times asked for, in the order of the run.
std::vector<std::size_t> order_of_requests(const CompanionPlan& plan) {
  const std::vector<double>& at = plan.options.at;
  std::vector<std::size_t> out(at.size());
  std::iota(out.begin(), out.end(), std::size_t{0});
  const bool backwards = plan.run.end < plan.run.begin;
  std::stable_sort(out.begin(), out.end(),
                   [&](std::size_t a, std::size_t b) { return backwards ? at[a] > at[b] : at[a] < at[b]; });
  return out;
}

}  // namespace

double CompanionPlan::looked_at(double t) const { return is_short(t) ? t : std::nextafter(t, run.begin); }

namespace {

Companions interrupted() {
  Companions out;
  out.interrupted = true;
  return out;
}

// ---------------------------------------------------------------------------------------------- one after the other

class Recorder {
 public:
  /// `last_row`: that others have come to before they lost the motion.
  Recorder(const CompanionPlan& plan, Method& method, std::size_t last_row)
      : plan_(plan), method_(method), requests_(order_of_requests(plan)), last_row_(last_row) {
    out_.at.resize(plan.options.at.size());
  }

  /// It is recorded up to where it has lost the motion for good: what follows is told by nobody.
  void end_where_lost(double share) { lost_.emplace(plan_, share); }
  std::size_t last_row() const { return last_row_; }

  /// Nothing where the user has interrupted it.
  std::optional<CompanionRun> record(const RoundedNumbers::Draw& draw) {
    const bool until = plan_.result.ending == Ending::UntilReached || plan_.result.ending == Ending::Stopped;
    double bound = until ? plan_.run.end : plan_.result.final.t;
    parameters_ = draw.parameters;
    method_.start(plan_.run.begin, draw.q, draw.v);
    cover();
    while (method_.time() != bound && !has_lost_the_motion()) {
      const Step step = method_.step(bound);
      cover();
      if (step.ending == StepEnding::Interrupted) return std::nullopt;
      // As much earlier as rounding hides: what it may hide from all of them is in the errors then.
      const bool met = until && step.event && !out_.final;
      if (met) out_.final = closely(method_.time() - std::copysign(step.hidden, bound - plan_.run.begin));
      note_like_ending(step);  // a little earlier
      if (step.ending != StepEnding::None) break;
      if (out_.final && has_come_to(plan_.result.final.t)) break;
      // It has met its end a little earlier, before the last row of the motion.
      if (met) bound = plan_.result.final.t;
    }
    if (!until && method_.time() == bound && !has_lost_the_motion()) {
      out_.final = closely(plan_.looked_at(bound));
      come_to_like_ending();
    }
    out_.rows.resize(plan_.grid.size() * plan_.columns(), nothing);
    return std::move(out_);
  }

 private:
  /// Where the run cannot go on for what events, contacts or friction do, its companion cannot either.
  void note_like_ending(const Step& step) {
    if (is_reason_of_modes(plan_.result.ending) && ending_of(step.ending) == plan_.result.ending)
      out_.final = closely(method_.time());
  }

  /// That comes a little later here. Those that have been counted alone have no instant of their own.
  void come_to_like_ending() {
    constexpr double little = 1e-6;  // of the run
    if (plan_.result.ending != Ending::Paradox && plan_.result.ending != Ending::ImpossibleState) return;
    const double bound = plan_.result.final.t + little * (plan_.result.final.t - plan_.run.begin);
    for (Step step; step.ending == StepEnding::None && method_.time() != bound; note_like_ending(step))
      step = method_.step(bound);
  }

  Sample sample(double t) const {
    Sample out = method_.sample(t);
    leave_out_undetermined(out, plan_.observables);
    return out;
  }

  Sample closely(double t) const {
    Sample out = sample(t);
    plan_.close.put_into(out, parameters_);
    return out;
  }

  bool has_come_to(double t) const {
    return plan_.run.begin <= plan_.run.end ? method_.time() >= t : method_.time() <= t;
  }
  bool has_lost_the_motion() const { return next_row_ > last_row_ && next_request_ == requests_.size(); }

  void cover() {
    for (; next_row_ < plan_.grid.size() && method_.covers(plan_.time(next_row_)); ++next_row_)
      add_row(plan_.time(next_row_));
    for (; next_request_ < requests_.size() && method_.covers(plan_.options.at[requests_[next_request_]]);
         ++next_request_)
      out_.at[requests_[next_request_]] = closely(plan_.looked_at(plan_.options.at[requests_[next_request_]]));
  }

  void add_row(double t) {
    if (plan_.whole_rows) return append_row(out_.rows, sample(t), plan_.observables);
    const std::size_t n = plan_.run.q.size(), from = out_.rows.size();
    out_.rows.resize(from + 2 * n);
    const std::span<double> q = std::span(out_.rows).subspan(from, n), v = std::span(out_.rows).subspan(from + n, n);
    method_.state(t, q, v);
    if (lost_ && lost_->look(next_row_, out_.rows.data() + from)) last_row_ = std::min(last_row_, next_row_);
  }

  const CompanionPlan& plan_;
  Method& method_;
  std::vector<std::size_t> requests_;
  std::size_t next_row_ = 0, next_request_ = 0;
  std::size_t last_row_;
  std::optional<LostCompanion> lost_;
  std::vector<double> parameters_;
  CompanionRun out_;
};

/// Whether nothing but the state is asked of companions at the end, where it may be lost.
bool may_end_where_lost(const CompanionPlan& plan) {
  const bool at_the_end = plan.result.ending == Ending::UntilReached || plan.result.ending == Ending::Stopped;
  return !plan.whole_rows && !at_the_end && (goes_through_modes(plan.model) || plan.observables.reactions.empty());
}

std::size_t most_steps(const CompanionPlan& plan) {
  const std::size_t steps = plan.result.statistics.steps, most = std::numeric_limits<std::size_t>::max();
  return steps < most / 8 ? 8 * steps + 1000 : most;
}

/// Whether a function of t alone is known to the last digit at any t: t stands in it as t − c alone, with one number c,
/// of which nothing but the difference counts. In t − c − w numbers are added first, and w t is rounded as t is.
bool resolves_time(Expr f, Expr time) {
  const std::vector<Expr> symbols = symbols_of({&f, 1});
  if (std::any_of(symbols.begin(), symbols.end(), [](const Expr& s) { return s.role() == Role::Coordinate; }))
    return false;
  bool exact = true;
  const std::function<void(Expr)> look = [&](Expr e) {
    if (e == time) {
      exact = false;
      return;
    }
    bool is_difference = false;
    for (std::size_t i = 0; i < e.size(); ++i) is_difference = is_difference || (e.is(Kind::Sum) && e[i] == time);
    if (is_difference && e.size() != 2) exact = false;
    for (std::size_t i = 0; i < e.size(); ++i)
      if (!(is_difference && e[i] == time)) look(e[i]);
  };
  look(f);
  return exact;
}

/// Whether instants at which steps of the run end are rounded as its time is; those of switches at t − c are known
/// better.
bool rounds_instants(const CompanionPlan& plan) {
  if (goes_through_modes(plan.model) || plan.run.until) return true;
  if (plan.result.statistics.switches == 0) return false;
  const MechanicalSystem& system = *plan.equations.system;
  const auto balance = expand_time_derivatives(in_terms_of_motion(system, plan.equations.balance()));
  const std::vector<Expr> switches = switches_of(with_constants_as_numbers(system, balance));
  const Expr time = system.context->time();
  return !std::all_of(switches.begin(), switches.end(), [&](const Expr& f) { return resolves_time(f, time); });
}

/// Of tolerances that the user chose a smaller one: its own error must not hide that of the run. At rounding level
/// nothing is smaller; there the order alone makes other steps.
TaylorOptions taylor_options(const CompanionPlan& plan, int companion) {
  TaylorOptions out;
  out.tolerance = std::max(rounding_tolerance(), plan.options.tolerance / (20 * (companion + 1)));
  out.order = plan.result.statistics.order + 1 + companion;
  out.maximum_steps = most_steps(plan);
  out.interrupt = plan.options.interrupt;
  out.backend = plan.options.backend;
  out.cache = plan.options.cache;
  if (rounds_instants(plan)) out.moved_instants = seed + static_cast<std::uint64_t>(companion);
  return out;
}

std::unique_ptr<Method> finer_stiff(const CompanionPlan& plan, const WantedFunctions& wanted, int companion) {
  constexpr double least = 1e-14;  // below, steps err by rounding
  StiffOptions out;
  if (plan.options.method == StepMethod::Stiff && plan.options.tolerance != 0) out.tolerance = plan.options.tolerance;
  out.tolerance = std::max(std::min(least, out.tolerance / 2), out.tolerance / (companion == 0 ? 5 : 25));
  out.maximum_steps = most_steps(plan);
  out.interrupt = plan.options.interrupt;
  Diagnostics told_by_the_run;
  return stiff_method(plan.equations, wanted, out, told_by_the_run);
}

std::unique_ptr<Method> finer_variational(const CompanionPlan& plan, const WantedFunctions& wanted, int companion) {
  constexpr int highest = 12;
  VariationalOptions out;
  out.step = plan.options.step / (companion == 0 ? 1.5 : 2);
  // Before the first step of both is over all make the same shorter one: another order alone tells its error.
  out.order = std::max(std::min(plan.result.statistics.order + 2, highest), plan.result.statistics.order);
  out.maximum_steps = most_steps(plan);
  out.interrupt = plan.options.interrupt;
  Diagnostics told_by_the_run;
  return variational_method(plan.equations, wanted, out, told_by_the_run);
}

Companions one_after_the_other(const CompanionPlan& plan, const WantedFunctions& wanted,
                               const RoundedNumbers& numbers) {
  const std::string& name = plan.result.statistics.method;
  const bool taylor = name == "taylor";
  Companions out;
  const int count = taylor ? 3 : 2;
  std::size_t last_row = std::numeric_limits<std::size_t>::max();
  std::vector<double> with_longer_steps;  // of the variational method
  for (int k = 0; k < count; ++k) {
    RoundedNumbers::Draw draw = numbers.draw(seed + static_cast<std::uint64_t>(k));
    if (!taylor) draw.q = plan.run.q, draw.v = plan.run.v;  // rounding is nothing beside their tolerances
    HybridMotion* through_modes = nullptr;
    const auto hybrid = [&] {
      auto made = std::make_unique<HybridMotion>(plan.modes, draw.parameters, taylor_options(plan, k));
      made->meet_hidden_roots_late();
      through_modes = made.get();
      return made;
    };
    const std::unique_ptr<Method> method =
        goes_through_modes(plan.model) ? std::unique_ptr<Method>(hybrid())
        : taylor          ? method_of(TaylorStepper(numbers.kernel(), draw.parameters, taylor_options(plan, k)))
        : name == "stiff" ? finer_stiff(plan, wanted, k)
                          : finer_variational(plan, wanted, k);
    Recorder recorder(plan, *method, last_row);
    if (may_end_where_lost(plan)) recorder.end_where_lost(out.factor / std::sqrt(count));
    auto run = recorder.record(draw);
    if (!run) return interrupted();
    last_row = recorder.last_row();
    if (through_modes) through_modes->finish(), run->happenings = through_modes->take_happenings();
    if (name == "variational" && k == 0) with_longer_steps = run->rows;
    if (name == "variational" && k == 1) out.between = differences(run->rows, with_longer_steps);
    take_in(out, std::move(*run), plan);
  }
  return out;
}

// ------------------------------------------------------------------------------------------------------ side by side

constexpr std::size_t in_a_register = 7, most_unknowns = 4;
constexpr std::size_t most_numbers = 60'000'000;  // of all samples: half a gigabyte

bool fit_side_by_side(const CompanionPlan& plan, const Kernel& kernel) {
  const std::size_t n = plan.run.q.size(), samples = plan.grid.size() + plan.options.at.size();
  return n <= most_unknowns && fits_lanes(kernel) && plan.result.statistics.method == "taylor" && plan.result.ok() &&
         in_a_register * samples * 2 * n <= most_numbers;
}

class SideBySide {
 public:
  SideBySide(const CompanionPlan& plan, const RoundedNumbers& numbers)
      : plan_(plan), kernel_(numbers.kernel()), point_(kernel_, 1) {
    for (std::size_t k = 0; k < in_a_register; ++k) {
      draws_.push_back(numbers.draw(seed + k));
      const auto append = [](std::vector<double>& to, const std::vector<double>& from) {
        to.insert(to.end(), from.begin(), from.end());
      };
      append(q_, draws_[k].q), append(v_, draws_[k].v), append(parameters_, draws_[k].parameters);
      factors_.push_back(1 - static_cast<double>(k) / 32);
      lost_.emplace_back(plan, factor / std::sqrt(in_a_register));
    }
    for (std::size_t g = 0; g < plan.grid.size(); ++g) times_.push_back(plan.time(g));
    for (std::size_t i = 0; i < plan.options.at.size(); ++i)
      if (!plan.result.at[i].q.empty()) times_.push_back(plan.looked_at(plan.options.at[i]));
    times_.push_back(plan.looked_at(plan.result.final.t));
    std::sort(times_.begin(), times_.end());
    times_.erase(std::unique(times_.begin(), times_.end()), times_.end());
  }

  /// Nothing where a lane was given up: its steps are then those of a run alone.
  std::optional<Companions> run() {
    double from = plan_.run.begin;
    for (const double to : ends_of_parts()) {
      const EnsembleResult found = advance(from, to);
      if (std::any_of(found.endings.begin(), found.endings.end(),
                      [](const TrajectoryEnding& e) { return e.ending == StepEnding::Interrupted; }))
        return interrupted();
      if (std::any_of(found.endings.begin(), found.endings.end(), [](const TrajectoryEnding& e) { return e.alone; }))
        return std::nullopt;
      for (std::size_t k = 0; k < in_a_register; ++k) record(found, k, to);
      next_row_ = rows_until(to);
      const bool all_go_on =
          std::all_of(found.endings.begin(), found.endings.end(), [](const TrajectoryEnding& e) { return e.ok(); });
      if ((is_lost_ && may_end_early() && !has_probes_after(to)) || !all_go_on) break;
      q_ = found.q, v_ = found.v, from = to;
    }
    Companions out;
    out.factor = factor;
    out.running_maximum = false;
    for (CompanionRun& run : runs_) {
      run.rows.resize(plan_.grid.size() * plan_.columns(), nothing);
      run.at.resize(plan_.options.at.size());
      take_in(out, std::move(run), plan_);
    }
    return out;
  }

 private:
  static constexpr double factor = 3;

  /// Long runs go on in parts, each twice as long as what went before: of a motion that is lost soon the rest is not
  /// computed.
  ///
  ///     ├┤├┤├──┤├────────┤├────────────────┤
  std::vector<double> ends_of_parts() const {
    constexpr std::size_t long_run = 8'000;  // steps
    const double begin = plan_.run.begin, end = plan_.result.final.t;
    std::vector<double> out;
    if (may_end_early() && plan_.result.statistics.steps > long_run && end > begin)
      for (const double share : {1.0 / 32, 1.0 / 16, 1.0 / 8, 1.0 / 4, 1.0 / 2})
        out.push_back(begin + share * (end - begin));
    out.push_back(end);
    return out;
  }

  EnsembleResult advance(double from, double to) {
    // In either direction; what is wanted at the beginning belongs to the first part.
    const auto is_of_part = [&](double t) {
      return std::min(from, to) <= t && t <= std::max(from, to) && (t != from || from == plan_.run.begin);
    };
    part_.clear();
    std::copy_if(times_.begin(), times_.end(), std::back_inserter(part_), is_of_part);
    EnsembleStart start;
    start.q = q_, start.v = v_, start.parameters = parameters_, start.step_factors = factors_, start.times = part_;
    start.begin = {&from, 1};
    start.end = {&to, 1};
    EnsembleOptions options;
    options.tolerance = std::max(rounding_tolerance(), plan_.options.tolerance / 40);
    options.order = plan_.result.statistics.order + 2;
    options.maximum_steps = most_steps(plan_);
    options.width = 8;
    options.threads = 1;
    options.interrupt = plan_.options.interrupt;
    options.backend = plan_.options.backend;
    options.cache = plan_.options.cache;
    return advance_ensemble(kernel_, start, options);
  }

  /// The first row behind `to`.
  std::size_t rows_until(double to) const {
    if (to == plan_.result.final.t) return plan_.grid.size();
    std::size_t g = next_row_;
    while (g < plan_.grid.size() && plan_.time(g) <= to) ++g;
    return g;
  }

  void record(const EnsembleResult& found, std::size_t k, double to) {
    point_.set_parameters(draws_[k].parameters);
    CompanionRun& out = runs_[k];
    for (std::size_t g = next_row_; g < rows_until(to); ++g) {
      const double t = plan_.time(g);
      const std::size_t i = index_of(t);
      if (plan_.whole_rows) {
        append_row(out.rows, sample(t, found.q_of(k, i), found.v_of(k, i)), plan_.observables);
        continue;
      }
      for (const auto part : {found.q_of(k, i), found.v_of(k, i)})
        out.rows.insert(out.rows.end(), part.begin(), part.end());
      is_lost_ = lost_[k].look(g, out.rows.data() + g * plan_.columns()) || is_lost_;
    }
    out.at.resize(plan_.options.at.size());
    for (std::size_t r = 0; r < plan_.options.at.size(); ++r) {
      const double t = plan_.looked_at(plan_.options.at[r]);
      const bool reached = !plan_.result.at[r].q.empty();
      if (reached && std::binary_search(part_.begin(), part_.end(), t)) out.at[r] = closely(found, k, t);
    }
    if (to == plan_.result.final.t && found.endings[k].ok())
      out.final = closely(found, k, plan_.looked_at(plan_.result.final.t));
  }

  /// Where energy is conserved, motions that have parted do not come together again (Liouville's theorem); where there
  /// is damping they may, on their way to the same rest.
  bool may_end_early() const { return may_end_where_lost(plan_) && plan_.equations.power.is_zero(); }

  /// Functions of a state that is lost may be known: an energy.
  bool has_probes_after(double t) const {
    const std::vector<double>& at = plan_.options.at;
    return plan_.observables.probes > 0 && std::any_of(at.begin(), at.end(), [&](double asked) { return asked > t; });
  }

  std::size_t index_of(double t) const {
    return static_cast<std::size_t>(std::lower_bound(part_.begin(), part_.end(), t) - part_.begin());
  }

  Sample sample(double t, std::span<const double> q, std::span<const double> v) {
    Sample out;
    out.t = t;
    out.q.assign(q.begin(), q.end());
    out.v.assign(v.begin(), v.end());
    const bool known = std::isfinite(q[0]) && point_.evaluate(t, q, v) == KernelStatus::Ok;
    for (std::size_t i = 0; i < kernel_.observables(); ++i)
      out.observables.push_back(known ? point_.observable(i) : nothing);
    for (std::size_t i = 0; i < q.size(); ++i) out.a.push_back(known ? point_.acceleration(i) : nothing);
    return out;
  }

  Sample closely(const EnsembleResult& found, std::size_t k, double t) {
    Sample out = sample(t, found.q_of(k, index_of(t)), found.v_of(k, index_of(t)));
    plan_.close.put_into(out, draws_[k].parameters);
    return out;
  }

  const CompanionPlan& plan_;
  const Kernel& kernel_;
  KernelWorkspace point_;
  std::vector<RoundedNumbers::Draw> draws_;
  std::vector<double> q_, v_, parameters_, factors_, times_;
  std::vector<double> part_;  // times of the part at hand
  std::vector<CompanionRun> runs_ = std::vector<CompanionRun>(in_a_register);
  std::vector<LostCompanion> lost_;  // [companions]
  std::size_t next_row_ = 0;
  bool is_lost_ = false;  // by one of them at least
};

}  // namespace

Companions run_companions(const CompanionPlan& plan, const WantedFunctions& wanted, const RoundedNumbers& numbers) {
  if (!goes_through_modes(plan.model) && fit_side_by_side(plan, numbers.kernel()))
    if (auto found = SideBySide(plan, numbers).run()) return std::move(*found);
  return one_after_the_other(plan, wanted, numbers);
}

}  // namespace maupertuis
