#include <maupertuis/require.hpp>
#include <maupertuis/transform.hpp>

#include "symbolic/transform/reverse_sweep.hpp"

namespace maupertuis {

std::vector<Expr> gradient(Expr e, std::span<const Expr> symbols) {
  MAUP_REQUIRE(!e.context().has_time_derivative(e.id()));
  const auto adjoints = reverse_sweep(e, places_of(symbols));
  std::vector<Expr> derivatives;
  derivatives.reserve(symbols.size());
  for (const Expr& symbol : symbols) {
    const auto found = adjoints.find(symbol.id());
    derivatives.push_back(found == adjoints.end() ? e.context().number(0) : found->second);
  }
  return derivatives;
}

std::vector<Expr> variational_residual(Expr lagrangian, std::span<const Expr> coordinates) {
  Context& context = lagrangian.context();
  std::vector<Expr> symbols(coordinates.begin(), coordinates.end());
  for (const Expr& q : coordinates) symbols.push_back(context.time_derivative(q));
  const auto adjoints = reverse_sweep(lagrangian, places_of(symbols));
  const auto adjoint_of = [&](Expr symbol) {
    const auto found = adjoints.find(symbol.id());
    return found == adjoints.end() ? context.number(0) : found->second;
  };
  std::vector<Expr> residual;
  residual.reserve(coordinates.size());
  for (const Expr& q : coordinates)
    residual.push_back(context.time_derivative(adjoint_of(context.time_derivative(q))) - adjoint_of(q));
  return residual;
}

}  // namespace maupertuis
