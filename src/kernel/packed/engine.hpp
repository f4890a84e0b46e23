#pragma once
#include "kernel/packed/code.hpp"
#include "kernel/packed/layout.hpp"

#include <array>
#include <cstddef>
#include <vector>

/// Runs packs on rows of Taylor coefficients. The same source is compiled for several instruction sets, and the best
/// one that the processor has is taken at run time. Plain structures alone stand at this border, so that no inline
/// function of another header is compiled for a processor that may not be there.
namespace maupertuis::packed {

/// What a pack cannot do: one instruction by the reference rules.
struct ScalarRules {
  void* context = nullptr;
  void (*value)(void* context, std::uint32_t instruction, int order) = nullptr;           // of its result at that order
  void (*tangent)(void* context, std::uint32_t instruction, double* tangents) = nullptr;  // [slots], one direction
};

/// 1/k to twice the digits of a double: a rounded reciprocal alone errs the same way in every step.
struct Reciprocal {
  double leading = 0, rest = 0;
};

/// What a pack needs to know of order k.
struct Order {
  double* row = nullptr;
  std::ptrdiff_t offset = 0;              // of the row from that of order 0
  std::array<double, 3> shift_factors{};  // 1, k + 1, (k + 1)(k + 2)
  Reciprocal reciprocal;                  // of k; of 0: none
  int number = 0;                         // k
};
std::vector<Order> orders_of(double* rows, std::size_t stride, int count);

struct Tables {
  const Pack* packs = nullptr;
  std::size_t pack_count = 0;
  const Block* blocks = nullptr;
  std::size_t block_count = 0;
  const Column* columns = nullptr;
  const ColumnRun* runs = nullptr;
  const ProductTerm* products = nullptr;
  const Convolution* convolutions = nullptr;
  const std::uint32_t* functions = nullptr;
  const double* coefficients = nullptr;  // values of PackedProgram::coefficients
  double* rows = nullptr;                // [orders][stride], aligned to 64 bytes
  std::size_t stride = 0;                // a multiple of 8
  std::size_t unknowns = 0;
  const Order* orders = nullptr;  // [orders] of these rows
  ScalarRules scalar;
};

/// Tangents of order 0 in each direction q̈_d: ∂slot/∂q^(lag).
struct TangentMatrix {
  const double* values = nullptr;  // [directions][stride], aligned to 64 bytes
  std::size_t stride = 0, directions = 0;
  Slot first = 0;             // of the slots that are corrected: those of lag 0 …
  std::array<Slot, 3> end{};  // … and where those of lag 0, 1, 2 end; all multiples of 8
};

/// For 1 to 16 unknowns by −M₀⁻¹, as Engine::negative_inverse() wrote it.
struct InverseSolution {
  const double* inverse = nullptr;
  const Slot* residual = nullptr;  // [directions]
  bool side_by_side = false;       // residual[i] = residual[0] + i
  TangentMatrix tangents;          // in the direction of each unknown
  // Many coefficients follow one acceleration alone, as sines follow their angle. [vectors of corrected slots]: v, if
  // lane i of such a vector follows the unknown 8 v + i and no other, whatever i is; −1: it follows several.
  const std::int8_t* own = nullptr;
  /// [tangents.stride × directions] scratch, aligned to 64 bytes, kept from stage 1 on
  double* answers = nullptr;
};

/// The largest absolute value of each.
struct Sizes {
  double values = 0, change = 0;
};

struct Engine {
  const char* name;
  /// Every pack at the order that belongs to the stage, from stage 1 on with q_{k+2} = 0, which it sets.
  void (*run_stage)(const Tables&, int stage);
  /// When the coefficients of the stage are final: copies of blocks, and sums of products for the stages that follow.
  void (*renew_blocks)(const Tables&, int stage);
  /// Tangents of order 0: in, those of the coordinates; out, those of all slots of Dynamics. [directions][slots of a
  /// row]
  void (*tangents)(const Tables&, double* tangents, std::size_t stride, std::size_t directions);
  /// −M⁻¹ of a symmetric, positive definite matrix, by Gauss and Jordan: a product with it takes part in few
  /// dependences, where a substitution waits for each of its rows.
  ///   matrix   row by row [n × n], n ≤ 16
  ///   inverse  [n × stride] rows, stride n rounded up to a multiple of 8 and 0 beyond n, aligned to 64 bytes
  /// False if a pivot is below 1e-10 of its diagonal entry, or M not positive, not finite or not symmetric: then
  /// nothing is written, and a solver that pivots has to decide.
  bool (*negative_inverse)(const double* matrix, std::size_t n, double* inverse);
  /// 8 × 8 numbers, columns as rows.
  void (*transpose)(const double* from, std::size_t from_stride, double* to, std::size_t to_stride);
  /// solution = Σ_i inverse[i] · row[residual[i]], [stride]. False where it is not finite.
  bool (*solve_by_inverse)(const double* inverse, std::size_t stride, const double* row, const Slot* residual,
                           std::size_t n, double* solution);
  /// Whether all of `rows` rows of `count` numbers are finite.
  bool (*are_finite)(const double* first, std::size_t stride, std::size_t rows, std::size_t count);
  /// values += factor · change, of `count` numbers in eights; the sizes are those before, and of what was added.
  Sizes (*add)(double* values, const double* change, double factor, std::size_t count);
  /// Whether |x + y| ≤ most for each of `count` numbers, which are read in eights.
  bool (*cancel)(const double* x, const double* y, const double* most, std::size_t count);
  /// to = −from; read in eights, and 0 written beyond `count` up to a multiple of 8.
  void (*negate)(const double* from, double* to, std::size_t count);
  /// q_{k+2} = q̈_k / ((k+1)(k+2)) for k = stage, q̈_k = sign · `solution`; read and written in eights.
  void (*set_accelerations)(const Tables&, int stage, const double* solution, std::size_t unknowns, int sign);
  /// How q̈_k changes the coefficients of the stage that later orders read: in a slot of lag ℓ by Σ_d weights[d] ·
  /// tangents[d] times 1, 1/(k+1), 1/((k+1)(k+2)) for ℓ = 2, 1, 0.
  void (*correct)(const Tables&, int stage, const TangentMatrix&, const double* weights);
  /// Stages `first` ≥ 1 to `last` − 1, each with all that belongs to it: run_stage(), solve_by_inverse(),
  /// set_accelerations(), correct(), and where another follows (after the last one: if it `goes_on`) renew_blocks().
  /// False where a q̈ is not finite, which stays in the coefficients.
  bool (*run_stages_by_inverse)(const Tables&, const InverseSolution&, int first, int last, bool goes_on);
  /// Σ_{k=2..degree} c_k τ^{k−1} and Σ k c_k τ^{k−1} of `count` columns, c_k = first + k · stride: read and written in
  /// eights.
  void (*increments)(const double* first, std::size_t stride, std::size_t count, int degree, double tau, double* dq,
                     double* dv);
  /// Σ_{k=2..degree} k (k − 1) c_k τ^{k−2}, in eights like `increments`.
  void (*accelerations)(const double* first, std::size_t stride, std::size_t count, int degree, double tau, double* a);
  /// See maupertuis::polynomial_sizes.
  void (*sizes)(const double* first, std::size_t stride, std::size_t count, int degree, const double* weights,
                double* sizes);
  /// See maupertuis::add_increments.
  void (*add_increments)(std::size_t count, double tau, const double* dq, const double* dv, const double* q,
                         const double* v, double* q_out, double* v_out);
  /// See KernelWorkspace::radius.
  double (*radius)(const double* first, std::size_t stride, std::size_t count, int order, double h);
};

/// The best one for this processor.
const Engine& engine();

}  // namespace maupertuis::packed
