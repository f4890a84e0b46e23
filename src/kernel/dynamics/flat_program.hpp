#pragma once
#include "kernel/program/program.hpp"

#include <array>
#include <vector>

/// The Dynamics of a program at one point: every coefficient of every order that the residual needs is a number in a *cell*, made
/// once. Coefficients that vanish are left out, equal ones are one cell, and what nothing needs is not there.
namespace maupertuis::dynamics {

using Cell = std::uint32_t;
inline constexpr Cell cell_of_one = 0, cell_of_zero = 1, cell_of_time = 2, first_coordinate_cell = 3;

inline constexpr ConstantId no_constant = ~ConstantId{0};

/// factor · constant + offset; the offset alone with no_constant.
struct Coefficient {
  ConstantId constant = 0;
  double factor = 1, offset = 0;
};

inline double value_of(const Coefficient& c, const std::vector<double>& constants) {
  return (c.constant == no_constant ? 0.0 : c.factor * constants[c.constant]) + c.offset;
}

/// Σ c x_a + Σ c x_a x_b, perhaps divided by a cell. Sums of one level and as many terms stand together.
struct SumRun {
  std::uint32_t linear, products;                // terms of each sum
  std::uint32_t first, last;                     // sums
  std::uint32_t first_linear, first_product;     // of the first one; they follow each other
  bool divides;
};

/// Sines and cosines of up to 8 cells side by side, to `out` and `out + 8`.
struct SineRun {
  std::array<Cell, 8> angle;
  Cell out;
};

/// Any other function of order 0.
struct FunctionCall {
  Op op;                    // SquareRoot, Power, SinhCosh, Function
  Kind function;
  Cell a, b, out, second;
  ConstantId exponent;
};

/// Select: which cell is taken follows from constants.
struct Choice {
  Cell out;
  std::uint32_t first, last;  // in choice_conditions, choice_cells
};

struct FlatStep {
  enum Kind : std::uint8_t { Sum, Sine, Function, Choose } kind;
  std::uint32_t index;
};

struct FlatProgram {
  std::size_t cells = 0;
  std::vector<FlatStep> steps;        // in order
  std::vector<SumRun> sums;
  std::vector<SineRun> sines;
  std::vector<FunctionCall> functions;
  std::vector<Choice> choices;

  std::vector<Cell> sum_out, sum_divisor;                         // [sums]
  std::vector<Coefficient> linear_coefficient, product_coefficient;
  std::vector<Cell> linear_cell, product_a, product_b;
  std::vector<ConstantId> choice_conditions;
  std::vector<Cell> choice_cells;

  std::vector<Cell> residual;         // [unknowns]
  std::vector<Cell> value_of_slot;    // [slots] at order 0, where it is kept
  /// Cells of q, then q̇, then q̈/2 [unknowns] each, from first_coordinate_cell on.
};

/// `with_accelerations`: else q̈ = 0. `kept`: [slots] whose values of order 0 are wanted.
FlatProgram flatten(const Program& program, bool with_accelerations, const std::vector<bool>& kept);

}  // namespace maupertuis::dynamics
