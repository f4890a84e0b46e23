#include <maupertuis/diagram.hpp>
#include <maupertuis/field_pictures.hpp>
#include <maupertuis/require.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

/// Runs of fields as pictures.
namespace maupertuis {
namespace {

constexpr std::size_t most_moments = 6;
constexpr double turn_degrees = 180 / 3.14159265358979323846;

/// At most this many values along x and t are drawn: finer ones change nothing that could be seen.
constexpr std::size_t most_across = 500, most_up = 320;

std::vector<std::size_t> thinned(std::size_t count, std::size_t most) {
  std::vector<std::size_t> out;
  const std::size_t shown = std::min(count, most);
  for (std::size_t i = 0; i < shown; ++i) out.push_back(shown == 1 ? 0 : i * (count - 1) / (shown - 1));
  return out;
}

class FieldPainter {
 public:
  FieldPainter(const FieldEquations& equations, const FieldRunResult& run, const FieldPictureOptions& options)
      : s_(equations.system()), run_(run), o_(options), field_(equations.varied[options.field]) {}

  std::string svg() const {
    if (s_.space.size() == 2) return plane();
    return o_.map ? space_time() : curves();
  }

  std::string frame(std::size_t row) const {
    std::vector<double> reached(2);
    bool any = false;
    for (std::size_t r = 0; r < run_.trajectory.rows(); ++r)
      for (const double v : values(r))
        if (std::isfinite(v))
          reached[0] = any ? std::min(reached[0], v) : v, reached[1] = any ? std::max(reached[1], v) : v, any = true;
    if (s_.space.size() == 2) {
      FieldMap map = frame_of_map();
      map.y_name = s_.space[1].name, map.y_unit = unit_of(s_.space[1].dimension);
      map.x = run_.places, map.y = run_.upwards, map.include = reached;
      map.equal_scales = s_.space[0].dimension == s_.space[1].dimension;
      map.sheets.push_back({moment(row), values(row)});
      return field_map_svg(map);
    }
    Diagram out;
    out.title = o_.title, out.theme = o_.theme, out.width = o_.width, out.include_y = reached;
    out.x_name = s_.space.front().name, out.x_unit = unit_of(s_.space.front().dimension);
    out.y_name = value_name(), out.y_unit = value_unit();
    out.curves.push_back({run_.places, values(row), 0, false, false});
    out.legend.push_back({moment(row), 0, false, false});
    return diagram_svg(out);
  }

 private:
  std::string unit_of(const Dimension& d) const {
    const std::string text = to_string(d);
    return o_.dimensionless || text == "1" ? std::string() : text;
  }
  Dimension dimension() const { return s_.dimension_of({field_, std::vector<int>(s_.space.size(), 0), o_.order}); }
  bool in_degrees() const { return o_.degrees && unit_of(dimension()).compare(0, 3, "rad") == 0; }
  std::string value_unit() const {
    const std::string unit = unit_of(dimension());
    return in_degrees() ? "°" + unit.substr(3) : unit;
  }
  std::string value_name() const { return s_.fields[field_].name + (o_.order ? "'" : ""); }
  std::string moment(std::size_t row) const {
    return fmt::format("t = {:.4g}{}", run_.trajectory.times[row], o_.dimensionless ? "" : " s");
  }
  std::vector<double> values(std::size_t row) const {
    std::vector<double> out = field_values(run_, row, o_.field, o_.order);
    if (in_degrees())
      for (double& v : out) v *= turn_degrees;
    return out;
  }

  FieldMap frame_of_map() const {
    FieldMap map;
    map.title = o_.title, map.theme = o_.theme, map.width = o_.width;
    map.x_name = s_.space.front().name, map.x_unit = unit_of(s_.space.front().dimension);
    map.value_name = value_name(), map.value_unit = value_unit();
    return map;
  }

  std::string space_time() const {
    FieldMap map = frame_of_map();
    map.y_name = "t", map.y_unit = o_.dimensionless ? "" : "s";
    const auto across = thinned(run_.places.size(), most_across);
    std::vector<std::size_t> up = thinned(run_.trajectory.rows(), most_up);
    const auto moments = drawn_moments(run_, most_moments);
    up.insert(up.end(), moments.begin(), moments.end());
    std::sort(up.begin(), up.end());
    up.erase(std::unique(up.begin(), up.end()), up.end());
    for (const std::size_t i : across) map.x.push_back(run_.places[i]);
    map.sheets.emplace_back();
    for (const std::size_t row : up) {
      map.y.push_back(run_.trajectory.times[row]);
      const std::vector<double> all = values(row);
      for (const std::size_t i : across) map.sheets.back().values.push_back(all[i]);
    }
    for (const std::size_t row : moments)
      if (o_.curves)
        map.lines.push_back({static_cast<std::size_t>(std::find(up.begin(), up.end(), row) - up.begin()), moment(row)});
    return field_map_svg(map);
  }

  std::string curves() const {
    Diagram out;
    out.title = o_.title, out.theme = o_.theme, out.width = o_.width;
    out.x_name = s_.space.front().name, out.x_unit = unit_of(s_.space.front().dimension);
    out.y_name = value_name(), out.y_unit = value_unit();
    std::size_t series = 0;
    for (const std::size_t row : drawn_moments(run_, most_moments)) {
      Diagram::Curve curve;
      curve.series = series;
      curve.x = run_.places, curve.y = values(row);
      out.curves.push_back(std::move(curve));
      out.legend.push_back({moment(row), series++, false, false});
    }
    return diagram_svg(out);
  }

  std::string plane() const {
    FieldMap map = frame_of_map();
    map.y_name = s_.space[1].name, map.y_unit = unit_of(s_.space[1].dimension);
    map.x = run_.places, map.y = run_.upwards;
    map.equal_scales = s_.space[0].dimension == s_.space[1].dimension;
    for (const std::size_t row : drawn_moments(run_, most_moments)) map.sheets.push_back({moment(row), values(row)});
    return field_map_svg(map);
  }

  const FieldSystem& s_;
  const FieldRunResult& run_;
  const FieldPictureOptions& o_;
  std::size_t field_;
};

}  // namespace

namespace {

std::string shown_unit(const Dimension& d, const FieldPictureOptions& options) {
  const std::string text = to_string(d);
  return options.dimensionless || text == "1" ? std::string() : text;
}

/// The sign of a shape is free: what is largest points upwards.
double upright(const std::vector<double>& values) {
  double largest = 0;
  for (const double v : values)
    if (std::abs(v) > std::abs(largest) * (1 + 1e-9)) largest = v;
  return largest < 0 ? -1 : 1;
}

}  // namespace

std::string field_shape_svg(const FieldEquations& equations, const FieldModes& modes, std::size_t mode,
                            const FieldPictureOptions& options) {
  const FieldSystem& s = equations.system();
  const auto& fields = modes.shapes[mode].fields;
  const auto name_of = [&](std::size_t a) { return s.fields[equations.varied[a]].name; };
  const SpaceVariable& x = s.space.front();
  if (s.space.size() == 2) {
    FieldMap map;
    map.title = options.title, map.theme = options.theme, map.width = options.width;
    map.x_name = x.name, map.x_unit = shown_unit(x.dimension, options);
    map.y_name = s.space[1].name, map.y_unit = shown_unit(s.space[1].dimension, options);
    map.value_name = name_of(options.field);
    map.x = modes.places, map.y = modes.upwards, map.include = {-1, 1};
    map.equal_scales = x.dimension == s.space[1].dimension;
    const double sign = upright(fields[options.field]);
    map.sheets.push_back({"", fields[options.field]});
    for (double& v : map.sheets.back().values) v *= sign;
    return field_map_svg(map);
  }
  Diagram out;
  out.title = options.title, out.theme = options.theme, out.width = options.width, out.zero_line = true;
  out.x_name = x.name, out.x_unit = shown_unit(x.dimension, options), out.include_y = {-1, 1};
  if (fields.size() == 1) out.y_name = name_of(0);
  std::vector<double> all;
  for (const auto& one : fields) all.insert(all.end(), one.begin(), one.end());
  const double sign = upright(all);
  for (std::size_t a = 0; a < fields.size(); ++a) {
    std::vector<double> values = fields[a];
    for (double& v : values) v *= sign;
    out.curves.push_back({modes.places, std::move(values), a, false, false});
    if (fields.size() > 1) out.legend.push_back({name_of(a), a, false, false});
  }
  return diagram_svg(out);
}

std::string field_equilibrium_svg(const FieldEquations& equations, const FieldEquilibrium& rest,
                                  const FieldPictureOptions& options) {
  const FieldSystem& s = equations.system();
  const SpaceVariable& x = s.space.front();
  const Field& field = s.fields[equations.varied[options.field]];
  std::vector<double> values = rest.fields[options.field];
  const bool degrees = options.degrees && to_string(field.dimension) == "rad";
  for (double& v : values) v *= degrees ? turn_degrees : 1;
  const std::string unit = degrees ? "°" : shown_unit(field.dimension, options);
  if (s.space.size() == 2) {
    FieldMap map;
    map.title = options.title, map.theme = options.theme, map.width = options.width;
    map.x_name = x.name, map.x_unit = shown_unit(x.dimension, options);
    map.y_name = s.space[1].name, map.y_unit = shown_unit(s.space[1].dimension, options);
    map.value_name = field.name, map.value_unit = unit;
    map.x = rest.places, map.y = rest.upwards;
    map.equal_scales = x.dimension == s.space[1].dimension;
    map.sheets.push_back({"", std::move(values)});
    return field_map_svg(map);
  }
  Diagram out;
  out.title = options.title, out.theme = options.theme, out.width = options.width;
  out.x_name = x.name, out.x_unit = shown_unit(x.dimension, options);
  out.y_name = field.name, out.y_unit = unit;
  out.curves.push_back({rest.places, std::move(values), 0, false, false});
  return diagram_svg(out);
}

std::vector<double> field_values(const FieldRunResult& run, std::size_t row, std::size_t field, int order) {
  const std::size_t count = run.places.size() * std::max<std::size_t>(run.upwards.size(), 1);
  const std::size_t first = (2 * field + static_cast<std::size_t>(order)) * count;
  std::vector<double> out(count);
  for (std::size_t i = 0; i < count; ++i) out[i] = run.trajectory.at(row, first + i);
  return out;
}

std::vector<std::size_t> drawn_moments(const FieldRunResult& run, std::size_t most) {
  return thinned(run.trajectory.rows(), most);
}

std::string field_frame_svg(const FieldEquations& equations, const FieldRunResult& run,
                            const FieldPictureOptions& options, std::size_t row) {
  MAUP_REQUIRE(row < run.trajectory.rows() && !run.places.empty());
  return FieldPainter(equations, run, options).frame(row);
}

std::string turned_pictures_svg(const std::vector<std::string>& frames, double seconds, bool loop) {
  MAUP_REQUIRE(!frames.empty());
  double width = 0, height = 0;
  if (const std::size_t at = frames.front().find(" width=\""); at != std::string::npos)
    std::sscanf(frames.front().c_str() + at, " width=\"%lf\" height=\"%lf\"", &width, &height);
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 "
      "{0:.0f} {1:.0f}\">\n",
      width, height);
  const double n = static_cast<double>(frames.size());
  for (std::size_t f = 0; f < frames.size(); ++f) {
    const bool last = f + 1 == frames.size();
    std::string times = "0", values = f == 0 ? "visible" : "hidden";
    if (f > 0) times += fmt::format(";{:.6g}", static_cast<double>(f) / n), values += ";visible";
    if (!last) times += fmt::format(";{:.6g}", static_cast<double>(f + 1) / n), values += ";hidden";
    out += fmt::format(
        "<g visibility=\"{}\"><animate attributeName=\"visibility\" calcMode=\"discrete\" dur=\"{:.6g}s\" {} "
        "keyTimes=\"{}\" values=\"{}\"/>\n{}</g>\n",
        f == 0 ? "visible" : "hidden", seconds, loop ? "repeatCount=\"indefinite\"" : "fill=\"freeze\"", times, values,
        frames[f]);
  }
  return out + "</svg>\n";
}

std::string field_picture_svg(const FieldEquations& equations, const FieldRunResult& run,
                              const FieldPictureOptions& options) {
  MAUP_REQUIRE(run.trajectory.rows() > 1 && !run.places.empty());
  return FieldPainter(equations, run, options).svg();
}

}  // namespace maupertuis
