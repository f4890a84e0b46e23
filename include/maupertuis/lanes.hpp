#pragma once
#include <maupertuis/backend.hpp>
#include <maupertuis/kernel.hpp>

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// Several motions of one kernel side by side: a *lane* is one of them, and every number becomes `width` numbers.
///
///     auto expansion = interpreted_lanes(kernel, 8);
///     LaneWorkspace work(kernel, 20, expansion);
///     work.set_parameters(lane, values);          // each lane its own
///     work.coordinate(0)[i * 8 + lane] = q_i; work.coordinate(1)[i * 8 + lane] = v_i;
///     work.expand();
///     if (work.quality()[lane] > least) ... work.coordinate(k)[i * 8 + lane] ...
///
/// The results of a lane depend neither on the width nor on the other lanes, to the bit.
namespace maupertuis {

/// The expansion of `width` motions of one kernel. Immutable, safe to share between threads.
/// The arrays are those of src/kernel/lanes/lanes.hpp; LaneWorkspace owns them.
class LaneExpansion {
 public:
  virtual ~LaneExpansion() = default;
  virtual int width() const = 0;
  /// Which backend: "interpreter", …
  virtual std::string_view backend() const = 0;
  virtual void expand(double* rows, const double* constants, double* quality, double* scratch, int stages) const = 0;
};

/// The instructions that a processor may be asked for. `Best`: what this one has.
enum class InstructionSet { Best, Baseline, Avx2, Avx512 };

/// Whether this processor and this build have it, and the environment variable MAUPERTUIS_INSTRUCTIONS allows it.
bool has_instruction_set(InstructionSet set);

/// The width at which a processor carries most motions a second: the doubles of a vector register, 8 with AVX-512.
int best_lane_width();

/// Whether the processor multiplies and adds in one instruction. Without, lanes give the same results, but slower than
/// TaylorStepper.
bool lanes_pay();

/// Whether motions of the kernel can be carried in lanes: not with constraints, whose rank may change, nor with
/// switches or events, which end steps at different places.
bool fits_lanes(const Kernel& kernel);

/// The kernel's instructions one after the other, each for all lanes.
/// Precondition: width is 1, 2, 4, 8 or 16; fits_lanes(kernel); the instruction set is there.
std::shared_ptr<const LaneExpansion> interpreted_lanes(const Kernel& kernel, int width,
                                                       InstructionSet set = InstructionSet::Best);

/// Machine code for a kernel's lanes, and how it came.
struct CompiledLanes {
  std::shared_ptr<const LaneExpansion> expansion;  // null: `trouble` says why; take interpreted_lanes
  std::string trouble;
  std::string cache_trouble;  // the code could not be kept for the next run
  double seconds = 0;
  bool from_cache = false;
};

/// The kernel as machine code. Its results are those of interpreted_lanes to rounding, not to the bit.
/// Precondition: width is 1, 2, 4, 8 or 16; fits_lanes(kernel).
CompiledLanes compiled_lanes(const Kernel& kernel, int width, const CompileOptions& options = {});

/// Everything that `width` motions change. One thread at a time.
class LaneWorkspace {
 public:
  /// `order`: of the Taylor polynomial of q̇, as in KernelWorkspace.
  /// Precondition: the expansion was made for this kernel.
  LaneWorkspace(const Kernel& kernel, int order, std::shared_ptr<const LaneExpansion> expansion);
  ~LaneWorkspace();
  LaneWorkspace(LaneWorkspace&&) noexcept;

  int width() const;
  int order() const;
  /// Precondition: values.size() == kernel.parameters().
  void set_parameters(int lane, std::span<const double> values);
  /// [kernel.program().constants] of a lane under its parameters.
  std::vector<double> constants(int lane) const;
  /// [width] t of each lane: an input of expand().
  double* time();
  /// [n][width] k-th coefficients of q, 0 ≤ k ≤ order + 1. Those of orders 0 and 1, q and q̇, are the input of expand().
  double* coordinate(int k);
  const double* coordinate(int k) const;
  /// The motions through (t, q, q̇). Cost as KernelWorkspace::expand, for all lanes together.
  void expand();
  /// [width] The smallest pivot of M₀, scaled to a unit diagonal, in units of the largest: what its inverse is worth.
  /// 0 or less where M₀ is not symmetric and positive definite, NaN where something is not finite: such a motion is for
  /// KernelWorkspace, which decides.
  const double* quality() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace maupertuis
