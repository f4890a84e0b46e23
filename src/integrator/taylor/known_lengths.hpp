#pragma once
#include "kernel/disks/envelope.hpp"

#include <maupertuis/disks.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace maupertuis::taylor {

/// Lengths of steps that are known to be safe, for all motions of sizes met before: so that a bounded motion asks for disks in its first steps alone.
///
///     radius of the disk   ├──┤├──┤├──┤├──┤├──┤   eight bins an octave, each with limits of |q|, |q(s) − q(0)|, |q̇|, |q̈| on its disk
///                                                 and of the values that an Envelope observes.
///
/// A step whose sizes lie within the limits of its bin is safe. Where they do not, the limits are widened and an Envelope is asked anew.
class KnownLengths {
 public:
  /// ratio: of the disk's radius to the length of the step. The program must outlive this.
  KnownLengths(const Program& program, std::span<const int> degrees, double ratio);

  void forget();
  /// Whether a step of length h is known to be safe, might be learned to be so, or is better not asked about for some time.
  /// Cost: some 4 operations an order and coordinate.
  enum class Answer { Safe, Unknown, GivenUp };
  Answer ask(const SlotCoefficients& coefficients, double time, double h);
  /// After Unknown: bounds all motions within limits that are widened to hold the step at hand, or that belong to it alone (anew).
  void bound(const double* constants, bool anew);
  /// Whether their tails are small enough, which is remembered. allowed: [residuals] what the tail of R_j times h x^p/(1 − x) may be, x = 1/ratio.
  bool accept(std::span<const double> allowed);
  /// After accept() said no.
  void give_up();
  double radius() const { return bin_->radius; }
  double length() const { return bin_->radius / ratio_; }

 private:
  struct Bin {
    std::uint64_t key = ~std::uint64_t{0};
    double radius = 0;
    bool has_limits = false, holds = false;
    unsigned visits = 0, learned = 0, next_try = 0;
    double time = 0;                  // the largest |t|
    std::vector<double> weights;      // [3][orders] of |c_k| in the sizes
    std::vector<double> limits;       // [4][padded]
    std::vector<double> least, most;  // [observed]
  };

  Bin& bin_of(double radius);
  void begin(Bin& bin, std::uint64_t key) const;
  double centre(std::size_t slot) const { return centre_[slot * step_]; }
  const double* side_by_side(const SlotCoefficients& coefficients);
  bool is_within(const Bin& bin) const;
  void widen(Bin& bin, bool anew, double widened) const;

  Envelope envelope_;
  std::size_t unknowns_, residuals_, padded_;
  double ratio_;
  std::vector<Bin> bins_;
  // The step at hand.
  Bin* bin_ = nullptr;
  const double* centre_ = nullptr;   // of slot s at [s · step]
  std::size_t step_ = 1;
  double time_ = 0;
  int order_ = 0;
  std::vector<double> sizes_;        // [3][padded]
  std::vector<double> gathered_;     // [orders][padded] coordinates of one motion of several
};

}  // namespace maupertuis::taylor
