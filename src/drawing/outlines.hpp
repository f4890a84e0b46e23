#pragma once
#include <maupertuis/drawing.hpp>
#include <maupertuis/evaluate.hpp>

#include <functional>

namespace maupertuis::drawing {

/// One element and the expressions that place it.
struct Outline {
  enum class Placement {
    Direct,     // the expressions are the positions
    AboutAxis,  // a place and an axis of space: the third axis of a solid of radius `size`
    Between,    // two places: the first axis reaches from one to the other
    Along,      // two places: the first axis is a metre towards the other
    Force,      // a place and a force, for each newton of a reaction where there is one
    Torque,     // a place and a torque: one number in the plane, a vector in space
  };
  Drawing::Element element;
  std::vector<Expr> values;
  Placement placement = Placement::Direct;
  double size = 1;
  std::optional<std::size_t> reaction = std::nullopt;  // Force: the column of the run with its value
  enum class Fitting {
    None,
    Wheel,
    Spring,
    Cup,
    Plate,
    Anchor,
    Pivot
  } fitting = Fitting::None;  // what the motion decides of its shape
  double aside = 0;           // Spring, Cup, Plate: to the left of the way between the places, in thicknesses
};

/// What a drawing is made of, before anything is known of the motion but where it began.
struct Plan {
  std::vector<Outline> outlines;
  std::vector<Expr> follow;  // [dimension], or none
  struct Ground {
    ExprVector place, normal;  // normal: empty where the model does not say
    bool wall = false;
  };
  std::vector<Ground> grounds;
  std::vector<std::string> unplaced;  // forces that no arrow stands for
};

Plan plan_of(const Model& model, const Bindings& parameters, const EquationsOfMotion* equations, const Trajectory& run,
             ForcesShown forces);

/// Arrows of what acts and is not asked for by the model: weights, springs, dampers, applied forces, torques, and
/// forces on coordinates. In space and in the plane.
void add_acting_forces(const MechanicalSystem& system, Plan& plan);

/// A force in newtons with its foot at a place; a torque about a place, one number in the plane.
Outline arrow_of(const ExprVector& place, const ExprVector& force, Drawing::ForceOrigin origin,
                 const std::string& name);
Outline torque_about(const ExprVector& place, const ExprVector& torque, Drawing::ForceOrigin origin,
                     const std::string& name);

/// A torque becomes an arc about its place that turns as it does, counter-clockwise where it is positive; three
/// quarters of a turn for the largest. `d`: of space.
void place_torque(Outline& torque, std::size_t d, double radius, double largest);

/// Whether these expressions have the same values wherever the system is and whenever: at some random states.
bool same_everywhere(const MechanicalSystem& system, const std::vector<Expr>& expressions, const Bindings& parameters);

/// What the whole motion decides of what is drawn, once the positions of every frame are there: bounds, sizes of bobs,
/// springs, dashpots, pivots, ground, arrows, surfaces of contacts.
class ContactTracks;
void settle(Drawing& drawing, std::vector<Outline>& outlines, const Plan& plan, const MechanicalSystem& system,
            const Bindings& parameters, const ContactTracks& contacts, const std::vector<ContactImpulse>& impulses);

}  // namespace maupertuis::drawing
