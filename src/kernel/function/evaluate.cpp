#include <maupertuis/function_kernel.hpp>
#include <maupertuis/functions.hpp>
#include <maupertuis/require.hpp>

#include "kernel/function/program.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

double integer_power(double x, std::int32_t exponent) {
  double result = exponent & 1 ? x : 1;
  for (std::int32_t left = exponent >> 1; left > 0; left >>= 1) {
    x *= x;
    if (left & 1) result *= x;
  }
  return result;
}

/// NaN stays NaN: a comparison with it must not choose a side in silence.
double sign(double x) { return x > 0 ? 1 : x < 0 ? -1 : x == 0 ? 0 : x; }
double step(double x) { return x >= 0 ? 1 : x < 0 ? 0 : x; }
double smaller(double x, double y) { return y < x || std::isnan(y) ? y : x; }
double larger(double x, double y) { return y > x || std::isnan(y) ? y : x; }

void run(const std::vector<FunctionInstruction>& instructions, double* s) {
  for (const FunctionInstruction& i : instructions) {
    const double x = s[i.a];
    double& out = s[i.out];
    switch (i.op) {
      case FunctionOp::Add: out = x + s[i.b]; break;
      case FunctionOp::Subtract: out = x - s[i.b]; break;
      case FunctionOp::Multiply: out = x * s[i.b]; break;
      case FunctionOp::Divide: out = x / s[i.b]; break;
      case FunctionOp::Negate: out = -x; break;
      case FunctionOp::Square: out = x * x; break;
      case FunctionOp::Sqrt: out = std::sqrt(x); break;
      case FunctionOp::PowerInteger: out = integer_power(x, i.exponent); break;
      case FunctionOp::Power: out = std::pow(x, s[i.b]); break;
      case FunctionOp::Function: out = functions::value(i.function, x); break;
      case FunctionOp::Abs: out = std::abs(x); break;
      case FunctionOp::Sign: out = sign(x); break;
      case FunctionOp::Step: out = step(x); break;
      case FunctionOp::Atan2: out = std::atan2(x, s[i.b]); break;
      case FunctionOp::Min: out = smaller(x, s[i.b]); break;
      case FunctionOp::Max: out = larger(x, s[i.b]); break;
      case FunctionOp::Less: out = x < s[i.b]; break;
      case FunctionOp::LessEqual: out = x <= s[i.b]; break;
      case FunctionOp::And: out = x != 0 && s[i.b] != 0; break;
      case FunctionOp::Or: out = x != 0 || s[i.b] != 0; break;
      case FunctionOp::Choose: out = s[i.c] != 0 ? x : s[i.b]; break;
    }
  }
}

}  // namespace

FunctionKernel::FunctionKernel() : program_(std::make_shared<const FunctionProgram>()) {}
std::size_t FunctionKernel::inputs() const { return program_->inputs; }
std::size_t FunctionKernel::parameters() const { return program_->parameters; }
std::size_t FunctionKernel::outputs() const { return program_->outputs.size(); }
std::size_t FunctionKernel::size() const { return program_->changing.size(); }
bool FunctionKernel::uses(std::size_t input) const { return program_->used[input]; }

FunctionWorkspace::FunctionWorkspace(const FunctionKernel& kernel) : kernel_(kernel), slots_(kernel.program().slots) {
  const FunctionProgram& program = kernel_.program();
  std::copy(program.numbers.begin(), program.numbers.end(),
            slots_.begin() + static_cast<std::ptrdiff_t>(program.inputs + program.parameters));
  if (program.parameters == 0) run(program.fixed, slots_.data());
}

void FunctionWorkspace::set_parameters(std::span<const double> values) {
  const FunctionProgram& program = kernel_.program();
  MAUP_REQUIRE(values.size() == program.parameters);
  std::copy(values.begin(), values.end(), slots_.begin() + static_cast<std::ptrdiff_t>(program.inputs));
  run(program.fixed, slots_.data());
}

void FunctionWorkspace::evaluate(std::span<const double> inputs, std::span<double> outputs) {
  const FunctionProgram& program = kernel_.program();
  MAUP_REQUIRE(inputs.size() == program.inputs && outputs.size() == program.outputs.size());
  std::copy(inputs.begin(), inputs.end(), slots_.begin());
  run(program.changing, slots_.data());
  for (std::size_t i = 0; i < program.outputs.size(); ++i) outputs[i] = slots_[program.outputs[i]];
}

}  // namespace maupertuis
