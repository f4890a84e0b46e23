#include "analysis/invariants/symmetry_fit.hpp"

#include "analysis/invariants/linear_fit.hpp"
#include "analysis/invariants/symmetry.hpp"

#include <stdexcept>

namespace maupertuis::invariants {
namespace {

/// The unknowns of a fit, each with the axes it belongs to.
std::vector<SymmetryFit::Term> unknowns_of_points(const Ansatz& ansatz) {
  const std::size_t d = ansatz.world.axes.size();
  std::vector<SymmetryFit::Term> out{{Constant::TimeShift, 0, 0, {}}};
  for (std::size_t i = 0; i < d; ++i)
    for (std::size_t j = i + 1; j < d; ++j) out.push_back({Constant::Rotation, i, j, {}});
  for (const Constant c : {Constant::Translation, Constant::Boost})
    for (std::size_t i = 0; i < d; ++i) out.push_back({c, i, 0, {}});
  for (const Constant c : {Constant::TimeScale, Constant::Scale, Constant::TimeSquare, Constant::TimeTimesScale})
    out.push_back({c, 0, 0, {}});
  if (!ansatz.atoms.natural && ansatz.world.points.size() == 1)
    for (std::size_t i = 0; i < d; ++i) out.push_back({Constant::LorentzBoost, i, 0, {}});
  return out;
}

/// What one unknown adds to δr of a point along an axis.
Expr displacement(const SymmetryFit::Term& u, const WorldPoint& p, std::size_t axis, Expr t) {
  const Expr along = t.context().number(u.axis == axis ? 1 : 0);
  switch (u.constant) {
    case Constant::TimeShift:
      return -p.velocity[axis];
    case Constant::Rotation:
      return axis == u.second ? p.position[u.axis] : along * -p.position[u.second];
    case Constant::Translation:
      return along;
    case Constant::Boost:
      return along * t;
    case Constant::TimeScale:
      return -(t * p.velocity[axis]);
    case Constant::Scale:
      return p.position[axis];
    case Constant::TimeSquare:
      return -(t * t * p.velocity[axis]);
    case Constant::TimeTimesScale:
      return t * p.position[axis];
    case Constant::LorentzBoost:
      return -(p.position[u.axis] * p.velocity[axis]);
    case Constant::Coordinate:
    case Constant::RungeLenz:
    case Constant::Fradkin:
      break;
  }
  throw std::logic_error("a symmetry of points met a constant that moves no point; please report");
}

SymmetryFit solved(const std::vector<SymmetryFit::Term>& unknowns, LinearFitRows fit, const MotionRows& rows,
                   std::uint64_t seed) {
  fit.unknowns = unknowns.size();
  const auto constants = fit_constants(rows, fit, seed);
  SymmetryFit out;
  for (std::size_t k = 0; constants && k < constants->size(); ++k) {
    if (!(*constants)[k]) continue;
    out.terms.push_back(unknowns[k]);
    out.terms.back().value = (*constants)[k];
  }
  return out;
}

}  // namespace

SymmetryFit fit_points(Expr integral, const MotionRows& rows, const Ansatz& ansatz, std::uint64_t seed) {
  const auto dq = symmetry_of(integral, rows);
  if (!dq || ansatz.world.points.empty()) return {};
  ExprVector q;
  for (const Coordinate& c : rows.system->coordinates) q.push_back(c.q);
  const Expr t = rows.system->context->time();
  const auto unknowns = unknowns_of_points(ansatz);
  LinearFitRows fit;
  for (const WorldPoint& p : ansatz.world.points)
    for (std::size_t axis = 0; axis < p.position.size(); ++axis) {
      std::vector<Expr> row;
      for (const auto& u : unknowns) row.push_back(displacement(u, p, axis, t));
      Expr moved = t.context().number(0);
      const auto slopes = gradient(p.position[axis], q);
      for (std::size_t i = 0; i < q.size(); ++i) moved = moved + slopes[i] * (*dq)[i];
      row.push_back(moved);
      fit.rows.push_back(std::move(row));
    }
  return solved(unknowns, std::move(fit), rows, seed);
}

SymmetryFit fit_coordinates(Expr integral, const MotionRows& rows, std::uint64_t seed) {
  const auto dq = symmetry_of(integral, rows);
  if (!dq) return {};
  const MechanicalSystem& system = *rows.system;
  std::vector<SymmetryFit::Term> unknowns{{Constant::TimeShift, 0, 0, {}}};
  for (std::size_t k = 0; k < dq->size(); ++k) unknowns.push_back({Constant::Coordinate, k, 0, {}});
  LinearFitRows fit;
  for (std::size_t i = 0; i < dq->size(); ++i) {
    std::vector<Expr> row{-system.coordinates[i].velocity};
    for (std::size_t k = 0; k < dq->size(); ++k) row.push_back(system.context->number(k == i ? 1 : 0));
    row.push_back((*dq)[i]);
    fit.rows.push_back(std::move(row));
  }
  return solved(unknowns, std::move(fit), rows, seed);
}

SymmetryFit fit_leading_part(Expr integral, const MotionRows& rows, const Ansatz& ansatz, std::uint64_t seed) {
  const MechanicalSystem& system = *rows.system;
  const Orbit orbit = orbit_of(ansatz.world);
  const ExprVector &r = orbit.position, &v = orbit.velocity;
  const std::size_t d = r.size();
  const bool spans = orbit.relative || d == system.coordinates.size();
  if (d < 2 || !spans || !ansatz.constant_mass || !ansatz.reversible) return {};
  Expr speed = integral.context().number(0), radial = speed;
  for (std::size_t i = 0; i < d; ++i) {
    speed = speed + v[i] * v[i];
    radial = radial + r[i] * v[i];
  }
  std::vector<SymmetryFit::Term> unknowns;
  ExprVector functions;
  for (std::size_t a = 0; a < d; ++a) {
    unknowns.push_back({Constant::RungeLenz, a, 0, {}});
    functions.push_back(r[a] * speed - v[a] * radial);
  }
  for (std::size_t i = 0; i < d; ++i)
    for (std::size_t j = i; j < d; ++j) {
      unknowns.push_back({Constant::Fradkin, i, j, {}});
      functions.push_back(v[i] * v[j]);
    }
  LinearFitRows fit;  // second derivatives by the velocities
  for (const Coordinate& first : system.coordinates)
    for (const Coordinate& second : system.coordinates) {
      const auto twice = [&](Expr e) { return differentiate(differentiate(e, first.velocity), second.velocity); };
      std::vector<Expr> row;
      for (const Expr& f : functions) row.push_back(twice(f));
      row.push_back(twice(integral));
      fit.rows.push_back(std::move(row));
    }
  return solved(unknowns, std::move(fit), rows, seed);
}

}  // namespace maupertuis::invariants
