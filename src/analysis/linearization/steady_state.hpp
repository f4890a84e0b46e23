#pragma once
#include "analysis/linearization/dense.hpp"
#include "analysis/linearization/point_equations.hpp"

#include <maupertuis/precise_roots.hpp>
#include <maupertuis/repeated_evaluation.hpp>

#include <memory>
#include <optional>

namespace maupertuis {

/// The equations of rest and of steady motion, R(q, D c, 0, λ) = 0 with the constraints, in the unknowns (q, c, λ): q
/// as far as it is not held, c the rates of the translations D as far as they are not held. Momenta of conserved
/// translations whose rate is free keep given values.
class SteadyState {
 public:
  struct Held {
    std::vector<bool> q;      // [n] coordinates that stay
    std::vector<bool> rates;  // [translations] rates that stay
  };
  /// `momenta`: [translations] d·p to keep; NaN: none.
  SteadyState(PointEquations::Impl& equations, const std::vector<Translation>& translations, Held held,
              std::vector<double> momenta, std::vector<double> sizes);

  struct Solution {
    OperatingPoint point;
    double residual = 0;             // largest row, divided by its derivatives times typical sizes
    std::size_t family = 0;          // ways to move on and stay a solution
    std::vector<std::size_t> along;  // the coordinates that change on them, ascending
    bool proved = false;             // a root of 100 digits is there, and rounded to this point
  };
  /// From the positions and velocities of `from`; nothing where the iteration does not arrive within so many turns.
  /// With the family, what double does not tell from a solution is asked of 100 digits: flat places, multiple roots.
  std::optional<Solution> solve(const OperatingPoint& from, bool with_family = true, int turns = 80) const;
  /// The root of 100 digits within so many typical sizes: at multiple roots Newton's method in double comes nearer by a
  /// constant factor a turn, and stops far from them. Nothing where there is none, or of more than 40 unknowns.
  std::optional<Solution> precise_root(const OperatingPoint& from, double farthest) const;
  /// A step of that length (in typical sizes, at most) from a solution along its family, as far towards `target` as the
  /// directions of the family there lead. Nothing where none does.
  std::optional<OperatingPoint> step_towards(const OperatingPoint& solution, const OperatingPoint& target,
                                             double step) const;
  /// The residual there, all unknowns as they are, with the multipliers that fit best.
  double residual_at(OperatingPoint& point) const;
  /// Whether a force is left that is no rounding of its own terms, or of the unknowns: 39 N of gravity are none beside
  /// the stiffness of a bar.
  bool is_unbalanced(const OperatingPoint& point) const;

 private:
  struct System {
    Vector f;  // rows
    Matrix j;  // by the unknowns
  };
  PointEquations::Impl::Rows& balance_of(const OperatingPoint& point) const;
  Vector rows_at(const OperatingPoint& point) const;
  System system_at(const OperatingPoint& point) const;
  Vector unknowns(const OperatingPoint& point) const;
  void place(const Vector& z, OperatingPoint& point) const;
  void fit_multipliers(OperatingPoint& point) const;
  double scale_of(const System& s, const Vector& z, Index row) const;
  double scaled(const System& s, const Vector& z) const;
  double length(const Vector& move, const Vector& z) const;
  double largest_work(const System& s, const Vector& z) const;
  Matrix without_rounding(const System& s, const Vector& z) const;
  Matrix soft_ways(const Matrix& derivatives, const Equilibration& by) const;
  bool has_no_multipliers(OperatingPoint point) const;
  bool is_doubtful(const Solution& solution) const;
  std::optional<Solution> proved(const Solution& solution, double farthest) const;
  Vector sizes_of_terms(const OperatingPoint& point) const;
  std::optional<Solution> accepted(const Solution& solution, const System& s, const Vector& z, bool with_family) const;
  const PreciseRoots& precise() const;
  void find_family(Solution& solution) const;

  PointEquations::Impl& e_;
  const std::vector<Translation>& translations_;
  std::vector<std::size_t> free_q_, free_rates_, kept_momenta_;
  std::vector<double> momenta_, sizes_;
  Matrix by_rates_;  // [n × free rates]
  mutable std::unique_ptr<PreciseRoots> precise_;
  mutable std::unique_ptr<RepeatedEvaluation> terms_;  // the sizes of the terms of R and of what is kept
};

}  // namespace maupertuis
