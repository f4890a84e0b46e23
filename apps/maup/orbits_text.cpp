#include "orbits_text.hpp"

#include "outcome.hpp"
#include "quantity.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace maupertuis::app {
namespace {

constexpr double vanishing_multiplier = 1e-13;  // of a contact that closes, or friction that sticks
constexpr std::size_t most_rows = 12;           // of a table on the terminal

/// The unit of coordinate i (order 0) or its velocity (order 1), "" for numbers.
std::string unit_of(const MechanicalSystem& system, std::size_t i, int order) {
  if (system.dimensionless) return {};
  const Dimension d = system.coordinates[i].dimension;
  const std::string unit = to_string(order == 0 ? d : d / system.independent_dimension);
  return unit == "1" ? "" : unit;
}

std::string in_unit(double value, const std::string& unit) {
  return unit.empty() ? brief(value) : fmt::format("{} {}", brief(value), unit);
}

std::string seconds(double value, const MechanicalSystem& system) {
  return system.dimensionless ? fmt::format("{:.12g}", value) : fmt::format("{:.12g} s", value);
}

std::string state_line(const MotionState& state, const MechanicalSystem& system) {
  std::string out;
  for (int order = 0; order <= 1; ++order)
    for (std::size_t i = 0; i < system.coordinates.size(); ++i)
      out += fmt::format("{}{}{} = {}", out.empty() ? "" : ", ", system.coordinates[i].name, order ? "'" : "",
                         in_unit((order ? state.v : state.q)[i], unit_of(system, i, order)));
  return out;
}

Json orbit_state_json(const MotionState& state, const MechanicalSystem& system) {
  Json out = Json::object();
  for (std::size_t i = 0; i < system.coordinates.size(); ++i) {
    out[system.coordinates[i].name] = state.q[i];
    out[system.coordinates[i].name + "'"] = state.v[i];
  }
  return out;
}

std::string orbit_line(const char* head, const std::string& text) { return fmt::format("  {:<20}{}\n", head, text); }

const char* stability_word(OrbitalStability stability) {
  switch (stability) {
    case OrbitalStability::Attracting:
      return "attracting";
    case OrbitalStability::Neutral:
      return "neutral";
    case OrbitalStability::Unstable:
      return "unstable";
    case OrbitalStability::Undecided:
      return "undecided";
  }
  return "";
}

std::string turns_text(const PeriodicMotion& m, const MechanicalSystem& system) {
  std::string out;
  for (std::size_t i = 0; i < m.turns.size(); ++i)
    if (m.turns[i] != 0)
      out += fmt::format("{}{} by {} turn{}", out.empty() ? "" : ", ", system.coordinates[i].name, m.turns[i],
                         std::abs(m.turns[i]) == 1 ? "" : "s");
  return out;
}

/// Of the multiplier that the divergence tells: with more than rounding leaves of the others.
std::string smallest_line(const FloquetResult& r, std::complex<double> mu) {
  const std::string value = mu == 0.0 ? fmt::format("e^{:.9g}", *r.log_smallest) : fmt::format("{:.9g}", mu.real());
  return fmt::format("{:<32}log|μ|/T = {:.6g}, by the divergence", value, *r.log_smallest / r.motion.period);
}

std::string multiplier_line(std::complex<double> mu, double period) {
  const double modulus = std::abs(mu), argument = std::arg(mu);
  const std::string value =
      mu.imag() == 0 ? fmt::format("{:.9g}", mu.real())
                     : fmt::format("{:.9g} {} {:.9g} i", mu.real(), mu.imag() < 0 ? "-" : "+", std::abs(mu.imag()));
  if (modulus < vanishing_multiplier)
    return "0                               by rounding: the direction vanishes in a period";
  return fmt::format("{:<31} |μ| = {:<15.9g} arg μ = {:<13.6g} log|μ|/T = {:.6g}", value, modulus, argument,
                     std::log(modulus) / period);
}

}  // namespace

std::string stability_sentence(const FloquetResult& r) {
  switch (r.stability) {
    case OrbitalStability::Attracting:
      if (r.largest < vanishing_multiplier) return "attracting: after a period neighbours are in the same motion";
      return fmt::format("attracting: in each period neighbours come nearer by a factor {}", brief(r.largest));
    case OrbitalStability::Neutral:
      return r.multipliers.size() == r.trivial
                 ? "neutral: there are no other multipliers"
                 : "neutral: stable to first order, all multipliers lie on the unit circle";
    case OrbitalStability::Unstable:
      return fmt::format("unstable: in each period some neighbours move away by a factor {}", brief(r.largest));
    case OrbitalStability::Undecided:
      return "undecided: the multipliers contradict what the geometry of the motion asks of them";
  }
  return "";
}

std::string neighbours_text(const FloquetResult& r) {
  std::string out;
  const std::size_t count = r.multipliers.size() - r.trivial;
  for (std::size_t i = 0; i + r.lost < count; ++i)
    out += orbit_line(i == 0 ? "multipliers" : "", i + 1 == count && r.log_smallest
                                                       ? smallest_line(r, r.multipliers[i])
                                                       : multiplier_line(r.multipliers[i], r.motion.period));
  if (r.lost > 0)
    out += orbit_line(r.lost == count ? "multipliers" : "",
                      fmt::format("{}, lost in the rounding of dΦ: nearer to 0 than 1e-12 of its largest", r.lost));
  if (r.vanished > 0)
    out += orbit_line(
        r.multipliers.size() == r.trivial ? "multipliers" : "",
        fmt::format("0, of {} direction{} that contacts and friction hold", r.vanished, r.vanished == 1 ? "" : "s"));
  if (r.trivial == 1) out += orbit_line("trivial", "1, along the motion");
  if (r.trivial == 2)
    out += orbit_line("trivial", "1 and 1, along the motion and from orbit to orbit as the energy changes");
  out += orbit_line("stability", stability_sentence(r));
  if (r.symplectic_residual)
    out += orbit_line("check", fmt::format("the symplectic form is preserved to {:.2g}", *r.symplectic_residual));
  if (r.log_determinant && !r.symplectic_residual)
    out += orbit_line("check", fmt::format("log |det dΦ| = {:.12g}, and ∫ divergence dt = {:.12g}", *r.log_determinant,
                                           *r.integrated_divergence));
  return out;
}

std::string period_text(const FloquetResult& r, const MechanicalSystem& system) {
  return orbit_line("period", seconds(r.motion.period, system) + (r.motion.driven ? ", of the drive" : ""));
}

std::string floquet_text(const FloquetResult& r, const MechanicalSystem& system) {
  const PeriodicMotion& m = r.motion;
  std::string out = fmt::format("{}: {}\n", spoken_name(system),
                                m.rests ? "an equilibrium, whose neighbours are driven" : "a periodic motion");
  out += period_text(r, system);
  const std::string at = m.start.t == 0 ? "" : fmt::format("t = {}, ", seconds(m.start.t, system));
  out += orbit_line("start", at + state_line(m.start, system));
  if (const std::string turns = turns_text(m, system); !turns.empty()) out += orbit_line("advances", turns);
  if (!m.other_sign.empty())
    out +=
        orbit_line("comes back as", fmt::format("−q of {}, the same orientation as q", fmt::join(m.other_sign, ", ")));
  out += orbit_line("closed to", fmt::format("{:.2g} of its size, after {} correction{} that moved the start by {:.2g}",
                                             m.closure, m.iterations, m.iterations == 1 ? "" : "s", m.moved));
  return out + neighbours_text(r);
}

Json floquet_json(const FloquetResult& r, const MechanicalSystem& system) {
  const PeriodicMotion& m = r.motion;
  Json out = {{"period", m.period},
              {"start", orbit_state_json(m.start, system)},
              {"t", m.start.t},
              {"driven", m.driven},
              {"rests", m.rests}};
  out["turns"] = Json::object();
  for (std::size_t i = 0; i < m.turns.size(); ++i) out["turns"][system.coordinates[i].name] = m.turns[i];
  out["other_sign"] = m.other_sign;
  out["closure"] = m.closure;
  out["moved"] = m.moved;
  out["iterations"] = m.iterations;
  out["multipliers"] = Json::array();
  for (const std::complex<double>& mu : r.multipliers)
    out["multipliers"].push_back({{"real", mu.real()}, {"imaginary", mu.imag()}});
  out["trivial"] = r.trivial;
  out["vanished"] = r.vanished;
  out["lost"] = r.lost;
  out["trace"] = r.trace;
  out["largest"] = r.largest;
  out["stability"] = stability_word(r.stability);
  const auto or_null = [](const std::optional<double>& x) { return x ? Json(*x) : Json(nullptr); };
  out["checks"] = {{"symplectic_residual", or_null(r.symplectic_residual)},
                   {"log_determinant", or_null(r.log_determinant)},
                   {"integrated_divergence", or_null(r.integrated_divergence)},
                   {"error", or_null(r.error)}};
  out["log_smallest"] = or_null(r.log_smallest);
  return out;
}

// ------------------------------------------------------------------------------------------------------------ sections

std::string section_text(const SectionResult& r, const std::string& what, const MechanicalSystem& system) {
  std::string out = fmt::format("{}: {}, {} crossing{} of {} motion{}\n", spoken_name(system), what, r.crossings.size(),
                                r.crossings.size() == 1 ? "" : "s", r.orbits.size(), r.orbits.size() == 1 ? "" : "s");
  double low = r.orbits.front().energy, high = low, drift = 0;
  std::size_t early = 0;
  for (const SectionOrbit& o : r.orbits) {
    low = std::min(low, o.energy), high = std::max(high, o.energy);
    drift = std::max(drift, o.energy_drift);
    early += !o.ended.empty();
  }
  if (r.energy_conserved)
    out += orbit_line("energy",
                      fmt::format("{}, drift at most {:.2g}", in_unit(low, system.dimensionless ? "" : "J"), drift));
  if (r.largest_miss > 0)
    out +=
        orbit_line("on the section to", fmt::format("{:.2g} of its largest value between crossings", r.largest_miss));
  if (early > 0)
    out +=
        orbit_line("ended early", fmt::format("{} of them, the first because: {}", early,
                                              std::find_if(r.orbits.begin(), r.orbits.end(), [](const SectionOrbit& o) {
                                                return !o.ended.empty();
                                              })->ended));
  if (r.orbits.size() > 1) return out;
  for (std::size_t k = 0; k < std::min(most_rows, r.crossings.size()); ++k)
    out += orbit_line(fmt::format("t = {}", seconds(r.crossings[k].state.t, system)).c_str(),
                      "  " + state_line(r.crossings[k].state, system));
  if (r.crossings.size() > most_rows)
    out += fmt::format("  … and {} more; -o FILE.csv has them all\n", r.crossings.size() - most_rows);
  return out;
}

Json section_json(const SectionResult& r, const std::string& what, const MechanicalSystem& system) {
  Json out = {{"section", what}, {"energy_conserved", r.energy_conserved}, {"largest_miss", r.largest_miss}};
  out["orbits"] = Json::array();
  for (const SectionOrbit& o : r.orbits)
    out["orbits"].push_back({{"start", orbit_state_json(o.start, system)},
                             {"energy", o.energy},
                             {"energy_drift", o.energy_drift},
                             {"crossings", o.crossings},
                             {"reached", o.reached},
                             {"ended", o.ended}});
  out["crossings"] = Json::array();
  for (const Crossing& c : r.crossings)
    out["crossings"].push_back(
        {{"orbit", c.orbit}, {"number", c.number}, {"t", c.state.t}, {"state", orbit_state_json(c.state, system)}});
  return out;
}

// --------------------------------------------------------------------------------------------------------- Lyapunov

namespace {

const char* chaos_word(Chaos chaos) {
  switch (chaos) {
    case Chaos::Shown:
      return "shown";
    case Chaos::NotShown:
      return "not shown";
    case Chaos::Excluded:
      return "excluded";
    case Chaos::RunsAway:
      return "runs away";
  }
  return "";
}

std::string chaos_line(const LyapunovResult& r) {
  switch (r.chaos) {
    case Chaos::Shown:
      return orbit_line("chaotic",
                        fmt::format("neighbours part by a factor e in {} s", brief(1 / r.exponents.front())));
    case Chaos::NotShown:
      return orbit_line("not shown chaotic", "within this time the growth may be that of regular motion, a power of t");
    case Chaos::Excluded:
      return orbit_line("not chaotic",
                        "its states fill two dimensions at most, no room for chaos (Poincaré, Bendixson)");
    case Chaos::RunsAway:
      return orbit_line("not shown chaotic", "the motion itself grows about as fast as neighbours part");
  }
  return {};
}

}  // namespace

std::string lyapunov_text(const LyapunovResult& r) {
  std::string out = fmt::format("Lyapunov exponents, the mean over {} s ({} intervals)\n", brief(r.duration),
                                static_cast<std::size_t>(std::round(r.duration / r.interval)));
  for (std::size_t j = 0; j < r.exponents.size(); ++j)
    out +=
        orbit_line(fmt::format("λ{}", j + 1).c_str(), fmt::format("{: .6g} ± {:.2g} 1/s", r.exponents[j], r.errors[j]));
  if (r.exponents.size() == r.dimension)
    out += orbit_line(
        "sum", fmt::format("{: .3g} 1/s{}", r.sum,
                           r.expected_sum ? fmt::format(", the mean divergence {:.3g} 1/s (Liouville, to {:.2g})",
                                                        *r.expected_sum, *r.sum_rule_residual)
                                          : ""));
  out += chaos_line(r);
  if (r.kaplan_yorke) out += orbit_line("dimension", fmt::format("{:.4g}, by Kaplan and Yorke", *r.kaplan_yorke));
  if (!r.ended.empty()) out += orbit_line("ended early", r.ended);
  return out;
}

Json lyapunov_json(const LyapunovResult& r) {
  const auto or_null = [](const std::optional<double>& x) { return x ? Json(*x) : Json(nullptr); };
  return {{"exponents", r.exponents},
          {"errors", r.errors},
          {"dimension", r.dimension},
          {"sum", r.sum},
          {"expected_sum", or_null(r.expected_sum)},
          {"sum_rule_residual", or_null(r.sum_rule_residual)},
          {"chaos", chaos_word(r.chaos)},
          {"kaplan_yorke", or_null(r.kaplan_yorke)},
          {"duration", r.duration},
          {"interval", r.interval},
          {"blocks", r.blocks},
          {"ended", r.ended}};
}

}  // namespace maupertuis::app
