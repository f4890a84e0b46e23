#include "simulation/contact_checks.hpp"

#include "simulation/contact/contact_functions.hpp"

#include <maupertuis/across_switches.hpp>
#include <maupertuis/constraint_analysis.hpp>
#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/jacobian.hpp>
#include <maupertuis/motion_through_modes.hpp>
#include <maupertuis/normal_force.hpp>
#include <maupertuis/simulation.hpp>
#include <maupertuis/transform.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace maupertuis {
namespace {

bool has_linear_momenta(const EquationsOfMotion& equations) {
  const ExprMatrix mass = mass_matrix(equations);
  ExprVector velocities, slopes;
  for (const Expr& s : symbols_of(mass.entries))
    if (s.role() == Role::Coordinate && s.order() == 1) velocities.push_back(s);
  if (velocities.empty()) return true;
  for (const Expr& entry : mass.entries)
    for (const Expr& slope : gradient(entry, velocities))
      if (!slope.is_zero()) slopes.push_back(slope);
  return slopes.empty() || zero_test(slopes).verdict == Verdict::Zero;
}

/// E0730 for each contact whose gap, or its slope, jumps at a switch: there λ would have to be an impulse.
bool contacts_are_smooth(const EquationsOfMotion& equations, Diagnostics& diagnostics) {
  const MechanicalSystem& system = *equations.system;
  bool smooth = true;
  ExprVector symbols{system.context->time()};
  for (const Coordinate& q : system.coordinates) symbols.push_back(q.q);
  const SparseGradient gradient(symbols);
  for (const Contact& c : system.contacts) {
    ExprVector functions;
    for (const SparseGradient::Entry& slope : gradient(c.gap)) functions.push_back(slope.value);
    functions.push_back(c.gap);
    for (const Expr& f : functions) {
      const auto jump = across_switches(system, f, equations.order).jump;
      if (!jump) continue;
      diagnostics.error("E0730", c.span,
                        fmt::format("the surface of this contact has a kink or a step where {}", jump->place),
                        "There the direction of its force jumps, and what slides over it is let go or hit.",
                        "Write one contact for each smooth side of the surface.");
      smooth = false;
      break;
    }
  }
  return smooth;
}

/// Coordinates that are lengths, have the same mass and are not coupled: they move a body along directions at right
/// angles, and the point where it touches with it.
class Places {
 public:
  explicit Places(const EquationsOfMotion& equations)
      : system_(*equations.system), mass_(mass_matrix(equations)), n_(system_.coordinates.size()) {}

  /// [the directions that each length belongs to]
  std::vector<std::vector<std::size_t>> groups() const {
    std::vector<std::vector<std::size_t>> out;
    for (std::size_t i = 0; i < n_; ++i) {
      if (!is_length(i)) continue;
      out.emplace_back();
      for (std::size_t j = 0; j < n_; ++j)
        if (is_length(j) && mass(i, i) == mass(j, j) && (i == j || mass(i, j).is_zero())) out.back().push_back(j);
    }
    return out;
  }
  bool is_uncoupled(std::size_t i) const {
    for (std::size_t j = 0; j < n_; ++j)
      if (i != j && !mass(i, j).is_zero()) return false;
    return true;
  }

 private:
  Expr mass(std::size_t i, std::size_t j) const { return mass_.entries[i * n_ + j]; }
  bool is_length(std::size_t i) const { return system_.coordinates[i].dimension.same_as(dimensions::length()); }

  const MechanicalSystem& system_;
  ExprMatrix mass_;
  std::size_t n_;
};

bool rubs(const Contact& c) { return c.friction.present(); }

/// The coordinate by which alone, of those of a body, the gap of a contact opens, where the slip holds its rate.
std::optional<std::size_t> opening_rate_in(const MechanicalSystem& system, const Contact& c, const Places& places,
                                           const std::vector<std::size_t>& group) {
  std::optional<std::size_t> opens;
  for (const std::size_t j : group) {
    if (differentiate(c.gap, system.coordinates[j].q).is_zero()) continue;
    if (opens) return std::nullopt;
    opens = j;
  }
  if (!opens || !places.is_uncoupled(*opens)) return std::nullopt;
  for (const Expr& slip : c.friction.slip)
    if (zero_test(differentiate(slip, system.coordinates[*opens].velocity)).verdict == Verdict::Nonzero) return opens;
  return std::nullopt;
}

/// E0265 where the energies alone tell the place of what slides; where points and bodies do, the text was checked.
bool slips_are_along_surfaces(const EquationsOfMotion& equations, Diagnostics& diagnostics) {
  const MechanicalSystem& system = *equations.system;
  if (system.dimensionless || std::none_of(system.contacts.begin(), system.contacts.end(), rubs)) return true;
  const Places places(equations);
  const auto groups = places.groups();
  for (const Contact& c : system.contacts) {
    if (!rubs(c) || normal_force_per_multiplier(system, c)) continue;
    for (const auto& group : groups)
      if (const auto i = opening_rate_in(system, c, places, group)) {
        diagnostics.error("E0265", c.friction.span, "this slip velocity is not along the surface",
                          fmt::format("{}' is the velocity along the normal, at which the contact opens: friction does "
                                      "no work there.",
                                      system.coordinates[*i].name),
                          "Write the velocity along the surface alone, such as slip x' where the contact is z >= 0.");
        return false;
      }
  }
  return true;
}

/// The gradients of two components of slip are at right angles where those of the place are.
bool slips_are_at_right_angles(const EquationsOfMotion& equations, Diagnostics& diagnostics) {
  const MechanicalSystem& system = *equations.system;
  const auto is_in_space = [](const Contact& c) { return c.friction.in_space(); };
  if (system.dimensionless || std::none_of(system.contacts.begin(), system.contacts.end(), is_in_space)) return true;
  const auto groups = Places(equations).groups();
  bool good = true;
  for (const Contact& c : system.contacts) {
    if (!c.friction.in_space()) continue;
    for (const auto& group : groups) {
      ExprVector terms;
      for (const std::size_t j : group) {
        const Expr velocity = system.coordinates[j].velocity;
        terms.push_back(differentiate(c.friction.slip[0], velocity) * differentiate(c.friction.slip[1], velocity));
      }
      if (zero_test(system.context->sum(terms)).verdict != Verdict::Nonzero) continue;
      diagnostics.error("E0265", c.friction.span, "the two components of this slip velocity are not at right angles",
                        "Friction acts against the slip as a whole, √(v₁² + v₂²), which is its speed only where the "
                        "components are along two directions at right angles.",
                        "Write the components along two such directions, each a velocity: slip (x', y').");
      good = false;
      break;
    }
  }
  return good;
}

/// What friction multiplies, without reactions: what stands for them.
std::vector<Expr> forces_of(const EquationsOfMotion& equations, const Friction& friction) {
  std::vector<Expr> out;
  for (const Expr& e : {friction.kinetic, friction.static_, friction.normal})
    if (e) out.push_back(e);
  return with_reactions(equations, out);
}

/// E0732 for friction by forces of redundant constraints, which these share in a way that the motion does not
/// determine.
bool frictions_are_determined(const EquationsOfMotion& equations, Diagnostics& diagnostics) {
  const MechanicalSystem& system = *equations.system;
  if (system.constraints.size() < 2 || system.frictions.empty()) return true;
  std::optional<ConstraintAnalysis> analysis;
  bool good = true;
  for (const Friction& f : system.frictions) {
    const std::vector<Expr> symbols = symbols_of(forces_of(equations, f));
    for (std::size_t k = 0; k < equations.multipliers.size() && good; ++k) {
      if (std::find(symbols.begin(), symbols.end(), equations.multipliers[k]) == symbols.end()) continue;
      if (!analysis) analysis = analyse_constraints(equations);
      const auto& open = analysis->undetermined;
      if (std::find(open.begin(), open.end(), k) == open.end()) continue;
      diagnostics.error(
          "E0732", f.span,
          fmt::format("the model does not determine the force of {}, on which this friction depends",
                      system.constraint_label(k)),
          "It is one of several constraints that say the same of the motion: how they share the force is a "
          "question of elasticity.",
          "Leave one of them out, or give the normal force by a formula.");
      good = false;
    }
  }
  return good;
}

/// E0733 for friction by a normal force that is no linear function of multipliers, as the resultant of two: the
/// accelerations follow from linear equations.
bool frictions_are_linear(const EquationsOfMotion& equations, Diagnostics& diagnostics) {
  bool good = true;
  for (const Friction& f : equations.system->frictions) {
    if (!f.normal) continue;
    const std::vector<Expr> normal = with_reactions(equations, {&f.normal, 1});
    ExprVector bends;
    for (const Expr& slope : gradient(normal.front(), equations.multipliers))
      for (const Expr& bend : gradient(slope, equations.multipliers))
        if (!bend.is_zero()) bends.push_back(bend);
    if (bends.empty() || zero_test(bends).verdict == Verdict::Zero) continue;
    diagnostics.error(
        "E0733", f.span, "this normal force is no linear function of the forces of constraint",
        "Friction acts back on the forces that press: with their resultant, a root of squares, the accelerations "
        "follow from equations that are not linear, which are not solved yet.",
        "Take the force of one constraint, a sum of them, or the normal force by a formula in the coordinates and "
        "velocities.");
    good = false;
  }
  return good;
}

}  // namespace

bool can_go_through_modes(const EquationsOfMotion& equations, Diagnostics& diagnostics) {
  const MechanicalSystem& system = *equations.system;
  if (!system.contacts.empty() && !has_linear_momenta(equations)) {
    diagnostics.error("E0729", system.contacts.front().span,
                      "impacts are not carried out where momenta are not linear in the velocities",
                      "An impulse changes p = ∂L/∂q'; here q' does not follow from p by a linear equation.",
                      "Leave the contacts out, or use a Lagrangian that is quadratic in the velocities.");
    return false;
  }
  return contacts_are_smooth(equations, diagnostics) && frictions_are_determined(equations, diagnostics) &&
         frictions_are_linear(equations, diagnostics) && slips_are_along_surfaces(equations, diagnostics) &&
         slips_are_at_right_angles(equations, diagnostics);
}

bool start_keeps_contacts(const Model& model, double t, std::span<const double> q, Diagnostics& diagnostics) {
  const MechanicalSystem& system = model.system;
  Bindings at = parameter_bindings(system);
  at[system.context->time()] = t;
  for (std::size_t i = 0; i < q.size(); ++i) at[system.coordinates[i].q] = q[i];
  bool kept = true;
  constexpr double rounding = 64 * std::numeric_limits<double>::epsilon();
  for (std::size_t i = 0; i < system.contacts.size(); ++i) {
    const Expr gap = in_terms_of_motion(system, {&system.contacts[i].gap, 1}).front();
    const double value = evaluate(gap, at);
    if (value >= -rounding * evaluate(size_of_nested_terms(gap), at)) continue;
    kept = false;
    diagnostics.error(
        "E0728", system.contacts[i].span, fmt::format("the start violates the contact {}", system.contact_label(i)),
        fmt::format("Its left side less its right side is {:.6g} there (SI), and has to be at least 0.", value),
        "Change the start, or the sense of the inequality.");
  }
  return kept;
}

}  // namespace maupertuis
