#include "analysis/orbits/chaos.hpp"
#include "analysis/orbits/divergence.hpp"
#include "analysis/orbits/drive.hpp"
#include "analysis/orbits/messages.hpp"
#include "analysis/orbits/survey.hpp"
#include "linear_algebra/dense.hpp"

#include <maupertuis/degenerate.hpp>

#include <maupertuis/orbits.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

/// Directions are carried by the tangent equations and orthogonalized at intervals: the logarithms of what the
/// orthogonalization takes away add up to the exponents, the largest first (Benettin, Galgani, Giorgilli and Strelcyn,
/// Meccanica 15, 1980; Shimada and Nagashima, Prog. Theor. Phys. 61, 1979). The exponents do not depend on the measure
/// of directions; numbers do, so that every component is measured by the size it gets along the motion.
namespace maupertuis {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using Index = Eigen::Index;

constexpr std::size_t most_blocks = 20;
constexpr std::size_t rows_of_convergence = 400;
constexpr double steps_of_interval =
    8;  // Taylor steps between orthogonalizations: directions grow by some e in a step at most
constexpr double least_intervals = 40;
/// The logarithm of the factor by which directions may part before they are made orthonormal again: rounding of the
/// largest is 1e-10 of the smallest then.
constexpr double most_parting = 14;
constexpr int most_halvings = 40;
constexpr double most_intervals = 1e6;  // each keeps the logarithms of its directions
constexpr double most_steps_of_transient = 1e8;

class LyapunovRun {
 public:
  LyapunovRun(const Model& model, const EquationsOfMotion& equations, const LyapunovOptions& options,
              Diagnostics& diagnostics)
      : model_(model),
        equations_(equations),
        options_(options),
        diagnostics_(diagnostics),
        geometry_(equations),
        flow_(model, equations, {0, 100'000'000, options.interrupt}) {}

  std::optional<LyapunovResult> carry_out() {
    if (!plan() || !choose_directions() || !warm_up()) return std::nullopt;
    if (takes_all() && !flow_.through_modes()) divergence_.emplace(equations_, geometry_);
    if (flow_.through_modes() && !geometry_.symplectic()) volume_.reset();
    for (std::uint64_t k = 0; k < intervals_ && interval(); ++k) tell_progress();
    if (logs_.empty()) return std::nullopt;  // told
    average();
    return std::move(out_);
  }

 private:
  bool plan() {
    const auto start = consistent_start(model_, equations_, diagnostics_);
    const auto duration = length_of_run();
    if (!start || !duration) return false;
    transient_ = options_.transient.value_or(0.1 * *duration);
    if (!(transient_ >= 0 && std::isfinite(transient_))) return orbits::refuse_no_time("the transient", diagnostics_);
    const MotionKernel motion = free_motion_kernel(equations_);
    const double look = std::min(*duration, std::max(0.02 * *duration, transient_));
    const orbits::Survey seen = orbits::survey(model_, equations_, motion, start->state, look, options_.interrupt);
    if (seen.steps == 0) return orbits::refuse_end(start->state.t, seen.ended, diagnostics_);
    flow_.set_usual_sizes(seen.sizes);
    sizes_ = Eigen::Map<const Vector>(seen.sizes.data(), static_cast<Index>(seen.sizes.size()));
    const double step = (seen.states.back().t - start->state.t) / static_cast<double>(seen.steps);
    if (!check_interval(*duration) || !check_transient(step)) return false;
    const double wanted =
        options_.interval > 0 ? options_.interval : std::min(steps_of_interval * step, *duration / least_intervals);
    intervals_ = static_cast<std::uint64_t>(std::max(1.0, std::round(*duration / wanted)));
    out_.interval = *duration / static_cast<double>(intervals_);
    point_.state = start->state;
    return true;
  }

  bool check_interval(double duration) {
    if (options_.interval == 0) return true;
    if (!(options_.interval > 0 && std::isfinite(options_.interval)))
      return orbits::refuse_no_time("the interval", diagnostics_);
    if (options_.interval <= duration && duration / options_.interval <= most_intervals) return true;
    diagnostics_.error(
        "E1411", {}, fmt::format("intervals of {:.6g} s do not divide a run of {:.6g} s", options_.interval, duration),
        fmt::format("Directions are made orthonormal again after each interval: at least one, at most {:.0f} of them.",
                    most_intervals),
        "Leave --interval out, or take one between.");
    return false;
  }

  bool check_transient(double step) {
    if (transient_ / step <= most_steps_of_transient) return true;
    diagnostics_.error("E1411", {}, fmt::format("a transient of {:.6g} s never ends", transient_),
                       fmt::format("One step of this motion is about {:.2g} s long: it would take {:.1g} of them.",
                                   step, transient_ / step),
                       "Take a shorter one: the average begins after it.");
    return false;
  }

  std::optional<double> length_of_run() const { return orbits::length_of_run(model_, options_.duration, diagnostics_); }

  /// The first of an orthonormal basis, turned so that no direction is special.
  bool choose_directions() {
    const TangentPoint all = flow_.all_directions(point_.state);
    const Matrix basis = Eigen::Map<const Matrix>(all.directions.data(), static_cast<Index>(all.width()),
                                                  static_cast<Index>(all.columns()));
    const Index d = basis.cols(), k = options_.exponents == 0 ? d : std::min(d, static_cast<Index>(options_.exponents));
    out_.dimension = static_cast<std::size_t>(d);
    if (static_cast<Index>(options_.exponents) > d) {
      diagnostics_.error("E1412", {}, fmt::format("this motion has {} exponents, not {}", d, options_.exponents),
                         "Each direction of a neighbour, in positions and velocities, has one.",
                         fmt::format("Ask for at most {}, or for all: leave --exponents out.", d));
      return false;
    }
    if (k == 0) {
      diagnostics_.error("E1410", {}, "the constraints leave nothing that could move",
                         "Without a freedom there are no neighbours.", "Leave a constraint out.");
      return false;
    }
    Matrix turn(d, k);
    for (Index i = 0; i < d; ++i)
      for (Index j = 0; j < k; ++j)
        turn(i, j) = std::cos(1.0 + 2.0 * static_cast<double>(i) + 3.0 * static_cast<double>(i * j) +
                              static_cast<double>(j * j));
    directions_ = sizes_.cwiseInverse().asDiagonal() * (basis * turn);
    orthogonalize();
    return true;
  }

  /// R of the QR factors, its diagonal's logarithms; directions_ becomes Q.
  Vector orthogonalize() {
    Eigen::HouseholderQR<Matrix> qr(directions_);
    const Vector diagonal = qr.matrixQR().diagonal();
    directions_ = columns_of_q(qr, directions_.cols());
    return diagonal.cwiseAbs().array().log();
  }

  /// The state and the directions at the time t; false where the motion does not go on.
  bool carry_at_once(double t) {
    const Matrix in_state = sizes_.asDiagonal() * directions_;
    point_.directions.assign(in_state.data(), in_state.data() + in_state.size());
    if (const auto stop = flow_.advance(point_, t)) {
      stop_ = *stop;
      return false;
    }
    directions_ = sizes_.cwiseInverse().asDiagonal() *
                  Eigen::Map<const Matrix>(point_.directions.data(), in_state.rows(), in_state.cols());
    return true;
  }

  /// Directions over one interval, with what was found there; nothing where the motion does not go on. Where they part
  /// so far that the smaller ones are lost in the rounding of the larger, they are orthogonalized on the way as well:
  /// what pieces take away multiplies.
  std::optional<Vector> carry(double t, int halvings = 0) {
    const MotionState from = point_.state;
    const Matrix frame = directions_;
    if (!carry_at_once(t)) return std::nullopt;
    if (flow_.fewest_directions() < static_cast<std::size_t>(directions_.cols())) {
      vanishing_ = flow_.fewest_directions();
      stop_ = {StepEnding::None, point_.state.t, {}, {}};
      return std::nullopt;
    }
    const Vector logs = orthogonalize();
    if (logs.allFinite() && logs.maxCoeff() - logs.minCoeff() <= most_parting) {
      add_jumps();
      return logs;
    }
    if (halvings == most_halvings) {
      stop_ = {StepEnding::Overflow, point_.state.t, "A direction shrank to nothing, or grew beyond all numbers."};
      return std::nullopt;
    }
    point_.state = from;
    directions_ = frame;
    const auto first = carry(0.5 * (from.t + t), halvings + 1);
    const auto second = first ? carry(t, halvings + 1) : std::nullopt;
    return second ? std::optional<Vector>(*first + *second) : std::nullopt;
  }

  bool tell_stop() {
    if (vanishing_) return orbits::refuse_vanishing(stop_.t, *vanishing_, diagnostics_);
    if (stop_.ending == StepEnding::None) return orbits::refuse_jump(stop_, diagnostics_);
    return orbits::refuse_end(stop_.t, stop_.reason, diagnostics_);
  }

  /// Of the transient and the average.
  void tell_progress() {
    const double all = std::ceil(transient_ / out_.interval) + static_cast<double>(intervals_);
    if (options_.progress) options_.progress(static_cast<double>(early_.size() + logs_.size()) / all);
  }

  bool warm_up() {
    const double begin = point_.state.t;
    const auto count = static_cast<std::uint64_t>(std::ceil(transient_ / out_.interval));
    grown_ = Vector::Zero(directions_.cols());
    visited_.emplace(*equations_.system, sizes_);
    visited_->add_of_transient(point_.state, 0);
    for (std::uint64_t k = 1; k <= count; ++k) {
      const auto logs = carry(begin + transient_ * static_cast<double>(k) / static_cast<double>(count));
      if (!logs) return takes_transient(begin, transient_ / static_cast<double>(count)) || tell_stop();
      grown_ += *logs;
      visited_->add_of_transient(point_.state, grown_.maxCoeff());
      early_.push_back({point_.state, *logs});
      tell_progress();
    }
    begin_ = point_.state.t;
    averaging_ = true;
    before_ = point_.state;
    frame_before_ = directions_;
    visited_->add(before_, grown_.maxCoeff());
    return true;
  }

  /// Where the transient is interrupted, its own average is what there is: but for the first tenth, as of a run that
  /// was to be no longer. False where there is none yet.
  bool takes_transient(double begin, double interval) {
    constexpr std::size_t fewest = 20, part_left_out = 10;
    if (stop_.ending != StepEnding::Interrupted || early_.size() < fewest) return false;
    const std::size_t left_out = early_.size() / part_left_out;
    visited_.emplace(*equations_.system, sizes_);
    grown_.setZero();
    for (std::size_t k = 0; k < early_.size(); ++k) {
      grown_ += early_[k].logs;
      if (k + 1 < left_out) visited_->add_of_transient(early_[k].state, grown_.maxCoeff());
      if (k + 1 >= left_out) visited_->add(early_[k].state, grown_.maxCoeff());
      if (k >= left_out) logs_.push_back(early_[k].logs);
    }
    out_.interval = interval;
    transient_ = early_[left_out - 1].state.t - begin;
    intervals_ = 0;
    volume_.reset();  // it is integrated along the average alone
    out_.ended = "The run was interrupted before its transient was over: this is an average over the transient.";
    return true;
  }

  bool interval() {
    const MotionState before = point_.state;
    const auto logs = carry(begin_ + out_.interval * static_cast<double>(logs_.size() + 1));
    if (logs) {
      logs_.push_back(*logs);
      grown_ += *logs;
      visited_->add(point_.state, grown_.maxCoeff());
      frame_after_ = directions_;
      add_divergence(before);
      return true;
    }
    if (stop_.ending == StepEnding::None) logs_.clear();
    if (logs_.empty()) return tell_stop();
    out_.ended = stop_.reason;
    return false;
  }

  bool takes_all() const { return static_cast<std::size_t>(directions_.cols()) == out_.dimension; }

  /// Along the motion that carried the directions: another run of a chaotic motion would soon be another motion.
  void add_divergence(const MotionState& before) {
    if (!volume_ || !divergence_) return;
    const auto here = (*divergence_)(before, point_.state.t);
    volume_ = here ? std::optional(*volume_ + *here) : std::nullopt;
  }

  /// What impacts on the way did to volumes: with them the sum rule holds through modes.
  void add_jumps() {
    if (!flow_.through_modes() || !volume_ || !averaging_) return;
    const auto jumps = flow_.log_volume_of_jumps();
    volume_ = jumps ? std::optional(*volume_ + *jumps) : std::nullopt;
  }

  void average() {
    out_.duration = out_.interval * static_cast<double>(logs_.size());
    largest_first();
    const auto k = static_cast<std::size_t>(directions_.cols());
    const std::size_t stride = std::max<std::size_t>(1, logs_.size() / rows_of_convergence);
    std::vector<double> sum(k, 0.0), half(k, 0.0);
    for (std::size_t i = 0; i < logs_.size(); ++i) {
      for (std::size_t j = 0; j < k; ++j) sum[j] += logs_[i][static_cast<Index>(j)];
      if (i + 1 == (logs_.size() + 1) / 2) half = sum;
      if ((i + 1) % stride != 0 && i + 1 != logs_.size()) continue;
      out_.times.push_back(out_.interval * static_cast<double>(i + 1));
      for (const double s : sum) out_.running.push_back(s / out_.times.back());
    }
    const double first_half = out_.interval * static_cast<double>((logs_.size() + 1) / 2);
    const double of_powers = (1 + log_growth_of_time()) / out_.duration;
    for (std::size_t j = 0; j < k; ++j) {
      out_.exponents.push_back(sum[j] / out_.duration);
      out_.errors.push_back(std::max({scatter(j), std::abs(out_.exponents[j] - half[j] / first_half), of_powers}));
    }
    out_.sum = std::accumulate(out_.exponents.begin(), out_.exponents.end(), 0.0);
    if (takes_all()) compare_sum();
    judge_chaos(sum[0], sum[0] - half[0]);
  }

  /// Directions that change places slowly, as those of equal exponents do, need not come out in order.
  void largest_first() {
    Vector sum = Vector::Zero(directions_.cols());
    for (const Vector& logs : logs_) sum += logs;
    std::vector<Index> order(static_cast<std::size_t>(sum.size()));
    std::iota(order.begin(), order.end(), Index{0});
    std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return sum[a] > sum[b]; });
    for (Vector& logs : logs_) logs = Vector(logs(order));
  }

  /// Neighbours of a regular motion part like t: log t / t is left of an exponent. They begin with the transient.
  double log_growth_of_time() const {
    return std::log((transient_ + out_.duration) / std::max(transient_, out_.interval));
  }

  void judge_chaos(double whole, double second_half) {
    constexpr double clearly = 3;  // errors
    out_.chaos = orbits::chaos_of(
        {whole, second_half, log_growth_of_time(), clearly * out_.errors.front() * out_.duration,
         visited_->share_without_return(directions_.col(0))},
        *visited_, out_.duration, out_.dimension, orbits::depends_on_time(equations_), !flow_.through_modes());
  }

  /// The standard error of the mean of the blocks.
  double scatter(std::size_t j) {
    out_.blocks = std::min(most_blocks, logs_.size());
    std::vector<double> means;
    for (std::size_t b = 0; b < out_.blocks; ++b) {
      const std::size_t first = b * logs_.size() / out_.blocks, last = (b + 1) * logs_.size() / out_.blocks;
      double sum = 0;
      for (std::size_t i = first; i < last; ++i) sum += logs_[i][static_cast<Index>(j)];
      means.push_back(sum / (out_.interval * static_cast<double>(last - first)));
    }
    const auto count = static_cast<double>(means.size());
    const double mean = std::accumulate(means.begin(), means.end(), 0.0) / count;
    double square = 0;
    for (const double x : means) square += (x - mean) * (x - mean);
    return count > 1 ? std::sqrt(square / (count - 1) / count) : 0;
  }

  void compare_sum() {
    if (volume_) check_sum();
    if (flow_.through_modes() && !out_.expected_sum) return;  // other directions may have vanished before
    if (shrinks()) out_.kaplan_yorke = kaplan_yorke();        // no attractor where volumes stay
  }

  /// Volumes in q and p tell without an error, but those in (q, q̇) are what there is an attractor in: where t stands in
  /// M they go another way (p = e^{ct} q̇).
  bool shrinks() const {
    const double largest = std::abs(out_.exponents.front());
    const double errors = std::accumulate(out_.errors.begin(), out_.errors.end(), 0.0);
    if (out_.expected_sum && *volume_ / out_.duration < -1e-9 * largest) return true;
    return (!out_.expected_sum || orbits::depends_on_time(equations_)) && out_.sum < -errors;
  }

  /// Along a motion that neither rests nor is driven neighbours stay behind by the same time: one exponent is 0. Of
  /// another that may be 0 within its error the sign, on which the dimension depends, is not known.
  std::optional<double> kaplan_yorke() const {
    int zeros = visited_->keeps_moving(out_.duration) && !orbits::depends_on_time(equations_) ? 1 : 0;
    double partial = 0;
    for (std::size_t j = 0; j < out_.exponents.size(); ++j) {
      const bool may_be_zero = std::abs(out_.exponents[j]) <= out_.errors[j];
      if (may_be_zero && zeros-- == 0) return std::nullopt;
      const double exponent = may_be_zero ? 0 : out_.exponents[j];
      if (partial + exponent < 0) return static_cast<double>(j) + partial / std::abs(exponent);
      partial += exponent;
    }
    return std::nullopt;
  }

  /// Liouville's theorem speaks of the volume in q and p. That of the directions, orthonormal in (q, q̇), is √|det ω| of
  /// them: less its change from the first end to the last, the divergence is that of the flow in (q, q̇), for the run as
  /// it is and not only in the mean. The two differ for ever where t stands in M.
  void check_sum() {
    const double change = log_volume(frame_after_, point_.state) - log_volume(frame_before_, before_);
    if (!std::isfinite(change)) return;  // states next to the largest numbers: the form itself has no value
    const double rounding = 1e-14 * static_cast<double>(out_.dimension);
    out_.expected_sum = (*volume_ - (std::abs(change) > rounding ? change : 0)) / out_.duration;
    double largest = std::abs(*out_.expected_sum);
    for (const double x : out_.exponents) largest = std::max(largest, std::abs(x));
    out_.sum_rule_residual = std::abs(out_.sum - *out_.expected_sum);
    for (double& error : out_.errors) error = std::max(error, *out_.sum_rule_residual);
    if (*out_.sum_rule_residual <= 1e-6 * largest + 1e-9 / out_.interval) return;
    diagnostics_.warning(
        "W1401", {},
        fmt::format("the exponents add up to {:.6g} 1/s instead of {:.6g} 1/s", out_.sum, *out_.expected_sum),
        "Their sum is the mean divergence of the flow (Liouville), which is known without them: neighbours of this "
        "motion were not carried to rounding.",
        "Take no exponent for more certain than its error, which allows for that.");
  }

  double log_volume(const Matrix& frame, const MotionState& state) const {
    const Matrix in_state = sizes_.asDiagonal() * frame;
    const TangentPoint point{state, {in_state.data(), in_state.data() + in_state.size()}};
    const auto products = geometry_.symplectic_products(point);
    const Matrix form = Eigen::Map<const Matrix>(products.data(), frame.cols(), frame.cols());
    return 0.5 * Eigen::PartialPivLU<Matrix>(form).matrixLU().diagonal().cwiseAbs().array().log().sum();
  }

  /// The end of an interval, and what directions have grown by in it.
  struct Carried {
    MotionState state;
    Vector logs;
  };

  const Model& model_;
  const EquationsOfMotion& equations_;
  const LyapunovOptions& options_;
  Diagnostics& diagnostics_;
  TangentGeometry geometry_;
  TangentFlow flow_;
  TangentPoint point_;
  Matrix directions_;  // [2n × k], orthonormal in units of the sizes
  Vector sizes_;
  double transient_ = 0, begin_ = 0;
  std::uint64_t intervals_ = 0;
  MotionState before_;                                    // where the average begins
  Matrix frame_before_, frame_after_;                     // the directions there, and at the end
  std::vector<Vector> logs_;                              // of each interval
  std::vector<Carried> early_;                            // over the intervals of the transient
  Vector grown_;                                          // their sums, from the beginning of the transient
  std::optional<orbits::DivergenceIntegral> divergence_;  // of all exponents
  std::optional<double> volume_ = 0;  // its integral over the intervals; nothing where there is none
  std::optional<orbits::VisitedStates> visited_;
  bool averaging_ = false;
  TangentStop stop_;
  std::optional<std::size_t> vanishing_;  // directions that a mode on the way leaves: fewer than are carried
  LyapunovResult out_;
};

}  // namespace

std::optional<LyapunovResult> lyapunov_exponents(const Model& model, const EquationsOfMotion& equations,
                                                 const LyapunovOptions& options, Diagnostics& diagnostics) {
  if (refuse_free_functions(equations, "Lyapunov exponents", diagnostics)) return std::nullopt;
  if (equations.determined)
    return lyapunov_exponents(with_determined_system(model, equations), *equations.determined, options, diagnostics);
  if (jumps_on_its_way(model) && !can_go_through_modes(equations, diagnostics)) return std::nullopt;
  return LyapunovRun(model, equations, options, diagnostics).carry_out();
}

}  // namespace maupertuis
