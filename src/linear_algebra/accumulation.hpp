#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace maupertuis {

/// What happens infinitely often in a finite time: instants of several kinds that come in cycles, each shorter than the
/// one before by one ratio.
///
///     a      b       a  b   a b ab┤ the end
template <class T>
class Accumulation {
 public:
  struct End {
    T t;
    std::vector<std::size_t> kinds;  // of one cycle
  };

  void add(std::size_t kind, const T& t) {
    if (last_.empty()) begin_ = t;
    last_.push_back({kind, t});
    if (last_.size() > cycles * longest_cycle + 1) last_.erase(last_.begin());
  }

  /// Extrapolated from the last three cycles; nothing while they are long, or their ratios differ.
  std::optional<End> end() const {
    for (std::size_t length = 1; cycles * length < last_.size(); ++length) {
      if (!is_cycle(length)) continue;
      if (const auto left = time_left(length)) return End{T(last_.back().t + *left), kinds(length)};
    }
    return std::nullopt;
  }

 private:
  static constexpr std::size_t cycles = 3, longest_cycle = 8;
  struct Instant {
    std::size_t kind;
    T t;
  };

  const Instant& before(std::size_t count) const { return last_[last_.size() - 1 - count]; }
  bool is_cycle(std::size_t length) const {
    for (std::size_t k = 0; k < (cycles - 1) * length; ++k)
      if (before(k).kind != before(k + length).kind) return false;
    return true;
  }
  std::vector<std::size_t> kinds(std::size_t length) const {
    std::vector<std::size_t> out;
    for (std::size_t k = length; k-- > 0;) out.push_back(before(k).kind);
    return out;
  }

  /// The sum of a geometric series. Its cycles are so short that what is not geometric in them is little, and longer
  /// than the rounding of time.
  std::optional<T> time_left(std::size_t length) const {
    using std::abs, std::pow;
    const T short_part =
        pow(std::numeric_limits<T>::epsilon(), T(1) / 3) / 2;  // of the time since the first: 3e-6 in double
    const T unsteady = T(1e-4);
    const auto cycle = [&](std::size_t k) { return T(before(k * length).t - before((k + 1) * length).t); };
    const T ratio = cycle(0) / cycle(1), ratio_before = cycle(1) / cycle(2);
    const T rounding = 8 * std::numeric_limits<T>::epsilon() * abs(last_.back().t / cycle(0));
    const bool is_steady =
        ratio > 0 && ratio < T(0.999) && abs(ratio - ratio_before) <= unsteady * (1 - ratio) + rounding;
    if (!is_steady || !(rounding < T(0.01) * (1 - ratio))) return std::nullopt;
    if (!(abs(cycle(0)) <= short_part * abs(last_.back().t - begin_))) return std::nullopt;
    return T(cycle(0) * ratio / (1 - ratio));
  }

  T begin_ = T(0);
  std::vector<Instant> last_;
};

}  // namespace maupertuis
