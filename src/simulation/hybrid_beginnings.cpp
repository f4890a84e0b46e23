#include "simulation/hybrid_slips.hpp"

#include "linear_algebra/slip_series.hpp"

#include <maupertuis/kernel.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

/// How slips in space begin (linear_algebra/slip_series.hpp), in double: slips that are bound to each other too.
namespace maupertuis::hybrid {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Series = TimeSeries<double>;

constexpr int degree = direction_degree;
constexpr double negligible = 1e-9;

/// The motion with friction along given directions, and its slips.
class Slips {
 public:
  Slips(const Kernel& kernel, std::span<const double> parameters, double t, std::span<const double> q,
        std::span<const double> v)
      : work_(kernel, degree + 1), parameters_(parameters.begin(), parameters.end()), t_(t), q_(q), v_(v) {}

  /// φ of each contact. All orders of the slips are found.
  bool follow(const std::vector<Series>& angles, std::size_t /*orders*/) {
    directions_.clear();
    std::vector<double> all = parameters_;
    for (const Series& phi : angles) {
      directions_.push_back(cosine_and_sine<double>(phi));
      all.push_back(t_);
      all.insert(all.end(), directions_.back().first.begin(), directions_.back().first.end());
      all.insert(all.end(), directions_.back().second.begin(), directions_.back().second.end());
    }
    given_.assign(all.begin() + static_cast<std::ptrdiff_t>(parameters_.size()), all.end());
    work_.set_parameters(all);
    return work_.expand(t_, q_, v_) == KernelStatus::Ok;
  }

  double across(std::size_t c, std::size_t k) const { return parts(c, k).across; }
  double along(std::size_t c, std::size_t k) const { return parts(c, k).along; }
  const std::vector<double>& given() const { return given_; }

 private:
  AlongAndAcross<double> parts(std::size_t c, std::size_t k) const {
    return {directions_[c], k,
            [&](std::size_t which, std::size_t j) { return work_.event(2 * c + which, static_cast<int>(j)); }};
  }

  KernelWorkspace work_;
  std::vector<double> parameters_;
  double t_;
  std::span<const double> q_, v_;
  std::vector<std::pair<Series, Series>> directions_;
  std::vector<double> given_;
};

/// The directions of slips that begin together.
class Directions {
 public:
  /// `loose`: combinations of the directions that friction does not hold to their slips, the weakest ones, besides
  /// those that it cannot.
  Directions(Slips& slips, const std::vector<double>& towards, Index loose)
      : slips_(slips), loose_(loose), series_(slips, degree, towards, {1e-16, 1e-15, negligible, 1e-4, 60}) {}

  /// The cones give φ_0 to their own rounding only: at a limit, where all is turned little, to its root. Slips that are
  /// bound to each other take the differences of φ_0 from the next order, which moves what was found before.
  bool find() {
    return series_.find([&](std::size_t k, const std::vector<double>& slope, const std::vector<double>& across) {
      using ByRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
      const auto n = at(across.size());
      return correct(k, Eigen::Map<const ByRows>(slope.data(), n, n), -Eigen::Map<const VectorXd>(across.data(), n));
    });
  }

  /// How long from the beginning on they are right to rounding, and the slips grow, at most `most`.
  double length(double most) const { return series_.length(most); }

  /// The largest angle between a slip and its direction a while later.
  double deviation(double since) const {
    double out = 0;
    for (std::size_t c = 0; c < series_.sizes().size(); ++c) {
      double across = 0, along = 0, power = 1;
      for (std::size_t k = 1; k <= degree + 1; ++k) {
        power *= since;
        across += slips_.across(c, k) * power;
        along += slips_.along(c, k) * power;
      }
      out = std::max(out, std::abs(across / along));
    }
    return out;
  }

 private:
  /// Where slips are bound to each other (two feet of a bar have one velocity along it) friction across does the same
  /// to all of them: then v_{t,k+1} tells but sums of the φ_k, and differences of the φ_{k−1}, by what they turn
  /// v_{t,2}. Where they are nearly bound (the bar turns, and slides along itself a little) the series of the
  /// differences is right for next to no time: they may be taken as if they were bound, and whether the slips go along
  /// then is seen.
  bool correct(std::size_t k, const MatrixXd& slope, const VectorXd& right) {
    const Index n = slope.cols();
    Eigen::JacobiSVD<MatrixXd> parts(slope, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const double least =
        negligible * *std::max_element(series_.sizes().begin(), series_.sizes().end()) / static_cast<double>(k + 1);
    const Index free = (parts.singularValues().array() > least).count();
    const MatrixXd bound = parts.matrixV().rightCols(std::min(n - free + loose_, n));
    MatrixXd all(n, n + bound.cols());
    all.leftCols(n) = slope - slope * bound * bound.transpose();
    for (Index c = 0; c < n && bound.cols() > 0; ++c)
      all.row(c).tail(bound.cols()) = (k > 0 ? -slips_.along(static_cast<std::size_t>(c), 2) : 0.0) * bound.row(c);
    Eigen::CompleteOrthogonalDecomposition<MatrixXd> solver;
    solver.setThreshold(negligible);
    const VectorXd by = solver.compute(all).solve(right);
    if (!by.allFinite()) return false;
    const VectorXd before = bound * by.tail(bound.cols());
    std::vector<Series>& angles = series_.angles();
    for (std::size_t c = 0; c < angles.size(); ++c) {
      angles[c][k] += by(at(c));
      if (k > 0) angles[c][k - 1] += before(at(c));
    }
    return true;
  }

  Slips& slips_;
  Index loose_;
  SlipSeries<double, Slips> series_;
};

}  // namespace

std::optional<Given> SpaceSlips::directions_in(const ContactMode& mode, double bound) const {
  Given out;
  std::vector<bool> begins(problem_.system.contacts.size(), false);
  std::vector<double> towards;
  for (std::size_t i = 0; i < begins.size(); ++i) {
    begins[i] = begins_[i] && mode.friction[i] == FrictionState::Slide && std::isfinite(towards_[i]);
    if (begins[i]) towards.push_back(towards_[i]);
  }
  if (towards.empty()) return out;
  out.begins = begins;
  const auto program = problem_.library->program(mode, {stop_speeds(), false, begins});
  Slips slips(*program->slips, problem_.parameters, here_.t, here_.q, here_.v);
  constexpr double astray = 1e-12;
  double length = 0;
  for (std::size_t loose = 0; loose < towards.size(); ++loose) {  // the one that leads furthest
    Directions directions(slips, towards, at(loose));
    const double reached = directions.find() ? directions.length(std::abs(bound - here_.t)) : 0;
    if (!(reached > length) || (loose > 0 && directions.deviation(reached) > astray)) continue;
    length = reached;
    out.values = slips.given();
  }
  if (!(length > 0)) return std::nullopt;
  out.end = here_.t + length;
  return out;
}

}  // namespace maupertuis::hybrid
