#include <maupertuis/evaluate.hpp>
#include <maupertuis/field_run.hpp>

#include "fields/collocation.hpp"
#include "fields/field_mesh.hpp"
#include "fields/resolution.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>

/// The run of a field, and of a second mesh of half the cells that tells how far off it is.
namespace maupertuis {
namespace {

constexpr int usual_cells = 100, usual_order = 3, usual_smooth_order = 7;
constexpr double stability = 3.2;  // h ω_max
constexpr int stages = 4;          // of Gauss's collocation
constexpr double goal = 1e-12;     // of its steps, beside the field, over the whole run

void refuse(const FieldMotion& mesh, const FieldEquations& equations, Diagnostics& diagnostics) {
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
    diagnostics.error("E0642", s.density_span, "the motion of the field is not determined",
                      "The equations do not hold enough derivatives by t to go on from a start.",
                      "`maup derive` shows them.");
  } else if (what == "moment") {
    diagnostics.error("E0508", s.end_forces.empty() ? s.density_span : s.end_forces.front().span,
                      "not supported yet: a moment on a field without curvature",
                      "A moment acts on the slope, which has no part in the energy of this field at its end.",
                      "Give a force on the field itself, or a density with its second derivative.");
  } else if (what == "ends") {
    diagnostics.error("E0642", s.boundary.empty() ? s.density_span : s.boundary.front().span,
                      "the conditions at the ends do not determine the motion",
                      "The part of the density that is linear in the velocities leaves a shape of the field without an "
                      "equation of motion of its own: a free end asks for more than the start can give.",
                      "Hold the field at both ends and take elements of an odd order, or make the domain periodic.");
  } else if (what == "step") {
    diagnostics.error(
        "E0643", s.density_span, "no step leads on from here",
        fmt::format("At t = {:.6g} s the equations of a step have no solution near, however short it is.", mesh.time()),
        "The field grows beyond all bounds, or comes to where its equations are singular.");
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

/// Where a value of smooth elements is looked at beside its place, in widths of the first mesh's cells: the error
/// inside an element goes through zero several times.
constexpr double beside[] = {-1, -0.7, -0.4, 0.4, 0.7, 1};

struct OneRun {
  std::vector<double> answers;
  std::vector<std::vector<double>> near;  // [questions]: the same beside their places
  std::size_t steps = 0;
  double h = 0, omega = 0, energy = 0, drift = 0;
  Trajectory trajectory;
};

/// How the fields of a density are put on a mesh and moved: waves by Taylor steps, where ω_max grows like 1/h;
/// densities of second derivatives or linear in the velocities, where it grows like 1/h² to 1/h⁴, by collocation.
struct Method {
  std::optional<PointForm> waves;
  std::optional<DensityForm> stiff;
  int order = 0;
  double step = 0, width = 0;  // of the first mesh by collocation

  static std::optional<Method> of(const FieldEquations& equations, Diagnostics& diagnostics) {
    Method out;
    const int written = equations.system().element_order;
    if (needs_collocation(equations)) {
      out.stiff = density_form(equations, diagnostics);
      out.order = written ? written : usual_smooth_order;
    } else {
      out.waves = point_form(equations, diagnostics);
      out.order = written ? written : usual_order;
    }
    return out.waves || out.stiff ? std::optional(std::move(out)) : std::nullopt;
  }
  std::unique_ptr<FieldMotion> mesh(const FieldEquations& equations, int cells) const {
    if (waves) return std::make_unique<FieldMesh>(equations, *waves, cells, order);
    return std::make_unique<CollocationMotion>(equations, *stiff, cells, order, stages);
  }
  /// By collocation as much longer on the other meshes as their cells are wider, so that their difference tells the
  /// error of steps as well.
  double longest_step(FieldMotion& mesh, OneRun& run, const FieldRunOptions& options) {
    if (auto* wave = dynamic_cast<FieldMesh*>(&mesh)) {
      run.omega = wave->omega_max(options.interrupt);
      return run.omega > 0 ? stability / run.omega : options.duration;
    }
    auto& motion = dynamic_cast<CollocationMotion&>(mesh);
    const double cell = mesh.place_of_cell(1) - mesh.place_of_cell(0);
    if (step > 0) return step * std::round(cell / width);
    width = cell;
    const double every = options.every > 0 ? options.every : options.duration / 100;
    return step = motion.choose_step(std::min(every, options.duration), options.duration, goal, options.interrupt);
  }
  bool conserves() const { return waves ? waves->conserves : stiff->conserves; }
  /// The power of the width of a cell by which a value is off on both meshes with their steps.
  int power(const FieldEquations& equations, const FieldQuestion& question) const {
    if (waves) return std::min(2 * order, 8);
    const bool smooth = std::find(stiff->smooth.begin(), stiff->smooth.end(), true) != stiff->smooth.end();
    const int degree = smooth ? std::max(order, 3) : order;
    int lost = smooth ? 2 : 0;  // of the whole, energies for example: twice what the derivatives in ℒ leave
    if (question.total) return std::min(2 * degree - lost, 2 * stages);
    lost = 0;
    for (const PlaceValue& place : equations.model->places) {
      const Expr value[] = {question.value};
      const std::vector<Expr> symbols = symbols_of(value);
      if (std::find(symbols.begin(), symbols.end(), place.symbol) != symbols.end())
        lost = std::max(lost, equations.system().jet_of(place.jet)->space[0]);
    }
    return std::min(std::max(degree + 1 - lost, 1), 2 * stages);
  }
};

void add_row(const FieldMotion& mesh, const FieldEquations& equations, int cells, Trajectory& rows) {
  const FieldSystem& s = equations.system();
  const bool first = rows.columns.empty();
  rows.times.push_back(mesh.time());
  for (std::size_t a = 0; a < equations.varied.size(); ++a)
    for (int order = 0; order < 2; ++order)
      for (int e = 0; e <= cells; ++e) {
        const double x = mesh.place_of_cell(e);
        const Field& f = s.fields[equations.varied[a]];
        if (first)
          rows.columns.push_back({fmt::format("{}{}({:.10g})", f.name, order ? "'" : "", x),
                                  to_string(s.dimension_of({equations.varied[a], {0}, order}))});
        rows.values.push_back(mesh.field_at(a, order, 0, x));
      }
}

/// E0647 where both meshes would pass something by, and their difference would tell nothing of it.
bool refuse_coarse_mesh(const FieldEquations& equations, const Method& method, int cells, Diagnostics& diagnostics) {
  PointForm of_density;
  if (method.stiff) of_density.inputs = method.stiff->inputs, of_density.g = method.stiff->by_slot;
  const auto found = unresolved_feature(equations, method.waves ? *method.waves : of_density, cells, method.order);
  if (!found) return false;
  const FieldSystem& s = equations.system();
  const bool at_start = found->of_start && !equations.model->start.empty();
  diagnostics.error(
      "E0647", at_start ? equations.model->start.front().span : s.density_span,
      fmt::format("the mesh is too coarse for what {} has at {} = {:.6g}",
                  found->of_start ? "the start" : "the density", s.space.front().name, found->place),
      fmt::format("Elements are {:.3g} wide (SI units), and what lies between their nodes is not seen by a "
                  "second mesh either: no value of this run could be trusted.",
                  found->element),
      "Take more `cells`, or make it wider.");
  return true;
}

/// W0646: the end of the mesh is put to its condition, and what the start says beside it runs in as a wave.
void warn_of_clashes(const FieldMotion& mesh, const FieldEquations& equations, Diagnostics& diagnostics) {
  const FieldSystem& s = equations.system();
  for (const FieldMotion::StartClash& c : mesh.start_clashes())
    diagnostics.warning(
        "W0646", equations.model->start.empty() ? s.density_span : equations.model->start.front().span,
        fmt::format("the start does not fit the condition at the {} end: {} = {:.6g} beside {:.6g} (SI units)",
                    c.right ? "right" : "left", s.jet_name({equations.varied[c.field], {c.space}, c.time}), c.start,
                    c.condition),
        "The condition is followed, so that a jump runs into the field, which no mesh resolves.",
        "Give a start that has the value of the condition there.");
}

/// N0648: what no equation says of a potential.
void tell_what_is_fixed(const FieldMotion& mesh, const FieldEquations& equations, Diagnostics& diagnostics) {
  const FieldSystem& s = equations.system();
  for (const std::size_t a : mesh.fixed_fields()) {
    const std::string& name = s.fields[equations.varied[a]].name;
    diagnostics.note("N0648", s.fields[equations.varied[a]].span,
                     fmt::format("a constant in {} is not determined by the density", name),
                     fmt::format("It holds derivatives of {0} alone, so that {0} plus any function of t is the same "
                                 "motion. The run keeps {0} as it starts at the left end.",
                                 name),
                     fmt::format("Ask for {}_{}, or for what is made of it.", name, s.space.front().name));
  }
}

/// Of a run on one mesh: with rows and warnings the first, without the second, which is there for the error.
std::optional<OneRun> run_on(const FieldEquations& equations, Method& method, int cells,
                             const std::vector<FieldQuestion>& questions, const FieldRunOptions& options, bool first,
                             Diagnostics& diagnostics) {
  const auto owner = method.mesh(equations, cells);
  FieldMotion& mesh = *owner;
  OneRun out;
  double longest = options.duration;
  if (mesh.trouble().empty()) mesh.start();
  if (mesh.trouble().empty()) longest = method.longest_step(mesh, out, options);
  if (!mesh.trouble().empty()) return refuse(mesh, equations, diagnostics), std::nullopt;
  if (first) warn_of_clashes(mesh, equations, diagnostics), tell_what_is_fixed(mesh, equations, diagnostics);
  std::vector<double> stops;
  for (const FieldQuestion& q : questions) stops.push_back(q.time);
  stops.push_back(options.duration);
  const double every = options.every > 0 ? options.every : options.duration / 100;
  for (double t = 0; (first || method.waves) && t < options.duration; t += every) stops.push_back(t);
  std::sort(stops.begin(), stops.end());
  double size = 0;
  const double start = mesh.energy(size);
  out.energy = start;
  out.answers.assign(questions.size(), std::nan(""));
  out.near.resize(questions.size());
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
      if (questions[i].time == stop) {
        out.answers[i] = mesh.answer(questions[i]);
        out.near[i].clear();
        for (const double shift : beside)
          if (method.stiff && !questions[i].total)
            out.near[i].push_back(mesh.answer_beside(questions[i], shift * method.width));
      }
    if (first && options.trajectory && (out.trajectory.times.empty() || mesh.time() > out.trajectory.times.back()))
      add_row(mesh, equations, cells, out.trajectory);
  }
  out.h = longest;
  if (size > 0) out.drift /= size;
  return out;
}

/// Of an answer on two meshes: the largest at and beside its place.
double difference(const OneRun& one, const OneRun& other, std::size_t question) {
  double out = std::abs(one.answers[question] - other.answers[question]);
  const std::vector<double>&a = one.near[question], &b = other.near[question];
  for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k) out = std::max(out, std::abs(a[k] - b[k]));
  return out;
}

}  // namespace

std::optional<FieldRunResult> run_fields(const FieldEquations& equations, const std::vector<FieldQuestion>& questions,
                                         const FieldRunOptions& options, Diagnostics& diagnostics) {
  const auto begin = std::chrono::steady_clock::now();
  auto method = Method::of(equations, diagnostics);
  if (!method) return std::nullopt;
  const FieldSystem& s = equations.system();
  const int cells = s.space.front().cells ? s.space.front().cells : usual_cells;
  const int order = method->order;
  if (refuse_coarse_mesh(equations, *method, cells, diagnostics)) return std::nullopt;
  auto fine = run_on(equations, *method, cells, questions, options, true, diagnostics);
  if (!fine) return std::nullopt;
  FieldRunResult out;
  out.cells = cells, out.order = order;
  out.method =
      method->waves ? "Taylor steps of order 8" : fmt::format("steps of Gauss's collocation of order {}", 2 * stages);
  out.nodes = static_cast<std::size_t>(cells) * static_cast<std::size_t>(order) + 1;
  out.steps = fine->steps, out.step = fine->h, out.omega_max = fine->omega;
  out.energy = fine->energy, out.energy_drift = method->conserves() ? fine->drift : -1;
  out.end = options.duration;
  out.trajectory = std::move(fine->trajectory);
  if (options.trajectory) {
    const auto mesh = method->mesh(equations, cells);
    for (int e = 0; e <= cells; ++e) out.places.push_back(mesh->place_of_cell(e));
  }
  std::optional<OneRun> coarse, coarser;
  if (options.errors && !questions.empty() && cells > 1)
    coarse = run_on(equations, *method, std::max(cells / 2, 1), questions, options, false, diagnostics);
  if (method->stiff && coarse && cells / 4 > 0) {
    Diagnostics ignored;  // without it there is a broader estimate
    coarser = run_on(equations, *method, cells / 4, questions, options, false, ignored);
  }
  // Meshes and their steps are off by a power of the width of a cell, but never by less than rounding. Where a third
  // mesh shows that the difference falls more slowly, by that.
  const double ratio = cells > 1 ? static_cast<double>(cells) / std::max(cells / 2, 1) : 2;
  const double rounding = 2.2e-16 * std::sqrt(static_cast<double>(out.steps) + 1);
  for (std::size_t i = 0; i < questions.size(); ++i) {
    const double value = fine->answers[i];
    double gain = std::pow(ratio, method->power(equations, questions[i]));
    if (method->stiff) {
      const double seen = coarser ? difference(*coarser, *coarse, i) / difference(*coarse, *fine, i) : 2;
      gain = std::isfinite(seen) ? std::min(gain, std::max(seen, 2.0)) : gain;
    }
    const double error = coarse
                             ? difference(*coarse, *fine, i) / (gain - 1) + rounding * std::max(std::abs(value), 1e-300)
                             : std::numeric_limits<double>::infinity();
    out.answers.push_back({value, error});
  }
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return out;
}

}  // namespace maupertuis
