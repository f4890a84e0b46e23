#pragma once
#include "disks/envelope.hpp"

#include <maupertuis/disks.hpp>

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace maupertuis::taylor {

/// Lengths of steps that are known to be safe, for all motions of sizes met before: so that a bounded motion asks for
/// disks in its first steps alone.
///
///     radius of the disk   ├──┤├──┤├──┤├──┤├──┤   eight bins an octave, each with limits of |q|, |q(s) − q(0)|, |q̇|,
///     |q̈| on its disk
///                                                 and of the values that an Envelope observes.
///
/// A step whose sizes lie within the limits of its bin is safe. Where they do not, the limits are widened and an
/// Envelope is asked anew.
///
/// Several motions may share what is known. What a step may be must not depend on it then: SafeLength asks for the
/// bound of the step alone before it refuses a length.
class KnownLengths {
 public:
  /// ratio: of the disk's radius to the length of the step. The program must outlive this.
  KnownLengths(const Program& program, std::span<const int> degrees, double ratio, bool for_several);

  /// Whether what is known belongs to these constants, up to some of their last digits.
  bool belongs_to(const double* constants) const;
  /// Forgets what belongs to others: what will be known belongs to these.
  void adopt(const double* constants);
  bool has_constants() const { return !constants_.empty(); }
  void forget();
  /// Whether a step of length h is known to be safe, might be learned to be so, or is better not asked about for some
  /// time. allowed: [residuals] what the tail of R_j times h x^p/(1 − x) may be, x = 1/ratio, by the momenta of this
  /// motion. Cost: some 4 operations an order and coordinate.
  enum class Answer { Safe, Unknown, GivenUp };
  /// sizes: null or [3][unknowns] on |s| ≤ disk_radius(h), column i at [i · step]: Σ_{k≥1} |c_k| r^k, and of the first
  /// two derivatives all terms.
  Answer ask(const SlotCoefficients& coefficients, double time, double h, std::span<const double> allowed,
             const double* sizes = nullptr);
  double disk_radius(double h) const;
  /// After ask(): bounds all motions within limits that are widened to hold the step at hand, that begin anew with it,
  /// or hold it alone.
  enum class Limits { Widened, Anew, Exact };
  void bound(Limits limits);
  /// Whether their tails are small enough, which is remembered. by_rounding: [residuals] or empty: what they may be by
  /// the rounding of R here; then this is remembered for one motion alone.
  bool accept(std::span<const double> allowed, std::span<const double> by_rounding = {});
  /// After accept() said no.
  void give_up();
  bool has_asked() const { return bin_ != nullptr; }
  double radius() const { return bin_->radius; }
  double length() const { return bin_->radius / ratio_; }

 private:
  static constexpr int no_key = std::numeric_limits<int>::min();
  struct Bin {
    int key = no_key;
    double radius = 0;
    bool has_limits = false, holds = false;
    unsigned visits = 0, learned = 0, next_try = 0;
    int generosity = 2;  // how far limits go beyond the sizes that were met; less, each time that a bound is refused
    double time = 0;     // the largest |t|
    std::vector<double> weights;      // [3][orders] of |c_k| in the sizes
    std::vector<double> limits;       // [4][padded]
    std::vector<double> least, most;  // [observed]
    std::vector<double> needed;       // [residuals] of what is allowed; 0 where rounding allowed it
  };

  Bin& bin_of(double radius);
  void begin(Bin& bin, int key) const;
  double centre(std::size_t slot) const { return now_.rows[slot * now_.step]; }
  bool meets(const Bin& bin, std::span<const double> allowed) const;
  void find_sizes();
  bool is_within(const Bin& bin) const;
  void widen(Bin& bin, Limits limits) const;

  Envelope envelope_;
  std::size_t unknowns_, residuals_, constant_count_, padded_;
  double ratio_;
  bool for_several_;
  std::vector<double> constants_;  // that what is known belongs to
  std::vector<Bin> bins_;
  // The step at hand.
  Bin* bin_ = nullptr;
  SlotCoefficients now_;
  const double* given_ = nullptr;  // sizes
  bool has_sizes_ = false;
  double time_ = 0;
  std::vector<double> sizes_;  // [3][padded]
};

}  // namespace maupertuis::taylor
