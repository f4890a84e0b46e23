#include "happenings_text.hpp"

#include "extended_text.hpp"
#include "numbers.hpp"
#include "quantity.hpp"

#include <fmt/format.h>
#include <maupertuis/uncertainty.hpp>

#include <cmath>

namespace maupertuis::app {
namespace {

Json finite_or_null(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }

Json happening_json(const Happening& h, const MechanicalSystem& system) {
  Json state = Json::object();
  for (std::size_t i = 0; i < h.q.size(); ++i) {
    state[system.coordinates[i].name] = finite_or_null(h.q[i]);
    state[system.coordinates[i].name + "'"] = finite_or_null(h.v[i]);
  }
  Json out = {{"t", h.t},
              {"error", finite_or_null(h.error)},
              {"what", word_of(h.kind)},
              {"name", h.name},
              {"state", std::move(state)}};
  if (h.kind == Happening::Kind::Impact) out["impulse"] = h.impulse, out["speed"] = h.speed;
  if (system.has_modes()) out["mode"] = h.mode;
  if (!h.remark.empty()) out["remark"] = h.remark;
  return out;
}

}  // namespace

void put_happenings(Json& document, const Chronicle& run, const MechanicalSystem& system) {
  document["events"] = Json::array();
  for (const Happening& h : run.happenings) document["events"].push_back(happening_json(h, system));
  if (system.has_modes()) document["first_mode"] = run.first_mode;
  if (run.books)
    document["energy_books"] = {{"impacts", run.books->impacts},
                                {"moving_contacts", run.books->moving},
                                {"friction", run.books->friction},
                                {"dampers", run.books->dampers},
                                {"events", run.books->events}};
  document["remarks"] = run.remarks;
}

std::string happenings_text(const Chronicle& run, const MechanicalSystem& system) {
  constexpr std::size_t most = 24, first = 16;
  std::string out;
  if (system.has_modes())
    out += fmt::format("begins {}\n", run.first_mode.empty() ? "without contact" : "in the mode " + run.first_mode);
  const std::size_t count = run.happenings.size();
  for (std::size_t k = 0; k < count; ++k) {
    if (count > most && k == first) {
      k = count - (most - first);
      out += fmt::format("  … {} more, all with --json …\n", k - first);
    }
    const Happening& h = run.happenings[k];
    const std::string time = run.of_mesh           ? fmt::format("{:.10g}", h.t)
                             : h.error == 0        ? exact(h.t)
                             : std::isinf(h.error) ? exact(h.t) + " (no digit is certain)"
                                                   : with_uncertainty(h.t, h.error);
    out += fmt::format("  {}  {} {}", system.moment(time), h.name, word_of(h.kind));
    if (h.kind == Happening::Kind::Impact)
      out += ", impulse " + impulse_text(fmt::format("{:.6g}", h.impulse), h.name, system);
    if (!h.remark.empty()) out += ": " + h.remark;
    if (system.has_modes() && !(h.kind == Happening::Kind::Event || h.kind == Happening::Kind::Impact))
      out += h.mode.empty() ? " → free" : " → " + h.mode;
    out += "\n";
  }
  for (const std::string& remark : run.remarks) out += "  " + remark + "\n";
  if (run.books) {
    const std::string unit = system.dimensionless ? "" : " J";
    std::vector<std::string> parts;
    if (system.has_modes())
      parts.push_back(fmt::format("energy lost: impacts {0}{3}, friction {1}{3}, dampers {2}{3}",
                                  brief(run.books->impacts), brief(run.books->friction), brief(run.books->dampers),
                                  unit));
    const auto add = [&](double gained, const char* from) {
      if (gained != 0)
        parts.push_back(
            fmt::format("{} {} {}{}", gained > 0 ? "gained from" : "given to", from, brief(std::abs(gained)), unit));
    };
    add(run.books->moving, "moving contacts");
    add(run.books->events, "events that set the state");
    out += fmt::format("{}\n", fmt::join(parts, "; "));
  }
  return out;
}

}  // namespace maupertuis::app
