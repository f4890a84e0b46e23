#include "analysis/action/problem.hpp"

#include "analysis/action/kinks.hpp"
#include "linear_algebra/dense.hpp"

#include <maupertuis/constraint_analysis.hpp>
#include <maupertuis/evaluate.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace maupertuis::action {
namespace {

constexpr Index degree = 10;
/// Of (q, v, p), an odd one: of an even degree q ∝ P_n − 1 vanishes at both ends of an element and has no slope at its
/// inner nodes, so that they cannot be eliminated from the second variation.
constexpr Index degree_of_higher = 11;
constexpr Index fewest_elements = 6, most_first_elements = 80;

bool vanish(const ExprVector& expressions) {
  ExprVector open;
  for (const Expr& e : expressions)
    if (!e.is_zero()) open.push_back(e);
  return open.empty() || zero_test(open).verdict == Verdict::Zero;
}

/// The place of a force or a dissipation in the text, if there is one.
std::optional<Span> span_of_force(const MechanicalSystem& system) {
  if (!system.forces.empty()) return system.forces.front().span;
  if (!system.dissipation.empty()) return system.dissipation.front().span;
  return std::nullopt;
}

/// Whether as many independent constraints as coordinates fix the motion.
bool leave_no_freedom(const EquationsOfMotion& equations) {
  const MechanicalSystem& system = *equations.system;
  if (system.constraints.size() < system.coordinates.size()) return false;
  return analyse_constraints(equations).configuration_freedoms == 0;
}

}  // namespace

bool has_action(const EquationsOfMotion& equations, Diagnostics& diagnostics) {
  const MechanicalSystem& system = *equations.system;
  for (std::size_t i = 0; i < system.constraints.size(); ++i) {
    if (system.constraints[i].level == Constraint::Level::Position) continue;
    diagnostics.error(
        "E1201", system.constraints[i].span,
        fmt::format("{} holds between velocities: its motions make no action stationary", system.constraint_label(i)),
        "Constraints between velocities follow d'Alembert's principle; their motions are not the stationary paths of "
        "∫ L dt among the paths that obey them.",
        "Write it between coordinates if it can be integrated (`maup check` says whether it is holonomic in "
        "disguise).");
    return false;
  }
  if (leave_no_freedom(equations)) {
    diagnostics.error("E1201", cover(system.constraints.front().span, system.constraints.back().span),
                      "the constraints leave the system no freedom: its motion is given, and no path lies beside it",
                      "S is stationary among the paths that obey the constraints; here there is a single one.",
                      "Leave a constraint out, so that a coordinate is free to vary between the ends of the path.");
    return false;
  }
  if (vanish(equations.generalized_forces) && vanish(equations.dissipative_terms)) return true;
  diagnostics.error(
      "E1201", span_of_force(system), "forces and dissipation act that no Lagrangian gives",
      "With Q or D the motion is no stationary path of ∫ L dt: there is no principle of stationary action for it.",
      "Write a force that has a potential as `V = …`; leave the others out.");
  return false;
}

bool interrupted(const ActionOptions& options, Diagnostics& diagnostics) {
  if (!options.interrupt || !options.interrupt->load()) return false;
  diagnostics.error("E1210", {}, "interrupted",
                    "The study was ended before it was done; what was found until then is not shown.", {});
  return true;
}

void diagnose_infinite_lagrangian(std::string_view curve, Diagnostics& diagnostics) {
  diagnostics.error("E1206", {}, fmt::format("L has no finite value along the {}", curve),
                    fmt::format("The integral of L is taken at points inside of the {}.", curve),
                    fmt::format("Give a {} on which L is defined.", curve));
}

Problem::Problem(const Model& m, const EquationsOfMotion& e)
    : model(m),
      equations(e),
      functional(e),
      rule(std::make_shared<const Rule>(functional.orders().higher() ? degree_of_higher : degree)),
      kinks(kinks_of(e)),
      typical(Vector::Ones(functional.freedoms())) {
  const MechanicalSystem& system = *e.system;
  for (std::size_t i = 0; i < system.coordinates.size(); ++i) {
    const Coordinate& c = system.coordinates[i];
    if (c.kind == "angle" || c.kind == "number" || c.dimension.same_as(Dimension{})) continue;
    double size = 0;
    for (const Parameter& p : system.parameters)
      if (p.dimension == c.dimension) size = std::max(size, std::abs(p.si_value));
    if (size > 0) typical[static_cast<Index>(i)] = size;
  }
}

double Problem::number(Expr e) const {
  return evaluate(in_terms_of_motion(model.system, {&e, 1}).front(), parameter_bindings(model.system));
}

Vector Problem::least(const ActionEnds* ends) const {
  Vector out = 1e-3 * typical;
  if (!ends || ends->closed) return out;
  for (Index i = 0; i < out.size(); ++i) {
    const auto &a = ends->from[static_cast<std::size_t>(i)], &b = ends->to[static_cast<std::size_t>(i)];
    if (a && b && *a != *b)
      out[i] = std::abs(*b - *a);
    else if (a && *a != 0)
      out[i] = std::min(out[i], std::max(1e-3 * std::abs(*a), 1e-6 * out[i]));
  }
  return out;
}

/// ω² = largest |∂²L/∂q∂q| relative to M, at a few points.
Index Problem::first_elements(const Trial& trial) const {
  Functional& f = const_cast<Functional&>(functional);
  const ActionPath path = to_path(trial);
  Density density;
  double largest = 0;
  for (int k = 0; k <= 8; ++k) {
    const double t = path.start + (path.end - path.start) * (0.03 + 0.94 * k / 8);
    const MotionState s = path.at(t);
    f.evaluate(t, s.q.data(), s.v.data(), trial.multipliers, 2, density);
    if (!density.finite) continue;
    const Matrix mass = density.hessian.bottomRightCorner(n(), n());
    const Matrix ratio = mass.fullPivLu().solve(Matrix(density.hessian.topLeftCorner(n(), n())));
    if (ratio.allFinite()) largest = std::max(largest, ratio.eigenvalues().cwiseAbs().maxCoeff());
  }
  const double waves = std::sqrt(largest) * trial.mesh.whole / std::numbers::pi;
  return std::clamp<Index>(static_cast<Index>(std::min(waves, 1e6)) + 2, fewest_elements, most_first_elements);
}

SingularEnds Problem::singular_ends(const ActionEnds& ends) {
  if (ends.closed || functional.orders().higher()) return {};
  Density density;
  const auto infinite = [&](const std::vector<std::optional<double>>& at, double t) {
    Vector q(n()), v(n());
    for (Index i = 0; i < n(); ++i) {
      const auto &value = at[static_cast<std::size_t>(i)], &a = ends.from[static_cast<std::size_t>(i)],
                 &b = ends.to[static_cast<std::size_t>(i)];
      if (!value) return false;
      q[i] = *value;
      v[i] = a && b ? (*b - *a) / (ends.end - ends.start) : 0.0;
    }
    functional.evaluate(t, q.data(), v.data(), Vector::Zero(functional.integrals()), 0, density);
    return !density.finite;
  };
  return {infinite(ends.from, ends.start), infinite(ends.to, ends.end)};
}

FixedEnds fixed_of(const ActionEnds& ends) {
  FixedEnds out;
  for (std::size_t i = 0; i < ends.from.size(); ++i) {
    out.from.push_back(!ends.closed && ends.from[i].has_value());
    out.to.push_back(!ends.closed && ends.to[i].has_value());
  }
  return out;
}

std::string with_unit(double value, const std::string& unit) {
  return unit.empty() ? fmt::format("{:.9g}", value) : fmt::format("{:.9g} {}", value, unit);
}

std::string unit_of_independent(const MechanicalSystem& system) {
  if (system.dimensionless) return {};
  const std::string unit = to_string(system.independent_dimension);
  return unit == "1" ? "" : unit;
}

std::string place(double t, const MechanicalSystem& system) {
  return fmt::format("{} = {}", system.independent, with_unit(t, unit_of_independent(system)));
}

bool check_order(double start, double end, const MechanicalSystem& system, std::optional<Span> span,
                 Diagnostics& diagnostics) {
  if (start < end && std::isfinite(end - start)) return true;
  if (start < end)
    diagnostics.error("E1203", span,
                      fmt::format("the ends at {} and {} are further apart than numbers reach", place(start, system),
                                  place(end, system)),
                      "The largest number is 1.8e308.", "Give ends that are nearer to each other.");
  else
    diagnostics.error(
        "E1203", span,
        fmt::format("the path ends at {}, not after its start at {}", place(end, system), place(start, system)),
        "The action is an integral from the earlier end to the later one.", "Write the earlier end first.");
  return false;
}

bool move_onto_constraints(Functional& functional, Trial& trial, const FixedEnds& fixed, const Matrix& scale) {
  if (functional.constraints() == 0) return true;
  const Vector nothing = Vector::Zero(trial.q.size());
  double before = HUGE_VAL;
  for (int turn = 0; turn < 60; ++turn) {
    const Directions d = directions_of(functional, trial, fixed, scale, nothing);
    if (!d.normal.allFinite()) return false;
    trial.q += std::min(1.0, 1 / std::max(d.off, 1e-300)) *
               Eigen::Map<const Matrix>(d.normal.data(), trial.q.rows(), trial.q.cols());
    if (d.off < 1e-10) return true;
    if (turn > 30 && d.off > before) return false;
    before = d.off;
  }
  return false;
}

}  // namespace maupertuis::action

namespace maupertuis {

ActionEnds ends_of(const Model& model) {
  const PathEnds& path = *model.experiment.path;
  const Bindings bindings = parameter_bindings(model.system);
  const auto value = [&](Expr e) { return evaluate(in_terms_of_motion(model.system, {&e, 1}).front(), bindings); };
  ActionEnds out;
  for (const Expr& e : path.from) out.from.push_back(e ? std::optional(value(e)) : std::nullopt);
  for (const Expr& e : path.to) out.to.push_back(e ? std::optional(value(e)) : std::nullopt);
  out.start = value(path.start);
  out.end = value(path.end);
  return out;
}

std::string kind_of(const SecondVariation& second) {
  if (!second.index) return "stationary";
  if (second.nullity > 0) return "degenerate";
  return *second.index == 0 ? "minimum" : "saddle";
}

}  // namespace maupertuis
