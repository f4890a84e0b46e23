#include "fields/field_mesh.hpp"

#include <maupertuis/evaluate.hpp>
#include <maupertuis/repeated_evaluation.hpp>

#include "fields/end_slopes.hpp"
#include "fields/switching.hpp"
#include "fields/wide_lanes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

using Side = BoundaryCondition::Side;

void unsupported(Diagnostics& diagnostics, Span span, const std::string& what) {
  diagnostics.error("E0508", span, fmt::format("not supported yet: a run of {}", what),
                    "Runs are those of fields of one or two space variables on a bounded domain.",
                    "`maup derive`, `maup invariants` and expectations about formulas work for all fields.");
}

/// φ or φ' where `along` is beyond the space variables, else its derivative along one.
Expr jet_at(const FieldSystem& s, std::size_t field, std::size_t along, int t) {
  FieldJet jet{field, std::vector<int>(s.space.size(), 0), t};
  if (along < s.space.size()) jet.space[along] = 1;
  return s.jet_symbol(jet);
}

}  // namespace

std::optional<PointForm> point_form(const FieldEquations& equations, Diagnostics& diagnostics) {
  const FieldSystem& s = equations.system();
  const std::size_t d = s.space.size(), itself = d;
  if (d > 2) return unsupported(diagnostics, s.density_span, "fields of three space variables"), std::nullopt;
  for (const SpaceVariable& x : s.space)
    if (!x.from) return unsupported(diagnostics, s.density_span, "a field without a domain"), std::nullopt;
  ExprMap given;
  for (std::size_t f = 0; f < s.fields.size(); ++f) {
    if (!s.fields[f].given) continue;
    if (!s.fields[f].formula)
      return unsupported(diagnostics, s.fields[f].span, "an input without a formula"), std::nullopt;
    given[jet_at(s, f, itself, 0)] = s.fields[f].formula;
  }
  const auto plain = [&](Expr e) { return s.expanded(substitute(s.expanded(e), given)); };
  const Expr density = plain(s.density), dissipation = s.dissipation ? plain(s.dissipation) : s.context->number(0);
  std::vector<Expr> both{density, dissipation};
  for (const Expr& f : s.forces)
    if (f) both.push_back(plain(f));
  for (const Expr& e : both)
    for (const Expr& symbol : s.jets_in(e)) {
      const FieldJet jet = *s.jet_of(symbol);
      if (jet.order() - jet.time > 1 || jet.order() > 2 || (e == density && jet.order() > 1))
        return unsupported(diagnostics, s.density_span, "a density with second derivatives"), std::nullopt;
    }
  PointForm out;
  out.fields = equations.varied.size(), out.directions = d;
  const Expr t = s.context->time();
  for (const std::size_t f : equations.varied) {
    for (const int by_time : {0, 1}) out.inputs.push_back(jet_at(s, f, itself, by_time));
    for (std::size_t x = 0; x < 2 * d; ++x) out.inputs.push_back(jet_at(s, f, x % d, x < d ? 0 : 1));
  }
  for (const SpaceVariable& x : s.space) out.inputs.push_back(x.symbol);
  out.inputs.push_back(t);
  std::vector<Expr> energy{-density};
  for (const std::size_t f : equations.varied) {
    const Expr v = jet_at(s, f, itself, 1), p = differentiate(density, v);
    std::vector<Expr> g{differentiate(p, t), -differentiate(density, jet_at(s, f, itself, 0)),
                        differentiate(dissipation, v)};
    for (const std::size_t other : equations.varied) {
      out.a.push_back(differentiate(p, jet_at(s, other, itself, 1)));
      g.push_back(differentiate(p, jet_at(s, other, itself, 0)) * jet_at(s, other, itself, 1));
      for (std::size_t x = 0; x < d; ++x)
        g.push_back(differentiate(p, jet_at(s, other, x, 0)) * jet_at(s, other, x, 1));
    }
    if (s.forces[f]) g.push_back(-plain(s.forces[f]));
    out.g.push_back(s.context->sum(g));
    energy.push_back(v * p);
  }
  for (std::size_t x = 0; x < d; ++x)
    for (const std::size_t f : equations.varied)
      out.s.push_back(differentiate(density, jet_at(s, f, x, 0)) - differentiate(dissipation, jet_at(s, f, x, 1)));
  out.energy = s.context->sum(energy);
  bool forced = !dissipation.is_zero() || !differentiate(density, t).is_zero() || !s.end_forces.empty();
  for (const Expr& f : s.forces) forced = forced || static_cast<bool>(f);
  // A given slope is a force at the end, which does work.
  for (const BoundaryCondition& b : s.boundary)
    forced = forced || s.context->depends_on_time(b.value.id()) || (b.jet.order() > 0 && !b.value.is_zero());
  out.conserves = !forced;
  for (const Expr& a : out.a)
    for (const Expr& symbol : symbols_of({&a, 1}))
      out.constant_mass = out.constant_mass && !s.jet_of(symbol) && symbol.role() != Role::Time;
  return out;
}

namespace {

std::vector<Expr> roots_of_line(const PointForm& form) {
  std::vector<Expr> out;
  for (const auto* part : {&form.a, &form.g, &form.s}) out.insert(out.end(), part->begin(), part->end());
  return out;
}

/// x, t, and φ and φ' of each field: inputs whose past is read.
std::vector<std::size_t> inputs_that_last(std::size_t fields) {
  std::vector<std::size_t> out{4 * fields, 4 * fields + 1};
  for (std::size_t f = 0; f < fields; ++f) out.push_back(4 * f), out.push_back(4 * f + 1);
  return out;
}

}  // namespace

double FieldMesh::bytes(const FieldEquations& equations, const PointForm& form, double cells, int order) {
  std::unordered_map<Expr, double, ExprHash> constants;
  for (const Parameter& p : equations.model->parameters) constants[p.symbol] = p.si_value;
  std::string trouble;
  auto series = LaneSeries::make(roots_of_line(form), form.inputs, constants, trouble);
  if (!series) return 0;
  series->keep(inputs_that_last(form.fields), form.a.size());
  return series->bytes(cells * (order + 1), kOrder + 2);
}

FieldMesh::FieldMesh(const FieldEquations& equations, const PointForm& form, int cells, int order)
    : WaveMesh(equations),
      form_(form),
      cells_(cells),
      p_(order),
      lanes_(static_cast<std::size_t>(cells) * (static_cast<std::size_t>(order) + 1)),
      fields_(form.fields),
      rule_(order) {
  std::unordered_map<Expr, double, ExprHash> constants;
  for (const Parameter& p : equations.model->parameters) constants[p.symbol] = values_[p.symbol] = p.si_value;
  left_ = value_of(s_.space.front().from, {});
  width_ = (value_of(s_.space.front().to, {}) - left_) / cells;
  const std::vector<Expr> roots = roots_of_line(form);
  const std::vector<Expr> sizes{form.energy};
  auto series = LaneSeries::make(roots, form.inputs, constants, trouble_);
  auto energies = LaneSeries::make(sizes, form.inputs, constants, trouble_);
  if (!series || !energies) return;
  series_ = std::move(*series);
  energies_ = std::move(*energies);
  energies_.resize(lanes_, 1);
  for (std::size_t f = 0; f < fields_; ++f)
    for (const Expr& root : roots) {
      const Expr one[] = {root};
      const std::vector<Expr> below = symbols_of(one);
      needs_rate_ = needs_rate_ || std::find(below.begin(), below.end(), form.inputs[4 * f + 3]) != below.end();
    }
  series_.keep(inputs_that_last(fields_), form.a.size());
  series_.resize(lanes_, kOrder + 2);
  constant_mass_ = form.constant_mass;
  double* x = series_.input(4 * fields_, 0);
  for (int j = 0; j <= p_; ++j)
    for (int e = 0; e < cells_; ++e)
      x[local(j, e)] = left_ + width_ * (e + 0.5 * (1 + rule_.x[static_cast<std::size_t>(j)]));
  const auto hold = [&](Side side, std::size_t field, Expr value, bool force) {
    Held held{side == Side::Right, 0, s_.expanded(value), {}, force};
    while (equations_.varied[held.field] != field) ++held.field;
    held.derivatives = time_derivatives(held.value);
    held_.push_back(std::move(held));
  };
  for (const EndForce& f : s_.end_forces) hold(f.side, f.jet.field, f.value, true);
  for (const BoundaryCondition& b : s_.boundary) {
    if (b.jet.order() == 0) {
      hold(b.side, b.jet.field, b.value, false);
      continue;
    }
    // u_x = a says what ∂ℒ/∂u_x is there: p + F = 0 on the right, −p + F = 0 on the left.
    std::size_t a = 0;
    while (equations_.varied[a] != b.jet.field) ++a;
    const Expr p = substitute(
        form_.s[a], {{s_.jet_symbol(b.jet), b.value},
                     {s_.space.front().symbol, b.side == Side::Right ? s_.space.front().to : s_.space.front().from}});
    if (!s_.jets_in(p).empty()) {
      trouble_ = "slope";
      return;
    }
    hold(b.side, b.jet.field, b.side == Side::Right ? -p : p, true);
  }
  force_.assign(fields_, std::vector<double>(lanes_));
  mass_.assign(fields_ * fields_ * lanes_, 0);
  past_.assign(fields_ * (kOrder + 2), std::vector<double>(lanes_));
}

void FieldMesh::start() {
  u_.assign(fields_, std::vector<double>(lanes_, 0));
  v_ = u_;
  const double* x = series_.input(4 * fields_, 0);
  for (const FieldStart& start : equations_.model->start) {
    std::size_t a = 0;
    while (equations_.varied[a] != start.field) ++a;
    const Expr value[] = {s_.expanded(start.value)};
    const RepeatedEvaluation at(value);
    for (std::size_t n = 0; n < lanes_; ++n)
      (start.order == 0 ? u_ : v_)[a][n] =
          at([&](Expr symbol) { return symbol == s_.space.front().symbol ? x[n] : values_.at(symbol); }).front();
    for (const double value : (start.order == 0 ? u_ : v_)[a])
      if (!std::isfinite(value)) trouble_ = "start";
  }
  for (const Held& held : held_) {
    if (held.force) continue;
    const std::size_t n = node_of(held);
    for (int order = 0; order < 2; ++order) {
      std::vector<double>& values = (order == 0 ? u_ : v_)[held.field];
      const double condition = boundary_coefficient(held.derivatives, static_cast<std::size_t>(order));
      double size = std::abs(condition);
      for (const double value : values) size = std::max(size, std::abs(value));
      constexpr double rounding = 1e-9;
      if (std::abs(values[n] - condition) > rounding * size)
        clashes_.push_back({held.field, 0, order, held.right ? Side::Right : Side::Left, values[n], condition});
      values[n] = condition;
    }
  }
}

void FieldMesh::follow_branches(double from, double until) {
  t_ = from;
  for (Held& held : held_) {
    held.derivatives = time_derivatives(branches_between(held.value, s_, values_, from, until));
    if (held.force || u_.empty()) continue;
    u_[held.field][node_of(held)] = boundary_coefficient(held.derivatives, 0);
    v_[held.field][node_of(held)] = boundary_coefficient(held.derivatives, 1);
  }
}

double FieldMesh::boundary_coefficient(const std::vector<Expr>& derivatives, std::size_t k) const {
  double factorial = 1;
  for (std::size_t i = 2; i <= k; ++i) factorial *= static_cast<double>(i);
  if (derivatives[k].is_zero()) return 0;
  return value_of(derivatives[k], {{s_.context->time(), t_}}) / factorial;
}

namespace {

/// to = Σ_m c_m (u_m − base), the u_m `stride` apart.
MAUP_LANES void differences(double* __restrict to, const double* u, const double* base, const double* c,
                            std::size_t points, std::size_t stride, std::size_t n) {
  std::size_t i = 0;
  for (; i + kWide <= n; i += kWide) {
    Lanes sum = {};
    for (std::size_t m = 0; m < points; ++m) sum += c[m] * (lanes_at(u + m * stride + i) - lanes_at(base + i));
    lanes_at(to + i) = sum;
  }
  for (; i < n; ++i) {
    to[i] = 0;
    for (std::size_t m = 0; m < points; ++m) to[i] += c[m] * (u[m * stride + i] - base[i]);
  }
}
/// to = weight g + Σ_q c_q s_q
MAUP_LANES void weighted(double* __restrict to, const double* g, double weight, const double* s, const double* c,
                         std::size_t points, std::size_t stride, std::size_t n) {
  std::size_t i = 0;
  for (; i + kWide <= n; i += kWide) {
    Lanes sum = weight * lanes_at(g + i);
    for (std::size_t q = 0; q < points; ++q) sum += c[q] * lanes_at(s + q * stride + i);
    lanes_at(to + i) = sum;
  }
  for (; i < n; ++i) {
    to[i] = weight * g[i];
    for (std::size_t q = 0; q < points; ++q) to[i] += c[q] * s[q * stride + i];
  }
}
MAUP_LANES void set_product(double* __restrict to, const double* __restrict a, double factor, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) to[i] = factor * a[i];
}
MAUP_LANES void set_products(double* __restrict to, const double* __restrict a, const double* __restrict b,
                             std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) to[i] = a[i] * b[i];
}
MAUP_LANES void add_products(double* __restrict to, const double* __restrict a, const double* __restrict b,
                             std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) to[i] += a[i] * b[i];
}
MAUP_LANES void horner(double* __restrict to, const double* __restrict a, double h, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) to[i] = to[i] * h + a[i];
}

}  // namespace

/// Stiffness acts on differences u_m − u_j, which keeps digits.
void FieldMesh::differentiate_along_x(const double* from, double* to) const {
  const auto n = static_cast<std::size_t>(cells_), points = static_cast<std::size_t>(p_) + 1;
  const double scale = 2 / width_;
  std::vector<double> c(points);
  for (std::size_t j = 0; j < points; ++j) {
    for (std::size_t m = 0; m < points; ++m) c[m] = m == j ? 0 : scale * rule_.derivative[j * points + m];
    differences(to + j * n, from, from + j * n, c.data(), points, n, n);
  }
}

void FieldMesh::forces(std::size_t f, std::size_t k) {
  const auto n = static_cast<std::size_t>(cells_), points = static_cast<std::size_t>(p_) + 1;
  const double* g = series_.root(fields_ * fields_ + f, k);
  const double* s = series_.root(fields_ * fields_ + fields_ + f, k);
  std::vector<double>& out = force_[f];
  std::vector<double> c(points);
  for (std::size_t j = 0; j < points; ++j) {
    for (std::size_t q = 0; q < points; ++q) c[q] = rule_.w[q] * rule_.derivative[q * points + j];
    weighted(out.data() + j * n, g + j * n, -rule_.w[j] * width_ / 2, s, c.data(), points, n, n);
  }
  for (const Held& held : held_)
    if (held.force && held.field == f) out[node_of(held)] += boundary_coefficient(held.derivatives, k);
  share(out);
}

/// Neighbours have one node in common: the sum of both stands in both.
void FieldMesh::share(std::vector<double>& lanes) const {
  double* first = lanes.data();
  double* last = lanes.data() + local(p_, 0);
  for (int e = 0; e + 1 < cells_; ++e) first[e + 1] = last[e] = last[e] + first[e + 1];
  if (s_.periodic(0)) first[0] = last[cells_ - 1] = last[cells_ - 1] + first[0];
}

/// Which fields are held at a node.
std::vector<bool> FieldMesh::held_at(std::size_t lane) const {
  std::vector<bool> out(fields_, false);
  for (const Held& held : held_)
    if (!held.force && node_of(held) == lane) out[held.field] = true;
  return out;
}

/// M⁻¹ at each node, of the fields that are free there.
void FieldMesh::masses() {
  if (constant_mass_ && mass_known_) return;
  std::vector<std::vector<double>> m(fields_ * fields_, std::vector<double>(lanes_));
  for (std::size_t i = 0; i < m.size(); ++i) {
    const double* a = series_.root(i, 0);
    for (std::size_t n = 0; n < lanes_; ++n)
      m[i][n] = a[n] * rule_.w[n / static_cast<std::size_t>(cells_)] * width_ / 2;
    share(m[i]);
  }
  std::vector<double> a(fields_ * fields_), inverse;
  for (std::size_t n = 0; n < lanes_; ++n) {
    for (std::size_t i = 0; i < a.size(); ++i) a[i] = m[i][n];
    if (!invert_mass(a, inverse, held_at(n))) {
      trouble_ = "mass";
      return;
    }
    for (std::size_t i = 0; i < inverse.size(); ++i) mass_[i * lanes_ + n] = inverse[i];
  }
  mass_known_ = true;
}

/// φ''_k = M₀⁻¹ (F_k − Σ_i M_i φ''_{k−i}), where fields are held φ''_k itself in the place of their force.
void FieldMesh::solve(std::size_t k) {
  if (!constant_mass_) {
    std::vector<double> part(lanes_);
    for (std::size_t f = 0; f < fields_; ++f)
      for (std::size_t i = 1; i <= k; ++i)
        for (std::size_t o = 0; o < fields_; ++o) {
          const double* a = series_.root(f * fields_ + o, i);
          for (std::size_t n = 0; n < lanes_; ++n)
            part[n] = a[n] * rule_.w[n / static_cast<std::size_t>(cells_)] * width_ / 2;
          share(part);
          const std::vector<double>& before = past_[o * (kOrder + 2) + k - i];
          for (std::size_t n = 0; n < lanes_; ++n) force_[f][n] -= part[n] * before[n];
        }
  }
  hold_ends(k);
  for (std::size_t f = 0; f < fields_; ++f) {
    std::vector<double>& out = past_[f * (kOrder + 2) + k];
    for (std::size_t o = 0; o < fields_; ++o) {
      const double* inverse = mass_.data() + (f * fields_ + o) * lanes_;
      o == 0 ? set_products(out.data(), inverse, force_[o].data(), lanes_)
             : add_products(out.data(), inverse, force_[o].data(), lanes_);
    }
  }
}

void FieldMesh::hold_ends(std::size_t k) {
  for (const Held& held : held_)
    if (!held.force)
      force_[held.field][node_of(held)] =
          boundary_coefficient(held.derivatives, k + 2) * static_cast<double>((k + 1) * (k + 2));
}

void FieldMesh::coefficient(std::size_t k) {
  for (std::size_t f = 0; f < fields_; ++f) {
    differentiate_along_x(phi(f, k), slope(f, k));
    if (needs_rate_) differentiate_along_x(velocity(f, k), rate(f, k));
  }
  if (k < 2) std::fill_n(series_.input(4 * fields_ + 1, k), lanes_, k == 0 ? t_ : 1.0);  // t; the rest of it is 0
  series_.advance(k);
  if (k == 0) masses();
  for (std::size_t f = 0; f < fields_; ++f) forces(f, k);
  solve(k);
  for (std::size_t f = 0; f < fields_; ++f) {
    const double* a = past_[f * (kOrder + 2) + k].data();
    const auto next = static_cast<double>(k + 1);
    double* v = velocity(f, k + 1);
    set_product(v, a, 1 / next, lanes_);
    if (k + 2 > kOrder + 1) continue;
    double* u = phi(f, k + 2);
    set_product(u, a, 1 / (next * (next + 1)), lanes_);
  }
}

void FieldMesh::load(const std::vector<std::vector<double>>& u, const std::vector<std::vector<double>>& v) {
  for (std::size_t f = 0; f < fields_; ++f) {
    std::copy(u[f].begin(), u[f].end(), phi(f, 0));
    std::copy(v[f].begin(), v[f].end(), velocity(f, 0));
    std::copy(v[f].begin(), v[f].end(), phi(f, 1));
  }
}

/// How far the series at this moment reaches, at most h: to where its last term is kLastTerm of the field. It
/// grows where an amplitude, friction, a velocity in the stiffness or a coefficient in t makes waves faster than ω_max
/// told at the start.
double FieldMesh::reach(double h) {
  constexpr double at_rest = 1e-30;
  double ratio = 0;
  for (std::size_t f = 0; f < fields_; ++f) {
    const auto largest = [&](std::size_t k) {
      double out = 0;
      for (const double* c = phi(f, k); c != phi(f, k) + lanes_; ++c) out = std::max(out, std::abs(*c));
      return out;
    };
    const double size = std::max({largest(0), largest(1) * h, at_rest});
    ratio = std::max(ratio, largest(kOrder) * std::pow(h, static_cast<double>(kOrder)) / size);
  }
  const double allowed = kLastTerm * std::pow(longer_, static_cast<double>(kOrder));
  return ratio > allowed ? h * std::pow(allowed / ratio, 1.0 / static_cast<double>(kOrder)) : h;
}

bool FieldMesh::step(double h) {
  constexpr double shortest = 1e-7;  // of h: beyond, the motion leaves all bounds
  for (double left = h; left > 0;) {
    load(u_, v_);
    for (std::size_t k = 0; k < kOrder && trouble_.empty(); ++k) coefficient(k);
    if (!trouble_.empty()) return false;
    const double reached = reach(h), tau = reached < left ? reached : left;
    if (!(tau > shortest * h) && tau < left) trouble_ = "stuck";
    if (!trouble_.empty() || !advance(tau)) return false;
    left = tau < left ? left - tau : 0;
    if (left > 0) ++further_steps_;
  }
  return true;
}

bool FieldMesh::advance(double h) {
  for (std::size_t f = 0; f < fields_; ++f) {
    std::copy_n(phi(f, kOrder), lanes_, u_[f].begin());
    std::copy_n(velocity(f, kOrder), lanes_, v_[f].begin());
    for (std::size_t k = kOrder; k-- > 0;) {
      horner(u_[f].data(), phi(f, k), h, lanes_);
      horner(v_[f].data(), velocity(f, k), h, lanes_);
    }
  }
  t_ += h;
  for (std::size_t f = 0; f < fields_; ++f)
    if (!std::isfinite(u_[f][lanes_ / 2]) || !std::isfinite(u_[f][0]) || !std::isfinite(u_[f][lanes_ - 1])) {
      trouble_ = "overflow";
      return false;
    }
  return true;
}

double FieldMesh::omega_max(const Interrupt& interrupt) {
  FieldValues w(fields_, std::vector<double>(lanes_));
  fill_randomly(w);
  for (auto& row : w) {
    for (int e = 0; e + 1 < cells_; ++e) row[local(0, e + 1)] = row[local(p_, e)];
    if (s_.periodic(0)) row[local(0, 0)] = row[local(p_, cells_ - 1)];
  }
  for (const Held& held : held_)
    if (!held.force) w[held.field][node_of(held)] = 0;
  const auto accelerations = [&](const FieldValues& u, FieldValues& to) {
    load(u, v_);
    coefficient(0);
    for (std::size_t f = 0; f < fields_; ++f) to[f] = past_[f * (kOrder + 2)];
  };
  constexpr int rounds = 60;
  return largest_frequency(u_, std::move(w), accelerations, rounds, trouble_, interrupt);
}

/// Coefficient 0 of all that ℒ depends on, as inputs.
void FieldMesh::show_state() {
  load(u_, v_);
  for (std::size_t f = 0; f < fields_; ++f) {
    differentiate_along_x(phi(f, 0), slope(f, 0));
    differentiate_along_x(velocity(f, 0), rate(f, 0));
  }
  std::fill_n(series_.input(4 * fields_ + 1, 0), lanes_, t_);
}

double FieldMesh::energy(double& size) {
  show_state();
  for (std::size_t i = 0; i < 4 * fields_ + 2; ++i) std::copy_n(series_.input(i, 0), lanes_, energies_.input(i, 0));
  energies_.advance(0);
  CarefulSum sum;
  size = 0;
  for (std::size_t n = 0; n < lanes_; ++n) {
    const double weight = rule_.w[n / static_cast<std::size_t>(cells_)] * width_ / 2;
    const double term = weight * energies_.root(0, 0)[n];
    sum.add(term);
    size += std::abs(term);
  }
  return sum.value();
}

double FieldMesh::field_at(std::size_t field, const FieldJet& jet, const std::vector<double>& place) const {
  const int by_space = jet.space[0];
  if (jet.time > 1 || by_space > 1) return std::nan("");
  const double cell = (place[0] - left_) / width_;
  const int e = std::clamp(static_cast<int>(std::floor(cell + 1e-9)), 0, cells_ - 1);
  std::vector<double> value, slope;
  rule_.at(2 * (cell - e) - 1, value, slope);
  double out = 0;
  for (int j = 0; j <= p_; ++j) {
    const double node = (jet.time == 0 ? u_ : v_)[field][local(j, e)];
    out += node * (by_space == 0 ? value : slope)[static_cast<std::size_t>(j)];
  }
  return by_space == 0 ? out : out * 2 / width_;
}

void FieldMesh::visit_points(const PointVisitor& visit) {
  show_state();
  std::vector<double> values(form_.inputs.size());
  for (std::size_t n = 0; n < lanes_; ++n) {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = series_.input(i, 0)[n];
    visit(rule_.w[n / static_cast<std::size_t>(cells_)] * width_ / 2, values.data());
  }
}

/// What ℒ depends on at the nodes of an element.
std::vector<std::vector<double>> FieldMesh::element_inputs(std::size_t cell) const {
  const std::size_t points = static_cast<std::size_t>(p_) + 1, n = static_cast<std::size_t>(cells_);
  std::vector<std::vector<double>> out(points, std::vector<double>(4 * fields_ + 2, 0));
  for (std::size_t j = 0; j < points; ++j) {
    for (std::size_t f = 0; f < fields_; ++f)
      for (const std::size_t rate : {0, 1}) {
        const std::vector<double>& u = (rate ? v_ : u_)[f];
        out[j][4 * f + rate] = u[j * n + cell];
        for (std::size_t m = 0; m < points; ++m)
          out[j][4 * f + 2 + rate] +=
              2 / width_ * rule_.derivative[j * points + m] * (u[m * n + cell] - u[j * n + cell]);
      }
    out[j][4 * fields_] = left_ + width_ * (static_cast<double>(cell) + 0.5 * (1 + rule_.x[j]));
    out[j][4 * fields_ + 1] = t_;
  }
  return out;
}

/// Of a free end slopes are those of its condition, of a held one those of the equation of its node.
std::vector<double> FieldMesh::inputs_at_end(bool right) {
  const auto inputs = element_inputs(right ? static_cast<std::size_t>(cells_) - 1 : 0);
  std::vector<double> out = right ? inputs.back() : inputs.front();
  if (s_.periodic(0)) return out;
  std::vector<double> s(fields_, 0), accelerations(fields_, 0);
  std::vector<bool> is_held(fields_, false);
  for (const Held& held : held_) {
    if (held.right != right) continue;
    if (held.force) s[held.field] += (right ? -1 : 1) * boundary_coefficient(held.derivatives, 0);
    if (!held.force) accelerations[held.field] = 2 * boundary_coefficient(held.derivatives, 2);
    is_held[held.field] = is_held[held.field] || !held.force;
  }
  if (std::find(is_held.begin(), is_held.end(), true) != is_held.end()) {
    // Where one field of several is free its acceleration is not at hand: polynomial slopes then.
    if (std::find(is_held.begin(), is_held.end(), false) != is_held.end()) return out;
    s = end_slopes_->stresses(rule_, width_, right, inputs, accelerations);
  }
  end_slopes_->solve(out, s, std::vector<bool>(fields_, false));
  return out;
}

void FieldMesh::visit_sides(const std::vector<Expr>& jets, const SideVisitor& visit) {
  if (!end_slopes_) end_slopes_ = std::make_shared<EndSlopes>(form_, equations_.model->parameters);
  for (const bool right : {false, true}) {
    const std::vector<double> inputs = inputs_at_end(right);
    std::vector<double> values;
    for (const Expr& jet : jets) {
      const auto at = std::find(form_.inputs.begin(), form_.inputs.end(), jet);
      values.push_back(at == form_.inputs.end() ? std::nan("")
                                                : inputs[static_cast<std::size_t>(at - form_.inputs.begin())]);
    }
    values.insert(values.end(), inputs.end() - 2, inputs.end());  // x, t
    visit({0, right, 1}, values.data());
  }
}

}  // namespace maupertuis
