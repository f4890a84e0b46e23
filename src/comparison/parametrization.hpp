#pragma once
#include <maupertuis/comparison.hpp>

#include <set>

namespace maupertuis::comparison {

/// A coordinate that replaces others: an angle, or a distance along a line.
struct NewCoordinate {
  std::string name, kind;  // kind as in `coord`
  Expr q;
  Dimension dimension;
  double start = 0;
};

/// A constraint that was solved: what its coordinates are now.
struct Solved {
  std::size_t constraint = 0;
  std::vector<std::size_t> dependent;  // coordinates of the model
  ExprVector written;                  // [dependent] for the text: other solved coordinates may stand in it
  std::vector<NewCoordinate> fresh;
  Expr radius;  // of a sphere: the length of a rod; else empty
  std::string sentence;
};

struct Parametrization {
  std::vector<Solved> solved;         // in an order in which each uses those before it alone
  std::vector<std::size_t> repeated;  // constraints that the others imply
  std::vector<NewCoordinate> fresh;
  ExprMap values;                       // solved coordinate → function of the independent ones
  std::optional<std::size_t> unsolved;  // a constraint that has no closed form here
};

/// Solves the holonomic constraints one by one, those of few coordinates first.
/// `keep`: coordinates that other lines of the model drive, kept where there is a choice.
Parametrization parametrize(const Model& model, const EquationsOfMotion& equations, const MotionState& start,
                            const std::set<std::string>& keep);

/// Coordinates chosen as dependent by pivoting on the holonomic rows of A at the start, columns measured by √M_ii.
std::vector<std::size_t> dependent_coordinates(const EquationsOfMotion& equations, const MotionState& start);

}  // namespace maupertuis::comparison
