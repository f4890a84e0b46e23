#pragma once
#include "kernel/reference/reference.hpp"

namespace maupertuis::reference {

/// Section AtPoint for observables, which are read at order 0 alone: each of its instructions up to the order that one
/// of them needs. Most need no more than order 0; a derivative by t reads one more.
class PointSection {
 public:
  explicit PointSection(const Program& program);

  bool empty() const { return parts_.empty(); }
  /// Whether q̈ has an influence.
  bool follows_acceleration() const;
  /// What is known after stage `stage` ≤ 0.
  void run(Memory& memory, int stage) const;

 private:
  struct Part {
    Run run;
    int highest;  // order
  };
  std::vector<Part> parts_;
};

}  // namespace maupertuis::reference
