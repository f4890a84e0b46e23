#include "report/sections.hpp"

#include <maupertuis/require.hpp>

#include <fmt/format.h>

#include <cmath>
#include <iterator>

namespace maupertuis {
namespace {

// Six digits: a thousandth of a pixel in a picture of a thousand.
void append_numbers(std::string& out, const std::vector<double>& numbers, int digits) {
  out += '[';
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (i > 0) out += ',';
    if (std::isfinite(numbers[i])) fmt::format_to(std::back_inserter(out), "{:.{}g}", numbers[i], digits);
    else out += "null";
  }
  out += ']';
}

std::string_view kind_name(Drawing::Kind kind) {
  switch (kind) {
    case Drawing::Kind::Line: return "line";
    case Drawing::Kind::Trail: return "trail";
    case Drawing::Kind::Box: return "box";
    case Drawing::Kind::Circle: return "circle";
    case Drawing::Kind::Spring: return "spring";
    case Drawing::Kind::Reaction: return "reaction";
  }
  return "line";
}

}  // namespace

std::string drawing_json(const Drawing& drawing) {
  std::string out = fmt::format("{{\"dimension\":{},\"dimensionless\":{},\"gravity\":", drawing.dimension, drawing.dimensionless);
  append_numbers(out, drawing.gravity, 6);
  out += ",\"times\":";
  append_numbers(out, drawing.times, 9);
  out += ",\"elements\":[";
  for (std::size_t i = 0; i < drawing.elements.size(); ++i) {
    const auto& element = drawing.elements[i];
    MAUP_REQUIRE(element.positions.size() ==
                 drawing.times.size() * element.points * static_cast<std::size_t>(drawing.dimension));
    out += fmt::format("{}{{\"kind\":\"{}\",\"points\":{},", i ? "," : "", kind_name(element.kind), element.points);
    if (element.kind == Drawing::Kind::Reaction) out += fmt::format("\"name\":\"{}\",", element.names[0]);  // a name holds no quotes
    out += "\"masses\":";
    append_numbers(out, element.masses, 6);
    out += ",\"sizes\":";
    append_numbers(out, element.sizes, 6);
    out += ",\"rotation\":";
    append_numbers(out, element.rotation, 6);
    out += ",\"positions\":";
    append_numbers(out, element.positions, 6);
    out += '}';
  }
  return out + "]}";
}

}  // namespace maupertuis
