#pragma once
#include "fields/field_mesh.hpp"
#include "fields/tensor_slopes.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace maupertuis {

/// A rectangle of Gauss-Lobatto elements, tensor products of those of FieldMesh.
///
/// Divided by its weight, the equation of a node of one element reads
///
///     A φ'' + g = −∂_x s_x − ∂_y s_y ± (what the sides of the element add),
///
/// since summation by parts holds exactly on Gauss-Lobatto points; nodes that elements share take the mean, as all
/// elements are of one size. A row of elements is one block of lanes, [line of nodes × local node × cells].
///
/// Coefficients go through the rows as a wave front, order k one row behind order k − 1, so that what a step needs of a
/// few rows stays in the cache whatever the size of the mesh.
class PlaneMesh final : public WaveMesh {
 public:
  static constexpr std::size_t kInputs = 6;  // of a field: φ, φ', φ_x, φ_y, φ_tx, φ_ty
  enum Input : std::size_t { Phi, Velocity, SlopeX, SlopeY, RateX, RateY };

  PlaneMesh(const FieldEquations& equations, const PointForm& form, int cells_x, int cells_y, int order);

  void start() override;
  void follow_branches(double from, double until) override;
  double omega_max(const Interrupt& interrupt) override;
  bool step(double h) override;
  double energy(double& size) override;
  const std::vector<Expr>& point_inputs() const override { return form_.inputs; }
  void visit_points(const PointVisitor& visit) override;
  void visit_sides(const std::vector<Expr>& jets, const SideVisitor& visit) override;
  double field_at(std::size_t field, const FieldJet& jet, const std::vector<double>& place) const override;

  /// Bytes that a mesh takes.
  static double bytes(const FieldEquations& equations, const PointForm& form, double cells_x, double cells_y,
                      int order);

 private:
  double advance(double h);
  using Rows = std::vector<double>;  // [rows of cells × lanes]
  struct Axis {
    int cells = 0;
    double from = 0, width = 0;
    double at(double cell) const { return from + cell * width; }
  };
  std::size_t points() const { return static_cast<std::size_t>(p_) + 1; }
  std::size_t rows() const { return static_cast<std::size_t>(axes_[1].cells); }
  std::size_t cells() const { return static_cast<std::size_t>(axes_[0].cells); }
  double weight(std::size_t lane) const;
  double place(std::size_t direction, std::size_t row, std::size_t lane) const;
  double* phi(std::size_t f, std::size_t k) { return series_.input(6 * f, k); }
  void slopes(double* to_x, double* to_y, const double* from) const;
  void prepare(std::size_t k);
  void look_for_plain_stresses(const std::vector<Expr>& roots);
  void prepare_masses();
  void masses(std::size_t row);
  bool is_alone() const { return fields_ == 1 && inverse_.empty(); }
  double share_of_force(std::size_t k) const;
  void force(std::size_t f, std::size_t row, std::size_t k, double* out);
  const double* add_stress(std::size_t f, std::size_t direction, std::size_t k, const double* base, double* to);
  void add_sides_of_elements(std::size_t f, std::size_t direction, std::size_t k, double* to);
  void share_columns(double* lanes) const;
  void process(std::size_t row, std::size_t k);
  void finish(std::size_t row, std::size_t k, std::size_t from_line, std::size_t lines, double* forces,
              std::size_t stride);
  void sweep(std::size_t orders, const std::function<void(std::size_t row)>& behind);
  void take_row(std::size_t row);
  void show_row(std::size_t row);
  std::vector<double> inputs_at(std::size_t row, std::size_t lane) const;
  std::vector<double> given_stresses(BoundaryCondition::Side side, std::size_t row, std::size_t lane);
  std::vector<bool> held_on(BoundaryCondition::Side side) const;
  bool is_on(BoundaryCondition::Side side, std::size_t row) const;
  bool is_on(BoundaryCondition::Side side, std::size_t row, std::size_t lane) const;
  std::vector<bool> held_at(std::size_t row, std::size_t lane) const;

  /// A condition or an end force, with its derivatives by t, at the nodes of a side.
  struct Held {
    BoundaryCondition::Side side;
    std::size_t field = 0;
    bool force = false;   // else the field itself
    bool varies = false;  // along the side
    Expr value;
    std::vector<Expr> derivatives;  // of its branch in force
  };
  void hold(BoundaryCondition::Side side, std::size_t field, Expr value, bool force);
  /// Calls f(lane, coefficient k of the condition) for the nodes of a side that lie in lines of a row.
  template <class F>
  void each_held(const Held& held, std::size_t row, std::size_t k, std::size_t from_line, std::size_t lines, F&& f);

  const PointForm& form_;
  int p_;
  Axis axes_[2];
  std::size_t fields_, line_ = 0, lanes_ = 0;  // nodes of a line, of a row of elements
  Lobatto rule_;
  EvenOddProduct slopes_, stiffness_;
  LaneSeries series_, energies_;
  std::vector<double> stress_scale_;  // [directions × fields] constant factors of s, which its roots are without
  std::vector<bool> is_slope_;        // [directions × fields] whether s is a number times the slope of its own field
  bool uses_slope_ = false, uses_time_ = false, uses_velocity_ = false, uses_rate_ = false;
  std::vector<Rows> u_, v_, next_u_, next_v_;  // [fields]
  std::vector<double> force_, other_;          // of one row: [fields × lanes], [lanes]
  std::vector<std::vector<double>> pending_;   // [orders] the last line of the row before, [fields × line]
  std::vector<std::vector<double>> first_;     // the same of the first line, where the plane is periodic
  std::vector<double> scalar_inverse_;         // of A where it is the same matrix of numbers at all nodes, [fields²]
  std::vector<double> inverse_;                // else [rows][fields² × lanes], of the fields that are free
  std::vector<double> a_pending_, a_first_, a_;
  bool mass_known_ = false;
  std::vector<Held> held_;
  std::shared_ptr<EndSlopes> side_slopes_[2];  // across x and y
};

}  // namespace maupertuis
