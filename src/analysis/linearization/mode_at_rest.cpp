#include "analysis/linearization/mode_at_rest.hpp"

#include <maupertuis/transform.hpp>

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

constexpr double touches = 1e-9;    // of the sizes of the terms of a gap, and of the largest force
constexpr double no_gap = 1e-13;    // of what typical sizes of the coordinates make of a gap
constexpr double no_force = 1e-14;  // of a limit of friction
// By which each contact presses at least, of the largest force: none, then less and less, above rounding.
constexpr double shares_of_force[] = {0, 0.25, 0.03, 1e-3, 1e-5, 1e-8};

bool slides_at_rest(FrictionState state) { return state != FrictionState::None && state != FrictionState::Stick; }

}  // namespace

ModeAtRest::ModeAtRest(const MechanicalSystem& system, ContactMode mode) : system_(system), mode_(std::move(mode)) {
  Diagnostics unheard;  // the system passed its checks with its contacts
  MechanicalSystem in_mode = system_in_mode(system, mode_);
  in_mode.written = nullptr;
  equations_ = std::make_shared<const EquationsOfMotion>(
      *euler_lagrange(std::make_shared<const MechanicalSystem>(std::move(in_mode)), unheard));
  points_.emplace(*equations_);
}

// -------------------------------------------------------------------------------------------------------------- gaps

std::optional<std::vector<bool>> ModeAtRest::touching(const OperatingPoint& point) const {
  const Bindings b = at(point);
  std::vector<bool> out = mode_.closed;
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (out[i]) continue;
    const Contact& c = system_.contacts[i];
    const double gap = value(c.gap, b), rounding = gap_rounding(c, b);
    if (!(gap >= -rounding)) return std::nullopt;
    out[i] = gap <= rounding;
  }
  return out;
}

bool ModeAtRest::has_gaps(const OperatingPoint& point) const {
  const Bindings b = at(point);
  for (std::size_t i = 0; i < mode_.closed.size(); ++i)
    if (!mode_.closed[i] && !(value(system_.contacts[i].gap, b) > 0)) return false;
  return true;
}

/// Terms of a gap that vanish together, z and a sin θ at θ = π, say nothing of its rounding: typical sizes do.
double ModeAtRest::gap_rounding(const Contact& contact, const Bindings& b) const {
  const MotionState none{0, std::vector<double>(system_.coordinates.size()), {}};
  const std::vector<double> sizes = typical_sizes(system_, none);
  double places = 0;
  for (std::size_t k = 0; k < sizes.size(); ++k)
    places += sizes[k] * std::abs(value(differentiate(contact.gap, system_.coordinates[k].q), b));
  return std::max(touches * size(contact.gap, b), no_gap * places);
}

bool ModeAtRest::is_free_along(const Translation& translation) const {
  for (std::size_t i = 0; i < system_.contacts.size(); ++i)
    for (std::size_t k = 0; k < system_.coordinates.size(); ++k)
      if (!mode_.closed[i] && translation.direction[k] != 0 &&
          !differentiate(system_.contacts[i].gap, system_.coordinates[k].q).is_zero())
        return false;
  return true;
}

// ------------------------------------------------------------------------------------------------------------ forces

std::optional<OperatingPoint> ModeAtRest::with_forces(const OperatingPoint& point, Presses least) const {
  if (press(point, least) && friction_holds(point)) return point;
  const SharedForces forces = shared_forces(point);
  if (!forces.are_open()) return std::nullopt;
  double largest = 0;
  for (const double x : point.multipliers) largest = std::max(largest, std::abs(x));
  OperatingPoint out = point;
  for (const double share : shares_of_force) {
    if (share > 0 && least != Presses::MoreThanRounding) break;
    const auto found = forces.pressing_by(share * largest);
    if (!found && share == 0) break;
    if (found) out.multipliers = *found;
    if (found && press(out, least) && friction_holds(out)) return out;
  }
  return std::nullopt;
}

bool ModeAtRest::leaves_forces_open(const OperatingPoint& point) const { return shared_forces(point).are_open(); }

SharedForces ModeAtRest::shared_forces(const OperatingPoint& point) const {
  const Bindings b = at(point);
  std::vector<double> limits;
  for (std::size_t i = 0; i < mode_.friction.size(); ++i) {
    const Friction& f = friction_of(system_, i);
    const bool acts = mode_.friction[i] == FrictionState::Stick && !f.sticking;
    const Expr normal = acts && i >= mode_.closed.size() ? normal_force(system_, mode_, i) : Expr();
    limits.push_back(!acts || has_multipliers(normal) ? NAN : value(f.static_, b) * (normal ? value(normal, b) : 1));
  }
  return {system_, mode_, *equations_, points_->impl(), point, limits};
}

bool ModeAtRest::press(const OperatingPoint& point, Presses least) const {
  const Bindings b = at(point);
  double largest = 0;
  for (const double x : point.multipliers) largest = std::max(largest, std::abs(x));
  for (std::size_t i = 0; i < system_.contacts.size(); ++i) {
    if (!mode_.closed[i]) continue;
    const Contact& c = system_.contacts[i];
    const double x = value(c.multiplier, b), rounding = touches * std::max(largest, balanced(c, b));
    if (least == Presses::MoreThanRounding  ? !(x > rounding)
        : least == Presses::NotLessThanZero ? !(x >= 0)
                                            : !(x >= -rounding))
      return false;
  }
  return true;
}

/// The forces that balance where the contact pushes, in units of its λ.
double ModeAtRest::balanced(const Contact& c, const Bindings& b) const {
  double out = 0;
  for (std::size_t k = 0; k < system_.coordinates.size(); ++k) {
    const double slope = std::abs(value(differentiate(c.gap, system_.coordinates[k].q), b));
    if (!(slope > 0)) continue;
    double forces = size(equations_->generalized_forces[k], b);
    for (const EnergyTerm& term : system_.potential)
      forces += std::abs(value(differentiate(term.value, system_.coordinates[k].q), b));
    out = std::max(out, forces / slope);
  }
  return out;
}

// ---------------------------------------------------------------------------------------------------------- friction

std::vector<StaticHold> ModeAtRest::holds(const OperatingPoint& point) const {
  const Bindings b = at(point);
  std::vector<StaticHold> out;
  for (std::size_t i = 0; i < mode_.friction.size(); ++i) {
    const Friction& f = friction_of(system_, i);
    const bool acts = i >= system_.contacts.size() || mode_.closed[i];
    if (!f.present() || !acts || slides_at_rest(mode_.friction[i])) continue;
    const Expr normal = normal_force(system_, mode_, i);
    const double limit = f.sticking ? HUGE_VAL : value(f.static_, b) * (normal ? std::abs(value(normal, b)) : 1);
    const std::string name =
        i < system_.contacts.size() ? system_.contact_label(i) : system_.frictions[i - system_.contacts.size()].name;
    const double force = force_of(f, b);
    const bool is_rounding = force <= no_force * limit && std::isfinite(limit);
    out.push_back({name, is_rounding ? 0.0 : force, limit, dimension_of_friction(i)});
  }
  return out;
}

bool ModeAtRest::friction_holds(const OperatingPoint& point) const {
  const auto all = holds(point);
  return std::all_of(all.begin(), all.end(), [](const StaticHold& h) { return h.force <= h.limit; });
}

Dimension ModeAtRest::dimension_of_friction(std::size_t i) const {
  if (i < system_.contacts.size()) return dimensions::force();
  const std::string& name = system_.frictions[i - system_.contacts.size()].name;
  for (const Coordinate& c : system_.coordinates)
    if (c.name == name) return system_.lagrangian_dimension / c.dimension;
  return {};
}

double ModeAtRest::force_of(const Friction& f, const Bindings& b) const {
  double square = 0;
  for (const Expr& m : f.multipliers) square += std::pow(value(m, b), 2);
  return std::sqrt(square);
}

// ------------------------------------------------------------------------------------------------------------ values

Bindings ModeAtRest::at(const OperatingPoint& point) const {
  Bindings b = parameter_bindings(system_);
  for (std::size_t i = 0; i < point.q.size(); ++i) {
    b[system_.coordinates[i].q] = point.q[i];
    b[system_.coordinates[i].velocity] = 0;
    b[system_.coordinates[i].acceleration] = 0;
  }
  b[system_.context->time()] = point.t;
  for (const Contact& c : system_.contacts) b[c.multiplier] = 0;
  for (std::size_t i = 0; i < system_.contacts.size() + system_.frictions.size(); ++i)
    for (const Expr& m : friction_of(system_, i).multipliers) b[m] = 0;
  for (std::size_t k = 0; k < equations_->multipliers.size(); ++k) b[equations_->multipliers[k]] = point.multipliers[k];
  return b;
}

double ModeAtRest::value(Expr e, const Bindings& b) const {
  return evaluate(in_terms_of_motion(system_, {&e, 1}).front(), b);
}

double ModeAtRest::size(Expr e, const Bindings& b) const {
  double sum = 0;
  for (std::size_t i = 0; i < (e.is(Kind::Sum) ? e.size() : 1); ++i)
    sum += std::abs(value(e.is(Kind::Sum) ? e[i] : e, b));
  return sum;
}

}  // namespace maupertuis
