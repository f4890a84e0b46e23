#pragma once
#include "integrator/stiff/index_two_system.hpp"
#include "integrator/stiff/motion.hpp"
#include "linear_algebra/collocation_tableau.hpp"
#include "linear_algebra/dense.hpp"

#include <complex>
#include <optional>
#include <span>
#include <vector>

namespace maupertuis::stiff {

enum class Failure {
  Value,        // infinite, undefined, or no unique accelerations
  Accuracy,     // the tolerance is finer than double precision resolves
  ErrorTest,    // no step, however short, meets the tolerance
  Convergence,  // Newton's iteration does not converge
  Constraints,  // no state on the constraints near the one reached
};

struct Advance {
  double reached = 0;
  std::optional<Failure> failure;  // then nothing was reached
  bool history_ends = false;       // the next step needs a restart
  bool drifted = false;            // over a jump, without the method
};

/// The s points of a step with what is needed of them, as matrices.
struct Stages {
  explicit Stages(int count);
  std::complex<double> lambda(Eigen::Index k) const { return tableau.lambda[static_cast<std::size_t>(k)]; }
  std::complex<double> basis(Eigen::Index i, Eigen::Index k) const {
    return tableau.basis[static_cast<std::size_t>(i * s + k)];
  }
  std::complex<double> inverse(Eigen::Index k, Eigen::Index i) const {
    return tableau.inverse[static_cast<std::size_t>(k * s + i)];
  }

  CollocationTableau tableau;
  Eigen::Index s;
  std::vector<double> nodes;  // 0 and c
  Eigen::MatrixXd a_inverse;  // of A
  Eigen::Index real = 0;      // the one real eigenvalue of A, γ
  double gamma = 0;
  Eigen::VectorXd error;  // h γ ẏ₀ + Σ error_i Z_i: what a quadrature of order s gives less what the step does
};

/// Radau IIA: collocation at s points of a step, its end among them, of order 2s − 1 (Hairer and Wanner, Solving
/// Ordinary Differential Equations II, IV.5 and IV.8). The unknowns are the increments Z_i = Y_i − y₀ of the stages:
///
///     F(t_i, y₀ + Z_i, (A⁻¹Z)_i / h) = 0,
///
/// solved by Newton's iteration with ∂F/∂ẏ and ∂F/∂y of one moment, which falls apart into a real and (s − 1)/2 complex
/// systems. The step's error is estimated by a quadrature of order s.
class RadauMethod {
 public:
  explicit RadauMethod(Motion& motion);
  /// Begins at a state that meets the constraints. Precondition: the motion was solved there.
  void restart(double t, std::span<const double> y);
  /// One step towards `bound`, at most up to it; y: the state reached, on the constraints.
  Advance advance(double bound, std::span<double> y);
  /// The state at a time in the last step by its polynomial, off the constraints by what the tolerance allows.
  void interpolate(double t, std::span<double> y) const { interpolate_at((t - t_before_) / h_before_, y); }
  /// At a part of the last step, 0 … 1: t may be too coarse to tell it.
  void interpolate_at(double part, std::span<double> y) const;
  /// Of that polynomial: s.
  int degree() const { return static_cast<int>(stages_.s); }
  int order() const { return stages_.tableau.order; }
  /// What rounding of the forces makes of velocity i in a step.
  double rounding_of_velocity(std::size_t i) const {
    return rounding_[static_cast<Eigen::Index>(motion_.freedoms() + i)];
  }
  /// No step shall be longer from now on; 0: as long as the errors allow.
  void limit(double longest) { longest_ = longest; }

 private:
  struct Factors {
    Eigen::PartialPivLU<Eigen::MatrixXd> real;
    std::vector<Eigen::PartialPivLU<Eigen::MatrixXcd>> complex;  // of the eigenvalues with a positive imaginary part
    Eigen::VectorXd rows;                                        // by which the rows are scaled
  };

  std::size_t integrals() const { return motion_.functions.integrands.outputs(); }
  double first_step(double distance);
  bool find_matrices();
  void factor(double h);
  void find_rounding(const Eigen::MatrixXd& by_rate, const Eigen::MatrixXd& by_state);
  double size_of(const Eigen::VectorXd& change) const;
  void predict(double h);
  std::optional<Failure> attempt(double h);
  std::optional<Failure> solve_stages(double h);
  bool residuals(double h);
  double correct();
  double error_of(double h);
  bool integrate(double h);
  Advance accept(double h, double end, std::span<double> y);
  static Advance failed(Failure failure) { return {0, failure, false, false}; }
  void choose_next(double h, double error);

  Motion& motion_;
  IndexTwoSystem system_;
  Stages stages_;
  std::vector<std::size_t> rows_;  // of the constraints that take part
  double t_ = 0;
  Eigen::VectorXd y_, rate_;    // (q, v, λ, μ) and (q̇, v̇, …) at t
  std::vector<double> w_;       // integrals at t
  std::vector<double> weight_;  // of errors, [2n]
  Eigen::MatrixXd by_rate_, by_state_;
  bool matrices_known_ = false, matrices_fresh_ = false;
  Factors factors_;
  double factored_for_ = 0;
  Eigen::VectorXd rounding_;               // of a state, through Newton's matrix
  Eigen::MatrixXd z_, residual_, change_;  // [size][s]
  double h_ = 0;                           // of the next step, without a sign; 0: to be guessed
  double longest_ = 0;
  double contraction_ = 0;  // of Newton's last iteration
  // The last step.
  double t_before_ = 0, h_before_ = 0, error_before_ = 0;
  Eigen::VectorXd y_before_;
  std::vector<double> w_before_;
  Eigen::MatrixXd z_before_, w_stages_;  // increments of its stages
};

}  // namespace maupertuis::stiff
