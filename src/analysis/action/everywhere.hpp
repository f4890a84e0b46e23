#pragma once
#include "analysis/action/functional.hpp"

#include <maupertuis/function_disks.hpp>
#include <maupertuis/stop_flag.hpp>

#include <functional>
#include <span>
#include <vector>

namespace maupertuis::action {

/// A piece of the independent variable.
struct Piece {
  double from = 0, to = 0;
  double middle() const { return from + (to - from) / 2; }
  double width() const { return to - from; }
  /// No number lies between its ends.
  bool is_point() const { return middle() == from || middle() == to; }
};

/// Functions of the independent variable alone, known everywhere and not only at the points where they are looked at:
/// bounds on disks (FunctionDisks) say what polynomials leave out of them on a piece.
class Everywhere {
 public:
  /// `functions` of the independent variable and of parameters.
  Everywhere(const MechanicalSystem& system, const ExprVector& functions);

  std::span<const double> at(double t);
  /// What the best polynomials of a degree leave out of each function on a piece, at most; ∞ where a switch or a
  /// singularity lies so near that nothing is known.
  std::span<const double> left_out(const Piece& piece, int degree);

 private:
  FunctionKernel kernel_;
  FunctionWorkspace work_;
  FunctionDisks disks_;
  std::vector<double> out_, left_out_;
};

/// Where a function could not be resolved: a piece that is not cut any more, about a switch or a singularity.
using Gap = Piece;

struct Integral {
  enum class Told {
    Known,
    NotFinite,  // no finite value inside
    Diverges,   // what lies next to `at` counts, however little that is
    TooRough,   // more pieces than there may be
  };
  Told told = Told::Known;
  double value = 0;
  double left_out = 0;  // at most
  double size = 0;      // ∫ Σ |terms|
  double at = 0;
  std::vector<Piece> pieces;  // by time
};

/// ∫ f dt by Gauss's rule on pieces, cut where the bound is largest until all bounds together are at rounding. What is
/// narrow is seen as what is wide is. Cost: some ten evaluations of f a piece, at most 10⁵ pieces.
Integral integrate(const MechanicalSystem& system, Expr f, const Piece& whole, const Vector& points,
                   const Vector& weights, const StopFlag* interrupt);

struct Visit {
  bool whole = true;  // false: more pieces than there may be
  std::vector<Piece> pieces;
  std::vector<Gap> gaps;
};

/// The pieces on which all functions are polynomials of a degree, as far as `small` asks for it.
Visit visit(Everywhere& functions, const Piece& whole, int degree,
            const std::function<bool(const Piece&, std::span<const double> left_out)>& small,
            const StopFlag* interrupt);

}  // namespace maupertuis::action
