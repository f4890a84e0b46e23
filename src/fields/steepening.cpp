#include "fields/steepening.hpp"

#include <maupertuis/evaluate.hpp>

#include "fields/element.hpp"
#include "linear_algebra/quadrature.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace maupertuis {
namespace {

constexpr double places_across[] = {0.13, 0.31, 0.5, 0.67,
                                    0.89};  // of lines through the plane, where fields are looked at

}  // namespace

bool SteepeningWatch::may_steepen(const FieldEquations& equations) {
  const FieldSystem& s = equations.system();
  const Expr density = s.expanded(s.density);
  std::vector<Expr> moving;  // velocities and slopes
  for (const Expr& jet : s.jets_in(density))
    if (s.jet_of(jet)->order() > 0) moving.push_back(jet);
  for (const Expr& a : moving)
    for (const Expr& b : moving)
      if (!s.jets_in(differentiate(differentiate(density, a), b)).empty()) return true;
  return false;
}

SteepeningWatch::SteepeningWatch(const FieldEquations& equations, std::vector<int> cells, int order)
    : equations_(equations), cells_(std::move(cells)), order_(order) {
  const FieldSystem& s = equations.system();
  Bindings values;
  for (const Parameter& p : equations.model->parameters) values[p.symbol] = p.si_value;
  for (const SpaceVariable& x : s.space) {
    from_.push_back(evaluate(s.expanded(x.from), values));
    width_.push_back(evaluate(s.expanded(x.to), values) - from_.back());
  }
  steepest_.assign(equations.varied.size() * width_.size(), 0);
}

/// The largest coefficient of the highest Legendre polynomial of φ_x (or of φ') on an element, beside the largest value
/// along all lines so far: fields go through rest, and what is far smaller than φ over the whole domain is rounding.
double SteepeningWatch::part_of_highest(const FieldMotion& mesh, std::size_t field, std::size_t along, bool rates) {
  const int degree = rates ? order_ : order_ - 1;
  const GaussRule rule(degree + 1);
  FieldJet jet{equations_.varied[field], std::vector<int>(from_.size(), 0), rates ? 1 : 0}, itself = jet;
  if (!rates) jet.space[along] = 1;
  itself.time = 0;
  std::vector<double> highest;  // w P_n (2n + 1)/2 at the points
  for (std::size_t q = 0; q < rule.x.size(); ++q)
    highest.push_back(rule.w[q] * legendre(degree, rule.x[q]).first * (degree + 0.5));
  const double cell = width_[along] / cells_[along];
  double largest = 0, size = 0, field_size = 0;
  for (const double share : places_across) {
    std::vector<double> at;
    for (std::size_t d = 0; d < from_.size(); ++d) at.push_back(from_[d] + share * width_[d]);
    for (int e = 0; e < cells_[along]; ++e) {
      double coefficient = 0;
      for (std::size_t q = 0; q < rule.x.size(); ++q) {
        at[along] = from_[along] + cell * (e + (1 + rule.x[q]) / 2);
        const double value = mesh.field_at(field, jet, at);
        coefficient += highest[q] * value, size = std::max(size, std::abs(value));
      }
      largest = std::max(largest, std::abs(coefficient));
      field_size = std::max(field_size, std::abs(mesh.field_at(field, itself, at)));
    }
    if (from_.size() == 1) break;
  }
  constexpr double rounding = 1e-6;
  if (!rates) {
    double& so_far = steepest_[field * width_.size() + along];
    size = so_far = std::max({so_far, size, rounding * field_size / width_[along]});
  }
  return size > 0 ? largest / size : 0;
}

SteepeningWatch::Follows SteepeningWatch::look(const FieldMotion& mesh) {
  if (order_ < 3) return Follows::Well;  // of lower orders the highest polynomial of a slope is its mean change
  double part = 0;
  for (std::size_t f = 0; f < equations_.varied.size(); ++f)
    for (std::size_t along = 0; along < from_.size(); ++along) {
      part = std::max(part, part_of_highest(mesh, f, along, false));
      if (!at_start_) part = std::max(part, part_of_highest(mesh, f, along, true));
    }
  if (!at_start_) at_start_ = part;
  const double much = order_ == 3 ? 0.3 : order_ == 4 ? 0.2 : 0.1;
  constexpr double little = 0.02, grown = 4;  // of `much`; times what it was at the start
  if (part < grown * *at_start_ || part < little * much) return Follows::Well;
  if (part > much && !lost_) lost_ = mesh.time();
  return part > much ? Follows::Not : Follows::Barely;
}

void SteepeningWatch::warn(Diagnostics& diagnostics) const {
  if (!lost_) return;
  diagnostics.warning(
      "W0660", equations_.system().density_span,
      fmt::format("the mesh does not follow the field any more from t = {:.4g} s on", *lost_),
      "Slopes have become so steep that they change within an element. Where waves overtake themselves the slope "
      "jumps, and the equations alone do not say how it goes on from there: values after this moment are those of the "
      "mesh.",
      "End the run before, or add what acts on steep slopes, as friction 𝒟(u_tx) or a term with u_xx; if the field is "
      "smooth there, take more `cells`.");
}

void warn_of_drift(const FieldRunResult& run, const FieldEquations& equations, Diagnostics& diagnostics) {
  constexpr double much = 1e-6;  // of its terms: where steps follow what the mesh resolves less than 1e-9 is left
  if (!(run.energy_drift > much)) return;
  diagnostics.warning(
      "W0661", equations.system().density_span,
      fmt::format("the energy drifts by {:.2g} of its terms along the run", run.energy_drift),
      "Nothing feeds or brakes this field, so that its energy is conserved, and that of the mesh as far as the steps "
      "follow its motion. Here they do not, and values may be off by as much.",
      "Take shorter steps by `output every`, other `cells` or another `order`.");
}

}  // namespace maupertuis
