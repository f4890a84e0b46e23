#include <maupertuis/equations_of_motion.hpp>
#include <maupertuis/evaluate.hpp>
#include <maupertuis/linear_system.hpp>

#include "equations/simplified.hpp"

#include <functional>
#include <numeric>

namespace maupertuis {
namespace {

/// numerator / denominator, both readable, so that common factors have a chance to cancel in the constructor.
ReadableForm quotient(Expr numerator, Expr denominator, const ReadingOrder& order) {
  ReadableForm top = readable(numerator, order), bottom = readable(denominator, order);
  ReadableForm result = readable(top.value / bottom.value, order);
  for (auto* part : {&top, &bottom})
    for (Intermediate& intermediate : part->intermediates) result.intermediates.push_back(std::move(intermediate));
  return result;
}

bool vanishes(Expr e) { return e.is_zero() || zero_test(e).verdict != Verdict::Nonzero; }

std::vector<SolvedAcceleration> solved_for(const EquationsOfMotion& equations, const ExprVector& h) {
  const std::size_t n = equations.system->coordinates.size();
  ExprMatrix m = mass_matrix(equations);
  for (Expr& entry : m.entries)
    if (const Expr canonical = fourier_form(entry)) entry = canonical;  // zeros become visible to the grouping

  std::vector<SolvedAcceleration> solved(n);
  for (const auto& block : coupled_rows(m)) {
    for (const std::size_t i : block) {
      solved[i].coordinate = i;
      solved[i].coupled_with = block;
    }
    if (block.size() == 1) {
      const std::size_t i = block[0];
      if (!vanishes(m.at(i, i))) solved[i].right = quotient(-h[i], m.at(i, i), equations.order);
    } else if (block.size() == 2) {
      const std::size_t i = block[0], j = block[1];
      const Expr determinant = m.at(i, i) * m.at(j, j) - m.at(i, j) * m.at(j, i);
      if (vanishes(determinant)) continue;
      solved[i].right = quotient(m.at(i, j) * h[j] - m.at(j, j) * h[i], determinant, equations.order);
      solved[j].right = quotient(m.at(j, i) * h[i] - m.at(i, i) * h[j], determinant, equations.order);
    }
  }
  return solved;
}

Expr row_times(const ExprMatrix& a, std::size_t row, const ExprVector& x) {
  ExprVector terms;
  for (std::size_t i = 0; i < x.size(); ++i) terms.push_back(a.at(row, i) * x[i]);
  return x.front().context().sum(terms);
}

/// M⁻¹ applied to a vector, block by block; empty where a block is singular or larger than two.
ExprVector apply_inverse_mass(const EquationsOfMotion& equations, const ExprVector& vector) {
  ExprVector negated, result;
  for (const Expr& entry : vector) negated.push_back(-entry);
  for (const SolvedAcceleration& solved : solved_for(equations, negated)) {
    if (!solved.right.value || !solved.right.intermediates.empty()) return {};
    result.push_back(solved.right.value);
  }
  return result;
}

}  // namespace

std::vector<std::vector<std::size_t>> coupled_rows(const ExprMatrix& m) {
  std::vector<std::size_t> leader(m.rows);
  std::iota(leader.begin(), leader.end(), std::size_t{0});
  const std::function<std::size_t(std::size_t)> find = [&](std::size_t i) {
    return leader[i] == i ? i : leader[i] = find(leader[i]);
  };
  for (std::size_t i = 0; i < m.rows; ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (!m.at(i, j).is_zero() || !m.at(j, i).is_zero()) leader[find(i)] = find(j);
  std::vector<std::vector<std::size_t>> blocks(m.rows);
  for (std::size_t i = 0; i < m.rows; ++i) blocks[find(i)].push_back(i);
  std::erase_if(blocks, [](const auto& block) { return block.empty(); });
  return blocks;
}

std::vector<SolvedAcceleration> solved_accelerations(const EquationsOfMotion& equations) {
  ExprVector h = bias(equations);
  for (std::size_t i = 0; i < equations.constraint_forces.size(); ++i) h[i] = h[i] - equations.constraint_forces[i];
  return solved_for(equations, h);
}

std::vector<ReadableForm> solved_multipliers(const EquationsOfMotion& equations) {
  const ExprMatrix a = constraint_matrix(equations);
  if (a.rows == 0 || a.rows > 2) return {};
  // λ = (A M⁻¹ Aᵀ)⁻¹ (b + A M⁻¹ h)
  const ExprVector drift = apply_inverse_mass(equations, bias(equations)), b = constraint_bias(equations);
  if (drift.empty()) return {};
  ExprMatrix g{a.rows, a.rows, {}};
  ExprVector c;
  for (std::size_t k = 0; k < a.rows; ++k) {
    const ExprVector column(a.entries.begin() + static_cast<std::ptrdiff_t>(k * a.columns),
                            a.entries.begin() + static_cast<std::ptrdiff_t>((k + 1) * a.columns));
    const ExprVector response = apply_inverse_mass(equations, column);
    for (std::size_t l = 0; l < a.rows; ++l) g.entries.push_back(simplified(row_times(a, l, response), equations.order));
    c.push_back(b[k] + row_times(a, k, drift));
  }
  if (a.rows == 1) return vanishes(g.entries[0]) ? std::vector<ReadableForm>{} : std::vector{quotient(c[0], g.entries[0], equations.order)};
  const Expr determinant = g.at(0, 0) * g.at(1, 1) - g.at(0, 1) * g.at(1, 0);
  if (vanishes(determinant)) return {};
  return {quotient(g.at(1, 1) * c[0] - g.at(0, 1) * c[1], determinant, equations.order),
          quotient(g.at(0, 0) * c[1] - g.at(1, 0) * c[0], determinant, equations.order)};
}

}  // namespace maupertuis
