#include "simulation/contact_checks.hpp"
#include "simulation/hybrid_motion.hpp"

#include <maupertuis/contact_mode.hpp>
#include <maupertuis/motion_kernel.hpp>
#include <maupertuis/motion_through_modes.hpp>

namespace maupertuis {

std::optional<ContactStart> contact_start(const Model& model, const EquationsOfMotion& equations,
                                          const MotionState& start, Diagnostics& diagnostics) {
  const MechanicalSystem& system = model.system;
  ContactStart out;
  const std::vector<double> parameters = parameter_values(system);
  ContactFunctions functions(equations, parameters);
  const ContactValues& values = functions.at(start.t, start.q, start.v);
  out.gaps = values.gap;
  out.rates = values.rate;
  if (!start_keeps_contacts(model, start.t, start.q, diagnostics)) return std::nullopt;
  if (!can_go_through_modes(equations, diagnostics)) return std::nullopt;
  HybridMotion motion(std::make_shared<ModeLibrary>(model, equations, WantedFunctions{}), parameters, {});
  motion.start(start.t, start.q, start.v);
  for (const Happening& h : motion.record().happenings)
    if (h.kind == Happening::Kind::Impact) out.impacts.push_back(h);
  out.trouble = motion.trouble();
  if (!out.trouble.empty())
    diagnostics.warning("W0731", std::nullopt, "no motion begins at this start", out.trouble,
                        "Change the start, or a coefficient of friction.");
  out.mode = motion.record().first_mode;
  std::string unread;
  out.closed.assign(system.contacts.size(), false);
  if (const auto mode = read_mode(system, out.mode, unread); mode && out.trouble.empty()) out.closed = mode->closed;
  return out;
}

}  // namespace maupertuis
