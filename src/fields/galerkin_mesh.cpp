#include "fields/galerkin_mesh.hpp"

#include <maupertuis/evaluate.hpp>
#include <maupertuis/repeated_evaluation.hpp>

#include "fields/wide_lanes.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

bool holds_jets_or_time(const FieldSystem& s, Expr e) {
  const std::vector<Expr> symbols = symbols_of({&e, 1});
  return std::any_of(symbols.begin(), symbols.end(),
                     [&](Expr symbol) { return s.jet_of(symbol) || symbol.role() == Role::Time; });
}

}  // namespace

GalerkinMesh::GalerkinMesh(const FieldEquations& equations, const DensityForm& form, int cells, int degree,
                           const Bindings& values, std::string& trouble)
    : form_(form), cells_(cells), fields_(form.smooth.size()), rule_(degree + 2), values_(values) {
  const FieldSystem& s = equations.system();
  x_ = s.space.front().symbol;
  left_ = evaluate(s.expanded(s.space.front().from), values);
  width_ = (evaluate(s.expanded(s.space.front().to), values) - left_) / cells;
  for (const bool smooth : form.smooth) elements_.emplace_back(smooth, smooth ? std::max(degree, 3) : degree);
  for (const Element& e : elements_) local_ = std::max(local_, e.size());
  number_coefficients(s.periodic);
  for (const Element& e : elements_)
    for (int k = 0; k < 3; ++k) {
      std::vector<double> table(rule_.x.size() * e.size());
      for (std::size_t q = 0; q < rule_.x.size(); ++q) {
        double* row = table.data() + q * e.size();
        e.at(rule_.x[q], k, row);
        if (k > 0) row[0] = -row[e.at_end()];  // to the bit: forces act on differences of u
        for (std::size_t i = 0; i < e.size(); ++i) row[i] *= std::pow(2 / width_, k);
      }
      tables_.push_back(std::move(table));
    }
  for (const double xi : rule_.x)
    for (int e = 0; e < cells; ++e) points_.push_back(left_ + width_ * (e + 0.5 * (1 + xi)));
  std::unordered_map<Expr, double, ExprHash> constants(values.begin(), values.end());
  std::vector<Expr> seconds;
  for (const DensityForm::Entry& e : form.hessian) seconds.push_back(e.value);
  const std::vector<Expr> sizes{form.energy};
  auto series = LaneSeries::make(form.by_slot, form.inputs, constants, trouble);
  auto hessian = LaneSeries::make(seconds, form.inputs, constants, trouble);
  auto energies = LaneSeries::make(sizes, form.inputs, constants, trouble);
  if (!series || !hessian || !energies) return;
  series_ = std::move(*series), hessian_ = std::move(*hessian), energies_ = std::move(*energies);
  for (LaneSeries* lanes : {&series_, &hessian_, &energies_}) {
    lanes->resize(points_.size(), 1);
    std::copy(points_.begin(), points_.end(), lanes->input(form.slots.size(), 0));
  }
}

/// From left to right: what stands at an end, then the inner coefficients of the element to its right. In a ring the
/// elements are taken from both sides in turn, so that neighbours have near numbers all round.
void GalerkinMesh::number_coefficients(bool periodic) {
  const auto cells = static_cast<std::size_t>(cells_);
  std::size_t block = 0, at_ends = 0;
  for (const Element& e : elements_) block += e.at_end() + e.inner(), at_ends += e.at_end();
  const auto first_of = [&](std::size_t node) {
    if (!periodic) return node * block;
    node %= cells;
    return block * (2 * node < cells ? 2 * node : 2 * (cells - 1 - node) + 1);
  };
  size_ = periodic ? cells * block : cells * block + at_ends;
  map_.assign(cells * fields_ * local_, 0);
  for (std::size_t cell = 0; cell < cells; ++cell) {
    std::size_t least = size_, most = 0, end = 0, inner = at_ends;
    for (std::size_t f = 0; f < fields_; ++f) {
      const Element& e = elements_[f];
      std::size_t* to = map_.data() + (cell * fields_ + f) * local_;
      for (std::size_t i = 0; i < e.at_end(); ++i) {
        to[i] = first_of(cell) + end + i;
        to[e.at_end() + i] = first_of(cell + 1) + end + i;
      }
      for (std::size_t i = 0; i < e.inner(); ++i) to[2 * e.at_end() + i] = first_of(cell) + inner + i;
      end += e.at_end(), inner += e.inner();
      for (std::size_t i = 0; i < e.size(); ++i) least = std::min(least, to[i]), most = std::max(most, to[i]);
    }
    band_ = std::max(band_, most - least);
  }
}

const double* GalerkinMesh::table(std::size_t field, int k, std::size_t q) const {
  return tables_[3 * field + static_cast<std::size_t>(k)].data() + q * elements_[field].size();
}

namespace {

/// to = Σ_m c_m from_m, the from_m `stride` apart.
MAUP_LANES void combine(double* __restrict to, const double* from, const double* c, std::size_t count,
                        std::size_t stride, std::size_t n) {
  std::size_t i = 0;
  for (; i + kWide <= n; i += kWide) {
    Lanes sum = {};
    for (std::size_t m = 0; m < count; ++m) sum += c[m] * lanes_at(from + m * stride + i);
    lanes_at(to + i) = sum;
  }
  for (; i < n; ++i) {
    to[i] = 0;
    for (std::size_t m = 0; m < count; ++m) to[i] += c[m] * from[m * stride + i];
  }
}

}  // namespace

void GalerkinMesh::set(const double* c, const double* rates, double t, bool all) {
  const std::size_t n = cells();
  std::vector<double> local(local_ * n);
  for (std::size_t slot = 0; slot < form_.slots.size(); ++slot) {
    const DensityForm::Slot& s = form_.slots[slot];
    if (!s.stands && !all) continue;
    const Element& e = elements_[s.field];
    const double* from = s.rate ? rates : c;
    for (std::size_t cell = 0; cell < n; ++cell)
      for (std::size_t i = 0; i < e.size(); ++i) local[i * n + cell] = from[index(s.field, cell, i)];
    if (s.space > 0)
      for (std::size_t cell = 0; cell < n; ++cell) local[e.at_end() * n + cell] -= local[cell], local[cell] = 0;
    for (std::size_t q = 0; q < rule_.x.size(); ++q)
      combine(series_.input(slot, 0) + q * n, local.data(), table(s.field, s.space, q), e.size(), n, n);
  }
  std::fill_n(series_.input(form_.slots.size() + 1, 0), lanes(), t);
  series_.advance(0);
}

void GalerkinMesh::assemble(double* out, bool rates) const {
  std::fill_n(out, size_, 0.0);
  const std::size_t points = rule_.x.size(), n = cells();
  std::vector<double> local(n), c(points);
  for (std::size_t slot = 0; slot < form_.slots.size(); ++slot) {
    const DensityForm::Slot& s = form_.slots[slot];
    if (s.rate != rates || form_.by_slot[slot].is_zero()) continue;
    for (std::size_t i = 0; i < elements_[s.field].size(); ++i) {
      for (std::size_t q = 0; q < points; ++q) c[q] = rule_.w[q] * width_ / 2 * table(s.field, s.space, q)[i];
      combine(local.data(), series_.root(slot, 0), c.data(), points, n, n);
      for (std::size_t cell = 0; cell < n; ++cell) out[index(s.field, cell, i)] += local[cell];
    }
  }
}

void GalerkinMesh::momenta(double* out) const { assemble(out, true); }
void GalerkinMesh::forces(double* out) const { assemble(out, false); }

GalerkinMesh::Matrices GalerkinMesh::matrices() {
  for (std::size_t i = 0; i < form_.inputs.size(); ++i) std::copy_n(series_.input(i, 0), lanes(), hessian_.input(i, 0));
  hessian_.advance(0);
  const BandedMatrix<double> empty(size_, band_, band_);
  Matrices out{empty, empty, empty, empty};
  const std::size_t points = rule_.x.size();
  std::vector<double> local(local_ * local_);
  for (std::size_t k = 0; k < form_.hessian.size(); ++k) {
    const DensityForm::Slot &row = form_.slots[form_.hessian[k].row], &column = form_.slots[form_.hessian[k].column];
    const Element &r = elements_[row.field], &c = elements_[column.field];
    BandedMatrix<double>& to = row.rate ? (column.rate ? out.m : out.g) : column.rate ? out.g : out.k;
    const double sign = row.rate ? 1 : -1;
    const double* value = hessian_.root(k, 0);
    for (std::size_t cell = 0; cell < cells(); ++cell) {
      std::fill(local.begin(), local.end(), 0.0);
      for (std::size_t q = 0; q < points; ++q) {
        const double weight = sign * rule_.w[q] * width_ / 2 * value[q * cells() + cell];
        const double *a = table(row.field, row.space, q), *b = table(column.field, column.space, q);
        for (std::size_t i = 0; i < r.size(); ++i)
          for (std::size_t j = 0; j < c.size(); ++j) local[i * local_ + j] += weight * a[i] * b[j];
      }
      for (std::size_t i = 0; i < r.size(); ++i)
        for (std::size_t j = 0; j < c.size(); ++j)
          to.at(index(row.field, cell, i), index(column.field, cell, j)) += local[i * local_ + j];
      if (!row.rate || column.rate) continue;
      for (std::size_t i = 0; i < r.size(); ++i)
        for (std::size_t j = 0; j < c.size(); ++j)
          out.a.at(index(row.field, cell, i), index(column.field, cell, j)) += local[i * local_ + j];
    }
  }
  return out;
}

double GalerkinMesh::energy(double& size) {
  for (std::size_t i = 0; i < form_.inputs.size(); ++i)
    std::copy_n(series_.input(i, 0), lanes(), energies_.input(i, 0));
  energies_.advance(0);
  const double* density = energies_.root(0, 0);
  std::vector<double> terms(density, density + lanes()), sizes(lanes());
  for (std::size_t n = 0; n < lanes(); ++n) sizes[n] = std::abs(density[n]);
  size = integral(sizes);
  return integral(terms);
}

double GalerkinMesh::integral(const std::vector<double>& f) const {
  CarefulSum sum;
  for (std::size_t n = 0; n < f.size(); ++n) sum.add(weight(n) * f[n]);
  return sum.value();
}

void GalerkinMesh::project(std::size_t field, const std::vector<Expr>& derivatives, double* c,
                           std::string& trouble) const {
  const Element& e = elements_[field];
  const GaussRule fine(2 * e.degree() + 4);
  const RepeatedEvaluation at(derivatives);
  const auto values_at = [&](double x) {
    std::vector<double> out = at([&](Expr symbol) { return symbol == x_ ? x : values_.at(symbol); });
    for (const double value : out)
      if (!std::isfinite(value)) trouble = "start";
    return out;
  };
  std::vector<double> highest(fine.x.size()), inner(e.inner());
  for (std::size_t cell = 0; cell < cells(); ++cell) {
    for (int side = 0; side < 2; ++side) {
      const std::vector<double> v =
          values_at(left_ + width_ * static_cast<double>(cell + static_cast<std::size_t>(side)));
      for (std::size_t k = 0; k < e.at_end(); ++k)
        c[index(field, cell, static_cast<std::size_t>(side) * e.at_end() + k)] = v[k] * (k == 1 ? width_ / 2 : 1);
    }
    for (std::size_t q = 0; q < fine.x.size(); ++q)
      highest[q] = values_at(left_ + width_ * (static_cast<double>(cell) + 0.5 * (1 + fine.x[q])))[e.at_end()] *
                   std::pow(width_ / 2, static_cast<double>(e.at_end()));
    e.project(fine, highest, inner.data());
    for (std::size_t i = 0; i < e.inner(); ++i) c[index(field, cell, 2 * e.at_end() + i)] = inner[i];
  }
}

double GalerkinMesh::value(const double* c, std::size_t field, int derivatives, double x) const {
  const Element& e = elements_[field];
  const double place = (x - left_) / width_;
  const int cell = std::clamp(static_cast<int>(std::floor(place + 1e-9)), 0, cells_ - 1);
  std::vector<double> n(e.size());
  e.at(2 * (place - cell) - 1, derivatives, n.data());
  double out = 0;
  for (std::size_t i = 0; i < e.size(); ++i) out += n[i] * c[index(field, static_cast<std::size_t>(cell), i)];
  return out * std::pow(2 / width_, derivatives);
}

std::size_t GalerkinMesh::end_coefficient(std::size_t field, bool right, int space) const {
  const auto k = static_cast<std::size_t>(space);
  return right ? index(field, cells() - 1, elements_[field].at_end() + k) : index(field, 0, k);
}

double GalerkinMesh::largest_end(const double* c, std::size_t field) const {
  double out = 0;
  for (std::size_t cell = 0; cell < cells(); ++cell)
    for (const std::size_t i : {std::size_t{0}, elements_[field].at_end()})
      out = std::max(out, std::abs(c[index(field, cell, i)]));
  return out;
}

std::vector<std::size_t> GalerkinMesh::fields_of_coefficients() const {
  std::vector<std::size_t> out(size_, 0);
  for (std::size_t cell = 0; cell < cells(); ++cell)
    for (std::size_t f = 0; f < fields_; ++f)
      for (std::size_t i = 0; i < elements_[f].size(); ++i) out[index(f, cell, i)] = f;
  return out;
}

bool GalerkinMesh::is_rough(const std::vector<double>& c) const {
  double all = 0, slow = 0;
  for (std::size_t f = 0; f < fields_; ++f) {
    const Element& e = elements_[f];
    for (std::size_t cell = 0; cell < cells(); ++cell) {
      double mean = 0;
      for (std::size_t q = 0; q < rule_.x.size(); ++q) {
        const double* n = table(f, 0, q);
        double u = 0;
        for (std::size_t i = 0; i < e.size(); ++i) u += n[i] * c[index(f, cell, i)];
        mean += rule_.w[q] / 2 * u, all += rule_.w[q] / 2 * u * u;
      }
      slow += mean * mean;
    }
  }
  constexpr double little = 0.05;
  return slow < little * all;
}

std::vector<double> GalerkinMesh::constant(std::size_t field) const {
  std::vector<double> out(size_, 0);
  for (std::size_t cell = 0; cell < cells(); ++cell)
    for (const std::size_t i : {std::size_t{0}, elements_[field].at_end()}) out[index(field, cell, i)] = 1;
  return out;
}

// ------------------------------------------------------------------------------------------------ the density's form

namespace {

void run_unsupported(Diagnostics& diagnostics, Span span, const std::string& what) {
  diagnostics.error("E0508", span, "not supported yet: a run of " + what,
                    "Runs are those of fields of one space variable on a bounded domain.",
                    "`maup derive`, `maup invariants` and expectations about formulas work for all fields.");
}

struct FormBuilder {
  const FieldEquations& equations;
  Diagnostics& diagnostics;
  const FieldSystem& s;
  ExprMap given;
  DensityForm out;
  Expr density, dissipation;

  Expr plain(Expr e) const { return s.expanded(substitute(s.expanded(e), given)); }
  Expr jet(std::size_t varied, int space, bool rate) const {
    return s.jet_symbol({equations.varied[varied], {space}, rate ? 1 : 0});
  }

  bool supported() {
    if (s.space.size() != 1)
      return run_unsupported(diagnostics, s.density_span, "fields of several space variables"), false;
    if (!s.space.front().from) return run_unsupported(diagnostics, s.density_span, "a field without a domain"), false;
    for (std::size_t f = 0; f < s.fields.size(); ++f) {
      if (!s.fields[f].given) continue;
      if (!s.fields[f].formula)
        return run_unsupported(diagnostics, s.fields[f].span, "an input without a formula"), false;
      given[s.jet_symbol({f, {0}, 0})] = s.fields[f].formula;
    }
    return true;
  }

  void slots() {
    std::vector<Expr> all{density, dissipation};
    for (const Expr& f : s.forces)
      if (f) all.push_back(plain(f));
    const std::size_t n = equations.varied.size();
    out.smooth.assign(n, false);
    for (const Expr& e : all)
      for (const Expr& symbol : s.jets_in(e)) {
        const FieldJet j = *s.jet_of(symbol);
        for (std::size_t a = 0; a < n; ++a)
          if (equations.varied[a] == j.field && j.space[0] > 1) out.smooth[a] = true;
      }
    // A field whose u_tx has a kinetic energy has slopes of its own too: its highest derivatives are those of a beam.
    for (std::size_t a = 0; a < n; ++a)
      for (const bool rate : {false, true})
        for (int k = 0; k <= (out.smooth[a] && !rate ? 2 : 1); ++k)
          out.slots.push_back({a, k, rate, false, jet(a, k, rate)});
    for (const DensityForm::Slot& slot : out.slots) out.inputs.push_back(slot.jet);
    out.inputs.push_back(s.space.front().symbol);
    out.inputs.push_back(s.context->time());
  }

  void derivatives() {
    std::vector<Expr> energy{-density};
    for (const DensityForm::Slot& slot : out.slots) {
      Expr e = differentiate(density, slot.jet);
      if (slot.rate) {
        energy.push_back(slot.jet * e);
      } else {
        if (slot.space < 2) e = e - differentiate(dissipation, jet(slot.field, slot.space, true));
        if (const Expr f = s.forces[equations.varied[slot.field]]; slot.space == 0 && f) e = e + plain(f);
      }
      out.by_slot.push_back(e);
    }
    out.energy = s.context->sum(energy);
    const std::vector<Expr> standing = symbols_of(out.by_slot);
    for (DensityForm::Slot& slot : out.slots)
      slot.stands = std::find(standing.begin(), standing.end(), slot.jet) != standing.end();
    out.linear = out.steady = true;
    out.first_order.assign(out.smooth.size(), true);
    for (std::size_t row = 0; row < out.slots.size(); ++row)
      for (std::size_t column = 0; column < out.slots.size(); ++column) {
        const Expr value = differentiate(out.by_slot[row], out.slots[column].jet);
        if (value.is_zero()) continue;
        out.hessian.push_back({row, column, value});
        if (out.slots[row].rate && out.slots[column].rate) out.first_order[out.slots[row].field] = false;
        const bool changes = holds_jets_or_time(s, value);
        out.linear = out.linear && !changes;
        out.steady = out.steady && !(changes && (out.slots[row].rate || out.slots[column].rate));
      }
  }

  bool well_formed() {
    std::vector<bool> moves(out.smooth.size(), false);
    for (const DensityForm::Entry& e : out.hessian) {
      const DensityForm::Slot &row = out.slots[e.row], &column = out.slots[e.column];
      if (row.rate) moves[row.field] = true, moves[column.field] = true;
      if (row.rate && out.first_order[row.field] && holds_jets_or_time(s, e.value))
        return run_unsupported(diagnostics, s.density_span,
                               "a density whose part linear in the velocities has coefficients that change"),
               false;
    }
    for (std::size_t a = 0; a < moves.size(); ++a)
      if (!moves[a]) {
        diagnostics.error("E0642", s.density_span,
                          "the motion of " + s.fields[equations.varied[a]].name + " is not determined",
                          "No equation holds its derivative by t.",
                          "`maup derive` shows them; eliminate it, or give it a part in the kinetic energy.");
        return false;
      }
    for (const FieldStart& start : equations.model->start)
      for (std::size_t a = 0; a < moves.size(); ++a)
        if (start.order == 1 && equations.varied[a] == start.field && out.first_order[a]) {
          diagnostics.error("E0642", start.span,
                            "the velocity of " + s.fields[start.field].name + " cannot be chosen at the start",
                            "The density is linear in the velocities: its equations are of first order, and the field "
                            "alone determines how it goes on.",
                            "Leave it out.");
          return false;
        }
    return true;
  }
};

}  // namespace

bool needs_collocation(const FieldEquations& equations) {
  const FieldSystem& s = equations.system();
  if (s.space.size() != 1) return false;
  const Expr density = s.expanded(s.density);
  const std::vector<Expr> jets = s.jets_in(density);
  for (const Expr& symbol : jets)
    if (s.jet_of(symbol)->order() > 1) return true;
  for (const std::size_t f : equations.varied) {
    const Expr p = differentiate(density, s.jet_symbol({f, {0}, 1}));
    bool squared = false;
    for (const Expr& symbol : jets)
      squared = squared || (s.jet_of(symbol)->time > 0 && !differentiate(p, symbol).is_zero());
    if (!squared) return true;
  }
  return false;
}

std::optional<DensityForm> density_form(const FieldEquations& equations, Diagnostics& diagnostics) {
  FormBuilder b{equations, diagnostics, equations.system(), {}, {}, {}, {}};
  if (!b.supported()) return std::nullopt;
  const FieldSystem& s = equations.system();
  b.density = b.plain(s.density);
  b.dissipation = s.dissipation ? b.plain(s.dissipation) : s.context->number(0);
  b.slots();
  b.derivatives();
  if (!b.well_formed()) return std::nullopt;
  bool forced =
      !b.dissipation.is_zero() || !differentiate(b.density, s.context->time()).is_zero() || !s.end_forces.empty();
  for (const Expr& f : s.forces) forced = forced || static_cast<bool>(f);
  for (const BoundaryCondition& c : s.boundary) forced = forced || s.context->depends_on_time(c.value.id());
  b.out.conserves = !forced;
  return std::move(b.out);
}

}  // namespace maupertuis
