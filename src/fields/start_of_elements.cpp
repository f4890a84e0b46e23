#include <maupertuis/coupled_fields.hpp>
#include <maupertuis/evaluate.hpp>

#include "fields/resting_fields.hpp"
#include "fields/semi_discrete.hpp"
#include "fields/written_start.hpp"
#include "linear_algebra/dense.hpp"

#include <algorithm>
#include <cmath>

/// The start of elements beside bodies: what bodies hold of a field starts as it is written, the rest of the elements
/// comes as near to the start as they can.
namespace maupertuis {

WrittenStart::WrittenStart(const FieldEquations& equations, std::size_t varied, int order, const Bindings& parameters)
    : x_(equations.system().space.front().symbol), parameters_(parameters) {
  const FieldSystem& s = equations.system();
  Expr value = s.context->number(0);
  for (const FieldStart& one : equations.model->start)
    if (one.field == equations.varied[varied] && one.order == order)
      value = s.expanded(one.value), span_ = one.span, is_written_ = true;
  const Expr slope = differentiate(value, x_);
  derivatives_.emplace_back(std::span(&value, 1));
  derivatives_.emplace_back(std::span(&slope, 1));
}

double WrittenStart::at(double x, int by_space) const {
  const auto value_of = [&](Expr symbol) { return symbol == x_ ? x : parameters_.at(symbol); };
  return derivatives_[static_cast<std::size_t>(by_space)](value_of).front();
}

namespace {

using Side = BoundaryCondition::Side;
using Kept = std::vector<std::optional<double>>;  // by degree of freedom

constexpr double rounding_of_zero = 4e-16;  // of the size of a start: what sin π is beside 1

double largest(const std::vector<double>& values) {
  double out = 0;
  for (const double v : values) out = std::max(out, std::abs(v));
  return out;
}

/// At the points of the elements; sin π is rounding, which must not violate a contact that the field touches.
std::vector<double> at_points(const WrittenStart& start, const ElementSpace& space) {
  std::vector<double> out;
  for (const ElementSpace::Point& p : space.points()) out.push_back(start.at(p.x));
  const double size = largest(out);
  for (double& v : out) v = std::abs(v) <= rounding_of_zero * size ? 0 : v;
  return out;
}

/// The coefficients of functions that are not kept come nearest to a function in the mean square.
std::vector<double> nearest(const ElementSpace& space, const std::vector<double>& function, const Kept& kept) {
  const std::vector<ElementSpace::Point>& points = space.points();
  const auto n = static_cast<Eigen::Index>(space.size());
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(n);
  for (std::size_t q = 0; q < points.size(); ++q)
    for (const ElementSpace::Part& i : points[q].parts) {
      b(static_cast<Eigen::Index>(i.dof)) += points[q].weight * i.of[0] * function[q];
      for (const ElementSpace::Part& j : points[q].parts)
        m(static_cast<Eigen::Index>(i.dof), static_cast<Eigen::Index>(j.dof)) += points[q].weight * i.of[0] * j.of[0];
    }
  for (Eigen::Index j = 0; j < n; ++j) {
    const auto& value = kept[static_cast<std::size_t>(j)];
    if (!value) continue;
    b -= m.col(j) * *value;
    const double own = m(j, j);
    m.row(j).setZero(), m.col(j).setZero();
    m(j, j) = own, b(j) = own * *value;
  }
  // Slopes count as lengths of their elements do: without units of their own, pivots of short elements pass for zeros.
  const Eigen::VectorXd unit = m.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = unit.asDiagonal() * m * unit.asDiagonal();
  const Eigen::VectorXd solution = unit.asDiagonal() * Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(scaled).solve(
                                                           Eigen::VectorXd(unit.cwiseProduct(b)));
  std::vector<double> out(solution.data(), solution.data() + solution.size());
  for (std::size_t j = 0; j < out.size(); ++j) out[j] = kept[j].value_or(out[j]);
  return out;
}

/// The coefficients at the start: of nodes the values there, of other functions those nearest to the start.
std::vector<double> coefficients_at_start(const ElementSpace& space, const std::vector<double>& function,
                                          const Kept& kept) {
  if (space.kind() != ElementSpace::Kind::Nodal) return nearest(space, function, kept);
  std::vector<double> out(space.size(), 0);
  for (std::size_t q = 0; q < space.points().size(); ++q)
    for (const ElementSpace::Part& part : space.points()[q].parts)
      if (part.of[0] == 1) out[part.dof] = function[q];
  for (std::size_t j = 0; j < out.size(); ++j)
    if (kept[j]) out[j] = *kept[j];
  return out;
}

}  // namespace

bool SemiDiscrete::set_start(Diagnostics& diagnostics) {
  for (std::size_t a = 0; a < spaces_.size(); ++a)
    for (const int order : {0, 1}) {
      const WrittenStart start(*equations_, a, order, numbers_);
      const std::vector<double> function = at_points(start, spaces_[a]);
      if (!std::all_of(function.begin(), function.end(), [](double v) { return std::isfinite(v); })) {
        diagnostics.error("E0645", start.span(), "the start of a field is not a finite number somewhere in its domain",
                          "A run can only begin from definite values at all places.",
                          "Look for a logarithm or a root of a negative number in it, or a division by zero.");
        return false;
      }
      Kept kept = held_at_ends(a, order);
      look_for_clashes(a, order, start, largest(function), kept);
      keep_places(a, start, largest(function), kept);
      add_start(a, order, start.is_written(), coefficients_at_start(spaces_[a], function, kept));
    }
  return true;
}

/// What the conditions at the ends say of degrees of freedom that are no coordinates.
std::vector<std::optional<double>> SemiDiscrete::held_at_ends(std::size_t a, int order) const {
  Bindings at_start = numbers_;
  at_start[equations_->system().context->time()] = begin();
  Kept out(spaces_[a].size());
  for (std::size_t j = 0; j < out.size(); ++j)
    if (!coordinates_[a][j])
      out[j] = evaluate(order == 1 ? total_time_derivative(values_[a][j]) : values_[a][j], at_start);
  return out;
}

/// Values and slopes at the ends that the start has otherwise than their conditions. Into a field without any velocity
/// in its equation nothing runs.
void SemiDiscrete::look_for_clashes(std::size_t a, int order, const WrittenStart& start, double size,
                                    const std::vector<std::optional<double>>& held) {
  constexpr double rounding = 1e-9;
  constexpr double near = 1e-12, nearer = 1e-14, falls = 0.5;  // |x| has a slope beside its kink alone
  if (!moves(*equations_, equations_->varied[a])) return;
  const double whole = mesh_.borders.back() - mesh_.borders.front();
  const auto look = [&](bool right, int space, std::size_t dof, double largest_value) {
    if (!held[dof]) return;
    const auto beside = [&](double share) {
      const double away = space * share * whole;
      return start.at(right ? mesh_.borders.back() - away : mesh_.borders.front() + away, space);
    };
    const double value = beside(near), off = std::abs(*held[dof] - value);
    if (off <= rounding * std::max(largest_value, std::abs(*held[dof]))) return;
    // That of x^(3/2) falls to 0 at the end itself.
    if (std::abs(*held[dof] - beside(nearer)) <= falls * off) return;
    clashes_.push_back({a, space, order, right ? Side::Right : Side::Left, value, *held[dof]});
  };
  const bool is_smooth = spaces_[a].kind() == ElementSpace::Kind::Smooth;
  double steepest = 0;
  for (const ElementSpace::Point& p : spaces_[a].points())
    if (const double slope = is_smooth ? std::abs(start.at(p.x, 1)) : 0; std::isfinite(slope))
      steepest = std::max(steepest, slope);
  for (const bool right : {false, true}) {
    const std::size_t border = right ? mesh_.borders.size() - 1 : 0;
    look(right, 0, spaces_[a].value_at_border(border), size);
    if (is_smooth) look(right, 1, spaces_[a].slope_at_border(border), steepest);
  }
}

/// Values and slopes that bodies hold start as they are written, whatever the elements beside them can follow.
void SemiDiscrete::keep_places(std::size_t a, const WrittenStart& start, double size,
                               std::vector<std::optional<double>>& kept) const {
  for (const PlaceCoordinate& p : equations_->model->attached) {
    if (p.moves || p.jet.field != equations_->varied[a]) continue;
    const std::size_t dof = dof_at(a, p);
    const double value = start.at(number(p.place), p.jet.space[0]);
    if (kept[dof] || !std::isfinite(value)) continue;
    kept[dof] = p.jet.space[0] == 0 && std::abs(value) <= rounding_of_zero * size ? 0 : value;
  }
}

/// The start of what has no inertia is no choice, and gives way to that of the coordinates that it carries.
void SemiDiscrete::add_start(std::size_t a, int order, bool is_written, const std::vector<double>& coefficients) {
  const bool may_give_way = !moves(*equations_, equations_->varied[a]);
  for (std::size_t j = 0; j < coefficients.size(); ++j) {
    if (!coordinates_[a][j]) continue;
    StartValue v;
    v.coordinate = *coordinates_[a][j];
    v.order = order;
    v.value = constant(coefficients[j]);
    const Coordinate& c = model_.system.coordinates[v.coordinate];
    if (may_give_way && !(is_written && has_inertia(c))) v.span = c.span;
    model_.experiment.start.push_back(std::move(v));
  }
}

std::vector<SemiDiscrete::MovedStart> SemiDiscrete::moved_starts(const State& begin) const {
  constexpr double as_written = 1e-6;  // of a value; elements follow the shape of a rest to less where EI changes
  std::vector<MovedStart> out;
  if (begin.q.size() != model_.system.coordinates.size()) return out;
  for (std::size_t a = 0; a < spaces_.size(); ++a)
    for (const int order : {0, 1}) {
      const WrittenStart start(*equations_, a, order, numbers_);
      if (moves(*equations_, equations_->varied[a]) || !start.is_written()) continue;
      const MovedStart one = most_moved(a, order, start, begin);
      if (std::abs(one.found - one.written) > as_written * std::max(std::abs(one.found), std::abs(one.written)))
        out.push_back(one);
    }
  return out;
}

/// Where a field is farthest from what is written.
SemiDiscrete::MovedStart SemiDiscrete::most_moved(std::size_t a, int order, const WrittenStart& start,
                                                  const State& begin) const {
  constexpr double places[] = {0, 0.25, 0.5, 0.75, 1};  // of an element
  MovedStart out{a, order, 0, 0, 0};
  for (std::size_t e = 0; e < elements(); ++e)
    for (const double part : places) {
      const double x = mesh_.borders[e] + part * (mesh_.borders[e + 1] - mesh_.borders[e]);
      const double written = start.at(x), found = value_in(value_at(a, order, 0, x), begin);
      if (std::abs(found - written) > std::abs(out.found - out.written)) out = {a, order, x, written, found};
    }
  return out;
}

double SemiDiscrete::value_in(Expr value, const State& state) const { return evaluate(value, bindings_at(state)); }

Bindings SemiDiscrete::bindings_at(const State& state) const {
  Bindings at = numbers_;
  at[equations_->system().context->time()] = state.t;
  for (std::size_t i = 0; i < state.q.size(); ++i) {
    const Coordinate& c = model_.system.coordinates[i];
    at[c.q] = state.q[i], at[c.velocity] = state.v[i];
  }
  return at;
}

}  // namespace maupertuis
