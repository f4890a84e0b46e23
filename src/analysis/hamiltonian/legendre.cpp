#include "analysis/hamiltonian/legendre.hpp"

#include "analysis/hamiltonian/readable_choice.hpp"

#include <maupertuis/evaluate.hpp>
#include <maupertuis/linear_system.hpp>
#include <maupertuis/scattered_point.hpp>

#include <algorithm>
#include <cmath>

namespace maupertuis {

bool LegendreTransform::has(LegendreKind kind) const {
  return std::any_of(blocks.begin(), blocks.end(), [&](const LegendreBlock& block) { return block.kind == kind; });
}

Expr LegendreTransform::velocity(std::size_t coordinate) const {
  for (const LegendreBlock& block : blocks)
    for (std::size_t i = 0; i < block.coordinates.size(); ++i)
      if (block.coordinates[i] == coordinate) return block.velocities[i];
  return {};
}

}  // namespace maupertuis

namespace maupertuis::phase_space {

bool may_vanish(Expr e) { return e.is_zero() || zero_test(e).verdict != Verdict::Nonzero; }

ExprVector reduced_momenta(const LegendreBlock& block, const LegendreProblem& problem) {
  ExprVector reduced;
  for (std::size_t i = 0; i < block.coordinates.size(); ++i)
    reduced.push_back(difference(problem.momenta[block.coordinates[i]], block.shift[i]));
  return reduced;
}

ExprMatrix augmented(const ExprMatrix& matrix, const ExprVector& column) {
  ExprMatrix out{matrix.rows, matrix.columns + 1, {}};
  for (std::size_t i = 0; i < matrix.rows; ++i) {
    for (std::size_t j = 0; j < matrix.columns; ++j) out.entries.push_back(matrix.at(i, j));
    out.entries.push_back(column[i]);
  }
  return out;
}

namespace {

class Transform {
 public:
  explicit Transform(const LegendreProblem& problem) : problem_(problem), context_(*problem.system.context) {
    for (const std::size_t i : problem.replaced) velocities_.push_back(problem.system.coordinates[i].velocity);
    momenta_ = gradient(problem.lagrangian, velocities_);
    const std::size_t n = velocities_.size();
    mass_ = {n, n, {}};
    for (const Expr& p : momenta_)
      for (const Expr& entry : gradient(p, velocities_)) mass_.entries.push_back(entry);
    const std::vector<bool> plain = maybe_numbers();
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j)
        mass_.at(i, j) = j < i              ? mass_.at(j, i)
                         : plain[i * n + j] ? with_visible_zeros(mass_.at(i, j))
                                            : mass_.at(i, j);
  }

  LegendreTransform carry_out() {
    LegendreTransform out;
    Expr remaining = problem_.lagrangian;
    for (const std::vector<std::size_t>& rows : coupled_rows(mass_)) {
      out.blocks.push_back(block_of(rows));
      const auto root = roots_.find(out.blocks.size() - 1);
      if (root != roots_.end()) remaining = substitute(remaining, {{root->second, context_.number(0)}});
    }
    out.at_rest = tidy(-substitute(remaining, at_rest(velocities_)), problem_.order);
    add_up(out);
    return out;
  }

 private:
  /// Which entries of M have the same value at two points with the same parameters: those alone may be numbers.
  std::vector<bool> maybe_numbers() const {
    constexpr double rounding = 1e-9;
    const std::vector<Expr> symbols = symbols_of(mass_.entries);
    const std::vector<double> a = evaluate(mass_.entries, scattered_point(symbols, 0)),
                              b = evaluate(mass_.entries, scattered_point(symbols, 1));
    std::vector<bool> out;
    const std::size_t n = velocities_.size();
    for (std::size_t k = 0; k < a.size(); ++k) {
      const double beside = std::sqrt(std::abs(a[k / n * (n + 1)] * a[k % n * (n + 1)]));  // of M_ii M_jj
      out.push_back(!(std::abs(a[k] - b[k]) > rounding * (std::abs(a[k]) + std::abs(b[k]) + 1e-3 * beside)));
    }
    return out;
  }

  /// An entry that vanishes becomes 0; others keep their form, of which readable ones are made.
  static Expr with_visible_zeros(Expr e) {
    const Expr canonical = fourier_form(e);
    return canonical && (canonical.is_zero() || canonical.is_number()) ? canonical : e;
  }

  ExprMap at_rest(const ExprVector& velocities) const {
    ExprMap map;
    for (const Expr& v : velocities) map.emplace(v, context_.number(0));
    return map;
  }

  bool has_velocities(Expr e) const {
    for (const Expr& s : symbols_of({&e, 1}))
      if (std::find(velocities_.begin(), velocities_.end(), s) != velocities_.end()) return true;
    return false;
  }

  LegendreBlock block_of(const std::vector<std::size_t>& rows) {
    LegendreBlock block;
    block.mass = {rows.size(), rows.size(), {}};
    const bool is_solved = rows.size() <= largest_eliminated;  // else nobody reads n² entries of M one by one
    ExprVector own;
    bool quadratic = true;
    for (const std::size_t i : rows) {
      block.coordinates.push_back(problem_.replaced[i]);
      own.push_back(velocities_[i]);
      for (const std::size_t j : rows) {
        const std::size_t k = block.mass.entries.size(), row = k / rows.size(), column = k % rows.size();
        block.mass.entries.push_back(column < row ? block.mass.at(column, row)
                                     : is_solved  ? tidy(mass_.at(i, j), problem_.order)
                                                  : mass_.at(i, j));
        quadratic &= !has_velocities(mass_.at(i, j));
      }
    }
    block.velocities.resize(rows.size());
    if (const auto root = quadratic ? std::nullopt : root_lagrangian(problem_, block.coordinates)) {
      roots_.emplace(blocks_, root->root);
      transform_root(block, *root, problem_);
    } else if (!quadratic || !is_solved) {
      block.kind = LegendreKind::Unsolved;
    } else {
      for (const std::size_t i : rows)
        block.shift.push_back(tidy(substitute(momenta_[i], at_rest(own)), problem_.order));
      transform_quadratic(block, problem_);
    }
    ++blocks_;
    return block;
  }

  void add_up(LegendreTransform& out) const {
    if (out.has(LegendreKind::Unsolved)) return;
    ExprVector parts;
    bool is_readable = true;
    for (const LegendreBlock& block : out.blocks) {
      parts.push_back(block.energy);
      is_readable &= block.energy_is_readable;
    }
    parts.push_back(out.at_rest);
    out.value = flat_sum(parts, context_);
    if (!is_readable) return;
    // (p_x + m Ω y)²/2m − ½ m Ω² y² is Ω y p_x + p_x²/2m: what the completed squares hide may cancel.
    const ReadableForm expanded = readable(out.value, problem_.order);
    const Expr candidates[] = {out.value, expanded.intermediates.empty() ? expanded.value : Expr()};
    out.value = shortest(candidates, problem_.order);
    out.readable.value = out.value;
  }

  const LegendreProblem& problem_;
  Context& context_;
  ExprVector velocities_, momenta_;
  ExprMatrix mass_;
  std::size_t blocks_ = 0;
  std::unordered_map<std::size_t, Expr> roots_;  // by block: √w, which belongs to the block's energy
};

}  // namespace

LegendreTransform legendre_transform(const LegendreProblem& problem) { return Transform(problem).carry_out(); }

}  // namespace maupertuis::phase_space
