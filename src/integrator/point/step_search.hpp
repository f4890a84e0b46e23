#pragma once
#include <maupertuis/function_disks.hpp>

#include <array>
#include <functional>
#include <span>
#include <vector>

namespace maupertuis {

/// What a function does everywhere along a step, not only at the points that a method looks at.
///
/// The inputs are polynomials in x ∈ [−1, 1], the step. It is cut into pieces until on each the function is a
/// polynomial of degree 15, up to a bound that follows from a disk around the piece (FunctionDisks); the sixteen values
/// on each piece are then all there is to know. A piece shorter than 2^-30 of the step is not cut again: a switch lies
/// in it.
class StepSearch {
 public:
  static constexpr std::size_t path_points = 8, piece_points = 16;
  enum class Outcome {
    Seen,       // all pieces were visited
    Stopped,    // by the visitor
    TooRough,   // more pieces than a step may need
    NotFinite,  // no value somewhere within the step
  };
  /// Whether tails of this size, one an output, are small enough.
  using Small = std::function<bool(std::span<const double> tails)>;
  /// Told the values at x, their weight in ∫ dx, and whether a switch lies there; false stops the search.
  using Visitor = std::function<bool(double x, double weight, std::span<const double> values, bool switched)>;

  StepSearch(const FunctionKernel& function, std::span<const double> parameters);

  /// The x at which the path is given.
  static const std::array<double, path_points>& path_nodes();
  /// points: [path_points × inputs].
  void set_path(std::span<const double> points);
  std::span<const double> values_at(double x);
  /// Cost: sixteen evaluations and one to three disks a piece; mostly there is one piece.
  Outcome visit(const Small& small, const Visitor& visitor);

 private:
  struct Piece {
    double centre = 0, half = 1;
  };
  bool is_resolved(const Piece& piece, const Small& small);

  FunctionKernel function_;
  FunctionWorkspace work_;
  FunctionDisks disks_;
  std::vector<std::array<double, path_points>> path_;  // [inputs] coefficients of x^k
  std::vector<double> point_, reach_, values_, tails_;
};

}  // namespace maupertuis
