#pragma once
#include <maupertuis/equations_of_motion.hpp>

#include <array>
#include <vector>

namespace maupertuis {

/// The four numbers that turn a body, on the sphere where their squares add up to 1.
class UnitQuaternions {
 public:
  explicit UnitQuaternions(const MechanicalSystem& system);

  bool empty() const { return quaternions_.empty(); }
  /// `e` in its shortest readable form that is equal to it on the spheres: one of the squares may be replaced by
  /// 1 less the others.
  Expr shortest(Expr e, const ReadingOrder& order) const;
  /// Points of the spheres by free numbers (the stereographic projection), as replacements of the components: what
  /// vanishes then as a function vanishes on the spheres.
  ExprMap parametrization() const;

 private:
  std::vector<std::array<Expr, 4>> quaternions_;
};

}  // namespace maupertuis
