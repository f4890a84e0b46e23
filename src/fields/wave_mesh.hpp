#pragma once
#include "fields/careful_sum.hpp"
#include "fields/field_motion.hpp"

#include <functional>
#include <string>
#include <vector>

namespace maupertuis {

constexpr std::size_t kOrder = 8;  // of Taylor steps: on the imaginary axis stable up to hω = 3.40

/// A discrete field whose motion is a wave: the highest frequency of the mesh bounds its Taylor steps.
class WaveMesh : public FieldMotion {
 public:
  using FieldMotion::FieldMotion;
  /// Largest frequency of small motions about the present state, by power iteration.
  virtual double omega_max(const Interrupt& interrupt) = 0;

 protected:
  /// What is given at a side and its derivatives by t, as many as the series of a step takes.
  std::vector<Expr> time_derivatives(Expr value) const;
};

using FieldValues = std::vector<std::vector<double>>;  // [fields][lanes]
/// φ'' at a state into `to`; what stands in `state` afterwards is left open.
using Accelerations = std::function<void(FieldValues& state, FieldValues& to)>;
/// The largest frequency of small motions about u by power iteration from the direction w. `trouble` ends it.
double largest_frequency(const FieldValues& u, FieldValues w, const Accelerations& accelerations, int rounds,
                         const std::string& trouble, const Interrupt& interrupt);
/// Numbers of −1/2 .. 1/2, always the same.
void fill_randomly(FieldValues& w);

/// What the last term of a step may be beside the field. A mode is multiplied by 1 − O((hω)^10) a step. Of a smooth
/// field the highest modes have nothing; a kink or a start that does not fit its sides puts energy into all of them,
/// which longer steps would take away.
constexpr double kLastTerm = 1e-14;

/// A⁻¹ of one point, [n²]; false where it is singular.
bool invert_mass(std::vector<double> a, std::vector<double>& inverse, std::size_t n);
/// The same where some fields are held: rows of these say that φ'' is what stands in their place among the forces, so
/// that the other fields feel the mass that they have in common with them, A_ff φ_f'' = F_f − A_fh φ_h''.
bool invert_mass(std::vector<double> a, std::vector<double>& inverse, const std::vector<bool>& held);

}  // namespace maupertuis
