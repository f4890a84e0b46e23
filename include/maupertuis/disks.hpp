#pragma once
#include <maupertuis/kernel.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

/// How far the polynomials of a step can be trusted: every value of the program answers for its own expansion.
///
/// Along a step the coordinates are known polynomials q_p(s). A disk |s| ≤ r in the complex plane is carried through
/// the residual R(q_p, q̇_p, q̈_p, t + s) and through switch functions and events, whose inputs are polynomials, so that
/// no majorant of the solution is needed. Each value f has a *reach* δ ≥ |f(s) − f(0)| on the disk and a *tail*: a
/// bound of that part of f which is no polynomial of the kept degree, ∞ where the disk meets a singularity. By Cauchy's
/// estimate what the step leaves out of f at |s| = x r is at most tail · x^{K+1}/(1 − x), K being the last order kept.
///
/// docs/design/safe_steps.md has the rules; L. V. Ahlfors, Complex Analysis, §4.2.3 (Cauchy's estimate).
namespace maupertuis {

/// Coefficients of all slots: the k-th of slot s, times unit^k, at rows[k · stride + s · step].
struct SlotCoefficients {
  const double* rows = nullptr;
  std::size_t stride = 0;
  int order = 0;         // of the polynomial of q̇: slots of lag ℓ are known up to order + 1 − ℓ
  double unit = 1;       // s is counted in these; 1 but where coefficients would leave the range of double
  std::size_t step = 1;  // more than 1 where several motions stand side by side
};

class Disks {
 public:
  /// Bounds the residual, and the slots named besides. The program must outlive this.
  explicit Disks(const Program& program, std::span<const std::uint32_t> slots = {});
  ~Disks();
  Disks(Disks&&) noexcept;

  /// From now on these slots alone, without the residual. Cost: that of some evaluations.
  void bound_only(std::span<const std::uint32_t> slots);
  /// False: the residual is linear in q, so that its polynomial is all there is.
  bool residual_has_tails() const;
  /// [program.constants]; anew whenever parameters or sides change.
  void set_constants(const double* constants);
  /// A step begins; the rows have to stay until the last evaluate().
  void begin(const SlotCoefficients& coefficients);
  /// How much is asked of a disk: what a smaller one needs to know of derivatives; what the rules say; and what the
  /// coefficients say besides, where a larger disk has bounded what they leave out.
  enum class Depth { Derivatives, Rules, Coefficients };
  /// Bounds on |s| ≤ radius. Within a step from large radii to small ones.
  /// Cost: some 20 operations an instruction; 2 an order and stored slot for the coefficients.
  void evaluate(double radius, Depth depth = Depth::Coefficients);
  /// Whether derivatives of other values than coordinates are bounded, for which a larger disk has to be asked first.
  bool needs_larger_disk() const;
  /// Whether distances and the like are denominators or stand under powers: sums of products of coordinates whose known
  /// coefficients tell how near they come to 0.
  bool has_bases() const;

  /// Of R_j at the radius evaluated last; rows of constraints follow those of the coordinates.
  double residual_tail(std::size_t j) const;
  /// Where there are bases: the terms of the rows are to be bounded on so many disks, from the largest to the smallest.
  static constexpr std::size_t many = 8;
  void begin_many(const SlotCoefficients& coefficients, const std::array<double, many>& radii);
  /// Bounds them, by the rules, on as many more of these disks as a register of this processor holds; those first that
  /// were asked last in the step before. False: all have been asked. Cost: some 20 operations an instruction.
  bool ask_more();
  /// What a step of length h leaves out of the rows, each term bounded on that of the disks asked so far which suits
  /// it. Cost: some 3 operations a term and disk.
  void find_left_out(double h);
  double residual_left_out(std::size_t j) const;
  /// What rounding makes of R_j at s = 0, in units of the rounding of 1: each value adds its own size to what its
  /// operands hand on, and a derivative divides by `length`, over which its operand is known. Cost: some 10 operations
  /// an instruction for each length.
  double residual_rounding(std::size_t j, double length);
  /// The same of a slot that is bounded.
  double rounding(std::uint32_t slot, double length);
  /// [slots] of polynomials in t; very large for all else.
  std::span<const int> degrees() const;
  std::size_t residuals() const;
  double tail(std::uint32_t slot) const;
  double reach(std::uint32_t slot) const;
  /// The last order of a slot that the step knows.
  int last_order(std::uint32_t slot) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace maupertuis
