#include <maupertuis/trajectory.hpp>

#include <fmt/format.h>

#include <cmath>
#include <iterator>

namespace maupertuis {
namespace {

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"') result += '"';
    result += c;
  }
  return result + '"';
}

std::string heading(const Trajectory::Column& column) {
  return column.unit.empty() ? column.name : fmt::format("{} [{}]", column.name, column.unit);
}

void append_number(std::string& out, double value) {
  if (std::isfinite(value))
    fmt::format_to(std::back_inserter(out), "{:.17g}", value);
  else
    out += std::isnan(value) ? "nan" : value > 0 ? "inf" : "-inf";
}

}  // namespace

std::string to_csv(const Trajectory& trajectory) {
  std::string out = quoted(heading(trajectory.independent));
  for (const auto& column : trajectory.columns) out += ',' + quoted(heading(column));
  out += "\r\n";
  out.reserve(out.size() + trajectory.rows() * (trajectory.columns.size() + 1) * 22);
  for (std::size_t row = 0; row < trajectory.rows(); ++row) {
    append_number(out, trajectory.times[row]);
    for (std::size_t column = 0; column < trajectory.columns.size(); ++column) {
      out += ',';
      append_number(out, trajectory.at(row, column));
    }
    out += "\r\n";
  }
  return out;
}

}  // namespace maupertuis
