#include <maupertuis/equations_of_motion.hpp>

#include <functional>
#include <numeric>

namespace maupertuis {
namespace {

/// Groups of coordinates that M couples, directly or through others; each group ascending.
std::vector<std::vector<std::size_t>> blocks_of(const ExprMatrix& m) {
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

/// numerator / denominator, both readable, so that common factors have a chance to cancel in the constructor.
ReadableForm quotient(Expr numerator, Expr denominator, const ReadingOrder& order) {
  ReadableForm top = readable(numerator, order), bottom = readable(denominator, order);
  ReadableForm result = readable(top.value / bottom.value, order);
  for (auto* part : {&top, &bottom})
    for (Intermediate& intermediate : part->intermediates) result.intermediates.push_back(std::move(intermediate));
  return result;
}

}  // namespace

std::vector<SolvedAcceleration> solved_accelerations(const EquationsOfMotion& equations) {
  const std::size_t n = equations.system->coordinates.size();
  ExprMatrix m = mass_matrix(equations);
  const ExprVector h = bias(equations);
  for (Expr& entry : m.entries)
    if (const Expr canonical = fourier_form(entry)) entry = canonical;  // zeros become visible to the grouping

  std::vector<SolvedAcceleration> solved(n);
  for (const auto& block : blocks_of(m)) {
    for (const std::size_t i : block) {
      solved[i].coordinate = i;
      solved[i].coupled_with = block;
    }
    if (block.size() == 1) {
      const std::size_t i = block[0];
      solved[i].right = quotient(-h[i], m.at(i, i), equations.order);
    } else if (block.size() == 2) {
      const std::size_t i = block[0], j = block[1];
      const Expr determinant = m.at(i, i) * m.at(j, j) - m.at(i, j) * m.at(j, i);
      solved[i].right = quotient(m.at(i, j) * h[j] - m.at(j, j) * h[i], determinant, equations.order);
      solved[j].right = quotient(m.at(j, i) * h[i] - m.at(i, i) * h[j], determinant, equations.order);
    }
  }
  return solved;
}

}  // namespace maupertuis
