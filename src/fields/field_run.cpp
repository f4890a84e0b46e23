#include <maupertuis/evaluate.hpp>
#include <maupertuis/field_run.hpp>

#include "fields/breaks.hpp"
#include "fields/charge_meter.hpp"
#include "fields/field_method.hpp"
#include "fields/field_sides.hpp"
#include "fields/outlook.hpp"
#include "fields/resolution.hpp"
#include "fields/start_fit.hpp"
#include "fields/steepening.hpp"
#include "fields/switching.hpp"
#include "fields/well_posed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#if __has_include(<unistd.h>)
#include <unistd.h>
#endif

/// The run of a field, and of meshes of half and a quarter of the cells that tell how far off it is.
namespace maupertuis {
namespace {

constexpr int usual_cells = 100, usual_cells_of_plane = 32, usual_cells_of_plate = 4;

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
  } else if (what == "shapes") {
    diagnostics.error("E0508", s.density_span,
                      "not supported yet: a run of a field of first order in time whose energy holds no curvature",
                      "Shapes that the part linear in the velocities leaves out stand within each element, and nothing "
                      "in the energy holds them.",
                      "Add a term with the second derivative, as KdV's 1/2 w_xx^2, with a small factor.");
  } else if (what == "stuck") {
    diagnostics.error(
        "E0643", s.density_span, "no step leads on from here",
        fmt::format("At t = {:.6g} s the equations of a step have no solution near, nor those of its 4096th part.",
                    mesh.time()),
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

void refuse_infinite_density(const FieldEquations& equations, Diagnostics& diagnostics) {
  diagnostics.error("E0645", equations.system().density_span,
                    "the density has no finite value at the start somewhere in its domain",
                    "A coefficient is infinite or undefined there, or the start is where the density is.",
                    "Look for a division by zero, or a logarithm or a root of a negative number.");
}

/// Where a value of smooth elements, or of a wave with a jump in it, is looked at beside its place, in widths of the
/// first mesh's cells: the error inside an element goes through zero several times, and two meshes agree by chance.
constexpr double beside[] = {-1, -0.7, -0.4, 0.4, 0.7, 1};
/// At the same place of elements of both meshes; of waves, at a border of both alone, where they are off by far less.
constexpr double beside_alike[] = {-4, -2, 2, 4};

struct OneRun {
  std::vector<double> answers;
  std::vector<std::vector<double>> near;          // [questions]: the same beside their places
  std::vector<double> sizes;                      // [questions]: the largest anywhere along x, on the first mesh
  std::vector<double> felt;                       // [questions]: felt_rounding, on the first mesh
  std::vector<SteepeningWatch::Follows> follows;  // [questions]: whether the first mesh did
  std::size_t steps = 0;
  bool passes_by = false;  // something that acts for less than a step
  double h = 0, omega = 0, energy = 0, drift = 0;
  Trajectory trajectory;
  std::vector<FieldRunResult::Range> at_end;
  std::vector<FieldCharge> charges;
};

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

const char* side_name(BoundaryCondition::Side side, const FieldSystem& s) {
  constexpr const char* names[] = {"left", "right", "bottom", "top"};
  constexpr const char* ends[] = {"left end", "right end", "bottom", "top"};
  return (s.space.size() == 1 ? ends : names)[static_cast<int>(side)];
}

std::string jet_name(const FieldMotion::StartClash& c, const FieldEquations& equations) {
  std::vector<int> space(equations.system().space.size(), 0);
  space[c.side == BoundaryCondition::Side::Bottom || c.side == BoundaryCondition::Side::Top ? 1 : 0] = c.space;
  return equations.system().jet_name({equations.varied[c.field], std::move(space), c.time});
}

/// Two numbers that differ, also where they do so in late digits.
std::string both_numbers(double value, double other) {
  const std::string one = fmt::format("{:.6g}", value), two = fmt::format("{:.6g}", other);
  return one != two ? one + " beside " + two : fmt::format("{}, off by {:.2g}", two, value - other);
}

/// W0646: the end of the mesh is put to its condition, and what the start says beside it runs in as a wave.
void warn_of_clashes(const FieldMotion& mesh, const FieldEquations& equations, Diagnostics& diagnostics) {
  const FieldSystem& s = equations.system();
  for (const FieldMotion::StartClash& c : mesh.start_clashes())
    diagnostics.warning("W0646", equations.model->start.empty() ? s.density_span : equations.model->start.front().span,
                        fmt::format("the start does not fit the condition at the {}: {} = {} (SI units)",
                                    side_name(c.side, s), jet_name(c, equations), both_numbers(c.start, c.condition)),
                        "The condition is followed, so that a jump runs into the field, which no mesh resolves.",
                        "Give a start that has the value of the condition there.");
}

/// W0650: what acts for less than a step; whether there is such.
bool warn_of_short_action(const FieldEquations& equations, const std::vector<double>& switching, double step,
                          const FieldRunOptions& options, Diagnostics& diagnostics) {
  const auto moment = unresolved_moment(equations, switching, step, {options.begin, options.duration});
  if (!moment) return false;
  diagnostics.warning(
      "W0650", equations.system().density_span,
      fmt::format("what acts changes within less than a step at t = {:.6g} s", *moment),
      fmt::format(
          "Steps are {:.3g} s long: a pulse between their ends is passed by, a jump is taken for something else, "
          "and no error can be estimated.",
          step),
      "Make steps shorter with `output every`, or the change slower.");
  return true;
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

/// The memory of this machine in bytes; 0 where it does not say.
double memory_of_machine() {
#if defined(_SC_PHYS_PAGES) && defined(_SC_PAGESIZE)
  return static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
#else
  return 0;
#endif
}

/// E0649 before anything of a mesh is made that the machine has no room for.
bool refuse_large_mesh(const FieldEquations& equations, const FieldMethod& method, const Cells& cells,
                       Diagnostics& diagnostics) {
  const double bytes = method.bytes(equations, cells), memory = memory_of_machine();
  if (!(memory > 0) || bytes < 0.8 * memory) return false;
  std::string numbers;
  for (const int n : cells) numbers += (numbers.empty() ? "" : " × ") + std::to_string(n);
  diagnostics.error(
      "E0649", equations.system().space.front().span,
      fmt::format("{} cells of order {} do not fit into the memory of this machine", numbers, method.order()),
      fmt::format("{} would take {:.3g} GB; there are {:.3g} GB.",
                  needs_collocation(equations) ? "The matrices of its steps" : "Its Taylor series", bytes / 1e9,
                  memory / 1e9),
      "Write fewer cells, or a lower order of the elements.");
  return true;
}

/// The places of each direction that rows have values at: borders of cells, in the plane not more than some hundred,
/// and between them where those are few.
std::vector<std::vector<double>> places_of_rows(const FieldEquations& equations, const Cells& cells, int least) {
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

/// From the least to the largest value of each field at these places, now.
std::vector<FieldRunResult::Range> ranges_of(const FieldMotion& mesh, const FieldEquations& equations,
                                             const std::vector<std::vector<double>>& places) {
  const FieldSystem& s = equations.system();
  std::vector<FieldRunResult::Range> out;
  for (std::size_t a = 0; a < equations.varied.size(); ++a) {
    const FieldJet jet{equations.varied[a], std::vector<int>(places.size(), 0), 0};
    FieldRunResult::Range range{s.jet_name(jet), to_string(s.dimension_of(jet)),
                                std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    const auto take = [&](const std::vector<double>& at) {
      const double value = mesh.field_at(a, jet, at);
      range.low = std::min(range.low, value), range.high = std::max(range.high, value);
    };
    for (const double x : places[0])
      if (places.size() == 1)
        take({x});
      else
        for (const double y : places[1]) take({x, y});
    out.push_back(std::move(range));
  }
  return out;
}

/// What a mesh of more than a gigabyte takes is said before it is made.
void announce_memory(const FieldRunOptions& options, double bytes) {
  constexpr double gigabyte = 1e9;
  if (options.announce && bytes >= gigabyte)
    options.announce(fmt::format("The mesh of this run takes {:.2g} GB of memory.", bytes / gigabyte));
}

/// The largest |φ_J| on a line along x through a place, now.
double largest_along(const FieldMotion& mesh, const FieldEquations& equations, std::size_t varied, const FieldJet& jet,
                     const PlaceValue& place) {
  constexpr int places = 40;
  const FieldSystem& s = equations.system();
  Bindings values;
  for (const Parameter& p : equations.model->parameters) values[p.symbol] = p.si_value;
  std::vector<double> at;
  for (const Expr& x : place.place) at.push_back(evaluate(s.expanded(x), values));
  const double from = evaluate(s.expanded(s.space.front().from), values),
               to = evaluate(s.expanded(s.space.front().to), values);
  double out = 0;
  for (int k = 0; k <= places; ++k) {
    at[0] = from + (to - from) * k / places;
    out = std::max(out, std::abs(mesh.field_at(varied, jet, at)));
  }
  return out;
}

/// The largest that an answer is at places along x, now.
double size_along(FieldMotion& mesh, const FieldQuestion& question, double width) {
  constexpr int places = 16;  // on either side
  double out = std::abs(mesh.answer(question));
  for (int k = -places; k <= places && !question.total; ++k)
    out = std::max(out, std::abs(mesh.answer_beside(question, k * width / places)));
  return out;
}

/// What an answer feels of rounding beside its own size: each derivative of a field is off by p²/h times what its
/// values are off by on elements of order p, so are, by a little less, rates that are derivatives (of fields of first
/// order in time); those of waves by a part of ω_max; and beams are as soft towards loads as they are long beside an
/// element.
double felt_rounding(FieldMotion& mesh, const FieldMethod& method, const FieldEquations& equations,
                     const FieldQuestion& question, const Cells& cells, double omega) {
  double out = std::abs(mesh.answer(question));
  if (question.total) return out;
  const FieldSystem& s = equations.system();
  const double p = method.order(), all = cells[0] * std::pow(p, 1.5) / std::numbers::pi;
  for (const PlaceValue& place : equations.model->places) {
    const double weight = std::abs(mesh.answer({differentiate(question.value, place.symbol), false, question.time}));
    const FieldJet jet = *s.jet_of(place.jet);
    const auto varied = std::find(equations.varied.begin(), equations.varied.end(), jet.field);
    if (!(weight > 0) || varied == equations.varied.end()) continue;
    const auto a = static_cast<std::size_t>(varied - equations.varied.begin());
    FieldJet value{jet.field, std::vector<int>(s.space.size(), 0), 0}, rate = value;
    rate.time = 1;
    double size = largest_along(mesh, equations, a, value, place);
    if (jet.time > 0) {
      const double rates = largest_along(mesh, equations, a, rate, place);
      size = method.is_first_order(a) ? rates * all * all : rates + omega / 50 * size;
    }
    if (method.is_smooth(a)) size *= cells[0] * cells[0];
    out += weight * size * std::pow(p * p / method.width_of_cell(equations, cells), jet.order() - jet.time);
  }
  return out;
}

/// The answer beside its place.
void look_around(FieldMotion& mesh, const FieldMethod& method, const FieldEquations& equations,
                 const FieldQuestion& question, std::vector<double>& out) {
  const auto look = [&](std::span<const double> shifts) {
    for (const double shift : shifts) out.push_back(mesh.answer_beside(question, shift * method.width()));
  };
  if (method.looks_alike()) look(beside_alike);
  if (!method.looks_alike(equations, question)) look(beside);
}

/// On one mesh: with rows and warnings the first, without the others, which are there for the error.
std::optional<OneRun> run_on(const FieldEquations& equations, FieldMethod& method, const Cells& cells,
                             const std::vector<FieldQuestion>& questions, const FieldRunOptions& options,
                             const std::vector<std::vector<double>>& rows, bool first, Diagnostics& diagnostics) {
  const auto owner = method.mesh(equations, cells, first);
  FieldMotion& mesh = *owner;
  OneRun out;
  double longest = options.duration;
  const double end = options.begin + options.duration;
  mesh.begin_at(options.begin);
  const std::vector<double>& switching = method.switching();
  if (mesh.trouble().empty()) mesh.follow_branches(options.begin, switching.empty() ? end : switching.front());
  if (mesh.trouble().empty()) mesh.start();
  const double every = options.every > 0 ? options.every : options.duration / 100;
  if (mesh.trouble().empty())
    longest = method.longest_step(mesh, options.duration, every, options.interrupt, out.omega);
  if (!mesh.trouble().empty()) return refuse(mesh, equations, diagnostics), std::nullopt;
  if (first) warn_of_clashes(mesh, equations, diagnostics), tell_what_is_fixed(mesh, equations, diagnostics);
  std::vector<double> stops;
  for (const FieldQuestion& q : questions) stops.push_back(q.time);
  stops.push_back(end);
  for (const double t : options.moments)
    if (first && t >= options.begin && t <= end) stops.push_back(t);
  if (first) out.passes_by = warn_of_short_action(equations, switching, std::min(longest, every), options, diagnostics);
  // Where rows bound the steps, those of the other meshes are twice as long, so that their difference tells of steps
  // too.
  const double apart = first ? every : 2 * every;
  for (double t = options.begin; (first || method.is_wave()) && t < end; t += apart) stops.push_back(t);
  std::sort(stops.begin(), stops.end());
  const std::vector<double> of_rows = stops;
  stops.insert(stops.end(), switching.begin(), switching.end());
  std::sort(stops.begin(), stops.end());
  double size = 0;
  const double start = mesh.energy(size);
  if (!std::isfinite(start)) return refuse_infinite_density(equations, diagnostics), std::nullopt;
  out.energy = start;
  out.answers.assign(questions.size(), std::nan(""));
  out.near.resize(questions.size());
  out.sizes.assign(questions.size(), 0), out.felt = out.sizes;
  out.follows.assign(questions.size(), SteepeningWatch::Follows::Well);
  std::optional<SteepeningWatch> slopes;
  if (first && SteepeningWatch::may_steepen(equations)) slopes.emplace(equations, cells, method.order());
  std::optional<ChargeMeter> meter;
  if (first && options.currents) meter.emplace(mesh, equations, *options.currents);
  if (meter && meter->idle()) meter.reset();
  if (meter) meter->note_flux(mesh), meter->measure(mesh);
  constexpr int measurements = 20;
  const double apart_in_run = options.duration / measurements * (1 - 1e-9);
  double measured = options.begin;
  std::optional<Outlook> outlook;
  if (first) outlook.emplace(options);
  for (const double stop : stops) {
    const double way = stop - mesh.time();
    const auto steps = static_cast<std::uint64_t>(std::ceil(way / longest - 1e-9));
    for (std::uint64_t k = 0; way > 0 && k < std::max<std::uint64_t>(steps, 1); ++k) {
      options.interrupt.throw_if_asked();
      if (!mesh.step(way / static_cast<double>(std::max<std::uint64_t>(steps, 1))))
        return refuse(mesh, equations, diagnostics), std::nullopt;
      ++out.steps;
      if (outlook) outlook->after_steps(out.steps, (mesh.time() - options.begin) / options.duration);
      if (first && options.progress) options.progress((mesh.time() - options.begin) / options.duration);
      if (meter) meter->note_flux(mesh);
    }
    if (const auto now = std::lower_bound(switching.begin(), switching.end(), stop);
        now != switching.end() && *now == stop)
      mesh.follow_branches(stop, now + 1 == switching.end() ? end : *(now + 1));
    const bool asked = std::any_of(questions.begin(), questions.end(), [&](const auto& q) { return q.time == stop; });
    const bool due = (way > 0 && stop - measured >= apart_in_run) || stop == end;
    auto follows = SteepeningWatch::Follows::Well;
    if (slopes && (due || asked || stop == options.begin)) follows = slopes->look(mesh);
    if (due && way > 0 && meter) meter->measure(mesh);
    if (due) measured = stop;
    double now = 0;
    if (way > 0 || stop == options.begin) out.energy = mesh.energy(now), size = std::max(size, now);
    out.drift = std::max(out.drift, std::abs(out.energy - start));
    for (std::size_t i = 0; i < questions.size(); ++i)
      if (questions[i].time == stop) {
        out.answers[i] = mesh.answer(questions[i]);
        out.near[i].clear();
        if (first && method.is_wave()) out.sizes[i] = size_along(mesh, questions[i], method.width() * cells[0]);
        if (first) out.felt[i] = felt_rounding(mesh, method, equations, questions[i], cells, out.omega);
        out.follows[i] = follows;
        if (method.width() > 0 && !questions[i].total) look_around(mesh, method, equations, questions[i], out.near[i]);
      }
    if (!rows.empty() && std::binary_search(of_rows.begin(), of_rows.end(), stop) &&
        (out.trajectory.times.empty() || mesh.time() > out.trajectory.times.back()))
      mesh.add_row(out.trajectory, rows);
  }
  if (slopes) slopes->warn(diagnostics);
  if (meter) out.charges = meter->finish();
  out.h = longest, out.steps += mesh.further_steps();
  if (size > 0) out.drift /= size;
  if (first) out.at_end = ranges_of(mesh, equations, places_of_rows(equations, cells, 0));
  return out;
}

/// Of an answer on two meshes: the largest at and beside its place.
double difference(const OneRun& one, const OneRun& other, std::size_t question) {
  double out = std::abs(one.answers[question] - other.answers[question]);
  const std::vector<double>&a = one.near[question], &b = other.near[question];
  for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k) out = std::max(out, std::abs(a[k] - b[k]));
  return out;
}

/// `between` of two meshes, or more where a third and the second differ by more than three times what belongs to that;
/// at most four times, as the third may not follow the wave at all. A place at a border of the second is one of the
/// third too (`aligned`), or else the places two cells of the first beside it are.
double seen_by_coarser(const OneRun& coarser, const OneRun& coarse, double between, double gain, bool aligned,
                       std::size_t question) {
  constexpr double beyond = 3, most = 4;
  const std::vector<double>&a = coarser.near[question], &b = coarse.near[question];
  const bool alike = a.size() == std::size(beside_alike);
  double seen = alike && !aligned ? 0 : std::abs(coarser.answers[question] - coarse.answers[question]);
  for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k) {
    const bool far = k == 0 || k + 1 == a.size();  // four cells beside it
    if (!alike || far == aligned) seen = std::max(seen, std::abs(a[k] - b[k]));
  }
  return std::clamp(seen / (beyond * gain), between, most * between);
}

/// How far off an answer is, and the power of the width of cells by which it comes nearer; 0: not measured.
struct AnswerError {
  double size = std::numeric_limits<double>::infinity(), order = 0;
};

/// By three meshes, each of `ratio` times the cells of the one before; where the last two differ by more than rounding.
double measured_order(const OneRun& coarser, const OneRun& coarse, const OneRun& fine, double rounding, double ratio,
                      std::size_t question) {
  constexpr double clear = 10;
  const double first = std::abs(coarser.answers[question] - coarse.answers[question]),
               second = std::abs(coarse.answers[question] - fine.answers[question]);
  return second > clear * rounding && first > second ? std::log(first / second) / std::log(ratio) : 0;
}

/// Of so many parts the cells of the first mesh.
Cells divided(const Cells& cells, int parts) {
  Cells out = cells;
  for (int& n : out) n = std::max(n / parts, 1);
  return out;
}

/// Whether a mesh follows the start: not where it has jumps or kinks, in part where it is too coarse, and by a lower
/// power of its cells where a derivative of the order `jump` runs in from a side that the start does not fit, or whose
/// motion switches.
struct Rough {
  enum { No, Coarse, Breaks } how = No;
  std::optional<int> jump;
  double tail = 0;  // as in SideFit
};

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

/// The other meshes, and how far off the answers on the first are.
///
/// Meshes and their steps are off by a power of the width of a cell, but never by less than rounding. Where a third
/// mesh shows that the difference falls more slowly, by that; of waves, which go through zero together at some moments
/// on two meshes, by what the third and the second differ where that is more, up to four times; where the start breaks,
/// by the first power; where it does not fit a side, by that of the derivative that jumps, and twice the difference
/// counts. Where slopes are about as steep as the mesh can follow the difference itself counts, and beyond there is no
/// estimate. Where the mesh follows the start in part alone, a mesh of twice the cells tells what both others miss.
/// Tails of pulses that do not fit a side are jumps too, as far as they reach.
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
  double ratio = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (cells[i] > 1) ratio = std::min(ratio, static_cast<double>(cells[i]) / half[i]);
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
    const bool aligned =
        !method.looks_alike(equations, questions[i]) || method.stands_on_borders(equations, questions[i], quarter);
    const double felt = rounding * std::max(fine.felt[i], 1e-300);
    if (coarser && aligned) out[i].order = measured_order(*coarser, *coarse, fine, felt, ratio, i);
    if (smooth_wave && coarser && gain > 2) between = seen_by_coarser(*coarser, *coarse, between, gain, aligned, i);
    const double tail = std::min(2 * between, start.tail * fine.sizes[i]),
                 missed = finer ? 2 * difference(*finer, fine, i) : 0;
    out[i].size = std::max({missed, between / (gain - 1), tail}) + felt;
  }
  return out;
}

}  // namespace

std::optional<FieldRunResult> run_fields(const FieldEquations& equations, const std::vector<FieldQuestion>& questions,
                                         const FieldRunOptions& options, Diagnostics& diagnostics) {
  const auto begin = std::chrono::steady_clock::now();
  auto method = FieldMethod::of(equations, diagnostics);
  if (!method || refuse_too_many_conditions(equations, diagnostics)) return std::nullopt;
  if (refuse_ill_posed_start(equations, diagnostics)) return std::nullopt;
  const FieldSystem& s = equations.system();
  Cells cells;
  for (const SpaceVariable& x : s.space) {
    const int usual = s.space.size() == 1 ? usual_cells
                      : method->is_wave() ? usual_cells_of_plane
                                          : usual_cells_of_plate;
    cells.push_back(x.cells ? x.cells : s.space.front().cells ? s.space.front().cells : usual);
  }
  if (refuse_large_mesh(equations, *method, cells, diagnostics)) return std::nullopt;
  announce_memory(options, method->bytes(equations, cells));
  if (refuse_unresolved(equations, even_borders(equations, cells), method->order(), {options.begin, options.duration},
                        diagnostics))
    return std::nullopt;
  if (auto moments = switching_moments(equations, options.begin, options.begin + options.duration))
    method->end_steps_at(std::move(*moments));
  const Rough start = roughness_of(equations, *method, cells, options, diagnostics);
  if (method->is_wave()) {
    const std::vector<double> borders = even_borders(equations, cells).front();
    method->look_beside(borders[1] - borders[0], !start.jump, divided(cells, 2));
  }
  std::vector<std::vector<double>> rows;
  if (options.trajectory) rows = places_of_rows(equations, cells, options.least_values);
  auto fine = run_on(equations, *method, cells, questions, options, rows, true, diagnostics);
  if (!fine) return std::nullopt;
  FieldRunResult out;
  out.cells = cells.front(), out.order = method->order(), out.method = method->name(), out.nodes = 1;
  if (cells.size() == 2) out.cells_upwards = cells[1];
  for (const int n : cells) out.nodes *= static_cast<std::size_t>(n) * static_cast<std::size_t>(out.order) + 1;
  out.steps = fine->steps, out.step = fine->h, out.omega_max = fine->omega;
  out.energy = fine->energy, out.energy_drift = method->conserves() ? fine->drift : -1;
  warn_of_drift(out, equations, diagnostics);
  out.end = options.begin + options.duration;
  out.trajectory = std::move(fine->trajectory);
  out.at_end = std::move(fine->at_end);
  out.charges = std::move(fine->charges);
  if (!rows.empty()) out.places = rows[0];
  if (rows.size() == 2) out.upwards = rows[1];
  const std::vector<AnswerError> errors =
      errors_of(*fine, equations, *method, cells, questions, options, start, diagnostics);
  for (std::size_t i = 0; i < questions.size(); ++i)
    out.answers.push_back({fine->answers[i], errors[i].size, errors[i].order});
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return out;
}

}  // namespace maupertuis
