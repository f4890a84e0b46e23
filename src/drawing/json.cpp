#include <maupertuis/drawing.hpp>
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
    if (std::isfinite(numbers[i]))
      fmt::format_to(std::back_inserter(out), "{:.{}g}", numbers[i], digits);
    else
      out += "null";
  }
  out += ']';
}

std::string_view kind_name(Drawing::Kind kind) {
  switch (kind) {
    case Drawing::Kind::Path:
      return "path";
    case Drawing::Kind::Trail:
      return "trail";
    case Drawing::Kind::Solid:
      return "solid";
    case Drawing::Kind::Arrow:
      return "arrow";
    case Drawing::Kind::Label:
      return "label";
  }
  return "path";
}

std::string_view origin_name(Drawing::ForceOrigin origin) {
  switch (origin) {
    case Drawing::ForceOrigin::Asked:
      return "asked";
    case Drawing::ForceOrigin::Reaction:
      return "reaction";
    case Drawing::ForceOrigin::Weight:
      return "weight";
    case Drawing::ForceOrigin::Spring:
      return "spring";
    case Drawing::ForceOrigin::Damper:
      return "damper";
    case Drawing::ForceOrigin::Applied:
      return "applied";
    case Drawing::ForceOrigin::Potential:
      return "potential";
    case Drawing::ForceOrigin::Torque:
      return "torque";
  }
  return "asked";
}

/// In a <script> of a page: neither quotes nor the end of the script.
std::string quoted(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\' || c == '<' || static_cast<unsigned char>(c) < 0x20)
      out += fmt::format("\\u{:04x}", static_cast<unsigned char>(c));
    else
      out += c;
  }
  return out + '"';
}

void append_outlines(std::string& out, const char* name, const std::vector<SolidShape::Outline>& outlines) {
  out += fmt::format(",\"{}\":[", name);
  for (std::size_t i = 0; i < outlines.size(); ++i) {
    out += fmt::format("{}{{\"closed\":{},\"points\":", i ? "," : "", outlines[i].closed);
    append_numbers(out, outlines[i].points, 5);
    out += '}';
  }
  out += ']';
}

void append_element(std::string& out, const Drawing::Element& e) {
  out += fmt::format("{{\"kind\":\"{}\",\"points\":{},\"still\":{}", kind_name(e.kind), e.points, e.still);
  if (e.kind == Drawing::Kind::Path) {
    out += ",\"bobs\":[";
    for (std::size_t p = 0; p < e.masses.size(); ++p) out += fmt::format("{}{}", p ? "," : "", e.masses[p] > 0);
    out += "],\"radii\":";
    append_numbers(out, e.radii, 6);
  }
  if (e.kind == Drawing::Kind::Arrow || e.kind == Drawing::Kind::Label)
    out += fmt::format(",\"text\":{{\"base\":{},\"index\":{},\"dots\":{},\"upright\":{}}}", quoted(e.text.base),
                       quoted(e.text.index), e.text.dots, e.text.upright);
  if (e.impulse) out += ",\"impulse\":true";
  if (e.origin != Drawing::ForceOrigin::Asked)
    out +=
        fmt::format(",\"origin\":\"{}\",\"name\":{}", origin_name(e.origin), quoted(e.names.empty() ? "" : e.names[0]));
  if (e.kind == Drawing::Kind::Solid) {
    out += fmt::format(",\"ground\":{},\"convex\":{},\"ball\":{}", e.shape.role == SolidShape::Role::Ground,
                       e.shape.convex, e.shape.ball);
    append_outlines(out, "faces", e.shape.faces);
    append_outlines(out, "lines", e.shape.lines);
  }
  out += ",\"positions\":";
  append_numbers(out, e.positions, 6);
  out += '}';
}

}  // namespace

std::string drawing_json(const Drawing& drawing) {
  std::string out = fmt::format(
      "{{\"dimension\":{},\"dimensionless\":{},\"momentsOnly\":{},\"radius\":{:.6g},\"gravity\":", drawing.dimension,
      drawing.dimensionless, drawing.moments_only, drawing.radius);
  append_numbers(out, drawing.gravity, 6);
  for (const auto& [name, list, digits] : {std::tuple{"low", &drawing.low, 6},
                                           {"high", &drawing.high, 6},
                                           {"follow", &drawing.follow, 6},
                                           {"times", &drawing.times, 9}}) {
    out += fmt::format(",\"{}\":", name);
    append_numbers(out, *list, digits);
  }
  if (drawing.metres_a_newton > 0) out += fmt::format(",\"metresANewton\":{:.6g}", drawing.metres_a_newton);
  if (drawing.largest_torque > 0) out += fmt::format(",\"largestTorque\":{:.6g}", drawing.largest_torque);
  if (!drawing.unplaced_forces.empty()) {
    out += ",\"unplacedForces\":[";
    for (const std::string& name : drawing.unplaced_forces)
      out += (&name == &drawing.unplaced_forces.front() ? "" : ",") + quoted(name);
    out += ']';
  }
  out += ",\"elements\":[";
  for (std::size_t i = 0; i < drawing.elements.size(); ++i) {
    const Drawing::Element& e = drawing.elements[i];
    MAUP_REQUIRE(e.positions.size() ==
                 (e.still ? 1 : drawing.times.size()) * e.points * static_cast<std::size_t>(drawing.dimension));
    if (i) out += ',';
    append_element(out, e);
  }
  return out + "]}";
}

}  // namespace maupertuis
