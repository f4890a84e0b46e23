#pragma once
#include <cstddef>
#include <cstdint>

/// What compiled code of a packed program is given, and what it calls. Plain, since both sides of a module's border
/// read it.
namespace maupertuis::packed {

/// Rolled code adds up the products of so many stages at once.
inline constexpr int rolled_group = 4;

/// Unknowns up to which rolled code solves by −M₀⁻¹.
inline constexpr std::size_t most_by_inverse = 48;

struct CompiledArguments {
  double* rows = nullptr;                // [orders][stride]; q, q̇ and the leaves are set
  /// straight-line: the same numbers where they were written first, which are there sooner
  const double *q = nullptr, *v = nullptr;
  const double* coefficients = nullptr;  // of PackedProgram::coefficients
  const double* term_coefficients = nullptr;  // of Program::terms
  const double* constants = nullptr;     // of Program::constants
  /// Engine::sine_cosine
  void (*sincos)(const double* x, double* out, int count) = nullptr;
  double (*elementary)(std::uint8_t function, double x, double y) = nullptr;
  double* sums = nullptr;                // rolled: [convolutions][rolled_group][8], aligned to 64 bytes
  const double* inverse = nullptr;       // rolled: −M₀⁻¹, [unknowns] rows, each padded to a multiple of 8
  double* tangent_row = nullptr;         // rolled `solve` and `later`: [stride] scratch; what no pack writes is 0
  double* passing_row = nullptr;         // rolled `first`, `stage` and `later`: [stride] scratch
  /// rolled `correct`: [stride] x and the slots' tangents in its direction, where M₀ x = R_k
  const double* tangents = nullptr;
  /// rolled: `tangents` holds x also in the cells of blocks that copy coordinates, so that `correct` renews these
  std::int64_t has_copies = 0;
  /// Rolled: ScalarRules.
  void (*value)(void* context, std::uint32_t instruction, int order) = nullptr;
  void (*tangent)(void* context, std::uint32_t instruction, double* tangents) = nullptr;
  void* context = nullptr;
};

using CompiledExpandOld = int (*)(const CompiledArguments*);
/// Unrolled code: all stages of section Dynamics. Its arrays in this order: rows with the leaves set, q and q̇ where they
/// were written first, `coefficients` of lanes, constants, 8 doubles of scratch, which tell whether it went well
/// (straight::sound); else the reference has to repeat it.
using CompiledExpand = void (*)(double* rows, const double* q, const double* v, const double* coefficients,
                                const double* constants, double* scratch);
enum ArrayOfExpand : std::uint32_t {
  RowsOfExpand, PositionsOfExpand, VelocitiesOfExpand, CoefficientsOfExpand, ConstantsOfExpand, arrays_of_expand
};

/// With straight-line code: as Engine::radius and Engine::increments, for its rows.
using CompiledRadius = double (*)(const double* first, double h);
using CompiledIncrements = void (*)(const double* first, std::size_t stride, std::size_t count, int degree, double tau,
                                    double* dq, double* dv);

/// Rolled code of long runs, `first`: the stages up to 0, as Engine::run_stage, and Engine::renew_blocks after all but
/// the last.
using CompiledFirst = void (*)(const CompiledArguments*);

/// Rolled code, one stage a call.
///   stage    ≥ 1; as Engine::run_stage, with q_{k+2} = 0
///   solve    ≥ 1; as Engine::solve_by_inverse, set_accelerations and correct
///   correct  ≥ 1; as the last two, by `tangents`
///   ahead    ≥ 0, after the others, in turn; as Engine::renew_blocks, but for what `correct` has renewed, and sums for
///   the stages that follow
using CompiledStage = void (*)(const CompiledArguments*, std::int64_t stage);

/// Rolled code of long runs, `later`: `stage`, `solve` and `ahead` for all stages from 1 to `end` − 1. 1: q̈ is finite
/// in all of them; else 0.
using CompiledLater = std::int64_t (*)(const CompiledArguments*, std::int64_t end);

/// Rolled code: as Engine::tangents.
using CompiledTangents = void (*)(const CompiledArguments*, double* tangent);

}  // namespace maupertuis::packed
