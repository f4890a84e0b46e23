#include "analysis/hamiltonian/legendre.hpp"
#include "analysis/hamiltonian/readable_choice.hpp"

#include <maupertuis/arguments.hpp>
#include <maupertuis/integral_symbol.hpp>

#include <algorithm>
#include <numeric>

namespace maupertuis {

using namespace phase_space;

namespace {

/// A right side of this length stands on one line; a longer one had better be short in the velocities.
constexpr std::size_t comfortable = 100;

bool has_velocities(Expr e) {
  for (const Expr& s : symbols_of({&e, 1}))
    if (s.role() == Role::Coordinate && s.order() >= 1 && !is_integral(s.name())) return true;
  return false;
}

/// What a reader is shown of the canonical equations.
class CanonicalWriter {
 public:
  CanonicalWriter(Hamiltonian& out, const EquationsOfMotion& shown)
      : out_(out), shown_(shown), context_(*shown.system->context) {}

  void write() {
    for (std::size_t i = 0; i < shown_.system->coordinates.size(); ++i) out_.velocities.push_back(velocity(i));
    for (const CanonicalEquation& e : out_.velocities)
      if (e.right.value) explicit_velocities_.emplace(e.left, e.right.value);
    for (std::size_t i = 0; i < shown_.system->coordinates.size(); ++i) out_.forces.push_back(force(i));
  }

 private:
  CanonicalEquation velocity(std::size_t i) const {
    CanonicalEquation equation{shown_.system->coordinates[i].velocity, {}, false};
    const Expr h = energy_for(i);
    if (!h || !out_.legendre.velocity(i)) return equation;
    const Expr plain = differentiate(h, out_.momenta[i]);
    const Expr candidates[] = {tidy(plain, out_.order), plain, slope(h, out_.momenta[i], out_.order)};
    equation.right.value = shortest(candidates, out_.order);
    return equation;
  }

  /// H where it is written out, else the energy of the coordinate's group; empty where that is not written out either.
  Expr energy_for(std::size_t i) const {
    if (out_.legendre.readable.value) return out_.legendre.readable.value;
    for (const LegendreBlock& block : out_.legendre.blocks)
      if (block.energy_is_readable &&
          std::find(block.coordinates.begin(), block.coordinates.end(), i) != block.coordinates.end())
        return block.energy;
    return {};
  }

  CanonicalEquation force(std::size_t i) const {
    const Expr left = momentum_rate_symbol(*out_.system, i);
    const Expr applied = expand_time_derivatives(shown_.generalized_forces[i] - shown_.dissipative_terms[i]);
    const Expr of_constraints =
        shown_.constraint_forces.empty() ? context_.number(0) : expand_time_derivatives(shown_.constraint_forces[i]);
    const auto total = [&](Expr gradient, Expr forces) {
      const Expr parts[] = {gradient, forces, tidy(of_constraints, out_.order)};
      return flat_sum(parts, context_);
    };
    const Expr q = shown_.system->coordinates[i].q;
    const Expr mixed = total(tidy(differentiate(shown_.lagrangian_expanded, q), out_.order), tidy(applied, out_.order));
    CanonicalEquation equation{left, {mixed, {}, {}}, has_velocities(mixed)};
    if (!equation.has_velocities || !out_.regular() || !out_.legendre.readable.value) return equation;
    const Expr h = out_.legendre.readable.value, plain = negative(differentiate(h, q));
    const Expr candidates[] = {tidy(plain, out_.order), plain, negative(slope(h, q, out_.order))};
    const Expr put_in = tidy(substitute(applied, explicit_velocities_), out_.order);
    const Expr pure = total(shortest(candidates, out_.order), put_in);
    if (has_velocities(pure)) return equation;  // a constraint that is not linear in the velocities
    if (length_of(pure, out_.order) <= std::max(comfortable, 4 * length_of(mixed, out_.order) / 3))
      equation = {left, {pure, {}, {}}, false};
    return equation;
  }

  Hamiltonian& out_;
  const EquationsOfMotion& shown_;
  Context& context_;
  ExprMap explicit_velocities_;
};

/// q' = ∂H/∂p and p' = −∂H/∂q + Q − ∂D/∂q̇, without Aᵀλ.
ExprVector canonical_flow(const Hamiltonian& h, const EquationsOfMotion& shown) {
  ExprVector positions;
  ExprMap velocities;
  for (const Coordinate& c : shown.system->coordinates) positions.push_back(c.q);
  ExprVector flow = gradient(h.value, h.momenta);
  for (std::size_t i = 0; i < positions.size(); ++i) velocities.emplace(shown.system->coordinates[i].velocity, flow[i]);
  const ExprVector slopes = gradient(h.value, positions);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Expr applied = expand_time_derivatives(shown.generalized_forces[i] - shown.dissipative_terms[i]);
    flow.push_back(substitute(applied, velocities) - slopes[i]);
  }
  return flow;
}

void add_legend(Hamiltonian& h, const EquationsOfMotion& shown) {
  ExprVector roots = shown.momenta;
  roots.push_back(shown.lagrangian_expanded);
  for (const auto* list : {&shown.generalized_forces, &shown.dissipative_terms})
    roots.insert(roots.end(), list->begin(), list->end());
  h.legend = definitions_used(*shown.system, roots);
}

}  // namespace

Hamiltonian hamiltonian(const EquationsOfMotion& equations) {
  const EquationsOfMotion& shown = equations.shown();
  Hamiltonian h;
  h.system = equations.system;
  h.order = shown.order;
  h.momentum_values = expand_time_derivatives(shown.momenta);
  for (std::size_t i = 0; i < shown.system->coordinates.size(); ++i) h.momenta.push_back(momentum_symbol(*h.system, i));
  for (const Expr& p : h.momenta) h.order.coordinates.push_back(p.context().symbol(p.name(), Role::Coordinate));
  std::vector<std::size_t> all(h.momenta.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  h.legendre = legendre_transform({*shown.system, h.order, shown.lagrangian_expanded, all, h.momenta});
  h.value = h.legendre.value;
  if (h.regular()) h.flow = canonical_flow(h, shown);
  if (h.value) CanonicalWriter(h, shown).write();
  add_legend(h, shown);
  return h;
}

std::vector<Expr> with_definitions(const MechanicalSystem& system, std::span<const Expr> expressions) {
  return substitute(expressions, system.definition_values());
}

Expr in_phase_space(Expr e, const Hamiltonian& h) {
  const Expr plain = expand_time_derivatives(e);
  ExprMap velocities;
  for (std::size_t i = 0; i < h.momenta.size(); ++i)
    if (h.regular()) velocities.emplace(h.system->coordinates[i].velocity, h.flow[i]);
  const Expr out = substitute(plain, velocities);
  return has_velocities(out) ? Expr() : out;
}

Expr phase_space::bracket_of(Expr a, Expr b, const ExprVector& positions, const ExprVector& momenta) {
  const ExprVector a_q = gradient(a, positions), a_p = gradient(a, momenta);
  const ExprVector b_q = gradient(b, positions), b_p = gradient(b, momenta);
  ExprVector terms;
  for (std::size_t i = 0; i < positions.size(); ++i) terms.push_back(a_q[i] * b_p[i] - a_p[i] * b_q[i]);
  return a.context().sum(terms);
}

ReadableForm phase_space::shown_bracket(Expr bracket, const ReadingOrder& order) {
  if (vanishes_identically(bracket)) return ReadableForm{bracket.context().number(0), {}, {}};
  ReadableForm form = readable(bracket, order);
  if (form.intermediates.empty()) form.value = tidy(bracket, order);
  return form;
}

std::optional<ReadableForm> poisson_bracket(Expr a, Expr b, const Hamiltonian& h) {
  check_argument(a && b, "poisson_bracket: one of the two has no formula");
  const Expr both[] = {in_phase_space(a, h), in_phase_space(b, h)};
  if (!both[0] || !both[1]) return std::nullopt;
  ExprVector positions;
  for (const Coordinate& c : h.system->coordinates) positions.push_back(c.q);
  return shown_bracket(bracket_of(both[0], both[1], positions, h.momenta), h.order);
}

}  // namespace maupertuis
