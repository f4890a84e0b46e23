#include "fields/collocation.hpp"

#include <maupertuis/evaluate.hpp>

#include "linear_algebra/banded.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis {

CollocationMotion::CollocationMotion(const FieldEquations& equations, const DensityForm& form,
                                     const std::vector<int>& cells, int degree, int stages)
    : FieldMotion(equations),
      form_(form),
      mesh_(
          equations, form, cells, degree,
          [&] {
            for (const Parameter& p : equations.model->parameters) values_[p.symbol] = p.si_value;
            return values_;
          }(),
          trouble_),
      tableau_(stages, form.damps ? CollocationTableau::Points::Radau : CollocationTableau::Points::Gauss) {
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

void CollocationMotion::hold(BoundaryCondition::Side side, std::size_t field, int space, Expr value, bool force) {
  Held held;
  held.field = field, held.space = space, held.side = side, held.force = force;
  held.coefficients = mesh_.side_coefficients(field, side, space == 1);
  held.scale = space == 1 ? mesh_.axis(GalerkinMesh::across(side)).width() / 2 : 1;
  const Expr itself = s_.expanded(value);
  for (const Expr& by_time : {itself, differentiate(itself, s_.context->time())})
    held.derivatives.push_back(mesh_.derivatives_along(field, side, by_time));
  if (!force)
    for (const std::size_t i : held.coefficients) is_held_[i] = true;
  held_.push_back(std::move(held));
}

void CollocationMotion::impose(const Held& held, int by_time, double t, std::vector<double>& to) const {
  const std::vector<Expr>& value = held.derivatives[static_cast<std::size_t>(by_time)];
  if (value.front().is_zero()) {
    for (const std::size_t i : held.coefficients) to[i] = 0;
    return;
  }
  const std::vector<double> values = mesh_.side_values(held.field, held.side, value, t);
  for (std::size_t i = 0; i < values.size(); ++i) to[held.coefficients[i]] = held.scale * values[i];
}

bool CollocationMotion::take_conditions() {
  for (const EndForce& f : s_.end_forces) {
    const std::size_t a = varied(f.jet.field);
    if (f.jet.order() == 1 && !form_.smooth[a]) {
      trouble_ = "moment";
      return false;
    }
    hold(f.side, a, f.jet.order(), f.value, true);
  }
  for (const BoundaryCondition& b : s_.boundary) {
    const std::size_t a = varied(b.jet.field), across = GalerkinMesh::across(b.side);
    if (b.jet.order() == 0 || form_.smooth[a]) {
      hold(b.side, a, b.jet.order(), b.value, false);
      continue;
    }
    // u_x = a says what ∂ℒ/∂u_x is there: p + F = 0 on the far side, −p + F = 0 on the near one.
    const bool far = GalerkinMesh::is_far(b.side);
    const SpaceVariable& x = s_.space[across];
    Expr p;
    for (std::size_t slot = 0; slot < form_.slots.size(); ++slot)
      if (form_.slots[slot].jet == s_.jet_symbol(b.jet))
        p = substitute(form_.by_slot[slot], {{s_.jet_symbol(b.jet), b.value}, {x.symbol, far ? x.to : x.from}});
    if (!s_.jets_in(p).empty()) {
      trouble_ = "slope";
      return false;
    }
    hold(b.side, a, 0, far ? -p : p, true);
  }
  return true;
}

void CollocationMotion::start_field(std::size_t field, bool rate, std::vector<double>& to) {
  for (const FieldStart& start : equations_.model->start) {
    if (varied(start.field) != field || (start.order == 1) != rate) continue;
    mesh_.project(field, s_.expanded(start.value), to.data(), trouble_);
  }
}

/// Where a start says something else at a side than its condition: at the coefficient that is farthest off.
void CollocationMotion::note_clash(const Held& held, int by_time, const std::vector<double>& start,
                                   const std::vector<double>& condition) {
  constexpr double rounding = 1e-9;
  double size = 0, worst = 0;
  std::size_t where = 0;
  for (std::size_t i = 0; i < start.size(); ++i)
    if (field_of_[i] == held.field) size = std::max({size, std::abs(start[i]), std::abs(condition[i])});
  for (const std::size_t i : held.coefficients)
    if (const double off = std::abs(start[i] - condition[i]); off > worst) worst = off, where = i;
  if (worst > rounding * size)
    clashes_.push_back(
        {held.field, held.space, by_time, held.side, start[where] / held.scale, condition[where] / held.scale});
}

void CollocationMotion::start() {
  const std::size_t n = mesh_.size();
  state_ = {std::vector<double>(n, 0), std::vector<double>(n, 0), std::vector<double>(n, 0), std::vector<double>(n, 0),
            t_};
  std::vector<double> v(n, 0);
  for (std::size_t f = 0; f < form_.smooth.size(); ++f)
    for (const bool rate : {false, true}) start_field(f, rate, rate ? v : state_.c);
  if (!trouble_.empty()) return;
  for (const Held& held : held_) {
    if (held.force) continue;
    for (const int order : {0, 1}) {
      if (order == 1 && form_.first_order[held.field]) continue;
      std::vector<double>& to = order == 0 ? state_.c : v;
      const std::vector<double> before = to;
      impose(held, order, t_, to);
      note_clash(held, order, before, to);
    }
  }
  mesh_.set(state_.c.data(), v.data(), t_);
  mesh_.momenta(state_.p.data());
  rates_ = v;
  recent_size_.assign(form_.smooth.size(), 0);
  note_size();
  refresh_matrices(state_.c, v, t_);
  find_null_vectors();
}

void CollocationMotion::add_end_forces(double t, double* f) const {
  for (const Held& held : held_) {
    if (!held.force) continue;
    const std::vector<double> loads = mesh_.side_loads(held.field, held.side, held.derivatives[0][0], t);
    for (std::size_t i = 0; i < loads.size(); ++i) f[held.coefficients[i]] += loads[i] / held.scale;
  }
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

double CollocationMotion::bytes(const DensityForm& form, const std::vector<int>& cells, int degree, int stages) {
  const double along = degree + 1, fields = static_cast<double>(form.smooth.size());
  double coefficients = fields, points = 1, of_cell = fields;
  for (const int n : cells) coefficients *= n * along, points *= n * (degree + 2.0), of_cell *= along;
  constexpr double number = 8, real_matrices = 6, instructions_a_slot = 12, band_beside_entries = 6;
  const double entries = coefficients * of_cell;
  // Along a line factors stay within the band. In the plane 676 unknowns had 2.8 times the entries, 2500 had 4.4 times.
  const double filled =
      cells.size() == 1 ? band_beside_entries : 1 + 0.9 * std::max(1.0, std::log2(coefficients / 100));
  const double matrices = entries * number * (real_matrices + filled * (1 + 2.0 * (stages / 2 + stages % 2)));
  return matrices + points * number * instructions_a_slot * static_cast<double>(form.slots.size()) +
         10.0 * stages * number * coefficients;
}

double CollocationMotion::choose_step(double longest, double duration, double goal, const Interrupt& interrupt) {
  const State begin = state_;
  const std::vector<double> rates = rates_;
  const double gain = std::pow(2, tableau_.order) - 1;
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
      if (trouble_ != "mass" && trouble_ != "shapes") trouble_.clear();
      return good ? state_.c : std::vector<double>{};
    };
    const std::vector<double> one = from_start(1), two = one.empty() ? one : from_start(2);
    if (!trouble_.empty()) break;
    if (two.empty()) continue;
    double error = 0;
    std::vector<double> difference(one.size());
    for (std::size_t i = 0; i < one.size(); ++i) difference[i] = one[i] - two[i];
    const std::vector<double> sizes = mesh_.squares(two), errors = mesh_.squares(difference);
    const double all = *std::max_element(sizes.begin(), sizes.end());
    for (std::size_t f = 0; f < sizes.size(); ++f)
      error = std::max(error, std::sqrt(errors[f] / std::max({sizes[f], 1e-16 * all, 1e-300})));
    const double expected = error / gain * (duration / h);
    // From so many steps on less is asked for, by the power of the steps: a start that does not fit the conditions at
    // the ends moves frequencies of the mesh, and to follow them is worth nothing.
    constexpr double many = 2000;
    const double asked = goal * std::pow(std::max(1.0, duration / h / many), tableau_.order);
    if (expected <= asked || (null_.empty() && error <= 16 * rounding_)) break;
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

double CollocationMotion::energy(double& size) {
  find_rates();
  mesh_.set(state_.c.data(), rates_.data(), t_, true);
  return mesh_.energy(size);
}

double CollocationMotion::field_at(std::size_t field, const FieldJet& jet, const std::vector<double>& place) const {
  if (jet.time > 1 || jet.order() - jet.time > (form_.smooth[field] ? 3 : 1)) return std::nan("");
  if (jet.time == 1) find_rates();
  return mesh_.value(jet.time == 0 ? state_.c.data() : rates_.data(), field, jet, place);
}

void CollocationMotion::visit_points(const PointVisitor& visit) {
  find_rates();
  mesh_.set(state_.c.data(), rates_.data(), t_, true);
  const std::size_t slots = form_.slots.size();
  std::vector<double> values(form_.inputs.size());
  values.back() = t_;
  for (std::size_t n = 0; n < mesh_.lanes(); ++n) {
    for (std::size_t slot = 0; slot < slots; ++slot) values[slot] = mesh_.jet(slot, n);
    for (std::size_t d = 0; slots + d + 1 < values.size(); ++d) values[slots + d] = mesh_.place(d, n);
    visit(mesh_.weight(n), values.data());
  }
}

void CollocationMotion::visit_sides(const std::vector<Expr>& jets, const SideVisitor& visit) {
  if (s_.space.size() == 1) return FieldMotion::visit_sides(jets, visit);
  std::vector<double> values(jets.size() + 3);
  values.back() = t_;
  for (std::size_t across = 0; across < 2; ++across)
    for (const bool far : {false, true}) {
      const MeshAxis &axis = mesh_.axis(across), &side = mesh_.axis(1 - across);
      for (std::size_t cell = 0; cell < side.cells(); ++cell)
        for (std::size_t q = 0; q < side.points(); ++q) {
          std::vector<double> place(2);
          place[across] = axis.place(far ? axis.cells() - 1 : 0, far ? 1 : -1);
          place[1 - across] = side.point(cell, q);
          for (std::size_t i = 0; i < jets.size(); ++i) {
            const FieldJet jet = *s_.jet_of(jets[i]);
            const std::size_t a = varied(jet.field);
            // At a free side higher derivatives of plates are far off what the condition there says.
            const bool known = a < equations_.varied.size() && jet.order() - jet.time < 2;
            values[i] = known ? field_at(a, jet, place) : std::nan("");
          }
          std::copy(place.begin(), place.end(), values.end() - 3);
          visit({across, far, side.weight(q)}, values.data());
        }
    }
}

}  // namespace maupertuis
