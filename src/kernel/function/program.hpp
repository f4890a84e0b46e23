#pragma once
#include <maupertuis/expression.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace maupertuis {

/// What an instruction does to its operands x (slot a) and y (slot b).
enum class FunctionOp : std::uint8_t {
  Add, Subtract, Multiply, Divide, Negate, Square, Sqrt, PowerInteger, Power,
  Function,  // of one argument, by the table of functions
  Abs, Sign, Step, Atan2, Min, Max, Less, LessEqual, And, Or,
  Choose,  // x where the condition in slot c holds, else y
};

struct FunctionInstruction {
  FunctionOp op = FunctionOp::Add;
  Kind function = Kind::Exp;  // Function: which
  std::int32_t exponent = 0;  // PowerInteger
  std::uint32_t out = 0, a = 0, b = 0, c = 0;
};

/// Slots in this order: inputs, parameters, numbers, results of instructions. Conditions are 1 or 0.
struct FunctionProgram {
  std::size_t inputs = 0, parameters = 0, slots = 0;
  std::vector<double> numbers;
  std::vector<FunctionInstruction> fixed;     // of parameters and numbers alone, in order
  std::vector<FunctionInstruction> changing;  // the rest, in order
  std::vector<std::uint32_t> outputs;         // slots
  std::vector<bool> used;                     // [inputs]
};

}  // namespace maupertuis
