#include "analysis/orbits/closing.hpp"

#include "analysis/orbits/drive.hpp"
#include "analysis/orbits/messages.hpp"
#include "analysis/orbits/same_places.hpp"
#include "analysis/tangent/point_functions.hpp"
#include "linear_algebra/dense.hpp"
#include "linear_algebra/products.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

/// Newton's method on Φ_T(x) − x = 0. With the derivative M of the return map in the directions that the constraints
/// allow, and the velocity f of the motion in the space of states, (M − 1) ξ + f δT = −(Φ_T(x) − x) has many solutions:
/// the start may be any point of the orbit, and where the energy is conserved the orbit is one of a family. Then ∂E ξ =
/// 0 is asked for as well, so that the orbit has the energy of the model's start; of what is still left open the
/// shortest correction is taken (pseudo-inverse).
namespace maupertuis::orbits {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using Index = Eigen::Index;

constexpr int most_iterations = 40;
constexpr double converged = 1e-9;  // closure that counts as closed where rounding lets nothing better
constexpr double least_singular = 1e-9;
constexpr double longest_step = 0.2;                     // of the size of the orbit, and of the period
constexpr double near_impact = 0.01;                     // of the stretch that is seen, and of the size of the orbit
constexpr double near_return = 0.02, any_return = 0.25;  // distances from the start, of the largest
constexpr std::size_t most_returns = 8;
constexpr int most_parts = 100;                        // of a period that may be the true one
constexpr int some_periods = 64, many_periods = 4096;  // after which the equations of a drive are looked at

class Closer {
 public:
  Closer(const Model& model, const EquationsOfMotion& equations, const FloquetOptions& options,
         Diagnostics& diagnostics)
      : model_(model),
        system_(*equations.system),
        equations_(equations),
        options_(options),
        diagnostics_(&diagnostics),
        n_(system_.coordinates.size()),
        motion_(free_motion_kernel(equations)),
        flow_(model, equations, {0, 100'000'000, options.interrupt}) {}

  std::optional<Closed> close() {
    const auto start = options_.start ? options_.start : start_of_model();
    if (!start || n_ == 0) return std::nullopt;
    at_ = *start;
    out_.motion.driven = depends_on_time(equations_);
    out_.through_modes = flow_.through_modes();
    out_.keeps_energy = keeps_energy(model_, equations_);
    if (!first_period() || !follow() || !leave_impacts()) return std::nullopt;
    places_.emplace(system_, motion_, seen_);
    if (!guess()) return std::nullopt;
    if (!out_.motion.driven && out_.keeps_energy) {
      energy_.emplace(system_, std::span(&equations_.energy_function, 1));
      energy_of_start_ = energy_->values(at_)[0];
    }
    if (!iterate_from_returns() || !shorten()) return std::nullopt;
    return std::move(out_);
  }

 private:
  bool refuse_rest() {
    diagnostics_->error("E1402", place_of_start(), "the motion from this start rests",
                        "At an equilibrium every time is a period, and there is no orbit.",
                        "Start away from the equilibrium, or use `maup modes` for the motion near it.");
    return false;
  }
  /// A start that moves, and not in the period that was given.
  bool refuse_short_period() {
    diagnostics_->error("E1406", {}, fmt::format("this motion hardly moves in a period of {:.9g} s", *period_),
                        "Where nothing has turned, to come back and to stay are not to be told apart.",
                        "Give the time after which it comes back, or leave --period out: then it is looked for.");
    return false;
  }
  std::optional<MotionState> start_of_model() {
    const auto start = consistent_start(model_, equations_, *diagnostics_);
    return start ? std::optional(start->state) : std::nullopt;
  }
  std::optional<Span> place_of_start() const {
    return model_.experiment.start.empty() ? std::nullopt : std::optional(model_.experiment.start.front().span);
  }

  /// Of a drive, or as the user gave it; else it is looked for.
  bool first_period() {
    if (options_.period && !(*options_.period > 0 && std::isfinite(*options_.period))) {
      refuse_no_time("a period", *diagnostics_);
      return false;
    }
    period_ = options_.period;
    if (out_.motion.driven && !period_) period_ = period_of_drive(equations_);
    if (!out_.motion.driven || period_) return true;
    diagnostics_->error("E1404", {}, "the equations depend on the time, and with what period is not to be seen",
                        "A driven motion can only repeat with the period of its drive, or a multiple of it.",
                        "Give it with --period.");
    return false;
  }

  /// One look at the motion: over the period, or over the model's run where a return is to be found.
  bool follow() {
    double length = period_.value_or(0);
    if (!period_) {
      const auto run = length_of_run(model_, {}, *diagnostics_);
      if (!run) return false;
      length = *run;
    }
    seen_ = survey(model_, equations_, motion_, at_, length, options_.interrupt);
    out_.sizes = seen_.sizes;
    flow_.set_usual_sizes(seen_.sizes);
    if (!seen_.ended.empty() && (period_ || seen_.states.size() < 64))
      return refuse_end(seen_.states.back().t, seen_.ended, *diagnostics_);
    const Vector f = flow_at(at_);
    if (f.size() == 0) return refuse_end(at_.t, "An acceleration has no value here.", *diagnostics_);
    if (!out_.motion.driven && f.cwiseAbs().maxCoeff() == 0) return refuse_rest();
    if (!out_.motion.driven && period_ && !turns(at_)) return refuse_short_period();
    if (out_.motion.driven && !repeats_in_time(system_, motion_, seen_, *period_, compared_)) {
      diagnostics_->error("E1404", {},
                          fmt::format("the equations do not repeat after {:.9g} s{}", *period_,
                                      options_.period ? "" : ", the period of the sines and cosines of t in them"),
                          "A driven motion can only repeat with the period of its drive, or a multiple of it.",
                          "If there is one, give it with --period.");
      return false;
    }
    if (out_.motion.driven && compared_ == many_periods)
      diagnostics_->warning("W1403", {},
                            fmt::format("the equations were compared over {} periods of {:.9g} s", compared_, *period_),
                            "t stands outside of sines and cosines too: whether they are the same after that is not "
                            "known, and what is said of stability holds for so long.",
                            "A model whose drive is made of sines and cosines of t alone repeats for ever.");
    return true;
  }

  /// At an impact the state has two values, and next to it a correction may throw the start through the contact: where
  /// one is near, the orbit begins in the middle of a stretch without, the longest of those in which least is held.
  bool leave_impacts() {
    if (!out_.through_modes) return true;
    const double begin = at_.t, end = seen_.states.back().t;
    std::vector<double> instants = seen_.instants;
    instants.push_back(end);
    if (!touches_contact() && instants.front() - begin > near_impact * (end - begin)) return true;
    double from = begin, middle = begin, longest = 0;
    std::size_t least = SIZE_MAX;
    for (std::size_t k = 0; k < instants.size(); ++k) {
      const double length = instants[k] - from;
      const std::size_t held = k < seen_.held.size() ? seen_.held[k] : 0;
      if (length > near_impact * (end - begin) && (held < least || (held == least && length > longest)))
        least = held, longest = length, middle = from + 0.5 * length;
      from = instants[k];
    }
    if (longest == 0) return true;
    const auto later = [](const MotionState& s, double t) { return s.t < t; };
    at_ = *std::lower_bound(seen_.states.begin(), seen_.states.end(), middle, later);
    const double length = end - begin;
    const std::vector<double> sizes = seen_.sizes;
    seen_ = survey(model_, equations_, motion_, at_, length, options_.interrupt, sizes);
    return seen_.ended.empty() || seen_.states.size() >= 64 ||
           refuse_end(seen_.states.back().t, seen_.ended, *diagnostics_);
  }

  bool touches_contact() const {
    ExprVector gaps;
    for (const Contact& c : system_.contacts) gaps.push_back(c.gap);
    if (gaps.empty()) return false;
    const tangent::PointFunctions functions(system_, gaps);
    const std::vector<double> values = functions.values(at_);
    const Matrix slopes = functions.slopes(at_);
    for (std::size_t i = 0; i < values.size(); ++i) {
      double size = 0;
      for (std::size_t k = 0; k < n_; ++k)
        size += std::abs(slopes(static_cast<Index>(i), static_cast<Index>(k))) * seen_.sizes[k];
      if (std::abs(values[i]) <= near_impact * size) return true;
    }
    return false;
  }

  /// (q̇, q̈); empty where there is no acceleration.
  Vector flow_at(const MotionState& s) {
    const auto a = flow_.accelerations(s);
    Vector f(static_cast<Index>(a.empty() ? 0 : 2 * n_));
    for (std::size_t i = 0; i < a.size(); ++i) {
      f[static_cast<Index>(i)] = s.v[i];
      f[static_cast<Index>(n_ + i)] = a[i];
    }
    return f;
  }

  /// T (q̇, q̈) in units of the sizes: what moves the state by the whole of its size in a period is 1 and more.
  Vector turning(const MotionState& s) {
    Vector f = flow_at(s);
    for (Index i = 0; i < f.size(); ++i) f[i] *= *period_ / out_.sizes[static_cast<std::size_t>(i)];
    return f;
  }

  /// Φ_T(x) − x without whole turns and signs of quaternions, in units of the sizes.
  Vector gap(const MotionState& from, const MotionState& to, std::vector<int>* turns = nullptr) const {
    return places_->gap(from, to, turns)
        .cwiseQuotient(Eigen::Map<const Vector>(out_.sizes.data(), static_cast<Index>(out_.sizes.size())));
  }

  /// A time at which the distance from the start has a minimum, and how small it is: the squares of the distances of
  /// three states lie on a parabola there.
  struct Return {
    double t = 0, distance = 0;
  };
  Return return_near(std::size_t k, const std::vector<double>& distance) const {
    const auto t = [&](std::size_t i) { return seen_.states[i].t - at_.t; };
    const auto square = [&](std::size_t i) { return distance[i] * distance[i]; };
    const double left = (square(k) - square(k - 1)) / (t(k) - t(k - 1));
    const double right = (square(k + 1) - square(k)) / (t(k + 1) - t(k));
    const double bend = (right - left) / (t(k + 1) - t(k - 1));
    if (!(bend > 0)) return {t(k), distance[k]};
    const double slope = left + bend * (t(k) - t(k - 1)), back = slope / (2 * bend);
    return {t(k) - back, std::sqrt(std::max(0.0, square(k) - bend * back * back))};
  }

  /// Returns: the state was far from the start and comes back. The first ones that come really near, else the nearest.
  bool guess() {
    if (period_) {
      returns_ = {*period_};
      return true;
    }
    std::vector<double> distance;
    for (const MotionState& s : seen_.states) distance.push_back(gap(at_, s).norm());
    const double largest = *std::max_element(distance.begin(), distance.end());
    std::optional<Return> best;
    bool away = false;
    for (std::size_t k = 1; k + 1 < distance.size() && returns_.size() < most_returns; ++k) {
      away = away || distance[k] > 0.5 * largest;
      if (!away || distance[k] > distance[k - 1] || distance[k] > distance[k + 1]) continue;
      const Return here = return_near(k, distance);
      if (here.distance < near_return * largest) returns_.push_back(here.t), away = false;
      if (here.distance < any_return * largest && (!best || here.distance < best->distance)) best = here;
    }
    if (!best) {
      diagnostics_->error(
          "E1401", place_of_start(), "the motion does not come back to its start within the run",
          fmt::format(
              "Of a periodic motion the state returns; in {:.6g} s this one never comes nearer than a quarter of "
              "its size.",
              seen_.states.back().t - at_.t),
          "Give a period to start from with --period, a start that is nearer to a periodic motion, or a longer run.");
      return false;
    }
    if (returns_.empty()) returns_ = {best->t};
    return true;
  }

  /// A return may be that of another motion: of a pendulum near the top the angle is the same on both sides of it. What
  /// is told is why Newton's method fails with the first.
  bool iterate_from_returns() {
    first_ = at_;
    Diagnostics of_first;
    for (const double period : returns_) {
      Diagnostics told;
      at_ = first_;
      period_ = period;
      Diagnostics* const outer = std::exchange(diagnostics_, &told);
      const bool closes = iterate();
      diagnostics_ = outer;
      if (closes) return true;
      if (of_first.empty()) of_first = told;
    }
    diagnostics_->append(of_first);
    return false;
  }

  /// The period of a motion is the shortest after which it repeats, together with the drive; a return at a multiple of
  /// it closes as well.
  bool shorten() {
    if (options_.period) return true;
    std::vector<double> times;
    for (int parts = most_parts; parts >= 2; --parts) times.push_back(out_.motion.start.t + *period_ / parts);
    std::vector<TangentPoint> points;
    if (flow_.along(out_.begin, times, points)) return true;
    for (const TangentPoint& point : points) {
      const double part = point.state.t - out_.motion.start.t;
      if (gap(out_.motion.start, point.state).norm() > converged) continue;
      if (out_.motion.driven && !repeats_in_time(system_, motion_, seen_, part, compared_)) continue;
      at_ = out_.motion.start;
      period_ = part;
      const int before = out_.motion.iterations;
      const bool closes = iterate();
      out_.motion.iterations += before;
      return closes;
    }
    return true;
  }

  bool iterate() {
    double before = 0;
    for (out_.motion.iterations = 0;; ++out_.motion.iterations) {
      if (!carry()) return false;
      const Vector rest = gap(out_.begin.state, out_.end.state, &out_.motion.turns);
      const double error = rest.norm();
      const bool better = out_.motion.iterations == 0 || error < 0.5 * before;
      if (error <= 4e-16 || (!better && before < converged))
        return finish(std::min(error, out_.motion.iterations ? before : error), error < before);
      if (out_.motion.iterations == most_iterations || !std::isfinite(error)) return refuse_newton(error);
      keep_ = {out_.begin, out_.end, *period_};
      before = error;
      if (!correct(rest)) return false;
    }
  }

  bool carry() {
    std::optional<TangentStop> stop;
    for (int halvings = 0;; ++halvings) {
      out_.begin = out_.end = flow_.all_directions(at_);
      stop = flow_.advance(out_.end, at_.t + *period_);
      // A correction may end where contacts allow no start: half of it then.
      constexpr int most_halvings = 12;
      if (!stop || !out_.through_modes || out_.motion.iterations == 0 || halvings == most_halvings) break;
      if (stop->t != at_.t) break;
      for (std::size_t i = 0; i < n_; ++i) {
        at_.q[i] = 0.5 * (at_.q[i] + keep_.begin.state.q[i]);
        at_.v[i] = 0.5 * (at_.v[i] + keep_.begin.state.v[i]);
      }
      *period_ = 0.5 * (*period_ + keep_.period);
      if (!on_constraints()) return false;
    }
    out_.log_volume = flow_.log_volume_of_jumps();
    if (!stop) {
      out_.motion.other_sign = places_->take_sign_of(out_.begin.state, out_.end);
      return true;
    }
    if (stop->ending == StepEnding::None) return refuse_jump(*stop, *diagnostics_);
    if (out_.motion.iterations > 0 && stop->ending != StepEnding::Interrupted) return refuse_corrected(*stop);
    return refuse_end(stop->t, stop->reason, *diagnostics_);
  }

  /// The linear equations of a correction ξ, δT/T: the return; the phase, f ξ = 0, so that the start does not slide
  /// along the orbit; the energy. `f_begin`, `f_end`: `turning` there.
  std::pair<Matrix, Vector> newton_equations(const ReturnMap& map, const Vector& rest, const Vector& f_begin,
                                             const Vector& f_end) const {
    const Index d = map.monodromy.rows();
    const bool free = !out_.motion.driven, family = free && energy_.has_value();
    Matrix left = Matrix::Zero(d + free + family, d + free);
    Vector right = Vector::Zero(d + free + family);
    left.topLeftCorner(d, d) = map.monodromy - Matrix::Identity(d, d);
    right.head(d) = -(map.directions.transpose() * rest);
    if (free) {
      left.col(d).head(d) = map.directions.transpose() * f_end;
      left.row(d).head(d) = (map.directions.transpose() * f_begin).normalized().transpose();
    }
    if (family) {
      const Vector slope = energy_->slopes(at_).row(0).transpose();
      const Vector up =
          map.directions.transpose() * slope.cwiseProduct(Eigen::Map<const Vector>(out_.sizes.data(), slope.size()));
      left.row(d + 1).head(d) = up.normalized().transpose();
      right[d + 1] = (energy_of_start_ - energy_->values(at_)[0]) / up.norm();
    }
    return {left, right};
  }

  bool correct(const Vector& rest) {
    const Vector f_begin = turning(out_.begin.state), f_end = turning(out_.end.state);
    if (f_begin.size() == 0 || f_end.size() == 0)
      return refuse_end(out_.end.state.t, "An acceleration has no value here.", *diagnostics_);
    const ReturnMap map = return_map(out_.begin, out_.end, out_.sizes);
    if (map.directions.cols() == 0) return refuse_determined();
    const auto [left, right] = newton_equations(map, rest, f_begin, f_end);
    Eigen::JacobiSVD<Matrix> svd(left, Eigen::ComputeThinU | Eigen::ComputeThinV);
    svd.setThreshold(least_singular);
    Vector step = svd.solve(right);
    if (const double length = step.norm(); length > longest_step) step *= longest_step / length;
    const Vector by = map.directions * step.head(map.monodromy.rows());
    for (std::size_t i = 0; i < n_; ++i) {
      at_.q[i] += by[static_cast<Index>(i)] * out_.sizes[i];
      at_.v[i] += by[static_cast<Index>(n_ + i)] * out_.sizes[n_ + i];
    }
    if (!out_.motion.driven) *period_ *= 1 + step[step.size() - 1];
    return on_constraints();
  }

  bool on_constraints() {
    const EquationsOfMotion& equations =
        out_.through_modes ? flow_.equations_at(keep_.begin.state) : equations_;  // of the mode that it starts in
    if (!equations.system->constrained()) return true;
    if (!manifold_ || out_.through_modes) manifold_.emplace(equations);
    const std::vector<bool> free(n_, false);
    return (manifold_->move_positions(at_, free) && manifold_->move_velocities(at_, free)) || refuse_newton(1);
  }

  bool finish(double closure, bool last_is_best) {
    if (!last_is_best && out_.motion.iterations > 0) {
      out_.begin = keep_.begin, out_.end = keep_.end;
      *period_ = keep_.period;
    }
    gap(out_.begin.state, out_.end.state, &out_.motion.turns);
    out_.motion.start = out_.begin.state;
    out_.motion.period = *period_;
    out_.motion.closure = closure;
    out_.motion.moved = gap(first_, out_.motion.start).norm();
    out_.flow = flow_at(out_.motion.start);
    out_.motion.rests = out_.motion.driven && rests_at(out_.motion.start);
    return out_.motion.driven || turns(out_.motion.start) || refuse_rest();
  }

  /// Whether a period takes the state away from where it is.
  bool turns(const MotionState& s) {
    constexpr double still = 1e-6;
    return turning(s).cwiseAbs().maxCoeff() > still;
  }

  /// To rounding of the place, or of the motion that Newton's method began with.
  bool rests_at(const MotionState& start) const {
    const Survey seen = survey(model_, equations_, motion_, start, *period_, options_.interrupt, seen_.sizes);
    constexpr double rounding = 1e-12;
    const auto stays = [&](const MotionState& s) { return gap(start, s).norm() <= rounding; };
    return seen.ended.empty() && (seen.rests || std::all_of(seen.states.begin(), seen.states.end(), stays));
  }

  bool refuse_determined() {
    diagnostics_->error(
        "E1401", place_of_start(), "no periodic motion was found near this start",
        fmt::format("The constraints determine the whole motion, and after {:.9g} s it is not back.", *period_),
        "Give a period after which the constraints are the same again, with --period.");
    return false;
  }

  bool refuse_newton(double error) {
    diagnostics_->error("E1401", place_of_start(), "no periodic motion was found near this start",
                        fmt::format("Newton's method on the return map did not converge: after {:.9g} s the state is "
                                    "still {:.2g} of the orbit's size away.",
                                    *period_, error),
                        "Give a better period with --period, or a start that is nearer to a periodic motion.");
    return false;
  }

  /// The motion from the start that was given goes on; the one from a corrected start does not.
  bool refuse_corrected(const TangentStop& stop) {
    diagnostics_->error("E1401", place_of_start(), "no periodic motion was found near this start",
                        fmt::format("Newton's method on the return map led to a start from which the motion ends at "
                                    "t = {:.9g} s: {}",
                                    stop.t, stop.reason),
                        "Give a better period with --period, or a start that is nearer to a periodic motion.");
    return false;
  }

  struct Kept {
    TangentPoint begin, end;
    double period = 0;
  };
  const Model& model_;
  const MechanicalSystem& system_;
  const EquationsOfMotion& equations_;
  const FloquetOptions& options_;
  Diagnostics* diagnostics_;
  std::size_t n_;
  MotionKernel motion_;
  TangentFlow flow_;
  MotionState at_, first_;
  std::optional<double> period_;
  const int compared_ = stands_in_waves_alone(equations_) ? some_periods : many_periods;
  std::vector<double> returns_;  // s after the start: periods to begin with
  Survey seen_;
  std::optional<orbits::SamePlaces> places_;
  std::optional<ConstraintManifold> manifold_;
  std::optional<tangent::PointFunctions> energy_;  // where it is conserved
  double energy_of_start_ = 0;                     // J
  Kept keep_;
  Closed out_;
};

}  // namespace

ReturnMap return_map(const TangentPoint& begin, const TangentPoint& end, const std::vector<double>& sizes) {
  const auto rows = static_cast<Index>(begin.width()), d = static_cast<Index>(begin.columns());
  const Vector size = Eigen::Map<const Vector>(sizes.data(), rows);
  // Columns of `begin` are an orthonormal basis B; the directions sizes · U are B C with C = Bᵀ (sizes · U).
  const Matrix basis = Eigen::Map<const Matrix>(begin.directions.data(), rows, d),
               carried = Eigen::Map<const Matrix>(end.directions.data(), rows, d);
  Eigen::HouseholderQR<Matrix> qr(size.cwiseInverse().asDiagonal() * basis);
  ReturnMap out;
  out.directions = columns_of_q(qr, d);
  const Matrix combination = transposed_product(basis, size.asDiagonal() * out.directions);
  out.monodromy = transposed_product(out.directions, size.cwiseInverse().asDiagonal() * product(carried, combination));
  return out;
}

std::optional<Closed> close_motion(const Model& model, const EquationsOfMotion& equations,
                                   const FloquetOptions& options, Diagnostics& diagnostics) {
  return Closer(model, equations, options, diagnostics).close();
}

}  // namespace maupertuis::orbits
