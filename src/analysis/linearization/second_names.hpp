#pragma once
#include "analysis/linearization/point_equations.hpp"

#include <map>
#include <optional>
#include <vector>

namespace maupertuis {

/// Places that have two names: of polar coordinates (r, φ) and (−r, φ + π); of spherical ones (r, θ, φ) and
/// (−r, π − θ, φ + π), or (r, −θ, φ + π). The turn of φ, a translation, changes nothing and is left out.
///
/// A change of names takes R and the constraints to themselves. So does many a mirror image, which is another motion;
/// the inertia tells them apart: at 0 of the coordinate r that changes its sign that of another, φ or θ, vanishes as r²
/// times that of r, as in a plane. On a cone it does not, and r < 0 is its other half; in a double well no other
/// vanishes. And the points of the model have to be where they were, with φ half a turn further. All this by values at
/// random points.
class SecondNames {
 public:
  SecondNames(PointEquations::Impl& equations, const std::vector<Translation>& translations)
      : e_(equations), translations_(translations) {}

  /// The same motion with no coordinate below 0 that a second name brings above.
  OperatingPoint first_name(OperatingPoint point);

 private:
  struct Name {
    std::size_t reversed = 0;             // this coordinate changes its sign
    std::optional<std::size_t> mirrored;  // this angle θ becomes π − θ
    std::vector<double> turned;           // [n] by π times this, a translation
  };

  OperatingPoint renamed(OperatingPoint point, const Name& name) const;
  const std::optional<Name>& name_that_reverses(std::size_t i);
  std::optional<Name> found(std::size_t i) const;
  bool keeps_equations(const Name& name) const;
  bool keeps_places(const Name& name) const;

  PointEquations::Impl& e_;
  const std::vector<Translation>& translations_;
  std::map<std::size_t, std::optional<Name>> known_;  // what was asked for
};

}  // namespace maupertuis
