#include "language_services/units_of_text.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis::language {

double si_value(const Unit& unit) { return unit.factor.to_double() * std::pow(std::acos(-1.0), unit.pi_power); }

// The reading whose dimension fits wins, and two that fit are a mistake: where the words in square brackets, which are
// units, leave the model without a mistake, they are units without brackets too.
const Declared* name_read(Document& document, std::size_t token) {
  const Roles& roles = document.roles();
  const syntax::TextReading& reading = document.reading();
  if (!roles.ambiguous(token) || !document.model()) return nullptr;
  const Span word = reading.tokens[token].span;
  const auto place = std::find_if(reading.units.begin(), reading.units.end(),
                                  [&](Span unit) { return unit.begin <= word.begin && word.end <= unit.end; });
  if (place == reading.units.end()) return nullptr;
  const bool names = document.reads_names(*place, [&] {
    const std::string words = "[" + std::string(document.source().slice(*place)) + "]";
    Document probe(SourceText("", edited(document.source().text(), {{*place, words}})), document.interrupt());
    return probe.model() == nullptr;
  });
  return names ? roles.find(reading.tokens[token].text) : nullptr;
}

}  // namespace maupertuis::language
