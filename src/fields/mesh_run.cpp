#include "fields/mesh_run.hpp"

#include "fields/charge_meter.hpp"
#include "fields/field_run_messages.hpp"
#include "fields/outlook.hpp"

#include <maupertuis/evaluate.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
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

/// A run on one mesh: from stop to stop, at each of which it notes what is asked there.
class MeshRun {
 public:
  MeshRun(const FieldEquations& equations, FieldMethod& method, const Cells& cells,
          const std::vector<FieldQuestion>& questions, const FieldRunOptions& options,
          const std::vector<std::vector<double>>& rows, bool first, Diagnostics& diagnostics)
      : equations_(equations),
        method_(method),
        cells_(cells),
        questions_(questions),
        options_(options),
        rows_(rows),
        first_(first),
        diagnostics_(diagnostics),
        owner_(method.mesh(equations, cells, first)),
        mesh_(*owner_),
        end_(options.begin + options.duration),
        every_(options.every > 0 ? options.every : options.duration / 100) {}

  std::optional<OneRun> run() {
    if (!begin()) return std::nullopt;
    plan_stops();
    if (!measure_start()) return std::nullopt;
    for (const double stop : stops_) {
      const bool moved = stop > mesh_.time();
      if (!move_to(stop)) return std::nullopt;
      note(stop, moved);
    }
    finish();
    return std::move(out_);
  }

 private:
  bool begin();
  void plan_stops();
  bool measure_start();
  bool move_to(double stop);
  void note(double stop, bool moved);
  void answer(double stop, SteepeningWatch::Follows follows);
  void finish();

  const FieldEquations& equations_;
  FieldMethod& method_;
  const Cells& cells_;
  const std::vector<FieldQuestion>& questions_;
  const FieldRunOptions& options_;
  const std::vector<std::vector<double>>& rows_;
  const bool first_;
  Diagnostics& diagnostics_;
  const std::unique_ptr<FieldMotion> owner_;
  FieldMotion& mesh_;
  const double end_, every_;
  OneRun out_;
  std::vector<double> stops_, of_rows_;  // sorted
  double start_energy_ = 0, size_of_energy_ = 0;
  double measured_ = 0;  // when charges were last
  std::optional<SteepeningWatch> slopes_;
  std::optional<ChargeMeter> meter_;
  std::optional<Outlook> outlook_;
};

bool MeshRun::begin() {
  mesh_.begin_at(options_.begin);
  const std::vector<double>& switching = method_.switching();
  if (mesh_.trouble().empty()) mesh_.follow_branches(options_.begin, switching.empty() ? end_ : switching.front());
  if (mesh_.trouble().empty()) mesh_.start();
  if (mesh_.trouble().empty())
    out_.h = method_.longest_step(mesh_, options_.duration, every_, options_.interrupt, out_.omega);
  if (!mesh_.trouble().empty()) return refuse_mesh(mesh_, equations_, diagnostics_), false;
  if (!first_) return true;
  warn_of_clashes(mesh_.start_clashes(), equations_, diagnostics_), tell_what_is_fixed(mesh_, equations_, diagnostics_);
  if (method_.is_wave() && options_.errors) method_.look_before(out_.h, cells_[0] * method_.order());
  out_.passes_by = warn_of_short_action(equations_, switching, std::min(out_.h, every_), options_, diagnostics_);
  return true;
}

void MeshRun::plan_stops() {
  out_.looks = looks_of(method_, questions_, options_.begin);
  for (const FieldQuestion& q : questions_) stops_.push_back(q.time);
  stops_.push_back(end_);
  for (const double t : options_.moments)
    if (first_ && t >= options_.begin && t <= end_) stops_.push_back(t);
  // Where rows bound the steps, those of the other meshes are twice as long, so that their difference tells of steps
  // too.
  const double apart = first_ ? every_ : 2 * every_;
  for (double t = options_.begin; (first_ || method_.is_wave()) && t < end_; t += apart) stops_.push_back(t);
  std::sort(stops_.begin(), stops_.end());
  of_rows_ = stops_;
  const std::vector<double>& switching = method_.switching();
  stops_.insert(stops_.end(), switching.begin(), switching.end());
  for (const auto& looks : out_.looks)
    for (const Look& look : looks) stops_.push_back(look.time);
  std::sort(stops_.begin(), stops_.end());
}

bool MeshRun::measure_start() {
  start_energy_ = out_.energy = mesh_.energy(size_of_energy_);
  if (!std::isfinite(start_energy_)) return refuse_infinite_density(equations_, diagnostics_), false;
  out_.answers.assign(questions_.size(), std::nan(""));
  out_.sizes.assign(questions_.size(), 0), out_.felt = out_.sizes;
  out_.follows.assign(questions_.size(), SteepeningWatch::Follows::Well);
  measured_ = options_.begin;
  if (!first_) return true;
  if (SteepeningWatch::may_steepen(equations_)) slopes_.emplace(equations_, cells_, method_.order());
  if (options_.currents) meter_.emplace(mesh_, equations_, *options_.currents);
  if (meter_ && meter_->idle()) meter_.reset();
  if (meter_) meter_->note_flux(mesh_), meter_->measure(mesh_);
  outlook_.emplace(options_);
  return true;
}

bool MeshRun::move_to(double stop) {
  const double way = stop - mesh_.time();
  const auto steps = static_cast<std::uint64_t>(std::max(std::ceil(way / out_.h - 1e-9), 1.0));
  for (std::uint64_t k = 0; way > 0 && k < steps; ++k) {
    options_.interrupt.throw_if_asked();
    if (!mesh_.step(way / static_cast<double>(steps))) return refuse_mesh(mesh_, equations_, diagnostics_), false;
    ++out_.steps;
    const double done = (mesh_.time() - options_.begin) / options_.duration;
    if (outlook_) outlook_->after_steps(out_.steps, done);
    if (first_ && options_.progress) options_.progress(done);
    if (meter_) meter_->note_flux(mesh_);
  }
  const std::vector<double>& switching = method_.switching();
  const auto now = std::lower_bound(switching.begin(), switching.end(), stop);
  if (now != switching.end() && *now == stop)
    mesh_.follow_branches(stop, now + 1 == switching.end() ? end_ : *(now + 1));
  return true;
}

void MeshRun::note(double stop, bool moved) {
  constexpr int measurements = 20;
  const double apart = options_.duration / measurements * (1 - 1e-9);
  const bool asked = std::any_of(questions_.begin(), questions_.end(), [&](const auto& q) { return q.time == stop; });
  const bool due = (moved && stop - measured_ >= apart) || stop == end_;
  auto follows = SteepeningWatch::Follows::Well;
  if (slopes_ && (due || asked || stop == options_.begin)) follows = slopes_->look(mesh_);
  if (due && moved && meter_) meter_->measure(mesh_);
  if (due) measured_ = stop;
  double size = 0;
  if (moved || stop == options_.begin)
    out_.energy = mesh_.energy(size), size_of_energy_ = std::max(size_of_energy_, size);
  out_.drift = std::max(out_.drift, std::abs(out_.energy - start_energy_));
  answer(stop, follows);
  if (!rows_.empty() && std::binary_search(of_rows_.begin(), of_rows_.end(), stop) &&
      (out_.trajectory.times.empty() || mesh_.time() > out_.trajectory.times.back()))
    mesh_.add_row(out_.trajectory, rows_);
}

void MeshRun::answer(double stop, SteepeningWatch::Follows follows) {
  for (std::size_t i = 0; i < questions_.size(); ++i) {
    const FieldQuestion& question = questions_[i];
    for (Look& look : out_.looks[i])
      if (look.time == stop) look.values = look_around(mesh_, method_, equations_, question);
    if (question.time != stop) continue;
    out_.answers[i] = mesh_.answer(question);
    out_.follows[i] = follows;
    if (!first_) continue;
    if (method_.is_wave()) out_.sizes[i] = size_along(mesh_, question, method_.width() * cells_[0]);
    out_.felt[i] = felt_rounding(mesh_, method_, equations_, question, cells_, out_.omega);
  }
}

void MeshRun::finish() {
  if (slopes_) slopes_->warn(diagnostics_);
  if (meter_) out_.charges = meter_->finish();
  out_.steps += mesh_.further_steps();
  if (size_of_energy_ > 0) out_.drift /= size_of_energy_;
  if (first_) out_.at_end = ranges_of(mesh_, equations_, places_of_rows(equations_, cells_, 0));
}

}  // namespace

std::optional<OneRun> run_on(const FieldEquations& equations, FieldMethod& method, const Cells& cells,
                             const std::vector<FieldQuestion>& questions, const FieldRunOptions& options,
                             const std::vector<std::vector<double>>& rows, bool first, Diagnostics& diagnostics) {
  return MeshRun(equations, method, cells, questions, options, rows, first, diagnostics).run();
}

}  // namespace maupertuis
