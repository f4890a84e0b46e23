#include "fields/answer_errors.hpp"

#include "fields/breaks.hpp"
#include "fields/resolution.hpp"
#include "fields/start_fit.hpp"
#include "fields/switching.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

/// Whether the mesh leaves so much of the start out that two meshes may agree by chance; W0652 where it is much.
bool is_coarse_for_start(const FieldEquations& equations, const FieldMethod& method, const Cells& cells,
                         Diagnostics& diagnostics) {
  constexpr double counts = 1e-3, much = 1e-2;
  const double part = left_out_of_start(equations, cells, method.order());
  if (part > much)
    diagnostics.warning("W0652", equations.model->start.front().span,
                        fmt::format("the mesh leaves {:.2g} % of the start out", 100 * part),
                        "Between the nodes the start is another function than the polynomials of the elements, and "
                        "waves shorter than these run apart.",
                        "Take more `cells`, or a higher `order`, until what is left out is less than 0.1 %.");
  return part > counts;
}

/// How far apart two meshes are at a place: of an oscillation the largest within a quarter of it. At some moments the
/// errors of both go through zero together; with moments at 0, o and 2 o before the answer a difference that swings has
/// D_0 + D_2o = 2 cos(ω o) D_o, one that has run past falls like an exponential, D_0 + D_2o > 2 D_o, and counts as it
/// is.
double swing(const std::vector<Look>& one, const std::vector<Look>& other, std::size_t place) {
  constexpr double growth = 1.05, quarter = 0.3;  // of cos(ω o)
  const auto apart = [&](std::size_t moment) { return one[moment].values[place] - other[moment].values[place]; };
  double out = std::abs(apart(0));
  for (std::size_t k = 1; k + 1 < std::min(one.size(), other.size()); ++k) {
    const double ends = apart(0) + apart(k + 1), middle = 2 * apart(k);
    if (std::abs(ends) > growth * std::abs(middle)) break;
    out = std::max(out, std::abs(apart(k)));
    if (ends * middle < quarter * middle * middle) break;
  }
  return out;
}

/// Of an answer at a border: its place and those four cells beside it, or those two cells beside it. A third mesh has
/// borders at one of the two.
enum class Among { All, Own, Beside };

/// The largest swing of an answer at its place and beside it.
double difference(const OneRun& one, const OneRun& other, std::size_t question, Among among = Among::All) {
  const std::vector<Look>&a = one.looks[question], &b = other.looks[question];
  const std::size_t places = a[0].values.size();
  double out = 0;
  for (std::size_t k = 0; k < places; ++k) {
    const bool own = k == 0 || k == 1 || k == 4;  // the place, and four cells beside it
    if (among == Among::All || own == (among == Among::Own)) out = std::max(out, swing(a, b, k));
  }
  return out;
}

/// `between` of two meshes, or more where a third and the second swing further apart than belongs to that; at most ten
/// times, as the third may not follow the wave at all.
double seen_by_coarser(double swing, double between, double gain) {
  constexpr double beyond = 1.5, most = 10;
  return std::clamp(swing / (beyond * gain), between, most * between);
}

/// Three quarters of the cells, where meshes are of few: half of them may share a symmetry with the motion (a cell that
/// holds just one half-wave), and be off by far less than belongs to their width. Of many the rate of three meshes
/// tells.
std::optional<Cells> cells_between(const Cells& cells) {
  constexpr int few = 32;
  if (*std::min_element(cells.begin(), cells.end()) >= few) return std::nullopt;
  Cells out = cells;
  for (int& n : out) n = std::max(n - std::max(n / 4, 1), 1);
  return out == divided(cells, 2) ? std::nullopt : std::optional(out);
}

/// The least of how much wider the cells of another mesh are.
double widening(const Cells& cells, const Cells& other) {
  double out = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (cells[i] > 1) out = std::min(out, static_cast<double>(cells[i]) / other[i]);
  return out;
}

/// By three meshes, each of `ratio` times the cells of the one before; where the last two differ by more than rounding.
double measured_order(const OneRun& coarser, const OneRun& coarse, const OneRun& fine, double rounding, double ratio,
                      std::size_t question) {
  constexpr double clear = 10;
  const double first = std::abs(coarser.answers[question] - coarse.answers[question]),
               second = std::abs(coarse.answers[question] - fine.answers[question]);
  return second > clear * rounding && first > second ? std::log(first / second) / std::log(ratio) : 0;
}

}  // namespace

Cells divided(const Cells& cells, int parts) {
  Cells out = cells;
  for (int& n : out) n = std::max(n / parts, 1);
  return out;
}

Rough roughness_of(const FieldEquations& equations, const FieldMethod& method, const Cells& cells,
                   const FieldRunOptions& options, Diagnostics& diagnostics) {
  Rough out;
  const std::vector<double> borders = even_borders(equations, cells).front();
  if (method.is_wave()) {
    const double end = options.begin + options.duration;
    const SideFit fit = fit_of_sides(equations, options.begin, method.switching().empty() ? end : method.switching()[0],
                                     (borders[1] - borders[0]) / method.order());
    out.jump = fit.jump, out.tail = fit.tail;
    if (const auto b = lowest_break(equations, method.switching(), options.begin, end)) {
      if (b->order <= 1) warn_of_switching(*b, diagnostics);
      out.jump = out.jump ? std::min(*out.jump, b->order) : b->order;
    }
  }
  if (warn_of_breaks(equations, cells, diagnostics) || (out.jump && *out.jump <= 1))
    out.how = Rough::Breaks;
  else if (is_coarse_for_start(equations, method, cells, diagnostics))
    out.how = Rough::Coarse;
  return out;
}

std::vector<AnswerError> errors_of(const OneRun& fine, const FieldEquations& equations, FieldMethod& method,
                                   const Cells& cells, const std::vector<FieldQuestion>& questions,
                                   const FieldRunOptions& options, Rough start, Diagnostics& diagnostics) {
  std::vector<AnswerError> out(questions.size());
  const Cells half = divided(cells, 2), quarter = divided(cells, 4);
  if (!options.errors || questions.empty() || half == cells || fine.passes_by) return out;
  const auto coarse = run_on(equations, method, half, questions, options, {}, false, diagnostics);
  if (!coarse) return out;
  std::optional<OneRun> coarser;
  Diagnostics ignored;  // without the third there is a broader estimate
  constexpr int least_of_wave = 8;
  const bool smooth_wave = method.is_wave() && start.how == Rough::No && !start.jump &&
                           *std::min_element(cells.begin(), cells.end()) >= least_of_wave;
  if (smooth_wave || (!method.is_wave() && cells[0] >= 4))
    coarser = run_on(equations, method, quarter, questions, options, {}, false, ignored);
  std::optional<OneRun> finer;
  if (start.how != Rough::No) {
    Cells twice = cells;
    for (int& n : twice) n *= 2;
    finer = run_on(equations, method, twice, questions, options, {}, false, diagnostics);
    if (!finer) return out;
  }
  std::optional<OneRun> near;
  const std::optional<Cells> between_both = start.how == Rough::No ? cells_between(cells) : std::nullopt;
  if (between_both) near = run_on(equations, method, *between_both, questions, options, {}, false, ignored);
  const double ratio = widening(cells, half);
  // Each step rounds a value several times: 2.5 of these units were seen on 1000 cells.
  const double rounding = 4 * 2.2e-16 * std::sqrt(static_cast<double>(fine.steps) + 1);
  for (std::size_t i = 0; i < questions.size(); ++i) {
    if (fine.follows[i] == SteepeningWatch::Follows::Not && start.how == Rough::No) continue;
    double gain = start.how == Rough::Breaks ? 2 : std::pow(ratio, method.power(equations, questions[i], half));
    if (fine.follows[i] == SteepeningWatch::Follows::Barely) gain = 2;
    if (start.jump && *start.jump > 1) gain = std::min(gain, (std::pow(ratio, *start.jump) + 1) / 2);
    if (!method.is_wave()) {
      const double seen = coarser ? difference(*coarser, *coarse, i) / difference(*coarse, fine, i) : 2;
      gain = std::isfinite(seen) ? std::min(gain, std::max(seen, 2.0)) : gain;
    }
    double between = difference(*coarse, fine, i);
    const bool alike = method.looks_alike(equations, questions[i]);
    const bool aligned = !alike || method.stands_on_borders(equations, questions[i], quarter);
    const double felt = rounding * std::max(fine.felt[i], 1e-300);
    if (coarser && aligned) out[i].order = measured_order(*coarser, *coarse, fine, felt, ratio, i);
    if (smooth_wave && coarser && gain > 2) {
      const Among among = !alike ? Among::All : aligned ? Among::Own : Among::Beside;
      between = seen_by_coarser(difference(*coarser, *coarse, i, among), between, gain);
    }
    const double tail = std::min(2 * between, start.tail * fine.sizes[i]),
                 missed = finer ? 2 * difference(*finer, fine, i) : 0;
    double error = std::max({missed, between / (gain - 1), tail});
    if (near) {
      const double rate = std::log(gain) / std::log(ratio), gained = std::pow(widening(cells, *between_both), rate);
      const bool meets = alike && method.stands_on_borders(equations, questions[i], *between_both);
      error = std::max(error, difference(*near, fine, i, meets ? Among::Own : Among::All) / (gained - 1));
    }
    out[i].size = error + felt;
  }
  return out;
}

}  // namespace maupertuis
