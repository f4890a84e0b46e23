#pragma once
#include <maupertuis/equations_of_motion.hpp>
#include <maupertuis/evaluate.hpp>

#include <memory>
#include <span>
#include <vector>

namespace maupertuis {

/// Expressions of a model in coordinates, multipliers, parameters and t alone: lets and inputs put in, with their time
/// derivatives.
std::vector<Expr> in_terms_of_motion(const MechanicalSystem& system, std::span<const Expr> expressions);

/// Numbers with units that stand in formulas, as the SI numbers that they are: each is a symbol of its own otherwise.
ExprVector with_constants_as_numbers(const MechanicalSystem& system, std::span<const Expr> expressions);

/// Whether all of them vanish for all parameters or, where one does not, for those that have the signs of the model's:
/// √(m² c²) is m c for positive m and c alone. `reason` of a Zero then says "for c > 0, m > 0". Parameters that stand
/// below roots and in switches are replaced by ± the square of a symbol. Cost: at most twice that of zero_test.
ZeroTest vanish_for_given_signs(const MechanicalSystem& system, std::span<const Expr> expressions);

/// The same as `in_terms_of_motion` for many lists: what is put in is made once.
class MotionTerms {
 public:
  explicit MotionTerms(const MechanicalSystem& system);
  std::vector<Expr> operator()(std::span<const Expr> expressions) const;
  Expr operator()(Expr e) const { return (*this)({&e, 1}).front(); }

 private:
  std::unordered_map<Expr, Expr, ExprHash> replacements_;
  bool twice_ = false;  // definitions hold inputs, or the other way round
};

/// The values of all parameters, as symbols bound to SI values; with t = 0.
Bindings parameter_bindings(const MechanicalSystem& system);

/// A time, a configuration and velocities.
struct MotionState {
  double t = 0;
  std::vector<double> q, v;  // [n] each
};

/// An entry of a matrix, in numbers.
struct MatrixEntry {
  std::size_t row = 0, column = 0;
  double value = 0;
};

/// The configurations and velocities that the constraints of a system allow, in numbers: for starts and for ranks at
/// points of the manifold. Runs keep to it by the kernel.
class ConstraintManifold {
 public:
  /// `rates`: further functions of q, q̇, t that the velocities must bring to zero.
  /// Cost: that of the symbolic rows of A and of M.
  explicit ConstraintManifold(const EquationsOfMotion& equations, std::vector<Expr> rates = {});
  ~ConstraintManifold();
  ConstraintManifold(ConstraintManifold&&) noexcept;

  std::size_t constraints() const;  // m, without the rates
  /// A [m × n] by rows, M [n × n] by rows; φ or ψ [m]; ψ of velocity rows, dφ/dt of the others [m].
  std::vector<double> matrix(const MotionState& state) const;
  std::vector<double> mass(const MotionState& state) const;
  /// A without the entries that are 0 as formulas, by rows; the diagonal of M, without M.
  std::vector<MatrixEntry> matrix_entries(const MotionState& state) const;
  std::vector<double> mass_diagonal(const MotionState& state) const;
  std::vector<double> values(const MotionState& state) const;
  std::vector<double> rates(const MotionState& state) const;
  /// |φ_i| divided by the sum of the sizes of its terms and of |A_ij q_j|, 0 for constraints of velocities [m].
  std::vector<double> relative_values(const MotionState& state) const;
  /// |dφ_i/dt| or |ψ_i|, and the further rates, each divided by the sum of the sizes of its terms and of
  /// |A_ij q̇_j| [m + rates].
  std::vector<double> relative_rates(const MotionState& state) const;

  /// Moves the coordinates that are not `fixed` [n] onto φ = 0 by the least kinetic change (Gauss-Newton in the metric
  /// M, or in the scaled Euclidean one where M is not positive definite, or has more entries than would be worth it).
  /// Rows that are not `active` [m] are left out; empty: all are in. False, with the best point reached in `state`,
  /// where it does not get there.
  bool move_positions(MotionState& state, const std::vector<bool>& fixed, const std::vector<bool>& active = {}) const;
  /// The same for the velocities, at a configuration that is on the manifold: dφ/dt = 0, ψ = 0 and the rates.
  bool move_velocities(MotionState& state, const std::vector<bool>& fixed, const std::vector<bool>& active = {}) const;
  /// Constraints that no positions near `from`, or no velocities there, satisfy together, though all but any one of
  /// them can be: one is left out after the other as long as the rest still clashes. Precondition: all together do
  /// clash.
  std::vector<std::size_t> smallest_clash(const MotionState& from) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace maupertuis
