#include "numbers.hpp"

#include "quantity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace maupertuis::app {
namespace {

/// "/points/0/modes/1/frequency" below `value`, "/" if it is that itself; or empty. The path is written where one is
/// found alone: there may be a million numbers.
std::string place_of_no_number(const Json& value) {
  if (value.is_number_float() && !std::isfinite(value.get<double>())) return "/";
  if (!value.is_structured()) return {};
  for (const auto& part : value.items())
    if (const std::string found = place_of_no_number(part.value()); !found.empty())
      return "/" + part.key() + (found == "/" ? "" : found);
  return {};
}

void tell(const std::string& what, Diagnostics& diagnostics, const std::string& further = {},
          std::optional<Span> span = {}) {
  diagnostics.error("E0816", span, fmt::format("{} is no finite number", what),
                    "A quantity grew beyond the range of numbers, or a formula has no value there." +
                        (further.empty() ? further : " " + further),
                    "Change start, parameters or the length of the run so that it stays within 1e308.");
}

std::optional<Span> span_of(const std::string& column, const WrittenColumns& written) {
  const auto found = written.find(column);
  return found == written.end() ? std::nullopt : std::optional(found->second);
}

bool may_be_open(const std::string& column, std::span<const std::string> open) {
  return std::find(open.begin(), open.end(), column) != open.end() || column.rfind("reaction(", 0) == 0 ||
         column.rfind("error(", 0) == 0;
}

/// The first row where a column holds what is no finite number; none where it may, or where all are.
std::optional<std::size_t> row_of_no_number(const Trajectory& rows, std::size_t column,
                                            std::span<const std::string> open) {
  if (may_be_open(rows.columns[column].name, open)) return std::nullopt;
  for (std::size_t row = 0; row < rows.rows(); ++row)
    if (!std::isfinite(rows.at(row, column))) return row;
  return std::nullopt;
}

}  // namespace

bool check_numbers(const Json& document, Diagnostics& diagnostics) {
  const std::string place = place_of_no_number(document);
  if (!place.empty()) tell(fmt::format("the result at {}", place), diagnostics);
  return place.empty();
}

bool check_numbers(const Trajectory& rows, Diagnostics& diagnostics, std::span<const std::string> open,
                   const std::string& further, const WrittenColumns& written) {
  for (std::size_t column = 0; column < rows.columns.size(); ++column)
    if (const auto row = row_of_no_number(rows, column, open)) {
      tell(fmt::format("{} at {} = {}", rows.columns[column].name, rows.independent.name, brief(rows.times[*row])),
           diagnostics, further, span_of(rows.columns[column].name, written));
      return false;
    }
  return true;
}

bool check_picture(const Trajectory& rows, Diagnostics& diagnostics, const WrittenColumns& written) {
  std::vector<std::string> with_gaps;
  for (const auto& [name, span] : written) {
    const auto column = rows.column(name);
    const auto gap = column ? row_of_no_number(rows, *column, {}) : std::nullopt;
    std::size_t row = 0;
    while (gap && row < rows.rows() && !std::isfinite(rows.at(row, *column))) ++row;
    if (!gap || row == rows.rows()) continue;
    with_gaps.push_back(name);
    diagnostics.note("N0819", span,
                     fmt::format("{} at {} = {} is no finite number: its curve has a gap", name, rows.independent.name,
                                 brief(rows.times[*gap])),
                     "A formula has no value where it divides by 0 or takes the root of a negative number.",
                     "Draw what stays finite, or begin the run where it is.");
  }
  return check_numbers(rows, diagnostics, with_gaps, {}, written);
}

Trajectory columns_of_numbers(const Trajectory& rows, std::span<const std::string> open) {
  std::vector<std::size_t> kept;
  std::set<std::string> left_out;
  for (std::size_t column = 0; column < rows.columns.size(); ++column)
    if (row_of_no_number(rows, column, open)) left_out.insert(fmt::format("error({})", rows.columns[column].name));
  Trajectory out;
  for (std::size_t column = 0; column < rows.columns.size(); ++column) {
    const std::string& name = rows.columns[column].name;
    if (left_out.count(name) || left_out.count(fmt::format("error({})", name))) continue;
    kept.push_back(column);
    out.columns.push_back(rows.columns[column]);
  }
  out.independent = rows.independent, out.times = rows.times, out.gaps = rows.gaps, out.metadata = rows.metadata;
  for (std::size_t row = 0; row < rows.rows(); ++row)
    for (const std::size_t column : kept) {
      out.values.push_back(rows.at(row, column));
      if (!rows.errors.empty()) out.errors.push_back(rows.error(row, column));
    }
  return out;
}

}  // namespace maupertuis::app
