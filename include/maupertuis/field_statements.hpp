#pragma once
#include <maupertuis/syntax_tree.hpp>

#include <optional>
#include <string>
#include <variant>
#include <vector>

/// What the statements of fields say. They are kept apart from syntax_tree.hpp, which everything includes.
namespace maupertuis::syntax {

/// field a(x), b(x) : number on x = 0 .. L cells 8 order 7 boundary a = 0
struct FieldDeclaration {
  struct Item {
    Name name;
    std::vector<Name> variables;  // x; x, y; x, y, z
    Name kind;                    // angle, length, charge, number, complex; empty with `unit` set
    std::optional<UnitExpression> unit;
  };
  struct Range {
    Name variable;
    ExpressionPtr from, to;
  };
  std::vector<Item> items;
  std::vector<Range> ranges;         // empty: not written
  std::vector<ExpressionPtr> cells;  // one a variable, or none
  ExpressionPtr order;               // of the elements; null: not written
  bool periodic = false;
  std::vector<Name> around;        // periodic x: along these space variables; empty: along all
  std::vector<Equation> boundary;  // at both ends
  Span boundary_span;
};

/// density = EXPR, density += EXPR, dissipation density = EXPR
struct DensityText {
  bool dissipation = false, adds = false;
  ExpressionPtr value;
  ExpressionPtr imaginary;  // of a density in complex fields, which must vanish; null: it is real as it is written
  Span name_span;
};

/// boundary left : u = 0, u_x = 0;  boundary u = 0
struct BoundaryText {
  Name side;  // left, right, bottom, top; empty: all
  std::vector<Equation> conditions;
};

/// force density u = f;  force u(l) = F;  force u_x(l) = M
struct FieldForce {
  ExpressionPtr on;  // a Name, or a Call with the place
  ExpressionPtr value;
};

struct FieldClause {
  std::variant<FieldDeclaration, DensityText, BoundaryText, FieldForce> body;
};

/// What is expected of fields.
struct FieldExpectation {
  struct Natural {  // natural T u_x = 0, …
    std::vector<Equation> conditions;
  };
  struct Solution {  // solution u = f(x, t), v = g(x, t)
    std::vector<Equation> fields;
  };
  struct Total {  // total DENSITY at 2 s = 3 J ± 1e-9
    ExpressionPtr density, time;
    expectation::Number expected;
    bool at_equilibrium = false;  // total DENSITY at equilibrium = …
  };
  struct Current {  // current J flux F, G
    ExpressionPtr density;
    std::vector<ExpressionPtr> fluxes;
  };
  struct Dispersion {  // dispersion ω^2 = c^2 k^2
    ExpressionPtr left, right;
  };
  struct Frequencies {  // frequencies of u : 1 rad/s, 2 rad/s rel 1e-9
    Name field;
    std::vector<ExpressionPtr> values;
    Tolerance tolerance;
  };
  std::variant<Natural, Solution, Total, Current, Dispersion, Frequencies> body;
};

}  // namespace maupertuis::syntax
