#pragma once
#include <cstddef>
#include <cstdint>

/// What compiled code of a packed program is given, and what it calls. Plain, since both sides of a module's border read it.
namespace maupertuis::packed {

struct CompiledArguments {
  double* rows = nullptr;                // [orders][stride]; q, q̇ and the leaves are set
  const double* coefficients = nullptr;  // of PackedProgram::coefficients
  const double* term_coefficients = nullptr;  // of Program::terms
  const double* constants = nullptr;     // of Program::constants
  double* bordered = nullptr;            // out: M₀, row by row [n × n]
  /// Engine::sine_cosine
  void (*sincos)(const double* x, double* out, int count) = nullptr;
  double (*elementary)(std::uint8_t function, double x, double y) = nullptr;
};

/// All stages of section Dynamics. 0: done; else the reference has to repeat it.
using CompiledExpand = int (*)(const CompiledArguments*);

}  // namespace maupertuis::packed
