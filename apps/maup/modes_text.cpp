#include "modes_text.hpp"

#include "mirrored.hpp"
#include "orbits_text.hpp"
#include "quantity.hpp"

#include <fmt/format.h>

#include <maupertuis/print.hpp>
#include <maupertuis/uncertainty.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace maupertuis::app {
namespace {

using Complex = std::complex<double>;
constexpr std::size_t widest_matrix = 8, most_shapes = 8;
constexpr double turn = 6.283185307179586;

/// Letters beyond ASCII count as one column.
std::size_t columns(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}
std::string padded_left(const std::string& text, std::size_t width) {
  return std::string(width - std::min(width, columns(text)), ' ') + text;
}
std::string padded(const std::string& text, std::size_t width) {
  return text + std::string(width - std::min(width, columns(text)), ' ');
}

/// Lines of cells: the first line is the head, numbers at the right.
std::string table(const std::vector<std::vector<std::string>>& rows, std::size_t left_aligned) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (i >= widths.size()) widths.push_back(0);
      widths[i] = std::max(widths[i], columns(row[i]));
    }
  std::string out;
  for (const auto& row : rows) {
    std::string line = " ";
    for (std::size_t i = 0; i < row.size(); ++i)
      line += " " + (i < left_aligned ? padded(row[i], widths[i]) : padded_left(row[i], widths[i])) + " ";
    line.erase(line.find_last_not_of(' ') + 1);
    out += line + "\n";
  }
  return out;
}

std::string number(double x) { return fmt::format("{:.6g}", x == 0 ? 0.0 : x); }

std::string complex_number(Complex z) {
  if (z.imag() == 0) return number(z.real());
  if (z.real() == 0) return number(z.imag()) + "i";
  return fmt::format("{}{}{}i", number(z.real()), z.imag() < 0 ? "-" : "+", number(std::abs(z.imag())));
}

using Cells = std::vector<std::vector<std::string>>;

/// "NAME = ⎡ … ⎤" over its rows.
std::string brackets(const std::string& name, const Cells& cells) {
  std::vector<std::size_t> widths(cells.empty() ? 0 : cells[0].size(), 0);
  for (const auto& row : cells)
    for (std::size_t j = 0; j < row.size(); ++j) widths[j] = std::max(widths[j], columns(row[j]));
  std::string out;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const bool one = cells.size() == 1, first = i == 0, last = i + 1 == cells.size();
    std::string line = fmt::format("  {} ", padded(i == (cells.size() - 1) / 2 ? name + " =" : "", columns(name) + 2));
    line += one ? "[" : first ? "⎡" : last ? "⎣" : "⎢";
    for (std::size_t j = 0; j < cells[i].size(); ++j) line += " " + padded_left(cells[i][j], widths[j]) + " ";
    out += line + (one ? "]" : first ? "⎤" : last ? "⎦" : "⎥") + "\n";
  }
  return out;
}

std::string matrix_text(const std::string& name, const RealMatrix& m) {
  Cells cells(m.rows);
  for (std::size_t i = 0; i < m.rows; ++i)
    for (std::size_t j = 0; j < m.columns; ++j) cells[i].push_back(number(m.at(i, j)));
  return brackets(name, cells);
}

std::string matrix_text(const std::string& name, const ExprMatrix& m, const ReadingOrder& order) {
  Cells cells(m.rows);
  for (std::size_t i = 0; i < m.rows; ++i)
    for (std::size_t j = 0; j < m.columns; ++j) cells[i].push_back(to_plain(m.at(i, j), order));
  return brackets(name, cells);
}

std::string kind_text(const Mode& m) {
  switch (m.kind) {
    case Mode::Kind::Zero:
      return m.cause.empty() ? "zero" : m.cause;
    case Mode::Kind::Oscillation:
      return std::abs(m.eigenvalue.real()) <= m.error ? "oscillation"  // or growing, or damped: rounding hides it
             : m.eigenvalue.real() > 0                ? "growing oscillation"
                                                      : "damped oscillation";
    case Mode::Kind::Decay:
      return "decay";
    case Mode::Kind::Growth:
      return "growth";
  }
  return "";
}

/// Of a Jordan chain neighbours move as t e^{λt}.
std::string fold_text(const Mode& m) {
  return (m.multiplicity > 1 ? fmt::format(", {}-fold", m.multiplicity) : "") + (m.chain > 1 ? ", defective" : "");
}

/// δσ of a mode ξ e^{λ t}: from its positions and from its velocities λ ξ.
std::vector<Complex> rates_of(const Mode& m, const ModalEntry& entry) {
  std::vector<Complex> states;
  for (const std::size_t i : entry.linearization.independent) states.push_back(m.shape[i]);
  for (const std::size_t i : entry.linearization.independent_velocities) states.push_back(m.eigenvalue * m.shape[i]);
  const RealMatrix& of_states = entry.in_rates->of_states;
  double largest = 0;
  for (const Complex& x : states) largest = std::max(largest, std::abs(x));
  std::vector<Complex> out(of_states.rows);
  for (std::size_t k = 0; k < out.size(); ++k) {
    for (std::size_t j = 0; j < states.size(); ++j) out[k] += of_states.at(k, j) * states[j];
    constexpr double rounding = 1e-14;
    if (std::abs(out[k].real()) <= rounding * largest) out[k].real(0);
    if (std::abs(out[k].imag()) <= rounding * largest) out[k].imag(0);
  }
  return out;
}

/// As many digits as rounding leaves beside the other eigenvalues, at most nine.
std::string certain_digits(double value, double error) {
  constexpr double nine_digits = 5e-10;
  return error > nine_digits * std::abs(value) ? with_uncertainty(value, error) : fmt::format("{:.9g}", value);
}

std::string modes_table(const MechanicalSystem& system, const ModalEntry& entry) {
  const ModalAnalysis& analysis = entry.analysis;
  const bool damped =
      std::any_of(analysis.modes.begin(), analysis.modes.end(), [](const Mode& m) { return m.eigenvalue.real() != 0; });
  const bool shapes = system.coordinates.size() <= most_shapes;
  std::vector<std::string> head{"", "", system.dimensionless ? "ω" : "ω (rad/s)",
                                system.dimensionless ? "f" : "f (Hz)"};
  if (damped) head.insert(head.end(), {system.dimensionless ? "Re λ" : "Re λ (1/s)", "ζ"});
  if (shapes)
    for (const Coordinate& c : system.coordinates) head.push_back(c.name);
  if (shapes && entry.in_rates)
    for (const Rate& rate : system.rates) head.push_back(rate.name);
  std::vector<std::vector<std::string>> rows{head};
  for (std::size_t i = 0; i < analysis.modes.size(); ++i) {
    const Mode& m = analysis.modes[i];
    const bool oscillates = m.kind == Mode::Kind::Oscillation;
    std::vector<std::string> row{fmt::format("{}", i + 1), kind_text(m) + fold_text(m),
                                 oscillates                   ? certain_digits(m.frequency(), m.error)
                                 : m.kind == Mode::Kind::Zero ? "0"
                                                              : "",
                                 oscillates ? certain_digits(m.frequency() / turn, m.error / turn) : ""};
    if (damped)
      row.insert(row.end(), {number(m.eigenvalue.real()),
                             oscillates && m.eigenvalue.real() != 0 ? fmt::format("{:.4g}", m.damping_ratio()) : ""});
    if (shapes)
      for (const Complex& x : m.shape) row.push_back(complex_number(x));
    if (shapes && entry.in_rates)
      for (const Complex& x : rates_of(m, entry)) row.push_back(complex_number(x));
    rows.push_back(std::move(row));
  }
  return table(rows, 2);
}

std::string listed(const MechanicalSystem& system, const std::vector<std::size_t>& coordinates, const char* primes) {
  std::string out;
  for (const std::size_t i : coordinates) out += (out.empty() ? "" : ", ") + system.coordinates[i].name + primes;
  return out;
}

bool vanishes(const RealMatrix& m) {
  return std::all_of(m.entries.begin(), m.entries.end(), [](double x) { return x == 0; });
}

/// The parts of x: coordinates, then velocities, of which a Lagrangian of the first order has none.
std::string state_listed(const MechanicalSystem& system, const Linearization& l, const char* between) {
  const std::string q = listed(system, l.independent, ""), v = listed(system, l.independent_velocities, "'");
  return q + (q.empty() || v.empty() ? "" : between) + v;
}

bool vanishes(const ExprMatrix& m) {
  return std::all_of(m.entries.begin(), m.entries.end(), [](const Expr& e) { return e.is_zero(); });
}

constexpr const char* indices[] = {"", "₁", "₂"};

/// What u, u' and u'' bring: "B u + B₁ u'", without what vanishes.
template <class Matrix>
std::string inputs_text(const std::string& name, const std::array<const Matrix*, 3>& by_rates) {
  std::string out;
  for (std::size_t i = 0; i < 3; ++i)
    if (!vanishes(*by_rates[i])) out += (out.empty() ? "" : " + ") + name + indices[i] + " u" + std::string(i, '\'');
  return out;
}

template <class Matrix, class... Order>
std::string input_matrices_text(const std::string& name, const std::array<const Matrix*, 3>& by_rates,
                                const Order&... order) {
  std::string out;
  for (std::size_t i = 0; i < 3; ++i)
    if (!vanishes(*by_rates[i])) out += matrix_text(name + indices[i], *by_rates[i], order...);
  return out;
}

std::string or_zero(const std::string& sum) { return sum.empty() ? "0" : sum; }
std::string added(const std::string& sum) { return sum.empty() ? "" : " + " + sum; }

/// "z' = A z,  z = (x, y; v, w)": the independent positions and the rates of the model.
std::string in_rates_text(const MechanicalSystem& system, const LinearizationInRates& r) {
  if (r.a.rows > widest_matrix) return "";
  std::string states = listed(system, r.positions, "");
  for (const Rate& rate : system.rates) states += (states.empty() ? "" : ", ") + rate.name;
  const std::array by_rates{&r.b, &r.b_rate, &r.b_acceleration};
  return fmt::format("  z' = A z{},  z = ({})\n", added(inputs_text("B", by_rates)), states) + matrix_text("A", r.a) +
         input_matrices_text("B", by_rates);
}

std::string matrices_text(const MechanicalSystem& system, const Linearization& l,
                          const std::optional<LinearizationInRates>& rates) {
  std::string out;
  if (l.independent.empty() && l.independent_velocities.empty()) return "  independent: none\n";
  if (l.independent.size() < system.coordinates.size())
    out +=
        fmt::format("  independent: {}\n", l.independent == l.independent_velocities ? listed(system, l.independent, "")
                                                                                     : state_listed(system, l, "; "));
  if (l.second_order() && l.independent.size() <= widest_matrix) {
    const std::pair<const char*, const RealMatrix*> all[] = {
        {"M", &l.mass}, {"C", &l.damping}, {"G", &l.gyroscopic}, {"K", &l.stiffness}, {"N", &l.circulatory}};
    const std::array by_rates{&l.input, &l.input_rate, &l.input_acceleration};
    std::string sum = "M ξ''";
    const bool c = !vanishes(l.damping), g = !vanishes(l.gyroscopic), k = !vanishes(l.stiffness),
               n = !vanishes(l.circulatory);
    if (c || g) sum += fmt::format(" + {} ξ'", c && g ? "(C + G)" : c ? "C" : "G");
    if (k || n) sum += fmt::format(" + {} ξ", k && n ? "(K + N)" : k ? "K" : "N");
    out += fmt::format("  {} = {}\n", sum, or_zero(inputs_text("B", by_rates)));
    for (const auto& [name, matrix] : all)
      if (!vanishes(*matrix)) out += matrix_text(name, *matrix);
    out += input_matrices_text("B", by_rates);
    if (rates) out += in_rates_text(system, *rates);
  } else if (rates) {
    out += in_rates_text(system, *rates);
  } else if (l.a.rows <= widest_matrix) {
    const std::array by_rates{&l.b, &l.b_rate, &l.b_acceleration};
    out += fmt::format("  x' = A x{},  x = ({})\n", added(inputs_text("B", by_rates)), state_listed(system, l, ", "));
    out += matrix_text("A", l.a) + input_matrices_text("B", by_rates);
  }
  return out;
}

/// y = y0 + C x + D u over the outputs that were asked for.
std::string measured_text(const MechanicalSystem& system, const Linearization& l,
                          const std::vector<std::string>& outputs) {
  if (outputs.empty()) return "";
  const MeasuredOutputs& y = l.measured;
  const std::array by_rates{&y.d, &y.d_rate, &y.d_acceleration};
  std::string out = fmt::format("  y = y0 + C x{} (SI),  x = ({})\n", added(inputs_text("D", by_rates)),
                                state_listed(system, l, ", "));
  for (std::size_t i = 0; i < outputs.size(); ++i)
    out += fmt::format("  y{} = {},  y0 = {}\n", outputs.size() == 1 ? "" : fmt::format("{}", i + 1), outputs[i],
                       number(y.values[i]));
  return out + matrix_text("C", y.c) + input_matrices_text("D", by_rates);
}

/// Formulas instead of numbers where they fit a line.
std::optional<std::string> formulas_text(const SymbolicLinearization& s, const ReadingOrder& order) {
  std::string out;
  for (const auto& [left, right] : s.equilibrium)
    out += fmt::format("  {} = {}\n", to_plain(left, order), to_plain(right.value, order));
  const bool c = !vanishes(s.damping), k = !vanishes(s.stiffness);
  const std::array by_rates{&s.input, &s.input_rate, &s.input_acceleration};
  out += fmt::format("  M ξ''{}{} = {}\n", c ? " + C ξ'" : "", k ? " + K ξ" : "", or_zero(inputs_text("B", by_rates)));
  const std::tuple<const char*, const ExprMatrix*, bool> all[] = {
      {"M", &s.mass, true}, {"C", &s.damping, c}, {"K", &s.stiffness, k}};
  for (const auto& [name, matrix, shown] : all)
    if (shown) out += matrix_text(name, *matrix, order);
  out += input_matrices_text("B", by_rates, order);
  if (s.square) out += fmt::format("  ω² = {}\n", to_plain(s.square, order));
  constexpr std::size_t widest = 110;
  for (std::size_t begin = 0, end; begin < out.size(); begin = end + 1) {
    end = out.find('\n', begin);
    if (columns(out.substr(begin, end - begin)) > widest) return std::nullopt;
  }
  return out;
}

std::string verdict(const StabilityReport& s) { return fmt::format("{}: {}", stability_word(s.verdict), s.reason); }

std::string multipliers_text(const MechanicalSystem& system, const OperatingPoint& point) {
  std::string out;
  // Determined equations have further ones, which vanish.
  for (std::size_t i = 0; i < std::min(point.multipliers.size(), system.constraints.size()); ++i)
    out += fmt::format("{}{} {}", out.empty() ? "" : ", ", system.constraint_label(i), number(point.multipliers[i]));
  return out.empty() ? out : "  multipliers (SI): " + out + "\n";
}

/// " (one of a family, along y, z)": neighbours along these coordinates are equilibria too.
std::string family_text(const MechanicalSystem& system, const Equilibrium& e) {
  if (e.family == 0) return "";
  const std::string ways = e.family_along.empty() ? "" : ", along " + listed(system, e.family_along, "");
  return fmt::format(" (one of a family{})", ways);
}

/// "x = 0, on the side x > 0"
std::string place_text(const MechanicalSystem& system, const ModalEntry& e, const ModalStudy& study) {
  return point_text(system, e.equilibrium, study.translations) + family_text(system, e.equilibrium) +
         (e.side.empty() ? "" : ", on the side " + e.side);
}

std::string summary(const MechanicalSystem& system, const ModalStudy& study) {
  if (study.starts == 0) return "";
  std::size_t resting = 0;
  for (const ModalEntry& e : study.entries) resting += e.equilibrium.at_rest;
  const std::size_t moving = study.entries.size() - resting;
  std::string out = fmt::format("{} {}", resting, resting == 1 ? "equilibrium" : "equilibria");
  if (moving > 0) out += fmt::format(", {} steady {}", moving, moving == 1 ? "motion" : "motions");
  out += fmt::format(" (Newton's method from {} points; there may be more)\n", study.starts);
  if (study.outside > 0)
    out += fmt::format("{} further, ten typical sizes and more from the start, left out\n", study.outside);
  out += "\n";
  std::vector<std::vector<std::string>> rows;
  for (std::size_t i = 0; i < study.entries.size(); ++i) {
    const ModalEntry& e = study.entries[i];
    rows.push_back({fmt::format("{}", i + 1), place_text(system, e, study), verdict(e.analysis.stability)});
  }
  return out + table(rows, 3);
}

}  // namespace

std::string modes_text(const MechanicalSystem& system, const ModalStudy& study,
                       const std::vector<std::optional<SymbolicLinearization>>& formulas, const ReadingOrder& order,
                       const std::vector<std::string>& outputs,
                       const std::vector<std::optional<FloquetResult>>& neighbours) {
  const std::size_t detailed = formulas.size();
  std::string out = summary(system, study);
  for (std::size_t i = 0; i < study.entries.size() && i < detailed; ++i) {
    const ModalEntry& e = study.entries[i];
    const std::string head = place_text(system, e, study);
    if (!out.empty()) out += "\n";
    out += study.starts > 0 ? fmt::format("{}  {}\n", i + 1, head)
                            : fmt::format("{}\n  {}\n", head, verdict(e.analysis.stability));
    out += multipliers_text(system, e.linearization.point);
    if (i < neighbours.size() && neighbours[i]) {
      out += period_text(*neighbours[i], system) + neighbours_text(*neighbours[i]);
      continue;
    }
    if (const auto image = mirrored(study, i)) {
      out += fmt::format("  the mirror image of {}, in {}: the same modes\n", image->of + 1,
                         listed(system, image->turned, ""));
      continue;
    }
    if (e.analysis.modes.empty() && e.linearization.a.rows > 0) continue;  // frozen coefficients: the verdict says so
    const auto symbolic = formulas[i] ? formulas_text(*formulas[i], order) : std::nullopt;
    out += symbolic ? *symbolic : matrices_text(system, e.linearization, e.in_rates);
    out += measured_text(system, e.linearization, outputs);
    if (e.analysis.modes.empty()) continue;
    out += modes_table(system, e);
    out += fmt::format("  residual of the eigenvalue problem {}\n", brief(e.analysis.residual));
  }
  if (study.entries.size() > detailed)
    out += fmt::format("\nThe modes of the others: --at \"…\" with one of the points above, or --all.\n");
  return out;
}

std::string regulator_text(const MechanicalSystem& system, const Linearization& l, const Regulator& r) {
  std::string out = fmt::format("\nregulator  u = u0 - F x,  x = ({})\n", state_listed(system, l, ", "));
  out += matrix_text("F", r.gain);
  std::string poles;
  for (const Complex& z : r.poles)
    if (z.imag() >= 0)
      poles += (poles.empty() ? "" : ", ") +
               (z.imag() == 0 ? number(z.real()) : fmt::format("{} ± {}i", number(z.real()), number(z.imag())));
  return out + fmt::format("  poles of the closed loop {}\n  residual of the Riccati equation {}\n", poles,
                           brief(r.residual));
}

namespace {

/// One word where the verdict does not change along the branch; where it does is told behind the table.
std::string verdicts_text(const LocusBranch& branch) {
  std::string out;
  for (std::size_t i = 0; i < branch.points.size(); ++i) {
    const Stability verdict = branch.points[i].stability.verdict;
    if (i > 0 && verdict == branch.points[i - 1].stability.verdict) continue;
    out += (i > 0 ? ", then " : "") + std::string(stability_word(verdict));
  }
  return out;
}

std::string branches_that_end(const Fold& fold) {
  return fold.branches.size() == 1 ? fmt::format("branch {} ends", fold.branches.front() + 1)
                                   : fmt::format("branches {} and {} meet", fold.branches[0] + 1, fold.branches[1] + 1);
}

}  // namespace

std::string locus_text(const MechanicalSystem& system, const Locus& locus) {
  const Parameter& p = system.parameters[locus.parameter];
  const auto value = [&](double x) { return value_text(system, x, p.dimension); };
  std::string out =
      fmt::format("{} = {} … {}, {} values: {} {}\n", p.name, value(locus.values.front()), value(locus.values.back()),
                  locus.values.size(), locus.branches.size(), locus.branches.size() == 1 ? "branch" : "branches");
  Cells rows;
  for (std::size_t b = 0; b < locus.branches.size(); ++b) {
    const LocusPoint &first = locus.branches[b].points.front(), &last = locus.branches[b].points.back();
    rows.push_back({fmt::format("{}", b + 1), fmt::format("{} … {}", value(first.parameter), value(last.parameter)),
                    fmt::format("from {}", point_text(system, first.equilibrium, locus.translations)),
                    fmt::format("to {}", point_text(system, last.equilibrium, locus.translations)),
                    verdicts_text(locus.branches[b])});
  }
  out += table(rows, 5);
  for (const StabilityChange& c : locus.changes)
    out += fmt::format("  branch {} at {} = {}: {} → {}\n", c.branch + 1, p.name, value(c.parameter),
                       stability_word(c.before), stability_word(c.after));
  for (const Fold& f : locus.folds)
    out += fmt::format("  {} in a fold at {} = {}: {}\n", branches_that_end(f), p.name, value(f.parameter),
                       point_text(system, f.equilibrium, locus.translations));
  if (const std::vector<double> without = values_without_points(locus); !without.empty())
    out +=
        fmt::format("  no point was found at {} = {}{}\n", p.name, value(without.front()),
                    without.size() == 1 ? "" : fmt::format(" … {}, {} values", value(without.back()), without.size()));
  if (locus.driven)
    out +=
        "  judged over a period of the drive at each value, and where a multiplier comes nearest to 1 or -1 between "
        "two: "
        "other windows narrower than the step are not looked for\n";
  if (locus.interrupted)
    out += "  interrupted         further values are missing, and places where a verdict changes\n";
  return out;
}

// --------------------------------------------------------------------------------------------------------------------
// JSON

namespace {

std::string range_text(const MechanicalSystem& system, const RestingRange& range) {
  const Coordinate& c = system.coordinates[range.coordinate];
  const auto value = [&](double x) { return value_text(system, x, c.dimension, c.kind == "angle"); };
  if (std::isinf(range.from) && std::isinf(range.to)) return fmt::format("at every {}", c.name);
  if (std::isinf(range.from)) return fmt::format("for {} up to {}", c.name, value(range.to));
  if (std::isinf(range.to)) return fmt::format("for {} from {} on", c.name, value(range.from));
  return fmt::format("for {} from {} to {}", c.name, value(range.from), value(range.to));
}

std::string holds_text(const MechanicalSystem& system, const RestingMode& mode, std::size_t entry) {
  const auto& holds = mode.holds[entry];
  if (holds.empty()) return {};
  std::string out;
  for (const StaticHold& h : holds)
    if (std::isinf(h.limit))
      out += fmt::format("  friction of {} holds with {}: it never slides\n", h.friction, number(h.force));
    else
      out +=
          fmt::format("  static friction of {} holds with {} of {} at most\n", h.friction,
                      value_text(system, h.force, h.dimension, false), value_text(system, h.limit, h.dimension, false));
  if (std::all_of(holds.begin(), holds.end(), [](const StaticHold& h) { return std::isinf(h.limit); })) return out;
  out += "  rest is a set of points, not one: static friction holds neighbours as well";
  if (mode.ranges[entry]) out += ", here " + range_text(system, *mode.ranges[entry]);
  return out + "\n";
}

/// A point that friction holds: there is nothing to linearize.
std::string held_text(const MechanicalSystem& system, const ModalStudy& study) {
  return fmt::format("{}\n  held by static friction\n", place_text(system, study.entries.front(), study)) +
         multipliers_text(system, study.entries.front().linearization.point);
}

}  // namespace

std::string resting_text(const RestingMode& mode, bool first) {
  const MechanicalSystem& system = *mode.equations->system;
  std::string out = fmt::format("{}Mode \"{}\"{}\n", first ? "" : "\n", mode.text,
                                mode.frictionless ? ", its friction left out of the equations" : "");
  for (std::size_t i = 0; i < mode.study.entries.size(); ++i) {
    ModalStudy one;
    one.entries = {mode.study.entries[i]};
    one.translations = mode.study.translations;
    const auto& modes = mode.study.entries[i].analysis.modes;
    const bool held = !mode.frictionless && !mode.holds[i].empty() &&
                      std::all_of(modes.begin(), modes.end(), [](const Mode& m) { return m.kind == Mode::Kind::Zero; });
    out += held ? held_text(system, one) : modes_text(system, one, {std::nullopt}, mode.equations->order, {}, {});
    if (mode.forces_are_open[i])
      out +=
          "  the balance does not determine these forces (statically indeterminate): some within the limits are "
          "shown\n";
    out += holds_text(system, mode, i);
  }
  return out;
}

}  // namespace maupertuis::app
