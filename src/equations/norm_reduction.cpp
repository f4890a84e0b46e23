#include "equations/norm_reduction.hpp"
#include "equations/simplified.hpp"

#include <maupertuis/quaternion_coordinates.hpp>

#include <algorithm>

namespace maupertuis {
namespace {

constexpr int highest_power = 12;

/// q_k² = 1 − the other squares, in a polynomial that is multiplied out.
Expr without_square(Expr e, const std::array<Expr, 4>& quaternion, std::size_t k) {
  Context& context = e.context();
  ExprVector terms{context.number(1)};
  for (std::size_t i = 0; i < 4; ++i)
    if (i != k) terms.push_back(-pow(quaternion[i], Rational(2)));
  const Expr square = context.sum(terms);
  ExprMap powers;
  for (int n = 2; n <= highest_power; ++n) {
    const Expr rest = pow(square, Rational(n / 2));
    powers.emplace(pow(quaternion[k], Rational(n)), n % 2 ? quaternion[k] * rest : rest);
  }
  const Expr expanded = expand(e);
  return expanded ? expand(substitute(expanded, powers)) : Expr();
}

bool holds(Expr e, const std::array<Expr, 4>& quaternion) {
  const std::vector<Expr> symbols = symbols_of({&e, 1});
  return std::any_of(quaternion.begin(), quaternion.end(),
                     [&](Expr q) { return std::find(symbols.begin(), symbols.end(), q) != symbols.end(); });
}

}  // namespace

UnitQuaternions::UnitQuaternions(const MechanicalSystem& system) {
  for (const auto& four : quaternion_coordinates(system)) {
    std::array<Expr, 4> quaternion;
    for (std::size_t k = 0; k < 4; ++k) quaternion[k] = system.coordinates[four[k]].q;
    quaternions_.push_back(quaternion);
  }
}

Expr UnitQuaternions::shortest(Expr e, const ReadingOrder& order) const {
  Expr best = simplified(e, order);
  for (const auto& quaternion : quaternions_) {
    if (!holds(best, quaternion)) continue;
    const Expr start = best;
    std::size_t length = to_plain(best, order).size();
    for (std::size_t k = 0; k < 4; ++k) {
      const Expr reduced = without_square(start, quaternion, k);
      if (!reduced) continue;
      const Expr candidate = simplified(reduced, order);
      const std::size_t size = to_plain(candidate, order).size();
      if (size >= length) continue;
      best = candidate;
      length = size;
    }
  }
  return best;
}

ExprMap UnitQuaternions::parametrization() const {
  ExprMap replaced;
  for (const auto& quaternion : quaternions_) {
    Context& context = quaternion[0].context();
    ExprVector plane, squares;
    for (std::size_t k = 1; k < 4; ++k) {
      plane.push_back(context.symbol("∫∫" + quaternion[k].name(), Role::Coordinate));
      squares.push_back(pow(plane.back(), Rational(2)));
    }
    const Expr one = context.number(1), size = context.sum(squares), below = one / (one + size);
    replaced.emplace(quaternion[0], (one - size) * below);
    for (std::size_t k = 1; k < 4; ++k) replaced.emplace(quaternion[k], Rational(2) * plane[k - 1] * below);
  }
  return replaced;
}

}  // namespace maupertuis
