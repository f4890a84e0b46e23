#include "analysis/invariants/naming.hpp"

#include "analysis/invariants/linear_fit.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace maupertuis::invariants {
namespace {

enum Rank { EnergyRank, MomentumRank, CoordinateRank, RotationRank, BoostRank, ScalingRank, LeadingRank };

std::string joined_with_and(const std::vector<std::string>& words) {
  std::string out;
  for (std::size_t i = 0; i < words.size(); ++i)
    out += (i == 0 ? "" : i + 1 == words.size() ? " and " : ", ") + words[i];
  return out;
}

/// From x to z is the negative turn about y.
int turn_about(const std::string& axis) { return axis == "y" ? -1 : 1; }

}  // namespace

Namer::Namer(const EquationsOfMotion& equations, const MotionRows& rows, const Ansatz& ansatz, std::uint64_t seed)
    : equations_(equations), rows_(rows), ansatz_(ansatz), seed_(seed) {
  energy_is_t_plus_v_ =
      equations.system->lagrangian_given.has_value() || conserved_quantities(equations).energy_is_t_plus_v;
}

std::string Namer::axis_of_rotation(const Fit::Term& rotation) const {
  for (const char c : {'x', 'y', 'z'})
    if (c != ansatz_.world.axes[rotation.axis] && c != ansatz_.world.axes[rotation.second]) return std::string(1, c);
  return {};
}

std::string Namer::total() const {
  return ansatz_.world.points.size() > 1 && equations_.system->bodies.empty() ? "total " : "";
}

Naming Namer::name(Expr integral) const {
  if (auto energy = as_energy(integral)) return *energy;
  if (const Fit fit = fit_points(integral, rows_, ansatz_, seed_); !fit.terms.empty()) return of_fit(fit, integral);
  if (const Fit fit = fit_coordinates(integral, rows_, seed_); !fit.terms.empty()) return of_fit(fit, integral);
  if (const Fit fit = fit_leading_part(integral, rows_, ansatz_, seed_); !fit.terms.empty())
    return of_fit(fit, integral);
  if (const auto naming = of_relative_rotation(integral)) return *naming;
  Naming naming{"", "", integral, 9};
  if (is_square_of_angular_momentum(integral)) naming.name = "square of the angular momentum";
  return naming;
}

Naming Namer::of_fit(const Fit& fit, Expr integral) const {
  for (const auto rule : {&Namer::of_leading_part, &Namer::of_time, &Namer::of_scaling, &Namer::of_rotation,
                          &Namer::of_translation, &Namer::of_boost, &Namer::of_coordinates})
    if (auto naming = (this->*rule)(fit, integral)) return *naming;
  return {"", "", integral, 9};
}

/// ±h_E = ±(T + V), without the fit of a symmetry: that of a hundred coordinates takes seconds.
std::optional<Naming> Namer::as_energy(Expr integral) const {
  if (!energy_is_t_plus_v_ || equations_.system->independent != "t") return std::nullopt;
  for (const int sign : {1, -1})
    if (const Expr scaled = Rational(sign) * integral; vanishes_identically(scaled - ansatz_.energy))
      return Naming{"energy", "translation in time", scaled, EnergyRank};
  return std::nullopt;
}

/// −ξ₀ h_E + …: the energy, or Jacobi's integral where it is not T + V or another transformation goes with it.
std::optional<Naming> Namer::of_time(const Fit& fit, Expr integral) const {
  const Fit::Term* shift = fit.find(Constant::TimeShift);
  if (!shift) return std::nullopt;
  std::vector<std::string> with;
  for (const Fit::Term& t : fit.terms) {
    if (t.constant == Constant::Rotation) with.push_back("a rotation about " + axis_of_rotation(t));
    if (t.constant == Constant::Translation) with.push_back("a translation along " + axis(t.axis));
    if (t.constant == Constant::Coordinate) with.push_back("a shift of " + equations_.system->coordinates[t.axis].name);
  }
  const bool energy = energy_is_t_plus_v_ && fit.only({Constant::TimeShift});
  const std::string& t = equations_.system->independent;
  return Naming{t != "t" ? "Beltrami's integral"
                : energy ? "energy"
                         : "Jacobi integral",
                "translation in " + (t == "t" ? "time" : t) + (with.empty() ? "" : " with " + joined_with_and(with)),
                -integral / shift->value, EnergyRank};
}

std::optional<Naming> Namer::of_scaling(const Fit& fit, Expr integral) const {
  if (const auto* t = fit.find(Constant::TimeSquare))
    return Naming{"conformal charge", "expansion: δt = t², δr = t r", -integral / t->value, ScalingRank};
  if (const auto* t = fit.find(Constant::TimeScale))
    return Naming{"dilation charge", "scaling of time and space", -integral / t->value, ScalingRank};
  return std::nullopt;
}

std::optional<Naming> Namer::of_rotation(const Fit& fit, Expr integral) const {
  const Fit::Term *rotation = fit.find(Constant::Rotation), *translation = fit.find(Constant::Translation);
  if (fit.count(Constant::Rotation) != 1 || !fit.only({Constant::Rotation, Constant::Translation})) return std::nullopt;
  const std::string about = axis_of_rotation(*rotation);
  const Expr scaled = Rational(turn_about(about)) * integral / rotation->value;
  if (!translation)
    return Naming{total() + "angular momentum about " + about, "rotation about " + about, scaled, RotationRank};
  if (about == axis(translation->axis))
    return Naming{"helical momentum about " + about,
                  "screw: a rotation about " + about + " with a translation along it", scaled, RotationRank};
  return Naming{"angular momentum about another axis along " + about, "rotation about another point", scaled,
                RotationRank};
}

std::optional<Naming> Namer::of_translation(const Fit& fit, Expr integral) const {
  const Fit::Term* translation = fit.find(Constant::Translation);
  if (fit.terms.size() != 1 || !translation) return std::nullopt;
  const std::string along = axis(translation->axis);
  const bool gauge = has_gauge(integral);
  return Naming{total() + "momentum along " + along + (gauge ? ", modified by the field" : ""),
                "translation along " + along + (gauge ? " up to gauge" : ""), integral / translation->value,
                MomentumRank};
}

std::optional<Naming> Namer::of_boost(const Fit& fit, Expr integral) const {
  if (const auto* t = fit.find(Constant::LorentzBoost))
    return Naming{"boost along " + axis(t->axis), "Lorentz boost along " + axis(t->axis), -integral / t->value,
                  BoostRank};
  const Fit::Term* boost = fit.find(Constant::Boost);
  if (fit.count(Constant::Boost) != 1 || !fit.only({Constant::Boost, Constant::Translation})) return std::nullopt;
  return Naming{
      "Galilei boost along " + axis(boost->axis) + (ansatz_.world.points.size() > 1 ? " (centre of mass)" : ""),
      "Galilei boost along " + axis(boost->axis), -integral / boost->value, BoostRank};
}

std::optional<Naming> Namer::of_coordinates(const Fit& fit, Expr integral) const {
  if (!fit.only({Constant::Coordinate})) return std::nullopt;
  std::vector<std::string> names;
  for (const Fit::Term& t : fit.terms) names.push_back(equations_.system->coordinates[t.axis].name);
  return Naming{"momentum of " + joined_with_and(names), "shift of " + joined_with_and(names),
                integral / fit.terms[0].value, CoordinateRank};
}

std::optional<Naming> Namer::of_leading_part(const Fit& fit, Expr integral) const {
  if (fit.terms.size() != 1) return std::nullopt;
  const Orbit orbit = orbit_of(ansatz_.world);
  const std::string where = orbit.relative ? " (relative motion)" : "";
  if (const auto* t = fit.find(Constant::RungeLenz))
    return Naming{"Laplace-Runge-Lenz vector, " + axis(t->axis) + where, "",
                  integral * (orbit.mass * orbit.mass) / t->value, LeadingRank};
  if (const auto* t = fit.find(Constant::Fradkin))
    return Naming{"Fradkin tensor, " + axis(t->axis) + axis(t->second) + where, "",
                  integral * orbit.mass / (Rational(2) * t->value), LeadingRank};
  return std::nullopt;
}

std::optional<Naming> Namer::of_relative_rotation(Expr integral) const {
  const Orbit orbit = orbit_of(ansatz_.world);
  if (!orbit.relative) return std::nullopt;
  std::vector<Expr> row;
  for (const Expr& component : cross(orbit.position, orbit.velocity)) row.push_back(orbit.mass * component);
  const std::size_t count = row.size();
  row.push_back(integral);
  const auto constants = fit_constants(rows_, {{row}, count}, seed_);
  if (!constants) return std::nullopt;
  std::vector<std::size_t> used;
  for (std::size_t k = 0; k < count; ++k)
    if ((*constants)[k]) used.push_back(k);
  if (used.size() != 1) return std::nullopt;
  const char about = count == 1 ? 'z' : "xyz"[used[0]];
  return Naming{fmt::format("relative angular momentum about {}", about),
                fmt::format("rotation of the relative position about {}", about), integral / (*constants)[used[0]],
                LeadingRank};
}

bool Namer::is_square_of_angular_momentum(Expr integral) const {
  if (ansatz_.world.angular_momentum.size() != 3) return false;
  Expr square = integral.context().number(0);
  for (const Expr& j : ansatz_.world.angular_momentum) square = square + j * j;
  return fit_constants(rows_, {{{square, integral}}, 1}, seed_).has_value();
}

/// A translation whose charge is no combination of the momenta p: f is not 0.
bool Namer::has_gauge(Expr integral) const {
  std::vector<Expr> row = ansatz_.momenta;
  const std::size_t count = row.size();
  row.push_back(integral);
  return ansatz_.constant_mass && !fit_constants(rows_, {{row}, count}, seed_);
}

Naming Namer::name_by_value(Expr integral) const {
  const MechanicalSystem& system = *rows_.system;
  const World& world = ansatz_.world;
  std::vector<Expr> row{ansatz_.energy};
  std::vector<std::pair<std::string, int>> names{{energy_is_t_plus_v_ ? "energy" : "Jacobi integral", EnergyRank}};
  const auto add = [&](Expr e, std::string name, int rank) {
    row.push_back(e);
    names.emplace_back(std::move(name), rank);
  };
  for (std::size_t i = 0; i < world.momentum.size(); ++i)
    add(world.momentum[i], fmt::format("{}momentum along {}", total(), world.axes[i]), MomentumRank);
  for (std::size_t i = 0; i < ansatz_.momenta.size(); ++i)
    add(ansatz_.momenta[i], "momentum of " + system.coordinates[i].name, CoordinateRank);
  for (std::size_t i = 0; i < world.angular_momentum.size(); ++i)
    add(world.angular_momentum[i],
        fmt::format("{}angular momentum about {}", total(), world.angular_momentum.size() == 1 ? 'z' : "xyz"[i]),
        RotationRank);
  row.push_back(integral);
  const auto constants = fit_constants(rows_, {{row}, names.size()}, seed_);
  std::vector<std::size_t> used;
  for (std::size_t k = 0; constants && k < constants->size(); ++k)
    if ((*constants)[k]) used.push_back(k);
  const bool with_energy = !used.empty() && used[0] == 0;
  if (used.empty() || (used.size() > 1 && !with_energy)) return {"", "", integral, 9};
  return {used.size() == 1 ? names[used[0]].first : "Jacobi integral", "", integral / (*constants)[used[0]],
          names[used[0]].second};
}

}  // namespace maupertuis::invariants
