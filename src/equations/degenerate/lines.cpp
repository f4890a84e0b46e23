#include <maupertuis/degenerate.hpp>

#include <fmt/format.h>

#include <array>

namespace maupertuis {
namespace {

std::string generation_text(int generation) {
  static constexpr std::array words{"first", "second", "third", "fourth", "fifth", "sixth"};
  const auto place = static_cast<std::size_t>(generation - 1);
  return place < words.size() ? fmt::format("{} generation", words[place]) : fmt::format("generation {}", generation);
}

}  // namespace

std::vector<DerivationStep> degenerate_lines(const DegenerateAnalysis& analysis, const MechanicalSystem& system) {
  std::vector<DerivationStep> out;
  const std::string section = "Constraints of the Lagrangian";
  for (const FoundConstraint& c : analysis.chain.constraints) {
    const std::string rule = generation_text(c.generation) + (c.follows ? ", the derivative of one before" : "");
    out.push_back({section, rule, layouts::number("0"), c.value, {}, {}});
  }
  for (const Gauge& gauge : system.gauges)
    if (analysis.gauges > 0) out.push_back({section, "gauge", {}, {}, "With the gauge " + gauge.text + ".", {}});
  std::string names;
  for (const std::size_t i : analysis.free) names += (names.empty() ? "" : ", ") + system.coordinates[i].name + "''";
  if (!names.empty())
    out.push_back(
        {section,
         {},
         {},
         {},
         fmt::format("No equation gives {}: {} free.", names,
                     analysis.free.size() == 1 ? "one function of time is"
                                               : fmt::format("{} functions of time are", analysis.free.size())),
         {}});
  out.push_back({section,
                 {},
                 {},
                 {},
                 fmt::format("Of the {} numbers of a state the constraints leave {}{}; {} single{} out a motion.",
                             2 * system.coordinates.size(), analysis.chain.manifold_dimension,
                             analysis.orbits.empty()
                                 ? std::string()
                                 : fmt::format(", of which the free functions move {}", analysis.orbits.size()),
                             analysis.motions, analysis.motions == 1 ? "s" : ""),
                 {}});
  return out;
}

}  // namespace maupertuis
