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

/// The largest swing of an answer at its place and beside it.
double difference(const OneRun& one, const OneRun& other, std::size_t question) {
  const std::vector<Look>&a = one.looks[question], &b = other.looks[question];
  double out = 0;
  for (std::size_t k = 0; k < a[0].values.size(); ++k) out = std::max(out, swing(a, b, k));
  return out;
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

/// Each step rounds a value several times: 2.5 of these units were seen on 1000 cells.
double rounding_of(const OneRun& run) { return 4 * 2.2e-16 * std::sqrt(static_cast<double>(run.steps) + 1); }

/// How a mesh is sharpened: so many times fewer cells, of an order so much higher.
struct Sharpening {
  int fewer_cells = 1, orders = 2;
};

/// Two orders, since of one more a motion that is even or odd in each cell may have nothing. Waves on many cells, which
/// are resolved there or nowhere, have less work on fewer cells of higher order.
Sharpening sharpening_of(const FieldMethod& method, const Cells& cells) {
  constexpr int many = 64, very_many = 256;
  const int least = *std::min_element(cells.begin(), cells.end());
  if (!method.is_wave() || least < many) return {};
  return {least < very_many ? 2 : 4, 4};
}

/// By how much an answer is off where a sharper run, which is off by up to a fifth of that itself, says something else.
/// At single places both may agree by chance, so that a sixteenth of the differences within a cell counts as well, but
/// at the borders of cells, which are off by far less than what lies between; all of them where the mesh follows slopes
/// just so; and up to twice them what rounding may have done.
double error_of(const OneRun& sharp, const OneRun& fine, const FieldQuestion& asked, std::size_t question,
                bool at_border, double tail) {
  constexpr double own = 5.0 / 4, by_chance = 1.0 / 16, of_tails = 8;
  const bool barely = fine.follows[question] == SteepeningWatch::Follows::Barely;
  const double at_place = std::abs(sharp.answers[question] - fine.answers[question]),
               near = difference(sharp, fine, question), felt = rounding_of(fine) / 2 * fine.felt[question],
               rounded = asked.total ? felt : std::min(felt, 2 * near),
               beside = barely      ? near
                        : at_border ? 0
                                    : by_chance * near;
  return std::max(own * at_place + std::max(beside, rounded), std::min(of_tails * near, tail * fine.sizes[question]));
}

/// The power of the width of cells by which answers converge, where half the cells are off by more than rounding.
double measured_order(const OneRun& half, const OneRun& sharp, const OneRun& fine, double ratio, std::size_t question) {
  constexpr double clear = 10;
  const double wide = difference(half, sharp, question), narrow = difference(fine, sharp, question);
  const bool beyond_rounding = narrow > clear * rounding_of(fine) * std::abs(fine.answers[question]);
  return beyond_rounding && wide > narrow ? std::log(wide / narrow) / std::log(ratio) : 0;
}

std::vector<AnswerError> errors_by_sharper_run(const OneRun& fine, const FieldEquations& equations, FieldMethod& method,
                                               const Cells& cells, const std::vector<FieldQuestion>& questions,
                                               const FieldRunOptions& options, double tail, Diagnostics& diagnostics) {
  std::vector<AnswerError> out(questions.size());
  const Sharpening by = sharpening_of(method, cells);
  FieldMethod sharper = method.sharper(by.orders);
  const auto sharp =
      run_on(equations, sharper, divided(cells, by.fewer_cells), questions, options, {}, false, diagnostics);
  if (!sharp) return out;
  std::optional<OneRun> wide;
  Diagnostics unheard;  // without half the cells no order is told
  const Cells half = divided(cells, 2);
  if (options.orders && half != cells) wide = run_on(equations, method, half, questions, options, {}, false, unheard);
  for (std::size_t i = 0; i < questions.size(); ++i) {
    if (fine.follows[i] == SteepeningWatch::Follows::Not) continue;
    const bool at_border = FieldMethod::stands_on_borders(equations, questions[i], cells);
    out[i].size = error_of(*sharp, fine, questions[i], i, at_border, tail);
    if (wide) out[i].order = measured_order(*wide, *sharp, fine, widening(cells, half), i);
  }
  return out;
}

/// The power of the ratio of cells that the error of an answer falls by, from what the start, the slopes and (by
/// collocation) a third mesh let come about.
double gain_of(const OneRun& fine, const OneRun& coarse, const std::optional<OneRun>& coarser, const Rough& start,
               double by_order, double ratio, std::size_t question) {
  double gain = start.how == Rough::Breaks ? 2 : by_order;
  if (fine.follows[question] == SteepeningWatch::Follows::Barely) gain = 2;
  if (start.jump && *start.jump > 1) gain = std::min(gain, (std::pow(ratio, *start.jump) + 1) / 2);
  if (!coarser) return gain;
  const double seen = difference(*coarser, coarse, question) / difference(coarse, fine, question);
  return std::isfinite(seen) ? std::min(gain, std::max(seen, 2.0)) : gain;
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
                                   const FieldRunOptions& options, const Rough& start, Diagnostics& diagnostics) {
  std::vector<AnswerError> out(questions.size());
  if (!options.errors || questions.empty() || fine.passes_by) return out;
  if (start.smooth())
    return errors_by_sharper_run(fine, equations, method, cells, questions, options, start.tail, diagnostics);
  const Cells half = divided(cells, 2);
  if (half == cells) return out;
  const auto run = [&](const Cells& other, Diagnostics& told) {
    return run_on(equations, method, other, questions, options, {}, false, told);
  };
  Diagnostics unheard;  // without a third there is a broader estimate
  const auto coarse = run(half, diagnostics);
  if (!coarse) return out;
  std::optional<OneRun> coarser, finer, near;
  if (!method.is_wave() && cells[0] >= 4) coarser = run(divided(cells, 4), unheard);
  if (start.how != Rough::No) {
    Cells twice = cells;
    for (int& n : twice) n *= 2;
    finer = run(twice, diagnostics);
    if (!finer) return out;
  }
  const std::optional<Cells> between_both = start.how == Rough::No ? cells_between(cells) : std::nullopt;
  if (between_both) near = run(*between_both, unheard);
  const double ratio = widening(cells, half);
  for (std::size_t i = 0; i < questions.size(); ++i) {
    if (fine.follows[i] == SteepeningWatch::Follows::Not && start.how == Rough::No) continue;
    const double power = std::pow(ratio, method.power(equations, questions[i], half));
    const double gain = gain_of(fine, *coarse, coarser, start, power, ratio, i), apart = difference(*coarse, fine, i);
    double error = std::max({finer ? 2 * difference(*finer, fine, i) : 0, apart / (gain - 1),
                             std::min(2 * apart, start.tail * fine.sizes[i])});
    if (near) {
      const double rate = std::log(gain) / std::log(ratio), gained = std::pow(widening(cells, *between_both), rate);
      error = std::max(error, difference(*near, fine, i) / (gained - 1));
    }
    out[i].size = error + rounding_of(fine) * std::max(fine.felt[i], 1e-300);
  }
  return out;
}

}  // namespace maupertuis
