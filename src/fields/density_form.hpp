#pragma once
#include <maupertuis/fields.hpp>

#include <array>
#include <optional>
#include <vector>

namespace maupertuis {

/// ℒ with its first and second derivatives by jets, as functions at a point.
///
/// With the fields as sums of c_i N_i(x) the discrete Lagrangian is L(c, c') = Σ_q w_q ℒ(x_q). Momenta ∂L/∂c'_i are
/// sums of ∂ℒ/∂φ'_J N_i^(J), generalized forces ∂L/∂c_i − ∂D/∂c'_i + Q_i those of ∂ℒ/∂φ_J − ∂𝒟/∂φ'_J + f.
struct DensityForm {
  struct Slot {
    std::size_t field = 0;           // of those that are varied
    std::array<int, 2> space{0, 0};  // derivatives along each direction
    bool rate = false;
    bool stands = false;  // in a momentum or a force
    Expr jet;
    int order() const { return space[0] + space[1]; }
  };
  struct Entry {  // ∂ of a momentum (row.rate) or of a force by a slot
    std::size_t row = 0, column = 0;
    Expr value;
  };
  std::vector<Slot> slots;
  std::vector<Expr> inputs;   // the jets of the slots, then the space variables, then t
  std::vector<Expr> by_slot;  // momenta of slots that are rates, forces of others          [slots]
  std::vector<Entry> hessian;
  Expr energy;
  std::vector<bool> smooth;       // [varied]: a second derivative in space of it stands in ℒ
  std::vector<bool> first_order;  // [varied]: its momenta hold no velocity
  bool conserves = false;
  bool damps = false;   // friction on slopes, or of fields that nothing else moves: heat
  bool linear = false;  // the Hessian is the same at all times
  bool steady = false;  // its part by velocities is
};
/// Whether a density holds second derivatives, or no square of a field's velocity, or friction acts on slopes.
bool needs_collocation(const FieldEquations& equations);
/// Of one or two space variables. Errors: E0508, E0642.
std::optional<DensityForm> density_form(const FieldEquations& equations, Diagnostics& diagnostics);

}  // namespace maupertuis
