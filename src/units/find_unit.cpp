#include "units/unit_table.hpp"

#include <maupertuis/units.hpp>

#include <algorithm>
#include <stdexcept>
#include <string>

namespace maupertuis {
namespace {

Rational decimal(std::string_view text) {
  const auto value = Rational::parse(text);
  if (!value) throw std::logic_error("unit table: unreadable factor " + std::string(text) + "; please report");
  return *value;
}

Rational factor_of(std::string_view text) {
  const std::size_t slash = text.find('/');
  if (slash == std::string_view::npos) return decimal(text);
  return decimal(text.substr(0, slash)) / decimal(text.substr(slash + 1));
}

Unit unit_of(const UnitEntry& entry) {
  Unit unit;
  for (std::size_t i = 0; i < entry.exponents.size(); ++i) unit.dimension.exponents[i] = {entry.exponents[i], 1};
  unit.factor = factor_of(entry.factor);
  unit.pi_power = entry.pi_power;
  unit.is_hertz = entry.word == "Hz";
  return unit;
}

// Words that look alike: the micro sign and μ, the ohm sign and Ω, the ångström sign and Å.
std::string canonical(std::string_view word) {
  constexpr std::pair<std::string_view, std::string_view> alike[] = {
      {"\u00B5", "μ"}, {"\u2126", "Ω"}, {"\u212B", "\u00C5"}};
  std::string result(word);
  for (const auto& [from, to] : alike) {
    const std::size_t at = result.find(from);
    if (at != std::string::npos) result.replace(at, from.size(), to);
  }
  return result;
}

const UnitEntry* find_entry(std::string_view word) {
  const auto table = unit_table();
  const auto found =
      std::find_if(table.begin(), table.end(), [&](const UnitEntry& entry) { return entry.word == word; });
  return found == table.end() ? nullptr : &*found;
}

}  // namespace

std::optional<Unit> find_unit(std::string_view written) {
  const std::string word = canonical(written);
  if (const UnitEntry* exact = find_entry(word)) return unit_of(*exact);
  for (const PrefixEntry& prefix : prefix_table()) {
    if (word.size() <= prefix.word.size() || word.compare(0, prefix.word.size(), prefix.word) != 0) continue;
    const UnitEntry* entry = find_entry(std::string_view(word).substr(prefix.word.size()));
    if (!entry || !entry->prefixes) continue;
    Unit unit = unit_of(*entry);
    unit.factor = unit.factor * pow(Rational(10), prefix.power);
    return unit;
  }
  return std::nullopt;
}

const AmbiguousUnit* find_ambiguous_unit(std::string_view word) {
  const auto table = ambiguous_units();
  const auto found =
      std::find_if(table.begin(), table.end(), [&](const AmbiguousUnit& unit) { return unit.word == word; });
  return found == table.end() ? nullptr : &*found;
}

std::vector<std::string> unit_words() {
  std::vector<std::string> words;
  for (const UnitEntry& entry : unit_table()) words.emplace_back(entry.word);
  return words;
}

}  // namespace maupertuis
