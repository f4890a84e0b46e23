#include "fields/collocation.hpp"

#include <maupertuis/evaluate.hpp>

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
