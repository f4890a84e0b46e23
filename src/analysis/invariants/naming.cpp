#include "analysis/invariants/naming.hpp"

#include "analysis/invariants/linear_fit.hpp"
#include "analysis/invariants/symmetry.hpp"

#include <maupertuis/constraint_manifold.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace maupertuis::invariants {
namespace {

enum class Unknown { TimeShift, Rotation, Translation, Boost, TimeScale, Scale, TimeSquare, TimeTimesScale, LorentzBoost, Coordinate,
                     RungeLenz, Fradkin };

std::string joined_with_and(const std::vector<std::string>& words) {
  std::string out;
  for (std::size_t i = 0; i < words.size(); ++i) out += (i == 0 ? "" : i + 1 == words.size() ? " and " : ", ") + words[i];
  return out;
}

}  // namespace

/// The constants of a fit: which unknown, of which axis, with what value.
struct Namer::Fit {
  struct Term { Unknown unknown; std::size_t axis, second; Expr value; };
  std::vector<Term> terms;
  const Term* find(Unknown u) const {
    const auto it = std::find_if(terms.begin(), terms.end(), [u](const Term& t) { return t.unknown == u; });
    return it == terms.end() ? nullptr : &*it;
  }
  bool only(std::initializer_list<Unknown> allowed) const {
    return std::all_of(terms.begin(), terms.end(), [&](const Term& t) { return std::count(allowed.begin(), allowed.end(), t.unknown) > 0; });
  }
  std::size_t count(Unknown u) const {
    return static_cast<std::size_t>(std::count_if(terms.begin(), terms.end(), [u](const Term& t) { return t.unknown == u; }));
  }
};

Namer::Namer(const EquationsOfMotion& equations, const MotionRows& rows, const Ansatz& ansatz, std::uint64_t seed)
    : equations_(equations), rows_(rows), ansatz_(ansatz), seed_(seed) {
  const ConservedQuantities c = conserved_quantities(equations);
  energy_is_t_plus_v_ = c.energy_is_t_plus_v || equations.system->lagrangian_given.has_value();
}

namespace {

/// The unknown constants of a fit with the names of their columns.
struct Columns {
  std::vector<Unknown> unknowns;
  std::vector<std::pair<std::size_t, std::size_t>> axes;
  LinearFitRows fit;
  std::size_t add(Unknown u, std::size_t axis = 0, std::size_t second = 0) {
    unknowns.push_back(u);
    axes.emplace_back(axis, second);
    return unknowns.size() - 1;
  }
};

}  // namespace

std::optional<Namer::Fit> Namer::fit_points(Expr integral) const {
  const World& world = ansatz_.world;
  if (world.points.empty()) return std::nullopt;
  const ExprVector dq = symmetry_of(integral, rows_).value_or(ExprVector{});
  if (dq.empty()) return std::nullopt;
  const MechanicalSystem& system = *rows_.system;
  Context& context = *system.context;
  const Expr t = context.time(), zero = context.number(0);
  const std::size_t d = world.axes.size();
  ExprVector q;
  for (const Coordinate& c : system.coordinates) q.push_back(c.q);
  Columns columns;
  columns.add(Unknown::TimeShift);
  for (std::size_t i = 0; i < d; ++i)
    for (std::size_t j = i + 1; j < d; ++j) columns.add(Unknown::Rotation, i, j);
  for (std::size_t i = 0; i < d; ++i) columns.add(Unknown::Translation, i);
  for (std::size_t i = 0; i < d; ++i) columns.add(Unknown::Boost, i);
  for (const Unknown u : {Unknown::TimeScale, Unknown::Scale, Unknown::TimeSquare, Unknown::TimeTimesScale}) columns.add(u);
  if (!ansatz_.atoms.natural && world.points.size() == 1)
    for (std::size_t i = 0; i < d; ++i) columns.add(Unknown::LorentzBoost, i);
  columns.fit.unknowns = columns.unknowns.size();
  for (const WorldPoint& p : world.points)
    for (std::size_t axis = 0; axis < d; ++axis) {
      std::vector<Expr> row;
      for (std::size_t k = 0; k < columns.unknowns.size(); ++k) {
        const auto [i, j] = columns.axes[k];
        const Expr at_axis = context.number(i == axis ? 1 : 0);
        switch (columns.unknowns[k]) {
          case Unknown::TimeShift: row.push_back(-p.velocity[axis]); break;
          case Unknown::Rotation: row.push_back(axis == j ? p.position[i] : axis == i ? -p.position[j] : zero); break;
          case Unknown::Translation: row.push_back(at_axis); break;
          case Unknown::Boost: row.push_back(at_axis * t); break;
          case Unknown::TimeScale: row.push_back(-(t * p.velocity[axis])); break;
          case Unknown::Scale: row.push_back(p.position[axis]); break;
          case Unknown::TimeSquare: row.push_back(-(t * t * p.velocity[axis])); break;
          case Unknown::TimeTimesScale: row.push_back(t * p.position[axis]); break;
          default: row.push_back(-(p.position[i] * p.velocity[axis])); break;
        }
      }
      Expr moved = zero;
      const auto slopes = gradient(p.position[axis], q);
      for (std::size_t i = 0; i < q.size(); ++i) moved = moved + slopes[i] * dq[i];
      row.push_back(moved);
      columns.fit.rows.push_back(std::move(row));
    }
  const auto constants = fit_constants(rows_, columns.fit, seed_);
  if (!constants) return std::nullopt;
  Fit fit;
  for (std::size_t k = 0; k < constants->size(); ++k)
    if ((*constants)[k]) fit.terms.push_back({columns.unknowns[k], columns.axes[k].first, columns.axes[k].second, (*constants)[k]});
  return fit;
}

std::optional<Namer::Fit> Namer::fit_coordinates(Expr integral) const {
  const ExprVector dq = symmetry_of(integral, rows_).value_or(ExprVector{});
  if (dq.empty()) return std::nullopt;
  const MechanicalSystem& system = *rows_.system;
  Context& context = *system.context;
  const std::size_t n = dq.size();
  LinearFitRows rows;
  rows.unknowns = 1 + n;
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<Expr> row{-system.coordinates[i].velocity};
    for (std::size_t k = 0; k < n; ++k) row.push_back(context.number(k == i ? 1 : 0));
    row.push_back(dq[i]);
    rows.rows.push_back(std::move(row));
  }
  const auto constants = fit_constants(rows_, rows, seed_);
  if (!constants) return std::nullopt;
  Fit fit;
  for (std::size_t k = 0; k <= n; ++k)
    if ((*constants)[k]) fit.terms.push_back({k == 0 ? Unknown::TimeShift : Unknown::Coordinate, k == 0 ? 0 : k - 1, 0, (*constants)[k]});
  return fit;
}

/// Quadratic integrals of one particle by their leading part: v × (r × v) of the Laplace-Runge-Lenz vector, v_i v_j of
/// Fradkin's tensor.
std::optional<Namer::Fit> Namer::fit_leading_part(Expr integral) const {
  const MechanicalSystem& system = *rows_.system;
  const Orbit orbit = orbit_of(ansatz_.world);
  const ExprVector &r = orbit.position, &v = orbit.velocity;
  const std::size_t d = r.size();
  const bool spans = orbit.relative || d == system.coordinates.size();
  if (d < 2 || !spans || !ansatz_.constant_mass || !ansatz_.reversible) return std::nullopt;
  Context& context = *system.context;
  Columns columns;
  ExprVector functions;
  for (std::size_t a = 0; a < d; ++a) {
    Expr speed = context.number(0), radial = context.number(0);
    for (std::size_t i = 0; i < d; ++i) {
      speed = speed + v[i] * v[i];
      radial = radial + r[i] * v[i];
    }
    columns.add(Unknown::RungeLenz, a);
    functions.push_back(r[a] * speed - v[a] * radial);
  }
  for (std::size_t i = 0; i < d; ++i)
    for (std::size_t j = i; j < d; ++j) {
      columns.add(Unknown::Fradkin, i, j);
      functions.push_back(v[i] * v[j]);
    }
  columns.fit.unknowns = functions.size();
  ExprVector velocities;
  for (const Coordinate& c : system.coordinates) velocities.push_back(c.velocity);
  for (const Expr& first : velocities)
    for (const Expr& second : velocities) {
      std::vector<Expr> row;
      for (const Expr& f : functions) row.push_back(differentiate(differentiate(f, first), second));
      row.push_back(differentiate(differentiate(integral, first), second));
      columns.fit.rows.push_back(std::move(row));
    }
  const auto constants = fit_constants(rows_, columns.fit, seed_);
  if (!constants) return std::nullopt;
  Fit fit;
  for (std::size_t k = 0; k < constants->size(); ++k)
    if ((*constants)[k]) fit.terms.push_back({columns.unknowns[k], columns.axes[k].first, columns.axes[k].second, (*constants)[k]});
  return fit;
}

bool Namer::is_square_of_angular_momentum(Expr integral) const {
  if (ansatz_.world.angular_momentum.size() != 3) return false;
  Context& context = *rows_.system->context;
  Expr square = context.number(0);
  for (const Expr& j : ansatz_.world.angular_momentum) square = square + j * j;
  LinearFitRows rows{{{square, integral}}, 1};
  return fit_constants(rows_, rows, seed_).has_value();
}

bool Namer::name_relative_rotation(Expr integral, Naming& naming) const {
  const Orbit orbit = orbit_of(ansatz_.world);
  if (!orbit.relative) return false;
  std::vector<Expr> row;
  for (const Expr& component : cross(orbit.position, orbit.velocity)) row.push_back(orbit.mass * component);
  const std::size_t count = row.size();
  row.push_back(integral);
  const auto constants = fit_constants(rows_, {{row}, count}, seed_);
  if (!constants || std::count_if(constants->begin(), constants->end(), [](const Expr& c) { return bool(c); }) != 1) return false;
  for (std::size_t k = 0; k < count; ++k)
    if ((*constants)[k]) {
      const char axis = count == 1 ? 'z' : "xyz"[k];
      naming = {fmt::format("relative angular momentum about {}", axis),
                fmt::format("rotation of the relative position about {}", axis), integral / (*constants)[k], 6};
    }
  return true;
}

Naming Namer::name(Expr integral) const {
  Naming naming{"", "", integral, 9};
  auto fit = fit_points(integral);
  if (!fit || fit->terms.empty()) fit = fit_coordinates(integral);
  if (!fit || fit->terms.empty()) {
    fit = fit_leading_part(integral);
    if (fit && fit->terms.size() != 1) fit.reset();
  }
  if (fit && !fit->terms.empty()) describe(*fit, naming);
  else if (name_relative_rotation(integral, naming)) return naming;
  else if (is_square_of_angular_momentum(integral)) naming.name = "square of the angular momentum";
  return naming;
}

Naming Namer::name_by_value(Expr integral) const {
  const MechanicalSystem& system = *rows_.system;
  const World& world = ansatz_.world;
  const std::string total = world.points.size() > 1 && system.bodies.empty() ? "total " : "";
  std::vector<Expr> row{ansatz_.energy};
  std::vector<std::pair<std::string, int>> names{{energy_is_t_plus_v_ ? "energy" : "Jacobi integral", 0}};
  const auto add = [&](Expr e, std::string name, int rank) {
    row.push_back(e);
    names.emplace_back(std::move(name), rank);
  };
  for (std::size_t i = 0; i < world.momentum.size(); ++i)
    add(world.momentum[i], fmt::format("{}momentum along {}", total, world.axes[i]), 1);
  for (std::size_t i = 0; i < ansatz_.momenta.size(); ++i) add(ansatz_.momenta[i], "momentum of " + system.coordinates[i].name, 2);
  for (std::size_t i = 0; i < world.angular_momentum.size(); ++i)
    add(world.angular_momentum[i], fmt::format("{}angular momentum about {}", total, world.angular_momentum.size() == 1 ? 'z' : "xyz"[i]), 3);
  row.push_back(integral);
  const auto constants = fit_constants(rows_, {{row}, names.size()}, seed_);
  Naming naming{"", "", integral, 9};
  if (!constants) return naming;
  std::vector<std::size_t> used;
  for (std::size_t k = 0; k < constants->size(); ++k)
    if ((*constants)[k]) used.push_back(k);
  if (used.empty()) return naming;
  const bool with_energy = used[0] == 0;
  if (used.size() > 1 && !with_energy) return naming;
  naming.scaled = integral / (*constants)[used[0]];
  naming.name = used.size() == 1 ? names[used[0]].first : "Jacobi integral";
  naming.rank = names[used[0]].second;
  return naming;
}

void Namer::describe(const Fit& fit, Naming& naming) const {
  const World& world = ansatz_.world;
  const MechanicalSystem& system = *rows_.system;
  const auto axis = [&](std::size_t i) { return std::string(1, world.axes[i]); };
  const auto about = [&](const Fit::Term& t) {   // the axis that is in neither direction of the plane
    for (const char c : {'x', 'y', 'z'})
      if (c != world.axes[t.axis] && c != world.axes[t.second]) return std::string(1, c);
    return std::string();
  };
  const std::string total = world.points.size() > 1 && system.bodies.empty() ? "total " : "";
  const auto scale = [&](Expr value, int sign = 1) { naming.scaled = Rational(sign) * naming.scaled / value; };
  const Fit::Term *shift = fit.find(Unknown::TimeShift), *rotation = fit.find(Unknown::Rotation),
                  *translation = fit.find(Unknown::Translation), *boost = fit.find(Unknown::Boost);
  // From x to z is the negative turn about y.
  const int turn = rotation && about(*rotation) == "y" ? -1 : 1;
  if (const auto* t = fit.find(Unknown::RungeLenz)) {
    const Orbit orbit = orbit_of(world);
    naming = {"Laplace-Runge-Lenz vector, " + axis(t->axis) + (orbit.relative ? " (relative motion)" : ""), "",
              naming.scaled * (orbit.mass * orbit.mass), 6};
    return scale(t->value);
  }
  if (const auto* t = fit.find(Unknown::Fradkin)) {
    naming = {"Fradkin tensor, " + axis(t->axis) + axis(t->second), "", naming.scaled * orbit_of(world).mass / Rational(2), 6};
    return scale(t->value);
  }
  if (shift) {
    scale(shift->value, -1);
    const bool alone = fit.only({Unknown::TimeShift});
    naming.rank = 0;
    naming.name = alone && energy_is_t_plus_v_ ? "energy" : "Jacobi integral";
    std::vector<std::string> with;
    if (rotation) with.push_back("a rotation about " + about(*rotation));
    if (translation) with.push_back("a translation along " + axis(translation->axis));
    for (const Fit::Term& t : fit.terms)
      if (t.unknown == Unknown::Coordinate) with.push_back("a shift of " + system.coordinates[t.axis].name);
    naming.symmetry = "translation in time" + (with.empty() ? "" : " with " + joined_with_and(with));
    return;
  }
  if (fit.find(Unknown::TimeSquare)) {
    scale(fit.find(Unknown::TimeSquare)->value, -1);
    naming.name = "conformal charge";
    naming.symmetry = "expansion: δt = t², δr = t r";
    naming.rank = 5;
    return;
  }
  if (const auto* t = fit.find(Unknown::TimeScale)) {
    scale(t->value, -1);
    naming.name = "dilation charge";
    naming.symmetry = "scaling of time and space";
    naming.rank = 5;
    return;
  }
  if (const auto* t = fit.find(Unknown::LorentzBoost)) {
    scale(t->value, -1);
    naming.name = "boost along " + axis(t->axis);
    naming.symmetry = "Lorentz boost along " + axis(t->axis);
    naming.rank = 4;
    return;
  }
  if (rotation && fit.count(Unknown::Rotation) == 1 && fit.only({Unknown::Rotation})) {
    scale(rotation->value, turn);
    naming.name = total + "angular momentum about " + about(*rotation);
    naming.symmetry = "rotation about " + about(*rotation);
    naming.rank = 3;
    return;
  }
  if (rotation && translation && fit.only({Unknown::Rotation, Unknown::Translation}) && fit.count(Unknown::Rotation) == 1) {
    const bool screw = about(*rotation) == axis(translation->axis);
    scale(rotation->value, turn);
    naming.name = screw ? "helical momentum about " + axis(translation->axis) : "angular momentum about a shifted axis along " + about(*rotation);
    naming.symmetry = screw ? "screw: a rotation about " + about(*rotation) + " with a translation along it" : "rotation about another point";
    naming.rank = 3;
    return;
  }
  if (translation && fit.count(Unknown::Translation) == 1 && fit.only({Unknown::Translation})) {
    scale(translation->value);
    naming.name = total + "momentum along " + axis(translation->axis);
    naming.symmetry = "translation along " + axis(translation->axis);
    naming.rank = 1;
    return;
  }
  if (boost && fit.count(Unknown::Boost) == 1 && fit.only({Unknown::Boost, Unknown::Translation})) {
    scale(boost->value, -1);
    naming.name = "Galilei boost along " + axis(boost->axis) + (world.points.size() > 1 ? " (centre of mass)" : "");
    naming.symmetry = "Galilei boost along " + axis(boost->axis);
    naming.rank = 4;
    return;
  }
  if (fit.only({Unknown::Coordinate})) {
    scale(fit.terms[0].value);
    std::vector<std::string> names;
    for (const Fit::Term& t : fit.terms) names.push_back(system.coordinates[t.axis].name);
    naming.name = fmt::format("momentum of {}", joined_with_and(names));
    naming.symmetry = fmt::format("shift of {}", joined_with_and(names));
    naming.rank = 2;
  }
}

}  // namespace maupertuis::invariants
