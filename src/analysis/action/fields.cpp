#include "analysis/action/fields.hpp"

#include "analysis/action/newton.hpp"
#include "linear_algebra/dense.hpp"
#include "linear_algebra/products.hpp"

#include <maupertuis/degenerate.hpp>
#include <maupertuis/integrator.hpp>
#include <maupertuis/motion_kernel.hpp>
#include <maupertuis/tangent.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

/// The neighbours that leave the beginning together are a Lagrangian frame (Q, P), Q = 0 there; a conjugate point is
/// where Q loses rank. On a stretch [t_k, t] without conjugate points of its own, with the transfer (A B; C D),
///
///     Q(t) = A Q_k + B P_k = B (U(t) Q_k + P_k),   U = B⁻¹A symmetric, U → +∞ at t_k, dU/dt = −B⁻¹ H_pp B⁻ᵀ < 0,
///
/// so that Q loses rank where G(t) = Qₖᵀ U(t) Qₖ + Qₖᵀ Pₖ has a zero eigenvalue. These fall from +∞ and never come
/// back: the number of negative ones at the end of the stretch is the number of conjugate points in it, with
/// multiplicity, also where det Q only touches zero; and each is the single root of a monotone function.
namespace maupertuis::action {
namespace {

constexpr double on_end = 1e-8;        // a singular value of the frame: the end itself is conjugate
constexpr double too_near_end = 1e-5;  // a frame that stretches should not begin with
constexpr double longest_turn = 0.8;   // of B M / t against 1: certainly no conjugate point within
constexpr double same_place = 1e-9;    // of the whole: roots that are one, with multiplicity
constexpr std::size_t most_stretches = 4000;

Matrix inverse_times(const Matrix& a, const Matrix& b) { return a.partialPivLu().solve(b); }

/// The path as states, and neighbours in coordinates in which the symplectic form is the standard one.
class Neighbours {
 public:
  Neighbours(Functional& functional, const EquationsOfMotion& weighted, const Trial& trial,
             std::span<const MotionState> states, bool backward, double stretch, const StopFlag* interrupt)
      : functional_(functional),
        trial_(trial),
        path_(to_path(trial)),
        states_(states),
        n_(functional.freedoms()),
        k_(functional.integrals()),
        sign_(backward ? -1 : 1),
        flow_(weighted, {0, 100'000, interrupt}) {
    set_scale(stretch);
  }

  MotionState state(double t) {
    const auto known =
        std::lower_bound(states_.begin(), states_.end(), t, [](const MotionState& s, double at) { return s.t < at; });
    MotionState out = known != states_.end() && known->t == t ? *known : path_.at(t);
    functional_.evaluate(t, out.q.data(), out.v.data(), trial_.multipliers, 1, density_);
    for (Index i = 0; i < k_; ++i) {
      out.q.push_back(trial_.multipliers[i]);
      out.v.push_back(0);
    }
    for (Index i = 0; i < k_; ++i) {
      out.q.push_back(0);
      out.v.push_back(density_.integrals[i]);
    }
    return out;
  }

  /// An orthonormal basis of the configurations next to this one, in scaled coordinates [n × d].
  Matrix tangent(const MotionState& s) {
    if (functional_.orders().higher()) return Matrix::Identity(n_, n_)(Eigen::all, functional_.orders().configurations);
    Vector values;
    Matrix rows;
    functional_.constraints_at(s.t, Eigen::Map<const Vector>(s.q.data(), n_), values, rows);
    return null_basis(rows * scale_.asDiagonal(), n_);
  }

  /// (δq, ∫δG; δp, −δλ) of each column [2 (d + k) × columns].
  /// `z`: the basis of configurations there.
  Matrix canonical(const TangentPoint& point, const Matrix& z) {
    const auto width = static_cast<Index>(point.width()), half = width / 2;
    const Eigen::Map<const Matrix> y(point.directions.data(), width, static_cast<Index>(point.columns()));
    const MotionState& s = point.state;
    functional_.evaluate(s.t, s.q.data(), s.v.data(), trial_.multipliers, 2, density_);
    const Index d = z.cols();
    const Matrix dq = y.topRows(n_), dv = y.middleRows(half, n_);
    Matrix dp = product(density_.hessian.bottomLeftCorner(n_, n_), dq);
    dp += product(density_.hessian.bottomRightCorner(n_, n_), dv);
    if (k_ > 0) dp += product(density_.integral_gradients.bottomRows(n_), y.middleRows(n_, k_));
    Matrix out(2 * (d + k_), y.cols());
    const Matrix over_scale = scale_.cwiseInverse().asDiagonal() * z, by_scale = scale_.asDiagonal() * z;
    out.topRows(d) = transposed_product(over_scale, dq);
    out.middleRows(d + k_, d) = sign_ * transposed_product(by_scale, dp);
    if (k_ > 0) {
      out.middleRows(d, k_) = integral_scale_.cwiseInverse().asDiagonal() * y.middleRows(n_ + k_, k_);
      out.bottomRows(k_) = -sign_ * (integral_scale_.asDiagonal() * y.middleRows(n_, k_));
    }
    return out;
  }

  /// The basis next to another one: turned as little as the constraints ask for.
  Matrix tangent_next_to(const MotionState& s, const Matrix& z) {
    const Matrix own = tangent(s);
    const Eigen::JacobiSVD<Matrix> overlap(transposed_product(own, z), Eigen::ComputeThinU | Eigen::ComputeThinV);
    return product(own, product_transposed(overlap.matrixU(), overlap.matrixV()));
  }

  struct Carried {
    Matrix transfer;  // [2d × 2d]
    MotionState end;
    Matrix basis;  // with which the next stretch begins: that of the path's own state
    std::string stopped;
  };
  Carried carry(const MotionState& from, const Matrix& z, double to) {
    TangentPoint point = flow_.all_directions(from);
    const Matrix before = canonical(point, z);
    if (const auto stop = flow_.advance(point, to)) return {{}, from, {}, stop->reason};
    const Matrix basis = tangent_next_to(state(to), z);
    return {product(canonical(point, basis), before.partialPivLu().inverse()), point.state, basis, {}};
  }

  /// Whether the stretch is too short for a conjugate point of its own: B M / t near 1.
  bool short_enough(const Matrix& transfer, const MotionState& from, const Matrix& basis, double length) {
    const Index d = transfer.rows() / 2 - k_;
    functional_.evaluate(from.t, from.q.data(), from.v.data(), trial_.multipliers, 2, density_);
    const Matrix z = scale_.asDiagonal() * basis;
    const Matrix mass = functional_.orders().higher()
                            ? free_flight(length)
                            : Matrix(quadratic_form(z, density_.hessian.bottomRightCorner(n_, n_)) / length);
    const Matrix turn = product(transfer.block(0, d + k_, d, d), mass) - Matrix::Identity(d, d);
    return turn.norm() < longest_turn;
  }

  /// The inverse of what B is where L is ½ M v'² alone, with q' = v, p₁' = 0, p₂' = −p₁: v' = M⁻¹ p₂.
  Matrix free_flight(double t) const {
    const OrderOfCoordinates& orders = functional_.orders();
    const std::vector<Index>&all = orders.configurations, &tops = orders.tops;
    const Matrix inverse = Matrix(density_.hessian.bottomRightCorner(n_, n_)(tops, tops)).partialPivLu().inverse();
    Matrix q = Matrix::Zero(static_cast<Index>(all.size()), static_cast<Index>(tops.size())), v = q;
    for (const auto& [place, top] : orders.rates) q(place, top) = 1;
    for (std::size_t i = 0; i < tops.size(); ++i)
      v(std::find(all.begin(), all.end(), tops[i]) - all.begin(), static_cast<Index>(i)) = 1;
    // v = M⁻¹ ∫ (p₂ − p₁ t), q = ∫ v.
    const auto part = [&](const Matrix& a, const Matrix& c) { return product_transposed(product(a, inverse), c); };
    const Matrix b = t * part(v, v) + t * t / 2 * (part(q, v) - part(v, q)) - t * t * t / 6 * part(q, q);
    const Vector unit = scale_(all).cwiseInverse();
    return Matrix(unit.asDiagonal() * b * unit.asDiagonal()).partialPivLu().inverse();
  }

  const Vector& scale() const { return scale_; }
  Index integrals() const { return k_; }

 private:
  void set_scale(double stretch) {
    Vector mass = Vector::Zero(n_);
    for (const double part : {0.21, 0.5, 0.83}) {
      const MotionState s = path_.at(path_.start + part * (path_.end - path_.start));
      functional_.evaluate(s.t, s.q.data(), s.v.data(), trial_.multipliers, 2, density_);
      mass = mass.cwiseMax(density_.hessian.bottomRightCorner(n_, n_).diagonal().cwiseAbs());
    }
    mass = mass.cwiseMax(1e-12 * mass.maxCoeff());
    scale_ = (stretch * mass.cwiseInverse()).cwiseSqrt();
    const OrderOfCoordinates& orders = functional_.orders();
    for (const auto& [place, top] : orders.rates)
      scale_[orders.configurations[static_cast<std::size_t>(place)]] =
          stretch * scale_[orders.tops[static_cast<std::size_t>(top)]];
    integral_scale_ = functional_.wanted().cwiseAbs().cwiseMax(1e-300) * 0.1;
  }

  Functional& functional_;
  const Trial& trial_;
  ActionPath path_;
  std::span<const MotionState> states_;  // by time
  Index n_, k_;
  double sign_;
  TangentFlow flow_;
  Density density_;
  Vector scale_, integral_scale_;
};

/// ∫ L dt along the motions themselves.
/// Motions and their ∫ L dt, as the velocity of a further coordinate, S'' = L: so the steps keep to what L does as they
/// do for forces, and nothing narrow in it is passed over.
class ActionAlong {
 public:
  ActionAlong(const EquationsOfMotion& weighted, Expr lagrangian, const StopFlag* interrupt = nullptr)
      : kernel_(kernel_of(weighted, lagrangian)),
        stepper_(kernel_, parameter_values(*weighted.system), {.maximum_steps = 100'000, .interrupt = interrupt}) {}

  std::span<const double> q() const { return stepper_.q().first(stepper_.q().size() - 1); }  // where the motion is
  std::optional<double> over(const MotionState& from, double to) {
    std::vector<double> q = from.q, v = from.v;
    q.push_back(0), v.push_back(0);
    stepper_.start(from.t, q, v);
    while (stepper_.time() != to)
      if (stepper_.step(to).ending != StepEnding::None) return std::nullopt;
    return stepper_.v().back();
  }

 private:
  static Kernel kernel_of(const EquationsOfMotion& weighted, Expr lagrangian) {
    KernelSource source = motion_source(weighted);
    Context& context = *weighted.system->context;
    source.coordinates.push_back(context.symbol("∫∫ L", Role::Coordinate));
    source.residual.push_back(context.symbol("∫∫ L", Role::Coordinate, 2) -
                              in_terms_of_motion(*weighted.system, {&lagrangian, 1}).front());
    return build_kernel(source);
  }
  Kernel kernel_;
  TaylorStepper stepper_;
};

class Study {
 public:
  Study(Functional& functional, const EquationsOfMotion& weighted, Expr lagrangian, const Trial& trial,
        std::span<const MotionState> states, const FixedEnds& fixed, const Vector& least, std::vector<double> breaks,
        const StopFlag* interrupt)
      : functional_(functional),
        trial_(trial),
        fixed_(fixed),
        breaks_(std::move(breaks)),
        backward_(breaks_.back() < breaks_.front()),
        whole_(std::abs(breaks_.back() - breaks_.front())),
        neighbours_(functional, weighted, trial, states, backward_, whole_ / static_cast<double>(breaks_.size() - 1),
                    interrupt),
        action_(solvable_equations(weighted), lagrangian),
        size_(scale_of_found(trial, least, functional.orders()).col(0)) {}

  FieldStudy run() {
    MotionState from = neighbours_.state(breaks_.front());
    first_tangent_ = basis_ = neighbours_.tangent(from);
    const Index d = first_tangent_.cols() + neighbours_.integrals();
    frame_ = Matrix::Zero(2 * d, d);
    frame_.bottomRows(d).setIdentity();
    total_ = Matrix::Identity(2 * d, 2 * d);
    std::size_t next = 1;
    while (next < breaks_.size()) {
      if (++out_.check.stretches > most_stretches || d == 0)
        return fail(d == 0 ? "Nothing can move." : "The path takes too many stretches.");
      const auto reached = stretch(from, breaks_[next]);
      if (!reached) return std::move(out_);
      if (*reached == breaks_[next] || near_conjugate_) ++next;  // a break next to a conjugate point is passed over
      from = neighbours_.state(*reached);
    }
    finish();
    return std::move(out_);
  }

 private:
  FieldStudy fail(std::string why) {
    out_.reason = out_.check.reason = std::move(why);
    return std::move(out_);
  }

  /// One stretch from a state towards a time, shorter where it has to be; where it ended.
  std::optional<double> stretch(const MotionState& from, double next_break) {
    double to = next_break;
    near_conjugate_ = false;
    for (int attempt = 0; attempt < 40; ++attempt) {
      const auto carried = neighbours_.carry(from, basis_, to);
      if (!carried.stopped.empty()) return fail(carried.stopped), std::nullopt;
      const double half = from.t + (to - from.t) / 2;
      if (!carried.transfer.allFinite() ||
          !neighbours_.short_enough(carried.transfer, from, basis_, std::abs(to - from.t))) {
        if (half == from.t || half == to) break;
        near_conjugate_ = false;
        to = half;
        continue;
      }
      Matrix next = product(carried.transfer, frame_);
      next = columns_of_q(Eigen::HouseholderQR<Matrix>(next), next.cols());
      const Vector sizes = Eigen::JacobiSVD<Matrix>(next.topRows(next.cols())).singularValues();
      const bool last = to == breaks_.back();
      if (!last && sizes.minCoeff() < too_near_end) {
        near_conjugate_ = near_conjugate_ || to == next_break;
        to = from.t + 0.83 * (to - from.t);
        continue;
      }
      if (last) out_.at_end = static_cast<std::size_t>((sizes.array() < on_end).count());
      count(from, to, carried.transfer, last ? out_.at_end : 0);
      compare(from, carried.end);
      frame_ = next;
      basis_ = carried.basis;
      total_ = product(carried.transfer, total_);
      return to;
    }
    return fail("Stretches of the path become too short for a conjugate point to be located."), std::nullopt;
  }

  static Vector eigenvalues(const Matrix& frame, const Matrix& transfer) {
    const Index d = frame.cols();
    const Matrix q = frame.topRows(d), p = frame.bottomRows(d);
    const Matrix u = inverse_times(transfer.topRightCorner(d, d), transfer.topLeftCorner(d, d));
    const Matrix g = quadratic_form(q, u) + transposed_product(q, p);
    return Eigen::SelfAdjointEigenSolver<Matrix>(symmetric_part(g), Eigen::EigenvaluesOnly).eigenvalues();
  }

  void count(const MotionState& from, double to, const Matrix& transfer, std::size_t at_end) {
    if (frame_.topRows(frame_.cols()).isZero(0)) return;
    Vector values = eigenvalues(frame_, transfer);
    for (std::size_t i = 0; i < at_end; ++i) {
      Index nearest = 0;
      values.cwiseAbs().minCoeff(&nearest);
      values[nearest] = HUGE_VAL;
    }
    const auto crossed = static_cast<Index>((values.array() < 0).count());
    for (Index j = 0; j < crossed; ++j) add_point(root(from, to, j));
  }

  /// Where the j-th eigenvalue passes zero: it is positive after the beginning and negative at the end.
  double root(const MotionState& from, double to, Index j) {
    const auto value = [&](double t) {
      const auto carried = neighbours_.carry(from, basis_, t);
      return eigenvalues(frame_, carried.transfer)[j] * std::abs(t - from.t);
    };
    last_side_ = 0;
    double before = HUGE_VAL;
    double high = to, at_high = value(to), low = from.t + 0.05 * (to - from.t), at_low = value(low);
    for (int turn = 0; turn < 40 && at_low < 0; ++turn) {
      high = low, at_high = at_low;
      low = from.t + 0.1 * (low - from.t);
      at_low = value(low);
    }
    for (int turn = 0; turn < 100 && std::abs(high - low) > 4e-16 * (whole_ + std::abs(high)); ++turn) {
      // The Illinois rule: an end that stays loses half its weight, so that both ends move.
      double t = (low * at_high - high * at_low) / (at_high - at_low);
      if (!(std::min(low, high) < t && t < std::max(low, high))) t = (low + high) / 2;
      const double moved = std::abs(t - before);
      before = t;
      const double here = value(t);
      if (here == 0 || moved <= 1e-14 * whole_) return t;
      if (here < 0) {
        if (last_side_ < 0) at_low /= 2;
        high = t, at_high = here, last_side_ = -1;
      } else {
        if (last_side_ > 0) at_high /= 2;
        low = t, at_low = here, last_side_ = 1;
      }
    }
    return (low + high) / 2;
  }

  void add_point(double t) {
    for (ConjugatePoint& p : out_.inside)
      if (std::abs(p.t - t) < same_place * whole_) {
        ++p.multiplicity;
        return;
      }
    out_.inside.push_back({t, 1});
  }

  void compare(const MotionState& from, const MotionState& end) {
    const MotionState on_path = neighbours_.state(end.t);
    for (Index i = 0; i < size_.size(); ++i)
      out_.check.missed =
          std::max(out_.check.missed,
                   std::abs(end.q[static_cast<std::size_t>(i)] - on_path.q[static_cast<std::size_t>(i)]) / size_[i]);
    if (const auto part = action_.over(from, end.t))
      out_.check.action += backward_ ? -*part : *part;
    else
      out_.check.reason = "The motion ends on the way.";
  }

  void finish() {
    std::sort(out_.inside.begin(), out_.inside.end(),
              [](const ConjugatePoint& a, const ConjugatePoint& b) { return a.t < b.t; });
    out_.check.done = out_.check.reason.empty();
    out_.check.from = std::min(breaks_.front(), breaks_.back());
    out_.check.to = std::max(breaks_.front(), breaks_.back());
    if (!all_fixed(functional_, trial_, fixed_) && out_.at_end == 0) out_.concavity = concavity();
  }

  /// Directions of an end that stay free, in the coordinates of the frame there [(d + k) × free].
  Matrix free_directions(const Matrix& tangent, const std::vector<bool>& fixed) const {
    const Index n = tangent.rows();
    Matrix rows(0, n);
    for (Index i = 0; i < n; ++i)
      if (fixed[static_cast<std::size_t>(i)]) {
        rows.conservativeResize(rows.rows() + 1, n);
        rows.row(rows.rows() - 1) = Vector::Unit(n, i).transpose();
      }
    const Matrix free = null_basis(product(rows, tangent), tangent.cols());
    Matrix out = Matrix::Zero(tangent.cols() + neighbours_.integrals(), free.cols());
    out.topRows(tangent.cols()) = free;
    return out;
  }

  /// Negative eigenvalues of the Hessian of the principal function S(q0, q1) on the ends that are allowed.
  std::size_t concavity() {
    const Index d = frame_.cols(), k = neighbours_.integrals();
    const Matrix a = total_.topLeftCorner(d, d), b = total_.topRightCorner(d, d), dd = total_.bottomRightCorner(d, d);
    const Matrix inverse = b.partialPivLu().inverse();
    Matrix c(2 * d, 2 * d);
    c.topLeftCorner(d, d) = product(inverse, a);
    c.topRightCorner(d, d) = -inverse;
    c.bottomLeftCorner(d, d) = -inverse.transpose();
    c.bottomRightCorner(d, d) = product(dd, inverse);
    const Matrix& last_tangent = basis_;
    Matrix w;
    if (trial_.mesh.closed) {
      w = Matrix::Zero(2 * d, d - k);
      w.topRows(d - k).setIdentity();
      w.middleRows(d, d - k) = transposed_product(last_tangent, first_tangent_);
    } else {
      const Matrix first = free_directions(first_tangent_, fixed_.from),
                   last = free_directions(last_tangent, fixed_.to);
      w = Matrix::Zero(2 * d, first.cols() + last.cols());
      w.topLeftCorner(d, first.cols()) = first;
      w.bottomRightCorner(d, last.cols()) = last;
    }
    if (w.cols() == 0) return 0;  // constraints leave nothing of the ends' freedom
    const Matrix on = symmetric_part(quadratic_form(w, c));
    const Vector values = Eigen::SelfAdjointEigenSolver<Matrix>(on, Eigen::EigenvaluesOnly).eigenvalues();
    const double zero = 1e-8 * c.cwiseAbs().maxCoeff();  // the same closed orbit, begun later, changes nothing
    return static_cast<std::size_t>((values.array() < -zero).count());
  }

  Functional& functional_;
  const Trial& trial_;
  const FixedEnds& fixed_;
  std::vector<double> breaks_;
  bool backward_;
  double whole_;
  Neighbours neighbours_;
  ActionAlong action_;
  Vector size_;
  Matrix frame_, total_, first_tangent_, basis_;
  FieldStudy out_;
  int last_side_ = 0;
  bool near_conjugate_ = false;  // the break that the stretch went for
};

/// The breaks of the mesh, those next to an end where L is infinite left out; from an end where it is finite.
std::vector<double> breaks_of(const Trial& trial, bool singular_start, bool singular_end) {
  constexpr double nearest = 1e-6;  // of the whole, to an end where L is infinite
  std::vector<double> out;
  const double begin = trial.mesh.start, whole = trial.mesh.whole;
  for (Index e = 0; e <= trial.mesh.elements(); ++e) {
    const double t = trial.mesh.t(e < trial.mesh.elements() ? trial.mesh.begins[static_cast<std::size_t>(e)] : 1.0);
    if (singular_start && t - begin < nearest * whole) continue;
    if (singular_end && begin + whole - t < nearest * whole) continue;
    out.push_back(t);
  }
  if (singular_start && !singular_end) std::reverse(out.begin(), out.end());
  return out;
}

}  // namespace

MotionCheck carried_along(const EquationsOfMotion& weighted, Expr lagrangian, const Trial& trial, const Vector& least,
                          const StopFlag* interrupt) {
  MotionCheck out;
  const ActionPath path = to_path(trial);
  const Vector size = scale_of_found(trial, least, OrderOfCoordinates(*weighted.system)).col(0);
  const std::vector<double> breaks = breaks_of(trial, false, false);
  ActionAlong motion(solvable_equations(weighted), lagrangian, interrupt);
  for (std::size_t k = 0; k + 1 < breaks.size(); ++k) {
    const auto part = motion.over(path.at(breaks[k]), breaks[k + 1]);
    if (!part) return out.reason = "The motion ends on the way.", out;
    const MotionState there = path.at(breaks[k + 1]);
    for (Index i = 0; i < size.size(); ++i) {
      const auto at = static_cast<std::size_t>(i);
      out.missed = std::max(out.missed, std::abs(motion.q()[at] - there.q[at]) / size[i]);
    }
    out.action += *part;
    ++out.stretches;
  }
  out.done = true;
  out.from = breaks.front();
  out.to = breaks.back();
  return out;
}

std::size_t FieldStudy::count() const {
  return std::accumulate(inside.begin(), inside.end(), std::size_t{0},
                         [](std::size_t sum, const ConjugatePoint& p) { return sum + p.multiplicity; });
}

FieldStudy jacobi_fields(Functional& functional, const EquationsOfMotion& weighted, Expr lagrangian, const Trial& trial,
                         std::span<const MotionState> states, const FixedEnds& fixed, bool singular_start,
                         bool singular_end, const Vector& least, const StopFlag* interrupt) {
  std::vector<double> breaks = breaks_of(trial, singular_start, singular_end);
  if (breaks.size() < 2) {
    FieldStudy out;
    out.reason = out.check.reason = "L is infinite at both ends, and nothing of the path lies between.";
    return out;
  }
  return Study(functional, weighted, lagrangian, trial, states, fixed, least, std::move(breaks), interrupt).run();
}

}  // namespace maupertuis::action
