#pragma once
#include <cstddef>
#include <cstdint>

/// Compiled code of a packed program: what it is given, and what it calls. Plain, since both sides of a module's border
/// read it.
namespace maupertuis::packed {

/// Rolled code adds up the products of so many stages at once.
inline constexpr int rolled_group = 4;

/// Unknowns up to which rolled code solves by −M₀⁻¹; with constraints, whose bordered matrix has no code to invert it.
inline constexpr std::size_t most_by_inverse = 48, most_bordered_by_inverse = 16;

constexpr bool solves_by_inverse(std::size_t unknowns, std::size_t freedoms) {
  return unknowns <= (unknowns == freedoms ? most_by_inverse : most_bordered_by_inverse);
}

/// Of rolled code.
struct CompiledArguments {
  double* rows = nullptr;                // [orders][stride]; q, q̇ and the leaves are set
  const double* coefficients = nullptr;  // of PackedProgram::coefficients
  double* sums = nullptr;                // [convolutions][rolled_group][8], aligned to 64 bytes
  const double* inverse = nullptr;       // −M₀⁻¹, [unknowns] rows, each padded to a multiple of 8
  double* tangent_row = nullptr;         // `solve` and `later`: [stride] scratch; what no pack writes is 0
  double* passing_row = nullptr;         // `first`, `stage` and `later`: [stride] scratch
  /// `correct`: [stride] x and the slots' tangents in its direction, where M₀ x = R_k
  const double* tangents = nullptr;
  /// `tangents` holds x also in the cells of blocks that copy coordinates, so that `correct` renews these
  std::int64_t has_copies = 0;
  /// ScalarRules.
  void (*value)(void* context, std::uint32_t instruction, int order) = nullptr;
  void (*tangent)(void* context, std::uint32_t instruction, double* tangents) = nullptr;
  void* context = nullptr;
};

/// Unrolled code: all stages of section Dynamics, see unrolled::unroll. [8] of scratch tell whether it went well
/// (straight::sound); else the engine has to repeat it.
using CompiledExpand = void (*)(double* rows, const double* q, const double* v, const double* coefficients,
                                const double* constants, double* scratch);

/// With unrolled code: as Engine::radius, increments and accelerations (of rows with any stride), and PolynomialSizes.
using CompiledRadius = double (*)(const double* first, double h);
using CompiledIncrements = void (*)(const double* first, std::size_t stride, std::size_t count, int degree, double tau,
                                    double* dq, double* dv);
using CompiledAccelerations = void (*)(const double* first, std::size_t stride, std::size_t count, int degree,
                                       double tau, double* a);
using CompiledSizes = void (*)(const double* first, double radius, double* sizes);

/// Rolled code of long runs, `first`: the stages up to 0, as Engine::run_stage, and Engine::renew_blocks after all but
/// the last.
using CompiledFirst = void (*)(const CompiledArguments*);

/// Rolled code, one stage a call.
///   stage    ≥ 1; as Engine::run_stage, with q_{k+2} = 0
///   solve    ≥ 1; as Engine::solve_by_inverse, set_accelerations and correct
///   correct  ≥ 1; as the last two, by `tangents`
///   ahead    ≥ 0, after the others and for each stage in turn, what later stages read: copies of blocks, as
///            Engine::renew_blocks (but for those that `correct` has renewed), and parts of their sums of products
using CompiledStage = void (*)(const CompiledArguments*, std::int64_t stage);

/// Rolled code of long runs, `later`: `stage`, `solve` and `ahead` for all stages from 1 to `end` − 1. 1: q̈ is finite
/// in all of them; else 0.
using CompiledLater = std::int64_t (*)(const CompiledArguments*, std::int64_t end);

/// Rolled code: as Engine::tangents.
using CompiledTangents = void (*)(const CompiledArguments*, double* tangent);

}  // namespace maupertuis::packed
