#include <maupertuis/equations_of_motion.hpp>
#include <maupertuis/evaluate.hpp>
#include <maupertuis/linear_system.hpp>
#include <maupertuis/print.hpp>
#include <maupertuis/seen_nonzero.hpp>

#include "equations/multiplier_forces.hpp"
#include "equations/simplified.hpp"

#include <functional>
#include <map>
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

bool may_vanish(Expr e) { return e.is_zero() || zero_test(e).verdict != Verdict::Nonzero; }

/// Cramer's rule for a block of three to six coupled rows, as long as what it writes stays short:
///
///     q̈_j = −Σ_i C_ij h_i / det M,      C_ij the cofactor of M_ij
///
/// Minors are expanded along their first row; each occurs once, whatever asks for it, in canonical form, so that what
/// cancels is gone before it is multiplied on.
class LargeBlock {
 public:
  static constexpr std::size_t largest = 6;  // rows

  LargeBlock(const ExprMatrix& m, const std::vector<std::size_t>& block) : m_(m), block_(block) {}

  /// Right sides in the order of the block; empty where one is too long, or M is singular.
  std::vector<ReadableForm> solve(const ExprVector& h, const ReadingOrder& order) {
    const std::size_t n = block_.size();
    const unsigned all = (1u << n) - 1;
    const Expr determinant = minor(all, all);
    if (!determinant || may_vanish(determinant)) return {};
    std::vector<ReadableForm> out;
    for (std::size_t j = 0; j < n; ++j) {
      ExprVector terms;
      for (std::size_t i = 0; i < n; ++i) {
        const Expr cofactor = minor(all & ~(1u << i), all & ~(1u << j));
        if (!cofactor) return {};
        terms.push_back((i + j) % 2 == 0 ? -(cofactor * h[block_[i]]) : cofactor * h[block_[i]]);
      }
      const Expr numerator = fourier_form(determinant.context().sum(terms), most_terms);
      if (!numerator) return {};
      out.push_back(quotient(numerator, determinant, order));
      if (!out.back().intermediates.empty() || to_plain(out.back().value, order).size() > longest) return {};
    }
    return out;
  }

 private:
  static constexpr std::size_t most_terms = 120, longest = 400;  // of a sum, in characters

  /// The determinant of the rows and columns whose bits are set, as many of each; an empty handle where it is long.
  Expr minor(unsigned rows, unsigned columns) {
    if (rows == 0) return m_.entries.front().context().number(1);
    const auto [known, is_new] = minors_.try_emplace({rows, columns});
    if (!is_new) return known->second;
    std::size_t row = 0;
    while (!(rows >> row & 1)) ++row;
    ExprVector terms;
    bool negative = false;
    for (std::size_t column = 0; column < block_.size(); ++column) {
      if (!(columns >> column & 1)) continue;
      const Expr entry = m_.at(block_[row], block_[column]);
      const Expr rest = entry.is_zero() ? entry : minor(rows & ~(1u << row), columns & ~(1u << column));
      if (!rest) return minors_[{rows, columns}] = Expr();
      terms.push_back(negative ? -(entry * rest) : entry * rest);
      negative = !negative;
    }
    return minors_[{rows, columns}] = fourier_form(m_.entries.front().context().sum(terms), most_terms);
  }

  const ExprMatrix& m_;
  const std::vector<std::size_t>& block_;
  std::map<std::pair<unsigned, unsigned>, Expr> minors_;
};

void make_canonical(Expr& entry) {
  if (const Expr canonical = fourier_form(entry)) entry = canonical;
}

std::vector<SolvedAcceleration> solved_for(const EquationsOfMotion& equations, const ExprVector& h) {
  const std::size_t n = equations.system->coordinates.size();
  ExprMatrix m = mass_matrix(equations);
  const std::vector<bool> seen = seen_nonzero(expand_time_derivatives(m.entries));
  for (std::size_t k = 0; k < seen.size(); ++k)
    if (!seen[k]) make_canonical(m.entries[k]);  // zeros become visible to the grouping

  std::vector<SolvedAcceleration> solved(n);
  for (const auto& block : coupled_rows(m)) {
    for (const std::size_t i : block) {
      solved[i].coordinate = i;
      solved[i].coupled_with = block;
    }
    if (block.size() > LargeBlock::largest) continue;
    for (const std::size_t i : block)
      for (const std::size_t j : block)
        if (seen[i * n + j]) make_canonical(m.at(i, j));
    if (block.size() == 1) {
      const std::size_t i = block[0];
      if (!may_vanish(m.at(i, i))) solved[i].right = quotient(-h[i], m.at(i, i), equations.order);
    } else if (block.size() == 2) {
      const std::size_t i = block[0], j = block[1];
      const Expr determinant = m.at(i, i) * m.at(j, j) - m.at(i, j) * m.at(j, i);
      if (may_vanish(determinant)) continue;
      solved[i].right = quotient(m.at(i, j) * h[j] - m.at(j, j) * h[i], determinant, equations.order);
      solved[j].right = quotient(m.at(j, i) * h[i] - m.at(i, i) * h[j], determinant, equations.order);
    } else {
      const std::vector<ReadableForm> rights = LargeBlock(m, block).solve(h, equations.order);
      for (std::size_t k = 0; k < rights.size(); ++k) solved[block[k]].right = rights[k];
    }
  }
  return solved;
}

ExprVector at_rest(const EquationsOfMotion& equations, const ExprVector& residual) {
  ExprMap still;
  for (const Coordinate& c : equations.system->coordinates)
    still.emplace(c.acceleration, equations.system->context->number(0));
  return substitute(residual, still);
}

Expr row_times(const ExprMatrix& a, std::size_t row, const ExprVector& x) {
  ExprVector terms;
  for (std::size_t i = 0; i < x.size(); ++i) terms.push_back(a.at(row, i) * x[i]);
  return x.front().context().sum(terms);
}

/// M⁻¹ applied to a vector, block by block; empty where a block is singular or too long to be solved.
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
  const auto forces = multiplier_forces(equations);
  if (!forces) return {};
  // λ = (A M⁻¹ F)⁻¹ (b + A M⁻¹ h₀), F = Aᵀ where no friction is made of λ
  const ExprVector drift = apply_inverse_mass(equations, at_rest(equations, forces->residual));
  const ExprVector b = constraint_bias(equations);
  if (drift.empty()) return {};
  ExprMatrix g{a.rows, a.rows, ExprVector(a.rows * a.rows, drift.front().context().number(0))};
  ExprVector c;
  for (std::size_t k = 0; k < a.rows; ++k) {
    const auto row = forces->rows.entries.begin() + static_cast<std::ptrdiff_t>(k * a.columns);
    const ExprVector response = apply_inverse_mass(equations, {row, row + static_cast<std::ptrdiff_t>(a.columns)});
    for (std::size_t l = 0; l < a.rows; ++l) g.at(l, k) = simplified(row_times(a, l, response), equations.order);
    c.push_back(b[k] + row_times(a, k, drift));
  }
  if (a.rows == 1)
    return may_vanish(g.entries[0]) ? std::vector<ReadableForm>{}
                                    : std::vector{quotient(c[0], g.entries[0], equations.order)};
  const Expr determinant = g.at(0, 0) * g.at(1, 1) - g.at(0, 1) * g.at(1, 0);
  if (may_vanish(determinant)) return {};
  return {quotient(g.at(1, 1) * c[0] - g.at(0, 1) * c[1], determinant, equations.order),
          quotient(g.at(0, 0) * c[1] - g.at(1, 0) * c[0], determinant, equations.order)};
}

}  // namespace maupertuis
