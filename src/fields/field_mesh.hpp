#pragma once
#include "fields/lane_series.hpp"
#include "fields/wave_mesh.hpp"
#include "linear_algebra/quadrature.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace maupertuis {

/// ℒ at the points of a mesh, as a function of what the fields are there.
///
/// Discretised with Gauss-Lobatto points both as nodes and for the integral, δ∫ℒ dx = 0 says at each node
///
///     w J (A φ'' + g) = Σ_q w_q ℓ'(x_q) s_q,   A = ∂²ℒ/∂φ'∂φ', s = ∂ℒ/∂φ_x − ∂𝒟/∂φ_tx,
///     g = (∂²ℒ/∂φ'∂φ) φ' + (∂²ℒ/∂φ'∂φ_x) φ_tx + ∂²ℒ/∂φ'∂t − ∂ℒ/∂φ + ∂𝒟/∂φ' − f
///
/// A is that of the point alone, so that M is diagonal but for the fields among themselves.
///
/// In the plane s has a component along each space variable.
struct PointForm {
  std::size_t fields = 0, directions = 1;
  std::vector<Expr> inputs;  // φ, φ', φ_x, φ_tx (in the plane φ_x, φ_y, φ_tx, φ_ty) of each field, then x (, y), t
  std::vector<Expr> a, g, s;  // [fields²], [fields], [directions × fields]
  Expr energy;                // density of h_E
  bool conserves = false;
  bool constant_mass = true;  // A changes neither in time nor with the fields
};
std::optional<PointForm> point_form(const FieldEquations& equations, Diagnostics& diagnostics);

class EndSlopes;

/// One discretisation and its state. Lanes are [local node × cells], so that what belongs to one local node of all
/// cells lies together.
class FieldMesh final : public WaveMesh {
 public:
  FieldMesh(const FieldEquations& equations, const PointForm& form, int cells, int order);

  void start() override;
  void follow_branches(double from, double until) override;
  double omega_max(const Interrupt& interrupt) override;
  bool step(double h) override;
  double energy(double& size) override;
  const std::vector<Expr>& point_inputs() const override { return form_.inputs; }
  void visit_points(const PointVisitor& visit) override;
  void visit_sides(const std::vector<Expr>& jets, const SideVisitor& visit) override;
  double field_at(std::size_t field, const FieldJet& jet, const std::vector<double>& place) const override;
  /// Steps that the series bounds are so many times as long: of a mesh whose difference to another is to tell of steps.
  void lengthen_steps(double times) { longer_ = times; }
  /// Bytes that a mesh takes.
  static double bytes(const FieldEquations& equations, const PointForm& form, double cells, int order);
  std::size_t nodes() const { return static_cast<std::size_t>(cells_) * static_cast<std::size_t>(p_); }

 private:
  std::size_t local(int j, int e) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(cells_) + static_cast<std::size_t>(e);
  }
  double* phi(std::size_t f, std::size_t k) { return series_.input(4 * f, k); }
  double* velocity(std::size_t f, std::size_t k) { return series_.input(4 * f + 1, k); }
  double* slope(std::size_t f, std::size_t k) { return series_.input(4 * f + 2, k); }
  double* rate(std::size_t f, std::size_t k) { return series_.input(4 * f + 3, k); }
  /// Coefficient k of all that follows from φ_0..k and φ'_0..k: the accelerations.
  void coefficient(std::size_t k);
  void show_state();
  std::vector<std::vector<double>> element_inputs(std::size_t cell) const;
  std::vector<double> inputs_at_end(bool right);
  void differentiate_along_x(const double* from, double* to) const;
  void forces(std::size_t f, std::size_t k);
  void share(std::vector<double>& lanes) const;
  double reach(double h);
  bool advance(double h);  // by the series that is there
  void masses();
  void solve(std::size_t k);
  void hold_ends(std::size_t k);
  std::vector<bool> held_at(std::size_t lane) const;
  void load(const std::vector<std::vector<double>>& u, const std::vector<std::vector<double>>& v);
  double boundary_coefficient(const std::vector<Expr>& derivatives, std::size_t k) const;

  const PointForm& form_;
  double left_ = 0, width_ = 0;  // of the domain, of a cell
  int cells_, p_;
  std::size_t lanes_ = 0, fields_ = 0;
  Lobatto rule_;
  LaneSeries series_, energies_;  // of the equations; of the energy at one moment
  bool needs_rate_ = false;
  double longer_ = 1;
  std::vector<std::vector<double>> u_, v_;  // [fields][lanes]
  std::vector<std::vector<double>> force_;  // [fields][lanes]
  std::vector<double> mass_;                // [fields² × lanes], inverse, of the fields that are free
  std::vector<std::vector<double>> past_;   // accelerations by order [fields · orders][lanes]
  bool constant_mass_ = false, mass_known_ = false;
  struct Held {
    bool right = false;
    std::size_t field = 0;
    Expr value;                     // at the end
    std::vector<Expr> derivatives;  // of its branch in force
    bool force = false;             // else the field itself
  };
  std::size_t node_of(const Held& held) const { return held.right ? local(p_, cells_ - 1) : local(0, 0); }
  std::vector<Held> held_;
  std::shared_ptr<EndSlopes> end_slopes_;  // made when sides are first looked at
};

}  // namespace maupertuis
