#pragma once
#include "analysis/action/everywhere.hpp"
#include "analysis/action/problem.hpp"

#include <optional>
#include <span>
#include <vector>

namespace maupertuis::action {

/// q, q', q'' of a path as functions of t, and the sizes of the terms of q and q'.
class PathFunctions {
 public:
  PathFunctions(const MechanicalSystem& system, std::span<const Expr> path);

  /// Afterwards q(), v(), a().
  void at(double t) { work_->evaluate({&t, 1}, out_); }
  const double* q() const { return out_.data(); }
  const double* v() const { return out_.data() + n_; }
  const double* a() const { return out_.data() + 2 * n_; }
  const double* q_terms() const { return out_.data() + 3 * n_; }
  const double* v_terms() const { return out_.data() + 4 * n_; }

  /// Functions of q, q', q'', t as functions of t along the path.
  ExprVector on_path(std::span<const Expr> functions) const;

 private:
  const MechanicalSystem& system_;
  Index n_;
  ExprMap path_;
  FunctionKernel kernel_;
  std::optional<FunctionWorkspace> work_;
  std::vector<double> out_;
};

/// d/dt ∂L/∂q' − ∂L/∂q in numbers, of L and of each G, with the sizes of the terms.
class Residual {
 public:
  explicit Residual(const Problem& problem);

  /// rows [n × 1 + k], sizes [n × 1 + k]
  void at(double t, const PathFunctions& path, Matrix& rows, Matrix& sizes);
  /// The rows as formulas, in the order of the numbers.
  const ExprVector& rows() const { return rows_; }

 private:
  Index n_, k_;
  ExprVector rows_;
  std::vector<std::size_t> first_;
  FunctionKernel kernel_;
  std::optional<FunctionWorkspace> work_;
  std::vector<double> in_, out_;
};

/// Whether a path that is given solves the equations: seen on pieces so short that nothing hides between the places
/// that are looked at, and at the corners between them, where p = ∂L/∂q' and h_E have to go on (Weierstrass, Erdmann).
class GivenEquations {
 public:
  GivenEquations(Problem& problem, PathFunctions& path, const Piece& whole);

  /// False where it is no path: it jumps (E1213), leaves the constraints (E1202), or too much happens on it (E1212).
  bool is_path(const ActionOptions& options, Diagnostics& diagnostics);
  const std::vector<Piece>& pieces() const { return visit_.pieces; }
  /// Fills what is said of the equations. After is_path.
  void judge(GivenPath& out);

 private:
  /// What the values of functions before and after a place differ by, where that is a jump and no steep slope.
  struct Sides {
    std::vector<double> before, after, far_before, far_after;
  };
  Sides sides_of(const Gap& gap);
  static bool jumps(const Sides& sides, std::size_t function, double size);
  bool keeps_constraints(Diagnostics& diagnostics);
  Vector projected(double t, const Vector& vector);
  double momentum(const std::vector<double>& values, Index i, const Vector& lambda) const;
  double energy(const std::vector<double>& values, const Vector& lambda) const;
  void look_for_corners(const Vector& lambda, GivenPath& out);
  std::vector<double> looks() const;

  Problem& problem_;
  PathFunctions& path_;
  Piece whole_;
  Index n_, k_;
  Residual residual_;
  Everywhere functions_;  // rows [n (1 + k)], q [n], p [n (1 + k)], h_E [1 + k]
  Vector least_;
  double largest_size_ = 0;
  Visit visit_;
};

}  // namespace maupertuis::action
