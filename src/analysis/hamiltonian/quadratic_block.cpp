#include "analysis/hamiltonian/legendre.hpp"
#include "analysis/hamiltonian/readable_choice.hpp"

#include <maupertuis/integral_symbol.hpp>
#include <maupertuis/linear_system.hpp>

#include <algorithm>
#include <numeric>

/// ½ πᵀM⁻¹π in forms that a textbook prints: completed squares in some order of elimination, or Cramer's rule.
namespace maupertuis::phase_space {
namespace {

constexpr std::size_t largest_written = 3;   // coordinates of a group whose M⁻¹ is tried in symbols
constexpr std::size_t longest_energy = 240;  // letters

/// π²/2D, without fractions inside the square.
Expr square_over(Expr pi, Expr d, const ReadingOrder& order) {
  const Cleared fraction = cleared(pi, order), bar = cleared(d, order);
  const Expr square = Rational(1, 2) * pow(fraction.numerator, 2);
  const Expr candidates[] = {over(over(square, pow(fraction.denominator, 2)), d),
                             over(over(square * bar.denominator, pow(fraction.denominator, 2)), bar.numerator)};
  return shortest(candidates, order);
}

/// M = L D Lᵀ in the given order: Σ (L⁻¹π)²/2D. Empty where a pivot vanishes or an entry gets too long.
Expr completed_squares(ExprMatrix m, ExprVector pi, const std::vector<std::size_t>& sequence,
                       const ReadingOrder& order) {
  Context& context = pi.front().context();
  ExprVector terms;
  const auto simplify = [&](Expr e) {
    const Expr simple = tidy(e, order);
    return length_of(simple, order) > longest_energy ? Expr() : simple;
  };
  for (std::size_t step = 0; step < sequence.size(); ++step) {
    const std::size_t k = sequence[step];
    if (may_vanish(m.at(k, k))) return {};
    terms.push_back(square_over(pi[k], m.at(k, k), order));
    for (std::size_t rest = step + 1; rest < sequence.size(); ++rest) {
      const std::size_t i = sequence[rest];
      if (m.at(i, k).is_zero()) continue;
      const Expr factor = simplify(over(m.at(i, k), m.at(k, k)));
      if (!factor || !(pi[i] = simplify(pi[i] - factor * pi[k]))) return {};
      for (std::size_t later = step + 1; later < sequence.size(); ++later) {
        Expr& entry = m.at(i, sequence[later]);
        if (!(entry = simplify(entry - factor * m.at(k, sequence[later])))) return {};
      }
    }
  }
  return flat_sum(terms, context);
}

/// (M₂₂ π₁² − 2 M₁₂ π₁ π₂ + M₁₁ π₂²) / 2 det M
Expr cramer(const ExprMatrix& m, const ExprVector& pi, const ReadingOrder& order) {
  const Expr determinant = tidy(m.at(0, 0) * m.at(1, 1) - m.at(0, 1) * m.at(1, 0), order);
  const Expr top = m.at(1, 1) * pow(pi[0], 2) - 2 * m.at(0, 1) * pi[0] * pi[1] + m.at(0, 0) * pow(pi[1], 2);
  return over(Rational(1, 2) * tidy(top, order), determinant);
}

/// Three angles of a body whose kinetic energy is ½ Σ I_k ω_k², ω = W q̇: with the angular momenta W⁻ᵀπ about its own
/// axes H = Σ (W⁻ᵀπ)_k²/2I_k. Empty where M is another matrix.
Expr by_body_axes(const LegendreBlock& block, const ExprVector& pi, const Body& body, const LegendreProblem& problem) {
  const std::size_t n = 3;
  if (pi.size() != n || body.inertia.rows != n || body.angular_velocity.size() != n) return {};
  ExprVector velocities;
  for (const std::size_t i : block.coordinates) velocities.push_back(problem.system.coordinates[i].velocity);
  ExprMatrix transposed{n, n, ExprVector(n * n)};
  for (std::size_t k = 0; k < n; ++k) {
    const ExprVector row = gradient(expand_time_derivatives(body.angular_velocity[k]), velocities);
    for (std::size_t i = 0; i < n; ++i) transposed.at(i, k) = row[i];
    for (std::size_t j = 0; j < k; ++j)
      if (!body.inertia.at(k, j).is_zero()) return {};
  }
  ExprVector differences;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      Expr sum = -block.mass.at(i, j);
      for (std::size_t k = 0; k < n; ++k) sum = sum + body.inertia.at(k, k) * transposed.at(i, k) * transposed.at(j, k);
      differences.push_back(sum);
    }
  if (zero_test(differences).verdict != Verdict::Zero) return {};
  const auto momenta = solve_linear(augmented(transposed, pi));
  if (!momenta) return {};
  ExprVector terms;
  for (std::size_t k = 0; k < n; ++k) terms.push_back(square_over((*momenta)[k], body.inertia.at(k, k), problem.order));
  return flat_sum(terms, *problem.system.context);
}

Expr shortest_energy(const LegendreBlock& block, const ExprVector& pi, const LegendreProblem& problem) {
  const ReadingOrder& order = problem.order;
  ExprVector candidates;
  for (const Body& body : problem.system.bodies) {
    const Expr squares = by_body_axes(block, pi, body, problem);
    if (!squares) continue;
    const ExprMatrix& inertia = body.inertia;
    const bool asymmetric = inertia.at(0, 0) != inertia.at(1, 1) && inertia.at(1, 1) != inertia.at(2, 2) &&
                            inertia.at(2, 2) != inertia.at(0, 0);
    if (asymmetric) return squares;  // eliminating in some order gives nothing shorter
    candidates.push_back(squares);
  }
  std::vector<std::size_t> sequence(pi.size());
  std::iota(sequence.begin(), sequence.end(), std::size_t{0});
  do {
    if (const Expr squares = completed_squares(block.mass, pi, sequence, order)) {
      candidates.push_back(squares);
      candidates.push_back(tidy(squares, order));
    }
  } while (std::next_permutation(sequence.begin(), sequence.end()));
  if (pi.size() == 2) {
    candidates.push_back(cramer(block.mass, pi, order));
    candidates.push_back(tidy(candidates.back(), order));
  }
  return shortest(candidates, order);
}

Expr half_product(const ExprVector& pi, const ExprVector& velocities) {
  ExprVector terms;
  for (std::size_t i = 0; i < pi.size(); ++i) terms.push_back(Rational(1, 2) * (pi[i] * velocities[i]));
  return pi.front().context().sum(terms);
}

// ------------------------------------------------------------------------------------------------------- singular

/// Rows of M that are no combination of those before them.
std::vector<std::size_t> independent_rows(const ExprMatrix& m) {
  std::vector<std::size_t> kept;
  std::vector<std::pair<std::size_t, ExprVector>> echelon;  // pivot column, row
  for (std::size_t i = 0; i < m.rows; ++i) {
    ExprVector row(m.entries.begin() + static_cast<std::ptrdiff_t>(i * m.columns),
                   m.entries.begin() + static_cast<std::ptrdiff_t>((i + 1) * m.columns));
    for (const auto& [column, pivot] : echelon) {
      const Expr factor = row[column] / pivot[column];
      for (std::size_t j = 0; j < row.size(); ++j)
        row[j] = j == column ? m.entries[0].context().number(0) : row[j] - factor * pivot[j];
    }
    const auto entry = std::find_if(row.begin(), row.end(), [](Expr e) { return !may_vanish(e); });
    if (entry == row.end()) continue;
    kept.push_back(i);
    echelon.emplace_back(static_cast<std::size_t>(entry - row.begin()), std::move(row));
  }
  return kept;
}

/// M n = 0 for the gradient n of a holonomic constraint: n·π is the shortest primary constraint, q·p = 0 of a
/// quaternion.
Expr null_vector_constraint(const LegendreBlock& block, const ExprVector& pi, const Constraint& c,
                            const LegendreProblem& problem) {
  if (c.level != Constraint::Level::Position) return {};
  ExprVector positions;
  for (const std::size_t i : block.coordinates) positions.push_back(problem.system.coordinates[i].q);
  const ExprVector n = gradient(c.value, positions);
  Context& context = *problem.system.context;
  for (std::size_t i = 0; i < n.size(); ++i) {
    ExprVector terms;
    for (std::size_t j = 0; j < n.size(); ++j) terms.push_back(block.mass.at(i, j) * n[j]);
    if (!may_vanish(context.sum(terms))) return {};
  }
  ExprVector terms;
  for (std::size_t i = 0; i < n.size(); ++i) terms.push_back(n[i] * pi[i]);
  const Expr value = context.sum(terms);
  return may_vanish(value) ? Expr() : tidy(value, problem.order);
}

ExprMatrix submatrix(const ExprMatrix& m, const std::vector<std::size_t>& rows) {
  ExprMatrix out{rows.size(), rows.size(), {}};
  for (const std::size_t i : rows)
    for (const std::size_t j : rows) out.entries.push_back(m.at(i, j));
  return out;
}

/// R p = 0 and p = 0, 2 (a x + b y) = 0, 2 a x + 2 b y = 0 and a x + b y = 0 say the same.
Expr without_factor(Expr e) {
  Expr rest = split_coefficient(e).rest;
  const auto has_momentum = [](Expr x) {
    const ExprVector symbols = symbols_of({&x, 1});
    return std::any_of(symbols.begin(), symbols.end(), [](Expr s) { return is_integral(s.name()); });
  };
  if (rest.is(Kind::Product)) {
    Expr product = e.context().number(1);
    for (std::size_t i = 0; i < rest.size(); ++i)
      if (has_momentum(rest[i])) product = product * rest[i];
    rest = product;
  }
  if (!rest.is(Kind::Sum)) return rest;
  Rational first = split_coefficient(rest[0]).coefficient;
  for (std::size_t i = 0; i < rest.size(); ++i)  // a momentum alone is positive: p_x − q B y
    if (const ScaledTerm term = split_coefficient(rest[i]); term.rest.is_symbol() && is_integral(term.rest.name()))
      first = term.coefficient;
  ExprVector terms;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    if (abs(split_coefficient(rest[i]).coefficient) != abs(first)) return rest;
    terms.push_back(rest[i] / first);
  }
  return e.context().sum(terms);
}

void transform_singular(LegendreBlock& block, const ExprVector& pi, const LegendreProblem& problem) {
  block.kind = LegendreKind::Singular;
  Context& context = *problem.system.context;
  const std::vector<std::size_t> kept = independent_rows(block.mass);
  const ExprMatrix core = submatrix(block.mass, kept);
  ExprVector right;
  for (const std::size_t i : kept) right.push_back(pi[i]);
  block.energy = context.number(0);
  if (!kept.empty()) {
    const auto solved = solve_linear(augmented(core, right));
    if (!solved) throw std::logic_error("a principal part of M is singular; please report");
    block.energy = half_product(right, *solved);
  }
  const Expr short_energy = tidy(block.energy, problem.order);
  block.energy_is_readable = length_of(short_energy, problem.order) <= longest_energy;
  if (block.energy_is_readable) block.energy = short_energy;

  for (const Constraint& c : problem.system.constraints)
    if (block.primary_constraints.size() + kept.size() < block.coordinates.size())
      if (const Expr value = null_vector_constraint(block, pi, c, problem))
        block.primary_constraints.push_back(without_factor(value));
  if (block.primary_constraints.size() + kept.size() == block.coordinates.size()) return;
  block.primary_constraints.clear();
  for (std::size_t k = 0; k < block.coordinates.size(); ++k) {
    if (std::find(kept.begin(), kept.end(), k) != kept.end()) continue;
    Expr value = pi[k];
    if (!kept.empty()) {
      ExprVector column;
      for (const std::size_t i : kept) column.push_back(block.mass.at(i, k));
      const auto weights = solve_linear(augmented(core, column));
      for (std::size_t i = 0; i < kept.size(); ++i) value = value - (*weights)[i] * right[i];
    }
    block.primary_constraints.push_back(without_factor(cleared(value, problem.order).numerator));
  }
}

}  // namespace

void transform_quadratic(LegendreBlock& block, const LegendreProblem& problem) {
  const ExprVector pi = reduced_momenta(block, problem);
  const auto solved = solve_linear(augmented(block.mass, pi));
  if (!solved) return transform_singular(block, pi, problem);
  block.velocities = *solved;
  block.kind = LegendreKind::Implicit;
  block.energy = half_product(pi, *solved);
  if (pi.size() > largest_written) return;
  const Expr written = shortest_energy(block, pi, problem);
  if (!written || length_of(written, problem.order) > longest_energy) return;
  block.kind = LegendreKind::Quadratic;
  block.energy = written;
  block.energy_is_readable = true;
}

}  // namespace maupertuis::phase_space
