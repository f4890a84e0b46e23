#include <maupertuis/trajectory.hpp>

#include <fmt/format.h>

#include <cmath>
#include <iterator>

namespace maupertuis {
namespace {

// A JSON string; the bytes of UTF-8 pass as they are.
std::string json_string(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      (result += '\\') += c;
    else if (c == '\n')
      result += "\\n";
    else if (static_cast<unsigned char>(c) < 0x20)
      result += fmt::format("\\u{:04x}", static_cast<int>(c));
    else
      result += c;
  }
  return result + '"';
}

void append_json_number(std::string& out, double value) {
  if (!std::isfinite(value))
    out += "null";
  else if (value == 0)
    out += std::signbit(value) ? "-0.0" : "0";  // "-0" would be read as the integer 0
  else
    fmt::format_to(std::back_inserter(out), "{:.17g}", value);
}

}  // namespace

std::string to_json(const Trajectory& trajectory) {
  std::string out = "{\"schema\": \"maupertuis-trajectory-1\",\n\"metadata\": {";
  const char* separator = "";
  for (const auto& [key, value] : trajectory.metadata) {
    out += fmt::format("{}{}: {}", separator, json_string(key), json_string(value));
    separator = ", ";
  }
  const auto column_text = [](const Trajectory::Column& c) {
    return fmt::format("{{\"name\": {}, \"unit\": {}}}", json_string(c.name), json_string(c.unit));
  };
  out += "},\n\"columns\": [" + column_text(trajectory.independent);
  for (const auto& column : trajectory.columns) out += ", " + column_text(column);
  out += "],\n\"rows\": [";
  for (std::size_t row = 0; row < trajectory.rows(); ++row) {
    out += row == 0 ? "\n[" : ",\n[";
    append_json_number(out, trajectory.times[row]);
    for (std::size_t column = 0; column < trajectory.columns.size(); ++column) {
      out += ", ";
      append_json_number(out, trajectory.at(row, column));
    }
    out += ']';
  }
  return out + "]}\n";
}

}  // namespace maupertuis
