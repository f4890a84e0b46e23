#include "analysis/linearization/steady_state.hpp"

#include <maupertuis/interrupt_scope.hpp>

#include "analysis/linearization/dense.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

constexpr int most_turns = 80;
constexpr double arrived = 1e-9;         // of what is left, by the sizes of coordinates
constexpr double rank_threshold = 1e-11;
constexpr double rounding_of_work = 1e-14;

}  // namespace

SteadyState::SteadyState(PointEquations::Impl& equations, const std::vector<Translation>& translations, Held held,
                         std::vector<double> momenta, std::vector<double> sizes)
    : e_(equations), translations_(translations), momenta_(std::move(momenta)), sizes_(std::move(sizes)) {
  for (std::size_t i = 0; i < e_.n; ++i)
    if (!held.q[i]) free_q_.push_back(i);
  for (std::size_t k = 0; k < translations.size(); ++k)
    if (!held.rates[k]) free_rates_.push_back(k);
  for (const std::size_t k : free_rates_)
    if (!std::isnan(momenta_[k])) kept_momenta_.push_back(k);
  by_rates_ = Matrix::Zero(static_cast<Index>(e_.n), static_cast<Index>(free_rates_.size()));
  for (std::size_t k = 0; k < free_rates_.size(); ++k)
    by_rates_.col(static_cast<Index>(k)) = to_eigen(translations[free_rates_[k]].direction);
}

SteadyState::System SteadyState::system_at(const OperatingPoint& point) const {
  const auto q = static_cast<Index>(free_q_.size()), c = static_cast<Index>(free_rates_.size()), m = static_cast<Index>(e_.m);
  const RowsAtPoint balance = e_.at(e_.balance, point), positions = e_.at(e_.positions, point),
                    velocities = e_.at(e_.velocities, point), momenta = e_.at(e_.momenta, point);
  const auto kept = static_cast<Index>(kept_momenta_.size());
  const Index rows = balance.value.size() + positions.value.size() + velocities.value.size() + kept;
  System out{Vector::Zero(rows), Matrix::Zero(rows, q + c + m)};
  Index row = 0;
  for (const RowsAtPoint* part : {&balance, &positions, &velocities}) {
    const Index count = part->value.size();
    out.f.segment(row, count) = part->value;
    for (Index j = 0; j < q; ++j) out.j.block(row, j, count, 1) = part->by_q.col(static_cast<Index>(free_q_[static_cast<std::size_t>(j)]));
    out.j.block(row, q, count, c) = part->by_v * by_rates_;
    out.j.block(row, q + c, count, m) = part->by_multipliers;
    row += count;
  }
  for (const std::size_t k : kept_momenta_) {
    const Vector d = to_eigen(translations_[k].direction);
    out.f[row] = d.dot(momenta.value) - momenta_[k];
    for (Index j = 0; j < q; ++j) out.j(row, j) = d.dot(momenta.by_q.col(static_cast<Index>(free_q_[static_cast<std::size_t>(j)])));
    out.j.block(row, q, 1, c) = d.transpose() * momenta.by_v * by_rates_;
    ++row;
  }
  return out;
}

Vector SteadyState::unknowns(const OperatingPoint& point) const {
  Vector z(static_cast<Index>(free_q_.size() + free_rates_.size() + e_.m));
  Index at = 0;
  for (const std::size_t i : free_q_) z[at++] = point.q[i];
  for (const std::size_t k : free_rates_) z[at++] = point.v[translations_[k].pivot];
  for (const double l : point.multipliers) z[at++] = l;
  return z;
}

void SteadyState::place(const Vector& z, OperatingPoint& point) const {
  Index at = 0;
  for (const std::size_t i : free_q_) point.q[i] = z[at++];
  std::vector<double> rates;
  for (const Translation& t : translations_) rates.push_back(point.v[t.pivot]);
  for (const std::size_t k : free_rates_) rates[k] = z[at++];
  Vector v = Vector::Zero(static_cast<Index>(e_.n));
  for (std::size_t k = 0; k < rates.size(); ++k) v += rates[k] * to_eigen(translations_[k].direction);
  point.v = to_list(v);
  for (double& l : point.multipliers) l = z[at++];
}

void SteadyState::fit_multipliers(OperatingPoint& point) const {
  if (e_.m == 0) return;
  std::fill(point.multipliers.begin(), point.multipliers.end(), 0);
  const RowsAtPoint balance = e_.at(e_.balance, point);
  if (!balance.value.allFinite() || !balance.by_multipliers.allFinite()) return;
  const Vector fit = least_squares(balance.by_multipliers, -balance.value, rank_threshold).x;
  if (fit.allFinite()) point.multipliers = to_list(fit);
}

/// What the unknowns of typical size do to a row.
double SteadyState::scale_of(const System& s, const Vector& z, Index row) const {
  double scale = 0;
  for (Index j = 0; j < s.j.cols(); ++j) {
    const double typical = static_cast<std::size_t>(j) < free_q_.size() ? sizes_[free_q_[static_cast<std::size_t>(j)]] : 0.0;
    scale = std::max(scale, std::abs(s.j(row, j)) * std::max(std::abs(z[j]), typical));
  }
  return scale;
}

/// The largest row, divided by its scale: a relative error of positions. The first n rows are forces, and forces times typical sizes are
/// works, which compare: a force that no unknown changes (one sideways on a bicycle that runs upright) is rounding of the others.
double SteadyState::scaled(const System& s, const Vector& z) const {
  if (!s.f.allFinite() || !s.j.allFinite()) return HUGE_VAL;
  const auto forces = static_cast<Index>(e_.n);
  double work = 0;
  for (Index i = 0; i < forces; ++i) work = std::max(work, scale_of(s, z, i) * sizes_[static_cast<std::size_t>(i)]);
  double largest = 0;
  for (Index i = 0; i < s.f.size(); ++i) {
    if (s.f[i] == 0 || (i < forces && std::abs(s.f[i]) * sizes_[static_cast<std::size_t>(i)] <= rounding_of_work * work)) continue;
    const double scale = scale_of(s, z, i);
    largest = std::max(largest, scale > 0 ? std::abs(s.f[i]) / scale : HUGE_VAL);
  }
  return largest;
}

double SteadyState::residual_at(OperatingPoint& point) const {
  fit_multipliers(point);
  return scaled(system_at(point), unknowns(point));
}

/// Directions of the kernel along which there are solutions. A kernel alone is none: where two equilibria meet it has a dimension too,
/// and leads nowhere.
std::size_t SteadyState::family_at(const OperatingPoint& point, const System& s, const Vector& z) const {
  const Equilibration by(s.j);
  const KernelFirst split = kernel_first(by.of(s.j), rank_threshold * std::max(1.0, by.of(s.j).norm()));
  constexpr double step = 1e-3, curved = 0.1;
  std::size_t out = 0;
  for (Index k = 0; k < split.kernel; ++k) {
    Vector direction = by.columns.cwiseProduct(split.basis.col(k));
    double size = 0;   // of the largest move, in typical sizes; multipliers do not count
    for (std::size_t i = 0; i < free_q_.size(); ++i) size = std::max(size, std::abs(direction[static_cast<Index>(i)]) / sizes_[free_q_[i]]);
    for (std::size_t i = 0; i < free_rates_.size(); ++i) {
      const auto at = static_cast<Index>(free_q_.size() + i);
      size = std::max(size, std::abs(direction[at]) / std::max(1.0, std::abs(z[at])));
    }
    if (!(size > 0)) continue;
    direction *= step / size;
    OperatingPoint moved = point;
    place(z + direction, moved);
    const auto there = solve(moved, false);
    if (!there) continue;
    const Vector gone = unknowns(there->point) - z;
    out += (gone - direction).cwiseQuotient(by.columns).norm() < curved * direction.cwiseQuotient(by.columns).norm();
  }
  return out;
}

std::optional<SteadyState::Solution> SteadyState::solve(const OperatingPoint& from, bool with_family) const {
  OperatingPoint point = from;
  std::fill(point.a.begin(), point.a.end(), 0);
  Vector z = unknowns(point);
  place(z, point);
  fit_multipliers(point);
  z = unknowns(point);
  System s = system_at(point);
  double error = scaled(s, z);
  Index rank = 0;
  for (int turn = 0; turn < most_turns; ++turn) {
    interrupt_of(*e_.system->context).throw_if_asked();
    if (!std::isfinite(error) && !(s.f.allFinite() && s.j.allFinite())) return std::nullopt;
    const Equilibration by(s.j);
    const Vector weighted = by.rows.cwiseProduct(s.f);
    const LeastSquares solved = least_squares(by.of(s.j), -weighted, rank_threshold);
    rank = solved.rank;
    const Vector step = by.columns.cwiseProduct(solved.x.col(0));
    if (s.f.isZero(0) || !step.allFinite()) break;
    bool closer = false;
    OperatingPoint trial = point;
    Vector moved = z;
    System there = s;
    for (double damping = 1; !closer && damping > 1e-6; damping /= 2) {
      moved = z + damping * step;
      place(moved, trial);
      there = system_at(trial);
      closer = there.f.allFinite() && there.j.allFinite() &&
               by.rows.cwiseProduct(there.f).norm() < (1 - 1e-4 * damping) * weighted.norm();
    }
    if (!closer) break;
    point = trial;
    z = moved;
    s = there;
    error = scaled(s, z);
  }
  if (!(error <= arrived)) return std::nullopt;
  return Solution{point, error, with_family && rank < s.j.cols() ? family_at(point, s, z) : 0};
}

}  // namespace maupertuis
