#include "analysis/orbits/chaos.hpp"

#include "linear_algebra/dense.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace maupertuis::orbits {
namespace {

constexpr double flat = 1e-6;                  // of the largest extent
constexpr double rest = 1e-12;                 // of the place
constexpr double rounding_of_states = 32;      // in roundings of a component: what rows and their factors differ by
constexpr double rounding_of_a_motion = 1000;  // what the steps of a motion leave, before it grows
constexpr double least_oscillations = 10;      // fewer may be one passage next to an unstable rest
/// Of the growth over the whole run that of the second half is a half where it is exponential, a quarter where it is
/// like a power of t.
constexpr double least_share = 0.35;

constexpr std::size_t enough_dimensions = 3;  // for chaos
constexpr std::size_t states_between = 4;     // counts of dimensions

Eigen::VectorXd components_of(const MotionState& state) {
  const auto n = static_cast<Eigen::Index>(state.q.size());
  Eigen::VectorXd x(2 * n);
  x << Eigen::Map<const Eigen::VectorXd>(state.q.data(), n), Eigen::Map<const Eigen::VectorXd>(state.v.data(), n);
  return x;
}

}  // namespace

/// R of the QR factors takes the place of rows: moments would lose what is below the root of rounding.
void StateSpan::add(const Eigen::VectorXd& x) {
  const Eigen::Index width = x.size();
  if (states_++ == 0) {
    first_ = x;
    magnitudes_ = x.cwiseAbs();
    rows_ = Eigen::MatrixXd::Zero(2 * width, width);
  }
  magnitudes_ = magnitudes_.cwiseMax(x.cwiseAbs());
  rows_.row(filled_++) = (x - first_).transpose();
  if (filled_ < rows_.rows()) return;
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(rows_);
  rows_.topRows(width) = qr.matrixQR().topRows(width).triangularView<Eigen::Upper>();
  filled_ = width;
}

Eigen::VectorXd StateSpan::in_roundings() const {
  constexpr double eps = std::numeric_limits<double>::epsilon();
  const auto unit = [](double magnitude) { return magnitude > 0 ? 1 / (eps * magnitude) : 0; };
  const Eigen::MatrixXd scaled = rows_.topRows(filled_) * magnitudes_.unaryExpr(unit).asDiagonal();
  return Eigen::JacobiSVD<Eigen::MatrixXd>(scaled).singularValues() / std::sqrt(static_cast<double>(states_));
}

void VisitedStates::add_of_transient(const MotionState& state, double growth) {
  whole_.add(components_of(state));
  growth_ = std::max(growth_, growth);
  if (++seen_ % states_between == 0 && certain_ < enough_dimensions) certain_ = certain_now();
}

void VisitedStates::add(const MotionState& state, double growth) {
  add_of_transient(state, growth);
  const auto n = static_cast<Eigen::Index>(state.q.size());
  const Eigen::VectorXd x = components_of(state);
  averaged_.add(x);
  if (largest_.empty()) {
    first_ = x;
    ways_ = Eigen::VectorXd::Zero(n);
    lowest_ = highest_ = x.head(n);
    slowest_ = fastest_ = x.tail(n);
    variation_ = Eigen::VectorXd::Zero(2 * n);
    last_ = x;
  }
  variation_ += (x - last_).cwiseAbs();
  last_ = x;
  slowest_ = slowest_.cwiseMin(x.tail(n));
  fastest_ = fastest_.cwiseMax(x.tail(n));
  ways_ += x.tail(n).cwiseAbs();
  speeds_.push_back(x.tail(n).cwiseQuotient(sizes_.tail(n)).lpNorm<Eigen::Infinity>());
  lowest_ = lowest_.cwiseMin(x.head(n));
  highest_ = highest_.cwiseMax(x.head(n));
  const Eigen::VectorXd from_first = (x - first_).cwiseQuotient(sizes_);
  double largest = 0;
  for (Eigen::Index i = 0; i < 2 * n; ++i)
    if (i >= n || system_.coordinates[static_cast<std::size_t>(i)].kind != "angle")
      largest = std::max(largest, std::abs(from_first[i]));
  largest_.push_back(largest);
}

std::size_t VisitedStates::most_dimensions() const {
  const auto places = lowest_.cwiseAbs().cwiseMax(highest_.cwiseAbs()).array();
  if (((highest_ - lowest_).array() <= rest * places).all()) return 0;
  return static_cast<std::size_t>((averaged_.in_roundings().array() > rounding_of_states).count());
}

/// Rounding grows as neighbours do: what is certain is seen early, and stays.
std::size_t VisitedStates::certain_now() const {
  const Eigen::VectorXd extents = whole_.in_roundings();
  const double limit = std::min(rounding_of_a_motion * std::exp(growth_), flat * extents.maxCoeff());
  return std::max(certain_, static_cast<std::size_t>((extents.array() > limit).count()));
}

std::size_t VisitedStates::certain_dimensions() const {
  if (*std::max_element(largest_.begin(), largest_.end()) <= flat) return 0;  // measured by sizes: it rests
  return certain_now();
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

/// On the stable manifold of a saddle coordinate and velocity come in without turning round more than once. A particle
/// that drifts goes on too, but its velocity comes back.
bool VisitedStates::comes_back(Eigen::Index component) const {
  constexpr double to_and_fro = 2;  // ranges
  const auto n = lowest_.size();
  const double range =
      component < n ? highest_[component] - lowest_[component] : fastest_[component - n] - slowest_[component - n];
  return variation_[component] > to_and_fro * range;
}

double VisitedStates::share_without_return(const Eigen::VectorXd& direction) const {
  double share = 0;
  const auto n = ways_.size();
  for (Eigen::Index i = 0; i < n; ++i) {
    const double place = std::max(std::abs(lowest_[i]), std::abs(highest_[i]));
    const bool rests = highest_[i] - lowest_[i] <= rest * place;
    if (rests || !(comes_back(i) || comes_back(n + i)))
      share += direction[i] * direction[i] + direction[n + i] * direction[n + i];
  }
  return share;
}

bool VisitedStates::keeps_moving(double duration) const {
  const auto middle = speeds_.begin() + static_cast<std::ptrdiff_t>(speeds_.size() / 2);
  const double before = *std::max_element(speeds_.begin(), middle), after = *std::max_element(middle, speeds_.end());
  return after > 0.5 * before && oscillations(duration) > 1;
}

Chaos chaos_of(const GrowthOfNeighbours& growth, const VisitedStates& states, double duration, std::size_t d,
               bool driven, bool flows) {
  const auto leaves_no_room = [&](std::size_t dimensions) { return flows && std::min(d, dimensions) + driven <= 2; };
  if (leaves_no_room(states.most_dimensions())) return Chaos::Excluded;
  const auto highest_power = static_cast<double>(d - 1);
  const bool exponential = growth.whole > std::max(growth.certain, highest_power * growth.log_of_time) &&
                           growth.second_half > least_share * growth.whole &&
                           growth.second_half > highest_power * std::numbers::ln2;
  if (!exponential || leaves_no_room(states.certain_dimensions())) return Chaos::NotShown;
  if (!(states.oscillations(duration) > least_oscillations)) return Chaos::NotShown;
  if (states.growth_of_second_half() > 0.5 * growth.second_half) return Chaos::RunsAway;
  // Neighbours of a rest that is unstable part from it, and from what comes to it, however the other coordinates move:
  // chaos needs motions that come back.
  constexpr double nearly_all = 0.99;
  return growth.share_without_return > nearly_all ? Chaos::NotShown : Chaos::Shown;
}

}  // namespace maupertuis::orbits
