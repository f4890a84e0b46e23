#include "integrator/ensemble/lane_safety.hpp"

#include <cmath>
#include <limits>

namespace maupertuis::ensemble {

LaneSafety::LaneSafety(const Job& job, const LaneWorkspace& work)
    : work_(work),
      n_(job.freedoms),
      width_(static_cast<std::size_t>(work.width())),
      order_(job.control.order),
      parameters_(width_),
      point_(job.kernel, 1),
      point_disks_(point_.program()) {
  const double tolerance = taylor::safe_tolerance(job.options.tolerance);
  const auto known = taylor::SafeLength::shared_by_motions(job.kernel.program(), order_, tolerance);
  lanes_.reserve(width_);
  for (std::size_t lane = 0; lane < width_; ++lane)
    lanes_.push_back({taylor::SafeLength(job.kernel.program(), order_, tolerance, known),
                      taylor::EndCheck(n_, job.options.tolerance),
                      std::vector<double>(n_),
                      {},
                      0});
}

/// The kernel at one point of a lane's motion.
KernelWorkspace& LaneSafety::point_of(std::size_t lane) {
  if (point_lane_ != lane) point_.set_parameters(parameters_[lane]);
  point_lane_ = lane;
  return point_;
}

void LaneSafety::begin(std::size_t lane, std::span<const double> parameters) {
  Lane& l = lanes_[lane];
  parameters_[lane].assign(parameters.begin(), parameters.end());
  if (point_lane_ == lane) point_lane_ = ~std::size_t{0};
  l.constants = work_.constants(static_cast<int>(lane));
  l.safe.set_constants(l.constants.data());
  l.safe.forget();
  l.end.forget();
  l.tau = 0;
}

void LaneSafety::take_state(std::size_t lane, std::vector<double>& q, std::vector<double>& v) const {
  q.resize(n_), v.resize(n_);
  for (std::size_t i = 0; i < n_; ++i)
    q[i] = work_.coordinate(0)[i * width_ + lane], v[i] = work_.coordinate(1)[i * width_ + lane];
}

double LaneSafety::radius(double wanted, double left) const {
  return lanes_.front().safe.disk_radius(std::min(wanted, left));
}

double LaneSafety::within(std::size_t lane, double t, double wanted, double left, const double* sizes) {
  Lane& l = lanes_[lane];
  l.end.note_rates(work_.coordinate(1) + lane, work_.coordinate(2) + lane, width_, std::min(wanted, left));
  if (!l.safe.is_needed()) return wanted;
  if (l.safe.wants_momenta(l.end.rates())) {
    std::vector<double> q, v;
    take_state(lane, q, v);
    KernelWorkspace& point = point_of(lane);
    if (point.evaluate(t, q, v) == KernelStatus::Ok) l.safe.set_momenta(l.end.rates(), point);
  }
  const std::size_t row = static_cast<std::size_t>(work_.coordinate(1) - work_.coordinate(0));
  return l.safe.within({work_.coordinate(0) + lane, row, order_, 1, width_}, t, wanted, left, sizes);
}

void LaneSafety::expect(std::size_t lane, double tau, const double* acceleration) {
  Lane& l = lanes_[lane];
  l.tau = tau;
  for (std::size_t i = 0; i < n_; ++i) l.expected[i] = acceleration[i * width_];
}

bool LaneSafety::holds(std::size_t lane, double t) {
  Lane& l = lanes_[lane];
  if (l.tau == 0 || l.end.agrees(l.expected, work_.coordinate(2) + lane, width_, l.tau)) return true;
  std::vector<double> q, v;
  take_state(lane, q, v);
  return holds_but_for_rounding(lane, work_.coordinate(2) + lane, width_, t, q, v);
}

bool LaneSafety::holds_at(std::size_t lane, double t, std::span<const double> q, std::span<const double> v) {
  Lane& l = lanes_[lane];
  if (l.tau == 0) return true;
  KernelWorkspace& point = point_of(lane);
  if (point.evaluate(t, q, v) != KernelStatus::Ok) return false;
  return l.end.agrees(l.expected, point.coordinate(2), 1, l.tau) ||
         holds_but_for_rounding(lane, point.coordinate(2), 1, t, q, v);
}

bool LaneSafety::holds_but_for_rounding(std::size_t lane, const double* half_by_equations, std::size_t step, double t,
                                        std::span<const double> q, std::span<const double> v) {
  return taylor::agrees_but_for_rounding(lanes_[lane].end, lanes_[lane].expected, half_by_equations, step,
                                         point_of(lane), t, q, v, lanes_[lane].tau, point_disks_);
}

}  // namespace maupertuis::ensemble
