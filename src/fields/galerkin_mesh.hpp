#pragma once
#include "fields/careful_sum.hpp"
#include "fields/density_form.hpp"
#include "fields/field_motion.hpp"
#include "fields/lane_series.hpp"
#include "fields/mesh_axis.hpp"
#include "linear_algebra/mesh_matrix.hpp"

#include <array>
#include <optional>

namespace maupertuis {

/// The discrete Lagrangian of fields on elements of equal size, along a line or over a rectangle. Coefficients of what
/// stands at the ends of elements are shared, so that smooth fields have continuous slopes.
///
/// A cell has functions N_i(x) N_j(y), numbered j × (functions along x) + i; likewise its points of quadrature. A lane
/// is a point of a cell, [points × cells], a cell one of [cells along y × cells along x].
class GalerkinMesh {
 public:
  using Side = BoundaryCondition::Side;
  GalerkinMesh(const FieldEquations& equations, const DensityForm& form, const std::vector<int>& cells, int degree,
               const Bindings& values, std::string& trouble);

  std::size_t size() const { return size_; }
  const std::shared_ptr<const SparsityPattern>& pattern() const { return pattern_; }  // of its matrices
  const MeshAxis& axis(std::size_t direction) const { return axes_[direction]; }
  /// Values of the jets at the quadrature points: to be called before what follows, and with `all` before energies and
  /// integrals, which hold more of them than forces do.
  void set(const double* c, const double* rates, double t, bool all = false);
  void momenta(double* out) const;
  void forces(double* out) const;  // without forces at ends
  double energy(double& size);
  /// M = ∂p/∂c', A = ∂p/∂c, G = A − ∂F/∂c', K = −∂F/∂c.
  struct Matrices {
    MeshMatrix<double> m, a, g, k;
  };
  Matrices matrices();

  /// Coefficients of a function of place.
  void project(std::size_t field, Expr f, double* c, std::string& trouble) const;
  double value(const double* c, std::size_t field, const FieldJet& jet, const std::vector<double>& place) const;
  /// Σ w f over the quadrature points, f of the lane.
  double integral(const std::vector<double>& f) const;
  std::size_t lanes() const { return places_[0].size(); }
  double weight(std::size_t lane) const { return point_weight(lane / cells()); }
  double place(std::size_t direction, std::size_t lane) const { return places_[direction][lane]; }
  double jet(std::size_t slot, std::size_t lane) { return series_.input(slot, 0)[lane]; }
  const DensityForm& form() const { return form_; }

  static std::size_t across(Side side) { return side == Side::Left || side == Side::Right ? 0 : 1; }
  static bool is_far(Side side) { return side == Side::Right || side == Side::Top; }
  /// The coefficients that are the field (`slope` false) at a side, or du/dξ across it: [cells × functions] along the
  /// side, those that cells share once for each.
  std::vector<std::size_t> side_coefficients(std::size_t field, Side side, bool slope) const;
  /// Those of a function of the place along the side at a moment, in the same order.
  std::vector<double> side_values(std::size_t field, Side side, const std::vector<Expr>& derivatives, double t) const;
  /// ∫ of it with each function along the side: what a force does there.
  std::vector<double> side_loads(std::size_t field, Side side, Expr f, double t) const;
  /// f with its derivatives along a side, as many as side_values needs.
  std::vector<Expr> derivatives_along(std::size_t field, Side side, Expr f) const;

  /// ∫ u² of each field.
  std::vector<double> squares(const std::vector<double>& c) const;
  std::size_t cells() const { return axes_[0].cells() * axes_[1].cells(); }
  const std::vector<std::size_t>& fields_of_coefficients() const { return field_of_; }
  /// Whether a function has all but nothing in common with those that change slowly over an element: its mean over each
  /// element, beside its size. Of fields in `fixed` a constant does not count.
  bool is_rough(const std::vector<double>& c, const std::vector<std::size_t>& fixed) const;
  /// Coefficients of u = 1.
  std::vector<double> constant(std::size_t field) const;

 private:
  std::size_t along(std::size_t field, std::size_t direction) const {
    return axes_[direction].size(form_.smooth[field]);
  }
  std::size_t functions(std::size_t field) const { return along(field, 0) * along(field, 1); }
  std::size_t points() const { return axes_[0].points() * axes_[1].points(); }
  std::size_t index(std::size_t field, std::size_t cell, std::size_t i) const {
    return map_[(cell * fields_ + field) * local_ + i];
  }
  double point_weight(std::size_t point) const {
    return axes_[0].weight(point % axes_[0].points()) * axes_[1].weight(point / axes_[0].points());
  }
  void number_coefficients();
  std::vector<double> table_of(std::size_t field, const std::array<int, 2>& space) const;
  std::vector<double> loads_of(std::size_t field, const std::vector<double>& table) const;
  std::vector<double> loads_along(std::size_t direction, bool smooth, int k) const;
  const double* table(std::size_t slot, std::size_t point) const {
    return tables_[slot].data() + point * functions(form_.slots[slot].field);
  }
  void take_differences(double* local, std::size_t field, std::size_t direction) const;
  void set_jet(std::size_t slot, const double* c);
  void assemble(double* out, bool rates) const;
  void add_loads(std::size_t slot, double* out) const;
  void add_products();
  std::vector<std::size_t> values_at_ends(std::size_t field) const;
  Expr side_symbol(Side side) const;

  const FieldSystem& s_;
  const DensityForm& form_;
  std::array<MeshAxis, 2> axes_;
  std::size_t fields_ = 0, local_ = 0, size_ = 0;
  std::vector<std::size_t> map_;  // [cells × fields × functions]
  std::shared_ptr<const SparsityPattern> pattern_;
  std::vector<std::vector<double>>
      tables_;  // [slots] the derivative of each function at each point: [points × functions]
  /// Along a direction, of each slot, times the weights of the points: [functions × points].
  std::vector<std::vector<double>> loads_[2];
  MeshMatrix<double> products_;        // ∫ N_i N_j within each field
  std::vector<std::size_t> field_of_;  // [size]
  std::vector<double> places_[2];      // of the lanes
  mutable LaneSeries series_, hessian_, energies_;
  Bindings values_;
};

}  // namespace maupertuis
