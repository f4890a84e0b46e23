#pragma once
#include <maupertuis/kernel.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

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

struct Instruction;
class ResidualTerms;

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
  bool residual_has_tails() const { return residual_has_tails_; }
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
  bool needs_larger_disk() const { return !derived_.empty(); }
  /// Whether distances and the like are denominators or stand under powers: sums of products of coordinates whose known
  /// coefficients tell how near they come to 0.
  bool has_bases() const { return !bases_.empty(); }

  /// Of R_j at the radius evaluated last; rows of constraints follow those of the coordinates.
  double residual_tail(std::size_t j) const;
  /// What a step of length h leaves out of the rows, each term bounded on that of the disks since begin() which suits
  /// it; where there are bases. Cost: some 3 operations a term and disk.
  void find_left_out(double h, std::uint32_t without = 0);
  double residual_left_out(std::size_t j) const;
  /// Of the disks since begin(), as they were asked.
  const std::vector<double>& radii() const;
  /// What rounding makes of R_j at s = 0, in units of the rounding of 1: each value adds its own size to what its
  /// operands hand on, and a derivative divides by `length`, over which its operand is known. Cost: some 10 operations
  /// an instruction for each length.
  double residual_rounding(std::size_t j, double length);
  /// [slots] of polynomials in t; very large for all else.
  std::span<const int> degrees() const { return degree_; }
  std::size_t residuals() const { return residual_.size(); }
  double tail(std::uint32_t slot) const { return tail_[slot]; }
  double reach(std::uint32_t slot) const { return reach_[slot]; }
  /// The last order of a slot that the step knows.
  int last_order(std::uint32_t slot) const;

 private:
  struct Term {
    double size = 0;  // |coefficient|
    std::uint32_t coefficient = 0, a = 0, b = 0, shift = 0;
  };
  struct Node;
  struct Bounds {
    double reach, tail, low, high;  // |f| lies in [low, high]
  };

  void find_degrees();
  void find_series(const std::vector<bool>& made);
  void find_needs(std::span<const std::uint32_t> slots, bool residual);
  void need_operands(const Node& node);
  void find_derived();
  void find_powers();
  void evaluate_coordinates();
  double reach_of_rate(std::uint32_t slot, int shift) const;
  void evaluate_series();
  void evaluate(const Node& node);
  void find_roundings(double length);
  double rounding_of_derivative(std::uint32_t slot, std::uint32_t shift) const;
  double rounding_of(const Node& node) const;
  Bounds sum(const Node& node) const;
  void add_disk();
  double tail_of_sum(const Instruction& instruction) const;
  Bounds product(std::uint32_t a, std::uint32_t b) const;
  Bounds quotient(const Node& node) const;
  Bounds power(std::uint32_t a, double exponent, double centre) const;
  Bounds function(const Node& node) const;
  Bounds chosen(const Instruction& instruction) const;
  void pair(const Node& node);
  void set(std::uint32_t slot, Bounds bounds);
  double coefficient(int k, std::uint32_t slot) const {
    return now_.rows[static_cast<std::size_t>(k) * now_.stride + slot * now_.step];
  }
  void find_bases();
  double low_of_base(std::uint32_t slot) const;
  double beyond(std::uint32_t slot) const;
  double centre(std::uint32_t slot, std::uint32_t shift = 0) const;
  double shifted_reach(const Term& term) const;
  double shifted_tail(const Term& term) const;
  double series_of_derivative(std::uint32_t slot, std::uint32_t shift) const;

  const Program& program_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> needed_;                  // nodes that evaluate() carries out, in order
  std::vector<std::uint32_t> derived_;                 // those of them that Depth::Derivatives does
  bool by_coefficients_ = false;                       // the depth of the disk at hand
  std::vector<std::int8_t> needs_reach_, needs_tail_;  // [slots]
  int most_rates_ = 0;                                 // up to this shift the reach of coordinates is needed
  std::vector<Term> terms_;
  std::unique_ptr<ResidualTerms> rows_;
  bool bounds_residual_ = true;
  std::vector<int> residual_;            // node that makes R_j; −1: none
  std::vector<std::int8_t> has_series_;  // [slots] all known orders are in the rows
  std::vector<std::uint32_t> bases_;     // slots
  std::vector<std::int8_t> is_base_;     // [slots]
  std::vector<int> maker_;               // [slots] node; −1: none
  std::vector<std::uint32_t> alone_;     // slots with a series beyond the stored ones
  std::vector<std::uint32_t> few_;       // those with a series that are needed, where bound_only() left few of them
  bool only_few_ = false;
  std::vector<int> degree_;   // [slots] of polynomials in t; very large for all else
  std::vector<bool> linear_;  // [slots] in coordinates and polynomials in t
  bool residual_has_tails_ = false;
  const double* constants_ = nullptr;

  SlotCoefficients now_;
  double radius_ = 0, previous_ = 0;   // evaluated last and before it, in units of now_.unit
  std::vector<double> powers_;         // [orders] radius^k
  std::array<double, 4> passed_on_{};  // by lag + 1: what a tail at the previous radius leaves in the series
  std::vector<double> reach_, tail_, low_, high_;   // [slots] |f| lies in [low, high] on the disk
  std::vector<double> reach_before_, tail_before_;  // [slots] at the previous radius
  std::vector<double> rounding_;                    // [slots]
  double rounding_length_ = 0;                      // that they belong to; 0: there are none of this step
  std::vector<double> series_;                      // [slots] Σ_{k≥1} |f_k| r^k
  std::vector<double> upper_;                       // [unknowns] Σ |q_k| r^k of the upper half of the orders
  std::array<std::vector<double>, 2> rate_reach_;   // [unknowns] of q̇ and q̈
};

}  // namespace maupertuis
