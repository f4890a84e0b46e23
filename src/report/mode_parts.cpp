#include "report/mode_parts.hpp"

#include "report/notation.hpp"

#include <maupertuis/mode_pictures.hpp>
#include <maupertuis/print.hpp>
#include <maupertuis/symbolic_linearization.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace maupertuis {
namespace {

using Formula = ReportContent::Formula;
constexpr std::size_t most_points = 4, most_shapes = 6, widest_matrix = 5, frames_of_a_mode = 60;
constexpr double turn = 6.283185307179586;

// ----------------------------------------------------------------------------------------------------------------
// formulas

Layout number_layout(double x) {
  Layout out = layouts::number(short_number(std::abs(x), 4));
  out.negative = x < 0;
  return out;
}

template <class Entry>
Layout matrix_layout(std::size_t rows, std::size_t columns, Entry&& entry) {
  std::vector<Layout> entries;
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t j = 0; j < columns; ++j) entries.push_back(entry(i, j));
  return layouts::matrix(std::move(entries), columns);
}

/// M ξ̈, C ξ̇, K ξ
Layout term(const char* matrix, int dots) {
  return layouts::product({layouts::bold(matrix), layouts::name("ξ", dots)});
}

struct Shown {
  bool velocity = false, position = false;
  std::array<bool, 3> inputs = {};  // u, u', u''
};

/// B, B₁, B₂
Layout input_name(std::size_t rate) {
  return rate == 0 ? layouts::bold("B")
                   : layouts::indexed(layouts::bold("B"), {layouts::number(rate == 1 ? "1" : "2")});
}

Layout sum_of(std::vector<Layout> terms) { return terms.size() == 1 ? terms.front() : layouts::sum(std::move(terms)); }

Formula balance(const Shown& shown) {
  std::vector<Layout> terms{term("M", 2)};
  if (shown.velocity) terms.push_back(term("C", 1));
  if (shown.position) terms.push_back(term("K", 0));
  std::vector<Layout> right;
  for (std::size_t i = 0; i < 3; ++i)
    if (shown.inputs[i]) right.push_back(layouts::product({input_name(i), layouts::name("u", static_cast<int>(i))}));
  if (right.empty()) right.push_back(layouts::number("0"));
  return {sum_of(std::move(terms)), sum_of(std::move(right)), "", ""};
}

bool any(const RealMatrix& m) {
  return std::any_of(m.entries.begin(), m.entries.end(), [](double x) { return x != 0; });
}
bool any(const ExprMatrix& m) {
  return std::any_of(m.entries.begin(), m.entries.end(), [](const Expr& e) { return !e.is_zero(); });
}

std::vector<Formula> formulas_of(const SymbolicLinearization& s, const ReadingOrder& order) {
  std::vector<Formula> out;
  for (const auto& [left, right] : s.equilibrium) out.push_back({lay_out(left, order), lay_out(right, order), "", ""});
  const Shown shown{any(s.damping), any(s.stiffness), {any(s.input), any(s.input_rate), any(s.input_acceleration)}};
  out.push_back(balance(shown));
  const std::tuple<Layout, const ExprMatrix*, bool> all[] = {{layouts::bold("M"), &s.mass, true},
                                                             {layouts::bold("C"), &s.damping, shown.velocity},
                                                             {layouts::bold("K"), &s.stiffness, shown.position},
                                                             {input_name(0), &s.input, shown.inputs[0]},
                                                             {input_name(1), &s.input_rate, shown.inputs[1]},
                                                             {input_name(2), &s.input_acceleration, shown.inputs[2]}};
  for (const auto& [name, matrix, is_shown] : all)
    if (is_shown)
      out.push_back(
          {name,
           matrix_layout(matrix->rows, matrix->columns,
                         [&, m = matrix](std::size_t i, std::size_t j) { return lay_out(m->at(i, j), order); }),
           "", ""});
  if (s.square)
    out.push_back({layouts::power(layouts::name("ω"), layouts::number("2")), lay_out(s.square, order), "", ""});
  return out;
}

RealMatrix sum(RealMatrix a, const RealMatrix& b) {
  for (std::size_t i = 0; i < a.entries.size(); ++i) a.entries[i] += b.entries[i];
  return a;
}

std::vector<Formula> formulas_of(const Linearization& l) {
  if (!l.second_order() || l.independent.size() > widest_matrix || l.independent.empty()) return {};
  const RealMatrix c = sum(l.damping, l.gyroscopic), k = sum(l.stiffness, l.circulatory);
  const Shown shown{any(c), any(k), {any(l.input), any(l.input_rate), any(l.input_acceleration)}};
  std::vector<Formula> out{balance(shown)};
  const std::tuple<Layout, const RealMatrix*, bool> all[] = {{layouts::bold("M"), &l.mass, true},
                                                             {layouts::bold("C"), &c, shown.velocity},
                                                             {layouts::bold("K"), &k, shown.position},
                                                             {input_name(0), &l.input, shown.inputs[0]},
                                                             {input_name(1), &l.input_rate, shown.inputs[1]},
                                                             {input_name(2), &l.input_acceleration, shown.inputs[2]}};
  for (const auto& [name, matrix, is_shown] : all)
    if (is_shown)
      out.push_back({name,
                     matrix_layout(matrix->rows, matrix->columns,
                                   [m = matrix](std::size_t i, std::size_t j) { return number_layout(m->at(i, j)); }),
                     "", ""});
  return out;
}

// ------------------------------------------------------------------------------------------------------------------
// modes

ReportContent::ModeRow row_of(const MechanicalSystem& system, const Mode& m) {
  const std::string rate = system.dimensionless ? "" : "rad/s", hertz = system.dimensionless ? "" : "Hz",
                    second = system.dimensionless ? "" : "s";
  const std::string fold = m.multiplicity > 1 && m.kind != Mode::Kind::Zero
                               ? fmt::format(", {}-fold{}", m.multiplicity, m.chain > 1 ? ", defective" : "")
                               : "";
  switch (m.kind) {
    case Mode::Kind::Zero:
      return {m.cause.empty() ? "zero mode" : "zero mode: " + m.cause, "0", "0", "", ""};
    case Mode::Kind::Decay:
      return {"decay" + fold, "", "", "", "rate " + quantity(m.eigenvalue.real(), system.dimensionless ? "" : "1/s")};
    case Mode::Kind::Growth:
      return {"growth" + fold, "", "", "", "rate " + quantity(m.eigenvalue.real(), system.dimensionless ? "" : "1/s")};
    case Mode::Kind::Oscillation:
      break;
  }
  return {"oscillation" + fold, quantity(m.frequency(), rate, 7), quantity(m.frequency() / turn, hertz, 7),
          quantity(turn / m.frequency(), second, 5),
          m.eigenvalue.real() == 0 ? "" : "ζ = " + short_number(m.damping_ratio(), 4)};
}

std::string with_minus_signs(std::string text) {
  for (std::size_t at = 0; (at = text.find("= -", at)) != std::string::npos; ++at) text.replace(at, 3, "= −");
  return text;
}

/// One period of q₀ + a Re(φ e^{iωt}).
Trajectory swing(const MechanicalSystem& system, const OperatingPoint& point, const Mode& mode, double amplitude) {
  Trajectory run;
  for (const Coordinate& c : system.coordinates) run.columns.push_back({c.name, ""});
  for (const Coordinate& c : system.coordinates) run.columns.push_back({c.name + "'", ""});
  const double w = mode.frequency();
  for (std::size_t f = 0; f <= frames_of_a_mode; ++f) {
    const double t = turn / w * static_cast<double>(f) / static_cast<double>(frames_of_a_mode);
    run.times.push_back(t);
    const std::complex<double> phase = std::polar(amplitude, w * t), rate = phase * std::complex<double>(0, w);
    for (std::size_t i = 0; i < point.q.size(); ++i) run.values.push_back(point.q[i] + (mode.shape[i] * phase).real());
    for (std::size_t i = 0; i < point.q.size(); ++i) run.values.push_back((mode.shape[i] * rate).real());
  }
  return run;
}

/// One period of the deviations alone, each a bead on a stem above its place in a row: for systems that have no
/// drawing, and about motions.
Drawing beads_of(const MechanicalSystem& system, const Mode& mode) {
  constexpr double bead = 0.07, label_at = -1.55;
  Drawing out;
  out.dimensionless = true;
  double largest = 0;
  for (const auto& x : mode.shape) largest = std::max(largest, std::abs(x));
  for (std::size_t f = 0; f <= frames_of_a_mode; ++f)
    out.times.push_back(turn / mode.frequency() * static_cast<double>(f) / static_cast<double>(frames_of_a_mode));
  const auto n = static_cast<double>(mode.shape.size());
  Drawing::Element line;
  line.points = 2;
  line.still = true;
  line.positions = {-0.5, 0, n - 0.5, 0};
  line.masses = line.radii = {0, 0};
  line.names = {"", ""};
  out.elements.push_back(line);
  for (std::size_t i = 0; i < mode.shape.size(); ++i) {
    const auto x = static_cast<double>(i);
    Drawing::Element stem = line, label;
    stem.still = false;
    stem.positions.clear();
    stem.masses = {0, 1};
    stem.radii = {0, bead};
    for (const double t : out.times) {
      const double y = largest > 0 ? (mode.shape[i] / largest * std::polar(1.0, mode.frequency() * t)).real() : 0;
      stem.positions.insert(stem.positions.end(), {x, 0, x, y});
    }
    out.elements.push_back(std::move(stem));
    label.kind = Drawing::Kind::Label;
    label.still = true;
    label.positions = {x - bead, label_at};
    label.text = name_parts(system.coordinates[i].name);
    out.elements.push_back(std::move(label));
  }
  out.low = {-0.5, label_at};
  out.high = {n - 0.5, 1 + bead};
  out.radius = std::hypot(n, out.high[1] - out.low[1]) / 2;
  return out;
}

/// As many frames as a mode needs: drawings of runs are finer.
Drawing thinned(const Drawing& d) {
  Drawing out = d;
  const std::size_t stride = std::max<std::size_t>(1, (d.times.size() - 1) / frames_of_a_mode);
  const auto keep = [&](const std::vector<double>& list, std::size_t width) {
    std::vector<double> kept;
    for (std::size_t f = 0; f < d.times.size() && width > 0; f += stride)
      kept.insert(kept.end(), list.begin() + static_cast<std::ptrdiff_t>(f * width),
                  list.begin() + static_cast<std::ptrdiff_t>((f + 1) * width));
    return kept;
  };
  out.times = keep(d.times, 1);
  out.follow = keep(d.follow, d.follow.size() / d.times.size());
  for (Drawing::Element& e : out.elements)
    if (!e.still) e.positions = keep(e.positions, e.positions.size() / d.times.size());
  return out;
}

/// The size of a drawing, and how far its points go from where they begin.
std::pair<double, double> extent_and_motion(const Drawing& d) {
  const auto dimension = static_cast<std::size_t>(d.dimension);
  std::vector<double> low(dimension, HUGE_VAL), high(dimension, -HUGE_VAL);
  double motion = 0;
  for (const Drawing::Element& e : d.elements) {
    if (e.still) continue;
    const std::size_t width = e.points * dimension;
    for (std::size_t i = 0; i < e.positions.size(); ++i) {
      if (!std::isfinite(e.positions[i])) continue;
      low[i % dimension] = std::min(low[i % dimension], e.positions[i]);
      high[i % dimension] = std::max(high[i % dimension], e.positions[i]);
      if (i >= width) motion = std::max(motion, std::abs(e.positions[i] - e.positions[i % width]));
    }
  }
  double extent = 0;
  for (std::size_t k = 0; k < dimension; ++k) extent = std::max(extent, high[k] - low[k]);
  return {extent, motion};
}

/// With an amplitude that shows: the largest excursion a seventh of the drawing, angles at most half a radian.
std::optional<Drawing> drawing_of(const Model& model, const OperatingPoint& point, const Mode& mode) {
  const MechanicalSystem& system = model.system;
  double largest_angle = 0, largest = 0;
  for (std::size_t i = 0; i < mode.shape.size(); ++i) {
    largest = std::max(largest, std::abs(mode.shape[i]));
    if (system.coordinates[i].kind == "angle") largest_angle = std::max(largest_angle, std::abs(mode.shape[i]));
  }
  if (largest == 0) return std::nullopt;
  const double trial = largest_angle > 0 ? 1e-3 / largest_angle : 1e-3 / largest;
  const auto small = evaluate_drawing(model, swing(system, point, mode, trial));
  if (!small) return std::nullopt;
  const auto [extent, motion] = extent_and_motion(*small);
  if (!(motion > 0) || !(extent > 0)) return std::nullopt;
  double amplitude = trial * 2 * (extent > 2 * motion ? extent / 7 : 0.1) / motion;
  if (largest_angle > 0) amplitude = std::min(amplitude, 0.5 / largest_angle);
  const auto drawing = evaluate_drawing(model, swing(system, point, mode, amplitude));
  return drawing ? std::optional(thinned(*drawing)) : std::nullopt;
}

void add_shapes(ReportContent::ModePoint& out, const Model& model, const ModalEntry& entry) {
  for (std::size_t k = 0; k < entry.analysis.modes.size() && out.shapes.size() < most_shapes; ++k) {
    const Mode& m = entry.analysis.modes[k];
    if (m.kind != Mode::Kind::Oscillation) continue;
    ReportContent::ModeShape shape{fmt::format("Mode {}: ω = {}", k + 1, out.rows[k].frequency), std::nullopt,
                                   std::nullopt};
    if (entry.equilibrium.at_rest) shape.drawing = drawing_of(model, entry.equilibrium.point, m);
    if (!shape.drawing) {
      shape.diagram = shape_diagram(model.system, m);
      shape.beads = beads_of(model.system, m);
    }
    out.shapes.push_back(std::move(shape));
  }
}

}  // namespace

void add_modes(ReportContent& content, const Model& model, const EquationsOfMotion& equations,
               const ModalStudy& study) {
  const MechanicalSystem& system = model.system;
  content.mode_search =
      fmt::format("Found by Newton's method from {} points; nothing says that there are no others.", study.starts);
  for (std::size_t p = 0; p < study.entries.size() && p < most_points; ++p) {
    const ModalEntry& entry = study.entries[p];
    const StabilityReport& s = entry.analysis.stability;
    ReportContent::ModePoint point;
    point.name = with_minus_signs(point_text(system, entry.equilibrium, study.translations)) +
                 (entry.side.empty() ? "" : ", on the side " + with_minus_signs(entry.side));
    point.stability = fmt::format("{}: {}", stability_word(s.verdict), s.reason);
    point.stable = s.verdict != Stability::Unstable && s.verdict != Stability::Undecided;
    if (!entry.analysis.modes.empty()) {  // frozen coefficients of a driven system are not shown
      const auto symbolic = entry.side.empty()
                                ? symbolic_linearization(equations, entry.linearization, study.translations)
                                : std::nullopt;
      point.formulas = symbolic ? formulas_of(*symbolic, equations.order) : formulas_of(entry.linearization);
    }
    for (const Mode& m : entry.analysis.modes) point.rows.push_back(row_of(system, m));
    if (p == 0 || point.stable) add_shapes(point, model, entry);  // the others are left at the slightest push
    content.mode_points.push_back(std::move(point));
  }
}

void add_loci(ReportContent& content, const MechanicalSystem& system, const Locus& locus) {
  const std::string& name = system.parameters[locus.parameter].name;
  for (Diagram& d : bifurcation_diagrams(system, locus, 2)) {
    d.width = 440;
    std::string caption = fmt::format("Equilibria against {}.", name);
    content.loci.push_back({std::move(caption), std::move(d)});
  }
  Diagram roots = root_locus(system, locus);
  roots.width = 440;
  content.loci.push_back({fmt::format("The eigenvalues as {} changes.", name), std::move(roots)});
}

}  // namespace maupertuis
