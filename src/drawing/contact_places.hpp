#pragma once
#include <maupertuis/drawing.hpp>
#include <maupertuis/evaluate.hpp>

#include <functional>
#include <optional>

/// Where contacts in the plane act: which places they touch, and with what force.
namespace maupertuis::drawing {

/// A contact and the places that it touches. The force on a place for λ = 1 is ∂g/∂P, where P is its position: of one
/// place that its gap g(P, t) depends on alone; or of two, ∂g/∂P₁ = −∂g/∂P₂, which touch each other.
struct ContactPlaces {
  struct Place {
    std::string name;       // of a point or a body; empty: a place that is fixed on a body
    ExprVector position;    // [2] m
    ExprVector slope = {};  // [2] ∂g/∂P where the gap is written in P; empty: of least size along the way of P
    std::vector<double> at = {};    // [frames × 2] m
    std::vector<double> push = {};  // [frames × 2] N for λ = 1
  };
  std::size_t contact = 0;
  std::vector<Place> places;               // one: the other side belongs to the surroundings; two
  std::size_t freedoms = 2;                // of one place: in the plane, or along a line
  std::vector<double> gap = {};            // [frames]
  std::vector<double> multiplier = {};     // [frames] λ; empty: the run does not tell it
  std::vector<double> friction = {};       // [frames] N on the one place, to the right of the normal; empty: none
  std::vector<double> surface_speed = {};  // [frames] m/s along the surface, to the right of its normal; empty: at rest
};

/// Those of all contacts whose places are found; none in space.
class ContactTracks {
 public:
  ContactTracks(const Model& model, const Bindings& parameters, const Trajectory& run,
                const EquationsOfMotion* equations);
  /// The state of a frame; `column` is what the run has there.
  void add_frame(const Bindings& state, const std::function<double(std::size_t)>& column);

  std::vector<ContactPlaces> contacts;
  std::vector<double> states;  // [frames × n] q

 private:
  struct Formulas {
    ExprVector values;  // g, ∂g/∂q, P and ∂P/∂q of each place, λ for a reaction of 1, v_t at rest
    std::optional<std::size_t> reaction;  // column of the run
    std::optional<std::size_t> friction;  // column of the run
    bool slips = false, written = false;  // written: at the end ∂g/∂P of the one place
  };
  void add_formulas(const MechanicalSystem& system, const Trajectory& run, const EquationsOfMotion* equations);
  const MechanicalSystem& system_;
  std::vector<Formulas> formulas_;  // [contacts]
};

/// Functions of the configuration and their slopes.
ExprVector with_slopes(const MechanicalSystem& system, const ExprVector& functions);

}  // namespace maupertuis::drawing
