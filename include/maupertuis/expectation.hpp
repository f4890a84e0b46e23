#pragma once
#include <maupertuis/expression.hpp>
#include <maupertuis/source.hpp>

#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace maupertuis {

struct StartValue {
  std::size_t coordinate = 0;
  int order = 0;  // 0: q, 1: q'
  Expr value;     // parameters and numbers only, SI
  Span span;
  std::string unit;        // as written, "deg"; empty where the value is a formula or a bare number
  double unit_factor = 1;  // its SI value
};

/// A path that is given by formulas.
struct PathFormulas {
  std::vector<Expr> q;  // [n] in t and parameters, SI
  Expr from, to;        // SI; empty: the ends of the model's path
};

/// The `expect` and `claim` lines of a model: a struct a kind. Values are in SI.
namespace expectation {

/// How far a number may be off: ± 1e-9 rad, rel 1e-9.
struct Tolerance {
  Expr size;  // SI, or a bare number where relative; empty: as many digits as are written
  bool relative = false;
};

/// The unit beside a value, in which what comes out is shown.
struct DisplayUnit {
  std::string name;   // empty: SI
  double factor = 1;  // its SI value
};

struct Number {
  Expr value;
  Tolerance tolerance;
  DisplayUnit unit;
};

/// Complex numbers; one with an imaginary part stands for itself and its conjugate.
struct Spectrum {
  std::vector<Expr> real, imaginary;  // [values]
  Tolerance tolerance;
  DisplayUnit unit;
};

// ------------------------------------------------------------------------------------------------- along the motion

struct ValueAt {
  Expr subject, time;
  Number expected;
};  // θ at 10 s = 0.5 rad ± 1e-9; time empty: at the start
struct ValueAtUntil {
  Expr subject;
  Number expected;
};  // θ at until = …: when `run until` ends
struct UntilAt {
  Number expected;
};                           // until at 1.2 s ± 1e-9
struct Event {               // event hit 3 at 0.45 s ± 1e-11: the third time it happens
  std::string name, change;  // change of a contact: impact, made, lost, stick, slip; empty: any
  int occurrence = 1;
  Number time;
};
struct EventCount {  // event floor impact = 12: as often along the run
  std::string name, change;
  Expr number;
};
struct EnergyConserved {
  Tolerance tolerance;
};  // energy conserved rel 1e-13; without one 1e-12
struct ConservedAlongRun {
  Expr subject;
  Tolerance tolerance;
};  // conserved m x' rel 1e-13: its drift

// ---------------------------------------------------------------------------------------------------------- identities

struct Conserved {  // conserved F where p_φ = 0
  Expr subject;
  std::vector<Expr> where;  // functions that vanish on the level; none: at all states
};
struct NotConserved {
  Expr subject;
};
struct Integral {
  Expr subject;
};  // found by `maup invariants`
struct Equation {
  Expr left, right;
};  // equation left = right; claim left = right
struct Hamiltonian {
  Expr value;
};  // in q, p, t
struct Routhian {
  std::vector<std::size_t> coordinates;
  Expr value;
};  // without these
struct Bracket {
  Expr a, b, value;
  bool dirac = false;
};  // {a, b} = value, Poisson's or Dirac's

// --------------------------------------------------------------------------------------------- degenerate Lagrangians

/// constraints : p_y ; z ; p_x: primary, secondary, … of phase space, up to invertible combinations.
struct PhaseConstraints {
  std::vector<std::vector<Expr>> generations;
};
/// first class = 3, of phase space; motions = 2, of Lagrange's equations.
struct ClassCount {
  enum class What { FirstClass, SecondClass, PhysicalFreedoms, Motions, FreeFunctions } what = What::FirstClass;
  Expr number;
};

// -------------------------------------------------------------------------------------------------------- constraints

struct Freedoms {
  Expr number;
};
struct ConstraintClass {
  std::string constraint, word;
};  // constraint roll is nonholonomic

// ------------------------------------------------------------------------------------------------ about a point

struct Frequencies {
  std::vector<StartValue> at;
  std::vector<Expr> values;  // angular, rad/s, or their squares
  bool squared = false;
  Tolerance tolerance;
  DisplayUnit unit;
};

struct Eigenvalues {
  std::vector<StartValue> at;
  Spectrum expected;
};

/// What a row or a column of a matrix belongs to.
struct MatrixVariable {
  std::size_t index = 0;  // of the coordinate, the input or the rate
  int order = 0;          // 0: q, 1: q', -1: an input, 2: a rate that the model names
};

struct Matrix {
  char letter = 'M';  // M; A, B, C, G, K, N of the linearization
  std::vector<StartValue> at;
  std::vector<MatrixVariable> rows, columns;
  std::vector<Expr> entries;  // [rows × columns]
  Tolerance tolerance;
  DisplayUnit unit;
};

/// One value of the place of an equilibrium.
struct Place {
  StartValue value;
  std::optional<Tolerance> tolerance;  // none: the value is kept as it is; else it is where the search begins
  DisplayUnit unit;
};
struct Equilibrium {
  std::vector<Place> at;
  std::string word;
};  // word: stable, unstable, undecided, or none

struct Stable {               // unstable for Ω > 5.7 rad/s ± 1e-2 at θ = 0
  bool stable = true;         // the verdict
  std::size_t parameter = 0;  // index in MechanicalSystem::parameters
  bool above = false;         // for values above the critical one
  Number critical;
  std::vector<StartValue> at;
};

// ------------------------------------------------------------------------------------------- of a periodic motion

// `over` a time that is a period, or nearly one; empty: looked for.
struct Multipliers {
  Expr over;
  Spectrum expected;
};
struct Trace {
  Expr over;
  Number expected;
};
struct Period {
  Expr over;
  Number expected;
};

// -------------------------------------------------------------------------------------------- of a stationary path

// `path` counts by the action, the smallest first, from 1; 0: not written, which is the first.
struct Action {
  int path = 0;
  Number expected;
};
struct ActionAlong {
  PathFormulas along;
  Number expected;
};
struct MorseIndex {
  int path = 0;
  Expr index;
};
struct PathAt {
  int path = 0;
  Expr subject, time;
  Number expected;
};

/// error E0412: a model whose text has this mistake.
struct Error {
  std::string code;
};

using Kind = std::variant<ValueAt, ValueAtUntil, UntilAt, EnergyConserved, ConservedAlongRun, Conserved, NotConserved,
                          Integral, Equation, Hamiltonian, Routhian, Bracket, Freedoms, ConstraintClass, Frequencies,
                          Eigenvalues, Matrix, Equilibrium, Stable, Multipliers, Trace, Period, Action, ActionAlong,
                          MorseIndex, PathAt, Event, EventCount, PhaseConstraints, ClassCount, Error>;

}  // namespace expectation

struct Expectation {
  std::string text;  // as written
  bool claim = false;
  Span span;
  expectation::Kind kind;
  std::string with = {};  // "s = -1": parameters that have other values for it; empty: none
};

}  // namespace maupertuis
