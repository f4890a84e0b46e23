#include "equations/manifold_samples.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

namespace maupertuis {
namespace {

constexpr int attempts = 40;
constexpr std::size_t wanted = 4;
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
    for (int attempt = 0; attempt < attempts; ++attempt)
      if (auto state = consistent(scattered(origin, 2.0 * (attempt + 1) / attempts))) return state;
    return std::nullopt;
  }

  ManifoldSamples around(const MotionState& start) {
    ManifoldSamples out;
    for (int attempt = 0; attempt < attempts && out.states.size() < wanted; ++attempt) {
      const MotionState from = scattered(start, near * (1 + attempt % 4));  // farther ones leave a singular start
      if (auto state = consistent(from)) out.states.push_back(std::move(*state)), out.beside.push_back(from);
    }
    return out;
  }

  MotionState scattered(const MotionState& from, double size) {
    MotionState state = from;
    state.t += longest_time * std::abs(random());
    for (std::size_t i = 0; i < state.q.size(); ++i) {
      state.q[i] += size * std::max(reach_[i], std::abs(from.q[i])) * random();
      state.v[i] += reach_[i] * random();
    }
    return state;
  }

 private:
  double random() { return std::generate_canonical<double, 53>(random_) * 2 - 1; }

  std::optional<MotionState> consistent(MotionState state) const {
    if (manifold_.move_positions(state, free_) && manifold_.move_velocities(state, free_)) return state;
    return std::nullopt;
  }

  const ConstraintManifold& manifold_;
  std::vector<bool> free_;
  std::vector<double> reach_;
  std::mt19937_64 random_{1788};
};

}  // namespace

ManifoldSamples sample_manifold(const ConstraintManifold& manifold, const MechanicalSystem& system, const MotionState* start) {
  Sampler sampler(manifold, system);
  const std::optional<MotionState> any = start ? *start : sampler.find();
  ManifoldSamples out;
  if (any) out = sampler.around(*any);
  const MotionState origin{0, std::vector<double>(system.coordinates.size(), 0), std::vector<double>(system.coordinates.size(), 0)};
  if (out.states.empty()) out.clashing = manifold.smallest_clash(sampler.scattered(any.value_or(origin), near));
  return out;
}

}  // namespace maupertuis
