#include "equations/constraint_steps.hpp"

#include <maupertuis/print.hpp>

#include <fmt/format.h>

#include <algorithm>

#include "equations/constraint_forms.hpp"
#include "equations/multiplier_forces.hpp"
#include "equations/simplified.hpp"

namespace maupertuis {
namespace {

constexpr std::size_t longest = 400;  // characters: beyond it a solved form hides more than it shows

bool on_positions(const Constraint& c) { return c.level == Constraint::Level::Position; }

/// φ_rod, ψ_2.
Layout name_of(const MechanicalSystem& system, std::size_t k) {
  const Constraint& c = system.constraints[k];
  const std::string tail = !c.name.empty() ? c.name : !c.body.empty() ? c.body : std::to_string(k + 1);
  const std::string letter = on_positions(c) ? "φ" : "ψ";
  return layouts::labelled(letter + "_" + tail, layouts::indexed(layouts::name(letter), {layouts::name(tail)}));
}

bool is_short(const ReadableForm& form, const ReadingOrder& order) {
  return form.value && form.intermediates.empty() && to_plain(form.value, order).size() <= longest;
}

bool depends_on_velocities(Expr e) {
  const std::vector<Expr> symbols = symbols_of({&e, 1});
  return std::any_of(symbols.begin(), symbols.end(),
                     [](Expr s) { return s.role() == Role::Coordinate && s.order() == 1; });
}

bool has_friction_of_multipliers(const EquationsOfMotion& equations) {
  const auto forces = multiplier_forces(equations);
  return forces && forces->of_friction;
}

void write_eliminated(StepWriter& out) {
  const auto eliminated = eliminate_multipliers(out.equations());
  if (!eliminated) return;
  std::string rule = has_friction_of_multipliers(out.equations())
                         ? "multipliers eliminated: Zᵀ(M q'' + h₀) = 0 with Zᵀ(Aᵀ − ∂h/∂λ) = 0, h = h₀ + (∂h/∂λ) λ"
                         : "multipliers eliminated: Zᵀ(M q'' + h) = 0 with A Z = 0";
  if (eliminated->dependent_replaced) {
    rule += ", and from A q'' = b ";
    for (std::size_t i = 0; i < eliminated->dependent.size(); ++i)
      rule += (i ? ", " : "") + out.system().coordinates[eliminated->dependent[i]].name + "''";
  }
  out.open("Multipliers eliminated");
  for (const ReadableForm& row : eliminated->rows)
    out.as_is(lay_out(row, out.equations().order), {out.context().number(0), {}, {}}, rule);
}

}  // namespace

std::string counting_sentence(const MechanicalSystem& system) {
  const auto& all = system.constraints;
  const std::size_t n = system.coordinates.size();
  const auto positions = static_cast<std::size_t>(std::count_if(all.begin(), all.end(), on_positions));
  const std::size_t velocities = all.size() - positions;
  const std::size_t freedoms = n - std::min(n, positions), free = n - std::min(n, all.size());
  if (velocities == 0)
    return fmt::format("tied by {}: {} − {} = {} if none repeats another.", plural(positions, "constraint"), n,
                       positions, plural(freedoms, "freedom"));
  return fmt::format("tied by {} and by {}: {} of the velocities can be chosen freely if none repeats another.",
                     plural(positions, "constraint"), plural(velocities, "constraint") + " on the velocities", free);
}

void write_constraints(StepWriter& out) {
  const MechanicalSystem& s = out.system();
  const ExprMatrix a = constraint_matrix(out.equations());
  const ReadingOrder& order = out.equations().order;
  out.open("Constraints");
  bool chetaev = false;
  for (std::size_t k = 0; k < s.constraints.size(); ++k) {
    const Constraint& c = s.constraints[k];
    const Layout name = name_of(s, k);
    const ConstraintEquation written = constraint_equation(out.equations(), k);
    out.as_is(lay_out(written.left, order), {written.right, {}, {}},
              fmt::format("{}: {} = left − right, zero along the motion", written.name, to_plain(name)));
    for (std::size_t i = 0; i < a.columns; ++i) {
      if (a.at(k, i).is_zero()) continue;
      const Coordinate& q = s.coordinates[i];
      chetaev |= !on_positions(c) && depends_on_velocities(a.at(k, i));
      out.as_is(
          layouts::partial(name, out.symbol(on_positions(c) ? q.q : q.velocity)),
          {simplified(a.at(k, i), order), {}, {}},
          fmt::format("row of A: the generalized force on {} is this times {}", q.name, symbol_to_plain(c.multiplier)));
    }
  }
  if (chetaev)
    out.sentence("Chetaev's rule",
                 "Not linear in the velocities: by Chetaev's rule the forces of constraint act along ∂ψ/∂q'.");
}

void write_constraint_accelerations(StepWriter& out) {
  const MechanicalSystem& s = out.system();
  const ReadingOrder& order = out.equations().order;
  const ExprMatrix a = constraint_matrix(out.equations());
  const ExprVector b = constraint_bias(out.equations());
  out.open("Constraints differentiated");
  for (std::size_t k = 0; k < a.rows; ++k) {
    ExprVector terms;
    for (std::size_t i = 0; i < a.columns; ++i)
      if (!a.at(k, i).is_zero()) terms.push_back(simplified(a.at(k, i), order) * s.coordinates[i].acceleration);
    const Expr left = out.context().sum(terms);
    const bool position = on_positions(s.constraints[k]);
    out.formula(lay_out(left, order), b[k],
                fmt::format("A q'' = b: the {} derivative of {} is zero", position ? "second" : "first",
                            to_plain(name_of(s, k))));
  }
}

void write_solved_multipliers(StepWriter& out, bool any_left) {
  const ReadingOrder& order = out.equations().order;
  std::vector<ReadableForm> solved = solved_multipliers(out.equations());
  const bool all_short = !solved.empty() && std::all_of(solved.begin(), solved.end(),
                                                        [&](const ReadableForm& f) { return is_short(f, order); });
  for (std::size_t k = 0; all_short && k < solved.size(); ++k) {
    const Expr symbol = out.equations().multipliers[k];
    out.as_is(out.symbol(symbol), std::move(solved[k]),
              has_friction_of_multipliers(out.equations()) ? "A M⁻¹ (Aᵀ − ∂h/∂λ) λ = b + A M⁻¹ h₀, h = h₀ + (∂h/∂λ) λ"
                                                           : "A M⁻¹ Aᵀ λ = b + A M⁻¹ h");
  }
  if (any_left || !all_short)
    out.sentence(
        "M q'' + h = Aᵀλ, A q'' = b",
        "Written out in full this is long; a run solves M q'' + h = Aᵀλ, A q'' = b numerically at every step.");
  write_eliminated(out);
}

void write_reactions(StepWriter& out, const std::vector<Reaction>& reactions) {
  if (reactions.empty()) return;
  out.open("Reactions");
  for (const Reaction& r : reactions) {
    if (!r.value) {
      out.sentence("reaction " + r.name, r.sentence);
      continue;
    }
    const bool named = r.name.find(' ') == std::string::npos;
    out.formula(layouts::labelled(
                    named ? fmt::format("reaction({})", r.name) : r.name,
                    layouts::indexed(layouts::name("F"), {named ? layouts::name(r.name) : layouts::words(r.name)})),
                r.value, r.sentence);
  }
}

}  // namespace maupertuis
