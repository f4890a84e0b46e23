#include "fields/mesh_run.hpp"

#include "fields/charge_meter.hpp"
#include "fields/field_run_messages.hpp"
#include "fields/outlook.hpp"

#include <maupertuis/evaluate.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

namespace maupertuis {

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

namespace {

/// Where a value of smooth elements, or of a wave with a jump in it, is looked at beside its place, in widths of the
/// first mesh's cells: the error inside an element goes through zero several times, and two meshes agree by chance.
constexpr double beside[] = {-1, -0.7, -0.4, 0.4, 0.7, 1};
/// At the same place of elements of both meshes; of waves, at a border of both alone, where they are off by far less.
constexpr double beside_alike[] = {-4, -2, 2, 4};

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

/// The answer at its place and beside it.
std::vector<double> look_around(FieldMotion& mesh, const FieldMethod& method, const FieldEquations& equations,
                                const FieldQuestion& question) {
  std::vector<double> out{mesh.answer(question)};
  if (!(method.width() > 0) || question.total) return out;
  const auto look = [&](std::span<const double> shifts) {
    for (const double shift : shifts) out.push_back(mesh.answer_beside(question, shift * method.width()));
  };
  if (method.looks_alike()) look(beside_alike);
  if (!method.looks_alike(equations, question)) look(beside);
  return out;
}

/// When each question is looked at, of the answers of all meshes.
std::vector<std::vector<Look>> looks_of(const FieldMethod& method, const std::vector<FieldQuestion>& questions,
                                        double begin) {
  std::vector<std::vector<Look>> out;
  for (const FieldQuestion& q : questions) {
    out.emplace_back();
    for (const double t : method.looks_at(q.time, begin)) out.back().push_back({t});
  }
  return out;
}

}  // namespace

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
  if (!mesh.trouble().empty()) return refuse_mesh(mesh, equations, diagnostics), std::nullopt;
  if (first) warn_of_clashes(mesh, equations, diagnostics), tell_what_is_fixed(mesh, equations, diagnostics);
  if (first && method.is_wave() && options.errors) method.look_before(longest, cells[0] * method.order());
  out.looks = looks_of(method, questions, options.begin);
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
  for (const auto& looks : out.looks)
    for (const Look& look : looks) stops.push_back(look.time);
  std::sort(stops.begin(), stops.end());
  double size = 0;
  const double start = mesh.energy(size);
  if (!std::isfinite(start)) return refuse_infinite_density(equations, diagnostics), std::nullopt;
  out.energy = start;
  out.answers.assign(questions.size(), std::nan(""));
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
        return refuse_mesh(mesh, equations, diagnostics), std::nullopt;
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
      for (Look& look : out.looks[i])
        if (look.time == stop) look.values = look_around(mesh, method, equations, questions[i]);
    for (std::size_t i = 0; i < questions.size(); ++i)
      if (questions[i].time == stop) {
        out.answers[i] = mesh.answer(questions[i]);
        if (first && method.is_wave()) out.sizes[i] = size_along(mesh, questions[i], method.width() * cells[0]);
        if (first) out.felt[i] = felt_rounding(mesh, method, equations, questions[i], cells, out.omega);
        out.follows[i] = follows;
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

}  // namespace maupertuis
