#include "fields/plane_mesh.hpp"

#include "fields/end_slopes.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

/// What is read off the mesh of a plane between its steps: energy, values at places, points and sides of the domain.
namespace maupertuis {

using Side = BoundaryCondition::Side;

/// Coefficient 0 of all that ℒ depends on, of one row, as the inputs of the energy.
void PlaneMesh::show_row(std::size_t row) {
  for (std::size_t f = 0; f < fields_; ++f) {
    const std::size_t i = kInputs * f;
    const double *u = u_[f].data() + row * lanes_, *v = v_[f].data() + row * lanes_;
    std::copy_n(u, lanes_, energies_.input(i + Phi, 0));
    std::copy_n(v, lanes_, energies_.input(i + Velocity, 0));
    slopes(energies_.input(i + SlopeX, 0), energies_.input(i + SlopeY, 0), u);
    slopes(energies_.input(i + RateX, 0), energies_.input(i + RateY, 0), v);
  }
  for (std::size_t j = 0; j < points(); ++j)  // x is the same in all rows
    std::fill_n(energies_.input(kInputs * fields_ + 1, 0) + j * line_, line_, place(1, row, j * line_));
  std::fill_n(energies_.input(kInputs * fields_ + 2, 0), lanes_, t_);
}

double PlaneMesh::energy(double& size) {
  CarefulSum sum;
  size = 0;
  std::vector<double> weights(lanes_);
  for (std::size_t n = 0; n < lanes_; ++n) weights[n] = weight(n);
  for (std::size_t row = 0; row < rows(); ++row) {
    show_row(row);
    energies_.advance(0);
    for (std::size_t n = 0; n < lanes_; ++n) {
      const double term = weights[n] * energies_.root(0, 0)[n];
      sum.add(term);
      size += std::abs(term);
    }
  }
  return sum.value();
}

double PlaneMesh::field_at(std::size_t field, const FieldJet& jet, const std::vector<double>& place) const {
  if (jet.time > 1 || jet.space[0] + jet.space[1] > 1) return std::nan("");
  std::size_t cell[2];
  std::vector<double> factor[2];
  for (std::size_t i = 0; i < 2; ++i) {
    const double at = (place[i] - axes_[i].from) / axes_[i].width;
    const int e = std::clamp(static_cast<int>(std::floor(at + 1e-9)), 0, axes_[i].cells - 1);
    cell[i] = static_cast<std::size_t>(e);
    std::vector<double> value, slope;
    rule_.at(2 * (at - e) - 1, value, slope);
    factor[i] = jet.space[i] == 0 ? value : slope;
    if (jet.space[i] == 1)
      for (double& c : factor[i]) c *= 2 / axes_[i].width;
  }
  const double* values = (jet.time == 0 ? u_ : v_)[field].data() + cell[1] * lanes_;
  double out = 0;
  for (std::size_t j = 0; j < points(); ++j)
    for (std::size_t i = 0; i < points(); ++i)
      out += factor[1][j] * factor[0][i] * values[j * line_ + i * cells() + cell[0]];
  return out;
}

void PlaneMesh::visit_points(const PointVisitor& visit) {
  std::vector<double> values(form_.inputs.size());
  for (std::size_t row = 0; row < rows(); ++row) {
    show_row(row);
    for (std::size_t n = 0; n < lanes_; ++n) {
      for (std::size_t i = 0; i < values.size(); ++i) values[i] = energies_.input(i, 0)[n];
      visit(weight(n), values.data());
    }
  }
}

/// What ℒ depends on at one node of one element.
std::vector<double> PlaneMesh::inputs_at(std::size_t row, std::size_t lane) const {
  const std::size_t j = lane / line_, i = lane % line_ / cells(), cell = lane % cells();
  std::vector<double> out(form_.inputs.size(), 0);
  for (std::size_t f = 0; f < fields_; ++f)
    for (const std::size_t rate : {0, 1}) {
      const double* u = (rate ? v_ : u_)[f].data() + row * lanes_;
      const std::size_t first = kInputs * f + (rate ? RateX : SlopeX);
      out[kInputs * f + (rate ? Velocity : Phi)] = u[lane];
      for (std::size_t m = 0; m < points(); ++m) {
        const double *along_x = u + j * line_ + m * cells() + cell, *along_y = u + m * line_ + i * cells() + cell;
        out[first] += 2 / axes_[0].width * rule_.derivative[i * points() + m] * (*along_x - u[lane]);
        out[first + 1] += 2 / axes_[1].width * rule_.derivative[j * points() + m] * (*along_y - u[lane]);
      }
    }
  for (const std::size_t direction : {0, 1}) out[kInputs * fields_ + direction] = place(direction, row, lane);
  out[kInputs * fields_ + 2] = t_;
  return out;
}

/// Forces on the free fields of a side as what s is there: p + F = 0 on the far ones, −p + F = 0 on the near ones.
std::vector<double> PlaneMesh::given_stresses(Side side, std::size_t row, std::size_t lane) {
  std::vector<double> out(fields_, 0);
  const bool far = side == Side::Right || side == Side::Top;
  for (const Held& held : held_)
    if (held.force && held.side == side && !held.derivatives.front().is_zero())
      out[held.field] +=
          (far ? -1 : 1) * value_of(held.derivatives.front(), {{s_.context->time(), t_},
                                                               {s_.space[0].symbol, place(0, row, lane)},
                                                               {s_.space[1].symbol, place(1, row, lane)}});
  return out;
}

std::vector<bool> PlaneMesh::held_on(Side side) const {
  std::vector<bool> out(fields_, false);
  for (const Held& held : held_)
    if (!held.force && held.side == side) out[held.field] = true;
  return out;
}

/// Slopes across a side are those of the condition where a field is free, of the polynomials where it is held.
void PlaneMesh::visit_sides(const std::vector<Expr>& jets, const SideVisitor& visit) {
  std::vector<std::optional<std::size_t>> known;
  for (const Expr& jet : jets) {
    const auto at = std::find(form_.inputs.begin(), form_.inputs.end(), jet);
    known.push_back(at == form_.inputs.end() ? std::nullopt
                                             : std::optional(static_cast<std::size_t>(at - form_.inputs.begin())));
  }
  for (const std::size_t across : {0, 1})
    if (!side_slopes_[across] && !s_.periodic(across))
      side_slopes_[across] = std::make_shared<EndSlopes>(form_, equations_.model->parameters, across);
  std::vector<double> values(jets.size() + 3);
  const auto at = [&](Side side, const std::vector<bool>& kept, std::size_t row, std::size_t lane) {
    const std::size_t along = side == Side::Left || side == Side::Right ? 0 : 1;
    std::vector<double> inputs = inputs_at(row, lane);
    if (side_slopes_[along] && std::find(kept.begin(), kept.end(), false) != kept.end())
      side_slopes_[along]->solve(inputs, given_stresses(side, row, lane), kept);
    for (std::size_t i = 0; i < jets.size(); ++i) values[i] = known[i] ? inputs[*known[i]] : std::nan("");
    std::copy(inputs.end() - 3, inputs.end(), values.end() - 3);  // x, y, t
    const std::size_t node = along == 0 ? lane / line_ : lane % line_ / cells();
    const bool far = side == Side::Right || side == Side::Top;
    visit({along, far, rule_.w[node] * axes_[1 - along].width / 2}, values.data());
  };
  const std::vector<bool> left = held_on(Side::Left), right = held_on(Side::Right), bottom = held_on(Side::Bottom),
                          top = held_on(Side::Top);
  for (std::size_t row = 0; row < rows(); ++row)
    for (std::size_t j = 0; j < points(); ++j)
      at(Side::Left, left, row, j * line_), at(Side::Right, right, row, (j + 1) * line_ - 1);
  for (std::size_t i = 0; i < line_; ++i)
    at(Side::Bottom, bottom, 0, i), at(Side::Top, top, rows() - 1, lanes_ - line_ + i);
}

}  // namespace maupertuis
