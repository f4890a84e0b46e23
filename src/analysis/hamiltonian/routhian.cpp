#include "analysis/hamiltonian/legendre.hpp"
#include "analysis/hamiltonian/proofs.hpp"
#include "analysis/hamiltonian/readable_choice.hpp"

#include <algorithm>
#include <array>

namespace maupertuis {

using namespace phase_space;

namespace {

constexpr std::size_t longest_routhian = 300, longest_row = 300;  // letters
constexpr std::size_t longest_raw_row =
    2500;  // of a row before it is made readable: beyond it that takes seconds, in vain

bool contains(const std::vector<std::size_t>& list, std::size_t i) {
  return std::find(list.begin(), list.end(), i) != list.end();
}

/// Routh's equations of the coordinates that stay, with the replaced momenta constant.
class ReducedEquations {
 public:
  ReducedEquations(const Routhian& r, const Hamiltonian& h, const EquationsOfMotion& shown)
      : r_(r), h_(h), shown_(shown) {
    for (const std::size_t i : r.replaced) {
      constant_.emplace(momentum_rate_symbol(*h.system, i), r.value.context().number(0));
      put_in_.emplace(h.system->coordinates[i].velocity, -differentiate(r.value, h.momenta[i]));
    }
  }

  ExprVector rows() const {
    ExprVector rows;
    for (const std::size_t i : r_.rest) {
      const Coordinate& c = h_.system->coordinates[i];
      const Expr inertia = substitute(total_time_derivative(differentiate(r_.value, c.velocity)), constant_);
      Expr forces = expand_time_derivatives(shown_.generalized_forces[i] - shown_.dissipative_terms[i]);
      if (!shown_.constraint_forces.empty()) forces = forces + expand_time_derivatives(shown_.constraint_forces[i]);
      rows.push_back(inertia - differentiate(r_.value, c.q) - substitute(forces, put_in_));
    }
    return rows;
  }

 private:
  const Routhian& r_;
  const Hamiltonian& h_;
  const EquationsOfMotion& shown_;
  ExprMap constant_, put_in_;
};

void write(Routhian& r, const Hamiltonian& h, const EquationsOfMotion& shown) {
  const Expr written = shortest(std::array{tidy(r.value, r.order), r.value}, r.order);
  if (length_of(written, r.order) > longest_routhian) return;
  r.readable.value = written;
  ExprMap at_rest;
  for (const std::size_t i : r.rest) at_rest.emplace(h.system->coordinates[i].velocity, r.value.context().number(0));
  const Expr potential = substitute(r.legendre.value, at_rest);
  r.effective_potential.value = tidy(potential, r.order);
  for (const std::size_t i : r.replaced) {
    const Expr plain = negative(differentiate(r.value, h.momenta[i]));
    const Expr candidates[] = {tidy(plain, r.order), plain, negative(slope(r.value, h.momenta[i], r.order))};
    r.velocities.push_back({h.system->coordinates[i].velocity, {shortest(candidates, r.order), {}, {}}, false});
  }
  if (!r.conserved || r.rest.empty()) return;
  ReadingOrder order = r.order;
  order.coordinates.clear();
  for (const std::size_t i : r.rest) order.coordinates.push_back(h.system->coordinates[i].q);
  const ExprVector rows = ReducedEquations(r, h, shown).rows();
  for (const Expr& row : rows)
    if (length_of(row, r.order) > longest_raw_row) return;
  r.equations = readable_equations(rows, order);
  for (std::size_t k = 0; k < rows.size();
       ++k) {  // the force of the effective potential, in which its squares stay factors
    const Expr q = order.coordinates[k], rest = rows[k] - differentiate(r.effective_potential.value, q);
    const ReadableForm inertia = readable_equations({&rest, 1}, order).front();
    if (!inertia.intermediates.empty() || !r.equations[k].intermediates.empty()) continue;
    const Expr parts[] = {inertia.value, slope(r.effective_potential.value, q, r.order)};
    const Expr candidates[] = {r.equations[k].value, flat_sum(parts, q.context())};
    r.equations[k].value = shortest(candidates, r.order);
  }
  for (const ReadableForm& row : r.equations)
    if (!row.intermediates.empty() || length_of(row.value, r.order) > longest_row) {
      r.equations.clear();
      return;
    }
}

}  // namespace

std::optional<Routhian> routhian(const EquationsOfMotion& equations, const Hamiltonian& h,
                                 const std::vector<std::size_t>* coordinates) {
  const EquationsOfMotion& shown = equations.shown();
  const std::vector<std::size_t> conserved = conserved_quantities(equations).conserved_momenta;
  Routhian r;
  r.replaced = coordinates ? *coordinates : conserved;
  if (r.replaced.empty()) return std::nullopt;
  std::sort(r.replaced.begin(), r.replaced.end());
  r.conserved =
      std::all_of(r.replaced.begin(), r.replaced.end(), [&](std::size_t i) { return contains(conserved, i); });
  for (std::size_t i = 0; i < h.momenta.size(); ++i)
    if (!contains(r.replaced, i)) r.rest.push_back(i);
  r.order = h.order;
  r.legendre = legendre_transform({*shown.system, h.order, shown.lagrangian_expanded, r.replaced, h.momenta});
  if (!r.legendre.value || r.legendre.has(LegendreKind::Singular)) return r;
  r.value = negative(r.legendre.value);
  write(r, h, shown);
  return r;
}

Certificate certify(const Routhian& r, const Hamiltonian& h, const EquationsOfMotion& equations) {
  const EquationsOfMotion& shown = equations.shown();
  Proofs proofs(h, equations);
  if (!r.value) return proofs.take();
  ExprMap momenta;
  Expr definition = shown.lagrangian_expanded;
  for (const std::size_t i : r.replaced) {
    momenta.emplace(h.momenta[i], h.momentum_values[i]);
    definition = definition - h.momentum_values[i] * h.system->coordinates[i].velocity;
  }
  ExprVector differences{substitute(r.value, momenta) - definition};
  const auto compare = [&](Expr of_r, Expr other) { differences.push_back(substitute(of_r, momenta) - other); };
  for (const Coordinate& c : h.system->coordinates)
    compare(differentiate(r.value, c.q), differentiate(shown.lagrangian_expanded, c.q));
  for (const std::size_t i : r.rest) {
    const Expr v = h.system->coordinates[i].velocity;
    compare(differentiate(r.value, v), differentiate(shown.lagrangian_expanded, v));
  }
  for (const std::size_t i : r.replaced)
    compare(-differentiate(r.value, h.momenta[i]), h.system->coordinates[i].velocity);
  proofs.add("routhian", "with p = ∂L/∂q' put in, R is L − Σ p q', ∂R/∂q is ∂L/∂q, ∂R/∂q' is ∂L/∂q', and ∂R/∂p is −q'",
             differences);

  if (!r.equations.empty()) {  // Lagrange's row is Routh's plus what a change of p would add
    const ExprVector balance = expand_time_derivatives(shown.balance());
    ExprVector rows;
    for (std::size_t k = 0; k < r.rest.size(); ++k) {
      const Expr inertia = differentiate(r.value, h.system->coordinates[r.rest[k]].velocity);
      Expr change = r.value.context().number(0);
      for (const std::size_t i : r.replaced)
        change = change + differentiate(inertia, h.momenta[i]) * total_time_derivative(h.momentum_values[i]);
      rows.push_back(substitute(r.equations[k].value + change, momenta) - balance[r.rest[k]]);
    }
    proofs.add("routh_equations", "with p' = 0 the reduced equations are Lagrange's", rows);
  }
  return proofs.take();
}

}  // namespace maupertuis
