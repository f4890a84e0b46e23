#pragma once
#include <maupertuis/evaluate.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

/// Where abs, sign, step, min, max and piecewise go over from one branch to another (docs/theory/switches.md).
namespace maupertuis {

/// The functions g that decide: x of |x|, sign x and step x, b − a of min, max and a < b; each once, whatever its sign.
/// What changes its branch does so where its g passes through 0. Precondition: no TimeDerivative nodes.
std::vector<Expr> switches_of(std::span<const Expr> roots);

/// The formulas in force where g > 0 (`above`) or g < 0: every node that this switch decides is replaced by its branch.
std::vector<Expr> on_side(std::span<const Expr> roots, Expr difference, bool above);

/// The formulas where g > 0 minus those where g < 0. What a sum or a product has on both sides is not written twice.
std::vector<Expr> jump_across(std::span<const Expr> roots, Expr difference);

/// Where switches stand in some expressions. Cost: one walk; then what lies above a switch.
class SwitchUses {
 public:
  explicit SwitchUses(std::span<const Expr> roots);
  /// Of each root what the switch with this g decides: sums without the terms that do not hold it, 0 where nothing
  /// does.
  std::vector<Expr> terms_with(Expr difference) const;

 private:
  std::vector<Expr> roots_;
  std::unordered_map<NodeId, std::vector<NodeId>> parents_;
  std::unordered_map<NodeId, std::vector<NodeId>> deciding_;  // [g] the nodes that it switches
};

/// What the search for points may move, and where it begins.
struct SwitchSearch {
  std::vector<Expr> moving;  // coordinates, velocities, time
  Bindings center;           // every symbol; those that do not move keep this value
  int points = 16;           // samples on each switch
  std::uint64_t seed = 0x73776974;
};

/// Points in the branches of some switches, found by directed search: not near the center alone, and not by luck. All
/// combinations of signs are looked for, of more than six switches all those of each pair.
struct BranchPoints {
  std::vector<Bindings> points;  // of different signs
  std::size_t combinations = 0;  // that were looked for
  std::size_t missing = 0;       // of them not found: most often they exclude each other
};
BranchPoints points_in_branches(std::span<const Expr> switches, const SwitchSearch& search);

/// Functions on both sides of a switch.
struct SwitchSample {
  std::size_t which = 0;      // the index of the switch
  Bindings at;                // a point on it
  std::vector<double> below;  // [functions] beside the point where g < 0
  std::vector<double> above;  // [functions] where g > 0
  /// [functions] above − below; 0 where it vanishes as the switch is approached: kinks, pieces that meet. NaN where a
  /// side is undefined or grows without bound.
  std::vector<double> jump;
};

/// Points on each switch, by brackets of its sign along lines and bisection to 100 digits; the functions are evaluated
/// at 1e-20 and 1e-40 beside it. The first samples are those next to the center. A switch of which none was found has
/// no sample. Cost: some thousand evaluations of the switches in double, four of the functions with 100 digits a
/// sample.
std::vector<SwitchSample> sample_switches(std::span<const Expr> functions, std::span<const Expr> switches,
                                          const SwitchSearch& search);

/// Samples one switch after the other of functions that hold many. Of more than 24 the combinations of signs are not
/// looked for: points are drawn. Cost a switch: two evaluations of the functions in double a sample, four of the
/// branches in force there with 100 digits.
class SwitchSampler {
 public:
  /// Precondition: the search has every symbol of the functions.
  SwitchSampler(std::vector<Expr> functions, SwitchSearch search);
  ~SwitchSampler();
  SwitchSampler(SwitchSampler&&) noexcept;
  SwitchSampler& operator=(SwitchSampler&&) noexcept;

  const std::vector<Expr>& functions() const;
  const SwitchSearch& search() const;
  /// Precondition: the search has every symbol of g and of the functions `beside`, whose values follow those of the
  /// functions.
  std::vector<SwitchSample> sample(Expr g, std::span<const Expr> beside = {}) const;

 private:
  struct Impl;
  friend std::vector<SwitchSample> sample_switches(std::span<const Expr>, std::span<const Expr>, const SwitchSearch&);
  std::unique_ptr<Impl> impl_;
};

}  // namespace maupertuis
