#include "invariants_text.hpp"

#include <maupertuis/print.hpp>
#include <maupertuis/rates.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace maupertuis::app {
namespace {

std::string formula(const ReadableForm& form, const ReadingOrder& order) {
  std::string text = to_plain(form, order);
  for (const Intermediate& i : form.intermediates)
    text += fmt::format("\n       with {} = {}", to_plain(i.symbol, order), to_plain(i.value, order));
  return text;
}

const char* kind_name(IntegralKind kind) {
  switch (kind) {
    case IntegralKind::Noether:
      return "noether";
    case IntegralKind::Hidden:
      return "hidden";
    case IntegralKind::Direct:
      break;
  }
  return "direct";
}

std::string ground(const ZeroTest& test, const MechanicalSystem& system) {
  const std::string rate = "dI/d" + system.independent;
  if (test.error_bound == 0) return rate + " = 0 term by term";
  if (test.error_bound < 1)
    return fmt::format("{} = 0 proved at {} points, error bound {:.0e}", rate, test.points, test.error_bound);
  return fmt::format("{} vanishes at {} points", rate, test.points);
}

std::string displacement(const ConservedFunction& integral, const EquationsOfMotion& equations) {
  std::string text;
  for (std::size_t i = 0; i < integral.characteristic.size(); ++i)
    text += fmt::format("{}δ{} = {}", i == 0 ? "" : ", ", equations.system->coordinates[i].name,
                        to_plain(integral.characteristic[i], equations.order));
  return text;
}

std::string origin(const ConservedFunction& integral, const EquationsOfMotion& equations) {
  if (!integral.symmetry.empty()) return integral.symmetry;
  constexpr std::size_t longest = 160;
  if (const std::string text = displacement(integral, equations); !text.empty() && text.size() <= longest) return text;
  switch (integral.kind) {
    case IntegralKind::Noether:
      return "a point symmetry up to gauge";
    case IntegralKind::Hidden:
      return "no point symmetry: its symmetry depends on the velocities";
    case IntegralKind::Direct:
      break;
  }
  return "found directly";
}

std::string integral_text(const std::string& symbol, const ConservedFunction& integral,
                          const EquationsOfMotion& equations, const RateNotation& rates) {
  const auto in_rates = rates.shorter(integral.value, integral.readable);
  const std::string shown = in_rates ? formula(*in_rates, rates.order()) : formula(integral.readable, equations.order);
  std::string text = fmt::format("{:<4} {}\n", symbol, shown);
  if (!integral.name.empty()) text += fmt::format("     {}\n", integral.name);
  text += fmt::format("     from: {}\n     {}", origin(integral, equations),
                      ground(integral.certificate, *equations.system));
  if (integral.drift) text += fmt::format("; drift in the run {:.1e}", *integral.drift);
  if (!integral.independent) text += "; a function of those before it at fixed t";
  return text + "\n";
}

/// Whether a formula in I1, I2, … names only the first `count` of them.
bool is_about(Expr value, const Invariants& found, std::size_t count) {
  const auto nodes = topological_order({&value, 1});
  return std::none_of(found.symbols.begin() + static_cast<std::ptrdiff_t>(count), found.symbols.end(),
                      [&](const Expr& s) { return std::find(nodes.begin(), nodes.end(), s) != nodes.end(); });
}

std::string relations_text(const Invariants& found, std::size_t count, const ReadingOrder& order) {
  std::string text;
  for (const IntegralRelation& r : found.relations)
    if (is_about(r.value.value, found, count)) text += fmt::format("  {} = 0\n", to_plain(r.value, order));
  return text.empty() ? "" : "\nRelations\n" + text;
}

std::string brackets_text(const Invariants& found, std::size_t count, const ReadingOrder& order) {
  std::string text;
  for (const PoissonBracket& b : found.brackets)
    if (b.second < count)
      text += fmt::format("  {{{}, {}}} = {}\n", found.symbols[b.first].name(), found.symbols[b.second].name(),
                          b.value.value ? to_plain(b.value, order) : "a further function");
  return text.empty() ? "" : "\nPoisson brackets that do not vanish\n" + text;
}

std::string integrability_text(const Invariants& found) {
  const std::size_t n = found.freedoms;
  std::string text = fmt::format("\n{} independent integral{}", found.rank, found.rank == 1 ? "" : "s");
  if (found.autonomous_rank != found.rank)
    text += fmt::format(", {} of them without explicit time", found.autonomous_rank);
  text += fmt::format("; {} degree{} of freedom.\n", n, n == 1 ? "" : "s");
  if (!found.completely_integrable) return text;
  text += fmt::format("Completely integrable: {} {} independent and in involution", fmt::join(found.involution, ", "),
                      found.involution.size() == 1 ? "is" : "are");
  if (n > 1 && found.autonomous_rank == 2 * n - 1)
    text += fmt::format("; maximally superintegrable, with {} integrals", 2 * n - 1);
  return text + ".\n";
}

/// What looks like an integral and is none.
std::string one_side_text(const Invariants& found, const ReadingOrder& order) {
  constexpr std::size_t most = 4;
  std::string text = found.on_one_side.empty() ? "" : "\nConstant on each side of a switch, not across it\n";
  for (std::size_t i = 0; i < std::min(most, found.on_one_side.size()); ++i) {
    const auto& [value, place] = found.on_one_side[i];
    text += fmt::format("  {}{}\n", formula(readable(value, order), order),
                        place.empty() ? "" : ", which jumps where " + place);
  }
  if (found.on_one_side.size() > most) text += fmt::format("  and {} more\n", found.on_one_side.size() - most);
  return text;
}

std::string completeness_text(const Invariants& found) {
  std::string text;
  if (found.symmetry_bound) {
    text += *found.symmetry_bound == found.noether_symmetries
                ? fmt::format("Point symmetries: {} found, and there are no more (bound at a generic point).\n",
                              found.noether_symmetries)
                : fmt::format("Point symmetries: {} found, at most {} exist (bound at a generic point).\n",
                              found.noether_symmetries, *found.symmetry_bound);
  }
  text += "None further in this basis:\n";
  for (const std::string& line : found.basis) text += "  " + line + "\n";
  if (found.too_long > 0)
    text += fmt::format(
        "  {} more in it, whose coefficients could not be written as fractions of the parameters, or not proved\n",
        found.too_long);
  return text;
}

}  // namespace

std::string invariants_text(const Invariants& found, const EquationsOfMotion& equations, bool all) {
  const ReadingOrder& order = equations.order;
  const std::size_t count = all ? found.integrals.size() : found.shown;
  const RateNotation rates(equations);
  std::string text;
  for (std::size_t i = 0; i < count; ++i)
    text += integral_text(found.symbols[i].name(), found.integrals[i], equations, rates);
  if (found.integrals.empty()) text += "No integral was found.\n";
  if (count < found.integrals.size())
    text += fmt::format("{} more {} of these: --all\n", found.integrals.size() - count,
                        found.integrals.size() - count == 1 ? "is a function" : "are functions");
  text += relations_text(found, count, order) + brackets_text(found, count, order);
  if (!found.balance_laws.empty()) text += "\nBalance laws\n";
  for (const BalanceLaw& law : found.balance_laws)
    text += fmt::format("  {}: d/d{} ({}) = {}\n", law.name, equations.system->independent,
                        to_plain(law.quantity, order), formula(law.rate, order));
  text += one_side_text(found, order);
  if (!found.integrals.empty()) text += integrability_text(found);
  return text + completeness_text(found);
}

namespace {

Json integral_json(const ConservedFunction& integral, const ReadingOrder& order, const RateNotation& rates) {
  const auto in_rates = rates.shorter(integral.value, integral.readable);
  Json intermediates = Json::array(), characteristic = Json::array();
  for (const Intermediate& i : integral.readable.intermediates)
    intermediates.push_back({{"name", to_plain(i.symbol, order)}, {"plain", to_plain(i.value, order)}});
  for (const Expr& e : integral.characteristic) characteristic.push_back(to_plain(e, order));
  return {{"name", integral.name},
          {"plain", to_plain(integral.readable, order)},
          {"latex", to_latex(integral.readable, order)},
          {"in_rates", in_rates ? Json(formula(*in_rates, rates.order())) : Json()},
          {"intermediates", std::move(intermediates)},
          {"kind", kind_name(integral.kind)},
          {"symmetry", integral.symmetry},
          {"characteristic", std::move(characteristic)},
          {"velocity_degree", integral.velocity_degree},
          {"explicit_time", integral.explicit_time},
          {"independent", integral.independent},
          {"certificate",
           {{"verdict", verdict_name(integral.certificate.verdict)},
            {"points", integral.certificate.points},
            {"error_bound", integral.certificate.error_bound}}},
          {"drift", integral.drift ? Json(*integral.drift) : Json(nullptr)}};
}

}  // namespace

void add_invariants_json(Json& document, const Invariants& found, const EquationsOfMotion& equations) {
  const ReadingOrder& order = equations.order;
  const RateNotation rates(equations);
  document["integrals"] = Json::array();
  for (const ConservedFunction& i : found.integrals) document["integrals"].push_back(integral_json(i, order, rates));
  document["shown"] = found.shown;
  document["independent"] = found.rank;
  document["independent_without_time"] = found.autonomous_rank;
  document["relations"] = Json::array();
  for (const IntegralRelation& r : found.relations) document["relations"].push_back(to_plain(r.value, order));
  document["brackets"] = Json::array();
  for (const PoissonBracket& b : found.brackets)
    document["brackets"].push_back({{"first", b.first + 1},
                                    {"second", b.second + 1},
                                    {"plain", b.value.value ? Json(to_plain(b.value, order)) : Json(nullptr)}});
  document["balance_laws"] = Json::array();
  for (const BalanceLaw& law : found.balance_laws)
    document["balance_laws"].push_back(
        {{"name", law.name}, {"quantity", to_plain(law.quantity, order)}, {"rate", to_plain(law.rate, order)}});
  document["freedoms"] = found.freedoms;
  document["completely_integrable"] = found.completely_integrable;
  document["involution"] = found.involution;
  document["point_symmetries"] = found.noether_symmetries;
  document["point_symmetries_bound"] = found.symmetry_bound ? Json(*found.symmetry_bound) : Json(nullptr);
  document["basis"] = found.basis;
  document["too_long"] = found.too_long;
  document["on_one_side"] = Json::array();
  for (const auto& [value, place] : found.on_one_side)
    document["on_one_side"].push_back({{"plain", to_plain(readable(value, order), order)}, {"jumps_at", place}});
}

namespace {

using Holds = IntegralThroughModes::Holds;

std::string through_text(const IntegralThroughModes& through) {
  std::vector<std::string> lines;
  const auto modes = [&](Holds holds, const char* before) {
    std::vector<std::string> names;
    for (const auto& m : through.modes)
      if (m.holds == holds) names.push_back("\"" + m.mode + "\"");
    if (names.size() == through.modes.size() && names.size() > 1)
      lines.push_back(fmt::format("{} all {} modes", before, names.size()));
    else if (!names.empty())
      lines.push_back(fmt::format("{} {}", before, fmt::join(names, ", ")));
  };
  if (through.modes.size() > 1 || !through.impacts.empty()) {
    modes(Holds::Yes, "holds in");
    modes(Holds::No, "not in");
    modes(Holds::Undecided, "undecided in");
  }
  const auto kept_at = [&](const auto& list, auto name, const char* yes, const char* no, const char* undecided) {
    for (const auto& [kept, before] : {std::pair(Holds::Yes, yes), {Holds::No, no}, {Holds::Undecided, undecided}}) {
      std::vector<std::string> names;
      for (const auto& x : list)
        if (x.kept == kept) names.push_back(x.*name);
      if (!names.empty()) lines.push_back(fmt::format("{} {}", before, fmt::join(names, ", ")));
    }
  };
  kept_at(through.impacts, &IntegralThroughModes::AtImpact::contact, "kept by impacts on", "changed by impacts on",
          "undecided at impacts on");
  kept_at(through.events, &IntegralThroughModes::AtEvent::event, "kept by the event", "changed by the event",
          "undecided at the event");
  if (through.left_out > 0)
    lines.push_back(fmt::format("{} not looked at",
                                through.left_out == 1 ? "1 mode was" : fmt::format("{} modes were", through.left_out)));
  return fmt::format("{}", fmt::join(lines, "\n       "));
}

const char* word_of_holds(Holds holds) { return holds == Holds::Yes ? "yes" : holds == Holds::No ? "no" : "undecided"; }

}  // namespace

std::string through_modes_text(const Invariants& found, const std::vector<IntegralThroughModes>& through,
                               bool has_modes, bool all) {
  const std::size_t count = std::min(all ? found.integrals.size() : found.shown, through.size());
  if (count == 0)
    return has_modes ? "\nAll this is the motion while contacts are open; --mode asks of another one.\n" : "";
  std::string text = has_modes
                         ? "\nAll this is the motion while contacts are open. Through contacts, friction and impacts:\n"
                         : "\nAll this is the motion between events. At events that set the state:\n";
  for (std::size_t i = 0; i < count; ++i)
    text += fmt::format("  {:<4} {}\n", found.symbols[i].name(),
                        !through[i].everywhere() ? through_text(through[i])
                        : has_modes              ? "holds in all modes, and impacts keep it"
                                                 : "kept by all of them");
  return text;
}

void add_through_modes_json(Json& document, const std::vector<IntegralThroughModes>& through) {
  for (std::size_t i = 0; i < through.size(); ++i) {
    Json modes = Json::array(), impacts = Json::array();
    for (const auto& m : through[i].modes) modes.push_back({{"mode", m.mode}, {"holds", word_of_holds(m.holds)}});
    for (const auto& c : through[i].impacts)
      impacts.push_back({{"contact", c.contact}, {"kept", word_of_holds(c.kept)}, {"largest_change", c.change}});
    Json events = Json::array();
    for (const auto& e : through[i].events)
      events.push_back({{"event", e.event}, {"kept", word_of_holds(e.kept)}, {"largest_change", e.change}});
    document["integrals"][i]["through_modes"] = {{"modes", std::move(modes)},
                                                 {"impacts", std::move(impacts)},
                                                 {"events", std::move(events)},
                                                 {"modes_left_out", through[i].left_out}};
  }
}

}  // namespace maupertuis::app
