#pragma once
#include <maupertuis/mechanical_system.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace maupertuis {

/// What a friction does in a mode. None: its contact is open, or there is none. Slide: in space, along v_t, wherever
/// that points.
enum class FrictionState : std::int8_t { None, Stick, Forward, Backward, Slide };

/// Which contacts are closed and what each friction does: between events a system moves by the equations of one mode.
struct ContactMode {
  std::vector<bool> closed;              // [contacts]
  std::vector<FrictionState> friction;   // [contacts + frictions]: those of the contacts, then those of coordinates
  std::vector<std::int8_t> normal_sign;  // [frictions] sign of a normal force that is made of multipliers; else 1
  friend bool operator==(const ContactMode&, const ContactMode&) = default;
};

/// All contacts open, coordinates with friction stuck.
ContactMode open_mode(const MechanicalSystem& system);
/// Friction number i of a mode: of contact i, then of the coordinates.
const Friction& friction_of(const MechanicalSystem& system, std::size_t index);

/// |v_t| of a friction in space.
Expr slip_speed(const Friction& friction);
/// The normal force of friction i in a mode, not negative there: λ of its contact; the |N| that the model says, by the
/// sign of the mode where it is made of multipliers. Empty where the limits of the friction are forces themselves.
Expr normal_force(const MechanicalSystem& system, const ContactMode& mode, std::size_t index);
/// Whether multipliers stand in it.
bool has_multipliers(Expr e);

/// "floor, wall sliding, x sticking"; empty where all is open and nothing rubs.
std::string mode_text(const MechanicalSystem& system, const ContactMode& mode);

/// A mode with its first contact closed and not sliding, or its first friction sticking: for a help, as `--mode` takes
/// it.
std::string some_mode(const MechanicalSystem& system);

/// Reads what mode_text writes: "floor, wall sliding +, x sticking"; "free" for none. Nothing, with one sentence why in
/// `trouble`, where a name is no contact, or a friction is left open.
std::optional<ContactMode> read_mode(const MechanicalSystem& system, const std::string& text, std::string& trouble);

/// How many modes there are: 2 for each contact, 4 where it has friction, 3 for each friction of a coordinate.
double number_of_modes(const MechanicalSystem& system);
/// All modes where there are at most `most`, fewest changes from `from` first. Else `from` and those that one contact
/// or one friction makes of it.
std::vector<ContactMode> modes_to_show(const MechanicalSystem& system, const ContactMode& from, std::size_t most);

/// The system as it moves in a mode, without inequalities: closed contacts are constraints g = 0 at the end of its
/// constraints, sticking ones constraints between velocities v_t = 0 after them; sliding ones have the generalized
/// force −σ μ N ∂v_t/∂q̇ with σ = ±1, in space −μ N Σ_k v_tk/|v_t| ∂v_tk/∂q̇, which holds the multiplier of the contact.
/// Its equations are those of any system, and are certified as such. Reactions in normal forces have been replaced (see
/// contact_normals).
MechanicalSystem system_in_mode(const MechanicalSystem& system, const ContactMode& mode);

/// Throws std::invalid_argument where the system has contacts or friction, which are no part of its equations: the
/// caller of `who` would get the motion without them.
void check_one_mode(const MechanicalSystem& system, std::string_view who);

}  // namespace maupertuis
