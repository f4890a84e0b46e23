#include "extended_text.hpp"

#include "quantity.hpp"
#include "run_options.hpp"

#include <fmt/format.h>

namespace maupertuis::app {
namespace {

std::string digits_text(const AgreedNumber& x) {
  if (x.text.empty()) return "not determined";
  if (x.digits > 0) return x.text;
  return fmt::format("0  (no digit is certain: the runs differ by {})", x.difference);
}

/// A time that was asked for is exact: its zeros at the end say nothing.
std::string time_text(const AgreedNumber& t) {
  std::string text = t.text;
  if (text.find('.') == std::string::npos || text.find('e') != std::string::npos) return text;
  while (text.back() == '0') text.pop_back();
  if (text.back() == '.') text.pop_back();
  return text;
}

std::string moment_text(const std::string& t, const ExtendedResult& result) {
  const std::string& second = result.independent.unit;
  return fmt::format("{} = {}{}{}\n", result.independent.name, t, second.empty() ? "" : " ", second);
}

std::string state_text(const ExtendedState& state, const ExtendedResult& result) {
  std::string out = moment_text(time_text(state.t), result);
  const auto line = [&](const std::string& name, const AgreedNumber& x, const std::string& unit) {
    const std::string number = state.compared || x.text.empty() ? digits_text(x) : x.text;
    out +=
        fmt::format("  {} = {}{}{}\n", name, number, unit == "1" || unit.empty() ? "" : " ", unit == "1" ? "" : unit);
  };
  const std::size_t n = state.q.size();
  for (std::size_t i = 0; i < n; ++i) {
    line(result.columns[i].name, state.q[i], result.columns[i].unit);
    line(result.columns[n + i].name, state.v[i], result.columns[n + i].unit);
  }
  for (std::size_t i = 0; i < state.reactions.size(); ++i)
    line(result.reactions[i].name, state.reactions[i], result.reactions[i].unit);
  line("energy", state.energy, result.columns.back().unit);
  return out;
}

std::string happening_text(const ExtendedHappening& h, const ExtendedResult& result, const MechanicalSystem& system) {
  const std::string& second = result.independent.unit;
  std::string out = fmt::format("  {} = {}{}{}  {}", result.independent.name, digits_text(h.t),
                                second.empty() ? "" : " ", second, h.name);
  if (h.kind == Happening::Kind::Impact)
    out += " impact, impulse " + impulse_text(digits_text(h.impulse), h.name, system);
  else if (h.kind != Happening::Kind::Event)
    out += " " + std::string(word_of(h.kind));
  return out + "\n";
}

/// The first and the last of them, a line each.
std::string happenings_text(const ExtendedResult& result, const MechanicalSystem& system) {
  constexpr std::size_t most = 24, first = 16;
  const std::size_t count = result.happenings.size();
  std::string out;
  for (std::size_t k = 0; k < count; ++k) {
    if (count > most && k == first) {
      k = count - (most - first);
      out += fmt::format("  … {} more, all with --json …\n", k - first);
    }
    out += happening_text(result.happenings[k], result, system);
  }
  return out;
}

Json number_json(const AgreedNumber& x) { return x.digits > 0 ? Json(x.text) : Json(nullptr); }

Json state_json(const ExtendedState& state, const ExtendedResult& result) {
  if (!state.reached) return nullptr;
  Json values = Json::object(), digits = Json::object(), reactions = Json::object();
  const std::size_t n = state.q.size();
  const auto add = [&](const std::string& name, const AgreedNumber& x) {
    values[name] = number_json(x);
    digits[name] = x.digits;
  };
  for (std::size_t i = 0; i < n; ++i) {
    add(result.columns[i].name, state.q[i]);
    add(result.columns[n + i].name, state.v[i]);
  }
  for (std::size_t i = 0; i < state.reactions.size(); ++i) {
    reactions[result.reactions[i].name] = number_json(state.reactions[i]);
    digits[result.reactions[i].name] = state.reactions[i].digits;
  }
  digits["energy"] = state.energy.digits;
  return {{"t", time_text(state.t)},
          {"state", std::move(values)},
          {"reactions", std::move(reactions)},
          {"energy", number_json(state.energy)},
          {"digits", std::move(digits)}};
}

std::string statistics_text(const ExtendedResult& result) {
  const ExtendedStatistics& s = result.statistics;
  const std::string run =
      fmt::format("{} steps of order {} with {} bits in {} s", s.steps, s.order, s.bits, brief(s.seconds));
  if (result.ending == Ending::Interrupted)
    return "How many of these digits are right is not known: the run was interrupted before the runs that tell it.\n" +
           run + "\n";
  return run + fmt::format(
                   "; digits on which {} steps of order {} in {} s and {} steps of order {} with {} bits in {} s "
                   "agree\n",
                   s.companion_steps, s.companion_order, brief(s.companion_seconds), s.check_steps, s.check_order,
                   s.check_bits, brief(s.check_seconds));
}

}  // namespace

std::string impulse_text(const std::string& number, const std::string& contact, const MechanicalSystem& system) {
  if (system.dimensionless) return number;
  for (std::size_t i = 0; i < system.contacts.size(); ++i)
    if (system.contact_label(i) == contact)
      return fmt::format("{} {}", number,
                         to_string(dimensions::energy() * system.independent_dimension / system.contacts[i].dimension));
  return number;
}

std::string extended_text(const ExtendedResult& result, const MechanicalSystem& system) {
  std::string out;
  out += happenings_text(result, system);
  for (const std::string& remark : result.remarks) out += "  " + remark + "\n";
  for (const ExtendedState& state : result.at)
    out += state.reached ? state_text(state, result) : moment_text(state.t.text, result) + "  not reached\n";
  const bool told = !result.at.empty() && result.at.back().reached && result.at.back().t.text == result.final.t.text;
  if (result.final.reached && !told) out += state_text(result.final, result);
  return out + statistics_text(result);
}

Json extended_document(const ExtendedResult& result, const std::string& precision, const MechanicalSystem& system) {
  Json document = json_document("simulate");
  document["system"] = system.name;
  document["precision"] = precision;
  document["final"] = state_json(result.final, result);
  document["at"] = Json::array();
  for (const ExtendedState& state : result.at) document["at"].push_back(state_json(state, result));
  document["happenings"] = Json::array();
  for (const ExtendedHappening& h : result.happenings) {
    Json entry = {
        {"kind", std::string(word_of(h.kind))}, {"name", h.name}, {"t", number_json(h.t)}, {"digits", h.t.digits}};
    if (h.kind == Happening::Kind::Impact)
      entry["impulse"] = number_json(h.impulse), entry["speed"] = number_json(h.speed);
    document["happenings"].push_back(std::move(entry));
  }
  document["remarks"] = result.remarks;
  const ExtendedStatistics& s = result.statistics;
  document["statistics"] = {{"steps", s.steps},
                            {"order", s.order},
                            {"bits", s.bits},
                            {"seconds", s.seconds},
                            {"check_steps", s.check_steps},
                            {"check_order", s.check_order},
                            {"check_bits", s.check_bits},
                            {"check_seconds", s.check_seconds},
                            {"companion_steps", s.companion_steps},
                            {"companion_order", s.companion_order},
                            {"companion_seconds", s.companion_seconds},
                            {"switches", s.switches},
                            {"rows", result.rows.size()}};
  document["ended"] = {{"reason", result.reason.empty() ? std::string(word_of(result.ending)) : result.reason},
                       {"kind", word_of(result.ending)},
                       {"ok", result.ok()}};
  return document;
}

}  // namespace maupertuis::app
