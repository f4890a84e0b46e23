#include "simulation/hybrid_slips.hpp"

#include <maupertuis/kernel.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

/// How slips in space begin. At the first instant v_t/|v_t| has no value, and next to it the equations are as stiff as
/// can be: what is across to the force that pulls is braked at the rate μ N/(m |v_t|). The direction d(τ) that the slip
/// has from its beginning on is sought as a polynomial of time, so that v_t(τ) with friction −μ N d(τ) goes along d(τ):
///
///     v_t = τ (v_1 + v_2 τ + …) where friction jumps from μ_s to μ, or is too weak from the beginning
///     v_t = τ² (v_2 + v_3 τ + …) where a force grows beyond what it holds
///
/// With d = (cos φ, sin φ), φ = Σ φ_k τ^k, the coefficient v_{k+1} of the slip depends on φ_0, …, φ_k, on the last of
/// them linearly, and what v_t has across to d vanishes order by order. In the second case the series is an asymptotic
/// one (the origin is an irregular singular point of φ' = …/|v_t|): it is cut where its last terms are rounding.

namespace maupertuis::hybrid {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Series = std::vector<double>;  // coefficients of powers of τ

constexpr int degree = direction_degree;

/// cos φ and sin φ: c' = −s φ', s' = c φ'.
std::pair<Series, Series> cosine_and_sine(const Series& phi) {
  Series c(degree + 1, 0), s(degree + 1, 0);
  c[0] = std::cos(phi[0]), s[0] = std::sin(phi[0]);
  for (std::size_t k = 1; k <= degree; ++k) {
    for (std::size_t j = 1; j <= k; ++j) {
      c[k] -= static_cast<double>(j) * phi[j] * s[k - j];
      s[k] += static_cast<double>(j) * phi[j] * c[k - j];
    }
    c[k] /= static_cast<double>(k), s[k] /= static_cast<double>(k);
  }
  return {c, s};
}

/// The motion with friction along given directions, and its slips.
class Slips {
 public:
  Slips(const Kernel& kernel, std::span<const double> parameters, double t, std::span<const double> q,
        std::span<const double> v)
      : work_(kernel, degree + 1), parameters_(parameters.begin(), parameters.end()), t_(t), q_(q), v_(v) {}

  /// φ of each contact.
  bool follow(const std::vector<Series>& angles) {
    directions_.clear();
    std::vector<double> all = parameters_;
    for (const Series& phi : angles) {
      directions_.push_back(cosine_and_sine(phi));
      all.push_back(t_);
      all.insert(all.end(), directions_.back().first.begin(), directions_.back().first.end());
      all.insert(all.end(), directions_.back().second.begin(), directions_.back().second.end());
    }
    given_.assign(all.begin() + static_cast<std::ptrdiff_t>(parameters_.size()), all.end());
    work_.set_parameters(all);
    return work_.expand(t_, q_, v_) == KernelStatus::Ok;
  }

  /// Coefficient k ≥ 1 of what the slip of contact c has across to d, and along it; what is there at the beginning is
  /// rounding.
  double across(std::size_t c, int k) const { return sum(c, k, -1); }
  double along(std::size_t c, int k) const { return sum(c, k, 1); }
  const std::vector<double>& given() const { return given_; }

 private:
  double sum(std::size_t c, int k, int which) const {
    const auto& [cosine, sine] = directions_[c];
    double out = 0;
    for (int j = 1; j <= k; ++j) {
      const double x = work_.event(2 * c, j), y = work_.event(2 * c + 1, j);
      const auto rest = static_cast<std::size_t>(k - j);
      if (rest > static_cast<std::size_t>(degree)) continue;
      out += which > 0 ? x * cosine[rest] + y * sine[rest] : y * cosine[rest] - x * sine[rest];
    }
    return out;
  }

  KernelWorkspace work_;
  std::vector<double> parameters_;
  double t_;
  std::span<const double> q_, v_;
  std::vector<std::pair<Series, Series>> directions_;
  std::vector<double> given_;
};

/// The directions of slips that begin together, one order after the other.
class Directions {
 public:
  /// `loose`: combinations of the directions that friction does not hold to their slips, the weakest ones, besides
  /// those that it cannot.
  Directions(Slips& slips, const std::vector<double>& towards, Index loose) : slips_(slips), loose_(loose) {
    for (const double angle : towards) {
      angles_.emplace_back(degree + 1, 0.0);
      angles_.back()[0] = angle;
    }
  }

  bool find() {
    // The cones give φ_0 to their own rounding only: at a limit, where all is turned little, to its root. Slips that
    // are bound to each other take the differences of φ_0 from the next order, which moves what was found before.
    constexpr int most_sweeps = 60;
    constexpr double settled = 1e-15, falls = 0.9;
    if (!find_sizes()) return false;
    double before = std::numeric_limits<double>::infinity();
    for (int sweep = 0; sweep < most_sweeps; ++sweep) {
      const std::vector<Series> last = angles_;
      if (!improve_all()) return false;
      double moved = 0;
      for (std::size_t c = 0; c < angles_.size(); ++c) moved = std::max(moved, std::abs(angles_[c][0] - last[c][0]));
      if (moved <= settled || !(moved < falls * before)) break;
      before = moved;
    }
    return slips_.follow(angles_);
  }

  /// How long from the beginning on they are right to rounding, and the slips grow: infinite where nothing tells.
  double length() const {
    constexpr double rounding = 1e-16;
    constexpr std::size_t last = 6;
    double out = std::numeric_limits<double>::infinity();
    for (std::size_t c = 0; c < angles_.size(); ++c) {
      for (std::size_t k = degree - last + 1; k <= degree; ++k)
        if (angles_[c][k] != 0)
          out = std::min(out, std::pow(rounding / std::abs(angles_[c][k]), 1 / static_cast<double>(k)));
      out = std::min(out, growth(c));
    }
    return out;
  }

  /// The largest angle between a slip and its direction a while later.
  double deviation(double since) const {
    double out = 0;
    for (std::size_t c = 0; c < angles_.size(); ++c) {
      double across = 0, along = 0, power = 1;
      for (int k = 1; k <= degree + 1; ++k) {
        power *= since;
        across += slips_.across(c, k) * power;
        along += slips_.along(c, k) * power;
      }
      out = std::max(out, std::abs(across / along));
    }
    return out;
  }

 private:
  bool improve_all() {
    constexpr int most_turns = 8;
    for (int turn = 0; turn < most_turns; ++turn)
      if (!improve(0)) return false;
    for (std::size_t k = 1; k <= degree; ++k)
      if (!improve(k)) return false;
    return true;
  }

  /// What friction does to v̇_t: half of what changes where it is turned round.
  bool find_sizes() {
    sizes_.assign(angles_.size(), 0);
    for (const double turned : {0.0, half_turn}) {
      for (Series& phi : angles_) phi[0] += turned;
      const bool moves = slips_.follow(angles_);
      for (Series& phi : angles_) phi[0] -= turned;
      if (!moves) return false;
      for (std::size_t c = 0; c < angles_.size(); ++c) sizes_[c] += 0.5 * slips_.along(c, 1);
    }
    for (double& size : sizes_) size = std::abs(size);
    return true;
  }

  std::optional<VectorXd> across(std::size_t k) {
    if (!slips_.follow(angles_)) return std::nullopt;
    VectorXd out(at(angles_.size()));
    for (std::size_t c = 0; c < angles_.size(); ++c) out(at(c)) = slips_.across(c, static_cast<int>(k) + 1);
    return out;
  }

  /// φ_k from the coefficient k + 1 of what the slips have across, which is linear in it for k ≥ 1.
  bool improve(std::size_t k) {
    constexpr double change = 1e-4;  // of an angle φ_0
    const auto here = across(k);
    if (!here) return false;
    if (k <= 1) {  // later slopes are known from this one
      slope_.resize(at(angles_.size()), at(angles_.size()));
      for (std::size_t c = 0; c < angles_.size(); ++c) {
        const double by = k == 0 ? change : 1;
        angles_[c][k] += by;
        const auto there = across(k);
        angles_[c][k] -= by;
        if (!there) return false;
        slope_.col(at(c)) = (*there - *here) / by;
      }
      along_.resize(at(angles_.size()));
      for (std::size_t c = 0; c < angles_.size(); ++c) along_(at(c)) = slips_.along(c, 1);
    }
    MatrixXd slope = slope_;
    if (k > 1) {  // ∂v̇_t/∂d goes with 1/(k + 1), what turns the slip itself does not
      slope.diagonal() += along_;
      slope *= 2 / static_cast<double>(k + 1);
      slope.diagonal() -= along_;
    }
    return correct(k, slope, VectorXd(-*here));
  }

  /// Where slips are bound to each other (two feet of a bar have one velocity along it) friction across does the same
  /// to all of them: then v_{t,k+1} tells but sums of the φ_k, and differences of the φ_{k−1}, by what they turn
  /// v_{t,2}. Where they are nearly bound (the bar turns, and slides along itself a little) the series of the
  /// differences is right for next to no time: they may be taken as if they were bound, and whether the slips go along
  /// then is seen.
  bool correct(std::size_t k, const MatrixXd& slope, const VectorXd& right) {
    const Index n = slope.cols();
    Eigen::JacobiSVD<MatrixXd> parts(slope, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const double least = negligible_ * *std::max_element(sizes_.begin(), sizes_.end()) / static_cast<double>(k + 1);
    const Index free = (parts.singularValues().array() > least).count();
    const MatrixXd bound = parts.matrixV().rightCols(std::min(n - free + loose_, n));
    MatrixXd all(n, n + bound.cols());
    all.leftCols(n) = slope - slope * bound * bound.transpose();
    for (Index c = 0; c < n && bound.cols() > 0; ++c)
      all.row(c).tail(bound.cols()) = (k > 0 ? -slips_.along(static_cast<std::size_t>(c), 2) : 0.0) * bound.row(c);
    Eigen::CompleteOrthogonalDecomposition<MatrixXd> solver;
    solver.setThreshold(negligible_);
    const VectorXd by = solver.compute(all).solve(right);
    if (!by.allFinite()) return false;
    const VectorXd before = bound * by.tail(bound.cols());
    for (std::size_t c = 0; c < angles_.size(); ++c) {
      angles_[c][k] += by(at(c));
      if (k > 0) angles_[c][k - 1] += before(at(c));
    }
    return true;
  }

  /// Until the later powers of a slip may have taken half of what its first one is: those that add to it do not.
  double growth(std::size_t c) const {
    const int first = std::abs(slips_.along(c, 1)) > negligible_ * sizes_[c] ? 1 : 2;
    const double leads = first * slips_.along(c, first);
    if (!(leads > 0)) return 0;
    double most = std::numeric_limits<double>::infinity();
    for (int k = first + 1; k <= degree + 1; ++k)
      if (const double x = -k * slips_.along(c, k); x > 0)
        most = std::min(most, std::pow(0.5 * leads / x, 1.0 / (k - first)));
    return 0.5 * most;
  }

  static constexpr double negligible_ = 1e-9, half_turn = 3.141592653589793;
  Slips& slips_;
  Index loose_;
  std::vector<Series> angles_;
  std::vector<double> sizes_;  // of v̇_t, by what friction does there
  MatrixXd slope_;             // of v_{t,2} across by φ_1
  VectorXd along_;             // v_{t,1}
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
    const double reached = directions.find() ? std::min(directions.length(), std::abs(bound - here_.t)) : 0;
    if (!(reached > length) || (loose > 0 && directions.deviation(reached) > astray)) continue;
    length = reached;
    out.values = slips.given();
  }
  if (!(length > 0)) return std::nullopt;
  out.end = here_.t + length;
  return out;
}

}  // namespace maupertuis::hybrid
