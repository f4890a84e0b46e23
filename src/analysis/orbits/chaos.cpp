#include "analysis/orbits/chaos.hpp"

#include "linear_algebra/dense.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace maupertuis::orbits {
namespace {

constexpr double flat = 1e-6;              // of the largest extent
constexpr double least_oscillations = 10;  // fewer may be one passage next to an unstable rest
/// Of the growth over the whole run that of the second half is a half where it is exponential, a quarter where it is
/// like a power of t.
constexpr double least_share = 0.35;

}  // namespace

void VisitedStates::add(const MotionState& state) {
  const auto n = static_cast<Eigen::Index>(state.q.size());
  Eigen::VectorXd x(2 * n);
  x << Eigen::Map<const Eigen::VectorXd>(state.q.data(), n), Eigen::Map<const Eigen::VectorXd>(state.v.data(), n);
  if (largest_.empty()) {
    first_ = x;
    ways_ = Eigen::VectorXd::Zero(n);
    lowest_ = highest_ = x.head(n);
    moments_ = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  }
  ways_ += x.tail(n).cwiseAbs();
  speeds_.push_back(x.tail(n).cwiseQuotient(sizes_.tail(n)).lpNorm<Eigen::Infinity>());
  lowest_ = lowest_.cwiseMin(x.head(n));
  highest_ = highest_.cwiseMax(x.head(n));
  const Eigen::VectorXd from_first = (x - first_).cwiseQuotient(sizes_);
  moments_ += from_first * from_first.transpose();
  double largest = 0;
  for (Eigen::Index i = 0; i < 2 * n; ++i)
    if (i >= n || system_.coordinates[static_cast<std::size_t>(i)].kind != "angle")
      largest = std::max(largest, std::abs(from_first[i]));
  largest_.push_back(largest);
}

std::size_t VisitedStates::dimensions() const {
  const Eigen::VectorXd squares = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(moments_).eigenvalues();
  const double largest = squares.maxCoeff();
  if (!(largest > flat * flat)) return 0;  // measured by sizes: it rests
  return static_cast<std::size_t>((squares.array() > flat * flat * largest).count());
}

double VisitedStates::growth_of_second_half() const {
  const auto middle = largest_.begin() + static_cast<std::ptrdiff_t>(largest_.size() / 2);
  const double before = *std::max_element(largest_.begin(), middle), after = *std::max_element(middle, largest_.end());
  return after > before ? std::log(after / before) : 0;
}

double VisitedStates::oscillations(double duration) const {
  double most = 0;
  for (Eigen::Index i = 0; i < ways_.size(); ++i) {
    const double way = ways_[i] * duration / static_cast<double>(largest_.size());
    double range = highest_[i] - lowest_[i];
    if (system_.coordinates[static_cast<std::size_t>(i)].kind == "angle") range = std::min(range, 2 * std::numbers::pi);
    if (range > 0) most = std::max(most, way / (2 * range));
  }
  return most;
}

bool VisitedStates::keeps_moving(double duration) const {
  const auto middle = speeds_.begin() + static_cast<std::ptrdiff_t>(speeds_.size() / 2);
  const double before = *std::max_element(speeds_.begin(), middle), after = *std::max_element(middle, speeds_.end());
  return after > 0.5 * before && oscillations(duration) > 1;
}

Chaos chaos_of(const GrowthOfNeighbours& growth, const VisitedStates& states, double duration, std::size_t d,
               bool driven, bool flows) {
  if (flows && std::min(d, states.dimensions()) + driven <= 2) return Chaos::Excluded;
  const auto highest_power = static_cast<double>(d - 1);
  const bool exponential = growth.whole > std::max(growth.certain, highest_power * growth.log_of_time) &&
                           growth.second_half > least_share * growth.whole &&
                           growth.second_half > highest_power * std::numbers::ln2;
  if (!exponential || !(states.oscillations(duration) > least_oscillations)) return Chaos::NotShown;
  return states.growth_of_second_half() > 0.5 * growth.second_half ? Chaos::RunsAway : Chaos::Shown;
}

}  // namespace maupertuis::orbits
