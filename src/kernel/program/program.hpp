#pragma once
#include <maupertuis/kernel.hpp>
#include <maupertuis/rational.hpp>
#include <maupertuis/winding.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

/// The artifact of this stage: a straight-line program in single-assignment form over Taylor coefficients.
///
/// Two kinds of number stand in it. *Constants* do not change along a motion: literals, parameters, sides of switch
/// functions, and everything computed from these alone; they are one double each, computed when the parameters or
/// the sides are set. *Slots* are jets: slot s has a coefficient x_k for each order k.
///
/// Lags. A slot of lag 0 follows q, of lag 1 q̇, of lag 2 q̈: at stage k, which finds q_{k+2}, it is at order k + 2 −
/// lag. d/dt is an instruction that raises the lag by one and does nothing but shift the index.
namespace maupertuis {

using ConstantId = std::uint32_t;
using Slot = std::uint32_t;
inline constexpr Slot no_slot = ~Slot{0};

enum class Op : std::uint8_t {
  // leaves: set by the workspace
  One,   // 1, 0, 0, …
  Time,  // t, 1, 0, …
  Coordinate,
  Companion,  // the second result of SinCos, SinhCosh
  // instructions
  Linear,      // Σ c dʳa/dtʳ
  Products,    // Σ c dʳa/dtʳ + Σ c a b
  Square,      // a²
  Quotient,    // a / b
  SquareRoot,  // √a
  Power,       // a^c
  SinCos,      // sin a, cos a
  SinhCosh,    // sinh a, cosh a
  Function,    // y = f(a…), dy = Σ c w du: every other elementary function, its differential given by slots
  Derivative,  // d/dt a
  Select,      // the first operand whose condition (a constant) holds
};

/// c · dʳa/dtʳ with r = shift, c · a · b, or of a Function's differential c · w du (a = w, b = u), or of a Select (c:
/// condition, a: value).
struct Term {
  ConstantId coefficient;
  Slot a;
  Slot b = no_slot;
  std::uint32_t shift = 0;
  static constexpr std::uint32_t most_shift = 2;
};

struct Instruction {
  Op op;
  Kind function = Kind::Exp;  // Op::Function: which
  std::int8_t lag = 0;
  Slot out = no_slot;
  Slot second = no_slot;  // SinCos, SinhCosh: where the second result goes
  Slot a = no_slot, b = no_slot;
  ConstantId constant = 0;                                         // Op::Power: the exponent
  std::uint32_t first_term = 0, first_product = 0, last_term = 0;  // linear terms, then products, in Program::terms
};

/// A constant: `kind` Number (literal), Symbol (parameter), or a function of earlier constants. Kind::Sign without
/// arguments is the side of the switch function `index`.
struct Constant {
  Kind kind = Kind::Number;
  double value = 0;         // Number
  std::uint32_t index = 0;  // Number: literal; Symbol: parameter; Sign without arguments: switch
  std::uint32_t first_argument = 0, arguments = 0;  // in Program::constant_arguments
};

/// Instructions of one op and one lag that do not wait for each other.
struct Run {
  Op op;
  std::int8_t lag;
  std::uint32_t first, last;
};

/// Which outputs a run of instructions serves, and so when it is carried out.
enum Section : std::uint8_t {
  Dynamics,  // the residual: before the solve of each stage
  Along,     // switch functions, events, integrands: after it
  AtPoint,   // observables: at order 0 alone
  SectionCount,
};

struct Program {
  std::vector<Constant> constants;
  std::vector<ConstantId> constant_arguments;
  std::vector<Rational> literals;         // the Numbers among the constants, exactly
  std::vector<Instruction> instructions;  // in order of execution
  std::vector<Term> terms;
  std::array<std::vector<Run>, SectionCount> runs;

  /// Slots 0 … n−1 are the coordinates. Slots below stored_end[2] are *stored*: later orders read their coefficients,
  /// so that they are corrected after the solve; those of lag 0 come first, then lag 1, then lag 2.
  std::size_t slots = 0;
  std::array<Slot, 3> stored_end{};
  std::vector<std::int8_t> lags;          // [slots]; below 0 only where q has no influence
  std::vector<std::int8_t> tangent_lags;  // [slots]; `unmoved` where q has no influence
  static constexpr std::int8_t unmoved = -128;
  Slot one = no_slot, time = no_slot;  // no_slot: not used
  int first_stage = -2;                // −2, or less when functions of t alone are differentiated

  /// Unknowns of each stage: the accelerations, then the multipliers. A multiplier is the second derivative of a
  /// coordinate of its own that stands nowhere else, so that it is found, corrected and differentiated like a q̈.
  std::size_t freedoms = 0, unknowns = 0, parameters = 0;
  std::optional<std::uint32_t> rounding;  // the parameter that says which way constants are rounded; none: to nearest
  std::vector<Slot> residual;             // [unknowns] R, then −A q̈ + b of the constraints
  std::vector<Slot> constraint_values;    // [m]; no_slot: level 1
  std::vector<Slot> constraint_rates;     // [m]
  std::vector<Slot> switch_slots;         // [switches]
  std::vector<Slot> events, observables, integrands;

  Winding winding;
  std::vector<SwitchFunction> switches;
  std::vector<std::string> coordinate_names;  // [n]
  std::vector<std::string> constraint_names;  // [m]
  std::vector<std::string> parameter_names;   // [p]
};

/// Name of an op in prints.
std::string_view op_name(Op op);
/// Thrown where a pass meets an instruction that it has no rule for.
std::logic_error unknown_op(Op op, std::string_view who);

/// One line an instruction.
std::string print(const Program& program);

}  // namespace maupertuis
