#include "report/motion_parts.hpp"
#include "report/notation.hpp"

#include <maupertuis/print.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace maupertuis {
namespace {

/// The dimension of a formula that was found consistent: that of its first term.
Dimension dimension_of(Expr e, const MechanicalSystem& system) {
  if (e.is(Kind::Sum)) return dimension_of(e[0], system);
  if (e.is(Kind::Product)) {
    Dimension product = dimensions::one();
    for (std::size_t i = 0; i < e.size(); ++i) product = product * dimension_of(e[i], system);
    return product;
  }
  if (e.is(Kind::Power)) {
    const Rational* exponent = e[1].number_or_null();
    const auto parts = exponent ? exponent->small() : std::nullopt;
    return parts ? pow(dimension_of(e[0], system), parts->numerator, parts->denominator) : dimensions::one();
  }
  if (!e.is_symbol()) return dimensions::one();
  if (e.role() == Role::Time) return system.independent_dimension;
  for (const Parameter& p : system.parameters)
    if (p.symbol == e) return p.dimension;
  for (const Coordinate& c : system.coordinates)
    if (c.name == e.name()) return c.dimension / pow(system.independent_dimension, e.order());
  return dimensions::one();
}

std::string sentence_of(const ConservedFunction& integral) {
  std::string text = integral.name.empty() ? "An integral without a name of its own" : integral.name;
  text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  if (!integral.symmetry.empty())
    text += ", from the symmetry: " + integral.symmetry;
  else if (integral.kind == IntegralKind::Hidden)
    text += ", from no point symmetry";
  text += ".";
  if (!integral.independent) text += " A function of those before it at fixed t.";
  return text;
}

std::string summary_of(const Invariants& found) {
  const std::size_t n = found.freedoms;
  std::string text = fmt::format("{} independent integral{}, {} degree{} of freedom.", found.rank,
                                 found.rank == 1 ? "" : "s", n, n == 1 ? "" : "s");
  if (found.completely_integrable)
    text += fmt::format(" Completely integrable: {} {} independent and in involution.",
                        fmt::join(found.involution, ", "), found.involution.size() == 1 ? "is" : "are");
  if (found.symmetry_bound)
    text += *found.symmetry_bound == found.noether_symmetries
                ? fmt::format(
                      " There are no further point symmetries than {}.",
                      found.noether_symmetries == 1 ? "this one" : fmt::format("these {}", found.noether_symmetries))
                : fmt::format(" At most {} point symmetries exist; {} were found.", *found.symmetry_bound,
                              found.noether_symmetries);
  return text;
}

}  // namespace

void add_invariants(ReportContent& content, const EquationsOfMotion& equations, const Invariants& found,
                    const SimulationResult* run) {
  const ReadingOrder& order = equations.order;
  for (std::size_t i = 0; i < found.shown; ++i) {
    const ConservedFunction& integral = found.integrals[i];
    ReportContent::Conserved row;
    row.sentence = sentence_of(integral);
    row.formula = {lay_out(found.symbols[i], order), lay_out(integral.readable, order), "", ""};
    const MechanicalSystem& system = *equations.system;
    const std::string unit = system.dimensionless ? "" : to_string(dimension_of(integral.value, system));
    if (run) add_values_along_run(row, equations, integral.value, unit, run->trajectory);
    content.conserved.push_back(std::move(row));
  }
  const auto is_hidden = [&](Expr node) {
    return std::find(found.symbols.begin() + static_cast<std::ptrdiff_t>(found.shown), found.symbols.end(), node) !=
           found.symbols.end();
  };
  for (const IntegralRelation& relation : found.relations) {
    const auto nodes = topological_order({&relation.value.value, 1});
    if (std::any_of(nodes.begin(), nodes.end(), is_hidden)) continue;
    content.conserved.push_back(
        {"Between them holds", {layouts::number("0"), lay_out(relation.value, order), "", ""}, "", ""});
  }
  for (const BalanceLaw& law : found.balance_laws)
    content.conserved.push_back({law.name + " is changed by forces or constraints, at the rate",
                                 {{}, lay_out(law.rate, order), "", ""},
                                 "",
                                 ""});
  ReportContent::Conserved summary;
  summary.sentence = summary_of(found);
  content.conserved.push_back(std::move(summary));
}

}  // namespace maupertuis
