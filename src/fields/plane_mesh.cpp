#include "fields/plane_mesh.hpp"

#include <maupertuis/evaluate.hpp>
#include <maupertuis/repeated_evaluation.hpp>

#include "fields/switching.hpp"
#include "fields/wide_lanes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

using Side = BoundaryCondition::Side;

/// a = b = mean of both
MAUP_LANES void set_means(double* __restrict a, double* __restrict b, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) a[i] = b[i] = 0.5 * (a[i] + b[i]);
}
MAUP_LANES void scale_into(double* __restrict to, const double* __restrict a, double factor, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) to[i] = factor * a[i];
}
MAUP_LANES void add_scaled(double* __restrict to, const double* __restrict a, double factor, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) to[i] += factor * a[i];
}
MAUP_LANES void add_scaled_products(double* __restrict to, const double* __restrict a, const double* __restrict b,
                                    double factor, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) to[i] += factor * (a[i] * b[i]);
}
/// u = Σ φ_k h^k, v = Σ (k+1) φ_{k+1} h^k, k ≤ kOrder; coefficients `n` apart.
MAUP_LANES void sum_series(double* __restrict u, double* __restrict v, const double* __restrict phi, double h,
                           std::size_t n) {
  std::size_t i = 0;
  for (; i + kWide <= n; i += kWide) {
    Lanes next = lanes_at(phi + (kOrder + 1) * n + i), rate = (kOrder + 1.0) * next, value = {};
    for (std::size_t k = kOrder + 1; k-- > 0;) {
      const Lanes c = lanes_at(phi + k * n + i);
      value = value * h + c;
      if (k > 0) rate = rate * h + static_cast<double>(k) * c;
    }
    lanes_at(u + i) = value, lanes_at(v + i) = rate;
  }
  for (; i < n; ++i) {
    double rate = (kOrder + 1.0) * phi[(kOrder + 1) * n + i], value = 0;
    for (std::size_t k = kOrder + 1; k-- > 0;) {
      value = value * h + phi[k * n + i];
      if (k > 0) rate = rate * h + static_cast<double>(k) * phi[k * n + i];
    }
    u[i] = value, v[i] = rate;
  }
}

/// max |a|
MAUP_LANES double largest(const double* __restrict a, std::size_t n) {
  Lanes most = {};
  std::size_t i = 0;
  for (; i + kWide <= n; i += kWide) {
    const Lanes value = lanes_at(a + i), size = value < 0.0 ? -value : value;
    most = size > most ? size : most;
  }
  double out = 0;
  for (std::size_t k = 0; k < kWide; ++k) out = std::max(out, most[k]);
  for (; i < n; ++i) out = std::max(out, std::abs(a[i]));
  return out;
}

std::vector<Expr> roots_of(const PointForm& form) {
  std::vector<Expr> roots;
  for (const auto* part : {&form.a, &form.g, &form.s}) roots.insert(roots.end(), part->begin(), part->end());
  return roots;
}

/// A product without its constants, whose product is `factor`: that goes into the scale of slopes.
Expr without_constants(Expr e, const std::unordered_map<Expr, double, ExprHash>& constants, double& factor) {
  factor = 1;
  if (!e.is(Kind::Product)) return e;
  std::vector<Expr> rest;
  for (std::size_t i = 0; i < e.size(); ++i)
    if (const auto known = constants.find(e[i]); known != constants.end())
      factor *= known->second;
    else if (e[i].is_number())
      factor *= e[i].number().to_double();
    else
      rest.push_back(e[i]);
  return e.context().product(rest);
}

bool stands_in_any(const std::vector<Expr>& roots, Expr symbol) {
  const std::vector<Expr> below = symbols_of(roots);
  return std::find(below.begin(), below.end(), symbol) != below.end();
}

/// φ, and the places and t where they stand in the equation, keep their past: the mesh writes and reads it.
std::vector<std::size_t> inputs_with_a_past(const PointForm& form) {
  std::vector<std::size_t> out;
  for (std::size_t f = 0; f < form.fields; ++f) out.push_back(PlaneMesh::kInputs * f + PlaneMesh::Phi);
  const std::vector<Expr> roots = roots_of(form);
  for (std::size_t i = PlaneMesh::kInputs * form.fields; i < PlaneMesh::kInputs * form.fields + 3; ++i)
    if (stands_in_any(roots, form.inputs[i])) out.push_back(i);
  return out;
}

}  // namespace

PlaneMesh::PlaneMesh(const FieldEquations& equations, const PointForm& form, int cells_x, int cells_y, int order)
    : WaveMesh(equations),
      form_(form),
      p_(order),
      fields_(form.fields),
      rule_(order),
      slopes_(EvenOddProduct::slopes(rule_)),
      stiffness_(EvenOddProduct::stiffness(rule_)) {
  std::unordered_map<Expr, double, ExprHash> constants;
  for (const Parameter& p : equations.model->parameters) constants[p.symbol] = values_[p.symbol] = p.si_value;
  for (std::size_t i = 0; i < 2; ++i) {
    axes_[i].cells = i == 0 ? cells_x : cells_y;
    axes_[i].from = value_of(s_.space[i].from, {});
    axes_[i].width = (value_of(s_.space[i].to, {}) - axes_[i].from) / axes_[i].cells;
  }
  line_ = points() * cells(), lanes_ = points() * line_;
  std::vector<Expr> roots = roots_of(form);
  const std::vector<Expr> sizes{form.energy};
  stress_scale_.resize(form.s.size());
  for (std::size_t i = 0; i < form.s.size(); ++i)
    roots[roots.size() - form.s.size() + i] = without_constants(form.s[i], constants, stress_scale_[i]);
  look_for_plain_stresses(roots);
  auto series = LaneSeries::make(roots, form.inputs, constants, trouble_);
  auto energies = LaneSeries::make(sizes, form.inputs, constants, trouble_);
  if (!series || !energies) return;
  series_ = std::move(*series), energies_ = std::move(*energies);
  for (std::size_t f = 0; f < fields_; ++f) {
    uses_velocity_ = uses_velocity_ || stands_in_any(roots, form.inputs[kInputs * f + Velocity]);
    for (const std::size_t i : {RateX, RateY})
      uses_rate_ = uses_rate_ || stands_in_any(roots, form.inputs[kInputs * f + i]);
  }
  uses_time_ = stands_in_any(roots, s_.context->time());
  series_.keep(inputs_with_a_past(form), form.a.size());
  series_.resize(lanes_, kOrder + 2, rows());
  energies_.resize(lanes_, 1);
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t row = 0; row < rows() && stands_in_any(roots, s_.space[i].symbol); ++row) {
      series_.select(row);
      for (std::size_t n = 0; n < lanes_; ++n) series_.input(kInputs * fields_ + i, 0)[n] = place(i, row, n);
    }
  for (std::size_t n = 0; n < lanes_; ++n) energies_.input(kInputs * fields_, 0)[n] = place(0, 0, n);
  for (const EndForce& f : s_.end_forces) hold(f.side, f.jet.field, f.value, true);
  for (const BoundaryCondition& b : s_.boundary) {
    if (b.jet.order() == 0) {
      hold(b.side, b.jet.field, b.value, false);
      continue;
    }
    // u_x = a says what ∂ℒ/∂u_x is there: p + F = 0 on the right and at the top, −p + F = 0 on the others.
    std::size_t a_field = 0;
    while (equations_.varied[a_field] != b.jet.field) ++a_field;
    const std::size_t along = b.side == Side::Left || b.side == Side::Right ? 0 : 1;
    const bool far = b.side == Side::Right || b.side == Side::Top;
    const SpaceVariable& x = s_.space[along];
    const Expr p = substitute(form_.s[along * fields_ + a_field],
                              {{s_.jet_symbol(b.jet), b.value}, {x.symbol, far ? x.to : x.from}});
    if (!s_.jets_in(p).empty()) {
      trouble_ = "slope";
      return;
    }
    hold(b.side, b.jet.field, far ? -p : p, true);
  }
  prepare_masses();
  force_.assign(fields_ * lanes_, 0), other_.assign(lanes_, 0);
  pending_.assign(kOrder, std::vector<double>(fields_ * line_)), first_ = pending_;
}

/// Which stresses are numbers times the slopes of their own fields, as of membranes: then the stiffness of an element
/// is one matrix along each direction. Slopes are computed where anything else holds them.
void PlaneMesh::look_for_plain_stresses(const std::vector<Expr>& roots) {
  const std::size_t stresses = form_.s.size(), first = roots.size() - stresses;
  std::vector<Expr> others(roots.begin(), roots.begin() + static_cast<std::ptrdiff_t>(first));
  for (std::size_t i = 0; i < stresses; ++i) {
    const std::size_t f = i % fields_, direction = i / fields_;
    is_slope_.push_back(roots[first + i] == form_.inputs[kInputs * f + SlopeX + direction]);
    if (!is_slope_.back()) others.push_back(roots[first + i]);
  }
  for (std::size_t f = 0; f < fields_; ++f)
    for (const std::size_t i : {SlopeX, SlopeY})
      uses_slope_ = uses_slope_ || stands_in_any(others, form_.inputs[kInputs * f + i]);
}

/// One A⁻¹ for all nodes where A is a matrix of numbers, and no field is held that has mass in common with another one.
void PlaneMesh::prepare_masses() {
  std::vector<double> a(fields_ * fields_);
  bool alike = true;
  for (std::size_t i = 0; i < a.size(); ++i) {
    alike = alike && series_.number_root(i);
    if (!alike) break;
    a[i] = *series_.number_root(i);
    for (const Held& held : held_)
      if (!held.force && i / fields_ == held.field && i % fields_ != held.field && a[i] != 0) alike = false;
  }
  if (alike) {
    if (!invert_mass(a, scalar_inverse_, fields_)) trouble_ = "mass";
    return;
  }
  inverse_.assign(fields_ * fields_ * lanes_ * rows(), 0);
  a_.assign(fields_ * fields_ * lanes_, 0);
  a_pending_.assign(fields_ * fields_ * line_, 0), a_first_ = a_pending_;
}

double PlaneMesh::bytes(const FieldEquations& equations, const PointForm& form, double cells_x, double cells_y,
                        int order) {
  std::unordered_map<Expr, double, ExprHash> constants;
  for (const Parameter& p : equations.model->parameters) constants[p.symbol] = p.si_value;
  std::string trouble;
  auto series = LaneSeries::make(roots_of(form), form.inputs, constants, trouble);
  if (!series) return 0;
  series->keep(inputs_with_a_past(form), form.a.size());
  const double lanes = cells_x * cells_y * (order + 1.0) * (order + 1.0);
  // φ, φ' and, at the start, a direction of the power iteration with two accelerations
  return series->bytes(lanes, kOrder + 2) + 6.0 * static_cast<double>(form.fields) * lanes * sizeof(double);
}

void PlaneMesh::hold(Side side, std::size_t field, Expr value, bool force) {
  Held held{side, 0, force, false, s_.expanded(value), {}};
  while (equations_.varied[held.field] != field) ++held.field;
  for (const SpaceVariable& x : s_.space) held.varies = held.varies || stands_in_any({held.value}, x.symbol);
  held.derivatives = time_derivatives(held.value);
  held_.push_back(std::move(held));
}

void PlaneMesh::follow_branches(double from, double until) {
  t_ = from;
  for (Held& held : held_) {
    held.derivatives = time_derivatives(branches_between(held.value, s_, values_, from, until));
    if (held.force || u_.empty()) continue;
    for (std::size_t order = 0; order < 2; ++order)
      for (std::size_t row = 0; row < rows(); ++row)
        each_held(held, row, order, 0, points(), [&](std::size_t lane, double value) {
          (order == 0 ? u_ : v_)[held.field][row * lanes_ + lane] = value;
        });
  }
}

double PlaneMesh::weight(std::size_t lane) const {
  return rule_.w[lane / line_] * rule_.w[lane % line_ / cells()] * axes_[0].width * axes_[1].width / 4;
}

double PlaneMesh::place(std::size_t direction, std::size_t row, std::size_t lane) const {
  const double cell = static_cast<double>(direction == 0 ? lane % cells() : row);
  const double xi = rule_.x[direction == 0 ? lane % line_ / cells() : lane / line_];
  return axes_[direction].at(cell + 0.5 * (1 + xi));
}

bool PlaneMesh::is_on(Side side, std::size_t row) const {
  return side == Side::Bottom ? row == 0 : side == Side::Top ? row + 1 == rows() : true;
}

bool PlaneMesh::is_on(Side side, std::size_t row, std::size_t lane) const {
  const std::size_t in_line = lane % line_;
  return side == Side::Left     ? in_line == 0
         : side == Side::Right  ? in_line + 1 == line_
         : side == Side::Bottom ? is_on(side, row) && lane < line_
                                : is_on(side, row) && lane >= lanes_ - line_;
}

/// Which fields are held at a node.
std::vector<bool> PlaneMesh::held_at(std::size_t row, std::size_t lane) const {
  std::vector<bool> out(fields_, false);
  for (const Held& held : held_)
    if (!held.force && is_on(held.side, row, lane)) out[held.field] = true;
  return out;
}

template <class F>
void PlaneMesh::each_held(const Held& held, std::size_t row, std::size_t k, std::size_t from_line, std::size_t lines,
                          F&& f) {
  if (!is_on(held.side, row)) return;
  double factorial = 1;
  for (std::size_t i = 2; i <= k; ++i) factorial *= static_cast<double>(i);
  const Expr derivative = held.derivatives[k];
  const bool zero = derivative.is_zero();
  const double everywhere = zero || held.varies ? 0 : value_of(derivative, {{s_.context->time(), t_}}) / factorial;
  const auto at = [&](std::size_t lane) {
    f(lane, zero || !held.varies ? everywhere
                                 : value_of(derivative, {{s_.context->time(), t_},
                                                         {s_.space[0].symbol, place(0, row, lane)},
                                                         {s_.space[1].symbol, place(1, row, lane)}}) /
                                       factorial);
  };
  for (std::size_t j = from_line; j < from_line + lines; ++j) {
    if (held.side == Side::Left) at(j * line_);
    if (held.side == Side::Right) at(j * line_ + line_ - 1);
    if ((held.side == Side::Bottom && j == 0) || (held.side == Side::Top && j + 1 == points()))
      for (std::size_t i = 0; i < line_; ++i) at(j * line_ + i);
  }
}

void PlaneMesh::start() {
  u_.assign(fields_, Rows(lanes_ * rows(), 0)), v_ = next_u_ = next_v_ = u_;
  for (const FieldStart& start : equations_.model->start) {
    std::size_t a = 0;
    while (equations_.varied[a] != start.field) ++a;
    const Expr value[] = {s_.expanded(start.value)};
    const RepeatedEvaluation at(value);
    Rows& to = (start.order == 0 ? u_ : v_)[a];
    for (std::size_t n = 0; n < to.size(); ++n) {
      const double x = place(0, n / lanes_, n % lanes_), y = place(1, n / lanes_, n % lanes_);
      to[n] = at([&](Expr symbol) {
                return symbol == s_.space[0].symbol ? x : symbol == s_.space[1].symbol ? y : values_.at(symbol);
              }).front();
      if (!std::isfinite(to[n])) trouble_ = "start";
    }
  }
  for (const Held& held : held_)
    for (std::size_t order = 0; order < 2 && !held.force; ++order) {
      Rows& values = (order == 0 ? u_ : v_)[held.field];
      double size = 0;
      for (const double value : values) size = std::max(size, std::abs(value));
      std::optional<StartClash> clash;
      for (std::size_t row = 0; row < rows(); ++row)
        each_held(held, row, order, 0, points(), [&](std::size_t lane, double condition) {
          double& value = values[row * lanes_ + lane];
          constexpr double rounding = 1e-9;
          if (!clash && std::abs(value - condition) > rounding * std::max(size, std::abs(condition)))
            clash = StartClash{held.field, 0, static_cast<int>(order), held.side, value, condition};
          value = condition;
        });
      if (clash) clashes_.push_back(*clash);
    }
}

/// ∂_x and ∂_y of one row of elements.
void PlaneMesh::slopes(double* to_x, double* to_y, const double* from) const {
  const EvenOddProduct& d = slopes_;
  for (std::size_t j = 0; j < points(); ++j)
    d.apply(to_x + j * line_, nullptr, from + j * line_, 2 / axes_[0].width, cells(), cells());
  d.apply(to_y, nullptr, from, 2 / axes_[1].width, line_, line_);
}

void PlaneMesh::take_row(std::size_t row) {
  for (std::size_t f = 0; f < fields_; ++f) {
    std::copy_n(u_[f].data() + row * lanes_, lanes_, phi(f, 0));
    std::copy_n(v_[f].data() + row * lanes_, lanes_, phi(f, 1));
  }
}

/// Coefficient k of what ℒ is a function of.
void PlaneMesh::prepare(std::size_t k) {
  for (std::size_t f = 0; f < fields_; ++f) {
    const std::size_t i = kInputs * f;
    if (uses_slope_) slopes(series_.input(i + SlopeX, k), series_.input(i + SlopeY, k), phi(f, k));
    if (!uses_velocity_ && !uses_rate_) continue;
    scale_into(series_.input(i + Velocity, k), phi(f, k + 1), static_cast<double>(k + 1), lanes_);
    if (uses_rate_) slopes(series_.input(i + RateX, k), series_.input(i + RateY, k), series_.input(i + Velocity, k));
  }
  if (uses_time_ && k < 2)  // the rest of t is 0
    std::fill_n(series_.input(kInputs * fields_ + 2, k), lanes_, k == 0 ? t_ : 1.0);
}

/// The nodes that neighbours in a row have in common take the mean of both.
void PlaneMesh::share_columns(double* lanes) const {
  const std::size_t n = cells();
  for (std::size_t j = 0; j < points(); ++j) {
    double* first = lanes + j * line_;
    double* last = first + line_ - n;
    set_means(first + 1, last, n - 1);
    if (s_.periodic(0)) set_means(first, last + n - 1, 1);
  }
}

/// A⁻¹ at the nodes of a row, and of the last line of the row before.
void PlaneMesh::masses(std::size_t row) {
  const std::size_t pairs = fields_ * fields_, last = line_ * (points() - 1);
  for (std::size_t i = 0; i < pairs; ++i) {
    double* a = a_.data() + i * lanes_;
    std::copy_n(series_.root(i, 0), lanes_, a);
    share_columns(a);
    if (row > 0) set_means(a, a_pending_.data() + i * line_, line_);
    if (row == 0) std::copy_n(a, line_, a_first_.data() + i * line_);
    if (s_.periodic(1) && row + 1 == rows()) set_means(a + last, a_first_.data() + i * line_, line_);
    if (row + 1 < rows() || !s_.periodic(1)) std::copy_n(a + last, line_, a_pending_.data() + i * line_);
  }
  std::vector<double> a(pairs), inverse;
  const auto put = [&](std::size_t of_row, std::size_t lane, const std::vector<double>& from, std::size_t at,
                       std::size_t stride) {
    for (std::size_t i = 0; i < pairs; ++i) a[i] = from[i * stride + at];
    if (!invert_mass(a, inverse, held_at(of_row, lane))) trouble_ = "mass";
    for (std::size_t i = 0; i < pairs; ++i) inverse_[(of_row * pairs + i) * lanes_ + lane] = inverse[i];
  };
  std::vector<double> before(pairs * line_);  // of the line in common with the row before
  for (std::size_t i = 0; i < pairs; ++i) std::copy_n(a_.data() + i * lanes_, line_, before.data() + i * line_);
  for (std::size_t n = 0; n < lanes_; ++n) put(row, n, a_, n, lanes_);
  for (std::size_t n = 0; n < line_ && row > 0; ++n) put(row - 1, last + n, before, n, line_);
  for (std::size_t n = 0; n < line_ && s_.periodic(1) && row + 1 == rows(); ++n) put(0, n, a_first_, n, line_);
  if (row + 1 == rows()) mass_known_ = true;
}

/// base + ∂s/∂x of one direction with what the sides of the elements add; `base` may be null. Where it is, into `to`;
/// `base` itself where there is no such stress.
const double* PlaneMesh::add_stress(std::size_t f, std::size_t direction, std::size_t k, const double* base,
                                    double* to) {
  const std::size_t i = direction * fields_ + f, root = fields_ * fields_ + fields_ + i;
  if (series_.number_root(root) == 0.0) return base;
  const double slope = 2 / axes_[direction].width, scale = slope * stress_scale_[i] * share_of_force(k);
  const EvenOddProduct& matrix = is_slope_[i] ? stiffness_ : slopes_;
  const double* from = is_slope_[i] ? phi(f, k) : series_.root(root, k);
  const double factor = is_slope_[i] ? slope * scale : scale;
  if (direction == 1) matrix.apply(to, base, from, factor, line_, line_);
  for (std::size_t at = 0; direction == 0 && at < lanes_; at += line_)
    matrix.apply(to + at, base ? base + at : nullptr, from + at, factor, cells(), cells());
  if (!is_slope_[i]) add_sides_of_elements(f, direction, k, to);
  return to;
}

/// ± s over the weight of the end of an element, at its two sides.
void PlaneMesh::add_sides_of_elements(std::size_t f, std::size_t direction, std::size_t k, double* to) {
  const std::size_t i = direction * fields_ + f, n = direction == 0 ? cells() : line_;
  const std::size_t whole = direction == 0 ? line_ : lanes_;
  const double scale = 2 / axes_[direction].width * stress_scale_[i] / rule_.w[0] * share_of_force(k);
  const double* s = series_.root(fields_ * fields_ + fields_ + i, k);
  for (std::size_t at = 0; at < lanes_; at += whole) {
    add_scaled(to + at, s + at, scale, n);
    add_scaled(to + at + whole - n, s + at + whole - n, -scale, n);
  }
}

/// What a force is multiplied by as it is made: the coefficient k + 2 of a field alone whose A is a number is a
/// multiple of its force, so that no pass over a row is needed for it.
double PlaneMesh::share_of_force(std::size_t k) const {
  return is_alone() ? -scalar_inverse_.front() / static_cast<double>((k + 1) * (k + 2)) : 1;
}

/// −A φ'' of coefficient k, element by element, times its share: g + ∂_x s_x + ∂_y s_y and the sides.
void PlaneMesh::force(std::size_t f, std::size_t row, std::size_t k, double* out) {
  const std::size_t g = fields_ * fields_ + f;
  const double share = share_of_force(k);
  const double* potential = series_.number_root(g) == 0.0 ? nullptr : series_.root(g, k);
  const double* sum = add_stress(f, 0, k, is_alone() ? nullptr : potential, other_.data());
  sum = add_stress(f, 1, k, sum, out);
  if (!sum) std::fill_n(out, lanes_, 0.0);
  if (sum && sum != out) std::copy_n(sum, lanes_, out);
  if (is_alone() && potential) add_scaled(out, potential, share, lanes_);
  for (std::size_t o = 0; o < fields_ && !form_.constant_mass; ++o)
    for (std::size_t i = 1; i <= k; ++i)
      add_scaled_products(out, series_.root(f * fields_ + o, i), phi(o, k - i + 2),
                          static_cast<double>((k - i + 1) * (k - i + 2)), lanes_);
  for (const Held& held : held_) {
    if (!held.force || held.field != f) continue;
    const bool across = held.side == Side::Left || held.side == Side::Right;
    const double factor = share * 2 / rule_.w[0] / axes_[across ? 0 : 1].width;
    each_held(held, row, k, 0, points(), [&](std::size_t lane, double value) { out[lane] -= factor * value; });
  }
  share_columns(out);
}

/// φ_{k+2} in lines of a row whose forces, `stride` apart for the fields, are known with all that their neighbours add;
/// that of a field alone is its force. Where a field is held that has mass in common with others, its acceleration
/// stands in the place of its force.
void PlaneMesh::finish(std::size_t row, std::size_t k, std::size_t from_line, std::size_t lines, double* forces,
                       std::size_t stride) {
  series_.select(row);
  const std::size_t n = lines * line_, at = from_line * line_;
  const double factor = -1 / static_cast<double>((k + 1) * (k + 2));
  for (const Held& held : held_)
    if (!held.force && !inverse_.empty())
      each_held(held, row, k + 2, from_line, lines,
                [&](std::size_t lane, double value) { forces[held.field * stride + lane - at] = value / factor; });
  for (std::size_t f = 0; f < fields_; ++f) {
    double* out = phi(f, k + 2) + at;
    if (is_alone()) {
      if (out != forces) std::copy_n(forces, n, out);
    } else if (inverse_.empty()) {
      scale_into(out, forces, factor * scalar_inverse_[f * fields_], n);
      for (std::size_t o = 1; o < fields_; ++o)
        if (const double c = scalar_inverse_[f * fields_ + o]; c != 0)
          add_scaled(out, forces + o * stride, factor * c, n);
    } else {
      std::fill_n(out, n, 0.0);
      for (std::size_t o = 0; o < fields_; ++o)
        add_scaled_products(out, inverse_.data() + ((row * fields_ + f) * fields_ + o) * lanes_ + at,
                            forces + o * stride, factor, n);
    }
    for (const Held& held : held_)
      if (!held.force && held.field == f)
        each_held(held, row, k + 2, from_line, lines,
                  [&](std::size_t lane, double value) { phi(f, k + 2)[lane] = value; });
  }
}

/// Coefficient k + 2 of the lines of a row but the last, which the next row has in common with it, and of that of the
/// row before.
void PlaneMesh::process(std::size_t row, std::size_t k) {
  series_.select(row);
  if (k == 0) take_row(row);
  prepare(k);
  series_.advance(k);
  if (k == 0 && !inverse_.empty() && !(form_.constant_mass && mass_known_)) masses(row);
  const std::size_t last = points() - 1;
  const bool wraps = s_.periodic(1), top = row + 1 == rows();
  double* forces = is_alone() ? phi(0, k + 2) : force_.data();  // of this row, whichever is selected
  for (std::size_t f = 0; f < fields_; ++f) {
    double* lanes = forces + f * lanes_;
    force(f, row, k, lanes);
    if (row > 0) set_means(lanes, pending_[k].data() + f * line_, line_);
    if (row == 0) std::copy_n(lanes, line_, first_[k].data() + f * line_);
    if (wraps && top) set_means(lanes + last * line_, first_[k].data() + f * line_, line_);
  }
  if (row > 0) finish(row - 1, k, last, 1, pending_[k].data(), line_);
  finish(row, k, 0, points(), forces, lanes_);
  if (wraps && top) finish(0, k, 0, 1, first_[k].data(), line_);
  for (std::size_t f = 0; f < fields_ && !top; ++f)
    std::copy_n(forces + f * lanes_ + last * line_, line_, pending_[k].data() + f * line_);
}

/// All coefficients below `orders` + 2 of all rows; `behind` is called where a row is done.
void PlaneMesh::sweep(std::size_t orders, const std::function<void(std::size_t row)>& behind) {
  if (s_.periodic(1)) {  // each row waits for both of its neighbours, the first for the last
    for (std::size_t k = 0; k < orders; ++k)
      for (std::size_t row = 0; row < rows(); ++row) process(row, k);
    for (std::size_t row = 0; row < rows(); ++row) behind(row);
    return;
  }
  for (std::size_t front = 0; front < rows() + orders; ++front) {
    for (std::size_t k = 0; k < orders && k <= front; ++k)
      if (front - k < rows()) process(front - k, k);
    if (front >= orders) behind(front - orders);
  }
}

/// The sum of the series after h, as the next values. The last term beside the field: what is too long for the series
/// is found afterwards, since a row's coefficients are gone when the next is there.
double PlaneMesh::advance(double h) {
  std::vector<double> size(fields_, 0), last(fields_, 0);
  const double power = std::pow(h, static_cast<double>(kOrder));
  sweep(kOrder, [&](std::size_t row) {
    series_.select(row);
    for (std::size_t f = 0; f < fields_; ++f) {
      size[f] = std::max({size[f], largest(phi(f, 0), lanes_), h * largest(phi(f, 1), lanes_)});
      last[f] = std::max(last[f], power * largest(phi(f, kOrder), lanes_));
      sum_series(next_u_[f].data() + row * lanes_, next_v_[f].data() + row * lanes_, phi(f, 0), h, lanes_);
    }
  });
  constexpr double at_rest = 1e-30;
  double ratio = 0;
  for (std::size_t f = 0; f < fields_; ++f) ratio = std::max(ratio, last[f] / std::max(size[f], at_rest));
  return ratio;
}

/// Steps are held to kLastTerm, as those of FieldMesh.
bool PlaneMesh::step(double h) {
  constexpr double shortest = 1e-7;
  for (double left = h; left > 0 && trouble_.empty();) {
    double tau = left;
    const double ratio = advance(tau);
    if (ratio > kLastTerm) {
      tau *= std::pow(kLastTerm / ratio, 1.0 / static_cast<double>(kOrder));
      ++further_steps_;
      if (tau > shortest * h)
        advance(tau);
      else
        trouble_ = "stuck";
    }
    std::swap(u_, next_u_), std::swap(v_, next_v_);
    t_ += tau;
    left = tau < left ? left - tau : 0;
    for (std::size_t f = 0; f < fields_; ++f)
      for (std::size_t row = 0; row < rows(); ++row)
        if (!std::isfinite(u_[f][row * lanes_ + lanes_ / 2]) && trouble_.empty()) trouble_ = "overflow";
  }
  return trouble_.empty();
}

double PlaneMesh::omega_max(const Interrupt& interrupt) {
  constexpr int rounds = 100;
  std::vector<Rows> w(fields_, Rows(lanes_ * rows()));
  fill_randomly(w);
  const auto accelerations = [&](std::vector<Rows>& state, std::vector<Rows>& to) {
    std::swap(u_, state);
    sweep(1, [&](std::size_t row) {
      series_.select(row);
      for (std::size_t f = 0; f < fields_; ++f) scale_into(to[f].data() + row * lanes_, phi(f, 2), 2, lanes_);
    });
    std::swap(u_, state);
  };
  const std::vector<Rows> here = u_;
  return largest_frequency(here, std::move(w), accelerations, rounds, trouble_, interrupt);
}

}  // namespace maupertuis
