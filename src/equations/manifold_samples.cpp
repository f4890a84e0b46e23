#include "equations/manifold_samples.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

namespace maupertuis {
namespace {

constexpr std::size_t attempts = 40;
constexpr std::size_t wanted = 4;
constexpr std::size_t many = 128;      // coordinates
constexpr double near = 0.1;           // of the reach of a coordinate: on the branch of the start
constexpr double longest_time = 0.01;  // s after the start: driven linkages need not close much later

class Sampler {
 public:
  Sampler(const ConstraintManifold& manifold, const MechanicalSystem& system)
      : manifold_(manifold), free_(system.coordinates.size(), false) {
    double length = 0;
    for (const Parameter& p : system.parameters)
      if (p.dimension == dimensions::length()) length = std::max(length, std::abs(p.si_value));
    for (const Coordinate& c : system.coordinates) reach_.push_back(c.kind == "length" && length > 0 ? length : 1);
  }

  /// Any consistent state: the first that is reached from points farther and farther from zero.
  std::optional<MotionState> find() {
    MotionState origin{0, std::vector<double>(free_.size(), 0), std::vector<double>(free_.size(), 0)};
    for (std::size_t attempt = 1; attempt <= attempts; ++attempt)
      if (auto state = consistent(scattered(origin, 2.0 * static_cast<double>(attempt) / attempts), free_))
        return state;
    return std::nullopt;
  }

  /// One coordinate is held where it was put, if that is possible: a singular start draws Newton's method to itself.
  /// Points there count only where there are no others.
  ManifoldSamples around(const MotionState& start) {
    ManifoldSamples away, at_start;
    for (std::size_t attempt = 0; attempt < attempts && away.states.size() < wanted; ++attempt) {
      const MotionState from = scattered(start, near * static_cast<double>(1 + attempt / 4));
      std::vector<bool> held = free_;
      held[attempt % held.size()] = true;
      auto state = consistent(from, held);
      if (!state) state = consistent(from, free_);
      if (!state) continue;
      ManifoldSamples& kept = distance(*state, start) > near / 1000 ? away : at_start;
      kept.states.push_back(std::move(*state));
      kept.beside.push_back(from);
    }
    return away.states.empty() ? at_start : away;
  }

  /// Where the last attempt began.
  const MotionState& last() const { return last_; }

 private:
  MotionState scattered(const MotionState& from, double size) {
    MotionState state = from;
    state.t += longest_time * std::abs(random());
    for (std::size_t i = 0; i < state.q.size(); ++i) {
      // The far end of a long chain is not scattered by a tenth of its distance from the origin.
      const double scale = state.q.size() > many ? reach_[i] : std::max(reach_[i], std::abs(from.q[i]));
      state.q[i] += size * scale * random();
      state.v[i] += reach_[i] * random();
    }
    last_ = state;
    return state;
  }

  double random() { return std::generate_canonical<double, 53>(random_) * 2 - 1; }

  double distance(const MotionState& a, const MotionState& b) const {
    double largest = 0;
    for (std::size_t i = 0; i < a.q.size(); ++i) largest = std::max(largest, std::abs(a.q[i] - b.q[i]) / reach_[i]);
    return largest;
  }

  std::optional<MotionState> consistent(MotionState state, const std::vector<bool>& held) const {
    if (manifold_.move_positions(state, held) && manifold_.move_velocities(state, free_)) return state;
    return std::nullopt;
  }

  const ConstraintManifold& manifold_;
  std::vector<bool> free_;
  std::vector<double> reach_;
  MotionState last_;
  std::mt19937_64 random_{1788};
};

}  // namespace

ManifoldSamples sample_manifold(const ConstraintManifold& manifold, const MechanicalSystem& system,
                                const MotionState* start) {
  Sampler sampler(manifold, system);
  const std::optional<MotionState> any = start ? *start : sampler.find();
  ManifoldSamples out;
  if (any) out = sampler.around(*any);
  if (out.states.empty()) out.clashing = manifold.smallest_clash(sampler.last());
  return out;
}

}  // namespace maupertuis
