#pragma once
#include <maupertuis/kernel.hpp>

#include <cstdint>
#include <functional>
#include <optional>
#include <type_traits>
#include <vector>

namespace maupertuis::taylor {

/// The number type of a workspace. One of more digits than double (kernel/extended) names its own.
template <class Work>
struct ScalarOf {
  using Type = typename Work::Scalar;
};
template <>
struct ScalarOf<KernelWorkspace> {
  using Type = double;
};

/// A function along the motion whose sign changes are to be seen: a switch function or an event.
struct Watched {
  std::int8_t side = 0;    // sign before the next crossing; 0: vanishes identically (switch), not known (event)
  bool at_zero = false;    // the step begins at a zero that was located
  std::uint8_t order = 1;  // of that zero, where it is known from elsewhere: lower powers are rounding
  bool is_open = false;  // an event comes to that zero from `side` where a switch changes: what follows tells its kind
  double hidden = 0;     // of such a zero, in time: by how much rounding may have moved it
};

/// The polynomial of a watched function over a step of length h, in x = τ/h.
template <class T>
struct ScaledPolynomialOf {
  std::vector<T> p;
  T scale = T(0);  // sizes of the terms of p_0
  T reach = T(0);  // scale + Σ_{k≥1} |p_k|

  /// What rounding may make of it in [0, x].
  T error_up_to(const T& x) const;
  /// Index of the first coefficient after p_0 that is told from zero; 0 if there is none.
  std::size_t leading(std::size_t from = 1) const;
  bool begins_at_zero() const;
  /// The side that the function takes from a zero at x = 0: sign of its first derivative that is not zero.
  std::int8_t direction(std::size_t from = 1) const;
};

using ScaledPolynomial = ScaledPolynomialOf<double>;

/// The same over a part of the step so short that its first terms outweigh the others: else those that come first in
/// time are lost among the sizes of those that grow fastest. Over the whole step where its first terms are rounding.
template <class T>
ScaledPolynomialOf<T> judged(const ScaledPolynomialOf<T>& whole);

template <class Work, class T = typename ScalarOf<Work>::Type>
ScaledPolynomialOf<T> switch_polynomial(const Work& work, std::size_t index, const std::type_identity_t<T>& h);
template <class Work, class T = typename ScalarOf<Work>::Type>
ScaledPolynomialOf<T> event_polynomial(const Work& work, std::size_t index, const std::type_identity_t<T>& h);

/// The first x in (0, 1] where the function leaves its side. A zero at x = 0 is divided out.
template <class T>
std::optional<T> crossing(const ScaledPolynomialOf<T>& polynomial, const Watched& watched);

/// The first x in [0, until] where the function is no longer told from zero, though it may be clear of it: a polynomial
/// about a place far from a zero has large terms, and their rounding there. Nothing where it stays on its side for
/// certain.
template <class T>
std::optional<T> first_unclear(const ScaledPolynomialOf<T>& polynomial, const Watched& watched,
                               const std::type_identity_t<T>& until);

/// Decides the sides of the switch functions at the beginning of a step, and with them the formulas in force.
///
/// Away from its zero a function's sign decides. At a zero the side is the one that the motion goes to, by the first
/// derivative that does not vanish; since the motion may depend on the side, a choice is tried and must confirm itself.
/// When none does, both sides push back: the motion would slide along the switch.
template <class Work>
class SideChooserOf {
 public:
  using T = typename ScalarOf<Work>::Type;
  /// `expand` computes the motion under given sides and returns the step length over which it is to be judged, or
  /// nothing where that fails.
  using Expand = std::function<std::optional<T>(const std::vector<std::int8_t>&)>;

  SideChooserOf(const Work& work, std::vector<Watched>& watched, Expand expand)
      : work_(work), watched_(watched), expand_(std::move(expand)) {}

  enum class Outcome { Decided, Sliding, Failed };
  /// Precondition: the workspace holds the motion under the present sides, judged over h.
  Outcome decide(T h);
  std::size_t sliding() const { return sliding_; }

 private:
  bool collect();
  bool confirms(const T& h) const;
  std::optional<bool> tries(const std::vector<std::int8_t>& sides);
  Outcome alone(std::size_t index);
  Outcome together();
  std::vector<std::int8_t> sides() const;
  void adopt(const std::vector<std::int8_t>& sides);

  const Work& work_;
  std::vector<Watched>& watched_;
  Expand expand_;
  std::vector<std::size_t> at_zero_;
  std::size_t sliding_ = 0;
};

using SideChooser = SideChooserOf<KernelWorkspace>;

}  // namespace maupertuis::taylor
