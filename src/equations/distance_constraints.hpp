#pragma once
#include <maupertuis/equations_of_motion.hpp>
#include <maupertuis/evaluate.hpp>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace maupertuis {

/// A place that a rod can end at: a point or a body of the model, or the origin O.
struct RodEnd {
  std::string name;
  ExprVector position;
  bool fixed = false;  // in space: no coordinate and no time in its position
};

/// φ is a function of the distance d of two places alone.
struct RodConstraint {
  RodEnd from, to;
  Expr distance;  // d; a constant length where φ = k (d² − l²) shows it
  Expr slope;     // dφ/d(d²)
};

/// The places of a system, to find what its constraints are the distances of.
class Rods {
 public:
  explicit Rods(const MechanicalSystem& system);

  /// The pair of places of which φ is the distance or its square, but for sign and constant; else the only one with ∇φ
  /// parallel to ∇d², proved by the zero test. Nothing where there is none, or several that are neither.
  /// Cost: about the number of places, for constraints of few coordinates; of many places on one body a product of
  /// numbers for each two of them.
  std::optional<RodConstraint> find(const Constraint& constraint) const;

 private:
  using Ids = std::vector<NodeId>;  // of coordinates, in order
  struct Pair {
    std::size_t first, second, reach;  // on how many coordinates the two depend
  };
  /// A place and its slopes at one scattered point.
  struct InNumbers {
    std::vector<double> position;             // [components]
    std::vector<std::vector<double>> slopes;  // [reach][components]
  };
  using Slopes = std::map<NodeId, double>;  // by coordinates
  struct Way {
    double slope = 0, size = 0;  // the sum of the sizes of its terms
  };
  std::vector<Pair> pairs_on(const Ids& support) const;
  const InNumbers& numbers_of(std::size_t place) const;
  Slopes slopes_of(Expr value, const Ids& support) const;
  Way way_along(const Pair& pair, NodeId id) const;
  bool may_be(const Slopes& of_phi, const Pair& pair) const;

  const MechanicalSystem& system_;
  std::vector<RodEnd> places_;
  std::vector<Ids> reach_;                                // [places]
  std::map<NodeId, std::vector<std::size_t>> depending_;  // the places that depend on a coordinate
  Bindings point_;                                        // of all symbols of places and constraints
  mutable std::map<std::size_t, InNumbers> numbers_;      // of the places that were asked for
};

}  // namespace maupertuis
