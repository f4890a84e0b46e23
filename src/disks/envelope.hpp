#pragma once
#include "kernel/program/program.hpp"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace maupertuis {

/// What is known of all motions that are bounded together, on |s| ≤ r.
struct MotionSizes {
  std::span<const double> centre, reach, rate, acceleration;  // [unknowns] |q| at the centre, |q(s) − q(0)|, |q̇|, |q̈|
  std::span<const double> least, most;                        // [observed] between which a slot lies at the centre
  double time = 0;                                            // the largest |t|
};

/// Bounds of the residual for all motions of certain sizes, where Disks bounds one motion: so that one bound serves
/// many steps.
///
/// Each value f has upper bounds of |f|, |ḟ|, |f̈| on the disk and of what of them is no polynomial; all of them grow
/// with the sizes of the coordinates, so that smaller ones are safe as well. Denominators, and what stands under roots
/// and in functions, are *observed*: their values at the centre are given.
class Envelope {
 public:
  /// degrees: [slots] of polynomials in t, see Disks::degrees. The program must outlive this.
  Envelope(const Program& program, std::span<const int> degrees);

  /// Whether the size of coordinate i counts, and not only how far it moves: little for an angle that stands in sines
  /// and cosines alone.
  bool needs_centre(std::size_t i) const { return needs_size_[i] != 0; }
  bool needs_time() const { return program_.time != no_slot && needs_size_[program_.time] != 0; }
  std::span<const Slot> observed() const { return observed_; }

  /// Bounds on |s| ≤ radius. constants: [program.constants]; order: of the polynomial of q̇.
  void evaluate(const double* constants, const MotionSizes& sizes, double radius, int order);
  /// Of R_j; infinite or not a number where there is no bound.
  double residual_tail(std::size_t j) const {
    return program_.residual[j] == no_slot ? 0.0 : values_[program_.residual[j]].tail[0];
  }

 private:
  static constexpr double infinity = std::numeric_limits<double>::infinity();
  /// What no rule bounds is infinite.
  struct Value {
    double centre = infinity, reach = infinity;  // |f(0)|, |f(s) − f(0)|
    double low = 0;                              // ≤ |f|
    /// ≥ |f|, |ḟ|, |f̈|, and of what of them is no polynomial
    double high[3] = {infinity, infinity, infinity}, tail[3] = {infinity, infinity, infinity};
  };

  void find_needs();
  void observe(Slot slot);
  void set(Slot slot, Value value);
  Value evaluate(const Instruction& instruction, const double* constants) const;
  static void add(Value& total, double& largest, double c, const Value& f, int shift);
  Value sum(const Instruction& instruction, const double* constants) const;
  Value product(Slot a, Slot b) const;
  Value quotient(const Instruction& instruction) const;
  Value power(const Value& base, double exponent) const;
  Value circular(const Value& angle, bool hyperbolic) const;
  Value function(const Instruction& instruction) const;

  const Program& program_;
  std::vector<int> degrees_;             // [slots]
  std::vector<std::int8_t> needs_size_;  // [slots]
  std::vector<std::int8_t> rates_;       // [slots] up to which derivative the bounds of a slot are wanted
  std::vector<Value> values_;            // [slots]
  std::vector<Slot> observed_;
  std::vector<int> place_;  // [slots] among the observed ones; −1: none
  MotionSizes sizes_;       // of the evaluation at hand
  int order_ = 0;
};

}  // namespace maupertuis
