#include "fields/collocation.hpp"
#include "linear_algebra/banded.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

/// A step of collocation: stages by Newton's method with banded factors, then what they add to c and p.
namespace maupertuis {

void CollocationMotion::refresh_matrices(const std::vector<double>& c, const std::vector<double>& v, double t) {
  mesh_.set(c.data(), v.data(), t);
  matrices_ = mesh_.matrices();
  factors_.clear();
}

const CollocationMotion::Factors* CollocationMotion::factors_for(double h) {
  for (const auto& [step, factors] : factors_)
    if (std::abs(step - h) <= 1e-9 * std::abs(h)) return &factors;
  constexpr std::size_t most_kept = 4;
  if (factors_.size() >= most_kept) factors_.clear();
  Factors out;
  for (const std::complex<double>& lambda : tableau_.lambda) {
    out.of.emplace_back();
    if (lambda.imag() < 0) continue;
    const std::complex<double> one = h * lambda, two = one * one;
    MeshMatrix<std::complex<double>> matrix(mesh_.pattern());
    mesh_.pattern()->for_each([&](std::size_t i, std::size_t j, std::size_t k) {
      matrix.values[k] = is_held_[i] || is_held_[j]
                             ? std::complex<double>(i == j ? 1 : 0)
                             : matrices_.m.values[k] + one * matrices_.g.values[k] + two * matrices_.k.values[k];
    });
    if (!matrix.factor()) {
      trouble_ = null_.empty() ? "mass" : "shapes";
      return nullptr;
    }
    out.of.back() = std::move(matrix);
    for (const std::vector<double>& v : null_) {
      out.null.emplace_back(v.begin(), v.end());
      out.of.back().solve(out.null.back().data());
    }
  }
  return &factors_.emplace(h, std::move(out)).first->second;
}

void CollocationMotion::residuals(double h) {
  const std::size_t s = tableau_.stages, n = mesh_.size();
  std::vector<std::vector<double>> force(s, std::vector<double>(n));
  for (std::size_t i = 0; i < s; ++i) {
    for (std::size_t k = 0; k < n; ++k) {
      double sum = 0;
      for (std::size_t j = 0; j < s; ++j) sum += tableau_.a[i * s + j] * stage_v_[j][k];
      stage_q_[i][k] = state_.c[k] + (h * sum + state_.c_lost[k]);
    }
    const double t = state_.t + tableau_.c[i] * h;
    mesh_.set(stage_q_[i].data(), stage_v_[i].data(), t);
    mesh_.momenta(residual_[i].data());
    mesh_.forces(force[i].data());
    add_end_forces(t, force[i].data());
  }
  for (std::size_t i = 0; i < s; ++i)
    for (std::size_t k = 0; k < n; ++k) {
      double sum = 0;
      for (std::size_t j = 0; j < s; ++j) sum += tableau_.a[i * s + j] * force[j][k];
      residual_[i][k] = is_held_[k] ? 0 : (residual_[i][k] - state_.p[k]) - (h * sum + state_.p_lost[k]);
    }
}

/// w −= Y (NᵀY)⁻¹ Nᵀ w, Y = J⁻¹ N: the null vectors N take a force that keeps them where they are.
void CollocationMotion::leave_null_vectors_out(const Factors& factors, std::size_t stage,
                                               std::vector<std::complex<double>>& w) const {
  const std::size_t m = null_.size();
  if (m == 0) return;
  std::size_t first = 0;  // of Y of this stage
  for (std::size_t k = 0; k < stage; ++k)
    if (tableau_.lambda[k].imag() >= 0) first += m;
  BandedMatrix<std::complex<double>> small(m, m, m);
  std::vector<std::complex<double>> parts(m, 0);
  for (std::size_t i = 0; i < m; ++i)
    for (std::size_t x = 0; x < w.size(); ++x) {
      parts[i] += null_[i][x] * w[x];
      for (std::size_t j = 0; j < m; ++j) small.at(i, j) += null_[i][x] * factors.null[first + j][x];
    }
  if (!small.factor()) return;
  small.solve(parts.data());
  for (std::size_t j = 0; j < m; ++j)
    for (std::size_t x = 0; x < w.size(); ++x) w[x] -= factors.null[first + j][x] * parts[j];
}

/// V −= J⁻¹ r. The largest change of h V beside the size of its field, both in the mean square: products of functions
/// that all but cancel are known to fewer digits than what they add up to.
double CollocationMotion::correct(double h, const Factors& factors) {
  using Complex = std::complex<double>;
  const std::size_t s = tableau_.stages, n = mesh_.size();
  std::vector<Complex> w(n);
  std::vector<std::vector<double>> change(s, std::vector<double>(n, 0));
  for (std::size_t k = 0; k < s; ++k) {
    if (tableau_.lambda[k].imag() < 0) continue;
    const bool pair = tableau_.lambda[k].imag() > 0;
    for (std::size_t x = 0; x < n; ++x) {
      Complex sum = 0;
      for (std::size_t j = 0; j < s; ++j) sum += tableau_.inverse[k * s + j] * residual_[j][x];
      w[x] = sum;
    }
    factors.of[k].solve(w.data());
    leave_null_vectors_out(factors, k, w);
    for (std::size_t i = 0; i < s; ++i) {
      const Complex t = tableau_.basis[i * s + k];
      for (std::size_t x = 0; x < n; ++x)
        change[i][x] += (pair ? 2 : 1) * (t.real() * w[x].real() - t.imag() * w[x].imag());
    }
  }
  std::vector<double> size = recent_size_, largest(form_.smooth.size());
  for (std::size_t i = 0; i < s; ++i) {
    for (std::size_t x = 0; x < n; ++x) {
      if (is_held_[x])
        change[i][x] = 0;
      else
        stage_v_[i][x] -= change[i][x];
    }
  }
  std::size_t worst = 0;  // stage
  double most = 0;
  for (std::size_t i = 0; i < s; ++i)
    for (const double value : change[i])
      if (std::abs(value) > most) most = std::abs(value), worst = i;
  const std::vector<double> now = mesh_.squares(stage_q_[worst]), moved = mesh_.squares(change[worst]);
  for (std::size_t f = 0; f < size.size(); ++f)
    size[f] = std::max(size[f], std::sqrt(now[f])), largest[f] = std::abs(h) * std::sqrt(moved[f]);
  double all = 0, out = 0;
  for (const double value : size) all = std::max(all, value);
  for (std::size_t f = 0; f < size.size(); ++f) out = std::max(out, largest[f] / std::max(size[f], 1e-8 * all));
  return std::isfinite(all) ? out : std::nan("");
}

bool CollocationMotion::newton(double h) {
  constexpr int most_rounds = 40;
  constexpr double enough = 4e-16, settled = 1e-10;
  double before = 0;
  slow_ = false;
  for (int round = 1; round <= most_rounds; ++round) {
    interrupt_.throw_if_asked();
    residuals(h);
    const Factors* factors = factors_for(h);
    if (!factors) return false;
    const double change = correct(h, *factors);
    if (!std::isfinite(change)) return false;
    if (change <= enough) return true;
    // The matrices of a linear system are exact: what a second round changes is rounding.
    const bool exact = form_.linear && null_.empty();
    if (round > 1 && (exact || change > 0.3 * before) && change <= settled) {
      rounding_ = change;
      return true;
    }
    if (round > 6) slow_ = true;
    if (round > 3 && change > 2 * before && change > settled) return false;
    before = change;
  }
  return false;
}

bool CollocationMotion::step(double h) {
  constexpr int most_halvings = 12;
  return step_or_halves(h, most_halvings);
}

bool CollocationMotion::step_or_halves(double h, int halvings) {
  if (one_step(h)) return true;
  if (trouble_ != "stuck" || halvings == 0) return false;
  trouble_.clear();
  have_stages_ = false;
  return step_or_halves(h / 2, halvings - 1) && step_or_halves(h / 2, halvings - 1);
}

/// Rates at the stages: the polynomial of the step before goes on, where its length was the same.
void CollocationMotion::predict_stages(double h) {
  const std::size_t s = tableau_.stages, n = mesh_.size();
  const bool goes_on = have_stages_ && std::abs(h - last_h_) < 1e-6 * std::abs(h);
  const std::vector<std::vector<double>> before = stage_v_;
  for (std::size_t i = 0; i < s; ++i) {
    stage_v_[i] = have_stages_ ? before.back() : rates_;
    if (goes_on) {
      std::fill(stage_v_[i].begin(), stage_v_[i].end(), 0);
      for (std::size_t j = 0; j < s; ++j)
        for (std::size_t k = 0; k < n; ++k) stage_v_[i][k] += tableau_.continuation[i * s + j] * before[j][k];
    }
    for (const Held& held : held_)
      if (!held.force) impose(held, 1, state_.t + tableau_.c[i] * h, stage_v_[i]);
  }
}

bool CollocationMotion::find_stages(double h) {
  if (slow_ && !form_.linear) refresh_matrices(state_.c, stage_v_.back(), state_.t);
  predict_stages(h);
  if (newton(h)) return true;
  if (!trouble_.empty() || form_.linear) return false;
  refresh_matrices(state_.c, rates_, state_.t);  // once more, with matrices of this moment
  have_stages_ = false;
  predict_stages(h);
  return newton(h);
}

bool CollocationMotion::one_step(double h) {
  if (!find_stages(h)) {
    if (trouble_.empty()) trouble_ = "stuck";
    return false;
  }
  add_stages(h);
  state_.t += h, t_ = state_.t;
  for (const Held& held : held_)
    if (!held.force) impose(held, 0, t_, state_.c);
  if (all_first_order_) {  // p is a function of c: no error gathers between them
    mesh_.set(state_.c.data(), rates_.data(), t_);
    mesh_.momenta(state_.p.data());
    std::fill(state_.p_lost.begin(), state_.p_lost.end(), 0);
  }
  have_stages_ = true, last_h_ = h, rates_known_ = false;
  note_size();
  if (std::all_of(state_.c.begin(), state_.c.end(), [](double value) { return std::isfinite(value); })) return true;
  trouble_ = "overflow";
  return false;
}

/// Δc and Δp of the step, each with what the addition before lost.
void CollocationMotion::add_stages(double h) {
  const std::size_t s = tableau_.stages, n = mesh_.size();
  const auto add = [](double& to, double& lost, double change) {
    const double all = change + lost, sum = to + all;
    lost = all - (sum - to);
    to = sum;
  };
  std::vector<double> p(n), gained(n, 0);
  for (std::size_t i = 0; i < s; ++i) {
    mesh_.set(stage_q_[i].data(), stage_v_[i].data(), state_.t + tableau_.c[i] * h);
    mesh_.momenta(p.data());
    for (std::size_t k = 0; k < n; ++k) gained[k] += tableau_.d[i] * ((p[k] - state_.p[k]) - state_.p_lost[k]);
  }
  for (std::size_t k = 0; k < n; ++k) {
    double sum = 0;
    for (std::size_t i = 0; i < s; ++i) sum += tableau_.b[i] * stage_v_[i][k];
    add(state_.c[k], state_.c_lost[k], h * sum);
    add(state_.p[k], state_.p_lost[k], gained[k]);
  }
}

/// The size of each field lately: a wave that stands goes through zero as a whole, and what rounding left of its former
/// size is no error of Newton's method then.
void CollocationMotion::note_size() {
  constexpr double forgets = 0.9;  // a step
  const std::vector<double> now = mesh_.squares(state_.c);
  for (std::size_t f = 0; f < recent_size_.size(); ++f)
    recent_size_[f] = std::max({forgets * recent_size_[f], std::sqrt(now[f]), 1e-300});
}

}  // namespace maupertuis
