#pragma once
#include "kernel/straight_line/evaluator.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace maupertuis {

/// Arrays of the line of a function.
enum FunctionArray : std::uint32_t { InputArray, ParameterArray, ValueArray, function_arrays };

/// The parameters are set seldom.
inline constexpr std::array<std::uint32_t, 1> seldom_arrays{ParameterArray};

/// The functions of a kernel as a straight line, whose stores are the outputs in order, and its evaluation.
struct FunctionProgram {
  straight::StraightLine line;
  straight::Evaluation evaluation{straight::StraightLine()};
  std::size_t inputs = 0, parameters = 0;
  std::vector<bool> used;  // [inputs]
  std::size_t size = 0;    // nodes that a call makes
};

}  // namespace maupertuis
