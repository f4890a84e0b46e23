#pragma once
#include "fields/careful_sum.hpp"
#include "fields/element.hpp"
#include "fields/field_motion.hpp"
#include "fields/lane_series.hpp"
#include "linear_algebra/banded.hpp"

#include <optional>

namespace maupertuis {

/// ℒ with its first and second derivatives by jets, as functions at a point.
///
/// With the fields as sums of c_i N_i(x) the discrete Lagrangian is L(c, c') = Σ_q w_q ℒ(x_q). Momenta ∂L/∂c'_i are
/// sums of ∂ℒ/∂φ'_J N_i^(J), generalized forces ∂L/∂c_i − ∂D/∂c'_i + Q_i those of ∂ℒ/∂φ_J − ∂𝒟/∂φ'_J + f.
struct DensityForm {
  struct Slot {
    std::size_t field = 0;  // of those that are varied
    int space = 0;
    bool rate = false;
    bool stands = false;  // in a momentum or a force
    Expr jet;
  };
  struct Entry {  // ∂ of a momentum (row.rate) or of a force by a slot
    std::size_t row = 0, column = 0;
    Expr value;
  };
  std::vector<Slot> slots;
  std::vector<Expr> inputs;   // the jets of the slots, then x, t
  std::vector<Expr> by_slot;  // momenta of slots that are rates, forces of others          [slots]
  std::vector<Entry> hessian;
  Expr energy;
  std::vector<bool> smooth;       // [varied]: its second derivative by x stands in ℒ
  std::vector<bool> first_order;  // [varied]: its momenta hold no velocity
  bool conserves = false;
  bool linear = false;  // the Hessian is the same at all times
  bool steady = false;  // its part by velocities is
};
/// Whether a density holds second derivatives, or no square of a field's velocity.
bool needs_collocation(const FieldEquations& equations);
/// Errors: E0508, E0642.
std::optional<DensityForm> density_form(const FieldEquations& equations, Diagnostics& diagnostics);

/// The discrete Lagrangian of fields on elements of equal width (element.hpp). Coefficients of what stands at the ends
/// of elements are shared, so that smooth fields have continuous slopes.
class GalerkinMesh {
 public:
  GalerkinMesh(const FieldEquations& equations, const DensityForm& form, int cells, int degree, const Bindings& values,
               std::string& trouble);

  std::size_t size() const { return size_; }
  std::size_t bandwidth() const { return band_; }
  double left() const { return left_; }
  double width() const { return width_; }
  /// Values of the jets at the quadrature points: to be called before what follows, and with `all` before energies and
  /// integrals, which hold more of them than forces do.
  void set(const double* c, const double* rates, double t, bool all = false);
  void momenta(double* out) const;
  void forces(double* out) const;  // without forces at ends
  double energy(double& size);
  /// M = ∂p/∂c', A = ∂p/∂c, G = A − ∂F/∂c', K = −∂F/∂c.
  struct Matrices {
    BandedMatrix<double> m, a, g, k;
  };
  Matrices matrices();

  /// Coefficients of a function, given with its derivatives by x.
  void project(std::size_t field, const std::vector<Expr>& derivatives, double* c, std::string& trouble) const;
  double value(const double* c, std::size_t field, int derivatives, double x) const;
  /// Σ w f over the quadrature points, f of the lane.
  double integral(const std::vector<double>& f) const;
  std::size_t lanes() const { return points_.size(); }
  double weight(std::size_t lane) const { return rule_.w[lane / cells()] * width_ / 2; }
  double place(std::size_t lane) const { return points_[lane]; }
  double jet(std::size_t slot, std::size_t lane) { return series_.input(slot, 0)[lane]; }
  const DensityForm& form() const { return form_; }
  const Element& element(std::size_t field) const { return elements_[field]; }
  /// Of u (space = 0) or of its slope (1, smooth fields) at an end.
  std::size_t end_coefficient(std::size_t field, bool right, int space) const;
  /// du/dx of a coefficient that stands for du/dξ.
  double slope_scale() const { return 2 / width_; }
  /// The largest coefficient of u at the ends of elements.
  double largest_end(const double* c, std::size_t field) const;
  std::size_t cells() const { return static_cast<std::size_t>(cells_); }
  std::vector<std::size_t> fields_of_coefficients() const;
  /// Whether a function has all but nothing in common with those that change slowly over an element: its mean over each
  /// element, beside its size.
  bool is_rough(const std::vector<double>& c) const;
  /// Coefficients of u = 1.
  std::vector<double> constant(std::size_t field) const;

 private:
  std::size_t index(std::size_t field, std::size_t cell, std::size_t i) const {
    return map_[(cell * fields_ + field) * local_ + i];
  }
  void number_coefficients(bool periodic);
  const double* table(std::size_t field, int k, std::size_t q) const;
  void assemble(double* out, bool rates) const;

  const DensityForm& form_;
  int cells_;
  std::size_t fields_ = 0, local_ = 0, size_ = 0, band_ = 0;
  double left_ = 0, width_ = 0;
  GaussRule rule_;
  std::vector<Element> elements_;            // [fields]
  std::vector<std::size_t> map_;             // [cells × fields × functions]
  std::vector<std::vector<double>> tables_;  // [smooth][derivative] → [points × functions]
  std::vector<double> points_;               // x of the lanes: [points × cells]
  mutable LaneSeries series_, hessian_, energies_;
  Bindings values_;
  Expr x_;
};

}  // namespace maupertuis
