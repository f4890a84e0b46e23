#pragma once
#include <maupertuis/mechanical_system.hpp>
#include <maupertuis/switches.hpp>
#include <maupertuis/transform.hpp>

#include <functional>
#include <optional>
#include <string>

namespace maupertuis {

/// A function of q, q̇, t where it does not go on.
struct JumpAcross {
  Expr difference;    // of the switch
  double jump = 0;    // SI
  Bindings at;        // a state on the switch
  std::string place;  // "x = 1"
};

/// What a function does at the switches that stand in it.
struct AcrossSwitches {
  std::size_t switches = 0;        // that some motion can pass
  std::size_t points = 0;          // at which both sides were compared
  std::optional<JumpAcross> jump;  // the first that was found
};

/// Whether a function whose derivative vanishes on each side of its switches is one constant: it must not jump where a
/// motion passes. `rate`, where it is given, is ġ of a switch along the motion: a switch that no motion passes, as ġ
/// vanishes on it, does not count. Evidence from points (docs/theory/switches.md), not a proof; a jump is certain.
/// Functions of more than q, q̇, t and parameters are not looked at: no points.
AcrossSwitches across_switches(const MechanicalSystem& system, Expr function, const ReadingOrder& order,
                               const std::function<Expr(Expr)>& rate = {});

/// The state space of a system as what a search for points moves: from q = q̇ = t = 1.
SwitchSearch search_of_states(const MechanicalSystem& system);

}  // namespace maupertuis
