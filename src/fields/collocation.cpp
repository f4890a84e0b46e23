#include "fields/collocation.hpp"

#include <maupertuis/evaluate.hpp>

#include "linear_algebra/dense.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis {

GaussTableau::GaussTableau(int count) : stages(static_cast<std::size_t>(count)) {
  const GaussRule rule(count);
  const std::size_t s = stages;
  c.resize(s), b.resize(s), a.assign(s * s, 0), continuation.assign(s * s, 0), d.assign(s, 0);
  for (std::size_t i = 0; i < s; ++i) c[i] = (1 + rule.x[i]) / 2, b[i] = rule.w[i] / 2;
  const auto lagrange = [&](std::size_t j, double x) {
    double product = 1;
    for (std::size_t k = 0; k < s; ++k)
      if (k != j) product *= (x - c[k]) / (c[j] - c[k]);
    return product;
  };
  Eigen::MatrixXd matrix(count, count);
  for (std::size_t i = 0; i < s; ++i)
    for (std::size_t j = 0; j < s; ++j) {
      for (std::size_t m = 0; m < s; ++m) a[i * s + j] += c[i] * b[m] * lagrange(j, c[i] * c[m]);  // ∫_0^c_i ℓ_j
      continuation[i * s + j] = lagrange(j, 1 + c[i]);
      matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = a[i * s + j];
    }
  const Eigen::PartialPivLU<Eigen::MatrixXd> lu(Eigen::MatrixXd(matrix.transpose()));
  Eigen::VectorXd weights(count);
  for (std::size_t i = 0; i < s; ++i) weights(static_cast<Eigen::Index>(i)) = b[i];
  const Eigen::VectorXd solved = lu.solve(weights);
  for (std::size_t i = 0; i < s; ++i) d[i] = solved(static_cast<Eigen::Index>(i));
  Eigen::EigenSolver<Eigen::MatrixXd> solver;
  solver.compute(matrix, true);
  BandedMatrix<std::complex<double>> columns(s, s, s);
  const auto vectors = solver.eigenvectors();
  for (std::size_t i = 0; i < s; ++i)
    for (std::size_t k = 0; k < s; ++k)
      columns.at(i, k) = vectors(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k));
  basis.resize(s * s), inverse.resize(s * s), lambda.resize(s);
  for (std::size_t i = 0; i < s; ++i) {
    lambda[i] = solver.eigenvalues()(static_cast<Eigen::Index>(i));
    for (std::size_t k = 0; k < s; ++k) basis[i * s + k] = columns.at(i, k);
  }
  columns.factor();
  for (std::size_t j = 0; j < s; ++j) {
    std::vector<std::complex<double>> unit(s, 0);
    unit[j] = 1;
    columns.solve(unit.data());
    for (std::size_t i = 0; i < s; ++i) inverse[i * s + j] = unit[i];
  }
}

CollocationMotion::CollocationMotion(const FieldEquations& equations, const DensityForm& form, int cells, int degree,
                                     int stages)
    : FieldMotion(equations),
      form_(form),
      mesh_(
          equations, form, cells, degree,
          [&] {
            for (const Parameter& p : equations.model->parameters) values_[p.symbol] = p.si_value;
            return values_;
          }(),
          trouble_),
      tableau_(stages) {
  if (!trouble_.empty()) return;
  const std::size_t n = mesh_.size();
  is_held_.assign(n, false);
  if (!take_conditions()) return;
  field_of_ = mesh_.fields_of_coefficients();
  is_first_order_.assign(n, false);
  all_first_order_ = std::find(form.first_order.begin(), form.first_order.end(), false) == form.first_order.end();
  for (std::size_t i = 0; i < n; ++i) is_first_order_[i] = form.first_order[field_of_[i]];
  for (auto* all : {&stage_v_, &stage_q_, &residual_}) all->assign(tableau_.stages, std::vector<double>(n, 0));
  rates_.assign(n, 0);
}

void CollocationMotion::hold(bool right, std::size_t field, int space, Expr value, bool force) {
  Held held;
  held.field = field, held.space = space, held.right = right, held.force = force;
  held.coefficient = mesh_.end_coefficient(field, right, space);
  held.scale = space == 1 ? 1 / mesh_.slope_scale() : 1;
  held.derivatives = {s_.expanded(value)};
  held.derivatives.push_back(differentiate(held.derivatives.front(), s_.context->time()));
  if (!force) is_held_[held.coefficient] = true;
  held_.push_back(std::move(held));
}

bool CollocationMotion::take_conditions() {
  for (const EndForce& f : s_.end_forces) {
    const std::size_t a = varied(f.jet.field);
    if (f.jet.order() == 1 && !form_.smooth[a]) {
      trouble_ = "moment";
      return false;
    }
    hold(f.side == BoundaryCondition::Side::Right, a, f.jet.order(), f.value, true);
  }
  for (const BoundaryCondition& b : s_.boundary) {
    const std::size_t a = varied(b.jet.field);
    const bool right = b.side == BoundaryCondition::Side::Right;
    if (b.jet.order() == 0 || form_.smooth[a]) {
      hold(right, a, b.jet.order(), b.value, false);
      continue;
    }
    // u_x = a says what ∂ℒ/∂u_x is there: p + F = 0 on the right, −p + F = 0 on the left.
    std::size_t slot = 0;
    while (form_.slots[slot].field != a || form_.slots[slot].space != 1 || form_.slots[slot].rate) ++slot;
    const Expr p = substitute(form_.by_slot[slot],
                              {{s_.jet_symbol(b.jet), b.value},
                               {s_.space.front().symbol, right ? s_.space.front().to : s_.space.front().from}});
    if (!s_.jets_in(p).empty()) {
      trouble_ = "slope";
      return false;
    }
    hold(right, a, 0, right ? -p : p, true);
  }
  return true;
}

void CollocationMotion::start_field(std::size_t field, bool rate, std::vector<double>& to) {
  for (const FieldStart& start : equations_.model->start) {
    if (varied(start.field) != field || (start.order == 1) != rate) continue;
    std::vector<Expr> derivatives{s_.expanded(start.value)};
    for (std::size_t k = 0; k < mesh_.element(field).at_end(); ++k)
      derivatives.push_back(differentiate(derivatives.back(), s_.space.front().symbol));
    mesh_.project(field, derivatives, to.data(), trouble_);
  }
}

void CollocationMotion::start() {
  const std::size_t n = mesh_.size();
  state_ = {std::vector<double>(n, 0), std::vector<double>(n, 0), std::vector<double>(n, 0), std::vector<double>(n, 0),
            0};
  t_ = 0;
  std::vector<double> v(n, 0);
  for (std::size_t f = 0; f < form_.smooth.size(); ++f)
    for (const bool rate : {false, true}) start_field(f, rate, rate ? v : state_.c);
  if (!trouble_.empty()) return;
  for (const Held& held : held_) {
    if (held.force) continue;
    for (const int order : {0, 1}) {
      if (order == 1 && form_.first_order[held.field]) continue;
      std::vector<double>& to = order == 0 ? state_.c : v;
      const double condition =
          value_of(held.derivatives[static_cast<std::size_t>(order)], {{s_.context->time(), t_}}) * held.scale;
      double size = std::abs(condition);
      for (std::size_t i = 0; i < n; ++i)
        if (field_of_[i] == held.field) size = std::max(size, std::abs(to[i]));
      constexpr double rounding = 1e-9;
      if (std::abs(to[held.coefficient] - condition) > rounding * size)
        clashes_.push_back({held.field, held.space, order,
                            held.right ? BoundaryCondition::Side::Right : BoundaryCondition::Side::Left,
                            to[held.coefficient] / held.scale, condition / held.scale});
      to[held.coefficient] = condition;
    }
  }
  mesh_.set(state_.c.data(), v.data(), t_);
  mesh_.momenta(state_.p.data());
  rates_ = v;
  refresh_matrices(state_.c, v, t_);
  find_null_vectors();
}

void CollocationMotion::add_end_forces(double t, double* f) const {
  for (const Held& held : held_)
    if (held.force) f[held.coefficient] += value_of(held.derivatives.front(), {{s_.context->time(), t}}) / held.scale;
}

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
  const std::size_t n = mesh_.size(), band = mesh_.bandwidth();
  for (const std::complex<double>& lambda : tableau_.lambda) {
    out.of.emplace_back();
    if (lambda.imag() < 0) continue;
    const std::complex<double> one = h * lambda, two = one * one;
    BandedMatrix<std::complex<double>> matrix(n, band, band);
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t i = matrix.first_row(j); i < matrix.end_row(j); ++i)
        matrix.at(i, j) = is_held_[i] || is_held_[j]
                              ? std::complex<double>(i == j ? 1 : 0)
                              : matrices_.m.at(i, j) + one * matrices_.g.at(i, j) + two * matrices_.k.at(i, j);
    if (!matrix.factor()) {
      trouble_ = "mass";
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

/// V −= J⁻¹ r. The largest change of h V beside the size of its field.
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
  std::vector<double> size(form_.smooth.size(), 1e-300), largest(form_.smooth.size(), 0);
  for (std::size_t i = 0; i < s; ++i) {
    for (std::size_t x = 0; x < n; ++x) {
      size[field_of_[x]] = std::max(size[field_of_[x]], std::abs(stage_q_[i][x]));
      if (is_held_[x]) continue;
      stage_v_[i][x] -= change[i][x];
      largest[field_of_[x]] = std::max(largest[field_of_[x]], std::abs(h * change[i][x]));
    }
  }
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
    if (round > 1 && change > 0.3 * before && change <= settled) return true;  // rounding
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
  if (trouble_ != "step" || halvings == 0) return false;
  trouble_.clear();
  have_stages_ = false;
  return step_or_halves(h / 2, halvings - 1) && step_or_halves(h / 2, halvings - 1);
}

bool CollocationMotion::one_step(double h) {
  const std::size_t s = tableau_.stages, n = mesh_.size();
  if (slow_ && !form_.linear) refresh_matrices(state_.c, stage_v_.back(), state_.t);
  const auto predict = [&] {
    const std::vector<std::vector<double>> before = stage_v_;
    for (std::size_t i = 0; i < s; ++i) {
      std::fill(stage_v_[i].begin(), stage_v_[i].end(), 0);
      if (have_stages_ && std::abs(h - last_h_) < 1e-6 * std::abs(h)) {
        for (std::size_t j = 0; j < s; ++j)
          for (std::size_t k = 0; k < n; ++k) stage_v_[i][k] += tableau_.continuation[i * s + j] * before[j][k];
      } else if (have_stages_) {
        stage_v_[i] = before.back();
      } else {
        stage_v_[i] = rates_;
      }
      for (const Held& held : held_)
        if (!held.force)
          stage_v_[i][held.coefficient] =
              held.scale * value_of(held.derivatives[1], {{s_.context->time(), state_.t + tableau_.c[i] * h}});
    }
  };
  predict();
  bool solved = newton(h);
  if (!solved && trouble_.empty() && !form_.linear) {  // once more, with matrices of this moment
    refresh_matrices(state_.c, rates_, state_.t);
    have_stages_ = false;
    predict();
    solved = newton(h);
  }
  if (!solved) {
    if (trouble_.empty()) trouble_ = "step";
    return false;
  }
  const auto add = [](double& to, double& lost, double change) {  // with what the addition loses
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
  state_.t += h, t_ = state_.t;
  for (const Held& held : held_)
    if (!held.force)
      state_.c[held.coefficient] = held.scale * value_of(held.derivatives.front(), {{s_.context->time(), t_}});
  if (all_first_order_) {  // p is a function of c: no error gathers between them
    mesh_.set(state_.c.data(), rates_.data(), t_);
    mesh_.momenta(state_.p.data());
    std::fill(state_.p_lost.begin(), state_.p_lost.end(), 0);
  }
  have_stages_ = true, last_h_ = h, rates_known_ = false;
  for (const double value : state_.c)
    if (!std::isfinite(value)) {
      trouble_ = "overflow";
      return false;
    }
  return true;
}

double CollocationMotion::bytes(const DensityForm& form, int cells, int degree, int stages) {
  double local = 0;
  for (std::size_t f = 0; f < form.smooth.size(); ++f) local += degree + 1;
  const double coefficients = cells * local, points = cells * (degree + 2.0);
  const double band = 2 * local, rows = 3 * band + 1;
  constexpr double number = 8, real_matrices = 6, instructions_a_slot = 12;
  const double matrices = coefficients * rows * number * (real_matrices + 2.0 * (stages / 2 + stages % 2));
  return matrices + points * number * instructions_a_slot * static_cast<double>(form.slots.size()) +
         10.0 * stages * number * coefficients;
}

double CollocationMotion::choose_step(double longest, double duration, double goal, const Interrupt& interrupt) {
  const State begin = state_;
  const std::vector<double> rates = rates_;
  const double gain = std::pow(2, 2 * static_cast<double>(tableau_.stages)) - 1;
  double h = longest, before = 0;
  int stays = 0, falls_slowly = 0;
  constexpr int most_halvings = 40;
  for (int k = 0; k < most_halvings; ++k, h /= 2) {
    interrupt.throw_if_asked();
    const auto from_start = [&](int steps) {
      restore(begin);
      rates_ = rates;
      bool good = true;
      for (int i = 0; i < steps && good; ++i) good = one_step(h / steps);
      if (trouble_ != "mass") trouble_.clear();
      return good ? state_.c : std::vector<double>{};
    };
    const std::vector<double> one = from_start(1), two = one.empty() ? one : from_start(2);
    if (!trouble_.empty()) break;
    if (two.empty()) continue;
    double error = 0;
    std::vector<double> difference(one.size());
    for (std::size_t i = 0; i < one.size(); ++i) difference[i] = one[i] - two[i];
    for (std::size_t f = 0; f < form_.smooth.size(); ++f) {
      double size = mesh_.largest_end(two.data(), f), all = 1e-300;
      for (std::size_t g = 0; g < form_.smooth.size(); ++g) all = std::max(all, mesh_.largest_end(two.data(), g));
      error = std::max(error, mesh_.largest_end(difference.data(), f) / std::max(size, 1e-8 * all));
    }
    const double expected = error / gain * (duration / h);
    if (expected <= goal) break;
    // What the mesh adds to the start moves with its highest frequencies, which no step resolves: where the error does
    // not fall any more, shorter steps would follow the mesh, not the field. After a jump it falls slowly for ever.
    constexpr double small = 1e-6;
    stays = before > 0 && error > 0.7 * before ? stays + 1 : 0;
    falls_slowly = before > 0 && error > before / 8 ? falls_slowly + 1 : 0;
    if (stays > (error < small ? 0 : 1) || falls_slowly > 3) break;
    before = error;
  }
  restore(begin);
  rates_ = rates;
  refresh_matrices(begin.c, rates, begin.t);
  return h;
}

/// Where all fields are of first order: the null vectors of ω = G. A constant that ℒ does not see (a potential is given
/// by its derivatives) is fixed at the left end, which the other equations allow; what else ω does not move is a shape
/// that the mesh alone has, and is left out of the motion.
void CollocationMotion::find_null_vectors() {
  null_.clear();
  if (!all_first_order_) return;
  const std::size_t n = mesh_.size(), band = mesh_.bandwidth();
  double size_g = 0, size_k = 0;
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = matrices_.g.first_row(j); i < matrices_.g.end_row(j); ++i)
      size_g = std::max(size_g, std::abs(matrices_.g.at(i, j))),
      size_k = std::max(size_k, std::abs(matrices_.k.at(i, j)));
  constexpr double rounding = 1e-10;
  const auto vanishes = [&](const BandedMatrix<double>& matrix, const std::vector<double>& v, double size) {
    std::vector<double> product(n, 0);
    matrix.add_product(v.data(), product.data());
    for (std::size_t i = 0; i < n; ++i)
      if (!is_held_[i] && !(std::abs(product[i]) <= rounding * size)) return false;
    return true;
  };
  for (std::size_t f = 0; f < form_.smooth.size(); ++f) {
    const std::vector<double> constant = mesh_.constant(f);
    bool free = true;
    for (std::size_t i = 0; i < n; ++i) free = free && !(is_held_[i] && constant[i] != 0);
    if (!free || !vanishes(matrices_.g, constant, size_g) || !vanishes(matrices_.k, constant, size_k)) continue;
    is_held_[mesh_.end_coefficient(f, false, 0)] = true;
    fixed_.push_back(f);
  }
  // (G + ε)⁻¹ makes what ω does not move large: its real part is ε, so that it exists.
  const double epsilon = 1e-9 * size_g;
  BandedMatrix<double> shifted(n, band, band);
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = shifted.first_row(j); i < shifted.end_row(j); ++i)
      shifted.at(i, j) = (is_held_[i] || is_held_[j] ? 0 : matrices_.g.at(i, j)) + (i != j        ? 0
                                                                                    : is_held_[i] ? size_g
                                                                                                  : epsilon);
  if (!shifted.factor()) return;
  std::uint64_t seed = 1;
  constexpr int most = 4, rounds = 4;
  for (int k = 0; k < most; ++k) {
    std::vector<double> v(n);
    for (std::size_t i = 0; i < n; ++i) {
      seed = seed * 6364136223846793005ull + 1442695040888963407ull;
      v[i] = is_held_[i] ? 0 : static_cast<double>(seed >> 33) / 4e9 - 0.5;
    }
    for (int round = 0; round < rounds; ++round) {
      shifted.solve(v.data());
      for (const std::vector<double>& other : null_) {
        double part = 0;
        for (std::size_t i = 0; i < n; ++i) part += other[i] * v[i];
        for (std::size_t i = 0; i < n; ++i) v[i] -= part * other[i];
      }
      double square = 0;
      for (const double x : v) square += x * x;
      for (double& x : v) x /= std::sqrt(square);
    }
    constexpr double small = 1e-11;  // rounding
    std::vector<double> product(n, 0);
    matrices_.g.add_product(v.data(), product.data());
    for (std::size_t i = 0; i < n; ++i)
      if (!is_held_[i] && std::abs(product[i]) > small * size_g) return;
    if (!mesh_.is_rough(v)) {
      trouble_ = "ends";
      return;
    }
    null_.push_back(std::move(v));
  }
}

const CollocationMotion::RateMatrix& CollocationMotion::rate_matrix() const {
  if (rate_matrix_ && form_.steady && rate_matrix_->null_vectors == null_.size()) return *rate_matrix_;
  const std::size_t n = mesh_.size(), band = mesh_.bandwidth();
  BandedMatrix<double> matrix(n, band, band);
  mesh_.set(state_.c.data(), rates_.data(), t_);
  GalerkinMesh::Matrices now = mesh_.matrices();
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = matrix.first_row(j); i < matrix.end_row(j); ++i)
      matrix.at(i, j) = is_held_[i] || is_held_[j] ? (i == j ? 1.0 : 0.0)
                        : !is_first_order_[i]      ? now.m.at(i, j)
                                                   : now.g.at(i, j);
  for (std::size_t j = 0; j < n; ++j)  // velocities of fields with mass do not depend on the others
    for (std::size_t i = matrix.first_row(j); i < matrix.end_row(j); ++i)
      if (!is_first_order_[i] && is_first_order_[j]) matrix.at(i, j) = 0;
  // ω has no inverse on null vectors: a small part of the identity, and they are left out of what it gives.
  double largest = 0;
  for (std::size_t j = 0; !null_.empty() && j < n; ++j)
    for (std::size_t i = matrix.first_row(j); i < matrix.end_row(j); ++i)
      largest = std::max(largest, std::abs(matrix.at(i, j)));
  for (std::size_t j = 0; !null_.empty() && j < n; ++j) matrix.at(j, j) += 1e-9 * largest;
  const bool regular = matrix.factor();
  rate_matrix_.emplace(RateMatrix{std::move(matrix), std::move(now.a), regular, null_.size()});
  return *rate_matrix_;
}

void CollocationMotion::find_rates() const {
  if (rates_known_) return;
  rates_known_ = true;
  const RateMatrix& matrix = rate_matrix();
  const std::size_t n = mesh_.size();
  if (!matrix.regular) {
    std::fill(rates_.begin(), rates_.end(), std::nan(""));
    return;
  }
  for (const Held& held : held_)
    if (!held.force) rates_[held.coefficient] = held.scale * value_of(held.derivatives[1], {{s_.context->time(), t_}});
  std::vector<double> p(n), f(n), r(n);
  for (int round = 0; round < 12; ++round) {
    mesh_.set(state_.c.data(), rates_.data(), t_);
    mesh_.momenta(p.data());
    mesh_.forces(f.data());
    add_end_forces(t_, f.data());
    std::vector<double> change_of_p(n, 0);  // of momenta that are functions of c
    matrix.a.add_product(rates_.data(), change_of_p.data());
    for (std::size_t i = 0; i < n; ++i)
      r[i] = is_held_[i] ? 0 : is_first_order_[i] ? change_of_p[i] - f[i] : (p[i] - state_.p[i]) - state_.p_lost[i];
    matrix.factored.solve(r.data());
    for (const std::vector<double>& v : null_) {
      double part = 0;
      for (std::size_t i = 0; i < n; ++i) part += v[i] * r[i];
      for (std::size_t i = 0; i < n; ++i) r[i] -= part * v[i];
    }
    double change = 0, size = 1e-300;
    for (std::size_t i = 0; i < n; ++i) {
      rates_[i] -= r[i];
      change = std::max(change, std::abs(r[i])), size = std::max(size, std::abs(rates_[i]));
    }
    if (change <= 1e-15 * size) break;
  }
}

double CollocationMotion::energy(double& size) {
  find_rates();
  mesh_.set(state_.c.data(), rates_.data(), t_, true);
  return mesh_.energy(size);
}

double CollocationMotion::field_at(std::size_t field, const FieldJet& jet, const std::vector<double>& place) const {
  if (jet.time > 1 || jet.space[0] > (form_.smooth[field] ? 3 : 1)) return std::nan("");
  if (jet.time == 1) find_rates();
  return mesh_.value(jet.time == 0 ? state_.c.data() : rates_.data(), field, jet.space[0], place[0]);
}

void CollocationMotion::visit_points(const PointVisitor& visit) {
  find_rates();
  mesh_.set(state_.c.data(), rates_.data(), t_, true);
  const std::size_t slots = form_.slots.size();
  std::vector<double> values(slots + 2);
  values[slots + 1] = t_;
  for (std::size_t n = 0; n < mesh_.lanes(); ++n) {
    for (std::size_t slot = 0; slot < slots; ++slot) values[slot] = mesh_.jet(slot, n);
    values[slots] = mesh_.place(n);
    visit(mesh_.weight(n), values.data());
  }
}

}  // namespace maupertuis
