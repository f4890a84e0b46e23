#pragma once
#include "fields/galerkin_mesh.hpp"
#include "linear_algebra/collocation_tableau.hpp"

#include <complex>
#include <map>
#include <memory>

namespace maupertuis {

/// A discrete Lagrangian L(c, c') in steps of Gauss's collocation:
///
///     ∂L/∂c'(Q_i, V_i) = p_0 + h Σ a_ij F(Q_j, V_j),   Q_i = c_0 + h Σ a_ij V_j
///
/// which needs no regular mass matrix: where ℒ is linear in the velocities, p = ∂L/∂c' is a function of c, and this is
/// ω(c) c' = ∇H. Solved by Newton's method with the matrices M + hλ G + (hλ)² K of one moment.
class CollocationMotion final : public FieldMotion {
 public:
  CollocationMotion(const FieldEquations& equations, const DensityForm& form, const std::vector<int>& cells, int degree,
                    int stages);

  void start() override;
  /// Where the equations of a step have no solution near, by halves of it, down to h/4096.
  bool step(double h) override;
  double energy(double& size) override;
  const std::vector<Expr>& point_inputs() const override { return form_.inputs; }
  void visit_points(const PointVisitor& visit) override;
  void visit_sides(const std::vector<Expr>& jets, const SideVisitor& visit) override;
  double field_at(std::size_t field, const FieldJet& jet, const std::vector<double>& place) const override;
  double width_of_cell() const { return mesh_.axis(0).width(); }

  /// The longest step whose error, summed over the duration, is `goal` of the field's size; found by comparing a step
  /// with two of half of it from the start on. Leaves the state as it was.
  double choose_step(double longest, double duration, double goal, const Interrupt& interrupt);
  /// Asked at each of Newton's rounds.
  void watch(const Interrupt& interrupt) { interrupt_ = interrupt; }
  /// What a run on such a mesh takes of memory, all but a factor 2.
  static double bytes(const DensityForm& form, const std::vector<int>& cells, int degree, int stages);

 private:
  struct Factors {
    std::vector<MeshMatrix<std::complex<double>>> of;     // [stages], empty where Im λ < 0
    std::vector<std::vector<std::complex<double>>> null;  // J⁻¹ of each null vector, by stages with Im λ ≥ 0
  };
  /// A condition or a force at an end, or along a side.
  struct Held {
    std::vector<std::size_t> coefficients;
    std::size_t field = 0;
    int space = 0;
    BoundaryCondition::Side side = BoundaryCondition::Side::Left;
    bool force = false;
    double scale = 1;                            // coefficient / value; a moment does work on the value
    std::vector<std::vector<Expr>> derivatives;  // of the value: itself, once by t; each with those along the side
  };
  struct State {
    std::vector<double> c, c_lost, p, p_lost;
    double t = 0;
  };
  void hold(BoundaryCondition::Side side, std::size_t field, int space, Expr value, bool force);
  /// What a condition says of its coefficients (`by_time` 0) or of their rates (1), at a moment.
  void impose(const Held& held, int by_time, double t, std::vector<double>& to) const;
  void note_clash(const Held& held, int by_time, const std::vector<double>& start,
                  const std::vector<double>& condition);
  bool take_conditions();
  void start_field(std::size_t field, bool rate, std::vector<double>& to);
  void find_null_vectors();
  void fix_constants();
  /// Whether the product is no more than this part of the largest entry, but for coefficients that are held.
  bool vanishes(const MeshMatrix<double>& matrix, const std::vector<double>& v, double rounding) const;
  const Factors* factors_for(double h);
  void refresh_matrices(const std::vector<double>& c, const std::vector<double>& v, double t);
  bool newton(double h);
  void predict_stages(double h);
  bool find_stages(double h);
  bool one_step(double h);
  void add_stages(double h);
  bool step_or_halves(double h, int halvings);
  void residuals(double h);
  double correct(double h, const Factors& factors);
  void leave_null_vectors_out(const Factors& factors, std::size_t stage, std::vector<std::complex<double>>& w) const;
  void add_end_forces(double t, double* f) const;
  void note_size();
  void restore(const State& s) { state_ = s, t_ = s.t, rates_known_ = false, have_stages_ = false; }
  /// What gives velocities from momenta, or from the equations of first order, at one moment.
  struct RateMatrix {
    MeshMatrix<double> factored, a;  // a = ∂p/∂c
    bool regular = false;
    std::size_t null_vectors = 0;  // that were known
  };
  const RateMatrix& rate_matrix() const;
  /// c' at the present moment, from the momenta, or from the equations of first order.
  void find_rates() const;

  const DensityForm& form_;
  mutable GalerkinMesh mesh_;
  CollocationTableau tableau_;
  std::vector<Held> held_;
  std::vector<bool> is_held_;          // [size]: no unknown of Newton's method
  std::vector<bool> is_first_order_;   // [size]: of a field whose momenta hold no velocity
  std::vector<std::size_t> field_of_;  // [size]
  State state_;
  mutable std::vector<double> rates_;
  mutable bool rates_known_ = false;
  std::vector<std::vector<double>> stage_v_, stage_q_, residual_;  // [stages][size]
  bool have_stages_ = false;
  std::vector<double> recent_size_;  // [fields], in the mean square
  double rounding_ = 0;              // the last change of the last step that was solved, where it is rounding
  double last_h_ = 0;
  mutable GalerkinMesh::Matrices matrices_;
  mutable bool matrices_known_ = false;
  mutable std::optional<RateMatrix> rate_matrix_;  // kept where it is the same at all times
  std::map<double, Factors> factors_;
  std::vector<std::vector<double>> null_;  // orthonormal vectors that are left out of the motion
  bool all_first_order_ = false;
  Interrupt interrupt_;
  bool slow_ = false;  // Newton's last step took many rounds: new matrices for the next
};

}  // namespace maupertuis
