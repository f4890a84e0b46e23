#include "analysis/tangent/extended_source.hpp"

#include <maupertuis/motion_kernel.hpp>
#include <maupertuis/variation.hpp>

#include <fmt/format.h>

namespace maupertuis::tangent {
namespace {

/// Names with a blank: no symbol of a model has one.
Expr direction_symbol(Expr of, std::size_t column) {
  return of.context().symbol(fmt::format("δ{} {}", column + 1, of.name()), of.role());
}

}  // namespace

KernelSource extended_source(const EquationsOfMotion& equations, std::size_t columns) {
  const KernelSource motion = motion_source(equations);
  KernelSource out = motion;
  ExprVector varied = motion.residual;
  for (const KernelConstraint& c : motion.constraints) varied.push_back(c.value);
  for (std::size_t j = 0; j < columns; ++j) {
    ExprMap directions;
    for (const auto& [from, to] :
         {std::pair(&motion.coordinates, &out.coordinates), std::pair(&motion.multipliers, &out.multipliers)})
      for (const Expr& symbol : *from) directions.emplace(symbol, to->emplace_back(direction_symbol(symbol, j)));
    const ExprVector rows = variation(varied, directions);
    for (std::size_t i = 0; i < motion.residual.size(); ++i) out.residual.push_back(rows[i]);
    for (std::size_t i = 0; i < motion.constraints.size(); ++i)
      out.constraints.push_back(
          {rows[motion.residual.size() + i], motion.constraints[i].level, motion.constraints[i].name});
  }
  return out;
}

}  // namespace maupertuis::tangent
