#include "simulation/matched_times.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>

namespace maupertuis {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// What it costs to leave one alone: the median of the ways between `times`, or their mean where half of them are none.
/// Where all are at one instant, as far as the others are away.
double cost_alone(std::span<const double> times, std::span<const double> others) {
  std::vector<double> ways;
  for (std::size_t i = 1; i < times.size(); ++i) ways.push_back(std::abs(times[i] - times[i - 1]));
  double farthest = 0;
  for (const double t : others) farthest = std::max(farthest, std::abs(t - times.front()));
  if (ways.empty() || times.front() == times.back()) return farthest;
  const double mean = std::accumulate(ways.begin(), ways.end(), 0.0) / static_cast<double>(ways.size());
  const auto middle = ways.begin() + static_cast<std::ptrdiff_t>(ways.size() / 2);
  std::nth_element(ways.begin(), middle, ways.end());
  return *middle > 0 ? *middle : mean;
}

/// The least costs of what comes before, by how many of `times` there are and by the shift of `others` against them.
class Alignment {
 public:
  static constexpr std::ptrdiff_t most_shifts = 3;

  Alignment(std::span<const double> times, std::span<const double> others)
      : times_(times),
        others_(others),
        more_(std::ssize(others) - std::ssize(times)),
        lowest_(std::min<std::ptrdiff_t>(more_, 0) - most_shifts),
        shifts_(std::abs(more_) + 2 * most_shifts + 1),
        alone_(cost_alone(times, others)) {}

  std::ptrdiff_t steps() const { return (std::ssize(times_) + 1) * shifts_; }

  /// The partner of each of `times`; none: infinite.
  std::vector<double> partners() {
    ways_.assign(static_cast<std::size_t>(steps()), Way::Pair);
    std::vector<double> costs(static_cast<std::size_t>(shifts_), infinity), next;
    costs[static_cast<std::size_t>(-lowest_)] = 0;
    leave_others(0, costs);
    for (std::ptrdiff_t i = 0; i < std::ssize(times_); ++i) {
      next.assign(costs.size(), infinity);
      for (std::ptrdiff_t s = 0; s < shifts_; ++s) advance(i, s, costs, next);
      leave_others(i + 1, next);
      costs.swap(next);
    }
    return traced();
  }

 private:
  enum class Way : std::uint8_t { Pair, OwnAlone, OtherAlone };

  Way& way(std::ptrdiff_t i, std::ptrdiff_t s) { return ways_[static_cast<std::size_t>(i * shifts_ + s)]; }
  bool is_other(std::ptrdiff_t j) const { return j >= 0 && j < std::ssize(others_); }

  /// From the first i of `times` to one more: as a pair, or alone.
  void advance(std::ptrdiff_t i, std::ptrdiff_t s, const std::vector<double>& costs, std::vector<double>& next) {
    const auto at = static_cast<std::size_t>(s);
    const std::ptrdiff_t j = i + lowest_ + s;
    if (is_other(j))
      next[at] = costs[at] + std::abs(times_[static_cast<std::size_t>(i)] - others_[static_cast<std::size_t>(j)]);
    if (s + 1 < shifts_ && costs[at + 1] + alone_ < next[at])
      next[at] = costs[at + 1] + alone_, way(i + 1, s) = Way::OwnAlone;
  }

  void leave_others(std::ptrdiff_t i, std::vector<double>& costs) {
    for (std::ptrdiff_t s = 1; s < shifts_; ++s) {
      const auto at = static_cast<std::size_t>(s);
      if (!is_other(i + lowest_ + s - 1) || !(costs[at - 1] + alone_ < costs[at])) continue;
      costs[at] = costs[at - 1] + alone_, way(i, s) = Way::OtherAlone;
    }
  }

  std::vector<double> traced() {
    std::vector<double> out(times_.size(), infinity);
    std::ptrdiff_t i = std::ssize(times_), s = more_ - lowest_;
    while (i > 0) {
      const Way taken = way(i, s);
      if (taken == Way::OtherAlone) {
        --s;
        continue;
      }
      --i;
      if (taken == Way::OwnAlone)
        ++s;
      else
        out[static_cast<std::size_t>(i)] = others_[static_cast<std::size_t>(i + lowest_ + s)];
    }
    return out;
  }

  std::span<const double> times_, others_;
  std::ptrdiff_t more_, lowest_, shifts_;  // shift s: times[i] beside others[i + lowest + s]
  double alone_;                           // the cost of what is left alone
  std::vector<Way> ways_;                  // [times + 1][shifts] by which the least cost came
};

std::vector<double> one_by_one(std::span<const double> times, std::span<const double> others) {
  std::vector<double> out(times.size(), infinity);
  std::copy_n(others.begin(), std::min(times.size(), others.size()), out.begin());
  return out;
}

/// Of what is alone the nearer of the times beside it, where a pair comes behind or stands at its own instant.
void fill_gaps(std::span<const double> times, std::vector<double>& out) {
  std::vector<double> behind(out.size());
  double next = infinity;
  for (std::size_t i = out.size(); i-- > 0;) behind[i] = next = std::isfinite(out[i]) ? out[i] : next;
  constexpr double one_instant = 4 * std::numeric_limits<double>::epsilon();
  double before = infinity, paired = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (std::isfinite(out[i])) {
      before = out[i], paired = times[i];
    } else if (std::abs(times[i] - paired) <= one_instant * std::abs(paired)) {
      out[i] = before;
    } else if (std::isfinite(behind[i])) {
      out[i] = std::abs(before - times[i]) < std::abs(behind[i] - times[i]) ? before : behind[i];
    }
  }
}

}  // namespace

std::vector<double> matched_times(std::span<const double> times, std::span<const double> others) {
  constexpr std::ptrdiff_t most_steps = 5'000'000;
  if (times.empty() || others.empty()) return one_by_one(times, others);
  Alignment alignment(times, others);
  if (alignment.steps() > most_steps) return one_by_one(times, others);
  std::vector<double> out = alignment.partners();
  fill_gaps(times, out);
  return out;
}

}  // namespace maupertuis
