#pragma once
#include <cstddef>

/// The arithmetic of one step for `width` motions, one a lane. Plain pointers, since the code behind is compiled for
/// several instruction sets and must share nothing with the rest of the program. Every operation works lane by lane and
/// is rounded by itself, so that results depend neither on the width nor on the instruction set.
namespace maupertuis::ensemble {

/// What a step reads and writes. Shapes in lanes: [width], [n][width], [order + 2][n][width] with `row` between orders.
struct LaneArrays {
  std::size_t width, freedoms, row;
  int order;              // of the polynomial of q̇
  const double* factor;   // [width] of the estimated radius of convergence
  const double* whole;    // [order + 3] 0, 1, 2, …
  const double* inverse;  // [order + 1] −1/k; the first is not used
  const double* coefficients;
  double *q_high, *q_low, *v_high, *v_low;  // [n][width] the state and what rounding left behind
  double *t_high, *t_low;                   // [width]
  const double* end;                        // [width]
  double* length;  // [width] that the control chose last; in: 0 is not allowed; infinity: the motion is a polynomial
  double* step;    // [width] signed, cut to the end
  double *reaches, *shrinks;  // [width] 1 or 0: the step reaches the end; the length is below the resolution of time
  const double* quality;      // [width] of the solution; at most `least_quality`: not to be trusted
  double least_quality;
  const double* next;    // [width] requested time; infinity: none is left
  double* acceleration;  // [n][width] q̈ by the polynomial, after the step
  double* radius;        // [width] of a disk
  double* sizes;  // [3][n][width] on |s| ≤ radius: Σ_{k≥1} |c_k| r^k, and of the first two derivatives all terms
};

struct LaneSteps {
  /// length → the next length, after Jorba and Zou as in integrator/taylor/step_size.cpp. Where `fresh` is given, only
  /// in lanes where it is not 0.
  void (*choose_length)(const LaneArrays& lanes, const double* fresh);
  /// step, reaches and shrinks from length, t and end. Whether a lane has to be looked at: the step reaches the end or
  /// may reach a requested time, its length is too short or infinite, or its solution is not to be trusted.
  bool (*cut_to_end)(const LaneArrays& lanes);
  /// Whether some |q| is above the limit.
  bool (*exceed)(const LaneArrays& lanes, double limit);
  /// The state, the time and the accelerations after `step`.
  void (*advance)(const LaneArrays& lanes);
  /// sizes from radius.
  void (*find_sizes)(const LaneArrays& lanes);
};

/// Null pointers where the build lacks the instruction set.
LaneSteps baseline_steps();
LaneSteps avx2_steps();
LaneSteps avx512_steps();

}  // namespace maupertuis::ensemble
