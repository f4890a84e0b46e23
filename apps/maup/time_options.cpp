#include "time_options.hpp"

#include "quantity.hpp"

#include <maupertuis/units.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <variant>

namespace maupertuis::app {
namespace {

bool is_dimensionless(const syntax::SyntaxTree& tree) {
  return std::any_of(tree.statements.begin(), tree.statements.end(), [](const syntax::Statement& s) {
    return std::holds_alternative<syntax::DimensionlessStatement>(s.body);
  });
}

/// Null: the model has no such parameter.
const syntax::Expression* value_of_parameter(const syntax::SyntaxTree& tree, const std::string& name) {
  for (const syntax::Statement& s : tree.statements)
    if (const auto* parameters = std::get_if<syntax::ParamStatement>(&s.body))
      for (const auto& item : parameters->items)
        if (item.name.text == name) return item.value.get();
  return nullptr;
}

bool is_written_as_time(const syntax::Expression& value) {
  if (!value.unit) return false;
  Dimension product;
  for (const auto& factor : value.unit->factors) {
    const auto unit = find_unit(factor.word);
    if (!unit) return false;
    product = product * pow(unit->dimension, factor.exponent_numerator, factor.exponent_denominator);
  }
  return product.same_as(dimensions::time());
}

}  // namespace

void refuse_unit_that_is_a_name(const std::string& option, const std::string& text, const syntax::SyntaxTree* tree,
                                Diagnostics& diagnostics) {
  const auto seconds = parse_time(text);
  const std::size_t word = std::min(text.find_last_of(" 0123456789.") + 1, text.size());
  if (!tree || !seconds || word == text.size()) return;
  const std::string unit = text.substr(word);
  const syntax::Expression* value = value_of_parameter(*tree, unit);
  if (!value || !(is_dimensionless(*tree) || is_written_as_time(*value))) return;
  diagnostics.error(
      "E0809", {}, fmt::format("{} \"{}\": `{}` is a unit and also a parameter of this model.", option, text, unit),
      fmt::format("As a unit it says {} seconds; in the text of the model it would be a multiple of the parameter.",
                  brief(*seconds)),
      fmt::format("Write {} {} for the unit; for a multiple of the parameter its value.", option, brief(*seconds)));
}

void check_time_option(const char* option, const std::optional<std::string>& text, const syntax::SyntaxTree* tree,
                       Diagnostics& diagnostics) {
  if (text && !parse_time(*text))
    diagnostics.error("E0809", {}, fmt::format("{} \"{}\" is no time.", option, *text), {},
                      "Write a number with a unit of time, such as 3s or 250ms, or a part of π, such as \"2 pi/3 s\".");
  if (text) refuse_unit_that_is_a_name(option, *text, tree, diagnostics);
}

std::optional<double> budget_seconds(const std::string& text, Diagnostics& diagnostics) {
  if (text == "none") return std::nullopt;
  const auto seconds = parse_time(text);
  if (!seconds || !(*seconds > 0) || *seconds > 1e8)
    diagnostics.error("E0809", {}, fmt::format("--budget \"{}\" is no length of time.", text), {},
                      "Write a positive time such as 20s or \"2 min\", or none.");
  return seconds;
}

}  // namespace maupertuis::app
