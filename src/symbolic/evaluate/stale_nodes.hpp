#pragma once
#include "symbolic/evaluate/field_numbers.hpp"

#include <vector>

namespace maupertuis::evaluation {

/// The nodes of a tape that have no value yet at the point that is drawn, over one prime: what a walk evaluates.
///
/// Where a root has no value, one symbol is drawn again and the walk repeated. What does not stand above this symbol
/// keeps its value, so that many roots cost what stands above their symbols, and not the tape for each draw.
class StaleNodes {
 public:
  explicit StaleNodes(const Tape& tape) : tape_(tape), stale_(tape.size(), 1) {}

  /// Another point: all but the numbers, which belong to the prime.
  void all();
  /// The same point, with another value for the symbol to blame (and its derivatives by time, which may follow it):
  /// what stands above it, the node at which the walk ended, and what it did not reach. False where there is no such
  /// symbol.
  bool mend(FieldNumbers& numbers, const Redraw& redraw);
  /// Asked by a walk for each node in order.
  bool operator()(Position at);

 private:
  const Tape& tape_;
  std::vector<char> stale_;  // [tape]
  Position last_ = 0, reached_ = 0;
};

}  // namespace maupertuis::evaluation
