#include "integrator/stiff/radau_method.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace maupertuis::stiff {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

constexpr double eps = std::numeric_limits<double>::epsilon();

Index at(std::size_t i) { return static_cast<Index>(i); }

/// The weights of a quadrature on 0, c_1 … c_s that is exact up to the degree s − 1 and has the weight `first` at 0:
/// [s], those of c.
VectorXd embedded_weights(const std::vector<double>& c, double first) {
  const Index s = at(c.size());
  MatrixXd powers(s, s);
  VectorXd moments(s);
  for (Index k = 0; k < s; ++k) {
    moments[k] = 1.0 / static_cast<double>(k + 1) - (k == 0 ? first : 0);
    for (Index i = 0; i < s; ++i) powers(k, i) = std::pow(c[static_cast<std::size_t>(i)], static_cast<double>(k));
  }
  return powers.partialPivLu().solve(moments);
}

/// Seven points for tolerances near the end of double precision, fewer for coarser ones.
int stages_for(double tolerance) { return tolerance < 1e-7 ? 7 : tolerance < 1e-4 ? 5 : 3; }

/// Lagrange's polynomials on the nodes, at x.
std::vector<double> lagrange(const std::vector<double>& nodes, double x) {
  std::vector<double> out(nodes.size(), 1);
  for (std::size_t j = 0; j < nodes.size(); ++j)
    for (std::size_t k = 0; k < nodes.size(); ++k)
      if (k != j) out[j] *= (x - nodes[k]) / (nodes[j] - nodes[k]);
  return out;
}

}  // namespace

Stages::Stages(int count) : tableau(count, CollocationTableau::Points::Radau), s(count), nodes{0} {
  nodes.insert(nodes.end(), tableau.c.begin(), tableau.c.end());
  const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> a(tableau.a.data(), s,
                                                                                                   s);
  a_inverse = MatrixXd(a).partialPivLu().solve(MatrixXd(MatrixXd::Identity(s, s)));
  for (Index k = 0; k < s; ++k)
    if (tableau.lambda[static_cast<std::size_t>(k)].imag() == 0) real = k;
  gamma = tableau.lambda[static_cast<std::size_t>(real)].real();
  const VectorXd b = Eigen::Map<const VectorXd>(tableau.b.data(), s);
  error = a_inverse.transpose() * VectorXd(embedded_weights(tableau.c, gamma) - b);
}

RadauMethod::RadauMethod(Motion& motion)
    : motion_(motion),
      system_(motion),
      stages_(stages_for(motion.options.tolerance)),
      y_(at(system_.size())),
      rate_(at(system_.size())),
      w_(integrals()),
      weight_(2 * motion.freedoms()) {
  z_.setZero(y_.size(), stages_.s);
  residual_ = change_ = z_;
  w_stages_.setZero(at(integrals()), stages_.s);
}

/// λ and v̇ are those of the bordered system; μ = 0.
void RadauMethod::restart(double t, std::span<const double> y) {
  rows_ = motion_.at_point.rows();
  system_.set_rows(rows_);
  const std::size_t n = motion_.freedoms();
  const auto v = motion_.v_of(y), a = motion_.at_point.a(), lambda = motion_.at_point.lambda();
  y_.setZero(), rate_.setZero();
  std::copy_n(y.begin(), 2 * n, y_.data());
  std::copy(lambda.begin(), lambda.end(), y_.data() + 2 * n);
  std::copy(v.begin(), v.end(), rate_.data());
  std::copy(a.begin(), a.end(), rate_.data() + n);
  std::copy(y.begin() + static_cast<std::ptrdiff_t>(2 * n), y.end(), w_.begin());
  t_ = t;
  h_ = h_before_ = 0;
  matrices_known_ = false;
}

/// A tenth of the time in which q bends away from its tangent by what a step may err.
double RadauMethod::first_step(double distance) {
  const std::size_t n = motion_.freedoms();
  double bend = 0;
  for (std::size_t i = 0; i < n; ++i) bend = std::max(bend, weight_[i] * std::abs(rate_[at(n + i)]));
  return std::min(0.1 * std::sqrt(2 / bend), 1e-3 * std::abs(distance));
}

bool RadauMethod::find_matrices() {
  matrices_known_ = matrices_fresh_ =
      system_.derivatives(t_, {y_.data(), system_.size()}, {rate_.data(), system_.size()}, by_rate_, by_state_);
  factored_for_ = 0;
  return matrices_known_;
}

/// ∂F/∂ẏ / (hλ) + ∂F/∂y for each eigenvalue λ of A, rows by their largest entries.
void RadauMethod::factor(double h) {
  if (factored_for_ == h) return;
  factored_for_ = h;
  factors_.rows = (by_rate_.cwiseAbs() / std::abs(h) + by_state_.cwiseAbs()).rowwise().maxCoeff();
  for (double& row : factors_.rows) row = row > 0 ? 1 / row : 1;
  const MatrixXd by_rate = factors_.rows.asDiagonal() * by_rate_, by_state = factors_.rows.asDiagonal() * by_state_;
  factors_.complex.clear();
  for (Index k = 0; k < stages_.s; ++k) {
    const std::complex<double> part = 1.0 / (h * stages_.lambda(k));
    if (k == stages_.real)
      factors_.real.compute(MatrixXd(part.real() * by_rate + by_state));
    else if (stages_.lambda(k).imag() > 0)
      factors_.complex.emplace_back(MatrixXcd(part * by_rate + by_state));
  }
  find_rounding(by_rate, by_state);
}

/// What rounding of the terms of F, and of the time in it, may do to a state through Newton's matrix, with
/// several patterns of signs: below it neither an error nor a change of Newton's iteration says anything.
void RadauMethod::find_rounding(const MatrixXd& by_rate, const MatrixXd& by_state) {
  constexpr double roundings = 8;
  VectorXd terms = roundings * eps * (by_rate.cwiseAbs() * rate_.cwiseAbs() + by_state.cwiseAbs() * y_.cwiseAbs());
  const std::size_t size = system_.size();
  VectorXd here(y_.size()), beside(y_.size());
  const double later = t_ + roundings * eps * std::abs(t_);
  if (system_.residual(t_, {y_.data(), size}, {rate_.data(), size}, {here.data(), size}) &&
      system_.residual(later, {y_.data(), size}, {rate_.data(), size}, {beside.data(), size}))
    terms += factors_.rows.cwiseProduct((beside - here).cwiseAbs());
  // One pattern of signs may cancel in a system that is symmetric.
  MatrixXd signed_terms = terms.replicate(1, 3);
  for (Index i = 0; i < terms.size(); ++i) {
    if (i % 2 == 1) signed_terms(i, 0) = -terms[i];
    if (i / 2 % 2 == 1) signed_terms(i, 1) = -terms[i];
    if (i * (i + 1) / 2 % 3 == 1) signed_terms(i, 2) = -terms[i];
  }
  rounding_ = VectorXd::Zero(terms.size());
  for (Index k = 0; k < signed_terms.cols(); ++k)
    rounding_ = rounding_.cwiseMax(factors_.real.solve(VectorXd(signed_terms.col(k))).cwiseAbs());
}

/// The largest of changes of q and v beside what a step may err, above rounding.
double RadauMethod::size_of(const VectorXd& change) const {
  double out = 0;
  for (std::size_t i = 0; i < weight_.size(); ++i)
    out = std::max(out, weight_[i] * (std::abs(change[at(i)]) - rounding_[at(i)]));
  return change.allFinite() ? out : std::numeric_limits<double>::infinity();
}

/// The polynomial of the step before goes on; at a beginning the tangent.
void RadauMethod::predict(double h) {
  for (Index i = 0; i < stages_.s; ++i) {
    const double c = stages_.tableau.c[static_cast<std::size_t>(i)];
    if (h_before_ == 0) {
      z_.col(i) = c * h * rate_;
      continue;
    }
    const std::vector<double> part = lagrange(stages_.nodes, 1 + c * h / h_before_);
    z_.col(i) = y_before_ - y_;
    for (Index j = 0; j < stages_.s; ++j) z_.col(i) += part[static_cast<std::size_t>(j) + 1] * z_before_.col(j);
  }
}

bool RadauMethod::residuals(double h) {
  const MatrixXd rates = z_ * MatrixXd(stages_.a_inverse.transpose() / h);
  const std::size_t size = system_.size();
  for (Index i = 0; i < stages_.s; ++i) {
    const VectorXd state = y_ + z_.col(i), rate = rates.col(i);
    if (!system_.residual(t_ + stages_.tableau.c[static_cast<std::size_t>(i)] * h, {state.data(), size},
                          {rate.data(), size}, {residual_.col(i).data(), size}))
      return false;
  }
  return true;
}

/// Z −= J⁻¹F; the largest change beside what a step may err.
double RadauMethod::correct() {
  change_.setZero();
  std::size_t pair = 0;
  for (Index k = 0; k < stages_.s; ++k) {
    if (stages_.lambda(k).imag() < 0) continue;
    VectorXcd right = VectorXcd::Zero(y_.size());
    for (Index i = 0; i < stages_.s; ++i) right += stages_.inverse(k, i) * residual_.col(i);
    right.array() *= factors_.rows.array();
    if (k == stages_.real) {
      const VectorXd solved = factors_.real.solve(VectorXd(right.real()));
      for (Index i = 0; i < stages_.s; ++i) change_.col(i) += stages_.basis(i, k).real() * solved;
    } else {
      const VectorXcd solved = factors_.complex[pair++].solve(right);
      for (Index i = 0; i < stages_.s; ++i) change_.col(i) += 2 * VectorXcd(stages_.basis(i, k) * solved).real();
    }
  }
  z_ -= change_;
  return size_of(change_.cwiseAbs().rowwise().maxCoeff());
}

/// Newton's iteration, to a hundredth of what a step may err, or as far as rounding lets it.
std::optional<Failure> RadauMethod::solve_stages(double h) {
  constexpr int most_rounds = 15;
  constexpr double enough = 0.01, stays = 0.1;  // of what a step may err
  double before = 0;
  contraction_ = 0;
  for (int round = 1; round <= most_rounds; ++round) {
    if (!residuals(h)) return Failure::Value;
    const double change = correct();
    if (!std::isfinite(change)) return Failure::Convergence;
    if (change <= 1e-3 * enough) return std::nullopt;
    if (round > 1) {
      contraction_ = change / before;
      if (contraction_ < 1 && change * contraction_ / (1 - contraction_) <= enough) return std::nullopt;
      if (contraction_ > 0.5 && change <= stays) return std::nullopt;
      if (contraction_ >= 2 || (round > 3 && contraction_ > 0.9)) return Failure::Convergence;
    }
    before = change;
  }
  return Failure::Convergence;
}

/// The error of the step beside what it may be. What decays faster than the step is taken out of the estimate by
/// (1 + hγ (∂F/∂ẏ)⁻¹ ∂F/∂y)⁻¹.
double RadauMethod::error_of(double h) {
  VectorXd error = h * stages_.gamma * rate_ + z_ * stages_.error;
  const auto filter = [&] {
    const VectorXd right = factors_.rows.cwiseProduct(by_rate_ * error) / (h * stages_.gamma);
    error = factors_.real.solve(right);
  };
  filter();
  if (const double once = size_of(error); once <= 1) return once;
  filter();
  return size_of(error);
}

Advance RadauMethod::advance(double bound, std::span<double> y) {
  constexpr double slow = 1e-3;  // a contraction of Newton's iteration: its matrices are found anew
  const double distance = bound - t_, resolution = 4 * eps * std::max(std::abs(t_), std::abs(bound));
  if (!motion_.weigh({y_.data(), 2 * motion_.freedoms()}, weight_)) return failed(Failure::Value);
  if (h_ == 0) h_ = std::max(first_step(distance), 16 * resolution);
  if (longest_ > 0) h_ = std::min(h_, longest_);
  matrices_fresh_ = false;
  if ((!matrices_known_ || contraction_ > slow) && !find_matrices()) return failed(Failure::Value);
  std::optional<Failure> failure = Failure::ErrorTest;
  while (h_ > resolution) {
    const bool is_last = h_ * (1 + 1e-4) >= std::abs(distance);
    const double h = std::copysign(is_last ? std::abs(distance) : h_, distance);
    failure = attempt(h);
    if (!failure) return accept(h, is_last ? bound : t_ + h, y);
    if (failure == Failure::Convergence && !matrices_fresh_) {
      if (!find_matrices()) return failed(Failure::Value);
      h_ = std::abs(h);
    }
  }
  return failed(*failure);
}

/// Solves a step, and chooses the length of the next, or of the next attempt.
std::optional<Failure> RadauMethod::attempt(double h) {
  factor(h);
  predict(h);
  if (const auto failure = solve_stages(h)) {
    h_ = 0.25 * std::abs(h);
    return failure;
  }
  const double error = error_of(h);
  if (error <= 1) {
    choose_next(h, error);
    return std::nullopt;
  }
  h_ = std::abs(h) * std::clamp(0.9 * std::pow(error, -1.0 / (degree() + 1)), 0.1, 0.9);
  return Failure::ErrorTest;
}

/// The next step by the error of this one and how it changed (Gustafsson).
void RadauMethod::choose_next(double h, double error) {
  const double power = 1.0 / (degree() + 1), now = std::max(error, 1e-10);
  double factor = 0.9 * std::pow(now, -power);
  if (h_before_ != 0)
    factor = std::min(factor, 0.9 * std::abs(h / h_before_) * std::pow(error_before_ / (now * now), power));
  factor = std::clamp(factor, 0.2, 8.0);
  if (factor >= 1 && factor < 1.2) factor = 1;  // the factors stay
  const double next = factor * std::abs(h);
  h_ = std::abs(h) < h_ ? std::max(h_, next) : next;  // a step up to a bound says little of the next
  error_before_ = now;
}

/// The integrals up to the stages, by the polynomial through their integrands.
bool RadauMethod::integrate(double h) {
  const Index s = stages_.s;
  MatrixXd integrands(at(integrals()), s);
  for (Index i = 0; i < s && integrals() > 0; ++i) {
    const VectorXd state = y_ + z_.col(i);
    if (!motion_.solve(t_ + stages_.tableau.c[static_cast<std::size_t>(i)] * h, {state.data(), system_.size()}))
      return false;
    motion_.integrand_values({integrands.col(i).data(), integrals()});
  }
  for (Index i = 0; i < s; ++i) {
    w_stages_.col(i).setZero();
    for (Index j = 0; j < s; ++j)
      w_stages_.col(i) += h * stages_.tableau.a[static_cast<std::size_t>(i * s + j)] * integrands.col(j);
  }
  return true;
}

/// Goes on from the end of the step, put onto the constraints. Where that moves it by more than a step may err and more
/// than rounding does, or onto other rows of the constraints, the history ends. A velocity that vanishes may err by
/// nothing at all, and each step would begin anew.
Advance RadauMethod::accept(double h, double end, std::span<double> y) {
  const Index last = stages_.s - 1;
  const std::size_t n = motion_.freedoms();
  if (!integrate(h)) return failed(Failure::Value);
  t_before_ = t_, h_before_ = h, y_before_ = y_, w_before_ = w_, z_before_ = z_;
  t_ = end;
  y_ += z_.col(last);
  rate_ = z_ * VectorXd(stages_.a_inverse.row(last).transpose() / h);
  for (std::size_t k = 0; k < w_.size(); ++k) w_[k] += w_stages_(at(k), last);
  std::copy_n(y_.data(), 2 * n, y.begin());
  std::copy(w_.begin(), w_.end(), y.begin() + static_cast<std::ptrdiff_t>(2 * n));
  if (!motion_.project(t_, y)) return failed(Failure::Constraints);
  double move = 0;
  for (std::size_t i = 0; i < 2 * n; ++i) {
    move = std::max(move, weight_[i] * (std::abs(y[i] - y_[at(i)]) - rounding_[at(i)]));
    y_[at(i)] = y[i];
  }
  Advance out;
  out.reached = t_;
  out.history_ends = move > 1 || motion_.at_point.rows() != rows_;
  return out;
}

void RadauMethod::interpolate_at(double where, std::span<double> y) const {
  const std::vector<double> part = lagrange(stages_.nodes, where);
  const std::size_t n2 = 2 * motion_.freedoms();
  for (std::size_t i = 0; i < n2; ++i) {
    double sum = 0;
    for (Index j = 0; j < stages_.s; ++j) sum += part[static_cast<std::size_t>(j) + 1] * z_before_(at(i), j);
    y[i] = y_before_[at(i)] + sum;
  }
  for (std::size_t k = 0; k < w_before_.size(); ++k) {
    double sum = 0;
    for (Index j = 0; j < stages_.s; ++j) sum += part[static_cast<std::size_t>(j) + 1] * w_stages_(at(k), j);
    y[n2 + k] = w_before_[k] + sum;
  }
}

}  // namespace maupertuis::stiff
