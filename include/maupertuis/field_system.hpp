#pragma once
#include <maupertuis/mechanical_system.hpp>
#include <maupertuis/transform.hpp>

#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

/// Fields as physics: densities in the fields and their derivatives, the boundary, what a run does and what is
/// expected.
///
/// A derivative of a field is a symbol, a coordinate of the jet: u, u', u_x, u_xx, u_x' (which texts write u_tx). Space
/// derivatives stand in its name, time derivatives are its order, so that d/dt is that of mechanics.
namespace maupertuis {

struct SpaceVariable {
  std::string name;
  Expr symbol;  // Role::Auxiliary
  Dimension dimension;
  Expr from, to;  // SI, parameters and numbers only; empty: no domain
  int cells = 0;  // 0: not written
  Span span;
};

struct Field {
  std::string name;
  Dimension dimension;
  std::string kind;
  bool given = false;  // input q(x): a function of space and time that is not varied
  Expr formula;        // of a given one, in x and t; empty: any function
  Span span;
};

/// A derivative of a field: how often by each space variable and by t.
struct FieldJet {
  std::size_t field = 0;   // index in FieldSystem::fields
  std::vector<int> space;  // [space variables]
  int time = 0;
  int order() const;  // of all derivatives
};

/// φ = value or its normal derivative = value at an end, in one space variable or on a side of a rectangle.
struct BoundaryCondition {
  enum class Side { Left, Right, Bottom, Top } side = Side::Left;
  FieldJet jet;  // u or u_x
  Expr value;    // in t and parameters
  Span span;
};

/// A force at an end: it enters the natural condition there. On u: force; on u_x: moment.
struct EndForce {
  BoundaryCondition::Side side = BoundaryCondition::Side::Left;
  FieldJet jet;
  Expr value;
  Span span;
};

/// The value of a jet at a place: u(3 m), u_x(l).
struct PlaceValue {
  Expr symbol;
  Expr jet;
  std::vector<Expr> place;  // [space variables]
  Span span;
  int side = 0;  // u_xxx(l - 0): the limit from the left (−1) or the right (+1), in equations alone
};

/// A value of a field at a place that stands in T, V, L, D, positions, constraints or forces: u(l), u_x(l). It is a
/// coordinate of the mechanical system beside the fields.
struct PlaceCoordinate {
  std::size_t coordinate = 0;                  // in MechanicalSystem::coordinates
  FieldJet jet;                                // u or u_x
  Expr place;                                  // SI, parameters and numbers only; where it moves, t too
  std::optional<BoundaryCondition::Side> end;  // nothing: inside, or of a periodic domain
  bool moves = false;                          // its velocity is that along the motion, d/dt u(X(t), t)
  Span span;
};

struct FieldSystem {
  std::shared_ptr<Context> context;
  std::vector<SpaceVariable> space;
  Dimension time_dimension;
  std::vector<Field> fields;  // the given ones last
  Expr density;               // ℒ in jets, x and t; definitions of parameters are symbols in it
  Expr dissipation;           // 𝒟, or empty
  std::vector<Expr> forces;   // [fields] per volume; an empty handle: none
  std::vector<EndForce> end_forces;
  std::vector<BoundaryCondition> boundary;
  std::vector<bool> around;     // [space variables] where the field goes on from one end to the other; empty: nowhere
  int element_order = 0;        // 0: not written
  Dimension density_dimension;  // energy/length^d
  Span density_span;
  ExprMap definitions;  // symbol of a definition → its value

  Expr jet_symbol(const FieldJet& jet) const;
  /// Nothing where the symbol is no jet of a field.
  std::optional<FieldJet> jet_of(Expr symbol) const;
  std::optional<FieldJet> jet_of_name(std::string_view name) const;
  Dimension dimension_of(const FieldJet& jet) const;
  /// The jets of fields that stand in e, in order of creation.
  std::vector<Expr> jets_in(Expr e) const;
  /// D_x e of the space variable, or D_t e for `variable` = space.size(): by the chain rule through all jets.
  Expr total_derivative(Expr e, std::size_t variable) const;
  /// With the values of definitions in the place of their symbols.
  Expr expanded(Expr e) const;
  bool periodic(std::size_t direction) const { return direction < around.size() && around[direction]; }
  /// Along every direction: the domain has no side.
  bool periodic() const;
  /// The name of a jet as the language has it: u, u', u_xx, u_tx.
  std::string jet_name(const FieldJet& jet) const;
};

namespace field_expectation {
struct Natural {
  std::vector<Expr> conditions;  // left − right
};
struct Solution {
  std::vector<std::size_t> fields;
  std::vector<Expr> values;
};
struct ValueAt {
  Expr subject, time;  // subject in symbols of place values
  expectation::Number expected;
};
struct Total {
  Expr density, time;
  expectation::Number expected;
  bool at_equilibrium = false;
};
struct Equilibrium {
  struct Place {
    Expr subject;  // u(l/2) or a coordinate, in symbols of place values
    std::string name;
    expectation::Number expected;
  };
  std::vector<Place> places;
  std::string word;  // stable, unstable, undecided, or none
};
struct Current {
  Expr density;
  std::vector<Expr> fluxes;
};
struct Dispersion {  // in the symbols ω and k, k_x, …
  Expr left, right;
};
struct Frequencies {
  std::size_t field = 0;
  std::vector<Expr> values;  // rad/s
  expectation::Tolerance tolerance;
  expectation::DisplayUnit unit;
};
using Kind = std::variant<Natural, Solution, ValueAt, Total, Current, Dispersion, Frequencies, Equilibrium>;
}  // namespace field_expectation

struct FieldExpectationLine {
  std::string text;
  Span span;
  field_expectation::Kind kind;
};

struct FieldStart {
  std::size_t field = 0;
  int order = 0;  // 0: u, 1: u'
  Expr value;     // in x and parameters
  Span span;
};

struct FieldModel {
  FieldSystem system;
  std::vector<FieldStart> start;
  std::vector<PlaceValue> places;
  /// Whether coordinates and bodies stand beside the fields, or forces at places inside: Model::system is what they are
  /// then, with the values of fields at places among its coordinates.
  bool coupled = false;
  std::vector<PlaceCoordinate> attached;
  bool complete = false;  // energies, constraints and forces are read: further values at places take part in nothing
  std::vector<FieldExpectationLine> expectations;
  Expr omega;  // ω of dispersion relations
  std::vector<Parameter> parameters;
  std::vector<Expr> wave_numbers;  // k, or k_x, k_y, k_z [space variables]
};

}  // namespace maupertuis
