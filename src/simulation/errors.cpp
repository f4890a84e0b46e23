#include "simulation/errors.hpp"
#include "simulation/ending.hpp"

#include "simulation/lost_digits.hpp"
#include "simulation/matched_times.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace maupertuis {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

constexpr double shrinking = 0.5;  // of what shorter steps change: what still shorter ones change
constexpr double noise = 1e-6;     // of a column's largest value

/// No number is known better than it is rounded; zero is exact where all agree on it.
double with_rounding(double error, double value) {
  return std::max(error, std::numeric_limits<double>::epsilon() * std::abs(value));
}

class Teller {
 public:
  Teller(SimulationResult& result, const CompanionPlan& plan, const Companions& companions,
         const RoundedNumbers& numbers)
      : result_(result),
        plan_(plan),
        companions_(companions),
        numbers_(numbers),
        n_(plan.run.q.size()),
        columns_(plan.columns()) {
    find_rows();
    find_loss();
  }

  void tell(Probe* probe) {
    for (std::size_t i = 0; i < result_.at.size(); ++i)
      if (!result_.at[i].q.empty())
        tell_state(result_.at[i], plan_.roundings.at[i],
                   [i](const CompanionRun& run) { return sample_or_null(run.at[i]); });
    tell_state(result_.final, plan_.roundings.final,
               [](const CompanionRun& run) { return run.final ? &*run.final : nullptr; });
    if (result_.ending == Ending::UntilReached || result_.ending == Ending::Stopped ||
        is_reason_of_modes(result_.ending))
      result_.final.errors->t =
          error_of(result_.final.t, [](const CompanionRun& run) { return run.final ? run.final->t : infinity; });
    if (plan_.whole_rows) tell_rows();
    tell_happenings();
    if (probe) tell_probe(*probe);
  }

 private:
  using Like = std::pair<Happening::Kind, std::string>;

  using Times = std::map<Like, std::vector<double>>;  // of each kind in order

  /// But for what holds as the motion begins, at a time that is given: a companion, which begins a rounding aside, has
  /// it there, a moment later, or not at all.
  Times times_of(const std::vector<Happening>& happenings) const {
    constexpr double moment = 1e-12;  // of the run
    const double near = moment * std::abs(plan_.run.end - plan_.run.begin);
    std::set<Like> begins;
    for (const Happening& h : result_.happenings)
      if (h.t == plan_.run.begin) begins.insert({h.kind, h.name});
    Times out;
    for (const Happening& h : happenings) {
      const Like like{h.kind, h.name};
      if (!(begins.count(like) > 0 && std::abs(h.t - plan_.run.begin) <= near)) out[like].push_back(h.t);
    }
    return out;
  }

  /// [companions] the times of what happens to them that belong to those of the run.
  std::vector<Times> times_of_companions(const Times& own) const {
    std::vector<Times> out;
    for (const CompanionRun& run : companions_.runs) {
      Times theirs = times_of(run.happenings);
      Times& matched = out.emplace_back();
      for (const auto& [like, times] : own) matched[like] = matched_times(times, theirs[like]);
    }
    return out;
  }

  /// Times of events: by those of the companions.
  void tell_happenings() {
    const Times own = times_of(result_.happenings);
    const std::vector<Times> others = times_of_companions(own);
    std::map<Like, std::size_t> counts;
    for (Happening& h : result_.happenings) {
      const Like like{h.kind, h.name};
      const auto times = own.find(like);
      if (times == own.end()) continue;
      const std::size_t count = counts[like];
      if (count == times->second.size() || times->second[count] != h.t) continue;  // as the motion begins
      ++counts[like];
      const double by_companions = error_of(h.t, [&](const CompanionRun& run) {
        return others[static_cast<std::size_t>(&run - companions_.runs.data())].at(like)[count];
      });
      h.error = std::max(h.error, by_companions);
    }
  }

  static const Sample* sample_or_null(const Sample& sample) { return sample.q.empty() ? nullptr : &sample; }

  /// factor · √(mean of (x_k − x)²); infinite where a companion has no value: it ended before.
  template <class ValueOf>
  double difference(double value, ValueOf value_of) const {
    if (!std::isfinite(value)) return std::numeric_limits<double>::quiet_NaN();
    double sum = 0;
    for (const CompanionRun& run : companions_.runs) {
      const double other = value_of(run);
      if (!std::isfinite(other)) return infinity;
      sum += (other - value) * (other - value);
    }
    return companions_.factor * std::sqrt(sum / static_cast<double>(companions_.runs.size()));
  }
  template <class ValueOf>
  double error_of(double value, ValueOf value_of) const {
    return with_rounding(difference(value, value_of), value);
  }

  // ------------------------------------------------------------------------------------------------------------ rows

  /// The instants at which the state jumps, in their order.
  std::vector<double> jumps() const {
    const auto sets = [&](const std::string& name) {
      const auto& events = plan_.model.experiment.events;
      return std::any_of(events.begin(), events.end(),
                         [&](const ModelEvent& e) { return e.name == name && !e.sets.empty(); });
    };
    std::vector<double> out;
    for (const Happening& h : result_.happenings)
      if (h.kind == Happening::Kind::Impact || (h.kind == Happening::Kind::Event && sets(h.name))) out.push_back(h.t);
    std::sort(out.begin(), out.end());
    return out;
  }

  /// Whether a row stands at one of them: companions may have it on the other side.
  bool is_at(const std::vector<double>& jumps, std::size_t g) const {
    constexpr double at_once = 1e-12;
    const double t = plan_.time(g), near = at_once * std::abs(t);
    const auto next = std::lower_bound(jumps.begin(), jumps.end(), t - near);
    return next != jumps.end() && *next <= t + near;
  }

  /// [grid × columns] differences; with a running maximum the largest so far.
  void find_rows() {
    const std::vector<double> at_jumps = jumps();
    for (std::size_t g = 0; g < plan_.grid.size(); ++g) {
      if (g > 0 && is_at(at_jumps, g)) {
        for (std::size_t c = 0; c < columns_; ++c) errors_.push_back(errors_[(g - 1) * columns_ + c]);
        continue;
      }
      for (std::size_t c = 0; c < columns_; ++c) {
        double e = companions_.factor *
                   std::sqrt(companions_.squares[g * columns_ + c] / static_cast<double>(companions_.runs.size()));
        if (g == 0 && plan_.time(0) == plan_.run.begin && is_given(c)) e = 0;
        if (companions_.running_maximum && g > 0) e = std::max(e, errors_[(g - 1) * columns_ + c]);
        errors_.push_back(e);
      }
    }
    largest_between_ = companions_.between;
    for (std::size_t i = columns_; i < largest_between_.size(); ++i)
      largest_between_[i] = std::max(largest_between_[i], largest_between_[i - columns_]);
  }

  bool is_given(std::size_t column) const {
    return column < n_ ? numbers_.given_q(column) : column < 2 * n_ && numbers_.given_v(column - n_);
  }

  /// Each column of the state that is lost at the end, and since when.
  void find_loss() {
    lost_from_.assign(2 * n_, infinity);
    if (plan_.grid.empty()) return;
    const LostDigits digits(plan_);
    bool everything = true;
    for (std::size_t c = 0; c < 2 * n_; ++c) {
      const std::size_t g = first_lost(c, digits);
      if (g == plan_.grid.size()) {
        everything = everything && digits.size(c) == 0;
        continue;
      }
      lost_from_[c] = plan_.time(g);
      note_loss(c);
    }
    result_.uncertain.everything = everything && !result_.uncertain.columns.empty();
  }

  /// The first row that is lost and from which on most are: companions that go ways of their own come near each other
  /// by chance now and then.
  std::size_t first_lost(std::size_t column, const LostDigits& digits) const {
    constexpr double most = 0.75;
    const std::size_t rows = plan_.grid.size();
    std::size_t first = rows, lost = 0;
    for (std::size_t g = rows; g-- > 0;) {
      const std::size_t at = g * columns_ + column;
      if (!digits.is_lost(column, errors_[at]) && !(unsettled(g, column) && errors_[at] > noise * digits.size(column)))
        continue;
      if (static_cast<double>(++lost) >= most * static_cast<double>(rows - g)) first = g;
    }
    return first;
  }

  /// Whether the two companions of the variational method differ, so far, by most of what they differ from the run by:
  /// with shorter steps the motion goes on changing, and the differences bound nothing.
  bool unsettled(std::size_t row, std::size_t column) const {
    const std::size_t at = row * columns_ + column;
    return !companions_.between.empty() && largest_between_[at] * companions_.factor > shrinking * errors_[at];
  }

  void note_loss(std::size_t column) {
    Uncertainty& uncertain = result_.uncertain;
    if (uncertain.columns.empty() || is_later(uncertain.first, lost_from_[column]))
      uncertain.first = lost_from_[column];
    if (uncertain.columns.empty() || is_later(lost_from_[column], uncertain.from)) uncertain.from = lost_from_[column];
    uncertain.columns.push_back(column);
  }

  bool is_later(double t, double than) const { return plan_.run.end < plan_.run.begin ? t < than : t > than; }
  bool is_lost_at(std::size_t column, double t) const {
    return lost_from_[column] < infinity && !is_later(lost_from_[column], t);
  }
  bool everything_lost_at(double t) const {
    return result_.uncertain.everything && !is_later(result_.uncertain.from, t);
  }

  /// The largest difference of a column of the state up to t, where the estimate is a running maximum.
  double before(std::size_t column, double t) const {
    double out = 0;
    if (!companions_.running_maximum) return out;
    for (std::size_t g = 0; g < plan_.grid.size() && !is_later(plan_.time(g), t); ++g)
      out = errors_[g * columns_ + column];
    return out;
  }

  // ---------------------------------------------------------------------------------------------------------- states

  template <class SampleOf>
  void tell_state(State& state, const std::vector<double>& roundings, SampleOf sample_of) {
    StateErrors out;
    const bool at_start = state.t == plan_.run.begin;
    for (std::size_t i = 0; i < 2 * n_; ++i) {
      const double value = i < n_ ? state.q[i] : state.v[i - n_];
      double e = difference(value, [&](const CompanionRun& run) {
        const Sample* const sample = sample_of(run);
        return !sample ? infinity : i < n_ ? sample->q[i] : sample->v[i - n_];
      });
      e = with_rounding(std::max(e, before(i, state.t)), value);
      if (at_start && is_given(i)) e = 0;
      if (is_lost_at(i, state.t)) e = infinity;
      (i < n_ ? out.q : out.v).push_back(e);
    }
    for (std::size_t i = 0; i < state.multipliers.size(); ++i)
      out.multipliers.push_back(error_of(state.multipliers[i], [&](const CompanionRun& run) {
        const Sample* const sample = sample_of(run);
        return sample && i < sample->multipliers.size() ? sample->multipliers[i] : infinity;
      }));
    const std::size_t first = plan_.observables.energy_terms + plan_.observables.points;
    const std::vector<double> balanced = rounding_of_balance(state.reactions);
    for (std::size_t i = 0; i < state.reactions.size(); ++i)
      out.reactions.push_back(std::max(
          {observable_error(state.reactions[i], first + i, state.t, sample_of), balanced[i], roundings[first + i]}));
    state.errors = std::move(out);
  }

  /// [reactions] A force of contacts that is nothing but rounding of others beside it is not known to be another one
  /// than 0, though all runs agree on it, since their numbers do: what it is beside the largest of its unit then; else
  /// 0.
  std::vector<double> rounding_of_balance(std::span<const double> forces) const {
    constexpr double rounding = 16 * std::numeric_limits<double>::epsilon();
    std::vector<double> out(forces.size(), 0);
    for (std::size_t i = 0; plan_.modes && i < forces.size(); ++i) {
      double largest = 0;
      for (std::size_t k = 0; k < forces.size(); ++k)
        if (plan_.observables.reactions[k].dimension == plan_.observables.reactions[i].dimension)
          largest = std::max(largest, std::abs(forces[k]));
      if (forces[i] != 0 && std::abs(forces[i]) <= rounding * largest) out[i] = rounding * largest;
    }
    return out;
  }

  /// Where the state is lost, a function of it is too, unless it is known all the same (an energy).
  template <class SampleOf>
  double observable_error(double value, std::size_t observable, double t, SampleOf sample_of) const {
    const double e = error_of(value, [&](const CompanionRun& run) {
      const Sample* const sample = sample_of(run);
      return sample ? sample->observables[observable] : infinity;
    });
    return everything_lost_at(t) && e >= saturated_error * std::abs(value) ? infinity : e;
  }

  void tell_probe(Probe& probe) const {
    probe.errors.assign(probe.values.size(), {});
    const std::size_t first = plan_.observables.expressions.size() - plan_.observables.probes;
    for (std::size_t i = 0; i < probe.values.size(); ++i)
      for (std::size_t k = 0; k < probe.values[i].size(); ++k)
        probe.errors[i].push_back(
            std::max(plan_.roundings.at[i][first + k],
                     observable_error(probe.values[i][k], first + k, plan_.options.at[i],
                                      [i](const CompanionRun& run) { return sample_or_null(run.at[i]); })));
  }

  /// A row that is not in the grid is the last one, of an event or an early end, whose companions are the ends; or it
  /// stands beside a jump, whose instant is not quite that of the companions: then the errors of the rows around tell.
  void tell_rows() {
    Trajectory& rows = result_.trajectory;
    const std::size_t forces = 2 * n_ + plan_.observables.points, count = plan_.observables.reactions.size();
    const RoundingOfRows rounding(plan_.equations, plan_.observables);
    std::size_t g = 0;
    const auto of_ends = [&](double value, std::size_t column) {
      return difference(value, [&](const CompanionRun& run) {
        std::vector<double> end;
        if (run.final) append_row(end, *run.final, plan_.observables);
        return run.final ? end[column] : infinity;
      });
    };
    for (std::size_t row = 0; row < rows.rows(); ++row) {
      const bool in_grid = g < plan_.grid.size() && plan_.grid[g] == row;
      const std::vector<double> balanced =
          rounding_of_balance(std::span(rows.values).subspan(row * columns_ + forces, count));
      const std::vector<double> of_formulas =
          rounding.errors(rows.times[row], std::span(rows.values).subspan(row * columns_, columns_));
      for (std::size_t c = 0; c < columns_; ++c) {
        const double value = rows.at(row, c);
        double e = in_grid ? errors_[g * columns_ + c] : row + 1 == rows.rows() ? of_ends(value, c) : around(g, c);
        const bool exact = row == 0 && e == 0 && is_given(c);
        if (!exact) e = with_rounding(e, value);
        if (c >= 2 * n_) e = std::max(e, of_formulas[c - 2 * n_]);
        if (c >= forces && c - forces < count) e = std::max(e, balanced[c - forces]);
        if (c < 2 * n_ && is_lost_at(c, rows.times[row])) e = infinity;
        rows.errors.push_back(std::isfinite(value) ? e : std::numeric_limits<double>::quiet_NaN());
      }
      if (in_grid) ++g;
    }
  }

  double around(std::size_t g, std::size_t column) const {
    const double before = g > 0 ? errors_[(g - 1) * columns_ + column] : 0,
                 after = g < plan_.grid.size() ? errors_[g * columns_ + column] : 0;
    return std::max(before, after);
  }

  SimulationResult& result_;
  const CompanionPlan& plan_;
  const Companions& companions_;
  const RoundedNumbers& numbers_;
  std::size_t n_, columns_;
  std::vector<double> errors_;           // [grid × columns]
  std::vector<double> largest_between_;  // [grid × columns] Companions::between, the largest so far; or empty
  std::vector<double> lost_from_;        // [2n] s; infinite: it is not
};

}  // namespace

std::vector<std::size_t> comparison_grid(const Trajectory& rows, const StatesBetween& between, const RunPlan& plan,
                                         ErrorEstimates wanted) {
  std::vector<std::size_t> all;  // rows of the output times; those beside jumps are not
  for (std::size_t row = 0; row < rows.rows() && all.size() < plan.output_times.size(); ++row)
    if (rows.times[row] == plan.output_times[all.size()]) all.push_back(row);
  const std::size_t stride = wanted == ErrorEstimates::Rows ? 1 : 1 + all.size() / usual_comparisons;
  std::vector<std::size_t> out;
  for (std::size_t k = 0; k < all.size(); k += stride) out.push_back(all[k]);
  if (!all.empty() && out.back() != all.back()) out.push_back(all.back());
  const auto time = [&](std::size_t i) { return i < rows.rows() ? rows.times[i] : between.times[i - rows.rows()]; };
  const auto first_between = static_cast<std::ptrdiff_t>(out.size());
  for (std::size_t k = 0; k < between.times.size(); ++k) out.push_back(rows.rows() + k);
  const bool backwards = plan.end < plan.begin;
  std::inplace_merge(out.begin(), out.begin() + first_between, out.end(),
                     [&](std::size_t a, std::size_t b) { return backwards ? time(a) > time(b) : time(a) < time(b); });
  return out;
}

void tell_errors(SimulationResult& result, Probe* probe, const CompanionPlan& plan, const Companions& companions,
                 const RoundedNumbers& numbers) {
  Teller(result, plan, companions, numbers).tell(probe);
}

}  // namespace maupertuis
