#include "numbers.hpp"

#include "quantity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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

void tell(const std::string& what, Diagnostics& diagnostics) {
  diagnostics.error("E0816", {}, fmt::format("{} is no finite number", what),
                    "A quantity grew beyond the range of numbers, or a formula has no value there.",
                    "Change start, parameters or the length of the run so that it stays within 1e308.");
}

bool may_be_open(const std::string& column, std::span<const std::string> open) {
  return std::find(open.begin(), open.end(), column) != open.end() || column.rfind("reaction(", 0) == 0 ||
         column.rfind("error(", 0) == 0;
}

}  // namespace

bool check_numbers(const Json& document, Diagnostics& diagnostics) {
  const std::string place = place_of_no_number(document);
  if (!place.empty()) tell(fmt::format("the result at {}", place), diagnostics);
  return place.empty();
}

bool check_numbers(const Trajectory& rows, Diagnostics& diagnostics, std::span<const std::string> open) {
  for (std::size_t column = 0; column < rows.columns.size(); ++column) {
    if (may_be_open(rows.columns[column].name, open)) continue;
    for (std::size_t row = 0; row < rows.rows(); ++row)
      if (!std::isfinite(rows.at(row, column))) {
        tell(fmt::format("{} at {} = {}", rows.columns[column].name, rows.independent.name, brief(rows.times[row])),
             diagnostics);
        return false;
      }
  }
  return true;
}

}  // namespace maupertuis::app
