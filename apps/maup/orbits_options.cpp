#include "orbits_options.hpp"

#include "interrupt.hpp"
#include "quantity.hpp"
#include "time_options.hpp"

#include <fmt/format.h>

#include <cmath>

namespace maupertuis::app {
namespace {

/// Of an option that check_orbits_options has found to be a time.
std::optional<double> time_of(const std::optional<std::string>& text) {
  return text ? parse_time(*text) : std::nullopt;
}

struct WrittenSection {
  std::string equation;
  SectionDirection direction = SectionDirection::Both;
};

WrittenSection split_section(const std::string& text) {
  for (const auto& [word, direction] : {std::pair(std::string(" rising"), SectionDirection::Rising),
                                        std::pair(std::string(" falling"), SectionDirection::Falling)})
    if (text.ends_with(word)) return {text.substr(0, text.size() - word.size()), direction};
  return {text, SectionDirection::Both};
}

}  // namespace

void add_orbits_options(Command& command, OrbitsOptions& options) {
  const auto count = [&command](const char* name, std::size_t& value, const char* what) {
    command.add_option(name, value, what)->positive()->type_name("NUMBER");
  };
  const auto time = [&command](const char* name, std::optional<std::string>& value, const char* what) {
    command.add_option(name, value, what)->type_name("TIME");
  };
  command.add_flag("--floquet", options.floquet,
                   "The periodic motion next to the start, and the multipliers of its neighbours");
  time("--period", options.period, "Its period, or near it (default: looked for; of a drive: read off)");
  command
      .add_option("--section", options.section,
                  "Where the motion passes this, e.g. \"x = 0 rising\", \"θ1 = 0 falling\", \"P.y = 0\"")
      ->type_name("EQUATION");
  time("--strobe", options.strobe, "The motion at multiples of a time, for driven systems");
  count("--crossings", options.crossings, "How many points of each motion (default 500)");
  count("--starts", options.starts,
        "How many motions, spread over the section at one energy (default: that of the model)");
  command.add_option("--energy", options.energy, "Their energy in J (default: that of the model's start)")
      ->type_name("NUMBER");
  time("--longest", options.longest, "How long to follow one motion at most");
  command.add_flag("--lyapunov", options.lyapunov, "How fast neighbours part");
  count("--exponents", options.exponents, "How many exponents, the largest first (default: all)");
  time("--interval", options.interval, "Time between two orthogonalizations (default: chosen)");
  time("--transient", options.transient, "Time before the average begins (default: a tenth of the duration)");
}

void check_orbits_options(const OrbitsOptions& o, const syntax::SyntaxTree* tree, Diagnostics& diagnostics) {
  for (const auto& [option, text] :
       {std::pair("--period", &o.period), std::pair("--strobe", &o.strobe), std::pair("--longest", &o.longest),
        std::pair("--interval", &o.interval), std::pair("--transient", &o.transient)})
    check_time_option(option, *text, tree, diagnostics);
  if (const auto interval = time_of(o.interval); interval && !(*interval > 0))
    diagnostics.error("E0809", {}, fmt::format("--interval \"{}\" is no time that passes.", *o.interval),
                      "Directions are orthogonalized each time that it has passed.", "Write one such as 0.5s.");
  if (const auto longest = time_of(o.longest); longest && !(*longest > 0))
    diagnostics.error("E0809", {}, fmt::format("--longest \"{}\" is no time that passes.", *o.longest),
                      "A motion is followed so long at most.", "Write one such as 100s, or leave it out.");
  if (o.energy && !std::isfinite(*o.energy))
    diagnostics.error("E0809", {}, "--energy is no finite number.", "Motions of a section share one energy.",
                      "Write it in J, such as --energy 0.125.");
  if (!o.section.empty() && o.strobe)
    diagnostics.error("E0809", {}, "--section and --strobe exclude each other.",
                      "One looks at the motion where it is, the other when it is time.", "Give one of them.");
}

FloquetOptions floquet_options(const OrbitsOptions& options) { return {time_of(options.period), &interrupt_flag()}; }

LyapunovOptions lyapunov_options(const OrbitsOptions& options) {
  LyapunovOptions out;
  out.exponents = options.exponents;
  out.interval = time_of(options.interval).value_or(0);
  out.transient = time_of(options.transient);
  out.interrupt = &interrupt_flag();
  return out;
}

void put_in_section(const OrbitsOptions& options, Study& study) {
  if (!options.section.empty())
    study.override_with(OverrideKind::Section, "--section", split_section(options.section).equation);
}

SectionOptions section_options(const OrbitsOptions& options, Study& study) {
  SectionOptions out;
  out.section = study.model()->experiment.section;
  out.direction = split_section(options.section).direction;
  out.strobe = time_of(options.strobe);
  out.longest = time_of(options.longest).value_or(0);
  out.crossings = options.crossings;
  out.starts = options.starts;
  out.energy = options.energy;
  out.interrupt = &interrupt_flag();
  return out;
}

std::string section_text(const OrbitsOptions& options) {
  return options.strobe ? fmt::format("strobe every {} s", brief(*time_of(options.strobe)))
                        : fmt::format("section {}", options.section);
}

}  // namespace maupertuis::app
