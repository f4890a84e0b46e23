#include <maupertuis/evaluate.hpp>
#include <maupertuis/field_run.hpp>

#include "fields/plane_mesh.hpp"
#include "fields/resolution.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>

#if __has_include(<unistd.h>)
#include <unistd.h>
#endif

/// The run of a field, and of a second mesh of half the cells that tells how far off it is.
namespace maupertuis {
namespace {

constexpr int usual_cells = 100, usual_cells_of_plane = 32, usual_order = 3;
constexpr double stability = 3.2;  // h ω_max

void refuse(const MovingMesh& mesh, const FieldEquations& equations, Diagnostics& diagnostics) {
  const FieldSystem& s = equations.system();
  const std::string& what = mesh.trouble();
  if (what == "slope") {
    Span span = s.density_span;
    for (const BoundaryCondition& b : s.boundary)
      if (b.jet.order() == 1) span = b.span;
    std::string natural;
    for (const NaturalCondition& n : equations.natural)
      natural += (natural.empty() ? "" : ", ") +
                 to_plain(field_layout(s, lay_out(readable(n.value, equations.order), equations.order))) + " = 0";
    diagnostics.error(
        "E0292", span, "this condition clashes with the natural one",
        fmt::format("What the variation leaves at a free end is {}; a given slope does not say what it is.", natural),
        "Give the field itself, or leave the end natural.");
  } else if (what == "mass") {
    diagnostics.error("E0642", s.density_span, "the accelerations are not determined",
                      "∂²ℒ/∂φ'∂φ' is singular: a density linear in the velocities gives equations of first order.",
                      "`maup derive` shows them; runs of such fields are carried out by a later version.");
  } else if (what == "start") {
    diagnostics.error("E0645", equations.model->start.empty() ? s.density_span : equations.model->start.front().span,
                      "the start of a field is not a finite number somewhere in its domain",
                      "A run can only begin from definite values at all places.",
                      "Look for a logarithm or a root of a negative number in it, or a division by zero.");
  } else if (what == "overflow") {
    diagnostics.error("E0643", s.density_span, "the field grew beyond all numbers",
                      fmt::format("At t = {:.6g} s a value of the field is no number any more.", mesh.time()),
                      "The start, or an unstable density, lets it grow.");
  } else {
    diagnostics.error("E0508", s.density_span, fmt::format("not supported yet: a run of a density with `{}`", what),
                      "Its Taylor series over a mesh has no rule yet.",
                      "Write it with sums, products, powers, exp, log, sin, cos, sinh, cosh or tanh.");
  }
}

struct OneRun {
  std::vector<double> answers;
  std::size_t steps = 0;
  double h = 0, omega = 0, energy = 0, drift = 0;
  Trajectory trajectory;
};

/// E0647 where both meshes would pass something by, and their difference would tell nothing of it.
bool refuse_coarse_mesh(const FieldEquations& equations, const PointForm& form, const std::vector<int>& cells,
                        int order, Diagnostics& diagnostics) {
  const auto found = unresolved_feature(equations, form, cells, order);
  if (!found) return false;
  const FieldSystem& s = equations.system();
  const bool at_start = found->of_start && !equations.model->start.empty();
  std::string place, width;
  for (std::size_t i = 0; i < found->place.size(); ++i) {
    place += fmt::format("{}{} = {:.6g}", i ? ", " : "", s.space[i].name, found->place[i]);
    width += fmt::format("{}{:.3g}", i ? " × " : "", found->element[i]);
  }
  diagnostics.error(
      "E0647", at_start ? equations.model->start.front().span : s.density_span,
      fmt::format("the mesh is too coarse for what {} has at {}", found->of_start ? "the start" : "the density", place),
      fmt::format("Elements are {} wide (SI units), and what lies between their nodes is not seen by a "
                  "second mesh either: no value of this run could be trusted.",
                  width),
      "Take more `cells`, or make it wider.");
  return true;
}

const char* side_name(BoundaryCondition::Side side, const FieldSystem& s) {
  constexpr const char* names[] = {"left", "right", "bottom", "top"};
  constexpr const char* ends[] = {"left end", "right end", "bottom", "top"};
  return (s.space.size() == 1 ? ends : names)[static_cast<int>(side)];
}

/// W0646: the end of the mesh is put to its condition, and what the start says beside it runs in as a wave.
void warn_of_clashes(const MovingMesh& mesh, const FieldEquations& equations, Diagnostics& diagnostics) {
  const FieldSystem& s = equations.system();
  for (const MovingMesh::StartClash& c : mesh.start_clashes())
    diagnostics.warning(
        "W0646", equations.model->start.empty() ? s.density_span : equations.model->start.front().span,
        fmt::format("the start does not fit the condition at the {}: {}{} = {:.6g} beside {:.6g} (SI units)",
                    side_name(c.side, s), s.fields[equations.varied[c.field]].name, c.order ? "'" : "", c.start,
                    c.condition),
        "The condition is followed, so that a jump runs into the field, which no mesh resolves.",
        "Give a start that has the value of the condition there.");
}

/// The memory of this machine in bytes; 0 where it does not say.
double memory_of_machine() {
#if defined(_SC_PHYS_PAGES) && defined(_SC_PAGESIZE)
  return static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
#else
  return 0;
#endif
}

/// E0648 before anything of a mesh is made that the machine has no room for.
bool refuse_large_mesh(const FieldEquations& equations, const PointForm& form, const std::vector<int>& cells, int order,
                       Diagnostics& diagnostics) {
  if (cells.size() != 2) return false;  // a million cells of a line fit anywhere
  const double bytes = PlaneMesh::bytes(equations, form, cells[0], cells[1], order), memory = memory_of_machine();
  if (!(memory > 0) || bytes < 0.8 * memory) return false;
  diagnostics.error(
      "E0648", equations.system().space.front().span,
      fmt::format("{} × {} cells of order {} do not fit into the memory of this machine", cells[0], cells[1], order),
      fmt::format("Its Taylor series would take {:.3g} GB; there are {:.3g} GB.", bytes / 1e9, memory / 1e9),
      "Write fewer cells, or a lower order of the elements.");
  return true;
}

std::unique_ptr<MovingMesh> make_mesh(const FieldEquations& equations, const PointForm& form,
                                      const std::vector<int>& cells, int order) {
  if (cells.size() == 2) return std::make_unique<PlaneMesh>(equations, form, cells[0], cells[1], order);
  return std::make_unique<FieldMesh>(equations, form, cells[0], order);
}

/// The places of each direction that rows have values at: borders of cells, in the plane not more than some hundred,
/// and between them where those are few.
std::vector<std::vector<double>> places_of_rows(const FieldEquations& equations, const std::vector<int>& cells,
                                                int least) {
  const FieldSystem& s = equations.system();
  Bindings values;
  for (const Parameter& p : equations.model->parameters) values[p.symbol] = p.si_value;
  std::vector<std::vector<double>> out(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    constexpr int most_of_plane = 128;
    const double from = evaluate(s.expanded(s.space[i].from), values),
                 width = (evaluate(s.expanded(s.space[i].to), values) - from) / cells[i];
    const int stride = cells.size() == 2 ? (cells[i] + most_of_plane - 1) / most_of_plane : 1;
    const int parts = std::max((least + cells[i] - 1) / cells[i], 1);
    for (int e = 0; e <= cells[i] * parts; e += stride) out[i].push_back(from + e * width / parts);
  }
  return out;
}

std::optional<OneRun> run_on(const FieldEquations& equations, const PointForm& form, const std::vector<int>& cells,
                             int order, const std::vector<FieldQuestion>& questions, const FieldRunOptions& options,
                             const std::vector<std::vector<double>>& rows, bool warns, Diagnostics& diagnostics) {
  const std::unique_ptr<MovingMesh> made = make_mesh(equations, form, cells, order);
  MovingMesh& mesh = *made;
  OneRun out;
  if (mesh.trouble().empty()) mesh.start();
  if (mesh.trouble().empty()) out.omega = mesh.omega_max(options.interrupt);
  if (!mesh.trouble().empty()) return refuse(mesh, equations, diagnostics), std::nullopt;
  if (warns) warn_of_clashes(mesh, equations, diagnostics);
  const double longest = out.omega > 0 ? stability / out.omega : options.duration;
  std::vector<double> stops;
  for (const FieldQuestion& q : questions) stops.push_back(q.time);
  stops.push_back(options.duration);
  const double every = options.every > 0 ? options.every : options.duration / 100;
  for (double t = 0; t < options.duration; t += every) stops.push_back(t);
  std::sort(stops.begin(), stops.end());
  double size = 0;
  const double start = mesh.energy(size);
  out.energy = start;
  out.answers.assign(questions.size(), std::nan(""));
  for (const double stop : stops) {
    const double way = stop - mesh.time();
    const auto steps = static_cast<std::size_t>(std::ceil(way / longest - 1e-9));
    for (std::size_t k = 0; way > 0 && k < std::max<std::size_t>(steps, 1); ++k) {
      options.interrupt.throw_if_asked();
      if (!mesh.step(way / static_cast<double>(std::max<std::size_t>(steps, 1))))
        return refuse(mesh, equations, diagnostics), std::nullopt;
      ++out.steps;
    }
    double now = 0;
    if (way > 0 || stop == 0) out.energy = mesh.energy(now), size = std::max(size, now);
    out.drift = std::max(out.drift, std::abs(out.energy - start));
    for (std::size_t i = 0; i < questions.size(); ++i)
      if (questions[i].time == stop) out.answers[i] = mesh.answer(questions[i]);
    if (!rows.empty() && (out.trajectory.times.empty() || mesh.time() > out.trajectory.times.back()))
      mesh.add_row(out.trajectory, rows);
  }
  out.h = longest;
  if (size > 0) out.drift /= size;
  return out;
}

/// The power of the width of a cell by which an answer is off: 2p (up to that of the steps) where elements meet and in
/// integrals, p + 1 between, p of a slope.
int power_of(const FieldEquations& equations, const FieldQuestion& question, const std::vector<int>& half, int order) {
  int power = std::min(2 * order, static_cast<int>(kOrder));
  if (question.total) return power;
  const FieldSystem& s = equations.system();
  Bindings values;
  for (const Parameter& p : equations.model->parameters) values[p.symbol] = p.si_value;
  const auto number = [&](Expr e) { return evaluate(s.expanded(e), values); };
  const std::vector<Expr> asked = symbols_of({&question.value, 1});
  for (const PlaceValue& place : equations.model->places) {
    if (std::find(asked.begin(), asked.end(), place.symbol) == asked.end()) continue;
    const FieldJet jet = *s.jet_of(place.jet);
    if (jet.order() > jet.time) power = std::min(power, order);
    for (std::size_t i = 0; i < half.size(); ++i) {
      const double from = number(s.space[i].from), width = number(s.space[i].to) - from;
      const double cell = (number(place.place[i]) - from) / width * half[i];
      if (std::abs(cell - std::round(cell)) > 1e-9 * half[i]) power = std::min(power, order + 1);
    }
  }
  return power;
}

}  // namespace

std::optional<FieldRunResult> run_fields(const FieldEquations& equations, const std::vector<FieldQuestion>& questions,
                                         const FieldRunOptions& options, Diagnostics& diagnostics) {
  const auto begin = std::chrono::steady_clock::now();
  const auto form = point_form(equations, diagnostics);
  if (!form) return std::nullopt;
  const FieldSystem& s = equations.system();
  std::vector<int> cells, half;
  for (const SpaceVariable& x : s.space) {
    const int usual = s.space.size() == 1 ? usual_cells : usual_cells_of_plane;
    cells.push_back(x.cells ? x.cells : s.space.front().cells ? s.space.front().cells : usual);
    half.push_back(std::max(cells.back() / 2, 1));
  }
  const int order = s.element_order ? s.element_order : usual_order;
  if (refuse_large_mesh(equations, *form, cells, order, diagnostics)) return std::nullopt;
  if (refuse_coarse_mesh(equations, *form, cells, order, diagnostics)) return std::nullopt;
  std::vector<std::vector<double>> rows;
  if (options.trajectory) rows = places_of_rows(equations, cells, options.least_values);
  auto fine = run_on(equations, *form, cells, order, questions, options, rows, true, diagnostics);
  if (!fine) return std::nullopt;
  FieldRunResult out;
  out.cells = cells.front(), out.order = order, out.nodes = 1;
  if (cells.size() == 2) out.cells_upwards = cells[1];
  for (const int n : cells) out.nodes *= static_cast<std::size_t>(n) * static_cast<std::size_t>(order) + 1;
  out.steps = fine->steps, out.step = fine->h, out.omega_max = fine->omega;
  out.energy = fine->energy, out.energy_drift = form->conserves ? fine->drift : -1;
  out.end = options.duration;
  out.trajectory = std::move(fine->trajectory);
  if (!rows.empty()) out.places = rows[0];
  if (rows.size() == 2) out.upwards = rows[1];
  const bool halved = half != cells;
  std::optional<OneRun> coarse;
  if (options.errors && !questions.empty() && halved)
    coarse = run_on(equations, *form, half, order, questions, options, {}, false, diagnostics);
  double ratio = halved ? 1e9 : 2;
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (cells[i] > 1) ratio = std::min(ratio, static_cast<double>(cells[i]) / half[i]);
  const double rounding = 2.2e-16 * std::sqrt(static_cast<double>(out.steps) + 1);
  for (std::size_t i = 0; i < questions.size(); ++i) {
    const double value = fine->answers[i];
    const double gain = std::pow(ratio, power_of(equations, questions[i], half, order)) - 1;
    const double error =
        coarse ? std::abs(value - coarse->answers[i]) / gain + rounding * std::max(std::abs(value), 1e-300)
               : std::numeric_limits<double>::infinity();
    out.answers.push_back({value, error});
  }
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return out;
}

}  // namespace maupertuis
