#include <maupertuis/contact_mode.hpp>
#include <maupertuis/motion_pictures.hpp>

#include <algorithm>

namespace maupertuis {
namespace {

using Doing = PlotStrip::State;

constexpr std::size_t most_strips = 12, most_parts = 20'000;

struct Stretch {
  double from = 0;
  ContactMode mode;
};

/// The modes of a run in the order of the time; nothing where one cannot be read.
std::vector<Stretch> stretches(const SimulationResult& run, const MechanicalSystem& system) {
  std::vector<Stretch> out;
  std::string trouble, last = run.first_mode;
  const auto add = [&](double t, const std::string& text) {
    if (auto mode = read_mode(system, text, trouble)) out.push_back({t, std::move(*mode)});
  };
  add(run.start.t, run.first_mode);
  for (const Happening& h : run.happenings) {
    if (h.kind == Happening::Kind::Event || h.mode == last || out.size() > most_parts) continue;
    last = h.mode;
    add(h.t, h.mode);
  }
  if (!trouble.empty()) out.clear();
  return out;
}

Doing doing_of(const ContactMode& mode, std::size_t friction) {
  switch (mode.friction[friction]) {
    case FrictionState::Stick:
      return Doing::Stick;
    case FrictionState::Forward:
    case FrictionState::Slide:
      return Doing::Forward;
    case FrictionState::Backward:
      return Doing::Backward;
    case FrictionState::None:
      break;
  }
  return friction < mode.closed.size() && mode.closed[friction] ? Doing::Closed : Doing::Open;
}

}  // namespace

void show_happenings(PlotOptions& options, const SimulationResult& run, const MechanicalSystem& system) {
  for (const Happening& h : run.happenings)
    if (h.kind == Happening::Kind::Impact || h.kind == Happening::Kind::Event)
      options.marks.push_back({h.t, h.name, h.kind == Happening::Kind::Event});
  if (!system.has_modes()) return;
  const std::vector<Stretch> modes = stretches(run, system);
  const std::size_t contacts = system.contacts.size();
  for (std::size_t i = 0; i < contacts + system.frictions.size() && !modes.empty(); ++i) {
    PlotStrip strip;
    strip.name = i < contacts ? system.contact_label(i) : system.frictions[i - contacts].name;
    for (std::size_t k = 0; k < modes.size(); ++k) {
      const Doing state = doing_of(modes[k].mode, i);
      const double to = k + 1 < modes.size() ? modes[k + 1].from : run.final.t;
      if (!strip.parts.empty() && strip.parts.back().state == state)
        strip.parts.back().to = to;
      else
        strip.parts.push_back({modes[k].from, to, state});
    }
    const bool open = std::all_of(strip.parts.begin(), strip.parts.end(),
                                  [](const PlotStrip::Part& p) { return p.state == Doing::Open; });
    if (!open && options.strips.size() < most_strips) options.strips.push_back(std::move(strip));
  }
}

std::vector<ContactImpulse> impulses_of(const SimulationResult& run, const MechanicalSystem& system) {
  std::vector<ContactImpulse> out;
  for (const Happening& h : run.happenings) {
    if (h.kind != Happening::Kind::Impact) continue;
    for (std::size_t i = 0; i < system.contacts.size(); ++i)
      if (system.contact_label(i) == h.name) {
        out.push_back({i, h.t, h.impulse});
        break;
      }
  }
  return out;
}

}  // namespace maupertuis
