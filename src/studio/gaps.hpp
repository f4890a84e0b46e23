#pragma once
#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/equations_of_motion.hpp>
#include <maupertuis/evaluate.hpp>

namespace maupertuis::studio {

/// The gaps of the contacts of a system in numbers: what a dragged mechanism must not pass through.
class Gaps {
 public:
  explicit Gaps(const MechanicalSystem& system);

  struct Gap {
    double value = 0;           // SI; below 0 the contact is violated
    std::vector<double> slope;  // ∂g/∂q [n]
    double size = 0;            // Σ |∂g/∂q_i q_i|: what rounding of q is measured by

    /// Open, or closed but for what the digits of a start hide.
    bool kept() const { return value >= 0.5 * margin * size; }
    double wanted() const { return margin * size; }
    static constexpr double margin = 4e-12;
  };
  std::vector<Gap> at(const MotionState& state) const;
  bool kept(const MotionState& state) const;
  bool empty() const { return count_ == 0; }

 private:
  const MechanicalSystem& system_;
  std::size_t count_ = 0;
  std::vector<Expr> formulas_;  // of each contact its gap and its slopes
  Bindings parameters_;
};

}  // namespace maupertuis::studio
