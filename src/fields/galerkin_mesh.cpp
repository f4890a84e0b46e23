#include "fields/galerkin_mesh.hpp"

#include <maupertuis/evaluate.hpp>
#include <maupertuis/repeated_evaluation.hpp>

#include "fields/wide_lanes.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace maupertuis {

GalerkinMesh::GalerkinMesh(const FieldEquations& equations, const DensityForm& form, const std::vector<int>& cells,
                           int degree, const Bindings& values, std::string& trouble)
    : s_(equations.system()), form_(form), fields_(form.smooth.size()), values_(values) {
  for (std::size_t i = 0; i < s_.space.size(); ++i)
    axes_[i] = MeshAxis(evaluate(s_.expanded(s_.space[i].from), values), evaluate(s_.expanded(s_.space[i].to), values),
                        cells[i], degree, s_.periodic(i), s_.space.size() > 1);
  for (std::size_t f = 0; f < fields_; ++f) local_ = std::max(local_, functions(f));
  number_coefficients();
  add_products();
  for (const DensityForm::Slot& slot : form.slots) {
    tables_.push_back(table_of(slot.field, slot.space));
    for (std::size_t d = 0; d < 2; ++d) loads_[d].push_back(loads_along(d, form.smooth[slot.field], slot.space[d]));
  }
  for (std::size_t point = 0; point < points(); ++point)
    for (std::size_t cell = 0; cell < this->cells(); ++cell) {
      places_[0].push_back(axes_[0].point(cell % axes_[0].cells(), point % axes_[0].points()));
      places_[1].push_back(axes_[1].point(cell / axes_[0].cells(), point / axes_[0].points()));
    }
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
    lanes->resize(this->lanes(), 1);
    for (std::size_t i = 0; i < s_.space.size(); ++i)
      std::copy(places_[i].begin(), places_[i].end(), lanes->input(form.slots.size() + i, 0));
  }
}

/// Line by line, the lines along the direction with fewer functions, so that the matrices have a narrow band:
///
///     y ↑  3 — 7 — 11 …      in each place of a line the fields one after the other, of each what stands there (the
///       |  2 — 6 — 10        value and slopes at a node, all inner functions between nodes)
///          1 — 5 —  9  → x
void GalerkinMesh::number_coefficients() {
  const std::size_t slow = axes_[0].cells() < axes_[1].cells() ? 1 : 0, fast = 1 - slow;
  using Key = std::array<std::uint32_t, 5>;  // ranks along both, the field, which of those there along both
  std::vector<Key> keys;
  for (std::size_t cell = 0; cell < cells(); ++cell)
    for (std::size_t f = 0; f < fields_; ++f)
      for (std::size_t i = 0; i < functions(f); ++i) {
        const std::size_t of_cell[] = {cell % axes_[0].cells(), cell / axes_[0].cells()};
        const std::size_t of_function[] = {i % along(f, 0), i / along(f, 0)};
        const auto number = [&](std::size_t d) { return axes_[d].number(form_.smooth[f], of_cell[d], of_function[d]); };
        const MeshAxis::Number a = number(slow), b = number(fast);
        keys.push_back({a.rank, b.rank, static_cast<std::uint32_t>(f), a.own, b.own});
      }
  std::vector<Key> sorted = keys;
  std::sort(sorted.begin(), sorted.end());
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  size_ = sorted.size();
  map_.assign(cells() * fields_ * local_, 0);
  std::size_t next = 0;
  std::vector<std::vector<std::size_t>> of_cells(cells());
  for (std::size_t cell = 0; cell < cells(); ++cell)
    for (std::size_t f = 0; f < fields_; ++f)
      for (std::size_t i = 0; i < functions(f); ++i) {
        const auto at = std::lower_bound(sorted.begin(), sorted.end(), keys[next++]);
        const auto number = static_cast<std::size_t>(at - sorted.begin());
        map_[(cell * fields_ + f) * local_ + i] = number;
        of_cells[cell].push_back(number);
      }
  pattern_ = std::make_shared<SparsityPattern>(SparsityPattern::of_groups(size_, of_cells));
}

std::vector<double> GalerkinMesh::table_of(std::size_t field, const std::array<int, 2>& space) const {
  const bool smooth = form_.smooth[field];
  const std::vector<double>&x = axes_[0].table(smooth, space[0]), &y = axes_[1].table(smooth, space[1]);
  const std::size_t nx = along(field, 0), ny = along(field, 1);
  std::vector<double> out;
  for (std::size_t q = 0; q < axes_[1].points(); ++q)
    for (std::size_t p = 0; p < axes_[0].points(); ++p)
      for (std::size_t j = 0; j < ny; ++j)
        for (std::size_t i = 0; i < nx; ++i) out.push_back(x[p * nx + i] * y[q * ny + j]);
  return out;
}

std::vector<double> GalerkinMesh::loads_along(std::size_t direction, bool smooth, int k) const {
  const MeshAxis& axis = axes_[direction];
  const std::vector<double>& table = axis.table(smooth, k);
  const std::size_t n = axis.size(smooth);
  std::vector<double> out(table.size());
  for (std::size_t p = 0; p < axis.points(); ++p)
    for (std::size_t i = 0; i < n; ++i) out[i * axis.points() + p] = axis.weight(p) * table[p * n + i];
  return out;
}

std::vector<double> GalerkinMesh::loads_of(std::size_t field, const std::vector<double>& table) const {
  const std::size_t n = functions(field);
  std::vector<double> out(table.size());
  for (std::size_t q = 0; q < points(); ++q)
    for (std::size_t i = 0; i < n; ++i) out[i * points() + q] = point_weight(q) * table[q * n + i];
  return out;
}

namespace {

/// to_r = Σ_m c_rm from_m for n cells, of `count` rows from_m; where rows begin is so far apart, and the from_m may be
/// read up to whole vectors. Four rows at a time, whose sums do not wait for each other.
MAUP_LANES void combine(double* to, std::size_t to_row, std::size_t rows, const double* from, std::size_t from_row,
                        std::size_t count, const double* c, std::size_t n) {
  for (std::size_t i = 0; i < n; i += kWide)
    for (std::size_t r = 0; r < rows; r += 4) {
      Lanes sum[4] = {};
      const double* factors[4];
      for (std::size_t k = 0; k < 4; ++k) factors[k] = c + std::min(r + k, rows - 1) * count;
      for (std::size_t m = 0; m < count; ++m) {
        const Lanes x = lanes_at(from + m * from_row + i);
        for (std::size_t k = 0; k < 4; ++k) sum[k] += factors[k][m] * x;
      }
      for (std::size_t k = 0; k < std::min<std::size_t>(4, rows - r); ++k) {
        double* const out = to + (r + k) * to_row + i;
        if (i + kWide <= n)
          lanes_at(out) = sum[k];
        else
          for (std::size_t cell = 0; cell < n - i; ++cell) out[cell] = sum[k][cell];
      }
    }
}

/// to_ij += w a_i b_j, where rows begin so far apart.
MAUP_LANES void add_outer_product(double* __restrict to, std::size_t row, double w, std::span<const double> a,
                                  std::span<const double> b) {
  const double* const factors = b.data();
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double factor = w * a[i];
    double* __restrict const out = to + i * row;
    for (std::size_t j = 0; j < b.size(); ++j) out[j] += factor * factors[j];
  }
}

/// Cells that are taken together: what they need stays in the cache.
constexpr std::size_t group_of_cells = 64;
static_assert(group_of_cells % kWide == 0);

/// Σ_j y_qj (Σ_i x_pi from_ij) for a group of cells: one direction after the other, as functions and points are
/// products of those along x and y. [points p, q] of [functions i, j], or the other way round.
class ProductOfDirections {
 public:
  ProductOfDirections(const std::array<std::size_t, 2>& from, const std::array<std::size_t, 2>& to)
      : from_(from), to_(to), between_(to[0] * from[1] * group_of_cells) {}

  void operator()(double* to, std::size_t to_row, const double* from, const double* x, const double* y, std::size_t n) {
    constexpr std::size_t row = group_of_cells;
    for (std::size_t j = 0; j < from_[1]; ++j)
      combine(between_.data() + j * to_[0] * row, row, to_[0], from + j * from_[0] * row, row, from_[0], x, n);
    for (std::size_t p = 0; p < to_[0]; ++p)
      combine(to + p * to_row, to_[0] * to_row, to_[1], between_.data() + p * row, to_[0] * row, from_[1], y, n);
  }

 private:
  std::array<std::size_t, 2> from_, to_;
  std::vector<double> between_;
};

}  // namespace

/// Derivatives along a direction are taken of differences: what stands at the right ends of elements becomes its
/// distance from the left ones, these become 0, so that rounding of a large constant does not enter slopes.
void GalerkinMesh::take_differences(double* local, std::size_t field, std::size_t direction) const {
  constexpr std::size_t row = group_of_cells;
  const std::size_t other = 1 - direction;
  const std::size_t step = direction == 0 ? 1 : along(field, 0), line = direction == 0 ? along(field, 0) : 1;
  const std::size_t right = axes_[direction].at_end(form_.smooth[field]) * step;
  for (std::size_t k = 0; k < along(field, other); ++k) {
    double *l = local + k * line * row, *r = l + right * row;
    for (std::size_t cell = 0; cell < row; ++cell) r[cell] -= l[cell], l[cell] = 0;
  }
}

void GalerkinMesh::set(const double* c, const double* rates, double t, bool all) {
  for (std::size_t slot = 0; slot < form_.slots.size(); ++slot)
    if (form_.slots[slot].stands || all) set_jet(slot, form_.slots[slot].rate ? rates : c);
  std::fill_n(series_.input(form_.inputs.size() - 1, 0), lanes(), t);
  series_.advance(0);
}

void GalerkinMesh::set_jet(std::size_t slot, const double* c) {
  const DensityForm::Slot& s = form_.slots[slot];
  const bool smooth = form_.smooth[s.field];
  const std::size_t n = cells(), count = functions(s.field);
  std::vector<double> local(count * group_of_cells);
  ProductOfDirections product({along(s.field, 0), along(s.field, 1)}, {axes_[0].points(), axes_[1].points()});
  for (std::size_t first = 0; first < n; first += group_of_cells) {
    const std::size_t group = std::min(group_of_cells, n - first);
    for (std::size_t cell = 0; cell < group; ++cell)
      for (std::size_t i = 0; i < count; ++i) local[i * group_of_cells + cell] = c[index(s.field, first + cell, i)];
    for (std::size_t d = 0; d < 2; ++d)
      if (s.space[d] > 0) take_differences(local.data(), s.field, d);
    product(series_.input(slot, 0) + first, n, local.data(), axes_[0].table(smooth, s.space[0]).data(),
            axes_[1].table(smooth, s.space[1]).data(), group);
  }
}

void GalerkinMesh::assemble(double* out, bool rates) const {
  std::fill_n(out, size_, 0.0);
  for (std::size_t slot = 0; slot < form_.slots.size(); ++slot)
    if (form_.slots[slot].rate == rates && !form_.by_slot[slot].is_zero()) add_loads(slot, out);
}

void GalerkinMesh::add_loads(std::size_t slot, double* out) const {
  const std::size_t field = form_.slots[slot].field, n = cells(), count = functions(field);
  std::vector<double> local(count * group_of_cells), roots(points() * group_of_cells);
  ProductOfDirections product({axes_[0].points(), axes_[1].points()}, {along(field, 0), along(field, 1)});
  for (std::size_t first = 0; first < n; first += group_of_cells) {
    const std::size_t group = std::min(group_of_cells, n - first);
    for (std::size_t q = 0; q < points(); ++q)
      std::copy_n(series_.root(slot, 0) + q * n + first, group, roots.data() + q * group_of_cells);
    product(local.data(), group_of_cells, roots.data(), loads_[0][slot].data(), loads_[1][slot].data(), group);
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t cell = 0; cell < group; ++cell)
        out[index(field, first + cell, i)] += local[i * group_of_cells + cell];
  }
}

void GalerkinMesh::momenta(double* out) const { assemble(out, true); }
void GalerkinMesh::forces(double* out) const { assemble(out, false); }

GalerkinMesh::Matrices GalerkinMesh::matrices() {
  for (std::size_t i = 0; i < form_.inputs.size(); ++i) std::copy_n(series_.input(i, 0), lanes(), hessian_.input(i, 0));
  hessian_.advance(0);
  Matrices out{MeshMatrix<double>(pattern_), MeshMatrix<double>(pattern_), MeshMatrix<double>(pattern_),
               MeshMatrix<double>(pattern_)};
  std::vector<double> local(local_ * local_);
  for (std::size_t k = 0; k < form_.hessian.size(); ++k) {
    const std::size_t first = form_.hessian[k].row, second = form_.hessian[k].column;
    const DensityForm::Slot &row = form_.slots[first], &column = form_.slots[second];
    const std::size_t rows = functions(row.field), columns = functions(column.field);
    MeshMatrix<double>& to = row.rate ? (column.rate ? out.m : out.g) : column.rate ? out.g : out.k;
    const double sign = row.rate ? 1 : -1;
    const double* value = hessian_.root(k, 0);
    for (std::size_t cell = 0; cell < cells(); ++cell) {
      std::fill(local.begin(), local.end(), 0.0);
      for (std::size_t q = 0; q < points(); ++q) {
        const double weight = sign * point_weight(q) * value[q * cells() + cell];
        const double *a = table(first, q), *b = table(second, q);
        add_outer_product(local.data(), local_, weight, {a, rows}, {b, columns});
      }
      const auto add_to = [&](MeshMatrix<double>& matrix) {
        for (std::size_t i = 0; i < rows; ++i)
          for (std::size_t j = 0; j < columns; ++j)
            matrix.at(index(row.field, cell, i), index(column.field, cell, j)) += local[i * local_ + j];
      };
      add_to(to);
      if (row.rate && !column.rate) add_to(out.a);
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

// --------------------------------------------------------------------------------------------- functions →
// coefficients

void GalerkinMesh::project(std::size_t field, Expr f, double* c, std::string& trouble) const {
  const bool smooth = form_.smooth[field];
  const std::vector<MeshAxis::Sample>&xs = axes_[0].samples(smooth), &ys = axes_[1].samples(smooth);
  const std::vector<double>&px = axes_[0].projection(smooth), &py = axes_[1].projection(smooth);
  std::vector<std::vector<RepeatedEvaluation>> at(3);  // [by y][by x]
  Expr by_y = f;
  for (std::size_t ky = 0; ky <= axes_[1].at_end(smooth); ++ky) {
    if (ky > 0) by_y = differentiate(by_y, s_.space[1].symbol);
    Expr derivative = by_y;
    for (std::size_t kx = 0; kx <= axes_[0].at_end(smooth); ++kx) {
      if (kx > 0) derivative = differentiate(derivative, s_.space[0].symbol);
      at[ky].emplace_back(std::span<const Expr>(&derivative, 1));
    }
  }
  const auto value = [&](const MeshAxis::Sample& i, const MeshAxis::Sample& j, std::size_t cell) {
    const double place[] = {axes_[0].place(cell % axes_[0].cells(), i.xi),
                            axes_[1].place(cell / axes_[0].cells(), j.xi)};
    const double out =
        at[static_cast<std::size_t>(j.derivative)][static_cast<std::size_t>(i.derivative)]([&](Expr symbol) {
          for (std::size_t d = 0; d < s_.space.size(); ++d)
            if (symbol == s_.space[d].symbol) return place[d];
          return values_.at(symbol);
        }).front();
    if (!std::isfinite(out)) trouble = "start";
    return out;
  };
  const std::size_t nx = along(field, 0), ny = along(field, 1);
  for (std::size_t cell = 0; cell < cells(); ++cell) {
    std::vector<double> lines(nx * ys.size(), 0), row(xs.size());  // functions along x at the samples along y
    for (std::size_t j = 0; j < ys.size(); ++j) {
      for (std::size_t i = 0; i < xs.size(); ++i) row[i] = value(xs[i], ys[j], cell);
      for (std::size_t k = 0; k < nx; ++k)
        for (std::size_t i = 0; i < xs.size(); ++i) lines[k * ys.size() + j] += px[k * xs.size() + i] * row[i];
    }
    for (std::size_t l = 0; l < ny; ++l)
      for (std::size_t k = 0; k < nx; ++k) {
        double sum = 0;
        for (std::size_t j = 0; j < ys.size(); ++j) sum += py[l * ys.size() + j] * lines[k * ys.size() + j];
        c[index(field, cell, l * nx + k)] = sum;
      }
  }
}

double GalerkinMesh::value(const double* c, std::size_t field, const FieldJet& jet,
                           const std::vector<double>& place) const {
  std::vector<double> n[2];
  std::size_t cell[2];
  for (std::size_t d = 0; d < 2; ++d) {
    const bool there = d < place.size();
    cell[d] = axes_[d].at(form_.smooth[field], there ? jet.space[d] : 0, there ? place[d] : 0, n[d]);
  }
  double out = 0;
  for (std::size_t j = 0; j < n[1].size(); ++j)
    for (std::size_t i = 0; i < n[0].size(); ++i)
      out += n[0][i] * n[1][j] * c[index(field, cell[1] * axes_[0].cells() + cell[0], j * n[0].size() + i)];
  return out;
}

// ------------------------------------------------------------------------------------------------------------ the
// sides

std::vector<std::size_t> GalerkinMesh::side_coefficients(std::size_t field, Side side, bool slope) const {
  const std::size_t d = across(side), other = 1 - d, nx = along(field, 0);
  const std::size_t cell_across = is_far(side) ? axes_[d].cells() - 1 : 0;
  const std::size_t function = (is_far(side) ? axes_[d].at_end(form_.smooth[field]) : 0) + (slope ? 1 : 0);
  std::vector<std::size_t> out;
  for (std::size_t along_side = 0; along_side < axes_[other].cells(); ++along_side)
    for (std::size_t k = 0; k < along(field, other); ++k) {
      const std::size_t cell =
          d == 0 ? along_side * axes_[0].cells() + cell_across : cell_across * axes_[0].cells() + along_side;
      out.push_back(index(field, cell, d == 0 ? k * nx + function : function * nx + k));
    }
  return out;
}

Expr GalerkinMesh::side_symbol(Side side) const {
  return s_.space.size() > 1 ? s_.space[1 - across(side)].symbol : Expr{};
}

std::vector<Expr> GalerkinMesh::derivatives_along(std::size_t field, Side side, Expr f) const {
  std::vector<Expr> out{f};
  for (std::size_t k = 0; k < axes_[1 - across(side)].at_end(form_.smooth[field]); ++k)
    out.push_back(differentiate(out.back(), side_symbol(side)));
  return out;
}

std::vector<double> GalerkinMesh::side_values(std::size_t field, Side side, const std::vector<Expr>& derivatives,
                                              double t) const {
  const Expr along_side = side_symbol(side);
  const RepeatedEvaluation at(derivatives);
  return axes_[1 - across(side)].project(form_.smooth[field], [&](int k, double x) {
    return at([&](Expr symbol) {
      return symbol == s_.context->time() ? t : along_side && symbol == along_side ? x : values_.at(symbol);
    })[static_cast<std::size_t>(k)];
  });
}

std::vector<double> GalerkinMesh::side_loads(std::size_t field, Side side, Expr f, double t) const {
  const MeshAxis& axis = axes_[1 - across(side)];
  const Expr along_side = side_symbol(side);
  const RepeatedEvaluation at(std::span<const Expr>(&f, 1));
  const std::vector<double>& table = axis.table(form_.smooth[field], 0);
  const std::size_t n = axis.size(form_.smooth[field]);
  std::vector<double> out(axis.cells() * n, 0);
  for (std::size_t cell = 0; cell < axis.cells(); ++cell)
    for (std::size_t q = 0; q < axis.points(); ++q) {
      const double x = axis.point(cell, q);
      const double load = axis.weight(q) * at([&](Expr symbol) {
                                             return symbol == s_.context->time()         ? t
                                                    : along_side && symbol == along_side ? x
                                                                                         : values_.at(symbol);
                                           }).front();
      for (std::size_t i = 0; i < n; ++i) out[cell * n + i] += load * table[q * n + i];
    }
  return out;
}

// -------------------------------------------------------------------------------------------------------- coefficients

/// The functions of a cell that are 1 at one of its corners.
std::vector<std::size_t> GalerkinMesh::values_at_ends(std::size_t field) const {
  std::vector<std::size_t> ends[2];
  for (std::size_t d = 0; d < 2; ++d) {
    ends[d] = {0};
    if (!axes_[d].is_point()) ends[d].push_back(axes_[d].at_end(form_.smooth[field]));
  }
  std::vector<std::size_t> out;
  for (const std::size_t j : ends[1])
    for (const std::size_t i : ends[0]) out.push_back(j * along(field, 0) + i);
  return out;
}

void GalerkinMesh::add_products() {
  products_ = MeshMatrix<double>(pattern_);
  field_of_.assign(size_, 0);
  for (std::size_t f = 0; f < fields_; ++f) {
    const std::vector<double> values = table_of(f, {0, 0}), loads = loads_of(f, values);
    const std::size_t n = functions(f);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) {
        double sum = 0;
        for (std::size_t q = 0; q < points(); ++q) sum += loads[i * points() + q] * values[q * n + j];
        for (std::size_t cell = 0; cell < cells(); ++cell) {
          field_of_[index(f, cell, i)] = f;
          products_.at(index(f, cell, i), index(f, cell, j)) += sum;
        }
      }
  }
}

std::vector<double> GalerkinMesh::squares(const std::vector<double>& c) const {
  std::vector<double> product(size_, 0), out(fields_, 0);
  products_.add_product(c.data(), product.data());
  for (std::size_t i = 0; i < size_; ++i) out[field_of_[i]] += c[i] * product[i];
  for (double& value : out) value = std::max(value, 0.0);  // rounding
  return out;
}

bool GalerkinMesh::is_rough(const std::vector<double>& c, const std::vector<std::size_t>& fixed) const {
  double all = 0, slow = 0;
  for (std::size_t f = 0; f < fields_; ++f) {
    const std::vector<double> values = table_of(f, {0, 0});
    double whole = 0, sum = 0;  // of the means
    for (std::size_t q = 0; q < points(); ++q) whole += point_weight(q);
    for (std::size_t cell = 0; cell < cells(); ++cell) {
      double mean = 0;
      for (std::size_t q = 0; q < points(); ++q) {
        double u = 0;
        for (std::size_t i = 0; i < functions(f); ++i) u += values[q * functions(f) + i] * c[index(f, cell, i)];
        mean += point_weight(q) / whole * u, all += point_weight(q) / whole * u * u;
      }
      slow += mean * mean, sum += mean;
    }
    if (std::find(fixed.begin(), fixed.end(), f) == fixed.end()) continue;
    const double constant = sum * sum / static_cast<double>(cells());
    slow -= constant, all -= constant;
  }
  constexpr double little = 0.05;
  return slow < little * all;
}

std::vector<double> GalerkinMesh::constant(std::size_t field) const {
  std::vector<double> out(size_, 0);
  for (std::size_t cell = 0; cell < cells(); ++cell)
    for (const std::size_t i : values_at_ends(field)) out[index(field, cell, i)] = 1;
  return out;
}

}  // namespace maupertuis
