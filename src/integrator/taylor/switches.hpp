#pragma once
#include <maupertuis/kernel.hpp>

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace maupertuis::taylor {

/// A function along the motion whose sign changes are to be seen: a switch function or an event.
struct Watched {
  std::int8_t side = 0;     // sign before the next crossing; 0: vanishes identically (switch), not known (event)
  bool at_zero = false;     // the step begins at a zero that was located
};

/// The polynomial of a watched function over a step of length h, in x = τ/h.
struct ScaledPolynomial {
  std::vector<double> p;
  double scale = 0;         // sizes of the terms of p_0
  double reach = 0;         // scale + Σ_{k≥1} |p_k|

  /// Index of the first coefficient after p_0 that is told from zero; 0 if there is none.
  std::size_t leading() const;
  bool begins_at_zero() const;
  /// The side that the function takes from a zero at x = 0: sign of its first derivative that is not zero.
  std::int8_t direction() const;
};

ScaledPolynomial switch_polynomial(const KernelWorkspace& work, std::size_t index, double h);
ScaledPolynomial event_polynomial(const KernelWorkspace& work, std::size_t index, double h);

/// The first x in (0, 1] where the function leaves its side. A zero at x = 0 is divided out.
std::optional<double> crossing(const ScaledPolynomial& polynomial, const Watched& watched);

/// Decides the sides of the switch functions at the beginning of a step, and with them the formulas in force.
///
/// Away from its zero a function's sign decides. At a zero the side is the one that the motion goes to, by the first
/// derivative that does not vanish; since the motion may depend on the side, a choice is tried and must confirm itself.
/// When none does, both sides push back: the motion would slide along the switch.
class SideChooser {
 public:
  /// `expand` computes the motion under given sides and returns the step length over which it is to be judged, or
  /// nothing where that fails.
  using Expand = std::function<std::optional<double>(const std::vector<std::int8_t>&)>;

  SideChooser(const KernelWorkspace& work, std::vector<Watched>& watched, Expand expand)
      : work_(work), watched_(watched), expand_(std::move(expand)) {}

  enum class Outcome { Decided, Sliding, Failed };
  /// Precondition: the workspace holds the motion under the present sides, judged over h.
  Outcome decide(double h);
  std::size_t sliding() const { return sliding_; }

 private:
  bool collect(double h);
  bool confirms(double h) const;
  std::optional<bool> tries(const std::vector<std::int8_t>& sides);
  Outcome alone(std::size_t index);
  Outcome together();
  std::vector<std::int8_t> sides() const;
  void adopt(const std::vector<std::int8_t>& sides);

  const KernelWorkspace& work_;
  std::vector<Watched>& watched_;
  Expand expand_;
  std::vector<std::size_t> at_zero_;
  std::size_t sliding_ = 0;
};

}  // namespace maupertuis::taylor
