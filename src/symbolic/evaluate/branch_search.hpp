#pragma once
#include <maupertuis/switches.hpp>

#include "symbolic/evaluate/tape.hpp"

#include <random>

namespace maupertuis::evaluation {

/// The signs that switches are to have; 0: any.
using Signs = std::vector<std::int8_t>;

/// Points by the signs of some functions, in double. Along each symbol that moves a fixed set of values is tried: zero,
/// the center, every constant and every part without what moves that stands in the functions, powers of ten, and what
/// lies between. A narrow gate exp(-100 (x - 3)^2) > 1/2 is met because its 3 is among them.
class BranchSearch {
 public:
  BranchSearch(std::span<const Expr> functions, const SwitchSearch& search);

  const std::vector<Expr>& moving() const { return moving_; }  // those that the functions know
  const std::vector<double>& values_to_try(std::size_t symbol) const { return tried_[symbol]; }

  /// All that may move at random: near the center, near a value to try, at any size.
  Bindings draw();
  std::vector<double> values(const Bindings& at) const;
  Signs signs(const Bindings& at) const;
  /// From `point` to these signs, one symbol after the other. False where it does not get there.
  bool reach(Bindings& point, const Signs& wanted) const;
  std::mt19937_64& random() { return random_; }

 private:
  double distance(const Bindings& at, const Signs& wanted) const;

  Tape tape_;
  std::vector<Expr> moving_;
  std::vector<std::vector<double>> tried_;  // [moving]
  const SwitchSearch& search_;
  std::mt19937_64 random_;
};

}  // namespace maupertuis::evaluation
