#pragma once
#include "integrator/dense_output/dense_output.hpp"

#include <maupertuis/winding.hpp>

#include <span>
#include <vector>

namespace maupertuis::taylor {

/// Whole turns that angles were wound back by. The rounding error of an angle grows with its size, and would with the
/// forces that it gives: after 10⁶ steps of a double pendulum that has turned over a hundred times, the energy error is
/// 50 times that of angles kept within a turn.
class Turns {
 public:
  /// 2π; angles beyond it are brought back.
  static constexpr double limit = 6.283185307179586;

  explicit Turns(const Kernel& kernel) : winding_(&winding(kernel)), counts_(kernel.freedoms(), 0.0) {}

  void forget() { counts_.assign(counts_.size(), 0.0), changes_ = 0; }
  /// How often an angle was brought back.
  std::size_t changes() const { return changes_; }
  /// Brings angles beyond ±2π back to ±π, exact to 100 bits. True if any was.
  bool wind(std::span<Compensated> q);
  /// The same for coordinate i alone.
  bool wind(std::size_t i, Compensated& q);
  /// The angle as it is counted outside.
  double unwound(std::size_t i, const Compensated& q) const;
  /// What observables gain by the turns.
  void add_to(std::span<double> observables) const;

 private:
  const Winding* winding_;      // of a kernel that lives as long
  std::vector<double> counts_;  // [n]
  std::size_t changes_ = 0;
};

}  // namespace maupertuis::taylor
